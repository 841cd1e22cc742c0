// SPDX-License-Identifier: Apache-2.0
import type {Deployment} from './deployment';
import type {Hub} from './hub';
import type {Layout} from './layouts/layout';

/// What all panels show: a deployment, at a time.
export interface View {
  t: number;  // [s]
  isLive: boolean;
  hub: Hub;
  deployment: Deployment | undefined;
  layout: Layout;
}

export interface Panel {
  readonly id: string;
  readonly title: string;
  readonly element: HTMLElement;
  readonly intervalMs: number;  // between two drawings, at least
  /// What it wants to be told of, while it is seen.
  topics(view: View): Iterable<string>;
  draw(view: View): void;
  /// Another deployment, or another run of it.
  reset?(view: View): void;
}

type Attributes = Record<string, string | number | boolean | undefined>;

/// An element with attributes and children.
export function make<K extends keyof HTMLElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== false) element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children);
  return element;
}

/// Writes a text where it differs, so that nothing is laid out again without need.
export function write(element: Element, text: string) {
  if (element.textContent !== text) element.textContent = text;
}
