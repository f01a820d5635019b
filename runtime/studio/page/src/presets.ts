// Named settings of the knobs and of the camera, kept by the browser for each model.
import { element } from './dom';
import type { Choices } from './protocol';
import type { Studio } from './studio';

type Preset = Pick<Choices, 'set' | 'steps' | 'time' | 'seed' | 'camera' | 'at' | 'zoom'>;

export class Presets {
  readonly element = element('div', { class: 'presets' });

  constructor(private readonly studio: Studio) {}

  show(): void {
    const presets = this.load();
    const name = element('input', { type: 'text', 'aria-label': 'Name of the preset', placeholder: 'name' });
    const form = element('form', { class: 'line' }, name, element('button', { class: 'quiet' }, 'Keep'));
    form.onsubmit = (event) => {
      event.preventDefault();
      if (!name.value.trim()) return name.focus();
      const { set, steps, time, seed, camera, at, zoom } = this.studio.history.now;
      this.store({ ...this.load(), [name.value.trim()]: { set, steps, time, seed, camera, at, zoom } });
    };
    this.element.replaceChildren(
      element('h2', {}, 'Presets'),
      element('ul', {}, ...Object.entries(presets).map(([label, preset]) => element('li', { class: 'line' },
        element('button', { type: 'button', class: 'link', onclick: () => this.studio.change(preset) }, label),
        element('button', {
          type: 'button', class: 'small', 'aria-label': `Delete ${label}`,
          onclick: () => {
            const { [label]: _, ...rest } = this.load();
            this.store(rest);
          },
        }, 'Delete')))),
      form,
    );
  }

  private get key(): string {
    return `graftal presets ${this.studio.history.now.name}`;
  }

  private load(): Record<string, Preset> {
    try {
      return JSON.parse(localStorage.getItem(this.key) ?? '{}') as Record<string, Preset>;
    } catch {
      return {};
    }
  }

  private store(presets: Record<string, Preset>): void {
    try {
      localStorage.setItem(this.key, JSON.stringify(presets));
    } catch {
      this.studio.say('The browser did not keep the preset: its storage is full or switched off.');
    }
    this.show();
  }
}
