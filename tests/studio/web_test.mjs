// node web_test.mjs MODULES FOLDER PROGRAM: the studio without a program, as tools/studio_web lays it out in FOLDER. Its session,
// run by node, draws what that of `graftal studio` draws, to the byte; its page works in headless Chromium, behind a
// server of files.
import assert from 'node:assert/strict';
import crypto from 'node:crypto';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import zlib from 'node:zlib';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createRequire } from 'node:module';
import { createInterface } from 'node:readline';
import { fileURLToPath, pathToFileURL } from 'node:url';

const [modules, folder, program] = process.argv.slice(2).map((name) => path.resolve(name));
const require = createRequire(path.join(modules, 'x'));
const scenes = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../../scenes');
const scene = (name) => ({ name: path.basename(name), text: fs.readFileSync(path.join(scenes, name), 'utf8') });
let passed = 0, failed = 0;

async function test(name, check) {
  if (process.env.ONLY && !name.includes(process.env.ONLY)) return;
  try {
    await check();
    ++passed;
  } catch (error) {
    ++failed;
    console.error(`FAILED ${name}\n${error.stack}`);
  }
}

/** Paints the tiles of a state and notes, for each pass, a hash of the picture. */
class Painter {
  passes = new Map();
  done = false;

  constructor({ width, height }) {
    this.width = width;
    this.height = height;
    this.picture = Buffer.alloc(3 * width * height);
  }

  hear(message) {
    if (message.type === 'findings') this.done ||= message.findings.some(({ severity }) => severity === 'error');
    assert.notEqual(message.type, 'fault', message.text);
    if (message.type !== 'pass') return;
    const hash = crypto.createHash('sha1').update(this.picture).digest('hex');
    this.passes.set(`${message.samples} samples, error ${message.error_px} px`, hash);
    if (message.done) this.final = hash;
    this.done ||= message.done;
  }

  hear_binary(bytes) {
    const [mark, , , left, top, width, height, block] = Array.from({ length: 8 }, (_, i) => bytes.readUInt32LE(4 * i));
    assert.equal(mark, 0x4c495447);
    const samples = zlib.inflateSync(bytes.subarray(32)), across = Math.ceil(width / block);
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const from = 3 * (Math.floor(y / block) * across + Math.floor(x / block));
        samples.copy(this.picture, 3 * ((top + y) * this.width + left + x), from, from + 3);
      }
    }
  }
}

/** The session as WebAssembly, without its worker. */
class WasmSession {
  number = 0;

  async start() {
    const glue = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'graftal-web-')), 'graftal_studio.mjs');
    fs.copyFileSync(path.join(folder, 'graftal_studio.js'), glue);
    globalThis.self ??= { location: { href: pathToFileURL(glue).href } }; // as in a worker
    const { default: create } = await import(pathToFileURL(glue).href);
    fs.rmSync(path.dirname(glue), { recursive: true });
    this.module = await create({
      wasmBinary: fs.readFileSync(path.join(folder, 'graftal_studio.wasm')),
      post: (is_binary, bytes) => (is_binary ? this.painter.hear_binary(Buffer.from(bytes)) : this.painter.hear(JSON.parse(Buffer.from(bytes)))),
    });
    return this;
  }

  draw(state) {
    this.painter = new Painter(state);
    this.say({ type: 'state', number: ++this.number, ...state });
    while (this.module._graftal_work(0.02)) ;
    return this.painter;
  }

  say(message) {
    const bytes = Buffer.from(JSON.stringify(message)), at = this.module._malloc(bytes.length);
    this.module.HEAPU8.set(bytes, at);
    this.module._graftal_hear(at, bytes.length);
    this.module._free(at);
  }
}

/** The session of the program. */
class ProgramSession {
  number = 0;

  async start() {
    this.process = spawn(program, ['studio', '--no-browser', '-q'], { stdio: ['ignore', 'pipe', 'inherit'] });
    const [line] = await once(createInterface(this.process.stdout), 'line');
    const address = new URL(line.trim());
    const { WebSocket } = require('ws');
    this.socket = new WebSocket(`ws://${address.host}${address.pathname}socket${address.search}`, { origin: address.origin });
    await once(this.socket, 'open');
    return this;
  }

  async draw(state) {
    const painter = new Painter(state);
    this.socket.send(JSON.stringify({ type: 'state', number: ++this.number, ...state }));
    await new Promise((resolve, reject) => {
      this.socket.removeAllListeners('message');
      this.socket.on('message', (bytes, is_binary) => {
        try {
          if (is_binary) painter.hear_binary(bytes);
          else painter.hear(JSON.parse(bytes));
          if (painter.done) resolve();
        } catch (error) {
          reject(error);
        }
      });
    });
    return painter;
  }

  end() {
    this.socket.close();
    this.process.kill('SIGINT');
  }
}

const drawn = ['abop/fig1_25.lsys', 'abop/fig1_24d.lsys', 'hart/elm.inst', 'hart/pound_sign.rifs', 'hart/ternary_tree.inst',
  'ifs/menger_sponge.rifs', 'ifs/fern.rifs', 'ifs/heighway_dragon.rifs', 'papers/five_maps.rifs', 'papers/bipinnate_leaf.lsys'];

await test('both sessions draw the same pictures', async () => {
  const wasm = await new WasmSession().start(), native = await new ProgramSession().start();
  try {
    for (const name of drawn) {
      const state = { ...scene(name), width: 160, height: 90, quality: 'draft' };
      const ours = wasm.draw(state), theirs = await native.draw(state);
      assert.ok(ours.final && theirs.final, `${name} was drawn`);
      assert.equal(ours.final, theirs.final, `${name}: the last pass`);
      // The coarse passes that a session takes are those that it has time for.
      const both = [...ours.passes].filter(([pass]) => theirs.passes.has(pass));
      for (const [pass, hash] of both) assert.equal(hash, theirs.passes.get(pass), `${name}: ${pass}`);
      console.log(`${name}: ${both.length} of ${ours.passes.size} passes compared`);
    }
  } finally {
    native.end();
  }
});

// The page.

const kinds = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };
const asked = [];
const server = http.createServer((request, response) => {
  const file = path.basename(new URL(request.url, 'http://x').pathname) || 'index.html', whole = path.join(folder, file);
  asked.push(file);
  if (!fs.existsSync(whole)) return response.writeHead(404).end();
  response.writeHead(200, { 'content-type': kinds[path.extname(file)] ?? 'text/plain' }).end(fs.readFileSync(whole));
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
const address = `http://127.0.0.1:${server.address().port}/`;
const { chromium } = require('playwright-core');
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu'],
});

/** Opens the page with a cold cache; `check` gets it when its first picture is there. */
async function page_test(name, check, { hash = '', width = 820, height = 420 } = {}) {
  await test(name, async () => {
    const context = await browser.newContext({ viewport: { width, height } });
    const page = await context.newPage(), faults = [];
    page.setDefaultTimeout(30_000);
    page.on('pageerror', (error) => faults.push(error.stack));
    page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
    page.on('request', (request) => !request.url().startsWith(address) && !/^(data|blob):/.test(request.url()) && faults.push(`asked ${request.url()}`));
    try {
      await page.goto(address + hash);
      const first_ms = await (await page.waitForFunction(() => window.studio.latencies_ms.length && performance.now(), null, { polling: 10 })).jsonValue();
      await check(page, first_ms);
      assert.deepEqual(faults, []);
    } catch (error) {
      if (process.env.SHOTS) await page.screenshot({ path: path.join(process.env.SHOTS, `${name.replace(/\W+/g, '_')}.png`) });
      error.stack += `\n${faults.join('\n')}`;
      throw error;
    } finally {
      await context.close();
    }
  });
}

const settled = async (page) => {
  await page.waitForTimeout(60);
  await page.waitForSelector('body[data-picture=done]', { timeout: 120_000 });
};
const pixels = (page) => page.evaluate(() => {
  const canvas = document.getElementById('picture');
  return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.reduce((sum, value, i) => (sum * 31 + value * (i % 97)) % 4294967291, 7);
});
/** Shows a model; milliseconds until its first pixels. */
const first_pixels_ms = async (page, choices) => {
  const count = await page.evaluate((made) => {
    const { length } = window.studio.latencies_ms;
    window.studio.change(made);
    return length;
  }, choices);
  await page.waitForFunction((before) => window.studio.latencies_ms.length > before && !window.studio.session.busy, count, { polling: 10 });
  return page.evaluate(() => window.studio.latencies_ms.at(-1));
};

await page_test('a page without a program: an error, its mending, a slider', async (page, first_ms) => {
  console.log(`the first picture after ${Math.round(first_ms)} ms`);
  assert.equal(await page.evaluate(() => window.studio.hello.home), 'browser');
  await page.evaluate(() => window.studio.change({ quality: 'draft' }));
  await settled(page);
  const before = await pixels(page), text = await page.evaluate(() => window.studio.history.now.text);
  await page.evaluate((now) => window.studio.change({ text: now }), text.replace('terminal sphere', 'terminal sphere oops'));
  await page.waitForSelector('.cm-lintRange-error');
  assert.ok(await page.isVisible('#stale'), 'the page says that it shows the last good picture');
  await page.evaluate((now) => window.studio.change({ text: now }), text);
  await page.waitForSelector('#stale', { state: 'hidden' });
  await settled(page);
  assert.equal(await pixels(page), before);
  const slider = await page.locator('.knob input[aria-label="spread"]').boundingBox();
  await page.mouse.move(slider.x + slider.width / 2, slider.y + slider.height / 2);
  await page.mouse.down();
  await page.mouse.move(slider.x + slider.width / 2 + 20, slider.y + slider.height / 2, { steps: 4 });
  await page.mouse.up();
  await settled(page);
  assert.notEqual(await page.evaluate(() => window.studio.history.now.set.spread), undefined);
  assert.notEqual(await pixels(page), before);
  assert.ok(!asked.includes('socket'), 'no program is asked for');
});

const link_to = (model) => '#m=' + zlib.deflateRawSync(JSON.stringify(model)).toString('base64url');
const has_text = (page, text) => page.waitForFunction((wanted) => window.studio.history.now.text === wanted, text);

const linked = scene('ifs/fern.rifs');
await page_test('a link opens its model', async (page) => {
  await has_text(page, linked.text);
}, { hash: link_to(linked) });

const row = { name: 'plants/row.inst', text: 'use leaf = "leaf.inst"\nobject row { leaf }\n' };
await page_test('a link opens with the files that its model uses', async (page) => {
  await has_text(page, row.text);
  await settled(page);
  assert.doesNotMatch(await page.textContent('#finding'), /cannot open/);
}, { hash: link_to({ ...row, files: { 'plants/leaf.inst': 'object leaf { sphere }\n' } }) });

await page_test('a link that lacks a file says which, and the model on the page stays', async (page) => {
  await page.waitForFunction(() => /lacks 'plants\/leaf\.inst'/.test(document.getElementById('said').textContent));
  assert.notEqual(await page.evaluate(() => window.studio.history.now.text), row.text);
}, { hash: link_to(row) });

// Its lowering is one piece of work, and takes seconds.
const slow = {
  name: 'slow.lsys',
  text: 'lsys slow {\n  angle 25\n  steps 19\n  axiom A(1)\n  A(s) -> F(s)[+A(s*random(0.8, 0.9))][-A(s*0.8)]\n}\n',
};
await page_test('a model that takes long is left for the next one', async (page) => {
  const crystal = await page.evaluate(() => ({ name: window.studio.history.now.name, text: window.studio.history.now.text }));
  await page.waitForTimeout(2000);
  await page.evaluate((made) => window.studio.change(made), slow);
  await page.waitForTimeout(700);
  const ms = await first_pixels_ms(page, { ...crystal, set: { spread: 0.4 } });
  console.log(`a picture ${Math.round(ms)} ms after a state that came while a model took long`);
});

await page_test('first pixels of scenes', async (page) => {
  for (const name of drawn.slice(0, 10).filter((_, i) => i % 2 === 0)) {
    const made = scene(name);
    const ms = [await first_pixels_ms(page, made), await first_pixels_ms(page, { text: made.text + '\n' })];
    console.log(`${name}: first pixels after ${ms.map(Math.round).join(' ms, of an edit after ')} ms`);
  }
});

await browser.close();
server.close();
for (const file of fs.readdirSync(folder)) {
  const bytes = fs.readFileSync(path.join(folder, file));
  console.log(`${file}: ${bytes.length} bytes, ${zlib.gzipSync(bytes, { level: 9 }).length} gzipped`);
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
