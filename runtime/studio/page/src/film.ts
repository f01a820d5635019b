// Key frames of the knobs, and the film that runs through them: by the code of `graftal animate`.
import { element, plain_number, soon } from './dom';
import type { KeyFrame, Progress } from './protocol';
import type { Studio } from './studio';

type Values = Record<string, number>;

/** The values of the knobs at a time, straight from key to key; before the first and after the last they stay. */
export function values_at(keys: KeyFrame[], seconds: number): Values {
  const values: Values = {};
  for (const name of moving(keys)) {
    const own = keys.filter(({ set }) => name in set), after = own.findIndex((key) => key.seconds > seconds);
    const b = own[after], a = after < 0 ? own.at(-1)! : own[after - 1];
    if (!b || !a) values[name] = (b ?? a)!.set[name]!;
    else values[name] = Number((a.set[name]! + ((b.set[name]! - a.set[name]!) * (seconds - a.seconds)) / (b.seconds - a.seconds)).toPrecision(7));
  }
  return values;
}

/** The knobs that differ from one key frame to another. */
export function moving(keys: KeyFrame[]): string[] {
  const names = [...new Set(keys.flatMap(({ set }) => Object.keys(set)))];
  return names.filter((name) => new Set(keys.filter(({ set }) => name in set).map(({ set }) => set[name])).size > 1);
}

/** Keys of one knob as shares of the film, with one at its beginning and one at its end. */
export function shares(keys: KeyFrame[], name: string, seconds: number): [number, number][] {
  const inside = keys.filter((key) => name in key.set && key.seconds > 0 && key.seconds < seconds);
  return [
    [0, values_at(keys, 0)[name]!],
    ...inside.map((key): [number, number] => [Number((key.seconds / seconds).toFixed(6)), key.set[name]!]),
    [1, values_at(keys, seconds)[name]!],
  ];
}

/** The time as the tab has it. */
export interface Course {
  seconds: number;
  /** From one time, or number of steps, to another; null: they stay. */
  steps: [number, number] | null;
  /** Where the hand is in the film. */
  now_seconds: number;
  show_at(seconds: number): void;
}

export class Film {
  readonly element: HTMLElement;
  private readonly list = element('ol', { class: 'keys' });
  private readonly fps = element('input', { id: 'film-fps', type: 'number', value: 25, min: 1, max: 100, step: 'any' });
  private readonly width = element('input', { id: 'film-width', type: 'number', value: 640, min: 2, max: 8192, step: 2, 'aria-label': 'Width of the film in pixels' });
  private readonly kind = element('select', { id: 'film-kind' },
    ...Object.entries({ '.gif': 'GIF', '.png': 'animated PNG', '.mp4': 'MP4 (needs ffmpeg)', '.webm': 'WebM (needs ffmpeg)', '/': 'pictures in a folder' })
      .map(([value, label]) => element('option', { value }, label)));
  private readonly save = element('button', { type: 'button', class: 'quiet', id: 'save-film', onclick: () => void this.write() }, 'Save film');
  private readonly cancel = element('button', { type: 'button', class: 'quiet', id: 'stop-film', hidden: true, onclick: () => void this.studio.session.ask('stop') }, 'Stop');
  private readonly bar = element('progress', { max: 1, 'aria-label': 'Share of the film that is drawn' });
  private readonly doing = element('span', { role: 'status' });
  private readonly work = element('div', { class: 'line', hidden: true }, this.bar, this.doing);
  private readonly command = element('pre', { tabindex: 0, role: 'region', 'aria-label': 'Command line of the film' });
  private readonly soon_command = soon(() => void this.show_command(), 300);
  private file_id = 0;
  /** The film that is being written. */
  private making = { frames: 0, file: '' };

  constructor(private readonly studio: Studio, private readonly course: () => Course) {
    for (const input of [this.fps, this.width, this.kind]) input.onchange = () => this.show();
    this.element = element('div', {},
      element('h2', {}, 'Film'),
      element('div', { class: 'line' }, element('label', {}, this.fps, ' pictures a second'), element('label', {}, this.width, ' pixels wide')),
      element('div', { class: 'line' }, element('label', { for: 'film-kind' }, 'As '), this.kind, this.save, this.cancel),
      this.work,
      element('h2', {}, 'Key frames'),
      element('p', { class: 'note' }, 'Set the knobs, then keep them for a moment of the film. Between two key frames the knobs move evenly.'),
      element('div', { class: 'line' }, element('button', { type: 'button', class: 'quiet', id: 'add-key', onclick: () => this.add() }, 'Keep the knobs here')),
      this.list,
      element('h3', {}, 'The same by the command line'),
      this.command,
    );
  }

  show(): void {
    const { keys } = this.studio.history.now;
    this.list.replaceChildren(...keys.map((key) => element('li', { class: 'line' },
      element('button', { type: 'button', class: 'link', onclick: () => this.course().show_at(key.seconds) }, `${plain_number(key.seconds)} s`),
      element('span', {}, this.says(key)),
      element('button', {
        type: 'button', class: 'small', 'aria-label': `Remove the key frame at ${plain_number(key.seconds)} seconds`,
        onclick: () => this.put(this.studio.history.now.keys.filter((other) => other !== key)),
      }, '×'))));
    this.soon_command();
  }

  private async show_command(): Promise<void> {
    if (this.element.offsetParent === null || !this.studio.model) return;
    try {
      const { command } = await this.studio.session.ask('command', { film: this.film() });
      this.command.textContent = `${String(command).replace(/--size \S+/, `--size ${this.size.width}x${this.size.height}`)} -o ${this.output}`;
    } catch (error) {
      this.command.textContent = (error as Error).message;
    }
  }

  /** Only a home with a program makes films. */
  hello(): void {
    const home = this.studio.hello?.home === 'program';
    this.save.disabled = !home;
    if (!home) this.save.title = 'Films need the program: copy the command line below.';
  }

  /** Each stage fills the bar anew. */
  progress({ stage, share }: Progress): void {
    const { frames, file } = this.making;
    this.bar.value = share;
    this.doing.textContent = {
      measure: `Looking at the model at all moments, then drawing ${frames} pictures …`,
      draw: `Drawing: ${Math.floor(share * frames + 1e-6)} of ${frames} pictures are there`,
      fit: '',
      assemble: `All ${frames} pictures are drawn. Writing ${file} …`,
    }[stage];
  }

  /** Whether a file under way is the film. */
  is_film(id: number): boolean {
    return id === this.file_id;
  }

  private says({ set }: KeyFrame): string {
    const shown = moving(this.studio.history.now.keys).filter((name) => name in set);
    const names = shown.length > 0 ? shown : Object.keys(set);
    return names.map((name) => `${name} ${plain_number(set[name]!)}`).join(', ') || 'no knobs';
  }

  private add(): void {
    const { studio } = this, seconds = Number(this.course().now_seconds.toFixed(3));
    const knobs = (studio.model?.parameters ?? []).filter(({ name }) => name !== 'steps' && name !== 'seed');
    const set = Object.fromEntries(knobs.map(({ name, value }) => [name, studio.history.now.set[name] ?? value]));
    if (knobs.length === 0) return studio.say('This model has no knobs: write a line such as let lean = 2 into the text.');
    const others = studio.history.now.keys.filter((key) => key.seconds !== seconds);
    this.put([...others, { seconds, set }].sort((a, b) => a.seconds - b.seconds));
    studio.say(`Kept at ${plain_number(seconds)} s. ${others.length === 0 ? 'Go to another time, change a knob, and keep that too.' : 'Play shows it.'}`);
  }

  private put(keys: KeyFrame[]): void {
    this.studio.change({ keys });
  }

  private get size(): { width: number; height: number } {
    const { width_px, height_px } = this.studio.size, even = (value: number) => Math.max(2, 2 * Math.round(value / 2));
    const width = even(Number(this.width.value) || 640);
    return { width, height: even((width * height_px) / width_px) };
  }

  private get fps_number(): number {
    return Number(this.fps.value) || 25;
  }

  private get frames(): number {
    return Math.max(2, Math.round(this.course().seconds * this.fps_number));
  }

  private get output(): string {
    return this.studio.history.now.name.replace(/^.*[\\/]/, '').replace(/\.\w+$/, '') + this.kind.value;
  }

  /** As asks and states have it. */
  film(): object {
    const { keys } = this.studio.history.now, { seconds, steps } = this.course(), fps = this.fps_number;
    return {
      frames: this.frames, fps, steps,
      set: Object.fromEntries(moving(keys).map((name) => [name, shares(keys, name, seconds)])),
    };
  }

  private async write(): Promise<void> {
    const { studio } = this, folder = this.kind.value === '/';
    this.save.disabled = true;
    this.cancel.hidden = this.work.hidden = false;
    this.bar.value = 0;
    this.making = { frames: this.frames, file: this.output };
    this.doing.textContent = 'Beginning …';
    try {
      const written = studio.session.ask('write', { ...(folder ? { path: this.output } : { suffix: this.kind.value }), ...this.size, film: this.film() });
      this.file_id = studio.session.coming_id - 1;
      const { path } = await written;
      if (path) studio.say(`Saved ${String(path)}.`);
    } catch (error) {
      const why = (error as Error).message;
      studio.say(why === 'interrupted' ? 'The film was stopped.' : why);
    } finally {
      this.save.disabled = false;
      this.cancel.hidden = this.work.hidden = true;
    }
  }
}
