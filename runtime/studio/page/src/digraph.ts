// Which map may follow which, as a matrix of switches: row first, then column.
import { element } from './dom';
import type { Edit, ModelMap } from './protocol';
import type { Studio } from './studio';

const most_maps = 24;

export class Digraph {
  readonly element = element('div', { class: 'digraph' });

  constructor(private readonly studio: Studio) {}

  private shown = false;

  show(shown = this.shown): void {
    this.shown = shown;
    const all = shown ? (this.studio.model?.maps ?? []) : [];
    const maps = all.length <= most_maps ? all.filter(({ follows }) => follows) : [];
    const focus = (document.activeElement as HTMLElement | null)?.dataset?.['edge'];
    this.element.replaceChildren();
    if (maps.length < 2) return;
    const names = maps.map(({ name }) => name);
    this.element.append(
      element('h2', {}, 'Which map may follow which'),
      element('table', {},
        element('thead', {}, element('tr', {}, element('td', {}), ...names.map((name) => element('th', { scope: 'col' }, element('span', {}, name))))),
        element('tbody', {}, ...maps.map((map) => element('tr', {}, element('th', { scope: 'row' }, map.name),
          ...names.map((name) => element('td', {}, this.toggle(map, name))))))),
    );
    if (focus) this.element.querySelector<HTMLElement>(`[data-edge="${CSS.escape(focus)}"]`)?.focus();
  }

  private toggle(map: ModelMap, to: string): HTMLElement {
    const edge = map.follows!.includes(to);
    return element('button', {
      type: 'button', class: 'edge', 'aria-pressed': String(edge), 'data-edge': `${map.name} ${to}`,
      'aria-label': `${to} may follow ${map.name}`, title: `${to} may follow ${map.name}`,
      onclick: async () => {
        try {
          const { edits } = await this.studio.session.ask('digraph', { object: map.object, from: map.name, to, edge: !edge });
          this.studio.edit(edits as Edit[]);
        } catch (error) {
          this.studio.say((error as Error).message);
        }
      },
    });
  }
}
