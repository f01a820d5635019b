// Whether a text is that of its file: a mark beside the name says where it is not.
import type { Choices } from './protocol';

type Text = Pick<Choices, 'name' | 'text'>;

const storage_key = 'graftal saved';

export class Saved {
  /** Texts by the names of their files, as they were read or written last. */
  private files: Record<string, string> = {};
  /** The model that the program opened, as it read it. */
  private first: Text | null = null;

  constructor(private readonly mark: HTMLElement) {}

  /** Whether a file has this text; the mark shows it. */
  show({ name, text }: Text): boolean {
    const is_saved = this.files[name] === text;
    this.mark.hidden = is_saved;
    return is_saved;
  }

  /** A program knows its model as it was when it began: after a reload, the page knows what it has written since. */
  opened({ name, text }: Text): void {
    this.first = { name, text };
    this.files = { [name]: text };
    try {
      const kept = JSON.parse(sessionStorage.getItem(storage_key) ?? 'null') as { first: Text; files: Record<string, string> } | null;
      if (kept?.first.name === name && kept.first.text === text) this.files = kept.files;
    } catch {
      // Nothing was kept.
    }
  }

  wrote({ name, text }: Text): void {
    this.files[name] = text;
    try {
      sessionStorage.setItem(storage_key, JSON.stringify({ first: this.first, files: this.files }));
    } catch {
      // Storage that is full or forbidden: the page forgets over a reload.
    }
  }
}
