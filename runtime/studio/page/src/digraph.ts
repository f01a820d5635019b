// The control digraph, which says which map may follow which: drawn, and as a matrix of switches (row first, then column).
import { draggable, element, svg } from './dom';
import type { ControlDigraph, Edit } from './protocol';
import type { Studio } from './studio';

const most_maps = 24, most_drawn = 12;
/** Of the drawing, in its own units, which are pixels unless the page is narrow. */
const size = 260, ring = 80, node_radius = 19, most_letters = 6;

type Point = [number, number];
const along = (a: Point, b: Point, length: number): Point => {
  const way = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  return [a[0] + ((b[0] - a[0]) * length) / way, a[1] + ((b[1] - a[1]) * length) / way];
};
const text_of = ([x, y]: Point): string => `${x.toFixed(1)} ${y.toFixed(1)}`;

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
      ...(maps.length <= most_drawn ? [this.drawing(block, maps, edges)] : []),
      element('table', {},
        element('thead', {}, element('tr', {}, element('td', {}), ...maps.map((name) => element('th', { scope: 'col' }, name)))),
        element('tbody', {}, ...maps.map((from, row) => element('tr', {}, element('th', { scope: 'row' }, from),
          ...maps.map((to, column) => element('td', {}, this.toggle(from, to, Boolean(edges[row]?.[column])))))))),
    ];
  }

  /** The maps on a circle. A click on an arrow takes it away; a drag from one map to another adds one, or takes it away. */
  private drawing(block: string, maps: string[], edges: ControlDigraph['edges']): HTMLElement {
    const place = (i: number, radius: number, turn = 0): Point => {
      const angle = 2 * Math.PI * (i / maps.length) - Math.PI / 2 + turn;
      return [size / 2 + radius * Math.cos(angle), size / 2 + radius * Math.sin(angle)];
    };
    const arrow = (from: number, to: number): string => {
      const start = place(from, ring), end = place(to, ring);
      if (from === to) {
        const out = place(from, ring + 58, -0.32), back = place(from, ring + 58, 0.32);
        return `M${text_of(along(start, out, node_radius))}C${text_of(out)} ${text_of(back)} ${text_of(along(start, back, node_radius + 5))}`;
      }
      const middle: Point = [(start[0] + end[0]) / 2, (start[1] + end[1]) / 2];
      const bow = along(middle, [middle[0] + end[1] - start[1], middle[1] - end[0] + start[0]], 16);
      return `M${text_of(along(start, bow, node_radius))}Q${text_of(bow)} ${text_of(along(end, bow, node_radius + 5))}`;
    };
    const arrows = maps.flatMap((from, row) => maps.flatMap((to, column) => {
      if (!edges[row]?.[column]) return [];
      const d = arrow(row, column);
      return [svg('g', { class: 'arrow', 'data-arrow': `${from} ${to}`, onclick: () => void this.switch_edge(from, to, false) },
        svg('title', {}, `${to} may follow ${from}`), svg('path', { class: 'reach', d }), svg('path', { d, 'marker-end': `url(#arrow-of-${block})` }))];
    }));
    const line = svg('path', { class: 'line', hidden: true });
    const nodes = maps.map((name, i) => {
      const centre = place(i, ring), label = name.length > most_letters ? `${name.slice(0, most_letters - 1)}…` : name;
      const node = svg('circle', { class: 'node', cx: centre[0], cy: centre[1], r: node_radius, 'data-node': name }, svg('title', {}, name));
      draggable(node, () => ({
        move: (event) => {
          const box = drawing.getBoundingClientRect(), scale = size / box.width;
          line.setAttribute('d', `M${text_of(centre)}L${text_of([(event.clientX - box.left) * scale, (event.clientY - box.top) * scale])}`);
          line.removeAttribute('hidden');
        },
        end: (event) => {
          line.setAttribute('hidden', '');
          const to = document.elementFromPoint(event.clientX, event.clientY)?.closest<SVGElement>('[data-node]')?.dataset['node'];
          if (event.type !== 'pointerup' || to === undefined || !drawing.contains(document.elementFromPoint(event.clientX, event.clientY))) return;
          void this.switch_edge(name, to, !edges[i]?.[maps.indexOf(to)]);
        },
      }));
      return [node, svg('text', { x: centre[0], y: centre[1] }, label)];
    });
    // The matrix below says and does the same for those who cannot see or point.
    const drawing = svg('svg', { class: 'drawn', viewBox: `0 0 ${size} ${size}`, 'aria-hidden': 'true' },
      svg('marker', { id: `arrow-of-${block}`, viewBox: '0 0 8 8', refX: 3, refY: 4, markerWidth: 7, markerHeight: 7, orient: 'auto' },
        svg('path', { d: 'M0 0L8 4L0 8z' })),
      ...arrows, line, ...nodes.flat());
    return element('div', {}, drawing, element('p', { class: 'note' }, 'Drag from a map to another to let it follow; click an arrow to take it away.'));
  }

  private toggle(from: string, to: string, edge: boolean): HTMLElement {
    return element('button', {
      type: 'button', class: 'edge', 'aria-pressed': String(edge), 'data-edge': `${from} ${to}`,
      'aria-label': `${to} may follow ${from}`, title: `${to} may follow ${from}`,
      onclick: () => void this.switch_edge(from, to, !edge),
    });
  }

  private async switch_edge(from: string, to: string, edge: boolean): Promise<void> {
    try {
      const { edits, contracts, why } = await this.studio.session.ask('digraph', { from, to, edge });
      if (contracts === false) this.studio.say(String(why ?? 'The maps would not shrink.'));
      else this.studio.edit(edits as Edit[]);
    } catch (error) {
      this.studio.say((error as Error).message);
    }
  }
}
