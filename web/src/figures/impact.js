// SPDX-License-Identifier: GPL-3.0-or-later
// Entering impact of each end at each torque, as a table.
import { fill, h } from '../base/dom.js';
import { change, changeText, sig } from '../base/format.js';
import { caseNames, endsOf, sameCase } from './context.js';
import { Frame } from './frame.js';

const COLUMNS = /** @type {[keyof Omit<Api.ImpactEnd, 'off_line'>, string, string][]} */ ([
  ['general_force_N', 'force', 'N'],
  ['speed_mm_per_s', 'speed', 'mm/s'],
  ['duration_ms', 'time', 'ms'],
  ['lead_before_A_mm', 'early', 'mm'],
]);
const SHOWN = 3; // on the page; the rest is in the CSV

export class Impact {
  /** @type {(string | number | null)[][]} */ #rows = [];

  constructor() {
    this.frame = new Frame({
      title: 'Entering impact',
      help:
        'The blow of the incoming tooth, which touches before its time because the teeth before it are bent: ' +
        'force, approach speed and duration.',
      good: 'A small force is good; tip relief makes room for the bending.',
      drawing: { table: () => this.#rows },
    });
    this.elements = [this.frame.element];
    this.frame.element.classList.add('with-table', 'keyless');
  }

  /** @param {import('./context.js').Context} context */
  set({ result, references, loadCase: chosen }) {
    const names = caseNames(result.load_cases);
    this.#rows = [['load case', 'end', ...COLUMNS.map(([, text, unit]) => `${text} (${unit})`), 'change (%)']];
    const body = h('tbody');
    result.load_cases.forEach((loadCase, k) => {
      for (const end of endsOf(result)) {
        const impact = loadCase.impact?.[end];
        const before = sameCase(references[0]?.result, loadCase, k)?.impact?.[end];
        const percent = change(impact?.general_force_N, before?.general_force_N);
        const values = COLUMNS.map(([key]) => impact?.[key] ?? null);
        this.#rows.push([names[k], end, ...values, percent ?? null]);
        body.append(
          h(
            k === chosen ? 'tr.chosen' : 'tr',
            null,
            end === 'left' ? h('th', { scope: 'row', rowspan: endsOf(result).length }, names[k]) : null,
            h('td', null, end),
            values.slice(0, SHOWN).map(value => h('td.number', null, sig(value, 3))),
            h('td.number.change', null, changeText(percent)),
          ),
        );
      }
    });
    const head = h(
      'thead',
      null,
      h(
        'tr',
        null,
        h('th', { scope: 'col' }, 'load case'),
        h('th', { scope: 'col' }, 'end'),
        COLUMNS.slice(0, SHOWN).map(([, text, unit]) =>
          h('th', { scope: 'col' }, text, h('span.unit', null, ` ${unit}`)),
        ),
        h('th', { scope: 'col' }, 'change'),
      ),
    );
    fill(this.frame.body, h('table.numbers', null, head, body));
  }
}
