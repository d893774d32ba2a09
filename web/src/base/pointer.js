// SPDX-License-Identifier: GPL-3.0-or-later
// Values inside a document by JSON pointer ("/gear_pair/pinion_teeth").

/** @param {any} document @param {string} pointer */
export function valueAt(document, pointer) {
  let value = document;
  for (const key of pointer.split('/').slice(1)) {
    if (value === null || value === undefined) return undefined;
    value = value[key];
  }
  return value;
}

/**
 * A copy of the document with one value changed; the rest is shared.
 * @param {any} document
 * @param {string} pointer
 * @param {any} value
 */
export function withValue(document, pointer, value) {
  const keys = pointer.split('/').slice(1);
  /** @param {any} node @param {number} depth @returns {any} */
  const put = (node, depth) => {
    if (depth === keys.length) return value;
    const copy = Array.isArray(node) ? [...node] : { ...(node ?? {}) };
    const key = keys[depth] ?? '';
    copy[key] = put(copy[key], depth + 1);
    if (copy[key] === undefined) delete copy[key];
    return copy;
  };
  return put(document, 0);
}

/** @param {any} a @param {any} b */
export function same(a, b) {
  return a === b || JSON.stringify(a) === JSON.stringify(b);
}

/**
 * Where two documents differ: pointers to numbers, words and flags, or to lists of unlike length.
 * @param {any} a
 * @param {any} b
 * @param {string} [pointer]
 * @returns {string[]}
 */
export function differences(a, b, pointer = '') {
  if (same(a, b)) return [];
  const parts = [a, b].filter(each => each !== null && typeof each === 'object');
  const alike = new Set(parts.map(part => (Array.isArray(part) ? part.length : -1))).size === 1;
  const absent = [a, b].every(each => each === undefined || each === null || parts.includes(each));
  if (!alike || !absent) return [pointer];
  const keys = new Set(parts.flatMap(part => Object.keys(part)));
  return [...keys].flatMap(key => differences(a?.[key], b?.[key], `${pointer}/${key}`));
}

/**
 * Leaves of a document as "a.b.c" -> value; lists are leaves.
 * @param {any} document
 * @param {string} [prefix]
 * @param {Map<string, any>} [into]
 */
export function leaves(document, prefix = '', into = new Map()) {
  for (const [key, value] of Object.entries(document ?? {})) {
    const path = prefix ? `${prefix}.${key}` : key;
    if (value !== null && typeof value === 'object' && !Array.isArray(value)) leaves(value, path, into);
    else into.set(path, value);
  }
  return into;
}
