// SPDX-License-Identifier: GPL-3.0-or-later
// The design on the table, whose it is, what it is compared with, and the way back.
import { same, valueAt, withValue } from './pointer.js';

/**
 * @typedef {{ label: string, design: Api.Design, from?: { example?: string, id?: string } }} Pin from: what a
 *   link tells its difference from
 */
/**
 * Whose a design is: an example's, a stored one's or nobody's yet; and what stands there, to see whether it differs.
 * @typedef {{ example: string, id: string, etag: string, base: any }} Identity
 */
/** @typedef {{ design: Api.Design, from: Identity }} Step what undo brings back */

const DEPTH = 200;
const ENDS = ['left', 'right'];

/** @param {Partial<Identity>} [from] @returns {Identity} */
function identity({ example = '', id = '', etag = '', base = null } = {}) {
  return { example, id, etag, base };
}

export class DesignStore extends EventTarget {
  design = /** @type {Api.Design} */ ({});
  from = identity({ example: 'paper' });
  tied = true;
  /** null: the unmodified pair. @type {Pin | null} */ pin = null;
  /** Load case whose numbers are shown large; -1: the one with the largest share. */
  loadCase = -1;
  /** How it is looked at, as far as a link says it: ranges and choices of figures. @type {Map<string, string>} */
  view = new Map();
  /** Faults of texts that could not become values. @type {Map<string, string>} */ faults = new Map();

  /** @type {Step[]} */ #past = [];
  /** @type {Step[]} */ #future = [];
  #stroke = '';

  /**
   * @param {(design: Api.Design) => Api.Design} [whole] a design with every default written out, so that equal ones
   *   are the same
   */
  constructor(whole = design => design) {
    super();
    this.whole = whole;
  }

  /** @param {string} what "design", "live" (more to come), "view", "fault" */
  #tell(what) {
    this.dispatchEvent(new CustomEvent('change', { detail: what }));
  }

  /** @param {string} pointer */
  get(pointer) {
    return valueAt(this.design, pointer);
  }

  /** Whether the design differs from what is stored, or from the example. */
  get changed() {
    const { base } = this.from;
    return base === null || (base !== this.design && !same(this.whole(this.design), this.whole(base)));
  }

  /**
   * @param {string} pointer @param {unknown} value
   * @param {{ live?: boolean }} [options] live: one of a stroke of changes, which undo takes back as one
   */
  set(pointer, value, { live = false } = {}) {
    let design = withValue(this.design, pointer, value);
    const twin = this.#twin(pointer);
    if (twin) design = withValue(design, twin, value);
    if (same(design, this.design)) {
      if (!live) this.#stroke = '';
      return;
    }
    this.#remember(live ? pointer : '');
    this.design = design;
    this.#tell(live ? 'live' : 'design');
  }

  /** Several values as one step. @param {[string, unknown][]} changes */
  setAll(changes) {
    let { design } = this;
    for (const [pointer, value] of changes) {
      design = withValue(design, pointer, value);
      const twin = this.#twin(pointer);
      if (twin) design = withValue(design, twin, value);
    }
    if (same(design, this.design)) return;
    this.#remember('');
    this.design = design;
    this.#tell('design');
  }

  /** The same key of the other end, when the ends are tied. @param {string} pointer */
  #twin(pointer) {
    const match = /^(\/modification\/[a-z]+\/)(left|right)(\/.*)?$/.exec(pointer);
    if (!match || !this.tied || (this.design.gear_pair?.ends ?? 2) === 1) return '';
    return `${match[1]}${match[2] === 'left' ? 'right' : 'left'}${match[3] ?? ''}`;
  }

  /** @param {string} stroke */
  #remember(stroke) {
    if (stroke === '' || stroke !== this.#stroke) {
      this.#past.push({ design: this.design, from: this.from });
      if (this.#past.length > DEPTH) this.#past.shift();
    }
    this.#stroke = stroke;
    this.#future = [];
  }

  /** A stroke has ended. */
  settle() {
    if (this.#stroke === '') return;
    this.#stroke = '';
    this.#tell('design');
  }

  /**
   * Another design altogether.
   * @param {Api.Design} design
   * @param {Partial<Identity>} from base: what stands there, the design itself when it is left out and somebody's
   * @param {{ fresh?: boolean }} [options] fresh: nothing to go back to
   */
  open(design, from, { fresh = false } = {}) {
    if (!fresh) this.#remember('');
    else {
      this.#past = [];
      this.#future = [];
    }
    this.design = design;
    this.from = identity({ ...from, base: from.base ?? (from.example || from.id ? design : null) });
    this.tied = this.#endsEqual();
    this.loadCase = -1;
    this.#forgetTyped();
    this.dispatchEvent(new Event('open'));
    this.#tell('design');
  }

  /**
   * What is on the table is stored now. A design stored as a new one takes its steps back with it, so that undo does
   * not lead to the one that it came from.
   * @param {string} id
   * @param {string} etag
   */
  kept(id, etag) {
    if (this.from.id === id) Object.assign(this.from, { etag, base: this.design });
    else {
      const [before, now] = [this.from, identity({ id, etag, base: this.design })];
      for (const step of [...this.#past, ...this.#future]) if (step.from === before) step.from = now;
      this.from = now;
    }
    this.#tell('view');
  }

  /** The stored one is gone; what is on the table stays. @param {string} id */
  orphaned(id) {
    for (const from of new Set([this.from, ...[...this.#past, ...this.#future].map(step => step.from)]))
      if (from.id === id) Object.assign(from, identity());
    this.#tell('view');
  }

  #endsEqual() {
    return ['pinion', 'gear'].every(member =>
      same(this.get(`/modification/${member}/left`), this.get(`/modification/${member}/right`)),
    );
  }

  /** @param {boolean} tied the right end takes what the left has */
  tie(tied) {
    this.tied = tied;
    if (tied && !this.#endsEqual()) {
      this.#remember('');
      for (const member of ['pinion', 'gear']) {
        const left = this.get(`/modification/${member}/${ENDS[0]}`);
        if (this.get(`/modification/${member}`))
          this.design = withValue(this.design, `/modification/${member}/${ENDS[1]}`, left);
      }
      this.#tell('design');
    } else this.#tell('view');
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  undo() {
    this.#step(this.#past, this.#future);
  }

  redo() {
    this.#step(this.#future, this.#past);
  }

  /** @param {Step[]} source @param {Step[]} target */
  #step(source, target) {
    const step = source.pop();
    if (step === undefined) return;
    target.push({ design: this.design, from: this.from });
    const other = step.from !== this.from;
    this.design = step.design;
    this.from = step.from;
    this.#stroke = '';
    this.tied = this.tied && this.#endsEqual();
    this.#forgetTyped();
    if (other) this.dispatchEvent(new Event('open'));
    this.#tell('design');
  }

  /** What is typed and not yet a value ends with the design that it was typed for. */
  #forgetTyped() {
    this.faults.clear();
    this.dispatchEvent(new Event('reset'));
  }

  /** @param {Pin | null} pin */
  setPin(pin) {
    this.pin = pin;
    this.#tell('design');
  }

  /** @param {number} index */
  setLoadCase(index) {
    this.loadCase = index;
    this.#tell('view');
  }

  /** @param {string} key @param {string} value "": as usual */
  setView(key, value) {
    if ((this.view.get(key) ?? '') === value) return;
    if (value) this.view.set(key, value);
    else this.view.delete(key);
    this.#tell('view');
  }

  /** @param {string} pointer @param {string} fault "" when there is none */
  setFault(pointer, fault) {
    if (fault ? this.faults.get(pointer) === fault : !this.faults.has(pointer)) return;
    if (fault) this.faults.set(pointer, fault);
    else this.faults.delete(pointer);
    this.#tell('fault');
  }
}

/** The pair without any modification, under the same load. @template {Page.Design} D @param {D} design */
export function unmodified(design) {
  return { ...design, modification: {} };
}

/**
 * A resolved design as a document: what is null in it is not stated.
 * @param {Page.Design} design
 */
export function documentOf(design) {
  return /** @type {Api.Design} */ (design);
}
