// SPDX-License-Identifier: GPL-3.0-or-later
// Measured points with their uncertainty beside predicted ones.
import { fill, h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { colour } from '../base/theme.js';
import { Painting, SMALL } from './canvas.js';
import { tickText, ticks } from './ticks.js';

/**
 * @typedef {{ x: number, measured: number, sigma: number, predicted: number | null, label: string, outlier?: boolean,
 * chosen?: boolean, pick?: () => void }} Point
 */
/**
 * @typedef {{ label: string, group?: string, colour: string, open?: boolean, points: Point[] }} Series open: hollow
 * marks; group: what shares a colour
 */

const NEAR = 14; // px
const BOX = { left: 42, top: 10, right: 14, bottom: 30 };

/**
 * @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height
 * @param {number[]} xs @param {number[]} ys
 * @param {(value: number) => number} across @param {(value: number) => number} down @param {string} xLabel
 */
function axes(pen, width, height, xs, ys, across, down, xLabel) {
  pen.font = SMALL;
  pen.lineWidth = 1;
  pen.fillStyle = colour('muted');
  pen.strokeStyle = colour('grid');
  for (const value of ys) {
    pen.beginPath();
    pen.moveTo(BOX.left, down(value));
    pen.lineTo(width - BOX.right, down(value));
    pen.stroke();
    pen.textAlign = 'right';
    pen.fillText(tickText(value), BOX.left - 5, down(value) + 3);
  }
  pen.textAlign = 'center';
  for (const value of xs) pen.fillText(tickText(value), across(value), height - BOX.bottom + 12);
  pen.fillText(xLabel, BOX.left + (width - BOX.left - BOX.right) / 2, height - 3);
}

/** @param {CanvasRenderingContext2D} pen @param {number} x @param {number} low @param {number} high */
function whisker(pen, x, low, high) {
  pen.lineWidth = 1.25;
  pen.setLineDash([]);
  pen.beginPath();
  pen.moveTo(x, low);
  pen.lineTo(x, high);
  for (const y of [low, high]) {
    pen.moveTo(x - 3, y);
    pen.lineTo(x + 3, y);
  }
  pen.stroke();
}

/** RMS over torque or speed: marks with their uncertainty, predictions joined by dashes. */
export class MeasuredPoints {
  /** @type {Series[]} */ #series = [];
  /** @type {{ point: Point, series: Series, x: number, y: number }[]} */ #places = [];

  /** @param {{ title: string, unit: string, help: string, xLabel: string }} options */
  constructor({ title, unit, help, xLabel }) {
    this.xLabel = xLabel;
    this.painting = new Painting({ title, unit, help }, (pen, width, height) => this.#paint(pen, width, height), {
      table: () => this.#table(),
    });
    this.tip = h('.tip', { hidden: true });
    this.painting.frame.body.append(this.tip);
    const { canvas } = this.painting;
    canvas.addEventListener('pointermove', event => this.#point(event));
    canvas.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
    });
    canvas.addEventListener('click', event => this.#nearest(event)?.point.pick?.());
    this.element = this.painting.element;
    this.element.classList.remove('keyless');
  }

  /** @param {Series[]} series */
  set(series) {
    this.#series = series;
    const groups = new Map(series.map(each => [each.group ?? each.label, each.colour]));
    /** @param {string} kind @param {string} name @param {string} text */
    const key = (kind, name, text) => {
      const mark = h(kind);
      mark.style.setProperty('--swatch', `var(--${name})`);
      return h('span.key', null, mark, text);
    };
    fill(
      this.painting.frame.legend,
      series.some(each => !each.open) ? key('span.dot', 'muted', 'modified') : null,
      series.some(each => each.open) ? key('span.dot.hollow', 'muted', 'unmodified') : null,
      series.length ? key('span.swatch.dashed', 'muted', 'predicted') : null,
      [...groups].map(([text, name]) => key('span.dot', name, text)),
    );
    this.painting.repaint();
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    const points = this.#series.flatMap(series => series.points);
    this.#places = [];
    if (!points.length) return;
    const xs = points.map(point => point.x);
    const [first, last] = [Math.min(...xs), Math.max(...xs)];
    // Speeds that differ by their noise stand together.
    const pad = Math.max((last - first) * 0.08, Math.abs(first) * 0.02) || 1;
    const top = 1.08 * Math.max(...points.map(point => Math.max(point.measured + point.sigma, point.predicted ?? 0)));
    const [w, t] = [width - BOX.left - BOX.right, height - BOX.top - BOX.bottom];
    /** @param {number} value */
    const across = value => BOX.left + ((value - first + pad) / (last - first + 2 * pad)) * w;
    /** @param {number} value */
    const down = value => BOX.top + (1 - value / top) * t;
    axes(pen, width, height, ticks(first - pad, last + pad), ticks(0, top), across, down, this.xLabel);
    for (const series of this.#series) this.#paintSeries(pen, series, across, down);
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {Series} series
   * @param {(value: number) => number} across
   * @param {(value: number) => number} down
   */
  #paintSeries(pen, series, across, down) {
    const ordered = [...series.points].sort((a, b) => a.x - b.x);
    pen.strokeStyle = pen.fillStyle = colour(series.colour);
    pen.setLineDash([4, 3]);
    pen.lineWidth = 1;
    pen.beginPath();
    for (const point of ordered) if (point.predicted !== null) pen.lineTo(across(point.x), down(point.predicted));
    pen.stroke();
    pen.setLineDash([]);
    for (const point of ordered) {
      const [x, y] = [across(point.x), down(point.measured)];
      if (point.predicted !== null) {
        const mark = down(point.predicted);
        pen.beginPath();
        pen.moveTo(x - 5, mark);
        pen.lineTo(x + 5, mark);
        pen.stroke();
      }
      whisker(pen, x, down(point.measured - point.sigma), down(point.measured + point.sigma));
      pen.beginPath();
      pen.arc(x, y, 4, 0, 2 * Math.PI);
      pen.fillStyle = series.open ? colour('panel') : colour(series.colour);
      pen.fill();
      pen.lineWidth = 1.5;
      pen.stroke();
      if (point.chosen || point.outlier) this.#ring(pen, x, y, Boolean(point.outlier));
      pen.strokeStyle = colour(series.colour);
      this.#places.push({ point, series, x, y });
    }
  }

  /**
   * A ring round the chosen point; a cross through an outlier, so that it shows without its colour.
   * @param {CanvasRenderingContext2D} pen
   * @param {number} x
   * @param {number} y
   * @param {boolean} outlier
   */
  #ring(pen, x, y, outlier) {
    pen.strokeStyle = colour(outlier ? 'bad' : 'text');
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.arc(x, y, 8, 0, 2 * Math.PI);
    if (outlier) {
      pen.moveTo(x - 8, y - 8);
      pen.lineTo(x + 8, y + 8);
    }
    pen.stroke();
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
    this.painting.canvas.style.cursor = place?.point.pick ? 'pointer' : '';
    if (!place) return;
    const { point, series } = place;
    fill(
      this.tip,
      h('.tip-x', null, point.label),
      h(
        '.tip-row',
        null,
        h('span', null, series.label),
        h('b', null, `${sig(point.measured, 4)} ± ${sig(point.sigma, 2)}`),
      ),
      h('.tip-row', null, h('span', null, 'predicted'), h('b', null, sig(point.predicted, 4))),
      point.outlier ? h('.tip-row', null, 'outlier') : null,
    );
    const right = place.x > this.painting.frame.body.clientWidth / 2;
    this.tip.style.left = right ? '' : `${place.x + 12}px`;
    this.tip.style.right = right ? `${this.painting.frame.body.clientWidth - place.x + 12}px` : '';
  }

  #table() {
    return [
      [this.xLabel, 'series', 'measured', 'sigma', 'predicted'],
      ...this.#series.flatMap(series =>
        series.points.map(point => [point.x, series.label, point.measured, point.sigma, point.predicted]),
      ),
    ];
  }
}

/** Orders of one measurement: bars with their uncertainty, the predicted ones pale beside them. */
export class MeasuredOrders {
  /** @type {{ measured: number[], sigma: number[], predicted: (number | null)[] }} */ #data = {
    measured: [],
    sigma: [],
    predicted: [],
  };

  /** @param {{ title: string, unit: string, help: string }} options */
  constructor({ title, unit, help }) {
    this.painting = new Painting({ title, unit, help }, (pen, width, height) => this.#paint(pen, width, height), {
      table: () => this.#table(),
    });
    const measured = h('span.dot');
    measured.style.setProperty('--swatch', 'var(--measured)');
    const predicted = h('span.dot.pale');
    predicted.style.setProperty('--swatch', 'var(--predicted)');
    fill(
      this.painting.frame.legend,
      h('span.key', null, measured, 'measured, ±σ'),
      h('span.key', null, predicted, 'predicted'),
    );
    this.element = this.painting.element;
    this.element.classList.remove('keyless');
  }

  /** @param {number[]} measured @param {number[]} sigma @param {(number | null)[]} predicted */
  set(measured, sigma, predicted) {
    this.#data = { measured, sigma, predicted };
    this.painting.repaint();
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    const { measured, sigma, predicted } = this.#data;
    if (!measured.length) return;
    const top = 1.08 * Math.max(...measured.map((value, i) => Math.max(value + sigma[i], predicted[i] ?? 0)), 1e-9);
    const [w, t] = [width - BOX.left - BOX.right, height - BOX.top - BOX.bottom];
    const step = w / measured.length;
    /** @param {number} order */
    const across = order => BOX.left + (order - 0.5) * step;
    /** @param {number} value */
    const down = value => BOX.top + (1 - value / top) * t;
    axes(
      pen,
      width,
      height,
      measured.map((_, i) => i + 1),
      ticks(0, top),
      across,
      down,
      'mesh order',
    );
    measured.forEach((value, i) => {
      const x = across(i + 1);
      const size = 0.36 * step;
      pen.fillStyle = colour('measured');
      pen.fillRect(x - size, down(value), size - 1, down(0) - down(value));
      const other = predicted[i];
      if (other !== null && other !== undefined) {
        pen.fillStyle = pen.strokeStyle = colour('predicted');
        pen.globalAlpha = 0.3;
        pen.fillRect(x + 1, down(other), size - 1, down(0) - down(other));
        pen.globalAlpha = 1;
        pen.lineWidth = 1;
        pen.setLineDash([3, 2]);
        pen.strokeRect(x + 1.5, down(other), size - 2, down(0) - down(other));
        pen.setLineDash([]);
      }
      pen.strokeStyle = colour('text');
      whisker(pen, x - size / 2 - 0.5, down(Math.max(0, value - sigma[i])), down(value + sigma[i]));
    });
  }

  #table() {
    const { measured, sigma, predicted } = this.#data;
    return [
      ['mesh order', 'measured', 'sigma', 'predicted'],
      ...measured.map((value, i) => [i + 1, value, sigma[i], predicted[i] ?? null]),
    ];
  }
}
