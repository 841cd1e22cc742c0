// SPDX-License-Identifier: Apache-2.0
// The arms, what they see and what they are after, in three dimensions.
import {
  AmbientLight, Box3, Color, DirectionalLight, GridHelper, Group, HemisphereLight, PerspectiveCamera, Scene,
  Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {kPurple} from '../colours';
import type {Hub} from '../hub';
import {Cameras} from '../scene/cameras';
import {Face} from '../scene/face';
import {Frames, matrixOf} from '../scene/frames';
import {Markers} from '../scene/markers';
import {Robots} from '../scene/robots';
import {ball, dispose, solid} from '../scene/shapes';
import {Tools} from '../scene/tools';
import {Trail} from '../scene/trails';
import {make, write, type Panel, type View} from '../view';

const kViews: [string, string, [number, number, number]][] = [
  ['Front', 'f', [1, 0, 0.15]], ['Side', 's', [0, -1, 0.15]], ['Top', 't', [0.01, 0, 1]],
];

export class ScenePanel implements Panel {
  readonly id = 'scene';
  readonly title = 'Arm';
  readonly element = make('div', {class: 'scene'});
  readonly frames = new Frames();
  readonly robots = new Robots();
  readonly frameTimes: number[] = [];  // [ms] of the last drawings
  private readonly labels = make('div', {class: 'labels', 'aria-hidden': 'true'});
  private readonly canvas = make('canvas', {
    tabindex: 0, role: 'img',
    'aria-label': 'The arm in three dimensions. Drag to turn, wheel or pinch to come nearer. Keys F, S, T: front, side, top; V: as at first.',
  });
  private readonly note = make('p', {class: 'note', role: 'status'});
  private readonly legend = make('ul', {class: 'legend'});
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(40, 1, 0.01, 50);
  private readonly near = new PerspectiveCamera(32, 1, 0.005, 20);
  private readonly inset = make('div', {class: 'inset', hidden: true, 'aria-hidden': 'true'}, 'close-up');
  private readonly cameras = new Cameras();
  private readonly face = new Face();
  private readonly tools = new Tools();
  private readonly bodies = new Group();
  private readonly markersGroup = new Group();
  private readonly trailsGroup = new Group();
  private renderer?: WebGLRenderer;
  private controls?: OrbitControls;
  private markers = new Map<string, Markers>();
  private trails: Trail[] = [];
  private framed = false;
  private hadLinks = false;
  private isTurned = false;  // by hand
  private drawnLook = '';

  constructor() {
    this.scene.background = new Color('#10161f');
    this.scene.add(
        new HemisphereLight('#dfe9f5', '#2a2f38', 1.6), new AmbientLight('#ffffff', 0.35), this.sun(),
        this.floor(), this.robots.group, this.markersGroup, this.trailsGroup, this.cameras.group, this.face.group,
        this.tools.group, this.bodies);
    this.camera.up.set(0, 0, 1);
    this.near.up.set(0, 0, 1);
    this.camera.position.set(2, -2, 1.5);
    const buttons = make('div', {class: 'tools'});
    for (const [name, key, direction] of kViews) {
      buttons.append(this.button(name, key, () => this.lookFrom(new Vector3(...direction))));
    }
    buttons.append(this.button('View', 'v', () => this.lookAsAtFirst()));
    this.element.append(this.canvas, this.labels, this.inset, buttons, this.legend, this.note);
    this.canvas.addEventListener('keydown', (event) => {
      const view = kViews.find(([, key]) => key === event.key.toLowerCase());
      if (view) this.lookFrom(new Vector3(...view[2]));
      if (event.key.toLowerCase() === 'v') this.lookAsAtFirst();
    });
    try {
      this.renderer = new WebGLRenderer({canvas: this.canvas, antialias: true, preserveDrawingBuffer: false});
      this.controls = new OrbitControls(this.camera, this.canvas);
      this.controls.enableDamping = false;
      this.controls.addEventListener('start', () => (this.isTurned = true));
    } catch {
      write(this.note, 'This browser draws nothing in three dimensions (WebGL is missing); everything else works');
    }
  }

  /// At most 30 a second; less often where the page comes round seldom because of it, as without a
  /// graphics card: pictures and curves need the time, too.
  get intervalMs() { return Math.min(250, Math.max(33, 4 * (this.roundMs - 17))); }
  roundMs = 17;  // from one frame of the page to the next, the mean of late
  topics({hub, layout, deployment}: View): string[] {
    const of = (topic: string) => deployment?.topic(topic) ?? topic;
    const descriptions = Robots.descriptions(hub);
    return [
      '/tf', '/tf_static', ...descriptions, ...descriptions.map((topic) => Robots.jointsOf(topic)),
      ...hub.ofType('visualization_msgs/msg/MarkerArray').filter((topic) => this.isOurs(topic, deployment?.namespace)),
      ...Cameras.topics(hub), ...layout.scene.trails.map(({topic}) => of(topic)), ...layout.scene.frames.map(of),
      ...layout.scene.bodies.map(({topic}) => of(topic)), ...(layout.scene.face ? [of(layout.scene.face)] : []),
    ];
  }
  reset({layout, deployment}: View) {
    const of = (topic: string) => deployment?.topic(topic) ?? topic;
    for (const markers of this.markers.values()) markers.clear();
    this.markers.clear();
    for (const trail of this.trails) dispose(trail.group);
    this.trails = layout.scene.trails.map(({topic, colour}) => new Trail(of(topic), colour));
    for (const {group} of this.trails) this.trailsGroup.add(group);
    this.tools.build(layout.scene.tools);
    this.legend.replaceChildren(...layout.scene.trails.map(({label, colour}) => {
      const swatch = make('span', {class: 'swatch'});
      swatch.style.background = colour;
      return make('li', {}, swatch, label);
    }));
    this.framed = false;
  }
  forget(topic: string) {
    for (const trail of this.trails) {
      if (trail.topic === topic) trail.clear();
    }
    this.markers.get(topic)?.clear();
  }

  draw(view: View) {
    const began = performance.now();
    const {hub, layout, deployment, t} = view;
    const of = (topic: string) => deployment?.topic(topic) ?? topic;
    this.frames.update(hub, ['/tf_static', '/tf', ...layout.scene.frames.map(of)], t);
    this.robots.update(hub, this.frames, t, new Set(layout.scene.tools.map(({instead}) => instead ?? '')));
    this.drawMarkers(view);
    for (const trail of this.trails) trail.update(hub, this.frames, t, layout.scene.trailS ?? 20);
    this.cameras.update(hub, this.frames);
    if (layout.scene.face) this.face.update(hub, of(layout.scene.face), this.frames, t);
    this.tools.update(this.frames);
    this.drawBodies(view);
    this.tellMissing(hub);
    this.fit();
    if (!this.framed) this.frame(view);
    const look = this.look();
    if (look !== this.drawnLook) {  // an arm that stands still is drawn once
      this.drawnLook = look;
      this.render(view);
      this.drawLabels(view);
    }
    this.frameTimes.push(performance.now() - began);
    if (this.frameTimes.length > 120) this.frameTimes.shift();
  }
  /// Names of the markers that are shown.
  markerNames(): string[] { return [...this.markers.values()].flatMap((markers) => markers.names()); }

  private isOurs(topic: string, namespace: string | undefined) { return !namespace || topic.startsWith(`${namespace}/`); }
  private drawMarkers({hub, t, deployment, layout}: View) {
    const topics = hub.ofType('visualization_msgs/msg/MarkerArray').filter((topic) => this.isOurs(topic, deployment?.namespace));
    const hasLinks = this.robots.count > 0;
    if (hasLinks !== this.hadLinks) {
      for (const markers of this.markers.values()) markers.clear();
    }
    this.hadLinks = hasLinks;
    const hidden = new Set([...(layout.scene.hide ?? []), ...(layout.scene.face ? ['face'] : []), ...(hasLinks ? ['links'] : [])]);  // the robot's description draws them better
    for (const [topic, markers] of this.markers) {
      if (topics.includes(topic)) continue;
      markers.clear();
      this.markers.delete(topic);
    }
    for (const topic of topics) {
      let markers = this.markers.get(topic);
      if (!markers) {
        this.markers.set(topic, (markers = new Markers(topic)));
        this.markersGroup.add(markers.group);
      }
      markers.update(hub, this.frames, t, hidden);
    }
  }
  /// Bodies that a tracker sees: three axes and a ball each.
  private drawBodies({hub, layout, deployment, t}: View) {
    const wanted = layout.scene.bodies;
    while (this.bodies.children.length < wanted.length) {
      const group = new Group();
      group.add(ball(new Vector3(), 0.012, solid(kPurple)));
      for (const at of [[0.03, 0, 0], [0, 0.03, 0], [-0.025, -0.02, 0]]) {
        group.add(ball(new Vector3(...(at as [number, number, number])), 0.006, solid('#eef2f6')));
      }
      this.bodies.add(group);
    }
    this.bodies.children.forEach((group, i) => {
      const topic = wanted[i]?.topic, message = topic ? hub.at(deployment?.topic(topic) ?? topic, t) : undefined;
      const frame = message?.valid ? this.frames.toRoot(message.header.frame_id) : undefined;
      group.visible = frame !== undefined;
      if (!frame) return;
      frame.multiply(matrixOf(message.pose.position, message.pose.orientation)).decompose(group.position, group.quaternion, group.scale);
    });
  }
  /// Names beside what they name.
  private drawLabels({layout}: View) {
    const wanted = layout.scene.labels ?? [];
    while (this.labels.children.length < wanted.length) this.labels.append(make('span'));
    while (this.labels.children.length > wanted.length) this.labels.lastChild!.remove();
    const width = this.element.clientWidth, height = this.element.clientHeight;
    const placed: {x: number; y: number}[] = [];
    wanted.forEach(({at, text}, i) => {
      const label = this.labels.children[i] as HTMLElement, place = this.whereIs(at);
      const on = place?.project(this.camera);
      label.hidden = !on || on.z > 1 || Math.abs(on.x) > 1 || Math.abs(on.y) > 1;
      if (!on || label.hidden) return;
      write(label, text);
      const x = ((on.x + 1) / 2) * width;
      let y = ((1 - on.y) / 2) * height;
      while (placed.some((other) => Math.abs(other.x - x) < 150 && Math.abs(other.y - y) < 24)) y -= 8;
      placed.push({x, y});
      // None lies on the close-up.
      label.hidden = !this.inset.hidden && x + label.offsetWidth > width - this.inset.offsetWidth - 12 && y > height - this.inset.offsetHeight - 8;
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    });
  }
  private whereIs(at: string): Vector3 | undefined {
    for (const markers of this.markers.values()) {
      const place = markers.place(at);
      if (place) return place;
    }
    const frame = this.frames.toRoot(at);
    return frame && new Vector3().setFromMatrixPosition(frame);
  }
  private tellMissing(hub: Hub) {
    const missing = this.robots.problems();
    if (hub.topics.size > 0 && Robots.descriptions(hub).length === 0) {
      missing.push('No arm can be drawn: nobody tells a /robot_description (the plugin monitor/rviz does)');
    }
    const skipped = [...this.markers.values()].flatMap((markers) => [...markers.skipped]);
    if (skipped.length > 0) missing.push(`Markers that are not drawn: ${[...new Set(skipped)].join(', ')}`);
    if (this.renderer) write(this.note, missing.join('. '));
  }

  private frame({layout}: View) {
    const {eye, target} = layout.scene;
    const box = new Box3().setFromObject(this.robots.group);
    if (box.isEmpty()) box.setFromObject(this.markersGroup);
    if (box.isEmpty()) return;
    const size = box.getSize(new Vector3()).length();
    if (eye && target) {
      this.place(new Vector3(...(eye as [number, number, number])), new Vector3(...(target as [number, number, number])));
    } else {
      const centre = box.getCenter(new Vector3());
      this.place(centre.clone().add(new Vector3(0.8, -1, 0.6).normalize().multiplyScalar(1.45 * size)), centre);
    }
    this.framed = true;
  }
  private place(eye: Vector3, target: Vector3) {
    // A narrow picture shows as much of what is in the middle: from farther away.
    const narrow = Math.max(1, 1.55 / Math.max(0.3, this.camera.aspect));
    this.camera.position.copy(target).add(eye.sub(target).multiplyScalar(narrow));
    this.controls?.target.copy(target);
    this.controls?.update();
  }
  private lookAsAtFirst() {
    this.isTurned = false;
    this.framed = false;
  }
  private lookFrom(direction: Vector3) {
    const box = new Box3().setFromObject(this.robots.group).expandByObject(this.face.group);
    if (box.isEmpty()) return;
    const centre = box.getCenter(new Vector3());
    this.place(centre.clone().add(direction.normalize().multiplyScalar(1.5 * box.getSize(new Vector3()).length())), centre);
    this.framed = true;
    this.isTurned = true;
  }
  /// Differs when what is drawn does.
  private look(): string {
    let sum = 0, weight = 1;
    this.scene.traverseVisible((one) => {
      const {elements} = one.matrixAutoUpdate ? one.matrixWorld : one.matrix;
      for (let i = 0; i < 16; ++i) sum += elements[i]! * (weight = (weight * 1.37) % 7);
      sum += one.id * weight;
    });
    const camera = this.camera.position.toArray().concat(this.controls?.target.toArray() ?? []);
    return [sum.toPrecision(9), ...camera, this.element.clientWidth, this.element.clientHeight,
            ...this.trails.map((trail) => trail.shown)].join();
  }
  /// Takes the size that the page gives it. Who has turned the picture himself keeps his view.
  private fit() {
    const width = this.element.clientWidth, height = this.element.clientHeight;
    const ratio = Math.min(window.devicePixelRatio, 2);
    if (!this.renderer || width === 0 || height === 0) return;
    if (this.canvas.width === Math.floor(width * ratio) && this.canvas.height === Math.floor(height * ratio)) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.isTurned) this.framed = false;
  }
  private render({layout}: View) {
    if (!this.renderer) return;
    const width = this.element.clientWidth, height = this.element.clientHeight;
    if (width === 0 || height === 0) return;
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.render(this.scene, this.camera);
    const {closeUp} = layout.scene, tip = closeUp && this.frames.toRoot(closeUp.frame);
    this.inset.hidden = !tip || width < 420;
    if (!closeUp || !tip || this.inset.hidden) return;
    // A second look from nearby, in a corner.
    const side = Math.round(Math.min(0.36 * width, 0.46 * height)), edge = 8;
    const at = new Vector3().setFromMatrixPosition(tip);
    this.near.position.copy(at).add(new Vector3(...(closeUp.from as [number, number, number])).normalize().multiplyScalar(closeUp.distance));
    this.near.lookAt(at);
    this.inset.style.width = this.inset.style.height = `${side}px`;
    this.renderer.setScissorTest(true);
    this.renderer.setScissor(width - side - edge, edge, side, side);
    this.renderer.setViewport(width - side - edge, edge, side, side);
    this.renderer.render(this.scene, this.near);
    this.renderer.setScissorTest(false);
  }
  private button(name: string, key: string, act: () => void) {
    const button = make('button', {type: 'button', title: `${name} (${key.toUpperCase()})`}, name);
    button.addEventListener('click', act);
    return button;
  }
  private sun() {
    const sun = new DirectionalLight('#ffffff', 1.7);
    sun.position.set(1.5, -2, 3);
    return sun;
  }
  private floor() {
    const grid = new GridHelper(4, 16, '#3a4a5e', '#222d3b');
    grid.rotation.x = Math.PI / 2;
    return grid;
  }
}
