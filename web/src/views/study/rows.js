// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a study in columns of numbers: which are shown, in which order.
import { labelOf } from '../../base/format.js';
import { get } from '../../base/api.js';
import { shownValue } from '../../base/units.js';

const PAGE = 2500; // rows of one answer
const PIECE = 1000; // rows of one piece of work: a few milliseconds

/** @typedef {{ name: string, unit: string, varies: boolean, value: Float64Array, words: string[] | null }} Column */

/** A breath for the page between two pieces of work. */
const breath = () => new Promise(resolve => setTimeout(resolve));

export class Rows extends EventTarget {
  study = 0;
  count = 0;
  variants = 0;
  /** @type {Column[]} */ columns = [];
  variant = new Int32Array(0);
  /** @type {string[]} */ outcome = [];
  /** @type {string[]} */ reason = [];
  /** Rows that are shown, in their order. */
  order = new Int32Array(0);
  /** Ranges that rows have to be in, by column. @type {Map<number, [number, number]>} */
  brushes = new Map();
  sort = { column: -1, descending: false };
  #turn = 0;

  /** Reads all rows that a study has by now. @param {number} study */
  async load(study) {
    const turn = ++this.#turn;
    /** @type {Api.StudyRow[]} */ const items = [];
    /** @type {Api.StudyTable | null} */ let page = null;
    for (let next = /** @type {string | null} */ ('0'); next !== null;) {
      page = await get(`studies/${study}/table?limit=${PAGE}&cursor=${next}`);
      if (turn !== this.#turn) return;
      items.push(...page.items);
      next = page.next;
      await breath();
    }
    if (!page) return;
    if (study !== this.study) {
      this.brushes.clear();
      this.sort = { column: -1, descending: false };
    }
    this.study = study;
    this.variants = page.variants;
    await this.#take(page, items, turn);
  }

  /** @param {Api.StudyTable} page @param {Api.StudyRow[]} items @param {number} turn */
  async #take(page, items, turn) {
    const keys = page.keys.length;
    /** @type {Column[]} */
    const columns = [...page.keys, ...page.columns].map((column, at) => ({
      name: column.name,
      unit: column.unit,
      varies: at < keys,
      value: new Float64Array(items.length).fill(NaN),
      words: at < keys && items.some(item => typeof item.values[at] === 'string') ? [] : null,
    }));
    const variant = new Int32Array(items.length);
    for (let row = 0; row < items.length; row++) {
      const item = items[row];
      variant[row] = item.variant;
      for (let at = 0; at < columns.length; at++) {
        const given = at < keys ? item.values[at] : item.numbers[at - keys];
        columns[at].value[row] = numberOf(columns[at], given);
      }
      if (row % PIECE === PIECE - 1) await breath();
    }
    if (turn !== this.#turn) return;
    this.count = items.length;
    this.columns = columns;
    this.variant = variant;
    this.outcome = items.map(item => item.outcome);
    this.reason = items.map(item => item.reason);
    await breath();
    this.arrange();
  }

  /** What a cell says. @param {number} column @param {number} row */
  text(column, row) {
    const { value, words } = this.columns[column];
    const number = value[row];
    if (Number.isNaN(number)) return '';
    if (words) return words[number] ?? '';
    return String(Number(shownValue(number, this.columns[column].unit).toPrecision(6)));
  }

  /** @param {number} column */
  sortBy(column) {
    const again = this.sort.column === column;
    this.sort = { column, descending: again && !this.sort.descending };
    this.arrange();
  }

  /** @param {number} column @param {[number, number] | null} range */
  brush(column, range) {
    if (range) this.brushes.set(column, range);
    else this.brushes.delete(column);
    this.arrange();
  }

  clearBrushes() {
    this.brushes.clear();
    this.arrange();
  }

  /** Filters and sorts; rows without a number come last. */
  arrange() {
    const rows = new Int32Array(this.count);
    let count = 0;
    for (let row = 0; row < this.count; row++) if (this.#fits(row)) rows[count++] = row;
    const order = rows.subarray(0, count);
    const { column, descending } = this.sort;
    if (this.columns[column]) {
      const { value } = this.columns[column];
      const sign = descending ? -1 : 1;
      order.sort((a, b) => {
        const one = value[a];
        const other = value[b];
        if (one === other) return a - b;
        const missing = Number(Number.isNaN(one)) - Number(Number.isNaN(other));
        return missing || sign * (one - other) || a - b;
      });
    }
    this.order = order;
    this.dispatchEvent(new Event('change'));
  }

  /** @param {number} row */
  #fits(row) {
    for (const [column, [low, high]] of this.brushes) {
      const number = this.columns[column]?.value[row];
      if (!(number >= low && number <= high)) return false;
    }
    return true;
  }
}

/** @param {Column} column @param {unknown} given */
function numberOf(column, given) {
  if (typeof given === 'number') return given;
  if (typeof given === 'boolean') return Number(given);
  if (typeof given !== 'string' || !column.words) return NaN;
  const at = column.words.indexOf(given);
  return at < 0 ? column.words.push(given) - 1 : at;
}

/** The end of a name, with its load case: "2 impact_N". @param {string} name */
export function shortName(name) {
  const loadCase = /load_cases\.(\d+|\*)\./.exec(name)?.[1];
  return `${labelOf(name.slice(name.lastIndexOf('.') + 1))}${loadCase ? `, case ${loadCase}` : ''}`;
}
