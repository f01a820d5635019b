// Numbers in the text that the pointer drags: to the right for more; with shift finer. With Alt a drag selects text.
import { syntaxTree } from '@codemirror/language';
import { EditorView } from '@codemirror/view';
import type { EditorState, Extension } from '@codemirror/state';

export interface Literal {
  from: number;
  to: number;
  text: string;
}

/** The number at an offset, with its sign, unless it stands in a comment or string. */
export function number_at(state: EditorState, offset: number): Literal | null {
  const line = state.doc.lineAt(offset);
  for (const match of line.text.matchAll(/(?<![A-Za-z_0-9.])(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?/g)) {
    let from = line.from + match.index;
    const to = from + match[0].length;
    if (offset < from || offset > to) continue;
    if (/comment|string/.test(syntaxTree(state).resolveInner(from, 1).name)) return null;
    // A minus belongs to the number where nothing stands before it that it could be taken from.
    if (/(^|[<(,:=*/])\s*-$/.test(line.text.slice(0, match.index))) --from;
    return { from, to, text: state.sliceDoc(from, to) };
  }
  return null;
}

/** The number that a drag of so many coarse and fine pixels makes of a literal, with the digits that the drag can tell. */
export function dragged_number(text: string, coarse_px: number, fine_px: number): string {
  const value = Number(text), whole = /^-?\d+$/.test(text);
  const decade = value === 0 ? 1 : 10 ** Math.floor(Math.log10(Math.abs(value)));
  const decimals = (/\.(\d*)/.exec(text)?.[1] ?? '').length;
  const per_px = whole ? Math.max(0.2, decade / 50) : decade / 50;
  const moved = value + per_px * (coarse_px + fine_px / 10);
  // As many decimals as the text has, unless a pixel tells fewer apart.
  const coarsest = Math.round(-Math.log10(decade)) + 1;
  const least = whole ? 0 : Math.max(0, coarsest, Math.min(decimals, coarsest + 1));
  const made = moved.toFixed(Math.min(100, fine_px !== 0 ? least + 1 : least));
  if (/e/i.test(text)) return String(Number(made));
  return fine_px !== 0 && whole ? made.replace(/\.0+$/, '') : made.replace(/^-(0(?:\.0*)?)$/, '$1');
}

export function number_drags(): Extension {
  return EditorView.domEventHandlers({
    pointerdown(event, view) {
      if (event.button !== 0 || !event.isPrimary || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return false;
      const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
      const literal = at === null ? null : number_at(view.state, at);
      if (!literal || !over(view, literal, event)) return false;
      drag(view, literal, event);
      return false;
    },
    // The drag decides by its first pixels whether it is one of the number; until then no text is selected.
    mousedown(event, view) {
      if (event.button !== 0 || event.detail > 1 || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return false;
      const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
      const literal = at === null ? null : number_at(view.state, at);
      if (!literal || !over(view, literal, event)) return false;
      event.preventDefault();
      view.focus();
      return true;
    },
    mousemove(event, view) {
      if (event.buttons) return false;
      const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
      const literal = at === null || event.altKey ? null : number_at(view.state, at);
      view.contentDOM.classList.toggle('over-number', literal !== null && over(view, literal, event));
      return false;
    },
  });
}

function over(view: EditorView, { from, to }: Literal, { clientX, clientY }: MouseEvent): boolean {
  const start = view.coordsAtPos(from, 1), end = view.coordsAtPos(to, -1);
  return !!start && !!end && clientX >= start.left - 1 && clientX <= end.right + 1 && clientY >= start.top && clientY <= end.bottom;
}

function drag(view: EditorView, literal: Literal, down: PointerEvent): void {
  let coarse_px = 0, fine_px = 0, last_px = down.clientX, begun = false, { to } = literal;
  let expected = literal.text;
  const move = (event: PointerEvent) => {
    if (event.pointerId !== down.pointerId) return;
    if (!begun && Math.abs(event.clientX - down.clientX) < 4) return;
    if (!begun) document.documentElement.classList.add('dragging-number');
    begun = true;
    if (event.shiftKey) fine_px += event.clientX - last_px;
    else coarse_px += event.clientX - last_px;
    last_px = event.clientX;
    const made = dragged_number(literal.text, coarse_px, fine_px);
    if (made === expected) return;
    // The text may have changed under the drag: then the number is no longer there.
    if (view.state.sliceDoc(literal.from, to) !== expected) return end(event);
    view.dispatch({
      changes: { from: literal.from, to, insert: made },
      selection: { anchor: literal.from, head: literal.from + made.length },
      userEvent: 'drag.number',
    });
    to = literal.from + made.length;
    expected = made;
  };
  const end = (event: PointerEvent) => {
    if (event.pointerId !== down.pointerId) return;
    window.removeEventListener('pointermove', move);
    window.removeEventListener('pointerup', end);
    window.removeEventListener('pointercancel', end);
    document.documentElement.classList.remove('dragging-number');
    if (!begun && event.type === 'pointerup') {
      const at = view.posAtCoords({ x: down.clientX, y: down.clientY });
      if (at !== null) view.dispatch({ selection: { anchor: at } });
    }
  };
  window.addEventListener('pointermove', move);
  window.addEventListener('pointerup', end);
  window.addEventListener('pointercancel', end);
}
