// SPDX-License-Identifier: Apache-2.0
// A recording that a server plays to all who watch it: where it stands, and what is asked of it.
// Source: github.com/foxglove/foxglove-sdk, rust/foxglove/src/protocol/common

const kControl = 3;  // what a request begins with
const kRequestBytes = 19, kStateBytes = 19;  // without the number of a request
const kPlaying = 0;  // a status
const kNearS = 1e-3;  // what a time loses as a number of seconds is less

interface Request {
  plays: boolean;
  speed: number;
  seek: number | undefined;  // [s]
}

export class Playback {
  t: number;  // [s] where it stands, or shall go
  speed = 1;
  isPlaying = false;
  private last = 0;
  private unanswered = '';  // the number of the request that is on its way
  private next: Request | undefined;  // is asked when that one is answered

  /// A recording from `start` to `end` [s]; `send` takes a request as the server reads it.
  constructor(readonly start: number, readonly end: number, private readonly send: (bytes: Uint8Array) => void) {
    this.t = start;
  }

  /// At its end it begins again.
  toggle() {
    const seek = !this.isPlaying && this.t > this.end - kNearS ? this.start : undefined;
    this.ask({plays: !this.isPlaying, speed: this.speed, seek});
  }
  seek(t: number) {
    this.ask({plays: this.isPlaying, speed: this.speed, seek: Math.min(this.end, Math.max(this.start, t))});
  }
  setSpeed(speed: number) { this.ask({plays: this.isPlaying, speed, seek: undefined}); }

  /// A state that the server tells. True: what follows is of another time.
  told(view: DataView): boolean {
    if (view.byteLength < kStateBytes) return false;
    const bytes = new Uint8Array(view.buffer, view.byteOffset + kStateBytes, view.byteLength - kStateBytes);
    const id = new TextDecoder().decode(bytes);
    if (id !== '' && id === this.unanswered) this.unanswered = '';
    if (this.unanswered === '' && this.next) {
      this.post(this.next);
      this.next = undefined;
    } else if (this.unanswered === '') {
      this.isPlaying = view.getUint8(1) === kPlaying;
      this.t = seconds(view.getBigUint64(2, true));
      this.speed = view.getFloat32(10, true);
    }
    return view.getUint8(14) === 1;
  }
  /// Where it is by now.
  toldTime(view: DataView) {
    if (view.byteLength >= 9 && this.unanswered === '') this.t = seconds(view.getBigUint64(1, true));
  }

  /// A slider asks faster than a recording is read: one request is on its way, and of the others the last counts.
  private ask(request: Request) {
    this.isPlaying = request.plays;
    this.speed = request.speed;
    if (request.seek !== undefined) this.t = request.seek;
    if (this.unanswered === '') this.post(request);
    else this.next = {...request, seek: request.seek ?? this.next?.seek};
  }
  private post({plays, speed, seek}: Request) {
    this.unanswered = String(++this.last);
    const id = new TextEncoder().encode(this.unanswered);
    const bytes = new Uint8Array(kRequestBytes + id.byteLength), view = new DataView(bytes.buffer);
    view.setUint8(0, kControl);
    view.setUint8(1, plays ? 0 : 1);
    view.setFloat32(2, speed, true);
    view.setUint8(6, seek === undefined ? 0 : 1);
    view.setBigUint64(7, BigInt(Math.round((seek ?? 0) * 1e9)), true);
    view.setUint32(15, id.byteLength, true);
    bytes.set(id, kRequestBytes);
    this.send(bytes);
  }
}

function seconds(ns: bigint): number { return Number(ns) * 1e-9; }
