// SPDX-License-Identifier: GPL-3.0-or-later
// The form of the Design view: what pair, what load, what flank; then whatever else the field tables have.
import { h } from '../base/dom.js';
import { labelOf } from '../base/format.js';
import { inInches, useInches } from '../base/units.js';
import { group, more } from '../form/group.js';
import { Flank } from './flank.js';
import { LoadCases } from './load_cases.js';
import { Teeth } from './teeth.js';

const PAIR = ['pinion_teeth', 'gear_teeth', 'normal_module_mm', 'helix_angle_deg', 'face_width_mm', 'groove_width_mm'];
const SHORT = /** @type {Record<string, string>} */ ({
  normal_module_mm: 'Module',
  groove_width_mm: 'Groove',
});
const ALIGNMENT = {
  shaft_angle_error_in_plane_deg: { label: 'Shaft error, in plane' },
  shaft_angle_error_out_of_plane_deg: { label: 'Shaft error, out of plane' },
};
const FLAGS = ['ends'];
/** Groups with a place of their own; every other object of the tables follows in their order. */
const PLACED = ['gear_pair', 'material', 'modification', 'alignment', 'supports', 'shafts', 'resolution', 'pitch'];
const ELSEWHERE = ['objective', 'optimization', 'tolerance'];

export class Parameters {
  /** @param {import('../base/store.js').DesignStore} store @param {import('../form/form.js').Form} form */
  constructor(store, form) {
    this.store = store;
    this.form = form;
    this.fields = form.set();
    this.pairText = h('span.aside');
    this.flank = new Flank(store, form);
    this.cases = new LoadCases(store, form);
    this.teeth = new Teeth(store, form);
    const { fields } = this;
    const others = form.fields.filter(
      field => field.kind === 'object' && !PLACED.includes(field.key) && !ELSEWHERE.includes(field.key),
    );
    const rest = ['supports', 'shafts', ...others.map(field => field.key), 'resolution'];
    this.element = h(
      'form.parameters',
      { 'aria-label': 'Design', onsubmit: (/** @type {Event} */ event) => event.preventDefault(), autocomplete: 'off' },
      this.#units(),
      group('pair', 'Gear pair', true, this.#pair(), this.pairText),
      group('cases', 'Load cases', true, [this.cases.element]),
      group('modification', 'Modification', true, [this.flank.element]),
      group('alignment', 'Alignment', false, fields.fieldsOf('/alignment', { looks: ALIGNMENT })),
      group('pitch', 'Single teeth', false, [this.teeth.element]),
      rest.map(key => group(key, labelOf(key), false, fields.fieldsOf(`/${key}`))),
    );
    store.addEventListener('change', () => this.refresh());
    this.refresh();
  }

  /** Lengths of all fields, in and out; and of all figures and tables; documents keep mm. */
  #units() {
    const choice = h(
      'select',
      {
        onchange: () => {
          useInches(choice.value === 'inch');
          this.form.refresh();
        },
      },
      h('option', { value: 'mm' }, 'mm, µm'),
      h('option', { value: 'inch' }, 'inch, thou'),
    );
    choice.value = inInches() ? 'inch' : 'mm';
    return h('label.units', null, 'Lengths in ', choice);
  }

  #pair() {
    const { fields } = this;
    return [
      h(
        '.pairs',
        null,
        PAIR.map(key => fields.field(`/gear_pair/${key}`, { label: SHORT[key], compact: true })),
      ),
      more('More of the pair', [
        fields.field('/name'),
        ...fields.fieldsOf('/gear_pair', { only: FLAGS }),
        ...fields.fieldsOf('/gear_pair', { skip: [...PAIR, ...FLAGS] }),
      ]),
      more('Material', fields.fieldsOf('/material')),
    ];
  }

  refresh() {
    const pair = this.store.design.gear_pair ?? {};
    const { helix_angle_deg: left, right_helix_angle_deg: right } = pair;
    const halves = typeof right === 'number' && right !== left ? `, left ${left ?? '–'}°, right ${right}°` : '';
    this.pairText.textContent = `${pair.pinion_teeth ?? '–'}/${pair.gear_teeth ?? '–'}${halves}`;
    this.flank.refresh();
    this.cases.refresh();
    this.teeth.refresh();
  }
}
