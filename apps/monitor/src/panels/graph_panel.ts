// SPDX-License-Identifier: Apache-2.0
// The components and who reads whom, with how each of them is.
import {kStateColours, kStateSigns} from '../colours';
import {kStates, type ComponentCondition} from '../deployment';
import {make, write, type Panel, type View} from '../view';
import {placeComponents, type Placed} from './graph_layout';

const kSvg = 'http://www.w3.org/2000/svg';
const kWidth = 150, kHeight = 46, kGapX = 40, kGapY = 16, kMargin = 10;

function svg(tag: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

export class GraphPanel implements Panel {
  readonly id = 'graph';
  readonly title = 'Components';
  readonly element = make('div', {class: 'graph'});
  readonly intervalMs = 250;
  selected = '';
  private nodes = new Map<string, {group: SVGElement; state: SVGElement; numbers: SVGElement; box: SVGElement}>();
  private edges: {element: SVGElement; from: string; to: string}[] = [];
  private drawnRun = '';
  private aspect = 0;

  constructor(private readonly onSelect: (component: string) => void) {}

  topics({deployment}: View): string[] { return deployment ? [deployment.descriptionTopic, deployment.statesTopic] : []; }
  reset() {
    this.drawnRun = '';
    this.aspect = 0;
  }
  draw(view: View) {
    const {deployment, t} = view;
    if (!deployment || deployment.components.length === 0) {
      if (this.nodes.size > 0 || !this.element.firstChild) {
        this.nodes.clear();
        this.element.replaceChildren(make('p', {class: 'note'}, 'No deployment has told of its components yet'));
      }
      return;
    }
    const run = `${deployment.run} ${deployment.components.length}`;
    const aspect = this.element.clientWidth / Math.max(1, this.element.clientHeight);
    if (run !== this.drawnRun || Math.abs(aspect - this.aspect) > 0.2 * this.aspect) {
      this.aspect = aspect;
      this.build(view);
    }
    this.drawnRun = run;
    const conditions = deployment.conditionsAt(t);
    for (const [name, node] of this.nodes) this.show(name, node, conditions.get(name));
  }

  private show(name: string, node: {group: SVGElement; state: SVGElement; numbers: SVGElement; box: SVGElement}, condition: ComponentCondition | undefined) {
    const state = condition?.state ?? -1;
    const word = kStates[state] ?? 'not told';
    write(node.state, kStateSigns[state] ?? '○');
    node.state.style.fill = kStateColours[state] ?? '#aab4c0';
    node.box.style.stroke = state > 0 ? kStateColours[state]! : '';
    const late = short(condition?.reaction?.p99 ?? condition?.stepP99 ?? NaN);
    const numbers = condition ? `${hertz(condition.hz)} · ${state > 0 ? word : late}` : 'not told';
    write(node.numbers, numbers);
    node.group.dataset.state = word;
    node.group.setAttribute('aria-label', `${name}, ${word}${condition?.reason ? `: ${condition.reason}` : ''}, ${numbers}`);
  }
  private build({deployment}: View) {
    const placed = placeComponents(deployment!.components);
    const {at, width, height} = places(placed, this.aspect);
    this.nodes.clear();
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': 'Components and who reads whom'});
    root.append(svg('defs', {}, ...['', '-on'].map((suffix) => svg('marker', {id: `arrow${suffix}`, viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: 'auto'}, svg('path', {d: 'M0 0 L8 4 L0 8 z', class: `head${suffix}`})))));
    this.edges = placed.edges.map(({from, to, topics, feedback}) => {
      const element = svg('path', {d: way(at.get(from)!, at.get(to)!), class: feedback ? 'edge feedback' : 'edge', 'marker-end': 'url(#arrow)'});
      element.append(svg('title', {}, `${from} → ${to}\n${topics.join('\n')}`));
      root.append(element);
      return {element, from, to};
    });
    for (const component of deployment!.components) {
      const {x, y} = at.get(component.name)!;
      const box = svg('rect', {width: kWidth, height: kHeight, rx: 7, class: 'box'});
      const state = svg('text', {x: 10, y: 19, class: 'state'}), numbers = svg('text', {x: 10, y: 38, class: 'numbers'});
      const group = svg('g', {transform: `translate(${x} ${y})`, class: 'node', tabindex: 0, role: 'button', 'data-component': component.name},
          box, state, svg('text', {x: 28, y: 19, class: 'name', ...(component.name.length > 12 ? {textLength: kWidth - 36, lengthAdjust: 'spacingAndGlyphs'} : {})}, component.name), numbers, svg('title', {}, `${component.name}: ${component.plugin}`));
      group.addEventListener('click', () => this.select(component.name));
      group.addEventListener('keydown', (event) => {
        const {key} = event as KeyboardEvent;
        if (key !== 'Enter' && key !== ' ') return;
        event.preventDefault();
        event.stopPropagation();
        this.select(component.name);
      });
      root.append(group);
      this.nodes.set(component.name, {group, state, numbers, box});
    }
    this.element.replaceChildren(root);
    this.highlight();
  }
  private select(name: string) {
    this.selected = this.selected === name ? '' : name;
    this.highlight();
    this.onSelect(this.selected);
  }
  highlight() {
    for (const [name, {group}] of this.nodes) group.classList.toggle('selected', name === this.selected);
    for (const {element, from, to} of this.edges) {
      const on = this.selected !== '' && (from === this.selected || to === this.selected);
      element.classList.toggle('on', on);
      element.setAttribute('marker-end', on ? 'url(#arrow-on)' : 'url(#arrow)');
    }
  }
}

/// In as many rows as make the components largest.
function places({order}: Placed, aspect: number) {
  const area = (rows: number) => ({
    width: 2 * kMargin + Math.ceil(order.length / rows) * (kWidth + kGapX) - kGapX,
    height: 2 * kMargin + rows * (kHeight + kGapY) - kGapY,
  });
  let rows = 1, best = 0;
  for (let tried = 1; tried <= order.length; ++tried) {
    const {width, height} = area(tried), scale = Math.min(Math.max(aspect, 0.2) / width, 1 / height);
    if (scale > best * 1.001) [best, rows] = [scale, tried];
  }
  const at = new Map<string, {x: number; y: number}>();
  order.forEach((name, i) => at.set(name, {
    x: kMargin + Math.floor(i / rows) * (kWidth + kGapX), y: kMargin + (i % rows) * (kHeight + kGapY),
  }));
  return {at, ...area(rows)};
}

/// To the right from side to side; within a column, and back, round the boxes between.
function way(a: {x: number; y: number}, b: {x: number; y: number}): string {
  const ya = a.y + kHeight / 2, yb = b.y + kHeight / 2;
  if (b.x > a.x) {
    const xa = a.x + kWidth, xb = b.x, bend = Math.max(16, (xb - xa) / 2);
    return `M${xa} ${ya} C${xa + bend} ${ya} ${xb - bend} ${yb} ${xb} ${yb}`;
  }
  const isNext = a.x === b.x && Math.abs(a.y - b.y) < 1.5 * (kHeight + kGapY);
  if (isNext) {
    const x = a.x + kWidth / 2 + (b.y > a.y ? -12 : 12);
    return b.y > a.y ? `M${x} ${a.y + kHeight} L${x} ${b.y}` : `M${x} ${a.y} L${x} ${b.y + kHeight}`;
  }
  if (a.x === b.x) {
    const x = a.x + kWidth, out = x + kGapX * 0.55;
    return `M${x} ${ya + 6} C${out} ${ya} ${out} ${yb} ${x} ${yb + (b.y > a.y ? -6 : 6)}`;
  }
  const xa = a.x, xb = b.x + kWidth, bend = Math.max(16, (xa - xb) / 2);
  return `M${xa} ${ya + 8} C${xa - bend} ${ya + 8} ${xb + bend} ${yb + 8} ${xb} ${yb + 8}`;
}

export function hertz(hz: number): string {
  return Number.isFinite(hz) ? `${hz < 10 && hz % 1 > 0.05 ? hz.toFixed(1) : hz.toFixed(0)} Hz` : '– Hz';
}
export function short(s: number): string {
  if (!Number.isFinite(s)) return '–';
  return s >= 1 ? `${s.toFixed(1)} s` : s >= 1e-3 ? `${(s * 1e3).toFixed(s >= 0.01 ? 0 : 1)} ms` : `${(s * 1e6).toFixed(0)} µs`;
}
