// SPDX-License-Identifier: Apache-2.0
// The arms, from their robot descriptions and moved by their joint states.
import {Color, type CylinderGeometry, Group, Matrix4, Mesh, MeshStandardMaterial, Object3D} from 'three';
import URDFLoader, {type URDFRobot} from 'urdf-loader';

import type {Hub} from '../hub';
import type {Frames} from './frames';
import {dispose} from './shapes';

const kType = 'std_msgs/msg/String';
const kEnd = 'robot_description';

interface Arm {
  topic: string;
  version: number;
  robot?: URDFRobot;
  problem: string;
}

export class Robots {
  readonly group = new Group();
  private arms = new Map<string, Arm>();

  static descriptions(hub: Hub): string[] {
    return hub.ofType(kType).filter((topic) => topic.endsWith(`/${kEnd}`));
  }
  static jointsOf(description: string) { return description.slice(0, -kEnd.length) + 'joint_states'; }

  /// Whether something has changed.
  update(hub: Hub, frames: Frames, t: number, hiddenLinks: ReadonlySet<string>): boolean {
    let changed = false;
    const there = Robots.descriptions(hub);
    for (const [topic, arm] of this.arms) {
      if (there.includes(topic)) continue;
      if (arm.robot) dispose(arm.robot);
      this.arms.delete(topic);
      changed = true;
    }
    for (const topic of there) changed = this.updateArm(topic, hub, frames, t) || changed;
    for (const [name, link] of this.links()) {
      for (const part of link.children) {
        if ((part as {isURDFVisual?: boolean}).isURDFVisual) part.visible = !hiddenLinks.has(name);
      }
    }
    return changed;
  }
  /// What is missing, for those who look.
  problems(): string[] {
    return [...this.arms.values()].filter((arm) => arm.problem).map((arm) => `${arm.topic}: ${arm.problem}`);
  }
  get count() { return [...this.arms.values()].filter((arm) => arm.robot).length; }
  robots(): URDFRobot[] { return [...this.arms.values()].flatMap((arm) => arm.robot ?? []); }
  /// Links by their names, of all arms.
  links(): Map<string, Object3D> {
    const links = new Map<string, Object3D>();
    for (const robot of this.robots()) {
      for (const [name, link] of Object.entries(robot.links)) links.set(name, link as Object3D);
    }
    return links;
  }

  private updateArm(topic: string, hub: Hub, frames: Frames, t: number): boolean {
    const log = hub.log(topic);
    let arm = this.arms.get(topic);
    if (!arm) this.arms.set(topic, (arm = {topic, version: -1, problem: 'not told yet'}));
    if (arm.version !== log.version) {
      arm.version = log.version;
      this.build(arm, log.message(log.last)?.data);
    }
    if (!arm.robot) return false;
    const joints = hub.at(Robots.jointsOf(topic), t);
    if (joints) {
      const values: Record<string, number> = {};
      (joints.name as string[]).forEach((name, i) => {
        const value = joints.position[i];
        if (Number.isFinite(value)) values[name] = value;
      });
      arm.robot.setJointValues(values);
    }
    const base = frames.toRoot(rootLink(arm.robot)) ?? new Matrix4();
    base.decompose(arm.robot.position, arm.robot.quaternion, arm.robot.scale);
    arm.robot.updateMatrixWorld(true);
    return true;
  }
  private build(arm: Arm, text: string | undefined) {
    if (arm.robot) dispose(arm.robot);
    arm.robot = undefined;
    if (text === undefined) {
      arm.problem = 'not told yet';
      return;
    }
    try {
      const loader = new URDFLoader();
      loader.parseCollision = false;
      loader.loadMeshCb = (_path, _manager, _material, done) => done(new Object3D());  // the page loads nothing
      arm.robot = loader.parse(text);
      for (const joint of Object.values(arm.robot.joints)) joint.ignoreLimits = true;  // it is where it is
      paint(arm.robot);
      this.group.add(arm.robot);
      arm.problem = '';
    } catch (error) {
      arm.problem = `cannot be drawn: ${(error as Error).message}`;
    }
  }
}

function rootLink(robot: URDFRobot): string {
  const children = new Set<string>();
  for (const joint of Object.values(robot.joints)) {
    for (const child of joint.children) children.add((child as unknown as {urdfName?: string}).urdfName ?? child.name);
  }
  return Object.keys(robot.links).find((name) => !children.has(name)) ?? robot.urdfName;
}

/// Links light, joints dark: a joint is the thicker cylinder.
function paint(robot: URDFRobot) {
  const lightLink = new MeshStandardMaterial({color: new Color('#c9d2dd'), roughness: 0.45, metalness: 0.15});
  const darkJoint = new MeshStandardMaterial({color: new Color('#3d5f8c'), roughness: 0.4, metalness: 0.25});
  let thinnest = Infinity;
  const radius = (mesh: Mesh) => ((mesh.geometry as CylinderGeometry).parameters?.radiusTop ?? NaN) * mesh.scale.x;
  robot.traverse((one) => {
    if (one instanceof Mesh && radius(one) > 0) thinnest = Math.min(thinnest, radius(one));
  });
  robot.traverse((one) => {
    if (one instanceof Mesh) one.material = radius(one) > 1.2 * thinnest || !(radius(one) > 0) ? darkJoint : lightLink;
  });
}
