// SPDX-License-Identifier: GPL-3.0-or-later
// Fields made from the field tables: label, unit, range, help, live check. A set comes and goes as a whole.
import { h, newId } from '../base/dom.js';
import { choiceText, labelOf, plain, sig } from '../base/format.js';
import { valueAt } from '../base/pointer.js';
import { readQuantity } from '../base/quantity.js';
import { fallbackOf, fieldAt, isNumeric, numberFault, unitOf } from '../base/schema.js';
import { shownValue, typedText } from '../base/units.js';
import { Entry } from './entry.js';

const REST = 700; // ms between two keys on a slider that make two steps to undo

/** @typedef {import('../base/schema.js').Field} Field */
/** @typedef {{ low: number, high: number, step: number }} Range */
/** @typedef {{ label?: string, compact?: boolean, parts?: string[] }} Look parts: names of the numbers of a row */

/** A step that changes the second digit. @param {number} value */
function stepOf(value) {
  if (value === 0) return 0.1;
  return 10 ** (Math.floor(Math.log10(Math.abs(value))) - 1);
}

/** @param {string} text @param {Field} field @returns {{ value: number | null } | { fault: string }} */
function readNumber(text, field) {
  if (text.trim() === '') {
    if (field.nullable) return { value: null };
    if (field.required) return { fault: 'A value is needed here.' };
    return { value: /** @type {number | null} */ (fallbackOf(field)) };
  }
  const { value, fault } = readQuantity(typedText(text, field.unit), field.unit);
  if (fault !== undefined) return { fault };
  const outside = numberFault(field, value);
  return outside ? { fault: outside } : { value };
}

/** A value that follows, in the width of a field. @param {number} value */
function derivedText(value) {
  const text = plain(Number(value.toPrecision(6)));
  return text.length > 8 ? sig(value, 4) : text;
}

export class FieldSet {
  /** @type {import('./form.js').Control[]} */ #controls = [];

  /** @param {import('./form.js').Form} form */
  constructor(form) {
    this.form = form;
    this.store = form.store;
  }

  /** The fields leave the page. */
  release() {
    this.form.release(this.#controls);
    this.#controls = [];
  }

  /** What is typed in the fields of a place and is no value yet. @returns {Map<string, string[]>} */
  typed() {
    const texts = new Map();
    for (const { pointer, entry } of this.#controls)
      if (entry?.typed && this.store.faults.has(pointer))
        texts.set(
          pointer,
          entry.host.inputs.map(input => input.value),
        );
    return texts;
  }

  /** @param {string} pointer @param {string[]} texts */
  retype(pointer, texts) {
    this.#controls.find(control => control.pointer === pointer)?.entry?.retype(texts);
  }

  /** @param {import('./form.js').Control} control */
  #add(control) {
    this.#controls.push(control);
    control.element.dataset.pointer = control.pointer; // whose row it is, for whoever looks at the page from outside
    this.form.add(control);
    return control.element;
  }

  /** @param {Field} field @param {HTMLElement} input */
  #faultOf(field, input) {
    const fault = h('span.fault', { id: newId('fault'), role: 'alert' });
    input.setAttribute('aria-describedby', fault.id);
    if (field.help) input.title = field.help;
    return fault;
  }

  /**
   * The text field of a number.
   * @param {string} pointer
   * @param {Field} field
   * @param {string} id
   */
  #number(pointer, field, id) {
    const input = h('input.number', {
      id,
      type: 'text',
      inputmode: 'decimal',
      autocomplete: 'off',
      spellcheck: 'false',
    });
    const entry = new Entry({
      store: this.store,
      pointer,
      inputs: [input],
      read: () => readNumber(input.value, field),
      write: value => [plain(shownValue(value === undefined ? fallbackOf(field) : value, field.unit))],
    });
    input.addEventListener('keydown', event => {
      const { value } = readQuantity(typedText(input.value, field.unit), field.unit);
      if ((event.key !== 'ArrowUp' && event.key !== 'ArrowDown') || value === undefined) return;
      event.preventDefault();
      const whole = field.kind === 'integer' || field.kind === 'seed';
      const step = whole ? 1 : stepOf(value) * (event.shiftKey ? 10 : 1);
      const next = Number((value + (event.key === 'ArrowUp' ? step : -step)).toPrecision(10));
      if (numberFault(field, next)) return;
      input.value = plain(shownValue(next, field.unit));
      entry.take(true);
    });
    const refresh = () => {
      const derived = valueAt(this.form.resolved, pointer);
      const open = field.derived === 'off' ? 'off' : 'auto';
      const known = typeof derived === 'number' ? derivedText(shownValue(derived, field.unit)) : open;
      input.placeholder = field.nullable ? known : '';
      entry.refresh();
    };
    return { input, entry, refresh };
  }

  /** One labelled field. @param {string} pointer @param {Look} [look] */
  field(pointer, { label, compact = false, parts } = {}) {
    const field = /** @type {Field} */ (fieldAt(this.form.fields, pointer));
    const name = label ?? labelOf(field.key);
    const id = newId('field');
    const row = h(compact ? '.field.compact' : '.field');
    this.form.explain(row, field, name);
    if (field.kind === 'flag') return this.#flag(row, pointer, field, name, id);
    if (field.choices) return this.#choice(row, pointer, field, name, id);
    if (field.kind === 'numbers') return this.#numbers(row, pointer, field, name, parts);
    if (field.kind === 'text') return this.#text(row, pointer, field, name, id);
    const { input, entry, refresh } = this.#number(pointer, field, id);
    const fault = this.#faultOf(field, input);
    const unit = h('span.unit');
    row.append(h('label', { for: id }, name), h('span.entry', null, input, unit), fault);
    const both = () => {
      unit.textContent = unitOf(field);
      refresh();
    };
    return this.#add({ pointer, name, element: row, input, fault, entry, refresh: both });
  }

  /** @param {HTMLElement} row @param {string} pointer @param {Field} field @param {string} name @param {string} id */
  #flag(row, pointer, field, name, id) {
    const input = h('input', { id, type: 'checkbox', onchange: () => this.store.set(pointer, input.checked) });
    const fault = this.#faultOf(field, input);
    row.classList.add('flag');
    row.append(input, h('label', { for: id }, name), fault);
    const refresh = () => {
      input.checked = Boolean(this.store.get(pointer) ?? fallbackOf(field));
    };
    return this.#add({ pointer, name, element: row, input, fault, refresh });
  }

  /** @param {HTMLElement} row @param {string} pointer @param {Field} field @param {string} name @param {string} id */
  #choice(row, pointer, field, name, id) {
    const input = h(
      'select',
      { id, onchange: () => this.store.set(pointer, input.value) },
      (field.choices ?? []).map(choice => h('option', { value: choice }, choiceText(choice))),
    );
    const fault = this.#faultOf(field, input);
    row.append(h('label', { for: id }, name), h('span.entry', null, input), fault);
    const refresh = () => {
      input.value = this.store.get(pointer) ?? fallbackOf(field);
    };
    return this.#add({ pointer, name, element: row, input, fault, refresh });
  }

  /** @param {HTMLElement} row @param {string} pointer @param {Field} field @param {string} name @param {string} id */
  #text(row, pointer, field, name, id) {
    const input = h('input.text', { id, type: 'text', maxlength: (field.count ?? 200) - 1 });
    const entry = new Entry({
      store: this.store,
      pointer,
      inputs: [input],
      read: () => ({ value: input.value }),
      write: value => [value ?? ''],
    });
    const fault = this.#faultOf(field, input);
    row.append(h('label', { for: id }, name), h('span.entry', null, input), fault);
    return this.#add({ pointer, name, element: row, input, fault, entry, refresh: () => entry.refresh() });
  }

  /**
   * A few numbers in a row: bounds, weights.
   * @param {HTMLElement} row
   * @param {string} pointer
   * @param {Field} field
   * @param {string} name
   * @param {string[]} [parts]
   */
  #numbers(row, pointer, field, name, parts) {
    const count = field.count ?? 2;
    const names = parts ?? (count === 2 ? ['from', 'to'] : Array.from({ length: count }, (_, i) => String(i + 1)));
    const inputs = names.map(part =>
      h('input.number', { type: 'text', inputmode: 'decimal', autocomplete: 'off', 'aria-label': `${name}, ${part}` }),
    );
    /** @type {Field} */
    const one = { ...field, kind: 'number', nullable: false, required: true };
    const read = () => {
      if (field.nullable && inputs.every(input => input.value.trim() === '')) return { value: null };
      const found = inputs.map(input => readNumber(input.value, one));
      const fault = found.find(each => 'fault' in each);
      if (fault) return fault;
      const values = found.map(each => ('value' in each ? each.value : null));
      return count === 2 && Number(values[0]) >= Number(values[1])
        ? { fault: 'The first value must be below the second.' }
        : { value: values };
    };
    const entry = new Entry({
      store: this.store,
      pointer,
      inputs,
      read,
      write: value => {
        const values = value ?? fallbackOf(field);
        return inputs.map((_, i) => (Array.isArray(values) ? plain(shownValue(values[i], field.unit)) : ''));
      },
    });
    const fault = this.#faultOf(field, inputs[0]);
    const unit = h('span.unit');
    row.classList.add('several');
    row.append(
      h('span.label', null, name),
      h(
        'span.entry',
        null,
        parts ? names.map((part, i) => h('label.part', null, inputs[i], h('small', null, part))) : inputs,
        unit,
      ),
      fault,
    );
    const refresh = () => {
      const derived = valueAt(this.form.resolved, pointer);
      inputs.forEach((input, i) => {
        const shown = Array.isArray(derived) ? shownValue(derived[i], field.unit) : undefined;
        input.placeholder = shown === undefined ? 'auto' : plain(Number(shown.toPrecision(4)));
      });
      unit.textContent = unitOf(field);
      entry.refresh();
    };
    return this.#add({ pointer, name, element: row, input: inputs[0], fault, entry, refresh });
  }

  /**
   * A number with a slider that is felt at once.
   * @param {string} pointer
   * @param {() => Range} rangeOf
   * @param {string} [label]
   */
  slider(pointer, rangeOf, label) {
    const field = /** @type {Field} */ (fieldAt(this.form.fields, pointer));
    const name = label ?? labelOf(field.key);
    const id = newId('field');
    const row = h('.field.slider');
    this.form.explain(row, field, name);
    const { input, entry, refresh } = this.#number(pointer, field, id);
    const slider = this.#range(pointer, name);
    const fault = this.#faultOf(field, input);
    const unit = h('span.unit');
    row.append(h('label', { for: id }, name), h('span.entry', null, input, unit), slider, fault);
    const both = () => {
      unit.textContent = unitOf(field);
      refresh();
      const { low, high, step } = rangeOf();
      const value = this.store.get(pointer) ?? fallbackOf(field) ?? 0;
      const [min, max] = [Math.min(low, value), Math.max(high, value)];
      if (Number(slider.min) !== min) slider.min = String(min);
      if (Number(slider.max) !== max) slider.max = String(max);
      if (Number(slider.step) !== step) slider.step = String(step);
      if (Number(slider.value) !== value) slider.value = String(value);
      slider.style.setProperty('--part', `${(100 * (value - min)) / (max - min || 1)}%`);
    };
    return this.#add({ pointer, name, element: row, input, fault, entry, refresh: both });
  }

  /**
   * The slider itself; a run of keys is one step to undo, as a drag is.
   * @param {string} pointer
   * @param {string} name
   */
  #range(pointer, name) {
    let timer = 0;
    let keys = false;
    const slider = h('input', {
      type: 'range',
      'aria-label': name,
      onkeydown: () => {
        keys = true;
      },
      onpointerdown: () => {
        keys = false;
      },
      oninput: () => this.store.set(pointer, Number(slider.value), { live: true }),
      onchange: () => {
        clearTimeout(timer);
        if (keys) timer = window.setTimeout(() => this.store.settle(), REST);
        else this.store.settle();
      },
    });
    return slider;
  }

  /**
   * Every field of a group; nested objects become groups of their own.
   * @param {string} pointer
   * @param {{ skip?: string[], only?: string[], looks?: Record<string, Look> }} [options]
   * @returns {HTMLElement[]}
   */
  fieldsOf(pointer, { skip = [], only, looks = {} } = {}) {
    const group = pointer === '' ? this.form.fields : (fieldAt(this.form.fields, pointer)?.fields ?? []);
    return group
      .filter(
        field =>
          !field.entry &&
          !skip.includes(field.key) &&
          (!only || only.includes(field.key)) &&
          (isNumeric(field) || !['list', 'series', 'document'].includes(field.kind)),
      )
      .map(field => {
        if (field.kind === 'object')
          return h('fieldset', null, h('legend', null, labelOf(field.key)), this.fieldsOf(`${pointer}/${field.key}`));
        return this.field(`${pointer}/${field.key}`, looks[field.key]);
      });
  }
}
