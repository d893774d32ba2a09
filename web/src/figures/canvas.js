// SPDX-License-Identifier: GPL-3.0-or-later
// A figure painted on a canvas: sharp on any screen, repainted when its size, the theme or its data change.
import { h } from '../base/dom.js';
import { theme } from '../base/theme.js';
import { units } from '../base/units.js';
import { Frame, whenSeen } from './frame.js';

export const FONT = '11px system-ui, sans-serif';
export const SMALL = '10px system-ui, sans-serif';

/** @typedef {(pen: CanvasRenderingContext2D, width: number, height: number) => void} Paint */
/**
 * @typedef {object} More
 * @property {() => import('./table.js').Rows} [table] @property {string} [label] a sentence
 * @property {() => boolean} [empty] @property {() => import('./sheet.js').Key[]} [keys] @property {() => void} [reset]
 */

export class Painting {
  #seen = false;
  #asked = false;

  /** @param {Omit<import('./frame.js').FrameOptions, 'drawing'>} options @param {Paint} paint @param {More} [more] */
  constructor(options, paint, { table, label, empty, keys, reset } = {}) {
    this.paint = paint;
    this.canvas = h('canvas', { role: 'img', 'aria-label': label ?? options.name ?? options.title });
    this.frame = new Frame({
      ...options,
      drawing: {
        paint: (pen, width, height) => {
          pen.font = FONT;
          paint(pen, width, height);
          this.repaint(); // places of the screen, which painting has noted, are those of the screen again
        },
        table,
        keys,
        reset,
        get empty() {
          return empty?.() ?? false;
        },
      },
    });
    this.element = this.frame.element;
    this.element.classList.add('keyless');
    this.frame.body.append(this.canvas);
    whenSeen(this.element, visible => {
      this.#seen = visible;
      if (visible) this.repaint();
    });
    new ResizeObserver(() => this.repaint()).observe(this.frame.body);
    for (const choice of [theme, units]) choice.addEventListener('change', () => this.now());
  }

  /** One sentence for those who do not see it. @param {string} text */
  describe(text) {
    this.canvas.setAttribute('aria-label', text);
  }

  /** Once before the next frame, if it can be seen. */
  repaint() {
    if (!this.#seen || this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.now();
    });
  }

  /** At once, in sight or not. */
  now() {
    const { clientWidth: width, clientHeight: height } = this.frame.body;
    if (width === 0 || height === 0) return;
    const { canvas } = this;
    const [columns, rows] = [Math.round(width * devicePixelRatio), Math.round(height * devicePixelRatio)];
    if (canvas.width !== columns || canvas.height !== rows) {
      canvas.width = columns;
      canvas.height = rows;
    }
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = FONT;
    this.paint(pen, width, height);
  }
}
