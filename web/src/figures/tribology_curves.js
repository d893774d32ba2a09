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
 * @param {any[]} sides of the ends
 */
function peaksOf(sides) {
  return {
    flash: Math.max(...sides.map(side => side.max_flash_K)),
    filmRatio: Math.min(...sides.map(side => side.min_film_ratio)),
    sliding: Math.max(...sides.map(side => side.max_sliding_m_per_s)),
  };
}

/**
 * Curves of a load case; null where the result has no maps of it.
 * @param {any} result with its tribology
 * @param {number} index of the load case
 * @param {('left' | 'right')[]} ends
 */
export function tribologyCurves(result, index, ends) {
  const tribology = result?.tribology;
  const loadCase = tribology?.load_cases?.[index];
  if (!loadCase || !ends.every(end => loadCase[end]?.flash_K && loadCase[end]?.film_um)) return null;
  const pitchPoint = result.geometry.tangent_length_mm[0];
  /** @param {(side: any) => (number | null)[]} curve @returns {EndCurve[]} */
  const each = curve => ends.map(end => ({ end, y: curve(loadCase[end]) }));
  return {
    pitchPoint,
    roll: tribology.s_mm.map((/** @type {number} */ s) => pitchPoint + s),
    flash: each(side => overFace(side.flash_K, Math.max)),
    filmRatio: each(side =>
      overFace(side.film_um, Math.min).map(film => (film === null ? null : film / loadCase.roughness_um)),
    ),
    peak: peaksOf(ends.map(end => loadCase[end])),
    sliding: /** @type {number[]} */ (loadCase.sliding_m_per_s),
  };
}
