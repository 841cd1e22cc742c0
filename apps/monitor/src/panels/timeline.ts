// SPDX-License-Identifier: Apache-2.0
// Pause, and go through the last minute, or through a recording at any speed.
import type {Hub} from '../hub';
import {kSpeeds, type Playhead} from '../playhead';
import {make, write} from '../view';
import type {LogEvent} from './log_panel';
import {clock, marksOf} from './time_scale';

const kParts = 1000;  // of the slider

export class Timeline {
  private readonly play = make('button', {type: 'button', class: 'play'});
  private readonly live = make('button', {type: 'button', class: 'live'}, 'Live');
  private readonly slider = make('input', {type: 'range', min: 0, max: kParts, step: 'any', 'aria-label': 'Time'});
  private readonly ticks = make('div', {class: 'ticks', 'aria-hidden': 'true'});
  private readonly scale = make('div', {class: 'scale', 'aria-hidden': 'true'});
  private readonly label = make('output', {class: 'when'});
  private readonly speed = make('select', {class: 'speed', title: 'Times as fast as it was (< and >)', 'aria-label': 'Speed'});
  private readonly open = make('input', {type: 'file', accept: '.mcap', id: 'open', class: 'visually-hidden', tabindex: 0});
  private readonly performance = make('span', {class: 'performance', title: 'Time that drawing takes, memory of what is remembered'});
  private tickKey = '';
  private scaleKey = '';
  private isHeld = false;  // the slider, by a finger or the mouse

  constructor(element: HTMLElement, private readonly playhead: Playhead, onFile: (file: File) => void, onHelp: () => void, onAbout?: () => void) {
    const opener = make('label', {for: 'open', class: 'button', title: 'Open a recording (MCAP)'}, 'Open recording');
    const help = make('button', {type: 'button', title: 'Keys (?)', 'aria-label': 'Help'}, '?');
    help.addEventListener('click', onHelp);
    this.listen(onFile);
    const about = make('button', {type: 'button', class: 'about'}, 'About this run');
    if (onAbout) about.addEventListener('click', onAbout);
    // A report shows its own run and no other.
    const source = onAbout ? [about] : [this.live, this.open, opener];
    const track = make('div', {class: 'track'}, this.ticks, this.slider, this.scale);
    element.append(this.play, track, this.label, this.speed, ...source, this.performance, help);
  }

  draw(hub: Hub, events: LogEvent[], frameMs: number) {
    const {position, start, end, isLive, isPlaying, isRecording} = this.playhead;
    const runs = isRecording ? isPlaying : isLive, span = end - start;
    write(this.play, runs ? '❚❚ Pause' : '▶ Play');
    this.play.setAttribute('aria-pressed', String(!runs));
    this.play.title = hub.playback ? 'Plays and pauses for all who watch (Space)' : 'Space';
    this.live.hidden = isRecording;
    this.live.classList.toggle('on', isLive);
    this.drawSlider(runs, span > 0 ? ((position - start) / span) * kParts : kParts);
    write(this.label, !Number.isFinite(position) ? 'no data yet' : isRecording ? `${clock(position - start)} of ${clock(span)}` : isLive ? 'live' : `${(position - end).toFixed(1)} s`);
    this.slider.setAttribute('aria-valuetext', this.label.textContent ?? '');
    this.drawSpeed();
    this.drawTicks(events, start, span);
    this.drawScale(isRecording ? span : 0);
    const first = Number.isFinite(hub.firstDataMs) ? `first data ${(hub.firstDataMs / 1000).toFixed(2)} s` : 'no data yet';
    write(this.performance, `${first} · frame ${frameMs.toFixed(1)} ms · ${(hub.store.bytes() / 1e6).toFixed(0)} MB`);
  }

  private listen(onFile: (file: File) => void) {
    this.play.addEventListener('click', () => this.playhead.toggle());
    this.live.addEventListener('click', () => this.playhead.goLive());
    this.slider.addEventListener('input', () => {
      const {start, end} = this.playhead;
      this.playhead.scrub(start + (Number(this.slider.value) / kParts) * (end - start));
    });
    this.slider.addEventListener('pointerdown', () => (this.isHeld = true));
    for (const end of ['pointerup', 'pointercancel', 'change']) this.slider.addEventListener(end, () => (this.isHeld = false));
    this.speed.addEventListener('change', () => {
      this.playhead.speed = Number(this.speed.value);
      this.speed.blur();  // the keys are those of the page again
    });
    this.open.addEventListener('change', () => {
      const file = this.open.files?.[0];
      if (file) onFile(file);
      this.open.value = '';
    });
  }
  private drawSlider(runs: boolean, value: number) {
    if (this.isHeld || (document.activeElement === this.slider && !runs && !this.playhead.isRecording)) return;
    this.slider.value = String(value);
  }
  /// A speed that is none of the list, of `--rate` or of another who watches, stands in it while it lasts.
  private drawSpeed() {
    const {speed, isRecording} = this.playhead;
    this.speed.hidden = !isRecording;
    const shown = Number(speed.toPrecision(3));
    const all = kSpeeds.includes(shown) ? kSpeeds : [...kSpeeds, shown].sort((a, b) => a - b);
    if (this.speed.dataset.all !== all.join()) {
      this.speed.dataset.all = all.join();
      this.speed.replaceChildren(...all.map((one) => make('option', {value: one}, `${one} ×`)));
    }
    if (document.activeElement !== this.speed) this.speed.value = String(shown);
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
  private drawScale(span: number) {
    this.scale.hidden = !(span > 0);
    const width = this.scale.clientWidth, key = `${span} ${width}`;
    if (key === this.scaleKey) return;
    this.scaleKey = key;
    this.scale.replaceChildren(...marksOf(span, width).map((t) => {
      const mark = make('span', {}, clock(t, 0));
      mark.style.left = `${(t / span) * 100}%`;
      return mark;
    }));
  }
}
