// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a search: any column against any other, or all of them as parallel axes; new evaluations, known ones and
// the best told apart.
import { fill, h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { colour } from '../base/theme.js';
import { shownBelow, shownHead, units } from '../base/units.js';
import { ROW, nameRows } from './axis_names.js';
import { Painting, SMALL } from './canvas.js';
import { scaleColour } from './colours.js';
import { placeTip } from './frame.js';
import { tickText, ticks } from './ticks.js';

/** @typedef {{ values: (number | null)[], kind: 'new' | 'known' | 'front', mark?: string, pick?: () => void }} Dot */
/** @typedef {{ columns: string[], dots: Dot[] }} Cloud lengths in mm and µm, as "(mm)" ending a column says */

const NEAR = 12; // px
const BOX = { left: 46, top: 10, right: 12, bottom: 32 };

/** @param {(number | null)[]} values @param {number} [margin] part of the range @returns {[number, number]} */
function extent(values, margin = 0.04) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null || !Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  const pad = high > low ? (high - low) * margin : Math.abs(high) * 0.05 || 1;
  return [low - pad, high + pad];
}

export class Scatter {
  /** @type {Cloud} */ #cloud = { columns: [], dots: [] };
  #x = '';
  #y = '';
  /** @type {{ dot: Dot, x: number, y: number }[]} */ #places = [];

  /** @param {{ title: string, help: string, x: string, y: string, wide?: boolean }} options */
  constructor({ title, help, x, y, wide }) {
    this.#x = x;
    this.#y = y;
    this.across = h('select.small-select', {
      'aria-label': 'Across',
      onchange: () => {
        this.#x = this.across.value;
        this.painting.repaint();
      },
    });
    this.up = h('select.small-select', {
      'aria-label': 'Upwards',
      onchange: () => {
        this.#y = this.up.value;
        this.painting.repaint();
      },
    });
    this.painting = new Painting({ title, help, wide }, (pen, width, height) => this.#paint(pen, width, height), {
      table: () => this.#table(),
    });
    this.painting.element.classList.remove('keyless');
    this.painting.frame.legend.append(h('span.range-fields', null, this.up, ' over ', this.across));
    this.tip = h('.tip', { hidden: true });
    this.painting.frame.body.append(this.tip);
    this.painting.canvas.addEventListener('pointermove', event => this.#point(event));
    this.painting.canvas.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
    });
    this.painting.canvas.addEventListener('click', event => this.#nearest(event)?.dot.pick?.());
    this.element = this.painting.element;
    units.addEventListener('change', () => {
      for (const select of [this.across, this.up])
        for (const option of select.options) option.textContent = shownHead(option.value);
    });
  }

  /** What the next columns are shown over. @param {string} x @param {string} y */
  turn(x, y) {
    if (this.#cloud.columns.includes(x)) return;
    this.#x = x;
    this.#y = y;
  }

  /** @param {Cloud} cloud */
  set(cloud) {
    const shape = cloud.columns.join('|');
    if (shape !== this.#cloud.columns.join('|')) {
      if (!cloud.columns.includes(this.#x)) this.#x = cloud.columns[0] ?? '';
      if (!cloud.columns.includes(this.#y)) this.#y = cloud.columns[cloud.columns.length - 1] ?? '';
      for (const [select, value] of /** @type {[HTMLSelectElement, string][]} */ ([
        [this.across, this.#x],
        [this.up, this.#y],
      ])) {
        fill(
          select,
          cloud.columns.map(name => h('option', { value: name }, shownHead(name))),
        );
        select.value = value;
      }
    }
    this.#cloud = cloud;
    this.painting.repaint();
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    const [i, j] = [this.#cloud.columns.indexOf(this.#x), this.#cloud.columns.indexOf(this.#y)];
    this.#places = [];
    if (i < 0 || j < 0) return;
    const [x0, x1] = extent(this.#cloud.dots.map(dot => shownBelow(dot.values[i], this.#x)));
    const [y0, y1] = extent(this.#cloud.dots.map(dot => shownBelow(dot.values[j], this.#y)));
    const [w, t] = [width - BOX.left - BOX.right, height - BOX.top - BOX.bottom];
    /** @param {number} value */
    const across = value => BOX.left + ((value - x0) / (x1 - x0)) * w;
    /** @param {number} value */
    const down = value => BOX.top + (1 - (value - y0) / (y1 - y0)) * t;
    axes(pen, width, height, [x0, x1], [y0, y1], across, down);
    pen.fillStyle = colour('muted');
    pen.textAlign = 'center';
    pen.fillText(shownHead(this.#x), BOX.left + w / 2, height - 4);
    for (const dot of this.#cloud.dots) {
      const [vx, vy] = [shownBelow(dot.values[i], this.#x), shownBelow(dot.values[j], this.#y)];
      if (vx === null || vy === null) continue;
      const place = { dot, x: across(vx), y: down(vy) };
      this.#places.push(place);
      pen.beginPath();
      pen.arc(place.x, place.y, dot.mark ? 5.5 : dot.kind === 'front' ? 4 : 2.5, 0, 2 * Math.PI);
      pen.globalAlpha = dot.mark || dot.kind === 'front' ? 1 : 0.7;
      if (dot.kind === 'known' && !dot.mark) {
        pen.strokeStyle = colour('known');
        pen.lineWidth = 1;
        pen.stroke();
      } else {
        pen.fillStyle = colour(dot.mark === 'start' ? 'reference' : dot.mark ? 'best' : 'evaluated');
        pen.fill();
      }
      pen.globalAlpha = 1;
      if (!dot.mark) continue;
      pen.fillStyle = colour('text');
      pen.textAlign = place.x > width - 70 ? 'right' : 'left';
      pen.fillText(dot.mark, place.x + (place.x > width - 70 ? -8 : 8), place.y - 5);
    }
  }

  /** @param {PointerEvent | MouseEvent} event */
  #nearest(event) {
    let best = null;
    let least = NEAR;
    for (const place of this.#places) {
      const distance = Math.hypot(place.x - event.offsetX, place.y - event.offsetY);
      if (distance < least) [least, best] = [distance, place];
    }
    return best;
  }

  /** @param {PointerEvent} event */
  #point(event) {
    const place = this.#nearest(event);
    this.tip.hidden = !place;
    this.painting.canvas.style.cursor = place?.dot.pick ? 'pointer' : '';
    if (!place) return;
    fill(
      this.tip,
      h(
        '.tip-x',
        null,
        place.dot.kind === 'known' ? 'known from before' : place.dot.kind === 'new' ? 'evaluated' : 'front',
        place.dot.pick ? ' – click to open' : '',
      ),
      this.#cloud.columns.map((name, k) =>
        h(
          '.tip-row',
          null,
          h('span', null, shownHead(name)),
          h('b', null, sig(shownBelow(place.dot.values[k], name), 4)),
        ),
      ),
    );
    placeTip(this.tip, place.x, this.painting.frame.body.clientWidth);
  }

  #table() {
    return [['kind', ...this.#cloud.columns], ...this.#cloud.dots.map(dot => [dot.kind, ...dot.values])];
  }
}

/**
 * @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height
 * @param {[number, number]} xs @param {[number, number]} ys
 * @param {(value: number) => number} across @param {(value: number) => number} down
 */
function axes(pen, width, height, xs, ys, across, down) {
  pen.font = SMALL;
  pen.lineWidth = 1;
  pen.strokeStyle = colour('grid');
  pen.fillStyle = colour('muted');
  for (const value of ticks(...xs)) {
    pen.beginPath();
    pen.moveTo(across(value), BOX.top);
    pen.lineTo(across(value), height - BOX.bottom);
    pen.stroke();
    pen.textAlign = 'center';
    pen.fillText(tickText(value), across(value), height - BOX.bottom + 12);
  }
  for (const value of ticks(...ys)) {
    pen.beginPath();
    pen.moveTo(BOX.left, down(value));
    pen.lineTo(width - BOX.right, down(value));
    pen.stroke();
    pen.textAlign = 'right';
    pen.fillText(tickText(value), BOX.left - 5, down(value) + 3);
  }
}

export class Parallel {
  /** @type {Cloud} */ #cloud = { columns: [], dots: [] };

  /** @param {string} title */
  constructor(title) {
    this.painting = new Painting(
      {
        title,
        wide: true,
        help: 'One line for each true evaluation through all its variables; the better the later and the brighter',
      },
      (pen, width, height) => this.#paint(pen, width, height),
    );
    this.element = this.painting.element;
  }

  /** The last column is the one that is judged. @param {Cloud} cloud */
  set(cloud) {
    this.#cloud = cloud;
    this.painting.repaint();
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    const dots = this.#cloud.dots.map(dot => ({
      ...dot,
      values: dot.values.map((value, k) => shownBelow(value, this.#cloud.columns[k])),
    }));
    const columns = this.#cloud.columns.map(shownHead);
    if (columns.length < 2 || dots.length === 0) return;
    const ranges = columns.map((_, k) =>
      extent(
        dots.map(dot => dot.values[k]),
        0,
      ),
    );
    const last = columns.length - 1;
    const [left, right, top] = [34, width - 34, 16];
    /** @param {number} k */
    const across = k => left + ((right - left) * k) / last;
    pen.font = SMALL;
    const { places, rows } = nameRows(pen, columns, across, width);
    const bottom = height - 14 - rows * ROW;
    const ordered = [...dots].sort((a, b) => (b.values[last] ?? Infinity) - (a.values[last] ?? Infinity));
    ordered.forEach((dot, rank) => {
      const part = ordered.length > 1 ? rank / (ordered.length - 1) : 1;
      const best = rank === ordered.length - 1;
      const [r, g, b] = scaleColour(0.9 * part);
      pen.strokeStyle = best ? colour('best') : `rgb(${r} ${g} ${b})`;
      pen.globalAlpha = best ? 1 : 0.15 + 0.4 * part;
      pen.lineWidth = best ? 2 : 1;
      pen.beginPath();
      dot.values.forEach((value, k) => {
        const [low, high] = ranges[k];
        const y = bottom - (((value ?? low) - low) / (high - low)) * (bottom - top);
        if (k === 0) pen.moveTo(across(k), y);
        else pen.lineTo(across(k), y);
      });
      pen.stroke();
    });
    pen.globalAlpha = 1;
    pen.font = SMALL;
    pen.textAlign = 'center';
    columns.forEach((name, k) => {
      pen.strokeStyle = colour('mark');
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(across(k), top);
      pen.lineTo(across(k), bottom);
      pen.stroke();
      pen.fillStyle = colour('muted');
      pen.fillText(sig(ranges[k][1], 3), across(k), top - 5);
      pen.fillText(sig(ranges[k][0], 3), across(k), bottom + 10);
      pen.fillText(name, places[k].x, height - 2 - (rows - 1 - places[k].row) * ROW);
    });
  }
}
