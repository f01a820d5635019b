// A link that holds the model: its choices as JSON, deflated, in the letters of base64url, behind `#m=`. The texts of the files
// that the model uses go with it, by paths that begin where that of the model begins.
import type { Choices } from './protocol';
import { through } from './protocol';
import type { Session } from './session';

const longest_bytes = 8_000_000;
/** What the files may add to a link, deflated. */
const most_file_bytes = 100_000;

type Files = Record<string, string>;

/** A link to the model that the session was told last, and the files that others need beside it. */
export async function link_of(choices: Choices, session: Pick<Session, 'ask'>): Promise<{ fragment: string; lacks: string[] }> {
  // A session that cannot be reached lets the page give what it has itself.
  const answer = await session.ask('link').catch(() => ({ name: choices.name, files: choices.files ?? {}, lacks: [] }));
  const { name, files: found, lacks: missing } = answer as { name: string; files: Files; lacks: string[] };
  const files = { ...found }, lacks = [...missing];
  const by_length = Object.keys(files).sort((a, b) => files[a]!.length - files[b]!.length);
  while (by_length.length > 0 && (await deflated(files)).length > most_file_bytes) {
    const longest = by_length.pop()!;
    delete files[longest];
    lacks.push(longest);
  }
  return { fragment: await fragment_of({ ...choices, name, files }), lacks };
}

/** What a link shows in this home. Throws an error that says why it shows nothing. */
export async function opened(link: string, session: Pick<Session, 'ask'>): Promise<Partial<Choices>> {
  const choices = await choices_of(link);
  if (!choices) throw new Error('This link holds no model.');
  const { name, files } = await session.ask('open', choices);
  return { ...choices, name: name as string, files: files as Files };
}

async function fragment_of(choices: Choices): Promise<string> {
  const held = Object.fromEntries(Object.entries(choices).filter(([key, value]) => value !== null && key !== 'engine'));
  return '#m=' + base64url(await deflated(held));
}

async function deflated(held: object): Promise<Uint8Array> {
  return through(new TextEncoder().encode(JSON.stringify(held)), new CompressionStream('deflate-raw'));
}

function base64url(deflated: Uint8Array): string {
  let letters = '';
  for (let at = 0; at < deflated.length; at += 4096) letters += String.fromCharCode(...deflated.subarray(at, at + 4096));
  return btoa(letters).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

/** What a link holds, each field of the kind that it must be; null: it holds no model. */
async function choices_of(link: string): Promise<Partial<Choices> | null> {
  const letters = /#m=([A-Za-z0-9_-]+)/.exec(link)?.[1];
  if (!letters) return null;
  try {
    const raw = atob(letters.replace(/-/g, '+').replace(/_/g, '/'));
    const bytes = Uint8Array.from(raw, (letter) => letter.charCodeAt(0));
    return checked(JSON.parse(await inflated_text(bytes)));
  } catch {
    return null;
  }
}

async function inflated_text(bytes: Uint8Array): Promise<string> {
  const reader = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const decoder = new TextDecoder();
  let text = '', count = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return text + decoder.decode();
    count += value.length;
    if (count > longest_bytes) throw new Error('The link holds too much.');
    text += decoder.decode(value, { stream: true });
  }
}

const is_number = (value: unknown): value is number => typeof value === 'number' && Number.isFinite(value);
const is_vector = (value: unknown) => Array.isArray(value) && value.length === 3 && value.every(is_number);

/** Strangers write links: nothing that is not of its kind goes on. */
function checked(held: Record<string, unknown>): Partial<Choices> | null {
  const made: Partial<Choices> = {};
  if (typeof held['text'] !== 'string' || typeof held['name'] !== 'string') return null;
  made.text = held['text'];
  const path = held['name'].replace(/\\/g, '/');
  made.name = leads_out(path) ? path.replace(/^.*\//, '') : path;
  for (const key of ['steps', 'time', 'seed'] as const) if (is_number(held[key])) made[key] = held[key];
  for (const key of ['at', 'zoom', 'quality'] as const) if (typeof held[key] === 'string') made[key] = held[key];
  const { set, camera, files } = held as { set?: object; camera?: Record<string, unknown>; files?: object };
  if (files && typeof files === 'object') made.files = Object.fromEntries(Object.entries(files).filter(([file, text]) => typeof text === 'string' && !leads_out(file)));
  if (set && typeof set === 'object') made.set = numbers_of(set)!;
  if (camera && ['location', 'look_at', 'up'].every((key) => is_vector(camera[key]))) made.camera = camera as unknown as Choices['camera'];
  const keys = held['keys'];
  if (Array.isArray(keys)) made.keys = keys.filter((key) => is_number(key?.seconds) && numbers_of(key.set)).map(({ seconds, set }) => ({ seconds, set: numbers_of(set)! }));
  return made;
}

/** Whether a path begins elsewhere than where the model's begins, or goes up from there. */
function leads_out(path: string): boolean {
  return /^(\/|[A-Za-z]:)/.test(path) || path.split('/').includes('..');
}

function numbers_of(held: unknown): Record<string, number> | null {
  if (!held || typeof held !== 'object') return null;
  return Object.fromEntries(Object.entries(held).filter(([, value]) => is_number(value))) as Record<string, number>;
}
