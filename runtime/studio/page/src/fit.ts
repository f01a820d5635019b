// A target picture behind the boxes of the maps, and the button that moves the maps until their attractor is the target: the ask
// `fit`. The picture is one unit wide, and its lower left corner is the origin.
import { element, svg } from './dom';
import type { Camera, Edit, Progress, Vec3 } from './protocol';
import type { Studio } from './studio';
import { read_target, type Target } from './target';
import { projected } from './vectors';

export class Fit {
  readonly element: HTMLElement;
  private readonly file = element('input', { type: 'file', id: 'target', accept: 'image/*', hidden: true });
  private readonly name = element('span', { class: 'note', id: 'target-name' }, 'none');
  private readonly begin = element('button', { type: 'button', class: 'quiet', id: 'fit', onclick: () => void this.run() }, 'Fit');
  private readonly stop = element('button', {
    type: 'button', class: 'quiet', id: 'stop-fit', hidden: true, onclick: () => void this.studio.session.ask('stop', { number: this.id }),
  }, 'Stop');
  private readonly bar = element('progress', { max: 1, hidden: true, 'aria-label': 'Share of the work of the fit' });
  private readonly doing = element('span', { role: 'status', id: 'fitted' });
  private target: Target | null = null;
  /** Of the last fit. */
  private id = 0;

  constructor(private readonly studio: Studio, private readonly changed: () => void) {
    this.file.onchange = () => void (this.file.files?.[0] && this.take(this.file.files[0]));
    this.element = element('div', {},
      element('h2', {}, 'Target'),
      element('p', { class: 'note' }, 'Choose a picture, or drop it on the page: it stands behind the boxes, one unit wide. Drag the boxes until they cover it; Fit moves the maps the rest of the way. Its dark pixels count, of one with a clear background its opaque ones.'),
      element('div', { class: 'line' }, element('button', { type: 'button', class: 'quiet', id: 'choose-target', onclick: () => this.file.click() }, 'Choose a picture'), this.file, this.name, this.begin, this.stop),
      element('div', { class: 'line' }, this.bar, this.doing),
    );
  }

  async take(file: File): Promise<void> {
    try {
      this.target = await read_target(file);
      this.name.textContent = this.target.name;
      this.changed();
    } catch (error) {
      this.studio.say((error as Error).message);
    }
    this.file.value = ''; // the same file may be chosen again
  }

  /** The target as the camera sees it; null where there is none, or it is seen askew. */
  drawn(camera: Camera): SVGImageElement | null {
    const { target, studio: { size: { width_px, height_px } } } = this;
    if (!target) return null;
    const height = target.height / target.width, corners: Vec3[] = [[0, height, 0], [1, height, 0], [0, 0, 0], [1, 0, 0]];
    const [origin, right, down, across] = corners.map((corner) => projected(camera, width_px, height_px, corner));
    if (!origin || !right || !down || !across) return null;
    if ([0, 1].some((i) => Math.abs(right[i]! + down[i]! - origin[i]! - across[i]!) > 2)) return null;
    const [x, y] = [0, 1].map((i) => [right[i]! - origin[i]!, (down[i]! - origin[i]!) / height, origin[i]!]) as [number[], number[]];
    return svg('image', {
      class: 'target', href: target.shown, width: 1, height, preserveAspectRatio: 'none', 'aria-hidden': 'true',
      transform: `matrix(${[x[0], y[0], x[1], y[1], x[2], y[2]].join(' ')})`,
    });
  }

  is_fit(id: number): boolean {
    return id === this.id;
  }

  progress({ share }: Progress): void {
    this.bar.value = share;
  }

  private async run(): Promise<void> {
    const { target, studio } = this, { history, session } = studio;
    if (!target) return void (this.doing.textContent = 'Choose a picture first: the maps are moved until they make it.');
    const { text, set } = history.now, { width, height, cell, runs } = target;
    this.busy(true);
    this.doing.textContent = 'Moving the maps …';
    try {
      const answered = session.ask('fit', { target: { width, height, cell, runs } });
      this.id = session.coming_id - 1;
      const answer = await answered;
      if (history.now.text !== text || history.now.set !== set) throw new Error('The model was changed meanwhile: fit it once more.');
      const number = (name: string, digits: number) => Number(answer[name]).toFixed(digits);
      studio.hold_view();
      studio.edit(answer['edits'] as Edit[], `map fit ${this.id}`);
      this.doing.textContent = `Agreement ${number('iou_within_a_cell', 3)} within one cell, ${number('before', 3)} before; IoU ${number('iou', 3)}, Chamfer distance ${number('chamfer_cells', 2)} cells.`;
    } catch (error) {
      this.doing.textContent = (error as Error).message;
    } finally {
      this.busy(false);
    }
  }

  private busy(is_busy: boolean): void {
    this.begin.disabled = is_busy;
    this.stop.hidden = this.bar.hidden = !is_busy;
    this.bar.value = 0;
  }
}
