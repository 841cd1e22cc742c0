// SPDX-License-Identifier: Apache-2.0
// The face as it is estimated: eyes, mouth and the way it looks, in the frame of the camera.
import {EllipseCurve, Group, Mesh, ShapeGeometry, Shape, Vector3, Matrix4} from 'three';

import {kSky} from '../colours';
import type {Hub} from '../hub';
import {secondsOf, type Message} from '../message/decoder';
import type {Frames} from './frames';
import {arrow, ball, dispose, glow, rod, solid} from './shapes';

const kOldestS = 1;

export class Face {
  readonly group = new Group();
  private drawnStamp = NaN;

  update(hub: Hub, topic: string, frames: Frames, t: number) {
    const face = hub.at(topic, t), stamp = secondsOf(face?.header.stamp);
    this.group.visible = !!face?.valid && t - stamp < kOldestS;
    if (!this.group.visible || stamp === this.drawnStamp) return;
    const toRoot = frames.toRoot(face.header.frame_id);
    this.group.visible = !!toRoot;
    if (!toRoot) return;
    this.drawnStamp = stamp;  // it stays where it was seen while the camera moves on
    toRoot.decompose(this.group.position, this.group.quaternion, this.group.scale);
    for (const child of [...this.group.children]) dispose(child);
    this.group.add(...parts(face));
  }
}

function parts(face: Message) {
  const point = (p: Message) => new Vector3(p.x, p.y, p.z);
  const left = point(face.left_eye), right = point(face.right_eye), mouth = point(face.mouth);
  const normal = point(face.normal).normalize();
  const eyes = left.clone().add(right).multiplyScalar(0.5);
  const across = right.clone().sub(left), width = across.length();
  across.normalize();
  const up = normal.clone().cross(across).normalize();
  if (up.dot(eyes.clone().sub(mouth)) < 0) up.negate();
  const skin = solid('#d8b49c', 0.55), ink = solid(kSky);
  const oval = new Shape(new EllipseCurve(0, 0, 1.15 * width, 1.65 * width).getPoints(48).map((p) => p.clone()));
  const disc = new Mesh(new ShapeGeometry(oval), skin);
  skin.side = 2;
  disc.matrixAutoUpdate = false;
  disc.matrix = new Matrix4().makeBasis(across, up, across.clone().cross(up))
                    .setPosition(eyes.clone().add(mouth).multiplyScalar(0.5).addScaledVector(normal, -0.004));
  const rim = new EllipseCurve(0, 0, 1.15 * width, 1.65 * width).getPoints(48).map(
      (p) => new Vector3(p.x, p.y, 0).applyMatrix4(disc.matrix));
  const outline = new Group(), line = glow(kSky, 0.9);
  for (let i = 1; i < rim.length; ++i) outline.add(rod(rim[i - 1]!, rim[i]!, 0.0018, line));
  return [
    disc, outline,
    ball(left, 0.008, ink), ball(right, 0.008, ink),
    rod(mouth.clone().addScaledVector(across, -0.4 * width), mouth.clone().addScaledVector(across, 0.4 * width), 0.004, ink),
    arrow(mouth, mouth.clone().addScaledVector(normal, 0.15), 0.004, 0.011, 0.03, ink),
  ];
}
