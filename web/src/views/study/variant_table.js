// SPDX-License-Identifier: GPL-3.0-or-later
// The rows as a table of which only what is in sight is there: ten thousand rows cost no more than forty.
import { fill, h } from '../../base/dom.js';
import { unitText } from '../../base/format.js';
import { shownSentence, shownUnit, units } from '../../base/units.js';
import { shortName } from './rows.js';

const USUAL = 24; // px of a row until one is there: fingers need taller ones
const BEYOND = 6; // rows above and below the window

export class VariantTable {
  #drawn = '';
  #height = USUAL;
  #asked = false;

  /** @param {import('./rows.js').Rows} rows @param {(row: number) => void} pick */
  constructor(rows, pick) {
    this.rows = rows;
    this.pick = pick;
    this.head = h('tr');
    this.body = h('tbody');
    this.above = h('div');
    this.below = h('div');
    this.element = h(
      '.variant-table',
      { tabindex: 0, 'aria-label': 'Variants', role: 'region' },
      h(
        'table.numbers',
        null,
        h('thead', null, this.head),
        h('tbody.space', null, h('tr', null, h('td', null, this.above))),
        this.body,
        h('tbody.space', null, h('tr', null, h('td', null, this.below))),
      ),
    );
    this.element.addEventListener('scroll', () => this.#later(), { passive: true });
    new ResizeObserver(() => this.#later()).observe(this.element);
    for (const source of [rows, units])
      source.addEventListener('change', () => {
        this.#drawn = '';
        this.#drawHead();
        this.#later();
      });
  }

  #drawHead() {
    const { columns, sort } = this.rows;
    const direction = sort.descending ? 'descending' : 'ascending';
    fill(
      this.head,
      h('th', { scope: 'col' }, '#'),
      ...columns.map((column, at) =>
        h(
          'th',
          { scope: 'col', title: column.name, 'aria-sort': sort.column === at ? direction : null },
          h(
            'button.link',
            { type: 'button', onclick: () => this.rows.sortBy(at) },
            shortName(column.name),
            column.unit ? h('span.unit', null, ` ${shownUnit(unitText(column.unit))}`) : null,
            sort.column === at ? (sort.descending ? ' ▼' : ' ▲') : '',
          ),
        ),
      ),
      h('th', { scope: 'col' }, 'outcome'),
    );
  }

  #later() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#draw();
    });
  }

  #draw() {
    const { order } = this.rows;
    const height = this.body.firstElementChild?.getBoundingClientRect().height || this.#height;
    this.#height = height;
    const first = Math.max(0, Math.floor(this.element.scrollTop / height) - BEYOND);
    const last = Math.min(order.length, first + Math.ceil(this.element.clientHeight / height) + 2 * BEYOND);
    const drawn = `${first} ${last} ${height}`;
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    this.above.style.height = `${first * height}px`;
    this.below.style.height = `${(order.length - last) * height}px`;
    fill(this.body, ...Array.from(order.subarray(first, last), row => this.#row(row)));
  }

  /** @param {number} row */
  #row(row) {
    const { rows } = this;
    return h(
      'tr',
      {
        'data-variant': rows.variant[row],
        title: shownSentence(rows.reason[row]) || null,
        onclick: () => this.pick(row),
      },
      h('th', { scope: 'row' }, h('button.link', { type: 'button' }, rows.variant[row])),
      ...rows.columns.map((_column, at) => h('td.number', null, rows.text(at, row))),
      h('td', null, rows.outcome[row].replaceAll('_', ' ')),
    );
  }
}
