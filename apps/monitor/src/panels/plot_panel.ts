// SPDX-License-Identifier: Apache-2.0
// Curves over time, each with its goal where the deployment file sets one; any number of any topic
// can be added.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';

import {kCurves, kDashes} from '../colours';
import type {Hub} from '../hub';
import type {PlotLayout, Series} from '../layouts/layout';
import {numericFields} from '../message/fields';
import {Curve} from '../plot/curve';
import {make, write, type Panel, type View} from '../view';

const kSecondsShown = 60, kFewestSecondsShown = 10;

interface Shown {
  series: Series;
  curve: Curve;
}

export class PlotPanel implements Panel {
  readonly element = make('div', {class: 'plot'});
  readonly intervalMs = 150;
  readonly title: string;
  shown: Shown[] = [];
  private readonly area = make('div', {class: 'area'});
  private readonly legend = make('ul', {class: 'legend'});
  private readonly note = make('p', {class: 'note', role: 'status'});
  private plot?: uPlot;
  private drawnVersion = '';
  private goals = new Map<string, number>();
  private offset = 0;  // [s] of the time axis: 0 is now
  private lastView?: View;
  private wantsFields = '';
  private readonly topicInput = make('input', {list: 'topics-there', placeholder: 'topic', 'aria-label': 'Topic', size: 22});
  private readonly fieldInput = make('select', {'aria-label': 'Number in the message'});

  constructor(readonly id: string, private readonly layout: PlotLayout) {
    this.title = layout.title;
    this.element.append(this.area, this.legend, this.note, this.adder());
  }
  topics(): string[] {
    const topics = this.shown.flatMap(({curve}) => curve.topics);
    if (this.wantsFields) topics.push(this.wantsFields);
    return topics;
  }
  reset(view: View) {
    this.lastView = view;
    const full = (topic: string) => view.deployment?.topic(topic) ?? topic;
    this.shown = this.layout.series.map((series) => ({series, curve: new Curve(series.value, full, (component, name) => view.deployment?.parameter(component, name) ?? NaN)}));
    this.goals = view.deployment?.goals() ?? new Map();
    this.build();
  }
  forget(topic: string) {
    for (const {curve} of this.shown) {
      if (curve.topics.includes(topic)) curve.clear();
    }
  }
  goalOf(series: Series): number | undefined { return series.goal ? this.goals.get(series.goal) : undefined; }
  unitOf() { return this.layout.unit; }
  get points() { return this.shown.reduce((sum, {curve}) => sum + curve.times.length, 0); }

  /// For the head, whether the panel is seen or not.
  update(view: View) {
    this.lastView = view;
    if (this.goals.size === 0 && view.deployment) {
      this.goals = view.deployment.goals();
      if (this.goals.size > 0) this.build();
    }
    for (const {curve} of this.shown) curve.update(view.hub);
  }
  draw(view: View) {
    this.update(view);
    this.offerFields(view.hub);
    const {t} = view;
    this.writeLegend(t, view.hub);
    const version = `${this.shown.map(({curve}) => curve.version).join()} ${t.toFixed(2)} ${this.area.clientWidth}x${this.area.clientHeight}`;
    if (version === this.drawnVersion || !this.plot || !Number.isFinite(t)) return;
    this.drawnVersion = version;
    const {width, height} = this.size();
    if (this.plot.width !== width || this.plot.height !== height) this.plot.setSize({width, height});
    this.offset = view.isLive ? t : view.hub.recording ? view.hub.recording.file.start : view.hub.store.newest;
    // As far back as there is something to see.
    const first = Math.min(...this.shown.map(({curve}) => curve.times[0] ?? Infinity));
    const back = Math.min(kSecondsShown, Math.max(kFewestSecondsShown, this.offset - first));
    const from = view.hub.recording ? Math.max(view.hub.recording.from, t - kSecondsShown) : this.offset - (view.isLive ? back : Math.max(back, this.offset - t));
    const to = view.hub.recording ? Math.min(view.hub.recording.to, Math.max(t, from + kSecondsShown)) : this.offset;
    this.plot.setData(this.table(), false);
    this.plot.batch(() => {
      this.plot!.setScale('x', {min: from - this.offset, max: to - this.offset});
    });
    const cursor = this.plot.valToPos(t - this.offset, 'x');
    this.mark.hidden = view.isLive;
    this.mark.style.left = `${cursor}px`;
    const empty = this.shown.length > 0 && this.points === 0;
    const missing = [...new Set(this.topics())].filter((topic) => !view.hub.topics.has(topic));
    write(this.note, empty && missing.length > 0 ? `Nobody writes ${missing.join(', ')}` : '');
  }
  private readonly mark = make('div', {class: 'mark', hidden: true});

  private size() { return {width: Math.max(120, this.area.clientWidth), height: Math.max(60, this.area.clientHeight)}; }
  private build() {
    this.plot?.destroy();
    this.drawnVersion = '';
    const goals = this.shown.map(({series}) => this.goalOf(series));
    const axis = {stroke: '#c3cdd8', grid: {stroke: '#27313e', width: 1}, ticks: {stroke: '#3a4656', width: 1}, font: '13px system-ui, sans-serif'};
    const log = this.layout.log ?? false, least = this.layout.min ?? 1e-3;
    this.plot = new uPlot({
      ...this.size(),
      legend: {show: false},
      cursor: {show: false},
      scales: {
        x: {time: false},
        y: log ? {
          distr: 3, log: 10,
          range: (_, low, high) => {
            const top = Math.min(this.layout.max ?? Infinity, Math.max(high ?? least, least * 10, ...goals.map((goal) => (goal ?? 0) * 2)));
            return [Math.max(least, 10 ** Math.floor(Math.log10(Math.max(low ?? least, least)))), 10 ** Math.ceil(Math.log10(top))];
          },
        } : {
          range: (_, low, high) => {
            const all = [low ?? 0, high ?? 1, ...goals.filter((goal) => goal !== undefined)];
            const a = Math.min(...all), b = Math.max(...all), size = Math.max(Math.abs(a), Math.abs(b));
            const room = b - a > 1e-6 * size ? 0.06 * (b - a) : Math.max(0.1 * size, 1);
            return [a >= 0 && a < 0.3 * b ? 0 : a - room, b + room];
          },
        },
      },
      axes: [
        {...axis, values: (_, splits) => splits.map((s) => `${Number(s.toFixed(3))} s`), space: 70, size: 30},
        {...axis, size: 62, values: (_, splits) => splits.map((v) => (v === null ? '' : shortNumber(v))), label: this.layout.unit, labelSize: 18, labelFont: '13px system-ui, sans-serif', labelGap: 0,
         ...(log ? {filter: decades, grid: {...axis.grid, filter: decades}, ticks: {...axis.ticks, filter: decades}} : {})},
      ],
      series: [{}, ...this.shown.map((_, i) => ({
        stroke: kCurves[i % kCurves.length]!, width: 2.2, dash: kDashes[i % kDashes.length]!, spanGaps: false, points: {show: false},
      }))],
      hooks: {draw: [(plot) => this.drawGoals(plot)]},
    }, this.table(), this.area);
    this.plot.over.append(this.mark);
    this.legend.replaceChildren(...this.shown.map(({series}, i) => {
      const swatch = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
      swatch.setAttribute('class', 'swatch');
      swatch.setAttribute('viewBox', '0 0 34 6');
      swatch.setAttribute('aria-hidden', 'true');
      const line = document.createElementNS('http://www.w3.org/2000/svg', 'line');
      for (const [name, value] of Object.entries({x1: 0, x2: 34, y1: 3, y2: 3, stroke: kCurves[i % kCurves.length]!, 'stroke-width': 3, 'stroke-dasharray': kDashes[i % kDashes.length]!.join(' ')})) {
        line.setAttribute(name, String(value));
      }
      swatch.append(line);
      return make('li', {title: series.value}, swatch, make('span', {class: 'label'}, series.label), make('b', {class: 'value'}));
    }));
  }
  private writeLegend(t: number, hub: Hub) {
    this.shown.forEach(({series, curve}, i) => {
      const goal = this.goalOf(series), value = curve.at(t);
      const label = this.legend.children[i]?.querySelector('.label');
      if (label) write(label, jointName(series, curve, hub) ?? series.label);
      const text = `${formatted(value, series.digits)} ${this.layout.unit.includes(' ') ? '' : this.layout.unit}` + (goal === undefined ? '' : ` (goal ${goal})`);
      const item = this.legend.children[i]?.querySelector('.value');
      if (item) write(item, text);
    });
  }
  /// A dashed line for each goal, with its number.
  private drawGoals(plot: uPlot) {
    const {ctx, bbox} = plot;
    const drawn = new Set<number>(), labels: number[] = [];
    this.shown.forEach(({series}, i) => {
      const goal = this.goalOf(series);
      if (goal === undefined || drawn.has(goal)) return;
      drawn.add(goal);
      const y = Math.round(plot.valToPos(goal, 'y', true));
      if (!(y >= bbox.top && y <= bbox.top + bbox.height)) return;
      const same = this.shown.filter((one) => this.goalOf(one.series) === goal).length > 1;
      ctx.save();
      ctx.strokeStyle = ctx.fillStyle = same ? '#eef2f6' : kCurves[i % kCurves.length]!;
      ctx.lineWidth = 1.5 * devicePixelRatio;
      ctx.setLineDash([3 * devicePixelRatio, 5 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      ctx.textAlign = 'left';
      ctx.textBaseline = 'alphabetic';
      ctx.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
      const beside = labels.filter((other) => Math.abs(other - y) < 15 * devicePixelRatio).length;
      labels.push(y);
      ctx.fillText(`goal ${goal}`, bbox.left + (6 + 70 * beside) * devicePixelRatio, y - 5 * devicePixelRatio);
      ctx.restore();
    });
  }
  /// All curves on one axis of time.
  private table(): uPlot.AlignedData {
    const tables = this.shown.map(({curve}) => [curve.times.map((t) => t - this.offset), curve.values.map((v) => (this.layout.log && v !== null ? Math.max(v, this.layout.min ?? 1e-3) : v))] as uPlot.AlignedData);
    if (tables.length === 0) return [[]];
    return tables.length === 1 ? tables[0]! : uPlot.join(tables, tables.map((table) => table.map(() => 1)));
  }

  private adder() {
    const form = make('form', {class: 'adder'});
    const open = make('details', {}, make('summary', {title: 'Show any number of any topic'}, '+ curve'), form);
    const add = make('button', {type: 'submit'}, 'Add');
    form.append(this.topicInput, this.fieldInput, add);
    this.topicInput.addEventListener('change', () => (this.wantsFields = this.topicInput.value.trim()));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      if (!this.lastView || !this.fieldInput.value) return;
      const topic = this.topicInput.value.trim(), field = this.fieldInput.value;
      this.add({label: `${topic.split('/').slice(-2).join('/')} ${field}`, value: `{${topic}}.${field}`});
      open.open = false;
    });
    return open;
  }
  add(series: Series) {
    this.shown.push({series, curve: new Curve(series.value, (topic) => topic.startsWith('/') ? topic : this.lastView?.deployment?.topic(topic) ?? topic)});
    this.wantsFields = '';
    this.build();
  }
  private offerFields(hub: Hub) {
    if (!this.wantsFields) return;
    const log = hub.log(this.wantsFields), message = log.message(log.last);
    const fields = message ? numericFields(message) : [];
    if (this.fieldInput.dataset.topic === this.wantsFields && this.fieldInput.options.length === fields.length) return;
    this.fieldInput.dataset.topic = this.wantsFields;
    this.fieldInput.replaceChildren(...fields.map((field) => make('option', {value: field}, field)));
    const why = !hub.topics.has(this.wantsFields) ? 'There is no such topic' : typeof log.decode === 'string' ? log.decode : '';
    write(this.note, message ? '' : why || 'Waiting for a first message');
  }
}

/// A number of a joint is called as the joint.
function jointName(series: Series, curve: Curve, hub: Hub): string | undefined {
  const [, field, i] = /^\{[^}]*\}\.(position|velocity|effort)\[(\d+)\]$/.exec(series.value) ?? [];
  if (i === undefined) return undefined;
  const log = hub.log(curve.topics[0]!), name = log.message(log.last)?.name?.[Number(i)];
  return name && (field === 'position' ? name : `${name}, ${field}`);
}

export function formatted(value: number, digits = 3): string {
  return Number.isFinite(value) ? (Math.abs(value) < 1e4 ? value.toFixed(digits) : value.toExponential(2)) : '–';
}
/// Of a logarithmic axis: powers of ten alone.
function decades(_: uPlot, splits: number[]): (number | null)[] {
  return splits.map((v) => (Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-6 ? v : null));
}
function shortNumber(value: number): string {
  return value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5) ? value.toExponential(0) : String(Number(value.toPrecision(6)));
}
