// SPDX-License-Identifier: Apache-2.0
// Places components in the order of the flow, from the left to the right and down each column, in as
// many columns as make them largest in the place there is.
import type {Component} from '../deployment';

export interface Edge {
  from: string;
  to: string;
  topics: string[];
  feedback: boolean;
}
export interface Placed {
  order: string[];  // with the flow
  edges: Edge[];
}

export function placeComponents(components: Component[]): Placed {
  const edges = edgesOf(components);
  const depth = new Map(components.map(({name}) => [name, 0]));
  // Longest path; what is left of circles after the feedback is cut by the number of rounds.
  for (let round = 0; round < components.length; ++round) {
    let moved = false;
    for (const {from, to, feedback} of edges) {
      const next = depth.get(from)! + 1;
      if (feedback || from === to || depth.get(to)! >= next || next >= components.length) continue;
      depth.set(to, next);
      moved = true;
    }
    if (!moved) break;
  }
  const place = new Map<string, number>();
  const order = [...depth.keys()];
  order.forEach((name) => place.set(name, depth.get(name)!));
  // Neighbours come near each other: within a depth by the middle of those that they read.
  order.sort((a, b) => depth.get(a)! - depth.get(b)!);
  for (let sweep = 0; sweep < 3; ++sweep) {
    order.forEach((name, i) => place.set(name, i));
    const middle = (name: string) => {
      const near = edges.filter((edge) => edge.to === name && !edge.feedback).map((edge) => place.get(edge.from)!);
      return near.length === 0 ? place.get(name)! : near.reduce((x, y) => x + y, 0) / near.length;
    };
    const middles = new Map(order.map((name) => [name, middle(name)]));
    order.sort((a, b) => depth.get(a)! - depth.get(b)! || middles.get(a)! - middles.get(b)! || a.localeCompare(b));
  }
  return {order, edges};
}

function edgesOf(components: Component[]): Edge[] {
  const writers = new Map<string, string[]>();
  for (const {name, ports} of components) {
    for (const port of ports) {
      if (port.output) writers.set(port.topic, [...(writers.get(port.topic) ?? []), name]);
    }
  }
  const edges = new Map<string, Edge>();
  for (const {name, ports} of components) {
    for (const port of ports) {
      if (port.output) continue;
      for (const writer of writers.get(port.topic) ?? []) {
        if (writer === name) continue;
        const key = `${writer}>${name}>${port.feedback}`;
        const edge = edges.get(key) ?? {from: writer, to: name, topics: [], feedback: port.feedback};
        edge.topics.push(port.topic);
        edges.set(key, edge);
      }
    }
  }
  return [...edges.values()];
}
