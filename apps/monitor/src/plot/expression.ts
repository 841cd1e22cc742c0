// SPDX-License-Identifier: Apache-2.0
// What a curve shows, written as one would say it:
//   1000 * distance({target}.position, {truth}.position)
// A topic stands in braces, its field behind them. What is missing makes the value NaN.
import type {Message} from '../message/decoder';
import {secondsOf} from '../message/decoder';
import {valueAt} from '../message/fields';
import {functions, type Value} from './functions';

/// The message of a topic at the time that is asked about.
export type MessageOf = (topic: string) => Message | undefined;

type Node = (messages: MessageOf) => Value;

export interface Expression {
  topics: string[];  // as they are written, in their order
  evaluate(messages: MessageOf): number;
}

const kToken = /\s*(\{[^}]*\}[\w.[\]]*|\d+(?:\.\d*)?(?:[eE][-+]?\d+)?|"[^"]*"|[A-Za-z_]\w*|[-+*/(),])/y;

/// Throws an Error that says what cannot be read.
export function parseExpression(text: string): Expression {
  const tokens = tokenize(text);
  const topics: string[] = [];
  let at = 0;
  const peek = () => tokens[at];
  const take = (wanted?: string) => {
    const token = tokens[at++];
    if (token === undefined) throw new Error(`'${text}' ends too early`);
    if (wanted !== undefined && token !== wanted) throw new Error(`'${wanted}' is missing before '${token}'`);
    return token;
  };
  const number = (value: Value) => (typeof value === 'number' ? value : typeof value === 'bigint' || typeof value === 'boolean' ? Number(value) : NaN);

  const sum = (): Node => {
    let left = product();
    while (peek() === '+' || peek() === '-') {
      const sign = take() === '+' ? 1 : -1, a = left, b = product();
      left = (messages) => number(a(messages)) + sign * number(b(messages));
    }
    return left;
  };
  const product = (): Node => {
    let left = factor();
    while (peek() === '*' || peek() === '/') {
      const times = take() === '*', a = left, b = factor();
      left = (messages) => times ? number(a(messages)) * number(b(messages)) : number(a(messages)) / number(b(messages));
    }
    return left;
  };
  const factor = (): Node => {
    const token = take();
    if (token === '-') {
      const inner = factor();
      return (messages) => -number(inner(messages));
    }
    if (token === '(') {
      const inner = sum();
      take(')');
      return inner;
    }
    if (token.startsWith('{')) return field(token);
    if (token.startsWith('"')) return () => token.slice(1, -1);
    if (/^\d/.test(token)) return () => Number(token);
    return call(token);
  };
  const field = (token: string): Node => {
    const [, topic, rest] = /^\{([^}]*)\}\.?(.*)$/.exec(token)!;
    topics.push(topic!);
    return (messages) => {
      const message = messages(topic!);
      return rest === '' ? message : valueAt(message, rest!);
    };
  };
  const call = (name: string): Node => {
    const make = functions[name];
    if (!make) throw new Error(`there is no function '${name}'; there are ${Object.keys(functions).join(', ')}`);
    take('(');
    const inner: Node[] = [];
    while (peek() !== ')') {
      if (inner.length > 0) take(',');
      inner.push(sum());
    }
    take(')');
    const apply = make();
    // The time of a call is the stamp of the first topic of the expression.
    return (messages) => apply(inner.map((one) => one(messages)), stampOf(messages(topics[0] ?? '')));
  };

  const root = sum();
  if (at !== tokens.length) throw new Error(`'${tokens[at]}' is one too many`);
  return {topics, evaluate: (messages) => number(root(messages))};
}

function tokenize(text: string): string[] {
  const tokens: string[] = [];
  kToken.lastIndex = 0;
  while (kToken.lastIndex < text.trimEnd().length) {
    const from = kToken.lastIndex, match = kToken.exec(text);
    if (!match) throw new Error(`'${text.slice(from)}' cannot be read`);
    tokens.push(match[1]!);
  }
  return tokens;
}

function stampOf(message: Message | undefined): number {
  return secondsOf(message?.header?.stamp ?? message?.stamp);
}
