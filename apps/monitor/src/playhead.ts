// SPDX-License-Identifier: Apache-2.0
// The time that is looked at: the newest, or one that was chosen.
import type {Hub} from './hub';

export class Playhead {
  private chosen = NaN;  // [s]; NaN: the newest
  isPlaying = false;     // of a recording
  speed = 1;
  private lastTick = performance.now();

  constructor(private readonly hub: Hub) {}

  get isLive() { return Number.isNaN(this.chosen) && !this.hub.recording; }
  get start() { return this.hub.recording?.file.start ?? this.hub.store.oldest; }
  get end() { return this.hub.recording?.file.end ?? this.hub.store.newest; }
  get t() {
    if (this.hub.recording && Number.isNaN(this.chosen)) return this.start;
    return Number.isNaN(this.chosen) ? this.end : this.chosen;
  }

  tick() {
    const now = performance.now(), passed = (now - this.lastTick) / 1000;
    this.lastTick = now;
    if (this.hub.recording) {
      if (this.isPlaying && this.hub.recording.isIdle) this.seek(this.t + passed * this.speed);
      if (this.t >= this.end) this.isPlaying = false;
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
    if (this.hub.recording) {
      if (!this.isPlaying && this.t >= this.end) this.seek(this.start);
      this.isPlaying = !this.isPlaying;
    } else if (this.isLive) {
      this.chosen = this.end;
    } else {
      this.goLive();
    }
  }
  seek(t: number) { this.chosen = Math.min(this.end, Math.max(this.start, t)); }
  step(seconds: number) {
    this.isPlaying = false;
    this.seek(this.t + seconds);
  }
  goLive() {
    if (this.hub.recording) this.seek(this.end);
    else this.chosen = NaN;
  }
  reset() {
    this.chosen = NaN;
    this.isPlaying = !!this.hub.recording;
  }
}
