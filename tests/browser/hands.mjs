// SPDX-License-Identifier: GPL-3.0-or-later
// What hands do to the page: type, erase, delete, switch, undo, store, print, save; each once went wrong.
import { readFile } from 'node:fs/promises';
import { inflateSync } from 'node:zlib';
import * as harness from './harness.mjs';

const { COARSE, LOOSE, Server, chapter, comes, finish, note, ok, openBrowser } = harness;

const START = `#design?from=paper-case-a&${LOOSE}`;
const { WAIT } = harness;
const PAUSE = 700; // ms after which a typed value has been taken

const server = await Server.start();
const browser = await openBrowser();
const context = await browser.newContext({
  viewport: { width: 1280, height: 800 },
  reducedMotion: 'reduce',
  acceptDownloads: true,
  permissions: ['clipboard-read', 'clipboard-write'],
});
await context.addInitScript(() => location.protocol === 'http:' && localStorage.setItem('easeoff-lead', 'away'));
const page = await context.newPage();
page.setDefaultTimeout(WAIT);
const troubles = [];
for (const each of [page]) each.on('pageerror', error => troubles.push(error.message));

const rest = ms => new Promise(resolve => setTimeout(resolve, ms));
const field = (name, where = page) =>
  where.getByLabel(name, { exact: true }).and(where.locator('input[type=text]')).first();
const torque = i => field(`Torque of load case ${i}`);
const banner = page.locator('.design-view > .head-pane > .trouble, .trouble').first();
const settled = (where = page) => harness.settled(where);
/** Opens an address afresh. */
const open = async (hash = START, where = page) => {
  await where.goto('about:blank');
  await where.goto(server.address + hash);
  await where.locator('.form-pane input').first().waitFor();
};
const api = async (path, method = 'GET', body) => {
  const response = await fetch(`${server.address}api/v1/${path}`, {
    method,
    headers: body ? { 'content-type': 'application/json' } : {},
    body: body ? JSON.stringify(body) : undefined,
  });
  return response.json();
};
const hash = () => decodeURIComponent(new URL(page.url()).hash);
const menu = async name => {
  await page.locator('.design-button').click();
  await page.locator('.design-menu').getByRole('button', { name }).first().click();
};
const figureMenu = async (title, item) => {
  const figure = page.locator('.figure', { has: page.locator('h3', { hasText: title }) }).first();
  await figure.scrollIntoViewIfNeeded();
  await figure.getByRole('button', { name: /: menu$/ }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('menuitem', { name: item }).click(),
  ]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
};

/** Rows of pixels of a PNG as browsers write it: 8 bits, no interlace. */
function pixelsOf(bytes) {
  const [width, height, kind] = [bytes.readUInt32BE(16), bytes.readUInt32BE(20), bytes[25]];
  const parts = [];
  for (let at = 8; at < bytes.length;) {
    const length = bytes.readUInt32BE(at);
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + length));
    at += 12 + length;
  }
  const raw = inflateSync(Buffer.concat(parts));
  const step = kind === 6 ? 4 : 3;
  const line = width * step;
  const out = Buffer.alloc(line * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (line + 1)];
    for (let x = 0; x < line; x++) {
      const left = x >= step ? out[y * line + x - step] : 0;
      const up = y > 0 ? out[(y - 1) * line + x] : 0;
      const corner = x >= step && y > 0 ? out[(y - 1) * line + x - step] : 0;
      const guess = left + up - corner;
      const [a, b, c] = [Math.abs(guess - left), Math.abs(guess - up), Math.abs(guess - corner)];
      const paeth = a <= b && a <= c ? left : b <= c ? up : corner;
      const add = [0, left, up, (left + up) >> 1, paeth][filter];
      out[y * line + x] = (raw[y * (line + 1) + 1 + x] + add) & 255;
    }
  }
  return { width, height, step, out };
}

/** Pixels that are coloured: neither paper nor grey, as curves are. */
function inkOf({ width, height, step, out }) {
  let count = 0;
  for (let at = 0; at < width * height * step; at += step) {
    const [r, g, b] = [out[at], out[at + 1], out[at + 2]];
    if (Math.max(r, g, b) - Math.min(r, g, b) > 60) count += 1;
  }
  return count;
}

await chapter('a field keeps what is typed', async () => {
  await open();
  await settled();
  const first = torque(1);
  await first.click();
  await page.keyboard.press('Control+a');
  await page.keyboard.type('1e9');
  ok((await first.getAttribute('aria-invalid')) === 'true', 'a torque out of range is refused');
  await page.keyboard.press('Control+a');
  await page.keyboard.type('750', { delay: 60 });
  ok((await first.inputValue()) === '750', `a refused text is overtyped: ${await first.inputValue()}`);
  await rest(PAUSE);
  ok(/"torque_Nm":750/.test(hash()), 'what is typed after a refused text is computed');
  const module = field('Module');
  await module.click();
  await page.keyboard.press('Control+a');
  await page.keyboard.press('Backspace');
  await page.keyboard.type('6,0', { delay: 60 });
  ok(
    (await module.inputValue()) === '6,0',
    `a number typed after erasing stands as it was typed: ${await module.inputValue()}`,
  );
  await page.keyboard.press('Tab');
  ok((await module.inputValue()) === '6', 'a value is written as values are when the field is left');
  await page.keyboard.press('Control+z');
  await page.waitForFunction(() => !/750/.test(location.hash));
  ok((await first.inputValue()) === '621', 'undo takes the torque back');
});

await chapter('every kind of field', async () => {
  const cases = [
    ['Pinion teeth', '0', 'outside'],
    ['Helix angle', 'abc', 'Not a number'],
    ['Face width', '', 'needed'],
  ];
  for (const [name, text, fault] of cases) {
    const input = field(name);
    const before = await input.inputValue();
    await input.fill(text);
    await page.locator('.field .fault', { hasText: fault }).first().waitFor();
    await page.keyboard.press('Control+z');
    ok((await input.inputValue()) === before, `${name}: undo gives up what is no value`);
    ok(await banner.isHidden(), `${name}: the fault ends with the undo`);
  }
  const tip = field('Tip relief');
  await tip.fill('0.014 mm');
  await tip.press('Enter');
  await tip.blur();
  ok((await tip.inputValue()) === '14', 'a unit of the same kind is taken');
  await tip.fill('12 kg');
  ok(
    /unit here is µm/.test(await page.locator('.field .fault:not(:empty)').first().innerText()),
    'a unit of another kind is not taken',
  );
  await tip.fill('1,000');
  ok(
    /1000 or 1\.0/.test(await page.locator('.field .fault:not(:empty)').first().innerText()),
    'what can be read in two ways is asked about',
  );
  await page.keyboard.press('Control+z');
  await field('Pinion teeth').fill('0');
  await field('Pinion teeth').blur();
  await banner.waitFor();
  await page.keyboard.press('Control+z');
  ok((await field('Pinion teeth').inputValue()) === '17', 'undo from elsewhere gives up what is no value too');
  await page.locator('summary', { hasText: 'More of the pair' }).click();
  const name = field('Name');
  await name.fill('歯車 <b>HTML</b>');
  await rest(PAUSE);
  ok(/<b>HTML/.test(await page.title()), 'a name counts as it is typed, hostile or not');
  await page.keyboard.press('Control+z');
});

await chapter('a fault belongs to its row', async () => {
  await open();
  await settled();
  await torque(3).fill('0');
  await banner.waitFor();
  ok(/Torque of load case 3/.test(await banner.innerText()), 'the banner names the field');
  await page.locator('.figure-pane').click({ position: { x: 5, y: 5 } });
  await banner.getByRole('button').first().click();
  ok(await torque(3).evaluate(input => input === document.activeElement), 'the banner leads to the field');
  await page.getByRole('button', { name: 'Remove load case 3' }).click();
  await banner.waitFor({ state: 'hidden' });
  ok((await page.locator('.chip').count()) <= 3, 'the row takes its fault with it');
  await comes(
    page.waitForFunction(() => document.querySelectorAll('.chip').length === 2),
    'the page goes on with two load cases',
  );
  await torque(2).fill('0');
  await banner.waitFor();
  await page.getByRole('button', { name: 'Remove load case 1' }).click();
  ok((await torque(1).inputValue()) === '0', 'what is typed in another row moves with it');
  await torque(1).fill('800');
  await comes(banner.waitFor({ state: 'hidden' }), 'a fault that moved with its row can be mended there');
});

await chapter('a fault belongs to its member and end', async () => {
  await open();
  await settled();
  const tip = field('Tip relief');
  await tip.fill('-7');
  await banner.waitFor();
  await page.locator('.flank').getByText('gear', { exact: true }).click();
  await comes(banner.waitFor({ state: 'hidden' }), 'a fault ends when the member of its field leaves the page');
  await page.locator('.flank').getByText('pinion', { exact: true }).click();
  ok((await field('Tip relief').inputValue()) === '14', 'the field shows the design again');
  await page.getByLabel('left = right').uncheck();
  await field('Tip relief').fill('-7');
  await banner.waitFor();
  await page.locator('.flank').getByText('right', { exact: true }).click();
  await comes(banner.waitFor({ state: 'hidden' }), 'a fault ends when the end of its field leaves the page');
});

await chapter('a fault of the service is shown and led to', async () => {
  await open();
  await settled();
  const folded = await page.locator('details.more[open]').count();
  await field('Pinion teeth').fill('5');
  await banner.waitFor();
  ok((await page.locator('details.more[open]').count()) === folded, 'nothing unfolds by itself');
  const lead = banner.getByRole('button').first();
  if (await lead.count()) {
    await lead.click();
    ok(await page.evaluate(() => document.activeElement?.tagName === 'INPUT'), 'the banner leads to its field');
  } else ok(/\w/.test(await banner.innerText()), 'a fault without a field is said in words');
  const weight = await page
    .locator('.figure-value')
    .first()
    .evaluate(each => getComputedStyle(each).fontWeight);
  ok(Number(weight) < 600, 'old numbers are not as bold as those that hold');
});

await chapter('a fault is said where the edit was', async () => {
  await open();
  await settled();
  await page.locator('summary', { hasText: 'Supports' }).click();
  await field('Load stiffness').fill('5e5');
  await field('Load stiffness').press('Enter');
  await banner.waitFor();
  const row = page.locator('.field', { has: field('Load stiffness') });
  ok(/inertia/.test(await row.locator('.fault').innerText()), 'a stiffness without its inertia is told at its row');
  await field('Load stiffness').blur();
  await banner.getByRole('button', { name: 'Load stiffness' }).click();
  ok(
    await field('Load stiffness').evaluate(input => input === document.activeElement),
    'the banner leads to the stiffness',
  );
  await banner.getByRole('button', { name: 'Load inertia' }).click();
  ok(
    await field('Load inertia').evaluate(input => input === document.activeElement),
    'the banner leads to the field that is missing',
  );
  await page.keyboard.press('Control+z');
  await banner.waitFor({ state: 'hidden' });
});

await chapter('the start of a relief in any way', async () => {
  await open();
  await settled();
  const row = page.locator('.field', { has: page.getByLabel('Tip relief start as') });
  const start = () => row.locator('input[type=text]').inputValue();
  const others = row.locator('.start-others');
  await page.waitForFunction(() => /diameter/.test(document.querySelector('.start-others')?.textContent ?? ''));
  const rack = Number(await start());
  const numbers = text =>
    Object.fromEntries([...text.matchAll(/([a-z ]+) ([\d.]+)/g)].map(([, name, value]) => [name.trim(), +value]));
  const at = numbers(await others.innerText());
  const { geometry: g } = await (
    await fetch(`${server.address}api/v1/check`, {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify({ ...(await api('examples/paper-case-a')), resolution: { ...COARSE } }),
    })
  ).json();
  const roll = g.tangent_length_mm[0] + rack / g.rack_factor;
  const base = g.base_radius_mm[0];
  const diameter = 2 * Math.hypot(roll, base);
  ok(Math.abs(at.diameter / diameter - 1) < 1e-5, `the diameter of a start is that of its roll: ${at.diameter}`);
  ok(Math.abs(at['length of roll'] / roll - 1) < 1e-5, 'the length of roll is that of the same place');
  ok(
    Math.abs(at['roll angle'] / ((roll / base) * (180 / Math.PI)) - 1) < 1e-5,
    'the roll angle is that of the same place',
  );
  const value = await page.locator('.number-cell .value').first().innerText();
  for (const way of ['diameter_mm', 'roll_angle_deg', 'length_mm', 'roll_length_mm', 'start_mm']) {
    await page.getByLabel('Tip relief start as').selectOption(way);
    await page.waitForFunction(key => decodeURIComponent(location.hash).includes(`tip_relief_${key}`), way);
    await page.waitForFunction(
      text =>
        !document.querySelector('.design-view.refused') &&
        document.querySelector('.number-cell .value').textContent === text,
      value,
    );
  }
  ok(
    Math.abs(Number(await start()) - rack) < 1e-5,
    `the start is where it was after all ways round: ${await start()}, ${rack}`,
  );
  await page.keyboard.press('Control+z');
  ok(/length of roll/.test(await row.locator('select').evaluate(s => s.selectedOptions[0].text)), 'undo is one step');
});

await chapter('load cases are pasted', async () => {
  await open();
  await settled();
  await torque(1).click();
  await page.evaluate(() =>
    navigator.clipboard.writeText('torque\tspeed\tshare\n500\t1000\t0,25\n900\t1500\t0,5\n900\t3000\t0,25\n'),
  );
  await page.keyboard.press('Control+v');
  await page.waitForFunction(() => /"torque_Nm":500/.test(decodeURIComponent(location.hash)));
  ok((await page.locator('.load-cases tbody tr').count()) >= 3, 'rows of a spreadsheet become load cases');
  await page.waitForFunction(() => document.querySelectorAll('.chip').length === 3);
  await page.waitForFunction(() => /3000 rpm/.test(document.querySelector('.cases').textContent));
  const chips = await page.locator('.chip').allInnerTexts();
  ok(new Set(chips).size === 3 && chips.includes('500 N m'), `equal torques are told apart: ${chips.join('; ')}`);
});

await chapter('undo knows whose design it is', async () => {
  await open();
  await settled();
  await menu('Store as new');
  await page.waitForFunction(() => /[?&]id=\d/.test(location.hash));
  const a = /[?&]id=(\d+)/.exec(hash())[1];
  ok(!(await page.locator('.design-name').innerText()).includes('*'), 'a stored design has no mark');
  await field('Tip relief').fill('11');
  await field('Tip relief').press('Enter');
  ok((await page.locator('.design-name').innerText()).includes('*'), 'a changed design has a mark');
  await menu('Store as new');
  await page.waitForFunction(old => !location.hash.includes(`id=${old}`), a);
  const b = /[?&]id=(\d+)/.exec(hash())[1];
  await page.locator('.design-button').click();
  await page.locator('.design-menu .menu-row button').last().waitFor();
  await page
    .locator('.design-menu .menu-row')
    .nth((await api('designs')).items.findIndex(item => String(item.id) === a))
    .getByRole('button')
    .first()
    .click();
  await page.waitForFunction(id => location.hash.includes(`id=${id}`), a);
  await page.keyboard.press('Control+z');
  await page.waitForFunction(id => location.hash.includes(`id=${id}`), b);
  ok((await field('Tip relief').inputValue()) === '11', 'undo after opening shows the design before');
  await field('Tip relief').fill('12');
  /* the notice of "Store as new" may still be there */
  const stored = page.waitForResponse(response => response.request().method() === 'PUT');
  await page.keyboard.press('Control+s');
  await stored;
  await page.locator('.notice', { hasText: 'Stored' }).waitFor();
  const [first, second] = [await api(`designs/${a}`), await api(`designs/${b}`)];
  ok(
    first.design.modification.pinion.left.tip_relief_um === 14 &&
      second.design.modification.pinion.left.tip_relief_um === 12,
    'storing stores the design that was opened, with what was just typed',
  );
});

await chapter('two change one design', async () => {
  const id = /[?&]id=(\d+)/.exec(hash())[1];
  const other = await context.newPage();
  await open(`#design?id=${id}`, other);
  await settled(other);
  await field('Tip relief', other).fill('13');
  await other.keyboard.press('Control+s');
  await other.locator('.notice', { hasText: 'Stored' }).waitFor();
  await other.close();
  await field('Tip relief').fill('9');
  await page.keyboard.press('Control+s');
  const question = page.locator('dialog.question');
  await question.waitFor();
  ok(/Tip relief/.test(await question.innerText()) && /13/.test(await question.innerText()), 'the difference is shown');
  await question.getByRole('button', { name: 'Store mine as a new design' }).click();
  await page.waitForFunction(old => !location.hash.includes(`id=${old}&`) && !location.hash.endsWith(`id=${old}`), id);
  ok(
    (await api(`designs/${id}`)).design.modification.pinion.left.tip_relief_um === 13,
    'their design stays, and mine is kept too',
  );
});

await chapter('back after opening', async () => {
  await open();
  await settled();
  await menu(/paper-case-b/);
  await page.waitForFunction(() => /from=paper-case-b/.test(location.hash));
  ok(!(await page.locator('.design-name').innerText()).includes('*'), 'an example that is as it was has no mark');
  await page.goBack();
  await page.waitForFunction(() => /from=paper-case-a/.test(location.hash));
  ok(/paper pair/.test(await page.title()), 'the back button shows the design before');
});

await chapter('a link shows the same', async () => {
  const against = page.getByLabel('Compare with');
  await open(`${START}&modification.pinion.left.tip_relief_um=9&modification.pinion.right.tip_relief_um=9`);
  await settled();
  await against.selectOption({ label: 'pin this design' });
  await field('Tip relief').fill('20');
  await field('Tip relief').press('Enter');
  await field('From, rpm').fill('600');
  await field('To, rpm').fill('3000');
  await field('To, rpm').press('Enter');
  await page.getByLabel('Number that is varied').selectOption({ label: 'Stagger' });
  await page.locator('.chip', { hasText: '621 N m' }).click();
  await page.waitForFunction(() => /speeds=600-3000/.test(location.hash) && /case=1/.test(location.hash));
  const elsewhere = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  elsewhere.setDefaultTimeout(WAIT);
  await elsewhere.goto(page.url());
  await settled(elsewhere);
  // a figure that comes after the numbers
  await elsewhere.getByLabel('Number that is varied').waitFor({ state: 'attached' });
  const seen = await elsewhere.evaluate(() => ({
    pin: document.querySelector('.pin select').selectedOptions[0].textContent,
    speeds: [...document.querySelectorAll('.range-fields input')].slice(0, 2).map(input => input.value),
    varied: document.querySelector('select[aria-label="Number that is varied"]').selectedOptions[0].textContent,
    load: document.querySelector('.chip:has(input:checked)').textContent,
  }));
  ok(
    JSON.stringify(seen) ===
      JSON.stringify({ pin: 'pinned 1', speeds: ['600', '3000'], varied: 'Stagger', load: '621 N m' }),
    `the link shows what is pinned, swept and chosen: ${JSON.stringify(seen)}`,
  );
  const numbers = where => where.locator('.number-cell .delta').allInnerTexts();
  await comes(
    elsewhere.waitForFunction(
      wanted => document.querySelector('.number-cell .delta').textContent === wanted,
      (await numbers(page))[0],
    ),
    'the link shows the same gain over the pinned design',
  );
  await elsewhere.context().close();
  await menu('paper-case-b');
  await page.waitForFunction(() => /from=paper-case-b/.test(location.hash));
  await page.goBack();
  await page.waitForFunction(() => /tip_relief_um=20/.test(location.hash));
  await settled();
  ok(
    (await field('Tip relief').inputValue()) === '20' && /pin=pinned/.test(hash()),
    'the back button shows the pinned design again',
  );
});

await chapter('links that lead nowhere', async () => {
  for (const [link, words] of [
    ['#design?id=9999', /9999 is not on this server/],
    ['#design?from=nope', /nope/],
  ]) {
    await open(link);
    const question = page.locator('dialog.question');
    await question.waitFor();
    ok(words.test(await question.innerText()), `${link} says that there is nothing`);
    await question.getByRole('button', { name: /Go on/ }).click();
  }
  await open(`#optimize?from=paper-case-a&job=777&${LOOSE}`);
  await comes(page.getByText('Search 777 is not on this server').waitFor(), 'a link to a missing search says so');
  await open(`#compare?from=paper-case-a&items=current,job:99&${LOOSE}`);
  await comes(
    page.locator('.comparison', { hasText: 'is not on this server' }).waitFor(),
    'a link to a comparison with a missing design says so',
  );
});

await chapter('menus keep the focus', async () => {
  await open();
  await settled();
  await page.locator('.design-button').focus();
  await page.keyboard.press('Enter');
  await page.locator('.design-menu .menu-row').first().waitFor();
  await rest(200);
  ok(
    await page.evaluate(() => document.activeElement?.closest('.design-menu') !== null),
    'the menu keeps the focus while it is filled again',
  );
  await page.keyboard.press('Escape');
  ok((await page.locator('.design-menu').count()) === 0, 'Escape closes the menu');
  ok(
    await page.evaluate(() => document.activeElement?.matches('.design-button')),
    'the button has the focus after Escape',
  );
});

await chapter('pictures of curves have curves', async () => {
  await open();
  await settled();
  for (const title of ['Loaded TE', 'Mesh stiffness', 'Vibration over speed', 'Ease-off']) {
    await page.locator('.figure h3', { hasText: title }).first().scrollIntoViewIfNeeded();
    if (title === 'Vibration over speed') await page.locator('.figure.wide:not(.waiting) .uplot').nth(1).waitFor();
    const { name, bytes } = await figureMenu(title, 'Save as PNG');
    const picture = pixelsOf(bytes);
    const ink = inkOf(picture);
    ok(picture.width >= 1200 && ink > 1500, `the picture of ${title} is ${picture.width} px wide with ${ink} coloured`);
    ok(/^paper-pair/.test(name), `${name} says whose it is`);
  }
  const { bytes } = await figureMenu('Loaded TE', 'Save as SVG');
  const text = bytes.toString();
  ok(
    (text.match(/<path/g) ?? []).length > 12 && /paper pair/.test(text) && /828 N m/.test(text),
    'a figure is saved as SVG with curves, legend and design',
  );
});

await chapter('a slider is felt in every figure', async () => {
  await open();
  await settled();
  const slider = page.locator('.field.slider input[type=range]').first();
  const shown = ['Loaded TE', 'Mesh stiffness', 'Load sharing', 'Contact pressure'];
  const pictures = async () => {
    const each = [];
    for (const title of shown) each.push((await figureMenu(title, 'Save as PNG')).bytes.toString('base64'));
    return each;
  };
  const before = await pictures();
  const step = page.waitForResponse(response => response.url().includes('overview'));
  await slider.evaluate(each => {
    each.value = String(Number(each.min) + 0.7 * (Number(each.max) - Number(each.min)));
    each.dispatchEvent(new Event('input', { bubbles: true }));
  });
  const size = (await (await step).body()).length;
  ok(size <= 60000, `a step's answer has ${size} bytes`);
  await rest(500);
  const waiting = await page.locator('.figure.waiting h3').allInnerTexts();
  const later = /^(Vibration|Root stress|Flash temperature|Specific film thickness|Sliding speed)| over /;
  ok(
    waiting.length > 0 && waiting.every(title => later.test(title)),
    `histories, sweeps and what the rating holds alone wait for the slider: ${waiting.join(', ')}`,
  );
  (await pictures()).forEach((picture, i) => ok(picture !== before[i], `${shown[i]} has moved`));
  const whole = page.waitForResponse(response => response.url().includes('histories=1'));
  await slider.evaluate(each => each.dispatchEvent(new Event('change', { bubbles: true })));
  await whole;
  const all = page.waitForFunction(() => !document.querySelector('.figure.waiting'), null, { timeout: WAIT });
  ok(
    await all.then(
      () => true,
      () => false,
    ),
    'what waited comes when the slider rests',
  );
  await page.keyboard.press('Control+z');
});

await chapter('legends switch', async () => {
  const figure = page.locator('.figure', { has: page.locator('h3', { hasText: 'Loaded TE' }) }).first();
  await figure.scrollIntoViewIfNeeded();
  const before = inkOf(pixelsOf((await figureMenu('Loaded TE', 'Save as PNG')).bytes));
  await figure.locator('.key', { hasText: '621 N m' }).click();
  const after = inkOf(pixelsOf((await figureMenu('Loaded TE', 'Save as PNG')).bytes));
  ok(after < before, 'a curve that is off is in no picture');
  await figure.locator('.key', { hasText: '621 N m' }).click();
  await figure.locator('.figure-body').focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  ok((await figure.locator('.tip:not([hidden]) .tip-row').count()) === 3, 'arrow keys read the curves');
});

await chapter('the report is whole wherever one has scrolled', async () => {
  await page.emulateMedia({ colorScheme: 'dark' });
  await open();
  await settled();
  await menu(/Print a report/);
  await page.locator('.report-state', { hasText: 'whole' }).waitFor();
  const titles = (await page.locator('.report-figure').allInnerTexts()).join('\n');
  for (const title of ['Loaded transmission error', 'over the speed', 'over the torque', 'Ease-off'])
    ok(titles.includes(title), `the report has ${title}`);
  const paper = await page
    .locator('.report')
    .first()
    .evaluate(each => getComputedStyle(each).backgroundColor);
  ok(paper === 'rgb(255, 255, 255)', 'the report is on white paper, whatever the screen has');
  ok(!/drag|click/.test(await page.locator('.report').first().innerText()), 'the report has no hints for a mouse');
  const pdf = await page.pdf({ format: 'A4', printBackground: true });
  const pages = (pdf.toString('latin1').match(/\/Type\s*\/Page\b/g) ?? []).length;
  ok(pages >= 3 && pages < 12, `the report prints at once on ${pages} pages`);
  await page.getByRole('button', { name: '← Back' }).click();
  await page.locator('.headline').waitFor();
  await page.emulateMedia({ colorScheme: 'light' });
});

await chapter('your own gear', async () => {
  await page.getByRole('button', { name: 'Your own gear…' }).first().click();
  const dialog = page.locator('dialog.own-gear-dialog');
  for (const [label, text] of [
    ['Teeth of the pinion', '20'],
    ['Teeth of the gear', '51'],
    ['Normal module', '4,5'],
    ['Helix angle', '25'],
    ['Face width of one end', '40 mm'],
    ['Torque on the pinion', '0.4 kN m'],
    ['Speed of the pinion', '1500'],
  ])
    await dialog.getByLabel(label).fill(text);
  await dialog.getByText('Assumed, until you state it').waitFor();
  ok(/Centre distance/.test(await dialog.innerText()), 'the dialog says what follows and what is assumed');
  await dialog.getByRole('button', { name: 'Compute it' }).click();
  await page.waitForFunction(() => /my gear/.test(document.title));
  ok((await torque(1).inputValue()) === '400', 'five numbers and a load are a design');
  ok((await field('Module').inputValue()) === '4.5', 'the numbers are as they were typed');
  // its teeth are finely meshed; nothing below waits for them
  await page.goto('about:blank');
  for (const job of (await api('jobs')).items)
    if (job.kind === 'prepare' && job.state !== 'done') await api(`jobs/${job.id}/cancel`, 'POST', {});
});

await chapter('a recording does not say its torque', async () => {
  await page.goto('about:blank');
  await page.goto(`${server.address}#rig?from=paper-case-a&${LOOSE}`);
  await page.locator('.drop').waitFor();
  const rows = Array.from({ length: 20000 }, (_, i) => [i / 20000, 0.36 * i, (0.36 * i * 17) / 44].join());
  await page.locator('.drop-box input[type=file]').setInputFiles({
    name: 'run-621.csv',
    mimeType: 'text/csv',
    buffer: Buffer.from(['t_s,a_deg,b_deg', ...rows].join('\n')),
  });
  const input = page.getByLabel('Torque of run-621.csv, N m');
  await input.waitFor();
  ok((await input.inputValue()) === '', 'the torque of a recording is empty where nobody has stated it');
  await page.getByRole('button', { name: 'Measure', exact: true }).click();
  await comes(
    page.getByText(/At which torque was it recorded\?/).waitFor(),
    'a recording without a torque is asked for it',
  );
});

await chapter('a preparation that others wait for', async () => {
  const wanted = `${START}&gear_pair.pinion_teeth=19`;
  const other = await (await browser.newContext()).newPage();
  other.setDefaultTimeout(WAIT);
  await open(wanted.replaceAll('layers=6', 'layers=20'), page);
  await open(wanted.replaceAll('layers=6', 'layers=20'), other);
  await other.locator('.preparing').waitFor();
  await field('Pinion teeth').fill('17');
  await field('Pinion teeth').press('Enter');
  await settled(other);
  ok(!/not possible/.test(await other.locator('.state').innerText()), 'a preparation is not ended by one that leaves');
  await other.context().close();
});

await chapter('the server goes away in a search', async () => {
  await open(`#optimize?from=paper-case-a&optimization.true_evaluations=4000&${LOOSE}`);
  await page.getByRole('button', { name: 'Start the search' }).click();
  await page.locator('.job-bar .progress').waitFor();
  const mean = page
    .locator('section[aria-label="Best so far"] tr', { hasText: 'Transmission error' })
    .locator('td')
    .nth(1);
  await page.waitForFunction(() =>
    /\d/.test(document.querySelector('section[aria-label="Best so far"] tbody tr td:nth-child(3)')?.textContent ?? ''),
  );
  const plain = await api('examples/paper-case-a');
  const design = { ...plain, resolution: { ...plain.resolution, ...COARSE }, modification: {} };
  const result = await (
    await fetch(`${server.address}api/v1/analyze?maps=0`, {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify(design),
    })
  ).json();
  const weighted = result.objectives.load_cases.reduce(
    (sum, row, i) => sum + row.peak_to_peak_um * result.load_cases[i].share,
    0,
  );
  const shown = Number(await mean.innerText());
  ok(Math.abs(shown / weighted - 1) < 0.01, `the duty-cycle mean is the mean of the load cases: ${shown}, ${weighted}`);
  server.process.kill('SIGKILL');
  await page.locator('.job-bar', { hasText: 'no connection' }).waitFor({ timeout: 10000 });
  ok(await page.locator('.away-banner').isVisible(), 'the page tells of a server that is away without being asked');
  await server.open();
  await page.locator('.away-banner').waitFor({ state: 'hidden' });
  const stop = page.getByRole('button', { name: 'stop', exact: true });
  await stop.hover({ force: true }); // it is drawn anew all the time
  await page.mouse.down();
  await rest(400); // a hand is slower than the bar
  await page.mouse.up();
  await comes(
    page.waitForFunction(() => /cancelled/.test(document.querySelector('.job-list tbody .job-state').textContent)),
    'a slow press of stop cancels the search',
  );
});

ok(troubles.length === 0, 'the page throws no errors');
for (const text of troubles.slice(0, 5)) note(text);
await browser.close();
await server.remove();
finish();
