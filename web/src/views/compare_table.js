// SPDX-License-Identifier: GPL-3.0-or-later
// Designs beside each other in numbers: for each load case, then their flanks and what differs of the pairs.
import { fill, h } from '../base/dom.js';
import { change, changeText, labelOf, plain, sig, unitText } from '../base/format.js';
import { same, valueAt } from '../base/pointer.js';
import { shownUnit, shownValue } from '../base/units.js';
import { caseLong } from '../figures/context.js';
import { NUMBERS, numbersOf, shownNumber } from '../numbers.js';

/**
 * One design of the comparison: without a result while it is computed, with a reason where it has none.
 * @typedef {{ key: string, label: string, title?: string, design: Api.Design | null, result: Page.Result | null,
 *   missing?: string }} Item
 */

const DATA = [
  '/gear_pair/pinion_teeth',
  '/gear_pair/gear_teeth',
  '/gear_pair/normal_module_mm',
  '/gear_pair/helix_angle_deg',
  '/gear_pair/face_width_mm',
  '/gear_pair/centre_distance_mm',
  '/alignment/shaft_angle_error_in_plane_deg',
];
const ENDS = ['left', 'right'];

/** @param {number} i */
export function designColour(i) {
  return `design${(i % 8) + 1}`;
}

/** @param {Item[]} items @param {string} text */
function sectionRow(items, text) {
  return h('tr.section', null, h('th', { scope: 'rowgroup', colspan: items.length + 1 }, text));
}

/**
 * Numbers of a row; the smallest is marked.
 * @param {Item[]} items
 * @param {HTMLElement[]} head
 * @param {(result: Page.Result) => Page.Reading | undefined} read
 */
function numberRow(items, head, read) {
  const values = items.map(item => (item.result ? (read(item.result) ?? null) : null));
  const known = values.filter(value => value !== null);
  const least = known.length > 1 ? Math.min(...known) : null;
  return h(
    'tr',
    null,
    h('th', { scope: 'row' }, head),
    items.map((item, i) => {
      const best = least !== null && values[i] === least;
      const waits = !item.result && !item.missing;
      return h(
        best ? 'td.number.best' : 'td.number',
        { title: best ? 'least of the row' : null },
        waits ? '…' : sig(values[i], 3),
        i > 0 ? h('small', null, ` ${changeText(change(values[i], values[0]))}`) : null,
      );
    }),
  );
}

/** @param {Item} item @param {string} member @param {string} key */
function endsOfKey(item, member, key) {
  return ENDS.map(end => valueAt(item.result?.design ?? item.design, `/modification/${member}/${end}/${key}`) ?? 0);
}

/** What is taken off, of the keys that any of the designs has. @param {Item[]} items */
function flankRows(items) {
  const rows = [];
  for (const member of ['pinion', 'gear']) {
    const keys = new Set(
      items.flatMap(item =>
        Object.keys(valueAt(item.result?.design ?? item.design, `/modification/${member}/left`) ?? {}),
      ),
    );
    for (const key of keys) {
      const values = items.map(item => endsOfKey(item, member, key));
      if (values.every(ends => ends.every(value => typeof value !== 'number' || value === 0))) continue;
      if (/_exponent$/.test(key) && same(values, values.map(() => values[0]))) continue; // says nothing by itself
      const unit = /_(um|mm|per_mm)$/.exec(key)?.[1];
      const text = (/** @type {unknown} */ value) => sig(Number(shownValue(value, unit)), 4);
      rows.push(
        h(
          'tr',
          null,
          h(
            'th',
            { scope: 'row' },
            `${labelOf(key)}, ${member}`,
            h('span.unit', null, ` ${shownUnit(unitText(unit))}`),
          ),
          values.map(([left, right]) =>
            h('td.number', null, left === right ? text(left) : `${text(left)} / ${text(right)}`),
          ),
        ),
      );
    }
  }
  return rows.length ? [sectionRow(items, 'Modification, left / right'), ...rows] : [];
}

/** @param {Item[]} items */
function dataRows(items) {
  return DATA.map(pointer => {
    const key = pointer.split('/')[2];
    const unit = /_(mm|deg)$/.exec(key)?.[1];
    return h(
      'tr',
      null,
      h('th', { scope: 'row' }, labelOf(key), unit ? h('span.unit', null, ` ${shownUnit(unitText(unit))}`) : null),
      items.map(item =>
        h('td.number', null, plain(shownValue(valueAt(item.result?.design ?? item.design, pointer), unit))),
      ),
    );
  });
}

/** @param {Item} item @param {number} i */
function headCell(item, i) {
  const fault = item.missing;
  return h(
    'th',
    { scope: 'col', title: item.title ?? null },
    h('span.dot', { css: { '--swatch': `var(--${designColour(i)})` } }),
    ` ${item.label}`,
    fault ? h('span.fault', null, ` ${fault}`) : item.result ? null : h('span.unit', null, ' is being computed…'),
  );
}

/**
 * @param {HTMLElement} place @param {Item[]} items
 * @param {Api.Design['load_cases']} cases load cases of the design on the table
 */
export function drawComparison(place, items, cases) {
  if (!items.length) {
    fill(place, h('p.empty', null, 'Choose at least one design.'));
    return;
  }
  /** @param {string} name @param {string} [unit] */
  const head = (name, unit) => [h('span', null, name), unit ? h('span.unit', null, ` ${unit}`) : h('span')];
  const body = [numberRow(items, head('Objective J, all load cases'), result => result.objectives?.J)];
  cases.forEach((row, k) => {
    body.push(sectionRow(items, caseLong(row)));
    for (const number of NUMBERS)
      body.push(
        numberRow(items, head(number.name, shownUnit(number.unit)), result =>
          shownNumber(numbersOf(result, k)[number.key], number),
        ),
      );
  });
  body.push(...flankRows(items), sectionRow(items, 'Pair'), ...dataRows(items));
  fill(
    place,
    h(
      'table.numbers.comparison',
      null,
      h('thead', null, h('tr', null, h('th', { scope: 'col' }, h('span.unseen', null, 'number')), items.map(headCell))),
      h('tbody', null, body),
    ),
  );
}
