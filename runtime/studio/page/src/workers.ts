// The browser's home: sessions in workers of the page. One works; a second one stands by, and takes over where the first
// is in a piece of work that lets it hear nothing.
import type { Transport } from './transport';

/** A state that nobody has heard after so long goes to the other worker. */
const patience_ms = 150;
/** The second worker is made so long after a pass: the first picture needs the processor more. */
const spare_after_ms = 1000;

interface Message {
  type?: string;
  id?: number;
  [field: string]: unknown;
}

/** A worker with a session, and how many messages it has not yet heard. */
class Colleague {
  readonly worker: Worker;
  ready = false;
  deaf = 0;
  on_message: (message: Message | ArrayBuffer) => void = () => {};
  on_end: (why: string) => void = () => {};

  constructor(address: string, compiled: Promise<WebAssembly.Module>) {
    this.worker = new Worker(address, { type: 'module' });
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.on_end(event.message);
    };
    this.worker.onmessage = ({ data }) => {
      if (data.type === 'ready') this.ready = true;
      else if (data.type === 'heard') --this.deaf;
      else this.on_message(data);
    };
    compiled.then((module) => this.worker.postMessage(module), (error: Error) => this.on_end(error.message));
  }

  send(message: Message): void {
    ++this.deaf;
    this.worker.postMessage(message);
  }
}

async function compiled_module(address: URL): Promise<WebAssembly.Module> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`the server has no ${address.pathname}`);
  // Some servers do not know the kind of the file.
  if (response.headers.get('content-type') === 'application/wasm') return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

export class WorkerTransport implements Transport {
  on_message: Transport['on_message'] = () => {};
  on_open: Transport['on_open'] = () => {};
  on_close: Transport['on_close'] = () => {};
  private readonly compiled: Promise<WebAssembly.Module>;
  private working: Colleague;
  private spare: Colleague | null = null;
  private greeted = false;
  /** The last state, with its text. */
  private state: Message | null = null;
  private readonly asks = new Map<number, Message>();
  private timer = 0;
  private spare_timer = 0;
  private failures = 0;

  constructor(private readonly address: string) {
    this.compiled = compiled_module(new URL('graftal_studio.wasm', new URL(address, location.href)));
    this.working = this.employ(this.colleague());
    queueMicrotask(() => this.on_open());
  }

  send(message: Message): void {
    if (message.type === 'state') {
      // With its text: whoever works may be new.
      this.state = { ...message, text: message['text'] ?? this.state?.['text'] };
      this.timer ||= setTimeout(() => this.look_after(), patience_ms);
      this.working.send(this.state);
    } else {
      if (message.type === 'ask') this.asks.set(message.id!, message);
      this.working.send(message);
    }
  }

  private colleague(): Colleague {
    return new Colleague(this.address, this.compiled);
  }

  private employ(colleague: Colleague): Colleague {
    colleague.on_message = (message) => this.hear(message);
    colleague.on_end = (why) => this.ended(why);
    return colleague;
  }

  private hear(message: Message | ArrayBuffer): void {
    if (!(message instanceof ArrayBuffer)) {
      if (message.type === 'hello' && this.greeted) return;
      if (message.type === 'hello') this.greeted = true;
      if (message.type === 'answer') this.asks.delete(message.id!);
      if (message.type === 'pass') {
        this.failures = 0;
        if (!this.spare) this.spare_timer ||= setTimeout(() => this.call_spare(), spare_after_ms);
      }
    }
    this.on_message(message);
  }

  private call_spare(): void {
    this.spare_timer = 0;
    const spare = this.spare ??= this.colleague();
    spare.on_end = () => {
      if (this.spare === spare) this.spare = null;
    };
  }

  /** A state was sent a while ago. */
  private look_after(): void {
    this.timer = 0;
    if (this.working.deaf === 0 || !this.working.ready) return;
    if (this.spare?.ready) return this.replace();
    this.call_spare();
    this.timer = setTimeout(() => this.look_after(), patience_ms / 3);
  }

  /** The spare goes on with the last state, and with the asks that are not answered. */
  private replace(state = this.state): void {
    this.working.worker.terminate();
    this.working = this.employ(this.spare ?? this.colleague());
    this.spare = null;
    if (state) this.working.send(state);
    for (const ask of this.asks.values()) this.working.send(ask);
  }

  private ended(why: string): void {
    if (!this.greeted) return this.on_close(`The session did not start: ${why}. Load the page again, or try another browser.`);
    if (++this.failures < 2) return this.replace();
    // The state itself is what ends workers.
    for (const id of this.asks.keys()) this.on_message({ type: 'answer', id, error: why });
    this.asks.clear();
    this.on_message({ type: 'fault', text: `This model ended its worker: ${why}. Make the model smaller, or undo the change.` });
    this.replace(null);
  }
}
