// A slider for each parameter of the model, and for its steps and its seed.
import { element } from './dom';
import type { Parameter } from './protocol';
import { Slider } from './slider';
import type { Studio } from './studio';

interface Row {
  slider: Slider;
  element: HTMLElement;
  reset: HTMLButtonElement;
  write: HTMLButtonElement | null;
  /** By text, the value that it gives: as far as models have told, or a knob was written. The newest stands at the end. */
  own: Map<string, number>;
}

/** A model may have thousands of parameters: the page stays quick, and shows the first. */
const most_shown = 64, most_texts = 100;
const is_common = (name: string) => name === 'steps' || name === 'seed';
const groups: [Parameter['kind'], string][] = [['let', 'Values'], ['inner', 'Inner values'], ['setting', 'Settings']];

export class Knobs {
  readonly element = element('div', { class: 'knobs' });
  private readonly rows = new Map<string, Row>();
  private shape = '';
  /** A number to write as soon as a model says where it stands in the text as it is. */
  private owed: { name: string; until_ms: number } | null = null;

  constructor(private readonly studio: Studio) {}

  /** A model of the state that is shown came. */
  model_came(): void {
    this.show();
    const { model, history: { now } } = this.studio;
    for (const [name, row] of this.rows) {
      const key = name === ': steps' ? 'steps' : name === ': seed' ? 'seed' : null;
      if (key) {
        const value = this.model_value(key);
        if (now[key] === null && value !== null) note_own(row, now.text, value);
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
    if (owed && performance.now() < owed.until_ms) this.write(owed.name);
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
      row.slider.show(changed ? set[parameter.name]! : value, least, most);
      row.reset.disabled = !changed;
      if (row.write) row.write.disabled = !changed;
    }
    for (const key of ['steps', 'seed'] as const) {
      const row = this.rows.get(`: ${key}`)!, chosen = history.now[key], own = own_of(row, history.now.text) ?? this.model_value(key), value = chosen ?? own ?? 0;
      row.slider.show(value, 0, Math.max(key === 'steps' ? 12 : 100, 2 * (own ?? 0)), chosen === null && own === null ? '–' : undefined);
      row.reset.disabled = chosen === null;
    }
  }

  private model_value(key: 'steps' | 'seed'): number | null {
    const stats = this.studio.model?.stats, value = stats && typeof stats === 'object' ? stats[key] : null;
    return typeof value === 'number' ? value : null;
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
      element('h2', {}, 'Growth and chance'),
      this.choice_row('steps', 'Steps'),
      this.choice_row('seed', 'Seed'),
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
    const write = !parameter.literal || parameter.from === undefined ? null
      : this.small('Write', `Write ${name} into the text`, () => this.write(name));
    return this.row(name, name, slider, reset, write);
  }

  /** Puts the number of a knob into the text in place of the one that stands there. */
  private write(name: string): void {
    const { session, model } = this.studio, patience_ms = 3000;
    if (session.holds || model?.number !== session.number) {
      this.owed = { name, until_ms: performance.now() + patience_ms };
      return;
    }
    const parameter = model.parameters.find((one) => one.name === name);
    const { set: { [name]: value, ...set }, text } = this.studio.history.now;
    if (!parameter || parameter.from === undefined || parameter.to === undefined || value === undefined) return;
    const written = text.slice(0, parameter.from) + String(value) + text.slice(parameter.to);
    note_own(this.rows.get(name)!, written, value);
    this.studio.change({ set, text: written });
  }

  private choice_row(key: 'steps' | 'seed', label: string): HTMLElement {
    const slider = new Slider({
      label, value: 0, least: 0, most: 1, whole: 'always',
      change: (value) => {
        this.studio.change({ [key]: Math.max(0, value) }, `set ${key}`);
      },
    });
    const reset = this.small('↺', `Reset ${label.toLowerCase()}`, () => this.studio.change({ [key]: null }));
    return this.row(`: ${key}`, label, slider, reset, null);
  }

  private small(text: string, label: string, act: () => void): HTMLButtonElement {
    return element('button', { type: 'button', class: 'small', 'aria-label': label, title: label, onclick: act }, text);
  }

  private row(key: string, label: string, slider: Slider, reset: HTMLButtonElement, write: HTMLButtonElement | null): HTMLElement {
    const made = element('div', { class: 'knob' }, element('span', { class: 'name', title: label }, label), slider.range, slider.number, reset, write);
    this.rows.set(key, { slider, element: made, reset, write, own: new Map() });
    return made;
  }
}

function note_own({ own }: Row, text: string, value: number): void {
  own.delete(text);
  own.set(text, value);
  if (own.size > most_texts) own.delete(own.keys().next().value!);
}

/** What the text gives, or else the text that was read last. */
function own_of({ own }: Row, text: string): number | undefined {
  return own.get(text) ?? [...own.values()].at(-1);
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
