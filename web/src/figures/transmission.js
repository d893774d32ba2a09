// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded transmission error over the mesh cycle, of the pair or one end, at every torque, and its orders.
import { switcher } from '../base/switcher.js';
import { Chart } from './chart.js';
import { caseColour, caseNames, counting, endsOf, lessMean, sameCase } from './context.js';

const ORDERS = 8;

export class Transmission {
  #which = /** @type {'pair' | Page.End} */ ('pair');

  /** @param {() => void} again draws again */
  constructor(again) {
    const choose = switcher(
      'Transmission error of',
      [
        ['pair', 'pair'],
        ['left', 'left'],
        ['right', 'right'],
      ],
      this.#which,
      value => {
        this.#which = value;
        again();
      },
    );
    this.chart = new Chart({
      title: 'Loaded TE',
      name: 'Loaded transmission error',
      unit: 'µm',
      help:
        'How far the gear lags behind the pinion under load, along the transverse line of action, less its mean ' +
        'over the mesh cycle; one curve for each load case.',
      good: 'Flat is good: the distance from lowest to highest, peak to peak, excites vibration.',
      xLabel: 'mesh cycle',
      cycle: true,
      controls: [choose],
    });
    this.orders = new Chart({
      title: 'Orders of the loaded TE',
      name: 'Mesh orders of the loaded transmission error',
      unit: 'µm',
      help:
        'Amplitude of each multiple of the mesh frequency, of the pair; pale behind each bar: what it is ' +
        'compared with.',
      good: 'Small is good, the first orders most of all.',
      xLabel: 'mesh order',
      bars: true,
    });
    this.elements = [this.chart.element, this.orders.element];
    this.choose = choose;
  }

  /** @param {import('./context.js').Context} context */
  set({ result, references }) {
    const cases = result.load_cases;
    this.choose.hidden = endsOf(result).length === 1;
    const which = endsOf(result).length === 1 ? 'left' : this.#which;
    const names = caseNames(cases);
    /** @type {import('./chart.js').Curve[]} */
    const curves = [];
    /** @type {import('./chart.js').Curve[]} */
    const bars = [];
    for (const reference of references) {
      cases.forEach((loadCase, k) => {
        const other = sameCase(reference.result, loadCase, k);
        if (!other?.lte) return;
        const label = `${names[k]}, ${reference.label}`;
        curves.push({
          label,
          x: other.position,
          y: lessMean(other.lte[`${which}_um`]),
          colour: caseColour(k),
          line: reference.line,
        });
        bars.push({
          label,
          y: (other.lte.orders_um ?? []).slice(1, ORDERS + 1),
          colour: caseColour(k),
          line: reference.line,
        });
      });
    }
    cases.forEach((loadCase, k) => {
      if (!loadCase.lte) return;
      curves.push({
        label: names[k],
        x: loadCase.position,
        y: lessMean(loadCase.lte[`${which}_um`]),
        colour: caseColour(k),
      });
      bars.push({
        label: names[k],
        y: (loadCase.lte.orders_um ?? []).slice(1, ORDERS + 1),
        colour: caseColour(k),
      });
    });
    this.chart.frame.about = `${which === 'pair' ? 'the pair' : `${which} end`}, all load cases`;
    this.orders.frame.about = 'all load cases';
    this.chart.set({ x: cases[0].position, curves });
    this.orders.set({ x: counting(ORDERS, 1), curves: bars });
  }
}
