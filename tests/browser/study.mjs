// SPDX-License-Identifier: GPL-3.0-or-later
// A study from the page: keys, cost, start, table, sort, brush, a row that is opened; no long task while doing so.
import { cp, rm } from 'node:fs/promises';
import { LOOSE, Server, WAIT, accessible, chapter, comes, finish, note, ok, openBrowser } from './harness.mjs';

const [FOLDER, JOB] = (process.env.EASEOFF_STUDY ?? '').split(':');
const MOST_TASK = 100; // ms

const server = await Server.start();
if (FOLDER) {
  await server.close();
  await rm(server.folder, { recursive: true });
  await cp(FOLDER, server.folder, { recursive: true });
  await server.open();
}
const browser = await openBrowser();
const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, reducedMotion: 'reduce' });
await context.addInitScript(() => {
  if (location.protocol === 'http:') localStorage.setItem('easeoff-lead', 'away');
  window.longest = 0;
  new PerformanceObserver(list => {
    for (const entry of list.getEntries()) window.longest = Math.max(window.longest, entry.duration);
  }).observe({ type: 'longtask', buffered: true });
});
const page = await context.newPage();
page.setDefaultTimeout(WAIT);
const troubles = [];
page.on('pageerror', error => troubles.push(error.message));
const rows = page.locator('.variant-table tbody:not(.space) tr');
/** Milliseconds of a processor that the page's longest task took: what else runs here does not count. */
function longestTask(trace) {
  const { traceEvents: events } = JSON.parse(trace.toString());
  const mains = events.filter(event => event.name === 'thread_name' && event.args.name === 'CrRendererMain');
  const threads = new Set(mains.map(event => `${event.pid} ${event.tid}`));
  const tasks = events.filter(event => /RunTask$/.test(event.name) && threads.has(`${event.pid} ${event.tid}`));
  return Math.max(0, ...tasks.map(event => event.tdur ?? 0)) / 1000;
}

const count = page.locator('.study-detail > .figure-note');

if (JOB) await browser.startTracing(page, { categories: ['toplevel', 'disabled-by-default-devtools.timeline'] });

await chapter('a study is ordered', async () => {
  await page.goto(`${server.address}#study?from=paper-case-a&${LOOSE}${JOB ? `&job=${JOB}` : ''}`);
  if (JOB) return;
  await page.getByLabel('Values 1').fill('0:30:6');
  await page.getByLabel('Values 2').fill('0, 5, 10, 20');
  await comes(page.getByText(/^24 variants of 1 gear pair/).waitFor(), 'the cost of a study stands beside it');
  await page.getByLabel('Key 2').fill('gear_pair.teeth');
  await comes(page.getByText('of which member').waitFor(), 'a key that could be two is asked about');
  await page.getByLabel('Key 2').fill('crowning both');
  await page.getByRole('option', { name: /^Lead crowning, pinion, both ends µm/ }).click();
  const row = page.locator('.study-axis').nth(1);
  const words = await page.getByLabel('Key 2').inputValue();
  ok(words === 'Lead crowning, pinion, both ends', 'a number is found by words');
  ok(
    /modification\.pinion\.\*\.lead_crowning_um in µm/.test(await row.innerText()),
    'the path and unit of a number stand below it',
  );
  await page.getByText(/^24 variants of 1 gear pair/).waitFor();
  await page.getByRole('button', { name: 'Start the study' }).click();
});

await chapter('its table', async () => {
  await page.waitForFunction(
    job => {
      const text = document.querySelector('.study-detail > .figure-note')?.textContent ?? '';
      return job ? /\d{3,} of/.test(text) : text.startsWith('24 of 24');
    },
    JOB ?? '',
    { polling: 200 },
  );
  note(await count.textContent());
  const there = await rows.count();
  ok(there > 10 && there < 80, `${there} rows are in the document`);
  await page.getByRole('button', { name: 'J', exact: true }).click();
  const sorted = page.waitForFunction(() => {
    const at = [...document.querySelectorAll('.variant-table thead th')].findIndex(th => th.title === 'objectives.J');
    const shown = [...document.querySelectorAll('.variant-table tbody:not(.space) tr')];
    const numbers = shown.map(tr => Number(tr.children[at].textContent));
    return numbers.length > 10 && numbers.every((value, i) => !i || value >= numbers[i - 1]);
  });
  ok(await sorted.then(Boolean, () => false), 'a click on a heading sorts the table');
  const table = page.locator('.variant-table');
  for (let i = 0; i < 10; i++)
    await table.evaluate((element, to) => (element.scrollTop = to * element.scrollHeight), i / 10);
});

await chapter('a brush', async () => {
  const box = await page.locator('.coordinates canvas').boundingBox();
  const before = await count.textContent();
  await page.mouse.move(box.x + 46, box.y + 35);
  await page.mouse.down();
  await page.mouse.move(box.x + 46, box.y + 90, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(
    text => document.querySelector('.study-detail > .figure-note').textContent !== text,
    before,
  );
  note(await count.textContent());
  await page.waitForFunction(() => document.querySelector('.variant-table tbody:not(.space) tr'));
  const kept = await rows.count();
  ok(kept > 0 && (JOB || kept < 24), 'a brush keeps the rows of its range');
  await page.getByRole('button', { name: 'show all rows' }).click();
  await comes(
    page.waitForFunction(
      () => !document.querySelector('.study-detail > .figure-note').textContent.includes('show all rows'),
    ),
    'a brush lets all rows go again',
  );
});

const wall = await page.evaluate(() => window.longest);
note(`longest task ${wall.toFixed(0)} ms by the clock`);
if (JOB) {
  const longest = longestTask(await browser.stopTracing());
  ok(longest > 0 && longest < MOST_TASK, `the longest task of the table took ${longest.toFixed(1)} ms of a processor`);
}

await chapter('for everybody', () => accessible(page, 'a study'));

await chapter('a variant', async () => {
  await rows.first().click();
  await page.locator('.picked-variant strong').waitFor();
  const name = await page.locator('.picked-variant strong').textContent();
  await page.locator('.picked-variant').getByRole('button', { name: 'Open' }).click();
  await page.waitForFunction(() => location.hash.startsWith('#design'));
  ok((await page.content()).includes(name.toLowerCase()), 'a click on a row opens its design');
});

ok(troubles.length === 0, `the page throws no errors: ${troubles.join('; ')}`);
await browser.close();
await server.remove();
finish();
