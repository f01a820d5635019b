// A slider: coarse by drag, fine with shift, typed after a double click (or Enter on the number).
import { element, plain_number, rounded, set_attributes } from './dom';

export interface SliderOptions {
  label: string;
  value: number;
  least: number;
  most: number;
  /** Whole numbers: only such, or also others where the hand moves finely. */
  whole?: 'always' | 'coarse' | null;
  change(value: number): void;
}

export class Slider {
  readonly range: HTMLInputElement;
  readonly number: HTMLButtonElement;
  /** Where the hand is: the value that is shown is rounded. */
  private exact: number;
  private shown: number;

  constructor(private readonly options: SliderOptions) {
    this.exact = this.shown = options.value;
    this.range = element('input', { type: 'range', 'aria-label': options.label });
    this.number = element('button', { type: 'button', class: 'number' });
    this.range.addEventListener('pointerdown', (event) => this.drag(event));
    this.range.addEventListener('keydown', (event) => this.key(event));
    // Assistive technology sets values without a pointer or key.
    this.range.addEventListener('input', () => this.put(Number(this.range.value), this.step));
    this.number.addEventListener('dblclick', () => this.type());
    this.number.addEventListener('click', (event) => event.detail === 0 && this.type());
    this.show(options.value, options.least, options.most);
  }

  /** What each key step may change: a hundredth, or less. */
  private get step(): number {
    return this.options.whole ? 1 : 10 ** Math.floor(Math.log10((this.options.most - this.options.least || 1) / 90));
  }

  /** `as_it_is`: what stands there in place of a number that nobody knows. */
  show(value: number, least: number, most: number, as_it_is?: string): void {
    this.options.least = Math.min(least, value);
    this.options.most = Math.max(most, value);
    if (value !== this.shown) this.exact = value;
    this.shown = value;
    set_attributes(this.range, { min: this.options.least, max: this.options.most, step: this.options.whole === 'always' ? 1 : 'any' });
    this.range.value = String(value);
    const text = as_it_is ?? plain_number(value);
    this.number.textContent = text;
    this.number.title = `${as_it_is === undefined ? '' : 'As the model is. '}Double-click to type a number`;
    this.number.setAttribute('aria-label', `${this.options.label}: ${text}. Type a number`);
    this.range.style.setProperty('--share', String((value - this.options.least) / (this.options.most - this.options.least || 1)));
  }

  /** `step`: what the hand can tell; 0: everything. */
  private put(value: number, step: number, fine = false): void {
    const { least, most, whole, change } = this.options;
    const exact = Math.max(least, Math.min(most, value));
    const whole_step = whole === 'always' || (whole && !fine) ? 1 : step;
    const written = exact === least || exact === most ? exact : Math.max(least, Math.min(most, rounded(exact, whole_step)));
    this.show(written, least, most);
    this.exact = exact;
    change(written);
  }

  private drag(down: PointerEvent): void {
    if (down.button !== 0 || !down.isPrimary) return;
    down.preventDefault();
    const { range } = this, box = range.getBoundingClientRect();
    range.focus();
    range.setPointerCapture(down.pointerId);
    const per_px = () => (this.options.most - this.options.least) / Math.max(1, box.width - 16);
    if (!down.shiftKey) this.put(this.options.least + (down.clientX - box.left - 8) * per_px(), per_px());
    let last = down;
    const move = (event: PointerEvent) => {
      const by = event.shiftKey ? per_px() / 20 : per_px(), px = event.clientX - last.clientX;
      last = event;
      if (px) this.put(this.exact + px * by, by, event.shiftKey);
    };
    const up = () => {
      range.removeEventListener('pointermove', move);
      range.removeEventListener('lostpointercapture', up);
    };
    range.addEventListener('pointermove', move);
    range.addEventListener('lostpointercapture', up);
  }

  private key(event: KeyboardEvent): void {
    const { least, most } = this.options;
    const by: Record<string, number> = {
      ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10,
    };
    const steps = by[event.key];
    let value: number;
    if (steps !== undefined) {
      const fine = event.shiftKey && this.options.whole !== 'always', step = (fine ? 0.1 : 1) * this.step;
      event.preventDefault();
      return this.put(this.exact + steps * step, step, fine);
    } else if (event.key === 'Home') value = least;
    else if (event.key === 'End') value = most;
    else if (event.key === 'Enter') return this.type();
    else return;
    event.preventDefault();
    this.put(value, 0);
  }

  private type(): void {
    const input = element('input', { type: 'text', inputmode: 'decimal', class: 'number', 'aria-label': this.options.label });
    input.value = this.number.textContent ?? '';
    let closed = false;
    const close = (keep: boolean) => {
      if (closed) return;
      closed = true;
      const value = Number(input.value.replace(',', '.'));
      const had_focus = document.activeElement === input;
      input.replaceWith(this.number);
      if (had_focus) this.number.focus();
      if (!keep || input.value.trim() === '' || !Number.isFinite(value)) return;
      this.options.least = Math.min(this.options.least, value);
      this.options.most = Math.max(this.options.most, value);
      this.put(value, 0, true);
    };
    input.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') close(true);
      else if (event.key === 'Escape') close(false);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    input.addEventListener('blur', () => close(true));
    this.number.replaceWith(input);
    input.select();
  }
}
