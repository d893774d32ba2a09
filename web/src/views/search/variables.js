// SPDX-License-Identifier: GPL-3.0-or-later
// What a search varied: variables by name ("pinion/both/tip_relief_um"), of a history row and of a best.
import { labelOf, unitText } from '../../base/format.js';
import { valueAt, withValue } from '../../base/pointer.js';

/** @typedef {Record<string, number>} Values */
/** @typedef {{ grid_nodes?: { row: number, column: number, delta_um: number }[] } | null | undefined} Nodes */
/** @typedef {object | null | undefined} Flanks values by member, end and key, all of them or those that were varied */

/** Short names of the variables. @param {string} name */
export function shortName(name) {
  const parts = name.split('/');
  const key = parts[parts.length - 1];
  const end = parts.length === 3 && parts[1] !== 'both' ? ` ${parts[1]}` : '';
  const unit = unitText(/_(um|mm|per_mm)(\[|$)/.exec(key)?.[1]);
  return `${labelOf(key)}${end}${unit ? ` (${unit})` : ''}`;
}

/**
 * Numbers in place of a grid's, each under the name that a variable has.
 * @param {Nodes} flank
 * @returns {Record<string, number>}
 */
function withNodes(flank) {
  const nodes = (flank?.grid_nodes ?? []).map(({ row, column, delta_um: delta }) => [
    `grid_um[u${row || '*'} y${column || '*'}]`,
    delta,
  ]);
  return { ...flank, ...Object.fromEntries(nodes) };
}

const KNOT = /^grid_um\[u(\*|\d+) y(\*|\d+)\]$/;

/**
 * A grid with one number at all knots that the name of a variable covers.
 * @param {{ delta_um: number[][] }} grid @param {string} key @param {number} value
 */
function withKnots(grid, key, value) {
  const [row, column] = (KNOT.exec(key) ?? []).slice(1).map(text => (text === '*' ? 0 : Number(text)));
  const delta = grid.delta_um.map((/** @type {number[]} */ numbers, /** @type {number} */ i) =>
    numbers.map((number, j) => ((!row || row === i + 1) && (!column || column === j + 1) ? value : number)),
  );
  return { ...grid, delta_um: delta };
}

/**
 * A modification that lists terms alone, with the grids of the design.
 * @template M
 * @param {{ modification?: Flanks }} design
 * @param {M} modification
 */
export function withGrids(design, modification) {
  let next = modification;
  for (const member of ['pinion', 'gear'])
    for (const end of ['left', 'left/coast', 'right', 'right/coast']) {
      const grid = valueAt(design.modification, `/${member}/${end}/grid`);
      if (grid && !valueAt(next, `/${member}/${end}/grid`)) next = withValue(next, `/${member}/${end}/grid`, grid);
    }
  return next;
}

/** @template D @param {D} design @param {string} flank pointer of it @param {string} key @param {number} value */
function withNumber(design, flank, key, value) {
  const grid = KNOT.test(key) && valueAt(design, `${flank}/grid`);
  return grid
    ? withValue(design, `${flank}/grid`, withKnots(grid, key, value))
    : withValue(design, `${flank}/${key}`, value);
}

/** Numbers of a modification, both ends beside each other. @param {Flanks} modification */
function flankValues(modification) {
  /** @type {{ member: string, key: string, left: number, right: number }[]} */
  const rows = [];
  for (const [member, ends] of Object.entries(modification ?? {})) {
    if (!ends || typeof ends !== 'object') continue;
    const [ofLeft, ofRight] = [withNodes(ends.left), withNodes(ends.right)];
    for (const key of Object.keys(ofLeft)) {
      const left = ofLeft[key];
      const right = ofRight[key] ?? left;
      if (typeof left === 'number') rows.push({ member, key, left, right });
    }
  }
  return rows;
}

/** Variables of a history row; it lists nothing else. @param {{ modification?: Flanks }} row @returns {Values} */
export function variablesOf(row) {
  /** @type {Values} */
  const values = {};
  for (const { member, key, left, right } of flankValues(row.modification)) {
    if (left === right) values[`${member}/both/${key}`] = left;
    else {
      values[`${member}/left/${key}`] = left;
      values[`${member}/right/${key}`] = right;
    }
  }
  return values;
}

/**
 * The same variables of any modification.
 * @param {string[]} names
 * @param {Flanks} modification
 * @returns {(number | null)[]}
 */
export function valuesOf(names, modification) {
  return names.map(name => {
    const [member, end, key] = name.split('/');
    return withNodes(valueAt(modification, `/${member}/${end === 'both' ? 'left' : end}`))[key] ?? null;
  });
}

/** The design with these values. @param {Api.Design} design @param {Values} values */
export function withValues(design, values) {
  let next = design;
  for (const [name, value] of Object.entries(values)) {
    const [member, end, key] = name.split('/');
    for (const each of end === 'both' ? ['left', 'right'] : [end])
      next = withNumber(next, `/modification/${member}/${each}`, key, value);
  }
  return next;
}

/**
 * What is not zero, for people; exponents only where they are not those of the design before.
 * @param {Flanks} modification @param {Flanks} before
 */
export function changedValues(modification, before) {
  const old = new Map(flankValues(before).map(({ member, key, left }) => [`${member}/${key}`, left]));
  return flankValues(modification)
    .filter(({ left, right }) => left !== 0 || right !== 0)
    .filter(({ member, key, left }) => !/_exponent$/.test(key) || left !== old.get(`${member}/${key}`))
    .map(({ member, key, left, right }) => ({
      label: `${labelOf(key)}${member === 'gear' ? ', gear' : ''}`,
      unit: unitText(/_(um|mm|per_mm)(\[|$)/.exec(key)?.[1]),
      values: left === right ? [left] : [left, right],
    }));
}
