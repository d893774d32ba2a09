// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the page in its address: #view?from=paper&modification.pinion.left.tip_relief_um=14
import { leaves, same, withValue } from './pointer.js';

/** @typedef {{ view: string, parameters: URLSearchParams }} Place */

/** @param {string} hash @returns {Place} */
export function readPlace(hash) {
  const [view, query] = hash.replace(/^#\/?/, '').split('?', 2);
  return { view: view || 'design', parameters: new URLSearchParams(query ?? '') };
}

/** @param {string} view @param {URLSearchParams} parameters */
export function writePlace(view, parameters) {
  const query = parameters.toString();
  return `#${view}${query ? `?${query}` : ''}`;
}

/**
 * What differs from the base, one parameter for each value.
 * @param {Api.Design} base
 * @param {Api.Design} design
 * @param {URLSearchParams} parameters
 */
export function putDifference(base, design, parameters) {
  const before = leaves(base);
  const after = leaves(design);
  for (const [path, value] of after) {
    if (!same(value, before.get(path))) parameters.set(path, typeof value === 'string' ? value : JSON.stringify(value));
  }
  for (const path of before.keys()) if (!after.has(path)) parameters.set(path, '');
}

/**
 * The base with those parameters; texts that are no JSON stay texts.
 * @param {Api.Design} base
 * @param {URLSearchParams} parameters
 */
export function takeDifference(base, parameters) {
  let design = base;
  for (const [path, text] of parameters) {
    if (path !== 'name' && !path.includes('.') && path !== 'load_cases') continue;
    const pointer = `/${path.replaceAll('.', '/')}`;
    design = withValue(design, pointer, readValue(path, text));
  }
  return design;
}

/** @param {string} path @param {string} text */
function readValue(path, text) {
  if (text === '') return path === 'name' ? '' : undefined;
  if (path === 'name') return text;
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}
