// The line between the text and the picture: a drag, or the arrow keys, give one of them more room. It stays over reloads.
import { draggable } from './dom';

const storage_key = 'graftal width of text', least_px = 0, least_picture_px = 200, snap_px = 120, key_px = 40;

export class Divider {
  constructor(private readonly line: HTMLElement, private readonly rooms: HTMLElement) {
    try {
      const kept = Number(localStorage.getItem(storage_key));
      if (kept > 0) this.put(kept);
    } catch {
      // Storage that is forbidden: the width is the usual one.
    }
    draggable(line, () => ({ move: ({ clientX }) => this.put(clientX - rooms.getBoundingClientRect().left) }));
    line.addEventListener('dblclick', () => this.reset());
    line.addEventListener('keydown', (event) => {
      const by: Record<string, number> = { ArrowLeft: -key_px, ArrowRight: key_px };
      const step = by[event.key];
      if (event.key === 'Home') this.reset();
      else if (step === undefined) return;
      else this.put(this.width + step);
      event.preventDefault();
    });
    this.tell();
  }

  private get width(): number {
    return this.line.getBoundingClientRect().left + 5 - this.rooms.getBoundingClientRect().left;
  }

  private put(width_px: number): void {
    const most_px = this.rooms.getBoundingClientRect().width - least_picture_px;
    const width = Math.max(least_px, Math.min(most_px, width_px));
    this.keep(width < snap_px ? (width < this.width ? 0 : snap_px) : width);
  }

  private reset(): void {
    this.rooms.style.removeProperty('--side');
    this.store('');
    this.tell();
  }

  private keep(width_px: number): void {
    this.rooms.style.setProperty('--side', `${Math.round(width_px)}px`);
    this.store(String(Math.round(width_px)));
    this.tell();
  }

  private tell(): void {
    const whole = this.rooms.getBoundingClientRect().width || 1;
    this.line.setAttribute('aria-valuenow', String(Math.round((100 * this.width) / whole)));
  }

  private store(value: string): void {
    try {
      localStorage.setItem(storage_key, value);
    } catch {
      // Storage that is forbidden: the width is the usual one next time.
    }
  }
}
