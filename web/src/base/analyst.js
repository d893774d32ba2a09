// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps results in step with the design: its own, the unmodified pair's and the pinned design's.
import { Refusal, connection } from './api.js';
import { Lane } from './lane.js';
import { unmodified } from './store.js';

const ANALYZE = 'analyze?histories=1&rating=0&pitch=0';
/**
 * While a slider moves: what figures show of the load case on the screen, what they compare between load cases, and the
 * design as resolved, which the form shows; no histories over time, and no more digits than a screen has points for.
 */
const STROKE =
  'analyze?rating=0&pitch=0&digits=6&parts=design,modification,mesh_stiffness,load_share,pattern,maps,overview';
/** With the rating, which takes two more contact analyses, and the maps of the tribology alone. */
const RATE = 'analyze?pitch=0&digits=8&parts=design,tribology,maps';
const TEETH = 'analyze?rating=0&parts=design,pitch'; // single teeth over the hunting period: seconds
const REST = 900; // ms without a change before the design is rated

/** What the results of a reference depend on. @param {Api.Design} design */
function loadKey(design) {
  const { name, modification, optimization, ...rest } = design;
  return JSON.stringify(rest);
}

export class Analyst extends EventTarget {
  /** @type {Page.Result | null} */ result = null;
  /** The last design that had a result. @type {Api.Design | null} */ possible = null;
  /** @type {Page.Result | null} */ plain = null;
  /** @type {Page.Result | null} */ pinned = null;
  /** "", "busy", "preparing", "refused" */ state = '';
  /** @type {Api.Job | null} */ job = null;
  /** @type {Error | null} */ refusal = null;
  ms = 0;
  /** Load case that figures of one load case show; the only one with all its curves in a stroke's answers. */
  shown = 0;
  /** The result is a stroke's. */
  partial = false;
  /** The last result with a rating. @type {Page.Result | null} */ rated = null;
  /** The result with single teeth, where the design states some. @type {Page.Result | null} */ teeth = null;
  #rest = 0;
  #plainKey = '';
  #pinKey = '';

  /** @param {import('./store.js').DesignStore} store */
  constructor(store) {
    super();
    this.store = store;
    /** @type {Lane<Page.Result>} */
    this.own = new Lane({
      result: (task, data, ms) => {
        this.result = data;
        this.possible = /** @type {Api.Design} */ (task.body);
        this.partial = task.note === 'stroke';
        this.ms = ms;
        this.refusal = null;
        this.#state(this.store.faults.size ? 'refused' : ''); // of the design before what is typed now
        this.#tell('result');
        clearTimeout(this.#rest);
        if (this.partial) return;
        this.#rest = window.setTimeout(() => this.#atRest(), REST);
      },
      preparing: (_task, job) => {
        this.job = job;
        this.#state('preparing');
      },
      refused: (_task, error) => {
        this.refusal = error;
        this.#state('refused');
      },
    });
    /** @type {Lane<Page.Result>} */
    this.reference = new Lane({
      result: (task, data) => {
        this[task.note === 'pin' ? 'pinned' : 'plain'] = data;
        this.#tell('result');
        if (task.note === 'plain') this.#askPin();
      },
      refused: task => {
        this[task.note === 'pin' ? 'pinned' : 'plain'] = null;
      },
    });
    /** @type {Lane<Page.Result>} */
    this.rating = new Lane({
      result: (_task, data) => {
        this.rated = data;
        this.#tell('rating');
      },
    });
    /** @type {Lane<Page.Result>} */
    this.period = new Lane({
      result: (_task, data) => {
        this.teeth = data;
        this.#tell('teeth');
      },
    });
    store.addEventListener('change', event => {
      const what = /** @type {CustomEvent} */ (event).detail;
      if (what === 'view') this.#tell('result');
      else this.update(what === 'live');
    });
    connection.addEventListener('change', () => this.#tell('state'));
  }

  get faults() {
    return this.refusal instanceof Refusal ? this.refusal.faults : [];
  }

  get message() {
    return this.refusal?.message ?? '';
  }

  /** What takes longer is asked for when the design rests. */
  #atRest() {
    const { design } = this.store;
    this.rating.submit({ path: RATE, body: design });
    if (design.pitch) this.period.submit({ path: TEETH, body: design });
    else if (this.teeth) {
      this.teeth = null;
      this.#tell('teeth');
    }
  }

  /** @param {boolean} [stroke] more changes are to come at once */
  update(stroke = false) {
    const { store } = this;
    if (store.faults.size) {
      this.refusal = null;
      this.#state('refused');
      return;
    }
    const { design } = store;
    if (this.state !== 'preparing') this.#state('busy');
    const last = (design.load_cases?.length ?? 1) - 1;
    const path = stroke ? `${STROKE}&curves_of=${Math.min(this.shown, last)}` : ANALYZE;
    this.own.submit({ path, body: design, note: stroke ? 'stroke' : '' });
    const key = loadKey(design);
    if (key !== this.#plainKey) {
      this.#plainKey = key;
      this.reference.submit({ path: ANALYZE, body: unmodified(design), note: 'plain' });
    } else this.#askPin();
  }

  #askPin() {
    const { pin, design } = this.store;
    if (!pin) {
      if (this.pinned) {
        this.pinned = null;
        this.#pinKey = '';
        this.#tell('result');
      }
      return;
    }
    const body = { ...pin.design, load_cases: design.load_cases };
    const key = JSON.stringify(body);
    if (key === this.#pinKey) return;
    this.#pinKey = key;
    this.reference.submit({ path: ANALYZE, body, note: 'pin' });
  }

  /** @param {string} state */
  #state(state) {
    this.state = state;
    this.#tell('state');
  }

  /** @param {string} what */
  #tell(what) {
    this.dispatchEvent(new Event(what));
  }

  /** @returns {import('../figures/context.js').Reference[]} the one to compare with first */
  references() {
    const { pin } = this.store;
    /** @type {import('../figures/context.js').Reference[]} */
    const references = [];
    if (pin && this.pinned) references.push({ label: pin.label, result: this.pinned, line: 'dashed' });
    if (this.plain) references.push({ label: 'unmodified', result: this.plain, line: pin ? 'dotted' : 'dashed' });
    return references;
  }
}
