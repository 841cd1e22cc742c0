// SPDX-License-Identifier: Apache-2.0
// The time that is looked at: the newest, or one that was chosen. A recording that a server plays is
// chosen in there: the page shows what comes.
import type {Hub} from './hub';

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4, 8];  // times as fast as it was

export class Playhead {
  private chosen = NaN;  // [s]; NaN: the newest
  private plays = false;  // a recording in the page
  private ownSpeed = 1;
  private lastTick = performance.now();

  constructor(private readonly hub: Hub) {}

  get isLive() { return Number.isNaN(this.chosen) && !this.hub.recording; }
  /// There is a beginning, an end, and a speed.
  get isRecording() { return this.hub.recording !== undefined || this.hub.playback !== undefined; }
  get isPlaying() { return this.hub.playback?.isPlaying ?? this.plays; }
  get start() { return this.hub.recording?.file.start ?? this.hub.playback?.start ?? this.hub.store.oldest; }
  get end() { return this.hub.recording?.file.end ?? this.hub.playback?.end ?? this.hub.store.newest; }
  /// What the panels show.
  get t() {
    if (this.hub.recording && Number.isNaN(this.chosen)) return this.start;
    return Number.isNaN(this.chosen) ? this.hub.store.newest : this.chosen;
  }
  /// Where the bar of time stands.
  get position() { return this.hub.playback?.t ?? this.t; }
  get speed() { return this.hub.playback?.speed ?? this.ownSpeed; }
  set speed(speed: number) {
    if (this.hub.playback) this.hub.playback.setSpeed(speed);
    else this.ownSpeed = speed;
  }
  /// The next one of `kSpeeds`.
  changeSpeed(isFaster: boolean) {
    const {speed} = this;
    const next = isFaster ? kSpeeds.find((one) => one > speed) : kSpeeds.filter((one) => one < speed).at(-1);
    if (this.isRecording && next !== undefined) this.speed = next;
  }

  tick() {
    const now = performance.now(), passed = (now - this.lastTick) / 1000;
    this.lastTick = now;
    if (this.hub.recording) {
      if (this.plays && this.hub.recording.isIdle) this.seek(this.t + passed * this.ownSpeed);
      if (this.t >= this.end) this.plays = false;
      this.hub.recording.lookAt(this.t);
    } else if (!Number.isNaN(this.chosen) && this.chosen < this.start) {
      this.chosen = this.start;
    }
    // What is looked at stays while it is looked at, for three minutes at most.
    if (!this.hub.recording) {
      this.hub.store.windowS = this.isLive ? 60 : Math.min(180, 60 + this.end - this.chosen);
    }
  }
  toggle() {
    if (this.hub.playback) {
      this.hub.playback.toggle();
    } else if (this.hub.recording) {
      if (!this.plays && this.t >= this.end) this.seek(this.start);
      this.plays = !this.plays;
    } else if (this.isLive) {
      this.chosen = this.end;
    } else {
      this.goLive();
    }
  }
  seek(t: number) {
    if (this.hub.playback) this.hub.playback.seek(t);
    else this.chosen = Math.min(this.end, Math.max(this.start, t));
  }
  /// By hand: a recording in the page stops there.
  scrub(t: number) {
    this.plays = false;
    this.seek(t);
  }
  step(seconds: number) { this.scrub(this.position + seconds); }
  goLive() {
    if (this.isRecording) this.seek(this.end);
    else this.chosen = NaN;
  }
  reset() {
    this.chosen = NaN;
    this.plays = !!this.hub.recording;
  }
}
