// SPDX-License-Identifier: GPL-3.0-or-later
// Reads curves where the pointer is, or where the arrow keys have moved the reading to: the nearest curves beside it,
// and for those who do not see the figure one sentence about it and one about the reading.
import { fill, h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { phase } from '../base/phase.js';

const NEAREST = 3; // curves in a reading: more would cover the figure

/** @typedef {import('uplot')} Plot */
/** @typedef {import('./chart.js').ChartData} ChartData */

/** @param {import('./chart.js').Curve} curve @param {number} value */
function readingRow({ colour, line = 'solid', label }, value) {
  const mark = h(`span.swatch.${line}`, { css: { '--swatch': `var(--${colour})` } });
  return h('.tip-row', null, mark, h('span', null, label), h('b', null, sig(value, 4)));
}

export class Reading {
  /** @type {Plot | null} */ #plot = null;
  /** @type {ChartData | null} */ #data = null;
  #hover = false;
  #keys = false;
  #at = 0;

  /** @param {import('./frame.js').Frame} frame @param {import('./chart.js').ChartOptions} options */
  constructor(frame, options) {
    this.frame = frame;
    this.options = options;
    this.tip = h('.tip', { hidden: true });
    this.words = h('span.unseen', { 'aria-live': 'polite' });
    const { body } = frame;
    body.tabIndex = 0;
    body.setAttribute('role', 'img');
    body.setAttribute('aria-label', options.name ?? options.title);
    body.addEventListener('keydown', event => this.#key(event));
    body.addEventListener('blur', () => this.#leave());
    frame.element.append(this.words);
  }

  /** Somebody reads this figure. */
  get busy() {
    return this.#hover || this.#keys;
  }

  /** @param {Plot} plot @param {ChartData} data */
  attach(plot, data) {
    this.#plot = plot;
    this.#data = data;
    this.frame.body.append(this.tip);
    plot.over.addEventListener('mouseenter', () => {
      this.#hover = true;
    });
    plot.over.addEventListener('mouseleave', () => this.#leave());
  }

  #leave() {
    if (this.#keys) this.#plot?.setCursor({ left: -10, top: -10 });
    this.#hover = this.#keys = false;
    this.tip.hidden = true;
    if (this.options.cycle) phase.set(null);
  }

  /** One sentence for the whole figure. @param {ChartData} data */
  describe(data) {
    this.#data = data;
    const { title, unit, xLabel } = this.options;
    const ranges = data.curves.map(curve => {
      const values = Array.from(curve.y).filter(value => typeof value === 'number');
      return values.length ? `${curve.label} ${sig(Math.min(...values), 3)} to ${sig(Math.max(...values), 3)}` : '';
    });
    const name = `${title} over ${xLabel}${unit ? ` in ${unit}` : ''}`;
    const text = `${name}: ${ranges.filter(Boolean).join('; ')}. Arrow keys read it.`;
    this.frame.body.setAttribute('aria-label', text);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const plot = this.#plot;
    const x = this.#data?.x;
    const steps = /** @type {Record<string, number>} */ ({ ArrowLeft: -1, ArrowRight: 1, PageUp: -8, PageDown: 8 });
    if (!plot || !x || !(event.key in steps || event.key === 'Home' || event.key === 'End')) return;
    event.preventDefault();
    const last = x.length - 1;
    const next = event.key === 'Home' ? 0 : event.key === 'End' ? last : this.#at + steps[event.key];
    this.#at = Math.min(Math.max(next, 0), last);
    this.#keys = true;
    plot.setCursor({ left: plot.valToPos(x[this.#at], 'x'), top: plot.over.clientHeight / 2 });
    this.words.textContent = this.tip.textContent;
  }

  /** @param {Plot} plot @param {ChartData | null} data */
  read(plot, data) {
    const at = plot.cursor.idx;
    if (!this.busy || at === null || at === undefined || !data) {
      this.tip.hidden = true;
      return;
    }
    const { xLabel, xUnit, cycle } = this.options;
    const top = plot.cursor.top ?? 0;
    const near = data.curves
      .map((curve, k) => ({ curve, value: plot.data[k + 1]?.[at], shown: plot.series[k + 1]?.show !== false }))
      .filter(each => each.shown && each.value !== null && each.value !== undefined)
      .map(each => ({ ...each, distance: Math.abs(plot.valToPos(Number(each.value), 'y') - top) }))
      .sort((a, b) => a.distance - b.distance)
      .slice(0, NEAREST)
      .sort((a, b) => Number(b.value) - Number(a.value));
    fill(
      this.tip,
      h('.tip-x', null, `${xLabel} ${sig(data.x[at], 4)}${xUnit ? ` ${xUnit}` : ''}`),
      near.map(({ curve, value }) => readingRow(curve, Number(value))),
    );
    this.tip.hidden = false;
    this.#place(plot, top);
    if (cycle && this.busy) phase.set(data.x[at]);
  }

  /** Beside the pointer, in the half of the figure that it is not in. @param {Plot} plot @param {number} top */
  #place(plot, top) {
    const left = plot.cursor.left ?? 0;
    const { over } = plot;
    const right = left < over.clientWidth / 2;
    const below = top < over.clientHeight / 2;
    this.tip.style.left = right ? '' : `${over.offsetLeft + 2}px`;
    this.tip.style.right = right ? '16px' : '';
    this.tip.style.top = below ? '' : '4px';
    this.tip.style.bottom = below ? '36px' : '';
  }
}
