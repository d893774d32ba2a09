// SPDX-License-Identifier: GPL-3.0-or-later
// Your own gear: five numbers and a load; what follows from them and what is assumed stands beside them as they are
// typed.
import { Refusal, post } from '../base/api.js';
import { fill, h, newId } from '../base/dom.js';
import { labelOf, plain, sig } from '../base/format.js';
import { withValue } from '../base/pointer.js';
import { readQuantity } from '../base/quantity.js';
import { fieldAt, numberFault, unitOf } from '../base/schema.js';
import { shownSentence, shownUnit, shownValue, typedText, units } from '../base/units.js';

const PAUSE = 350; // ms after the last key before the service is asked

/** @typedef {import('../base/schema.js').Field} Field */
/** @typedef {{ pointer: string, label: string, example: string }} Question */

/** @type {Question[]} */
const QUESTIONS = [
  { pointer: '/gear_pair/pinion_teeth', label: 'Teeth of the pinion', example: '23' },
  { pointer: '/gear_pair/gear_teeth', label: 'Teeth of the gear', example: '67' },
  { pointer: '/gear_pair/normal_module_mm', label: 'Normal module', example: '4' },
  { pointer: '/gear_pair/helix_angle_deg', label: 'Helix angle', example: '28' },
  { pointer: '/gear_pair/face_width_mm', label: 'Face width of one end', example: '45' },
  { pointer: '/load_cases/0/torque_Nm', label: 'Torque on the pinion', example: '500' },
  { pointer: '/load_cases/0/speed_rpm', label: 'Speed of the pinion', example: '1500' },
];

/** @param {Record<string, number>} values by pointer @param {number} ends @param {string} name */
function designOf(values, ends, name) {
  /** @type {unknown} */
  let design = { name, gear_pair: { ends }, load_cases: [{ share: 1 }] };
  for (const [pointer, value] of Object.entries(values)) design = withValue(design, pointer, value);
  return /** @type {Api.Design} */ (design);
}

/**
 * What the service takes for what is not stated: as it lists it, else the defaults of the field tables.
 * @param {Api.Check} answer
 * @param {Field[]} fields
 * @returns {[string, string, string][]} name, value, rule
 */
function assumptionsOf(answer, fields) {
  return answer.assumed.map(each => {
      const field = fieldAt(fields, each.key);
      return [labelOf(each.key.split('/').pop() ?? ''), valueText(each.value, field), shownSentence(each.rule ?? '')];
    });
}

/** @param {unknown} value @param {Field | undefined} field */
function valueText(value, field) {
  if (value === null || value === undefined) return '–';
  const text = typeof value === 'number' ? plain(Number(shownValue(value, field?.unit).toPrecision(5))) : String(value);
  return `${text} ${unitOf(field)}`.trim();
}

class OwnGear {
  #timer = 0;
  #turn = 0;
  /** @type {Api.Design | null} */ #checked = null;

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.inputs = QUESTIONS.map(question => this.#question(question));
    this.ends = h(
      'select',
      { id: newId('ends'), onchange: () => this.#changed() },
      h('option', { value: '2' }, 'herringbone: two ends'),
      h('option', { value: '1' }, 'single helical or spur'),
    );
    this.name = h('input.text', { id: newId('name'), type: 'text', maxlength: 199, placeholder: 'my gear' });
    this.finding = h('.own-finding', { 'aria-live': 'polite' });
    this.start = h('button.primary', { type: 'submit', disabled: true }, 'Compute it');
    this.dialog = h(
      'dialog',
      { class: 'own-gear-dialog', 'aria-label': 'Your own gear' },
      h('button.icon.close', { type: 'button', 'aria-label': 'Close', onclick: () => this.dialog.close() }, '✕'),
      h('h2', null, 'Your own gear'),
      h(
        'p.figure-note',
        null,
        'Five numbers and a load. Everything else has a usual value, which you can change afterwards.',
      ),
      this.#form(),
    );
    this.dialog.addEventListener('close', () => this.dialog.remove());
    document.body.append(this.dialog);
    this.dialog.showModal();
    this.inputs[0].input.focus();
    this.#say();
  }

  #form() {
    return h(
      'form',
      {
        autocomplete: 'off',
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          this.#open();
        },
      },
      h(
        '.own-columns',
        null,
        h(
          'div',
          null,
          this.inputs.map(({ row }) => row),
          h('.field', null, h('label', { for: this.ends.id }, 'Kind'), this.ends),
          h('.field', null, h('label', { for: this.name.id }, 'Name'), this.name),
        ),
        this.finding,
      ),
      h(
        '.dialog-foot',
        null,
        this.start,
        h('button', { type: 'button', onclick: () => this.#fillExample() }, 'Fill in an example'),
      ),
    );
  }

  /** @param {Question} question */
  #question({ pointer, label, example }) {
    const field = /** @type {Field} */ (fieldAt(this.app.fields, pointer));
    const id = newId('own');
    const fault = h('span.fault', { id: `${id}-fault`, role: 'alert' });
    const input = h('input.number', {
      id,
      type: 'text',
      inputmode: 'decimal',
      'aria-describedby': fault.id,
      oninput: () => this.#changed(),
    });
    const unit = h('span.unit');
    const row = h('.field', null, h('label', { for: id }, label), h('span.entry', null, input, unit), fault);
    /** As a number of the unit that is wanted. */
    const sample = () => plain(shownValue(Number(example), field.unit));
    const spell = () => {
      unit.textContent = unitOf(field);
      input.placeholder = `e.g. ${sample()}`;
    };
    spell();
    units.addEventListener('change', spell);
    return { pointer, field, input, fault, row, sample };
  }

  #fillExample() {
    for (const { input, sample } of this.inputs) input.value = sample();
    this.#changed();
  }

  /**
   * The values that can be taken; a fault at each that cannot.
   * @returns {Record<string, number> | null} null: not all
   */
  #values() {
    /** @type {Record<string, number>} */
    const values = {};
    for (const { pointer, field, input, fault } of this.inputs) {
      const text = input.value.trim();
      const read = text === '' ? { fault: '' } : readQuantity(typedText(text, field.unit), field.unit);
      const wrong = read.fault ?? numberFault(field, Number(read.value));
      fault.textContent = wrong;
      input.setAttribute('aria-invalid', String(wrong !== ''));
      if (wrong === '' && read.value !== undefined) values[pointer] = read.value;
    }
    return Object.keys(values).length === this.inputs.length ? values : null;
  }

  #changed() {
    clearTimeout(this.#timer);
    this.#checked = null;
    this.start.disabled = true;
    const values = this.#values();
    if (!values) return this.#say();
    this.#timer = window.setTimeout(() => this.#check(values), PAUSE);
  }

  /** @param {Record<string, number>} values */
  async #check(values) {
    const turn = ++this.#turn;
    const design = designOf(values, Number(this.ends.value), this.name.value.trim() || 'my gear');
    try {
      const answer = await post('check', design);
      if (turn !== this.#turn) return;
      this.#checked = design;
      this.start.disabled = false;
      this.#sayChecked(answer);
    } catch (error) {
      if (turn === this.#turn) this.#refuse(/** @type {Error} */ (error));
    }
  }

  /** @param {Error} error */
  #refuse(error) {
    const faults = error instanceof Refusal ? error.faults : [];
    const stray = faults.filter(({ pointer, detail }) => {
      const own = this.inputs.find(input => input.pointer === pointer);
      if (own) own.fault.textContent = detail;
      return !own;
    });
    fill(
      this.finding,
      h('h3', null, 'This does not work yet'),
      (faults.length ? stray.map(each => each.detail) : [error.message]).map(text => h('p.fault', null, text)),
    );
  }

  #say() {
    fill(
      this.finding,
      h('h3', null, 'Derived values and assumptions'),
      h(
        'p.figure-note',
        null,
        'They appear here when the seven numbers are there. Write a comma or a point, mm or inch, N m or lbf ft.',
      ),
    );
  }

  /** @param {Api.Check} answer */
  #sayChecked(answer) {
    const g = /** @type {Page.Result['geometry']} */ (answer.geometry); // of a design that was accepted
    const turns = Number(answer.design.load_cases[0].speed_rpm) / 60;
    const facts = [
      ['Ratio', sig(g.gear_teeth / g.pinion_teeth, 4)],
      ['Centre distance', `${sig(shownValue(g.centre_distance_mm, 'mm'), 6)} ${shownUnit('mm')}`],
      ['Transverse contact ratio', sig(g.transverse_contact_ratio, 3)],
      ['Overlap ratio', sig(g.overlap_ratio, 3)],
      [
        'Pitch line speed',
        `${sig((g.working_radius_mm[0] * 2 * Math.PI * turns) / 1000, 3)} m/s`,
      ],
    ];
    /** @param {string[][]} rows */
    const table = rows =>
      h(
        'table.numbers',
        null,
        h(
          'tbody',
          null,
          rows.map(([name, ...cells]) =>
            h(
              'tr',
              null,
              h('th', { scope: 'row' }, name),
              cells.map(cell => h('td', null, cell)),
            ),
          ),
        ),
      );
    fill(
      this.finding,
      h('h3', null, 'It follows'),
      table(facts),
      answer.warnings?.length
        ? h(
            'ul.findings',
            null,
            answer.warnings.map(text => h('li', null, shownSentence(text))),
          )
        : null,
      h('h3', null, 'Assumed, until you state it'),
      h(
        '.own-assumed',
        { tabindex: '0', role: 'region', 'aria-label': 'Assumed' },
        table(assumptionsOf(answer, this.app.fields)),
      ),
      answer.prepared
        ? null
        : h('p.figure-note', null, 'Its teeth are new here and are prepared first: some seconds, once.'),
    );
  }

  async #open() {
    const design = this.#checked;
    if (!design) return;
    design.name = this.name.value.trim() || 'my gear';
    this.dialog.close();
    await this.app.attempt(() => this.app.opening(() => this.app.library.openNew(design), 'design'));
  }
}

/** @param {import('../app.js').App} app */
export function openOwnGear(app) {
  return new OwnGear(app);
}
