// SPDX-License-Identifier: GPL-3.0-or-later
// The table of load cases: rows by hand or pasted from a spreadsheet.
import { fill, h } from '../base/dom.js';
import { labelOf, sig } from '../base/format.js';
import { readRows } from '../base/case_rows.js';
import { fieldAt, unitOf } from '../base/schema.js';
import { caseNames } from '../figures/context.js';
import { more } from '../form/group.js';

const COLUMNS = ['name', 'torque_Nm', 'speed_rpm', 'share'];
const FIRST = { torque_Nm: 100, speed_rpm: 2000, share: null };

/** @typedef {import('../base/schema.js').Field} Field */

export class LoadCases {
  #rows = -1;
  /** @type {import('../form/fieldset.js').FieldSet[]} */ #sets = [];

  /** @param {import('../base/store.js').DesignStore} store @param {import('../form/form.js').Form} form */
  constructor(store, form) {
    this.store = store;
    this.form = form;
    this.fields = fieldAt(form.fields, '/load_cases')?.fields ?? [];
    this.columns = COLUMNS.flatMap(key => this.fields.filter(field => field.key === key));
    this.others = this.fields.filter(field => !COLUMNS.includes(field.key) && !field.entry);
    this.table = h('table.load-cases', { onpaste: (/** @type {ClipboardEvent} */ event) => this.#paste(event) });
    this.note = h('p.figure-note', { role: 'status' });
    this.more = h('div');
    this.element = h(
      'div',
      null,
      this.table,
      h('button.small', { type: 'button', onclick: () => this.#add() }, '+ load case'),
      this.note,
      this.more,
    );
  }

  refresh() {
    const rows = this.store.design.load_cases ?? [];
    if (rows.length !== this.#rows) this.#draw(rows.length);
    this.#drawShares(rows);
  }

  /** @param {Partial<Api.Design['load_cases'][number]>[]} rows */
  #drawShares(rows) {
    const stated = rows.map(row => row.share).filter(share => typeof share === 'number');
    const sum = stated.reduce((total, share) => total + share, 0);
    const parts = rows.map(row => `${sig((100 * (row.share ?? 0)) / sum, 3)} %`);
    const off = stated.length === rows.length && stated.length > 0 && Math.abs(sum - 1) > 1e-6;
    this.note.textContent = off
      ? `The shares add up to ${sig(sum, 4)}; as parts of the whole they are ${parts.join(', ')}.`
      : 'Rows copied from a spreadsheet can be pasted here.';
  }

  #add() {
    const rows = this.store.design.load_cases ?? [];
    const { name, ...last } = rows[rows.length - 1] ?? FIRST;
    this.store.set('/load_cases', [...rows, name === undefined ? last : { ...last, name: '' }]);
  }

  /** @param {ClipboardEvent} event */
  #paste(event) {
    const text = event.clipboardData?.getData('text/plain') ?? '';
    if (!/\t|\n.*\S|;/.test(text.trim())) return;
    event.preventDefault();
    const { rows, fault } = readRows(text);
    if (fault) {
      this.note.textContent = `Nothing was pasted. ${fault}`;
      return;
    }
    const known = this.fields.map(field => field.key);
    const usual = this.store.design.load_cases?.[0] ?? FIRST;
    const whole = rows.map(row => {
      const taken = Object.fromEntries(Object.entries(row).filter(([key]) => known.includes(key)));
      return { torque_Nm: usual.torque_Nm, speed_rpm: usual.speed_rpm, share: null, ...taken };
    });
    this.#rows = -1;
    this.store.loadCase = -1;
    this.store.set('/load_cases', whole);
  }

  /** @param {number} count */
  #draw(count, typed = new Map()) {
    this.#rows = count;
    for (const set of this.#sets) set.release();
    this.#sets = Array.from({ length: count }, () => this.form.set());
    const head = h(
      'tr',
      null,
      h('th', { scope: 'col' }, h('span.unseen', null, 'colour')),
      this.columns.map(field => {
        const unit = unitOf(field);
        return h('th', { scope: 'col' }, labelOf(field.key), unit ? h('span.unit', null, ` ${unit}`) : null);
      }),
      h('th', { scope: 'col' }, h('span.unseen', null, 'remove')),
    );
    fill(
      this.table,
      h('thead', null, head),
      h(
        'tbody',
        null,
        this.#sets.map((set, i) => this.#row(set, i, count)),
      ),
    );
    fill(
      this.more,
      this.others.length
        ? more(
            `${this.others.map(field => labelOf(field.key)).join(', ')} of each`,
            this.#sets.map((set, i) => this.#rest(set, i)),
          )
        : null,
    );
    for (const [pointer, texts] of typed) for (const set of this.#sets) set.retype(pointer, texts);
  }

  /** @param {import('../form/fieldset.js').FieldSet} set @param {number} i @param {number} count */
  #row(set, i, count) {
    const mark = h('span.dot', { css: { '--swatch': `var(--case${(i % 8) + 1})` } });
    /** @param {Field} field */
    const entry = field =>
      set.field(`/load_cases/${i}/${field.key}`, { label: `${labelOf(field.key)} of load case ${i + 1}` });
    const remove = h(
      'button.icon',
      {
        type: 'button',
        'aria-label': `Remove load case ${i + 1}`,
        title: 'Remove',
        disabled: count === 1,
        onclick: () => this.#remove(i),
      },
      '✕',
    );
    return h(
      'tr',
      null,
      h('td', null, mark),
      this.columns.map(field => h('td', null, entry(field))),
      h('td', null, remove),
    );
  }

  /**
   * What a load case seldom states for itself.
   * @param {import('../form/fieldset.js').FieldSet} set
   * @param {number} i
   */
  #rest(set, i) {
    const place = `/load_cases/${i}`;
    const simple = this.others.filter(field => field.kind !== 'object' && field.kind !== 'list');
    const nested = this.others.filter(field => field.kind === 'object');
    return h(
      'fieldset',
      null,
      h('legend', null, `Load case ${i + 1}`),
      simple.map(field => set.field(`${place}/${field.key}`)),
      nested.map(field => [
        h('legend', null, `${labelOf(field.key)} of load case ${i + 1}`),
        set.fieldsOf(`${place}/${field.key}`),
      ]),
    );
  }

  /** The row goes with what is typed in it; what is typed in the others moves with them. @param {number} index */
  #remove(index) {
    const typed = new Map();
    this.#sets.forEach((set, i) => {
      const to = i > index ? i - 1 : i;
      if (i !== index)
        for (const [pointer, texts] of set.typed())
          typed.set(pointer.replace(`/load_cases/${i}/`, `/load_cases/${to}/`), texts);
    });
    for (const set of this.#sets) set.release();
    this.#sets = [];
    const rows = this.store.design.load_cases.filter((_row, i) => i !== index);
    if (this.store.loadCase >= rows.length) this.store.loadCase = -1;
    this.#rows = rows.length;
    this.store.set('/load_cases', rows);
    this.#draw(rows.length, typed);
  }

  /** @returns {string[]} */
  names() {
    return caseNames(this.store.design.load_cases ?? []);
  }
}
