// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths as people want them shown and typed: in mm and µm, or in inches and mils. Documents keep mm.

const KEY = 'easeoff-units';
const PER_INCH = 25.4; // mm in an inch, µm in a mil

/** In place of a field's unit: what is printed, and what a bare number is typed in. @type {Record<string, string>} */
const INCH = { mm: 'in', um: 'mil' };

let inches = false;
try {
  inches = localStorage.getItem(KEY) === 'inch';
} catch {
  // a browser that keeps nothing shows mm
}

export function inInches() {
  return inches;
}

/** @param {boolean} wanted */
export function useInches(wanted) {
  inches = wanted;
  try {
    localStorage.setItem(KEY, wanted ? 'inch' : 'mm');
  } catch {
    // for this visit, then
  }
}

/** The unit that stands in place of a field's own; undefined: its own. @param {string | null | undefined} unit */
export function unitInstead(unit) {
  return inches && unit ? INCH[unit] : undefined;
}

/** A value of a field as it is shown. @template T @param {T} value @param {string | null | undefined} unit */
export function shownValue(value, unit) {
  return typeof value === 'number' && unitInstead(unit) ? value / PER_INCH : value;
}

/** A text with the unit that a bare number is meant in. @param {string} text @param {string | null | undefined} unit */
export function typedText(text, unit) {
  const instead = unitInstead(unit);
  return instead && /[\d.,]\s*$/.test(text) ? `${text} ${instead}` : text;
}
