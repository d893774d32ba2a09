// SPDX-License-Identifier: GPL-3.0-or-later
// What the Tolerance view shows beside the distribution: tables and bars.
import { h } from '../../base/dom.js';
import { labelOf, sig, unitText } from '../../base/format.js';
import { shownUnit, shownValue } from '../../base/units.js';

const UNIT = /_(um|mm|deg|MPa|N_per_mm|N|m_per_s2)$/;

/** The unit that a key says, printed. @param {string} key */
export const unitOfKey = key => unitText(UNIT.exec(key)?.[1]);

/** A number of a key, with its unit. @param {string} key @param {number | null} value */
const shownOf = (key, value) => `${sig(shownValue(value, unitOfKey(key)), 4)} ${shownUnit(unitOfKey(key))}`.trim();

/**
 * A table below its name and a word about it.
 * @param {string} title @param {string} about @param {HTMLElement[]} parts @param {string} [kind]
 */
function titled(title, about, parts, kind = 'table.numbers') {
  return [h('.figure-head', null, h('h3', null, title)), h('p.figure-note', null, about), h(kind, null, parts)];
}

const SHOWN = 10; // inputs with a bar
const ROOM = matchMedia('(min-width: 1100px)'); // for the list of inputs beside the rest

/** "modification.pinion.left.profile_slope_um" -> "pinion left, profile slope". @param {string} key */
function nameOf(key) {
  const parts = key.split('.');
  const last = labelOf(parts.pop() ?? '').toLowerCase();
  const where = parts.filter(part => part !== 'modification').join(' ');
  return where ? `${where.replaceAll('_', ' ')}, ${last}` : last;
}

/** @param {Api.Tolerance} result @param {Api.ScatterOutput} output @param {string} unit */
export function percentiles(result, output, unit) {
  /** @param {number | null} value @param {number} [digits] */
  const text = (value, digits = 4) => sig(shownValue(value, unit), digits);
  /** @param {Api.ScatterOutput['percentiles'][number]} row */
  const line = row =>
    h(
      'tr',
      null,
      h('th', { scope: 'row' }, `${row.percent} %`),
      h('td', null, text(row.value)),
      h('td', null, `${text(row.low)} to ${text(row.high)}`),
    );
  return titled('Percentiles', `${labelOf(output.key)}${unit ? `, ${shownUnit(unit)}` : ''}: ${result.pairs} pairs`, [
    h(
      'thead',
      null,
      h(
        'tr',
        null,
        h('th', { scope: 'col' }, 'Share of the pairs'),
        h('th', { scope: 'col' }, 'at most'),
        h('th', { scope: 'col' }, 'with 95 % between'),
      ),
    ),
    h(
      'tbody',
      null,
      output.percentiles.map(line),
      h(
        'tr',
        null,
        h('th', { scope: 'row' }, 'mean'),
        h('td', null, text(output.mean)),
        h('td', null, output.mean_interval.map(end => text(end)).join(' to ')),
      ),
      h(
        'tr',
        null,
        h('th', { scope: 'row' }, 'standard deviation'),
        h('td', null, text(output.std, 3)),
        h('td', null, output.std_interval.map(end => text(end, 3)).join(' to ')),
      ),
      h('tr', null, h('th', { scope: 'row' }, 'as drawn'), h('td', null, text(output.nominal)), h('td')),
    ),
  ]);
}

/** Bars of the inputs that decide most, by the measure that explains more. @param {Api.ScatterOutput} output */
export function influences(output) {
  const bySurface = (output.Q2 ?? -1) > (output.R2 ?? -1);
  /** @param {Api.ScatterOutput['influences'][number]} row */
  const sizeOf = row => (bySurface ? (row.total ?? 0) : Math.abs(row.coefficient ?? 0));
  const rows = output.influences.slice(0, SHOWN);
  const largest = Math.max(...rows.map(sizeOf), 1e-12);
  /** @param {Api.ScatterOutput['influences'][number]} row */
  const bar = row =>
    h(
      'tr',
      null,
      h('th', { scope: 'row', title: row.key }, nameOf(row.key)),
      h('td', null, sig(bySurface ? row.total : row.coefficient, 2)),
      h('td.effect', null, h('span', { css: { width: `${(100 * sizeOf(row)) / largest}%` } })),
    );
  const share = sig(bySurface ? output.Q2 : output.R2, 2);
  const measure = bySurface
    ? `total Sobol indices of a quadratic surface; it explains ${share} of the variance of pairs it was not fitted to`
    : `standardised coefficients of a linear regression, which explains ${share} of the variance`;
  return titled('What decides', measure, [h('tbody', null, rows.map(bar))], 'table.numbers.influences');
}

/** @param {Api.ScatterYield[]} rows */
export function yields(rows) {
  if (!rows.length) return null;
  /** @param {Api.ScatterYield} row */
  const line = row =>
    h(
      'tr',
      null,
      h(
        'th',
        { scope: 'row' },
        row.output ? `${labelOf(row.output)} at most ${shownOf(row.output, row.at_most)}` : 'all limits',
      ),
      h('td', null, `${sig(100 * row.fraction, 4)} %`),
      h('td', null, row.clopper_pearson.map(end => `${sig(100 * end, 3)} %`).join(' to ')),
    );
  return titled('Yield', 'with its 95 % interval', [h('tbody', null, rows.map(line))]);
}

/** @param {Api.Tolerance} result */
export function inputTable(result) {
  /** @param {Api.ScatterInput} row */
  const line = row =>
    h(
      'tr',
      null,
      h('th', { scope: 'row', title: row.key }, nameOf(row.key)),
      h('td', null, shownOf(row.key, row.nominal)),
      h('td', null, row.distribution),
    );
  const table = h('table.numbers.scattering', null, h('tbody', null, result.inputs.map(line)));
  return [
    h('.figure-head', null, h('h3', null, 'What scatters')),
    h(
      'details.more',
      { open: ROOM.matches },
      h('summary', null, `${result.inputs.length} inputs`),
      h('.table-scroll', null, table),
    ),
  ];
}
