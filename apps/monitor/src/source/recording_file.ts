// SPDX-License-Identifier: Apache-2.0
// Reads an MCAP file: by its index, or, when that is missing because the file was cut off, from its
// beginning to its last whole chunk.
import {McapIndexedReader, McapStreamReader, type McapTypes} from '@mcap/core';
import {decompress} from 'fzstd';

import type {TopicInfo} from './source';

const kPart = 4 << 20;  // [byte] that are read at a time

export interface RecordedMessage {
  topic: string;
  t: number;  // [s]
  bytes: Uint8Array;
}

export interface RecordingFile {
  name: string;
  topics: Map<string, TopicInfo>;
  messages: number;
  start: number;  // [s]
  end: number;
  remark: string;  // what is wrong with it; empty: nothing
  read(topics: ReadonlySet<string>, from: number, to: number): AsyncGenerator<RecordedMessage>;
}

const decompressHandlers = {
  zstd: (bytes: Uint8Array, size: bigint) => decompress(bytes, new Uint8Array(Number(size))),
};
const seconds = (ns: bigint) => Number(ns / 1000n) * 1e-6;
const nanoseconds = (s: number) =>
    Number.isFinite(s) ? BigInt(Math.round(s * 1e6)) * 1000n : undefined;

/// Throws when it is no MCAP file at all.
export async function openRecording(file: Blob, name: string): Promise<RecordingFile> {
  const readable = {
    size: async () => BigInt(file.size),
    read: async (offset: bigint, size: bigint) =>
        new Uint8Array(await file.slice(Number(offset), Number(offset + size)).arrayBuffer()),
  };
  let reader: McapIndexedReader;
  try {
    reader = await McapIndexedReader.Initialize({readable, decompressHandlers});
  } catch (error) {
    return streamed(file, name, (error as Error).message);
  }
  if (reader.chunkIndexes.length === 0 || !reader.statistics) {
    return streamed(file, name, 'it has no index');
  }
  return indexed(reader, name);
}

function info(channel: McapTypes.Channel, schema: McapTypes.Schema | undefined): TopicInfo {
  return {
    name: channel.topic,
    type: schema?.name ?? '',
    schema: {
      encoding: channel.messageEncoding,
      schemaEncoding: schema?.encoding ?? '',
      text: new TextDecoder().decode(schema?.data),
    },
    count: 0,
  };
}

/// The process whose recording stands in the file; there are several when files were joined.
const processOf = ({name, metadata}: McapTypes.Metadata) =>
    name === 'armature.process' ? metadata.get('process') : undefined;

/// What one process got from others whose recordings are in the file, too, would be shown twice.
function isDoubled(channel: McapTypes.Channel, processes: ReadonlySet<string | undefined>): boolean {
  const from = channel.metadata.get('from');
  return from !== undefined && from.split(',').every((process) => processes.has(process));
}

interface Contents {
  topics: Map<string, TopicInfo>;
  topicOf: Map<number, string>;  // of the channels that are shown
  messages: number;
}

function contentsOf(
    channels: Iterable<McapTypes.Channel>, schemas: ReadonlyMap<number, McapTypes.Schema>,
    counts: ReadonlyMap<number, number | bigint>, metadata: McapTypes.Metadata[]): Contents {
  const processes = new Set(metadata.map(processOf));
  const contents: Contents = {topics: new Map(), topicOf: new Map(), messages: 0};
  for (const channel of channels) {
    if (isDoubled(channel, processes)) continue;
    const topic = contents.topics.get(channel.topic) ?? info(channel, schemas.get(channel.schemaId));
    const count = Number(counts.get(channel.id) ?? 0);
    topic.count! += count;
    contents.messages += count;
    contents.topics.set(channel.topic, topic);
    contents.topicOf.set(channel.id, channel.topic);
  }
  return contents;
}

async function indexed(reader: McapIndexedReader, name: string): Promise<RecordingFile> {
  const statistics = reader.statistics!;
  const metadata: McapTypes.Metadata[] = [];
  for await (const one of reader.readMetadata()) metadata.push(one);
  const {topics, topicOf, messages} = contentsOf(
      reader.channelsById.values(), reader.schemasById, statistics.channelMessageCounts, metadata);
  return {
    name,
    topics,
    messages,
    start: seconds(statistics.messageStartTime),
    end: seconds(statistics.messageEndTime),
    remark: '',
    async *read(wanted, from, to) {
      const all = reader.readMessages({
        topics: [...wanted],
        startTime: nanoseconds(from),
        endTime: nanoseconds(to),
      });
      for await (const message of all) {
        const topic = topicOf.get(message.channelId);
        if (topic === undefined) continue;
        yield {
          topic,
          t: seconds(message.logTime),
          bytes: message.data.slice(),  // of a chunk that need not stay
        };
      }
    },
  };
}

async function* recordsOf(file: Blob): AsyncGenerator<McapTypes.TypedMcapRecord, void> {
  const reader = new McapStreamReader({decompressHandlers});
  for (let at = 0; at < file.size; at += kPart) {
    reader.append(new Uint8Array(await file.slice(at, at + kPart).arrayBuffer()));
    for (let record; (record = reader.nextRecord());) yield record;
  }
}

async function streamed(file: Blob, name: string, why: string): Promise<RecordingFile> {
  const channels = new Map<number, McapTypes.Channel>();
  const schemas = new Map<number, McapTypes.Schema>();
  const counts = new Map<number, number>();
  const metadata: McapTypes.Metadata[] = [];
  let start = Infinity, end = -Infinity, damage = '';
  try {
    for await (const record of recordsOf(file)) {
      if (record.type === 'Schema') schemas.set(record.id, record);
      if (record.type === 'Channel') channels.set(record.id, record);
      if (record.type === 'Metadata') metadata.push(record);
      if (record.type !== 'Message') continue;
      const t = seconds(record.logTime);
      start = Math.min(start, t);
      end = Math.max(end, t);
      counts.set(record.channelId, (counts.get(record.channelId) ?? 0) + 1);
    }
  } catch (error) {
    if (counts.size === 0) throw error;
    damage = `; behind that it is damaged: ${(error as Error).message}`;
  }
  if (counts.size === 0) throw new Error(why);
  const {topics, topicOf, messages} = contentsOf(channels.values(), schemas, counts, metadata);
  return {
    name,
    topics,
    messages,
    start,
    end,
    remark: `It was not ended (${why}): read to its last whole chunk${damage}`,
    async *read(wanted, from, to) {
      try {
        for await (const record of recordsOf(file)) {
          if (record.type !== 'Message') continue;
          const topic = topicOf.get(record.channelId);
          const t = seconds(record.logTime);
          if (topic === undefined || !wanted.has(topic) || t < from || t > to) continue;
          yield {topic, t, bytes: record.data.slice()};
        }
      } catch {
        return;  // told already
      }
    },
  };
}
