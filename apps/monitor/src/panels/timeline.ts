// SPDX-License-Identifier: Apache-2.0
// Pause, and go through the last minute, or through a recording.
import type {Hub} from '../hub';
import type {Playhead} from '../playhead';
import {make, write} from '../view';
import type {LogEvent} from './log_panel';

export class Timeline {
  private readonly play = make('button', {type: 'button', class: 'play'});
  private readonly live = make('button', {type: 'button', class: 'live'}, 'Live');
  private readonly slider = make('input', {type: 'range', min: 0, max: 1000, step: 1, 'aria-label': 'Time'});
  private readonly ticks = make('div', {class: 'ticks', 'aria-hidden': 'true'});
  private readonly label = make('output', {class: 'when'});
  private readonly open = make('input', {type: 'file', accept: '.mcap', id: 'open', class: 'visually-hidden', tabindex: 0});
  private readonly performance = make('span', {class: 'performance', title: 'Time that drawing takes, memory of what is remembered'});
  private tickKey = '';

  constructor(element: HTMLElement, private readonly playhead: Playhead, onFile: (file: File) => void, onHelp: () => void, onAbout?: () => void) {
    const opener = make('label', {for: 'open', class: 'button', title: 'Open a recording (MCAP)'}, 'Open recording');
    const help = make('button', {type: 'button', title: 'Keys (?)', 'aria-label': 'Help'}, '?');
    this.play.addEventListener('click', () => this.playhead.toggle());
    this.live.addEventListener('click', () => this.playhead.goLive());
    help.addEventListener('click', onHelp);
    this.slider.addEventListener('input', () => {
      const {start, end} = this.playhead;
      this.playhead.isPlaying = false;
      this.playhead.seek(start + (Number(this.slider.value) / 1000) * (end - start));
    });
    this.open.addEventListener('change', () => {
      const file = this.open.files?.[0];
      if (file) onFile(file);
      this.open.value = '';
    });
    const about = make('button', {type: 'button', class: 'about'}, 'About this run');
    if (onAbout) about.addEventListener('click', onAbout);
    // A report shows its own run and no other.
    const source = onAbout ? [about] : [this.live, this.open, opener];
    element.append(this.play, make('div', {class: 'track'}, this.ticks, this.slider), this.label, ...source, this.performance, help);
  }

  draw(hub: Hub, events: LogEvent[], frameMs: number) {
    const {t, start, end, isLive, isPlaying} = this.playhead;
    const runs = isLive || isPlaying, span = end - start;
    write(this.play, runs ? '❚❚ Pause' : '▶ Play');
    this.play.setAttribute('aria-pressed', String(!runs));
    this.live.hidden = hub.source?.kind !== 'live';
    write(this.live, hub.isPlayed ? 'Newest' : 'Live');
    this.live.classList.toggle('on', isLive);
    const value = span > 0 ? Math.round(((t - start) / span) * 1000) : 1000;
    if (document.activeElement !== this.slider || runs) this.slider.value = String(value);
    write(this.label, !Number.isFinite(t) ? 'no data yet' : hub.recording ? `${(t - start).toFixed(1)} of ${span.toFixed(1)} s` : isLive ? (hub.isPlayed ? 'recording' : 'live') : `${(t - end).toFixed(1)} s`);
    this.slider.setAttribute('aria-valuetext', this.label.textContent ?? '');
    this.drawTicks(events, start, span);
    const first = Number.isFinite(hub.firstDataMs) ? `first data ${(hub.firstDataMs / 1000).toFixed(2)} s` : 'no data yet';
    write(this.performance, `${first} · frame ${frameMs.toFixed(1)} ms · ${(hub.store.bytes() / 1e6).toFixed(0)} MB`);
  }
  private drawTicks(events: LogEvent[], start: number, span: number) {
    const key = `${events.length} ${Math.round(start * 4)} ${Math.round(span)}`;
    if (key === this.tickKey || !(span > 0)) return;
    this.tickKey = key;
    this.ticks.replaceChildren(...events.filter(({t}) => t >= start && t <= start + span).map(({t, level, text}) => {
      const tick = make('i', {class: level, title: text});
      tick.style.left = `${((t - start) / span) * 100}%`;
      return tick;
    }));
  }
}
