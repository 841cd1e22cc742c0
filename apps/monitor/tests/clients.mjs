// SPDX-License-Identifier: Apache-2.0
// Other programs' clients as witnesses: Foxglove's own for the protocol, MCAP's own for recordings.
import {open} from 'node:fs/promises';

import foxglove from '@foxglove/ws-protocol';
import {parse} from '@foxglove/rosmsg';
import {MessageReader} from '@foxglove/rosmsg2-serialization';
import {McapIndexedReader} from '@mcap/core';
import {decompress} from 'fzstd';
import WebSocket from 'ws';

const {FoxgloveClient} = foxglove;

/// Subscribes to all topics for a time, and decodes every message.
export async function decodeLive(url, seconds, wanted = () => true) {
  const client = new FoxgloveClient({ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL])});
  const readers = new Map(), told = {messages: 0, pictures: 0, topics: 0, failures: []};
  client.on('error', (error) => told.failures.push(String(error)));
  client.on('advertise', (channels) => {
    for (const channel of channels) {
      if (!wanted(channel.topic)) continue;
      ++told.topics;
      readers.set(client.subscribe(channel.id), {topic: channel.topic, reader: new MessageReader(parse(channel.schema, {ros2: true}))});
    }
  });
  client.on('message', ({subscriptionId, data}) => {
    const {topic, reader} = readers.get(subscriptionId);
    ++told.messages;
    if (/image_raw\/compressed$/.test(topic)) ++told.pictures;
    try {
      reader.readMessage(data);
    } catch (error) {
      told.failures.push(`${topic}: ${error.message}`);
    }
  });
  await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
  client.close();
  return told;
}

/// Decodes every message of a recording. Throws when there are more or fewer than `expected`.
export async function decodeRecording(path, expected) {
  const file = await open(path), {size} = await file.stat();
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(size),
      read: async (offset, length) => (await file.read(new Uint8Array(Number(length)), 0, Number(length), Number(offset))).buffer,
    },
    decompressHandlers: {zstd: (bytes, length) => decompress(bytes, new Uint8Array(Number(length)))},
  });
  const readers = new Map();
  let count = 0;
  for await (const message of reader.readMessages({validateCrcs: true})) {
    if (!readers.has(message.channelId)) {
      const schema = reader.schemasById.get(reader.channelsById.get(message.channelId).schemaId);
      readers.set(message.channelId, new MessageReader(parse(new TextDecoder().decode(schema.data), {ros2: true})));
    }
    readers.get(message.channelId).readMessage(message.data);
    ++count;
  }
  await file.close();
  if (count !== expected) throw new Error(`${count} messages were decoded, and there are ${expected}`);
  console.log(`${count} messages of the recording were decoded`);
}

/// Clients that ask for everything and read nothing.
export async function lazyClients(url, count) {
  const sockets = [];
  for (let i = 0; i < count; ++i) {
    const socket = new WebSocket(url, ['foxglove.websocket.v1']);
    await new Promise((resolve, reject) => {
      socket.on('error', reject);
      socket.on('message', (data, isBinary) => {
        const told = isBinary ? {} : JSON.parse(data);
        if (told.op !== 'advertise') return;
        socket.send(JSON.stringify({op: 'subscribe', subscriptions: told.channels.map(({id}) => ({id, channelId: id}))}));
        socket._socket.pause();  // and never reads again
        resolve();
      });
    });
    sockets.push(socket);
  }
  return sockets;
}
