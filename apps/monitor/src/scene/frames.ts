// SPDX-License-Identifier: Apache-2.0
// The tree of frames at a time, from the transforms that are told.
import {Matrix4, Quaternion, Vector3} from 'three';

import type {Hub} from '../hub';
import type {Message} from '../message/decoder';

const kLookBack = 80;   // messages of a topic, for several writers
const kOldestS = 2;     // of a frame that moves

interface Branch {
  parent: string;
  matrix: Matrix4;
}

export class Frames {
  private branches = new Map<string, Branch>();

  /// `topics`: of messages with transforms; those that hold for ever are the seldom ones.
  update(hub: Hub, topics: Iterable<string>, t: number) {
    this.branches.clear();
    for (const topic of topics) {
      const log = hub.log(topic);
      const isStatic = topic.endsWith('_static') || log.length < 10;
      const newest = isStatic ? log.length - 1 : log.indexAt(t);
      for (let i = newest; i >= 0 && i > newest - kLookBack; --i) {
        const entry = log.entry(i)!;
        if (!isStatic && entry.t < t - kOldestS) break;
        const before = this.branches.size;
        this.add(log.message(entry));
        if (!isStatic && this.branches.size === before && i < newest - 4) break;
      }
    }
  }
  /// From a frame to the root of its tree; undefined: nobody has told of it.
  toRoot(frame: string): Matrix4 | undefined {
    const matrix = new Matrix4();
    let at = frame.replace(/^\//, ''), known = this.isKnown(at);
    if (!known) return undefined;
    for (let depth = 0; depth < 100; ++depth) {
      const branch = this.branches.get(at);
      if (!branch) return matrix;
      matrix.premultiply(branch.matrix);
      at = branch.parent;
    }
    return undefined;  // it goes round in a circle
  }
  parentOf(frame: string) { return this.branches.get(frame)?.parent; }
  names() { return [...this.branches.keys()]; }
  private isKnown(frame: string) {
    if (this.branches.has(frame)) return true;
    for (const branch of this.branches.values()) {
      if (branch.parent === frame) return true;
    }
    return false;
  }
  private add(message: Message | undefined) {
    for (const one of message?.transforms ?? (message?.transform ? [message] : [])) {
      if (this.branches.has(one.child_frame_id)) continue;
      this.branches.set(one.child_frame_id, {
        parent: one.header.frame_id,
        matrix: matrixOf(one.transform.translation, one.transform.rotation),
      });
    }
  }
}

export function matrixOf(p: Message, q: Message): Matrix4 {
  return new Matrix4().compose(
      new Vector3(p.x, p.y, p.z), new Quaternion(q.x, q.y, q.z, q.w).normalize(), new Vector3(1, 1, 1));
}
