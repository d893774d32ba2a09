// SPDX-License-Identifier: GPL-3.0-or-later
// Round numbers along an axis.

/** Four or five of a range; whole: no fractions. @param {number} low @param {number} high @param {boolean} [whole] */
export function ticks(low, high, whole = false) {
  const raw = (high - low) / 4;
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  let step = [1, 2, 2.5, 5, 10].map(factor => factor * power).find(candidate => candidate >= raw * 0.999) ?? raw;
  if (whole) step = Math.max(1, Math.round(step));
  const values = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * (high - low); i++)
    values.push(Number((i * step).toPrecision(10)));
  return values;
}

/** @param {number} value */
export function tickText(value) {
  return String(Number(value.toPrecision(6))).replace('-', '−');
}
