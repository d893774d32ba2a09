// SPDX-License-Identifier: GPL-3.0-or-later
// Deviations of single teeth: of each member a class, an eccentricity, a wobble; of all flanks a measured table.
import { fill, h } from '../base/dom.js';
import { fieldAt } from '../base/schema.js';
import { more } from '../form/group.js';

const MEMBERS = ['pinion', 'gear'];
const SKIP = ['left', 'right', 'csv', ...MEMBERS];
const EXAMPLE = 'member,end,flank,tooth,index_um\npinion,left,drive,1,0.0\npinion,left,drive,2,1.3';

export class Teeth {
  #shape = '';

  /** @param {import('../base/store.js').DesignStore} store @param {import('../form/form.js').Form} form */
  constructor(store, form) {
    this.store = store;
    this.form = form;
    this.fields = form.set();
    this.element = h('.teeth');
  }

  refresh() {
    const stated = Boolean(this.store.get('/pitch'));
    const shape = String(stated);
    if (shape === this.#shape) return;
    this.#shape = shape;
    this.fields.release();
    fill(this.element, stated ? this.#stated() : this.#none());
  }

  #none() {
    const note = fieldAt(this.form.fields, '/pitch')?.help ?? '';
    const begin = () =>
      this.store.set('/pitch', Object.fromEntries(MEMBERS.map(member => [member, { tolerance_class: 5 }])));
    return [
      h('p.figure-note', null, `The teeth are alike. ${note.charAt(0).toUpperCase()}${note.slice(1)}.`),
      h('button.small', { type: 'button', onclick: begin }, 'Draw teeth of class 5'),
    ];
  }

  #stated() {
    return [
      ...MEMBERS.map(member =>
        more(`Teeth of the ${member}`, this.fields.fieldsOf(`/pitch/${member}`, { skip: SKIP })),
      ),
      this.#table(),
      more('Period', this.fields.fieldsOf('/pitch', { skip: SKIP })),
      h('button.small', { type: 'button', onclick: () => this.store.set('/pitch', null) }, 'All teeth alike'),
    ];
  }

  #table() {
    const text = h('textarea', { rows: 4, 'aria-label': 'Measured teeth as CSV', placeholder: EXAMPLE });
    const take = () => text.value.trim() !== '' && this.store.set('/pitch/csv', text.value);
    return more('Measured teeth from a table', [
      h('p.figure-note', null, fieldAt(this.form.fields, '/pitch/csv')?.help ?? ''),
      text,
      h('button.small', { type: 'button', onclick: take }, 'Take the table'),
    ]);
  }
}
