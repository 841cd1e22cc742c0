// SPDX-License-Identifier: Apache-2.0
// Speaks Foxglove's WebSocket protocol to `armature monitor`. A connection that is lost is made
// again, with what was wanted.
// Source: github.com/foxglove/ws-protocol, docs/spec.md
import {Playback} from './playback';
import type {Source, SourceEvents, TopicInfo} from './source';

const kProtocols = ['foxglove.sdk.v1', 'foxglove.websocket.v1'];
const kMessage = 1, kTime = 2, kPlaybackState = 5;  // what a binary frame begins with
const kHeadBytes = 13;
const kSoonMs = 1500;  // in which a server says what there is
const kRetryMs = [300, 1000, 2000, 3000];

interface Channel {
  id: number;
  topic: string;
  encoding: string;
  schemaName: string;
  schema: string;
  schemaEncoding: string;
}

export class Connection implements Source {
  readonly kind = 'live';
  private socket?: WebSocket;
  private channels = new Map<number, Channel>();
  private byTopic = new Map<string, number>();
  private subscriptions = new Map<string, number>();  // by topic
  private topicOf = new Map<number, string>();        // by subscription
  private gone = new Set<string>();  // topics of something that has ended; not of a lost connection
  private wanted: ReadonlySet<string> = new Set();
  private playback: Playback | undefined;  // where a recording is played
  private lastSubscription = 0;
  private failures = 0;
  private retry = 0;
  private closed = false;
  private wasOpen = false;

  constructor(private readonly url: string, private readonly events: SourceEvents) { this.open(); }

  want(topics: ReadonlySet<string>) {
    this.wanted = topics;
    this.update();
  }
  close() {
    this.closed = true;
    clearTimeout(this.retry);
    this.socket?.close();
  }

  private open() {
    if (!this.wasOpen) this.events.condition('connecting', `Connecting to ${this.place()}`);
    let socket: WebSocket;
    try {
      socket = new WebSocket(this.url, kProtocols);
    } catch (error) {
      this.events.condition('refused', `${this.url} is no address: ${(error as Error).message}`);
      return;
    }
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.failures = 0;
      this.wasOpen = true;
      this.events.condition('connected', `Connected to ${this.place()}`);
      setTimeout(() => this.closed || this.tellTopics(), kSoonMs);  // where nothing is there any more
    };
    socket.onmessage = ({data}) => (typeof data === 'string' ? this.told(data) : this.data(data));
    socket.onclose = () => this.lost();
  }
  private place() { return this.url.replace(/\?.*/, ''); }

  private lost() {
    if (this.closed) return;
    this.channels.clear();
    this.byTopic.clear();
    this.subscriptions.clear();
    this.topicOf.clear();
    // What was there stays in the page until the server, or another one, says what is there now.
    const wait = kRetryMs[Math.min(this.failures++, kRetryMs.length - 1)]!;
    this.events.condition(
        'lost', this.wasOpen ? 'Connection lost, trying again'
                             : `Nobody answers at ${this.place()}, trying again`);
    this.retry = window.setTimeout(() => this.open(), wait);
  }

  private told(text: string) {
    const message = JSON.parse(text);
    if (message.op === 'serverInfo') {
      this.playback = playbackOf(message, (bytes) => this.control(bytes));
      this.events.played(this.playback);
    } else if (message.op === 'advertise') {
      for (const channel of message.channels as Channel[]) {
        this.channels.set(channel.id, channel);
        this.byTopic.set(channel.topic, channel.id);
        if (this.gone.delete(channel.topic)) this.events.forget(channel.topic);
      }
      this.tellTopics();
      this.update();
    } else if (message.op === 'unadvertise') {
      for (const id of message.channelIds as number[]) {
        const topic = this.channels.get(id)?.topic;
        this.channels.delete(id);
        if (topic === undefined) continue;
        this.gone.add(topic);
        this.byTopic.delete(topic);
        this.topicOf.delete(this.subscriptions.get(topic) ?? 0);
        this.subscriptions.delete(topic);
      }
      this.tellTopics();
    } else if (message.op === 'status' && message.level > 0) {
      this.events.warning(String(message.message));
    }
  }

  private data(buffer: ArrayBuffer) {
    const view = new DataView(buffer);
    const kind = buffer.byteLength > 0 ? view.getUint8(0) : 0;
    if (kind === kPlaybackState && this.playback?.told(view)) this.events.jumped();
    if (kind === kTime) this.playback?.toldTime(view);
    if (kind !== kMessage || buffer.byteLength < kHeadBytes) return;
    const topic = this.topicOf.get(view.getUint32(1, true));
    if (topic === undefined) return;
    const t = view.getUint32(9, true) * 4.294967296 + view.getUint32(5, true) * 1e-9;
    this.events.message(topic, t, new Uint8Array(buffer, kHeadBytes));
  }

  private control(bytes: Uint8Array) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(bytes);
  }

  private tellTopics() {
    const topics = new Map<string, TopicInfo>();
    for (const channel of this.channels.values()) {
      topics.set(channel.topic, {
        name: channel.topic,
        type: channel.schemaName,
        schema: {
          encoding: channel.encoding,
          schemaEncoding: channel.schemaEncoding,
          text: channel.schema,
        },
      });
    }
    this.events.topics(topics);
  }

  /// Asks for what is wanted and there, and no longer for what is not wanted any more.
  private update() {
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    const subscriptions: {id: number; channelId: number}[] = [];
    for (const topic of this.wanted) {
      const channelId = this.byTopic.get(topic);
      if (channelId === undefined || this.subscriptions.has(topic)) continue;
      const id = ++this.lastSubscription;
      this.subscriptions.set(topic, id);
      this.topicOf.set(id, topic);
      subscriptions.push({id, channelId});
    }
    const subscriptionIds: number[] = [];
    for (const [topic, id] of [...this.subscriptions]) {
      if (this.wanted.has(topic)) continue;
      this.subscriptions.delete(topic);
      this.topicOf.delete(id);
      subscriptionIds.push(id);
    }
    if (subscriptions.length > 0) {
      this.socket.send(JSON.stringify({op: 'subscribe', subscriptions}));
    }
    if (subscriptionIds.length > 0) {
      this.socket.send(JSON.stringify({op: 'unsubscribe', subscriptionIds}));
    }
  }
}

interface StoredTime {
  sec: number;
  nsec: number;
}
function secondsOf({sec, nsec}: StoredTime) { return sec + nsec * 1e-9; }

/// What a server's first words tell of a recording that it plays.
function playbackOf(info: {capabilities?: string[]; dataStartTime?: StoredTime; dataEndTime?: StoredTime},
                    send: (bytes: Uint8Array) => void): Playback | undefined {
  const {capabilities, dataStartTime, dataEndTime} = info;
  if (!capabilities?.includes('playbackControl') || !dataStartTime || !dataEndTime) return undefined;
  return new Playback(secondsOf(dataStartTime), secondsOf(dataEndTime), send);
}
