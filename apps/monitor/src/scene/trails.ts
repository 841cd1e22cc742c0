// SPDX-License-Identifier: Apache-2.0
// The way that a pose has come lately.
import {BufferAttribute, BufferGeometry, Color, Group, Line, LineBasicMaterial, Vector3} from 'three';

import type {Hub} from '../hub';
import type {Frames} from './frames';

const kMaxPoints = 3000;
const kStep = 0.0005;  // [m] that a point is from the one before, at least

export class Trail {
  readonly group = new Group();
  shown = '';  // which of its points
  private times: number[] = [];
  private positions = new Float32Array(3 * kMaxPoints);
  private count = 0;
  private geometry = new BufferGeometry();
  private seenTo = -Infinity;
  private seenFrom = Infinity;

  constructor(readonly topic: string, colour: string) {
    this.geometry.setAttribute('position', new BufferAttribute(this.positions, 3));
    const line = new Line(this.geometry, new LineBasicMaterial({color: new Color(colour), transparent: true, opacity: 0.9}));
    line.frustumCulled = false;
    this.group.add(line);
  }
  clear() {
    this.count = 0;
    this.times = [];
    this.seenTo = -Infinity;
    this.seenFrom = Infinity;
  }
  /// Points until `t`; returns how many are shown.
  update(hub: Hub, frames: Frames, t: number, shownS: number): number {
    const log = hub.log(this.topic);
    if (log.length === 0) return 0;
    if (log.first!.t < this.seenFrom - 1) this.clear();  // older ones have been read meanwhile
    this.seenFrom = Math.min(this.seenFrom, log.first!.t);
    for (let i = log.indexAt(this.seenTo) + 1; i < log.length; ++i) {
      const entry = log.entry(i)!, message = log.message(entry);
      this.seenTo = entry.t;
      const p = message?.pose?.position;
      if (!p || !Number.isFinite(p.x + p.y + p.z)) continue;
      this.add(entry.t, p.x, p.y, p.z);
    }
    let shown = this.times.length;
    while (shown > 0 && this.times[shown - 1]! > t) --shown;
    let from = 0;
    while (from < shown && this.times[from]! < t - shownS) ++from;
    this.geometry.setDrawRange(from, shown - from);
    this.shown = `${this.times[from]} ${shown - from}`;
    this.geometry.attributes.position!.needsUpdate = true;
    const frame = log.message(log.last)?.header?.frame_id ?? '';
    const toRoot = frames.toRoot(frame);
    this.group.visible = shown > from;
    if (toRoot) toRoot.decompose(this.group.position, this.group.quaternion, this.group.scale);
    return shown - from;
  }
  private add(t: number, x: number, y: number, z: number) {
    const last = 3 * (this.count - 1);
    if (this.count > 0) {
      const step = new Vector3(x - this.positions[last]!, y - this.positions[last + 1]!, z - this.positions[last + 2]!);
      if (step.length() < kStep) return;
    }
    if (this.count === kMaxPoints) {  // the older half is forgotten
      const kept = kMaxPoints / 2;
      this.positions.copyWithin(0, 3 * kept);
      this.times = this.times.slice(kept);
      this.count = kept;
    }
    this.positions.set([x, y, z], 3 * this.count++);
    this.times.push(t);
  }
}
