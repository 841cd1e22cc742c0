// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry, Color, ConeGeometry, CylinderGeometry, DoubleSide, Group, type Material, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, Object3D, Quaternion, SphereGeometry, Vector3,
} from 'three';

export function solid(colour: string | Color, opacity = 1, roughness = 0.55): MeshStandardMaterial {
  return new MeshStandardMaterial({
    color: colour, roughness, metalness: 0.1, transparent: opacity < 1, opacity, depthWrite: opacity === 1,
  });
}
/// A surface that shines by itself, seen from both sides.
export function glow(colour: string | Color, opacity: number): MeshBasicMaterial {
  return new MeshBasicMaterial({color: colour, transparent: true, opacity, side: DoubleSide, depthWrite: false});
}

/// A cylinder from one point to another.
export function rod(from: Vector3, to: Vector3, radius: number, material: Material, end = radius): Mesh {
  const way = to.clone().sub(from), length = way.length();
  const mesh = new Mesh(new CylinderGeometry(end, radius, Math.max(length, 1e-6), 20), material);
  mesh.position.copy(from).addScaledVector(way, 0.5);
  if (length > 0) mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), way.normalize());
  return mesh;
}
export function ball(at: Vector3, radius: number, material: Material): Mesh {
  const mesh = new Mesh(new SphereGeometry(radius, 20, 14), material);
  mesh.position.copy(at);
  return mesh;
}
export function arrow(from: Vector3, to: Vector3, radius: number, head: number, headLength: number, material: Material): Group {
  const group = new Group(), way = to.clone().sub(from), length = way.length();
  if (!(length > 0)) return group;
  const tip = Math.min(headLength, 0.6 * length);
  group.add(rod(from, to.clone().addScaledVector(way.clone().normalize(), -tip), radius, material));
  const cone = new Mesh(new ConeGeometry(head, tip, 20), material);
  cone.position.copy(to).addScaledVector(way.clone().normalize(), -tip / 2);
  cone.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), way.normalize()));
  group.add(cone);
  return group;
}

/// Gives back what a drawn thing holds on the graphics card.
export function dispose(object: Object3D) {
  object.traverse((one) => {
    const mesh = one as Mesh;
    if (mesh.geometry instanceof BufferGeometry) mesh.geometry.dispose();
    const material = mesh.material as Material | Material[] | undefined;
    for (const single of Array.isArray(material) ? material : material ? [material] : []) single.dispose();
  });
  object.removeFromParent();
}
