// SPDX-License-Identifier: Apache-2.0
// Puts the panels together, and draws those that are seen, each as often as it needs.
import {Deployment, deploymentsOf} from './deployment';
import {Hub} from './hub';
import {derivedLayout, kEmpty, shippedLayout, type Layout} from './layouts/layout';
import {AboutDialog} from './panels/about';
import {GraphPanel} from './panels/graph_panel';
import {Header, type Headline} from './panels/header';
import {helpDialog} from './panels/help';
import {ImagePanel} from './panels/image_panel';
import {Inspector} from './panels/inspector';
import {LogPanel} from './panels/log_panel';
import {PlotPanel} from './panels/plot_panel';
import {ScenePanel} from './panels/scene_panel';
import {Timeline} from './panels/timeline';
import {Playhead} from './playhead';
import type {Embedded} from './source/embedded';
import {openRecording} from './source/recording_file';
import {make, type Panel, type View} from './view';

interface Framed {
  panel: Panel;
  frame: HTMLElement;
  drawnAt: number;
}

export class App {
  readonly hub = new Hub();
  readonly playhead = new Playhead(this.hub);
  readonly scene = new ScenePanel();
  readonly graph = new GraphPanel((name) => this.inspect(name));
  readonly log = new LogPanel((t) => this.playhead.seek(t));
  images: ImagePanel[] = [];
  plots: PlotPanel[] = [];
  deployment: Deployment | undefined;
  layout: Layout = kEmpty;
  frameMs = NaN;  // of drawing, the mean of late
  private framed: Framed[] = [];
  private alone: string | undefined;  // the panel that has all the room
  private readonly header: Header;
  private readonly timeline: Timeline;
  private readonly isReport: boolean;
  private readonly inspector = new Inspector(() => this.inspect(''));
  private readonly help = helpDialog();
  private readonly topicsList = make('datalist', {id: 'topics-there'});
  private chosen = '';
  private run = '';
  private topicsVersion = -1;
  private condition = '';
  private slowAt = 0;
  private tickedAt = performance.now();
  private unreadable = new Set<string>();  // topics of which that was told

  /// `report`: what the page was made of, where it is a report.
  constructor(header: HTMLElement, private readonly panels: HTMLElement, timeline: HTMLElement, report?: Embedded) {
    this.header = new Header(header, (namespace) => this.choose(namespace));
    this.isReport = report !== undefined;
    const about = report && new AboutDialog(report);
    this.timeline = new Timeline(timeline, this.playhead, (file) => void this.openFile(file), () => this.help.showModal(),
                                 about && (() => this.tellAbout(about)));
    document.body.append(this.topicsList, this.inspector.element);
    this.hub.onForget((topic) => {
      this.scene.forget(topic);
      for (const plot of this.plots) plot.forget(topic);
    });
    this.listen();
    this.layOut();
    const frame = () => {
      this.tick();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  connect(url: string) {
    if (url === '') {
      this.hub.condition = 'read';
      this.hub.text = 'Open a recording, or drop it here';
      return;
    }
    this.startAnew();
    this.hub.connect(url);
  }
  async openFile(file: File) {
    this.hub.text = `Reading ${file.name}`;
    try {
      const recording = await openRecording(file, file.name);
      this.startAnew();
      this.hub.open(recording, this.isReport);
      this.playhead.reset();
      this.log.add({t: recording.start, level: recording.remark ? 'warning' : 'info', who: 'page',
                    text: `${file.name}: ${recording.messages} messages of ${recording.topics.size} topics${recording.remark ? `. ${recording.remark}` : ''}`});
    } catch (error) {
      this.hub.warn(`${file.name} is no recording that can be read: ${(error as Error).message}`);
    }
  }
  view(): View {
    return {t: this.playhead.t, isLive: this.playhead.isLive, hub: this.hub, deployment: this.deployment, layout: this.layout};
  }

  /// Of the end of the run where that is read, else of what is looked at.
  private tellAbout(about: AboutDialog) {
    const {start, end, t: shown} = this.playhead, hasEnd = this.hub.recording?.hasEnd ?? false;
    const t = hasEnd ? end : shown;
    about.show(this.deployment, this.headlines({...this.view(), t}), t, hasEnd ? 'at the end' : `at ${(t - start).toFixed(1)} s`);
  }
  private startAnew() {
    this.deployment = undefined;
    this.run = '';
    this.chosen = '';
    this.topicsVersion = -1;
    this.log.events = [];
    this.playhead.reset();
    this.layOut();
  }
  private choose(namespace: string) {
    this.chosen = namespace;
    this.deployment = undefined;
    this.topicsVersion = -1;
    this.playhead.goLive();
  }

  /// Which deployment it is, and whether it is still the same run of it.
  private follow() {
    if (this.topicsVersion !== this.hub.topicsVersion) {
      this.topicsVersion = this.hub.topicsVersion;
      this.topicsList.replaceChildren(...[...this.hub.topics.keys()].sort().map((topic) => make('option', {value: topic})));
      const there = deploymentsOf(this.hub);
      const current = there.find(({namespace}) => namespace === (this.chosen || this.deployment?.namespace)) ?? there[0];
      if (current && current.namespace !== this.deployment?.namespace) {
        this.deployment = new Deployment(this.hub, current.name, current.namespace);
        this.run = '';
        this.layOut();
      } else if (!current && this.hub.topics.size > 0 && !this.deployment && this.layout === kEmpty) {
        this.layOut();
      }
    }
    if (this.deployment?.update() && this.deployment.run !== this.run) {
      this.run = this.deployment.run;
      this.layOut();
    }
  }

  /// Makes the panels of the layout.
  private layOut() {
    this.layout = (this.deployment && shippedLayout(this.deployment.name)) ??
        (this.hub.topics.size > 0 ? derivedLayout(this.hub, this.deployment) : kEmpty);
    this.images = this.layout.images.map((image, i) => new ImagePanel(`image${i + 1}`, image));
    this.plots = this.layout.plots.map((plot, i) => new PlotPanel(`plot${i + 1}`, plot));
    const panels: Panel[] = [this.scene, ...this.images, ...this.plots, this.graph, this.log];
    this.panels.replaceChildren();
    this.panels.className = `images${this.images.length} plots${this.plots.length}`;
    this.framed = panels.map((panel, i) => {
      const title = make('button', {type: 'button', title: `This panel alone (${i + 1})`, 'aria-expanded': 'false'}, make('kbd', {}, String(i + 1)), panel.title);
      title.addEventListener('click', () => this.show(panel.id));
      const frame = make('section', {class: `panel ${panel.id}`, 'aria-label': panel.title}, make('h2', {}, title), panel.element);
      this.panels.append(frame);
      return {panel, frame, drawnAt: 0};
    });
    if (this.alone && !panels.some(({id}) => id === this.alone)) this.alone = undefined;
    const view = this.view();
    for (const panel of panels) panel.reset?.(view);
    this.inspect('');
    this.arrange();
  }
  private show(id: string) {
    this.alone = this.alone === id ? undefined : id;
    this.arrange();
  }
  private arrange() {
    this.panels.classList.toggle('alone', this.alone !== undefined);
    for (const {panel, frame} of this.framed) {
      frame.hidden = this.alone !== undefined && panel.id !== this.alone;
      frame.querySelector('h2 button')!.setAttribute('aria-expanded', String(panel.id === this.alone));
    }
    for (const one of this.framed) one.drawnAt = 0;
  }
  private inspect(name: string) {
    this.graph.selected = name;
    this.graph.highlight();
    this.inspector.show(name, this.view());
  }

  private tick() {
    const now = performance.now();
    this.scene.roundMs += 0.1 * (Math.min(500, now - this.tickedAt) - this.scene.roundMs);
    this.tickedAt = now;
    this.playhead.tick();
    this.follow();
    this.tellCondition();
    const view = this.view();
    this.want(view);
    let drawn = false;
    for (const one of this.framed) {
      if (one.frame.hidden || now - one.drawnAt < one.panel.intervalMs) continue;
      one.drawnAt = now;
      one.panel.draw(view);
      drawn = true;
    }
    if (now - this.slowAt >= 150) {
      this.slowAt = now;
      for (const {panel, frame} of this.framed) {
        if (frame.hidden && panel instanceof PlotPanel) panel.update(view);  // their figures stand in the head
      }
      this.log.update(view);
      this.header.draw(view, deploymentsOf(this.hub), this.headlines(view));
      this.inspector.draw(view);
      this.timeline.draw(this.hub, this.log.events, this.frameMs);
    }
    if (!drawn) return;
    const took = performance.now() - now;
    this.frameMs = Number.isNaN(this.frameMs) ? took : this.frameMs + 0.05 * (took - this.frameMs);
  }
  private headlines(view: View): Headline[] {
    return this.plots.flatMap((plot) => plot.shown.filter(({series}) => series.headline).map(({series, curve}) => ({
      series, unit: plot.unitOf(), value: curve.at(view.t), goal: plot.goalOf(series),
    })));
  }
  /// Asks for what is seen, and for what the head and the log need.
  private want(view: View) {
    const topics = new Set<string>(['/rosout']);
    for (const {namespace} of deploymentsOf(this.hub)) topics.add(`${namespace}/description`);
    if (this.deployment) topics.add(this.deployment.statesTopic).add(Header.taskTopic(this.deployment));
    for (const {panel, frame} of this.framed) {
      const needed = !frame.hidden && !document.hidden;
      if (!needed && !(panel instanceof PlotPanel && panel.shown.some(({series}) => series.headline))) continue;
      for (const topic of panel.topics(view)) topics.add(topic);
    }
    this.hub.want(topics);
  }
  private tellCondition() {
    const {condition, text} = this.hub;
    if (condition !== this.condition && condition !== 'reading' && condition !== 'read') {
      const isFirst = this.condition === '';
      this.condition = condition;
      if (!isFirst) this.log.add({t: this.now(), level: condition === 'lost' ? 'warning' : 'info', who: 'page', text});
    }
    for (const log of this.hub.store.topics.values()) {
      if (log.failures === 0 || this.unreadable.has(log.name)) continue;
      this.unreadable.add(log.name);
      this.log.add({t: this.now(), level: 'warning', who: 'page', text: `a message of ${log.name} cannot be read: ${log.failure}`});
    }
    for (const warning of this.hub.warnings.splice(0)) {
      this.log.add({t: this.now(), level: 'warning', who: 'page', text: warning});
    }
  }
  private now() { return Number.isFinite(this.hub.store.newest) ? this.hub.store.newest : Date.now() / 1000; }

  private listen() {
    addEventListener('keydown', (event) => this.key(event));
    addEventListener('dragover', (event) => event.preventDefault());
    addEventListener('drop', (event) => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file && !this.isReport) void this.openFile(file);
    });
    addEventListener('resize', () => this.arrange());
  }
  private key(event: KeyboardEvent) {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (target.matches('input:not([type=range]), select, textarea')) return;
    const step = event.shiftKey ? 0.1 : 1;
    const onButton = target.matches('button, summary, label, [role=button]');
    if (event.key === ' ' && !onButton) this.playhead.toggle();
    else if (event.key === '<' || event.key === '>') this.playhead.changeSpeed(event.key === '>');
    else if (event.key === 'ArrowLeft') this.playhead.step(-step);
    else if (event.key === 'ArrowRight') this.playhead.step(step);
    else if (event.key === 'Home') this.playhead.seek(this.playhead.start);
    else if (event.key === 'End') this.playhead.goLive();
    else if (/^[1-9]$/.test(event.key)) {
      const one = this.framed[Number(event.key) - 1];
      if (one) this.show(one.panel.id);
    } else if (event.key === 'Escape') {
      if (this.graph.selected) this.inspect('');
      else if (this.alone) this.show(this.alone);
      return;
    } else if (event.key === '?') this.help.showModal();
    else if (event.key.toLowerCase() === 'o') document.getElementById('open')?.click();
    else return;
    event.preventDefault();
  }
}
