// The canvas. Tiles of a new picture appear together once they cover it, so that the last one stays until then.
import { element } from './dom';
import { inflate, type Tile } from './protocol';
import type { Size } from './session';

const longest_hold_ms = 150, frame_share_ms = 12;
/** Pictures of larger blocks tell less than the last good picture: finer ones have a moment to come first. */
const largest_block_px = 16, block_hold_ms = 40;
const storage_key = 'graftal picture', kept_quality = 0.85;

interface Ready {
  tile: Tile;
  samples: Uint8Array | null;
  /** The samples a pixel once this tile is painted, where it ends a pass. */
  told?: number;
}

/** A picture of so many samples a pixel is sharp. */
const sharp_samples = 1;

/** The canvas is hidden until it shows a picture. */
export class Picture {
  /** Number of the state whose picture is shown; 0: none yet. */
  shown = 0;
  private readonly context: CanvasRenderingContext2D;
  private readonly sizes = new Map<number, Size>();
  private readonly coarse = new Map<number, CanvasRenderingContext2D>();
  private queue: Ready[] = [];
  private first_ms = 0;
  /** Pixels a sample of the coarse pass that comes in; 0: none. */
  private coarse_pass = 0;
  private painting = false;
  /** The samples a pixel of what is painted, as far as the session told. */
  private samples = 0;
  /** The last sharp picture, where the one that is shown is not. */
  private sharp: HTMLCanvasElement | null = null;

  constructor(readonly canvas: HTMLCanvasElement, private readonly painted: (number: number) => void) {
    this.context = canvas.getContext('2d', { alpha: false })!;
    canvas.hidden = true;
  }

  /** Keeps what is shown over a reload. */
  keep(): void {
    try {
      if (this.canvas.hidden) sessionStorage.removeItem(storage_key);
      else sessionStorage.setItem(storage_key, this.canvas.toDataURL('image/jpeg', kept_quality));
    } catch {
      // Storage that is full or forbidden: the picture is drawn anew.
    }
  }

  /** Shows what was kept, unless a picture has come already. */
  async show_kept(): Promise<void> {
    try {
      const kept = new Image();
      kept.src = sessionStorage.getItem(storage_key) ?? '';
      await kept.decode();
      if (!this.canvas.hidden) return;
      this.canvas.width = kept.width;
      this.canvas.height = kept.height;
      this.context.drawImage(kept, 0, 0);
      this.canvas.hidden = false;
    } catch {
      // Nothing was kept.
    }
  }

  /** Tells the size of the picture that a state asks for. */
  expect(number: number, size: Size): void {
    this.sizes.set(number, size);
    for (const old of this.sizes.keys()) if (old < number - 50) this.sizes.delete(old);
  }

  tile(tile: Tile): void {
    const newest = this.queue.at(-1)?.tile.number ?? this.shown;
    if (tile.number < newest || !this.sizes.has(tile.number)) return;
    if (tile.number > newest) {
      // Tiles of an older picture that still wait would only be painted over.
      this.queue = [];
      this.first_ms = performance.now();
    }
    const ready: Ready = { tile, samples: null };
    this.queue.push(ready);
    inflate(tile.deflated).then(
      (samples) => {
        ready.samples = samples;
        this.schedule();
      },
      () => {
        this.queue = this.queue.filter((other) => other !== ready);
      },
    );
  }

  /** A pass ends with the tiles that came before: they may still wait to be painted. Pictures of engines that tell no samples are sharp. */
  pass(number: number, samples: number | null): void {
    const last = this.queue.at(-1), told = samples ?? sharp_samples;
    if (last?.tile.number === number) last.told = told;
    else if (!last && number === this.shown) this.samples = told;
  }

  /** The view is another: no picture of before is of it. */
  forget_sharp(): void {
    this.sharp = null;
    this.samples = 0;
    for (const ready of this.queue) delete ready.told;
  }

  /** The state of this number has no picture: the last good one stays, or comes back where only a rough one followed it. */
  stay(number: number): void {
    this.queue = [];
    if (number <= this.shown || this.canvas.hidden) return;
    this.shown = number;
    if (!this.sharp || this.samples >= sharp_samples) return;
    this.context.drawImage(this.sharp, 0, 0, this.canvas.width, this.canvas.height);
    this.samples = sharp_samples;
  }

  /** Nothing waits to be painted. */
  get idle(): boolean {
    return this.queue.length === 0;
  }

  private schedule(): void {
    if (this.painting) return;
    this.painting = true;
    requestAnimationFrame(() => {
      this.painting = false;
      this.paint();
    });
  }

  private paint(): void {
    const number = this.queue[0]?.tile.number;
    if (number === undefined) return;
    let count = this.queue.findIndex(({ samples }) => samples === null);
    if (count < 0) count = this.queue.length;
    const size = this.sizes.get(number)!;
    if (number > this.shown) {
      const area = this.queue.slice(0, count).reduce((sum, { tile }) => sum + tile.width * tile.height, 0);
      const held_ms = performance.now() - this.first_ms, blocks = this.queue.slice(0, count).every(({ tile }) => tile.coarse > largest_block_px);
      if ((area < size.width_px * size.height_px && held_ms < longest_hold_ms) || (blocks && held_ms < block_hold_ms)) {
        setTimeout(() => this.schedule(), 20);
        return;
      }
      this.begin(number, size);
    }
    const start_ms = performance.now();
    // Coarse tiles that follow each other are enlarged together, before a finer one is painted over them.
    let coarse: Tile[] = [];
    const enlarge = () => {
      if (coarse.length) this.smooth(coarse);
      coarse = [];
    };
    let done = 0;
    while (done < count && performance.now() - start_ms < frame_share_ms) {
      const { tile, samples, told } = this.queue[done++]!;
      if (told !== undefined) this.samples = told;
      const data = tile_data(tile, samples!);
      if (!data) continue;
      if (coarse.length && coarse[0]!.coarse !== tile.coarse) enlarge();
      if (tile.coarse === 1) {
        this.context.putImageData(data, tile.x, tile.y);
      } else {
        this.coarse_context(tile.coarse, size).putImageData(data, tile.x / tile.coarse, tile.y / tile.coarse);
        coarse.push(tile);
      }
    }
    enlarge();
    this.queue.splice(0, done);
    if (this.queue.length) this.schedule();
    this.painted(number);
  }

  private begin(number: number, { width_px, height_px }: Size): void {
    const { canvas } = this;
    if (this.samples >= sharp_samples) this.sharp = copy_of(canvas);
    this.samples = 0;
    this.shown = number;
    this.coarse_pass = 0;
    canvas.hidden = false;
    if (canvas.width === width_px && canvas.height === height_px) return;
    const old = copy_of(canvas);
    canvas.width = width_px;
    canvas.height = height_px;
    this.context.drawImage(old, 0, 0, width_px, height_px);
    this.coarse.clear();
  }

  private coarse_context(pixels: number, { width_px, height_px }: Size): CanvasRenderingContext2D {
    let context = this.coarse.get(pixels);
    if (!context) {
      const canvas = document.createElement('canvas');
      canvas.width = Math.ceil(width_px / pixels);
      canvas.height = Math.ceil(height_px / pixels);
      context = canvas.getContext('2d', { alpha: false })!;
      this.coarse.set(pixels, context);
    }
    if (this.coarse_pass !== pixels) {
      // Until its neighbours come, a tile is smoothed against what is shown: it has no dark edges.
      this.coarse_pass = pixels;
      context.drawImage(this.canvas, 0, 0, width_px / pixels, height_px / pixels);
    }
    return context;
  }

  /** Enlarges coarse samples where these tiles are and a little beyond: what was enlarged before beside them knew no
   * neighbour, and would leave a seam. */
  private smooth(tiles: Tile[]): void {
    const { context } = this, pixels = tiles[0]!.coarse, from = this.coarse.get(pixels)!.canvas;
    context.save();
    context.beginPath();
    const rim = 2 * pixels;
    for (const { x, y, width, height } of tiles) context.rect(x - rim, y - rim, width + 2 * rim, height + 2 * rim);
    context.clip();
    context.imageSmoothingEnabled = true;
    context.imageSmoothingQuality = 'high';
    context.drawImage(from, 0, 0, from.width * pixels, from.height * pixels);
    context.restore();
  }
}

function copy_of(canvas: HTMLCanvasElement): HTMLCanvasElement {
  const copy = element('canvas', { width: canvas.width, height: canvas.height });
  copy.getContext('2d')!.drawImage(canvas, 0, 0);
  return copy;
}

/** The samples of a tile with full alpha; null where there are fewer than it promises. */
export function tile_data(tile: Tile, samples: Uint8Array): ImageData | null {
  const width = Math.ceil(tile.width / tile.coarse), height = Math.ceil(tile.height / tile.coarse);
  const count = width * height;
  if (count === 0 || samples.length < 3 * count) return null;
  const data = new ImageData(width, height), to = data.data;
  for (let i = 0, from = 0, at = 0; i < count; ++i) {
    to[at++] = samples[from++]!;
    to[at++] = samples[from++]!;
    to[at++] = samples[from++]!;
    to[at++] = 255;
  }
  return data;
}
