// SPDX-License-Identifier: GPL-3.0-or-later
// Over speed and over torque: asked for once the design rests, kept on show until the answer comes.
import { h } from '../base/dom.js';
import { labelOf, plain } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { readQuantity } from '../base/quantity.js';
import { Chart } from './chart.js';
import { OWN_COLOUR, REFERENCE_COLOUR, caseColour, torqueOf } from './context.js';
import { whenSeen } from './frame.js';

const REST = 350; // ms without a change before a sweep in sight is asked for
const IDLE = 3000; // ms before one out of sight is, so that a report is whole
const SPEEDS = 140;
/** rpm @type {[number, number]} */
const USUAL_SPEEDS = [400, 8000];
const TORQUES = 24;
const SHOWN_ORDERS = 3; // crossings of higher orders are not marked
const NAMED_ORDERS = 2;

class Sweep {
  /** @type {Api.Design | null} */ #design = null;
  /** @type {import('../base/store.js').Pin | null} */ #pin = null;
  #timer = 0;
  #seen = false;
  #asked = '';
  /** @type {Api.Sweep | null} */ own = null;
  /** @type {Api.Sweep | null} */ pinned = null;

  /** @param {Chart} chart */
  constructor(chart) {
    this.chart = chart;
    /** @type {Lane<Api.Sweep>} */
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
      if (visible) this.later();
    });
  }

  /** Nothing more is to come for the design of now. */
  get settled() {
    const waiting = this.chart.element.classList.contains('waiting');
    return this.#design !== null && !waiting && JSON.stringify(this.#body('own')) === this.#asked;
  }

  /** @param {Api.Design} design @param {import('../base/store.js').Pin | null} pin */
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
    clearTimeout(this.#timer);
    if (this.#design) this.#timer = window.setTimeout(() => this.#ask('own'), this.#seen ? REST : IDLE);
  }

  /** At once, in sight or not. */
  now() {
    clearTimeout(this.#timer);
    if (this.#design) this.#ask('own');
  }

  /** @param {'own' | 'pin'} which */
  #body(which) {
    const own = /** @type {Api.Design} */ (this.#design);
    const design = which === 'pin' && this.#pin ? { ...this.#pin.design, load_cases: own.load_cases } : own;
    return { request: this.request(design), pin: this.#pin?.label };
  }

  /** @param {'own' | 'pin'} which */
  #ask(which) {
    const body = this.#body(which);
    const text = JSON.stringify(body);
    if (which === 'own') {
      if (text === this.#asked) return;
      this.#asked = text;
      this.chart.element.classList.add('waiting');
    }
    this.chart.frame.say('');
    this.lane.submit({ path: 'sweep', body: body.request, note: which });
  }

  /** @param {Api.Design} design @returns {Api.SweepRequest} */
  request(design) {
    return { design };
  }

  draw() {}

  /**
   * Curves of what it is compared with, then its own.
   * @param {(half: Api.SweepVariant) => Page.Curve} read a curve of one half of an answer
   * @param {'speed_rpm' | 'torque_Nm'} abscissa
   * @param {string} label of the design's own
   * @param {string} colour
   */
  curves(read, abscissa, label, colour) {
    /** @type {import('./chart.js').Curve[]} */
    const curves = [];
    const { own, pinned } = this;
    if (!own) return curves;
    if (own.unmodified)
      curves.push({
        label: 'unmodified',
        y: read(own.unmodified),
        colour: REFERENCE_COLOUR,
        line: pinned ? 'dotted' : 'dashed',
      });
    if (pinned)
      curves.push({
        label: this.pinLabel,
        x: pinned[abscissa],
        y: read(pinned.modified),
        colour: REFERENCE_COLOUR,
        line: 'dashed',
      });
    curves.push({ label, y: read(own.modified), colour });
    return curves;
  }
}

/**
 * Two fields for a range; what cannot be taken is marked and stays until it can.
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
      onchange: () => {
        const values = fields.map(field => readQuantity(field.value, unit).value ?? NaN);
        const good = values[0] > 0 && values[0] < values[1];
        for (const field of fields) field.setAttribute('aria-invalid', String(!good));
        if (!good) return;
        take(values[0], values[1]);
        for (const [k, field] of fields.entries()) field.value = plain(read()[k]);
      },
    }),
  );
  const refresh = () =>
    fields.forEach((field, i) => {
      if (field !== document.activeElement) field.value = plain(read()[i]);
    });
  return { element: h('span.range-fields', null, fields[0], '…', fields[1], ` ${unit}`), refresh };
}

/**
 * The range of speeds that is swept.
 * @param {import('../base/store.js').DesignStore} store @returns {[number, number]}
 */
function speedsOf(store) {
  const [low, high] = (store.view.get('speeds') ?? '').split('-').map(Number);
  return low > 0 && low < high ? [low, high] : USUAL_SPEEDS;
}

export class SpeedSweep extends Sweep {
  #case = 0;

  /** @param {import('../base/store.js').DesignStore} store */
  constructor(store) {
    const fields = rangeFields(
      'rpm',
      () => speedsOf(store),
      (low, high) => store.setView('speeds', `${low}-${high}`),
    );
    super(
      new Chart({
        title: 'Vibration over speed',
        name: 'Vibration acceleration over the speed',
        unit: 'm/s²',
        help:
          'RMS of the normal acceleration of the teeth at each speed, at the torque of the chosen load case; ' +
          'upright lines: a multiple of the mesh frequency meets a natural frequency.',
        good: 'Low at the speeds you run at, and no peak near them.',
        xLabel: 'pinion speed',
        xUnit: 'rpm',
        zero: true,
        wide: true,
        controls: [fields.element],
      }),
    );
    this.store = store;
    this.elements = [this.chart.element];
    store.addEventListener('change', event => {
      if (/** @type {CustomEvent} */ (event).detail !== 'view') return;
      fields.refresh();
      this.later();
    });
  }

  /** @param {import('./context.js').Context} context */
  show(context) {
    if (this.#case === context.loadCase) return;
    this.#case = context.loadCase;
    this.later();
  }

  /** @param {Api.Design} design */
  request(design) {
    const torque = torqueOf(design.load_cases[this.#case] ?? design.load_cases[0]);
    const [from, to] = speedsOf(this.store);
    return {
      design,
      torque: { from: torque, to: torque, points: 1 },
      speed: { from, to, points: SPEEDS },
    };
  }

  draw() {
    const { own } = this;
    if (!own) return;
    const torque = `${plain(own.torque_Nm[0])} N m`;
    this.chart.frame.setCase(torque);
    const curves = this.curves(
      half => half.points.rms_m_per_s2.normal,
      'speed_rpm',
      'this design',
      caseColour(this.#case),
    );
    if (own.modified.down)
      curves.push({ label: 'slowing down', y: own.modified.down.rms_m_per_s2.normal, colour: OWN_COLOUR });
    const { mode = [], order = [], speed_rpm: speed = [] } = own.crossings ?? {};
    const marks = speed
      .map((x, i) => ({
        x,
        label: order[i] <= NAMED_ORDERS ? `${order[i]}× mode ${mode[i]}` : '',
        strong: order[i] === 1,
        order: order[i],
      }))
      .filter(mark => mark.order <= SHOWN_ORDERS)
      .sort((a, b) => a.order - b.order || a.x - b.x);
    this.chart.set({ x: own.speed_rpm, curves, marks });
  }
}

export class TorqueSweep extends Sweep {
  constructor() {
    super(
      new Chart({
        title: 'PPLTE over torque',
        name: 'Peak-to-peak loaded transmission error over the torque',
        unit: 'µm',
        help: 'From light to heavy load; upright lines: the load cases.',
        good: 'Low at every load case; a relief that is right at one torque is too much or too little at another.',
        xLabel: 'torque',
        xUnit: 'N m',
        zero: true,
      }),
    );
    this.elements = [this.chart.element];
  }

  /** @param {Api.Design} design */
  request(design) {
    const most = Math.max(...design.load_cases.map(torqueOf));
    return { design, torque: { from: most / 20, to: 1.6 * most, points: TORQUES } };
  }

  draw() {
    const { own } = this;
    if (!own) return;
    const curves = this.curves(half => half.by_torque.peak_to_peak_um, 'torque_Nm', 'this design', OWN_COLOUR);
    const marks = own.design.load_cases.map(row => ({
      x: Number(row.torque_Nm),
      label: '',
      strong: true,
    }));
    this.chart.frame.about = 'all load cases';
    this.chart.set({ x: own.torque_Nm, curves, marks });
  }
}
