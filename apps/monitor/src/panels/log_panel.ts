// SPDX-License-Identifier: Apache-2.0
// What the operator was told, changes of state, and what became of the connection, in one list. A
// click on a line goes to its time.
import {kStateSigns} from '../colours';
import {kStates, type Deployment} from '../deployment';
import type {Hub} from '../hub';
import {secondsOf} from '../message/decoder';
import {make, type Panel, type View} from '../view';

export interface LogEvent {
  t: number;
  level: 'debug' | 'info' | 'warning' | 'error';
  who: string;
  text: string;
}
const kSigns = {debug: '·', info: '●', warning: '▲', error: '✖'};
const kMost = 400;

function levelOf(level: number): LogEvent['level'] {
  return level >= 40 ? 'error' : level >= 30 ? 'warning' : level >= 20 ? 'info' : 'debug';
}

export class LogPanel implements Panel {
  readonly id = 'log';
  readonly title = 'Log';
  readonly element = make('div', {class: 'log'});
  readonly intervalMs = 200;
  events: LogEvent[] = [];
  private readonly list = make('ol', {tabindex: 0, 'aria-label': 'Events, the newest last'});
  private own: LogEvent[] = [];
  private states = new Map<string, string>();
  private seen = '';
  private shown = 0;
  private shownT = NaN;

  constructor(private readonly onChoose: (t: number) => void) { this.element.append(this.list); }

  topics({deployment}: View): string[] { return ['/rosout', ...(deployment ? [deployment.statesTopic] : [])]; }
  /// Of the page itself.
  add(event: LogEvent) {
    this.own.push(event);
    if (this.own.length > kMost) this.own.shift();
    this.seen = '';
  }
  reset() {
    this.states.clear();
    this.seen = '';
    this.own = this.own.filter((event) => event.who === 'page');
  }
  update(view: View) {
    this.watchStates(view.hub, view.deployment);
    const log = view.hub.log('/rosout'), key = `${log.version} ${this.own.length} ${view.deployment?.name}`;
    if (key === this.seen) return;
    this.seen = key;
    const told: LogEvent[] = [];
    const name = view.deployment?.name;
    for (let i = Math.max(0, log.length - kMost); i < log.length; ++i) {
      const message = log.message(log.entry(i));
      if (!message) continue;
      const [first, ...rest] = String(message.name).split('.');
      if (name && rest.length > 0 && first !== name) continue;  // another deployment of this domain
      told.push({t: secondsOf(message.stamp), level: levelOf(message.level), who: rest.join('.') || first!, text: message.msg});
    }
    this.events = [...told, ...this.own].sort((a, b) => a.t - b.t).slice(-kMost);
    this.shown = -1;
  }
  draw(view: View) {
    this.update(view);
    const until = this.events.filter((event) => !(event.t > view.t + 0.001)).length;
    if (this.shown === this.events.length && until === this.list.querySelectorAll('li:not(.later)').length && this.shownT === until) return;
    this.shownT = until;
    if (this.shown !== this.events.length) {
      this.shown = this.events.length;
      const start = this.events[0]?.t ?? 0;
      this.list.replaceChildren(...this.events.map((event) => this.line(event, start)));
      if (this.events.length === 0) this.list.replaceChildren(make('li', {class: 'note'}, 'Nothing has been told yet'));
    }
    [...this.list.children].forEach((line, i) => line.classList.toggle('later', i >= until));
    const last = this.list.children[Math.max(0, until - 1)] as HTMLElement | undefined;
    if (last) this.list.scrollTop = last.offsetTop + last.offsetHeight - this.list.clientHeight;
  }

  private line(event: LogEvent, start: number): HTMLElement {
    const button = make('button', {type: 'button', title: 'Go to this time'},
        make('time', {}, `${(event.t - start).toFixed(1)} s`), make('span', {class: 'sign', 'aria-label': event.level}, kSigns[event.level]),
        make('b', {}, event.who), make('span', {class: 'text'}, event.text));
    button.addEventListener('click', () => this.onChoose(event.t));
    return make('li', {class: event.level}, button);
  }
  /// A component that is not as it was a moment ago is an event, too.
  private watchStates(hub: Hub, deployment: Deployment | undefined) {
    if (!deployment || !Number.isFinite(hub.store.newest)) return;
    for (const [name, {state, reason}] of deployment.conditionsAt(hub.store.newest)) {
      const now = `${state} ${reason}`, before = this.states.get(name);
      this.states.set(name, now);
      if (before === undefined ? state === 0 : before === now) continue;
      this.add({t: hub.log(deployment.statesTopic).last?.t ?? hub.store.newest, level: state === 0 ? 'info' : state === 1 ? 'warning' : 'error',
                who: name, text: `${kStateSigns[state]} ${kStates[state]}${reason ? `: ${reason}` : ''}`});
    }
  }
}
