// SPDX-License-Identifier: GPL-3.0-or-later
// The fit of inputs that nobody knows to the measurements: which, within what, what came out, and taking it over.
import { fill, h, newId } from '../../base/dom.js';
import { labelOf, plain, sig, unitText } from '../../base/format.js';
import { parseNumber } from '../../base/quantity.js';
import { placesOf } from '../../base/schema.js';
import { Lane } from '../../base/lane.js';
import { valueAt } from '../../base/pointer.js';
import { group } from '../../form/group.js';
import { shownSentence } from '../../base/units.js';

/** Why a measurement was left out. @param {Api.LeftOut} item */
const reasonOf = item => `measurement ${item.id} (${shownSentence(item.reason)})`;

/** "12.3 … 14.5" @param {Page.Curve} range */
const rangeText = range => `${sig(range[0], 4)} … ${sig(range[1], 4)}`;

export class FitPanel {
  /** @type {Api.Fit | null} */ #answer = null;

  /** @param {import('../../app.js').App} app @param {() => string} designId */
  constructor(app, designId) {
    this.app = app;
    this.designId = designId;
    this.rows = app.fitted.map(unknown => this.#unknown(unknown));
    this.start = h('button', { type: 'button', onclick: () => this.#run() }, 'Fit to the measurements');
    this.note = h('p.figure-note', { role: 'status' });
    this.element = group('fit', 'Fit unknown inputs', false, [
      h('p.figure-note', null, 'Finds these inputs by least squares on the orders of all measurements, no outliers.'),
      ...this.rows.map(row => row.element),
      h('.form-foot', null, this.start),
      this.note,
    ]);
    this.result = h('section.figure.with-table.wide', { 'aria-label': 'Fit', hidden: true });
    /** @type {Lane<Api.Fit>} */
    this.lane = new Lane({
      result: (_task, data) => {
        this.#answer = data;
        this.#busy('');
        this.#draw();
      },
      refused: (_task, error) => this.#busy(error.message),
      preparing: () => this.#busy('The teeth are being prepared…', true),
    });
  }

  /** @param {import('../../base/schema.js').Field} unknown */
  #unknown(unknown) {
    const id = newId('unknown');
    const box = h('input', { type: 'checkbox', id, checked: unknown.key === 'mesh_damping_ratio' });
    const [low, high] = (unknown.usual ?? []).map((value, i) =>
      h('input.tiny', {
        type: 'text',
        inputmode: 'decimal',
        value: plain(value),
        'aria-label': `${labelOf(unknown.key)}, ${i ? 'highest' : 'lowest'}`,
      }),
    );
    return {
      unknown,
      box,
      low,
      high,
      element: h(
        '.field.unknown',
        null,
        h('label.flag', { for: id }, box, h('span', null, labelOf(unknown.key))),
        h('span.range-fields', null, low, '…', high, ` ${unitText(unknown.unit)}`),
      ),
    };
  }

  /** @param {string} text @param {boolean} [busy] */
  #busy(text, busy = false) {
    this.note.textContent = text;
    this.start.disabled = busy;
  }

  #run() {
    /** @type {Record<string, number[]>} */
    const unknowns = {};
    for (const { unknown, box, low, high } of this.rows) {
      const range = [parseNumber(low.value), parseNumber(high.value)];
      if (box.checked && range[0] !== undefined && range[1] !== undefined) unknowns[unknown.key] = [range[0], range[1]];
    }
    if (!this.designId()) return this.#busy('There are no measurements of this design yet.');
    if (!Object.keys(unknowns).length) return this.#busy('Choose at least one input.');
    this.#busy('Fitting…', true);
    const { design } = this.app.store;
    this.lane.submit({ path: `designs/${this.designId()}/fit`, body: { unknowns, design } });
  }

  #draw() {
    const answer = this.#answer;
    if (!answer) return;
    const rows = answer.unknowns.map(unknown => {
      const unit = this.app.fitted.find(each => each.key === unknown.key)?.unit ?? '';
      return h(
        'tr',
        null,
        h('th', { scope: 'row' }, labelOf(unknown.key), unit ? h('span.unit', null, ` ${unitText(unit)}`) : null),
        h('td.number', null, sig(unknown.before, 4)),
        h('td.number', null, h('b', null, sig(unknown.value, 4))),
        h('td.number', null, rangeText(unknown.confidence_95)),
        h('td.number', null, rangeText(unknown.range)),
        h(
          'td',
          null,
          unknown.undetermined
            ? 'not determined'
            : unknown.at_bound
              ? 'at its bound'
              : unknown.same_as
                ? `not apart from ${labelOf(unknown.same_as)}`
                : '',
        ),
      );
    });
    this.result.hidden = false;
    fill(
      this.result,
      h(
        '.figure-head',
        null,
        h('h3', null, 'Fit'),
        h(
          '.figure-controls',
          null,
          h('button.small.primary', { type: 'button', onclick: () => this.#apply() }, 'Take over into the design'),
        ),
      ),
      h(
        '.table-scroll',
        { tabindex: '0', role: 'region', 'aria-label': 'Table of the fit' },
        h(
          'table.numbers',
          null,
          h(
            'thead',
            null,
            h(
              'tr',
              null,
              ['input', 'before', 'found', '95 % interval', 'range', 'remark'].map(text =>
                h('th', { scope: 'col' }, text),
              ),
            ),
          ),
          h('tbody', null, rows),
        ),
      ),
      h(
        'p.figure-note',
        null,
        `${answer.measurements} measurements, ${answer.orders} orders; misfit ${sig(answer.misfit?.before, 3)} ` +
          `before, ${sig(answer.misfit?.after, 3)} after (1: as large as its uncertainty).`,
      ),
      answer.warnings.length
        ? h(
            'ul.findings',
            null,
            answer.warnings.map(text =>
              h('li', null, h('span.severity.warning', null, 'doubtful'), ' ', shownSentence(text)),
            ),
          )
        : null,
      answer.left_out.length ? h('p.figure-note', null, `Left out: ${answer.left_out.map(reasonOf).join(' ')}`) : null,
    );
  }

  #apply() {
    const { store } = this.app;
    if (!this.#answer) return;
    const { design, unknowns } = this.#answer;
    /** @type {string[]} */
    const keys = unknowns.map(unknown => unknown.key);
    const pointers = keys.flatMap(key => placesOf(this.app.fields, key));
    for (const pointer of [
      ...pointers,
      ...(keys.includes('pinion_axial_stiffness_N_per_um') ? ['/alignment/pinion_axial'] : []),
    ]) {
      const value = valueAt(design, pointer);
      if (value !== undefined) store.set(pointer, value);
    }
    this.note.textContent = 'Taken over; undo takes it back.';
  }
}
