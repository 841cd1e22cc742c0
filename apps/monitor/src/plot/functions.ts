// SPDX-License-Identifier: Apache-2.0
// The functions of expressions. Points and vectors are {x, y, z}; a place is a pose (position,
// orientation) or a transform (translation, rotation). Lengths are in metres, angles in degrees.
import {Quaternion, Vector3} from 'three';

import type {Message} from '../message/decoder';

export type Value = Message;
type Apply = (values: Value[], stamp: number) => Value;

const vector = (v: Value) => new Vector3(v?.x ?? NaN, v?.y ?? NaN, v?.z ?? NaN);
const rotation = (q: Value) => new Quaternion(q?.x ?? NaN, q?.y ?? NaN, q?.z ?? NaN, q?.w ?? NaN);
const place = (p: Value) => {
  const one = p?.pose ?? p?.transform ?? p;
  return {at: vector(one?.position ?? one?.translation), turn: rotation(one?.orientation ?? one?.rotation)};
};

function transformed(frame: Value, point: Value): Vector3 {
  const {at, turn} = place(frame);
  return vector(point).applyQuaternion(turn).add(at);
}

function distanceToLine(point: Vector3, start: Vector3, direction: Vector3): number {
  return point.clone().sub(start).cross(direction.clone().normalize()).length();
}

function distanceToSegment(point: Vector3, from: Vector3, to: Vector3): number {
  const way = to.clone().sub(from), length2 = way.lengthSq();
  const s = length2 === 0 ? 0 : Math.min(1, Math.max(0, point.clone().sub(from).dot(way) / length2));
  return point.distanceTo(from.addScaledVector(way, s));
}

/// The frame `to` in the frame `from`, along transforms that each name their parent and child.
function chain(list: Value, from: string, to: string): Value {
  const byChild = new Map<string, Message>();
  for (const one of list?.transforms ?? []) byChild.set(one.child_frame_id, one);
  const at = new Vector3(), turn = new Quaternion();
  for (let frame = to; frame !== from;) {
    const one = byChild.get(frame);
    if (!one) return undefined;
    const step = place(one);
    at.applyQuaternion(step.turn).add(step.at);
    turn.premultiply(step.turn);
    frame = one.header.frame_id;
  }
  return {position: at, orientation: turn};
}

function composed(frames: Value[]): Value {
  const at = new Vector3(), turn = new Quaternion();
  for (const frame of frames) {
    const step = place(frame);
    at.add(step.at.applyQuaternion(turn));
    turn.multiply(step.turn);
  }
  return {position: at, orientation: turn};
}

function inverse(frame: Value): Value {
  const {at, turn} = place(frame);
  turn.invert();
  return {position: at.applyQuaternion(turn).negate(), orientation: turn};
}

const pure = (apply: Apply) => () => apply;

export const functions: Record<string, () => Apply> = {
  abs: pure(([a]) => Math.abs(a)),
  min: pure((values) => Math.min(...values)),
  max: pure((values) => Math.max(...values)),
  norm: pure(([v]) => vector(v).length()),
  /// Of two points.
  distance: pure(([a, b]) => vector(a).distanceTo(vector(b))),
  /// [deg] between two directions.
  angle: pure(([a, b]) => (vector(a).angleTo(vector(b)) * 180) / Math.PI),
  opposite: pure(([v]) => vector(v).negate()),
  /// An axis of a rotation.
  axis_x: pure(([q]) => new Vector3(1, 0, 0).applyQuaternion(rotation(q))),
  axis_z: pure(([q]) => new Vector3(0, 0, 1).applyQuaternion(rotation(q))),
  /// A point of a frame, in the frame that this one stands in.
  transform: pure(([frame, point]) => transformed(frame, point)),
  compose: pure(composed),
  inverse: pure(([frame]) => inverse(frame)),
  chain: pure(([list, from, to]) => chain(list, from, to)),
  /// Of a point from the line through two others.
  off_line: pure(([p, a, b]) => distanceToLine(vector(p), vector(a), vector(b).sub(vector(a)))),
  /// Of the z axis of a place from a point: of a shaft from the incision.
  off_axis: pure(([frame, p]) => {
    const {at, turn} = place(frame);
    return distanceToLine(vector(p), at, new Vector3(0, 0, 1).applyQuaternion(turn));
  }),
  /// Of a point from the nearest of a list of places in a frame.
  nearest: pure(([p, places, frame]) => Math.min(
      ...[...(places ?? [])].map((one) => vector(p?.position ?? p).distanceTo(transformed(frame, one.position ?? one))), Infinity)),
  /// [deg] between an axis and the z axis of the nearest of a list of places in a frame.
  nearest_angle: pure(([pose, places, frame]) => {
    const own = place(pose);
    let best = Infinity, angle = NaN;
    for (const one of places ?? []) {
      const distance = own.at.distanceTo(transformed(frame, one.position));
      if (distance >= best) continue;
      best = distance;
      const axis = new Vector3(0, 0, 1).applyQuaternion(rotation(one.orientation)).applyQuaternion(place(frame).turn);
      angle = (axis.angleTo(new Vector3(0, 0, 1).applyQuaternion(own.turn)) * 180) / Math.PI;
    }
    return angle;
  }),
  /// Of a point from the surfaces of forbidden zones that stand in a frame.
  clearance: pure(([p, zones, frame]) => Math.min(
      ...[...(zones ?? [])].map((zone) => distanceToSegment(
          vector(p), transformed(frame, zone.from), transformed(frame, zone.to)) - zone.radius), Infinity)),
  /// Where a marker of a MarkerArray is, by its namespace.
  marker: pure(([array, ns]) => {
    const found = array?.markers?.find((one: Message) => one.ns === ns && one.action === 0);
    return found?.pose.position;
  }),
  /// How fast a point or a number changes, from one message to the next.
  speed: () => {
    let before: {at: Vector3; stamp: number; value: number} | undefined;
    return ([p], stamp) => {
      const at = typeof p === 'number' ? new Vector3(p, 0, 0) : vector(p);
      if (before && stamp <= before.stamp) return stamp === before.stamp ? before.value : ((before = undefined), NaN);
      const value = before ? at.distanceTo(before.at) / (stamp - before.stamp) : NaN;
      before = {at, stamp, value};
      return value;
    };
  },
};
