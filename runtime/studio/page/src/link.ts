// A link that holds the model: its choices as JSON, deflated, in the letters of base64url, behind `#m=`.
import type { Choices } from './protocol';
import { through } from './protocol';

const longest_bytes = 8_000_000;

export async function fragment_of(choices: Choices): Promise<string> {
  const held = Object.fromEntries(Object.entries(choices).filter(([key, value]) => value !== null && key !== 'engine'));
  const deflated = await through(new TextEncoder().encode(JSON.stringify(held)), new CompressionStream('deflate-raw'));
  let letters = '';
  for (let at = 0; at < deflated.length; at += 4096) letters += String.fromCharCode(...deflated.subarray(at, at + 4096));
  return '#m=' + btoa(letters).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

/** What a link holds, each field of the kind that it must be; null: it holds no model. */
export async function choices_of(link: string): Promise<Partial<Choices> | null> {
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
  made.name = held['name'].replace(/^.*[\\/]/, '');
  for (const key of ['steps', 'time', 'seed'] as const) if (is_number(held[key])) made[key] = held[key];
  for (const key of ['at', 'zoom', 'quality'] as const) if (typeof held[key] === 'string') made[key] = held[key];
  const { set, camera } = held as { set?: object; camera?: Record<string, unknown> };
  if (set && typeof set === 'object') made.set = numbers_of(set)!;
  if (camera && ['location', 'look_at', 'up'].every((key) => is_vector(camera[key]))) made.camera = camera as unknown as Choices['camera'];
  const keys = held['keys'];
  if (Array.isArray(keys)) made.keys = keys.filter((key) => is_number(key?.seconds) && numbers_of(key.set)).map(({ seconds, set }) => ({ seconds, set: numbers_of(set)! }));
  return made;
}

function numbers_of(held: unknown): Record<string, number> | null {
  if (!held || typeof held !== 'object') return null;
  return Object.fromEntries(Object.entries(held).filter(([, value]) => is_number(value))) as Record<string, number>;
}
