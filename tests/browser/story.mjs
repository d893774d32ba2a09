// SPDX-License-Identifier: GPL-3.0-or-later
// A designer's day: look, drag, mistype, search, close the laptop, come back, compare, print; and a server that goes
// away.
import { readFile } from 'node:fs/promises';
import { Server, WAIT, chapter, comes, cutLabels, finish, note, ok, openBrowser } from './harness.mjs';

// a coarse mesh, so that preparing the pair takes a second
const COARSE = {
  positions: 32,
  cells_per_line: 16,
  sector_teeth: 3,
  neighbour_coupling: false,
  layers: 14,
  flank_rows: 6,
  fillet_elements: 8,
};
const START = `#design?from=paper-case-a&${Object.entries(COARSE)
  .map(([key, value]) => `resolution.${key}=${value}`)
  .join('&')}`;
const MOST_BYTES = 1e6; // of the first view

const server = await Server.start();
const browser = await openBrowser();
const context = await browser.newContext({
  viewport: { width: 1280, height: 800 },
  colorScheme: 'light',
  reducedMotion: 'reduce',
  acceptDownloads: true,
});
const page = await context.newPage();
page.setDefaultTimeout(WAIT);
const troubles = [];
let quiet = false;
page.on('console', message => {
  if (
    !quiet &&
    (message.type() === 'error' || message.type() === 'warning') &&
    !/GL Driver Message|422|409/.test(message.text())
  )
    troubles.push(message.text());
});
page.on('pageerror', error => troubles.push(error.message));

/** Text of one of the large numbers. */
const number = (label, where = page) =>
  where.locator('.number-cell', { hasText: label }).locator('.value').textContent();
const settled = (where = page) =>
  where.waitForFunction(() => {
    const values = [...document.querySelectorAll('.number-cell .value')];
    return (
      values.length > 0 && values.every(value => /\d/.test(value.textContent)) && !document.querySelector('.preparing')
    );
  });
/** A picture of a figure as a number. */
const ink = title =>
  page.evaluate(wanted => {
    const figure = [...document.querySelectorAll('.figure')].find(each =>
      each.querySelector('h3')?.textContent.startsWith(wanted),
    );
    const text = figure.querySelector('canvas').toDataURL();
    let sum = 0;
    for (let i = 0; i < text.length; i++) sum = (sum * 31 + text.charCodeAt(i)) % 1e9;
    return sum;
  }, title);
const slider = name => page.getByRole('slider', { name, exact: true });
const field = name => page.getByLabel(name, { exact: true }).and(page.locator('input[type=text]'));
let job = '';
const rest = ms => new Promise(resolve => setTimeout(resolve, ms));

await chapter('open', async () => {
  const start = performance.now();
  await page.goto(server.address + START);
  await page.locator('.form-pane input').first().waitFor();
  note(`form shown after ${Math.round(performance.now() - start)} ms`);
  await page.waitForFunction(() =>
    performance.getEntriesByType('resource').some(entry => entry.name.endsWith('page.js')),
  );
  const page_bytes = await page.evaluate(() =>
    performance
      .getEntriesByType('resource')
      .concat(performance.getEntriesByType('navigation'))
      .filter(entry => !entry.name.includes('/api/'))
      .reduce((sum, entry) => sum + entry.transferSize, 0),
  );
  note(`first view ${Math.round(page_bytes / 1000)} kB without its data`);
  await settled();
  ok(page_bytes > 0 && page_bytes < MOST_BYTES, 'the first view is lighter than 1 MB');
  ok(
    !(await page.evaluate(() =>
      performance.getEntriesByType('resource').some(entry => /rig-|compare-/.test(entry.name)),
    )),
    'other views are not fetched before they are opened',
  );
  ok(/paper pair/.test(await page.title()), 'the title names the design');
  await page.waitForFunction(() => /−\d/.test(document.querySelector('.delta').textContent));
  ok(
    /−\d+ %/.test(await page.locator('.number-cell').first().innerText()),
    'the change against the unmodified pair stands beside the number',
  );
  ok((await page.locator('.figure .uplot').count()) >= 3, 'curves are drawn');
  ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the screen');
  ok(
    await page.evaluate(() => document.documentElement.scrollHeight <= innerHeight),
    'the window scrolls in its panes only',
  );
});

await chapter('drag a slider', async () => {
  const before = [await number('PPLTE'), await ink('Loaded TE'), await ink('Contact pressure')];
  const box = await slider('Tip relief').boundingBox();
  await page.mouse.move(box.x + 0.35 * box.width, box.y + box.height / 2);
  await page.mouse.down();
  for (let i = 0; i <= 12; i++) {
    await page.mouse.move(box.x + (0.35 + 0.03 * i) * box.width, box.y + box.height / 2);
    await rest(25);
  }
  await page.mouse.up();
  await page.waitForFunction(old => document.querySelector('.number-cell .value').textContent !== old, before[0]);
  await rest(400);
  ok((await number('PPLTE')) !== before[0], 'the number follows a drag');
  ok(
    (await ink('Loaded TE')) !== before[1] && (await ink('Contact pressure')) !== before[2],
    'the figures follow a drag',
  );
  ok(
    /modification\.pinion\.left\.tip_relief_um=/.test(page.url()) && /right\.tip_relief_um=/.test(page.url()),
    'the address holds the drag, left and right',
  );
  await page.keyboard.press('Control+z');
  await page.waitForFunction(old => document.querySelector('.number-cell .value').textContent === old, before[0]);
  ok(!/tip_relief_um/.test(page.url()), 'one undo takes the whole stroke back');
  await slider('Lead crowning').focus();
  await page.keyboard.press('ArrowRight');
  await comes(
    page.waitForFunction(() => /lead_crowning_um=/.test(location.hash)),
    'a slider is moved by keys',
  );
  await page.keyboard.press('Control+z');
});

await chapter('type numbers', async () => {
  const tip = field('Tip relief');
  await tip.fill('12,5');
  await tip.press('Enter');
  await page.waitForFunction(() => /left\.tip_relief_um=12\.5/.test(location.hash));
  ok((await slider('Tip relief').inputValue()) === '12.5', 'a comma is a decimal sign');
  await tip.fill('abc');
  await page.locator('.field .fault:not(:empty)').first().waitFor();
  ok((await tip.getAttribute('aria-invalid')) === 'true', 'what is no number is said at its field');
  await tip.fill('2000');
  await comes(
    page.getByText('2000 is outside 0 … 1000.', { exact: true }).waitFor(),
    'what is out of range is said with its range',
  );
  await tip.fill('14');
  await tip.press('Enter');
  await page.waitForFunction(() => !document.querySelector('.field .fault:not(:empty)'));
  const teeth = field('Pinion teeth');
  await teeth.fill('9');
  await teeth.press('Enter');
  const trouble = page.locator('.head-pane .trouble');
  await comes(
    trouble.filter({ hasText: /undercut|interferes|pointed|line of action/ }).waitFor(),
    'what the gears refuse is said in words',
  );
  await page.keyboard.press('Control+z');
  await teeth.fill('17');
  await teeth.press('Enter');
  await page.waitForFunction(() => document.querySelector('.trouble').hidden);
  await settled();
});

await chapter('pin and compare with it', async () => {
  await page.getByLabel('Compare with').selectOption('pin');
  await page.waitForFunction(() => /±0/.test(document.querySelector('.delta').textContent));
  ok((await page.locator('.legend', { hasText: 'pinned 1' }).count()) > 0, 'the pinned design is in the figures');
  await page.getByLabel('Compare with').selectOption('');
  await page.waitForFunction(() => /−\d/.test(document.querySelector('.delta').textContent));
});

await chapter('figures', async () => {
  const figure = page.locator('.figure', { hasText: 'Loaded TE' }).first();
  await figure.getByRole('button', { name: /menu/ }).click();
  const [csv] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('menuitem', { name: 'Save as CSV' }).click(),
  ]);
  const lines = (await readFile(await csv.path(), 'utf8')).trim().split('\n');
  ok(lines.length === 35 && lines[2].startsWith('mesh cycle,'), 'a figure is saved as CSV');
  ok(/paper pair/.test(lines[0]) && lines[1].startsWith('# Loaded transmission error'), 'the CSV says whose it is');
  ok(/^paper-pair.*-loaded-te\.csv$/.test(csv.suggestedFilename()), 'the name of the CSV says whose it is');
  ok(
    lines.slice(3).every(line => line.split(',').every(cell => cell.replace(/[-.]/g, '').length <= 12)),
    'the CSV has six digits',
  );
  await figure.getByRole('button', { name: /menu/ }).click();
  const [png] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('menuitem', { name: 'Save as PNG' }).click(),
  ]);
  const picture = await readFile(await png.path());
  ok(picture.readUInt32BE(16) >= 1200, `a figure is saved as PNG, ${picture.readUInt32BE(16)} px wide`);
  await figure.getByRole('button', { name: /menu/ }).click();
  await page.getByRole('menuitem', { name: 'Open large' }).click();
  ok((await page.locator('dialog .figure-body').boundingBox()).height > 400, 'a figure opens large');
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => !document.querySelector('dialog'));
  ok(
    (await page.locator('.figures .figure', { hasText: 'Loaded TE' }).count()) > 0,
    'a large figure goes back to its place',
  );
  const box = await figure.locator('.u-over').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await figure.locator('.tip:not([hidden])').waitFor();
  ok((await figure.locator('.tip-row').count()) === 3, 'the pointer reads the nearest curves');
  await page.mouse.move(5, 5);
  await page.locator('.figure.tall').scrollIntoViewIfNeeded();
  await page.locator('.figure.tall').getByRole('button', { name: 'front' }).click();
  ok((await page.locator('.figure.tall canvas').count()) === 1, 'the ease-off is drawn in space');
  await page.locator('.figure.wide').first().scrollIntoViewIfNeeded();
  await comes(page.locator('.figure.wide .uplot').first().waitFor(), 'the speed sweep is drawn');
  for (const title of ['Flash temperature', 'Specific film thickness', 'Sliding speed']) {
    const path = page.locator('.figure', { has: page.locator('h3', { hasText: title }) });
    await path.scrollIntoViewIfNeeded();
    await path.and(page.locator(':not(.waiting)')).locator('.uplot').waitFor(); // of the design on the table
    const text = await path.locator('.figure-body').getAttribute('aria-label');
    ok(/over roll length of the pinion.*: .* to /.test(text), `${title} is drawn: ${text}`);
  }
  await page.evaluate(() => document.querySelector('.figure-pane').scrollTo(0, 0));
});

await chapter('keep a design', async () => {
  await page.locator('.design-button').click();
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Export JSON' }).click(),
  ]);
  const document = JSON.parse(await readFile(await file.path(), 'utf8'));
  ok(document.gear_pair.pinion_teeth === 17, 'the design is saved as JSON');
  await page.locator('.design-button').click();
  const [model] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Export rexs zip (zip)' }).click(),
  ]);
  const archive = await readFile(await model.path());
  ok(
    model.suggestedFilename().endsWith('.rexsz') && archive.subarray(0, 4).equals(Buffer.from('PK\u0003\u0004')),
    `a file of another program is saved as it is: ${model.suggestedFilename()}`,
  );
  ok(archive.includes(Buffer.from('PK\u0005\u0006')), 'the archive is saved to its end, byte for byte');
  await page.locator('.design-button').click();
  await page.getByRole('button', { name: 'Store as new' }).click();
  await page.waitForFunction(() => /[?&]id=1/.test(location.hash));
  ok((await fetch(`${server.address}api/v1/designs/1`)).ok, 'the design is stored on the server');
  await page.locator('.design-button').click();
  const [points] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: /flank points/ }).click(),
  ]);
  ok((await readFile(await points.path(), 'utf8')).split('\n').length > 100, 'the points of the flanks are saved');
  document.name = 'from a file';
  document.modification.pinion.left.tip_relief_um = document.modification.pinion.right.tip_relief_um = 11;
  await page.locator('input[type=file]').setInputFiles({
    name: 'design.json',
    mimeType: 'application/json',
    buffer: Buffer.from(JSON.stringify(document)),
  });
  await page.waitForFunction(() => /from a file/.test(document.title));
  ok((await field('Tip relief').inputValue()) === '11', 'a design comes back from its file');
  await settled();
});

await chapter('search', async () => {
  await page.getByRole('button', { name: 'Optimize…' }).click();
  await field('Budget, evaluations').fill('400');
  await field('Budget, evaluations').press('Tab');
  await page.getByRole('button', { name: 'Start the search' }).click();
  await comes(page.locator('.job-bar .progress').waitFor(), 'the job bar shows the search');
  job = await page.locator('.job-list tbody tr').first().getAttribute('data-job');
  await page.reload();
  await page.locator('.job-list tbody tr').first().waitFor();
  ok(
    /running|preparing|queued|done/.test(await page.locator('.job-list tbody tr').first().innerText()),
    'the search is still there after a reload',
  );
  const ended = () => document.querySelector('.job-list tbody .job-state')?.textContent === 'done';
  await comes(page.waitForFunction(ended, null, { timeout: 4 * WAIT }), 'the search ends');
  await page.locator('.job-detail .figure', { hasText: 'Convergence' }).locator('.uplot').waitFor();
  await page.locator('.job-detail .figure', { hasText: 'History' }).waitFor();
  const before = await page.locator('.job-detail table').first().innerText();
  ok(/−\d+ %/.test(before), 'the best is better than the unmodified pair');
  await page.getByRole('button', { name: 'Open the best' }).click();
  await settled();
  ok((await field('Tip relief').inputValue()) !== '11', 'the optimum opens in the design view');
  ok(
    /0\.[1-9]/.test(await page.locator('.number-cell').last().locator('.value').innerText()),
    'the optimum has its objective',
  );
});

await chapter('compare and print', async () => {
  await page.goto(
    `${server.address}#compare?from=paper-case-a&items=unmodified,current,job:${job}&` +
      START.split('&').slice(1).join('&'),
  );
  await page.waitForFunction(
    () =>
      document.querySelectorAll('.comparison thead th').length === 4 &&
      !/…/.test(document.querySelector('.comparison').textContent),
    null,
    { timeout: 3 * WAIT },
  );
  ok((await page.locator('.comparison tbody tr').count()) > 20, 'three designs stand side by side');
  await page.locator('.compare-view .uplot').first().waitFor();
  const legend = await page.locator('.compare-view .legend').first().innerText();
  ok(/unmodified/.test(legend), 'the curves of three designs stand over one another');
  await page.getByRole('button', { name: 'Design', exact: true }).click();
  await settled();
  const paper = await page.pdf({ format: 'A4', printBackground: true });
  ok(paper.subarray(0, 4).toString() === '%PDF' && paper.length > 40000, 'the report is printed');
  ok(
    (paper.toString('latin1').match(/\/Type\s*\/Page\b/g) ?? []).length >= 3,
    'the printed report has three pages or more',
  );
  ok(
    await page.evaluate(() => !document.body.classList.contains('paper')),
    'the screen is a screen again after printing',
  );
});

await chapter('two pages share one stream', async () => {
  const other = await context.newPage();
  await other.goto(`${server.address}#optimize?from=paper-case-a`);
  await other.locator('.job-list tbody tr').first().waitFor();
  const rows = await other.locator('.job-list tbody tr').count();
  await page.bringToFront(); // a page behind another one draws nothing
  await page.getByRole('navigation').getByRole('button', { name: 'Optimize' }).click();
  await page.getByRole('button', { name: 'Again' }).click();
  const added = before => document.querySelectorAll('.job-list tbody tr').length === before + 1;
  await comes(
    other.waitForFunction(added, rows, { polling: 100 }), // a page behind another one has no frames
    'the other page sees a search that this one starts',
  );
  await other.bringToFront();
  await other.locator('.job-bar').getByRole('button', { name: 'stop' }).click();
  await page.bringToFront();
  await comes(
    page.waitForFunction(() =>
      /cancelled|done/.test(document.querySelector('.job-list tbody .job-state')?.textContent ?? ''),
    ),
    'this page sees that the other has stopped the search',
  );
  await other.close();
  await page.getByRole('navigation').getByRole('button', { name: 'Compare' }).click();
  await page.getByRole('navigation').getByRole('button', { name: 'Design' }).click();
});

await chapter('back', async () => {
  await page.goBack();
  await page.locator('.compare-view').waitFor();
  ok(/^#compare/.test(new URL(page.url()).hash), 'the back button shows the comparison again');
  await page.goForward();
  await page.locator('.headline').waitFor();
});

await chapter('every width', async () => {
  await page.getByRole('navigation').getByRole('button', { name: 'Design' }).click();
  for (const width of [390, 768, 1024, 1280, 1920, 2560]) {
    await page.setViewportSize({ width, height: 800 });
    await rest(150);
    const texts = await cutLabels(page);
    ok(texts.length === 0, `no label is cut at ${width} px ${texts.slice(0, 3).join(' | ')}`);
  }
  await page.setViewportSize({ width: 1280, height: 800 });
});

await chapter('a narrow screen', async () => {
  const phone = await browser.newContext({
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  const small = await phone.newPage();
  await small.goto(server.address + START);
  await small.locator('.design-view').waitFor();
  await settled(small);
  await rest(500);
  await small.getByRole('slider', { name: 'Tip relief', exact: true }).scrollIntoViewIfNeeded();
  const places = await small.evaluate(() =>
    ['.slider input[type=range]', '.number-cell .value', '.figure .u-over'].map(
      name => document.querySelector(name).getBoundingClientRect().top,
    ),
  );
  ok(
    places.every(top => top >= 0 && top < 800),
    `slider, number and figure are in sight together: ${places.map(Math.round).join(', ')}`,
  );
  await phone.close();
});

await chapter('a server with a token', async () => {
  const closed = await Server.start({ EASEOFF_TOKEN: 'only-for-the-three-of-us' });
  const visitor = await browser.newContext();
  const door = await visitor.newPage();
  await door.goto(closed.address);
  const token = door.getByLabel('Token of this server');
  await token.fill('a-guess');
  await token.press('Enter');
  await comes(door.locator('.fault:not(:empty)').waitFor(), 'a wrong token is refused in words');
  await token.fill('only-for-the-three-of-us');
  await token.press('Enter');
  await comes(door.locator('.form-pane input').first().waitFor(), 'the right token opens the page');
  await visitor.close();
  await closed.remove();
});

await chapter('the server goes away and comes back', async () => {
  await page.getByRole('navigation').getByRole('button', { name: 'Design' }).click();
  await settled();
  quiet = true;
  await server.close();
  const tip = field('Tip relief');
  await tip.fill('7');
  await tip.press('Enter');
  await page.locator('.away-banner:not([hidden])').waitFor();
  ok((await tip.inputValue()) === '7', 'the page tells of a server that is away and keeps the design');
  const before = await number('PPLTE');
  await server.open();
  await page.locator('.away-banner[hidden]').waitFor({ state: 'attached' });
  await comes(
    page.waitForFunction(old => document.querySelector('.number-cell .value').textContent !== old, before),
    'the page goes on by itself when the server is back',
  );
  quiet = false;
});

await chapter('fluency', async () => {
  const rate = await page.evaluate(async () => {
    const range = document.querySelector('.slider input[type=range]');
    let updates = 0;
    const observer = new MutationObserver(() => {
      updates += 1;
    });
    observer.observe(document.querySelector('.number-cell .value'), {
      childList: true,
      characterData: true,
      subtree: true,
    });
    const start = performance.now();
    for (let i = 0; performance.now() - start < 2000; i++) {
      range.value = String(5 + (i % 150) * 0.1);
      range.dispatchEvent(new Event('input', { bubbles: true }));
      await new Promise(resolve => setTimeout(resolve, 8));
    }
    return updates / 2;
  });
  note(`${rate} updates per second`);
  ok(rate > 1, 'results follow a moving slider');
});

ok(troubles.length === 0, 'the page complains about nothing');
for (const text of troubles.slice(0, 8)) note(text);
await browser.close();
await server.remove();
finish();
