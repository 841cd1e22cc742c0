// SPDX-License-Identifier: Apache-2.0
// The values of one expression over time, as far back as its topics are remembered.
import type {Hub} from '../hub';
import {kAhead} from '../store';
import {parseExpression, type Expression} from './expression';

const kMaxPoints = 20000;  // of what runs; a recording is bounded by what is read of it

export class Curve {
  readonly topics: string[];  // in full
  times: number[] = [];
  values: (number | null)[] = [];
  version = 0;
  private expression: Expression;
  private seenFrom = Infinity;  // the times of the first and the last message that was evaluated
  private seenTo = -Infinity;
  private clock: string;

  /// `full` makes a topic's full name of that in the expression. Throws what parseExpression throws.
  constructor(private readonly text: string, private readonly full: (topic: string) => string,
              private readonly parameter: (component: string, name: string) => number = () => NaN) {
    this.expression = this.parse();
    this.topics = [...new Set(this.expression.topics.map(full))];
    this.clock = this.topics[0] ?? '';
    if (this.clock === '') throw new Error('an expression needs a topic, in braces');
  }
  /// What a component was told by the deployment file stands in it as a number.
  private parse() {
    return parseExpression(this.text.replace(/parameter\("([\w.]+)", "(\w+)"\)/g, (_, component, name) => {
      const value = this.parameter(component, name);
      return Number.isFinite(value) ? `(${value})` : '(0 / 0)';
    }));
  }
  clear() {
    this.expression = this.parse();  // what it remembers, too
    this.times = [];
    this.values = [];
    this.seenFrom = Infinity;
    this.seenTo = -Infinity;
    ++this.version;
  }
  /// Evaluates what has come since, at every message of the first topic.
  update(hub: Hub) {
    const clock = hub.log(this.clock);
    const end = clock.indexAt(hub.store.newest + kAhead) + 1;  // what is stamped later is not believed
    // Earlier ones have come, or what was evaluated is forgotten: stamps have gone back.
    const isAnother = end === 0 || clock.first!.t < this.seenFrom - 0.5 || clock.entry(end - 1)!.t < this.seenTo;
    if (this.times.length > 0 && isAnother) this.clear();
    const others = this.topics.slice(1).map((topic) => hub.log(topic));
    for (let i = clock.indexAt(this.seenTo) + 1; i < end; ++i) {
      const {t} = clock.entry(i)!;
      // What does not come yet may come a little later: the first values wait for it.
      if (this.times.length === 0 && others.some((log) => log.length === 0)) break;
      const value = this.expression.evaluate((topic) => {
        const name = this.full(topic);
        if (name === this.clock) return clock.message(clock.entry(i));
        const log = hub.log(name);
        return log.at(t) ?? (log.length <= 2 ? log.message(log.first) : undefined);
      });
      this.times.push(t);
      this.values.push(Number.isFinite(value) ? value : null);
      this.seenFrom = Math.min(this.seenFrom, t);
      this.seenTo = t;
      ++this.version;
    }
    if (!hub.recording) this.forgetBefore(hub.store.newest - hub.store.windowS);
  }
  at(t: number): number {
    let low = 0, high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle]! <= t) low = middle + 1;
      else high = middle;
    }
    return low > 0 && t - this.times[low - 1]! < 5 ? this.values[low - 1] ?? NaN : NaN;
  }
  private forgetBefore(t: number) {
    let count = Math.max(0, this.times.length - kMaxPoints);
    while (count < this.times.length && this.times[count]! < t) ++count;
    if (count < 50 && count < this.times.length) return;
    this.times.splice(0, count);
    this.values.splice(0, count);
  }
}
