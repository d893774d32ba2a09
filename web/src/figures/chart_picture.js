// SPDX-License-Identifier: GPL-3.0-or-later
// Curves as they go to paper: axes with units, marks, curves or groups of bars.
import { colour } from '../base/theme.js';
import { tickText, ticks } from './ticks.js';

const BOX = { left: 58, top: 10, right: 20, bottom: 40 };
const SMALL = '10px system-ui, sans-serif';
const LABEL = '11px system-ui, sans-serif';
const DASHES = { solid: [], dashed: [5, 4], dotted: [1.5, 3] };

/** @typedef {import('./chart.js').Curve & { shown: ArrayLike<number | null | undefined> }} Drawn on the common x */
/**
 * @typedef {object} Plot
 * @property {CanvasRenderingContext2D} pen @property {number} width @property {number} height
 * @property {ArrayLike<number>} x @property {Drawn[]} curves @property {import('./chart.js').Mark[]} marks
 * @property {import('./chart.js').ChartOptions} options
 * @property {(value: number) => number} across @property {(value: number) => number} down
 * @property {[number, number]} xs @property {[number, number]} ys
 */

/** @param {number | null} low @param {number | null} high @param {boolean} zero @returns {[number, number]} */
export function yRange(low, high, zero) {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  const span = Math.max(high - low, 1e-3 * Math.max(Math.abs(low), Math.abs(high)), 1e-9);
  return [zero && low >= 0 ? 0 : low - 0.06 * span, high + 0.06 * span];
}

/** @param {Drawn[]} curves @param {boolean} zero @returns {[number, number]} */
function extent(curves, zero) {
  let [low, high] = [Infinity, -Infinity];
  for (const { shown } of curves) {
    for (let i = 0; i < shown.length; i++) {
      const value = shown[i];
      if (value === null || value === undefined || !Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  return yRange(low, high, zero);
}

/**
 * @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height
 * @param {{ x: ArrayLike<number>, curves: Drawn[], marks: import('./chart.js').Mark[] }} data
 * @param {import('./chart.js').ChartOptions} options
 */
export function paintChart(pen, width, height, { x, curves, marks }, options) {
  const half = options.bars ? 0.6 : 0;
  const xs = /** @type {[number, number]} */ ([x[0] - half, x[x.length - 1] + half]);
  const ys = extent(curves, Boolean(options.zero || options.bars));
  const [w, t] = [width - BOX.left - BOX.right, height - BOX.top - BOX.bottom];
  const plot = {
    ...{ pen, width, height, x, curves, marks, options, xs, ys },
    across: (/** @type {number} */ value) => BOX.left + ((value - xs[0]) / (xs[1] - xs[0] || 1)) * w,
    down: (/** @type {number} */ value) => BOX.top + (1 - (value - ys[0]) / (ys[1] - ys[0])) * t,
  };
  paintAxes(plot);
  paintMarks(plot);
  if (options.bars) paintBars(plot);
  else for (const curve of curves) paintCurve(plot, curve);
  pen.strokeStyle = colour('mark');
  pen.lineWidth = 1;
  pen.setLineDash([]);
  pen.strokeRect(BOX.left, BOX.top, w, t);
}

/** @param {Plot} plot */
function paintAxes({ pen, width, height, x, options, across, down, xs, ys }) {
  pen.font = SMALL;
  pen.lineWidth = 1;
  pen.setLineDash([]);
  const places = options.bars ? Array.from(x) : ticks(xs[0], xs[1], options.whole);
  for (const value of places) {
    pen.strokeStyle = colour('grid');
    if (!options.bars) line(pen, [across(value), BOX.top], [across(value), height - BOX.bottom]);
    pen.fillStyle = colour('muted');
    pen.textAlign = 'center';
    pen.fillText(tickText(value), across(value), height - BOX.bottom + 13);
  }
  for (const value of ticks(ys[0], ys[1])) {
    pen.strokeStyle = colour('grid');
    line(pen, [BOX.left, down(value)], [width - BOX.right, down(value)]);
    pen.fillStyle = colour('muted');
    pen.textAlign = 'right';
    pen.fillText(tickText(value), BOX.left - 5, down(value) + 3);
  }
  pen.fillStyle = colour('text');
  pen.font = LABEL;
  pen.textAlign = 'center';
  const xText = options.xUnit ? `${options.xLabel}, ${options.xUnit}` : options.xLabel;
  pen.fillText(xText, BOX.left + (width - BOX.left - BOX.right) / 2, height - 8);
}

/** @param {CanvasRenderingContext2D} pen @param {[number, number]} from @param {[number, number]} to */
function line(pen, from, to) {
  pen.beginPath();
  pen.moveTo(...from);
  pen.lineTo(...to);
  pen.stroke();
}

/** @param {Plot} plot */
function paintMarks({ pen, width, height, marks, across, xs }) {
  let edge = -Infinity;
  pen.font = SMALL;
  for (const mark of marks) {
    if (mark.x < xs[0] || mark.x > xs[1]) continue;
    const x = across(mark.x);
    pen.strokeStyle = colour(mark.strong ? 'mark' : 'grid');
    pen.setLineDash(mark.strong ? [] : [2, 2]);
    line(pen, [x, BOX.top], [x, height - BOX.bottom]);
    if (!mark.label || x < edge) continue;
    pen.fillStyle = colour('muted');
    const own = pen.measureText(mark.label).width;
    const beyond = x + own + 3 > width - BOX.right;
    pen.textAlign = beyond ? 'right' : 'left';
    pen.fillText(mark.label, beyond ? x - 3 : x + 3, BOX.top + 10);
    edge = x + own + 8;
  }
  pen.setLineDash([]);
}

/** @param {Plot} plot @param {Drawn} curve */
function paintCurve({ pen, x, across, down }, curve) {
  pen.strokeStyle = colour(curve.colour);
  pen.lineWidth = curve.width ?? (curve.line ? 1.25 : 1.75);
  pen.setLineDash(DASHES[curve.line ?? 'solid']);
  pen.beginPath();
  let on = false;
  for (let i = 0; i < x.length; i++) {
    const value = curve.shown[i];
    if (value === null || value === undefined) on = false;
    else if (on) pen.lineTo(across(x[i]), down(value));
    else {
      pen.moveTo(across(x[i]), down(value));
      on = true;
    }
  }
  pen.stroke();
  pen.setLineDash([]);
}

/** Solid curves side by side; those of a reference pale behind the bar of the same colour. @param {Plot} plot */
function paintBars({ pen, x, curves, across, down }) {
  const solid = curves.filter(curve => !curve.line || curve.line === 'solid');
  const step = x.length > 1 ? across(x[1]) - across(x[0]) : across(x[0] + 0.5) - across(x[0] - 0.5);
  const width = (0.76 * step) / Math.max(1, solid.length);
  for (const curve of curves) {
    const pale = Boolean(curve.line) && curve.line !== 'solid';
    const slot = pale ? solid.findIndex(other => other.colour === curve.colour) : solid.indexOf(curve);
    pen.fillStyle = pen.strokeStyle = colour(curve.colour);
    for (let i = 0; i < x.length; i++) {
      const value = curve.shown[i];
      if (value === null || value === undefined) continue;
      const left = across(x[i]) + (Math.max(0, slot) - solid.length / 2) * width;
      pen.globalAlpha = pale ? 0.22 : 1;
      pen.fillRect(left + 0.5, down(value), Math.max(1, width - 1), down(0) - down(value));
      pen.globalAlpha = 1;
      if (!pale) continue;
      pen.setLineDash([3, 2]);
      pen.lineWidth = 1;
      line(pen, [left + 0.5, down(value)], [left + width - 0.5, down(value)]);
      pen.setLineDash([]);
    }
  }
}
