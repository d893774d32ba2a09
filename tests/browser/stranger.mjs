// SPDX-License-Identifier: GPL-3.0-or-later
// A stranger with a gear of their own: five numbers and a load, a slider, a search, a comparison, a report; on every
// size of screen, light and dark. Each page on the way has room for its labels, and axe-core finds nothing on it.
import {
  LOOSE,
  Server,
  WAIT,
  chapter,
  cutLabels,
  findings,
  finish,
  note,
  ok,
  openBrowser,
  settled,
} from './harness.mjs';

const GEAR = [
  ['Teeth of the pinion', '23'],
  ['Teeth of the gear', '61'],
  ['Normal module', '5'],
  ['Helix angle', '30'],
  ['Face width of one end', '40'],
  ['Torque on the pinion', '450'],
  ['Speed of the pinion', '1500'],
];
/**
 * Each size and each theme, which decide over room and colours apart from one another; axe-core reads both layouts and
 * both themes once. EASEOFF_SCREENS=all takes every size in both.
 */
const SCREENS = [
  { width: 1280, height: 800, colorScheme: 'light', reads: true },
  { width: 1280, height: 800, colorScheme: 'dark', again: true },
  { width: 1920, height: 1080, colorScheme: 'light', again: true },
  { width: 1920, height: 1080, colorScheme: 'dark' },
  { width: 390, height: 844, colorScheme: 'light', phone: true, again: true },
  { width: 390, height: 844, colorScheme: 'dark', phone: true, reads: true },
].filter(screen => !screen.again || process.env.EASEOFF_SCREENS === 'all');
const FINGER = 44; // px
const BUDGET = 40; // evaluations

const server = await Server.start();
const browser = await openBrowser();

for (const { width, height, colorScheme, phone = false, reads = false } of SCREENS) {
  const context = await browser.newContext({
    viewport: { width, height },
    colorScheme,
    reducedMotion: 'reduce',
    hasTouch: phone,
    isMobile: phone,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(WAIT);
  const troubles = [];
  page.on('pageerror', error => troubles.push(error.message));
  const number = name => page.locator('.number-cell', { hasText: name }).locator('.value').innerText();
  const look = async what => {
    if (process.env.EASEOFF_PICTURES)
      await page.screenshot({ path: `${process.env.EASEOFF_PICTURES}/${width}-${colorScheme}-${what}.png` });
    const cut = await cutLabels(page);
    ok(cut.length === 0, `${what}: no label is cut ${cut.slice(0, 3).join(' | ')}`);
    if (!reads) return;
    const found = await findings(page);
    ok(found.length === 0, `${what} is accessible`);
    found.forEach(note);
    if (!phone) return;
    const small = await page.evaluate(
      least =>
        [...document.querySelectorAll('button, select, summary, input[type=text], input[type=range], a.button')]
          .filter(each => each.checkVisibility() && each.offsetHeight < least - 0.5)
          .map(each => `${each.textContent || each.id} ${each.offsetHeight} px`),
      FINGER,
    );
    ok(small.length === 0, `${what}: a finger meets everything ${small.slice(0, 5).join(' | ')}`);
  };

  await chapter(`${width} px, ${colorScheme}`, async () => {
    await page.goto(server.address);
    await page.getByText('Relieve the tooth tips until the pair runs quietly.').first().waitFor();
    await page.locator('.lead-line').getByRole('button', { name: 'Your own gear…' }).click();
    const dialog = page.locator('dialog.own-gear-dialog');
    for (const [name, text] of GEAR) await dialog.getByLabel(name).fill(text);
    await dialog.getByText('Assumed, until you state it').waitFor();
    await look('own gear');
    await dialog.getByRole('button', { name: 'Compute it' }).click();
    await page.waitForFunction(() => /from=own/.test(location.hash));
    const { length } = new URL(page.url()).hash;
    ok(length < 300, `the link to it has ${length} characters`);
    if (phone) {
      await page.locator('.design-view.preparing').waitFor();
      const [room, needed] = await page
        .locator('.tabs')
        .evaluate(tabs => [Math.min(tabs.clientWidth, innerWidth), tabs.scrollWidth]);
      ok(needed <= room, `all tabs are in sight while the teeth are prepared: ${needed} px of ${room}`);
    }
    await page.goto(`${page.url()}&${LOOSE}`); // prepared in a moment; all else stays
    await settled(page);
    ok((await page.getByLabel('Gear teeth', { exact: true }).inputValue()) === '61', 'the link opens the gear');
    await page.waitForFunction(() => /no relief yet/.test(document.querySelector('.sensitivity')?.textContent ?? ''));

    const before = Number(await number('Transmission error'));
    const slider = page.getByRole('slider', { name: 'Tip relief', exact: true });
    await slider.evaluate(each => each.scrollIntoView({ block: 'nearest' }));
    const box = await slider.boundingBox();
    await page.mouse.move(box.x + 9, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.35 * box.width, box.y + box.height / 2, { steps: 6 });
    await page.mouse.up();
    await page.waitForFunction(() => /left\.tip_relief_um=/.test(location.hash));
    await page.waitForFunction(() => /[−+]\d/.test(document.querySelector('.number-cell .delta').textContent));
    const after = Number(await number('Transmission error'));
    ok(after !== before, `a drag of a slider moves its number from ${before} µm to ${after} µm`);
    await look('Design');

    await page.getByRole('button', { name: 'Optimize…' }).click();
    const budget = page.getByLabel('Budget, evaluations', { exact: true });
    await budget.fill(String(BUDGET));
    await budget.press('Tab');
    await page.getByRole('button', { name: 'Start the search' }).click();
    await page.waitForFunction(
      () => /job=/.test(location.hash) && /^done/.test(document.querySelector('tr.chosen .job-state')?.textContent ?? ''),
      null,
      { polling: 100 },
    );
    await page.locator('.job-head').getByRole('button', { name: 'Delete' }).waitFor(); // of one that has ended
    await page.getByRole('button', { name: 'Open the best' }).waitFor();
    await look('Optimize');

    await page.locator('.job-head').getByRole('button', { name: 'Compare' }).click();
    await page.waitForFunction(() => {
      const table = document.querySelector('.comparison');
      return table?.querySelectorAll('thead th').length === 4 && !/…/.test(table.textContent);
    });
    const J = await page.locator('.comparison tbody tr').first().locator('td').allInnerTexts();
    const [plain, best] = J.map(text => parseFloat(text));
    ok(plain === 1 && best < plain, `the best of the search has less J than the unmodified pair: ${J.join('; ')}`);
    await look('Compare');

    await page.getByRole('navigation').getByRole('button', { name: 'Design' }).click();
    await settled(page);
    await page.locator('.design-button').click();
    await page.locator('.design-menu').getByRole('button', { name: /Print a report/ }).click();
    await page.locator('.report-state', { hasText: 'whole' }).waitFor();
    ok((await page.locator('.report h1').innerText()) === 'my gear', 'the report has the name of the gear');
    await look('Report');
    const beyond = await page.evaluate(() =>
      [...document.querySelectorAll('.report-figure > svg')].flatMap(svg => {
        const { width, height } = svg.viewBox.baseVal;
        const boxes = [...svg.querySelectorAll(':scope > path:not([clip-path])')].map(path => path.getBBox());
        const inside = ({ x, y, width: w, height: t }) => Math.min(x, y, width - x - w, height - y - t) > -1;
        return boxes.every(inside) ? [] : [svg.textContent.slice(0, 40)];
      }),
    );
    ok(beyond.length === 0, `no figure is drawn over its frame ${beyond.join('; ')}`);
    if (reads) {
      const pdf = (await page.pdf({ format: 'A4' })).toString('latin1');
      ok((pdf.match(/\/Type\s*\/Page\b/g) ?? []).length >= 3, 'the printed report has three pages or more');
    }

    await page.getByRole('button', { name: 'Help' }).click();
    await page.getByRole('menuitem', { name: 'All words explained' }).click();
    await page.getByText('Transmission error (TE)').waitFor();
    await look('Words');
    ok(troubles.length === 0, `the page throws no errors ${troubles.join('; ')}`);
  });
  await context.close();
}

await browser.close();
await server.remove();
finish();
