// The messages of docs/studio.md, as types, and the reading of binary messages.

export type Vec3 = [number, number, number];
/** Twelve numbers by rows: parent_from_child. */
export type Matrix = number[];

export interface Camera {
  location: Vec3;
  look_at: Vec3;
  up: Vec3;
  angle_deg?: number;
  /** Parallel rays: how many units the picture is wide. */
  width?: number;
}

/** What the knobs are at a moment of a film. */
export interface KeyFrame {
  seconds: number;
  set: Record<string, number>;
}

/** Everything that a picture depends on, except its size. Undefined and null: as the model says. */
export interface Choices {
  name: string;
  text: string;
  set: Record<string, number>;
  steps: number | null;
  time: number | null;
  seed: number | null;
  camera: Camera | null;
  at: string | null;
  zoom: string | null;
  engine: string | null;
  quality: string | null;
  /** In the order of time. No picture depends on them. */
  keys: KeyFrame[];
  /** Texts of files that came with a link, by their paths. */
  files: Record<string, string> | null;
}

export interface Edit {
  from: number;
  to: number;
  text: string;
}

export interface Finding {
  severity: 'error' | 'warning' | 'note';
  file?: string;
  from: number;
  to: number;
  text: string;
  hint?: string;
}

export interface Parameter {
  name: string;
  value: number;
  least?: number | null;
  most?: number | null;
  literal?: boolean | string | null;
  from?: number;
  to?: number;
  kind: 'let' | 'inner' | 'setting';
}

export interface ModelMap {
  name: string;
  object: string;
  matrix: Matrix;
  box: Box;
  contraction: number;
  from: number;
  to: number;
  movable: boolean;
  why?: string;
}

export interface ControlDigraph {
  block: string;
  maps: string[];
  /** By the map before, then by the map after it. */
  edges: boolean[][];
}

export interface Box {
  least: Vec3;
  most: Vec3;
}

export interface Hello {
  type: 'hello';
  version: string;
  home: 'program' | 'browser';
  engines: string[];
  name: string;
  text: string;
  formats: string[];
}

export interface Findings {
  type: 'findings';
  number: number;
  findings: Finding[];
}

export interface Model {
  type: 'model';
  number: number;
  parameters: Parameter[];
  camera: Camera;
  box: Box | null;
  stats: Record<string, unknown> | string | null;
  /** Whether another seed, and other steps, may change it; undefined: nobody knows. */
  chance?: boolean;
  grows?: boolean;
  maps: ModelMap[];
  digraphs?: ControlDigraph[];
}

export interface Progress {
  type: 'progress';
  number: number;
  stage: 'measure' | 'draw' | 'assemble' | 'fit';
  share: number;
}

export interface Pass {
  type: 'pass';
  number: number;
  pass: number;
  /** Null: another engine draws, and does not say. */
  samples: number | null;
  seconds_left: number | null;
  noise_255: number | null;
  done: boolean;
  /** Of the last pass that the work allowed has ended: what all of it would take. */
  whole_seconds?: number | null;
}

export interface Answer {
  type: 'answer';
  id: number;
  error?: string;
  [field: string]: unknown;
}

export interface Fault {
  type: 'fault';
  text: string;
}

export type Incoming = Hello | Findings | Model | Progress | Pass | Answer | Fault;

export interface Tile {
  kind: 'tile';
  /** Number of the state, or the id of a thumbnail. */
  number: number;
  pass: number;
  x: number;
  y: number;
  width: number;
  height: number;
  /** Pixels a sample, across and down. */
  coarse: number;
  deflated: Uint8Array;
}

export interface SentFile {
  kind: 'file';
  id: number;
  name_bytes: number;
  deflated: Uint8Array;
}

const head_bytes = 32;

export function read_binary(bytes: ArrayBuffer): Tile | SentFile | null {
  if (bytes.byteLength < head_bytes) return null;
  const view = new DataView(bytes);
  const word = (index: number) => view.getUint32(4 * index, true);
  const deflated = new Uint8Array(bytes, head_bytes);
  switch (word(0)) {
    case 0x4c495447:
      return {
        kind: 'tile', number: word(1), pass: word(2), x: word(3), y: word(4), width: word(5), height: word(6),
        coarse: Math.max(1, word(7)), deflated,
      };
    case 0x4c494647:
      return { kind: 'file', id: word(1), name_bytes: word(2), deflated };
    default:
      return null;
  }
}

export async function inflate(deflated: Uint8Array): Promise<Uint8Array> {
  return through(deflated, new DecompressionStream('deflate'));
}

export async function through(bytes: Uint8Array, stream: GenericTransformStream): Promise<Uint8Array> {
  const piped = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array, BufferSource>);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}
