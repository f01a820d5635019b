// The address of what is seen, as a row of crumbs that lead back out, or as a line that can be typed.
import { element } from './dom';
import type { Studio } from './studio';

const most_crumbs = 4;

export class Place {
  private typing = false;
  private shown = '';

  constructor(private readonly form: HTMLFormElement, private readonly studio: Studio) {
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const data = new FormData(form), field = (name: string) => String(data.get(name) ?? '').trim() || null;
      this.typing = false;
      studio.change({ at: field('at'), zoom: field('zoom'), camera: null });
      this.show();
    });
    form.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || !this.typing) return;
      this.typing = false;
      this.show();
      form.querySelector<HTMLElement>('.edit')?.focus();
    });
  }

  show(): void {
    const { at, zoom } = this.studio.history.now, shown = JSON.stringify([at, zoom, this.typing]);
    if (this.typing || shown === this.shown) return;
    this.shown = shown;
    const parts = at ? parts_of(at) : [];
    const hidden = Math.max(0, parts.length - most_crumbs);
    const crumb = (label: string, to: string | null, current: boolean) => element('button', {
      type: 'button', class: 'crumb', 'aria-current': current ? 'location' : null,
      onclick: () => this.studio.change({ at: to, zoom: null, camera: null }),
    }, label);
    const edit = element('button', {
      type: 'button', class: 'crumb edit', 'aria-label': 'Type an address', title: 'Type an address', onclick: () => this.type(),
    }, zoom && zoom !== '1' ? `× ${short_zoom(zoom)}` : '✎');
    this.form.replaceChildren(
      crumb('whole', null, parts.length === 0),
      hidden > 0 ? element('span', {}, '…') : '',
      ...parts.slice(hidden).map((part, i) => crumb(part, parts.slice(0, hidden + i + 1).join('.'), hidden + i + 1 === parts.length)),
      edit,
    );
  }

  private type(): void {
    const { at, zoom } = this.studio.history.now;
    this.typing = true;
    this.shown = '';
    const address = element('input', { name: 'at', 'aria-label': 'Address', placeholder: 'address, as of --at', value: at ?? '', spellcheck: 'false' });
    this.form.replaceChildren(
      address,
      element('input', { name: 'zoom', 'aria-label': 'Zoom', placeholder: 'zoom', value: zoom ?? '', size: 8, spellcheck: 'false' }),
      element('button', { class: 'crumb' }, 'Go'),
    );
    address.select();
  }
}

/** The steps of an address; those in brackets stay together. */
function parts_of(address: string): string[] {
  const parts = [''];
  let depth = 0;
  for (const letter of address) {
    if (letter === '(') ++depth;
    if (letter === ')') --depth;
    if (letter === '.' && depth === 0) parts.push('');
    else parts[parts.length - 1] += letter;
  }
  return parts;
}

export function short_zoom(zoom: string): string {
  const value = Number(zoom);
  if (!Number.isFinite(value)) return zoom;
  return value >= 1e5 || value < 0.01 ? value.toExponential(1).replace('e+', 'e') : String(Number(value.toPrecision(3)));
}
