// SPDX-License-Identifier: GPL-3.0-or-later
// All fields of the design on the page: what stands in them, which faults they have, how one is found.
import { fill, h } from '../base/dom.js';
import { labelOf, plain } from '../base/format.js';
import { isNumeric, unitOf } from '../base/schema.js';
import { shownSentence, shownValue } from '../base/units.js';
import { FieldSet } from './fieldset.js';
import { unfold } from './group.js';

/** @typedef {import('../base/schema.js').Field} Field */
/** @typedef {import('./entry.js').Entry} Entry */
/**
 * @typedef {object} Control one field on the page
 * @property {string} pointer @property {string} name
 * @property {HTMLElement} element @property {HTMLElement} input @property {HTMLElement} fault
 * @property {() => void} refresh
 * @property {Entry} [entry] of what is typed
 */
/** @typedef {{ name: string, lead: () => void }} Place a field and the way to it */
/**
 * @typedef {{ pointer: string, detail: string, name: string, lead: (() => void) | null, after: Place[] }} Trouble
 *   after: what was changed, where that is not the field of the fault
 */

const MOST_CHANGES = 4; // fields, of the design that was possible, that a fault is said at: one edit, of both ends

/** Whether one lies in the other, or they are the same. @param {string} a @param {string} b */
const related = (a, b) => `${a}/`.startsWith(`${b}/`) || `${b}/`.startsWith(`${a}/`);

export class Form {
  /** @type {Set<Control>} */ #controls = new Set();
  /** What null stands for. @type {Page.Design | null} */ resolved = null;
  /**
   * Brings a field to the page that is not there now: another member, end or view.
   * @type {((pointer: string) => void)[]}
   */
  finders = [];

  /** @param {import('../base/store.js').DesignStore} store @param {Field[]} fields of the design */
  constructor(store, fields) {
    this.store = store;
    this.fields = fields;
    this.help = h(
      'p.help-line',
      { 'aria-live': 'off' },
      'Point at a field to read what it means and which values it takes.',
    );
    store.addEventListener('change', () => this.refresh());
    store.addEventListener('reset', () => this.#controls.forEach(control => control.entry?.forget()));
  }

  /** Fields that come and go together. */
  set() {
    return new FieldSet(this);
  }

  /** @param {Control} control */
  add(control) {
    this.#controls.add(control);
    control.refresh();
  }

  /** The fields leave the page, and what is typed in them with its faults. @param {Iterable<Control>} controls */
  release(controls) {
    for (const control of controls) {
      this.#controls.delete(control);
      control.entry?.forget();
    }
  }

  refresh() {
    for (const control of this.#controls) control.refresh();
  }

  /** What is typed becomes part of the design, before it is stored or searched from. */
  flush() {
    for (const control of this.#controls) control.entry?.flush();
  }

  /**
   * What is typed and not yet a value is given up: in this field, else where the last fault is.
   * @param {EventTarget | null} target
   */
  giveUp(target) {
    const { faults } = this.store;
    const open = [...this.#controls].filter(({ entry, pointer }) => entry && (entry.waiting || faults.has(pointer)));
    const last = [...faults.keys()].pop();
    const chosen =
      open.find(({ entry }) => entry?.host.inputs.some(input => input === target)) ??
      open.find(({ pointer }) => pointer === last);
    chosen?.entry?.forget();
    return Boolean(chosen);
  }

  /**
   * Faults of typed texts and of the service at their fields; and at what was changed last, where the service has them
   * at another field that the change does not go with.
   * @param {import('../base/api.js').Fault[]} faults of the service
   * @param {string[]} [changed] in which the design differs from the last one that was possible
   * @returns {Trouble[]} all of them, with the way to their field
   */
  showFaults(faults, changed = []) {
    const texts = new Map([
      ...faults.map(fault => /** @type {[string, string]} */ ([fault.pointer, fault.detail])),
      ...this.store.faults,
    ]);
    const after = changed.length > MOST_CHANGES ? [] : this.#elsewhere(texts, changed);
    const said = [...texts].map(([pointer, detail]) => ({ pointer, detail, name: this.#nameOf(pointer) }));
    const whole = said.map(({ name, detail }) => (name ? `${name}: ${detail}` : detail)).join(' ');
    for (const { pointer } of after) texts.set(pointer, whole);
    for (const { pointer, fault, input } of this.#controls) {
      const text = texts.get(pointer) ?? '';
      if (fault.textContent !== text) fault.textContent = text;
      input.setAttribute('aria-invalid', String(text !== ''));
    }
    return said.map(trouble => ({
      ...trouble,
      lead: trouble.pointer && this.finders.length ? () => this.lead(trouble.pointer) : null,
      after: after.map(({ name, pointer }) => ({ name, lead: () => this.lead(pointer) })),
    }));
  }

  /** @param {string} pointer */
  #nameOf(pointer) {
    return this.#find(pointer)?.name ?? labelOf(pointer.split('/').pop() ?? '');
  }

  /**
   * Fields that were changed while every fault is at others.
   * @param {Map<string, string>} texts @param {string[]} changed
   */
  #elsewhere(texts, changed) {
    const places = [...texts.keys()].map(pointer => pointer.replace('/right/', '/left/'));
    const fields = [...this.#controls].filter(({ pointer }) => changed.some(each => related(each, pointer)));
    const met = fields.some(({ pointer }) => places.includes(pointer.replace('/right/', '/left/')));
    return met || !texts.size ? [] : fields;
  }

  /** What the service remarks about a value, at its field. @param {{ key: string, text: string }[]} findings */
  showFindings(findings) {
    const texts = new Map(findings.map(({ key, text }) => [key, shownSentence(text)]));
    for (const { pointer, element } of this.#controls) {
      const text = texts.get(pointer) ?? '';
      let remark = element.querySelector('.remark');
      if (!remark && text) element.append((remark = h('span.remark')));
      if (remark && remark.textContent !== text) remark.textContent = text;
    }
  }

  /** The field of a value: its own, or the same one of the other end that stands for both. @param {string} pointer */
  #find(pointer) {
    const places = [pointer, pointer.replace('/right/', '/left/')];
    const found = [...this.#controls].filter(control => places.includes(control.pointer));
    return found.find(control => control.element.isConnected) ?? found[0];
  }

  /** Shows a field and puts the cursor into it. @param {string} pointer */
  lead(pointer) {
    for (const find of this.finders) find(pointer);
    const control = this.#find(pointer) ?? [...this.#controls].find(each => each.pointer.startsWith(`${pointer}/`));
    if (!control) return;
    unfold(control.element);
    control.element.scrollIntoView({ block: 'center' });
    control.input.focus();
    if (control.input instanceof HTMLInputElement && control.input.type === 'text') control.input.select();
  }

  /** The help line while a field is pointed at. @param {HTMLElement} row @param {Field} field @param {string} name */
  explain(row, field, name) {
    const range = () => {
      if (!isNumeric(field) || typeof field.low !== 'number' || typeof field.high !== 'number') return '';
      const ends = [field.low, field.high].map(each => plain(shownValue(each, field.unit)));
      return `${ends.join(' … ')} ${unitOf(field)}`.trim();
    };
    const empty = field.nullable && field.derived ? `empty: ${field.derived}` : '';
    const show = () => {
      const parts = [shownSentence(field.help ?? ''), range(), shownSentence(empty)];
      fill(this.help, h('b', null, name), ` ${parts.filter(Boolean).join(' · ')}`);
    };
    row.addEventListener('focusin', show);
    row.addEventListener('pointerenter', show);
  }
}
