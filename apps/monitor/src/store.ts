// SPDX-License-Identifier: Apache-2.0
// Remembers the messages of every topic that somebody looks at, as far back as the window reaches
// and in bounded memory. Messages stay packed until somebody wants one.
import type {Decode, Message} from './message/decoder';
import {Newest} from './newest';

export interface Entry {
  t: number;  // [s] when it was sent
  bytes: Uint8Array;
}

const kOverhead = 160;  // [byte] of an entry, beside its message
const kUnpacked = 96;   // messages of a topic that stay unpacked
export const kAhead = 5;       // [s] what is stamped later is not kept, but for the last of it: it may hold for ever

function isSame(a: Uint8Array, b: Uint8Array): boolean {
  return a.byteLength === b.byteLength && a.every((byte, i) => byte === b[i]);
}

export class TopicLog {
  private entries: Entry[] = [];
  private unpacked = new Map<Entry, Message>();
  decode: Decode | string = 'its type is not known yet';
  failures = 0;   // messages that are not what their type says
  failure = '';   // what was wrong with the last of them
  bytes = 0;
  received = 0;  // since it was cleared
  version = 0;   // changes with the entries

  constructor(readonly name: string) {}

  get length() { return this.entries.length; }
  get first() { return this.entries[0]; }
  get last() { return this.entries[this.entries.length - 1]; }
  entry(i: number): Entry | undefined { return this.entries[i]; }

  /// In order of time; several writers of a topic may come out of turn.
  add(entry: Entry) {
    let i = this.entries.length;
    while (i > 0 && this.entries[i - 1]!.t > entry.t) --i;
    // What is kept for late comers is told again after a connection was lost.
    for (let j = i - 1; j >= 0 && this.entries[j]!.t === entry.t; --j) {
      if (isSame(this.entries[j]!.bytes, entry.bytes)) return;
    }
    if (i === this.entries.length) this.entries.push(entry);
    else this.entries.splice(i, 0, entry);
    this.bytes += entry.bytes.byteLength + kOverhead;
    ++this.received;
    ++this.version;
  }

  /// Forgets what is older than `t`, but for the last of those: it still holds.
  forgetBefore(t: number) {
    let count = 0;
    while (count + 1 < this.entries.length && this.entries[count + 1]!.t <= t) ++count;
    this.drop(count);
  }
  drop(count: number) { this.remove(0, count); }
  /// Forgets what was sent after `t`, but for the last message where that is `keepsLast`.
  forgetAfter(t: number, keepsLast: boolean) {
    const from = this.indexAt(t) + 1;
    this.remove(from, this.entries.length - from - (keepsLast ? 1 : 0));
  }
  private remove(from: number, count: number) {
    if (count <= 0) return;
    for (const entry of this.entries.splice(from, count)) {
      this.bytes -= entry.bytes.byteLength + kOverhead;
      this.unpacked.delete(entry);
    }
    ++this.version;
  }
  clear() {
    this.entries = [];
    this.unpacked.clear();
    this.bytes = 0;
    this.received = 0;
    ++this.version;
  }

  /// Index of the last entry that was sent until `t`; -1: there is none.
  indexAt(t: number): number {
    let low = 0, high = this.entries.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.entries[middle]!.t <= t) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
  /// The message of an entry; undefined when it is not what its type says.
  message(entry: Entry | undefined): Message | undefined {
    if (!entry || typeof this.decode === 'string') return undefined;
    const known = this.unpacked.get(entry);
    if (known !== undefined) return known ?? undefined;
    let message: Message;
    try {
      message = this.decode(entry.bytes);
    } catch (error) {
      ++this.failures;  // the next one may be as it should
      this.failure = (error as Error).message;
      message = null;
    }
    if (this.unpacked.size >= kUnpacked) this.unpacked.delete(this.unpacked.keys().next().value!);
    this.unpacked.set(entry, message);
    return message ?? undefined;
  }
  at(t: number): Message | undefined { return this.message(this.entries[this.indexAt(t)]); }
}

export class Store {
  readonly topics = new Map<string, TopicLog>();
  windowS = 60;
  maxBytes = 192e6;
  private readonly clock = new Newest();
  private sinceTrim = 0;
  private toldAhead = new Set<string>();

  /// `tell` is told what is not believed of the stamps.
  constructor(private readonly tell: (text: string) => void = () => {}) {}

  /// [s] of all messages that are believed.
  get newest(): number { return this.clock.t; }

  log(topic: string): TopicLog {
    let log = this.topics.get(topic);
    if (!log) this.topics.set(topic, (log = new TopicLog(topic)));
    return log;
  }
  /// `now`: when it came, by a clock that does not step [s]; without it the stamp is right, as that of a recording.
  add(topic: string, t: number, bytes: Uint8Array, now?: number) {
    this.log(topic).add({t, bytes});
    if (now === undefined) this.clock.take(t);
    else this.hear(topic, t, now);
    if (++this.sinceTrim >= 500) this.trim();
  }
  bytes(): number {
    let sum = 0;
    for (const log of this.topics.values()) sum += log.bytes;
    return sum;
  }
  /// What is too old goes, and when that is not enough the oldest of what takes most.
  trim() {
    this.sinceTrim = 0;
    for (const log of this.topics.values()) {
      log.forgetBefore(this.newest - this.windowS);
      log.forgetAfter(this.newest + kAhead, true);
    }
    while (this.bytes() > this.maxBytes) {
      const largest = [...this.topics.values()].reduce((a, b) => (a.bytes >= b.bytes ? a : b));
      if (largest.length <= 1) break;
      largest.drop(Math.ceil(largest.length / 8));
    }
  }
  /// The earliest time at which something that moves can be shown.
  get oldest(): number {
    let oldest = this.newest;
    for (const log of this.topics.values()) {
      if (log.length > 8) oldest = Math.min(oldest, log.first!.t);
    }
    return Math.max(oldest, this.newest - this.windowS);
  }
  clear() {
    for (const log of this.topics.values()) log.clear();
    this.clock.clear();
    this.toldAhead.clear();
  }

  private hear(topic: string, t: number, now: number) {
    const before = this.newest;
    const verdict = this.clock.hear(t, now);
    const apart = Math.abs(t - before).toFixed(0);
    if (verdict === 'ahead' && !this.toldAhead.has(topic) && this.toldAhead.size < 100) {
      this.toldAhead.add(topic);
      this.tell(`${topic} has messages that are stamped ${apart} s ahead of all others: they are not shown`);
    } else if (verdict === 'forward') {
      this.tell(`the stamps of most messages went ahead by ${apart} s`);
    } else if (verdict === 'back') {
      for (const log of this.topics.values()) log.forgetAfter(this.newest, false);
      this.tell(`the stamps of most messages went back by ${apart} s: what was stamped later is forgotten`);
    }
  }
}
