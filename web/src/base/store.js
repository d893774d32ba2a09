// SPDX-License-Identifier: GPL-3.0-or-later
// The design on the table, what it is compared with, and the way back.
import { same, valueAt, withValue } from './pointer.js';

/** @typedef {{ label: string, design: any }} Pin */

const DEPTH = 200;
const ENDS = ['left', 'right'];

export class DesignStore extends EventTarget {
  /** @type {any} */ design = {};
  /** Where it came from: an example's name or a stored design's id. */
  from = { example: 'paper', id: '', etag: '' };
  tied = true;
  /** null: the unmodified pair. @type {Pin | null} */ pin = null;
  /** Load case whose numbers are shown large; -1: the one with the largest share. */
  loadCase = -1;
  /** Faults of texts that could not become values. @type {Map<string, string>} */ faults = new Map();

  /** @type {any[]} */ #past = [];
  /** @type {any[]} */ #future = [];
  #stroke = '';

  /** @param {string} what "design", "live" (more to come), "view", "fault" */
  #tell(what) {
    this.dispatchEvent(new CustomEvent('change', { detail: what }));
  }

  /** @param {string} pointer */
  get(pointer) {
    return valueAt(this.design, pointer);
  }

  /**
   * @param {string} pointer @param {any} value
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

  /** The same key of the other end, when the ends are tied. @param {string} pointer */
  #twin(pointer) {
    const match = /^(\/modification\/[a-z]+\/)(left|right)(\/.*)?$/.exec(pointer);
    if (!match || !this.tied || (this.design.gear_pair?.ends ?? 2) === 1) return '';
    return `${match[1]}${match[2] === 'left' ? 'right' : 'left'}${match[3] ?? ''}`;
  }

  /** @param {string} stroke */
  #remember(stroke) {
    if (stroke === '' || stroke !== this.#stroke) {
      this.#past.push(this.design);
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
   * @param {any} design
   * @param {{ example?: string, id?: string, etag?: string }} from
   * @param {{ fresh?: boolean }} [options]
   */
  open(design, from, { fresh = false } = {}) {
    if (!fresh) this.#remember('');
    else {
      this.#past = [];
      this.#future = [];
    }
    this.design = design;
    this.from = { example: from.example ?? '', id: from.id ?? '', etag: from.etag ?? '' };
    this.faults.clear();
    this.tied = this.#endsEqual();
    this.loadCase = -1;
    this.dispatchEvent(new Event('open'));
    this.#tell('design');
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

  /** @param {any[]} from @param {any[]} to */
  #step(from, to) {
    const design = from.pop();
    if (design === undefined) return;
    to.push(this.design);
    this.design = design;
    this.#stroke = '';
    this.faults.clear();
    this.tied = this.tied && this.#endsEqual();
    this.#tell('design');
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

  /** @param {string} pointer @param {string} fault "" when there is none */
  setFault(pointer, fault) {
    if (fault) this.faults.set(pointer, fault);
    else if (!this.faults.delete(pointer)) return;
    this.#tell('fault');
  }
}

/** The pair without any modification, under the same load. @param {any} design */
export function unmodified(design) {
  return { ...design, modification: {} };
}
