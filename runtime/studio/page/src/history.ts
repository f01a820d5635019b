// One history over everything that can be changed: the text, the knobs, the camera and the rest of the choices.
import type { Choices } from './protocol';

const most_entries = 400, most_units = 1_500_000, merge_ms = 1200;

interface Kept {
  entries: Choices[];
  at: number;
}

/**
 * Entries are never changed, and share what did not change. A change with the key of the one before, soon after it or by the
 * same press of the pointer, takes its place: a drag or a typed word is one step. A key that ends in # and a number is of one
 * drag, however late the session answers.
 */
export class History {
  private entries: Choices[];
  private at = 0;
  private key: string | null = null;
  private changed_ms = 0;
  /** The pointer is down. */
  held = false;

  constructor(first: Choices, private readonly storage_key: string, private readonly changed: (why: string) => void) {
    this.entries = [first];
  }

  get now(): Choices {
    return this.entries[this.at]!;
  }

  get can_undo(): boolean {
    return this.at > 0;
  }

  get can_redo(): boolean {
    return this.at + 1 < this.entries.length;
  }

  /** `key` null: a step of its own. `why` says who changed it, for listeners that know already. False, and no step, where nothing changes. */
  change(part: Partial<Choices>, key: string | null = null, why = ''): boolean {
    const is_now = (value: unknown, now: unknown) => value === now || (typeof value === 'object' && JSON.stringify(value) === JSON.stringify(now));
    if (Object.entries(part).every(([name, value]) => is_now(value, this.now[name as keyof Choices]))) return false;
    const next = { ...this.now, ...part };
    const now_ms = performance.now();
    const soon = this.held || /#\d+$/.test(key ?? '') || now_ms - this.changed_ms < merge_ms;
    const merges = key !== null && key === this.key && soon && !this.can_redo && this.at > 0;
    this.entries.length = this.at + 1;
    if (merges) this.entries[this.at] = next;
    else this.entries.push(next);
    let units = 0, kept = 0;
    for (let i = this.entries.length; i-- && kept < most_entries; ++kept) {
      if (this.entries[i]!.text !== this.entries[i + 1]?.text) units += this.entries[i]!.text.length;
      if (units > most_units && kept > 1) break;
    }
    this.entries.splice(0, this.entries.length - kept);
    this.at = this.entries.length - 1;
    this.key = key;
    this.changed_ms = now_ms;
    this.changed(why);
    return true;
  }

  /** The pointer goes down: what it changes until it goes up is one step, however long it takes. */
  hold(): void {
    this.key = null;
    this.held = true;
  }

  /** The pointer goes up. Answers that the session still owes belong to its step. */
  release(): void {
    this.held = false;
    this.changed_ms = performance.now();
  }

  undo(): void {
    this.go(this.at - 1);
  }

  redo(): void {
    this.go(this.at + 1);
  }

  private go(to: number): void {
    if (to < 0 || to >= this.entries.length) return;
    this.at = to;
    this.key = null;
    this.changed('history');
  }

  /** Begins again with a model that was opened. If the page was reloaded, finds what was there before, and gives true. */
  open(first: Choices): boolean {
    const kept = this.load(), again = kept?.entries[0]?.name === first.name;
    if (kept && again) {
      this.entries = kept.entries;
      this.at = kept.at;
      // The file was changed outside since: its text is one more step, and nothing is lost.
      if (!this.entries.some(({ text }) => text === first.text)) this.change({ text: first.text });
    } else {
      this.entries = [first];
      this.at = 0;
    }
    this.key = null;
    this.changed('open');
    return again;
  }

  /** Keeps it over a reload. Texts and files that are equal are kept once. */
  save(): void {
    const texts = [...new Set(this.entries.map(({ text }) => text))];
    const files = [...new Set(this.entries.map((entry) => entry.files))];
    const index = new Map(texts.map((text, i) => [text, i]));
    const entries = this.entries.map((entry) => ({ ...entry, text: index.get(entry.text), files: files.indexOf(entry.files) }));
    try {
      sessionStorage.setItem(this.storage_key, JSON.stringify({ texts, files, entries, at: this.at }));
    } catch {
      // Storage that is full or forbidden: the page works, and forgets.
    }
  }

  private load(): Kept | null {
    try {
      const kept = JSON.parse(sessionStorage.getItem(this.storage_key) ?? 'null');
      const entries = kept.entries.map((entry: Omit<Choices, 'text' | 'files'> & { text: number; files: number }) => (
        { ...entry, keys: entry.keys ?? [], text: kept.texts[entry.text], files: kept.files?.[entry.files] ?? null }));
      return entries.length > 0 && entries[kept.at] ? { entries, at: kept.at } : null;
    } catch {
      return null;
    }
  }
}
