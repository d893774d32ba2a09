// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what a figure paints as SVG: the part of a canvas's drawing commands that the figures use.

const NAMESPACE = 'http://www.w3.org/2000/svg';
const DIGITS = 2;

/** @param {number} value */
const short = value => String(Number(value.toFixed(DIGITS)));

/** @typedef {{ fillStyle: string, strokeStyle: string, lineWidth: number, font: string, textAlign: string,
 *   textBaseline: string, globalAlpha: number, dash: number[], clip: string, move: [number, number] }} Style */

export class SvgPen {
  fillStyle = '#000';
  strokeStyle = '#000';
  lineWidth = 1;
  font = '11px sans-serif';
  textAlign = 'left';
  textBaseline = 'alphabetic';
  globalAlpha = 1;
  imageSmoothingEnabled = true;
  /** @type {number[]} */ #dash = [];
  #clip = '';
  /** @type {[number, number]} */ #move = [0, 0];
  #path = '';
  #clips = 0;
  /** @type {Style[]} */ #kept = [];

  /** @param {number} width @param {number} height */
  constructor(width, height) {
    this.root = document.createElementNS(NAMESPACE, 'svg');
    this.root.setAttribute('xmlns', NAMESPACE);
    this.root.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.root.setAttribute('width', String(width));
    this.root.setAttribute('height', String(height));
    this.ruler = /** @type {CanvasRenderingContext2D} */ (document.createElement('canvas').getContext('2d'));
  }

  /** @param {string} name @param {Record<string, string | number>} attributes @param {Element} [parent] */
  #element(name, attributes, parent = this.root) {
    const element = document.createElementNS(NAMESPACE, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
    if (this.#clip && parent === this.root) element.setAttribute('clip-path', `url(#${this.#clip})`);
    parent.append(element);
    return element;
  }

  /** @param {number} x @param {number} y */
  #at(x, y) {
    return `${short(x + this.#move[0])} ${short(y + this.#move[1])}`;
  }

  save() {
    const { fillStyle, strokeStyle, lineWidth, font, textAlign, textBaseline, globalAlpha } = this;
    this.#kept.push({
      fillStyle,
      strokeStyle,
      lineWidth,
      font,
      textAlign,
      textBaseline,
      globalAlpha,
      dash: this.#dash,
      clip: this.#clip,
      move: this.#move,
    });
  }

  restore() {
    const kept = this.#kept.pop();
    if (!kept) return;
    const { dash, clip, move, ...style } = kept;
    Object.assign(this, style);
    [this.#dash, this.#clip, this.#move] = [dash, clip, move];
  }

  /** @param {number} x @param {number} y */
  translate(x, y) {
    this.#move = [this.#move[0] + x, this.#move[1] + y];
  }

  beginPath() {
    this.#path = '';
  }

  closePath() {
    this.#path += 'Z';
  }

  /** @param {number} x @param {number} y */
  moveTo(x, y) {
    this.#path += `M${this.#at(x, y)}`;
  }

  /** @param {number} x @param {number} y */
  lineTo(x, y) {
    this.#path += `${this.#path === '' ? 'M' : 'L'}${this.#at(x, y)}`;
  }

  /** @param {number} x @param {number} y @param {number} width @param {number} height */
  rect(x, y, width, height) {
    this.#path += `M${this.#at(x, y)}h${short(width)}v${short(height)}h${short(-width)}Z`;
  }

  /**
   * Whole circles and arcs.
   * @param {number} x
   * @param {number} y
   * @param {number} radius
   * @param {number} from
   * @param {number} to
   */
  arc(x, y, radius, from, to) {
    const half = (from + to) / 2;
    for (const [i, angle] of [from, half, to].entries()) {
      const place = this.#at(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
      this.#path += i === 0 ? `M${place}` : `A${short(radius)} ${short(radius)} 0 0 1 ${place}`;
    }
  }

  clip() {
    this.#clips += 1;
    const id = `clip-${Math.random().toString(36).slice(2, 8)}-${this.#clips}`;
    const holder = this.#element('clipPath', { id });
    this.#element('path', { d: this.#path }, holder);
    this.#clip = id;
  }

  /** @returns {Record<string, string>} */
  #paintAttributes() {
    /** @type {Record<string, string>} */
    const none = {};
    return this.globalAlpha < 1 ? { opacity: short(this.globalAlpha) } : none;
  }

  stroke() {
    if (!this.#path) return;
    this.#element('path', {
      d: this.#path,
      fill: 'none',
      stroke: this.strokeStyle,
      'stroke-width': short(this.lineWidth),
      'stroke-linejoin': 'round',
      ...(this.#dash.length ? { 'stroke-dasharray': this.#dash.map(short).join(' ') } : {}),
      ...this.#paintAttributes(),
    });
  }

  fill() {
    if (this.#path) this.#element('path', { d: this.#path, fill: this.fillStyle, ...this.#paintAttributes() });
  }

  /** @param {number} x @param {number} y @param {number} width @param {number} height */
  fillRect(x, y, width, height) {
    const kept = this.#path;
    this.#path = '';
    this.rect(x, y, width, height);
    this.fill();
    this.#path = kept;
  }

  /** @param {number} x @param {number} y @param {number} width @param {number} height */
  strokeRect(x, y, width, height) {
    const kept = this.#path;
    this.#path = '';
    this.rect(x, y, width, height);
    this.stroke();
    this.#path = kept;
  }

  /** @param {number[]} dash */
  setLineDash(dash) {
    this.#dash = dash;
  }

  /** @param {string} text */
  measureText(text) {
    this.ruler.font = this.font;
    return this.ruler.measureText(text);
  }

  /** @param {string} text @param {number} x @param {number} y */
  fillText(text, x, y) {
    const [, weight = '', size = '11', family = 'sans-serif'] = /^(\d+ )?([\d.]+)px (.*)$/.exec(this.font) ?? [];
    const [left, top] = this.#at(x, y).split(' ');
    const anchors = /** @type {Record<string, string>} */ ({ center: 'middle', right: 'end' });
    const element = this.#element('text', {
      x: left,
      y: top,
      fill: this.fillStyle,
      'font-size': size,
      'font-family': family,
      'text-anchor': anchors[this.textAlign] ?? 'start',
      ...(weight ? { 'font-weight': weight.trim() } : {}),
      ...(this.textBaseline === 'top' ? { dy: '0.8em' } : {}),
      ...this.#paintAttributes(),
    });
    element.textContent = text;
  }

  /**
   * @param {HTMLCanvasElement} picture
   * @param {number} x
   * @param {number} y
   * @param {number} width
   * @param {number} height
   */
  drawImage(picture, x, y, width, height) {
    const [left, top] = this.#at(x, y).split(' ');
    this.#element('image', {
      href: picture.toDataURL(),
      x: left,
      y: top,
      width: short(width),
      height: short(height),
      preserveAspectRatio: 'none',
    });
  }
}
