// A click on the picture: the rule that made what is there, its address, and a point that can be pulled.
import { draggable, element, svg } from './dom';
import { covers, covers_of } from './reach';
import { edited, latest, type Studio } from './studio';
import type { Choices, Edit, Vec3 } from './protocol';
import { dragged, projected, units_of_pixel } from './vectors';

const dot_px = 7;

interface Picked {
  point: Vec3;
  address: string;
  object: string;
  path: string[];
  /** Numbers of the instances on the way, by which an L-system's part is found again. */
  part: number[];
}

/** What a point of the model depends on. */
type Shape = Pick<Choices, 'name' | 'text' | 'set' | 'steps' | 'time' | 'seed'>;

export class PointTool {
  private picked: Picked | null = null;
  /** Of what it was picked; of any other model it tells nothing. */
  private of: Shape | null = null;
  /** Where the point of the model lies, as far as the text follows the hand. */
  private lies: Vec3 = [0, 0, 0];
  /** Where the number begins that a drag of an L-system's part changes; null: the next drag chooses one. */
  private number: number | null = null;
  /** What stood there before the drag. */
  private was = '';
  private held = false;
  private drags = 0;
  private readonly ask: (to: Vec3) => void;

  /** `card` says what was picked. */
  constructor(private readonly overlay: SVGSVGElement, private readonly card: HTMLElement, private readonly studio: Studio) {
    this.ask = latest((to) => this.pull_now(to));
    this.draw();
  }

  async pick(x: number, y: number): Promise<void> {
    const { studio } = this, of = studio.history.now;
    if (!studio.model) return;
    try {
      const answer = await studio.session.ask('pick', { x, y });
      if (!answer['point'] || !is_same(of, studio.history.now)) {
        this.picked = null;
      } else {
        const { point, address, object, from, to, path, part } = answer as unknown as Picked & { from?: number; to?: number };
        this.picked = { point, address, object, path: path ?? [], part: part ?? [] };
        this.of = of;
        this.card.classList.toggle('high', y > studio.size.height_px / 2);
        if (typeof from === 'number' && typeof to === 'number') studio.select(from, to);
      }
    } catch (error) {
      this.picked = null;
      studio.say((error as Error).message);
    }
    this.draw();
  }

  /** Something changed: what was picked goes where it is no longer true. */
  changed(): void {
    if (this.of && !is_same(this.of, this.studio.history.now)) this.forget();
    else this.draw();
  }

  private forget(): void {
    if (!this.picked) return;
    this.picked = null;
    this.draw();
  }

  draw(): void {
    const { picked, studio } = this, { camera, size } = studio;
    if (!picked) {
      this.card.hidden = true;
      this.overlay.replaceChildren();
      return;
    }
    this.card.hidden = false;
    this.card.replaceChildren(element('button', { type: 'button', 'aria-label': 'Close', onclick: () => this.forget() }, '×'), element('dl', {},
      element('dt', {}, 'Object'), element('dd', {}, picked.object),
      element('dt', {}, 'Address'), element('dd', {}, element('code', {}, picked.address || '(the whole)')),
      picked.path.length > 0 && element('dt', {}, this.is_lsys ? 'Rules' : 'Path'), picked.path.length > 0 && element('dd', {}, shown_path(picked.path, this.is_lsys))),
      ...(this.can_pull ? [element('p', { class: 'note' }, this.is_lsys ? 'Drag the dot: a number of the rules follows.' : 'Drag the dot: the maps follow.')] : []));
    this.overlay.setAttribute('viewBox', `0 0 ${size.width_px} ${size.height_px}`);
    const zoomed = studio.history.now.at !== null || studio.history.now.zoom !== null;
    const place = camera && !zoomed ? projected(camera, size.width_px, size.height_px, picked.point) : null;
    if (!place) {
      this.overlay.replaceChildren();
      return;
    }
    const { width } = this.overlay.getBoundingClientRect(), scale = width > 0 ? size.width_px / width : 1;
    const old = this.overlay.querySelector<SVGCircleElement>('circle');
    const marker = old ?? this.marker();
    marker.setAttribute('cx', String(place[0]));
    marker.setAttribute('cy', String(place[1]));
    marker.setAttribute('r', String(dot_px * scale));
    marker.setAttribute('class', this.can_pull ? 'point pulls' : 'point');
    if (!old) this.overlay.replaceChildren(marker);
    // The card makes room for the dot.
    const [card] = covers_of(this.overlay, ['picked'], scale);
    if (card && covers(place, card, dot_px * scale)) this.card.classList.toggle('high', place[1] > size.height_px / 2);
  }

  private marker(): SVGCircleElement {
    const marker = svg('circle', { 'data-handle': 'point' }, svg('title', {}, 'Drag this point: the numbers that made it follow'));
    draggable(marker, () => {
      const { picked, studio } = this, { camera, size } = studio;
      if (!picked || !camera || !this.can_pull) return null;
      this.lies = picked.point;
      this.number = null;
      this.held = true;
      ++this.drags;
      const scale = size.width_px / this.overlay.getBoundingClientRect().width;
      return {
        move: (_, dx, dy) => {
          studio.hold_view();
          picked.point = dragged(camera, size.width_px, picked.point, dx * scale, dy * scale);
          this.draw();
          this.ask(picked.point);
        },
        end: () => {
          this.held = false;
          this.settle();
        },
      };
    });
    return marker;
  }

  /** The dot goes where the text has brought the point. */
  private settle(): void {
    if (!this.picked || this.held || !this.is_lsys) return;
    this.picked.point = this.lies;
    this.draw();
  }

  /** What a pixel of the screen shows at the point. */
  private get grain(): number {
    const { camera } = this.studio;
    return camera && this.picked ? units_of_pixel(camera, this.overlay.getBoundingClientRect().width, this.picked.point) : 0;
  }

  private get is_lsys(): boolean {
    return this.studio.history.now.name.toLowerCase().endsWith('.lsys');
  }

  private get can_pull(): boolean {
    return this.is_lsys ? (this.picked?.part.length ?? 0) > 0 : (this.studio.model?.maps.length ?? 0) > 0;
  }

  private async pull_now(to: Vec3): Promise<void> {
    const { studio, picked } = this, before = studio.history.now.text;
    if (!picked) return;
    try {
      const answer = this.is_lsys
        ? await studio.session.ask('drag', { part: picked.part, from: this.lies, to, number: this.number, grain: this.grain })
        : await studio.session.ask('pull', { address: picked.address, from: this.lies, to, grain: this.grain });
      if (studio.history.now.text !== before) return;
      if (answer['contracts'] === false) {
        studio.say(String(answer['why'] ?? 'The maps would not shrink.'));
        return;
      }
      const edits = answer['edits'] as Edit[];
      this.of = { ...this.of!, text: edited(before, edits) };
      studio.edit(edits, `pull #${this.drags}`);
      this.lies = (answer['point'] as Vec3 | undefined) ?? to;
      if (!this.is_lsys) return;
      const { from, to: end, text } = edits[0]!;
      if (this.number === null) this.was = before.slice(from, end);
      this.number = answer['number'] as number;
      studio.select(from, from + text.length);
      studio.say(`line ${before.slice(0, from).split('\n').length}: ${this.was} became ${text}`);
    } catch (error) {
      // A number that has done what it can lets the hand go on.
      if (this.number === null) studio.say((error as Error).message);
    }
    this.settle();
  }
}

function is_same(a: Shape, b: Shape): boolean {
  return a.name === b.name && a.text === b.text && a.set === b.set && a.steps === b.steps && a.time === b.time && a.seed === b.seed;
}

/** Parts of an L-system are named by their symbols and sizes: A_9_2 is an A. Equal ones one after the other are counted. */
function shown_path(path: string[], is_lsys: boolean): string {
  if (!is_lsys) return path.join(' → ');
  const counted: { name: string; times: number }[] = [];
  for (const whole of path) {
    const name = whole.replace(/(_\d+)+$/, ''), last = counted.at(-1);
    if (last?.name === name) ++last.times;
    else counted.push({ name, times: 1 });
  }
  return counted.map(({ name, times }) => (times > 1 ? `${name} × ${times}` : name)).join(' → ');
}
