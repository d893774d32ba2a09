// SPDX-License-Identifier: GPL-3.0-or-later
// The legend of curves: a button for each that hides and shows it; one for all curves of a reference.
import { fill, h } from '../base/dom.js';

/** @typedef {import('./chart.js').Curve} Curve */

/**
 * What a curve is switched by: its label; of a reference what it is compared with ("828 N m, unmodified").
 * @param {Curve} curve
 */
export function keyOf(curve) {
  return curve.line ? curve.label.replace(/^.*, /, '') : curve.label;
}

export class Legend {
  /** @type {Set<string>} */ hidden = new Set();
  /** @type {Curve[]} */ #curves = [];

  /**
   * @param {HTMLElement} element
   * @param {{ toggled: () => void, pointed: (key: string | null) => void }} host
   */
  constructor(element, host) {
    this.element = element;
    this.host = host;
    element.addEventListener('pointerleave', () => host.pointed(null));
  }

  /** One curve for each key, in the order of the legend. */
  #entries() {
    const solid = this.#curves.filter(curve => !curve.line);
    const others = new Map(this.#curves.filter(curve => curve.line).map(curve => [keyOf(curve), curve]));
    const mixed = new Set(this.#curves.map(curve => curve.colour)).size > 1;
    return [
      ...solid.map(curve => ({ key: keyOf(curve), colour: curve.colour, line: 'solid' })),
      ...[...others].map(([key, curve]) => ({
        key,
        colour: mixed ? 'reference' : curve.colour,
        line: curve.line ?? 'dashed',
      })),
    ];
  }

  /** What it is a legend of, drawn or not. @param {Curve[]} curves */
  set(curves) {
    this.#curves = curves;
  }

  /** @param {Curve[]} curves */
  draw(curves) {
    this.#curves = curves;
    fill(
      this.element,
      this.#entries().map(entry => this.#button(entry)),
    );
  }

  /** @param {{ key: string, colour: string, line: string }} entry */
  #button({ key, colour, line }) {
    const button = h(
      'button.key',
      {
        type: 'button',
        'aria-pressed': String(!this.hidden.has(key)),
        title: `Show or hide ${key}`,
        onclick: () => {
          if (!this.hidden.delete(key)) this.hidden.add(key);
          button.setAttribute('aria-pressed', String(!this.hidden.has(key)));
          this.host.toggled();
        },
        onpointerenter: () => this.host.pointed(this.hidden.has(key) ? null : key),
      },
      h(`span.swatch.${line}`, { css: { '--swatch': `var(--${colour})` } }),
      key,
    );
    return button;
  }

  showAll() {
    this.hidden.clear();
    this.draw(this.#curves);
    this.host.toggled();
  }

  /** For a picture. @returns {import('./sheet.js').Key[]} */
  keys() {
    return this.#entries()
      .filter(({ key }) => !this.hidden.has(key))
      .map(({ key, colour, line }) => ({ label: key, colour, line }));
  }
}
