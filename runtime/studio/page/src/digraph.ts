// Which map may follow which, as a matrix of switches: row first, then column.
import { element } from './dom';
import type { ControlDigraph, Edit } from './protocol';
import type { Studio } from './studio';

const most_maps = 24;

export class Digraph {
  readonly element = element('div', { class: 'digraph' });
  private shown = false;

  constructor(private readonly studio: Studio) {}

  show(shown = this.shown): void {
    this.shown = shown;
    const digraphs = shown ? (this.studio.model?.digraphs ?? []) : [];
    const focus = (document.activeElement as HTMLElement | null)?.dataset?.['edge'];
    this.element.replaceChildren(...digraphs.filter(({ maps }) => maps.length > 1 && maps.length <= most_maps)
      .flatMap((digraph) => this.table(digraph, digraphs.length > 1)));
    if (focus) this.element.querySelector<HTMLElement>(`[data-edge="${CSS.escape(focus)}"]`)?.focus();
  }

  private table({ block, maps, edges }: ControlDigraph, is_one_of_many: boolean): HTMLElement[] {
    return [
      element('h2', {}, `Which map may follow which${is_one_of_many ? `: ${block}` : ''}`),
      element('table', {},
        element('thead', {}, element('tr', {}, element('td', {}), ...maps.map((name) => element('th', { scope: 'col' }, name)))),
        element('tbody', {}, ...maps.map((from, row) => element('tr', {}, element('th', { scope: 'row' }, from),
          ...maps.map((to, column) => element('td', {}, this.toggle(from, to, Boolean(edges[row]?.[column])))))))),
    ];
  }

  private toggle(from: string, to: string, edge: boolean): HTMLElement {
    return element('button', {
      type: 'button', class: 'edge', 'aria-pressed': String(edge), 'data-edge': `${from} ${to}`,
      'aria-label': `${to} may follow ${from}`, title: `${to} may follow ${from}`,
      onclick: async () => {
        try {
          const { edits, contracts, why } = await this.studio.session.ask('digraph', { from, to, edge: !edge });
          if (contracts === false) this.studio.say(String(why ?? 'The maps would not shrink.'));
          else this.studio.edit(edits as Edit[]);
        } catch (error) {
          this.studio.say((error as Error).message);
        }
      },
    });
  }
}
