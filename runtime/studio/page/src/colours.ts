// A swatch before each colour that is written in numbers: it opens the browser's picker, which writes them anew.
import { syntaxTree } from '@codemirror/language';
import type { Extension, Range } from '@codemirror/state';
import { Decoration, EditorView, ViewPlugin, WidgetType, type DecorationSet, type ViewUpdate } from '@codemirror/view';
import { element } from './dom';

const number = String.raw`\s*(\d*\.?\d+(?:[eE][+-]?\d+)?)\s*`;
const written = new RegExp(
  String.raw`\brgb\s*<${number},${number},${number}>|\bhsv\s*\(${number},${number},${number}\)` +
  String.raw`|\b(?:color|tint|ink|background)\s*:?\s*${number},${number},${number}`, 'gd');

type Rgb = [number, number, number];

interface Colour {
  kind: 'linear' | 'screen' | 'hsv';
  /** Where its three numbers stand. */
  spans: [number, number][];
  numbers: Rgb;
}

const encoded = (linear: number) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
const decoded = (screen: number) => (screen <= 0.04045 ? screen / 12.92 : ((screen + 0.055) / 1.055) ** 2.4);

function from_hsv([hue_deg, saturation, value]: Rgb): Rgb {
  const part = (n: number) => {
    const k = (n + hue_deg / 60) % 6;
    return value - value * saturation * Math.max(0, Math.min(k, 4 - k, 1));
  };
  return [part(5), part(3), part(1)];
}

function to_hsv([r, g, b]: Rgb): Rgb {
  const value = Math.max(r, g, b), range = value - Math.min(r, g, b);
  const sixth = range === 0 ? 0 : value === r ? ((g - b) / range + 6) % 6 : value === g ? (b - r) / range + 2 : (r - g) / range + 4;
  return [60 * sixth, value === 0 ? 0 : range / value, value];
}

function screen_of({ kind, numbers }: Colour): string {
  const linear = kind === 'hsv' ? from_hsv(numbers) : numbers;
  const parts = kind === 'screen' ? linear : linear.map(encoded);
  return '#' + parts.map((part) => Math.round(255 * Math.max(0, Math.min(1, part))).toString(16).padStart(2, '0')).join('');
}

function numbers_of(kind: Colour['kind'], screen: string): string[] {
  const parts = [1, 3, 5].map((at) => parseInt(screen.slice(at, at + 2), 16) / 255) as Rgb;
  const linear = (kind === 'screen' ? parts : parts.map(decoded)) as Rgb;
  return (kind === 'hsv' ? to_hsv(linear) : linear).map((part) => String(Number(part.toFixed(part > 2 ? 1 : 3))));
}

class Swatch extends WidgetType {
  constructor(private readonly colour: Colour) {
    super();
  }

  override eq(other: Swatch): boolean {
    return JSON.stringify(other.colour) === JSON.stringify(this.colour);
  }

  override toDOM(view: EditorView): HTMLElement {
    const input = element('input', { type: 'color', class: 'swatch', 'aria-label': 'Colour', value: screen_of(this.colour) });
    input.oninput = () => {
      // The picker stays open while its widget moves: it finds its place in the text anew.
      const at = view.posAtDOM(input), found = colours_in(view, at, view.state.doc.lineAt(at).to)[0];
      if (!found || found.from !== at) return;
      const made = numbers_of(found.colour.kind, input.value);
      view.dispatch({
        changes: found.colour.spans.map(([from, to], i) => ({ from, to, insert: made[i]! })),
        userEvent: 'drag.colour',
      });
    };
    return input;
  }

  override updateDOM(dom: HTMLElement): boolean {
    const input = dom as HTMLInputElement, shown = screen_of(this.colour);
    if (document.activeElement !== input) input.value = shown;
    return true;
  }

  override ignoreEvent(): boolean {
    return true;
  }
}

function colours_in(view: EditorView, from: number, to: number): { from: number; colour: Colour }[] {
  const tree = syntaxTree(view.state), found: { from: number; colour: Colour }[] = [];
  for (const match of view.state.sliceDoc(from, to).matchAll(written)) {
    const at = from + match.index, first = [1, 4, 7].find((group) => match[group] !== undefined)!;
    if (/comment|string/.test(tree.resolveInner(at, 1).name)) continue;
    const groups = [first, first + 1, first + 2];
    found.push({
      from: at,
      colour: {
        kind: first === 4 ? 'hsv' : match[0].startsWith('ink') ? 'screen' : 'linear',
        spans: groups.map((group) => match.indices![group]!.map((index) => from + index) as [number, number]),
        numbers: groups.map((group) => Number(match[group])) as Rgb,
      },
    });
  }
  return found;
}

export function colour_swatches(): Extension {
  const decorate = (view: EditorView): DecorationSet => {
    const ranges: Range<Decoration>[] = view.visibleRanges.flatMap(({ from, to }) =>
      colours_in(view, from, to).map(({ from: at, colour }) => Decoration.widget({ widget: new Swatch(colour), side: -1 }).range(at)));
    return Decoration.set(ranges, true);
  };
  return ViewPlugin.fromClass(
    class {
      decorations: DecorationSet;
      constructor(view: EditorView) {
        this.decorations = decorate(view);
      }
      update(update: ViewUpdate) {
        if (update.docChanged || update.viewportChanged) this.decorations = decorate(update.view);
      }
    },
    { decorations: (plugin) => plugin.decorations },
  );
}
