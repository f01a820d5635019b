// node page_test.mjs MODULES PAGE: drives the page of graftal studio in headless Chromium, against the mock session.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { createRequire } from 'node:module';
import { open_browser, tester } from './hands.mjs';
import { example, serve } from './mock_session.mjs';

const [modules, folder] = process.argv.slice(2).map((name) => path.resolve(name));
for (const needed of [modules, path.join(folder, 'index.html')]) {
  if (fs.existsSync(needed)) continue;
  console.error(`there is no ${needed}: tools/test installs npm's packages, and the target graftal_studio_page makes the page`);
  process.exit(1);
}
const require = createRequire(path.join(modules, 'x'));
const axe = fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const browser = await open_browser(modules), test = tester(browser, (opened, told) => serve(folder, modules, opened, told));

test('an error is underlined, and its mending changes the picture', async (hand, page) => {
  await hand.settled();
  const before = await hand.pixels();
  await hand.type_at('terminal', ' oops');
  await page.waitForSelector('.cm-lintRange-error');
  assert.match(await page.textContent('#finding'), /Line 9: .*does not know the word oops.*words that may stand here/);
  assert.ok(await page.isVisible('#stale'), 'the page says that it shows the last good picture');
  await page.hover('.cm-lintRange-error');
  await page.waitForSelector('.cm-tooltip-lint .hint');
  for (let i = 0; i < 5; ++i) await page.keyboard.press('Backspace');
  await hand.until(async () => !(await page.isVisible('#stale')), 'the picture is good again');
  await hand.settled();
  assert.equal(await hand.pixels(), before);
  await hand.changes(() => hand.type_at('curl', '9'));
  assert.match(hand.last().text, /curl = 0\.859/);
});

const twig = `lsys twig {
  axiom A
  A -> F(1)[+(40)F(1)]F(0.5) # a stem
}
# map a { scale 0.5  translate <0, 0.5> }
# map b { scale 0.5 }
`;

const solid = `rifs solid {
  map a { scale 0.5  translate <-0.5, -0.5, -0.5> }
  map b { scale 0.5  translate <0.5, -0.5, -0.5> }
  map c { scale 0.5  translate <-0.5, 0.5, -0.5> }
  map d { scale 0.5  translate <0.5, 0.5, 0.5> }
}
`;

const leans = (text) => /let lean = (\S+)/.exec(text)[1];
const blank = (page) => page.evaluate(() => {
  const canvas = document.getElementById('picture');
  return canvas.hidden || canvas.width === 2;
});

test('a picture that the work has ended goes on by a button', async (hand, page) => {
  await page.focus('#place .edit');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await hand.until(() => hand.last().quality === 'best', 'the better quality is drawn');
  await hand.settled();
  assert.equal(await page.textContent('#status'), '4 samples a pixel');
  await page.keyboard.press('Control+z');
  await hand.settled();
  assert.equal(await page.textContent('#status'), 'coarse, stopped here: all of it takes 3 min or more Go on at best quality');
}, { told: { whole_seconds: 170 } });

test('the time that is left counts down, and what has no time says what it does', async (hand, page, session) => {
  const told = async (line) => hand.until(async () => (await page.textContent('#status')) === line, `it says: ${line}`);
  await page.evaluate(() => {
    window.lines = [];
    const line = document.querySelector('#status');
    new MutationObserver(() => window.lines.push(line.textContent)).observe(line, { childList: true, characterData: true, subtree: true });
  });
  session.told.passes = 1;
  await hand.knob('lean').press('ArrowRight');
  await told('coarse, still drawing …');
  assert.ok((await page.evaluate(() => window.lines)).includes('coarse, less than 1 s left'));
  session.told.passes = 2;
  session.told.delay_ms = 2000;
  await hand.knob('lean').press('ArrowRight');
  await told('reading the model …');
  await told('4 samples a pixel');
  session.told.delay_ms = 0;
  for (const [pass, line] of [
    [{ samples: 0.25, seconds_left: null, done: false }, 'coarse, a finer picture follows …'],
    [{ samples: 16, seconds_left: null, done: false }, '16 samples a pixel, taking noise out …'],
    [{ samples: null, seconds_left: null, done: false }, 'native is drawing …'],
    [{ samples: null, seconds_left: null, done: true }, 'drawn by native'],
  ]) {
    await page.evaluate((message) => window.studio.pass({ number: window.studio.session.number, ...message }), pass);
    assert.equal(await page.textContent('#status'), line);
  }
});

test('Tab leaves the text, and changes nothing; lines are indented by brackets', async (hand, page) => {
  const before = hand.last().text, is_in_text = () => page.evaluate(() => document.activeElement.closest('.cm-content') !== null);
  await hand.type_at('terminal', '');
  for (const key of ['Tab', 'Shift+Tab']) {
    await page.focus('.cm-content');
    for (let i = 0; i < 3 && (await is_in_text()); ++i) await page.keyboard.press(key);
    assert.equal(await is_in_text(), false, `${key} leaves the text`);
    assert.equal(hand.last().text, before);
  }
  await page.focus('.cm-content');
  await page.keyboard.press('Control+]');
  await hand.until(() => hand.last().text === before.replace('  terminal', '    terminal'), 'the line is indented');
  await page.keyboard.press('Control+[');
  await hand.until(() => hand.last().text === before, 'and back');
});

test('a text that no file has is marked until it is saved, over a reload too', async (hand, page) => {
  const is_marked = () => page.isVisible('#edited');
  assert.equal(await is_marked(), false);
  await hand.type_at('terminal', ' # more');
  assert.ok(await is_marked());
  assert.match(await page.title(), /^• /);
  let steps = 0; // more than one where the keys came slowly
  for (; steps < 10 && (await is_marked()); ++steps) await page.keyboard.press('Control+z');
  assert.equal(await is_marked(), false, 'undone, it is that of the file');
  for (; steps > 0; --steps) await page.keyboard.press('Control+Shift+z');
  await page.keyboard.press('Control+s');
  await hand.until(async () => !(await is_marked()), 'it is saved');
  await page.reload();
  await hand.settled();
  assert.match(hand.last().text, /# more/);
  assert.equal(await is_marked(), false);
  await page.keyboard.press('Control+z');
  await hand.until(is_marked, 'the file has the text of after');
});

test('on a small screen nothing is cut off, squeezed or covered', async (hand, page) => {
  const help = await page.locator('#help').boundingBox();
  assert.deepEqual([help.width, help.height], [30, 30]);
  const view = await page.locator('#view').boundingBox();
  const met = ([x, y]) => page.evaluate(([px, py]) => document.elementFromPoint(px, py).dataset.handle, [x, y]);
  for (const share of [0.35, 0.5, 0.65]) {
    // The mock's point lies in the middle of the picture.
    await page.evaluate((up) => {
      const { studio } = window, { camera } = studio;
      studio.change({ camera: { ...camera, location: [0.1, 5 + up, 17], look_at: [0.1, 5 + up, 0] } });
    }, 18 * (share - 0.5));
    await page.mouse.click(view.x + view.width / 2, view.y + view.height * share);
    await page.waitForSelector('#picked dl');
    const dot = await hand.place_of('.point');
    assert.equal(await met(dot), 'point', `the dot at ${dot} is covered`);
    await page.mouse.move(...dot);
    await page.mouse.down();
    for (let i = 1; i <= 4; ++i) {
      await page.mouse.move(dot[0], dot[1] + i * 30 * Math.sign(0.6 - share));
      assert.equal(await met(await hand.place_of('.point')), 'point', 'the card makes room');
    }
    await page.mouse.up();
    await hand.settled();
    await page.keyboard.press('Control+z');
  }
  await page.click('#tab-vary');
  await page.waitForSelector('#grid canvas');
  assert.equal(await page.evaluate(() => getComputedStyle(document.querySelector('#grid canvas')).objectFit), 'contain');
  await page.click('#help');
  assert.match(await page.innerText('#help-page section >> nth=0'), /^Touch\s+one finger on the picture\s+orbit/, 'fingers find theirs first');
}, { width: 390, height: 844, touch: true });

test('the ring about what has the focus is whole', async (hand, page) => {
  for (const selector of ['#place .crumb', '#place .edit', '#tab-knobs']) {
    await page.focus(selector);
    const cut = await page.evaluate(() => {
      const one = document.activeElement, style = getComputedStyle(one), reach = parseFloat(style.outlineWidth) + parseFloat(style.outlineOffset);
      const [a, b] = [one.getBoundingClientRect(), one.parentElement.getBoundingClientRect()];
      return a.left - reach < b.left || a.right + reach > b.right || a.top - reach < b.top || a.bottom + reach > b.bottom;
    });
    assert.equal(cut, false, selector);
  }
});

test('a wrong text keeps the last good picture, over a reload too', async (hand, page) => {
  await hand.type_at('terminal', ' oops');
  await page.waitForSelector('#stale:visible');
  await page.setViewportSize({ width: 1100, height: 700 });
  await page.waitForTimeout(300);
  assert.equal(await page.innerText('#stale'), 'The last good picture');
  assert.equal(await blank(page), false);
  await page.reload();
  await page.waitForSelector('#stale:visible');
  await hand.until(async () => !(await blank(page)), 'the picture of before is there');
  assert.equal(await page.innerText('#stale'), 'The last good picture');
  const [r, g, b] = await page.evaluate(() => [...document.getElementById('picture').getContext('2d').getImageData(5, 5, 1, 1).data]);
  assert.ok(r > 200 && g > 200 && b > 200, `the paper of the mock is light: ${r} ${g} ${b}`);
});

test('a first text that is wrong says so in place of a picture', async (hand, page) => {
  assert.equal(await page.innerText('#stale'), 'No picture yet: the text has an error.');
  assert.equal(await blank(page), true);
  await hand.type_at('oops', ' }');
  for (let i = 0; i < 6; ++i) await page.keyboard.press('Backspace');
  await hand.until(async () => !(await blank(page)), 'the mended text has a picture');
  assert.equal(await page.isVisible('#stale'), false);
}, { opened: { name: 'wrong.rifs', text: 'rifs wrong {\n  map a { scale 0.5 }\n}\noops' }, ready: '#stale:visible' });

test('a knob stays where the hand left it, however late the answers come', async (hand, page, session) => {
  const share = async () => Number(await hand.knob('lean').evaluate((range) => (range.value - range.min) / (range.max - range.min)));
  const number = () => page.textContent('.knob button.number >> nth=0');
  session.told.delay_ms = 700;
  const [x, y] = await hand.place_of('.knob input[aria-label="lean"]');
  await hand.drag([x, y], 40, 0);
  const left = await share(), value = await number();
  assert.ok(left > 0.6, `${left}`);
  for (let i = 0; i < 20; ++i) {
    await page.waitForTimeout(100);
    assert.ok(Math.abs((await share()) - left) < 1e-9, `it went from ${left} to ${await share()}`);
  }
  await page.click('[aria-label="Write lean into the text"]');
  for (let i = 0; i < 10; ++i) {
    assert.equal(await number(), value, 'what was written shows');
    await page.waitForTimeout(100);
  }
  await page.keyboard.press('Control+z');
  await page.click('[aria-label="Reset lean"]');
  assert.equal(await number(), '2.5', 'the text says so, and no answer is waited for');
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  assert.equal(await number(), '2.5');
  session.told.delay_ms = 0;
  await hand.settled();
  assert.equal(leans(hand.last().text), '2.5');
});

test('a number is written where it stands after an edit that no model knows yet', async (hand, page, session) => {
  const slider = await hand.place_of('.knob input[aria-label="lean"]');
  await hand.drag(slider, 25, 0);
  await hand.settled();
  const { lean } = hand.last().set;
  session.told.delay_ms = 400;
  await page.evaluate(() => window.studio.change({ text: `# One line more.\n${window.studio.history.now.text}` }));
  await page.click('[aria-label="Write lean into the text"]');
  await hand.until(() => !('lean' in hand.last().set), 'the number stands in the text');
  session.told.delay_ms = 0;
  await hand.settled();
  assert.match(hand.last().text, /^# One line more\.\n# A fern/);
  assert.equal(leans(hand.last().text), String(lean));
});

test('a slow hand moves a whole number', async (hand, page) => {
  const [x, y] = await hand.place_of('.knob input[aria-label="Steps"]');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await hand.settled();
  const before = hand.last().steps;
  for (let i = 1; i <= 24; ++i) {
    await page.mouse.move(x + i, y);
    await page.waitForTimeout(20);
  }
  await page.mouse.up();
  await hand.settled();
  assert.ok(hand.last().steps > before, `${before} ${hand.last().steps}`);
});

test('numbers have the digits that the hand can tell', async (hand, page) => {
  const decimals = (number) => (/\.(\d+)$/.exec(String(number))?.[1] ?? '').length;
  const slider = await hand.place_of('.knob input[aria-label="lean"]');
  await hand.drag(slider, 17, 0, { steps: 7 });
  await hand.settled();
  assert.ok(decimals(hand.last().set.lean) <= 2, `${hand.last().set.lean}`);
  await page.click('[aria-label="Write lean into the text"]');
  await hand.settled();
  assert.ok(decimals(leans(hand.last().text)) <= 2, leans(hand.last().text));
  const text = '# A fern, as Barnsley draws it.\nlet lean = 2.500000000000001\nlet tiny = 1.5e-13\nrifs fern {\n  map a { scale 0.5 }\n}\n';
  await page.evaluate((put) => window.studio.change({ text: put }), text);
  await hand.settled();
  await hand.drag(await hand.place_of_text('2.500000000000001'), 30, 0);
  await hand.settled();
  assert.match(leans(hand.last().text), /^[34]\.\d\d?$/);
  await hand.drag(await hand.place_of_text('1.5e-13'), 30, 0);
  await hand.settled();
  assert.match(hand.last().text, /let tiny = [23](\.\d)?\d?e-13\n/);
});

test('a slider: coarse, fine, typed, reset, written', async (hand, page) => {
  const slider = await hand.place_of('.knob input[aria-label="lean"]');
  await hand.changes(() => hand.drag(slider, 20, 0));
  const coarse = hand.last().set.lean;
  assert.ok(coarse > 2.7 && coarse < 5, `${coarse}`);
  await page.keyboard.down('Shift');
  await hand.drag(slider, 20, 0);
  await page.keyboard.up('Shift');
  await hand.settled();
  const fine = hand.last().set.lean;
  assert.ok(fine > coarse && fine - coarse < 0.1, `${coarse} ${fine}`);
  await page.dblclick('.knob button.number >> nth=0');
  await page.keyboard.type('7.25');
  await page.keyboard.press('Enter');
  await hand.settled();
  assert.equal(hand.last().set.lean, 7.25);
  await page.click('[aria-label="Write lean into the text"]');
  await hand.settled();
  assert.match(hand.last().text, /let lean = 7\.25/);
  assert.deepEqual(hand.last().set, {});
  await hand.knob('curl').press('ArrowRight');
  await hand.settled();
  assert.ok(hand.last().set.curl > 0.85);
  await page.click('[aria-label="Reset curl"]');
  await hand.settled();
  assert.deepEqual(hand.last().set, {});
});

test('the text is saved with its knobs, or the page says what it has not', async (hand, page) => {
  await hand.knob('lean').press('PageUp');
  await hand.knob('Steps').press('ArrowRight');
  await page.click('#tab-out');
  assert.match(await page.textContent('#unwritten'), /^The text does not have: lean \d(\.\d+)?, steps 13\./);
  await page.keyboard.press('Control+s');
  await page.waitForSelector('#said button');
  assert.match(await page.textContent('#said'), /^Saved fern\.rifs, without lean \d(\.\d+)?, steps 13: the text does not have that\./);
  const { lean } = hand.last().set;
  await page.click('#said button');
  await hand.until(() => hand.asked('write').length === 2, 'it is saved again');
  await hand.until(async () => (await page.textContent('#said')) === 'Saved fern.rifs.', 'all is in the text');
  assert.equal(leans(hand.last().text), String(lean));
  assert.match(hand.last().text, /\nsteps: 13\n$/);
  assert.deepEqual([hand.last().set, hand.last().steps], [{}, null]);
  await hand.until(async () => !(await page.isVisible('#unwritten')), 'nothing is left to write');
  await page.keyboard.press('Control+z');
  await hand.until(() => hand.last().steps === 13 && 'lean' in hand.last().set, 'it was one step');
});

test('a seed is typed, thrown and written; a text without a place for it says so', async (hand, page) => {
  const seed = page.locator('[aria-label="Seed"]'), write = '[aria-label="Write seed into the text"]';
  await seed.fill('718492');
  await seed.press('Enter');
  await hand.until(() => hand.last().seed === 718492, 'it is typed');
  await page.click('[aria-label="Throw another seed"]');
  await hand.until(() => hand.last().seed !== 718492, 'it is thrown');
  assert.equal(await seed.inputValue(), String(hand.last().seed));
  await seed.fill('1.5');
  await seed.press('Enter');
  assert.equal(await seed.inputValue(), String(hand.last().seed), 'a seed is a whole number');
  await page.click(write);
  await hand.until(async () => (await page.textContent('#said')) === 'This text has no place for a seed.', 'it says so');
  await page.evaluate((text) => window.studio.change({ text }), 'rifs fern {\n  seed 7\n  map a { scale 0.5 }\n}\n');
  await hand.settled();
  const thrown = hand.last().seed;
  await page.click(write);
  await hand.until(() => hand.last().seed === null, 'the text has it');
  assert.match(hand.last().text, new RegExp(`\\n  seed ${thrown}\\n`));
  assert.equal(await page.textContent('#said'), 'Written in line 2.');
  await page.evaluate(() => window.studio.change({ text: `# no chance\n${window.studio.history.now.text}` }));
  await hand.settled();
  assert.deepEqual([await seed.isVisible(), await hand.knob('Steps').isVisible()], [false, true], 'a model without chance has no seed to choose');
  await page.evaluate(() => window.studio.change({ text: `# no growth\n${window.studio.history.now.text}` }));
  await hand.settled();
  assert.equal(await page.isVisible('text=Growth and chance'), false);
});

test('numbers and colours in the text are dragged and picked', async (hand, page) => {
  const number = await hand.place_of_text('2.5');
  await hand.changes(() => hand.drag(number, 30, 0));
  const [, value] = /let lean = (\S+)/.exec(hand.last().text);
  assert.ok(Number(value) > 3 && Number(value) < 4.5, value);
  await hand.drag(await hand.place_of_text(value), 31, 0, { shift: true });
  await hand.settled();
  const fine = Number(/let lean = (\S+)/.exec(hand.last().text)[1]);
  assert.ok(fine > Number(value) && fine < Number(value) + 0.2, `${value} ${fine}`);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await hand.settled();
  assert.match(hand.last().text, /let lean = 2\.5\n/);
  await page.locator('.swatch').evaluate((input) => {
    input.value = '#ff0000';
    input.dispatchEvent(new Event('input'));
  });
  await hand.settled();
  assert.match(hand.last().text, /tint rgb <1, 0, 0> 0\.5/);
});

test('completion, hover, definition, rename, format', async (hand, page) => {
  await hand.type_at('curl', '\ntr');
  await page.waitForSelector('.cm-tooltip-autocomplete');
  await page.waitForTimeout(150);
  await page.keyboard.press('Enter');
  await hand.until(async () => /\ntranslate|\n +translate/.test(await hand.text()), 'the word is completed');
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  const word = await hand.place_of_text('frond');
  await page.mouse.move(...word);
  await page.waitForSelector('.hover strong');
  await page.mouse.move(5, 5);
  await page.mouse.click(...word);
  await page.keyboard.press('F12');
  await page.waitForTimeout(100);
  assert.equal(await page.evaluate(() => getSelection().toString()), 'lean');
  await page.keyboard.press('F2');
  await page.keyboard.type('bend');
  await page.keyboard.press('Enter');
  await hand.until(async () => /let bend[^]*rotate z, bend/.test(await hand.text()), 'both are renamed');
  await page.keyboard.press('Shift+Alt+F');
  await hand.until(async () => /map stem \{/.test(await hand.text()), 'the text is formatted');
});

test('a flat model is panned by a plain drag, and orbited with Shift', async (hand, page) => {
  const [x, y] = await hand.place_of('#view');
  const sight = () => hand.last().camera.look_at.map((v, i) => Math.round(100 * (v - hand.last().camera.location[i])));
  await hand.changes(() => hand.drag([x, y], 60, 80));
  assert.deepEqual(sight(), [0, 0, -1700]);
  assert.ok(hand.last().camera.look_at[0] < -0.5 && hand.last().camera.look_at[1] > 5.5, 'the fern follows the hand');
  assert.match(await page.textContent('#view-keys'), /^Arrow keys pan, with Shift they orbit\./);
  await page.focus('#view');
  await hand.changes(() => page.keyboard.press('ArrowDown'));
  assert.deepEqual(sight(), [0, 0, -1700]);
  await page.keyboard.press('Shift+ArrowLeft');
  await hand.settled();
  assert.ok(Math.abs(sight()[0]) > 100, `${sight()}`);
});

test('orbit, pan, dolly; by mouse and by keys; undo them all', async (hand, page) => {
  const before = await hand.pixels(), [x, y] = await hand.place_of('#view');
  await hand.changes(() => hand.drag([x, y], 80, 30));
  const orbited = hand.last().camera;
  assert.notEqual(orbited.location[0], 2.4);
  assert.deepEqual(orbited.look_at, [0, 0, 0]);
  assert.ok(Math.abs(Math.hypot(...orbited.location) - 5) < 1e-3);
  for (const number of orbited.location) assert.ok(String(number).length <= 7, `${number} has more digits than one can see`);
  await hand.changes(() => hand.drag([x, y], 50, 0, { shift: true }));
  await page.focus('#view');
  await hand.changes(() => page.keyboard.press('PageUp'));
  await hand.changes(() => page.keyboard.press('ArrowLeft'));
  await hand.changes(() => page.keyboard.press('Shift+ArrowDown'));
  while (!(await page.isDisabled('#undo'))) await page.keyboard.press('Control+z');
  await hand.settled();
  assert.equal(hand.last().camera, null);
  assert.equal(await hand.pixels(), before);
  assert.ok(await page.isDisabled('#undo'));
}, { opened: { name: 'solid.rifs', text: solid } });

test('near by, one turns about the surface in the middle', async (hand, page, session) => {
  const [x, y] = await hand.place_of('#view'), picks = () => hand.asked('pick').length;
  const near = (camera, wanted) => wanted.forEach((number, i) => assert.ok(Math.abs(camera[i] - number) < 2e-3, `${camera} is not ${wanted}`));
  await hand.changes(() => hand.drag([x, y], 50, 0));
  assert.deepEqual([picks(), hand.last().camera.look_at], [0, [0, 0, 0]], 'the whole turns about its middle');
  const before = { location: [0, 0, 2], look_at: [0, 0, 0], up: [0, 1, 0], angle_deg: 45 };
  await page.evaluate((camera) => window.studio.change({ camera }), before);
  await hand.settled();
  Object.assign(session.told, { point: [0.3, 0, 1], pick_ms: 200 });
  await hand.changes(() => hand.drag([x, y], 100, 0));
  near(hand.last().camera.look_at, [0, 0, 1]);
  near(hand.last().camera.location, [-Math.sin(0.8), 0, 1 + Math.cos(0.8)]);
  assert.equal(picks(), 1, 'a drag looks once');
  await page.keyboard.press('Control+z');
  await hand.settled();
  assert.deepEqual(hand.last().camera, before, 'a late answer is of the same step');
  await page.focus('#view');
  await hand.changes(async () => {
    for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowLeft');
  });
  await hand.until(() => Math.abs(hand.last().camera.location[0] - Math.sin(0.4)) < 2e-3, 'no turn is lost');
  assert.equal(picks(), 2);
  await page.keyboard.press('0');
  await page.evaluate((camera) => window.studio.change({ camera }), before);
  await hand.settled();
  session.told.point = null;
  await hand.changes(() => hand.drag([x, y], 100, 0));
  near(hand.last().camera.location, [-2 * Math.sin(0.8), 0, 2 * Math.cos(0.8)]);
  assert.deepEqual([picks(), hand.last().camera.look_at], [3, [0, 0, 0]], 'nothing is there: the old pivot');
}, { opened: { name: 'solid.rifs', text: solid } });

test('the wheel zooms without an end, and back', async (hand, page) => {
  const before = await hand.pixels(), [x, y] = await hand.place_of('#view');
  await page.mouse.move(x, y);
  await hand.changes(async () => {
    for (let i = 0; i < 30; ++i) await page.mouse.wheel(0, -1000);
  });
  await hand.until(() => Number(hand.last().zoom) > 1e18, 'the zoom is deep');
  assert.match(await page.textContent('#place'), /whole.*frond.*frond.*× /);
  await page.click('#place .edit');
  await page.fill('#place [name=at]', '(frond.left)*2.frond*13');
  await page.keyboard.press('Enter');
  await hand.settled();
  assert.deepEqual(await page.locator('#place .crumb:not(.edit)').allTextContents(), ['whole', '(frond.left)*2', 'frond*13']);
  await page.click('#place .edit');
  await page.fill('#place [name=at]', 'left');
  await page.fill('#place [name=zoom]', '1e30');
  await page.keyboard.press('Enter');
  await hand.settled();
  assert.equal(hand.last().at, 'left');
  assert.equal(hand.last().zoom, '1e30');
  await page.click('#place .crumb >> nth=0');
  await hand.settled();
  assert.equal(hand.last().zoom, null);
  assert.equal(await hand.pixels(), before);
});

test('a map is dragged by its corner; a map that would grow is red', async (hand, page) => {
  await page.click('#tab-maps');
  await page.focus('[data-map=left]');
  const corner = await hand.place_of('.corner >> nth=1');
  await hand.changes(() => hand.drag(corner, 20, 12));
  assert.match(hand.last().text, /map left { matrix /);
  assert.match(hand.last().text, /# A fern/);
  const [, row] = /map left { matrix ([^}]*)/.exec(hand.last().text);
  const [a, , , , b] = row.split(',').map(Number);
  assert.ok(Math.hypot(a, b) > 0.3 && Math.hypot(a, b) < 0.5, row);
  const turn = await hand.place_of('.turn');
  await hand.drag(turn, 30, 10);
  const edge = await hand.place_of('.handle.edge');
  await hand.drag(edge, 10, 5);
  await hand.settled();
  const good = hand.last().text;
  const far = await hand.place_of('.corner >> nth=3'), near = await hand.place_of('.corner >> nth=0');
  await page.mouse.move(...far);
  await page.mouse.down();
  await page.mouse.move(far[0] + 3 * (far[0] - near[0]), far[1] + 3 * (far[1] - near[1]), { steps: 3 });
  await page.waitForSelector('.map.bad');
  assert.match(await page.textContent('#said'), /would grow/);
  assert.match(await page.textContent('.maps .bad:has([data-listed=left])'), /would grow/);
  await page.mouse.up();
  assert.equal(await page.locator('.map.bad').count(), 0);
  await hand.settled();
  assert.ok(hand.last().text.length > 10 && !/NaN/.test(hand.last().text) && good.includes('matrix'));
  await page.focus('[data-map=right]');
  await hand.changes(() => page.keyboard.press('ArrowUp'));
  assert.match(hand.last().text, /map right { matrix /);
  await page.click('[data-edge="left right"]');
  await hand.settled();
  assert.match(hand.last().text, /follow left -> right/);
  // The drawn digraph has that one arrow; a drag from a map to another adds one.
  await page.waitForFunction(() => document.querySelectorAll('[data-arrow]').length === 1);
  await page.locator('.drawn').scrollIntoViewIfNeeded();
  const [from, to] = [await hand.place_of('[data-node=right]'), await hand.place_of('[data-node=frond]')];
  await hand.drag(from, to[0] - from[0], to[1] - from[1]);
  await hand.settled();
  assert.match(hand.last().text, /follow right -> frond/);
  await page.waitForSelector('[data-arrow="right frond"]', { state: 'attached' });
});

test('a click on a box selects its map, a second one the part; handles stay in reach', async (hand, page) => {
  await page.click('#tab-maps');
  const [x, y] = await hand.place_of('#view');
  await page.mouse.click(x, y);
  await page.waitForTimeout(500);
  assert.deepEqual([hand.asked('pick').length, await page.isVisible('#picked')], [0, false], 'one click does one thing');
  assert.ok(await page.locator('.map.chosen').count() === 1);
  await page.mouse.dblclick(x, y);
  await page.waitForSelector('#picked dl');
  assert.equal(hand.asked('pick').length, 1);
  await page.focus('[data-map=frond]');
  for (const [dx, dy] of [[0, -0.8], [0, 1.6], [0.8, -0.8], [-1.6, 0]]) {
    const view = await page.locator('#view').boundingBox();
    await page.evaluate(([right, up]) => {
      const { studio } = window, { camera } = studio;
      studio.change({ camera: { ...camera, location: [0.1 + 8 * right, 5 + 8 * up, 17], look_at: [0.1 + 8 * right, 5 + 8 * up, 0] } });
    }, [-dx, dy]);
    await hand.settled();
    const handles = page.locator('.handle');
    for (let i = 0; i < await handles.count(); ++i) {
      const one = await handles.nth(i).boundingBox(), cx = one.x + one.width / 2, cy = one.y + one.height / 2;
      assert.ok(cx > view.x && cx < view.x + view.width && cy > view.y && cy < view.y + view.height, `handle ${i} lies at ${cx} ${cy}`);
      const met = await page.evaluate(([px, py]) => document.elementFromPoint(px, py).closest('#maps-layer') !== null, [cx, cy]);
      assert.ok(met, `something covers handle ${i} at ${cx} ${cy}`);
    }
    const turn = await page.locator('.handle.turn').boundingBox();
    assert.equal(await page.evaluate(([px, py]) => document.elementFromPoint(px, py).dataset.handle, [turn.x + turn.width / 2, turn.y + turn.height / 2]), 'turn');
  }
});

test('a box in space is moved, turned and sheared', async (hand, page) => {
  const matrix = (name) => new RegExp(`map ${name} { matrix ([^}]*)}`).exec(hand.last().text)[1].split(',').map(Number);
  await page.click('#tab-maps');
  await page.focus('[data-map=d]');
  assert.equal(await page.locator('.handle.corner').count(), 8);
  assert.equal(await page.locator('.handle.edge').count(), 6);
  const face = await page.locator('[data-map=d] .face').boundingBox();
  await hand.changes(() => hand.drag([face.x + face.width * 0.3, face.y + face.height * 0.5], 30, -20));
  const moved = matrix('d');
  assert.deepEqual([moved[0], moved[5], moved[10]], [0.5, 0.5, 0.5]);
  assert.ok(moved[3] > 0.5 && moved[7] > 0.5, `${moved}`);
  await hand.changes(async () => hand.drag(await hand.place_of('.handle.turn'), 30, 5));
  const turned = matrix('d'), column = (m, c) => Math.hypot(m[c], m[4 + c], m[8 + c]);
  for (const c of [0, 1, 2]) assert.ok(Math.abs(column(turned, c) - 0.5) < 1e-3, `${turned}`);
  assert.ok(Math.abs(turned[1]) > 0.02);
  await hand.changes(async () => hand.drag(await hand.place_of('.handle.edge >> nth=3'), 12, 4));
  const sheared = matrix('d');
  for (const c of [0, 2]) assert.ok(Math.abs(column(sheared, c) - 0.5) < 2e-3, `${sheared}`);
  assert.ok(Math.hypot(...[1, 5, 9].map((i) => sheared[i] - turned[i])) > 0.01, `${turned} ${sheared}`);
}, { opened: { name: 'solid.rifs', text: solid } });

const lever = (page) => page.evaluate(() => {
  const box = (selector) => document.querySelector(selector).getBoundingClientRect(), [a, b] = [box('.pivot'), box('.turn')];
  return Math.hypot(a.x + a.width / 2 - b.x - b.width / 2, a.y + a.height / 2 - b.y - b.height / 2);
});

test('the view and the knob stand still under a hand that turns a map', async (hand, page) => {
  await page.click('#tab-maps');
  for (const name of ['frond', 'left', 'right']) {
    await page.focus(`[data-map=${name}]`);
    assert.ok((await lever(page)) >= 79.9, `${name} is turned by ${await lever(page)} px`);
  }
  await page.focus('[data-map=left]');
  const near = async (x, y) => {
    const [at_x, at_y] = await hand.place_of('.turn');
    assert.ok(Math.hypot(at_x - x, at_y - y) < 1.5, `the knob lies at ${at_x} ${at_y}, the hand at ${x} ${y}`);
  };
  const [x, y] = await hand.place_of('.turn'), whole = await page.evaluate(() => window.studio.model.camera);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 6; ++i) {
    await page.mouse.move(x + 3 * i, y - 4 * i);
    await hand.settled();
    assert.deepEqual(hand.last().camera, whole, 'the view is the one of before');
    await near(x + 3 * i, y - 4 * i);
  }
  await page.mouse.up();
  await hand.settled();
  assert.deepEqual(hand.last().camera, whole, 'all is in view: it stays');
  // The model leaves the view with this map.
  const face = await page.locator('[data-map=left] .face').boundingBox(), from = [face.x + face.width / 2, face.y + face.height / 2];
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(from[0] + 150, from[1], { steps: 5 });
  await hand.settled();
  assert.deepEqual(hand.last().camera, whole);
  await page.mouse.up();
  await hand.until(() => hand.last().camera === null, 'it is framed anew');
  await hand.settled();
  await page.focus('[data-map=left]');
  await page.keyboard.press('ArrowLeft');
  await hand.until(() => hand.last().camera !== null, 'keys keep the view');
  await hand.knob('lean').evaluate(() => window.studio.change({ set: { lean: 3 } }));
  await hand.until(() => hand.last().camera === null, 'another change lets the model choose');
}, { opened: { name: 'fern.rifs', text: example.replace('# A fern', '# It fits: a fern') } });

test('maps are fitted to a picture: it stands behind the boxes, and one step of the history has the answer', async (hand, page, session) => {
  const said = () => page.textContent('#fitted'), bar = page.locator('#panel-maps progress');
  // Six pixels by four: a column that is dark, and a lone pixel.
  const png = Buffer.from((await page.evaluate(() => {
    const canvas = Object.assign(document.createElement('canvas'), { width: 6, height: 4 }), context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, 6, 4);
    context.fillStyle = '#333';
    context.fillRect(1, 0, 1, 4);
    context.fillRect(4, 3, 1, 1);
    return canvas.toDataURL();
  })).split(',')[1], 'base64');
  const choose = (name, mimeType, buffer) => page.setInputFiles('#target', { name, mimeType, buffer });
  await page.click('#tab-maps');
  await page.click('#fit');
  assert.match(await said(), /Choose a picture first/);
  await choose('x.png', 'image/png', Buffer.from('no picture'));
  await hand.until(async () => /x\.png is no picture/.test(await page.textContent('#said')), 'it is no picture');
  await choose('wide.svg', 'image/svg+xml', Buffer.from('<svg xmlns="http://www.w3.org/2000/svg" width="20000" height="9"/>'));
  await hand.until(async () => /20000x9 pixels/.test(await page.textContent('#said')), 'it is too wide');
  assert.equal(await page.locator('.target').count(), 0);
  await choose('t.png', 'image/png', png);
  await page.waitForSelector('#maps-layer > .target:first-child');
  // One unit wide from the origin: the map left moves its foot by 1.6, so lengths compare.
  const box = await page.locator('.target').boundingBox(), unit_px = await page.evaluate(() => {
    const { camera, size } = window.studio, bounds = document.getElementById('maps-layer').getBoundingClientRect();
    const far = Math.hypot(...camera.location.map((value, i) => value - camera.look_at[i]));
    return bounds.width / size.width_px * (camera.width ? size.width_px / camera.width : size.width_px / (2 * far * Math.tan(camera.angle_deg * Math.PI / 360)));
  });
  assert.ok(Math.abs(box.width - unit_px) < 1 && Math.abs(box.height - unit_px * 4 / 6) < 1, `${JSON.stringify(box)} ${unit_px}`);
  const before = hand.last().text, at = before.indexOf('0.3  rotate');
  await page.click('#fit');
  await hand.until(() => session.told.fit, 'the fit is asked for');
  assert.deepEqual(hand.asked('fit')[0].target, { width: 6, height: 4, cell: 1, runs: [1, 1, 5, 1, 5, 1, 5, 1, 2, 1, 1] });
  session.told.fit.progress(0.4);
  await hand.until(async () => (await bar.getAttribute('value')) === '0.4', 'the bar goes on');
  await page.click('#stop-fit');
  await hand.until(() => hand.asked('stop').length === 1, 'the stop is asked for');
  assert.ok(hand.asked('stop')[0].number >= 2 ** 30);
  const answer = { before: 0.61, iou: 0.9, iou_within_a_cell: 0.998, chamfer_cells: 0.02 };
  session.told.fit.answer({ ...answer, edits: [{ from: at, to: at + 3, text: '0.28' }, { from: before.indexOf('0.16'), to: before.indexOf('0.16') + 4, text: '0.17' }] });
  await hand.until(async () => /^Agreement 0\.998 within one cell, 0\.610 before; IoU 0\.900, Chamfer distance 0\.02/.test(await said()), 'the agreement is told');
  await hand.settled();
  assert.equal(hand.last().text, before.replace('0.3  rotate', '0.28  rotate').replace('0.16', '0.17'));
  await page.click('#undo');
  await hand.until(() => hand.last().text === before, 'it is one step');
  // What it refuses is told; an answer about another text changes nothing.
  await page.click('#fit');
  await hand.until(() => hand.asked('fit').length === 2, 'it is asked again');
  session.told.fit.answer({ error: 'The model does not meet the target.' });
  await hand.until(async () => /does not meet/.test(await said()), 'the reason is told');
  await page.click('#fit');
  await hand.until(() => hand.asked('fit').length === 3, 'it is asked once more');
  await hand.type_at('# A fern', ' changed');
  session.told.fit.answer({ ...answer, edits: [{ from: 0, to: 9, text: '' }] });
  await hand.until(async () => /changed meanwhile/.test(await said()), 'it is about another text');
  assert.match(await hand.text(), /^# A fern.* changed/);
  // A picture that is dropped is a target, and no model.
  await page.click('#tab-knobs');
  await page.evaluate((bytes) => {
    const files = new DataTransfer();
    files.items.add(new File([new Uint8Array(bytes)], 'dropped.png', { type: 'image/png' }));
    dispatchEvent(new DragEvent('drop', { dataTransfer: files, cancelable: true }));
  }, [...png]);
  await hand.until(async () => (await page.textContent('#target-name')) === 'dropped.png', 'it is the target');
});

test('a map is chosen in the list by Enter, and moved by arrow keys', async (hand, page) => {
  await page.click('#tab-maps');
  await page.focus('[data-listed=right]');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  await hand.changes(() => page.keyboard.press('ArrowUp'));
  assert.equal(await page.evaluate(() => document.activeElement.dataset.listed), 'right');
  const [, row] = /map right { matrix ([^}]*)/.exec(hand.last().text);
  assert.ok(Number(row.split(',')[7]) > 0.7, row);
  assert.equal(await page.getAttribute('[data-listed=right]', 'aria-current'), 'true');
  await page.focus('[data-listed=stem]');
  await page.keyboard.press('Enter');
  await page.keyboard.press('ArrowUp');
  await hand.until(async () => (await page.textContent('#said')) === 'Its scale is one of a table.', 'it says why it stays');
});

test('a click on a box gives it the arrow keys', async (hand, page) => {
  await page.click('#tab-maps');
  await hand.settled();
  const { x, y, width, height } = await page.locator('[data-map=right] [data-handle=move]').first().boundingBox();
  await page.mouse.click(x + width / 2, y + height / 2);
  const chosen = await page.getAttribute('.map.chosen[data-map]', 'data-map');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.map), chosen);
  await hand.changes(() => page.keyboard.press('ArrowUp'));
  assert.equal(await page.getAttribute('#tab-maps', 'aria-selected'), 'true');
});

test('what changes nothing is no step, and keeps what was undone', async (hand, page) => {
  await page.evaluate(() => window.studio.change({ set: { lean: 3 } }));
  await hand.settled();
  await page.click('#undo');
  await hand.settled();
  await page.click('#whole');
  await page.evaluate(() => window.studio.change({ set: {} }));
  assert.ok(await page.isDisabled('#undo'));
  assert.ok(!(await page.isDisabled('#redo')));
  await page.evaluate(() => {
    window.studio.hold_view();
    window.studio.change({ set: { lean: 2 } }, 'map left');
  });
  await hand.until(() => hand.last().camera !== null, 'the view is held');
  await page.click('#whole');
  await hand.until(() => hand.last().camera === null, 'the model chooses it again');
});

test('a map is turned about its foot, or about its middle; the stem stays on the box', async (hand, page) => {
  const matrix = (name) => new RegExp(`map ${name} { matrix ([^}]*)}`).exec(hand.last().text)[1].split(',').map(Number);
  const gap = () => page.evaluate(() => {
    const [x, y] = document.querySelector('.stem').getAttribute('d').slice(1).split('L')[0].split(' ').map(Number);
    const edges = [...document.querySelector('.map.chosen .edges').getAttribute('d').matchAll(/M(\S+) (\S+)L(\S+) (\S+?)(?=M|$)/g)];
    const far = edges.map(([, ...numbers]) => {
      const [ax, ay, bx, by] = numbers.map(Number), ex = bx - ax, ey = by - ay;
      const share = Math.max(0, Math.min(1, ((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey || 1)));
      return Math.hypot(ax + share * ex - x, ay + share * ey - y);
    });
    return Math.min(...far);
  });
  await page.click('#tab-maps');
  await page.focus('[data-map=frond]');
  assert.equal(await page.locator('circle.handle').count(), 1, 'one handle is round');
  await hand.changes(async () => hand.drag(await hand.place_of('.handle.turn'), 25, 10));
  const turned = matrix('frond');
  assert.ok(Math.abs(turned[3]) < 1e-3 && Math.abs(turned[7] - 1.6) < 1e-3, `the foot stays: ${turned}`);
  assert.ok(turned[1] > 0.02, `${turned}`);
  assert.ok((await gap()) < 0.5, 'the stem stands on the box');
  await page.focus('[data-map=left]');
  for (let i = 0; i < 4; ++i) {
    await page.keyboard.press('Shift+ArrowRight');
    await hand.settled();
    assert.ok((await gap()) < 0.5, `the stem stands on the box at turn ${i}`);
  }
  const before = matrix('left'), middle = (m) => [0.1 * m[0] + 5 * m[1] + m[3], 0.1 * m[4] + 5 * m[5] + m[7]];
  assert.ok(Math.hypot(before[3], before[7] - 1.6) < 0.01, `keys turn about the foot: ${before}`);
  await page.keyboard.down('Alt');
  await hand.drag(await hand.place_of('.handle.turn'), 12, 12);
  await page.keyboard.up('Alt');
  await hand.settled();
  const [a, b] = [middle(before), middle(matrix('left'))];
  assert.ok(Math.hypot(a[0] - b[0], a[1] - b[1]) < 0.01 && Math.hypot(matrix('left')[3], matrix('left')[7] - 1.6) > 0.05, `${a} ${b}`);
});

test('what was picked goes when it is no longer true', async (hand, page) => {
  const [x, y] = await hand.place_of('#view'), pick = async () => {
    await page.mouse.click(x + 5, y - 40);
    await page.waitForSelector('#picked dl');
  };
  await pick();
  await page.mouse.move(x, y + 60);
  await hand.changes(() => hand.drag([x, y + 60], 40, 0));
  assert.ok(await page.isVisible('#picked') && await page.locator('.point').count() === 1, 'another view shows the same');
  await page.keyboard.press('Control+z');
  await hand.changes(async () => hand.drag(await hand.place_of('.point'), 15, 10));
  assert.ok(await page.isVisible('#picked'), 'its own drag keeps it');
  await page.keyboard.press('Control+z');
  await hand.settled();
  assert.deepEqual([await page.isVisible('#picked'), await page.locator('.point').count()], [false, 0], 'undone, the point is elsewhere');
  await pick();
  await hand.type_at('terminal', ' oops');
  assert.equal(await page.isVisible('#picked'), false);
  await page.keyboard.press('Control+z');
  await hand.settled();
  await pick();
  await hand.knob('lean').press('PageUp');
  assert.equal(await page.isVisible('#picked'), false);
});

test('an error brings the last sharp picture back', async (hand, page, session) => {
  await page.evaluate(() => { // Passes are told before they are painted.
    const soon = requestAnimationFrame;
    window.requestAnimationFrame = (act) => setTimeout(() => soon(act), 300);
  });
  await hand.changes(() => hand.type_at('curl', '4'));
  const sharp = await hand.pixels();
  session.told.passes = 1;
  await hand.type_at('curl', '1');
  await hand.until(async () => (await hand.pixels()) !== sharp, 'a rough picture of another model shows');
  await hand.type_at('terminal', ' oops');
  await page.waitForSelector('#stale:visible');
  await hand.until(async () => (await hand.pixels()) === sharp, 'the sharp one is back');
});

test('a click on the picture selects its rule; the point is pulled', async (hand, page) => {
  const [x, y] = await hand.place_of('#view');
  await page.mouse.click(x + 5, y - 40);
  await page.waitForSelector('#picked dl');
  assert.match(await page.textContent('#picked'), /frond\.left/);
  await hand.until(async () => (await page.locator('.cm-selectionLayer > *').count()) > 0, 'the selection shows without the focus');
  await page.focus('.cm-content');
  assert.match(await page.evaluate(() => getSelection().toString()), /^map frond/);
  await hand.changes(async () => hand.drag(await hand.place_of('.point'), 15, 10));
  assert.match(hand.last().text, /map frond { matrix /);
});

test('a drag is one step of the history, however late it is answered', async (hand, page, session) => {
  const [x, y] = await hand.place_of('#view');
  await page.mouse.click(x + 5, y - 40);
  await page.waitForSelector('#picked dl');
  session.told.drag_ms = 1500;
  const drag = async (place, what) => {
    await hand.drag(place, 15, 10);
    await hand.until(() => hand.asked(what).length === 2, 'the last place is asked for, too');
    await hand.settled();
    assert.notEqual(hand.last().text, example);
    await page.keyboard.press('Control+z');
    await hand.settled();
    assert.equal(hand.last().text, example);
  };
  await drag(await hand.place_of('.point'), 'pull');
  await page.click('#tab-maps');
  await page.focus('[data-map=left]');
  await drag(await hand.place_of('.corner >> nth=1'), 'map');
});

test('the grid of variations, and back', async (hand, page, session) => {
  await page.click('#tab-vary');
  await page.waitForSelector('#grid button:nth-child(9)');
  await hand.until(() => hand.asked('thumbnail').length === 9, 'nine pictures are asked for');
  assert.match(await page.textContent('#grid button:nth-child(1)'), /lean -1/);
  await hand.until(async () => (await page.locator('#grid .waits').count()) === 0, 'all are drawn');
  const drawn = (cell) => page.evaluate((selector) => document.querySelector(selector).toDataURL(), `#grid ${cell} canvas`);
  const first = await drawn('button:nth-child(1)');
  session.told.silent = true;
  await page.click('#grid button:nth-child(1)');
  await page.waitForTimeout(100);
  assert.ok(await drawn('.centre') === first, 'the clicked one is the middle before any answer');
  assert.equal(await page.locator('#grid .waits').count(), 8);
  assert.equal(hand.last().set.lean, -1);
  session.told.silent = false;
  await page.click('#vary-again');
  await hand.until(async () => (await page.locator('#grid .waits').count()) === 0, 'the grid is made anew');
  const asked = hand.asked('thumbnail').length, says = await page.textContent('#grid');
  await page.click('#tab-knobs');
  await page.click('#tab-vary');
  await page.waitForTimeout(200);
  assert.deepEqual([hand.asked('thumbnail').length, await page.textContent('#grid')], [asked, says], 'it is as it was');
  await page.selectOption('#vary-kind', 'seed');
  await hand.until(() => hand.asked('vary').at(-1).kind === 'seed', 'seeds are varied');
  assert.ok(await page.isDisabled('#vary-spread'));
  assert.equal(await page.textContent('#vary-why:visible'), 'Seeds are not near or far.');
  await hand.until(async () => (await page.locator('#grid .waits').count()) === 0, 'seeds are drawn');
  const vary_asked = hand.asked('vary').length;
  await page.click('#vary-back');
  assert.deepEqual([await page.textContent('#grid'), await page.inputValue('#vary-kind')], [says, 'parameters']);
  assert.ok(!(await page.isDisabled('#vary-spread')));
  await page.click('#vary-back');
  await hand.settled();
  assert.deepEqual(hand.last().set, {}, 'the model of before is the middle again');
  assert.ok(await drawn('button:nth-child(1)[aria-current=true]') === first, 'the eight are there, the chosen one marked');
  assert.equal(await page.locator('#grid .waits').count(), 0);
  assert.equal(hand.asked('vary').length, vary_asked, 'nothing is looked for again');
  assert.equal(await page.isVisible('#vary-back'), false, 'there was nothing before');
  await page.click('#grid button:nth-child(3)');
  await hand.until(() => hand.last().set.lean === 1, 'another is chosen');
  await hand.until(async () => (await page.locator('#grid .waits').count()) === 0, 'others come around it');
  await page.keyboard.press('Control+z');
  assert.ok(await drawn('button:nth-child(1)') === first, 'undo brings them back, too');
  assert.equal(await page.locator('#grid [aria-current]').count(), 1);
});

test('who leaves the grid before its answer finds it later', async (hand, page, session) => {
  session.told.later = true;
  await page.click('#tab-vary');
  await hand.until(() => session.told.vary, 'variations are asked for');
  await page.click('#tab-knobs');
  session.told.vary();
  await hand.drag(await hand.place_of('#view'), 20, 0);
  await hand.settled();
  session.told.later = false;
  await page.click('#tab-vary');
  await hand.until(async () => (await page.locator('#grid button:not(.waits)').count()) === 9, 'all are drawn');
});

test('the middle is the model, however many others there are', async (hand, page, session) => {
  for (const [count, rows] of [[1, 1], [2, 1], [3, 3], [5, 3]]) {
    session.told.children = count;
    await page.click('#tab-vary');
    await hand.until(async () => (await page.locator('#grid button').count()) === count + 1, `there are ${count} others`);
    const grid = await page.locator('#grid').boundingBox(), middle = await page.locator('#grid .centre').boundingBox();
    assert.ok(Math.abs(middle.x + middle.width / 2 - grid.x - grid.width / 2) < 3 && Math.abs(middle.y + middle.height / 2 - grid.y - grid.height / 2) < 3);
    assert.ok(Math.abs(middle.height - grid.height / rows) < 4, `${middle.height} of ${grid.height}`);
    await page.click('#tab-knobs');
    await hand.knob('lean').press('ArrowRight');
  }
});

test('time plays, and stops', async (hand, page) => {
  await page.click('#tab-time');
  await page.fill('#time-seconds', '1');
  await page.click('#play');
  await hand.until(async () => /Nothing moves yet/.test(await page.textContent('#said')), 'it says why it does not play');
  await page.check('#time-runs');
  await page.click('#play');
  await hand.until(() => hand.last().time > 3, 'time goes on');
  await hand.until(async () => (await page.textContent('#play')) === 'Play', 'it ends');
  assert.equal(hand.last().time, 10);
  const { film } = hand.last();
  assert.deepEqual(film, { frames: 25, fps: 25, steps: [0, 10], set: {} }, 'the session frames all moments together, as the film does');
  await page.click('#save-film');
  await hand.until(() => hand.asked('write').length === 1, 'the film is asked for');
  assert.deepEqual(hand.asked('write')[0].film, film);
  await hand.settled();
  const { camera } = await page.evaluate(() => window.studio.model);
  for (const tab of ['knobs', 'out', 'maps']) {
    await page.click(`#tab-${tab}`);
    await hand.until(() => hand.last().film === null, 'the view is given');
    assert.deepEqual(hand.last().camera, camera, 'another tab shows the same view');
  }
  await page.click('#tab-time');
  await hand.until(() => hand.last().film !== null && hand.last().camera === null, 'the film frames again');
  await page.click('#undo');
  await hand.settled();
  assert.deepEqual([hand.last().time, hand.last().film], [null, null]);
});

test('the second that shows is the one that is seen', async (hand, page) => {
  const second = () => page.textContent('#panel-time .knob .number');
  await page.click('#tab-time');
  await hand.settled();
  assert.equal(await second(), '5', 'the whole plant is the end of its growth');
  assert.deepEqual([hand.last().time, hand.last().film], [null, null], 'nothing moved');
  await page.click('#play');
  await hand.until(() => hand.last().time > 2, 'it grows');
  await page.click('#play');
  assert.match(await second(), /^\d(\.\d\d?)?$/);
  await page.click('#undo');
  assert.equal(await second(), '5');
  await page.evaluate(() => window.studio.change({ time: 3.25 }));
  assert.equal(await second(), '1.25', 'from 1 to 10 in 5 seconds');
}, { opened: { name: 'twig.lsys', text: twig } });

test('a film tells what is done until its file is there', async (hand, page, session) => {
  session.told.slow = true;
  await page.click('#tab-time');
  await page.click('#save-film');
  await hand.until(() => session.told.film, 'the film is asked for');
  session.told.film.progress('draw', 0.5);
  const doing = () => page.textContent('#panel-time [role=status]'), bar = page.locator('#panel-time progress');
  await hand.until(async () => (await doing()) === 'Drawing: 62 of 125 pictures are there', 'pictures are counted');
  assert.equal(await bar.getAttribute('value'), '0.5');
  session.told.film.progress('draw', 0.996);
  await hand.until(async () => (await doing()) === 'Drawing: 124 of 125 pictures are there', 'the bar goes on near its end');
  assert.equal(await bar.getAttribute('value'), '0.996');
  session.told.film.progress('assemble', 0.4);
  await hand.until(async () => (await doing()) === 'All 125 pictures are drawn. Writing fern.gif …', 'it writes the file');
  assert.equal(await bar.getAttribute('value'), '0.4', 'that has a bar of its own');
  session.told.film.done();
  await hand.until(async () => !(await bar.isVisible()), 'it is there');
  assert.match(await page.textContent('#said'), /^Saved film\.gif/);
});

test('key frames of knobs are kept, shown, played and removed; the film has them', async (hand, page) => {
  const keys = () => page.locator('.keys li').allTextContents(), moment = page.locator('[aria-label="Moment"]');
  await page.click('#tab-time');
  await page.click('#add-key');
  await moment.press('End');
  await page.click('#tab-knobs');
  await hand.knob('lean').press('PageUp');
  await page.click('#tab-time');
  await page.click('#add-key');
  const lean = hand.last().set.lean;
  assert.deepEqual(await keys(), ['0 slean 2.5×', `5 slean ${lean}×`]);
  await moment.evaluate((input) => {
    input.value = '2.5';
    input.dispatchEvent(new Event('input'));
  });
  await hand.until(() => Math.abs(hand.last().set.lean - (2.5 + lean) / 2) < 1e-6, 'the knob is half way');
  await page.click('.keys li:nth-child(1) .link');
  await hand.until(() => hand.last().set.lean === 2.5, 'the first key frame shows');
  await page.click('#save-film');
  await hand.until(() => hand.asked('write').length === 1, 'the film is asked for');
  const { film, width, height, suffix } = hand.asked('write')[0];
  assert.deepEqual(film, { frames: 125, fps: 25, steps: null, set: { lean: [[0, 2.5], [1, lean]] } });
  assert.deepEqual([width, height % 2, suffix], [640, 0, '.gif']);
  await hand.until(async () => /-o fern\.gif$/.test(await page.textContent('[aria-label="Command line of the film"]')), 'the command shows');
  await page.click('[aria-label="Remove the key frame at 5 seconds"]');
  assert.equal((await keys()).length, 1);
  await page.click('#undo');
  assert.equal((await keys()).length, 2, 'key frames are undone as all else');
  await page.reload();
  await hand.settled();
  await page.click('#tab-time');
  assert.equal((await keys()).length, 2, 'and outlive a reload');
});

test('a part of an L-system is dragged: the number that follows is one step of the history', async (hand, page) => {
  const [x, y] = await hand.place_of('#view');
  await page.mouse.click(x + 5, y - 40);
  await page.waitForSelector('#picked dl');
  assert.match(await page.textContent('#picked'), /RulesA × 2 → I/);
  await hand.drag(await hand.place_of('.point.pulls'), 40, 10, { steps: 8 });
  await hand.until(() => /\+\(4[1-9]\)/.test(hand.last().text), 'the number follows');
  const asks = hand.asked('drag');
  assert.equal(asks[0].number, null);
  assert.ok(asks.slice(1).every(({ number }) => number === twig.indexOf('40)')), 'a drag keeps its number');
  await hand.until(async () => {
    const [, last] = /\+\((\d+)\)/.exec(hand.last().text);
    return (await page.textContent('#said')) === `line 3: 40 became ${last}`;
  }, 'it names the value before the drag as the old one');
  await page.keyboard.press('Control+z');
  await hand.settled();
  assert.equal(hand.last().text, twig);
}, { opened: { name: 'twig.lsys', text: twig } });

const link_to = (model) => '#m=' + zlib.deflateRawSync(JSON.stringify(model)).toString('base64url');

test('a link holds files and opens with them; one that lacks a file changes nothing', async (hand, page, session) => {
  const files = { 'leaf.rifs': 'rifs leaf { }' };
  session.told.files = files;
  session.told.lacks = ['bark.png'];
  await page.click('#link');
  await hand.until(async () => /cannot hold bark\.png/.test(await page.textContent('#said')), 'it says what it cannot hold');
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const before = hand.last(), text = `# use leaf\n${before.text}`;
  const open = async (pasted) => {
    await page.click('#tab-out');
    await page.fill('#pasted', pasted);
    await page.press('#pasted', 'Enter');
  };
  await open(link_to({ name: 'plants/x.rifs', text: text.slice(2) }));
  await hand.until(async () => /lacks 'leaf\.rifs'/.test(await page.textContent('#said')), 'it says what the link lacks');
  assert.equal(hand.last().name, before.name, 'the model on the page stays');
  assert.ok(await page.isDisabled('#undo'), 'nothing changed');
  await open(link);
  await hand.until(() => hand.last().files?.['leaf.rifs'], 'the files go to the session');
  assert.deepEqual(hand.last().files, files);
  await page.reload();
  await hand.settled();
  assert.deepEqual(hand.last().files, files, 'they outlive a reload');
  await open(link_to({ name: '../../etc/x.rifs', text, files: { '/etc/passwd': '', '../y': '', z: 1, 'a/b': 'c' } }));
  await hand.until(() => hand.last().name === 'x.rifs', 'a stranger names no folder above');
  assert.deepEqual(hand.last().files, { 'a/b': 'c' });
});

test('a reload finds everything; a link holds the model', async (hand, page, session) => {
  await hand.knob('lean').press('PageUp');
  await hand.type_at('# A fern', ' Really.');
  await page.fill('.presets input', 'leaning');
  await page.click('.presets form button');
  await hand.settled();
  const before = hand.last();
  assert.match(before.text, /draws it\. Really\./);
  await page.reload();
  await hand.settled();
  assert.deepEqual({ ...hand.last(), number: 0 }, { ...before, number: 0 });
  await page.waitForSelector('.presets .link');
  await page.click('#link');
  await page.waitForTimeout(200);
  const link = await page.evaluate(() => navigator.clipboard.readText());
  assert.doesNotMatch(link, /mock/, 'the secret of the address stays here');
  while (!(await page.isDisabled('#undo'))) await page.click('#undo');
  await hand.settled();
  assert.doesNotMatch(hand.last().text, /Really/);
  assert.deepEqual(hand.last().set, {});
  await page.goto(session.address + link.slice(link.indexOf('#')));
  await hand.until(() => /Really/.test(hand.last().text), 'the link is read');
  assert.deepEqual(hand.last().set, before.set);
  await page.evaluate(() => { location.hash = '#m=AAAA'; });
  await hand.until(async () => /no model/.test(await page.textContent('#said')), 'a bad link is told');
});

test('fingers: one pans a flat model, two pan and zoom, a tap picks', async (hand, page) => {
  const [x, y] = await hand.place_of('#view'), client = await page.context().newCDPSession(page);
  const touch = (type, ...points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  await touch('touchStart', [x, y]);
  for (let i = 1; i <= 5; ++i) await touch('touchMove', [x + 10 * i, y]);
  await touch('touchEnd');
  await hand.settled();
  assert.ok(Math.abs(hand.last().camera.location[0] - 0.1) > 1);
  await touch('touchStart', [x - 40, y], [x + 40, y]);
  for (let i = 1; i <= 5; ++i) await touch('touchMove', [x - 40 - 8 * i, y], [x + 40 + 8 * i, y]);
  await touch('touchEnd');
  await hand.settled();
  await hand.until(() => Math.abs(Number(hand.last().zoom) - 2) < 0.1, 'two fingers enlarge twice');
  const sum = (asks, part) => asks.reduce((all, ask) => all + ask[part], 0), apart = hand.asked('zoom').length;
  assert.ok(Math.abs(sum(hand.asked('zoom'), 'dx')) < 1e-6, 'they went apart');
  await touch('touchStart', [x - 40, y], [x + 40, y]);
  for (let i = 1; i <= 5; ++i) await touch('touchMove', [x - 40 + 6 * i, y + 8 * i], [x + 40 + 6 * i, y + 8 * i]);
  await touch('touchEnd');
  await hand.settled();
  const pans = hand.asked('zoom').slice(apart), px = hand.last().width / (await page.locator('#view').boundingBox()).width;
  assert.ok(Math.abs(sum(pans, 'dx') - 30 * px) < 1e-6 && Math.abs(sum(pans, 'dy') - 40 * px) < 1e-6, JSON.stringify(pans));
  for (const { factor } of pans) assert.ok(Math.abs(factor - 1) < 1e-9, `${factor}: both fingers are one step`);
  await touch('touchStart', [x, y]);
  await touch('touchEnd');
  await page.waitForSelector('#picked dl');
}, { width: 390, height: 844, touch: true });

test('a file is opened, its text saved; the divider moves', async (hand, page) => {
  await page.click('#tab-out');
  await page.setInputFiles('#panel-out input[type=file]', { name: 'twig.rifs', mimeType: 'text/plain', buffer: Buffer.from('rifs twig {\r\n  map a { scale 0.5 }\r\n}\r\n') });
  await hand.until(() => hand.last().name === 'twig.rifs', 'the file is the model');
  assert.equal(hand.last().text, 'rifs twig {\n  map a { scale 0.5 }\n}\n');
  await page.keyboard.press('Control+s');
  await hand.until(() => hand.asked('write').at(-1)?.path === 'twig.rifs', 'the text is saved');
  const before = hand.last().width;
  await hand.drag(await hand.place_of('#divider'), -100, 0);
  await hand.until(() => hand.last().width > before + 90, 'the picture is wider');
  await page.keyboard.press('Control+z');
  await hand.until(() => hand.last().name === 'fern.rifs', 'the fern is back');
});

test('files and the command line', async (hand, page) => {
  await page.click('#tab-out');
  await hand.until(async () => /graftal render fern\.rifs --size/.test(await page.textContent('[aria-label="Command line"]')), 'the command shows');
  await page.click('text=2×');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save-picture')]);
  assert.equal(download.suggestedFilename(), 'fern.png');
  const { width, height } = hand.asked('write')[0];
  assert.equal(fs.readFileSync(await download.path(), 'utf8'), `${width}x${height}`);
  assert.equal(width, 2 * hand.last().width);
  await page.selectOption('#format', '.glb');
  const [exported] = await Promise.all([page.waitForEvent('download'), page.click('#save-export')]);
  assert.equal(exported.suggestedFilename(), 'fern.glb');
});

test('all by keyboard alone', async (hand, page) => {
  await page.keyboard.press('F6');
  await page.keyboard.press('Control+End');
  await page.keyboard.type('# typed');
  await hand.until(() => /# typed/.test(hand.last().text), 'the text has it');
  await page.keyboard.press('F6');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'view');
  await page.keyboard.press('+');
  await hand.until(() => hand.last().zoom !== null, 'it zooms');
  await page.keyboard.press('0');
  await page.keyboard.press('F6');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'tab-knobs');
  await page.keyboard.press('Tab');
  await page.keyboard.press('ArrowRight');
  await hand.until(() => hand.last().set.lean > 2.5, 'the knob turns');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await page.keyboard.type('3');
  await page.keyboard.press('Enter');
  await hand.until(() => hand.last().set.lean === 3, 'the number is typed');
  await page.keyboard.press('F6');
  await page.keyboard.press('F6');
  await page.keyboard.press('F6');
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'tab-maps');
  while (!(await page.isDisabled('#undo'))) await page.keyboard.press('Control+z');
  await hand.settled();
  assert.doesNotMatch(hand.last().text, /typed/);
  assert.deepEqual([hand.last().set, hand.last().zoom], [{}, null]);
});

for (const [width, height] of [[1280, 720], [390, 844]]) {
  for (const dark of [false, true]) {
    test(`axe finds nothing at ${width}, ${dark ? 'dark' : 'light'}`, async (hand, page) => {
      await page.evaluate(axe);
      for (const tab of [...(width < 800 ? ['text'] : []), 'knobs', 'maps', 'vary', 'time', 'out']) {
        await page.click(`#tab-${tab}`);
        await page.waitForTimeout(150);
        const { violations } = await page.evaluate(() => window.axe.run());
        assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes.map(({ html, failureSummary }) => html.slice(0, 200) + failureSummary)]), [], tab);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the page');
      }
      assert.ok(hand.last().width > 100);
    }, { width, height, dark });
  }
}

const rows = Array.from({ length: 300 }, (_, i) => `  let v${i} = 0.${i + 1}\n  map m${i} { scale 0.${(i % 8) + 1} } # row ${i}`).join('\n');
for (const [name, opened] of [['a fern', undefined], ['many maps', { name: 'rows.rifs', text: `rifs rows {\n${rows}\n}\n` }]]) {
  // Half of it on a free machine: processors that share a core count more.
  test(`no task takes 100 ms of the processor: ${name}`, async (hand, page) => {
    await browser.startTracing(page, { categories: ['toplevel', 'disabled-by-default-devtools.timeline', 'devtools.timeline'] });
    await hand.drag(await hand.place_of('.knob input'), 40, 0, { steps: 10 });
    await hand.type_at('rifs', ' some more words');
    await page.click('#tab-maps');
    await hand.drag(await hand.place_of('#view'), 60, 0, { steps: 10 });
    await hand.settled();
    const { traceEvents } = JSON.parse(await browser.stopTracing());
    const main = new Set(traceEvents.filter(({ name: event, args }) => event === 'thread_name' && args.name === 'CrRendererMain').map(({ pid, tid }) => `${pid} ${tid}`));
    const tasks = traceEvents.filter((event) => event.name === 'RunTask' && main.has(`${event.pid} ${event.tid}`));
    const longest_ms = Math.max(...tasks.map(({ tdur }) => (tdur ?? 0) / 1000));
    assert.ok(tasks.length > 100 && longest_ms < 100, `${tasks.length} tasks, the longest took ${longest_ms} ms`);
  }, { opened, alone: true });
}

await test.done();
