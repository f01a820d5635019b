// The page: it joins the text, the picture and the tools by one history and one session.
import { tidied } from './camera';
import { Digraph } from './digraph';
import { by_id, element, soon } from './dom';
import { Divider } from './divider';
import { Editor } from './editor';
import { Fit } from './fit';
import { fill_help } from './help';
import { History } from './history';
import { Knobs } from './knobs';
import { opened } from './link';
import { Maps } from './maps';
import { Out } from './out';
import { Picture } from './picture';
import { Place } from './place';
import { PointTool } from './point';
import { Presets } from './presets';
import { Saved } from './saved';
import { first_id, Session, type Listener, type Size } from './session';
import { Status } from './status';
import { edited, type Offer, type Studio } from './studio';
import { Tabs } from './tabs';
import { Time } from './time';
import { home_transport } from './transport';
import { Vary } from './vary';
import { is_in_view } from './vectors';
import { ViewControl } from './view';
import type { Camera, Choices, Edit, Findings, Hello, Model, Pass, Progress, SentFile, Tile } from './protocol';

const most_px = 2_100_000;
/** Keys of changes that keep a view that is held. */
const hands_in_picture = /^(map|pull) /;

const nothing: Choices = {
  name: '', text: '', set: {}, steps: null, time: null, seed: null, camera: null, at: null, zoom: null, engine: null, quality: null, keys: [], files: null,
};

class Page implements Studio, Listener {
  hello_message: Hello | null = null;
  model: Model | null = null;
  size: Size = { width_px: 960, height_px: 540 };
  readonly history: History;
  readonly session: Session;
  private readonly editor: Editor;
  private readonly picture: Picture;
  private readonly view: ViewControl;
  private readonly status: Status;
  private readonly knobs: Knobs;
  private readonly presets: Presets;
  private readonly maps: Maps;
  private readonly fitting: Fit;
  private readonly digraph: Digraph;
  private readonly point: PointTool;
  private readonly vary: Vary;
  private readonly time: Time;
  private readonly out: Out;
  private readonly saved = new Saved(by_id('edited'));
  private readonly place: Place;
  private readonly tabs: Tabs;
  private complete = 0;
  private readonly sent_ms = new Map<number, number>();
  /** The camera that the session chose for a film. */
  private film_view: Camera | null = null;
  /** The last state left it to the session to choose that. */
  private frames_film = false;
  /** The view that is held (`hold_view`); null: the model chooses. */
  private still: Camera | null = null;
  /** The model, camera, address and zoom of before. */
  private seen: unknown[] = [];
  /** From states to the first pixels of their pictures: the last ones. */
  readonly latencies_ms: number[] = [];
  private readonly save = soon(() => requestIdle(() => this.history.save()), 300);
  private readonly show_command = soon(() => void this.out.show(), 300);

  constructor() {
    this.history = new History(nothing, 'graftal history', (why) => this.changed(why));
    this.status = new Status(by_id('status'), by_id('share').firstElementChild as HTMLElement, by_id('finding'), by_id('said'), by_id('stale'), this);
    this.picture = new Picture(by_id<HTMLCanvasElement>('picture'), (number) => {
      this.note_latency(number);
      this.view.painted(number);
      this.tell_done();
    });
    const layer = (id: string) => by_id(id) as unknown as SVGSVGElement;
    this.maps = new Maps(layer('maps-layer'), this, (event) => void this.point.pick(...this.view.at(event)).then(() => this.maps.draw()),
      (camera) => this.fitting.drawn(camera));
    this.fitting = new Fit(this, () => this.maps.draw());
    this.digraph = new Digraph(this);
    this.point = new PointTool(layer('point-layer'), by_id('picked'), this);
    this.view = new ViewControl(by_id('view'), this.picture.canvas, this, (x, y) => void this.point.pick(x, y));
    this.editor = new Editor(by_id('editor'), this);
    this.knobs = new Knobs(this);
    this.presets = new Presets(this);
    this.vary = new Vary(by_id('grid'), this);
    this.time = new Time(this, () => this.show());
    this.out = new Out(this, this.knobs, (choices) => this.change({ ...nothing, ...choices }), (choices) => {
      this.saved.wrote(choices);
      this.show_name();
    });
    this.place = new Place(by_id<HTMLFormElement>('place'), this);
    this.tabs = new Tabs(by_id('tabs'), by_id('panels'), [
      { id: 'text', label: 'Text', content: by_id('text') },
      { id: 'knobs', label: 'Knobs', content: element('div', {}, this.knobs.element, this.presets.element) },
      { id: 'maps', label: 'Maps', content: element('div', {}, this.maps.list, this.fitting.element, this.digraph.element) },
      { id: 'vary', label: 'Vary', content: this.vary.element },
      { id: 'time', label: 'Time', content: this.time.element },
      { id: 'out', label: 'Save', content: this.out.element },
    ], (id) => this.tab(id));
    this.tabs.select(matchMedia('(max-width: 800px)').matches ? 'text' : 'knobs');
    this.bind();
    this.session = new Session(home_transport(), this);
  }

  get hello(): Hello | null {
    return this.hello_message;
  }

  get camera(): Camera | null {
    return this.history.now.camera ?? this.still ?? this.model?.camera ?? null;
  }

  hold_view(): void {
    const { camera, at, zoom } = this.history.now;
    if (this.camera && camera === null && at === null && zoom === null) this.still ??= tidied(this.camera);
  }

  /** The model chooses the view again, if it has left the one that is held. */
  private fit(): void {
    const { still, model, size } = this;
    if (!still || this.history.held || !model?.box || is_in_view(still, size.width_px, size.height_px, model.box)) return;
    this.still = null;
    this.show();
  }

  change(part: Partial<Choices>, key: string | null = null): void {
    const lets_go = this.still !== null && (!key || !hands_in_picture.test(key));
    if (lets_go) this.still = null;
    if (!this.history.change(part, key) && lets_go) this.show();
  }

  edit(edits: Edit[], key: string | null = null): void {
    if (edits.length) this.change({ text: edited(this.history.now.text, edits) }, key);
  }

  select(from: number, to: number): void {
    this.editor.select(from, to);
  }

  say(text: string, offer?: Offer): void {
    this.status.say(text, offer);
  }

  private bind(): void {
    const { history } = this;
    by_id('undo').onclick = () => history.undo();
    by_id('redo').onclick = () => history.redo();
    by_id('nearer').onclick = () => this.view.zoom(1.5);
    by_id('farther').onclick = () => this.view.zoom(1 / 1.5);
    by_id('whole').onclick = () => this.view.whole();
    by_id('link').onclick = () => void this.out.copy_link();
    const help = by_id<HTMLDialogElement>('help-page');
    fill_help(help);
    by_id('help').onclick = () => help.showModal();
    by_id<HTMLSelectElement>('quality').onchange = (event) => this.change({ quality: (event.target as HTMLSelectElement).value });
    by_id<HTMLSelectElement>('engine').onchange = (event) => this.change({ engine: (event.target as HTMLSelectElement).value });
    document.addEventListener('pointerdown', () => history.hold(), true);
    for (const name of ['pointerup', 'pointercancel']) document.addEventListener(name, () => {
      history.release();
      this.fit();
    }, true);
    // Before the editor, which has no history of its own.
    document.addEventListener('keydown', (event) => this.key(event), true);
    new ResizeObserver(() => this.resized()).observe(by_id('view'));
    addEventListener('dragover', (event) => event.dataTransfer?.types.includes('Files') && event.preventDefault());
    addEventListener('drop', (event) => {
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      if (!file.type.startsWith('image/')) return void this.out.open_file(file);
      this.tabs.select('maps');
      void this.fitting.take(file);
    });
    new Divider(by_id('divider'), by_id('rooms'));
    addEventListener('pagehide', () => {
      history.save();
      this.picture.keep();
    });
    addEventListener('hashchange', () => void this.open_link());
  }

  private key(event: KeyboardEvent): void {
    const field = event.target instanceof HTMLInputElement && ['text', 'number'].includes(event.target.type) && !event.target.closest('.cm-content');
    const key = event.key.toLowerCase(), ctrl = (event.ctrlKey || event.metaKey) && !event.altKey;
    if (ctrl && key === 'z' && !field) event.shiftKey ? this.history.redo() : this.history.undo();
    else if (ctrl && key === 'y' && !field) this.history.redo();
    else if (ctrl && key === 's') void this.out.save_text();
    else if (event.key === 'F1') by_id<HTMLDialogElement>('help-page').showModal();
    else if (event.key === 'F6') this.next_region();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private next_region(): void {
    const regions: [HTMLElement, () => void][] = [
      [by_id('text'), () => this.editor.view.focus()],
      [by_id('stage'), () => by_id('view').focus()],
      [by_id('tabs'), () => by_id(`tab-${this.tabs.selected}`).focus()],
    ];
    const at = regions.findIndex(([region]) => region.contains(document.activeElement));
    for (let step = 1; step <= regions.length; ++step) {
      const [region, focus] = regions[(at + step) % regions.length]!;
      if (region.offsetParent !== null) return focus();
    }
  }

  private resized(): void {
    const { width, height } = by_id('view').getBoundingClientRect();
    if (width < 1 || height < 1) return;
    const scale = Math.min(Math.min(2, devicePixelRatio), Math.sqrt(most_px / (width * height)));
    this.still = null;
    this.size = { width_px: Math.max(2, Math.round(width * scale)), height_px: Math.max(2, Math.round(height * scale)) };
    if (this.history.now.text) this.show();
    this.maps.draw();
    this.point.draw();
  }

  private show(): void {
    const { now } = this.history, film = this.time.shown_film;
    if (!film) this.film_view = null;
    // Beside the tab Time the view of the film stays as it is: a knob need not frame all moments anew, and what Save writes has it.
    const is_held = this.film_view !== null && this.tabs.selected !== 'time' && now.at === null && now.zoom === null;
    this.frames_film = film !== null && !is_held && this.still === null && now.camera === null && now.at === null && now.zoom === null;
    const camera = now.camera ?? (is_held ? this.film_view : null) ?? this.still;
    this.session.show({ ...now, camera, film: is_held ? null : film }, this.size);
    this.tell_done();
  }

  private tab(id: string): void {
    if (this.film_view) this.show();
    this.maps.show(id === 'maps');
    this.digraph.show(id === 'maps');
    this.vary.show(id === 'vary');
    this.time.tab(id === 'time');
    if (id === 'out') void this.out.show();
    if (id === 'knobs') this.presets.show();
    document.body.dataset['tab'] = id;
  }

  /** The history has something else now: everything shows it. */
  private changed(why: string): void {
    const { now, can_undo, can_redo } = this.history;
    by_id<HTMLButtonElement>('undo').disabled = !can_undo;
    by_id<HTMLButtonElement>('redo').disabled = !can_redo;
    by_id<HTMLSelectElement>('quality').value = now.quality ?? 'normal';
    by_id<HTMLSelectElement>('engine').value = now.engine ?? this.hello?.engines[0] ?? 'native';
    this.show_name();
    if (why === 'history') this.view.forget_ahead();
    const seen = [now.name, now.camera, now.at, now.zoom];
    if (seen.some((part, i) => part !== this.seen[i])) {
      this.picture.forget_sharp();
      this.still = null;
    }
    this.seen = seen;
    this.editor.show(now.text);
    this.show();
    this.knobs.show();
    this.time.show();
    this.place.show();
    this.maps.draw();
    this.point.changed();
    this.vary.changed();
    if (this.tabs.selected === 'out') this.show_command();
    this.save();
  }

  private show_name(): void {
    const { now } = this.history, is_saved = this.saved.show(now);
    by_id('model-name').textContent = now.name.replace(/^.*[\\/]/, '');
    by_id('model-name').title = now.name;
    document.title = `${is_saved ? '' : '• '}${now.name} – graftal studio`;
  }

  private async open_link(): Promise<boolean> {
    const link = location.hash;
    if (!link.startsWith('#m=')) return false;
    window.history.replaceState(null, '', location.pathname + location.search);
    try {
      this.change({ ...nothing, ...(await opened(link, this.session)) });
      return true;
    } catch (error) {
      this.say((error as Error).message);
      return false;
    }
  }

  // What the session says.

  sent(number: number, size: Size): void {
    this.picture.expect(number, size);
    this.complete = 0;
    this.status.sent();
    this.sent_ms.set(number, performance.now());
    this.tell_done();
  }

  async hear_hello(message: Hello): Promise<void> {
    const first = this.hello_message === null;
    this.hello_message = message;
    by_id('engine').replaceChildren(...message.engines.map((name) => element('option', { value: name }, name)));
    by_id('engine-choice').hidden = message.engines.length < 2;
    this.out.hello();
    this.time.film.hello();
    if (!first) return this.show();
    this.saved.opened(message);
    const again = this.history.open({ ...nothing, name: message.name, text: message.text });
    if (!(await this.open_link()) && again) await this.picture.show_kept();
    this.presets.show();
  }

  findings(message: Findings): void {
    if (message.number !== this.session.number || this.session.holds) return;
    this.editor.show_findings(message.findings.filter(({ file }) => !file || file === this.history.now.name));
    this.status.findings(message.findings);
    if (message.findings.some(({ severity }) => severity === 'error')) this.picture.stay(message.number);
  }

  model_came(message: Model): void {
    this.model = message;
    if (message.number !== this.session.number || this.session.holds) return;
    if (this.frames_film) this.film_view = message.camera;
    this.view.model_came();
    this.knobs.model_came();
    this.time.model_came();
    this.maps.model_came();
    this.digraph.show();
    this.point.draw();
    this.fit();
  }

  progress(message: Progress): void {
    if (this.fitting.is_fit(message.number)) this.fitting.progress(message);
    else if (this.time.film.is_film(message.number)) this.time.film.progress(message);
    else this.say(message.share === 1 ? 'Writing the file …' : `Working on the file: ${Math.round(100 * message.share)} %`);
  }

  pass(message: Pass): void {
    if (message.number !== this.session.number) return;
    this.status.pass(message);
    this.picture.pass(message.number, message.samples);
    if (message.done) this.complete = message.number;
    this.tell_done();
  }

  private note_latency(painted: number): void {
    const sent_ms = this.sent_ms.get(painted);
    if (sent_ms !== undefined) this.latencies_ms.push(performance.now() - sent_ms);
    if (this.latencies_ms.length > 200) this.latencies_ms.shift();
    for (const number of this.sent_ms.keys()) if (number <= painted) this.sent_ms.delete(number);
  }

  /** For tests, and for style: whether the last pass of the last state is on the canvas. */
  private tell_done(): void {
    const done = this.complete === this.session?.number && this.picture.idle && !this.session.holds;
    document.body.dataset['picture'] = done ? 'done' : 'under way';
  }

  tile(tile: Tile): void {
    if (tile.number >= first_id) void this.vary.tile(tile);
    else this.picture.tile(tile);
  }

  file(file: SentFile): void {
    void this.out.file(file);
  }

  fault(text: string): void {
    this.say(text);
  }

  reach(why: string | null): void {
    this.status.reach(why);
  }
}

function requestIdle(act: () => void): void {
  if ('requestIdleCallback' in window) requestIdleCallback(act, { timeout: 1000 });
  else act();
}

// For tests, and for the curious.
Object.assign(window, { studio: new Page() });
