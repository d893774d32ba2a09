// SPDX-License-Identifier: GPL-3.0-or-later
// Fields built from the field tables: label, unit, range, help, live check; comma or point.
import { fill, h, newId } from './base/dom.js';
import { choiceText, labelOf, parseNumber, plain, unitText } from './base/format.js';
import { valueAt } from './base/pointer.js';
import { fallbackOf, fieldAt, isNumeric, numberFault } from './base/schema.js';

const PAUSE = 450; // ms after the last key before a typed number counts

/** @typedef {import('./base/schema.js').Field} Field */
/** @typedef {{ element: HTMLElement, refresh: () => void, pointer: string }} Control */
/** @typedef {{ low: number, high: number, step: number }} Range */

export class Form {
  /** @type {Control[]} */ #controls = [];
  /** @type {Map<string, { element: HTMLElement, input: HTMLElement }>} */ #faultPlaces = new Map();
  /** What null stands for. @type {any} */ resolved = null;

  /** @param {import('./base/store.js').DesignStore} store @param {Field[]} fields of the design */
  constructor(store, fields) {
    this.store = store;
    this.fields = fields;
    this.help = h(
      'p.help-line',
      { 'aria-live': 'off' },
      'Point at a field to read what it means and which values it takes.',
    );
    store.addEventListener('change', () => this.refresh());
  }

  refresh() {
    for (const control of this.#controls) if (control.element.isConnected) control.refresh();
  }

  /**
   * Faults of the service at their fields; what has no field is returned.
   * @param {import('./base/api.js').Fault[]} faults
   */
  showFaults(faults) {
    const texts = new Map([
      ...faults.map(fault => /** @type {[string, string]} */ ([fault.pointer, fault.detail])),
      ...this.store.faults,
    ]);
    for (const [pointer, { element, input }] of this.#faultPlaces) {
      if (!element.isConnected) continue;
      const text = texts.get(pointer) ?? '';
      texts.delete(pointer);
      if (element.textContent !== text) {
        element.textContent = text;
        if (text) unfold(element);
      }
      input.setAttribute('aria-invalid', String(text !== ''));
    }
    return [...texts].map(([pointer, detail]) => ({ pointer, detail }));
  }

  /** @param {HTMLElement} row @param {Field} field @param {string} label */
  #explain(row, field, label) {
    const unit = unitText(field.unit);
    const range =
      isNumeric(field) && typeof field.low === 'number' && typeof field.high === 'number'
        ? `${plain(field.low)} … ${plain(field.high)}${unit ? ` ${unit}` : ''}`
        : '';
    const empty = field.nullable && field.derived ? `empty: ${field.derived}` : '';
    const show = () =>
      fill(this.help, h('b', null, label), ` ${[field.help, range, empty].filter(Boolean).join(' · ')}`);
    row.addEventListener('focusin', show);
    row.addEventListener('pointerenter', show);
  }

  /** @param {string} pointer @param {Field} field @param {HTMLElement} input */
  #describe(pointer, field, input) {
    const fault = h('span.fault', { id: newId('fault'), role: 'alert' });
    input.setAttribute('aria-describedby', fault.id);
    if (field.help) input.title = field.help;
    this.#faultPlaces.set(pointer, { element: fault, input });
    return fault;
  }

  /** @param {Control} control */
  #add(control) {
    this.#controls.push(control);
    control.refresh();
    return control.element;
  }

  /**
   * The text field of a number; other parts of a row may follow it.
   * @param {string} pointer
   * @param {Field} field
   * @param {string} id
   * @param {string} [label]
   */
  numberInput(pointer, field, id, label) {
    const input = h('input.number', {
      id,
      type: 'text',
      inputmode: 'decimal',
      autocomplete: 'off',
      spellcheck: 'false',
      'aria-label': label,
    });
    let timer = 0;
    /** @param {boolean} final */
    const take = final => {
      clearTimeout(timer);
      const text = input.value.trim();
      if (text === '' && (field.nullable || !field.required)) {
        this.store.setFault(pointer, '');
        this.store.set(pointer, field.nullable ? null : fallbackOf(field));
        return;
      }
      const value = parseNumber(text);
      const fault = value === undefined ? 'Not a number.' : numberFault(field, value);
      if (this.store.faults.get(pointer) !== (fault || undefined)) this.store.setFault(pointer, fault);
      if (value === undefined || fault) return;
      if (final) this.store.set(pointer, value);
      else timer = window.setTimeout(() => this.store.set(pointer, value), PAUSE);
    };
    input.addEventListener('input', () => take(false));
    input.addEventListener('change', () => take(true));
    input.addEventListener('keydown', event => {
      const value = parseNumber(input.value);
      if ((event.key !== 'ArrowUp' && event.key !== 'ArrowDown') || value === undefined) return;
      event.preventDefault();
      const step = field.kind === 'integer' || field.kind === 'seed' ? 1 : stepOf(value) * (event.shiftKey ? 10 : 1);
      const next = Number((value + (event.key === 'ArrowUp' ? step : -step)).toPrecision(10));
      if (numberFault(field, next)) return;
      input.value = plain(next);
      take(true);
    });
    const refresh = () => {
      const value = this.store.get(pointer);
      const derived = valueAt(this.resolved, pointer);
      input.placeholder = field.nullable
        ? typeof derived === 'number'
          ? plain(Number(derived.toPrecision(6)))
          : field.derived === 'off'
            ? 'off'
            : 'auto'
        : '';
      // What is typed stays as it is typed.
      if (document.activeElement === input && parseNumber(input.value) === value) return;
      if (this.store.faults.has(pointer)) return;
      const text = value === undefined ? plain(fallbackOf(field)) : plain(value);
      if (input.value !== text) input.value = text;
    };
    return { input, refresh };
  }

  /** One labelled field. @param {string} pointer @param {{ label?: string, compact?: boolean }} [options] */
  field(pointer, { label, compact = false } = {}) {
    const field = /** @type {Field} */ (fieldAt(this.fields, pointer));
    const name = label ?? labelOf(field.key);
    const id = newId('field');
    const unit = unitText(field.unit);
    const row = h(compact ? '.field.compact' : '.field');
    this.#explain(row, field, name);
    if (field.kind === 'flag') return this.#flag(row, pointer, field, name, id);
    if (field.choices) return this.#choice(row, pointer, field, name, id);
    if (field.kind === 'numbers') return this.#numbers(row, pointer, field, name);
    if (field.kind === 'text') return this.#text(row, pointer, field, name, id);
    const { input, refresh } = this.numberInput(pointer, field, id);
    row.append(
      h('label', { for: id }, name),
      h('span.entry', null, input, h('span.unit', null, unit)),
      this.#describe(pointer, field, input),
    );
    return this.#add({ element: row, refresh, pointer });
  }

  /** @param {HTMLElement} row @param {string} pointer @param {Field} field @param {string} name @param {string} id */
  #flag(row, pointer, field, name, id) {
    const input = h('input', { id, type: 'checkbox', onchange: () => this.store.set(pointer, input.checked) });
    row.classList.add('flag');
    row.append(input, h('label', { for: id }, name), this.#describe(pointer, field, input));
    return this.#add({
      element: row,
      pointer,
      refresh: () => {
        input.checked = Boolean(this.store.get(pointer) ?? fallbackOf(field));
      },
    });
  }

  /** @param {HTMLElement} row @param {string} pointer @param {Field} field @param {string} name @param {string} id */
  #choice(row, pointer, field, name, id) {
    const input = h(
      'select',
      { id, onchange: () => this.store.set(pointer, input.value) },
      (field.choices ?? []).map(choice => h('option', { value: choice }, choiceText(choice))),
    );
    row.append(h('label', { for: id }, name), h('span.entry', null, input), this.#describe(pointer, field, input));
    return this.#add({
      element: row,
      pointer,
      refresh: () => {
        input.value = this.store.get(pointer) ?? fallbackOf(field);
      },
    });
  }

  /** @param {HTMLElement} row @param {string} pointer @param {Field} field @param {string} name @param {string} id */
  #text(row, pointer, field, name, id) {
    const input = h('input.text', {
      id,
      type: 'text',
      maxlength: (field.count ?? 200) - 1,
      onchange: () => this.store.set(pointer, input.value),
    });
    row.append(h('label', { for: id }, name), h('span.entry', null, input), this.#describe(pointer, field, input));
    return this.#add({
      element: row,
      pointer,
      refresh: () => {
        if (document.activeElement !== input) input.value = this.store.get(pointer) ?? '';
      },
    });
  }

  /**
   * A few numbers in a row: bounds, weights.
   * @param {HTMLElement} row
   * @param {string} pointer
   * @param {Field} field
   * @param {string} name
   */
  #numbers(row, pointer, field, name) {
    const count = field.count ?? 2;
    const unit = unitText(field.unit);
    const inputs = Array.from({ length: count }, (_, i) =>
      h('input.number', {
        type: 'text',
        inputmode: 'decimal',
        'aria-label': `${name} ${count === 2 ? ['from', 'to'][i] : i + 1}`,
        onchange: () => take(),
      }),
    );
    const take = () => {
      const values = inputs.map(input => parseNumber(input.value));
      if (field.nullable && inputs.every(input => input.value.trim() === '')) {
        this.store.setFault(pointer, '');
        return this.store.set(pointer, null);
      }
      const fault =
        values
          .map(value => (value === undefined ? 'Not a number.' : numberFault({ ...field, kind: 'number' }, value)))
          .find(Boolean) ??
        (count === 2 && /** @type {number} */ (values[0]) >= /** @type {number} */ (values[1])
          ? 'From must be below to.'
          : '');
      this.store.setFault(pointer, fault);
      if (!fault) this.store.set(pointer, values);
    };
    row.classList.add('several');
    row.append(
      h('span.label', null, name),
      h('span.entry', null, inputs, h('span.unit', null, unit)),
      this.#describe(pointer, field, inputs[0]),
    );
    return this.#add({
      element: row,
      pointer,
      refresh: () => {
        if (this.store.faults.has(pointer)) return;
        const values = this.store.get(pointer) ?? fallbackOf(field);
        const derived = valueAt(this.resolved, pointer);
        inputs.forEach((input, i) => {
          input.placeholder = Array.isArray(derived) ? plain(Number(derived[i].toPrecision(4))) : 'auto';
          if (document.activeElement !== input) input.value = Array.isArray(values) ? plain(values[i]) : '';
        });
      },
    });
  }

  /**
   * A number with a slider that is felt at once.
   * @param {() => string} pointerOf
   * @param {Field} field
   * @param {() => Range} rangeOf
   * @param {string} [label]
   */
  slider(pointerOf, field, rangeOf, label) {
    const name = label ?? labelOf(field.key);
    const id = newId('field');
    const row = h('.field.slider');
    this.#explain(row, field, name);
    const { input, refresh } = this.numberInput(pointerOf(), field, id);
    const slider = h('input', {
      type: 'range',
      'aria-label': name,
      oninput: () => this.store.set(pointerOf(), Number(slider.value), { live: true }),
      onchange: () => this.store.settle(),
    });
    row.append(
      h('label', { for: id }, name),
      h('span.entry', null, input, h('span.unit', null, unitText(field.unit))),
      slider,
      this.#describe(pointerOf(), field, input),
    );
    return this.#add({
      element: row,
      pointer: pointerOf(),
      refresh: () => {
        refresh();
        const { low, high, step } = rangeOf();
        const value = this.store.get(pointerOf()) ?? fallbackOf(field) ?? 0;
        const [min, max] = [Math.min(low, value), Math.max(high, value)];
        if (Number(slider.min) !== min) slider.min = String(min);
        if (Number(slider.max) !== max) slider.max = String(max);
        if (Number(slider.step) !== step) slider.step = String(step);
        if (Number(slider.value) !== value) slider.value = String(value);
        slider.style.setProperty('--part', `${(100 * (value - min)) / (max - min || 1)}%`);
      },
    });
  }

  /**
   * Every field of a group; nested objects become groups of their own.
   * @param {string} pointer
   * @param {{ skip?: string[], only?: string[] }} [options]
   * @returns {HTMLElement[]}
   */
  fieldsOf(pointer, { skip = [], only } = {}) {
    const group = pointer === '' ? this.fields : (fieldAt(this.fields, pointer)?.fields ?? []);
    return group
      .filter(
        field =>
          !skip.includes(field.key) &&
          (!only || only.includes(field.key)) &&
          field.kind !== 'list' &&
          field.kind !== 'series',
      )
      .map(field => {
        if (field.kind === 'object')
          return h('fieldset', null, h('legend', null, labelOf(field.key)), this.fieldsOf(`${pointer}/${field.key}`));
        return this.field(`${pointer}/${field.key}`);
      });
  }
}

/** Opens the groups round an element. @param {HTMLElement} element */
function unfold(element) {
  for (let group = element.closest('details'); group; group = group.parentElement?.closest('details') ?? null)
    group.open = true;
}

/** A step that changes the second digit. @param {number} value */
function stepOf(value) {
  if (value === 0) return 0.1;
  return 10 ** (Math.floor(Math.log10(Math.abs(value))) - 1);
}

/**
 * A group that opens and closes, and remembers it.
 * @param {string} key
 * @param {string} title
 * @param {boolean} open
 * @param {(HTMLElement | null)[]} children
 * @param {HTMLElement | null} [aside]
 */
export function group(key, title, open, children, aside = null) {
  const remembered = sessionStorage.getItem(`easeoff-group-${key}`);
  const element = h(
    'details.group',
    { open: remembered === null ? open : remembered === 'open' },
    h('summary', null, h('h2', null, title), aside),
    h('.group-body', null, children),
  );
  element.addEventListener('toggle', () =>
    sessionStorage.setItem(
      `easeoff-group-${key}`,
      /** @type {HTMLDetailsElement} */ (element).open ? 'open' : 'closed',
    ),
  );
  return element;
}
