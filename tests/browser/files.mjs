// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are dropped on the page: of other programs, of this one, a grid on a flank, recordings on the rig.
import { readFile } from 'node:fs/promises';
import { COARSE, LOOSE, Server, WAIT, chapter, comes, drop, finish, ok, openBrowser, settled } from './harness.mjs';

const START = `#design?from=paper-case-a&${LOOSE}`;
const CASES = `${process.env.SOURCES}/tests/cases/exchange`;

const server = await Server.start();
const browser = await openBrowser();
const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce' });
await context.addInitScript(() => location.protocol === 'http:' && localStorage.setItem('easeoff-lead', 'away'));
const page = await context.newPage();
page.setDefaultTimeout(WAIT);
const troubles = [];
page.on('pageerror', error => troubles.push(error.message));

const fileOf = async name => ({ name, base64: (await readFile(`${CASES}/${name}`)).toString('base64') });
const dialog = page.locator('dialog.import-dialog');
const open = async (hash = START) => {
  await page.goto('about:blank');
  await page.goto(server.address + hash);
  await page.locator('.form-pane').waitFor();
};
const teeth = async () => [
  await page.getByLabel('Pinion teeth', { exact: true }).inputValue(),
  await page.getByLabel('Gear teeth', { exact: true }).inputValue(),
];

await chapter('a gear unit of two stages', async () => {
  await open();
  await settled(page);
  await drop(page, '.figure-pane', [await fileOf('two-stage-1.5.rexs')]);
  await dialog.getByRole('radio').nth(2).waitFor();
  const labels = await dialog.locator('label.choice').allInnerTexts();
  ok(
    labels.length === 3 && /23 and 71 teeth/.test(labels[0]) && /step-up/.test(labels[2]),
    'the dialog lists the pairs of the gear unit',
  );
  await dialog.getByRole('radio').nth(1).check();
  await dialog.getByText('19/58 teeth').waitFor();
  const text = await dialog.innerText();
  ok(/amounts are normal to the flank/.test(text), 'the dialog says what was assumed');
  ok(/gear_casing 2/.test(text), 'the dialog says what was not used');
  await page.setViewportSize({ width: 1280, height: 320 });
  const button = await dialog.getByRole('button', { name: 'Open this pair' }).boundingBox();
  ok(button.y + button.height < 320, 'the buttons of a long dialog stay in sight');
  await page.setViewportSize({ width: 1280, height: 800 });
  await dialog.getByRole('button', { name: 'Open this pair' }).click();
  await page.waitForFunction(() => /two-stage unit/.test(document.title));
  ok((await teeth()).join('/') === '19/58', 'the chosen pair is on the table');
  ok((await page.getByLabel(/^Torque of load case/).count()) === 3, 'the loads are those of the file');
  await page.goBack();
  await page.waitForFunction(() => /paper pair/.test(document.title));
  ok((await teeth()).join('/') === '17/44', 'the back button shows the design before');
});

await chapter('every kind of model', async () => {
  for (const [name, words] of [
    ['paper-case-b-2.0.0.rexsj', '17/44 teeth'],
    ['paper-case-b-1.4.rexsz', '17/44 teeth'],
    ['single-crowned-1.7.rexs', 'single helical'],
  ]) {
    await drop(page, '.form-pane', [await fileOf(name)]);
    await dialog.getByText(words).waitFor();
    ok(await dialog.getByRole('button', { name: 'Open this pair' }).isEnabled(), `${name} can be opened`);
    await dialog.getByRole('button', { name: 'Cancel' }).click();
  }
  const table = [
    'key;pinion;gear;unit',
    'gear_pair.teeth;23;61;',
    'gear_pair.normal_module_mm;5;;mm',
    'gear_pair.helix_angle_deg;30;;deg',
    'gear_pair.face_width_mm;50;;mm',
    '',
  ].join('\n');
  await drop(page, '.form-pane', [{ name: 'pair.csv', text: table }]);
  await dialog.getByText('23/61 teeth').waitFor();
  ok(
    /the load cases of the design on the table are kept/.test(await dialog.innerText()),
    'a table without loads keeps those of the design',
  );
  await dialog.getByRole('button', { name: 'Cancel' }).click();
});

await chapter('files with faults', async () => {
  await drop(page, '.form-pane', [await fileOf('errors-1.6.rexs')]);
  await dialog.locator('.fault').nth(2).waitFor();
  ok(/"inch"/.test(await dialog.innerText()), 'each fault is said');
  ok(await dialog.getByRole('button', { name: 'Open this pair' }).isDisabled(), 'a file with faults cannot be opened');
  await page.keyboard.press('Escape');
  await drop(page, '.form-pane', [{ name: 'notes.txt', text: 'no gear at all' }]);
  const fault = await dialog.locator('.fault').first().innerText();
  ok(/\w/.test(fault), `a file that is no model is refused in words: ${fault}`);
  await page.keyboard.press('Escape');
  ok(/paper pair/.test(await page.title()), 'a refused file leaves the design as it is');
});

await chapter('a design of this program', async () => {
  const design = await (await fetch(`${server.address}api/v1/examples/paper-case-b`)).json();
  const text = JSON.stringify({ ...design, name: 'mine', resolution: { ...design.resolution, ...COARSE } });
  await drop(page, '.figure-pane', [{ name: 'mine.json', text }]);
  await comes(
    page.waitForFunction(() => /^mine/.test(document.title)),
    'a design of this program is opened at once',
  );
  const flank = { tip_relief_exponent: 0, root_relief_exponent: 0, leading_end_relief_exponent: 0 };
  const ends = { left: flank, right: flank };
  const wrong = JSON.stringify({ ...design, modification: { pinion: ends, gear: ends } });
  await drop(page, '.figure-pane', [{ name: 'wrong.json', text: wrong }]);
  const notice = page.locator('.notice', { hasText: 'relief_exponent' });
  await notice.waitFor();
  const { y } = await notice.boundingBox();
  ok(
    y > 0 && / more\.$/.test(await notice.innerText()),
    'the first of many faults are told, and how many more there are',
  );
});

await chapter('a grid on a flank', async () => {
  await open();
  await settled(page);
  const before = await page.locator('.number-cell .value').first().innerText();
  const csv = 'u\\y, -30, 0, 30\n-5, 30, 25, 30\n0, 5, 0, 5\n5, 30, 25, 30\n';
  await drop(page, '.flank', [{ name: 'flank.csv', text: csv }]);
  await page.locator('.notice', { hasText: 'flank.csv' }).waitFor();
  await comes(
    page.waitForFunction(value => document.querySelector('.number-cell .value').textContent !== value, before),
    'a grid that is dropped on a flank changes the result',
  );
  await comes(page.getByText('This flank has a grid.').waitFor({ state: 'attached' }), 'the form tells of the grid');
  await page.getByRole('button', { name: 'Undo' }).click();
  await comes(
    page.waitForFunction(value => document.querySelector('.number-cell .value').textContent === value, before),
    'undo takes the grid back',
  );
});

/** What a figure saves as CSV: rows of cells. */
async function tableOf(title) {
  const figure = page.locator('.figure', { has: page.locator('h3', { hasText: title }) }).first();
  await figure.scrollIntoViewIfNeeded();
  await figure.getByRole('button', { name: /: menu$/ }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('menuitem', { name: 'Save as CSV' }).click(),
  ]);
  const text = await readFile(await download.path(), 'utf8');
  return text
    .trim()
    .split('\n')
    .filter(line => !line.startsWith('#'))
    .map(line => line.split(','));
}

await chapter('a grid is seen in charts and in space', async () => {
  const pair =
    'gear_pair.pinion_teeth=23&gear_pair.gear_teeth=61&gear_pair.normal_module_mm=5&gear_pair.helix_angle_deg=30&' +
    'gear_pair.face_width_mm=60';
  await open(`#design?from=narrow&${pair}&${LOOSE}`);
  await settled(page);
  await page.getByLabel('left = right').uncheck();
  await page.locator('.flank').getByText('gear', { exact: true }).first().click();
  const before = await tableOf('Ease-off');
  // nothing at mid face, nothing at the pitch point: profile and lead say nothing of it
  const csv = 'u\\y, -30, 0, 30\n-9, 0, 0, 0\n0, 0, 0, 0\n9, 0, 0, 40\n';
  await drop(page, '.flank', [{ name: 'corner.csv', text: csv }]);
  await page.waitForFunction(() => /corner|"csv"|grid/.test(decodeURIComponent(location.hash)));
  await page.locator('.figure', { hasText: 'thin: at both face ends' }).first().waitFor();
  const profile = page.locator('.figure', { has: page.locator('h3', { hasText: 'Profile modification' }) }).first();
  ok(await profile.getByLabel('gear', { exact: true }).isChecked(), 'the charts turn to the flank that is worked on');
  const after = await tableOf('Ease-off');
  const rows = after.slice(1).map(([end, s, eta, taken], i) => {
    return [end, Number(s), Number(eta), Number(taken) - Number(before[i + 1][3])];
  });
  const left = rows.filter(([end]) => end === 'left');
  const most = left.reduce((best, row) => (row[3] > best[3] ? row : best));
  const other = rows.filter(([end]) => end === 'right').reduce((best, row) => Math.max(best, Math.abs(row[3])), 0);
  ok(most[3] > 15 && most[2] > 29, `the ease-off is deepest where the grid is, ${most[3]} µm at eta ${most[2]} mm`);
  const middle = left.filter(([, , eta]) => Math.abs(eta) < 1e-6);
  ok(
    middle.length > 0 && middle.every(row => Math.abs(row[3]) < 0.05),
    'the ease-off has nothing of the grid in mid face',
  );
  const sOf = left.filter(([, , eta]) => eta > 29);
  ok(sOf[0][3] > sOf[sOf.length - 1][3] + 10, 'the ease-off is deeper at the tip of the gear, the root of the pinion');
  ok(other < 1e-9, `the ease-off of the other end has nothing of the grid: ${other}`);
});

await chapter('recordings on the rig', async () => {
  const plain = await (await fetch(`${server.address}api/v1/examples/paper-case-a`)).json();
  const design = { ...plain, resolution: { ...plain.resolution, ...COARSE } };
  const rig = { torque_Nm: 828, speed_rpm: 1200, turns: 60, speed_step: 0.5, rest_before_s: 0.5 };
  const record = () =>
    fetch(`${server.address}api/v1/rig`, {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify({ design, rig }),
    });
  let recording = await record();
  for (; recording.status === 202; recording = await record()) await page.waitForTimeout(300);
  await open(`#rig?from=paper-case-a&${LOOSE}`);
  await drop(page, '.drop', [{ name: 'modified_828Nm_1200rpm.csv', text: await recording.text() }]);
  await page.locator('.recording').waitFor();
  await page.getByRole('button', { name: 'Measure', exact: true }).click();
  const row = page.locator('section[aria-label="Measurements"] tbody tr');
  await row.first().waitFor();
  ok(/1499/.test(await row.first().innerText()), 'the longer one of two steady states is measured');
  const part = page.locator('section[aria-label="Part of the recording"]');
  await part.locator('.stretches li').first().waitFor();
  ok(/900 … 1500 rpm/.test(await part.innerText()), 'the stretch that was found is listed');
  await part.getByLabel('From, s').fill('0.6');
  await part.getByLabel('To, s').fill('1,9');
  await part.getByRole('button', { name: 'Measure these times' }).click();
  await row.nth(1).waitFor();
  await part.getByText('Measured: 0.6 … 1.899 s').waitFor();
  ok(
    /900\.0/.test((await row.allInnerTexts()).join(' ')),
    'the shorter one is measured by its times, with a result of its own',
  );
  await part.getByRole('button', { name: 'The whole recording' }).click();
  await part.getByText(/Measured: 2\.02 … 3\.[45]\d* s/).waitFor();
  await part.getByRole('button', { name: /with its run-up/ }).click();
  await comes(row.nth(2).waitFor(), 'the stretch is measured with what leads to the steady state, as a third result');
});

ok(troubles.length === 0, `nothing was complained about${troubles.length ? `: ${troubles.join('; ')}` : ''}`);
await browser.close();
await server.remove();
finish();
