// SPDX-License-Identifier: Apache-2.0
// Reads CDR messages by the text of their type, so that any type can be shown.
import {parse} from '@foxglove/rosmsg';
import {MessageReader} from '@foxglove/rosmsg2-serialization';

// eslint-disable-next-line @typescript-eslint/no-explicit-any
export type Message = any;
export type Decode = (bytes: Uint8Array) => Message;

export interface Schema {
  encoding: string;        // of the messages: cdr
  schemaEncoding: string;  // of the text: ros2msg
  text: string;
}

/// A function that reads messages of this type, or the reason why there is none.
export function decoderOf(schema: Schema): Decode | string {
  if (schema.encoding !== 'cdr') return `messages are '${schema.encoding}', not CDR`;
  if (schema.schemaEncoding !== 'ros2msg') {
    return `its type is told as '${schema.schemaEncoding}', not as ros2msg`;
  }
  try {
    const reader = new MessageReader(parse(schema.text, {ros2: true}));
    return (bytes) => reader.readMessage(bytes);
  } catch (error) {
    return `its type cannot be read: ${error instanceof Error ? error.message : String(error)}`;
  }
}

/// Seconds of a stamp; the reader calls the second part nsec.
export function secondsOf(stamp: {sec: number; nsec: number} | undefined): number {
  return stamp ? stamp.sec + stamp.nsec * 1e-9 : NaN;
}
