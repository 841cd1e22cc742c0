// SPDX-License-Identifier: Apache-2.0
// What one component consists of: its plugins with their parameters, its ports, how it is.
import {kStateSigns} from '../colours';
import {kStates} from '../deployment';
import {make, write, type View} from '../view';
import {hertz, short} from './graph_panel';

export class Inspector {
  readonly element = make('aside', {class: 'inspector', 'aria-label': 'Component', hidden: true});
  private readonly condition = make('p', {class: 'condition', role: 'status'});
  private name = '';

  constructor(private readonly onClose: () => void) {}

  show(name: string, {deployment}: View) {
    this.name = name;
    const component = deployment?.components.find((one) => one.name === name);
    this.element.hidden = !component;
    if (!component) return;
    const close = make('button', {type: 'button', 'aria-label': 'Close', class: 'close'}, '✕');
    close.addEventListener('click', () => this.onClose());
    const parts: HTMLElement[] = [
      make('header', {}, make('h3', {}, component.name), close),
      make('p', {}, `${component.plugin} · executor ${component.executor} · process ${component.process}`),
      this.condition,
    ];
    for (const {slot, plugin, sha256, parameters} of component.plugins) {
      if (sha256) parts.push(make('p', {class: 'hash'}, `${plugin}: SHA-256 ${sha256}`));
      if (parameters.length === 0) continue;
      parts.push(make('h4', {}, slot ? `Parameters of ${slot}: ${plugin}` : `Parameters of ${plugin}`));
      parts.push(table(['Name', 'Value', 'From'], parameters.map((one) => [one.name, one.value, one.origin.replace(/^\/.*\//, '')])));
    }
    for (const [title, output] of [['Reads', false], ['Writes', true]] as const) {
      const ports = component.ports.filter((port) => port.output === output);
      if (ports.length === 0) continue;
      parts.push(make('h4', {}, title));
      parts.push(table(['Port', 'Topic', 'Type', 'Quality'], ports.map((port) => [port.name, port.topic, port.type, `${port.qos}${port.reliable ? ', reliable' : ''}`])));
    }
    this.element.replaceChildren(...parts);
  }
  draw({deployment, t}: View) {
    if (this.element.hidden || !deployment) return;
    const one = deployment.conditionsAt(t).get(this.name);
    write(this.condition, one === undefined ? 'Nothing was told of it at this time'
      : `${kStateSigns[one.state] ?? ''} ${kStates[one.state] ?? '?'}${one.reason ? `: ${one.reason}` : ''} · ${hertz(one.hz)} · late ${short(one.latenessP99)} · step ${short(one.stepP99)} (99 %) · missed ${one.missed} · dropped ${one.dropped}` +
        (one.reaction ? ` · answers to ${one.reaction.source} after ${short(one.reaction.p99)} (99 %)` : ''));
  }
}

export function table(head: string[], rows: string[][]): HTMLElement {
  return make('table', {},
      make('thead', {}, make('tr', {}, ...head.map((text) => make('th', {scope: 'col'}, text)))),
      make('tbody', {}, ...rows.map((row) => make('tr', {}, ...row.map((text) => make('td', {}, text))))));
}
