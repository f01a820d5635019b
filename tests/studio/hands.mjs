// Hands on the page of graftal studio, in headless Chromium.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

/** `modules`: what tools/test installs from npm. */
export async function open_browser(modules) {
  if (!fs.existsSync(modules)) {
    console.error(`there is no ${modules}: tools/test installs it from npm`);
    process.exit(1);
  }
  const { chromium } = createRequire(path.join(modules, 'x'))('playwright-core');
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu'] });
}

/** Tests that run at once, each with a page of its own: a page mostly waits. */
const together = 3;

/** Gives the function that notes one test: `serve` opens a session for it, with an `address` and a `close`. */
export function tester(browser, serve) {
  const counts = { passed: 0, failed: 0 }, noted = [];
  /** `check` gets a hand on a page of its own. `alone`: nothing else runs meanwhile. */
  function test(name, check, options = {}) {
    if (!process.env.ONLY || name.includes(process.env.ONLY)) noted.push({ name, check, ...options });
  }
  async function run({ name, check, width = 1280, height = 720, dark = false, opened, told, hash = '', touch = false, ready = 'body[data-picture=done]' }) {
    const session = await serve(opened, told);
    const context = await browser.newContext({
      viewport: { width, height }, colorScheme: dark ? 'dark' : 'light', permissions: ['clipboard-read', 'clipboard-write'],
      acceptDownloads: true, hasTouch: touch,
    });
    const page = await context.newPage(), faults = [];
    page.setDefaultTimeout(20_000);
    page.on('pageerror', (error) => faults.push(error.stack));
    page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
    page.on('request', (request) => !/^(https?:\/\/127\.0\.0\.1|data:|blob:)/.test(request.url()) && faults.push(`asked ${request.url()}`));
    try {
      await page.goto(session.address + hash);
      await page.waitForSelector(ready);
      await check(hand_on(page, session), page, session);
      assert.deepEqual(faults, []);
      ++counts.passed;
    } catch (error) {
      ++counts.failed;
      console.error(`FAILED ${name}\n${error.stack}\n${faults.join('\n')}`);
      if (process.env.SHOTS) await page.screenshot({ path: path.join(process.env.SHOTS, `${name.replace(/\W+/g, '_')}.png`) });
    } finally {
      await context.close();
      session.close();
    }
  }
  /** Runs the tests, says how many passed, and ends. */
  test.done = async () => {
    const waiting = noted.filter(({ alone }) => !alone);
    const worker = async () => {
      for (let next = waiting.shift(); next; next = waiting.shift()) await run(next);
    };
    await Promise.all(Array.from({ length: together }, worker));
    for (const one of noted.filter(({ alone }) => alone)) await run(one);
    await browser.close();
    console.log(`${counts.passed} passed, ${counts.failed} failed`);
    process.exit(counts.failed ? 1 : 0);
  };
  return test;
}

function hand_on(page, { told }) {
  const hand = {
    last: () => told.states.at(-1),
    asked: (what) => told.asks.filter((ask) => ask.what === what),
    text: () => page.evaluate(() => [...document.querySelectorAll('.cm-line')].map((line) => line.textContent).join('\n')),
    pixels: () => page.evaluate(() => {
      const canvas = document.getElementById('picture');
      const words = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer);
      return words.reduce((sum, word) => Math.imul(sum, 31) + word | 0, 7);
    }),
    /** Waits until the picture of the last state is complete. */
    async settled() {
      await page.waitForTimeout(60);
      await page.waitForSelector('body[data-picture=done]', { timeout: 120_000 });
    },
    async changes(act) {
      const before = await hand.pixels();
      await act();
      await hand.until(async () => (await hand.pixels()) !== before, 'the pixels change');
      await hand.settled();
    },
    async until(holds, what) {
      for (let i = 0; i < 400; ++i) {
        if (await holds()) return;
        await page.waitForTimeout(50);
      }
      assert.fail(`it never came that ${what}`);
    },
    async place_of(selector) {
      let box; // null while handles are drawn anew
      await hand.until(async () => (box = await page.locator(selector).first().boundingBox()), `${selector} stands there`);
      return [box.x + box.width / 2, box.y + box.height / 2];
    },
    async drag([x, y], dx, dy, { steps = 4, shift = false } = {}) {
      await page.mouse.move(x, y);
      await page.mouse.down();
      if (shift) await page.keyboard.down('Shift');
      await page.mouse.move(x + dx, y + dy, { steps });
      await page.mouse.up();
      if (shift) await page.keyboard.up('Shift');
    },
    /** Where a piece of the text is on the screen. */
    place_of_text: (piece) => page.evaluate((wanted) => {
      const walker = document.createTreeWalker(document.querySelector('.cm-content'), NodeFilter.SHOW_TEXT);
      for (let node = walker.nextNode(); node; node = walker.nextNode()) {
        const at = node.data.indexOf(wanted);
        if (at < 0) continue;
        const range = document.createRange();
        range.setStart(node, at);
        range.setEnd(node, at + wanted.length);
        const box = range.getBoundingClientRect();
        return [box.x + box.width / 2, box.y + box.height / 2];
      }
      return null;
    }, piece),
    async type_at(piece, text) {
      const [x, y] = await hand.place_of_text(piece);
      await page.mouse.click(x, y);
      await page.keyboard.press('End');
      await page.keyboard.type(text);
    },
    knob: (name) => page.locator(`.knob input[aria-label="${name}"]`),
  };
  return hand;
}
