// SPDX-License-Identifier: GPL-3.0-or-later
// What the views share, and the way from one to another.
import { readPlace, writePlace } from './base/address.js';

/**
 * @typedef {object} View
 * @property {HTMLElement} element
 * @property {(parameters: URLSearchParams) => void} show
 * @property {() => void} [hide]
 * @property {() => void} [print]
 */

/**
 * @typedef {{ id: string, title: string, make: (app: App) => View }} Entry one tab; make is called when it is first
 * opened
 */

export class App extends EventTarget {
  /** @type {Map<string, View>} */ #views = new Map();
  #following = false;
  current = '';

  /**
   * @param {Entry[]} entries
   * @param {{ store: import('./base/store.js').DesignStore, analyst: import('./base/analyst.js').Analyst,
   *   form: import('./form.js').Form,
   *   fields: import('./base/schema.js').Field[], examples: { name: string, title: string }[],
   *   jobs: import('./base/jobs.js').Jobs,
   *   addressOf: () => URLSearchParams, openPlace: (parameters: URLSearchParams) => Promise<void> }} shared
   */
  constructor(entries, shared) {
    super();
    this.entries = entries;
    this.store = shared.store;
    this.analyst = shared.analyst;
    this.form = shared.form;
    this.fields = shared.fields;
    this.examples = shared.examples;
    this.jobs = shared.jobs;
    this.addressOf = shared.addressOf;
    this.openPlace = shared.openPlace;
    this.stage = document.createElement('main');
    this.stage.id = 'stage';
    window.addEventListener('popstate', () => this.follow());
  }

  /**
   * Opens a view and makes a step in the browser's history.
   * @param {string} id
   * @param {Record<string, string>} [own] parameters of the view itself
   */
  go(id, own = {}) {
    const parameters = this.addressOf();
    for (const [key, value] of Object.entries(own)) parameters.set(key, value);
    const place = writePlace(id, parameters);
    if (place !== location.hash) history.pushState(null, '', place);
    this.show(id, parameters);
  }

  /** Writes the design into the address without a step. */
  note() {
    if (!this.current || this.#following) return;
    const parameters = this.addressOf();
    for (const [key, value] of readPlace(location.hash).parameters)
      if (['job', 'items', 'tab'].includes(key)) parameters.set(key, value);
    history.replaceState(null, '', writePlace(this.current, parameters));
  }

  /** Follows the address, after back, forward or a link. */
  async follow() {
    const { view, parameters } = readPlace(location.hash);
    this.#following = true; // the address is right already
    try {
      await this.openPlace(parameters);
    } finally {
      this.#following = false;
    }
    this.show(view, parameters);
    this.note();
  }

  /** @param {string} id @param {URLSearchParams} parameters */
  show(id, parameters) {
    const entry = this.entries.find(candidate => candidate.id === id) ?? this.entries[0];
    let view = this.#views.get(entry.id);
    if (!view) {
      view = entry.make(this);
      this.#views.set(entry.id, view);
    }
    if (this.current !== entry.id) {
      this.#views.get(this.current)?.hide?.();
      this.current = entry.id;
      this.stage.replaceChildren(view.element);
    }
    view.show(parameters);
    this.dispatchEvent(new Event('view'));
  }

  /** The open view makes itself ready for paper. */
  print() {
    this.#views.get(this.current)?.print?.();
  }
}
