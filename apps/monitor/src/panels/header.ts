// SPDX-License-Identifier: Apache-2.0
// The head of the page, for those who stand two metres away: what runs, what it does, how near it is
// to its goals, whether all is well.
import {kStateSigns} from '../colours';
import type {Deployment} from '../deployment';
import type {Series} from '../layouts/layout';
import {make, write, type View} from '../view';
import {formatted} from './plot_panel';

export interface Headline {
  series: Series;
  unit: string;
  value: number;
  goal: number | undefined;
}
const kStepSigns = ['○', '?', '▶', '✓', '✖'];
const kStepWords = ['ahead', 'waits for its confirmation', 'active', 'done', 'broken off'];

export class Header {
  private readonly chooser = make('select', {'aria-label': 'Deployment', hidden: true});
  private readonly name = make('h1', {}, 'Armature');
  private readonly story = make('p', {class: 'story'});
  private readonly task = make('strong', {class: 'task', role: 'status'});
  private readonly steps = make('ol', {class: 'steps', 'aria-label': 'Steps of the procedure'});
  private readonly figures = make('ul', {class: 'figures', 'aria-label': 'Figures against their goals'});
  private readonly health = make('p', {class: 'health', role: 'status'});
  private readonly connection = make('p', {class: 'connection', role: 'status'});
  private names = '';

  constructor(element: HTMLElement, onChoose: (namespace: string) => void) {
    this.chooser.addEventListener('change', () => onChoose(this.chooser.value));
    element.append(
        make('div', {class: 'who'}, make('div', {class: 'title'}, this.name, this.chooser), this.story),
        make('div', {class: 'doing'}, this.task, this.steps), this.figures,
        make('div', {class: 'well'}, this.health, this.connection));
  }
  static taskTopic(deployment: Deployment | undefined) { return deployment?.topic('task/state') ?? ''; }

  draw(view: View, deployments: {name: string; namespace: string}[], headlines: Headline[]) {
    const {hub, deployment, layout} = view;
    const key = deployments.map(({namespace}) => namespace).join();
    if (key !== this.names) {
      this.names = key;
      this.chooser.replaceChildren(...deployments.map(({name, namespace}) => make('option', {value: namespace}, name)));
    }
    this.chooser.hidden = deployments.length < 2;
    if (deployment) this.chooser.value = deployment.namespace;
    this.name.hidden = !this.chooser.hidden;
    write(this.name, layout.title ?? deployment?.name ?? 'Armature');
    write(this.story, deployment ? layout.story : hub.condition === 'connected' ? 'No deployment runs on this domain' : '');
    this.drawTask(view);
    this.drawFigures(headlines);
    this.drawHealth(view);
    const lost = hub.condition === 'lost' || hub.condition === 'refused';
    write(this.connection, `${lost ? '▲ ' : ''}${hub.condition === 'connected' ? connected(view) : hub.text}`);
    this.connection.classList.toggle('lost', lost);
    document.body.classList.toggle('lost', lost);
  }

  private drawTask({hub, deployment, t}: View) {
    const state = deployment ? hub.at(Header.taskTopic(deployment), t) : undefined;
    const position = state?.steps > 0 ? ` ${state.step}/${state.steps}` : '';
    write(this.task, state ? `${state.paused ? '❚❚ paused: ' : ''}${state.state}${position}` : '');
    const steps = shortened(state?.procedure ?? []);
    while (this.steps.children.length > steps.length) this.steps.lastChild!.remove();
    steps.forEach(({name, state: how}, i) => {
      const item = (this.steps.children[i] as HTMLElement | undefined) ?? this.steps.appendChild(make('li'));
      write(item, `${kStepSigns[how] ?? ''} ${name}`);
      item.className = `step${how}`;
      item.setAttribute('aria-label', `${name}: ${kStepWords[how] ?? ''}`);
    });
  }
  private drawFigures(headlines: Headline[]) {
    while (this.figures.children.length > headlines.length) this.figures.lastChild!.remove();
    headlines.forEach(({series, unit, value, goal}, i) => {
      const item = (this.figures.children[i] as HTMLElement | undefined) ??
          this.figures.appendChild(make('li', {}, make('span', {class: 'name'}), make('b'), make('span', {class: 'goal'})));
      // A goal is for the end: on the way there it is not missed, it is not met yet.
      const met = goal !== undefined && Number.isFinite(value) ? (value <= goal ? 'met' : 'ahead') : '';
      write(item.children[0]!, series.label);
      write(item.children[1]!, `${formatted(value, series.digits)} ${unit}`);
      write(item.children[2]!, goal === undefined ? '' : `goal ${goal}${met === 'met' ? ' ✓' : ''}`);
      item.className = met;
    });
  }
  private drawHealth({deployment, t}: View) {
    if (!deployment || deployment.components.length === 0) return write(this.health, '');
    const {state, text} = deployment.healthAt(t);
    write(this.health, `${kStateSigns[state]} ${text}`);
    this.health.title = text;
    this.health.className = `health state${state}`;
    return undefined;
  }
}

function connected({hub, isLive}: View): string {
  if (hub.playback) return hub.playback.isPlaying ? '▷ recording' : '❚❚ recording';
  return isLive ? '● live' : '❚❚ paused';
}
/// Of many steps the one that is active and its neighbours; how many others are done and ahead.
function shortened(steps: {name: string; state: number}[]): {name: string; state: number}[] {
  if (steps.length <= 5) return steps;
  const done = steps.filter(({state}) => state === 3).length;
  const others = steps.filter(({state}) => state !== 3 && state !== 0), ahead = steps.filter(({state}) => state === 0);
  const shown = done > 0 ? [{name: `${done} done`, state: 3}, ...others] : others;
  shown.push(...ahead.slice(0, 2));
  if (ahead.length > 2) shown.push({name: `${ahead.length - 2} more`, state: 0});
  return shown;
}
