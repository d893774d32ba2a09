// SPDX-License-Identifier: GPL-3.0-or-later
// A file of another program: which pairs are in it, what was assumed, left out and not used, before it is opened.
import { Refusal, ask } from '../base/api.js';
import { fill, h } from '../base/dom.js';
import { shownSentence } from '../base/units.js';

const LISTS = /** @type {[keyof Pick<Api.Import, 'assumed' | 'refused' | 'not_used' | 'notes'>, string][]} */ ([
  ['assumed', 'Left open by the file, and assumed'],
  ['refused', 'Modifications that a design cannot say'],
  ['not_used', 'Not used'],
  ['notes', 'Remarks'],
]);
const NO_LOAD = 'The file states no load; the load cases of the design on the table are kept.';

/** A design of this program, not of another. @param {unknown} document */
function isDesign(document) {
  const found = /** @type {{ gear_pair?: unknown, design?: { gear_pair?: unknown } } | null} */ (document);
  return Boolean(found?.gear_pair ?? found?.design?.gear_pair);
}

/** @param {string} text @returns {unknown} undefined: no JSON */
function readJson(text) {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}

/**
 * Attributes of one component on one line: "A of C" and "B of C" are "A, B of C".
 * @param {string[]} entries
 */
export function byComponent(entries) {
  /** @type {{ attributes: string, of: string }[]} */
  const lines = [];
  for (const entry of entries) {
    const at = entry.indexOf(' of ');
    const [attribute, of] = at < 0 ? [entry, ''] : [entry.slice(0, at), entry.slice(at)];
    const last = lines.at(-1);
    if (last && of && last.of === of) last.attributes += `, ${attribute}`;
    else lines.push({ attributes: attribute, of });
  }
  return lines.map(line => line.attributes + line.of);
}

class ImportDialog {
  /** @type {Api.Import | null} */ #found = null;
  #pair = 0;
  #turn = 0;

  /** @param {import('../app.js').App} app @param {File} file */
  constructor(app, file) {
    this.app = app;
    this.file = file;
    this.flank = h(
      'select',
      { 'aria-label': 'Loaded flank of the driver', onchange: () => this.read() },
      h('option', { value: '' }, 'as the file says'),
      h('option', { value: 'left' }, 'left'),
      h('option', { value: 'right' }, 'right'),
    );
    this.transverse = this.#flag('Amounts stand in the transverse section');
    this.reversed = this.#flag('A positive helix slope takes material off towards the datum face');
    this.body = h('.dialog-body', { role: 'status' }, h('p', null, 'The file is being read…'));
    this.open = h('button.primary', { type: 'button', disabled: true, onclick: () => this.#open() }, 'Open this pair');
    this.dialog = h(
      'dialog',
      { class: 'question import-dialog', 'aria-label': `Import ${file.name}` },
      h('h2', null, `Import ${file.name}`),
      this.body,
      h(
        '.dialog-foot',
        null,
        this.open,
        h('button', { type: 'button', onclick: () => this.dialog.close() }, 'Cancel'),
      ),
    );
    this.dialog.addEventListener('close', () => this.dialog.remove());
    document.body.append(this.dialog);
    this.dialog.showModal();
  }

  /** @param {string} text */
  #flag(text) {
    const box = h('input', { type: 'checkbox', onchange: () => this.read() });
    return { box, element: h('label.flag', null, box, h('span', null, text)) };
  }

  /** Asks what is in it: of several pairs the chosen one. */
  async read() {
    const turn = ++this.#turn;
    const query = new URLSearchParams({ pair: String(this.#pair) });
    if (this.flank.value) query.set('flank', this.flank.value);
    if (this.transverse.box.checked) query.set('transverse', '1');
    if (this.reversed.box.checked) query.set('reversed', '1');
    this.open.disabled = true;
    try {
      const { data } = await ask('POST', `import?${query}`, { body: this.file });
      if (turn !== this.#turn) return;
      this.#found = data;
      this.#pair = data.pair ?? this.#pair;
      this.#draw([]);
    } catch (error) {
      if (turn === this.#turn) this.#refused(/** @type {Error} */ (error));
    }
  }

  /** Of several pairs the first that can be imported is chosen; all else is said. @param {Error} error */
  #refused(error) {
    const found = error instanceof Refusal ? /** @type {Api.Import | undefined} */ (error.more.imported) : undefined;
    const first = found?.pairs.find(pair => pair.importable);
    if (found && first && this.#pair === 0) {
      this.#pair = first.number;
      this.read();
      return;
    }
    this.#found = found ?? null;
    const faults = error instanceof Refusal ? error.faults.map(each => each.detail) : [];
    this.#draw(faults.length ? faults : [error.message]);
  }

  /** @param {string[]} faults why there is no design */
  #draw(faults) {
    const found = this.#found;
    this.open.disabled = !found?.design;
    fill(
      this.body,
      found ? h('p.figure-note', null, found.format) : null,
      found && found.pairs.length > 1 ? this.#choice(found.pairs) : null,
      faults.map(text => h('p.fault', null, text)),
      found?.design ? this.#about(found.design) : null,
      found && LISTS.map(([key, title]) => listed(title, key === 'not_used' ? byComponent(found[key]) : found[key])),
      h(
        'details.more',
        { open: faults.length > 0 && found !== null },
        h('summary', null, 'What the file leaves open'),
        h('label.field', null, h('span.label', null, 'Loaded flank of the driver'), this.flank),
        this.transverse.element,
        this.reversed.element,
      ),
    );
  }

  /** @param {Api.ImportPair[]} pairs */
  #choice(pairs) {
    return h(
      'fieldset.choice-group',
      null,
      h('legend', null, `${pairs.length} pairs, of which one is opened`),
      pairs.map(({ number, label, importable, remark }) =>
        h(
          'label.choice',
          null,
          h('input', {
            type: 'radio',
            name: 'import-pair',
            value: number,
            checked: number === this.#pair,
            disabled: !importable,
            onchange: () => {
              this.#pair = number;
              this.read();
            },
          }),
          h('span', null, label, remark ? h('small', null, ` ${remark}`) : null),
        ),
      ),
    );
  }

  /** @param {Api.Design} design */
  #about(design) {
    const { pinion_teeth: pinion, gear_teeth: gear, ends = 2 } = design.gear_pair;
    const cases = design.load_cases?.length ?? 0;
    return h(
      'p',
      null,
      h('b', null, design.name || 'unnamed'),
      `: ${pinion}/${gear} teeth, ${ends === 2 ? 'double' : 'single'} helical. `,
      cases ? `${cases} load case${cases === 1 ? '' : 's'}.` : NO_LOAD,
    );
  }

  async #open() {
    const design = this.#found?.design;
    if (!design) return;
    const { app } = this;
    const { load_cases: kept } = app.store.design;
    const name = design.name || this.file.name.replace(/\.\w+$/, '');
    this.dialog.close();
    const whole = { ...design, name, load_cases: design.load_cases?.length ? design.load_cases : kept };
    await app.attempt(() => app.opening(() => app.library.openNew(whole), 'design'));
  }
}

/** @param {string} title @param {string[]} texts */
function listed(title, texts) {
  if (!texts.length) return null;
  return h(
    'section',
    null,
    h('h3', null, title),
    h(
      'ul.findings',
      null,
      texts.map(text => h('li', null, shownSentence(text))),
    ),
  );
}

/**
 * Opens a design of this program, or shows what is in a file of another.
 * @param {import('../app.js').App} app @param {File} file
 */
export async function importFile(app, file) {
  if (isDesign(/^\s*\{/.test(await file.slice(0, 64).text()) ? readJson(await file.text()) : undefined))
    await app.opening(() => app.library.openFile(file), 'design');
  else await new ImportDialog(app, file).read();
}
