// SPDX-License-Identifier: GPL-3.0-or-later
// The few large numbers, each with its change against what the design is compared with.
import { fill, h } from './base/dom.js';
import { change, changeText, sig } from './base/format.js';
import { caseText, sameCase } from './figures/context.js';

/** @typedef {{ key: string, label: string, unit: string, help: string, scale?: number }} Number_ */

/** @type {Number_[]} */
export const NUMBERS = [
  { key: 'peak_to_peak_um', label: 'PPLTE', unit: 'µm', help: 'peak-to-peak loaded transmission error of the pair' },
  { key: 'impact_N', label: 'Impact', unit: 'kN', help: 'entering impact force, the larger of both ends', scale: 1e-3 },
  { key: 'rms_m_per_s2', label: 'Vibration', unit: 'm/s²', help: 'RMS of the normal acceleration' },
  { key: 'root_stress_MPa', label: 'Root stress', unit: 'MPa', help: 'largest bending stress in the root' },
  { key: 'contact_pressure_MPa', label: 'Pressure', unit: 'MPa', help: 'largest contact pressure' },
];

/**
 * Numbers of one load case as the objectives list them; the root stress where they leave it out.
 * @param {any} result
 * @param {number} k
 */
export function numbersOf(result, k) {
  const loadCase = result?.load_cases?.[k];
  const row = { ...(result?.objectives?.load_cases?.[k] ?? {}) };
  if (typeof row.root_stress_MPa !== 'number') {
    const stresses = ['pinion', 'gear']
      .map(member => loadCase?.root_stress?.[member]?.max_MPa)
      .filter(value => typeof value === 'number');
    row.root_stress_MPa = stresses.length ? Math.max(...stresses) : null;
  }
  return row;
}

export class Headline {
  /** @param {import('./base/store.js').DesignStore} store */
  constructor(store) {
    this.store = store;
    this.cells = NUMBERS.map(({ label, unit, help }) => cell(label, unit, help));
    this.total = cell('J', '', 'weighted objective over the duty cycle; 1 is the unmodified pair');
    this.cases = h('.cases', { role: 'radiogroup', 'aria-label': 'Load case of the numbers and figures' });
    this.warnings = h('button.warn', {
      type: 'button',
      hidden: true,
      'aria-expanded': 'false',
      onclick: () => this.#toggle(),
    });
    this.list = h('ul.warning-list', { hidden: true });
    this.element = h(
      'section.headline',
      { 'aria-label': 'Results in short' },
      h('.case-box', null, this.cases, this.warnings),
      [...this.cells, this.total].map(each => each.element),
      this.list,
    );
    document.addEventListener('pointerdown', event => {
      if (!this.list.hidden && !this.element.contains(/** @type {Node} */ (event.target))) this.#toggle();
    });
    this.element.addEventListener('keydown', event => {
      if (event.key === 'Escape' && !this.list.hidden) this.#toggle();
    });
  }

  #shape = '';

  #toggle() {
    this.list.hidden = !this.list.hidden;
    this.warnings.setAttribute('aria-expanded', String(!this.list.hidden));
  }

  /** @param {import('./figures/context.js').Context} context */
  set({ result, references, loadCase: k }) {
    const reference = references[0]?.result;
    const at = reference ? reference.load_cases.indexOf(sameCase(reference, result.load_cases[k], k)) : -1;
    const own = numbersOf(result, k);
    const before = at >= 0 ? numbersOf(reference, at) : {};
    NUMBERS.forEach(({ key, scale = 1 }, i) =>
      show(this.cells[i], own[key] === null ? null : own[key] * scale, change(own[key], before[key])),
    );
    show(this.total, result.objectives?.J, change(result.objectives?.J, reference?.objectives?.J));
    this.#drawCases(result, k);
    const warnings = result.warnings ?? [];
    this.warnings.hidden = warnings.length === 0;
    this.warnings.textContent = warnings.length === 1 ? '⚠ 1 warning' : `⚠ ${warnings.length} warnings`;
    fill(
      this.list,
      warnings.map((/** @type {string} */ text) => h('li', null, text)),
    );
  }

  /** @param {any} result @param {number} chosen */
  #drawCases(result, chosen) {
    const shape = JSON.stringify(result.load_cases.map((/** @type {any} */ c) => [c.torque_Nm, c.speed_rpm]));
    if (shape !== this.#shape) {
      this.#shape = shape;
      fill(
        this.cases,
        result.load_cases.map((/** @type {any} */ c, /** @type {number} */ i) => {
          const mark = h('span.dot');
          mark.style.setProperty('--swatch', `var(--c${(i % 8) + 1})`);
          return h(
            'label.chip',
            { title: `${caseText(c)} at ${c.speed_rpm} rpm` },
            h('input', { type: 'radio', name: 'load-case', value: i, onchange: () => this.store.setLoadCase(i) }),
            h('span', null, mark, caseText(c)),
          );
        }),
      );
    }
    this.cases.querySelectorAll('input').forEach((input, i) => {
      input.checked = i === chosen;
    });
  }
}

/** @param {string} label @param {string} unit @param {string} help */
function cell(label, unit, help) {
  const value = h('span.value', null, '–');
  const delta = h('span.delta');
  const element = h(
    '.number-cell',
    { title: help },
    h('span.label', null, label),
    h('span.figure-value', null, value, unit ? h('span.unit', null, ` ${unit}`) : null),
    delta,
  );
  return { element, value, delta };
}

/**
 * @param {{ value: HTMLElement, delta: HTMLElement }} cell
 * @param {number | null | undefined} value
 * @param {number | undefined} percent
 */
function show(cell, value, percent) {
  cell.value.textContent = sig(value, 3);
  cell.delta.textContent =
    percent === undefined ? '' : `${percent < -0.05 ? '▼' : percent > 0.05 ? '▲' : ''} ${changeText(percent)}`;
  cell.delta.className = `delta${percent === undefined || Math.abs(percent) < 1 ? '' : percent < 0 ? ' better' : ' worse'}`;
}
