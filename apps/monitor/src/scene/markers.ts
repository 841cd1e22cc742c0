// SPDX-License-Identifier: Apache-2.0
// Draws visualization_msgs/MarkerArray: what the deployment shows of plans, targets and zones.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DoubleSide, Group, LineBasicMaterial,
  LineSegments, Mesh, MeshBasicMaterial, MeshStandardMaterial, Object3D, Points, PointsMaterial,
  SphereGeometry, Vector3,
} from 'three';
import {ConvexGeometry} from 'three/addons/geometries/ConvexGeometry.js';

import type {Hub} from '../hub';
import type {Message} from '../message/decoder';
import {matrixOf, type Frames} from './frames';
import {arrow, ball, dispose, glow, rod, solid} from './shapes';

const kAdd = 0, kDeleteAll = 3;
const kReplay = 30;  // messages that are applied again after a jump back

interface Drawn {
  marker: Message;
  object: Object3D;
}

export class Markers {
  readonly group = new Group();
  skipped = new Set<string>();  // types that are not drawn
  private drawn = new Map<string, Drawn>();
  private appliedTo = NaN;

  constructor(private readonly topic: string) {}

  /// Whether something has changed. `hidden`: namespaces that something else draws.
  update(hub: Hub, frames: Frames, t: number, hidden: ReadonlySet<string>): boolean {
    const log = hub.log(this.topic), newest = log.indexAt(t);
    let changed = false;
    const before = this.appliedTo;
    let from = newest;
    if (newest < 0 || !(t >= before)) {
      changed = this.drawn.size > 0;
      this.clear();
      from = Math.max(0, newest - kReplay);
    } else {
      while (from >= 0 && log.entry(from)!.t > before) --from;
      ++from;
    }
    for (let i = Math.max(from, newest - kReplay); i >= 0 && i <= newest; ++i) {
      for (const marker of log.message(log.entry(i))?.markers ?? []) this.apply(marker, hidden);
      changed = true;
    }
    this.appliedTo = newest >= 0 ? log.entry(newest)!.t : NaN;
    for (const {marker, object} of this.drawn.values()) {
      const frame = frames.toRoot(marker.header.frame_id || 'base');
      object.visible = frame !== undefined;
      if (!frame) continue;
      object.matrix.multiplyMatrices(frame, matrixOf(marker.pose.position, marker.pose.orientation));
    }
    return changed;
  }
  /// Where a marker is; undefined: it is not there.
  place(key: string): Vector3 | undefined {
    const object = this.drawn.get(key)?.object;
    return object?.visible ? new Vector3().setFromMatrixPosition(object.matrix) : undefined;
  }
  names(): string[] { return [...this.drawn.keys()]; }
  clear() {
    for (const {object} of this.drawn.values()) dispose(object);
    this.drawn.clear();
    this.appliedTo = NaN;
  }

  private apply(marker: Message, hidden: ReadonlySet<string>) {
    if (marker.action === kDeleteAll) {
      for (const [key, {object}] of this.drawn) {
        dispose(object);
        this.drawn.delete(key);
      }
      return;
    }
    const key = `${marker.ns}/${marker.id}`;
    if (hidden.has(marker.ns) || hidden.has(key)) return;
    const old = this.drawn.get(key);
    if (old && marker.action === kAdd && isSame(old.marker, marker)) {
      old.marker = marker;  // it may have moved
      return;
    }
    if (old) dispose(old.object);
    this.drawn.delete(key);
    if (marker.action !== kAdd || !isFinite(marker)) return;
    const object = this.build(marker);
    if (!object) return;
    object.matrixAutoUpdate = false;
    object.name = key;
    this.group.add(object);
    this.drawn.set(key, {marker, object});
  }

  private build(marker: Message): Object3D | undefined {
    const c = marker.color, s = marker.scale;
    const colour = new Color().setRGB(c.r, c.g, c.b, 'srgb');
    const material = solid(colour, c.a);
    const points = (marker.points as Message[]).map((p) => new Vector3(p.x, p.y, p.z));
    switch (marker.type) {
      case 0: {
        const group = new Group();
        if (points.length === 2) {
          group.add(arrow(points[0]!, points[1]!, s.x / 2, Math.max(s.y / 2, s.x), s.z > 0 ? s.z : 4 * s.x, material));
        } else {
          group.add(arrow(new Vector3(), new Vector3(s.x, 0, 0), s.y / 2, s.y, 0.25 * s.x, material));
        }
        return group;
      }
      case 1: return inGroup(scaled(new BoxGeometry(1, 1, 1), material, s));
      case 2: return inGroup(scaled(new SphereGeometry(0.5, 24, 16), material, s));
      case 3: {
        const geometry = new CylinderGeometry(0.5, 0.5, 1, 24).rotateX(Math.PI / 2);
        return inGroup(scaled(geometry, material, s));
      }
      case 4: return strip(points, s.x, glow(colour, Math.max(0.6, c.a)));
      case 5: return pairs(points, colour);
      case 6: return many(points, () => scaled(new BoxGeometry(1, 1, 1), material, s));
      case 7: {
        const group = many(points, () => ball(new Vector3(), s.x / 2, material));
        // The hull of the balls on a head or a jaw: it shows where that is.
        if (points.length >= 5) group.add(new Mesh(new ConvexGeometry(points), glow(colour, 0.1)));
        return group;
      }
      case 8: {
        const geometry = new BufferGeometry().setFromPoints(points);
        return inGroup(new Points(geometry, new PointsMaterial({color: colour, size: s.x})));
      }
      case 11: return inGroup(triangles(points, colour, c.a));
      default: this.skipped.add(marker.type === 9 ? 'text' : marker.type === 10 ? 'mesh' : `type ${marker.type}`);
    }
    return undefined;
  }
}

/// The shape is the same: only its place may differ.
function isSame(a: Message, b: Message): boolean {
  if (a.type !== b.type || a.points.length !== b.points.length) return false;
  for (const axis of ['x', 'y', 'z']) {
    if (a.scale[axis] !== b.scale[axis]) return false;
  }
  if (a.color.r !== b.color.r || a.color.g !== b.color.g || a.color.b !== b.color.b || a.color.a !== b.color.a) return false;
  for (let i = 0; i < a.points.length; ++i) {
    if (a.points[i].x !== b.points[i].x || a.points[i].y !== b.points[i].y || a.points[i].z !== b.points[i].z) return false;
  }
  return true;
}

function isFinite(marker: Message): boolean {
  const {position: p, orientation: q} = marker.pose;
  return [p.x, p.y, p.z, q.x, q.y, q.z, q.w].every(Number.isFinite) &&
         marker.points.every((one: Message) => Number.isFinite(one.x + one.y + one.z));
}

function scaled(geometry: BufferGeometry, material: MeshStandardMaterial, s: Message): Mesh {
  const mesh = new Mesh(geometry, material);
  mesh.scale.set(s.x || 1e-6, s.y || 1e-6, s.z || 1e-6);
  return mesh;
}
function inGroup(object: Object3D): Group {
  const group = new Group();
  group.add(object);
  return group;
}
function many(points: Vector3[], build: () => Mesh): Group {
  const group = new Group();
  for (const point of points) {
    const mesh = build();
    mesh.position.copy(point);
    group.add(mesh);
  }
  return group;
}
function strip(points: Vector3[], width: number, material: MeshBasicMaterial): Group {
  const group = new Group();
  for (let i = 1; i < points.length; ++i) {
    if (points[i]!.distanceTo(points[i - 1]!) > 1e-9) group.add(rod(points[i - 1]!, points[i]!, width / 2, material));
  }
  return group;
}
function pairs(points: Vector3[], colour: Color): Object3D {
  return inGroup(new LineSegments(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({color: colour})));
}
/// A cone of light is one of these: seen from both sides, and through.
function triangles(points: Vector3[], colour: Color, alpha: number): Mesh {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(points.flatMap((p) => [p.x, p.y, p.z])), 3));
  geometry.computeVertexNormals();
  const material = alpha < 1 ? glow(colour, alpha * 0.8) : new MeshStandardMaterial({color: colour, side: DoubleSide});
  return new Mesh(geometry, material);
}

