// SPDX-License-Identifier: GPL-3.0-or-later
// A figure painted on a canvas: sharp on any screen, repainted when its size, the theme or its data change.
import { h } from '../base/dom.js';
import { paper } from '../base/paper.js';
import { theme } from '../base/theme.js';
import { Frame, whenSeen } from './frame.js';

export const FONT = '11px system-ui, sans-serif';
export const SMALL = '10px system-ui, sans-serif';

/** @typedef {(pen: CanvasRenderingContext2D, width: number, height: number) => void} Paint */

export class Painting {
  #seen = false;
  #asked = false;

  /**
   * @param {ConstructorParameters<typeof Frame>[0] extends infer T ? Omit<T, 'drawing'> : never} options
   * @param {Paint} paint
   * @param {{ table?: () => (string | number | null)[][], label?: string }} [more]
   */
  constructor(options, paint, { table, label } = {}) {
    this.paint = paint;
    this.canvas = h('canvas', { role: 'img', 'aria-label': label ?? options.title });
    this.frame = new Frame({ ...options, drawing: { picture: () => this.#picture(), table } });
    this.element = this.frame.element;
    this.element.classList.add('keyless');
    this.frame.body.append(this.canvas);
    whenSeen(this.element, visible => {
      this.#seen = visible;
      if (visible) this.repaint();
    });
    new ResizeObserver(() => this.repaint()).observe(this.frame.body);
    theme.addEventListener('change', () => this.now());
    paper.addEventListener('change', () => this.now());
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
    this.#paintOn(this.canvas, width, height, devicePixelRatio);
  }

  /** @param {HTMLCanvasElement} canvas @param {number} width @param {number} height @param {number} ratio */
  #paintOn(canvas, width, height, ratio) {
    const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== columns || canvas.height !== rows) {
      canvas.width = columns;
      canvas.height = rows;
    }
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = FONT;
    this.paint(pen, width, height);
  }

  #picture() {
    const { clientWidth: width, clientHeight: height } = this.frame.body;
    const inner = document.createElement('canvas');
    this.#paintOn(inner, width, height, 2);
    const canvas = document.createElement('canvas');
    canvas.width = inner.width;
    canvas.height = inner.height + 48;
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    const style = getComputedStyle(document.documentElement);
    pen.fillStyle = style.getPropertyValue('--panel');
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.fillStyle = style.getPropertyValue('--text');
    pen.font = '600 24px system-ui, sans-serif';
    pen.fillText(this.frame.title, 16, 32);
    pen.drawImage(inner, 0, 48);
    return canvas;
  }
}
