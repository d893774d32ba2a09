// SPDX-License-Identifier: GPL-3.0-or-later
// Over speed and over torque: asked for once the design rests, kept on show until the answer comes.
import { h } from '../base/dom.js';
import { labelOf, parseNumber, plain } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { Chart } from './chart.js';
import { caseText } from './context.js';
import { whenSeen } from './frame.js';

const REST = 350; // ms without a change before a sweep is asked for
const SPEEDS = 140;
const TORQUES = 24;

class Sweep {
  /** @type {any} */ #design = null;
  /** @type {import('../base/store.js').Pin | null} */ #pin = null;
  #timer = 0;
  #seen = false;
  #stale = false;
  #asked = '';
  /** @type {any} */ own = null;
  /** @type {any} */ pinned = null;

  /** @param {Chart} chart */
  constructor(chart) {
    this.chart = chart;
    this.lane = new Lane({
      result: (task, data) => {
        this[task.note === 'pin' ? 'pinned' : 'own'] = data;
        this.chart.element.classList.remove('waiting');
        this.draw();
        if (task.note === 'own' && this.#pin) this.#ask('pin');
      },
      refused: (_task, error) => this.chart.frame.say(error.message),
    });
    whenSeen(chart.element, visible => {
      this.#seen = visible;
      if (visible && this.#stale) this.later();
    });
  }

  /** @param {any} design @param {import('../base/store.js').Pin | null} pin */
  set(design, pin) {
    this.#design = design;
    this.#pin = pin;
    if (!pin) this.pinned = null;
    this.later();
  }

  get pinLabel() {
    return this.#pin?.label ?? '';
  }

  later() {
    this.#stale = true;
    clearTimeout(this.#timer);
    if (this.#seen && this.#design) this.#timer = window.setTimeout(() => this.#ask('own'), REST);
  }

  /** @param {'own' | 'pin'} which */
  #ask(which) {
    const design = which === 'own' ? this.#design : { ...this.#pin?.design, load_cases: this.#design.load_cases };
    const body = this.request(design);
    const text = JSON.stringify([body, this.#pin?.label]);
    if (which === 'own') {
      this.#stale = false;
      if (text === this.#asked) return;
      this.#asked = text;
      this.chart.element.classList.add('waiting');
    }
    this.chart.frame.say('');
    this.lane.submit({ path: 'sweep', body, note: which });
  }

  /** @param {any} design @returns {any} */
  request(design) {
    return { design };
  }

  draw() {}
}

/**
 * Two fields for a range.
 * @param {string} unit
 * @param {() => [number, number]} read
 * @param {(low: number, high: number) => void} take
 */
function rangeFields(unit, read, take) {
  const fields = ['from', 'to'].map((name, i) =>
    h('input.tiny', {
      type: 'text',
      inputmode: 'decimal',
      'aria-label': `${labelOf(name)}, ${unit}`,
      value: plain(read()[i]),
      onchange: (/** @type {Event} */ event) => {
        const field = /** @type {HTMLInputElement} */ (event.target);
        const range = read();
        const value = parseNumber(field.value);
        if (value !== undefined && value > 0) range[i] = value;
        if (range[0] < range[1]) take(range[0], range[1]);
        fields.forEach((each, k) => {
          /** @type {HTMLInputElement} */ (each).value = plain(read()[k]);
        });
      },
    }),
  );
  return h('span.range-fields', null, fields[0], '…', fields[1], ` ${unit}`);
}

export class SpeedSweep extends Sweep {
  #case = 0;

  constructor() {
    /** @type {[number, number]} */
    const range = [400, 8000];
    const fields = rangeFields(
      'rpm',
      () => [range[0], range[1]],
      (low, high) => {
        [range[0], range[1]] = [low, high];
        this.later();
      },
    );
    super(
      new Chart({
        title: 'Vibration over speed',
        unit: 'm/s²',
        help: 'RMS of the normal acceleration; upright lines: a mesh order meets an eigenfrequency',
        xLabel: 'pinion speed',
        xUnit: 'rpm',
        zero: true,
        wide: true,
        controls: [fields],
      }),
    );
    this.range = range;
    this.elements = [this.chart.element];
  }

  /** @param {import('./context.js').Context} context */
  show(context) {
    this.#case = context.loadCase;
  }

  /** @param {any} design */
  request(design) {
    const torque = design.load_cases[this.#case]?.torque_Nm ?? design.load_cases[0].torque_Nm;
    return {
      design,
      torque: { from: torque, to: torque, points: 1 },
      speed: { from: this.range[0], to: this.range[1], points: SPEEDS },
    };
  }

  draw() {
    const { own, pinned } = this;
    if (!own) return;
    const curves = [];
    const before = own.unmodified?.points?.rms_m_per_s2?.normal;
    if (before)
      curves.push({
        label: 'unmodified',
        y: before,
        colour: 'c1',
        line: pinned ? /** @type {const} */ ('dotted') : /** @type {const} */ ('dashed'),
      });
    if (pinned)
      curves.push({
        label: this.pinLabel,
        x: pinned.speed_rpm,
        y: pinned.modified.points.rms_m_per_s2.normal,
        colour: 'c1',
        line: /** @type {const} */ ('dashed'),
      });
    curves.push({
      label: `this design, ${caseText({ torque_Nm: own.torque_Nm[0] })}`,
      y: own.modified.points.rms_m_per_s2.normal,
      colour: 'c1',
    });
    if (own.modified.down)
      curves.push({ label: 'slowing down', y: own.modified.down.rms_m_per_s2.normal, colour: 'c2' });
    const { mode = [], order = [], speed_rpm: speed = [] } = own.crossings ?? {};
    const marks = speed
      .map((/** @type {number} */ x, /** @type {number} */ i) => ({
        x,
        label: order[i] <= 2 ? `${order[i]}× mode ${mode[i]}` : '',
        strong: order[i] === 1,
        order: order[i],
      }))
      .filter((/** @type {any} */ mark) => mark.order <= 3)
      .sort((/** @type {any} */ a, /** @type {any} */ b) => a.order - b.order || a.x - b.x);
    this.chart.set({ x: own.speed_rpm, curves, marks });
  }
}

export class TorqueSweep extends Sweep {
  constructor() {
    super(
      new Chart({
        title: 'PPLTE over torque',
        unit: 'µm',
        help: 'Peak-to-peak loaded transmission error from light to heavy load; upright lines: the load cases',
        xLabel: 'torque',
        xUnit: 'N m',
        zero: true,
      }),
    );
    this.elements = [this.chart.element];
  }

  /** @param {any} design */
  request(design) {
    const most = Math.max(...design.load_cases.map((/** @type {any} */ row) => row.torque_Nm));
    return { design, torque: { from: most / 20, to: 1.6 * most, points: TORQUES } };
  }

  draw() {
    const { own, pinned } = this;
    if (!own) return;
    const curves = [];
    if (own.unmodified)
      curves.push({
        label: 'unmodified',
        y: own.unmodified.by_torque.peak_to_peak_um,
        colour: 'c1',
        line: pinned ? /** @type {const} */ ('dotted') : /** @type {const} */ ('dashed'),
      });
    if (pinned)
      curves.push({
        label: this.pinLabel,
        x: pinned.torque_Nm,
        y: pinned.modified.by_torque.peak_to_peak_um,
        colour: 'c1',
        line: /** @type {const} */ ('dashed'),
      });
    curves.push({ label: 'this design', y: own.modified.by_torque.peak_to_peak_um, colour: 'c1' });
    const marks = own.design.load_cases.map((/** @type {any} */ row) => ({
      x: row.torque_Nm,
      label: '',
      strong: true,
    }));
    this.chart.set({ x: own.torque_Nm, curves, marks });
  }
}
