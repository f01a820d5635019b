// Time: a scrubber for the age or the steps, with play.
import { element } from './dom';
import { Slider } from './slider';
import type { Studio } from './studio';

type Key = 'time' | 'steps';

export class Time {
  readonly element: HTMLElement;
  private readonly slider: Slider;
  private readonly play_button: HTMLButtonElement;
  private readonly ends: Record<'least' | 'most' | 'seconds', HTMLInputElement>;
  private readonly key: HTMLSelectElement;
  private playing = 0;

  constructor(private readonly studio: Studio) {
    const field = (id: string, value: number, label: string) => element('input', { id, type: 'number', value, 'aria-label': label, step: 'any' });
    this.ends = { least: field('time-least', 0, 'From'), most: field('time-most', 10, 'To'), seconds: field('time-seconds', 5, 'Seconds') };
    this.key = element('select', { id: 'time-key' }, element('option', { value: 'time' }, 'time'), element('option', { value: 'steps' }, 'steps'));
    this.slider = new Slider({
      label: 'Time', value: 0, least: 0, most: 10,
      change: (value) => {
        this.stop();
        this.put(value);
      },
    });
    this.play_button = element('button', { type: 'button', class: 'quiet', id: 'play', onclick: () => (this.playing ? this.stop() : this.play()) }, 'Play');
    for (const input of Object.values(this.ends)) input.onchange = () => this.show();
    this.key.onchange = () => {
      this.stop();
      this.show();
    };
    this.element = element('div', {},
      element('div', { class: 'line' }, element('label', { for: 'time-key' }, 'Over '), this.key,
        element('label', {}, 'from ', this.ends.least), element('label', {}, 'to ', this.ends.most)),
      element('div', { class: 'knob' }, element('span', { class: 'name' }, 'Now'), this.slider.range, this.slider.number,
        element('button', { type: 'button', class: 'small', 'aria-label': 'Reset time', title: 'Reset time', onclick: () => studio.change({ [this.key.value]: null }) }, '↺')),
      element('div', { class: 'line' }, this.play_button, element('label', {}, 'in ', this.ends.seconds, ' seconds')),
      element('p', { class: 'note' }, 'A model reads the time as ', element('code', {}, 'age'), '. Each frame shows as soon as it is drawn.'),
    );
  }

  show(): void {
    const { now } = this.studio.history, key = this.key.value as Key;
    const [least, most] = this.range;
    this.slider.show(now[key] ?? least, least, most);
  }

  stop(): void {
    if (!this.playing) return;
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    this.play_button.textContent = 'Play';
  }

  private get range(): [number, number] {
    const least = Number(this.ends.least.value) || 0, most = Number(this.ends.most.value);
    return [least, most > least ? most : least + 1];
  }

  private put(value: number): void {
    const key = this.key.value as Key;
    const shown = key === 'steps' ? Math.max(0, Math.round(value)) : value;
    if (this.studio.history.now[key] !== shown) this.studio.change({ [key]: shown }, 'time');
  }

  private play(): void {
    const [least, most] = this.range, seconds = Math.max(0.2, Number(this.ends.seconds.value) || 5);
    const key = this.key.value as Key, from = this.studio.history.now[key] ?? least;
    const begun_ms = performance.now() - (((from >= most ? least : from) - least) / (most - least)) * seconds * 1000;
    this.play_button.textContent = 'Pause';
    const frame = () => {
      this.playing = requestAnimationFrame(frame);
      // Frames are drawn one after the other: the next is asked for when the picture of this one has begun.
      if (this.studio.session.busy) return;
      const share = (performance.now() - begun_ms) / (seconds * 1000);
      this.put(Number((least + (most - least) * Math.min(1, share)).toFixed(4)));
      if (share >= 1) this.stop();
    };
    this.playing = requestAnimationFrame(frame);
  }
}
