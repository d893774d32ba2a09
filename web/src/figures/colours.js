// SPDX-License-Identifier: GPL-3.0-or-later
// Colour scale of pressures: dark blue through green to yellow, even in lightness (viridis, sampled), nothing at zero.
const STOPS = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];

/** @param {number} part 0..1 @returns {[number, number, number]} 0..255 */
export function scaleColour(part) {
  const place = Math.min(Math.max(part, 0), 1) * (STOPS.length - 1);
  const below = Math.min(Math.floor(place), STOPS.length - 2);
  const t = place - below;
  const [a, b] = [STOPS[below], STOPS[below + 1]];
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}

/**
 * Bilinear value of a regular grid [rows][columns] at fractional indices.
 * @param {Page.Curve[]} grid places without a value count as 0
 * @param {number} row
 * @param {number} column
 */
export function gridValue(grid, row, column) {
  const at = (/** @type {number} */ i, /** @type {number} */ j) => grid[i][j] ?? 0;
  const i = Math.min(Math.max(Math.floor(row), 0), grid.length - 2);
  const j = Math.min(Math.max(Math.floor(column), 0), grid[0].length - 2);
  const [u, v] = [Math.min(Math.max(row - i, 0), 1), Math.min(Math.max(column - j, 0), 1)];
  return (
    (at(i, j) * (1 - v) + at(i, j + 1) * v) * (1 - u) + (at(i + 1, j) * (1 - v) + at(i + 1, j + 1) * v) * u
  );
}
