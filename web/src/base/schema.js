// SPDX-License-Identifier: GPL-3.0-or-later
// The field tables that the service describes its documents with.
import { plain, unitText } from './format.js';
import { shownValue, unitInstead } from './units.js';

/**
 * A row of a field table. `entry`: another way to state a value, read and never written; `symbol`: the unit as it is
 * printed; `basis`: where a default comes from.
 * @typedef {Api.Field} Field
 */

/** @param {Api.Form} description of GET /schema @returns {Field[]} */
export function designFields(description) {
  return description.design.fields;
}

/** The inputs that can be fitted. @param {Api.Form} description of GET /schema @returns {Field[]} */
export function fittedFields(description) {
  return fieldAt(description.fit.fields, '/unknowns')?.fields ?? [];
}

/**
 * Where a design holds a fitted input: under its key in one of its objects, or once for each end.
 * @param {Field[]} fields @param {string} key
 */
export function placesOf(fields, key) {
  return fields
    .filter(group => group.kind === 'object')
    .flatMap(group =>
      (group.fields ?? [])
        .filter(field => field.key.replace(/_(left|right)_/, '_') === key)
        .map(field => `/${group.key}/${field.key}`),
    );
}

/** @param {Field[]} fields @param {string} pointer @returns {Field | undefined} */
export function fieldAt(fields, pointer) {
  /** @type {Field | undefined} */
  let field;
  /** @type {Field[] | undefined} */
  let level = fields;
  for (const key of pointer.split('/').slice(1)) {
    if (field?.kind === 'list' && /^\d+$/.test(key)) continue;
    field = level?.find(candidate => candidate.key === key);
    if (!field) return undefined;
    level = field.fields;
  }
  return field;
}

/** The unit of the documents as it is printed. @param {Field | undefined} field */
export function ownUnitOf(field) {
  const text = unitText(field?.unit);
  return text === field?.unit ? field?.symbol || text : text;
}

/** The unit that a value of the field is shown and typed in. @param {Field | undefined} field */
export function unitOf(field) {
  return unitInstead(field?.unit) ?? ownUnitOf(field);
}

/** @param {Field} field */
export function isNumeric(field) {
  return ['number', 'integer', 'seed'].includes(field.kind);
}

/** @param {Field} field */
export function fallbackOf(field) {
  if (field.kind === 'text' && !field.choices && typeof field.default !== 'string') return '';
  return field.default === undefined ? null : field.default;
}

/** Objects that are no part of a document when it does not state them: an unmodified flank, a case without its own. */
const ABSENT = ['gear', 'coast'];

/**
 * The document with every key that has a default; what the service would assume is written out. Entry keys are other
 * ways to state a value and stand in no document.
 * @template D @param {Field[]} fields @param {D} document
 */
export function complete(fields, document) {
  const whole = /** @type {Record<string, unknown>} */ ({ ...document });
  for (const field of fields) {
    const missing = whole[field.key] === undefined;
    if (field.entry) continue;
    if (field.kind === 'object' && field.fields) {
      if (missing && (ABSENT.includes(field.key) || field.nullable)) continue;
      if (whole[field.key] !== null) whole[field.key] = complete(field.fields, whole[field.key] ?? {});
    } else if (field.kind === 'list') {
      const rows = whole[field.key];
      if (Array.isArray(rows)) whole[field.key] = rows.map(row => complete(field.fields ?? [], row));
    } else if (missing && !field.required) {
      whole[field.key] = fallbackOf(field);
    }
  }
  return /** @type {D} */ (whole);
}

/** Why a number cannot be taken, or nothing. @param {Field} field @param {number} value */
export function numberFault(field, value) {
  if ((field.kind === 'integer' || field.kind === 'seed') && !Number.isInteger(value))
    return 'A whole number is needed.';
  const low = field.low ?? -Infinity;
  const high = field.high ?? Infinity;
  if (value < low || value > high) {
    const [shown, from, to] = [value, low, high].map(each => shownValue(each, field.unit));
    return unitInstead(field.unit)
      ? `${plain(shown)} is outside ${plain(from)} … ${plain(to)} ${unitOf(field)}.`
      : `${value} is outside ${low} … ${high}.`;
  }
  return '';
}
