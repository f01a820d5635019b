// What the parts of the page share.
import type { History } from './history';
import type { Camera, Choices, Edit, Hello, Model } from './protocol';
import type { Session, Size } from './session';

export interface Studio {
  readonly history: History;
  readonly session: Session;
  readonly hello: Hello | null;
  /** Of the last text without errors; null before the first. */
  readonly model: Model | null;
  /** Of the picture, in pixels of the canvas. */
  readonly size: Size;
  /** The camera as it is: the person's, or else the model's. */
  readonly camera: Camera | null;
  /** A hand in the picture changes the model: where the model chooses the view, it chooses no other while the pointer is down,
   * and none after that as long as the model is in view and nothing else changes. */
  hold_view(): void;
  change(part: Partial<Choices>, key?: string | null): void;
  /** Puts edits into the text. */
  edit(edits: Edit[], key?: string | null): void;
  /** Selects a part of the text, and scrolls to it. */
  select(from: number, to: number): void;
  /** Tells the person one thing, for some seconds; `offer` is a button beside it. */
  say(text: string, offer?: Offer): void;
}

export interface Offer {
  label: string;
  act(): void;
}

export function edited(text: string, edits: Edit[]): string {
  const backwards = [...edits].sort((a, b) => b.from - a.from);
  for (const { from, to, text: put } of backwards) text = text.slice(0, from) + put + text.slice(to);
  return text;
}

/** Runs `act` one at a time; a call that comes meanwhile waits, and only the last of them is run. */
export function latest<Value>(act: (value: Value) => Promise<void>): (value: Value) => void {
  let busy = false, next: { value: Value } | null = null;
  const run = async (value: Value) => {
    busy = true;
    try {
      await act(value);
    } finally {
      busy = false;
      if (next) {
        const { value: after } = next;
        next = null;
        void run(after);
      }
    }
  };
  return (value) => {
    if (busy) next = { value };
    else void run(value);
  };
}
