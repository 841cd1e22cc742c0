// SPDX-License-Identifier: Apache-2.0
// What time it is for those who send, by the stamps of their messages. One whose clock is ahead is not believed while the
// others go on as before; a clock that most messages go by is, also when it is behind the one before.

const kApart = 5;   // [s] clocks that are this much apart are two
const kProof = 5;   // [s] so long another clock is listened to until it is believed
const kRuns = 2;    // [s] so long a clock has run that is known to run
const kMoves = 1;   // [s] so much its stamps have moved; what is told again with its old stamp moves none

interface Clock {
  t: number;        // [s] the greatest stamp
  heard: number;    // [s] when that came
  firstT: number;   // [s] the first stamp, and when that came
  since: number;
  messages: number;
}

function begin(t: number, now: number): Clock {
  return {t, heard: now, firstT: t, since: now, messages: 1};
}
function hear(clock: Clock, t: number, now: number) {
  ++clock.messages;
  if (t < clock.t) return;
  clock.t = t;
  clock.heard = now;
}
function ran(clock: Clock, least: number): boolean {
  return clock.heard - clock.since >= least && clock.t - clock.firstT >= kMoves;
}

export type Verdict = 'now' | 'past' | 'ahead' | 'forward' | 'back';

export class Newest {
  private clock?: Clock | undefined;
  private other?: Clock | undefined;  // one that may be believed
  private agreed = 0;                 // messages that went by `clock` since `other` was heard first

  get t(): number { return this.clock?.t ?? NaN; }

  /// Takes a stamp without a doubt, as those of a recording.
  take(t: number) {
    if (!this.clock || t > this.clock.t) this.clock = begin(t, NaN);
  }
  /// Takes the stamp of a message that came `now`, by any clock that does not step. 'ahead': it is not believed;
  /// 'forward' and 'back': from now on another clock is.
  hear(t: number, now: number): Verdict {
    const {clock} = this;
    if (!clock || Number.isNaN(clock.heard)) {
      this.clock = begin(t, now);
      return 'now';
    }
    const isAhead = t > clock.t + (now - clock.heard) + kApart;
    if (isAhead && !(ran(clock, kRuns) && now - clock.heard < kProof)) {
      this.clock = begin(t, now);
      this.other = undefined;
      return 'now';
    }
    if (!isAhead && t >= clock.t - kApart) {
      hear(clock, t, now);
      ++this.agreed;
      return 'now';
    }
    return this.hearOther(t, now) ? (isAhead ? 'forward' : 'back') : isAhead ? 'ahead' : 'past';
  }
  clear() {
    this.clock = undefined;
    this.other = undefined;
  }

  /// True when the other clock is the one that is believed now.
  private hearOther(t: number, now: number): boolean {
    const {other} = this;
    const isOld = !other || now - other.heard > kProof;
    if (isOld) {
      this.other = begin(t, now);
      this.agreed = 0;
      return false;
    }
    if (Math.abs(t - other.t - (now - other.heard)) > kApart) return false;
    hear(other, t, now);
    if (!ran(other, kProof) || other.messages <= this.agreed) return false;
    this.clock = other;
    this.other = undefined;
    return true;
  }
}
