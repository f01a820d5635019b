// A slider: coarse by drag, fine with shift, typed after a double click (or Enter on the number).
import { element, plain_number, set_attributes } from './dom';

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
  private exact: number;

  constructor(private readonly options: SliderOptions) {
    this.exact = options.value;
    this.range = element('input', { type: 'range', 'aria-label': options.label });
    this.number = element('button', { type: 'button', class: 'number', title: 'Double-click to type a number' });
    this.range.addEventListener('pointerdown', (event) => this.drag(event));
    this.range.addEventListener('keydown', (event) => this.key(event));
    // Assistive technology sets values without a pointer or key.
    this.range.addEventListener('input', () => this.put(Number(this.range.value)));
    this.number.addEventListener('dblclick', () => this.type());
    this.number.addEventListener('click', (event) => event.detail === 0 && this.type());
    this.show(options.value, options.least, options.most);
  }

  /** What each key step, or each drag of one pixel, may change: a hundredth, or finer where the range is small. */
  private get step(): number {
    return this.options.whole ? 1 : 10 ** Math.floor(Math.log10((this.options.most - this.options.least || 1) / 90));
  }

  /** `as_it_is`: what stands there in place of a number that nobody knows. */
  show(value: number, least: number, most: number, as_it_is?: string): void {
    this.options.least = Math.min(least, value);
    this.options.most = Math.max(most, value);
    if (Math.abs(value - this.exact) > 1e-12) this.exact = value;
    set_attributes(this.range, { min: this.options.least, max: this.options.most, step: this.options.whole === 'always' ? 1 : 'any' });
    this.range.value = String(value);
    const text = as_it_is ?? plain_number(value);
    this.number.textContent = text;
    this.number.setAttribute('aria-label', `${this.options.label}: ${text}. Type a number`);
    this.range.style.setProperty('--share', String((value - this.options.least) / (this.options.most - this.options.least || 1)));
  }

  private put(value: number, fine = false): void {
    const { least, most, whole, change } = this.options;
    this.exact = Math.max(least, Math.min(most, value));
    const rounded = whole === 'always' || (whole && !fine) ? Math.round(this.exact) : Number(this.exact.toPrecision(6));
    const exact = this.exact;
    this.show(rounded, least, most);
    this.exact = exact;
    change(rounded);
  }

  private drag(down: PointerEvent): void {
    if (down.button !== 0 || !down.isPrimary) return;
    down.preventDefault();
    const { range } = this, box = range.getBoundingClientRect();
    range.focus();
    range.setPointerCapture(down.pointerId);
    const span = () => this.options.most - this.options.least;
    if (!down.shiftKey) this.put(this.options.least + ((down.clientX - box.left - 8) / (box.width - 16)) * span());
    let last = down;
    const move = (event: PointerEvent) => {
      const by = ((event.clientX - last.clientX) / (box.width - 16)) * span();
      last = event;
      this.put(this.exact + (event.shiftKey ? by / 20 : by), event.shiftKey);
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
      const fine = event.shiftKey && this.options.whole !== 'always';
      value = Number((this.exact + steps * (fine ? 0.1 : 1) * this.step).toFixed(12));
      event.preventDefault();
      return this.put(value, fine);
    } else if (event.key === 'Home') value = least;
    else if (event.key === 'End') value = most;
    else if (event.key === 'Enter') return this.type();
    else return;
    event.preventDefault();
    this.put(value);
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
      this.put(value, true);
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
