// SPDX-License-Identifier: GPL-3.0-or-later
// Vibration acceleration over the mesh cycle and its orders.
import { switcher } from '../base/switcher.js';
import { Chart } from './chart.js';
import { END_COLOUR, caseColour, caseLong, caseNames, counting, endsOf, sameCase } from './context.js';

/** @typedef {'normal' | 'transverse' | 'rotational'} Reading */

const READINGS = /** @type {[Reading, string][]} */ ([
  ['normal', 'normal'],
  ['transverse', 'transv.'],
  ['rotational', 'rotat.'],
]);
const ORDERS = 12;

export class Vibration {
  #reading = /** @type {Reading} */ ('normal');

  /** @param {() => void} again */
  constructor(again) {
    this.cycle = new Chart({
      title: 'Vibration',
      name: 'Vibration acceleration of the teeth',
      unit: 'm/s²',
      help:
        'Relative acceleration of the teeth of each end along the line of action in steady running: normal, ' +
        'transverse, or by rotation alone.',
      good: 'Small is good.',
      xLabel: 'mesh cycle',
      cycle: true,
      controls: [
        switcher('Acceleration', READINGS, this.#reading, value => {
          this.#reading = value;
          again();
        }),
      ],
    });
    this.orders = new Chart({
      title: 'Orders of the vibration',
      unit: 'm/s²',
      help:
        'Amplitude of each multiple of the mesh frequency, mean of the ends; pale behind each bar: what it is ' +
        'compared with.',
      good: 'Small is good.',
      xLabel: 'mesh order',
      bars: true,
    });
    this.elements = [this.cycle.element, this.orders.element];
  }

  /** @param {import('./context.js').Context} context */
  set({ result, references, loadCase: k }) {
    const loadCase = result.load_cases[k];
    const reading = /** @type {const} */ (`${this.#reading}_m_per_s2`);
    const names = caseNames(result.load_cases);
    /** @type {import('./chart.js').Curve[]} */
    const curves = [];
    /** @type {import('./chart.js').Curve[]} */
    const bars = [];
    for (const reference of references) {
      const other = sameCase(reference.result, loadCase, k)?.vibration;
      for (const end of endsOf(result)) {
        const y = other?.[end]?.history?.[reading];
        if (y)
          curves.push({
            label: `${end}, ${reference.label}`,
            x: other?.position ?? undefined,
            y,
            colour: END_COLOUR[end],
            line: reference.line,
          });
      }
      result.load_cases.forEach((c, i) => {
        const orders = sameCase(reference.result, c, i)?.vibration?.[`orders_${reading}`];
        if (orders)
          bars.push({
            label: `${names[i]}, ${reference.label}`,
            y: orders.slice(1, ORDERS + 1),
            colour: caseColour(i),
            line: reference.line,
          });
      });
    }
    const own = loadCase.vibration;
    for (const end of endsOf(result)) {
      const y = own?.[end]?.history?.[reading];
      if (y) curves.push({ label: `${end} end`, y, colour: END_COLOUR[end] });
    }
    result.load_cases.forEach((c, i) => {
      const orders = c.vibration?.[`orders_${reading}`];
      if (orders) bars.push({ label: names[i], y: orders.slice(1, ORDERS + 1), colour: caseColour(i) });
    });
    // a stroke's answers have no histories: the last ones stay until it rests
    const late = endsOf(result).some(end => own?.[end] && !own[end]?.history);
    this.cycle.element.classList.toggle('waiting', late);
    this.cycle.frame.setCase(caseLong(loadCase));
    this.orders.frame.about = 'all load cases';
    this.cycle.frame.say(curves.length ? '' : 'No periodic vibration was found.');
    if (!late && own?.position && curves.length) this.cycle.set({ x: own.position, curves });
    this.orders.set({ x: counting(ORDERS, 1), curves: bars });
  }
}
