// SPDX-License-Identifier: GPL-3.0-or-later
// Names of parallel axes in as many rows as they need: on a narrow screen they would stand on one another.

const GAP = 8; // px between two names of a row
export const ROW = 12; // px

/**
 * The middle of each name and its row: the first in which it stands free of the names before it.
 * @param {CanvasRenderingContext2D} pen with the font of the names
 * @param {string[]} names
 * @param {(k: number) => number} at middle of an axis
 * @param {number} width of the figure
 */
export function nameRows(pen, names, at, width) {
  /** @type {number[]} */
  const ends = []; // of each row
  const places = names.map((name, k) => {
    const half = pen.measureText(name).width / 2;
    const x = Math.min(Math.max(at(k), half + 2), Math.max(half + 2, width - half - 2));
    const free = ends.findIndex(end => x - half >= end + GAP);
    const row = free < 0 ? ends.length : free;
    ends[row] = x + half;
    return { x, row };
  });
  return { places, rows: ends.length };
}
