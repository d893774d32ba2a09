// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as people write, copy and paste them: decimal comma or point, grouped thousands, with or without a unit.
import { unitText } from './format.js';

const INCH = 25.4; // mm, exactly
const POUND_FOOT = 1.3558179483314; // N m, of the international pound and foot
const KSI = 6.894757293168; // MPa

/** Units that a field takes besides its own, in its own. @type {Record<string, Record<string, number>>} */
const TAKEN = {
  mm: { mm: 1, cm: 10, m: 1000, µm: 1e-3, um: 1e-3, in: INCH, inch: INCH, '"': INCH },
  um: { µm: 1, um: 1, mm: 1000, mil: INCH, thou: INCH, in: 1e3 * INCH, '"': 1e3 * INCH },
  deg: { '°': 1, deg: 1, "'": 1 / 60, rad: 180 / Math.PI, mrad: 0.18 / Math.PI },
  Nm: { nm: 1, 'n·m': 1, knm: 1000, lbfft: POUND_FOOT, 'lb-ft': POUND_FOOT, ftlb: POUND_FOOT },
  rpm: { rpm: 1, '1/min': 1, 'min-1': 1, 'r/min': 1, 'u/min': 1, hz: 60 },
  N: { n: 1, kn: 1000 },
  MPa: { mpa: 1, gpa: 1000, 'n/mm2': 1, 'n/mm²': 1, ksi: KSI },
  GPa: { gpa: 1, mpa: 1e-3, 'n/mm2': 1e-3, 'n/mm²': 1e-3 },
  N_per_um: { 'n/µm': 1, 'n/um': 1, 'n/mm': 1e-3, 'n/m': 1e-6, 'kn/mm': 1 },
  kg: { kg: 1, g: 1e-3, t: 1000 },
  '%': { '%': 1 },
};

/** @typedef {{ value: number, fault?: undefined } | { value?: undefined, fault: string }} Read */

const SPACES = /[\s\u00a0\u2009\u202f]/g;
const NUMBER = /^[+-]?(\d[\d.,'’]*|[.,]\d+)(e[+-]?\d+)?/i;

/** Digits with one kind of mark between groups of three. @param {string} digits @param {string} mark */
function isGrouped(digits, mark) {
  const groups = digits.split(mark);
  return /^\d{1,3}$/.test(groups[0]) && groups.slice(1).every(group => /^\d{3}$/.test(group));
}

/**
 * The digits with a point, "" when they make no number, "?" when they can be read in two ways.
 * @param {string} text without sign and exponent
 */
function withPoint(text) {
  const digits = text.replace(/['’]/g, '');
  const [commas, points] = [digits.split(',').length - 1, digits.split('.').length - 1];
  if (commas && points) {
    const decimal = digits.lastIndexOf(',') > digits.lastIndexOf('.') ? ',' : '.';
    const mark = decimal === ',' ? '.' : ',';
    const [whole, part, ...more] = digits.split(decimal);
    return more.length || part.includes(mark) || !isGrouped(whole, mark) ? '' : `${whole.replaceAll(mark, '')}.${part}`;
  }
  const mark = commas ? ',' : '.';
  if (commas + points > 1) return isGrouped(digits, mark) ? digits.replaceAll(mark, '') : '';
  if (/^[1-9]\d{0,2},\d{3}$/.test(digits)) return '?';
  return digits.replace(',', '.');
}

/**
 * A number with the unit of its field, or another one of the same kind.
 * @param {string} text
 * @param {string | null} [unit] of the field, as the field tables spell it
 * @returns {Read}
 */
export function readQuantity(text, unit) {
  const clean = text.trim().replace(/[−–]/g, '-').replace(SPACES, '').replace('μ', 'µ');
  const found = NUMBER.exec(clean);
  if (!found) return { fault: 'Not a number.' };
  const [whole, digits, exponent = ''] = found;
  const number = withPoint(digits);
  if (number === '?') {
    const pointed = Number(digits.replace(',', '.'));
    const decimal = Number.isInteger(pointed) ? pointed.toFixed(1) : String(pointed);
    return { fault: `${digits} can be read in two ways: write ${digits.replace(',', '')} or ${decimal}.` };
  }
  const value = number === '' ? NaN : Number(`${whole.startsWith('-') ? '-' : ''}${number}${exponent}`);
  if (!Number.isFinite(value)) return { fault: 'Not a number.' };
  const rest = clean.slice(whole.length).toLowerCase();
  if (rest === '') return { value };
  const units = TAKEN[unit ?? ''] ?? {};
  const factor = rest === unitText(unit).replace(SPACES, '').toLowerCase() ? 1 : units[rest];
  if (factor === undefined)
    return {
      fault: unit ? `The unit here is ${unitText(unit)}, not ${rest}.` : `A number without a unit, not “${rest}”.`,
    };
  return { value: factor === 1 ? value : Number((value * factor).toPrecision(12)) };
}

/** The number, or undefined when it is none. @param {string} text */
export function parseNumber(text) {
  return readQuantity(text).value;
}
