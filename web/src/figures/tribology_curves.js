// SPDX-License-Identifier: GPL-3.0-or-later
// Sliding, flash temperature and film of a result over the path of contact, from its maps over the flank.

/** @typedef {(number | null)[][]} Map a row for every place of the path, a number for every place over the face */
/** @typedef {{ end: 'left' | 'right', y: (number | null)[] }} EndCurve */

/**
 * The largest or least value over the face at each place of the path; null where nothing touches.
 * @param {Map} map
 * @param {(...values: number[]) => number} pick Math.max or Math.min
 */
export function overFace(map, pick) {
  return map.map(row => {
    const values = row.filter(value => value !== null);
    return values.length ? pick(...values) : null;
  });
}

/**
 * Of all points of the contact, which lie closer than those of the maps.
 * @param {Api.TribologyEnd[]} sides of the ends
 */
function peaksOf(sides) {
  return {
    flash: Math.max(...sides.map(side => side.max_flash_K ?? NaN)),
    filmRatio: Math.min(...sides.map(side => side.min_film_ratio ?? NaN)),
    sliding: Math.max(...sides.map(side => side.max_sliding_m_per_s ?? NaN)),
  };
}

/**
 * Curves of a load case; null where the result has no maps of it.
 * @param {Page.Result} result with its tribology
 * @param {number} index of the load case
 * @param {('left' | 'right')[]} ends
 */
export function tribologyCurves(result, index, ends) {
  const tribology = result?.tribology;
  const loadCase = tribology?.load_cases?.[index];
  const sides = ends.flatMap(end => loadCase?.[end] ?? []);
  if (!tribology || !loadCase || sides.length < ends.length) return null;
  if (!sides.every(side => side.flash_K && side.film_um)) return null;
  const pitchPoint = result.geometry.tangent_length_mm[0];
  /** @param {(side: Api.TribologyEnd) => (number | null)[]} curve @returns {EndCurve[]} */
  const each = curve => ends.map((end, i) => ({ end, y: curve(sides[i]) }));
  return {
    pitchPoint,
    roll: tribology.s_mm.map(s => pitchPoint + s),
    flash: each(side => overFace(side.flash_K ?? [], Math.max)),
    filmRatio: each(side =>
      overFace(side.film_um ?? [], Math.min).map(film => (film === null ? null : film / loadCase.roughness_um)),
    ),
    peak: peaksOf(sides),
    sliding: /** @type {number[]} */ (loadCase.sliding_m_per_s),
  };
}
