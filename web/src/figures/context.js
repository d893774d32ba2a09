// SPDX-License-Identifier: GPL-3.0-or-later
// What the figures show: one result, beside what it is compared with.

/** @typedef {{ label: string, result: any, line: 'dashed' | 'dotted' }} Reference */
/** @typedef {{ result: any, references: Reference[], loadCase: number }} Context */

/** Index of the load case whose share of time is largest. @param {any} design */
export function mainCase(design) {
  const shares = design.load_cases.map((/** @type {any} */ row) => row.share ?? 0);
  return shares.indexOf(Math.max(...shares));
}

/** @param {any} loadCase */
export function caseText(loadCase) {
  return `${Number(loadCase.torque_Nm.toPrecision(5))} N m`;
}

/** Names of the ends that there are. @param {any} result @returns {('left' | 'right')[]} */
export function endsOf(result) {
  return (result.design.gear_pair.ends ?? 2) === 1 ? ['left'] : ['left', 'right'];
}

/** @param {number} index */
export function caseColour(index) {
  return `c${(index % 8) + 1}`;
}

/**
 * The load case of a reference that stands for the same torque and speed, or the one in the same place.
 * @param {any} result
 * @param {any} loadCase
 * @param {number} index
 */
export function sameCase(result, loadCase, index) {
  const cases = result?.load_cases ?? [];
  return (
    cases.find((/** @type {any} */ c) => c.torque_Nm === loadCase.torque_Nm && c.speed_rpm === loadCase.speed_rpm) ??
    cases[index]
  );
}

/** Numbers 0 .. count-1 or from the given start. @param {number} count @param {number} [start] */
export function counting(count, start = 0) {
  return Array.from({ length: count }, (_, i) => i + start);
}
