// SPDX-License-Identifier: GPL-3.0-or-later
// The measurements of a design with their comparison, asked for anew when the design rests.
import { list } from '../../base/api.js';
import { Lane } from '../../base/lane.js';
import { shownSentence } from '../../base/units.js';

const REST = 350; // ms without a change before the comparison is asked for
// Parts by which recordings of two pairs may differ and still stand beside each other.
const SAME_TORQUE = 0.01;
const SAME_SPEED = 0.02;

/** Equal but for a part. @param {Page.Reading} a @param {Page.Reading} b @param {number} part */
const near = (a, b, part) => a !== null && b !== null && Math.abs(a / b - 1) < part;

/** @param {Api.Job} job */
function fractionText(job) {
  const fraction = job?.progress?.fraction;
  return typeof fraction === 'number' ? `: ${Math.round(100 * fraction)} %` : '…';
}

/** Measurements of a design with their comparison. */
export class Bench extends EventTarget {
  /** @type {Api.ListedMeasurement[]} */ items = [];
  /** @type {Api.Comparison | null} */ comparison = null;
  #timer = 0;
  #id = '';
  #asked = '';

  /** @param {import('../../base/store.js').DesignStore} store */
  constructor(store) {
    super();
    this.store = store;
    this.note = '';
    /** @type {Lane<Api.Comparison>} */
    this.lane = new Lane({
      result: (_task, data) => {
        this.comparison = data;
        this.#say('');
      },
      refused: (_task, error) => this.#say(error.message),
      preparing: (_task, job) => this.#say(`The prediction waits for the teeth${fractionText(job)}`),
    });
  }

  get designId() {
    return this.store.from.id;
  }

  /** @param {string} text */
  #say(text) {
    this.note = text;
    this.dispatchEvent(new Event('change'));
  }

  async load() {
    const id = this.designId;
    if (id !== this.#id) {
      this.#id = id;
      this.comparison = null;
      this.#asked = '';
    }
    this.items = id ? await list(`measurements?design=${encodeURIComponent(id)}`, 256) : [];
    this.#say('');
    this.later(true);
  }

  /** @param {boolean} [anew] */
  later(anew = false) {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#compare(anew), anew ? 0 : REST);
  }

  /** @param {boolean} anew */
  #compare(anew) {
    if (!this.items.length || !this.designId) {
      this.comparison = null;
      this.#say('');
      return;
    }
    const { design } = this.store;
    const text = JSON.stringify(design);
    if (!anew && text === this.#asked) return;
    this.#asked = text;
    this.lane.submit({ path: `designs/${encodeURIComponent(this.designId)}/comparison`, body: design });
  }

  /** What the comparison says of a measurement. @param {number} id */
  of(id) {
    const c = this.comparison;
    const at = c ? c.id.indexOf(id) : -1;
    if (!c || at < 0) return null;
    const m = c.measurements;
    return {
      predicted: m.predicted_rms_m_per_s2[at],
      ratio: m.ratio[at],
      outlier: m.outlier[at],
      reason: m.reason[at],
      detail: c.details[at],
      reduction: c.reductions.find(each => each.id === id),
    };
  }

  /** The measurement of the other pair at the torque and speed of this one. @param {Api.ListedMeasurement} item */
  partner(item) {
    return this.items.find(
      each =>
        each.label !== item.label &&
        near(each.torque_Nm, item.torque_Nm, SAME_TORQUE) &&
        near(each.result.speed_rpm.mean, item.result.speed_rpm.mean, SAME_SPEED),
    );
  }

  /** What the comparison could not take, with its reasons. */
  get leftOut() {
    const found = this.comparison?.left_out ?? [];
    if (!found.length) return '';
    const names = found.map(
      item => `${this.items.find(each => each.id === item.id)?.file ?? item.id}: ${shownSentence(item.reason)}`,
    );
    return `Left out of the comparison: ${names.join(' ')}`;
  }
}
