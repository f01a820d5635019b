// Eight other models around this one: other seeds, other knobs or other rules. A click makes one of them the centre.
import { element } from './dom';
import { inflate, type Choices, type Tile } from './protocol';
import { tile_data } from './picture';
import type { Studio } from './studio';

const count = 8, at_once = 2;
/** Places of the others around the middle of three rows: a few lie beside and above it. */
const places = [3, 5, 1, 7, 0, 2, 6, 8];

interface Child extends Partial<Pick<Choices, 'text' | 'set' | 'seed'>> {
  says: string;
}

interface Cell {
  canvas: HTMLCanvasElement;
  button: HTMLButtonElement;
  /** What it changes of the model in the middle. */
  part: Partial<Choices>;
}

export class Vary {
  readonly element: HTMLElement;
  private readonly kind: HTMLSelectElement;
  private readonly spread: HTMLInputElement;
  private readonly told = element('p', { class: 'note', role: 'status' });
  private readonly awaited = new Map<number, Cell>();
  private cells: Cell[] = [];
  private waiting: Cell[] = [];
  private shown = false;
  private round = 0;
  private drawing = 0;
  private seed = 1;
  private middle: Cell | null = null;
  /** The picture in the middle is that of the model already: it was clicked. */
  private holds_middle = false;
  /** What the grid is around. */
  private around: Choices | null = null;

  constructor(private readonly grid: HTMLElement, private readonly studio: Studio) {
    this.kind = element('select', { id: 'vary-kind' },
      element('option', { value: 'parameters' }, 'knobs'), element('option', { value: 'seed' }, 'chance (seed)'), element('option', { value: 'rules' }, 'rules'));
    this.spread = element('input', { type: 'range', id: 'vary-spread', min: 0.02, max: 1, step: 0.01, value: 0.25 });
    this.kind.onchange = this.spread.onchange = () => this.fill();
    this.element = element('div', {},
      element('p', {}, 'The middle is your model. Click on another picture to make it the middle.'),
      element('div', { class: 'line' }, element('label', { for: 'vary-kind' }, 'What differs '), this.kind),
      element('div', { class: 'line' }, element('label', { for: 'vary-spread' }, 'How far '), this.spread),
      element('div', { class: 'line' },
        element('button', { type: 'button', class: 'quiet', id: 'vary-again', onclick: () => this.others() }, 'Show other variations'),
        element('button', { type: 'button', class: 'quiet', id: 'vary-back', onclick: () => studio.history.undo() }, 'Undo the last choice')),
      this.told,
    );
  }

  show(shown: boolean): void {
    this.grid.hidden = !shown;
    this.shown = shown;
    if (!shown) return;
    // Models without knobs have numbers in their rules.
    if (!this.around && this.studio.model && !this.studio.model.parameters.length) this.kind.value = 'rules';
    if (this.is_true) this.draw();
    else void this.fill();
  }

  /** Something changed: the grid is made anew where it is around something else. */
  changed(): void {
    if (this.shown && this.around && !this.is_true) void this.fill();
  }

  async tile(tile: Tile): Promise<void> {
    const cell = this.awaited.get(tile.number);
    if (!cell) return;
    const data = tile_data(tile, await inflate(tile.deflated));
    if (!data) return;
    const context = cell.canvas.getContext('2d')!;
    if (tile.coarse === 1) {
      context.putImageData(data, tile.x, tile.y);
    } else {
      const small = element('canvas', { width: data.width, height: data.height });
      small.getContext('2d')!.putImageData(data, 0, 0);
      context.drawImage(small, tile.x, tile.y, data.width * tile.coarse, data.height * tile.coarse);
    }
    cell.button.classList.remove('waits');
    this.tell();
  }

  private others(): void {
    ++this.seed;
    void this.fill();
  }

  /** Whether the grid is around the model as it is. */
  private get is_true(): boolean {
    const { around, studio: { history: { now } } } = this;
    return around !== null && (['name', 'text', 'set', 'seed', 'steps', 'time', 'camera', 'at', 'zoom'] as const).every((key) => now[key] === around[key]);
  }

  /** A picture was clicked: it is the middle at once, and others come around it. */
  private choose(cell: Cell): void {
    if (!Object.keys(cell.part).length) return;
    const { part, canvas } = cell, middle = this.middle!;
    this.holds_middle = !cell.button.classList.contains('waits');
    if (this.holds_middle) middle.canvas.getContext('2d')!.drawImage(canvas, 0, 0);
    for (const one of this.cells) if (one !== middle) clear(one);
    if (!this.holds_middle) middle.button.classList.add('waits');
    middle.button.focus();
    ++this.seed;
    this.studio.change(part);
  }

  private async fill(): Promise<void> {
    const { studio } = this, round = ++this.round;
    this.spread.disabled = this.kind.value === 'seed';
    if (!this.shown || !studio.model) return;
    const now = studio.history.now;
    this.around = now;
    this.awaited.clear();
    this.waiting = [];
    this.told.textContent = 'Looking for variations …';
    let children: Child[];
    try {
      const answer = await studio.session.ask('vary', {
        kind: this.kind.value, count, spread: Number(this.spread.value), seed: this.seed,
      });
      children = (answer['children'] as Child[]).slice(0, count);
    } catch (error) {
      if (round !== this.round) return;
      this.told.textContent = '';
      return studio.say((error as Error).message);
    }
    if (round !== this.round) return;
    if (!children.length) studio.say('There is nothing of this kind to vary in the model.');
    this.lay_out(now, children);
    this.draw();
  }

  /** The model lies in the middle, however many others there are. */
  private lay_out(now: Choices, children: Child[]): void {
    const { width_px, height_px } = this.studio.size, rows = children.length > 2 ? 3 : 1;
    const width = Math.max(16, Math.round(width_px / 3)), height = Math.max(16, Math.round(height_px / rows));
    const focus = [...this.grid.children].indexOf(document.activeElement!);
    const middle = this.cell({}, 'your model', width, height);
    middle.button.classList.add('centre');
    const others = children.map(({ says, ...part }) => this.cell(part.set ? { ...part, set: { ...now.set, ...part.set } } : part, says, width, height));
    const at = rows === 3 ? places.slice(0, others.length).sort() : [0, 2];
    const laid = [{ cell: middle, at: rows === 3 ? 4 : 1 }, ...others.map((cell, i) => ({ cell, at: at[i]! }))].sort((a, b) => a.at - b.at);
    for (const { cell: { button }, at } of laid) button.style.gridArea = `${Math.floor(at / 3) + 1} / ${(at % 3) + 1}`;
    this.grid.style.gridTemplateRows = `repeat(${rows}, minmax(0, 1fr))`;
    this.grid.replaceChildren(...laid.map(({ cell }) => cell.button));
    if (focus >= 0) (this.grid.children[focus] as HTMLElement | undefined)?.focus();
    if (this.holds_middle) {
      middle.canvas.getContext('2d')!.drawImage(this.middle!.canvas, 0, 0, width, height);
      middle.button.classList.remove('waits');
    }
    this.cells = laid.map(({ cell }) => cell);
    this.waiting = [...(this.holds_middle ? [] : [middle]), ...this.cells.filter((cell) => cell !== middle)];
    this.middle = middle;
    this.holds_middle = false;
  }

  private cell(part: Partial<Choices>, says: string, width: number, height: number): Cell {
    const canvas = element('canvas', { width, height });
    const button = element('button', { type: 'button', class: 'waits', title: says, onclick: () => this.choose(cell) }, canvas, element('span', {}, says));
    const cell: Cell = { canvas, button, part };
    return cell;
  }

  /** Asks for the pictures that are still missing, as long as the grid is shown. */
  private draw(): void {
    for (; this.drawing < at_once && this.waiting.length > 0; ++this.drawing) void this.draw_some();
    this.tell();
  }

  private async draw_some(): Promise<void> {
    const { session } = this.studio;
    for (let cell = this.shown ? this.waiting.shift() : undefined; cell; cell = this.shown ? this.waiting.shift() : undefined) {
      const { width, height } = cell.canvas;
      this.awaited.set(session.coming_id, cell);
      try {
        await session.ask('thumbnail', { ...this.around, ...cell.part, width, height });
      } catch (error) {
        cell.button.title = (error as Error).message;
        cell.button.classList.add('failed');
        cell.button.classList.remove('waits');
      }
      this.tell();
    }
    --this.drawing;
  }

  private tell(): void {
    const left = this.cells.filter(({ button }) => button.classList.contains('waits')).length;
    this.told.textContent = left > 0 ? `Drawing: ${this.cells.length - left} of ${this.cells.length} pictures are there.` : '';
  }
}

/** Nothing is there until another takes its place. */
function clear(cell: Cell): void {
  const { canvas, button } = cell;
  canvas.getContext('2d')!.clearRect(0, 0, canvas.width, canvas.height);
  button.classList.add('waits');
  button.lastElementChild!.textContent = '…';
  button.title = '';
  cell.part = {};
}
