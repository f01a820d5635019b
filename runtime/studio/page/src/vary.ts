// Eight other models around this one: other seeds, other knobs or other rules. A click makes one of them the centre.
import { element, set_attributes } from './dom';
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

/** The pictures that are shown together. */
interface Grid {
  /** The model in the middle. */
  around: Choices;
  kind: string;
  spread: string;
  rows: number;
  middle: Cell;
  /** Cells in the order of their places. */
  cells: Cell[];
  /** Cells whose pictures nobody has asked for. */
  waiting: Cell[];
  /** Others than the middle are not known yet. */
  is_blank: boolean;
}

/** Grids that are kept have nine pictures each. */
const most_grids = 8;
/** A model's variations depend on these. */
const shape = ['name', 'text', 'set', 'seed', 'steps', 'time', 'camera', 'at', 'zoom'] as const;
const is_same = (a: Choices, b: Choices): boolean => shape.every((key) => a[key] === b[key]);

export class Vary {
  readonly element: HTMLElement;
  private readonly kind: HTMLSelectElement;
  private readonly spread: HTMLInputElement;
  private readonly told = element('p', { class: 'note', role: 'status' });
  private readonly spread_why = element('span', { class: 'note', id: 'vary-why', hidden: true }, 'Seeds are not near or far.');
  private readonly back_button: HTMLButtonElement;
  private readonly awaited = new Map<number, Cell>();
  /** Grids in the order in which they were shown. */
  private grids: Grid[] = [];
  /** The number of the grid that shows. */
  private at = -1;
  private shown = false;
  /** Grids that were asked for: an answer to an older one is too late. */
  private round = 0;
  private drawing = 0;
  private seed = 1;

  constructor(private readonly grid: HTMLElement, private readonly studio: Studio) {
    this.kind = element('select', { id: 'vary-kind' },
      element('option', { value: 'parameters' }, 'knobs'), element('option', { value: 'seed' }, 'chance (seed)'), element('option', { value: 'rules' }, 'rules'));
    this.spread = element('input', { type: 'range', id: 'vary-spread', min: 0.02, max: 1, step: 0.01, value: 0.25, 'aria-describedby': 'vary-why' });
    this.back_button = element('button', { type: 'button', class: 'quiet', id: 'vary-back', hidden: true, onclick: () => this.back() }, 'Back to the pictures before');
    this.kind.onchange = this.spread.onchange = () => this.fill();
    this.element = element('div', {},
      element('p', {}, 'The middle is your model. Click on another picture to make it the middle; those before are kept.'),
      element('div', { class: 'line' }, element('label', { for: 'vary-kind' }, 'What differs '), this.kind),
      element('div', { class: 'line' }, element('label', { for: 'vary-spread' }, 'How far '), this.spread, this.spread_why),
      element('div', { class: 'line' },
        element('button', { type: 'button', class: 'quiet', id: 'vary-again', onclick: () => this.others() }, 'Show other variations'),
        this.back_button),
      this.told,
    );
  }

  show(shown: boolean): void {
    this.grid.hidden = !shown;
    this.shown = shown;
    if (!shown) return;
    // Models without knobs have numbers in their rules.
    if (!this.grid_shown && this.studio.model && !this.studio.model.parameters.length) this.kind.value = 'rules';
    if (this.is_true) this.draw();
    else this.changed();
  }

  /** Something changed: the grid is one that was around the model as it is, or is made anew. */
  changed(): void {
    if (!this.shown || this.is_true) return;
    const { now } = this.studio.history, fit = this.grids.flatMap(({ around, is_blank }, at) => (!is_blank && is_same(around, now) ? [at] : []));
    // Undone, the last that was shown before.
    const at = fit.filter((one) => one < this.at).at(-1) ?? fit[0];
    if (at !== undefined) this.go(at);
    else void this.fill();
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

  private get grid_shown(): Grid | undefined {
    return this.grids[this.at];
  }

  /** Whether the grid is around the model as it is. */
  private get is_true(): boolean {
    const grid = this.grid_shown;
    return grid !== undefined && !grid.is_blank && is_same(grid.around, this.studio.history.now);
  }

  /** A picture was clicked: it is the middle at once, and others come around it. */
  private choose(cell: Cell): void {
    const before = this.grid_shown!, { now } = this.studio.history;
    if (before.is_blank || !Object.keys(cell.part).length) return;
    for (const one of before.cells) set_attributes(one.button, { 'aria-current': one === cell && 'true' });
    const is_drawn = !cell.button.classList.contains('waits'), nobody = before.cells.slice(1).map(() => ({ says: '…' }));
    this.put({ ...this.laid_out({ ...now, ...cell.part }, nobody, is_drawn ? cell.canvas : null), is_blank: true, waiting: [] });
    this.grid_shown!.middle.button.focus();
    ++this.seed;
    this.studio.change(cell.part);
  }

  /** Shows the pictures before, around the model that they were around. */
  private back(): void {
    if (this.at < 1) return;
    this.go(this.at - 1);
    const { around } = this.grid_shown!;
    if (!is_same(around, this.studio.history.now)) this.studio.change(Object.fromEntries(shape.map((key) => [key, around[key]])));
  }

  private async fill(): Promise<void> {
    const { studio } = this, round = ++this.round;
    this.show_spread();
    if (!this.shown || !studio.model) return;
    const now = studio.history.now;
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
    const blank = this.grid_shown?.is_blank && is_same(this.grid_shown.around, now) ? this.grid_shown.middle : null;
    this.put(this.laid_out(now, children, blank && !blank.button.classList.contains('waits') ? blank.canvas : null));
    this.draw();
  }

  private show_spread(): void {
    this.spread.disabled = this.kind.value === 'seed';
    this.spread_why.hidden = !this.spread.disabled;
  }

  /** A grid follows the one that shows; it takes the place of one that nobody has seen whole. */
  private put(grid: Grid): void {
    const shown = this.grid_shown, was_seen = shown && (shown.waiting.length === 0 || shown.cells.some(is_chosen)) && !shown.is_blank;
    this.grids.length = shown && !was_seen ? this.at : this.at + 1;
    if (this.grids.at(-1)?.around.name !== grid.around.name) this.grids = [];
    this.grids.push(grid);
    this.grids.splice(0, this.grids.length - most_grids);
    this.go(this.grids.length - 1);
  }

  private go(at: number): void {
    const focus = [...this.grid.children].indexOf(document.activeElement!);
    const { kind, spread, rows, cells } = this.grids[at]!;
    this.at = at;
    ++this.round;
    this.kind.value = kind;
    this.spread.value = spread;
    this.show_spread();
    this.back_button.hidden = at === 0;
    this.grid.style.gridTemplateRows = `repeat(${rows}, minmax(0, 1fr))`;
    this.grid.replaceChildren(...cells.map(({ button }) => button));
    if (focus >= 0) (this.grid.children[focus] as HTMLElement | undefined)?.focus();
    this.draw();
  }

  /** The model lies in the middle, however many others there are; `picture` is its, if there is one. */
  private laid_out(around: Choices, children: Child[], picture: HTMLCanvasElement | null): Grid {
    const { width_px, height_px } = this.studio.size, rows = children.length > 2 ? 3 : 1;
    const width = Math.max(16, Math.round(width_px / 3)), height = Math.max(16, Math.round(height_px / rows));
    const middle = this.cell({}, 'your model', width, height);
    middle.button.classList.add('centre');
    const others = children.map(({ says, ...part }) => this.cell(part.set ? { ...part, set: { ...around.set, ...part.set } } : part, says, width, height));
    const at = rows === 3 ? places.slice(0, others.length).sort() : [0, 2];
    const laid = [{ cell: middle, at: rows === 3 ? 4 : 1 }, ...others.map((cell, i) => ({ cell, at: at[i]! }))].sort((a, b) => a.at - b.at);
    for (const { cell: { button }, at } of laid) button.style.gridArea = `${Math.floor(at / 3) + 1} / ${(at % 3) + 1}`;
    if (picture) {
      middle.canvas.getContext('2d')!.drawImage(picture, 0, 0, width, height);
      middle.button.classList.remove('waits');
    }
    const cells = laid.map(({ cell }) => cell);
    return {
      around, kind: this.kind.value, spread: this.spread.value, rows, middle, cells, is_blank: false,
      waiting: [...(picture ? [] : [middle]), ...cells.filter((cell) => cell !== middle)],
    };
  }

  private cell(part: Partial<Choices>, says: string, width: number, height: number): Cell {
    const canvas = element('canvas', { width, height });
    const button = element('button', { type: 'button', class: 'waits', title: says, onclick: () => this.choose(cell) }, canvas, element('span', {}, says));
    const cell: Cell = { canvas, button, part };
    return cell;
  }

  /** Asks for the pictures that are still missing, as long as the grid is shown. */
  private draw(): void {
    for (; this.shown && this.drawing < at_once && this.grid_shown?.waiting.length; ++this.drawing) void this.draw_some();
    this.tell();
  }

  private async draw_some(): Promise<void> {
    const { session } = this.studio;
    for (;;) {
      const grid = this.shown ? this.grid_shown : undefined, cell = grid?.waiting.shift();
      if (!grid || !cell) break;
      const { width, height } = cell.canvas, id = session.coming_id;
      this.awaited.set(id, cell);
      try {
        await session.ask('thumbnail', { ...grid.around, ...cell.part, width, height });
      } catch (error) {
        cell.button.title = (error as Error).message;
        cell.button.classList.add('failed');
        cell.button.classList.remove('waits');
      }
      this.awaited.delete(id);
      this.tell();
    }
    --this.drawing;
  }

  private tell(): void {
    const cells = this.grid_shown?.cells ?? [], left = cells.filter(({ button }) => button.classList.contains('waits')).length;
    this.told.textContent = left > 0 ? `Drawing: ${cells.length - left} of ${cells.length} pictures are there.` : '';
  }
}

const is_chosen = ({ button }: Cell): boolean => button.hasAttribute('aria-current');
