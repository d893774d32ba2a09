// SPDX-License-Identifier: GPL-3.0-or-later
// Curves over one abscissa, drawn by uPlot: live, with a reading by pointer and arrow keys, a legend that switches
// them, zoom by dragging, reset by a double click.
import uPlot from 'uplot';
import { phase } from '../base/phase.js';
import { colour, theme } from '../base/theme.js';
import { shownUnit, shownValue, shownValues, units } from '../base/units.js';
import { Legend, keyOf } from './chart_legend.js';
import { paintChart, yRange } from './chart_picture.js';
import { Reading } from './chart_reading.js';
import { Frame, whenSeen } from './frame.js';
import { tickText } from './ticks.js';

/**
 * @typedef {object} Curve
 * @property {string} label
 * @property {ArrayLike<number | null>} y
 * @property {ArrayLike<number>} [x] when it is not that of the figure
 * @property {string} colour name in the style sheet
 * @property {'solid' | 'dashed' | 'dotted'} [line]
 * @property {number} [width]
 */

/** @typedef {{ x: number, label: string, strong?: boolean }} Mark a vertical line */
/** @typedef {{ x: ArrayLike<number>, curves: Curve[], marks?: Mark[] }} ChartData */
/**
 * @typedef {object} ChartOptions
 * @property {string} title @property {string} [name] in full @property {string} [unit] of all curves, as they are given
 * @property {string} [help] @property {string} [good] what is good
 * @property {string} xLabel @property {string} [xUnit]
 * @property {boolean} [bars] groups of bars at whole x; dashed curves become ticks across them
 * @property {boolean} [cycle] x is the phase of the mesh cycle
 * @property {boolean} [zero] y starts at zero
 * @property {boolean} [whole] x counts: no fractions along the axis
 * @property {boolean} [wide] @property {HTMLElement[]} [controls]
 */

const DASHES = { solid: undefined, dashed: [5, 4], dotted: [1.5, 3] };
const FONT = '11px system-ui, sans-serif';
const COUNTS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
const WORDS = /** @type {const} */ (['xLabel', 'xUnit', 'unit']);
const CLICK = 280; // ms in which a second click makes a double one
const STILL = 4; // px that a click may move

/** Values of a curve at the places of another abscissa. @param {Curve} curve @param {ArrayLike<number>} x */
function onAbscissa(curve, x) {
  const from = curve.x;
  if (
    !from ||
    from === x ||
    (from.length === x.length && from[0] === x[0] && from[from.length - 1] === x[x.length - 1])
  )
    return curve.y;
  const y = new Array(x.length).fill(null);
  let k = 0;
  for (let i = 0; i < x.length; i++) {
    if (x[i] < from[0] || x[i] > from[from.length - 1]) continue;
    while (k < from.length - 2 && from[k + 1] < x[i]) k++;
    const [a, b] = [curve.y[k], curve.y[k + 1]];
    y[i] =
      a === null || b === null || a === undefined || b === undefined
        ? null
        : a + ((b - a) * (x[i] - from[k])) / (from[k + 1] - from[k]);
  }
  return y;
}

/** As it is shown: lengths in the units that are wanted. @param {ChartData} data @param {ChartOptions} options */
function shownData({ x, curves, marks }, { unit, xUnit }) {
  return {
    x: shownValues(x, xUnit),
    curves: curves.map(curve => ({
      ...curve,
      y: shownValues(curve.y, unit),
      ...(curve.x && { x: curve.x === x ? shownValues(x, xUnit) : shownValues(curve.x, xUnit) }),
    })),
    marks: marks?.map(mark => ({ ...mark, x: shownValue(mark.x, xUnit) })),
  };
}

export class Chart {
  /** @type {uPlot | null} */ #plot = null;
  /** @type {ChartData | null} as it was given */ #given = null;
  /** @type {ChartData | null} as it is shown */ #data = null;
  /** @type {ChartOptions} as they were given */ #said;
  /** What the plot has: newer data wait while the figure is out of sight. @type {ChartData | null} */ #drawn = null;
  #seen = false;
  #stale = false;
  #shape = '';
  #click = 0;

  /** @param {ChartOptions} options */
  constructor(options) {
    this.#said = options;
    this.options = this.#spelt();
    const { title, name, unit, help, good, wide, controls } = options;
    const chart = this;
    this.frame = new Frame({
      ...{ title, name, unit, help, good, wide, controls },
      drawing: {
        paint: (pen, width, height) => this.#paint(pen, width, height),
        keys: () => this.legend.keys(),
        table: () => this.#table(),
        reset: () => this.#reset(),
        get empty() {
          return !chart.#data?.x.length;
        },
      },
    });
    this.element = this.frame.element;
    this.legend = new Legend(this.frame.legend, {
      toggled: () => this.#switch(),
      pointed: key => this.#emphasise(key),
    });
    this.reading = new Reading(this.frame, this.options);
    whenSeen(this.element, visible => {
      this.#seen = visible;
      if (visible && this.#stale) this.#draw();
    });
    new ResizeObserver(() => this.#resize()).observe(this.frame.body);
    theme.addEventListener('change', () => {
      this.#shape = '';
      this.#draw();
    });
    units.addEventListener('change', () => this.#respell());
    if (options.cycle) phase.addEventListener('change', () => this.#followPhase());
  }

  /** The options with the units that are shown. @returns {ChartOptions} */
  #spelt() {
    return { ...this.#said, unit: shownUnit(this.#said.unit), xUnit: shownUnit(this.#said.xUnit) };
  }

  #respell() {
    this.options = this.reading.options = this.#spelt();
    this.#shape = '';
    if (this.#given) this.set(this.#given);
  }

  /**
   * Other words and units for the abscissa and for what is shown.
   * @param {Partial<Pick<ChartOptions, 'xLabel' | 'xUnit' | 'unit'>>} words
   * @param {string} [shown]
   */
  name(words, shown) {
    if (shown !== undefined) this.frame.setCase(shown);
    const said = { ...this.#said, ...words };
    if (WORDS.every(key => said[key] === this.#said[key])) return;
    this.#said = said;
    this.frame.unit = said.unit;
    this.options = this.reading.options = this.#spelt();
    this.#shape = '';
  }

  /** @param {ChartData} data */
  set(data) {
    this.#given = data;
    this.#data = shownData(data, this.#said);
    this.legend.set(data.curves);
    if (this.#seen) this.#draw();
    else this.#stale = true;
  }

  #draw() {
    this.#stale = false;
    const data = this.#data;
    const { clientWidth: width, clientHeight: height } = this.frame.body;
    if (!data || !data.x.length || width === 0) {
      this.#stale = Boolean(data?.x.length);
      if (data && !data.x.length) this.#clear();
      return;
    }
    const columns = /** @type {uPlot.AlignedData} */ (
      /** @type {unknown} */ ([data.x, ...data.curves.map(curve => onAbscissa(curve, data.x))])
    );
    this.#drawn = data;
    const shape = JSON.stringify([data.curves.map(curve => [curve.label, curve.colour, curve.line, curve.width])]);
    if (shape === this.#shape && this.#plot) {
      const zoomed = this.#zoom();
      this.#plot.setData(columns, !zoomed);
      if (zoomed) this.#plot.setScale('x', zoomed);
      this.reading.describe(data);
      return;
    }
    this.#plot?.destroy();
    this.#shape = shape;
    this.#plot = new uPlot(this.#settings(data, width, height), columns, this.frame.body);
    this.#listen(this.#plot);
    this.legend.draw(data.curves);
    this.reading.describe(data);
    this.reading.attach(this.#plot, data);
  }

  #clear() {
    this.#plot?.destroy();
    this.#plot = null;
    this.#shape = '';
    this.frame.legend.replaceChildren();
  }

  /** The zoomed range, or nothing. */
  #zoom() {
    const plot = this.#plot;
    const x = plot?.data[0];
    if (!plot || !x || this.options.bars) return null;
    const { min, max } = plot.scales.x;
    if (min === undefined || max === undefined || min === null || max === null) return null;
    return min > x[0] + 1e-9 || max < x[x.length - 1] - 1e-9 ? { min, max } : null;
  }

  /** @param {ChartData} data @param {number} width @param {number} height @returns {uPlot.Options} */
  #settings(data, width, height) {
    const { bars, zero } = this.options;
    return {
      width,
      height,
      pxAlign: 0,
      padding: [8, 18, 0, 0],
      legend: { show: false },
      focus: { alpha: 0.25 },
      cursor: { drag: { x: !bars, y: false, dist: 6 }, points: { size: 5 }, y: false },
      scales: {
        x: { time: false, range: (_plot, low, high) => (bars ? [low - 0.6, high + 0.6] : [low, high]) },
        y: { range: (_plot, low, high) => yRange(low, high, Boolean(zero || bars)) },
      },
      axes: this.#axes(data),
      series: [
        {},
        ...data.curves.map(curve => ({
          label: curve.label,
          show: !this.legend.hidden.has(keyOf(curve)),
          stroke: colour(curve.colour),
          width: curve.width ?? (curve.line ? 1.25 : 1.75),
          dash: DASHES[curve.line ?? 'solid'],
          points: { show: false },
          spanGaps: false,
          paths: bars ? () => null : undefined,
        })),
      ],
      hooks: {
        drawClear: [plot => drawMarks(plot, this.#drawn?.marks ?? [])],
        draw: bars ? [plot => drawBars(plot, this.#drawn?.curves ?? [])] : [],
        setCursor: [plot => this.reading.read(plot, this.#drawn)],
      },
    };
  }

  /** @param {ChartData} data @returns {uPlot.Axis[]} */
  #axes(data) {
    const { bars, xLabel, xUnit, whole } = this.options;
    /** @param {uPlot} _plot @param {number[]} splits */
    const values = (_plot, splits) => splits.map(value => (value === null ? '' : tickText(value)));
    const axis = {
      stroke: colour('muted'),
      grid: { stroke: colour('grid'), width: 1 },
      ticks: { show: false },
      font: FONT,
      gap: 4,
      values,
    };
    return [
      {
        ...axis,
        size: 18,
        label: xUnit ? `${xLabel}, ${xUnit}` : xLabel,
        labelFont: FONT,
        labelSize: 15,
        labelGap: 0,
        space: 44,
        grid: bars ? { show: false } : axis.grid,
        splits: bars ? () => Array.from(data.x) : undefined,
        ...(whole ? { incrs: COUNTS } : {}),
      },
      {
        ...axis,
        size: (_plot, texts) => 12 + 6.4 * Math.max(2, ...(texts ?? []).map(text => text.length)),
        space: 24,
      },
    ];
  }

  /** @param {uPlot} plot */
  #listen(plot) {
    let from = [0, 0];
    plot.over.addEventListener('pointerdown', event => {
      from = [event.clientX, event.clientY];
    });
    plot.over.addEventListener('click', event => {
      if (Math.hypot(event.clientX - from[0], event.clientY - from[1]) > STILL || event.detail > 1) return;
      this.#click = window.setTimeout(() => this.frame.enlarge(), CLICK);
    });
    plot.over.addEventListener('dblclick', () => clearTimeout(this.#click));
  }

  /** Shows what the legend has on. */
  #switch() {
    this.#data?.curves.forEach((curve, i) => {
      this.#plot?.setSeries(i + 1, { show: !this.legend.hidden.has(keyOf(curve)) });
    });
  }

  /** @param {string | null} key pointed at in the legend */
  #emphasise(key) {
    const curves = this.#data?.curves ?? [];
    const at = key === null ? -1 : curves.findIndex(curve => keyOf(curve) === key);
    this.#plot?.setSeries(at < 0 ? null : at + 1, { focus: true });
  }

  #followPhase() {
    const plot = this.#plot;
    if (!plot || this.reading.busy || !this.#seen) return;
    const left = phase.value === null ? -10 : plot.valToPos(phase.value, 'x');
    plot.setCursor({ left, top: phase.value === null ? -10 : 4 }, false);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.frame.body;
    if (!this.#plot || width === 0) {
      if (this.#seen && this.#data) this.#draw();
      return;
    }
    if (Math.abs(this.#plot.width - width) > 0.5 || Math.abs(this.#plot.height - height) > 0.5)
      this.#plot.setSize({ width, height });
  }

  #reset() {
    const x = this.#data?.x;
    if (x) this.#plot?.setScale('x', { min: x[0], max: x[x.length - 1] });
    this.legend.showAll();
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    const data = this.#data;
    if (!data?.x.length) return;
    const curves = data.curves
      .filter(curve => !this.legend.hidden.has(keyOf(curve)))
      .map(curve => ({ ...curve, shown: onAbscissa(curve, data.x) }));
    paintChart(pen, width, height, { x: data.x, curves, marks: data.marks ?? [] }, this.options);
  }

  #table() {
    const data = this.#given;
    if (!data) return [];
    const { xLabel, xUnit, unit } = this.#said;
    const columns = data.curves.map(curve => onAbscissa(curve, data.x));
    const rows = Array.from(data.x, (x, i) => [x, ...columns.map(column => column[i] ?? null)]);
    return [
      [
        xUnit ? `${xLabel} (${xUnit})` : xLabel,
        ...data.curves.map(curve => (unit ? `${curve.label} (${unit})` : curve.label)),
      ],
      ...rows,
    ];
  }
}

/** @param {uPlot} plot @param {Mark[]} marks */
function drawMarks(plot, marks) {
  const { ctx, bbox } = plot;
  const ratio = devicePixelRatio;
  let edge = -Infinity;
  ctx.save();
  ctx.font = `${10 * ratio}px system-ui, sans-serif`;
  ctx.textBaseline = 'top';
  for (const mark of marks) {
    const x = plot.valToPos(mark.x, 'x', true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.strokeStyle = colour(mark.strong ? 'mark' : 'grid');
    ctx.lineWidth = ratio;
    ctx.setLineDash(mark.strong ? [] : [2 * ratio, 2 * ratio]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    if (!mark.label || x < edge) continue;
    const width = ctx.measureText(mark.label).width;
    if (x + width + 3 * ratio > bbox.left + bbox.width) continue;
    ctx.fillStyle = colour('muted');
    ctx.fillText(mark.label, x + 3 * ratio, bbox.top + 1);
    edge = x + width + 8 * ratio;
  }
  ctx.restore();
}

/**
 * Solid curves as bars side by side; those of a reference pale behind the bar of the same colour.
 * @param {uPlot} plot
 * @param {Curve[]} curves
 */
function drawBars(plot, curves) {
  const { ctx, bbox } = plot;
  const ratio = devicePixelRatio;
  const solid = curves.filter(curve => !curve.line || curve.line === 'solid');
  const x = plot.data[0];
  const step = x.length > 1 ? plot.valToPos(x[1], 'x', true) - plot.valToPos(x[0], 'x', true) : bbox.width / 2;
  const width = (0.76 * step) / Math.max(1, solid.length);
  const floor = plot.valToPos(0, 'y', true);
  ctx.save();
  curves.forEach((curve, k) => {
    if (plot.series[k + 1].show === false) return;
    const pale = Boolean(curve.line) && curve.line !== 'solid';
    const slot = pale ? solid.findIndex(other => other.colour === curve.colour) : solid.indexOf(curve);
    ctx.fillStyle = ctx.strokeStyle = colour(curve.colour);
    ctx.lineWidth = ratio;
    ctx.setLineDash(pale ? [3 * ratio, 2 * ratio] : []);
    for (let i = 0; i < x.length; i++) {
      const value = plot.data[k + 1][i];
      if (value === null || value === undefined) continue;
      const left = plot.valToPos(x[i], 'x', true) + (Math.max(0, slot) - solid.length / 2) * width;
      const top = plot.valToPos(value, 'y', true);
      ctx.globalAlpha = pale ? 0.22 : 1;
      ctx.fillRect(left + 0.5, top, Math.max(1, width - 1), floor - top);
      if (!pale) continue;
      ctx.globalAlpha = 1;
      ctx.beginPath();
      ctx.moveTo(left + 0.5, top);
      ctx.lineTo(left + width - 0.5, top);
      ctx.stroke();
    }
  });
  ctx.restore();
}
