// SPDX-License-Identifier: Apache-2.0
// A server that says what no deployment should: NaN, messages that are cut off, types that nobody
// knows, a tree of frames that goes round in a circle.
import {parse} from '@foxglove/rosmsg';
import {MessageWriter} from '@foxglove/rosmsg2-serialization';
import {WebSocketServer} from 'ws';

const kLine = `${'='.repeat(80)}\nMSG: `;
const kHeader = `${kLine}std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n${kLine}builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n`;
const kTf = `geometry_msgs/TransformStamped[] transforms\n${kLine}geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n${kHeader}${kLine}geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n${kLine}geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n${kLine}geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n`;
const kJoints = `std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n${kHeader}`;

const kChannels = [
  {id: 1, topic: '/tf', encoding: 'cdr', schemaName: 'tf2_msgs/msg/TFMessage', schemaEncoding: 'ros2msg', schema: kTf},
  {id: 2, topic: '/joint_states', encoding: 'cdr', schemaName: 'sensor_msgs/msg/JointState', schemaEncoding: 'ros2msg', schema: kJoints},
  {id: 3, topic: '/odd', encoding: 'protobuf', schemaName: 'Odd', schemaEncoding: 'protobuf', schema: 'AAAA'},
  {id: 4, topic: '/broken', encoding: 'cdr', schemaName: 'broken/msg/Broken', schemaEncoding: 'ros2msg', schema: 'this is { no type'},
];

export function fakeServer() {
  const server = new WebSocketServer({port: 0, host: '127.0.0.1', handleProtocols: () => 'foxglove.websocket.v1'});
  const tf = new MessageWriter(parse(kTf, {ros2: true})), joints = new MessageWriter(parse(kJoints, {ros2: true}));
  const subscriptions = new Map();
  let count = 0;
  server.on('connection', (socket) => {
    socket.send(JSON.stringify({op: 'serverInfo', name: 'fake', capabilities: []}));
    socket.send(JSON.stringify({op: 'advertise', channels: kChannels}));
    socket.send(JSON.stringify({op: 'status', level: 1, message: 'a warning'}));
    socket.send(JSON.stringify({op: 'something new'}));
    socket.on('message', (text) => {
      const told = JSON.parse(text);
      for (const {id, channelId} of told.subscriptions ?? []) subscriptions.set(channelId, id);
    });
    const timer = setInterval(() => {
      const stamp = {sec: Math.floor(Date.now() / 1000), nsec: 0}, header = {stamp, frame_id: 'a'};
      const transform = {translation: {x: NaN, y: 0, z: Infinity}, rotation: {x: 0, y: 0, z: 0, w: 0}};
      ++count;
      send(socket, 1, tf.writeMessage({transforms: [{header, child_frame_id: 'b', transform}, {header: {stamp, frame_id: 'b'}, child_frame_id: 'a', transform}]}));
      const whole = joints.writeMessage({header, name: ['j1', 'j2'], position: [NaN, 1], velocity: [], effort: []});
      send(socket, 2, count % 7 === 0 ? whole.slice(0, 9) : whole);
      socket.send(new Uint8Array([9, 9, 9]));
    }, 10);
    socket.on('close', () => clearInterval(timer));
  });
  const send = (socket, channel, data) => {
    const id = subscriptions.get(channel);
    if (id === undefined) return;
    const head = new DataView(new ArrayBuffer(13));
    head.setUint8(0, 1);
    head.setUint32(1, id, true);
    head.setBigUint64(5, BigInt(Date.now()) * 1000000n, true);
    socket.send(Buffer.concat([Buffer.from(head.buffer), data]));
  };
  return new Promise((resolve) => server.on('listening', () => resolve({
    url: `ws://127.0.0.1:${server.address().port}`,
    close: () => {
      server.clients.forEach((socket) => socket.terminate());
      server.close();
    },
  })));
}
