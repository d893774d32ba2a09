// SPDX-License-Identifier: GPL-3.0-or-later
// A rig engineer's day: recordings come in, one of them is broken, they lie beside the prediction, an input is fitted,
// one is deleted.
import { readFile } from 'node:fs/promises';
import { LOOSE, Server, WAIT, accessible, chapter, comes, cutLabels, finish, ok, openBrowser } from './harness.mjs';

const START = `#rig?from=paper-case-a&${LOOSE}`;

const server = await Server.start();
const browser = await openBrowser();
const context = await browser.newContext({
  viewport: { width: 1280, height: 800 },
  reducedMotion: 'reduce',
  acceptDownloads: true,
});
const page = await context.newPage();
page.setDefaultTimeout(WAIT);
const troubles = [];
page.on('console', message => {
  if ((message.type() === 'error' || message.type() === 'warning') && !/GL Driver Message|422|409/.test(message.text()))
    troubles.push(message.text());
});
page.on('pageerror', error => troubles.push(error.message));

const rows = page.locator('section[aria-label="Measurements"] tbody tr');
/** Records without a rig and puts the recording into the queue. */
const record = async ({ pair = 'modified', speed = '', fault = 'none' }) => {
  const before = await page.locator('.recording').count();
  await page.getByLabel('Synthetic pair').selectOption(pair);
  await page.getByLabel('Synthetic speed, rpm').fill(speed);
  await page.getByLabel('Synthetic fault').selectOption(fault);
  await page.getByRole('button', { name: 'Record and use' }).click();
  await page.waitForFunction(count => document.querySelectorAll('.recording').length > count, before);
};
const compared = () =>
  page.waitForFunction(() => {
    const cells = [...document.querySelectorAll('section[aria-label="Measurements"] tbody td')];
    return cells.length > 0 && cells.every(cell => cell.textContent !== '…');
  });

await chapter('open', async () => {
  await page.goto(server.address + START);
  await page.locator('.drop').waitFor();
  ok(await page.getByText('Measured and predicted').isVisible(), 'an empty bench says what belongs on it');
  await page.locator('summary', { hasText: 'Synthetic recording' }).click();
});

await chapter('measure', async () => {
  await record({});
  await record({ pair: 'unmodified' });
  await record({ pair: 'unmodified', speed: '1000' });
  ok(
    (await page
      .getByLabel(/^Torque of/)
      .first()
      .inputValue()) === '828',
    'torque and speed are known from the name',
  );
  await page.getByRole('button', { name: 'Measure 3 recordings' }).click();
  await rows.nth(2).waitFor();
  await compared();
  ok(
    (await page.locator('.recording').count()) === 0 && (await rows.count()) === 3,
    'the queue is empty, and three measurements stand in the table',
  );
  const ratios = (await rows.allInnerTexts()).map(text => Number(text.split('\t')[6]));
  ok(
    ratios.every(ratio => Math.abs(ratio - 1) < 0.02),
    `what was measured lies beside what was predicted: ${ratios.join(', ')}`,
  );
  ok(
    /\d %/.test(await page.locator('section[aria-label="Reductions"]').innerText()),
    'the modification is judged in per cent',
  );
  ok(/id=1/.test(page.url()), 'the design was stored for its measurements');
});

await chapter('a broken recording', async () => {
  await record({ fault: 'slip' });
  await page.getByRole('button', { name: 'Measure', exact: true }).click();
  const finding = page.locator('.recording .findings li').first();
  await finding.waitFor();
  ok(
    /no result/.test(await finding.innerText()) && /jumps/.test(await finding.innerText()),
    'a refused recording says in plain words why it has no result',
  );
  ok((await rows.count()) === 3, 'a refused recording is not kept');
  await page.getByRole('button', { name: 'Say what the columns mean' }).click();
  ok(await page.getByLabel('Pinion column or columns').isVisible(), 'the columns can be named');
  ok(
    /pinion 2, gear 3/.test(await page.locator('.form-pane').innerText()),
    'the columns that were guessed stand beside',
  );
  await page.getByRole('button', { name: /^Leave .* out$/ }).click();
});

await chapter('look', async () => {
  await rows.first().getByRole('button').first().click();
  await page.waitForFunction(() =>
    /SHA-256/.test(document.querySelector('section[aria-label="About the recording"]').textContent),
  );
  ok(
    /Eccentricity/.test(await page.locator('section[aria-label="About the recording"]').innerText()),
    'a measurement tells about itself',
  );
  const download = page.waitForEvent('download');
  await rows.first().getByRole('link').click();
  const text = await readFile(await (await download).path(), 'utf8');
  ok(text.startsWith('t_s,angle1_deg'), 'the recording comes back');
});

await chapter('fit', async () => {
  await page.locator('summary', { hasText: 'Fit unknown inputs' }).click();
  await page.getByRole('button', { name: 'Fit to the measurements' }).click();
  const found = page.locator('section[aria-label="Fit"] tbody tr').first();
  await found.waitFor();
  const value = Number((await found.innerText()).split('\t')[2]);
  ok(Math.abs(value - 0.07) < 0.01, `the damping of the recordings is found: ${value}`);
  await page.getByRole('button', { name: 'Take over into the design' }).click();
  await page.getByText('Taken over; undo takes it back.').waitFor();
  await compared();
});

await chapter('for everybody', async () => {
  await accessible(page, 'the rig');
  await page.setViewportSize({ width: 390, height: 800 });
  await page.waitForTimeout(300);
  const cut = await cutLabels(page);
  ok(cut.length === 0, `no label is cut at 390 px ${cut.slice(0, 3).join(' | ')}`);
  await page.setViewportSize({ width: 1280, height: 800 });
});

await chapter('delete', async () => {
  await rows
    .first()
    .getByRole('button', { name: /^Delete/ })
    .click();
  await page.locator('dialog.question').getByRole('button', { name: 'Delete' }).click();
  await comes(
    page.waitForFunction(() => document.querySelectorAll('section[aria-label="Measurements"] tbody tr').length === 2),
    'a measurement is deleted',
  );
});

ok(troubles.length === 0, `the page throws no errors ${troubles.join(' | ')}`);
await browser.close();
await server.remove();
finish();
