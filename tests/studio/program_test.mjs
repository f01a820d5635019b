// node program_test.mjs MODULES PROGRAM: drives `graftal studio` itself in headless Chromium.
import assert from 'node:assert/strict';
import { spawn, execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { open_browser, tester } from './hands.mjs';

const [modules, program] = process.argv.slice(2).map((name) => path.resolve(name));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'graftal-studio-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));

const fern = `# A fern, as Barnsley draws it.
let lean = 2.5
let curl = 0.85
rifs fern {
  map stem  { scale <0.02, 0.16, 0.02> }
  map frond { scale curl  rotate z, lean  translate <0, 1.6> }
  map left  { scale 0.3  rotate z, 49  translate <0, 1.6>  tint rgb <0.2, 0.6, 0.1> 0.5 }
  map right { scale 0.3  rotate z, -49  translate <0, 0.7> }
}
`;

// A square, which every pixel in its middle shows at every zoom.
const square = `rifs square {
  map a { scale 1/2  translate <-1/2, -1/2>  tint rgb <0.8, 0.1, 0.1> 0.5 }
  map b { scale 1/2  translate <1/2, -1/2>  tint rgb <0.1, 0.5, 0.1> 0.5 }
  map c { scale 1/2  translate <-1/2, 1/2>  tint rgb <0.1, 0.1, 0.8> 0.5 }
  map d { scale 1/2  translate <1/2, 1/2> }
}
`;

/** Sessions run at once: each has a folder of its own. */
async function serve(text = fern) {
  const own = fs.mkdtempSync(path.join(folder, 'session-'));
  fs.writeFileSync(path.join(own, 'model.rifs'), text);
  const child = spawn(program, ['studio', '--no-browser', 'model.rifs'], { cwd: own, stdio: ['ignore', 'pipe', 'inherit'] });
  const address = await new Promise((resolve, reject) => {
    let told = '';
    child.on('exit', (code) => reject(new Error(`graftal studio ended with ${code}`)));
    child.stdout.on('data', (bytes) => {
      told += bytes;
      const found = /http:\S+/.exec(told);
      if (found) resolve(found[0]);
    });
  });
  return { address, own, told: { states: [], asks: [] }, close: () => child.kill('SIGINT') };
}

const browser = await open_browser(modules), test = tester(browser, serve);
// The first picture is enough to begin with: the tests draw drafts.
const small = { width: 820, height: 640, ready: '#picture:not([hidden])' };

test('the text, a knob, the camera; all undone', async (hand, page) => {
  const now = () => page.evaluate(() => window.studio.history.now);
  await page.selectOption('#quality', 'draft');
  await hand.settled();
  const before = await hand.pixels();
  await hand.type_at('curl', ' oops');
  await page.waitForSelector('.cm-lintRange-error');
  assert.match(await page.textContent('#finding'), /^Line 3: /);
  assert.ok(await page.isVisible('#stale'), 'the last good picture stays');
  for (let i = 0; i < 5; ++i) await page.keyboard.press('Backspace');
  await page.waitForSelector('#finding:empty', { state: 'attached' });
  await hand.settled();
  assert.equal(await hand.pixels(), before);
  await hand.changes(async () => hand.drag(await hand.place_of('.knob input[aria-label="lean"]'), 25, 0));
  assert.ok((await now()).set.lean > 2.6);
  await hand.changes(async () => hand.drag(await hand.place_of('#view'), 60, 20));
  assert.notEqual((await now()).camera, null);
  await hand.changes(async () => hand.drag(await hand.place_of_text('0.85'), -20, 0));
  for (let i = 0; i < 9 && (await now()).quality; ++i) await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+Shift+z');
  await hand.settled();
  assert.deepEqual([(await now()).text, (await now()).set, (await now()).camera], [fern, {}, null], 'all but the quality is undone');
  assert.equal(await hand.pixels(), before);
}, small);

test('a click selects the rule; the wheel to 1e30, and back to the same picture', async (hand, page) => {
  const now = () => page.evaluate(() => window.studio.history.now), scale = () => page.evaluate(() => Number(window.studio.history.now.zoom));
  await page.selectOption('#quality', 'draft');
  await hand.settled();
  const before = await hand.pixels(), [x, y] = await hand.place_of('#view');
  await page.mouse.click(x + 3, y + 5);
  await page.waitForSelector('#picked dl');
  await page.focus('.cm-content');
  assert.match(await page.evaluate(() => getSelection().toString()), /^(map )?[abcd]|scale/);
  let turns = 0;
  for (; turns < 60 && !((await scale()) > 1e30); ++turns) {
    await page.mouse.wheel(0, -1200);
    await page.waitForTimeout(50);
  }
  await hand.until(async () => (await scale()) > 1e28, 'the zoom is deep');
  await page.waitForTimeout(300);
  assert.match(await page.textContent('#place'), /whole.*× /);
  await hand.settled();
  assert.notEqual(await hand.pixels(), before);
  for (let i = 0; i < turns; ++i) await page.mouse.wheel(0, 1200);
  await hand.until(async () => (await now()).zoom === null && (await now()).camera === null, 'the whole is back');
  await hand.settled();
  assert.equal(await hand.pixels(), before);
}, { ...small, opened: square });

test('the saved picture is that of the command line; a reload finds all', async (hand, page, { own }) => {
  await page.selectOption('#quality', 'draft');
  await page.locator('.knob input[aria-label="lean"]').press('PageUp');
  await hand.settled();
  await page.click('#tab-out');
  await page.fill('[aria-label="Width in pixels"]', '160');
  await page.fill('[aria-label="Height in pixels"]', '90');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save-picture')]);
  const saved = fs.readFileSync(await download.path());
  const { command } = await page.evaluate(async () => window.studio.session.ask('command'));
  const drawn = path.join(own, 'drawn.png');
  execFileSync('bash', ['-c', `${command.replace(/^graftal/, '"$0"').replace(/--size \S+/, '--size 160x90')} -o "$1"`, program, drawn], { cwd: own, stdio: 'ignore' });
  assert.ok(saved.equals(fs.readFileSync(drawn)), `the picture is that of ${command}`);
  const before = await hand.pixels(), kept = await page.evaluate(() => window.studio.history.now);
  await page.reload();
  await hand.settled();
  assert.deepEqual(await page.evaluate(() => window.studio.history.now), kept);
  assert.equal(await hand.pixels(), before);
}, small);

test('maps that are near a target are fitted to it, and all else of the text stays', async (hand, page) => {
  const numbers = (text) => text.match(/^ {4}-?[\d.].*$/gm).map((row) => row.trim().split(/\s+/).map(Number));
  const png = await page.evaluate(() => {
    // The gasket on 128 by 128 pixels, by the bits of their places.
    const canvas = Object.assign(document.createElement('canvas'), { width: 128, height: 128 }), context = canvas.getContext('2d');
    for (let y = 0; y < 128; ++y) for (let x = 0; x < 128; ++x) if (!(x & y)) context.fillRect(x, 127 - y, 1, 1);
    return canvas.toDataURL();
  });
  await page.click('#tab-maps');
  await page.setInputFiles('#target', { name: 'gasket.png', mimeType: 'image/png', buffer: Buffer.from(png.split(',')[1], 'base64') });
  await page.waitForSelector('#maps-layer > .target');
  const before = await hand.text();
  await page.click('#fit');
  await hand.until(async () => /^Agreement/.test(await page.textContent('#fitted')), 'the fit ends');
  const after = await hand.text(), wanted = [[0.5, 0, 0, 0.5, 0, 0], [0.5, 0, 0, 0.5, 0.5, 0], [0.5, 0, 0, 0.5, 0, 0.5]];
  numbers(after).forEach((row, i) => row.forEach((number, k) => assert.ok(Math.abs(number - wanted[i][k]) < 1 / 128, after)));
  assert.ok(numbers(before).flat().some((number, i) => Math.abs(number - wanted.flat()[i]) > 0.02));
  assert.match(after, /^# off by hand\nrifs off \{/);
  await page.click('#undo');
  await hand.until(async () => (await hand.text()) === before, 'it is one step');
}, {
  ...small, opened: `# off by hand
rifs off {
  codes 2d {
    0.47 0.03 0.01 0.52 0.02 -0.02
    0.5 0.02 -0.03 0.5 0.53 0.01
    0.53 -0.02 0.02 0.48 0.01 0.47
  }
}
` });

await test.done();
