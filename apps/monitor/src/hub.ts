// SPDX-License-Identifier: Apache-2.0
// Stands between a source and those who look: decodes by type, remembers, and asks the source for
// what somebody looks at and nothing else.
import {decoderOf, type Message} from './message/decoder';
import {Connection} from './source/connection';
import type {Playback} from './source/playback';
import {Recording} from './source/recording';
import type {RecordingFile} from './source/recording_file';
import type {Condition, Source, SourceEvents, TopicInfo} from './source/source';
import {Store, TopicLog} from './store';

const kSoonMs = 2000;  // topics that are told later were not there when the page began

export interface Arrival {
  topic: string;
  t: number;
}

export class Hub {
  readonly store = new Store((text) => this.warn(text));
  topics = new Map<string, TopicInfo>();
  condition: Condition = 'connecting';
  text = '';
  playback?: Playback | undefined;  // of a recording that is played to the page, and to whoever else looks
  source?: Source;
  received = 0;
  firstDataMs = NaN;     // after the page began, or after there was something to see
  topicsVersion = 0;     // changes with the topics
  warnings: string[] = [];  // that nobody has taken yet; of too many the last
  private sinceMs = NaN;
  private wanted = new Set<string>();
  private arrivals: ((arrival: Arrival) => void)[] = [];
  private forgotten: ((topic: string) => void)[] = [];

  connect(url: string) {
    this.leave();
    this.store.windowS = 60;
    this.source = new Connection(url, this.events());
    this.source.want(this.wanted);
  }
  open(file: RecordingFile, isReport = false) {
    this.leave();
    this.store.windowS = Infinity;
    this.source = new Recording(file, this.events(), isReport);
    this.source.want(this.wanted);
  }
  get recording(): Recording | undefined {
    return this.source instanceof Recording ? this.source : undefined;
  }
  onArrival(call: (arrival: Arrival) => void) { this.arrivals.push(call); }
  onForget(call: (topic: string) => void) { this.forgotten.push(call); }

  /// The topics that somebody looks at now.
  want(topics: Set<string>) {
    if (topics.size === this.wanted.size && [...topics].every((topic) => this.wanted.has(topic))) return;
    for (const topic of this.wanted) {
      if (!topics.has(topic) && this.source?.kind === 'live') this.forget(topic);
    }
    this.wanted = topics;
    this.source?.want(topics);
  }
  isWanted(topic: string) { return this.wanted.has(topic); }
  log(topic: string): TopicLog { return this.store.log(topic); }
  at(topic: string, t: number): Message | undefined { return this.store.topics.get(topic)?.at(t); }
  /// Topics of a type, "tf2_msgs/msg/TFMessage", in order of their names.
  ofType(type: string): string[] {
    return [...this.topics.values()].filter((topic) => topic.type === type).map((topic) => topic.name).sort();
  }
  warn(text: string) {
    this.warnings.push(text);
    if (this.warnings.length > 100) this.warnings.shift();
  }

  private leave() {
    this.source?.close();
    this.source = undefined;
    this.playback = undefined;
    this.forgetAll();
    this.topics = new Map();
    ++this.topicsVersion;
    this.warnings = [];
  }
  private forgetAll() {
    for (const topic of this.store.topics.keys()) this.forget(topic);
    this.store.clear();
  }
  private forget(topic: string) {
    this.store.topics.get(topic)?.clear();
    for (const call of this.forgotten) call(topic);
  }
  private events(): SourceEvents {
    return {
      condition: (condition, text) => {
        this.condition = condition;
        this.text = text;
      },
      topics: (topics) => {
        const now = performance.now();
        if (topics.size > 0 && Number.isNaN(this.sinceMs)) this.sinceMs = now < kSoonMs ? 0 : now;
        this.topics = topics;
        ++this.topicsVersion;
        for (const topic of topics.values()) {
          const log = this.store.log(topic.name);
          log.decode = decoderOf(topic.schema);
        }
      },
      message: (topic, t, bytes) => {
        if (Number.isNaN(this.firstDataMs)) this.firstDataMs = performance.now() - this.sinceMs;
        ++this.received;
        const isLive = this.source?.kind === 'live' && !this.playback;
        this.store.add(topic, t, bytes, isLive ? performance.now() / 1000 : undefined);
        for (const call of this.arrivals) call({topic, t});
      },
      forget: (topic) => this.forget(topic),
      played: (playback) => {
        this.playback = playback;
      },
      jumped: () => this.forgetAll(),
      warning: (text) => this.warn(text),
    };
  }
}
