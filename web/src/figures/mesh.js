// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh stiffness, load sharing between the tooth pairs, and the root stress of a tooth on its way through the mesh.
import { switcher } from '../base/switcher.js';
import { Chart } from './chart.js';
import { END_COLOUR, caseLong, endsOf, sameCase } from './context.js';

export class Stiffness {
  #kind = 'tangent';

  /** @param {() => void} again */
  constructor(again) {
    this.chart = new Chart({
      title: 'Mesh stiffness',
      unit: 'N/µm',
      help:
        'Force that turns the teeth by one micrometre, normal to the flank, of each end: tangent for a small ' +
        'change of load, secant from zero load.',
      good: 'High and even is good.',
      xLabel: 'mesh cycle',
      cycle: true,
      controls: [
        switcher(
          'Stiffness',
          [
            ['tangent', 'tangent'],
            ['secant', 'secant'],
          ],
          this.#kind,
          value => {
            this.#kind = value;
            again();
          },
        ),
      ],
    });
    this.elements = [this.chart.element];
  }

  /** @param {import('./context.js').Context} context */
  set({ result, references, loadCase: k }) {
    const loadCase = result.load_cases[k];
    const prefix = this.#kind === 'tangent' ? 'tangent_' : '';
    const curves = [];
    for (const reference of references) {
      const other = sameCase(reference.result, loadCase, k);
      for (const end of endsOf(result)) {
        const y = other?.mesh_stiffness?.[`${prefix}${end}_N_per_um`];
        if (y)
          curves.push({
            label: `${end}, ${reference.label}`,
            x: other.position,
            y,
            colour: END_COLOUR[end],
            line: reference.line,
          });
      }
    }
    for (const end of endsOf(result)) {
      const y = loadCase.mesh_stiffness?.[`${prefix}${end}_N_per_um`];
      if (y) curves.push({ label: `${end} end`, y, colour: END_COLOUR[end] });
    }
    this.chart.frame.setCase(caseLong(loadCase));
    this.chart.set({ x: loadCase.position, curves });
  }
}

export class Sharing {
  #end = /** @type {'left' | 'right'} */ ('left');

  /** @param {() => void} again */
  constructor(again) {
    this.choose = switcher(
      'End',
      [
        ['left', 'left'],
        ['right', 'right'],
      ],
      this.#end,
      value => {
        this.#end = /** @type {'left' | 'right'} */ (value);
        again();
      },
    );
    this.chart = new Chart({
      title: 'Load sharing',
      unit: '%',
      help: 'Part of the end’s load that one tooth pair carries on its way through the mesh.',
      good: 'Rising and falling gently is good; a step is an impact.',
      xLabel: 'mesh cycles',
      controls: [this.choose],
    });
    this.elements = [this.chart.element];
  }

  /** @param {import('./context.js').Context} context */
  set({ result, references, loadCase: k }) {
    const loadCase = result.load_cases[k];
    this.choose.hidden = endsOf(result).length === 1;
    const end = this.choose.hidden ? 'left' : this.#end;
    const own = passage(loadCase, end);
    if (!own) return;
    const curves = [];
    for (const reference of references) {
      const other = passage(sameCase(reference.result, loadCase, k), end);
      if (other)
        curves.push({ label: reference.label, x: other.x, y: other.y, colour: END_COLOUR[end], line: reference.line });
    }
    curves.push({ label: `one pair, ${end} end`, x: own.x, y: own.y, colour: END_COLOUR[end] });
    this.chart.frame.setCase(caseLong(loadCase));
    this.chart.set({ x: own.x, curves });
  }
}

/**
 * The share of one pair from where it enters to where it leaves.
 * @param {Page.LoadCase | undefined} loadCase undefined: a reference does not have it
 * @param {'left' | 'right'} end
 */
function passage(loadCase, end) {
  const sharing = loadCase?.contact?.load_share;
  const rows = sharing?.[end];
  const position = loadCase?.position;
  if (!sharing || !rows || !position) return null;
  /** @type {number[]} */ const x = [];
  /** @type {number[]} */ const y = [];
  sharing.tooth_pair.forEach((pair, row) => {
    position.forEach((at, i) => {
      x.push(pair + at);
      y.push(100 * (rows[row][i] ?? NaN));
    });
  });
  return { x, y };
}

export class RootStress {
  #member = /** @type {'pinion' | 'gear'} */ ('pinion');

  /** @param {() => void} again */
  constructor(again) {
    this.chart = new Chart({
      title: 'Root stress',
      unit: 'MPa',
      name: 'Root stress of a tooth on its way through the mesh',
      help:
        'Largest principal stress over the face in the more stressed fillet, while one tooth passes through the ' +
        'mesh.',
      good: 'Low is good; the largest value is the one at the top of the page.',
      xLabel: 'mesh cycles',
      controls: [
        switcher(
          'Member',
          [
            ['pinion', 'pinion'],
            ['gear', 'gear'],
          ],
          this.#member,
          value => {
            this.#member = /** @type {'pinion' | 'gear'} */ (value);
            again();
          },
        ),
      ],
    });
    this.elements = [this.chart.element];
  }

  /** @param {import('./context.js').Context} context */
  set({ result, references, loadCase: k }) {
    const loadCase = result.load_cases[k];
    const own = loadCase.root_stress?.[this.#member];
    this.chart.element.classList.toggle('waiting', Boolean(own && !own.position));
    if (!own?.position) return;
    /** @type {import('./chart.js').Curve[]} */
    const curves = [];
    for (const reference of references) {
      const other = sameCase(reference.result, loadCase, k)?.root_stress?.[this.#member];
      for (const end of endsOf(result)) {
        const y = other?.[end]?.history_MPa;
        if (y)
          curves.push({
            label: `${end}, ${reference.label}`,
            x: other?.position ?? undefined,
            y,
            colour: END_COLOUR[end],
            line: reference.line,
          });
      }
    }
    for (const end of endsOf(result)) {
      const y = own[end]?.history_MPa;
      if (y) curves.push({ label: `${end} end`, y, colour: END_COLOUR[end] });
    }
    this.chart.frame.setCase(caseLong(loadCase));
    this.chart.set({ x: own.position, curves });
  }
}
