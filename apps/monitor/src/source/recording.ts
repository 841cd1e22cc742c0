// SPDX-License-Identifier: Apache-2.0
// A recording as a source: keeps the messages round the time that is looked at, the seldom ones all.
import type {RecordingFile} from './recording_file';
import type {Source, SourceEvents} from './source';

const kWholeS = 150;     // [s] a recording that is no longer is kept whole
const kWholeReportS = 400;  // [s] the same of a report, which has fewer messages
const kAroundS = 45;     // [s] before and after, of a longer one
const kSeldom = 600;     // messages of a topic that is kept whole: what still holds may be old
const kSettleMs = 200;    // in which the page finds out what it wants
const kSliceMs = 40;     // reading leaves the page time to draw

export class Recording implements Source {
  readonly kind = 'recording';
  from: number;
  to: number;
  /// Nothing is being read.
  isIdle = true;
  private wanted: ReadonlySet<string> = new Set();
  private loaded = new Set<string>();
  private reading: ReadonlySet<string> = new Set();  // those of `loaded` of which the pass that runs brings more
  private wantedAt = 0;  // [ms] when that changed last
  private job = 0;
  private progress = 0;  // of the pass that runs, 0 to 1

  constructor(readonly file: RecordingFile, private readonly events: SourceEvents, isReport = false) {
    const isShort = file.end - file.start <= (isReport ? kWholeReportS : kWholeS);
    this.from = file.start;
    this.to = isShort ? file.end : file.start + 2 * kAroundS;
    events.topics(file.topics);
    this.tell();
  }
  /// All that is wanted is there up to the end.
  get hasEnd() { return this.isIdle && this.to >= this.file.end; }
  want(topics: ReadonlySet<string>) {
    this.wanted = topics;
    this.wantedAt = performance.now();
    const missing = [...topics].filter((topic) => this.file.topics.has(topic) && !this.loaded.has(topic));
    if (missing.length > 0) void this.load();
  }
  /// Moves what is kept so that `t` is in it.
  lookAt(t: number) {
    const nearEdge = (t < this.from + 5 && this.from > this.file.start) ||
                     (t > this.to - 5 && this.to < this.file.end);
    if (!nearEdge) return;
    this.from = Math.max(this.file.start, t - kAroundS);
    this.to = Math.min(this.file.end, t + kAroundS);
    for (const topic of [...this.loaded]) {
      if (this.isSeldom(topic) && !this.reading.has(topic)) continue;
      this.events.forget(topic);
      this.loaded.delete(topic);
    }
    this.reading = new Set();
    ++this.job;
    this.isIdle = true;
    void this.load();
  }
  close() { ++this.job; }

  private isSeldom(topic: string) { return (this.file.topics.get(topic)?.count ?? 0) <= kSeldom; }
  private tell() {
    const {name, messages, topics, remark} = this.file;
    const reading = this.isIdle ? '' : `reading ${(100 * this.progress).toFixed(0)} %: `;
    this.events.condition(
        this.isIdle ? 'read' : 'reading',
        `${reading}${name}: ${messages} messages of ${topics.size} topics${remark ? `. ${remark}` : ''}`);
  }

  /// One after the other, until all that is wanted is there.
  private async load() {
    if (!this.isIdle) return;
    this.isIdle = false;
    const job = ++this.job;
    this.tell();
    try {
      for (;;) {
        // The seldom ones first: they say what else will be looked at, and every pass through the rest
        // unpacks all of it.
        do await new Promise((resolve) => setTimeout(resolve, kSettleMs));
        while (performance.now() - this.wantedAt < kSettleMs);
        if (job !== this.job) return;
        const missing = [...this.wanted].filter((t) => this.file.topics.has(t) && !this.loaded.has(t));
        if (missing.length === 0) break;
        const seldom = new Set(missing.filter((topic) => this.isSeldom(topic)));
        const next = seldom.size > 0 ? seldom : new Set(missing);
        for (const topic of next) this.loaded.add(topic);
        this.reading = next;
        if (seldom.size > 0) await this.read(next, -Infinity, Infinity, job);
        else await this.read(next, this.from, this.to, job);
        if (job !== this.job) return;
        this.reading = new Set();
      }
    } catch (error) {
      this.events.warning(`The recording cannot be read: ${(error as Error).message}`);
    }
    if (job !== this.job) return;
    this.isIdle = true;
    this.tell();
  }
  private async read(topics: ReadonlySet<string>, from: number, to: number, job: number) {
    if (topics.size === 0) return;
    let sliceEnd = performance.now() + kSliceMs;
    for await (const {topic, t, bytes} of this.file.read(topics, from, to)) {
      if (job !== this.job) return;
      this.events.message(topic, t, bytes);
      if (performance.now() < sliceEnd) continue;
      this.progress = Number.isFinite(from) ? (t - from) / (to - from) : 0;
      this.tell();
      await new Promise((resolve) => setTimeout(resolve));
      sliceEnd = performance.now() + kSliceMs;
    }
  }
}
