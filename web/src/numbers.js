// SPDX-License-Identifier: GPL-3.0-or-later
// The few numbers that a result is judged by, each with what it is and what is good.
import { shownValue } from './base/units.js';
import { sameCase } from './figures/context.js';

/**
 * @typedef {'peak_to_peak_um' | 'impact_N' | 'rms_m_per_s2' | 'root_stress_MPa' | 'contact_pressure_MPa'} NumberKey
 * @typedef {{ key: NumberKey, name: string, label: string, sub: string, unit: string, help: string, good: string,
 *   scale?: number }} Number_
 */

/** @type {Number_[]} */
export const NUMBERS = [
  {
    key: 'peak_to_peak_um',
    name: 'Peak-to-peak transmission error',
    label: 'Transmission error',
    sub: 'peak to peak (PPLTE)',
    unit: 'µm',
    help: 'How much the gear lags behind the pinion at most, less how much at least, over one mesh cycle under load.',
    good: 'Small is good: it is what makes gears whine.',
  },
  {
    key: 'impact_N',
    name: 'Entering impact force',
    label: 'Entering impact',
    sub: 'force, worse end',
    unit: 'kN',
    help: 'The blow of the tooth that comes into mesh too early because the loaded teeth before it are bent.',
    good: 'Small is good; tip relief makes room for the bending.',
    scale: 1e-3,
  },
  {
    key: 'rms_m_per_s2',
    name: 'Vibration acceleration, RMS',
    label: 'Vibration',
    sub: 'normal, RMS',
    unit: 'm/s²',
    help: 'Root mean square of the relative acceleration of the teeth along the line of action, normal to the flank.',
    good: 'Small is good.',
  },
  {
    key: 'root_stress_MPa',
    name: 'Largest root stress',
    label: 'Root stress',
    sub: 'largest',
    unit: 'MPa',
    help: 'Largest bending stress in the fillets of both members.',
    good: 'Small is good; what a material bears stands in ISO 6336-5.',
  },
  {
    key: 'contact_pressure_MPa',
    name: 'Largest contact pressure',
    label: 'Contact pressure',
    sub: 'largest',
    unit: 'MPa',
    help: 'Largest Hertzian pressure on the flanks, edges included.',
    good: 'Small is good; a peak on an edge says that the relief there is too little.',
  },
];

/**
 * Numbers of one load case as the objectives list them; the root stress where they leave it out.
 * @param {Page.Result | null | undefined} result
 * @param {number} k
 * @returns {Partial<Record<NumberKey, Page.Reading>>}
 */
export function numbersOf(result, k) {
  const loadCase = result?.load_cases?.[k];
  /** @type {Partial<Record<NumberKey, Page.Reading>>} */
  const row = { ...(result?.objectives?.load_cases?.[k] ?? {}) };
  if (typeof row.root_stress_MPa !== 'number') {
    const stresses = [loadCase?.root_stress?.pinion, loadCase?.root_stress?.gear]
      .map(member => member?.max_MPa)
      .filter(value => typeof value === 'number');
    row.root_stress_MPa = stresses.length ? Math.max(...stresses) : null;
  }
  return row;
}

/**
 * Numbers of the load case of a reference that stands for this one; none where there is none.
 * @param {Page.Result | null | undefined} reference
 * @param {Page.LoadCase} loadCase
 * @param {number} k
 */
export function numbersBefore(reference, loadCase, k) {
  const twin = sameCase(reference, loadCase, k);
  return reference && twin ? numbersOf(reference, reference.load_cases.indexOf(twin)) : {};
}

/**
 * A number in the unit that the page shows it in; null where there is none.
 * @param {Page.Reading | undefined} value @param {{ unit: string, scale?: number }} number
 */
export function shownNumber(value, { unit, scale = 1 }) {
  return typeof value === 'number' ? shownValue(value * scale, unit) : null;
}
