// SPDX-License-Identifier: GPL-3.0-or-later
// Curves over one abscissa, drawn by uPlot: live, with a reading at the pointer, zoom by dragging, reset by a double
// click.
import uPlot from 'uplot';
import { fill, h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { paper } from '../base/paper.js';
import { phase } from '../base/phase.js';
import { colour, theme } from '../base/theme.js';
import { Frame, placeTip, whenSeen } from './frame.js';

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
 * @property {string} title @property {string} [unit] @property {string} [help] @property {string} xLabel
 * @property {string} [xUnit]
 * @property {boolean} [bars] groups of bars at whole x; dashed curves become ticks across them
 * @property {boolean} [cycle] x is the phase of the mesh cycle
 * @property {boolean} [zero] y starts at zero
 * @property {boolean} [wide] @property {HTMLElement[]} [controls]
 */

const DASHES = { solid: undefined, dashed: [5, 4], dotted: [1.5, 3] };
const FONT = '11px system-ui, sans-serif';

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

export class Chart {
  /** @type {uPlot | null} */ #plot = null;
  /** @type {ChartData | null} */ #data = null;
  #seen = false;
  #stale = false;
  #shape = '';
  #hover = false;
  #click = 0;

  /** @param {ChartOptions} options */
  constructor(options) {
    this.options = options;
    this.frame = new Frame({
      title: options.title,
      unit: options.unit,
      help: options.help,
      wide: options.wide,
      controls: options.controls,
      drawing: { picture: () => this.#picture(), table: () => this.#table(), reset: () => this.#reset() },
    });
    this.element = this.frame.element;
    this.tip = h('.tip', { hidden: true });
    whenSeen(this.element, visible => {
      this.#seen = visible;
      if (visible && this.#stale) this.#draw();
    });
    new ResizeObserver(() => this.#resize()).observe(this.frame.body);
    theme.addEventListener('change', () => {
      this.#shape = '';
      this.#draw();
    });
    paper.addEventListener('change', () => this.force());
    if (options.cycle) phase.addEventListener('change', () => this.#followPhase());
  }

  /** @param {ChartData} data */
  set(data) {
    this.#data = data;
    if (this.#seen || paper.on) this.#draw();
    else this.#stale = true;
  }

  /** Draws even out of sight, in the size of now. */
  force() {
    this.#shape = '';
    this.#draw();
    this.element.classList.toggle('blank', !this.#data?.x.length);
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
    const shape = JSON.stringify([data.curves.map(curve => [curve.label, curve.colour, curve.line, curve.width])]);
    if (shape === this.#shape && this.#plot) {
      const zoomed = this.#zoom();
      this.#plot.setData(columns, !zoomed);
      if (zoomed) this.#plot.setScale('x', zoomed);
      return;
    }
    this.#plot?.destroy();
    this.#shape = shape;
    this.#plot = new uPlot(this.#settings(data, width, height), columns, this.frame.body);
    this.frame.body.append(this.tip);
    this.#listen(this.#plot);
    this.#drawLegend(data);
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
    const { bars, zero, xLabel, xUnit } = this.options;
    const axis = {
      stroke: colour('muted'),
      grid: { stroke: colour('grid'), width: 1 },
      ticks: { show: false },
      font: FONT,
      gap: 4,
    };
    return {
      width,
      height,
      pxAlign: 0,
      padding: [6, 8, 0, 0],
      legend: { show: false },
      cursor: { sync: undefined, drag: { x: !bars, y: false, dist: 6 }, points: { size: 5 }, y: false },
      scales: {
        x: { time: false, range: (_plot, low, high) => (bars ? [low - 0.6, high + 0.6] : [low, high]) },
        y: { range: (_plot, low, high) => yRange(low, high, Boolean(zero || bars)) },
      },
      axes: [
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
        },
        {
          ...axis,
          size: (_plot, texts) => 12 + 6.4 * Math.max(2, ...(texts ?? []).map(text => text.length)),
          space: 24,
          values: (_plot, splits) =>
            splits.map(value => (value === null ? '' : String(Number(value.toPrecision(6))).replace('-', '−'))),
        },
      ],
      series: [
        {},
        ...data.curves.map(curve => ({
          label: curve.label,
          stroke: colour(curve.colour),
          width: curve.width ?? (curve.line ? 1.25 : 1.75),
          dash: DASHES[curve.line ?? 'solid'],
          points: { show: false },
          spanGaps: false,
          paths: bars ? () => null : undefined,
        })),
      ],
      hooks: {
        drawClear: [plot => drawMarks(plot, this.#data?.marks ?? [])],
        draw: bars ? [plot => drawBars(plot, this.#data?.curves ?? [])] : [],
        setCursor: [plot => this.#read(plot)],
      },
    };
  }

  /** @param {uPlot} plot */
  #listen(plot) {
    plot.over.addEventListener('mouseenter', () => {
      this.#hover = true;
    });
    plot.over.addEventListener('mouseleave', () => {
      this.#hover = false;
      this.tip.hidden = true;
      if (this.options.cycle) phase.set(null);
    });
    let from = [0, 0];
    plot.over.addEventListener('pointerdown', event => {
      from = [event.clientX, event.clientY];
    });
    plot.over.addEventListener('click', event => {
      if (Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 4 || event.detail > 1) return;
      this.#click = window.setTimeout(() => this.frame.enlarge(), 280);
    });
    plot.over.addEventListener('dblclick', () => clearTimeout(this.#click));
  }

  /** @param {uPlot} plot */
  #read(plot) {
    const at = plot.cursor.idx;
    if (!this.#hover || at === null || at === undefined || !this.#data) {
      this.tip.hidden = true;
      return;
    }
    const x = this.#data.x[at];
    const order = this.#data.curves
      .map((curve, k) => ({ curve, k }))
      .sort((a, b) => Number(Boolean(a.curve.line)) - Number(Boolean(b.curve.line)));
    const rows = order.map(({ curve, k }) => {
      const value = /** @type {number | null | undefined} */ (plot.data[k + 1][at]);
      return h('.tip-row', null, swatch(curve), h('span', null, curve.label), h('b', null, sig(value, 4)));
    });
    fill(
      this.tip,
      h('.tip-x', null, `${this.options.xLabel} ${sig(x, 4)}${this.options.xUnit ? ` ${this.options.xUnit}` : ''}`),
      rows,
    );
    this.tip.hidden = false;
    const left = (plot.cursor.left ?? 0) + plot.over.offsetLeft;
    placeTip(this.tip, left, this.frame.body.clientWidth);
    if (this.options.cycle && this.#hover) phase.set(x);
  }

  #followPhase() {
    const plot = this.#plot;
    if (!plot || this.#hover || !this.#seen) return;
    const left = phase.value === null ? -10 : plot.valToPos(phase.value, 'x');
    plot.setCursor({ left, top: phase.value === null ? -10 : 4 }, false);
  }

  /** @param {ChartData} data */
  #drawLegend(data) {
    const solid = data.curves.filter(curve => !curve.line);
    // one key for all curves of a reference: "828 N m, unmodified" and its like
    const others = new Map(
      data.curves.filter(curve => curve.line).map(curve => [curve.label.replace(/^.*, /, ''), curve]),
    );
    const mixed = new Set(data.curves.map(curve => curve.colour)).size > 1;
    fill(
      this.frame.legend,
      solid.map(curve => h('span.key', null, swatch(curve), curve.label)),
      [...others].map(([label, curve]) =>
        h('span.key', null, swatch(mixed ? { ...curve, colour: 'muted' } : curve), label),
      ),
    );
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
  }

  #picture() {
    this.force();
    const plot = /** @type {uPlot} */ (this.#plot);
    const source = plot.ctx.canvas;
    const scale = source.width / plot.width;
    const canvas = h('canvas', { width: source.width, height: source.height + 44 * scale });
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    pen.fillStyle = colour('panel');
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(source, 0, 22 * scale);
    pen.scale(scale, scale);
    pen.fillStyle = colour('text');
    pen.font = `600 12px system-ui, sans-serif`;
    pen.fillText(`${this.options.title}${this.options.unit ? `, ${this.options.unit}` : ''}`, 8, 15);
    let left = 8;
    pen.font = FONT;
    for (const curve of this.#data?.curves ?? []) {
      pen.strokeStyle = colour(curve.colour);
      pen.lineWidth = 2;
      pen.setLineDash(DASHES[curve.line ?? 'solid'] ?? []);
      pen.beginPath();
      pen.moveTo(left, source.height / scale + 33);
      pen.lineTo(left + 18, source.height / scale + 33);
      pen.stroke();
      pen.fillText(curve.label, left + 22, source.height / scale + 37);
      left += 36 + pen.measureText(curve.label).width;
    }
    return canvas;
  }

  #table() {
    const data = this.#data;
    if (!data) return [];
    const { xLabel, xUnit, unit } = this.options;
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

/** @param {number | null} low @param {number | null} high @param {boolean} zero @returns {[number, number]} */
function yRange(low, high, zero) {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  const span = Math.max(high - low, 1e-3 * Math.max(Math.abs(low), Math.abs(high)), 1e-9);
  return [zero && low >= 0 ? 0 : low - 0.06 * span, high + 0.06 * span];
}

/** @param {Curve} curve */
function swatch(curve) {
  const mark = h(`span.swatch.${curve.line ?? 'solid'}`);
  mark.style.setProperty('--swatch', `var(--${curve.colour})`);
  return mark;
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
    ctx.fillStyle = colour('muted');
    ctx.fillText(mark.label, x + 3 * ratio, bbox.top + 1);
    edge = x + ctx.measureText(mark.label).width + 8 * ratio;
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
