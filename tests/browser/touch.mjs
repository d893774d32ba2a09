// SPDX-License-Identifier: GPL-3.0-or-later
// Fingers: on a phone everything that is pressed is 44 px high and wide, in every view, and nothing is cut.
import { LOOSE, Server, chapter, cutLabels, finish, knownPage, note, ok, openBrowser, settled } from './harness.mjs';

const LEAST = 44; // px
const PAIR =
  'gear_pair.pinion_teeth=23&gear_pair.gear_teeth=61&gear_pair.normal_module_mm=5&gear_pair.helix_angle_deg=30&' +
  'gear_pair.face_width_mm=60';

const server = await Server.start();
const browser = await openBrowser();
const { page, troubles } = await knownPage(browser, {
  viewport: { width: 390, height: 844 },
  hasTouch: true,
  isMobile: true,
});

/** What is smaller than a finger, each kind once. A link inside a sentence is as high as its line. */
function smallTargets(least) {
  for (const group of document.querySelectorAll('details')) group.open = true;
  const found = new Map();
  const pressed =
    'button, select, input:not([type=hidden]), textarea, summary, a[href], [role=button], canvas[tabindex]';
  for (const each of document.querySelectorAll(pressed)) {
    if (!each.checkVisibility({ visibilityProperty: true }) || each.disabled || each.matches('.away, .skip')) continue;
    if (each.matches('a') && each.closest('p, li, td, dd, small')) continue;
    const own = each.getBoundingClientRect();
    if (!own.width || !own.height) continue;
    const boxes = [own, ...[...(each.labels ?? [])].map(label => label.getBoundingClientRect())];
    const beside = each.closest('.entry, .field.flag')?.getBoundingClientRect();
    if (beside) boxes.push(beside); // a press beside a number is in its row
    const width = Math.max(...boxes.map(box => box.right)) - Math.min(...boxes.map(box => box.left));
    const height = Math.max(...boxes.map(box => box.bottom)) - Math.min(...boxes.map(box => box.top));
    if (width >= least - 0.5 && height >= least - 0.5) continue;
    const name = each.getAttribute('aria-label') ?? (each.labels?.[0]?.textContent || each.textContent || each.title);
    const kind = `${each.tagName.toLowerCase()}.${each.className} in .${each.parentElement.className}`;
    if (!found.has(kind)) found.set(kind, `${kind}: ${Math.round(width)} x ${Math.round(height)}: ${name.trim()}`);
  }
  return [...found.values()];
}

const open = async (view, more = '') => {
  await page.goto('about:blank');
  await page.goto(`${server.address}#${view}?from=narrow&${PAIR}&${LOOSE}${more}`);
};
const views = {
  design: async () => {
    await open('design');
    await settled(page);
  },
  optimize: async () => {
    await open('optimize');
    await page.getByRole('button', { name: 'Start the search' }).waitFor();
  },
  study: async () => {
    await open('study');
    await page.getByRole('button', { name: 'Start the study' }).waitFor();
  },
  tolerance: async () => {
    await open('tolerance', '&tolerance.pairs=64');
    await page.getByRole('button', { name: 'Draw the pairs' }).click();
    await page.getByText(/, 64 pairs/).first().waitFor();
  },
  compare: async () => {
    await open('compare', '&items=current,plain');
    await page.locator('.comparison').first().waitFor();
  },
  rig: async () => {
    await open('rig');
    await page.locator('.drop').waitFor();
  },
  glossary: async () => {
    await open('glossary');
    await page.getByText('Herringbone gear').first().waitFor();
  },
  report: async () => {
    await open('report');
    await page.locator('.report-head').waitFor();
  },
};
for (const [name, act] of Object.entries(views))
  await chapter(name, async () => {
    await act();
    const small = await page.evaluate(smallTargets, LEAST);
    small.forEach(note);
    ok(small.length === 0, `${name}: everything that is pressed is as large as a finger`);
    const cut = await cutLabels(page);
    ok(cut.length === 0, `${name}: no label is cut ${cut.join(', ')}`);
  });

ok(troubles.length === 0, `the page throws no errors: ${troubles.join('; ')}`);
await browser.close();
await server.remove();
finish();
