// The seed of a model: a number that is typed, and dice that throw another.
import { element } from './dom';

const most_seed = Number.MAX_SAFE_INTEGER, most_thrown = 1_000_000;

export class SeedField {
  readonly parts: HTMLElement[];
  private readonly input: HTMLInputElement;

  constructor(private readonly change: (value: number) => void) {
    this.input = element('input', { type: 'number', min: 0, max: most_seed, step: 1, class: 'seed', 'aria-label': 'Seed', placeholder: 'as the text says' });
    this.input.onchange = () => {
      const value = Number(this.input.value);
      if (this.input.value !== '' && Number.isInteger(value) && value >= 0 && value <= most_seed) this.change(value);
      else this.show(this.shown);
    };
    const dice = element('button', {
      type: 'button', class: 'small', 'aria-label': 'Throw another seed', title: 'Throw another seed',
      onclick: () => this.change(Math.floor(Math.random() * most_thrown)),
    }, '⚄');
    this.parts = [this.input, dice];
  }

  private shown: number | null = null;

  /** Null: nobody knows it. */
  show(value: number | null): void {
    this.shown = value;
    this.input.value = value === null ? '' : String(value);
  }
}
