// A click on the picture: the rule that made what is there, its address, and a point that can be pulled.
import { draggable, element, svg } from './dom';
import { latest, type Studio } from './studio';
import type { Edit, Vec3 } from './protocol';
import { dragged, projected } from './vectors';

interface Picked {
  point: Vec3;
  address: string;
  object: string;
  path: string[];
}

interface Pull {
  address: string;
  to: Vec3;
}

export class PointTool {
  private picked: Picked | null = null;
  /** Where the point of the model lies, as far as the text follows the hand. */
  private lies: Vec3 = [0, 0, 0];
  private readonly ask: (pull: Pull) => void;

  /** `card` says what was picked. */
  constructor(private readonly overlay: SVGSVGElement, private readonly card: HTMLElement, private readonly studio: Studio) {
    this.ask = latest((pull) => this.pull_now(pull));
    this.draw();
  }

  async pick(x: number, y: number): Promise<void> {
    const { studio } = this;
    if (!studio.model) return;
    try {
      const answer = await studio.session.ask('pick', { x, y });
      if (!answer['point']) {
        this.picked = null;
      } else {
        const { point, address, object, from, to, path } = answer as unknown as Picked & { from?: number; to?: number };
        this.picked = { point, address, object, path: (path ?? []).map((one) => (typeof one === 'string' ? one : JSON.stringify(one))) };
        if (typeof from === 'number' && typeof to === 'number') studio.select(from, to);
      }
    } catch (error) {
      this.picked = null;
      studio.say((error as Error).message);
    }
    this.draw();
  }

  forget(): void {
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
      picked.path.length > 0 && element('dt', {}, 'Path'), picked.path.length > 0 && element('dd', {}, picked.path.join(' → '))));
    this.overlay.setAttribute('viewBox', `0 0 ${size.width_px} ${size.height_px}`);
    const zoomed = studio.history.now.at !== null || studio.history.now.zoom !== null;
    const place = camera && !zoomed ? projected(camera, size.width_px, size.height_px, picked.point) : null;
    if (!place) {
      this.overlay.replaceChildren();
      return;
    }
    const { width } = this.overlay.getBoundingClientRect(), scale = width > 0 ? size.width_px / width : 1;
    const can_pull = (studio.model?.maps.length ?? 0) > 0;
    const old = this.overlay.querySelector<SVGCircleElement>('circle');
    const marker = old ?? this.marker();
    marker.setAttribute('cx', String(place[0]));
    marker.setAttribute('cy', String(place[1]));
    marker.setAttribute('r', String(7 * scale));
    marker.setAttribute('class', can_pull ? 'point pulls' : 'point');
    if (!old) this.overlay.replaceChildren(marker);
  }

  private marker(): SVGCircleElement {
    const marker = svg('circle', { 'data-handle': 'point' }, svg('title', {}, 'Pull this point: the maps of its address follow'));
    draggable(marker, () => {
      const { picked, studio } = this, { camera, size } = studio;
      if (!picked || !camera || !studio.model?.maps.length) return null;
      this.lies = picked.point;
      const scale = size.width_px / this.overlay.getBoundingClientRect().width;
      return {
        move: (_, dx, dy) => {
          picked.point = dragged(camera, size.width_px, picked.point, dx * scale, dy * scale);
          this.draw();
          this.ask({ address: picked.address, to: picked.point });
        },
              };
    });
    return marker;
  }

  private async pull_now({ address, to }: Pull): Promise<void> {
    const { studio } = this, before = studio.history.now.text;
    try {
      const answer = await studio.session.ask('pull', { address, from: this.lies, to });
      if (studio.history.now.text !== before) return;
      if (answer['contracts'] === false) {
        studio.say(String(answer['why'] ?? 'The maps would not shrink.'));
      } else {
        studio.edit(answer['edits'] as Edit[], 'pull');
        this.lies = to;
      }
    } catch (error) {
      studio.say((error as Error).message);
    }
  }
}
