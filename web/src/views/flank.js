// SPDX-License-Identifier: GPL-3.0-or-later
// The modification of the flanks: which member, which end, sliders for what is moved most.
import { fill, h } from '../base/dom.js';
import { flankShown } from '../base/flank_shown.js';
import { labelOf } from '../base/format.js';
import { notice } from '../base/notice.js';
import { valueAt } from '../base/pointer.js';
import { fieldAt } from '../base/schema.js';
import { WAYS, keyOf, otherTexts, restated, wayOf } from '../base/relief_start.js';
import { switcher } from '../base/switcher.js';
import { more } from '../form/group.js';

const MAIN = ['tip_relief_um', 'tip_relief_start_mm', 'root_relief_um', 'root_relief_start_mm', 'lead_crowning_um'];
const START = /^(tip|root)_relief_(start|diameter|roll|length)/; // each has its place, in the way that is chosen
/** What is moved less often, by what it is about; the first pattern that fits. @type {[string, RegExp][]} */
const GROUPS = [
  ['Shape of the reliefs', /_(shape|exponent)$/],
  ['Triangular relief of the corners', /triangular/],
  ['Relief of the face ends', /^(leading|trailing)_end/],
  ['Profile, helix and twist', /./],
];
const MEMBERS = ['pinion', 'gear'];
const ENDS = ['left', 'right'];
const SIDES = /** @type {import('../base/relief_start.js').Side[]} */ (['tip', 'root']);
const COAST = 'coast';
const USUAL = { um: 50, mm: 5 }; // ends of sliders without bounds of their own
const CURVATURE = 0.001; // 1/mm, of a profile crowning stated as a coefficient

export class Flank {
  #member = 'pinion';
  #end = 'left';
  #side = 'drive';
  #shape = '';
  /** Where the reliefs of the last result start. @type {Page.Result | null} */ #result = null;
  /** What shows it. @type {Partial<Record<import('../base/relief_start.js').Side, () => void>>} */ #starts = {};

  /** @param {import('../base/store.js').DesignStore} store @param {import('../form/form.js').Form} form */
  constructor(store, form) {
    this.store = store;
    this.form = form;
    this.fields = form.set();
    this.element = h('.flank', {
      ondragover: (/** @type {DragEvent} */ event) => {
        if (this.#isTable(event)) event.preventDefault();
        this.element.classList.toggle('over', this.#isTable(event));
      },
      ondragleave: () => this.element.classList.remove('over'),
      ondrop: (/** @type {DragEvent} */ event) => this.#dropped(event),
    });
    this.tie = h('input', { type: 'checkbox', id: 'tie', onchange: () => store.tie(this.tie.checked) });
    this.tieLabel = h('label.tie', { for: 'tie' }, this.tie, 'left = right');
    form.finders.push(pointer => this.#turnTo(pointer));
  }

  /** One file, in the place where a flank takes a table. @param {DragEvent} event */
  #isTable(event) {
    return [...(event.dataTransfer?.items ?? [])].filter(item => item.kind === 'file').length === 1;
  }

  /** The flank on show takes a table that is dropped on it. @param {DragEvent} event */
  async #dropped(event) {
    this.element.classList.remove('over');
    const file = event.dataTransfer?.files[0];
    if (!file || !/\.(csv|tsv|txt)$/i.test(file.name)) return; // files of other programs are the page's
    event.preventDefault();
    this.#take(this.#pointer('/grid'), await file.text());
    notice.say(`${file.name} is the grid of this flank now; undo takes it back.`);
  }

  /**
   * A table in place of the numbers that are there; it is what they were, measured or designed.
   * @param {string} pointer @param {string} csv
   */
  #take(pointer, csv) {
    const kind = this.store.get(pointer)?.kind;
    this.store.set(pointer, kind ? { csv, kind } : { csv });
  }

  /** Of what is on show. @param {string} key */
  #pointer(key) {
    const two = (this.store.design.gear_pair?.ends ?? 2) === 2;
    const end = two && !this.store.tied ? this.#end : 'left';
    return `/modification/${this.#member}/${end}${this.#side === COAST ? `/${COAST}` : ''}${key}`;
  }

  /** Turns to the member and end of a value. @param {string} pointer */
  #turnTo(pointer) {
    const [, group, member, end, side] = pointer.split('/');
    if (group !== 'modification' || !MEMBERS.includes(member)) return;
    this.#member = member;
    if (ENDS.includes(end)) this.#end = end;
    this.#side = side === COAST ? COAST : 'drive';
    this.refresh();
  }

  refresh() {
    const two = (this.store.design.gear_pair?.ends ?? 2) === 2;
    this.tie.checked = this.store.tied;
    this.tieLabel.hidden = !two;
    const split = two && !this.store.tied;
    const end = split ? this.#end : 'left';
    const grid = Boolean(this.store.get(this.#pointer('/grid')));
    flankShown.set(/** @type {Page.Member} */ (this.#member), this.#side === COAST ? COAST : 'drive');
    const ways = SIDES.map(side => wayOf(this.store.get(this.#pointer('')), side).way);
    const shape = JSON.stringify([this.#member, split, end, this.#side, grid, ways]);
    if (shape === this.#shape) return;
    this.#shape = shape;
    const flank = `/modification/${this.#member}/${end}`;
    this.#draw(this.#side === COAST ? `${flank}/${COAST}` : flank, split, end);
  }

  /** @param {string} base pointer of the flank @param {boolean} split each end for itself @param {string} end */
  #draw(base, split, end) {
    this.fields.release();
    /** @param {string[]} names @returns {[string, string][]} */
    const pairs = names => names.map(name => [name, name]);
    const switches = h(
      '.switches',
      null,
      switcher('Member', pairs(MEMBERS), this.#member, value => {
        this.#member = value;
        this.refresh();
      }),
      split
        ? switcher('End', pairs(ENDS), end, value => {
            this.#end = value;
            this.refresh();
          })
        : null,
      this.#sides(end),
      this.tieLabel,
    );
    const all = fieldAt(this.form.fields, base)?.fields ?? [];
    const main = all.filter(field => MAIN.includes(field.key));
    main.sort((a, b) => MAIN.indexOf(a.key) - MAIN.indexOf(b.key));
    const rest = all.filter(field => !MAIN.includes(field.key) && !START.test(field.key) && !field.entry);
    const open = new Set([...this.element.querySelectorAll('details[open] > summary')].map(each => each.textContent));
    fill(
      this.element,
      switches,
      main.map(field => (START.test(field.key) ? this.#start(base, field) : this.#entry(base, field))),
      this.#groups(base, rest),
      this.#grid(base, all),
    );
    for (const group of this.element.querySelectorAll('details'))
      group.open = open.has(group.querySelector('summary')?.textContent ?? '');
  }

  /** Where the reliefs start in every way, of the result on the screen. @param {Page.Result} result */
  showStarts(result) {
    this.#result = result;
    for (const show of Object.values(this.#starts)) show();
  }

  /** @param {import('../base/relief_start.js').Side} side @returns {Api.ReliefStart | null} */
  #startOf(side) {
    const end = /** @type {Page.End} */ (this.#pointer('').split('/')[3]);
    const drive = this.#result?.modification?.[/** @type {Page.Member} */ (this.#member)]?.[end];
    const flank = this.#side === COAST ? drive?.coast : drive;
    return (side === 'tip' ? flank?.tip_relief_start : flank?.root_relief_start) ?? null;
  }

  /**
   * The start of a relief in the way in which it is stated, and what it is in the others.
   * @param {string} base @param {import('../base/schema.js').Field} field
   */
  #start(base, field) {
    const side = field.key.startsWith('tip') ? 'tip' : 'root';
    const stated = wayOf(this.store.get(base), side);
    const name = labelOf(field.key);
    const own = fieldAt(this.form.fields, `${base}/${keyOf(side, stated)}`) ?? field;
    const row =
      stated === WAYS[0] ? this.#entry(base, own)[0] : this.fields.field(`${base}/${own.key}`, { label: name });
    const choice = h(
      'select.start-way',
      {
        'aria-label': `${name} as`,
        onchange: () => {
          const [way, start] = [WAYS.find(each => each.way === choice.value), this.#startOf(side)];
          if (way && start) this.store.set(base, restated(this.store.get(base), side, way, start));
        },
      },
      WAYS.map(({ way, name: text }) => h('option', { value: way }, text)),
    );
    choice.value = stated.way;
    const others = h('small.start-others');
    this.#starts[side] = () => {
      const start = this.#startOf(side);
      choice.disabled = !start;
      others.textContent = start ? `= ${otherTexts(start, stated).join(', ')}` : '';
    };
    this.#starts[side]?.();
    const label = row.querySelector('label');
    const both = h('span.start-name');
    label?.before(both);
    both.append(...(label ? [label] : []), choice);
    row.append(others);
    return row;
  }

  /** @param {string} base @param {import('../base/schema.js').Field[]} fields */
  #groups(base, fields) {
    /** @param {import('../base/schema.js').Field} field */
    const groupOf = field => GROUPS.find(([, pattern]) => pattern.test(field.key))?.[0];
    return [...GROUPS].reverse().flatMap(([title]) => {
      const own = fields.filter(field => groupOf(field) === title).flatMap(field => this.#entry(base, field));
      return own.length ? [more(title, own)] : [];
    });
  }

  /** Points of the flank from a table. @param {string} base @param {import('../base/schema.js').Field[]} fields */
  #grid(base, fields) {
    const field = fields.find(each => each.key === 'grid');
    if (!field) return null;
    const pointer = `${base}/grid`;
    const now = this.store.get(pointer);
    const text = h('textarea', {
      rows: 4,
      'aria-label': 'Grid of the flank as CSV',
      placeholder: 'u\\y, -20, 0, 20\n-5, 3, 0, 3\n5, 8, 0, 8',
    });
    const take = () =>
      text.value.trim() === '' ? this.store.set(pointer, null) : this.#take(pointer, text.value);
    return more('Points from a table', [
      h('p.figure-note', null, field.help ?? ''),
      h(
        'p.figure-note',
        null,
        'First row: places along the face in mm; each further row: its place on the profile, then µm.',
      ),
      h('p.figure-note', null, now ? 'This flank has a grid.' : 'This flank has no grid.'),
      ...(now ? [this.fields.field(`${pointer}/kind`)] : []),
      text,
      h(
        '.switches',
        null,
        h('button.small', { type: 'button', onclick: take }, 'Take the table'),
        now
          ? h('button.small', { type: 'button', onclick: () => this.store.set(pointer, null) }, 'Remove the grid')
          : null,
      ),
    ]);
  }

  /** Drive or coast flank, where the service knows both. @param {string} end */
  #sides(end) {
    if (!fieldAt(this.form.fields, `/modification/${this.#member}/${end}/${COAST}`)) return null;
    return switcher(
      'Flank',
      [
        ['drive', 'drive'],
        [COAST, 'coast'],
      ],
      this.#side,
      value => {
        this.#side = value;
        this.refresh();
      },
    );
  }

  /** @param {string} base @param {import('../base/schema.js').Field} field @returns {HTMLElement[]} */
  #entry(base, field) {
    const pointer = `${base}/${field.key}`;
    if (field.kind === 'number' && !field.nullable && field.unit)
      return [this.fields.slider(pointer, () => this.#range(pointer, field))];
    if (field.kind === 'object' || field.kind === 'list') return [];
    return [this.fields.field(pointer)];
  }

  /**
   * The bounds of the optimization where it has some, else what is usual.
   * @param {string} pointer
   * @param {import('../base/schema.js').Field} field
   */
  #range(pointer, field) {
    const place = `/optimization/bounds/${field.key}`;
    const bounds = this.store.get(place) ?? valueAt(this.form.resolved, place);
    const { face_width_mm: width = 10 * USUAL.mm, normal_module_mm: module = USUAL.mm } =
      this.store.design.gear_pair ?? {};
    const negative = typeof field.low === 'number' && field.low < 0;
    if (field.unit === 'per_mm') return { low: -CURVATURE, high: CURVATURE, step: CURVATURE / 100 };
    if (field.unit === 'mm') {
      const high = /length/.test(field.key) ? width / 2 : module;
      return { low: 0, high: Array.isArray(bounds) ? bounds[1] : high, step: 0.01 };
    }
    if (Array.isArray(bounds)) return { low: Math.min(0, bounds[0]), high: bounds[1], step: 0.1 };
    return { low: negative ? -USUAL.um : 0, high: USUAL.um, step: 0.1 };
  }
}
