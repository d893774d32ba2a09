// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths in inches: what a figure, a readout, a number and a saved table say is what they say in mm, by 25.4.
import { readFile } from 'node:fs/promises';
import { LOOSE, Server, chapter, finish, knownPage, ok, openBrowser, settled } from './harness.mjs';

const PAIR =
  'gear_pair.pinion_teeth=23&gear_pair.gear_teeth=61&gear_pair.normal_module_mm=4&gear_pair.helix_angle_deg=24&' +
  'gear_pair.face_width_mm=44&modification.pinion.left.tip_relief_um=18&' +
  'modification.pinion.left.tip_relief_start_mm=3&' +
  'modification.pinion.left.lead_crowning_um=6&modification.pinion.right.tip_relief_um=18&' +
  'modification.pinion.right.tip_relief_start_mm=3';
const PER_INCH = 25.4;

const server = await Server.start();
const browser = await openBrowser();
const { page, troubles } = await knownPage(browser, { viewport: { width: 1400, height: 1000 } });

const figure = title =>
  page.locator('section.figure', { has: page.getByRole('heading', { name: title }) }).first();
const number = text => Number(text.replace('−', '-'));
/** Within what the digits of either leave open. */
const agree = (metric, inch, part = 0.01) => Math.abs(inch * PER_INCH - metric) <= part * Math.abs(metric) + 1e-9;

/** What a menu of a figure saves, as lines without the remarks. */
async function saved(title, kind) {
  await figure(title).getByRole('button', { name: /: menu$/ }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('menuitem', { name: `Save as ${kind}` }).click(),
  ]);
  return readFile(await download.path(), 'utf8');
}
const rowsOf = text =>
  text
    .split('\n')
    .filter(line => line && !line.startsWith('#'))
    .map(line => line.split(','));

/** Everything that is looked at, in the units of now. */
async function look() {
  const orders = figure('Loaded TE');
  await orders.scrollIntoViewIfNeeded();
  const readOut = async () => {
    await orders.locator('.figure-body').focus();
    await page.keyboard.press('Home');
    return orders.locator('.tip').innerText();
  };
  const contact = figure('Contact pressure');
  await contact.scrollIntoViewIfNeeded();
  const box = await contact.locator('canvas').boundingBox();
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 0.4 * box.height);
  await contact.locator('.tip').waitFor();
  const tip = await contact.locator('.tip').innerText();
  await page.mouse.move(1, 1);
  const headline = page.locator('.number-cell').first();
  return {
    module: number(await page.getByLabel(/^Module/).inputValue()),
    headline: number(await headline.locator('.value').innerText()),
    headlineUnit: (await headline.locator('.unit').innerText()).trim(),
    heading: await orders.locator('h3').innerText(),
    reading: await readOut(),
    said: await orders.locator('.figure-body').getAttribute('aria-label'),
    tip,
    te: rowsOf(await saved('Loaded TE', 'CSV')),
    profile: rowsOf(await saved('Profile modification', 'CSV')),
    picture: await saved('Profile modification', 'SVG'),
    stiffness: rowsOf(await saved('Mesh stiffness', 'CSV')),
    strip: await page.locator('.sensitivity').innerText(),
  };
}

/** @type {Awaited<ReturnType<typeof look>>} */ let metric;
/** @type {Awaited<ReturnType<typeof look>>} */ let inch;

await chapter('in mm', async () => {
  await page.goto(`${server.address}#design?from=narrow&${PAIR}&${LOOSE}`);
  await settled(page);
  await page.waitForFunction(() => /µm/.test(document.querySelector('.sensitivity b')?.textContent ?? ''));
  metric = await look();
  ok(metric.headlineUnit === 'µm' && /µm/.test(metric.heading), 'numbers and headings are in micrometres at first');
});

await chapter('in inches', async () => {
  await page.getByLabel('Lengths in').selectOption('inch');
  await page.waitForFunction(() => /thou/.test(document.querySelector('.sensitivity b')?.textContent ?? ''));
  inch = await look();
  ok(agree(metric.module, inch.module, 1e-5), 'the form is in inches, with the same module');
  ok(
    inch.headlineUnit === 'thou' && agree(metric.headline, inch.headline),
    `a number at the top is in thou: ${inch.headline}`,
  );
  ok(/thou$/.test(inch.heading), `an axis is in thou: ${inch.heading}`);
  const last = text => number(/([−\d.]+)\s*$/.exec(text)?.[1] ?? 'NaN');
  const [before, after] = [last(metric.reading), last(inch.reading)];
  ok(agree(before, after, 0.002), `a readout is in thou: ${before}, ${after}`);
  ok(/ in thou: /.test(inch.said), 'the sentence about a figure is in thou');
  const radius = text => number(/pinion radius, (?:mm|in)\s+([\d.]+)/.exec(text)?.[1] ?? 'NaN');
  ok(
    /radius, in\b/.test(inch.tip) && agree(radius(metric.tip), radius(inch.tip), 1e-3),
    'a place on a flank is in inches',
  );
  ok(!/µm|\bmm\b/.test(inch.strip), 'the strip of sensitivities has no unit of mm');
});

await chapter('what is saved', async () => {
  const head = ({ te }) => te[0].at(-1);
  ok(
    /\(µm\)"?$/.test(head(metric)) && /\(thou\)"?$/.test(head(inch)), `the head of a column is in thou: ${head(inch)}`,
  );
  const middle = Math.floor(metric.te.length / 3);
  ok(agree(Number(metric.te[middle][1]), Number(inch.te[middle][1]), 1e-4), 'a number of this column is converted');
  ok(inch.te[middle][0] === metric.te[middle][0], 'the mesh cycle beside it is not converted');
  ok(/\(in\)$/.test(inch.profile[0][0]) && /\(thou\)$/.test(inch.profile[0][1]), 'a table of two units names both');
  const tip = metric.profile.length - 1;
  ok(
    [0, 1].every(k => agree(Number(metric.profile[tip][k]), Number(inch.profile[tip][k]), 1e-4)),
    'both columns of this table are converted',
  );
  ok(/thou/.test(inch.picture) && !/µm|\bmm\b/.test(inch.picture), 'a picture is in thou');
  ok(JSON.stringify(inch.stiffness) === JSON.stringify(metric.stiffness), 'a stiffness in N/µm is not converted');
});

/** A file that the design's menu saves. */
async function fromMenu(name) {
  await page.locator('.design-button').click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('.design-menu button', { hasText: name }).first().click(),
  ]);
  return readFile(await download.path(), 'utf8');
}

await chapter('files of the service', async () => {
  const points = await fromMenu('Export flank points');
  ok(/x_in,/.test(points) && !/_mm|_um/.test(points.slice(0, 400)), 'the points of the flanks are in inches');
  const report = await fromMenu('Save the report to sign');
  ok(
    /<code>\/gear_pair\/face_width_in<\/code>/.test(report) && !/>mm</.test(report),
    'the report to sign is in inches',
  );
  ok(/roll length, in/.test(report) && /deviation, thou/.test(report), 'the charts of the report are in inches');
});

await chapter('and back', async () => {
  await page.getByLabel('Lengths in').selectOption('mm');
  await page.waitForFunction(() => /µm/.test(document.querySelector('.sensitivity b')?.textContent ?? ''));
  const again = await look();
  ok(
    JSON.stringify([again.te, again.profile]) === JSON.stringify([metric.te, metric.profile]),
    'the tables in mm come back as they were',
  );
});

await chapter('sentences', async () => {
  // thirteen teeth are undercut; then a bore that leaves no rim
  await page.goto('about:blank');
  const few = PAIR.replace('pinion_teeth=23', 'pinion_teeth=13');
  await page.goto(`${server.address}#design?from=narrow&${few}&${LOOSE}`);
  await page.getByLabel('Lengths in').selectOption('mm');
  const warnings = () => page.locator('.warning-list').evaluate(list => list.textContent);
  await page.waitForFunction(() => /undercut/.test(document.querySelector('.warning-list')?.textContent ?? ''));
  const said = await warnings();
  const radius = /up to the radius ([\d.]+) mm/.exec(said)?.[1];
  await page.getByLabel('Lengths in').selectOption('inch');
  const inches = /up to the radius ([\d.]+) in\b/.exec(await warnings())?.[1];
  ok(agree(Number(radius), Number(inches), 1e-4), `a warning is in inches: ${radius} mm, ${inches} in`);
  ok(!/\d (mm|um)\b/.test(await page.locator('.remark').first().innerText()), 'a remark at its field is in inches');
  await page.getByLabel('Lengths in').selectOption('mm');
  ok((await warnings()) === said, 'the warnings in mm come back as they were');
  await page.goto(`${server.address}#design?from=narrow&${PAIR}&gear_pair.pinion_bore_mm=95&${LOOSE}`);
  const fault = page.locator('.trouble').filter({ hasText: 'bore' }).first();
  await fault.waitFor();
  ok(/bore of 95 mm/.test(await fault.innerText()), `a fault is in mm: ${await fault.innerText()}`);
  await page.getByLabel('Lengths in').selectOption('inch');
  ok(/bore of 3\.7402 in/.test(await fault.innerText()), `the fault is in inches: ${await fault.innerText()}`);
});

await chapter('a gear of one’s own', async () => {
  await page.getByLabel('Lengths in').selectOption('inch');
  await page.getByRole('button', { name: 'Your own gear…' }).first().click();
  const dialog = page.locator('.own-gear-dialog');
  const asked = page.waitForRequest(request => /\/check/.test(request.url()));
  for (const [name, value] of [
    ['Teeth of the pinion', '19'],
    ['Teeth of the gear', '57'],
    ['Normal module', '0.25'],
    ['Helix angle', '25'],
    ['Face width of one end', '1.75'],
    ['Torque on the pinion', '900'],
    ['Speed of the pinion', '1200'],
  ])
    await dialog.getByLabel(name).fill(value);
  const body = (await asked).postData() ?? '';
  ok(/"normal_module_mm":6\.35\b/.test(body), 'what is typed is read in the unit that stands beside it');
  ok(/"face_width_mm":44\.45/.test(body), 'the face width is read in its unit');
});

ok(troubles.length === 0, `the page throws no errors: ${troubles.join('; ')}`);
await browser.close();
await server.remove();
finish();
