// A session that answers by the protocol of docs/studio.md and is simple enough to be sure of: it reads `let` and `map` lines of a
// .rifs text and plots the set by random points. The page is tested against it, without the program.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import zlib from 'node:zlib';
import { createRequire } from 'node:module';

const tile_px = 256;
const kinds = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css' };

export const example = `# A fern, as Barnsley draws it.
let lean = 2.5
let curl = 0.85
rifs fern {
  map stem  { scale <0.02, 0.16> }
  map frond { scale curl  rotate z, lean  translate <0, 1.6> }
  map left  { scale 0.3  rotate z, 49  translate <0, 1.6>  tint rgb <0.2, 0.6, 0.1> 0.5 }
  map right { scale 0.3  rotate z, -49  translate <0, 0.7> }
  terminal sphere
}
`;

/** Serves `folder` and the session; gives its address and what the page told. With `told.delay_ms`, states are answered so late; with
 * `told.passes` 1, their pictures stay rough; with `told.whole_seconds`, the work ends them sooner, but for the best; with `told.silent`,
 * nothing is varied, and else so many as `told.children`, with `told.later` as soon as `told.vary` is called; with `told.slow`,
 * `told.film` says when a film is done; `told.fit` does so of a fit. After `told.drag_ms` drags are answered, after `told.pick_ms` picks, with `told.point`; null: with nothing.
 * A text that says `fits` is framed anew as the map left moves. */
export async function serve(folder, modules, { name = 'fern.rifs', text = example } = {}, begun = {}) {
  const { WebSocketServer } = createRequire(path.join(modules, 'x'))('ws');
  const server = http.createServer((request, response) => {
    const file = path.basename(new URL(request.url, 'http://x').pathname) || 'index.html', whole = path.join(folder, file);
    if (!fs.existsSync(whole)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': kinds[path.extname(file)] ?? 'text/plain' }).end(fs.readFileSync(whole));
  });
  const told = { states: [], asks: [], tokens: [], ...begun };
  new WebSocketServer({ server, path: '/socket' }).on('connection', (socket, request) => {
    told.tokens.push(new URL(request.url, 'http://x').searchParams.get('token'));
    new MockSession((message) => socket.send(Buffer.isBuffer(message) ? message : JSON.stringify(message)), told, { name, text }).hear_from(socket);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/?token=mock`, told, close: () => server.close() };
}

class MockSession {
  state = null;

  constructor(send, told, opened) {
    this.send = send;
    this.told = told;
    send({
      type: 'hello', version: '0', home: 'program', engines: ['native', 'gpu', 'povray'], formats: ['obj', 'glb', 'svg'], ...opened,
    });
  }

  hear_from(socket) {
    socket.on('message', (bytes) => {
      const message = JSON.parse(bytes);
      if (message.type === 'state') this.hear_state(message);
      else if (message.type === 'ask' && this.told.drag_ms && ['map', 'pull'].includes(message.what)) setTimeout(() => this.hear_ask(message), this.told.drag_ms);
      else if (message.type === 'ask') this.hear_ask(message);
      else this.send({ type: 'fault', text: `There is no message of the type ${message.type}.` });
    });
  }

  hear_state(state) {
    state.text ??= this.state.text;
    this.told.states.push(state);
    this.state = state;
    if (this.told.delay_ms) setTimeout(() => this.answer_state(state), this.told.delay_ms);
    else this.answer_state(state);
  }

  answer_state(state) {
    const { number } = state, findings = findings_of(state);
    this.send({ type: 'findings', number, findings });
    if (findings.some(({ severity }) => severity === 'error')) return;
    const model = model_of(state);
    this.send({ type: 'model', number, ...model });
    setImmediate(() => {
      if (this.state !== state) return;
      const picture = plot(model, state);
      this.tiles(number, 0, state, picture, 4);
      this.send({ type: 'pass', number, pass: 0, samples: 0.0625, seconds_left: 1, noise_255: 9, done: false });
      if (this.told.passes === 1) return;
      this.tiles(number, 1, state, picture, 1);
      const whole_seconds = state.quality === 'best' ? null : this.told.whole_seconds ?? null;
      this.send({ type: 'pass', number, pass: 1, samples: whole_seconds ? 0.25 : 4, seconds_left: null, noise_255: 1, done: true, whole_seconds });
    });
  }

  tiles(number, pass, { width, height }, picture, coarse) {
    for (let y = 0; y < height; y += tile_px) {
      for (let x = 0; x < width; x += tile_px) {
        const w = Math.min(tile_px, width - x), h = Math.min(tile_px, height - y);
        const across = Math.ceil(w / coarse), down = Math.ceil(h / coarse), samples = Buffer.alloc(3 * across * down);
        for (let row = 0; row < down; ++row) {
          for (let at = 0; at < across; ++at) {
            picture.copy(samples, 3 * (row * across + at), 3 * ((y + row * coarse) * width + x + at * coarse), 3 * ((y + row * coarse) * width + x + at * coarse) + 3);
          }
        }
        this.send(binary([0x4c495447, number, pass, x, y, w, h, coarse], samples));
      }
    }
  }

  hear_ask({ id, what, ...fields }) {
    this.told.asks.push({ what, ...fields });
    const { state } = this, answer = (parts) => this.send({ type: 'answer', id, ...parts });
    const maps = maps_of(state);
    switch (what) {
      case 'complete':
        return answer({
          from: fields.offset - /\w*$/.exec(state.text.slice(0, fields.offset))[0].length,
          items: [{ label: 'translate', kind: 'keyword', detail: 'moves what follows', text: 'translate' },
            { label: 'terminal', kind: 'keyword', detail: 'ends the recursion', text: 'terminal' }],
        });
      case 'hover':
        return answer({ from: fields.offset, to: fields.offset + 1, text: '**frond** maps the whole to `0.85` of it.' });
      case 'definition': {
        const found = /let lean/.exec(state.text);
        return answer({ file: state.name, from: found.index + 4, to: found.index + 8 });
      }
      case 'rename':
        return answer({ edits: [...state.text.matchAll(/\blean\b/g)].map((m) => ({ from: m.index, to: m.index + 4, text: fields.name })) });
      case 'format':
        return answer({ edits: [...state.text.matchAll(/map (\w+) +\{/g)].map((m) => ({ from: m.index, to: m.index + m[0].length, text: `map ${m[1]} {` })) });
      case 'pick': {
        const map = maps[1];
        if (this.told.point === null) return answer({});
        const picked = {
          point: this.told.point ?? [0, 5, 0], normal: [0, 0, 1], address: 'frond.left', object: 'fern', from: map.from, to: map.to,
          ...(state.name.endsWith('.lsys') ? { path: ['A_9', 'A_8_2', 'I_1'], part: [0, 1, 2] } : { path: ['frond', 'left'], part: [1, 2] }),
        };
        return void setTimeout(() => answer(picked), this.told.pick_ms ?? 0);
      }
      case 'zoom': {
        const zoom = Number(state.zoom ?? 1) * fields.factor;
        if (Math.abs(zoom - 1) < 1e-9) return answer({ at: null, zoom: null, camera: state.camera });
        return answer({ at: zoom > 2 ? 'frond.frond' : null, zoom: String(Number(zoom.toPrecision(12))), camera: state.camera });
      }
      case 'drag': {
        const found = /\+\(([\d.]+)\)/.exec(state.text), at = found.index + 2;
        const text = String(Math.round(Number(found[1]) + 5 * (fields.to[0] - fields.from[0])));
        const change = { edits: [{ from: at, to: at + found[1].length, text }], number: at, point: fields.to };
        return void setTimeout(() => answer(change), this.told.drag_ms ?? 0); // so late as the test wants it
      }
      case 'map':
      case 'pull': {
        const map = maps.find(({ name }) => name === fields.name) ?? maps[1];
        const matrix = fields.matrix ?? map.matrix.map((value, i) => (i % 4 === 3 ? value + fields.to[(i - 3) / 4] - fields.from[(i - 3) / 4] : value));
        const ratio = Math.max(Math.hypot(matrix[0], matrix[4]), Math.hypot(matrix[1], matrix[5]));
        if (ratio >= 1) return answer({ edits: [], ratio, contracts: false, why: `The map ${map.name} would grow ${ratio.toFixed(2)} times: it must shrink.` });
        const row = matrix.map((value) => String(Number(value.toFixed(4)))).join(', ');
        return answer({ edits: [{ from: map.from, to: map.to, text: `map ${map.name} { matrix ${row} }` }], ratio, contracts: true });
      }
      case 'setting': {
        const found = new RegExp(`^( *${fields.name}:? +)(\\S+)`, 'm').exec(state.text);
        if (found) return answer({ edits: [{ from: found.index + found[1].length, to: found.index + found[0].length, text: String(fields.value) }] });
        if (fields.name === 'seed') return answer({ error: 'This text has no place for a seed.' });
        return answer({ edits: [{ from: state.text.length, to: state.text.length, text: `steps: ${fields.value}\n` }] });
      }
      case 'digraph':
        return answer({ edits: [{ from: state.text.lastIndexOf('}'), to: state.text.lastIndexOf('}'), text: `  follow ${fields.from} -> ${fields.to}\n` }] });
      case 'vary':
        if (this.told.silent) return undefined;
        this.told.vary = () => answer({
          children: Array.from({ length: this.told.children ?? fields.count }, (_, i) => (fields.kind === 'seed'
            ? { seed: 10 * fields.seed + i, says: `seed ${10 * fields.seed + i}` }
            : { set: { lean: 2.5 + (i - 3.5) * 4 * fields.spread * fields.seed }, says: `lean ${(2.5 + (i - 3.5) * 4 * fields.spread * fields.seed).toFixed(2)}` })),
        });
        return this.told.later ? undefined : this.told.vary();
      case 'thumbnail':
        this.tiles(id, 0, fields, plot(model_of(fields), fields), 1);
        return answer({});
      case 'write': {
        if (fields.film) {
          this.told.film = { progress: (stage, share) => this.send({ type: 'progress', number: id, stage, share }), done: () => answer({ path: `film${fields.suffix}` }) };
          return this.told.slow ? undefined : this.told.film.done();
        }
        if (fields.path) return answer({ path: fields.path });
        const name = state.name.replace(/\.\w+$/, fields.suffix), contents = Buffer.from(`${fields.width}x${fields.height}`);
        this.send(binary([0x4c494647, id, Buffer.byteLength(name), 0, 0, 0, 0, 0], Buffer.concat([Buffer.from(name), contents])));
        return answer({});
      }
      case 'fit': // ends when the test says so
        this.told.fit = { progress: (share) => this.send({ type: 'progress', number: id, stage: 'fit', share }), answer };
        return undefined;
      case 'stop':
        return answer({});
      case 'link': // holds and lacks what the test says
        return answer({ name: state.name, files: this.told.files ?? {}, lacks: this.told.lacks ?? [] });
      case 'open':
        if (/^use leaf/m.test(fields.text) && !fields.files?.['leaf.rifs']) return answer({ error: "The link lacks 'leaf.rifs'." });
        return answer({ name: fields.name, files: fields.files ?? {} });
      case 'command':
        return answer({ command: `graftal render ${state.name} --size ${state.width}x${state.height}${Object.entries(state.set).map(([key, value]) => ` --set ${key}=${value}`).join('')}` });
      default:
        return answer({ error: `There is no question ${what}.` });
    }
  }
}

function binary(words, bytes) {
  const head = Buffer.alloc(32);
  words.forEach((word, i) => head.writeUInt32LE(word, 4 * i));
  return Buffer.concat([head, zlib.deflateSync(bytes, { level: 1 })]);
}

function findings_of({ name, text }) {
  const found = /\boops\w*/.exec(text);
  return found ? [{
    severity: 'error', file: name, from: found.index, to: found.index + found[0].length, text: `graftal does not know the word ${found[0]}`,
    hint: 'words that may stand here: map, let, terminal',
  }] : [];
}

function values_of({ text, set }) {
  const values = {};
  for (const [, name, value] of text.matchAll(/^\s*let (\w+) = (\S+)/gm)) values[name] = Number(value);
  return { ...values, ...set };
}

function maps_of(state) {
  const values = values_of(state), number = (word) => values[word] ?? Number(word);
  return [...state.text.matchAll(/map (\w+)\s*\{([^}]*)\}/g)].map((found) => {
    const [whole, name, body] = found;
    let matrix;
    const row = /matrix ([^}]*)/.exec(body);
    if (row) {
      matrix = row[1].split(',').map(Number);
    } else {
      const scale = (/scale (<[^>]*>|\S+)/.exec(body)?.[1] ?? '1').replace(/[<>]/g, '').split(',').map((w) => number(w.trim()));
      const angle = (number(/rotate z, (\S+)/.exec(body)?.[1] ?? '0') * Math.PI) / 180, [sx, sy = scale[0]] = scale;
      const [x = 0, y = 0, z = 0] = (/translate <([^>]*)>/.exec(body)?.[1] ?? '0,0').split(',').map((w) => number(w.trim()));
      matrix = [sx * Math.cos(angle), -sy * Math.sin(angle), 0, x, sx * Math.sin(angle), sy * Math.cos(angle), 0, y, 0, 0, sx, z];
    }
    return {
      name, object: 'fern', matrix, box: box_of(state), contraction: Math.hypot(matrix[1], matrix[5]),
      from: found.index, to: found.index + whole.length, movable: name !== 'stem', why: name === 'stem' ? 'Its scale is one of a table.' : undefined,
    };
  });
}

function digraphs_of({ text }) {
  const followed = [...text.matchAll(/follow (\w+) -> (\w+)/g)].map(([, from, to]) => `${from} ${to}`);
  const maps = [...text.matchAll(/map (\w+)/g)].map(([, name]) => name);
  return [{ block: 'fern', maps, edges: maps.map((from) => maps.map((to) => followed.length === 0 || followed.includes(`${from} ${to}`))) }];
}

const is_solid = ({ text }) => text.includes('solid');
const shift_of = ({ text }) => 3 * (text.includes('fits') ? Number(/map left *{ matrix [^,]*,[^,]*,[^,]*,([^,]*)/.exec(text)?.[1] ?? 0) : 0);
const box_of = (state) => (is_solid(state) ? { least: [-1, -1, -1], most: [1, 1, 1] }
  : { least: [-2.5 + shift_of(state), 0, 0], most: [2.7 + shift_of(state), 10, 0] });

function model_of(state) {
  const parameters = [...state.text.matchAll(/^\s*let (\w+) = (\S+)/gm)].map((found) => {
    const from = found.index + found[0].length - found[2].length;
    return { name: found[1], value: values_of(state)[found[1]], least: null, most: null, literal: true, from, to: from + found[2].length, kind: 'let' };
  });
  return {
    parameters, box: box_of(state),
    camera: state.camera ?? (is_solid(state) ? { location: [2.4, 1.8, 4], look_at: [0, 0, 0], up: [0, 1, 0], angle_deg: 45 }
      : { location: [0.1 + shift_of(state), 5, 17], look_at: [0.1 + shift_of(state), 5, 0], up: [0, 1, 0], angle_deg: 60 }), stats: { steps: 12 }, chance: !state.text.includes('no chance'), grows: !state.text.includes('no growth'), maps: maps_of(state), digraphs: digraphs_of(state),
  };
}

function plot({ maps, camera }, { width, height, zoom, seed, time }) {
  const picture = Buffer.alloc(3 * width * height);
  for (let y = 0; y < height; ++y) {
    picture.fill(Math.round(244 - (22 * y) / height), 3 * y * width, 3 * (y + 1) * width);
  }
  const minus = (a, b) => a.map((v, i) => v - b[i]), dot = (a, b) => a.reduce((s, v, i) => s + v * b[i], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((v) => v / Math.hypot(...a));
  const into = unit(minus(camera.look_at, camera.location)), right = unit(cross(into, camera.up)), up = cross(right, into);
  const focal = (Number(zoom ?? 1) * width) / (2 * Math.tan((camera.angle_deg * Math.PI) / 360));
  let random = 12345 + (seed ?? 1) * 7919, p = [0, 0, 0];
  const weights = maps.map(({ matrix: m }) => Math.max(0.01, Math.abs(m[0] * m[5] - m[1] * m[4]))), total = weights.reduce((a, b) => a + b, 0);
  for (let i = 0; i < 20000 && maps.length; ++i) {
    random = (Math.imul(random, 1664525) + 1013904223) >>> 0;
    let share = (random / 2 ** 32) * total, which = 0;
    while (which < maps.length - 1 && share > weights[which]) share -= weights[which++];
    const m = maps[which].matrix;
    p = [0, 1, 2].map((r) => m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3]);
    const eye = minus(p, camera.location), depth = dot(eye, into);
    const x = Math.round(width / 2 + (focal * dot(eye, right)) / depth), y = Math.round(height / 2 - (focal * dot(eye, up)) / depth);
    if (i < 20 || depth <= 0 || x < 0 || y < 0 || x >= width || y >= height) continue;
    picture.set([30 + 40 * (which % 3) + 10 * (time ?? 0), 110 - 20 * (which % 2), 50], 3 * (y * width + x));
  }
  return picture;
}

if (process.argv[1] === new URL(import.meta.url).pathname) console.log((await serve(process.argv[2], process.argv[3])).address);
