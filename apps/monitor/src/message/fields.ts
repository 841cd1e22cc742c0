// SPDX-License-Identifier: Apache-2.0
// Finds the numbers in a message, and says what each is called.
import type {Message} from './decoder';

const kMaxOfArray = 16;

/// Paths of all numbers: "pose.position.x", "position[2]". Entries of long arrays are left out, and
/// what the header tells.
export function numericFields(message: Message): string[] {
  const found: string[] = [];
  const walk = (value: Message, path: string) => {
    if (typeof value === 'number' || typeof value === 'bigint' || typeof value === 'boolean') {
      found.push(path);
    } else if (Array.isArray(value) || ArrayBuffer.isView(value)) {
      const list = value as unknown as ArrayLike<Message>;
      for (let i = 0; i < Math.min(list.length, kMaxOfArray); ++i) walk(list[i], `${path}[${i}]`);
    } else if (value && typeof value === 'object') {
      for (const [name, inner] of Object.entries(value)) {
        if (path === '' && name === 'header') continue;
        walk(inner, path === '' ? name : `${path}.${name}`);
      }
    }
  };
  walk(message, '');
  return found;
}

/// The value at a path; undefined where there is none.
export function valueAt(message: Message, path: string): Message {
  let value = message;
  for (const part of path.split(/[.[\]]+/)) {
    if (part === '') continue;
    if (value === undefined || value === null) return undefined;
    value = value[part];
  }
  return value;
}
