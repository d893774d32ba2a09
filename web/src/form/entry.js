// SPDX-License-Identifier: GPL-3.0-or-later
// What is typed into a text field until it is a value of the design: it stays as it is typed, whatever else is drawn;
// it ends when the design itself changes there, by undo, by a slider or by another design.
import { same } from '../base/pointer.js';

const PAUSE = 450; // ms after the last key before a typed value counts

/**
 * @typedef {object} Host
 * @property {import('../base/store.js').DesignStore} store
 * @property {string} pointer
 * @property {HTMLInputElement[]} inputs
 * @property {(final: boolean) => { value: unknown } | { fault: string }} read the typed text as a value
 * @property {(value: any) => string[]} write the value as text, one for each input
 */

export class Entry {
  #timer = 0;
  /** The text is the user's, not the design's. */
  #typed = false;
  /** This entry itself is changing the design. */
  #own = false;
  /** @type {unknown} value of the design when the text was last in step with it */ #seen;

  /** @param {Host} host */
  constructor(host) {
    this.host = host;
    for (const input of host.inputs) {
      input.addEventListener('input', () => this.take(false));
      input.addEventListener('change', () => this.take(true));
      input.addEventListener('blur', () => this.#leave());
    }
  }

  get typed() {
    return this.#typed;
  }

  /** Typed and not yet taken. */
  get waiting() {
    return this.#timer !== 0;
  }

  /** Takes the text as it stands: at once, or after a pause in which more may be typed. @param {boolean} final */
  take(final) {
    clearTimeout(this.#timer);
    this.#timer = 0;
    this.#typed = true;
    const { store, pointer, read } = this.host;
    const found = read(final);
    const fault = 'fault' in found ? found.fault : '';
    this.#own = true;
    store.setFault(pointer, fault);
    this.#own = false;
    if (!('value' in found)) return;
    if (final) this.#put(found.value);
    else this.#timer = window.setTimeout(() => this.take(true), PAUSE);
  }

  /** @param {unknown} value */
  #put(value) {
    const { store, pointer } = this.host;
    this.#own = true;
    store.set(pointer, value);
    this.#own = false;
    this.#seen = store.get(pointer);
    if (!this.#focused) this.#leave();
  }

  get #focused() {
    return this.host.inputs.some(input => input === document.activeElement);
  }

  /** What has become a value is written as values are. */
  #leave() {
    const { store, pointer } = this.host;
    if (this.#timer && this.#typed && !store.faults.has(pointer)) this.take(true);
    if (this.#focused || store.faults.has(pointer)) return;
    this.#typed = false;
    this.refresh();
  }

  /** The design may have changed. */
  refresh() {
    const { store, pointer, inputs, write } = this.host;
    const value = store.get(pointer);
    if (this.#typed) {
      if (this.#own || same(value, this.#seen)) return;
      this.forget();
      return;
    }
    this.#seen = value;
    write(value).forEach((text, i) => {
      if (inputs[i].value !== text) inputs[i].value = text;
    });
  }

  /** What is typed ends; the field shows the design's value. */
  forget() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    this.#typed = false;
    this.host.store.setFault(this.host.pointer, '');
    this.refresh();
  }

  /** What is typed becomes a value now, if it can. */
  flush() {
    if (!this.#typed) return;
    clearTimeout(this.#timer);
    this.#timer = 0;
    if (!this.host.store.faults.has(this.host.pointer)) this.take(true);
  }

  /** A text that was typed for this value elsewhere. @param {string[]} texts */
  retype(texts) {
    texts.forEach((text, i) => {
      this.host.inputs[i].value = text;
    });
    this.take(true);
  }
}
