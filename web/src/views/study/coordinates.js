// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel coordinates: a vertical axis for each number, a line across them for each variant; a range dragged along an
// axis keeps the rows in it.
import { h } from '../../base/dom.js';
import { unitText } from '../../base/format.js';
import { ROW, nameRows } from '../../figures/axis_names.js';
import { shownUnit, shownValue, units } from '../../base/units.js';
import { shortName } from './rows.js';

const MOST_AXES = 10;
const EACH = 84; // px of an axis with its name and numbers
const HEIGHT = 230;
const LEAST_TOP = 30;
const BOTTOM = 22;
const SIDE = 46;
const PIECE = 300; // lines drawn at a time: a few milliseconds
const LEAST = 4; // px of a drag that is none

export class Coordinates {
  /** Columns that have an axis. @type {number[]} */ #axes = [];
  /** @type {Map<number, [number, number]>} */ #ranges = new Map();
  #turn = 0;
  /** Where the axes begin, below their names. */
  #top = LEAST_TOP;
  /** @type {{ axis: number, from: number, to: number } | null} */ #drag = null;

  /** @param {import('./rows.js').Rows} rows */
  constructor(rows) {
    this.rows = rows;
    this.canvas = h('canvas');
    this.element = h(
      'figure.figure.coordinates',
      { role: 'img', 'aria-label': 'Parallel coordinates of the variants' },
      this.canvas,
    );
    new ResizeObserver(() => this.#draw()).observe(this.element);
    units.addEventListener('change', () => this.#draw());
    rows.addEventListener('change', () => {
      this.#choose();
      this.#draw();
    });
    this.canvas.addEventListener('pointerdown', event => this.#begin(event));
    this.canvas.addEventListener('pointermove', event => this.#move(event));
    this.canvas.addEventListener('pointerup', () => this.#end());
    this.canvas.addEventListener('pointercancel', () => this.#end());
  }

  /** What varies, then what comes of it, as many as have room. */
  #choose() {
    const { columns, count } = this.rows;
    this.#ranges.clear();
    this.#axes = [];
    columns.forEach((column, at) => {
      let low = Infinity;
      let high = -Infinity;
      for (let row = 0; row < count; row++) {
        const number = column.value[row];
        if (number < low) low = number;
        if (number > high) high = number;
      }
      if (this.#axes.length >= MOST_AXES || !(high > low)) return;
      this.#ranges.set(at, [low, high]);
      this.#axes.push(at);
    });
    this.element.hidden = this.#axes.length < 2;
  }

  /** @param {number} axis */
  #x(axis) {
    return SIDE + (axis * (this.#width - 2 * SIDE)) / Math.max(1, this.#axes.length - 1);
  }

  /** A narrow screen scrolls over them. */
  get #width() {
    const { clientWidth } = this.element;
    return clientWidth && Math.max(clientWidth, EACH * this.#axes.length);
  }

  /** @param {number} column @param {number} number */
  #y(column, number) {
    const [low, high] = this.#ranges.get(column) ?? [0, 1];
    return this.#top + (1 - (number - low) / (high - low)) * (HEIGHT - this.#top - BOTTOM);
  }

  /** @param {number} column @param {number} y */
  #number(column, y) {
    const [low, high] = this.#ranges.get(column) ?? [0, 1];
    return low + (1 - (y - this.#top) / (HEIGHT - this.#top - BOTTOM)) * (high - low);
  }

  #draw() {
    const { canvas } = this;
    const width = this.#width;
    const scale = devicePixelRatio || 1;
    if (!width || this.element.hidden) return;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(HEIGHT * scale);
    Object.assign(canvas.style, { width: `${width}px`, height: `${HEIGHT}px` });
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    const style = getComputedStyle(this.element);
    const colour = {
      line: style.getPropertyValue('--accent').trim(),
      ink: style.getPropertyValue('--ink').trim() || style.color,
    };
    pen.font = '11px system-ui, sans-serif';
    const names = this.#axes.map(column => {
      const { name, unit } = this.rows.columns[column];
      return unit ? `${shortName(name)}, ${shownUnit(unitText(unit))}` : shortName(name);
    });
    const { places, rows } = nameRows(pen, names, axis => this.#x(axis), width);
    this.#top = Math.max(LEAST_TOP, 6 + rows * ROW);
    this.#drawLines(pen, colour.line, 0, ++this.#turn);
    this.#drawAxes(pen, colour);
    pen.fillStyle = colour.ink;
    names.forEach((name, axis) => pen.fillText(name, places[axis].x, 10 + places[axis].row * ROW));
  }

  /** @param {CanvasRenderingContext2D} pen @param {string} colour @param {number} from @param {number} turn */
  #drawLines(pen, colour, from, turn) {
    const { order, columns } = this.rows;
    const to = Math.min(order.length, from + PIECE);
    if (turn !== this.#turn) return;
    pen.strokeStyle = colour;
    pen.globalAlpha = Math.max(0.04, Math.min(0.7, 40 / Math.max(1, order.length)));
    pen.lineWidth = 1;
    pen.beginPath();
    for (let at = from; at < to; at++) {
      let open = false;
      this.#axes.forEach((column, axis) => {
        const number = columns[column].value[order[at]];
        if (Number.isNaN(number)) open = false;
        else if (open) pen.lineTo(this.#x(axis), this.#y(column, number));
        else {
          pen.moveTo(this.#x(axis), this.#y(column, number));
          open = true;
        }
      });
    }
    pen.stroke();
    pen.globalAlpha = 1;
    if (to < order.length) requestAnimationFrame(() => this.#drawLines(pen, colour, to, turn));
  }

  /** @param {CanvasRenderingContext2D} pen @param {{ line: string, ink: string }} colour */
  #drawAxes(pen, colour) {
    pen.textAlign = 'center';
    this.#axes.forEach((column, axis) => {
      const x = this.#x(axis);
      const [low, high] = this.#ranges.get(column) ?? [0, 1];
      const { words, unit } = this.rows.columns[column];
      pen.fillStyle = pen.strokeStyle = colour.ink;
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(x, this.#top);
      pen.lineTo(x, HEIGHT - BOTTOM);
      pen.stroke();
      /** @param {number} number */
      const text = number => (words ? (words[number] ?? '') : String(Number(shownValue(number, unit).toPrecision(3))));
      pen.fillText(text(high), x + 22, this.#top + 8);
      pen.fillText(text(low), x, HEIGHT - 8);
      const brush = this.#drag?.axis === axis ? [this.#drag.from, this.#drag.to] : this.rows.brushes.get(column);
      if (!brush) return;
      const [one, other] = brush.map(number => this.#y(column, number));
      pen.globalAlpha = 0.35;
      pen.fillStyle = colour.line;
      pen.fillRect(x - 7, Math.min(one, other), 14, Math.max(2, Math.abs(other - one)));
      pen.globalAlpha = 1;
    });
  }

  /** @param {PointerEvent} event */
  #begin(event) {
    const axis = this.#axes.findIndex((_column, at) => Math.abs(event.offsetX - this.#x(at)) < 18);
    if (axis < 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    const number = this.#number(this.#axes[axis], event.offsetY);
    this.#drag = { axis, from: number, to: number };
  }

  /** @param {PointerEvent} event */
  #move(event) {
    if (!this.#drag) return;
    this.#drag.to = this.#number(this.#axes[this.#drag.axis], event.offsetY);
    this.#draw();
  }

  #end() {
    const drag = this.#drag;
    this.#drag = null;
    if (!drag) return;
    const column = this.#axes[drag.axis];
    const length = Math.abs(this.#y(column, drag.from) - this.#y(column, drag.to));
    this.rows.brush(column, length < LEAST ? null : [Math.min(drag.from, drag.to), Math.max(drag.from, drag.to)]);
  }
}
