// Eight other models around this one: other seeds, other knobs or other rules. A click makes one of them the centre.
import { element } from './dom';
import { inflate, type Choices, type Tile } from './protocol';
import { tile_data } from './picture';
import type { Studio } from './studio';

const count = 8, centre = 4, at_once = 2;

interface Child extends Partial<Pick<Choices, 'text' | 'set' | 'seed'>> {
  says: string;
}

export class Vary {
  readonly element: HTMLElement;
  private readonly kind: HTMLSelectElement;
  private readonly spread: HTMLInputElement;
  private readonly awaited = new Map<number, HTMLCanvasElement>();
  private shown = false;
  private round = 0;
  private seed = 1;
  /** What the grid is around. */
  private around: Choices | null = null;

  constructor(private readonly grid: HTMLElement, private readonly studio: Studio) {
    this.kind = element('select', { id: 'vary-kind' },
      element('option', { value: 'parameters' }, 'knobs'), element('option', { value: 'seed' }, 'seeds'), element('option', { value: 'rules' }, 'rules'));
    this.spread = element('input', { type: 'range', id: 'vary-spread', min: 0.02, max: 1, step: 0.01, value: 0.25 });
    this.kind.onchange = this.spread.onchange = () => this.fill();
    this.element = element('div', {},
      element('p', {}, 'The middle is your model. Click on another picture to make it the middle.'),
      element('div', { class: 'line' }, element('label', { for: 'vary-kind' }, 'Vary '), this.kind),
      element('div', { class: 'line' }, element('label', { for: 'vary-spread' }, 'How far '), this.spread),
      element('div', { class: 'line' },
        element('button', { type: 'button', class: 'quiet', id: 'vary-again', onclick: () => { ++this.seed; this.fill(); } }, 'Others'),
        element('button', { type: 'button', class: 'quiet', id: 'vary-back', onclick: () => studio.history.undo() }, 'Back')),
    );
  }

  show(shown: boolean): void {
    this.grid.hidden = !shown;
    if (shown && !this.shown) {
      this.shown = true;
      // Models without knobs have numbers in their rules.
      if (this.studio.model && !this.studio.model.parameters.length && this.kind.value === 'parameters') this.kind.value = 'rules';
      this.fill();
    } else if (!shown) {
      this.shown = false;
      this.around = null;
      ++this.round;
    }
  }

  /** Something changed: the grid is made anew where it is around something else. */
  changed(): void {
    const { now } = this.studio.history, { around } = this;
    if (!this.shown || !around) return;
    if (now.text !== around.text || now.set !== around.set || now.seed !== around.seed || now.steps !== around.steps) this.fill();
  }

  async tile(tile: Tile): Promise<void> {
    const canvas = this.awaited.get(tile.number);
    if (!canvas) return;
    const data = tile_data(tile, await inflate(tile.deflated));
    if (!data) return;
    if (tile.coarse === 1) {
      canvas.getContext('2d')!.putImageData(data, tile.x, tile.y);
    } else {
      const small = element('canvas', { width: data.width, height: data.height });
      small.getContext('2d')!.putImageData(data, 0, 0);
      canvas.getContext('2d')!.drawImage(small, tile.x, tile.y, data.width * tile.coarse, data.height * tile.coarse);
    }
  }

  private async fill(): Promise<void> {
    const { studio } = this, round = ++this.round;
    if (!this.shown || !studio.model) return;
    const now = studio.history.now;
    this.around = now;
    this.awaited.clear();
    let children: Child[];
    try {
      const answer = await studio.session.ask('vary', {
        kind: this.kind.value, count, spread: Number(this.spread.value), seed: this.seed,
      });
      children = answer['children'] as Child[];
    } catch (error) {
      if (round === this.round) studio.say((error as Error).message);
      return;
    }
    if (round !== this.round) return;
    if (!children.length) studio.say('There is nothing of this kind to vary in the model.');
    const width = Math.max(16, Math.round(studio.size.width_px / 3)), height = Math.max(16, Math.round(studio.size.height_px / 3));
    const entries: Child[] = [...children.slice(0, centre), { says: 'this model' }, ...children.slice(centre, count)];
    const focus = [...this.grid.children].indexOf(document.activeElement!);
    const cells = entries.map((child) => {
      const canvas = element('canvas', { width, height });
      const cell = element('button', {
        type: 'button', class: child.says === 'this model' ? 'centre' : '',
        onclick: () => {
          const { says: _, ...part } = child;
          if (Object.keys(part).length) studio.change(part.set ? { ...part, set: { ...now.set, ...part.set } } : part);
        },
      }, canvas, element('span', {}, child.says));
      return { canvas, cell, child };
    });
    this.grid.replaceChildren(...cells.map(({ cell }) => cell));
    if (focus >= 0) (this.grid.children[focus] as HTMLElement | undefined)?.focus();
    const waiting = [...cells];
    const worker = async () => {
      for (let next = waiting.shift(); next && round === this.round; next = waiting.shift()) {
        const { says: _, ...part } = next.child;
        const id = studio.session.coming_id;
        this.awaited.set(id, next.canvas);
        try {
          await studio.session.ask('thumbnail', {
            ...now, ...part, ...(part.set ? { set: { ...now.set, ...part.set } } : {}), width, height,
          });
        } catch (error) {
          next.cell.title = (error as Error).message;
          next.cell.classList.add('failed');
        }
      }
    };
    for (let i = 0; i < at_once; ++i) void worker();
  }
}
