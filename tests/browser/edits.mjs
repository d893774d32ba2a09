// SPDX-License-Identifier: GPL-3.0-or-later
// The first edit of any field of any example leads to a result, or to a fault at that field: every field of the form of
// the Design view, one edit at a time, taken back after each. A sample of them in `make check`; `make check-page-edits`
// (EASEOFF_EDITS=all) makes two kinds of edit of every field of every example, others in each example, so that all
// examples together make every kind; half an hour and more.
import { LOOSE, Server, WAIT, chapter, finish, note, ok, openBrowser, settled } from './harness.mjs';

const ALL = process.env.EASEOFF_EDITS === 'all';
const SAMPLE = 9; // of the usual check: one field of so many, one kind of edit for each
const EACH = 2; // kinds of edit of a field, of all fields
const KINDS = ['larger', 'smaller', 'much larger', 'empty', 'zero', 'negative', 'words'];

const server = await Server.start();
const browser = await openBrowser();
const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce' });
await context.addInitScript(() => {
  if (location.protocol !== 'http:') return;
  localStorage.setItem('easeoff-lead', 'away');
  // what the page asks for its figures: how much is under way, and how the last answer was
  const plain = window.fetch;
  window.asked = { open: 0, done: 0, bad: '', quiet: 0 };
  window.isQuiet = () => window.asked.open === 0 && performance.now() - window.asked.quiet > 100;
  window.fetch = async (...given) => {
    const address = String(given[0]?.url ?? given[0]);
    // what figures of their own ask beside it is nothing that an edit waits for, and takes most of the time
    if (/\/sweep|\/analyze\?(?!histories)/.test(address)) return new Promise(() => {});
    if (!/\/analyze\?histories/.test(address)) return plain(...given);
    window.asked.open += 1;
    try {
      const answer = await plain(...given);
      window.asked.done += 1;
      if (answer.status >= 500) window.asked.bad = `status ${answer.status}`;
      return answer;
    } finally {
      window.asked.open -= 1;
      window.asked.quiet = performance.now(); // the next one may follow at once
    }
  };
});
const page = await context.newPage();
page.setDefaultTimeout(WAIT);
const troubles = [];
page.on('pageerror', error => troubles.push(error.message));

/** Rows of the form that can be changed now: pointer, kind, what stands in it, what it offers. */
function fieldsOf() {
  return page.evaluate(given => {
    for (const group of document.querySelectorAll('.form-pane details')) group.open = true;
    return [...document.querySelectorAll('.form-pane [data-pointer]')]
      .filter(row => row.offsetParent && !row.querySelector('input, select').disabled)
      .filter(row => row.dataset.pointer.startsWith(given))
      .map(row => {
        const input = row.querySelector('input:not([type=range]), select');
        const kind = input.tagName === 'SELECT' ? 'choice' : input.type === 'checkbox' ? 'flag' : 'text';
        const options = kind === 'choice' ? [...input.options].map(option => option.value) : [];
        const number = input.classList.contains('number');
        const stated = input.value.trim() !== '';
        const value = kind === 'flag' ? String(input.checked) : input.value;
        return { pointer: row.dataset.pointer, kind, number, stated, value, placeholder: input.placeholder, options };
      });
  }, process.env.EASEOFF_FIELD ?? '');
}

/** What is typed for a kind of edit; undefined: it would change nothing. */
function textOf(field, kind) {
  if (kind === 'words') return 'about ten';
  if (kind === 'empty') return field.stated ? '' : undefined;
  if (kind === 'zero') return Number(field.value) === 0 && field.stated ? undefined : '0';
  const now = Number(field.stated ? field.value : field.placeholder);
  const whole = /teeth|positions|count|layers|rows|elements|harmonics|grade|samples|seed/.test(field.pointer);
  const from = Number.isFinite(now) && now !== 0 ? now : 1;
  const to = { larger: 1.3, smaller: 0.7, 'much larger': 20, negative: -1 }[kind] * from;
  if (kind === 'negative' && now < 0) return undefined;
  const text = String(whole ? Math.round(to) : Number(to.toPrecision(4)));
  return text === field.value ? undefined : text;
}

/** @returns {{ name: string, text?: string }[]} edits of a field */
function editsOf(field) {
  if (field.kind === 'flag') return [{ name: 'switched' }];
  if (field.kind === 'choice')
    return field.options.filter(option => option !== field.value).map(option => ({ name: 'chosen', text: option }));
  if (!field.number) return [{ name: 'another text', text: 'another' }];
  return KINDS.map(name => ({ name, text: textOf(field, name) })).filter(({ text }) => text !== undefined);
}

const rowOf = pointer => page.locator(`.form-pane [data-pointer="${pointer}"]`).first();

async function edit(field, { name, text }) {
  await page.evaluate(() => document.querySelectorAll('.form-pane details').forEach(group => (group.open = true)));
  const input = rowOf(field.pointer).locator('input:not([type=range]), select').first();
  if (name === 'switched') await input.click();
  else if (name === 'chosen') await input.selectOption(text);
  else {
    await input.fill(text);
    await input.press('Enter');
    await input.blur();
  }
}

/** How it ended: a result, or a fault and where it is; "" while neither is there. */
function outcomeOf([pointer, before, value]) {
  const view = document.querySelector('.design-view');
  const row = document.querySelector(`.form-pane [data-pointer="${CSS.escape(pointer)}"]`);
  const said = document.querySelector('.head-pane > .trouble:not([hidden])');
  const fault = row?.querySelector('.fault');
  const here = fault?.textContent && fault.getBoundingClientRect().height > 0;
  if (window.asked.bad) return { kind: 'failed', text: window.asked.bad };
  if (view.classList.contains('refused')) {
    if (!said) return { kind: 'silent', text: 'nothing is said' };
    if (here) return { kind: 'here', text: fault.textContent };
    const places = [...document.querySelectorAll('.form-pane [data-pointer]')]
      .filter(each => each.querySelector('.fault')?.textContent)
      .map(each => each.dataset.pointer);
    return { kind: places.length ? 'elsewhere' : 'nowhere', text: `${places.join()} ${said.textContent}` };
  }
  const input = row?.querySelector('input:not([type=range]), select');
  if (input?.type === 'text' && input.value === value) return { kind: 'same', text: '' }; // what it was before
  const idle = window.isQuiet() && window.asked.done > before && !view.classList.contains('preparing');
  return idle ? { kind: 'result', text: '' } : null;
}

/** The banner names the field, and its name leads to it. */
async function leads(pointer) {
  const links = page.locator('.head-pane > .trouble button.link');
  for (let i = 0; i < (await links.count()); i++) {
    await links.nth(i).click();
    const there = await page.evaluate(
      where => document.activeElement?.closest('[data-pointer]')?.dataset.pointer === where,
      pointer,
    );
    if (there) return true;
  }
  return false;
}

async function undo(field) {
  await page.keyboard.press('Control+z');
  await page.waitForFunction(
    ([pointer, value]) => {
      const row = document.querySelector(`.form-pane [data-pointer="${CSS.escape(pointer)}"]`);
      const input = row?.querySelector('input:not([type=range]), select');
      const now = input?.type === 'checkbox' ? String(input.checked) : input?.value;
      const late = document.querySelector('.design-view.refused, .design-view.preparing');
      return now === value && window.isQuiet() && !late;
    },
    [field.pointer, field.value],
    { polling: 20 },
  );
}

/** What stands in a field and over the page, for whoever reads the log. */
function stateOf(pointer) {
  const row = document.querySelector(`.form-pane [data-pointer="${CSS.escape(pointer)}"]`);
  const { value } = row?.querySelector('input:not([type=range]), select') ?? {};
  const at = document.activeElement?.closest('[data-pointer]')?.dataset.pointer;
  const { className } = document.querySelector('.design-view');
  const said = document.querySelector('.head-pane > .trouble')?.textContent;
  return JSON.stringify({ value, at, className, said, asked: window.asked });
}

const counts = { result: 0, here: 0, same: 0 };
const wrong = [];

async function tryEdit(example, field, each) {
  const before = await page.evaluate(() => ((window.asked.bad = ''), window.asked.done));
  await edit(field, each);
  let outcome;
  try {
    const found = await page.waitForFunction(outcomeOf, [field.pointer, before, field.value], { polling: 20 });
    outcome = await found.jsonValue();
  } catch {
    outcome = { kind: 'nothing', text: `no answer in ${WAIT} ms` };
  }
  counts[outcome.kind] = (counts[outcome.kind] ?? 0) + 1;
  const words = `${example} ${field.pointer} ${each.name} ${JSON.stringify(each.text ?? '')}`;
  if (outcome.kind === 'here' && !(await leads(field.pointer))) wrong.push(`${words}: the banner does not lead there`);
  if (outcome.kind === 'same') return true;
  if (outcome.kind !== 'result' && outcome.kind !== 'here') wrong.push(`${words}: ${outcome.kind}: ${outcome.text}`);
  try {
    await undo(field);
  } catch {
    const state = await page.evaluate(stateOf, field.pointer);
    wrong.push(`${words}: undo does not bring back ${JSON.stringify(field.value)}: ${state}`);
    return false;
  }
  return true;
}

async function open(example) {
  await page.goto('about:blank');
  await page.goto(`${server.address}#design?from=${example}&${LOOSE}`);
  await settled(page);
  await page.waitForFunction(() => window.isQuiet());
}

/** The form once for every flank that can be turned to: all fields first, then those of the flank alone. */
async function eachFlank(act) {
  const flank = page.locator('.flank');
  await act(await fieldsOf());
  if (!ALL) return;
  for (const [first, second] of [['gear'], ['gear', 'coast'], ['pinion', 'coast']]) {
    await flank.getByText(first, { exact: true }).first().click();
    if (second) await flank.getByText(second, { exact: true }).first().click();
    await act((await fieldsOf()).filter(field => /^\/modification/.test(field.pointer)));
    await flank.getByText('drive', { exact: true }).first().click();
  }
}

const response = await fetch(`${server.address}api/v1/examples`);
const names = (await response.json()).items.map(item => item.name);
const wanted = new RegExp(process.env.EASEOFF_EXAMPLE ?? (ALL ? '' : '^single$'));
for (const [turn, example] of names.entries())
  await chapter(example, async () => {
    if (!wanted.test(example)) return;
    let [edits, fields, number] = [0, 0, 0];
    await open(example);
    await eachFlank(async all => {
      for (const field of all) {
        number += 1;
        if (!ALL && number % SAMPLE) continue;
        const kinds = editsOf(field);
        fields += 1;
        for (let k = 0; k < Math.min(kinds.length, ALL ? EACH : 1); k++) {
          edits += 1;
          const each = kinds[(number + EACH * turn + k) % kinds.length];
          if (await tryEdit(example, field, each)) continue;
          await open(example);
          await fieldsOf();
        }
      }
    });
    note(`${example}: ${edits} edits of ${fields} fields`);
    ok(edits > (ALL ? 300 : 5), `${example} has ${edits} edits`);
  });

note(JSON.stringify(counts));
for (const text of wrong) note(text);
ok(wrong.length === 0, 'each edit leads to a result, or to a fault at its field');
ok(troubles.length === 0, `the page throws no errors: ${troubles.join('; ')}`);
await browser.close();
await server.remove();
finish();
