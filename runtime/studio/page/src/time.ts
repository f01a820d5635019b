// Time: a scrubber for the age or the steps, with play; key frames, and the film of both.
import { element } from './dom';
import { Film, moving, values_at, type Course } from './film';
import { Slider } from './slider';
import type { Studio } from './studio';

type Key = 'time' | 'steps';

/** Seconds as people read them. */
const tidy = (seconds: number): number => Number(seconds.toFixed(2));

export class Time {
  readonly element: HTMLElement;
  readonly film: Film;
  private readonly slider: Slider;
  private readonly play_button: HTMLButtonElement;
  private readonly ends: Record<'least' | 'most' | 'seconds', HTMLInputElement>;
  private readonly key: HTMLSelectElement;
  private readonly runs = element('input', { type: 'checkbox', id: 'time-runs' });
  /** Where the film stands. */
  private now_seconds = 0;
  private playing = 0;
  /** The model for which it was chosen whether the time runs. */
  private chosen_for = '';

  /** `moved`: the film is another one now. */
  constructor(private readonly studio: Studio, private readonly moved: () => void) {
    const field = (id: string, value: number, label: string) => element('input', { id, type: 'number', value, 'aria-label': label, step: 'any' });
    this.ends = { least: field('time-least', 0, 'From'), most: field('time-most', 10, 'To'), seconds: field('time-seconds', 5, 'Seconds') };
    this.key = element('select', { id: 'time-key', 'aria-label': 'Time' }, element('option', { value: 'time' }, 'age'), element('option', { value: 'steps' }, 'steps'));
    this.slider = new Slider({
      label: 'Moment', value: 0, least: 0, most: 5,
      change: (value) => {
        this.stop();
        this.put(value);
      },
    });
    this.play_button = element('button', { type: 'button', class: 'quiet', id: 'play', onclick: () => (this.playing ? this.stop() : this.play()) }, 'Play');
    for (const input of [...Object.values(this.ends), this.runs]) {
      input.onchange = () => {
        this.show();
        moved();
      };
    }
    this.key.onchange = () => {
      this.stop();
      this.show();
      moved();
    };
    this.film = new Film(studio, () => this.course());
    this.element = element('div', {},
      element('div', { class: 'line' }, this.runs, element('label', { for: 'time-runs' }, 'The model grows: '), this.key,
        element('label', {}, 'from ', this.ends.least), element('label', {}, 'to ', this.ends.most)),
      element('div', { class: 'knob' }, element('span', { class: 'name' }, 'Second'), this.slider.range, this.slider.number,
        element('button', { type: 'button', class: 'small', 'aria-label': 'Reset time', title: 'Reset time', onclick: () => this.reset() }, '↺')),
      element('div', { class: 'line' }, this.play_button, element('label', {}, 'in ', this.ends.seconds, ' seconds')),
      this.film.element,
    );
  }

  show(): void {
    this.follow();
    this.slider.show(this.now_seconds, 0, this.seconds);
    this.film.show();
  }

  /** A plant grows by itself; the time of other models stands still until somebody wants it. */
  model_came(): void {
    const { name } = this.studio.history.now;
    if (this.chosen_for === name) return;
    this.chosen_for = name;
    const { model } = this.studio, is_lsys = name.toLowerCase().endsWith('.lsys');
    const steps = model?.parameters.find((parameter) => parameter.name === 'steps')?.value;
    this.runs.checked = is_lsys && model?.grows !== false;
    if (is_lsys) this.ends.least.value = '1';
    if (steps !== undefined) this.ends.most.value = String(steps);
    this.show();
    if (this.shown_film) this.moved();
  }

  tab(is_shown: boolean): void {
    if (is_shown) this.show();
    else this.stop();
  }

  /** The film of which the picture is a moment: all its moments are framed together, whatever tab is open. */
  get shown_film(): object | null {
    const { now } = this.studio.history;
    const grows = this.runs.checked && (now.time !== null || (this.key.value === 'steps' && now.steps !== null));
    return grows || moving(now.keys).length > 0 ? this.film.film() : null;
  }

  /** The film stands where the picture is, which others may have changed. */
  private follow(): void {
    const { model, history: { now } } = this.studio, [least, most] = this.range;
    if (this.playing || !this.runs.checked) return;
    const shown = now.time ?? now.steps;
    if (shown !== null && shown === this.growth_at(this.now_seconds)) return;
    const whole = model?.parameters.find(({ name }) => name === 'steps')?.value ?? most;
    const share = ((shown ?? whole) - least) / (most - least);
    this.now_seconds = tidy(this.seconds * Math.max(0, Math.min(1, share)));
  }

  /** The time, or the steps, at a moment. */
  private growth_at(seconds: number): number {
    const [least, most] = this.range, time = Number((least + ((most - least) * seconds) / this.seconds).toFixed(4));
    return this.key.value === 'steps' ? Math.max(0, Math.round(time)) : time;
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

  private get seconds(): number {
    return Math.max(0.2, Number(this.ends.seconds.value) || 5);
  }

  private course(): Course {
    return {
      seconds: this.seconds, now_seconds: this.now_seconds, steps: this.runs.checked ? this.range : null,
      show_at: (seconds) => {
        this.stop();
        this.put(seconds);
      },
    };
  }

  /** Shows a moment of the film: the knobs of its key frames, and the time. */
  private put(seconds: number): void {
    const { now } = this.studio.history, key = this.key.value as Key;
    this.now_seconds = tidy(Math.max(0, Math.min(this.seconds, seconds)));
    this.slider.show(this.now_seconds, 0, this.seconds);
    const set = { ...now.set, ...values_at(now.keys, this.now_seconds) };
    const shown = this.runs.checked ? this.growth_at(this.now_seconds) : now[key];
    if (now[key] !== shown || JSON.stringify(now.set) !== JSON.stringify(set)) this.studio.change({ [key]: shown, set }, 'time');
  }

  private reset(): void {
    this.now_seconds = 0;
    this.studio.change({ time: null, steps: null });
  }

  private play(): void {
    const { keys } = this.studio.history.now;
    if (!this.runs.checked && keys.length < 2) {
      this.studio.say('Nothing moves yet: let the model grow, or keep two key frames.');
      return;
    }
    const seconds = this.seconds, from = this.now_seconds >= seconds ? 0 : this.now_seconds;
    const begun_ms = performance.now() - from * 1000;
    this.play_button.textContent = 'Pause';
    const frame = () => {
      this.playing = requestAnimationFrame(frame);
      // Frames are drawn one after the other: the next is asked for when the picture of this one has begun.
      if (this.studio.session.busy) return;
      const now_seconds = (performance.now() - begun_ms) / 1000;
      this.put(Math.min(seconds, now_seconds));
      if (now_seconds >= seconds) this.stop();
    };
    this.playing = requestAnimationFrame(frame);
  }
}
