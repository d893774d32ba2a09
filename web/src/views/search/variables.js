// SPDX-License-Identifier: GPL-3.0-or-later
// What a search varied: variables by name ("pinion/both/tip_relief_um"), of a history row and of a best.
import { labelOf, unitText } from '../../base/format.js';

/** @typedef {Record<string, number>} Values */

/** Short names of the variables. @param {string} name */
export function shortName(name) {
  const parts = name.split('/');
  const key = parts[parts.length - 1];
  const end = parts.length === 3 && parts[1] !== 'both' ? ` ${parts[1]}` : '';
  const unit = unitText(/_(um|mm|per_mm)$/.exec(key)?.[1]);
  return `${labelOf(key)}${end}${unit ? ` (${unit})` : ''}`;
}

/** Numbers of a modification, both ends beside each other. @param {any} modification */
function flankValues(modification) {
  /** @type {{ member: string, key: string, left: number, right: number }[]} */
  const rows = [];
  for (const [member, ends] of Object.entries(modification ?? {})) {
    if (!ends || typeof ends !== 'object') continue;
    for (const key of Object.keys(ends.left ?? {})) {
      const left = ends.left[key];
      const right = ends.right?.[key] ?? left;
      if (typeof left === 'number') rows.push({ member, key, left, right });
    }
  }
  return rows;
}

/** Variables of a history row; it lists nothing else. @param {any} row @returns {Values} */
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
 * @param {any} modification
 * @returns {(number | null)[]}
 */
export function valuesOf(names, modification) {
  return names.map(name => {
    const [member, end, key] = name.split('/');
    return modification?.[member]?.[end === 'both' ? 'left' : end]?.[key] ?? null;
  });
}

/** The design with these values. @param {any} design @param {Values} values */
export function withValues(design, values) {
  const next = structuredClone(design);
  for (const [name, value] of Object.entries(values)) {
    const [member, end, key] = name.split('/');
    next.modification ??= {};
    for (const each of end === 'both' ? ['left', 'right'] : [end]) {
      next.modification[member] ??= {};
      next.modification[member][each] = { ...next.modification[member][each], [key]: value };
    }
  }
  return next;
}

/** What is not zero, for people. @param {any} modification */
export function changedValues(modification) {
  return flankValues(modification)
    .filter(({ left, right }) => left !== 0 || right !== 0)
    .map(({ member, key, left, right }) => ({
      label: `${labelOf(key)}${member === 'gear' ? ', gear' : ''}`,
      unit: unitText(/_(um|mm|per_mm)$/.exec(key)?.[1]),
      values: left === right ? [left] : [left, right],
    }));
}
