// A slider for each parameter of the model and for its steps, and a field for its seed.
import { element, plain_number } from './dom';
import type { Edit, Parameter } from './protocol';
import { SeedField } from './seed';
import { Slider } from './slider';
import { edited, type Studio } from './studio';

interface Row {
  show(value: number | null, least: number, most: number): void;
  element: HTMLElement;
  reset: HTMLButtonElement;
  write: HTMLButtonElement | null;
  /** By text, the value that it gives: as far as models have told, or a knob was written. The newest stands at the end. */
  own: Map<string, number>;
}

/** A knob that the text does not have. */
export interface Unwritten {
  name: string;
  says: string;
  /** The text has a place for its number. */
  can_write: boolean;
}

/** A model may have thousands of parameters: the page stays quick, and shows the first. */
const most_shown = 64, most_texts = 100;
const common = ['steps', 'seed'] as const;
type Common = (typeof common)[number];
const is_common = (name: string): name is Common => common.some((one) => one === name);
const patience_ms = 3000;
const groups: [Parameter['kind'], string][] = [['let', 'Values'], ['inner', 'Inner values'], ['setting', 'Settings']];

export class Knobs {
  readonly element = element('div', { class: 'knobs' });
  private readonly rows = new Map<string, Row>();
  private readonly common_title = element('h2', {}, 'Growth and chance');
  private shape = '';
  /** What to do as soon as a model says where the numbers stand in the text as it is. */
  private owed: { act: () => void; until_ms: number } | null = null;

  constructor(private readonly studio: Studio) {}

  /** A model of the state that is shown came. */
  model_came(): void {
    this.show();
    const { model, history: { now } } = this.studio;
    for (const [name, row] of this.rows) {
      if (name.startsWith(': ')) {
        const key = name.slice(2) as Common, value = this.model_value(key);
        if (now[key] === null && now.time === null && value !== null) note_own(row, now.text, value);
        continue;
      }
      const { literal, value, from, to } = model!.parameters.find((one) => one.name === name)!;
      const written = literal && from !== undefined ? Number(now.text.slice(from, to)) : NaN;
      if (Number.isFinite(written)) note_own(row, now.text, written);
      else if (!(name in now.set)) note_own(row, now.text, value);
    }
    this.show();
    const { owed } = this;
    this.owed = null;
    if (owed && performance.now() < owed.until_ms) owed.act();
  }

  show(): void {
    const { model, history } = this.studio;
    const all = model?.parameters ?? [], parameters = all.slice(0, most_shown);
    // Rows stay while the same parameters are there: a drag must not lose its slider.
    const shape = JSON.stringify([all.length, parameters.map(({ name, kind, literal }) => [name, kind, Boolean(literal)])]);
    if (shape !== this.shape || !this.rows.size) {
      this.shape = shape;
      this.build(parameters, all.length - parameters.length);
    }
    for (const parameter of parameters) {
      const row = this.rows.get(parameter.name);
      if (!row) continue;
      // The range is that of the text's value: it stays while the knob turns.
      const value = own_of(row, history.now.text) ?? parameter.value, [least, most] = range_of({ ...parameter, value });
      const { set } = history.now, changed = parameter.name in set;
      row.show(changed ? set[parameter.name]! : value, least, most);
      row.reset.disabled = !changed;
      if (row.write) row.write.disabled = !changed;
    }
    for (const key of common) {
      const row = this.rows.get(`: ${key}`)!, chosen = history.now[key], own = own_of(row, history.now.text) ?? this.model_value(key);
      row.show(chosen ?? own, 0, Math.max(12, 2 * (own ?? 0)));
      row.reset.disabled = row.write!.disabled = chosen === null;
    }
    const [steps, seed] = common.map((key) => this.rows.get(`: ${key}`)!.element);
    steps!.hidden = model?.grows === false && history.now.steps === null;
    seed!.hidden = model?.chance === false && history.now.seed === null;
    this.common_title.hidden = steps!.hidden && seed!.hidden;
  }

  /** What the picture has and the text has not. */
  unwritten(): Unwritten[] {
    const { model, history: { now } } = this.studio;
    const knobs = Object.entries(now.set).filter(([name, value]) => own_of(this.rows.get(name), now.text) !== value);
    const chosen = common.flatMap((name): [string, number][] => (now[name] === null ? [] : [[name, now[name]]]));
    return [...knobs, ...chosen, ...(now.time === null ? [] : [['age', now.time] as [string, number]])].map(([name, value]) => ({
      name, says: `${name} ${plain_number(value)}`,
      can_write: is_common(name) || (name in now.set && Boolean(model?.parameters.some((one) => one.name === name && is_literal(one)))),
    }));
  }

  private model_value(key: Common): number | null {
    const { model } = this.studio, stats = model?.stats, value = stats && typeof stats === 'object' ? stats[key] : null;
    return typeof value === 'number' ? value : model?.parameters.find(({ name, kind }) => name === key && kind === 'setting')?.value ?? null;
  }

  private build(parameters: Parameter[], more: number): void {
    this.rows.clear();
    this.element.replaceChildren();
    for (const [kind, title] of groups) {
      // Steps and seed of an L-system have their row below, as those of all models.
      const mine = parameters.filter((parameter) => parameter.kind === kind && !(kind === 'setting' && is_common(parameter.name)));
      if (mine.length) this.element.append(element('h2', {}, title), ...mine.map((parameter) => this.parameter_row(parameter)));
    }
    if (more > 0) this.element.append(element('p', { class: 'note' }, `and ${more} more`));
    this.element.append(
      this.common_title,
      this.steps_row(),
      this.seed_row(),
    );
  }

  private parameter_row(parameter: Parameter): HTMLElement {
    const { name } = parameter, [least, most] = range_of(parameter), { history } = this.studio;
    const slider = new Slider({
      label: name, value: parameter.value, least, most, whole: is_whole(parameter, history.now.text) ? 'coarse' : null,
      change: (value) => {
        this.studio.change({ set: { ...history.now.set, [name]: value } }, `set ${name}`);
      },
    });
    const reset = this.small('↺', `Reset ${name}`, () => {
      const { [name]: _, ...set } = history.now.set;
      this.studio.change({ set });
    });
    return this.row(name, name, [slider.range, slider.number], reset, is_literal(parameter) ? this.write_button(name) : null,
      (value, low, high) => slider.show(value!, low, high));
  }

  /** Puts the numbers of knobs into the text in place of those that stand there; `then`: once they are there. */
  write(names: string[], then: () => void = () => {}): void {
    const { session, model } = this.studio;
    if (session.holds || model?.number !== session.number) this.owed = { act: () => this.write(names, then), until_ms: performance.now() + patience_ms };
    else void this.write_now(names).then((done) => done && then());
  }

  private async write_now(names: string[]): Promise<boolean> {
    const { studio } = this, before = studio.history.now, set = { ...before.set }, edits: Edit[] = [];
    const written: [Row, number][] = [], remarks: string[] = [];
    for (const name of names) {
      const value = is_common(name) ? before[name] : set[name];
      if (value === null || value === undefined) continue;
      if (is_common(name)) {
        try {
          const answer = await studio.session.ask('setting', { name, value });
          edits.push(...answer['edits'] as Edit[]);
          if (answer['why']) remarks.push(String(answer['why']));
        } catch (error) {
          studio.say((error as Error).message);
          return false;
        }
        written.push([this.rows.get(`: ${name}`)!, value]);
      } else {
        const parameter = studio.model?.parameters.find((one) => one.name === name);
        if (!parameter || !is_literal(parameter)) continue;
        edits.push({ from: parameter.from!, to: parameter.to!, text: String(value) });
        written.push([this.rows.get(name)!, value]);
        delete set[name];
      }
    }
    if (!edits.length || studio.history.now !== before) return false;
    const text = edited(before.text, edits);
    for (const [row, value] of written) note_own(row, text, value);
    const chosen = Object.fromEntries(common.filter((name) => names.includes(name)).map((name) => [name, null]));
    studio.change({ set, text, ...chosen });
    const first = edits.reduce((a, b) => (b.from < a.from ? b : a));
    studio.select(first.from, first.from + first.text.length);
    const lines = [...new Set(edits.map(({ from }) => before.text.slice(0, from).split('\n').length))].sort((a, b) => a - b);
    studio.say([`Written in ${lines.length === 1 ? 'line' : 'lines'} ${lines.join(', ')}.`, ...remarks].join(' '));
    return true;
  }

  private write_button(name: string): HTMLButtonElement {
    return this.small('Write', `Write ${name} into the text`, () => this.write([name]));
  }

  private steps_row(): HTMLElement {
    const slider = new Slider({
      label: 'Steps', value: 0, least: 0, most: 1, whole: 'always',
      change: (value) => this.studio.change({ steps: Math.max(0, value) }, 'set steps'),
    });
    return this.row(': steps', 'Steps', [slider.range, slider.number], this.reset_button('steps'), this.write_button('steps'),
      (value, least, most) => slider.show(value ?? 0, least, most, value === null ? '–' : undefined));
  }

  private seed_row(): HTMLElement {
    const field = new SeedField((seed) => this.studio.change({ seed }));
    return this.row(': seed', 'Seed', field.parts, this.reset_button('seed'), this.write_button('seed'), (value) => field.show(value));
  }

  private reset_button(key: Common): HTMLButtonElement {
    return this.small('↺', `Reset ${key}`, () => this.studio.change({ [key]: null }));
  }

  private small(text: string, label: string, act: () => void): HTMLButtonElement {
    return element('button', { type: 'button', class: 'small', 'aria-label': label, title: label, onclick: act }, text);
  }

  private row(
    key: string, label: string, parts: HTMLElement[], reset: HTMLButtonElement, write: HTMLButtonElement | null, show: Row['show'],
  ): HTMLElement {
    const made = element('div', { class: 'knob' }, element('span', { class: 'name', title: label }, label), ...parts, reset, write);
    this.rows.set(key, { show, element: made, reset, write, own: new Map() });
    return made;
  }
}

function note_own({ own }: Row, text: string, value: number): void {
  own.delete(text);
  own.set(text, value);
  if (own.size > most_texts) own.delete(own.keys().next().value!);
}

/** What the text gives, or else the text that was read last; null: no model told. */
function own_of(row: Row | undefined, text: string): number | null {
  return row?.own.get(text) ?? [...row?.own.values() ?? []].at(-1) ?? null;
}

function is_literal({ literal, from, to }: Parameter): boolean {
  return Boolean(literal) && from !== undefined && to !== undefined;
}

/** Whether the text writes a parameter without a decimal point. */
function is_whole({ kind, literal, from, to }: Parameter, text: string): boolean {
  return kind !== 'inner' && Boolean(literal) && from !== undefined && /^\d+$/.test(text.slice(from, to));
}

/** The range of a parameter: its own, or one around its value. */
function range_of({ value, least, most }: Parameter): [number, number] {
  const far = value === 0 ? 1 : 2 * Math.abs(value);
  return [least ?? (value < 0 ? -far : 0), most ?? Math.max(far, (least ?? 0) + far)];
}
