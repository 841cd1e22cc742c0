// SPDX-License-Identifier: Apache-2.0
// The parts of the page that need no browser.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {McapWriter} from '@mcap/core';

import {Deployment, type Component} from '../src/deployment';
import {numericFields, valueAt} from '../src/message/fields';
import {decoderOf} from '../src/message/decoder';
import {Hub} from '../src/hub';
import {placeComponents} from '../src/panels/graph_layout';
import {Curve} from '../src/plot/curve';
import {parseExpression} from '../src/plot/expression';
import {clock, marksOf} from '../src/panels/time_scale';
import {Playhead} from '../src/playhead';
import {Playback} from '../src/source/playback';
import {Recording} from '../src/source/recording';
import {openRecording, type RecordingFile} from '../src/source/recording_file';
import {Store} from '../src/store';

const messages: Record<string, unknown> = {
  target: {position: {x: 1, y: 2, z: 2}, header: {stamp: {sec: 5, nsec: 0}}},
  truth: {position: {x: 1, y: 0, z: 2}},
  pose: {position: {x: 0, y: 0, z: 1}, orientation: {x: 0, y: 0, z: Math.SQRT1_2, w: Math.SQRT1_2}},
};
const value = (text: string) => parseExpression(text).evaluate((topic) => messages[topic]);
const near = (a: number, b: number) => assert.ok(Math.abs(a - b) < 1e-12, `${a} is not ${b}`);

test('an expression computes with fields of topics', () => {
  near(value('1000 * distance({target}.position, {truth}.position)'), 2000);
  near(value('-(1 + 2) * 3 - 4 / 2'), -11);
  near(value('norm({target}.position)'), 3);
});
test('frames are composed and inverted', () => {
  near(value('norm(transform(compose({pose}, inverse({pose})), {target}.position))'), 3);
  near(value('off_axis({pose}, {target}.position)'), Math.hypot(1, 2));
});
test('what is missing is no number, and nothing breaks', () => {
  assert.ok(Number.isNaN(value('distance({nobody}.position, {truth}.position)')));
  assert.ok(Number.isNaN(value('{target}.nothing.there')));
  assert.ok(Number.isNaN(value('marker({nobody}, "lesion")')));
});
test('a faulty expression is refused with what is wrong', () => {
  assert.throws(() => parseExpression('distanze(1, 2)'), /there is no function 'distanze'/);
  assert.throws(() => parseExpression('(1 + 2'), /ends too early/);
  assert.throws(() => parseExpression('1 ; 2'), /cannot be read/);
});
test('speed is the change from one message to the next', () => {
  const speed = parseExpression('speed({p}.at)');
  const at = (sec: number, x: number) => speed.evaluate(() => ({header: {stamp: {sec, nsec: 0}}, at: {x, y: 0, z: 0}}));
  assert.ok(Number.isNaN(at(1, 0)));
  near(at(3, 4), 2);
});

test('the store forgets what is older than its window, but for what still holds', () => {
  const store = new Store();
  const bytes = new Uint8Array(10);
  store.add('/latched', 0, bytes);
  for (let t = 0; t < 100; ++t) store.add('/often', t, bytes);
  store.trim();
  assert.equal(store.log('/latched').length, 1);
  assert.equal(store.log('/often').first!.t, 39);
  assert.equal(store.log('/often').indexAt(98.5), 59);
});
/// A topic that is written `hz` times a second for `seconds`, by a clock that is `ahead`; the page's goes from `now` on.
function write(store: Store, topic: string, now: number, seconds: number, hz: number, ahead: number) {
  for (let i = 0; i < seconds * hz; ++i) store.add(topic, 1e9 + ahead + now + i / hz, new Uint8Array([i & 255, i >> 8]), now + i / hz);
}
test('a message that is stamped an hour ahead takes nothing from the others, and is told of once', () => {
  const told: string[] = [], store = new Store((text) => told.push(text));
  write(store, '/arm', 0, 10, 100, 0);
  for (let i = 0; i < 5; ++i) store.add('/tf', 1e9 + 3600 + 10 + i, new Uint8Array([i]), 10);
  write(store, '/arm', 10, 10, 100, 0);
  store.trim();
  assert.ok(Math.abs(store.newest - (1e9 + 20)) < 0.1, `${store.newest - 1e9}`);
  assert.equal(store.log('/arm').length, 2000);
  assert.equal(store.log('/tf').length, 1, 'the last one may hold for ever');
  assert.deepEqual(told, ['/tf has messages that are stamped 3600 s ahead of all others: they are not shown']);
});
test('one whose clock is ahead and who comes first is not believed once most go by another clock', () => {
  const store = new Store();
  for (let now = 0; now < 20; ++now) {
    store.add('/stranger', 1e9 + 3600 + now, new Uint8Array([now]), now);
    if (now >= 5) write(store, '/arm', now, 1, 50, 0);
  }
  assert.ok(Math.abs(store.newest - (1e9 + 20)) < 0.1, `${store.newest - 1e9}`);
  assert.equal(store.log('/arm').length, 750);
});
test('a clock that steps back is followed within seconds, and what was stamped later is forgotten', () => {
  const told: string[] = [], store = new Store((text) => told.push(text));
  write(store, '/arm', 0, 10, 100, 0);
  write(store, '/arm', 10, 6, 100, -600);
  assert.ok(Math.abs(store.newest - (1e9 + 16 - 600)) < 0.1, `${store.newest - 1e9}`);
  assert.ok(store.log('/arm').last!.t <= store.newest);
  assert.equal(told.length, 1, told.join());
});
test('what is latched is no clock: what lives after it is shown at once, and it does not lead back when it is told again', () => {
  const store = new Store();
  for (let i = 0; i < 100; ++i) store.add('/rosout', 1e9 - 3600 + i / 50, new Uint8Array([i]), 0);
  store.add('/arm', 1e9, new Uint8Array([1]), 0.1);
  assert.equal(store.newest, 1e9);
  for (let now = 1; now < 60; ++now) store.add('/map', 1e9 - 3600, new Uint8Array([now]), now);
  assert.equal(store.newest, 1e9);
});
test('a simulation that pauses, or is faster than the clock on the wall, is followed', () => {
  const store = new Store();
  write(store, '/arm', 0, 10, 100, 0);
  for (let i = 0; i < 1000; ++i) store.add('/arm', 1e9 + 10 + i / 10, new Uint8Array([i & 255, i >> 8]), 100 + i / 100);
  assert.ok(Math.abs(store.newest - (1e9 + 110)) < 0.2, `${store.newest - 1e9}`);
});
test('the store stays within its memory, and drops from what takes most', () => {
  const store = new Store();
  store.maxBytes = 100_000;
  for (let i = 0; i < 2000; ++i) {
    store.add('/pictures', i / 100, new Uint8Array(1000));
    store.add('/small', i / 100, new Uint8Array(1));
  }
  store.trim();
  assert.ok(store.bytes() <= store.maxBytes, `${store.bytes()}`);
  assert.ok(store.log('/small').length > store.log('/pictures').length);
  assert.equal(store.log('/pictures').last!.t, 19.99);
});
test('messages of several writers stand in order of their times', () => {
  const store = new Store();
  for (const t of [1, 3, 2, 5, 4]) store.add('/tf', t, new Uint8Array(1));
  assert.deepEqual([0, 1, 2, 3, 4].map((i) => store.log('/tf').entry(i)!.t), [1, 2, 3, 4, 5]);
});

test('a message that is told again is kept once', () => {
  const store = new Store(), bytes = () => new Uint8Array([1, 2, 3]);
  for (const t of [1, 2, 1, 2]) store.add('/rosout', t, bytes());
  store.add('/rosout', 2, new Uint8Array([1, 2, 4]));
  assert.equal(store.log('/rosout').length, 3);
});

/// A socket of the page to a server that this test is.
interface Socket {
  onmessage?: (event: {data: unknown}) => void;
  sent: unknown[];
}
function socketOf(hub: Hub): Socket {
  let socket: Socket = {sent: []};
  Object.assign(globalThis, {
    window: globalThis,
    WebSocket: class {
      static readonly OPEN = 1;
      readonly readyState = 1;
      readonly sent: unknown[] = [];
      constructor() { socket = this; }
      send(data: unknown) { this.sent.push(data); }
      close() {}
    },
  });
  hub.connect('ws://recording');
  return socket;
}
const told = (socket: Socket, message: object) => socket.onmessage!({data: JSON.stringify(message)});
const kPlayed = {op: 'serverInfo', capabilities: ['playbackControl', 'time'], dataStartTime: {sec: 100, nsec: 0}, dataEndTime: {sec: 120, nsec: 500_000_000}};
/// A state of a playback, as the server tells it.
function stateOf(status: number, t: number, speed: number, didSeek: number, id = ''): DataView {
  const view = new DataView(new ArrayBuffer(19 + id.length));
  view.setUint8(0, 5);
  view.setUint8(1, status);
  view.setBigUint64(2, BigInt(t * 1e9), true);
  view.setFloat32(10, speed, true);
  view.setUint8(14, didSeek);
  view.setUint32(15, id.length, true);
  for (let i = 0; i < id.length; ++i) view.setUint8(19 + i, id.charCodeAt(i));
  return view;
}
/// What was asked: [plays, speed, seek or nothing, number].
function requestOf(data: unknown) {
  const bytes = data as Uint8Array, view = new DataView(bytes.buffer);
  assert.equal(view.getUint8(0), 3);
  const size = view.getUint32(15, true);
  assert.equal(bytes.byteLength, 19 + size);
  return [view.getUint8(1) === 0, view.getFloat32(2, true), view.getUint8(6) ? Number(view.getBigUint64(7, true)) / 1e9 : undefined, new TextDecoder().decode(bytes.subarray(19))];
}

test('what was told before a playback jumps is forgotten, and what follows is kept', () => {
  const topic = '/lamp/light', hub = new Hub();
  hub.want(new Set([topic]));
  const socket = socketOf(hub);
  told(socket, kPlayed);
  const channel = {id: 7, topic, encoding: 'cdr', schemaName: 'std_msgs/msg/Float64', schemaEncoding: 'ros2msg', schema: 'float64 data'};
  socket.onmessage!({data: JSON.stringify({op: 'advertise', channels: [channel]})});
  const message = (seconds: number) => {
    const view = new DataView(new ArrayBuffer(25));
    view.setUint8(0, 1);
    view.setUint32(1, 1, true);
    view.setBigUint64(5, BigInt(seconds) * 1_000_000_000n, true);
    socket.onmessage!({data: view.buffer});
  };
  const state = (didSeek: number) => socket.onmessage!({data: stateOf(0, 105, 1, didSeek).buffer});
  message(50);
  state(0);
  assert.equal(hub.log(topic).length, 1);
  state(1);
  message(20);
  assert.equal(hub.log(topic).length, 1);
  assert.equal(hub.store.newest, 20);
  hub.source!.close();
});

test('a recording that a server plays is paused, sought in and made faster there', () => {
  const hub = new Hub(), playhead = new Playhead(hub), socket = socketOf(hub);
  told(socket, kPlayed);
  assert.deepEqual([playhead.isRecording, playhead.start, playhead.end, playhead.position], [true, 100, 120.5, 100]);
  socket.onmessage!({data: stateOf(0, 105, 1, 0).buffer});
  assert.deepEqual([playhead.isPlaying, playhead.position, playhead.speed], [true, 105, 1]);
  playhead.toggle();
  assert.deepEqual(requestOf(socket.sent[0]), [false, 1, undefined, '1']);
  assert.equal(playhead.isPlaying, false, 'the page shows at once what was asked');
  socket.onmessage!({data: stateOf(1, 106, 1, 0, '1').buffer});
  playhead.step(-1);
  assert.deepEqual(requestOf(socket.sent[1]), [false, 1, 105, '2']);
  socket.onmessage!({data: stateOf(1, 105, 1, 1, '2').buffer});
  playhead.changeSpeed(true);
  assert.deepEqual(requestOf(socket.sent[2]), [false, 2, undefined, '3']);
  socket.onmessage!({data: stateOf(1, 105, 2, 0, '3').buffer});
  playhead.goLive();
  assert.deepEqual(requestOf(socket.sent[3]), [false, 2, 120.5, '4']);
  assert.deepEqual([playhead.position, playhead.speed], [120.5, 2]);
  hub.source!.close();
});
test('while a request is on its way the slider asks nothing, and then for the last place', () => {
  const sent: unknown[] = [], playback = new Playback(100, 200, (bytes) => sent.push(bytes));
  for (const t of [110, 120, 130, 999]) playback.seek(t);
  assert.equal(sent.length, 1);
  assert.ok(!playback.told(stateOf(0, 50, 1, 0)), 'another who watches');
  assert.equal(sent.length, 1);
  assert.ok(playback.told(stateOf(1, 110, 1, 1, '1')), 'the answer to the first');
  assert.deepEqual(sent.map((bytes) => requestOf(bytes)[2]), [110, 200]);
  assert.equal(playback.t, 200, 'the bar stays where the finger is');
  playback.told(stateOf(1, 200, 1, 1, '2'));
  assert.deepEqual([playback.t, playback.isPlaying], [200, false]);
});
test('a recording that is over begins again', () => {
  const sent: unknown[] = [], playback = new Playback(100, 200, (bytes) => sent.push(bytes));
  playback.told(stateOf(3, 200, 1, 0));
  assert.equal(playback.isPlaying, false);
  playback.toggle();
  assert.deepEqual(requestOf(sent[0]), [true, 1, 100, '1']);
});
test('a server that shows a running deployment has no controls, also where a recording was before', () => {
  const hub = new Hub(), playhead = new Playhead(hub), socket = socketOf(hub);
  told(socket, kPlayed);
  assert.ok(playhead.isRecording);
  told(socket, {op: 'serverInfo', capabilities: ['time']});
  assert.equal(playhead.isRecording, false);
  playhead.changeSpeed(true);
  playhead.toggle();
  assert.deepEqual(socket.sent, [], 'what a page does to a running deployment');
  hub.source!.close();
});
test('times of a recording are written as on a clock, with few marks below the bar', () => {
  assert.deepEqual([0, 7.46, 59.96, 750, 3723.4].map((s) => clock(s)), ['0:00.0', '0:07.5', '1:00.0', '12:30.0', '1:02:03.4']);
  assert.equal(clock(59.9, 0), '1:00');
  assert.deepEqual(marksOf(17.5, 300), [0, 5, 10, 15]);
  assert.deepEqual([0.5, NaN, 0].map((span) => marksOf(span, 500).length), [1, 0, 0]);
  assert.deepEqual(marksOf(10, 0), [], 'a bar that nobody sees');
  for (let span = 1; span < 1e6; span *= 1.7) {
    for (const width of [60, 200, 700]) {
      const marks = marksOf(span, width);
      assert.ok(marks.length >= 1 && (marks.length < 2 || (marks[1]! / span) * width >= 56), `${span} s on ${width} pixels`);
    }
  }
});

test('types that cannot be read are named with a reason', () => {
  assert.match(String(decoderOf({encoding: 'json', schemaEncoding: 'jsonschema', text: ''})), /'json', not CDR/);
  assert.match(String(decoderOf({encoding: 'cdr', schemaEncoding: 'omgidl', text: ''})), /'omgidl'/);
  assert.equal(typeof decoderOf({encoding: 'cdr', schemaEncoding: 'ros2msg', text: 'float64 x\n'}), 'function');
});
test('all numbers of a message are found, and read at their paths', () => {
  const message = {header: {stamp: {sec: 1}}, name: ['a'], position: new Float64Array([1, 2]), ok: true, at: {x: 3}};
  assert.deepEqual(numericFields(message), ['position[0]', 'position[1]', 'ok', 'at.x']);
  assert.equal(valueAt(message, 'position[1]'), 2);
  assert.equal(valueAt(message, 'at.x'), 3);
});
test('components stand in the order of the flow, whatever circles there are', () => {
  const port = (topic: string, output: boolean, feedback = false) => ({name: '', output, feedback, topic, type: '', qos: '', reliable: true, doc: ''});
  const component = (name: string, ports: Component['ports']): Component => ({name, plugin: '', executor: '', process: '', plugins: [], ports});
  const {order, edges} = placeComponents([
    component('arm', [port('/q', true), port('/cmd', false)]),
    component('camera', [port('/q', false, true), port('/image', true)]),
    component('task', [port('/image', false), port('/cmd', true), port('/q', false)]),
  ]);
  assert.deepEqual(edges.map(({from, to}) => `${from}>${to}`).sort(), ['arm>camera', 'arm>task', 'camera>task', 'task>arm']);
  assert.ok(order.indexOf('camera') < order.indexOf('task'));
});

/// A recording in which "vision" has what it got from "main" on /image, too; `processes` have recorded.
async function recordingOf(processes: string[]): Promise<Uint8Array> {
  const bytes: number[] = [];
  const writer = new McapWriter({
    writable: {position: () => BigInt(bytes.length), write: async (more) => { bytes.push(...more); }},
    chunkSize: 1,
  });
  await writer.start({profile: 'ros2', library: 'test'});
  for (const process of processes) {
    await writer.addMetadata({name: 'armature.process', metadata: new Map([['process', process]])});
  }
  const schemaId = await writer.registerSchema({name: 'std_msgs/msg/String', encoding: 'ros2msg', data: new Uint8Array()});
  const channel = (topic: string, metadata: [string, string][]) =>
      writer.registerChannel({schemaId, topic, messageEncoding: 'cdr', metadata: new Map(metadata)});
  const sent = await channel('/image', []), got = await channel('/image', [['from', 'main']]), other = await channel('/face', []);
  let sequence = 0;
  for (const [channelId, t, byte] of [[sent, 1, 1], [got, 1.5, 1], [other, 2, 7], [sent, 3, 2], [got, 3.5, 2]] as const) {
    const logTime = BigInt(t * 1e9);
    await writer.addMessage({channelId, sequence: ++sequence, logTime, publishTime: logTime, data: new Uint8Array([byte])});
  }
  await writer.end();
  return new Uint8Array(bytes);
}
test('a sample that two processes have recorded is counted and shown once', async () => {
  const shown = async (bytes: Uint8Array) => {
    const file = await openRecording(new Blob([bytes as BlobPart]), 'run.mcap'), seen: string[] = [];
    for await (const {topic, t, bytes: data} of file.read(new Set(['/image', '/face']), -Infinity, Infinity)) seen.push(`${topic} ${t} ${data[0]}`);
    assert.equal(file.messages, seen.length);
    assert.equal(file.topics.get('/image')!.count! + file.topics.get('/face')!.count!, seen.length);
    return {seen, wasEnded: file.remark === ''};
  };
  const once = ['/image 1 1', '/face 2 7', '/image 3 2'];
  const joined = await recordingOf(['main', 'vision']);
  assert.deepEqual(await shown(joined), {seen: once, wasEnded: true});
  assert.deepEqual(await shown(joined.slice(0, -9)), {seen: once, wasEnded: false});
  const alone = await recordingOf(['vision']);
  assert.equal((await shown(alone)).seen.length, 5, 'what came from a process that is not in it is all there is');
});

test('what is read of a recording when it is sought in is read again to its end', async () => {
  const topics = new Map([['/log', 600], ['/often', 6000]].map(([name, count]) => [name, {name, count}]));
  const file = {
    name: 'ten minutes', topics, messages: 6600, start: 0, end: 600, remark: '',
    async *read(wanted: Set<string>, from: number, to: number) {
      for (let i = 0; i < 6000; ++i) {
        const t = i / 10;
        if (i % 100 === 0) await new Promise((resolve) => setTimeout(resolve, 10));  // a chunk is unpacked
        if (t < from || t > to) continue;
        for (const topic of wanted) if (topic === '/often' || i % 10 === 0) yield {topic, t, bytes: new Uint8Array(1)};
      }
    },
  };
  const kept = new Map([['/log', 0], ['/often', 0]]);
  const recording = new Recording(file as unknown as RecordingFile, {
    condition() {}, topics() {}, played() {}, jumped() {}, warning(text) { assert.fail(text); },
    message(topic) { kept.set(topic, kept.get(topic)! + 1); },
    forget(topic) { kept.set(topic, 0); },
  });
  recording.want(new Set(['/log', '/often']));
  while (kept.get('/log')! < 100) await new Promise((resolve) => setTimeout(resolve, 5));
  assert.ok(kept.get('/log')! < 600, 'the seldom ones are being read');
  recording.lookAt(600);
  while (!recording.hasEnd) await new Promise((resolve) => setTimeout(resolve, 20));
  assert.deepEqual([...kept], [['/log', 600], ['/often', 450]]);
});
test('a curve of a fast topic evaluates each message once, and one of a recording has them all', () => {
  const hub = new Hub(), log = hub.log('/a');
  let evaluated = 0;
  log.decode = () => ({x: ++evaluated});
  const curve = new Curve('{/a}.x', (topic) => topic);
  for (let i = 1; i <= 40000; ++i) {
    hub.store.add('/a', i / 1000, new Uint8Array(1));
    if (i % 150 === 0) curve.update(hub);
  }
  curve.update(hub);
  assert.equal(evaluated, 40000);
  assert.ok(curve.times.length <= 20050 && curve.times.at(-1) === 40, `${curve.times.length} points`);

  const whole = new Curve('{/a}.x', (topic) => topic);
  whole.update(Object.create(hub, {recording: {value: {}}}));
  assert.equal(whole.times.length, 40000);
  assert.ok(Number.isFinite(whole.at(5)));
});
test('a curve goes on after stamps have gone back, and past a message that is stamped ahead', () => {
  const hub = new Hub(), curve = new Curve('{/arm}.x', (topic) => topic);
  hub.log('/arm').decode = () => ({x: 1});
  const goOn = (now: number, seconds: number, ahead: number) => {
    write(hub.store, '/arm', now, seconds, 10, ahead);
    curve.update(hub);
    return Math.abs(curve.times.at(-1)! - hub.store.newest);
  };
  assert.ok(goOn(0, 40, 0) < 0.05);
  assert.ok(goOn(40, 7, -30) < 0.05, 'it has stepped back by less than the window');
  assert.ok(curve.times.every((t, i) => i === 0 || t >= curve.times[i - 1]!), 'in order');
  hub.store.add('/arm', hub.store.newest + 3600, new Uint8Array([1]), 47);
  curve.update(hub);
  assert.ok(goOn(47, 2, -30) < 0.05, 'one message is stamped ahead');
});
test('of many warnings each is there to be told once', () => {
  const hub = new Hub(), told: string[] = [];
  for (let i = 0; i < 250; ++i) {
    hub.warn(`warning ${i}`);
    told.push(...hub.warnings.splice(0));
  }
  assert.deepEqual(told, Array.from({length: 250}, (_, i) => `warning ${i}`));
  for (let i = 0; i < 250; ++i) hub.warn(`warning ${i}`);
  assert.deepEqual([hub.warnings.length, hub.warnings.at(-1)], [100, 'warning 249']);
});
test('a process that dies while it is watched is named, and all is not well', () => {
  const hub = new Hub(), deployment = new Deployment(hub, 'lamp', '/lamp');
  const processes = ['main', 'vision'];
  const json = (value: unknown) => new TextEncoder().encode(JSON.stringify(value));
  for (const topic of [deployment.descriptionTopic, deployment.statesTopic]) {
    hub.log(topic).decode = (bytes) => JSON.parse(new TextDecoder().decode(bytes));
  }
  for (const process of processes) {
    hub.store.add(deployment.descriptionTopic, 0, json({run: 'a', process, processes, components: [{name: `of_${process}`}]}));
  }
  const tell = (t: number, process: string) => hub.store.add(deployment.statesTopic, t, json({
    process, components: [{component: `of_${process}`, state: 0, reason: '', activations: 0, reactions: [], step: {}, lateness: {}}],
  }));
  deployment.update();
  for (let t = 0; t <= 30; t += 0.5) {
    tell(t, 'main');
    if (t < 20) tell(t, 'vision');
  }
  assert.deepEqual(deployment.healthAt(1), {state: 0, text: '2 of 2 ok'});
  assert.deepEqual(deployment.healthAt(20), {state: 0, text: '2 of 2 ok'});
  assert.deepEqual(deployment.healthAt(30), {state: 2, text: '1 of 2 ok; vision tells nothing any more'});
  assert.deepEqual(deployment.healthAt(36), {state: 1, text: 'nothing told of the components for 6 s'});
});
