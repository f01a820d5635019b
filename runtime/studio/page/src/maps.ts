// The maps of the model as boxes over the picture, with handles: the box moves, a corner scales, a side stretches and shears, the
// round knob turns about the foot. The text follows by the ask `map`.
import { element, draggable, svg, type Drag } from './dom';
import { covers_of, reachable, type Place } from './reach';
import { latest, type Studio } from './studio';
import type { Box, Camera, Edit, Matrix, ModelMap, Vec3 } from './protocol';
import { about, add, column, compose, corner, dot, dragged, edge_towards, far_from, flat_axis, hull_of, length, map_point, matrix_of, middle, projected, subtract, times, turned, unit, units_of_pixel, view_of } from './vectors';

/** A model may have thousands of maps: the page stays quick, and shows the first. */
const most_shown = 64;
const handle_px = 7, knob_px = 11, stem_px = 30, double_click_ms = 400;
/** The knob is so far at least from what it turns a map about: a hand tells a degree. */
const lever_px = 80;
/** Ways to look for room in, where the sides of a box have none. */
const ways_about = 16;
const whole_view = 'The boxes show in the whole view: press 0 on the picture.';
const hues = [212, 28, 145, 275, 350, 60, 185, 320];

interface Wish {
  map: ModelMap;
  matrix: Matrix;
  /** What a pixel of the screen shows there. */
  grain: number;
  /** The step of the history. */
  key: string;
}

export class Maps {
  readonly list = element('ul', { class: 'maps' });
  /** Matrices that a drag has reached before the session answered, by name. */
  private readonly ahead = new Map<string, Matrix>();
  private readonly refused = new Map<string, string>();
  private chosen: string | null = null;
  private dragging = false;
  private drags = 0;
  /** The way in which the knob's stem goes, of those that `stem` tries. */
  private side = -1;
  /** The knob's place under the hand. */
  private knob: Place | null = null;
  private clicked: { name: string; ms: number } | null = null;
  private readonly ask: (wish: Wish) => void;

  constructor(
    private readonly overlay: SVGSVGElement, private readonly studio: Studio,
    /** A double click on a box is one on the picture. */
    private readonly pick: (event: PointerEvent) => void,
    /** What stands behind the boxes. */
    private readonly behind: (camera: Camera) => SVGElement | null,
  ) {
    this.ask = latest((wish) => this.ask_now(wish));
    // The overlay holds the pointer: its shapes are made anew while they are dragged.
    draggable(overlay, (event) => {
      const name = (event.target as Element).closest<SVGElement>('[data-of]')?.dataset['of'];
      const { model } = studio, map = model?.maps.find((one) => one.name === name);
      return map ? this.begin(event, map, flat_axis(model!.box)) : null;
    });
  }

  private shown = false;

  show(shown: boolean): void {
    this.shown = shown;
    this.draw();
  }

  /** A new model came: what it says holds, except under the hand of a drag. */
  model_came(): void {
    if (!this.dragging) {
      this.ahead.clear();
      this.refused.clear();
    }
    this.draw();
  }

  draw(): void {
    const { model, camera, history, size } = this.studio;
    if (!this.shown) {
      this.overlay.replaceChildren();
      return;
    }
    const all = model?.maps ?? [], maps = all.slice(0, most_shown), zoomed = history.now.at !== null || history.now.zoom !== null;
    this.draw_list(maps, all.length - maps.length, zoomed);
    if (camera === null || zoomed || maps.length === 0) {
      this.overlay.replaceChildren();
      return;
    }
    this.overlay.setAttribute('viewBox', `0 0 ${size.width_px} ${size.height_px}`);
    const focus = (document.activeElement as SVGElement | null)?.dataset?.['map'];
    const flat = flat_axis(model!.box);
    // Small boxes lie on large ones, and the handles of the chosen one on all.
    const size_of = (map: ModelMap) => length(subtract(map.box.most, map.box.least)) * map.contraction;
    const chosen = maps.findIndex(({ name }) => name === this.chosen);
    const boxes = maps.map((map, i) => ({ map, made: this.box(map, i, camera, flat) }))
      .sort((a, b) => size_of(b.map) - size_of(a.map)).map(({ made }) => made);
    if (chosen >= 0) boxes.push(this.handles(maps[chosen]!, chosen, camera, flat));
    const behind = this.behind(camera);
    this.overlay.replaceChildren(...(behind ? [behind] : []), ...boxes);
    if (focus) this.focus(focus);
  }

  private focus(map: string): void {
    this.overlay.querySelector<SVGElement>(`[data-map="${CSS.escape(map)}"]`)?.focus({ preventScroll: true });
  }

  private draw_list(maps: ModelMap[], more: number, zoomed: boolean): void {
    const focus = (document.activeElement as HTMLElement | null)?.dataset?.['listed'];
    this.list.replaceChildren(...maps.map((map, i) => {
      const why = this.refused.get(map.name) ?? (map.movable ? '' : map.why ?? 'Its text cannot be rewritten.');
      return element('li', { class: why ? 'bad' : '' },
        element('span', { class: 'dot', style: `--hue:${hues[i % hues.length]}` }),
        element('button', {
          type: 'button', class: 'link', 'data-listed': map.name, 'aria-current': this.chosen === map.name ? 'true' : null,
          onclick: () => {
            this.choose(map);
            this.studio.select(map.from, map.to);
            this.draw();
          },
          onkeydown: (event: KeyboardEvent) => this.chosen === map.name && this.key(event, map),
        }, map.name),
        element('span', { class: 'note' }, why || `shrinks to ${plain_share(map.contraction)}`));
    }));
    if (more > 0) this.list.append(element('li', { class: 'note' }, `and ${more} more`));
    if (!maps.length) this.list.append(element('li', { class: 'note' }, 'This model has no maps. Models of the language .rifs have them.'));
    else if (!zoomed) this.list.append(element('li', { class: 'note' }, 'Drag a box to move it, a square to scale it, a diamond to stretch it, the round knob to turn it about the cross. Arrow keys move the chosen map; with Shift they turn and scale it.'));
    if (maps.length && zoomed) this.list.append(element('li', { class: 'note' }, whole_view));
    if (focus) this.list.querySelector<HTMLElement>(`[data-listed="${CSS.escape(focus)}"]`)?.focus();
  }

  private matrix_of(map: ModelMap): Matrix {
    return this.ahead.get(map.name) ?? map.matrix;
  }

  private box(map: ModelMap, index: number, camera: Camera, flat: number | null): SVGGElement {
    const { width_px, height_px } = this.studio.size, matrix = this.matrix_of(map), { box } = map;
    const scale = this.px_scale();
    const at = (point: Vec3) => projected(camera, width_px, height_px, map_point(matrix, point));
    const bad = this.refused.has(map.name);
    const group = svg('g', {
      'data-of': map.name, class: `map${bad ? ' bad' : ''}${map.movable ? '' : ' fixed'}${this.chosen === map.name ? ' chosen' : ''}`,
      style: `--hue:${hues[index % hues.length]}`, tabindex: 0, role: 'button', 'data-map': map.name,
      'aria-label': `Map ${map.name}. Arrow keys move it, with Shift they turn and scale it.`,
    });
    const bits = corner_bits(flat);
    const corners = new Map(bits.map((bit) => [bit, at(corner(box, bit))]));
    const edges = bits.flatMap((bit) => [0, 1, 2].map((axis) => [bit, bit | (1 << axis)] as const))
      .filter(([a, b]) => a !== b && corners.get(a) && corners.get(b));
    const path = edges.map(([a, b]) => `M${corners.get(a)!.join(' ')}L${corners.get(b)!.join(' ')}`).join('');
    const hull = hull_of([...corners.values()].filter((p): p is [number, number] => p !== null));
    group.append(
      svg('title', {}, bad ? this.refused.get(map.name)! : map.name),
      svg('path', { class: 'face', 'data-handle': 'move', d: hull.length ? `M${hull.map((p) => p.join(' ')).join('L')}Z` : '' }),
      svg('path', { class: 'edges', d: path }),
    );
    const centre = at(middle(box));
    if (centre) group.append(svg('text', { x: centre[0], y: centre[1], 'font-size': 13 * scale }, map.name));
    group.addEventListener('focus', () => {
      if (this.chosen === map.name) return;
      this.choose(map);
      this.draw();
    });
    group.addEventListener('keydown', (event) => this.key(event as KeyboardEvent, map));
    return group;
  }

  private handles(map: ModelMap, index: number, camera: Camera, flat: number | null): SVGGElement {
    const { width_px, height_px } = this.studio.size, matrix = this.matrix_of(map), { box } = map, scale = this.px_scale();
    const covers = covers_of(this.overlay, ['tools', 'foot', 'picked', 'stale'], scale);
    const reach = (place: Place, radius_px = handle_px) => reachable(place, { left: 0, top: 0, right: width_px, bottom: height_px }, covers, radius_px * scale);
    const at = (point: Vec3) => projected(camera, width_px, height_px, map_point(matrix, point));
    const group = svg('g', { 'data-of': map.name, class: `handles${this.refused.has(map.name) ? ' bad' : ''}`, style: `--hue:${hues[index % hues.length]}` });
    if (!map.movable) return group;
    const corners = corner_bits(flat).map((bit) => [bit, at(corner(box, bit))] as const);
    for (const axis of [0, 1, 2].filter((one) => one !== flat)) {
      for (const side of [0, 1]) {
        const point = middle(box);
        point[axis] = (side ? box.most : box.least)[axis]!;
        const seen = at(point), place = seen && reach(seen);
        if (!place) continue;
        const [x, y] = place, r = 6.5 * scale;
        group.append(svg('path', { class: 'handle edge', 'data-handle': `edge ${axis} ${side}`, d: `M${x - r} ${y}L${x} ${y - r}L${x + r} ${y}L${x} ${y + r}Z` },
          svg('title', {}, 'Stretch and shear')));
      }
    }
    for (const [bit, seen] of corners) {
      if (!seen) continue;
      const place = reach(seen);
      group.append(svg('rect', {
        class: 'handle corner', 'data-handle': `corner ${bit}`, x: place[0] - 5.5 * scale, y: place[1] - 5.5 * scale, width: 11 * scale, height: 11 * scale,
      }, svg('title', {}, 'Scale')));
    }
    const hull = hull_of(corners.map(([, place]) => place).filter((p): p is Place => p !== null)), centre = at(middle(box));
    if (!hull.length || !centre) return group;
    const pivot = at(foot_of(box));
    if (pivot) group.append(svg('path', { class: 'pivot', d: cross_at(pivot, 6 * scale) }));
    const [foot, knob] = this.stem(map, camera, centre, pivot ?? centre, hull, (place) => reach(place, knob_px));
    const [x, y] = knob, r = 4.5 * scale;
    group.append(
      svg('path', { class: 'stem', d: `M${foot.join(' ')}L${knob.join(' ')}` }),
      svg('circle', { class: 'handle turn', 'data-handle': 'turn', cx: x, cy: y, r: 9 * scale },
        svg('title', {}, 'Turn about the cross; with Shift by steps of 15°, with Alt about the middle')),
      svg('path', { class: 'arc', d: `M${x + r} ${y}A${r} ${r} 0 1 1 ${x} ${y - r}m${-r / 2} ${-r / 2}l${r / 2} ${r / 2}l${-r / 2} ${r / 2}` }),
    );
    return group;
  }

  /** Where the stem of the knob begins, and where it ends: above the top of the map, or else where there is room. */
  private stem(map: ModelMap, camera: Camera, centre: Place, pivot: Place, hull: Place[], reach: (place: Place) => Place): [Place, Place] {
    const { width_px, height_px } = this.studio.size, matrix = this.matrix_of(map), stem = stem_px * this.px_scale(), lever = lever_px * this.px_scale();
    const top = middle(map.box);
    top[1] = map.box.most[1];
    const seen = projected(camera, width_px, height_px, map_point(matrix, top)) ?? [centre[0], centre[1] - 1];
    const [x, y] = [seen[0] - centre[0], seen[1] - centre[1]], far = Math.hypot(x, y);
    const up: Place = far > 1e-6 ? [x / far, y / far] : [0, -1];
    const ways: Place[] = [up, [-up[0], -up[1]], [-up[1], up[0]], [up[1], -up[0]]];
    const along = ([ax, ay]: Place, way: Place, by: number): Place => [ax + by * way[0], ay + by * way[1]];
    // Stems on the outline of the box.
    const stems = ways.map((way): [Place, Place] => {
      const foot = edge_towards(hull, centre, way);
      return [foot, along(foot, way, Math.max(stem, far_from(foot, way, centre, lever), far_from(foot, way, pivot, lever)))];
    });
    // A box that fills the picture has its knob inside.
    const near = reach(centre);
    for (let i = 0; i < ways_about; ++i) {
      const angle = Math.atan2(up[1], up[0]) + (2 * Math.PI * i) / ways_about;
      stems.push([near, along(pivot, [Math.cos(angle), Math.sin(angle)], lever)]);
    }
    const has_room = ([, end]: [Place, Place]) => reach(end).every((value, i) => value === end[i]);
    // The knob stays on its side, under the hand at any rate.
    const side = stems[this.side];
    if (!side || !(this.dragging || has_room(side))) this.side = stems.findIndex(has_room);
    const [foot, end] = stems[this.side] ?? [near, along(near, [0, -1], lever)];
    return [foot, this.knob ?? reach(end)];
  }

  /** Pixels of the picture in one of the screen. */
  private px_scale(): number {
    const { width } = this.overlay.getBoundingClientRect();
    return width > 0 ? this.studio.size.width_px / width : 1;
  }

  private begin(event: PointerEvent, map: ModelMap, flat: number | null): Drag | null {
    const handle = (event.target as Element).getAttribute('data-handle');
    const { camera, size } = this.studio;
    if (!camera || !handle || event.button !== 0) return null;
    if (this.chosen !== map.name) {
      this.choose(map);
      this.draw();
    }
    this.focus(map.name);
    if (!map.movable) {
      this.say_fixed(map);
      this.draw();
      return null;
    }
    this.dragging = true;
    ++this.drags;
    const { width_px, height_px } = size, scale = this.px_scale(), start = this.matrix_of(map);
    const normal = flat === null ? view_of(camera).into : unit([Number(flat === 0), Number(flat === 1), Number(flat === 2)]);
    const [kind, first, second] = handle.split(' ');
    const centre = map_point(start, middle(map.box));
    const foot = map_point(start, foot_of(map.box));
    const bounds = this.overlay.getBoundingClientRect();
    const place = (one: PointerEvent): [number, number] => [(one.clientX - bounds.left) * scale, (one.clientY - bounds.top) * scale];
    const down = place(event), knob = event.target as Element;
    const held = ['cx', 'cy'].map((name, i) => Number(knob.getAttribute(name)) - down[i]!);
    return {
      move: (now) => {
        const to = place(now), dx = to[0] - down[0], dy = to[1] - down[1];
        const drag_from = (point: Vec3) => dragged(camera, width_px, point, dx, dy, flat === null ? undefined : normal);
        let by: Matrix;
        if (kind === 'move') {
          by = matrix_of([1, 0, 0], [0, 1, 0], [0, 0, 1], subtract(drag_from(centre), centre));
        } else if (kind === 'turn') {
          const pivot = now.altKey ? centre : foot, seen = projected(camera, width_px, height_px, pivot);
          if (!seen) return;
          const angle = (p: Place) => Math.atan2(-(p[1] - seen[1]), p[0] - seen[0]);
          const seen_from_front = dot(normal, view_of(camera).into) < 0 ? 1 : -1;
          let turn_rad = angle(to) - angle(down);
          if (now.shiftKey) turn_rad = (Math.round((turn_rad * 180) / Math.PI / 15) * 15 * Math.PI) / 180;
          by = about(pivot, (d) => turned(d, normal, turn_rad * seen_from_front));
          this.knob = [to[0] + held[0]!, to[1] + held[1]!];
        } else if (kind === 'corner') {
          // The corner across stays; in space that is the middle, for the one across may lie behind.
          const bit = Number(first), held = map_point(start, corner(map.box, bit));
          const across = flat === null || now.altKey ? centre : map_point(start, corner(map.box, ~bit & 7 & ~(1 << flat)));
          const arm = subtract(held, across), reach = subtract(drag_from(held), across);
          const factor = Math.max(0.02, dot(reach, arm) / (dot(arm, arm) || 1));
          by = about(across, (d) => times(d, factor));
        } else if (kind === 'edge') {
          const axis = Number(first), side = Number(second), still = middle(map.box), held = middle(map.box);
          still[axis] = (side ? map.box.least : map.box.most)[axis]!;
          held[axis] = (side ? map.box.most : map.box.least)[axis]!;
          const moved = subtract(drag_from(map_point(start, held)), map_point(start, held));
          const extent = held[axis]! - still[axis]!;
          const columns = [0, 1, 2].map((c) => (c === axis ? add(column(start, c), times(moved, 1 / (extent || 1))) : column(start, c)));
          const fixed = map_point(start, still);
          const linear = matrix_of(columns[0]!, columns[1]!, columns[2]!, [0, 0, 0]);
          this.wish(map, matrix_of(columns[0]!, columns[1]!, columns[2]!, subtract(fixed, map_point(linear, still))));
          return;
        } else {
          return;
        }
        this.wish(map, compose(by, start));
      },
      end: (up) => {
        this.dragging = false;
        this.knob = null;
        if (up.clientX === event.clientX && up.clientY === event.clientY) this.click(up, map);
        this.let_go();
        this.draw();
      },
    };
  }

  /** One click selects the map; the second, soon after it, the part that the picture shows there. */
  private click(event: PointerEvent, map: ModelMap): void {
    const twice = this.clicked?.name === map.name && event.timeStamp - this.clicked.ms < double_click_ms;
    this.clicked = twice ? null : { name: map.name, ms: event.timeStamp };
    if (twice) this.pick(event);
    else this.studio.select(map.from, map.to);
  }

  /** A map that was refused goes back to where the text has it. */
  private let_go(): void {
    for (const name of this.refused.keys()) this.ahead.delete(name);
    this.refused.clear();
  }

  private choose(map: ModelMap): void {
    this.chosen = map.name;
    this.side = -1;
  }

  private say_fixed(map: ModelMap): void {
    this.studio.say(map.why ?? 'The text of this map cannot be rewritten.');
  }

  private key(event: KeyboardEvent, map: ModelMap): void {
    const { camera, size, history: { now } } = this.studio;
    if (!camera || event.ctrlKey || event.metaKey || event.altKey) return;
    const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    if (!arrow) return;
    event.preventDefault();
    event.stopPropagation();
    if (!map.movable) return this.say_fixed(map);
    if (now.at !== null || now.zoom !== null) return this.studio.say(whole_view);
    const start = this.matrix_of(map), centre = map_point(start, middle(map.box)), flat = flat_axis(this.studio.model!.box);
    const normal = flat === null ? times(view_of(camera).into, -1) : unit([Number(flat === 0), Number(flat === 1), Number(flat === 2)]);
    let by: Matrix;
    if (!event.shiftKey) {
      const step = 8 * this.px_scale();
      const moved = dragged(camera, size.width_px, centre, arrow[0] * step, arrow[1] * step, flat === null ? undefined : normal);
      by = matrix_of([1, 0, 0], [0, 1, 0], [0, 0, 1], subtract(moved, centre));
    } else if (arrow[0]) {
      by = about(map_point(start, foot_of(map.box)), (d) => turned(d, normal, (-arrow[0] * 5 * Math.PI) / 180));
    } else {
      by = about(centre, (d) => times(d, arrow[1] < 0 ? 1.05 : 1 / 1.05));
    }
    this.wish(map, compose(by, start));
  }

  private wish(map: ModelMap, matrix: Matrix): void {
    this.studio.hold_view();
    this.ahead.set(map.name, matrix);
    this.draw();
    const { camera } = this.studio;
    const grain = camera ? units_of_pixel(camera, this.overlay.getBoundingClientRect().width, map_point(matrix, middle(map.box))) : 0;
    this.ask({ map, matrix, grain, key: `map ${map.name}${this.dragging ? ` #${this.drags}` : ''}` });
  }

  private async ask_now({ map, matrix, grain, key }: Wish): Promise<void> {
    const { session, history } = this.studio, before = history.now.text;
    try {
      const answer = await session.ask('map', { name: map.name, matrix, grain });
      if (history.now.text !== before) return;
      if (answer['contracts'] === false) this.refused.set(map.name, String(answer['why'] ?? 'It would not shrink.'));
      else this.refused.delete(map.name);
      const edits = answer['edits'] as Edit[] | undefined;
      if (edits?.length && !this.refused.has(map.name)) this.studio.edit(edits, key);
    } catch (error) {
      this.refused.set(map.name, (error as Error).message);
    }
    const why = this.refused.get(map.name);
    if (why) this.studio.say(why);
    if (!this.dragging) this.let_go();
    this.draw();
  }
}

/** The corners of a box, of a flat one those of its face (`corner`). */
function corner_bits(flat: number | null): number[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].filter((bit) => flat === null || !(bit & (1 << flat)));
}

function plain_share(contraction: number): string {
  return `${(100 * contraction).toFixed(contraction < 0.1 ? 1 : 0)} %`;
}

/** What a map turns about, in the frame below it: the origin, on which a frond stands, or the middle of a box that lies elsewhere. */
function foot_of(box: Box): Vec3 {
  const slack = 1e-3 * length(subtract(box.most, box.least));
  return [0, 1, 2].every((axis) => box.least[axis]! <= slack && box.most[axis]! >= -slack) ? [0, 0, 0] : middle(box);
}

function cross_at([x, y]: Place, r: number): string {
  return `M${x - r} ${y}H${x + r}M${x} ${y - r}V${y + r}`;
}
