// The worker of the browser's home: a session of WebAssembly (runtime/studio/web). It hears the page's messages between
// pieces of work. Its first message is the compiled module; it says `heard` of each message after that.

interface SessionModule {
  HEAPU8: Uint8Array;
  _malloc(bytes: number): number;
  _free(at: number): void;
  _graftal_hear(at: number, bytes: number): void;
  _graftal_work(budget_seconds: number): number;
}

type Instantiated = (instance: WebAssembly.Instance, module: WebAssembly.Module) => void;
type Post = (is_binary: boolean, bytes: Uint8Array<ArrayBuffer>) => void;

const budget_seconds = 0.02;
const scope = self as unknown as { postMessage(message: unknown, transfer?: Transferable[]): void; onmessage: ((event: MessageEvent) => void) | null };

const post: Post = (is_binary, bytes) => {
  if (is_binary) scope.postMessage(bytes.buffer, [bytes.buffer]);
  else scope.postMessage(JSON.parse(new TextDecoder().decode(bytes)));
};

async function session_of(compiled: WebAssembly.Module): Promise<SessionModule> {
  const { default: create } = await import(new URL('graftal_studio.js', import.meta.url).href);
  return create({
    post,
    instantiateWasm(imports: WebAssembly.Imports, instantiated: Instantiated) {
      void WebAssembly.instantiate(compiled, imports).then((instance) => instantiated(instance, compiled));
      return {};
    },
  });
}

function hear(session: SessionModule, message: unknown): void {
  const bytes = new TextEncoder().encode(JSON.stringify(message));
  const at = session._malloc(bytes.length);
  if (at === 0) throw new Error('there is too little memory for this message');
  session.HEAPU8.set(bytes, at);
  session._graftal_hear(at, bytes.length);
  session._free(at);
}

scope.onmessage = ({ data: compiled }) => {
  // Messages that come while the module starts wait in order.
  let waiting: unknown[] | null = [];
  let session: SessionModule, works = false;
  const next = new MessageChannel();
  const go_on = () => {
    if (works) return;
    works = true;
    next.port2.postMessage(null);
  };
  next.port1.onmessage = () => {
    works = false;
    if (session._graftal_work(budget_seconds)) go_on();
  };
  const take = (message: unknown) => {
    hear(session, message);
    scope.postMessage({ type: 'heard' });
    go_on();
  };
  scope.onmessage = ({ data: message }) => {
    if (waiting) waiting.push(message);
    else take(message);
  };
  session_of(compiled).then((made) => {
    session = made;
    for (const message of waiting!) take(message);
    waiting = null;
    scope.postMessage({ type: 'ready' });
    go_on();
  }, (error) => setTimeout(() => { throw error; }));
};
