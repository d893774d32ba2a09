// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths as people want them shown, saved and typed: in mm and µm, or in inches and thousandths of an inch, as
// `--units inch` of the terminal has them. Documents keep mm. A unit of which length is a part (N/µm, mm/s) stays.

const KEY = 'easeoff-units';
const PER_INCH = 25.4; // mm in an inch, µm in a thousandth of it

/** In place of a unit, of a field or printed: what is printed, and what a bare number is typed in.
 * @type {Record<string, string>} */
const INCH = { mm: 'in', um: 'thou', µm: 'thou' };
/** "from mid face (mm)": the unit of a column at the end of its head. */
/** "0.5 .. 500 mm", "70 mm": a length in a sentence, or several with the unit behind the last; as
 * format/inch_sentence.h reads it. No mm², mm/s; no number of a name. */
const NUMBER = String.raw`(?<![\w.]|[\w.]-)\d+(?:\.\d+)?(?:e[-+]?\d+)?`;
const LENGTHS = new RegExp(
  String.raw`(${NUMBER}(?:(?: \.\. | to | and | is outside )-?${NUMBER})*) (mm|[uµ]m)(?![\w/^²³])`,
  'g',
);
const LEAST_DIGITS = 5;
const MOST_DIGITS = 15;
const HEAD = /^(.*)\((mm|µm)\)$/s;

/** Tells ("change") that lengths are wanted in other units: what is shown is drawn again. */
export const units = new EventTarget();

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
  units.dispatchEvent(new Event('change'));
}

/** The unit that stands in place of a unit; undefined: it stays. @param {string | null | undefined} unit */
export function unitInstead(unit) {
  return inches && unit ? INCH[unit] : undefined;
}

/** The unit that is printed for a printed one: "µm". @template {string | undefined} U @param {U} unit */
export function shownUnit(unit) {
  return unitInstead(unit) ?? unit;
}

/**
 * A value of a unit, or of a field, as it is shown.
 * @template T @param {T} value @param {string | null | undefined} unit
 */
export function shownValue(value, unit) {
  return typeof value === 'number' && unitInstead(unit) ? value / PER_INCH : value;
}

/** A text with the unit that a bare number is meant in. @param {string} text @param {string | null | undefined} unit */
export function typedText(text, unit) {
  const instead = unitInstead(unit);
  return instead && /[\d.,]\s*$/.test(text) ? `${text} ${instead}` : text;
}

/**
 * Numbers of one unit as they are shown.
 * @template {ArrayLike<number | null>} T @param {T} values @param {string} [unit]
 */
export function shownValues(values, unit) {
  if (!unitInstead(unit)) return values;
  return /** @type {T} */ (/** @type {unknown} */ (Array.from(values, value => shownValue(value, unit))));
}

/** A sentence of the service, which is in mm and µm, as it is shown. @param {string} sentence */
export function shownSentence(sentence) {
  if (!inches) return sentence;
  return sentence.replace(
    LENGTHS,
    (_all, numbers, unit) => `${numbers.replace(new RegExp(NUMBER, 'g'), numberInInches)} ${INCH[unit]}`,
  );
}

/** To as many digits as it has, and at least five. @param {string} text */
function numberInInches(text) {
  const digits = text.replace(/e.*/, '').replace('.', '').replace(/^0+/, '').length;
  return String(Number((Number(text) / PER_INCH).toPrecision(Math.min(Math.max(digits, LEAST_DIGITS), MOST_DIGITS))));
}

/** The head of a column as it is shown: "from mid face (mm)". @param {string} head */
export function shownHead(head) {
  return head.replace(HEAD, (_all, name, unit) => `${name}(${shownUnit(unit)})`);
}

/** A value below such a head. @template T @param {T} value @param {unknown} head */
export function shownBelow(value, head) {
  return typeof head === 'string' ? shownValue(value, HEAD.exec(head)?.[2]) : value;
}
