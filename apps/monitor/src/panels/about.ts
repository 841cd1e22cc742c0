// SPDX-License-Identifier: Apache-2.0
// What a report tells of its run: where it came from, its figures, its timing, what it was made of.
import type {Deployment} from '../deployment';
import {make} from '../view';
import {hertz, short} from './graph_panel';
import type {Embedded, RunFigures, Timing} from '../source/embedded';
import type {Headline} from './header';
import {table} from './inspector';
import {formatted} from './plot_panel';

export class AboutDialog {
  private readonly content = make('div');
  private readonly dialog = make('dialog', {class: 'help about', 'aria-label': 'About this run'});

  constructor(private readonly report: Pick<Embedded, 'told' | 'figures'>) {
    const close = make('button', {type: 'button', class: 'close', 'aria-label': 'Close'}, '✕');
    close.addEventListener('click', () => this.dialog.close());
    this.dialog.append(make('header', {}, make('h2', {}, 'About this run'), close), this.content);
    document.body.append(this.dialog);
  }

  /// `headlines` are the figures at `t` [s], which is `when`: 'at the end'.
  show(deployment: Deployment | undefined, headlines: Headline[], t: number, when: string) {
    const {told, figures} = this.report;
    const parts: HTMLElement[] = [table(['', ''], told)];
    const add = (title: string, ...elements: HTMLElement[]) => parts.push(make('h3', {}, title), ...elements);
    if (figures) {
      add(`Figures of the run: ${figures.status}`, ...figures.reasons.map((reason) => make('p', {class: 'reason'}, reason)),
          table(['Figure', 'Value', 'Goal, at most', ''], figureRows(figures)));
      add('Timing of the run', table(['Component', 'Steps', 'Step (mean)', 'Step (99 %)', 'Step (max)', 'Late (99 %)', 'Late (max)', 'Processor (mean)'], timingRows(figures)));
    } else if (headlines.length > 0) {
      add(`Figures ${when}`, table(['Figure', 'Value', 'Goal'], headlines.map(({series, unit, value, goal}) =>
        [series.label, `${formatted(value, series.digits)} ${unit}`, goal === undefined ? '' : `${goal} ${unit}`])));
    }
    if (deployment) {
      const timing = [...deployment.conditionsAt(t)].sort(([a], [b]) => a.localeCompare(b));
      add(`Timing ${when}`, table(['Component', 'Rate', 'Step (99 %)', 'Late (99 %)', 'Missed', 'Dropped', 'Answers after (99 %)'], timing.map(([name, one]) =>
        [name, hertz(one.hz), short(one.stepP99), short(one.latenessP99), String(one.missed), String(one.dropped),
         one.reaction ? `${short(one.reaction.p99)} to ${one.reaction.source}` : ''])));
      const plugins = deployment.components.flatMap((component) => component.plugins.map((one) => ({...one, component: component.name})));
      add('Plugins', table(['Component', 'Plugin', 'Built for', 'SHA-256 of its library'], plugins.map(({component, slot, plugin, abi, sha256}) =>
        [slot ? `${component}, ${slot}` : component, plugin, abi, sha256 || 'part of the runtime'])));
      add('Parameters', table(['Component', 'Plugin', 'Parameter', 'Value', 'From'], plugins.flatMap(({component, plugin, parameters}) =>
        parameters.map((one) => [component, plugin, one.name, one.value, one.origin.replace(/^\/.*\//, '')]))));
      add('Configuration', folded('The deployment, resolved', deployment.configuration),
          ...deployment.documents.map(({section, name, text}) => folded(`${section}/${name}`, text)));
    }
    this.content.replaceChildren(...parts);
    this.dialog.showModal();
  }
}

function figureRows({figures}: RunFigures): string[][] {
  const shown = (value: number | string | null) =>
      value === null ? '–' : typeof value === 'string' || Number.isInteger(value) ? String(value) : Math.abs(value) < 0.0005 ? value.toExponential(0) : value.toFixed(3);
  return figures.map(({title, value, goal, met, not_measured, does_not_apply}) => [
    title, not_measured ? `not measured: ${not_measured}` : does_not_apply ? `does not apply: ${does_not_apply}` : Array.isArray(value) ? value.map(shown).join(', ') : shown(value),
    goal === undefined ? '' : String(goal), met === undefined ? '' : met ? '✓ met' : '✖ missed',
  ]);
}

function timingRows({timing}: RunFigures): string[][] {
  return Object.entries(timing.components).map(([name, {step, lateness, processor}]) => [
    name, String(step?.count ?? ''), ...([[step, 'mean_s'], [step, 'p99_s'], [step, 'max_s'], [lateness, 'p99_s'], [lateness, 'max_s'], [processor, 'mean_s']] as const)
        .map(([one, which]: readonly [Timing | undefined, keyof Timing]) => one ? short(one[which]) : ''),
  ]);
}

function folded(title: string, text: string): HTMLElement {
  return make('details', {}, make('summary', {}, title), make('pre', {}, text));
}
