// Elements in one line each.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

/** `element('button', { class: 'quiet', onclick: f }, 'Save')`; attributes that are false, null or undefined are left out. */
export function element<Name extends keyof HTMLElementTagNameMap>(
  name: Name, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const made = document.createElement(name);
  set_attributes(made, attributes);
  made.append(...present(children));
  return made;
}

export function svg<Name extends keyof SVGElementTagNameMap>(
  name: Name, attributes: Attributes = {}, ...children: Child[]
): SVGElementTagNameMap[Name] {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  set_attributes(made, attributes);
  made.append(...present(children));
  return made;
}

export function set_attributes(of: Element, attributes: Attributes): void {
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') of.addEventListener(key.slice(2), value as EventListener);
    else if (value === true) of.setAttribute(key, '');
    else if (value === false || value === null || value === undefined) of.removeAttribute(key);
    else of.setAttribute(key, String(value));
  }
}

function present(children: Child[]): (Node | string)[] {
  return children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false);
}

export function by_id<Type extends HTMLElement = HTMLElement>(id: string): Type {
  const found = document.getElementById(id);
  if (!found) throw new Error(`The page has no element ${id}.`);
  return found as Type;
}

/** Calls `act` once, soon after the last of many calls. */
export function soon(act: () => void, after_ms: number): () => void {
  let timer = 0;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(act, after_ms) as unknown as number;
  };
}

/** A drag of the pointer, captured by `on`: `begin` returns what to do as it moves, or null where there is nothing to drag. */
export function draggable(on: Element, begin: (event: PointerEvent) => Drag | null): void {
  on.addEventListener('pointerdown', (raw) => {
    const down = raw as PointerEvent;
    if (!down.isPrimary) return;
    const drag = begin(down);
    if (!drag) return;
    down.preventDefault();
    down.stopPropagation();
    on.setPointerCapture(down.pointerId);
    let last = down;
    const move = (raw_move: Event) => {
      const event = raw_move as PointerEvent;
      if (event.pointerId !== down.pointerId) return;
      drag.move(event, event.clientX - last.clientX, event.clientY - last.clientY);
      last = event;
    };
    const up = (raw_up: Event) => {
      const event = raw_up as PointerEvent;
      if (event.pointerId !== down.pointerId) return;
      on.removeEventListener('pointermove', move);
      on.removeEventListener('pointerup', up);
      on.removeEventListener('pointercancel', up);
      drag.end?.(event);
    };
    on.addEventListener('pointermove', move);
    on.addEventListener('pointerup', up);
    on.addEventListener('pointercancel', up);
  });
}

export interface Drag {
  move(event: PointerEvent, dx_px: number, dy_px: number): void;
  end?(event: PointerEvent): void;
}

/** The number as far as steps of this length tell it from others: by the power of ten that is no longer. 0: as it is. */
export function rounded(value: number, step: number): number {
  if (!(step > 0)) return value;
  const decade = Math.floor(Math.log10(step) + 1e-9);
  return decade < 0 ? Number(value.toFixed(Math.min(100, -decade))) : Math.round(value / 10 ** decade) * 10 ** decade;
}

/** A number as a person writes it. */
export function plain_number(value: number): string {
  if (!Number.isFinite(value)) return '0';
  return String(Number(Math.abs(value) < 1 ? value.toPrecision(6) : value.toFixed(6)));
}
