// SPDX-License-Identifier: Apache-2.0
// Where messages come from: a running deployment, or a recording.
import type {Schema} from '../message/decoder';
import type {Playback} from './playback';

export interface TopicInfo {
  name: string;
  type: string;  // sensor_msgs/msg/JointState
  schema: Schema;
  count?: number;  // of its messages, of a recording that tells
}

export type Condition = 'connecting' | 'connected' | 'lost' | 'reading' | 'read' | 'refused';

export interface SourceEvents {
  condition(condition: Condition, text: string): void;
  /// All topics there are now.
  topics(topics: Map<string, TopicInfo>): void;
  message(topic: string, t: number, bytes: Uint8Array): void;
  /// What was kept of this topic belongs to something that is over.
  forget(topic: string): void;
  /// What comes is no running deployment: a recording is played; or it is one (nothing).
  played(playback: Playback | undefined): void;
  /// What follows is of another time: a recording that is played has been sought in.
  jumped(): void;
  warning(text: string): void;
}

export interface Source {
  readonly kind: 'live' | 'recording';
  /// From now on messages of these topics are told, and of no others.
  want(topics: ReadonlySet<string>): void;
  close(): void;
}
