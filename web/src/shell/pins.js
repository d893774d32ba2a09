// SPDX-License-Identifier: GPL-3.0-or-later
// What the numbers and dashed curves compare with: the unmodified pair or a design that was pinned; kept for as long as
// the browser's tab, and in links.
import { fill, h } from '../base/dom.js';

const KEY = 'easeoff-pins';
const MOST = 8;
const VIEWS = ['design', 'compare'];

export class Pins {
  /** @type {import('../base/store.js').Pin[]} */ #pins = [];

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    try {
      this.#pins = JSON.parse(sessionStorage.getItem(KEY) ?? '[]');
    } catch {
      this.#pins = [];
    }
    this.select = h('select', {
      'aria-label': 'Compare with',
      title: 'What the numbers and dashed curves compare with',
      onchange: () => this.#choose(),
    });
    this.element = h('label.pin', null, h('span', null, 'against'), this.select);
  }

  refresh() {
    const { pin } = this.app.store;
    if (pin && !this.#pins.includes(pin)) this.#keep(pin); // of a link
    this.element.hidden = !VIEWS.includes(this.app.current);
    const options = [
      h('option', { value: '' }, 'unmodified'),
      ...this.#pins.map((each, i) => h('option', { value: String(i) }, each.label)),
      h('option', { value: 'pin' }, 'pin this design'),
    ];
    const shape = options.map(option => option.textContent).join('|');
    if (this.select.dataset.shape !== shape) {
      fill(this.select, options);
      this.select.dataset.shape = shape;
    }
    this.select.value = pin ? String(this.#pins.indexOf(pin)) : '';
  }

  #choose() {
    const { store } = this.app;
    const { value } = this.select;
    if (value !== 'pin') {
      store.setPin(value === '' ? null : this.#pins[Number(value)]);
      return;
    }
    const { example, id } = store.from;
    const pin = { label: this.#freeName(), design: store.design, from: { example, id } };
    this.#keep(pin);
    store.setPin(pin);
  }

  /** "pinned 2", when there is none of that name. */
  #freeName() {
    for (let count = this.#pins.length + 1; ; count++)
      if (!this.#pins.some(each => each.label === `pinned ${count}`)) return `pinned ${count}`;
  }

  /** One of the same name gives way. @param {import('../base/store.js').Pin} pin */
  #keep(pin) {
    this.#pins = [...this.#pins.filter(each => each.label !== pin.label), pin].slice(-MOST);
    sessionStorage.setItem(KEY, JSON.stringify(this.#pins));
  }
}
