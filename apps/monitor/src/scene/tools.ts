// SPDX-License-Identifier: Apache-2.0
// What the arm carries. No topic tells its shape, only the frame of its tip: it is a sketch.
import {ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Vector3} from 'three';

import {kYellow} from '../colours';
import type {Tool} from '../layouts/layout';
import type {Frames} from './frames';
import {dispose, glow, rod} from './shapes';

export class Tools {
  readonly group = new Group();
  private parts: {tool: Tool; object: Group; neck: Group}[] = [];

  build(tools: Tool[]) {
    for (const {object} of this.parts) dispose(object);
    this.parts = tools.map((tool) => {
      const object = new Group(), neck = new Group();
      object.add(shapeOf(tool), neck);
      this.group.add(object);
      return {tool, object, neck};
    });
  }
  update(frames: Frames) {
    for (const {tool, object, neck} of this.parts) {
      const toRoot = frames.toRoot(tool.frame);
      object.visible = toRoot !== undefined;
      if (!toRoot) continue;
      toRoot.decompose(object.position, object.quaternion, object.scale);
      if (neck.children.length === 0 && tool.kind !== 'lamp') addNeck(neck, tool, frames);
    }
  }
}

const steel = () => new MeshStandardMaterial({color: '#dfe6ee', metalness: 0.6, roughness: 0.3});

function shapeOf(tool: Tool): Group {
  const group = new Group(), length = tool.length ?? 0.05;
  const along = (from: number, to: number, radius: number, end = radius) =>
      rod(new Vector3(0, 0, from), new Vector3(0, 0, to), radius, steel(), end);
  if (tool.kind === 'lamp') {
    const shell = new Mesh(new CylinderGeometry(0.13, 0.09, 0.06, 40), new MeshStandardMaterial({color: '#c9d2dd', metalness: 0.3, roughness: 0.4}));
    shell.rotation.z = -Math.PI / 2;
    shell.position.x = -0.03;
    const glass = new Mesh(new CylinderGeometry(0.115, 0.115, 0.004, 40), glow('#fff4c2', 0.95));
    glass.rotation.z = -Math.PI / 2;
    glass.position.x = 0.003;
    group.add(shell, glass);
  } else if (tool.kind === 'drill') {
    group.add(along(-length, -0.012, 0.004), along(-0.012, 0, 0.0022, 0.0006));
  } else if (tool.kind === 'needle') {
    group.add(along(-length, -0.006, 0.0016), along(-0.006, 0, 0.0016, 0.0001));
  } else {
    group.add(along(-length, -0.015, 0.004), along(-0.015, 0, 0.004, 0.0015));
  }
  if (tool.kind !== 'lamp') {
    const tip = new Mesh(new ConeGeometry(0.0035, 0.008, 16), new MeshStandardMaterial({color: kYellow, roughness: 0.4}));
    tip.rotation.x = Math.PI / 2;
    tip.position.z = -0.004;
    group.add(tip);
  }
  return group;
}

/// From the flange to the tool's back end.
function addNeck(neck: Group, tool: Tool, frames: Frames) {
  const parent = frames.parentOf(tool.frame), flange = parent && frames.toRoot(parent), own = frames.toRoot(tool.frame);
  if (!flange || !own) return;
  const from = new Vector3().setFromMatrixPosition(own.clone().invert().multiply(flange));
  const to = new Vector3(0, 0, -(tool.length ?? 0.05));
  if (from.distanceTo(to) < 0.01 || from.length() < 0.02) return;
  neck.add(rod(from, to, 0.02, new MeshStandardMaterial({color: '#9fb0c3', roughness: 0.4, metalness: 0.3}), 0.008));
}
