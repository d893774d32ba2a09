// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs as made from the page: the first at once, all of them from a job that another page finds again and can stop.
import { LOOSE, Server, WAIT, accessible, chapter, comes, finish, ok, openBrowser } from './harness.mjs';

const server = await Server.start();
const browser = await openBrowser();
const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, reducedMotion: 'reduce' });
await context.addInitScript(() => {
  if (location.protocol === 'http:') localStorage.setItem('easeoff-lead', 'away');
});
const page = await context.newPage();
const troubles = [];
page.on('pageerror', error => troubles.push(error.message));
const state = page.locator('.tolerance-view [role=status]').first();
const draw = page.getByRole('button', { name: 'Draw the pairs' });
const jobs = async () => (await (await fetch(new URL('api/v1/jobs?kind=tolerance', server.address))).json()).items;

await chapter('a job draws them all', async () => {
  await page.goto(`${server.address}#tolerance?from=paper-case-a&${LOOSE}&tolerance.pairs=150`);
  await draw.click();
  await comes(page.getByText(/\b64 pairs/).first().waitFor({ timeout: WAIT }), 'the first 64 pairs are shown');
  await page.getByText(/, 150 pairs/).first().waitFor({ timeout: WAIT });
  const [job] = await jobs();
  ok(job.state === 'done' && job.progress.true_evaluations === 150, 'a job draws all pairs');
  ok(await draw.isEnabled(), 'the pairs can be drawn again');
});

await chapter('another page', async () => {
  await page.reload();
  await page.getByText(/, 150 pairs/).first().waitFor({ timeout: WAIT });
  ok((await state.textContent()).includes('20'), 'another page shows what was drawn, with its date');
});

await chapter('for everybody', () => accessible(page, 'a tolerance analysis'));

await chapter('stopping', async () => {
  await page.goto('about:blank');
  await page.goto(`${server.address}#tolerance?from=paper-case-a&${LOOSE}&tolerance.pairs=50000`);
  await page.getByText(/, 150 pairs/).first().waitFor({ timeout: WAIT });
  await draw.click();
  await page.getByText(/of 50000/).first().waitFor({ timeout: WAIT });
  await page.reload();
  await comes(page.getByText(/of 50000/).first().waitFor({ timeout: WAIT }), 'a job that runs is found after a reload');
  await page.getByRole('button', { name: 'Stop' }).click();
  await page.getByText('what was drawn is kept').waitFor({ timeout: WAIT });
  ok((await jobs())[0].state === 'cancelled', 'the job that was found is cancelled by stop');
  const [{ id }] = (await (await fetch(new URL('api/v1/jobs?kind=prepare', server.address))).json()).items;
  const other = await fetch(new URL(`api/v1/jobs/${id}/clone`, server.address), { method: 'POST' });
  await page.waitForTimeout(1000); // it reaches the page and ends
  ok(
    other.ok && (await state.textContent()).includes('is kept'),
    'the page still says what is kept when another job changes',
  );
});

ok(troubles.length === 0, `the page throws no errors: ${troubles.join('; ')}`);
await browser.close();
await server.remove();
finish();
