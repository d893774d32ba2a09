// SPDX-License-Identifier: GPL-3.0-or-later
// The few large numbers, each with its change against what the design is compared with.
import { NUMBERS, numbersBefore, numbersOf, shownNumber } from './numbers.js';
import { capacityText, groupedWarnings } from './verdict.js';
import { fill, h } from './base/dom.js';
import { change, changeText, sig } from './base/format.js';
import { shownUnit } from './base/units.js';
import { openPopover } from './base/popover.js';
import { caseLong, caseNames } from './figures/context.js';

/** @type {Omit<import('./numbers.js').Number_, 'key'>} */
const TOTAL = {
  name: 'Objective J of the duty cycle',
  label: 'Objective J',
  sub: 'all load cases',
  unit: '',
  help:
    'Transmission error, impact and vibration over the duty cycle, each divided by that of the unmodified pair ' +
    'and weighted; what a search makes small.',
  good: '1 is the unmodified pair; 0.4 is much better.',
};

export class Headline {
  /** @param {import('./base/store.js').DesignStore} store */
  constructor(store) {
    this.store = store;
    this.cells = NUMBERS.map(number => cell(number, () => this.about));
    this.total = cell(TOTAL, () => 'all load cases');
    /** Load case and what it is compared with. */
    this.about = '';
    this.cases = h('.cases', { role: 'radiogroup', 'aria-label': 'Load case of the numbers and figures' });
    this.warnings = h('button.warn', {
      type: 'button',
      hidden: true,
      'aria-expanded': 'false',
      onclick: () => this.#toggle(),
    });
    this.capacity = h('p.capacity');
    this.list = h('ul.warning-list', { hidden: true });
    this.element = h(
      'section.headline',
      { 'aria-label': 'Results in short' },
      h('.case-box', null, this.cases, this.capacity, this.warnings),
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
    const against = references[0]?.label ?? '';
    this.about = `${caseLong(result.load_cases[k])}${against ? `, against ${against}` : ''}`;
    const own = numbersOf(result, k);
    const before = numbersBefore(reference, result.load_cases[k], k);
    NUMBERS.forEach((number, i) => {
      const { key } = number;
      this.cells[i].unit.textContent = ` ${shownUnit(number.unit)}`;
      show(this.cells[i], shownNumber(own[key], number), change(own[key], before[key]), against);
    });
    show(this.total, result.objectives?.J, change(result.objectives?.J, reference?.objectives?.J), against);
    this.#drawCases(result, k);
    const warnings = result.warnings ?? [];
    this.warnings.hidden = warnings.length === 0;
    this.warnings.textContent = warnings.length === 1 ? '⚠ 1 warning' : `⚠ ${warnings.length} warnings`;
    fill(this.list, groupedWarnings(warnings));
  }

  /** The load capacity in short. @param {Page.Result} result with its rating */
  rate({ rating }) {
    const verdict = rating?.outcome === 'rated' ? rating.verdict : null;
    this.capacity.title = capacityText(rating);
    this.capacity.textContent = verdict
      ? `${verdict.passes ? '✓' : '✗'} S_H ${sig(verdict.S_H, 3)}, S_F ${sig(verdict.S_F, 3)}`
      : 'not rated';
    this.capacity.classList.toggle('worse', verdict?.passes === false);
  }

  /** @param {Page.Result} result @param {number} chosen */
  #drawCases(result, chosen) {
    const shape = JSON.stringify(result.load_cases.map(c => [c.torque_Nm, c.speed_rpm, c.name]));
    if (shape !== this.#shape) {
      this.#shape = shape;
      const names = caseNames(result.load_cases);
      fill(
        this.cases,
        result.load_cases.map((c, i) => {
          const mark = h('span.dot');
          mark.style.setProperty('--swatch', `var(--case${(i % 8) + 1})`);
          return h(
            'label.chip',
            { title: caseLong(c) },
            h('input', { type: 'radio', name: 'load-case', value: i, onchange: () => this.store.setLoadCase(i) }),
            h('span', null, mark, names[i]),
          );
        }),
      );
    }
    this.cases.querySelectorAll('input').forEach((input, i) => {
      input.checked = i === chosen;
    });
  }
}

/** @param {Omit<import('./numbers.js').Number_, 'key'>} number @param {() => string} about */
function cell({ name, label, sub, unit, help, good }, about) {
  const value = h('span.value', null, '–');
  const delta = h('span.delta');
  const unitText = h('span.unit', null, unit ? ` ${unit}` : '');
  const button = h(
    'button.explain',
    { type: 'button', 'aria-label': `What is this: ${name}`, 'aria-expanded': 'false' },
    h('span.label', null, label),
    h('span.sub', null, sub),
  );
  button.addEventListener('click', () =>
    openPopover(button, 'explanation', panel =>
      fill(
        panel,
        h('h4', null, unit ? `${name}, ${shownUnit(unit)}` : name),
        h('p', null, help),
        h('p', null, good),
        about() ? h('p', null, `Here: ${about()}.`) : null,
        h('p', null, h('a', { href: '#glossary' }, 'All words explained')),
      ),
    ),
  );
  const element = h(
    '.number-cell',
    null,
    button,
    h('span.figure-value', null, value, unitText),
    delta,
  );
  return { element, value, unit: unitText, delta };
}

/**
 * @param {{ value: HTMLElement, delta: HTMLElement }} cell
 * @param {number | null | undefined} value
 * @param {number | undefined} percent
 * @param {string} against what it is compared with
 */
function show(cell, value, percent, against) {
  cell.value.textContent = sig(value, 3);
  cell.delta.textContent =
    percent === undefined ? '' : `${percent < -0.05 ? '▼' : percent > 0.05 ? '▲' : ''} ${changeText(percent)}`;
  const clear = percent !== undefined && Math.abs(percent) >= 1;
  cell.delta.className = clear ? `delta ${percent < 0 ? 'better' : 'worse'}` : 'delta';
  cell.delta.title = percent === undefined ? '' : `against ${against}`;
}
