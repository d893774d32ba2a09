// SPDX-License-Identifier: GPL-3.0-or-later
// What the page takes: first words, figures, bytes, shifts, a drag. Times by the clock want a quiet machine; beside
// them stands the processor time of the page's main thread, which other work does not lengthen. EASEOFF_LINK opens
// another pair.
import { readFile } from 'node:fs/promises';
import { Server, finish, load, note, ok, openBrowser, settled } from './harness.mjs';

const LINK = process.env.EASEOFF_LINK ?? '#design?from=paper-case-a';
const MOST = { words: 0.2, figures: 1.5, bytes: 100e3, shift: 0.01, task: 100 };
const LEAST_UPDATES = 20; // a second
const DRAG = 4000; // ms

const server = await Server.start();
const browser = await openBrowser();
const trace = { categories: ['toplevel', 'disabled-by-default-devtools.timeline'] };

/** Longest task of the page's main thread: by the clock and of a processor, ms. */
function longestTask(buffer) {
  const { traceEvents: events } = JSON.parse(buffer.toString());
  const mains = events.filter(event => event.name === 'thread_name' && event.args.name === 'CrRendererMain');
  const threads = new Set(mains.map(event => `${event.pid} ${event.tid}`));
  const tasks = events.filter(event => /RunTask$/.test(event.name) && threads.has(`${event.pid} ${event.tid}`));
  const most = key => Math.max(0, ...tasks.map(event => event[key] ?? 0)) / 1000;
  return { wall: most('dur'), processor: most('tdur') };
}

async function newPage() {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  await context.addInitScript(() => {
    window.shift = 0;
    new MutationObserver((_changes, observer) => {
      if (!document.querySelector('.form-pane input')) return;
      window.formAt = performance.now();
      observer.disconnect();
    }).observe(document, { childList: true, subtree: true });
    new PerformanceObserver(list => {
      for (const entry of list.getEntries()) if (!entry.hadRecentInput) window.shift += entry.value;
    }).observe({ type: 'layout-shift', buffered: true });
  });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  return page;
}

// the pair is prepared first, so that what is measured is the page
const first = await newPage();
await first.goto(server.address + LINK);
await settled(first);
await first.context().close();

const page = await newPage();
await browser.startTracing(page, trace);
await page.goto(server.address + LINK);
await page.locator('.form-pane input').first().waitFor();
await settled(page);
const opened = await page.evaluate(() => ({
  words: performance.getEntriesByName('first-contentful-paint')[0]?.startTime / 1000,
  figures: performance.now() / 1000,
  bytes: [...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')]
    .filter(entry => entry.responseEnd <= window.formAt && !/analyze/.test(entry.name))
    .reduce((sum, entry) => sum + entry.transferSize, 0),
}));
await page.waitForTimeout(3000);
const start = longestTask(await browser.stopTracing());
const shift = await page.evaluate(() => window.shift);
ok(opened.words <= MOST.words, `the first words come after ${opened.words.toFixed(2)} s`);
ok(opened.figures <= MOST.figures, `the numbers of a cached pair come after ${opened.figures.toFixed(2)} s`);
ok(opened.bytes <= MOST.bytes, `the form takes ${(opened.bytes / 1000).toFixed(0)} kB`);
ok(shift < MOST.shift, `the layout shifts by ${shift.toFixed(4)}`);
ok(
  start.processor <= MOST.task,
  `the start has a task of ${start.processor.toFixed(0)} ms of a processor, ${start.wall.toFixed(0)} ms by the clock`,
);

let updates = 0;
page.on('response', response => (updates += /analyze.*curves_of/.test(response.url()) && response.ok() ? 1 : 0));
const slider = page.locator('.flank input[type=range]').first();
await slider.scrollIntoViewIfNeeded();
const box = await slider.boundingBox();
await page.mouse.move(box.x + box.width * 0.3, box.y + box.height / 2);
await page.mouse.down();
await browser.startTracing(page, trace);
const began = performance.now();
for (let i = 0; performance.now() - began < DRAG; i++) {
  await page.mouse.move(box.x + box.width * (0.5 + 0.3 * Math.sin(i / 12)), box.y + box.height / 2);
  await page.waitForTimeout(12);
}
const seconds = (performance.now() - began) / 1000;
const drag = longestTask(await browser.stopTracing());
await page.mouse.up();
const rate = updates / seconds;
ok(rate >= LEAST_UPDATES, `a drag of ${seconds.toFixed(1)} s brings ${rate.toFixed(1)} updates a second`);
ok(
  drag.processor <= MOST.task,
  `a drag has a task of ${drag.processor.toFixed(0)} ms of a processor, ${drag.wall.toFixed(0)} ms by the clock`,
);
note(`load average ${(await readFile('/proc/loadavg', 'utf8').catch(() => 'unknown')).trim()}`);
note(`Chromium by playwright-core ${load('playwright-core/package.json').version}`);
await browser.close();
await server.remove();
finish();
