// The page's end of the protocol: numbers states, holds them back while the picture of the last one is under way, and
// pairs asks with answers.
import {
  read_binary, type Answer, type Choices, type Findings, type Hello, type Incoming, type Model, type Pass, type Progress,
  type SentFile, type Tile,
} from './protocol';
import type { Transport } from './transport';

export interface Size {
  width_px: number;
  height_px: number;
}

/** What a picture is asked for with: `film` is the one whose view it has. */
type Shown = Choices & { film: object | null };

export interface Listener {
  /** A state left with this number, for a picture of this size. */
  sent(number: number, size: Size): void;
  hear_hello(message: Hello): void;
  findings(message: Findings): void;
  model_came(message: Model): void;
  progress(message: Progress): void;
  pass(message: Pass): void;
  tile(tile: Tile): void;
  file(file: SentFile): void;
  fault(text: string): void;
  /** Why the session cannot be reached; null: it can. */
  reach(why: string | null): void;
}

/** Ids of asks begin above all numbers of states: tiles of thumbnails carry the one, tiles of the picture the other. */
export const first_id = 2 ** 30;
const least_wait_ms = 150, most_wait_ms = 2000;
/** A picture this good, or begun so long ago, may be left for the next one: a drag shows as fine pictures as it has time for. */
const good_samples = 1 / 16, patience_ms = 40;

export class Session {
  number = 0;
  private next_id = first_id;
  private readonly asked = new Map<number, { resolve: (answer: Answer) => void; reject: (error: Error) => void }>();
  private waiting: { choices: Shown; size: Size } | null = null;
  private sent_text: string | null = null;
  private sent_ms = 0;
  private latency_ms = 50;
  private under_way = false;
  private timer = 0;
  private open = false;

  constructor(private readonly transport: Transport, private readonly listener: Listener) {
    transport.on_open = () => {
      this.open = true;
      this.sent_text = null;
      this.under_way = false;
      listener.reach(null);
      if (this.waiting) this.flush();
    };
    transport.on_close = (why) => {
      this.open = false;
      for (const { reject } of this.asked.values()) reject(new Error(why));
      this.asked.clear();
      listener.reach(why);
    };
    transport.on_message = (message) => {
      if (message instanceof ArrayBuffer) this.hear_binary(message);
      else this.hear(message as Incoming);
    };
  }

  /** Sends the state now, or as soon as the picture of the state before has begun; a later one takes its place. */
  show(choices: Shown, size: Size): void {
    this.waiting = { choices, size };
    const wait_ms = Math.min(most_wait_ms, Math.max(least_wait_ms, 1.5 * this.latency_ms));
    const left_ms = this.under_way ? this.sent_ms + wait_ms - performance.now() : 0;
    clearTimeout(this.timer);
    if (left_ms <= 0) this.flush();
    else this.timer = setTimeout(() => this.flush(), left_ms) as unknown as number;
  }

  /** Requires that something was shown before. The answer is about the state shown last. */
  ask(what: string, fields: object = {}): Promise<Answer> {
    this.flush();
    const id = this.next_id++;
    return new Promise((resolve, reject) => {
      if (!this.open) return reject(new Error('The session cannot be reached.'));
      this.asked.set(id, { resolve, reject });
      this.transport.send({ type: 'ask', id, what, ...fields });
    });
  }

  /** The id that the next ask will have: its tiles and files carry it. */
  get coming_id(): number {
    return this.next_id;
  }

  /** A state waits to be sent: its number will be the next. */
  get holds(): boolean {
    return this.waiting !== null;
  }

  /** The picture of the last state has not yet begun. */
  get busy(): boolean {
    return this.under_way || this.waiting !== null;
  }

  private flush(): void {
    clearTimeout(this.timer);
    if (!this.waiting || !this.open) return;
    const { choices, size } = this.waiting;
    this.waiting = null;
    const { text, keys: _, ...rest } = choices;
    const state: Record<string, unknown> = { type: 'state', number: ++this.number, ...rest };
    if (text !== this.sent_text) state['text'] = text;
    this.sent_text = text;
    state['width'] = size.width_px;
    state['height'] = size.height_px;
    state['threads'] = 0;
    this.sent_ms = performance.now();
    this.under_way = true;
    this.transport.send(state);
    this.listener.sent(this.number, size);
  }

  /** The picture of the last state began, or will not come. */
  private begun(number: number, is_picture: boolean): void {
    if (number !== this.number || !this.under_way) return;
    this.under_way = false;
    if (is_picture) this.latency_ms = performance.now() - this.sent_ms;
    if (this.waiting) this.flush();
  }

  private hear(message: Incoming): void {
    switch (message.type) {
      case 'hello':
        return this.listener.hear_hello(message);
      case 'findings':
        if (message.findings.some(({ severity }) => severity === 'error')) this.begun(message.number, false);
        return this.listener.findings(message);
      case 'model':
        return this.listener.model_came(message);
      case 'progress':
        return this.listener.progress(message);
      case 'pass': {
        const left_ms = this.sent_ms + patience_ms - performance.now();
        if (message.done || (message.samples ?? 0) >= good_samples || left_ms <= 0) this.begun(message.number, true);
        else setTimeout(() => this.begun(message.number, true), left_ms);
        return this.listener.pass(message);
      }
      case 'fault':
        return this.listener.fault(message.text);
      case 'answer': {
        const asked = this.asked.get(message.id);
        this.asked.delete(message.id);
        if (message.error !== undefined) asked?.reject(new Error(message.error));
        else asked?.resolve(message);
      }
    }
  }

  private hear_binary(bytes: ArrayBuffer): void {
    const message = read_binary(bytes);
    if (message?.kind === 'tile') this.listener.tile(message);
    else if (message) this.listener.file(message);
  }
}
