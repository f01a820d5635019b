// The person's hands on the picture: orbit, pan and dolly by mouse, touch and keys; the wheel zooms without an end. A flat
// model is panned where others are orbited, and the other way round.
import { dollied, orbited, panned, tidied } from './camera';
import { by_id } from './dom';
import { flat_axis } from './vectors';
import type { Studio } from './studio';
import type { Camera } from './protocol';

/** A notch of a wheel enlarges so much. */
const notch_px = 120, notch_factor = 1.3;
/** Asks may enlarge so much at once. */
const most_factor = 64, most_waiting = 100;
const turn_rad_of_px = 0.008, key_turn_rad = 0.1, key_pan_px = 40;

/** An enlargement that the picture shows already, before the session has drawn it. */
interface Ahead {
  factor: number;
  x: number;
  y: number;
  /** Of the state that holds it; null: none was sent yet. */
  number: number | null;
}

export class ViewControl {
  private ahead: Ahead[] = [];
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private moved_px = 0;
  /** Enlargements to ask for. Notches stay apart: those back are answered by the very states of those there. */
  private readonly wanted: { factor: number; x: number; y: number; whole: boolean }[] = [];
  private asking = false;

  constructor(
    private readonly view: HTMLElement, private readonly canvas: HTMLCanvasElement, private readonly studio: Studio,
    private readonly pick: (x_px: number, y_px: number) => void,
  ) {
    view.addEventListener('wheel', (event) => {
      event.preventDefault();
      const px = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 40 : 1), whole = Math.abs(px) >= 100;
      const notches = whole ? Math.sign(px) * Math.max(1, Math.round(Math.abs(px) / notch_px)) : px / notch_px;
      if (notches) this.zoom(notch_factor ** -notches, ...this.at(event), whole);
    }, { passive: false });
    view.addEventListener('contextmenu', (event) => event.preventDefault());
    view.addEventListener('pointerdown', (event) => this.down(event));
    view.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel'] as const) view.addEventListener(name, (event) => this.up(event));
    view.addEventListener('keydown', (event) => this.key(event));
  }

  /** Pixels of the canvas under an event. */
  at({ clientX, clientY }: { clientX: number; clientY: number }): [number, number] {
    const box = this.view.getBoundingClientRect(), { width_px, height_px } = this.studio.size;
    return [((clientX - box.left) / box.width) * width_px, ((clientY - box.top) / box.height) * height_px];
  }

  /** Enlarges at once what is seen, and asks for the state that shows it; further calls meanwhile add up. */
  zoom(factor: number, x = this.studio.size.width_px / 2, y = this.studio.size.height_px / 2, whole = true): void {
    if (!this.studio.model) return;
    const last = this.wanted.at(-1);
    if (last && (this.wanted.length > most_waiting || !(whole || last.whole))) Object.assign(last, { factor: last.factor * factor, x, y });
    else this.wanted.push({ factor, x, y, whole });
    this.ahead.push({ factor, x, y, number: null });
    this.show_ahead();
    void this.ask_zooms();
  }

  /** The picture of a state is there: what was shown ahead of it is in it. */
  painted(number: number): void {
    if (!this.ahead.length) return;
    this.ahead = this.ahead.filter((one) => one.number === null || one.number > number);
    this.show_ahead();
  }

  whole(): void {
    this.forget_ahead();
    this.studio.change({ camera: null, at: null, zoom: null });
  }

  forget_ahead(): void {
    this.wanted.length = 0;
    this.ahead = [];
    this.show_ahead();
  }

  private async ask_zooms(): Promise<void> {
    if (this.asking) return;
    this.asking = true;
    for (let next = this.wanted.shift(); next; next = this.wanted.shift()) {
      const factor = Math.max(1 / most_factor, Math.min(most_factor, next.factor)), rest = next.factor / factor;
      if (Math.abs(rest - 1) > 1e-9) this.wanted.unshift({ ...next, factor: rest });
      await this.zoom_now({ ...next, factor });
    }
    this.asking = false;
  }

  private async zoom_now({ factor, x, y }: { factor: number; x: number; y: number }): Promise<void> {
    try {
      const answer = await this.studio.session.ask('zoom', { x, y, factor });
      const { at = null, zoom = null, camera = null } = answer as { at?: string; zoom?: string; camera?: Camera };
      this.studio.change({ at, zoom, camera }, 'zoom');
      // The oldest enlargements that are shown ahead are in this state now.
      const number = this.studio.session.number + (this.studio.session.holds ? 1 : 0);
      for (let left = factor, i = 0; i < this.ahead.length && Math.abs(Math.log(left)) > 1e-9; ++i) {
        const one = this.ahead[i]!;
        if (one.number !== null) continue;
        one.number = number;
        left /= one.factor;
      }
    } catch (error) {
      this.forget_ahead();
      this.studio.say((error as Error).message);
    }
  }

  private show_ahead(): void {
    const { width_px, height_px } = this.studio.size;
    let scale = 1, left = 0, top = 0;
    for (const { factor, x, y } of this.ahead) {
      scale *= factor;
      left = x + (left - x) * factor;
      top = y + (top - y) * factor;
    }
    this.canvas.style.transform = this.ahead.length
      ? `translate(${(100 * left) / width_px}%, ${(100 * top) / height_px}%) scale(${scale})` : '';
  }

  private get is_flat(): boolean {
    return flat_axis(this.studio.model?.box ?? null) !== null;
  }

  /** Tells what the keys do with this model. */
  model_came(): void {
    const [plain, shifted] = this.is_flat ? ['pan', 'orbit'] : ['orbit', 'pan'];
    by_id('view-keys').textContent = `Arrow keys ${plain}, with Shift they ${shifted}. Plus and minus zoom. Page Up and Page Down move the camera nearer and farther. 0 shows the whole model.`;
  }

  private steer(change: (camera: Camera) => Camera, key: string): void {
    const { camera } = this.studio;
    if (camera) this.studio.change({ camera: tidied(change(camera)) }, key);
  }

  private down(event: PointerEvent): void {
    if ((event.target as Element).closest('[data-handle]')) return;
    this.view.setPointerCapture(event.pointerId);
    if (this.pointers.size === 0) {
      this.moved_px = 0;
    } else {
      this.moved_px = 100;
    }
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  private move(event: PointerEvent): void {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    if (dx === 0 && dy === 0) return;
    this.moved_px += Math.hypot(dx, dy);
    if (this.moved_px < 4) return;
    const box = this.view.getBoundingClientRect();
    if (this.pointers.size > 1) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)![1];
      const before = Math.hypot(last.x - other.x, last.y - other.y), after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      last.x = event.clientX;
      last.y = event.clientY;
      if (before > 10 && after > 10) {
        this.zoom(after / before, ...this.at({ clientX: (last.x + other.x) / 2, clientY: (last.y + other.y) / 2 }));
      }
      return;
    }
    last.x = event.clientX;
    last.y = event.clientY;
    if (event.ctrlKey || event.metaKey) {
      this.steer((camera) => dollied(camera, Math.exp(-0.01 * dy)), 'camera');
    } else if (event.buttons & 6 || event.shiftKey !== this.is_flat) {
      this.steer((camera) => panned(camera, dx, dy, box.width), 'camera');
    } else {
      this.steer((camera) => orbited(camera, dx * turn_rad_of_px, dy * turn_rad_of_px), 'camera');
    }
  }

  private up(event: PointerEvent): void {
    if (!this.pointers.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && this.moved_px < 4 && event.button === 0) this.pick(...this.at(event));
  }

  private key(event: KeyboardEvent): void {
    if (event.target !== this.view || event.ctrlKey || event.metaKey || event.altKey) return;
    const arrows: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
    };
    const arrow = arrows[event.key], { width } = this.view.getBoundingClientRect();
    if (arrow && event.shiftKey !== this.is_flat) {
      this.steer((camera) => panned(camera, -arrow[0] * key_pan_px, -arrow[1] * key_pan_px, width), 'camera key');
    } else if (arrow) {
      this.steer((camera) => orbited(camera, arrow[0] * key_turn_rad, arrow[1] * key_turn_rad), 'camera key');
    } else if (event.key === '+' || event.key === '=') this.zoom(1.25);
    else if (event.key === '-' || event.key === '_') this.zoom(0.8);
    else if (event.key === '0') this.whole();
    else if (event.key === 'PageUp' || event.key === 'PageDown') {
      this.steer((camera) => dollied(camera, event.key === 'PageUp' ? 1.15 : 1 / 1.15), 'camera key');
    } else return;
    event.preventDefault();
  }
}
