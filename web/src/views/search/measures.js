// SPDX-License-Identifier: GPL-3.0-or-later
// The objectives of a search as a designer reads them: means over the duty cycle in the units of the page.

/** @typedef {{ f1_um?: Page.Reading, f2_N?: Page.Reading, f3_m_per_s2?: Page.Reading }} Objectives */
/** @typedef {{ key: keyof Objectives, name: string, unit: string, scale: number }} Measure */

/** @type {Measure[]} */
export const MEASURES = [
  { key: 'f1_um', name: 'Transmission error, peak to peak', unit: 'µm', scale: 1 },
  { key: 'f2_N', name: 'Entering impact', unit: 'kN', scale: 1e-3 },
  { key: 'f3_m_per_s2', name: 'Vibration, RMS', unit: 'm/s²', scale: 1 },
];

/** Headings of the columns of a search. */
export const MEASURE_COLUMNS = ['Transmission error (µm)', 'Entering impact (kN)', 'Vibration (m/s²)'];

/**
 * The mean over the duty cycle. The method's objectives are that mean divided by the number of load cases; this takes
 * the division back.
 * @param {Objectives | null | undefined} objectives
 * @param {Measure} measure
 * @param {number} cases how many load cases
 * @returns {number | null}
 */
export function meanOf(objectives, { key, scale }, cases) {
  const value = objectives?.[key];
  return typeof value === 'number' ? value * scale * cases : null;
}

/** @param {Objectives | null | undefined} objectives @param {number} cases */
export function meansOf(objectives, cases) {
  return MEASURES.map(measure => meanOf(objectives, measure, cases));
}

/** "0.62 µm" of f1 is a third of it with three load cases: said once, below the table. @param {number} cases */
export function footnote(cases) {
  return cases > 1
    ? 'Means over the duty cycle, weighted by share of time. f1, f2, f3 of the method, in files and in the API, ' +
        `are these divided by the ${cases} load cases.`
    : 'Of the one load case; f1, f2, f3 of the method are the same.';
}
