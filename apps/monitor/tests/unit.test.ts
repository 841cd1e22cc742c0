// SPDX-License-Identifier: Apache-2.0
// The parts of the page that need no browser.
import assert from 'node:assert/strict';
import {test} from 'node:test';

import type {Component} from '../src/deployment';
import {numericFields, valueAt} from '../src/message/fields';
import {decoderOf} from '../src/message/decoder';
import {Hub} from '../src/hub';
import {placeComponents} from '../src/panels/graph_layout';
import {parseExpression} from '../src/plot/expression';
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

test('what was told before a playback jumps is forgotten, and what follows is kept', () => {
  let socket: {onmessage?: (event: {data: unknown}) => void} = {};
  const topic = '/lamp/light';
  Object.assign(globalThis, {
    window: globalThis,
    WebSocket: class {
      static readonly OPEN = 1;
      readonly readyState = 1;
      constructor() { socket = this as typeof socket; }
      send() {}
      close() {}
    },
  });
  const hub = new Hub();
  hub.want(new Set([topic]));
  hub.connect('ws://recording');
  socket.onmessage!({data: JSON.stringify({op: 'serverInfo', capabilities: ['playbackControl', 'time']})});
  assert.ok(hub.isPlayed);
  const channel = {id: 7, topic, encoding: 'cdr', schemaName: 'std_msgs/msg/Float64', schemaEncoding: 'ros2msg', schema: 'float64 data'};
  socket.onmessage!({data: JSON.stringify({op: 'advertise', channels: [channel]})});
  const message = (seconds: number) => {
    const view = new DataView(new ArrayBuffer(25));
    view.setUint8(0, 1);
    view.setUint32(1, 1, true);
    view.setBigUint64(5, BigInt(seconds) * 1_000_000_000n, true);
    socket.onmessage!({data: view.buffer});
  };
  const state = (didSeek: number) => {
    const view = new DataView(new ArrayBuffer(19));
    view.setUint8(0, 5);
    view.setUint8(14, didSeek);
    socket.onmessage!({data: view.buffer});
  };
  message(50);
  state(0);
  assert.equal(hub.log(topic).length, 1);
  state(1);
  message(20);
  assert.equal(hub.log(topic).length, 1);
  assert.equal(hub.store.newest, 20);
  hub.source!.close();
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
