// The person's hands on the picture: orbit, pan and dolly by mouse, touch and keys; the wheel zooms without an end, and two
// fingers do, which pan too. A flat model is panned where others are orbited, and the other way round.
import { aimed, dollied, orbited, panned, tidied } from './camera';
import { by_id } from './dom';
import { dot, flat_axis, length, subtract, units_of_pixel, view_of } from './vectors';
import type { Studio } from './studio';
import type { Camera, Choices, Vec3 } from './protocol';

/** A notch of a wheel enlarges so much. */
const notch_px = 120, notch_factor = 1.3;
/** Asks may enlarge so much at once. */
const most_factor = 64, most_waiting = 100;
const turn_rad_of_px = 0.008, key_turn_rad = 0.1, key_pan_px = 40;

/** A point under a pixel comes to (x, y), by (dx, dy), and is enlarged. The picture shows it before the session has drawn it. */
interface Step {
  factor: number;
  x: number;
  y: number;
  dx: number;
  dy: number;
  /** Notches of a wheel stay apart: those back are answered by the very states of those there. */
  whole: boolean;
  /** Of the state that holds it; null: nobody has asked for one. */
  number: number | null;
}

type Seen = Pick<Choices, 'camera' | 'at' | 'zoom'>;

export class ViewControl {
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private moved_px = 0;
  /** Steps that the picture does not have yet, in their order. */
  private steps: Step[] = [];
  private stepping = false;
  /** The turn that is still to be made, to the right and up. */
  private turn: [number, number] = [0, 0];
  private aiming = false;
  /** The camera that has aimed, and only turned since. */
  private turned: Camera | null = null;

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

  /** Enlarges, and moves, at once what is seen, and asks for the state that shows it; further calls meanwhile add up. */
  zoom(factor: number, x = this.studio.size.width_px / 2, y = this.studio.size.height_px / 2, whole = true, dx = 0, dy = 0): void {
    if (!this.studio.model) return;
    const last = this.steps.at(-1);
    if (last?.number === null && (this.steps.length > most_waiting || !(whole || last.whole))) {
      Object.assign(last, { factor: last.factor * factor, x, y, dx: last.dx + dx, dy: last.dy + dy });
    } else {
      this.steps.push({ factor, x, y, dx, dy, whole, number: null });
    }
    this.show_ahead();
    void this.take_steps();
  }

  /** The picture of a state is there: what was shown ahead of it is in it. */
  painted(number: number): void {
    if (!this.steps.length) return;
    this.steps = this.steps.filter((step) => step.number === null || step.number > number);
    this.show_ahead();
  }

  whole(): void {
    this.forget_ahead();
    this.studio.change({ camera: null, at: null, zoom: null });
  }

  forget_ahead(): void {
    this.steps = [];
    this.show_ahead();
  }

  private async take_steps(): Promise<void> {
    if (this.stepping) return;
    this.stepping = true;
    // Two fingers move one after the other: their steps are one, or each would enlarge.
    await new Promise(requestAnimationFrame);
    for (let step = this.next_step(); step; step = this.next_step()) await this.take(step);
    this.stepping = false;
  }

  /** An enlargement that is more than one ask may want is two steps. */
  private next_step(): Step | undefined {
    const at = this.steps.findIndex(({ number }) => number === null), step = this.steps[at];
    const factor = step && Math.max(1 / most_factor, Math.min(most_factor, step.factor));
    if (step && factor !== step.factor) {
      this.steps.splice(at + 1, 0, { ...step, factor: step.factor / factor!, dx: 0, dy: 0 });
      step.factor = factor!;
    }
    return step;
  }

  private async take(step: Step): Promise<void> {
    const { factor, x, y, dx, dy } = step;
    step.number = Infinity;
    try {
      const answer = await this.studio.session.ask('zoom', { x: x - dx, y: y - dy, factor, dx, dy });
      if (!this.steps.includes(step)) return; // forgotten meanwhile
      const { at = null, zoom = null, camera = null } = answer as Partial<Seen>;
      this.studio.change({ at, zoom, camera }, 'zoom');
      step.number = this.studio.session.number + (this.studio.session.holds ? 1 : 0);
    } catch (error) {
      this.forget_ahead();
      this.studio.say((error as Error).message);
    }
  }

  private show_ahead(): void {
    const { width_px, height_px } = this.studio.size;
    let scale = 1, left = 0, top = 0;
    for (const { factor, x, y, dx, dy } of this.steps) {
      scale *= factor;
      left = x + (left - x + dx) * factor;
      top = y + (top - y + dy) * factor;
    }
    this.canvas.style.transform = this.steps.length
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

  /** Turns about the point that the camera looks at: near by, the surface in the middle of the view, if there is one. */
  private async orbit(right_rad: number, up_rad: number, key: string): Promise<void> {
    const { studio } = this;
    this.turn = [this.turn[0] + right_rad, this.turn[1] + up_rad];
    if (this.aiming) return;
    const { camera, at, zoom } = studio.history.now;
    let distance: number | null = null;
    if ((camera === null || camera !== this.turned) && this.sees_part()) {
      this.aiming = true;
      distance = await this.distance_to_middle();
      this.aiming = false;
    }
    const turn = this.turn, now = studio.history.now;
    this.turn = [0, 0];
    if (now.camera !== camera || now.at !== at || now.zoom !== zoom) return; // another hand has taken the camera
    this.steer((seen) => orbited(distance === null ? seen : aimed(seen, distance), ...turn), key);
    this.turned = studio.history.now.camera;
  }

  /** Whether less than half of the model finds room at the depth that the camera looks at. */
  private sees_part(): boolean {
    const { camera, model, size, history } = this.studio;
    if (history.now.zoom !== null) return true;
    if (!camera || !model?.box) return false;
    const widest = units_of_pixel(camera, size.width_px) * Math.max(size.width_px, size.height_px);
    return widest < 0.5 * length(subtract(model.box.most, model.box.least));
  }

  /** From the camera to the surface in the middle of the view, along its sight; null: nothing is there. */
  private async distance_to_middle(): Promise<number | null> {
    const { camera, session, size } = this.studio;
    if (!camera) return null;
    try {
      const { point } = await session.ask('pick', { x: size.width_px / 2, y: size.height_px / 2 });
      const distance = point ? dot(subtract(point as Vec3, camera.location), view_of(camera).into) : 0;
      return distance > 0 ? distance : null;
    } catch {
      return null; // a text with an error has no surfaces
    }
  }

  private down(event: PointerEvent): void {
    if ((event.target as Element).closest('[data-handle]')) return;
    this.view.setPointerCapture(event.pointerId);
    this.moved_px = this.pointers.size === 0 ? 0 : 100;
    this.turned = null;
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
      const factor = before > 10 && after > 10 ? after / before : 1, px = this.studio.size.width_px / box.width;
      const [x, y] = this.at({ clientX: (last.x + other.x) / 2, clientY: (last.y + other.y) / 2 });
      this.zoom(factor, x, y, false, (dx / 2) * px, (dy / 2) * px);
      return;
    }
    last.x = event.clientX;
    last.y = event.clientY;
    if (event.ctrlKey || event.metaKey) {
      this.steer((camera) => dollied(camera, Math.exp(-0.01 * dy)), 'camera');
    } else if (event.buttons & 6 || event.shiftKey !== this.is_flat) {
      this.steer((camera) => panned(camera, dx, dy, box.width), 'camera');
    } else {
      void this.orbit(dx * turn_rad_of_px, dy * turn_rad_of_px, 'camera');
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
      void this.orbit(arrow[0] * key_turn_rad, arrow[1] * key_turn_rad, 'camera key');
    } else if (event.key === '+' || event.key === '=') this.zoom(1.25);
    else if (event.key === '-' || event.key === '_') this.zoom(0.8);
    else if (event.key === '0') this.whole();
    else if (event.key === 'PageUp' || event.key === 'PageDown') {
      this.steer((camera) => dollied(camera, event.key === 'PageUp' ? 1.15 : 1 / 1.15), 'camera key');
    } else return;
    event.preventDefault();
  }
}
