// SPDX-License-Identifier: GPL-3.0-or-later
// What the views share, and the way from one to another.
import { readPlace, writePlace } from './base/address.js';
import { Refusal } from './base/api.js';
import { choose } from './base/dialog.js';
import { Missing } from './base/library.js';
import { notice } from './base/notice.js';

/**
 * @typedef {object} View
 * @property {HTMLElement} element
 * @property {(parameters: URLSearchParams) => void} show
 * @property {() => import('./report.js').Parts | null} [report] what goes to paper
 */

/**
 * @typedef {{ id: string, title: string, load: () => Promise<(app: App) => View> }} Entry one tab; fetched and made
 * when it is first opened
 */

const OWN_KEYS = ['job', 'items', 'tab']; // of views, in the address
const TOLD = 4; // faults of a document that a notice has room for
const VIEW_KEYS = ['speeds', 'vary', 'shows']; // how the design is looked at: ranges and choices of its figures

export class App extends EventTarget {
  /** @type {Map<string, View>} */ #views = new Map();
  /** The address is right as it is. */
  #following = false;
  #turn = 0;
  current = '';
  /** The view before this one. */
  previous = '';

  /**
   * @param {Entry[]} entries
   * @param {{ store: import('./base/store.js').DesignStore, analyst: import('./base/analyst.js').Analyst,
   *   form: import('./form/form.js').Form, fields: import('./base/schema.js').Field[],
   *   fitted: import('./base/schema.js').Field[],
   *   library: import('./base/library.js').Library, jobs: import('./base/jobs.js').Jobs }} shared
   */
  constructor(entries, { store, analyst, form, fields, fitted, library, jobs }) {
    super();
    this.entries = entries;
    this.store = store;
    this.analyst = analyst;
    this.form = form;
    this.fields = fields;
    this.fitted = fitted;
    this.library = library;
    this.examples = library.examples;
    this.jobs = jobs;
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
    const parameters = this.#parameters();
    for (const [key, value] of Object.entries(own)) parameters.set(key, value);
    const place = writePlace(id, parameters);
    if (place !== location.hash) history.pushState(null, '', place);
    this.attempt(() => this.show(id, parameters));
  }

  /** What an address says of the design, of what it is compared with and of how it is looked at. */
  #parameters() {
    const { store, library } = this;
    const parameters = library.address();
    library.putPin(parameters);
    if (store.loadCase >= 0) parameters.set('case', String(store.loadCase + 1));
    for (const [key, value] of store.view) parameters.set(key, value);
    return parameters;
  }

  /** The other way round. @param {URLSearchParams} parameters */
  async #take(parameters) {
    const { store, library } = this;
    await library.openAddress(parameters);
    await library.openPin(parameters);
    for (const key of VIEW_KEYS) store.setView(key, parameters.get(key) ?? '');
    const chosen = Number(parameters.get('case') ?? 0) - 1;
    if (chosen !== store.loadCase && chosen < (store.design.load_cases?.length ?? 0)) store.setLoadCase(chosen);
  }

  /** Opens another design, as a step of its own in the browser's history. @param {() => unknown} act */
  async opening(act, view = this.entries.find(entry => entry.id === this.current)?.title ? this.current : 'design') {
    this.#following = true;
    try {
      await act();
    } finally {
      this.#following = false;
    }
    this.go(view);
  }

  /** Writes the design into the address without a step. */
  note() {
    if (!this.current || this.#following) return;
    const parameters = this.#parameters();
    for (const [key, value] of readPlace(location.hash).parameters)
      if (OWN_KEYS.includes(key)) parameters.set(key, value);
    history.replaceState(null, '', writePlace(this.current, parameters));
  }

  /** Follows the address, after back, forward or a link. */
  async follow() {
    const { view, parameters } = readPlace(location.hash);
    this.#following = true; // the address is right already
    try {
      await this.#take(parameters);
      await this.show(view, parameters);
    } catch (error) {
      await this.show(view, parameters);
      if (error instanceof Missing) await this.#askInstead(error);
      else notice.say(/** @type {Error} */ (error).message);
    } finally {
      this.#following = false;
    }
    this.note();
  }

  /** An address leads to nothing: what instead? @param {Missing} missing */
  async #askInstead(missing) {
    const answer = await choose(
      missing.message,
      ['It was deleted, or the link is of another server. Nothing on this page has changed.'],
      [
        { value: 'stored', text: 'Look through the stored designs', primary: true },
        { value: '', text: `Go on with ${this.store.design.name || 'what is on the table'}` },
      ],
    );
    if (answer) this.dispatchEvent(new Event('stored'));
  }

  /** A view, fetched and made when it is not there yet. @param {string} id */
  async view(id) {
    const entry = this.entries.find(candidate => candidate.id === id) ?? this.entries[0];
    let view = this.#views.get(entry.id);
    if (!view) {
      const make = await entry.load();
      view = this.#views.get(entry.id) ?? make(this); // two may have waited
      this.#views.set(entry.id, view);
    }
    return { entry, view };
  }

  /** What the open view gives to paper; of the Design view when it has nothing of its own. */
  reportParts() {
    const id = this.current === 'report' ? this.previous : this.current;
    return this.#views.get(id)?.report?.() ?? this.#views.get('design')?.report?.() ?? null;
  }

  /** @param {string} id @param {URLSearchParams} parameters */
  async show(id, parameters) {
    const turn = ++this.#turn;
    const { entry, view } = await this.view(id);
    if (turn !== this.#turn) return; // another one was asked for meanwhile
    if (this.current !== entry.id) {
      if (this.current !== 'glossary') this.previous = this.current;
      this.current = entry.id;
      this.stage.replaceChildren(view.element);
    }
    view.show(parameters);
    this.dispatchEvent(new Event('view'));
  }

  /** Tells what went wrong instead of nothing. @param {() => unknown} act */
  async attempt(act) {
    try {
      await act();
    } catch (error) {
      const faults = error instanceof Refusal ? error.faults : [];
      const told = faults.slice(0, TOLD).map(fault => `${fault.pointer} ${fault.detail}`);
      if (faults.length > TOLD) told.push(`${faults.length - TOLD} more.`);
      notice.say(told.length ? told.join(' ') : /** @type {Error} */ (error).message);
    }
  }
}
