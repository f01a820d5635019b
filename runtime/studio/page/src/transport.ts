// The two ways to a session: a WebSocket to the program, and messages posted to workers (workers.ts).
import { WorkerTransport } from './workers';

export interface Transport {
  send(message: object): void;
  /** Called with each message: an object, or the bytes of a binary one. */
  on_message: (message: object | ArrayBuffer) => void;
  /** Called when the session can be reached, and when it no longer can. */
  on_open: () => void;
  on_close: (why: string) => void;
}

/** Connects again, after a pause that grows, for as long as the page is open. */
export class SocketTransport implements Transport {
  on_message: Transport['on_message'] = () => {};
  on_open: Transport['on_open'] = () => {};
  on_close: Transport['on_close'] = () => {};
  private socket: WebSocket | null = null;
  private pause_ms = 250;

  constructor(private readonly address: string) {
    this.connect();
  }

  send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  private connect(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.pause_ms = 250;
      this.on_open();
    };
    socket.onmessage = ({ data }) => this.on_message(typeof data === 'string' ? JSON.parse(data) : data);
    socket.onclose = () => {
      this.socket = null;
      this.on_close('The program does not answer. It may have ended: start graftal studio again, or wait.');
      setTimeout(() => this.connect(), this.pause_ms);
      this.pause_ms = Math.min(5000, 2 * this.pause_ms);
    };
    this.socket = socket;
  }
}

/**
 * The home that the page was served from: `<meta name="graftal-worker" content="ADDRESS">` names the worker of the
 * browser's home; without it the program that served the page answers, at the same address, token and all.
 */
export function home_transport(): Transport {
  const worker = document.querySelector<HTMLMetaElement>('meta[name="graftal-worker"]')?.content;
  if (worker) return new WorkerTransport(worker);
  const address = new URL('socket', location.href);
  address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
  address.search = location.search;
  address.hash = '';
  return new SocketTransport(address.href);
}
