// SPDX-License-Identifier: GPL-3.0-or-later
// The form of the Design view: what pair, what load, what flank.
import { fill, h } from '../base/dom.js';
import { labelOf, unitText } from '../base/format.js';
import { fieldAt } from '../base/schema.js';
import { switcher } from '../figures/frame.js';
import { group } from '../form.js';

const PAIR = ['pinion_teeth', 'gear_teeth', 'normal_module_mm', 'helix_angle_deg', 'face_width_mm', 'groove_width_mm'];
const SHORT = /** @type {Record<string, string>} */ ({
  normal_module_mm: 'Module',
  groove_width_mm: 'Groove',
  shaft_angle_error_in_plane_deg: 'Shaft error, in plane',
  shaft_angle_error_out_of_plane_deg: 'Shaft error, out of plane',
});
const MAIN = ['tip_relief_um', 'tip_relief_start_mm', 'root_relief_um', 'root_relief_start_mm', 'lead_crowning_um'];
const FLAGS = ['ends'];
const COLUMNS = ['torque_Nm', 'speed_rpm', 'share'];

/** @typedef {import('../form.js').Form} Form */
/** @typedef {import('../base/store.js').DesignStore} Store */

export class Parameters {
  /** @type {'pinion' | 'gear'} */ #member = 'pinion';
  /** @type {'left' | 'right'} */ #end = 'left';
  #shape = '';
  #rows = -1;

  /** @param {Store} store @param {Form} form */
  constructor(store, form) {
    this.store = store;
    this.form = form;
    this.pairText = h('span.aside');
    this.table = h('table.load-cases');
    this.flank = h('.flank');
    this.tie = h('input', { type: 'checkbox', id: 'tie', onchange: () => store.tie(this.tie.checked) });
    this.tieLabel = h('label.tie', { for: 'tie' }, this.tie, 'left = right');
    this.element = h(
      'form.parameters',
      { 'aria-label': 'Design', onsubmit: (/** @type {Event} */ event) => event.preventDefault(), autocomplete: 'off' },
      group(
        'pair',
        'Gear pair',
        true,
        [
          h(
            '.pairs',
            null,
            PAIR.map(key => form.field(`/gear_pair/${key}`, { label: SHORT[key], compact: true })),
          ),
          more('More of the pair', [
            form.field('/name'),
            ...form.fieldsOf('/gear_pair', { only: FLAGS }),
            ...form.fieldsOf('/gear_pair', { skip: [...PAIR, ...FLAGS] }),
          ]),
          more('Material', form.fieldsOf('/material')),
        ],
        this.pairText,
      ),
      group('cases', 'Load cases', true, [
        this.table,
        h('button.small', { type: 'button', onclick: () => this.#addCase() }, '+ load case'),
      ]),
      group('modification', 'Modification', true, [this.flank]),
      group('alignment', 'Alignment', false, form.fieldsOf('/alignment')),
      group('supports', 'Supports', false, form.fieldsOf('/supports')),
      group('shafts', 'Shafts', false, form.fieldsOf('/shafts')),
      group('resolution', 'Resolution', false, form.fieldsOf('/resolution')),
    );
    store.addEventListener('change', () => this.refresh());
    this.refresh();
  }

  refresh() {
    const pair = this.store.design.gear_pair ?? {};
    this.pairText.textContent = `${pair.pinion_teeth ?? '–'}/${pair.gear_teeth ?? '–'}`;
    const two = (pair.ends ?? 2) === 2;
    this.tie.checked = this.store.tied;
    this.tieLabel.hidden = !two;
    this.#drawFlank(two);
    const rows = this.store.design.load_cases?.length ?? 0;
    if (rows !== this.#rows) this.#drawCases(rows);
  }

  /** @param {boolean} two ends */
  #drawFlank(two) {
    const split = two && !this.store.tied;
    const shape = JSON.stringify([this.#member, split, split ? this.#end : 'left']);
    if (shape === this.#shape) return;
    this.#shape = shape;
    const end = split ? this.#end : 'left';
    const base = `/modification/${this.#member}/${end}`;
    const again = () => this.refresh();
    const switches = h(
      '.switches',
      null,
      switcher(
        'Member',
        [
          ['pinion', 'pinion'],
          ['gear', 'gear'],
        ],
        this.#member,
        value => {
          this.#member = /** @type {any} */ (value);
          again();
        },
      ),
      split
        ? switcher(
            'End',
            [
              ['left', 'left'],
              ['right', 'right'],
            ],
            end,
            value => {
              this.#end = /** @type {any} */ (value);
              again();
            },
          )
        : null,
      this.tieLabel,
    );
    const all = (fieldAt(this.form.fields, base)?.fields ?? []).map(field => field.key);
    fill(
      this.flank,
      switches,
      MAIN.map(key => this.#slider(`${base}/${key}`)),
      more(
        'More of the flank',
        all
          .filter(key => !MAIN.includes(key))
          .map(key => (key === 'relief_shape' ? this.form.field(`${base}/${key}`) : this.#slider(`${base}/${key}`))),
      ),
    );
    this.form.refresh();
  }

  /** @param {string} pointer */
  #slider(pointer) {
    const field = /** @type {import('../base/schema.js').Field} */ (fieldAt(this.form.fields, pointer));
    return this.form.slider(
      () => pointer,
      field,
      () => this.#range(field),
    );
  }

  /**
   * The bounds of the optimization where it has some, else what is usual.
   * @param {import('../base/schema.js').Field} field
   */
  #range(field) {
    const bounds =
      this.store.get(`/optimization/bounds/${field.key}`) ?? this.form.resolved?.optimization?.bounds?.[field.key];
    const { face_width_mm: width = 50, normal_module_mm: module = 5 } = this.store.design.gear_pair ?? {};
    if (field.key === 'profile_crowning_per_mm') return { low: -0.001, high: 0.001, step: 0.00001 };
    if (field.unit === 'mm')
      return Array.isArray(bounds)
        ? { low: 0, high: bounds[1], step: 0.01 }
        : { low: 0, high: /length/.test(field.key) ? width / 2 : module, step: 0.01 };
    const low = typeof field.low === 'number' && field.low < 0 ? -50 : 0;
    return Array.isArray(bounds)
      ? { low: Math.min(low < 0 ? 0 : low, bounds[0]), high: bounds[1], step: 0.1 }
      : { low, high: 50, step: 0.1 };
  }

  #addCase() {
    const rows = this.store.design.load_cases ?? [];
    const last = rows[rows.length - 1] ?? { torque_Nm: 100, speed_rpm: 2000, share: 1 };
    this.store.set('/load_cases', [...rows, { ...last }]);
  }

  /** @param {number} count */
  #drawCases(count) {
    this.#rows = count;
    const fields = fieldAt(this.form.fields, '/load_cases')?.fields ?? [];
    const columns = COLUMNS.map(key => fields.find(field => field.key === key)).filter(field => field !== undefined);
    const head = h(
      'tr',
      null,
      columns.map(field =>
        h(
          'th',
          { scope: 'col' },
          labelOf(field.key),
          field.unit ? h('span.unit', null, ` ${unitText(field.unit)}`) : null,
        ),
      ),
      h('td'),
    );
    const rows = Array.from({ length: count }, (_, i) =>
      h(
        'tr',
        null,
        columns.map(field =>
          h(
            'td',
            null,
            this.form.field(`/load_cases/${i}/${field.key}`, { label: `${labelOf(field.key)} of load case ${i + 1}` }),
          ),
        ),
        h(
          'td',
          null,
          h(
            'button.icon',
            {
              type: 'button',
              'aria-label': `Remove load case ${i + 1}`,
              title: 'Remove',
              disabled: count === 1,
              onclick: () => this.#removeCase(i),
            },
            '✕',
          ),
        ),
      ),
    );
    fill(this.table, h('thead', null, head), h('tbody', null, rows));
  }

  /** @param {number} index */
  #removeCase(index) {
    this.#rows = -1;
    const rows = this.store.design.load_cases.filter((/** @type {any} */ _row, /** @type {number} */ i) => i !== index);
    if (this.store.loadCase >= rows.length) this.store.loadCase = -1;
    this.store.set('/load_cases', rows);
  }
}

/** @param {string} title @param {HTMLElement[]} children */
function more(title, children) {
  return h('details.more', null, h('summary', null, title), h('.group-body', null, children));
}
