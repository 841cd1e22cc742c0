// SPDX-License-Identifier: Apache-2.0
// What each camera sees, as a pyramid from its CameraInfo.
import {BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Vector3} from 'three';

import type {Hub} from '../hub';
import {kGrey} from '../colours';
import type {Frames} from './frames';
import {dispose} from './shapes';

const kDepth = 0.16;  // [m] of the pyramid that is drawn

export class Cameras {
  readonly group = new Group();
  private drawn = new Map<string, {version: number; object: LineSegments}>();

  static topics(hub: Hub) { return hub.ofType('sensor_msgs/msg/CameraInfo'); }
  update(hub: Hub, frames: Frames) {
    const topics = Cameras.topics(hub);
    for (const [topic, {object}] of this.drawn) {
      if (topics.includes(topic)) continue;
      dispose(object);
      this.drawn.delete(topic);
    }
    for (const topic of topics) {
      const log = hub.log(topic), info = log.message(log.last);
      if (!info) continue;
      let drawn = this.drawn.get(topic);
      if (drawn?.version !== log.version) {
        if (drawn) dispose(drawn.object);
        this.drawn.set(topic, (drawn = {version: log.version, object: pyramid(info)}));
        this.group.add(drawn.object);
      }
      const frame = frames.toRoot(info.header.frame_id);
      drawn.object.visible = frame !== undefined;
      if (frame) frame.decompose(drawn.object.position, drawn.object.quaternion, drawn.object.scale);
    }
  }
  get count() { return this.drawn.size; }
}

function pyramid(info: {width: number; height: number; p: number[]}): LineSegments {
  const [fx, , cx, tx, , fy, cy] = info.p as [number, number, number, number, number, number, number];
  const centre = new Vector3(-tx / fx, 0, 0);  // of a right camera, in the frame of the left one
  const corner = (u: number, v: number) =>
      new Vector3(((u - cx) / fx) * kDepth, ((v - cy) / fy) * kDepth, kDepth).add(centre);
  const c = [corner(0, 0), corner(info.width, 0), corner(info.width, info.height), corner(0, info.height)];
  const lines: Vector3[] = [];
  c.forEach((one, i) => lines.push(centre, one, one, c[(i + 1) % 4]!));
  return new LineSegments(new BufferGeometry().setFromPoints(lines), new LineBasicMaterial({color: new Color(kGrey), transparent: true, opacity: 0.8}));
}
