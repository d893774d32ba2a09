// SPDX-License-Identifier: GPL-3.0-or-later
// A figure as a picture that stands alone: title, load case, drawing with its axes, whole legend, design and date.
import { withPaperColours, colour } from '../base/theme.js';
import { subject } from './subject.js';
import { SvgPen } from './svg_pen.js';

const MARGIN = 16;
const HEAD = 46;
const LINE = 17;
const FOOT = 22;
const PIXELS = 2; // of a PNG for each unit: 1600 across
const FAMILY = 'system-ui, sans-serif';
const DASHES = /** @type {Record<string, number[]>} */ ({ dashed: [5, 4], dotted: [1.5, 3] });

/** @typedef {CanvasRenderingContext2D} Pen */
/** @typedef {{ label: string, colour: string, line?: string }} Key */
/** @typedef {{ width: number, height: number, foot: boolean }} Size of the drawing; foot: design and date below it */

/** @type {Size} a picture of its own */
const ALONE = { width: 800, height: 400, foot: true };

/**
 * @typedef {object} Content
 * @property {string} title @property {string} [unit] @property {string} [about] load case and what is shown
 * @property {Key[]} keys
 * @property {(pen: Pen, width: number, height: number) => void} paint
 */

/** Keys row by row. @param {Pen} pen @param {Key[]} keys @param {number} width */
function arrange(pen, keys, width) {
  pen.font = `11px ${FAMILY}`;
  let [left, row] = [0, 0];
  return keys.map(key => {
    const own = 24 + pen.measureText(key.label).width + 14;
    if (left > 0 && left + own > width) {
      left = 0;
      row += 1;
    }
    const place = { key, left, row };
    left += own;
    return place;
  });
}

/** @param {Pen} pen @param {ReturnType<typeof arrange>} places @param {number} left @param {number} top */
function paintKeys(pen, places, left, top) {
  for (const { key, left: x, row } of places) {
    const y = top + row * LINE;
    pen.strokeStyle = colour(key.colour);
    pen.lineWidth = 2;
    pen.setLineDash(DASHES[key.line ?? ''] ?? []);
    pen.beginPath();
    pen.moveTo(left + x, y - 4);
    pen.lineTo(left + x + 18, y - 4);
    pen.stroke();
    pen.setLineDash([]);
    pen.fillStyle = colour('text');
    pen.textAlign = 'left';
    pen.fillText(key.label, left + x + 24, y);
  }
}

/** @param {Content} content @param {Pen} ruler @param {Size} size */
function measure(content, ruler, size) {
  const places = arrange(ruler, content.keys, size.width - 2 * MARGIN);
  const rows = places.length ? places[places.length - 1].row + 1 : 0;
  return { ...size, places, rows, whole: HEAD + size.height + rows * LINE + 8 + (size.foot ? FOOT : 0) };
}

/**
 * A line in a smaller font when it would not fit.
 * @param {Pen} pen
 * @param {string} text
 * @param {number} y
 * @param {number} room
 */
function paintLine(pen, text, y, room) {
  const size = Number(/([\d.]+)px/.exec(pen.font)?.[1] ?? 11);
  const wide = pen.measureText(text).width;
  if (wide > room) pen.font = pen.font.replace(/[\d.]+px/, `${((size * room) / wide).toFixed(1)}px`);
  pen.fillText(text, MARGIN, y);
}

/** @param {Pen} pen @param {Content} content @param {ReturnType<typeof measure>} size */
function paintSheet(pen, content, { places, rows, width, height, whole, foot }) {
  const room = width - 2 * MARGIN;
  pen.fillStyle = colour('panel');
  pen.fillRect(0, 0, width, whole);
  pen.fillStyle = colour('text');
  pen.font = `600 15px ${FAMILY}`;
  pen.textAlign = 'left';
  paintLine(pen, content.unit ? `${content.title}, ${content.unit}` : content.title, 22, room);
  pen.fillStyle = colour('muted');
  pen.font = `11px ${FAMILY}`;
  if (content.about) paintLine(pen, content.about, 38, room);
  pen.save();
  pen.translate(MARGIN, HEAD);
  content.paint(pen, room, height);
  pen.restore();
  pen.font = `11px ${FAMILY}`;
  paintKeys(pen, places, MARGIN, HEAD + height + LINE);
  if (!foot) return;
  pen.fillStyle = colour('muted');
  pen.textAlign = 'left';
  pen.font = `10px ${FAMILY}`;
  paintLine(pen, subject.line, HEAD + height + rows * LINE + 8 + 14, room);
}

/** @param {Content} content @param {Size} [size] @returns {SVGSVGElement} */
export function sheetAsSvg(content, size = ALONE) {
  return withPaperColours(() => {
    const ruler = /** @type {Pen} */ (document.createElement('canvas').getContext('2d'));
    const measured = measure(content, ruler, size);
    const pen = new SvgPen(measured.width, measured.whole);
    paintSheet(/** @type {Pen} */ (/** @type {unknown} */ (pen)), content, measured);
    return pen.root;
  });
}

/** @param {Content} content @returns {HTMLCanvasElement} */
export function sheetAsCanvas(content) {
  return withPaperColours(() => {
    const canvas = document.createElement('canvas');
    const pen = /** @type {Pen} */ (canvas.getContext('2d'));
    const measured = measure(content, pen, ALONE);
    canvas.width = measured.width * PIXELS;
    canvas.height = Math.ceil(measured.whole * PIXELS);
    pen.scale(PIXELS, PIXELS);
    paintSheet(pen, content, measured);
    return canvas;
  });
}
