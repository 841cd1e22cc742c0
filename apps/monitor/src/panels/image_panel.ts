// SPDX-License-Identifier: Apache-2.0
// A camera's pictures, with what was found in them drawn over.
import {kGreen, kOrange, kSky, kYellow} from '../colours';
import type {Hub} from '../hub';
import type {Message} from '../message/decoder';
import type {ImageLayout} from '../layouts/layout';
import {make, write, type Panel, type View} from '../view';
import {rawPixels} from './raw_image';

const kRaw = 'sensor_msgs/msg/Image', kCompressed = 'sensor_msgs/msg/CompressedImage';
const kLatestLandmarksS = 0.6;  // that a picture waits for what is found in it
const kAxisLength = 0.06;       // [m] of a face's axes

/// Groups of the 68 landmarks of iBUG that belong together.
const kIbug68: [number, number, boolean][] = [
  [0, 16, false], [17, 21, false], [22, 26, false], [27, 30, false], [31, 35, false], [36, 41, true],
  [42, 47, true], [48, 59, true], [60, 67, true],
];

function stampOf(message: Message | undefined): string {
  const {sec, nsec} = message?.header.stamp ?? {};
  return `${sec}.${nsec}`;
}

export class ImagePanel implements Panel {
  readonly element = make('div', {class: 'image'});
  readonly intervalMs = 33;
  readonly title: string;
  pictures = 0;           // drawn
  landmarks = 0;          // drawn over the last one
  private readonly canvas = make('canvas', {role: 'img'});
  private readonly note = make('p', {class: 'note', role: 'status'});
  private readonly caption = make('p', {class: 'caption'});
  private shown: unknown;
  private isBusy = false;
  private arrivals: number[] = [];
  private scale = 1;  // pixels of the canvas for one of the camera

  constructor(readonly id: string, private readonly layout: ImageLayout) {
    this.title = layout.title;
    this.canvas.setAttribute('aria-label', `Picture: ${layout.title}`);
    this.element.append(this.canvas, this.caption, this.note);
  }

  topics({hub, deployment}: View): string[] {
    const of = (topic: string) => deployment?.topic(topic) ?? topic;
    const topics = [this.picture(hub, of(this.layout.image))?.topic ?? ''];
    if (this.layout.side) {
      topics.push(of('landmarks'), of('face'), of(this.layout.image.replace(/image_raw$/, 'camera_info')));
    }
    return topics.filter((topic) => hub.topics.has(topic));
  }
  /// The compressed pictures where there are such.
  private picture(hub: Hub, raw: string): {topic: string; compressed: boolean} | undefined {
    const compressed = `${raw}/compressed`;
    if (hub.topics.get(compressed)?.type === kCompressed) return {topic: compressed, compressed: true};
    if (hub.topics.get(raw)?.type === kRaw) return {topic: raw, compressed: false};
    return undefined;
  }

  draw(view: View) {
    const {hub, deployment, t} = view;
    const of = (topic: string) => deployment?.topic(topic) ?? topic;
    const raw = of(this.layout.image), source = this.picture(hub, raw);
    if (!source) {
      write(this.note, hub.topics.size > 0 ? `There is no picture ${raw}` : '');
      return;
    }
    const log = hub.log(source.topic);
    let index = log.indexAt(t), found: Message | undefined;
    if (index < 0) {
      write(this.note, typeof log.decode === 'string' ? log.decode : 'No picture has come yet');
      return;
    }
    if (this.layout.side) {
      // The newest picture that has been looked through already, unless that takes too long.
      const results = this.resultsBy(view), newest = log.entry(index)!.t;
      for (let i = index; i >= 0 && log.entry(i)!.t > newest - kLatestLandmarksS; --i) {
        found = results.get(stampOf(log.message(log.entry(i))));
        if (!found) continue;
        index = i;
        break;
      }
    }
    const entry = log.entry(index)!, message = log.message(entry);
    if (!message || this.shown === entry || this.isBusy) return;
    this.isBusy = true;
    const over = {found, face: this.faceAt(view, found), info: this.infoOf(view)};
    void this.paint(message, source.compressed, over).then((problem) => {
      this.isBusy = false;
      this.shown = entry;
      ++this.pictures;
      write(this.note, problem);
      this.tellRate(source.compressed);
    });
  }
  reset() { this.shown = undefined; }
  get rateHz() {
    const n = this.arrivals.length;
    return n < 2 ? 0 : ((n - 1) * 1000) / (this.arrivals[n - 1]! - this.arrivals[0]!);
  }

  /// What was found lately, by the stamp of the picture.
  private resultsBy({hub, deployment, t}: View): Map<string, Message> {
    const results = new Map<string, Message>();
    const faces = new Set<string>();
    const lately = (topic: string, take: (message: Message) => void) => {
      const one = hub.log(deployment?.topic(topic) ?? topic);
      for (let i = one.indexAt(t), steps = 0; i >= 0 && steps < 8; --i, ++steps) {
        const message = one.message(one.entry(i));
        if (message) take(message);
      }
    };
    lately('face', (message) => faces.add(stampOf(message)));
    // The face is told a moment after its landmarks: they are shown together.
    lately('landmarks', (message) => {
      if (faces.size === 0 || faces.has(stampOf(message))) results.set(stampOf(message), message);
    });
    return results;
  }
  private tellRate(compressed: boolean) {
    this.arrivals.push(performance.now());
    if (this.arrivals.length > 30) this.arrivals.shift();
    write(this.caption, `${this.layout.title} · ${this.rateHz.toFixed(0)} Hz${compressed ? '' : ' · raw'}`);
  }
  private infoOf({hub, deployment}: View) {
    const topic = this.layout.image.replace(/image_raw$/, 'camera_info');
    const log = hub.log(deployment?.topic(topic) ?? topic);
    return log.message(log.last);
  }
  private faceAt({hub, deployment, t}: View, found: Message | undefined) {
    const log = hub.log(deployment?.topic('face') ?? 'face');
    for (let i = log.indexAt(t), steps = 0; i >= 0 && steps < 8; --i, ++steps) {
      const face = log.message(log.entry(i));
      if (found && face?.valid && stampOf(face) === stampOf(found)) return face;
    }
    return undefined;
  }

  /// Empty, or what was wrong.
  private async paint(message: Message, compressed: boolean, over: {found?: Message; face?: Message; info?: Message}): Promise<string> {
    const context = this.canvas.getContext('2d')!;
    try {
      if (compressed) {
        const type = /png/i.test(message.format) ? 'image/png' : 'image/jpeg';
        // No larger than it is seen: the less there is to copy for every picture.
        const wanted = Math.ceil(Math.max(160, this.canvas.clientWidth) * Math.min(devicePixelRatio, 2));
        const size = over.info?.width > wanted ? {resizeWidth: wanted, resizeHeight: Math.round((wanted * over.info.height) / over.info.width), resizeQuality: 'medium' as const} : {};
        const picture = await createImageBitmap(new Blob([message.data as Uint8Array<ArrayBuffer>], {type}), size);
        this.resize(picture.width, picture.height);
        context.drawImage(picture, 0, 0);
        picture.close();
      } else {
        const pixels = rawPixels(message);
        if (typeof pixels === 'string') return pixels;
        this.resize(message.width, message.height);
        context.putImageData(pixels, 0, 0);
      }
    } catch (error) {
      return `A picture cannot be read: ${(error as Error).message}`;
    }
    this.landmarks = 0;
    // From here on in the pixels of the camera.
    this.scale = over.info?.width > 0 ? this.canvas.width / over.info.width : 1;
    context.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    if (over.found?.valid) this.drawLandmarks(context, over.found);
    if (over.face && over.info) this.drawFace(context, over.face, over.info);
    context.setTransform(1, 0, 0, 1, 0, 0);
    return over.found && !over.found.valid ? over.found.reason : '';
  }
  private resize(width: number, height: number) {
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.canvas.width = width;
    this.canvas.height = height;
  }
  /// Of the picture's pixels on one of the page: lines are as thick whatever the size of the panel.
  private unit() {
    const shown = Math.min(this.canvas.clientWidth, (this.canvas.clientHeight * this.canvas.width) / this.canvas.height);
    return this.canvas.width / this.scale / Math.max(160, shown);
  }
  private drawLandmarks(context: CanvasRenderingContext2D, found: Message) {
    const side = this.layout.side!, points = found[side] as Float64Array;
    const box = found[`${side}_box`] as Float64Array, unit = this.unit();
    context.lineWidth = 1.5 * unit;
    context.strokeStyle = kSky;
    context.strokeRect(box[0]!, box[1]!, box[2]!, box[3]!);
    const at = (i: number): [number, number] => [points[2 * i]!, points[2 * i + 1]!];
    if (found.scheme === 'ibug68') {
      context.beginPath();
      for (const [from, to, closed] of kIbug68) {
        context.moveTo(...at(from));
        for (let i = from + 1; i <= to; ++i) context.lineTo(...at(i));
        if (closed) context.closePath();
      }
      context.stroke();
    }
    context.fillStyle = kYellow;
    this.landmarks = points.length / 2;
    for (let i = 0; i < this.landmarks; ++i) {
      context.beginPath();
      context.arc(...at(i), Math.max(1.3 * unit, 2), 0, 2 * Math.PI);
      context.fill();
    }
  }
  /// The axes of the face at its mouth: to its side, up, and where it looks.
  private drawFace(context: CanvasRenderingContext2D, face: Message, info: Message) {
    const p = info.p as number[], unit = this.unit();
    const pixel = (x: number, y: number, z: number): [number, number] =>
        [(p[0]! * x + p[3]!) / z + p[2]!, (p[5]! * y) / z + p[6]!];
    const {mouth, normal, left_eye: l, right_eye: r} = face;
    const width = Math.hypot(r.x - l.x, r.y - l.y, r.z - l.z);
    const side = [(r.x - l.x) / width, (r.y - l.y) / width, (r.z - l.z) / width] as const;
    const n = [normal.x, normal.y, normal.z] as const;
    const up = [n[1] * side[2] - n[2] * side[1], n[2] * side[0] - n[0] * side[2], n[0] * side[1] - n[1] * side[0]] as const;
    const axes: [readonly number[], string, string][] = [[side, kOrange, 'side'], [up, kGreen, 'up'], [n, kSky, 'normal']];
    context.lineWidth = 2.5 * unit;
    context.font = `600 ${12 * unit}px system-ui, sans-serif`;
    const from = pixel(mouth.x, mouth.y, mouth.z);
    for (const [axis, colour, name] of axes) {
      const length = name === 'normal' ? 2 * kAxisLength : kAxisLength;
      const to = pixel(mouth.x + length * axis[0]!, mouth.y + length * axis[1]!, mouth.z + length * axis[2]!);
      context.strokeStyle = context.fillStyle = colour;
      context.beginPath();
      context.moveTo(...from);
      context.lineTo(...to);
      context.stroke();
      context.beginPath();
      context.arc(...to, 3 * unit, 0, 2 * Math.PI);
      context.fill();
      // An axis that looks at the camera is short: its name would stand on the others.
      const isShort = Math.hypot(to[0] - from[0], to[1] - from[1]) < 14 * unit;
      if (!isShort) context.fillText(name, to[0] + 6 * unit, to[1] + 4 * unit);
    }
  }
}
