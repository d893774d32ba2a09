// SPDX-License-Identifier: GPL-3.0-or-later
// How much the shown design depends on what no drawing holds: misalignment first, then load and relief as a small
// figure that is always in sight; any number of the design as a figure of its own.
import { fill, h } from '../base/dom.js';
import { labelOf, sig, unitText } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { valueAt, withValue } from '../base/pointer.js';
import { shownUnit, shownValue, units } from '../base/units.js';
import { unmodified } from '../base/store.js';
import { numbersOf } from '../numbers.js';
import { tickText } from './ticks.js';
import { Chart } from './chart.js';
import { OWN_COLOUR, REFERENCE_COLOUR, mainCase, torqueOf } from './context.js';

const REST = 500; // ms without a change
const ASK = 'analyze?maps=0&root_stress=0&rating=0&pitch=0';
const IN_PLANE = '/alignment/shaft_angle_error_in_plane_deg';
const OUT_OF_PLANE = '/alignment/shaft_angle_error_out_of_plane_deg';
const MISALIGNMENT = 0.05; // deg on either side, as shafts and housings bring
const TORQUES = [0.5, 0.75, 1, 1.25, 1.5];
const RELIEFS = [0.6, 0.8, 1, 1.2, 1.4];
const STEPS = 9;
const [WIDTH, HEIGHT] = [60, 24]; // px of a small curve

/**
 * @typedef {object} Variation a number of the design and what becomes of it
 * @property {string} name @property {string} unit
 * @property {(design: Api.Design) => { at: number, design: Api.Design }[]} designs
 */
/** @typedef {{ at: number, value: number }} Point */

/** @param {Api.Design} design @param {string} pointer */
const numberAt = (design, pointer) => Number(valueAt(design, pointer) ?? 0);

/**
 * The design with all its reliefs times a factor; itself when it has none.
 * @param {Api.Design} design @param {number} factor
 */
function withRelief(design, factor) {
  let next = design;
  for (const member of ['pinion', 'gear'])
    for (const end of ['left', 'right'])
      for (const key of ['tip_relief_um', 'root_relief_um']) {
        const pointer = `/modification/${member}/${end}/${key}`;
        const value = valueAt(design, pointer);
        if (typeof value === 'number' && value !== 0) next = withValue(next, pointer, value * factor);
      }
  return next;
}

/** @type {Variation[]} of the strip */
const STRIP = [
  {
    name: 'misalignment',
    unit: '°',
    designs: design =>
      [-1, -0.5, 0, 0.5, 1].map(part => {
        const at = numberAt(design, IN_PLANE) + part * MISALIGNMENT;
        return { at, design: withValue(design, IN_PLANE, at) };
      }),
  },
  {
    name: 'torque',
    unit: '%',
    designs: design =>
      TORQUES.map(factor => ({
        at: 100 * factor,
        design: {
          ...design,
          load_cases: design.load_cases.map(row => ({
            ...row,
            torque_Nm: torqueOf(row) * factor,
            power_kW: undefined,
          })),
        },
      })),
  },
  {
    name: 'relief',
    unit: '%',
    designs: design => RELIEFS.map(factor => ({ at: 100 * factor, design: withRelief(design, factor) })),
  },
];

/** Numbers that may be swept, by what a designer doubts first. */
const KEYS = [
  IN_PLANE,
  OUT_OF_PLANE,
  '/modification/pinion/left/tip_relief_um',
  '/modification/pinion/left/tip_relief_start_mm',
  '/modification/pinion/left/root_relief_um',
  '/modification/pinion/left/root_relief_start_mm',
  '/modification/pinion/left/lead_crowning_um',
  '/alignment/stagger',
  '/supports/mesh_damping_ratio',
];
/** The last part of a pointer. @param {string} pointer */
const keyIn = pointer => pointer.split('/').pop() ?? '';
/** @type {[import('../numbers.js').NumberKey, string, string][]} */
const MEASURES = [
  ['peak_to_peak_um', 'transmission error', 'µm'],
  ['impact_N', 'entering impact', 'N'],
  ['rms_m_per_s2', 'vibration', 'm/s²'],
  ['contact_pressure_MPa', 'contact pressure', 'MPa'],
];

/** Asks for one design after the other; a newer row of questions ends the one before. */
class Series {
  /** @type {{ at: number, design: Api.Design }[]} */ #left = [];
  /** @type {{ at: number, result: Page.Result }[]} */ #found = [];
  /** @type {((found: { at: number, result: Page.Result }[]) => void) | null} */ #done = null;
  #turn = 0;

  constructor() {
    /** @type {Lane<Page.Result, { at: number, turn: number }>} */
    this.lane = new Lane({
      result: (task, data) => this.#take(task.note, data),
      refused: task => this.#take(task.note, null),
    });
  }

  /**
   * @param {{ at: number, design: Api.Design }[]} designs
   * @param {(found: { at: number, result: Page.Result }[]) => void} done
   */
  ask(designs, done) {
    this.#turn += 1;
    this.#left = [...designs];
    this.#found = [];
    this.#done = done;
    this.#next();
  }

  stop() {
    this.#turn += 1;
    this.#left = [];
    this.#done = null;
  }

  #next() {
    const first = this.#left.shift();
    if (first) this.lane.submit({ path: ASK, body: first.design, note: { at: first.at, turn: this.#turn } });
    else this.#done?.(this.#found);
  }

  /** @param {{ at: number, turn: number }} note @param {Page.Result | null} result */
  #take({ at, turn }, result) {
    if (turn !== this.#turn) return;
    if (result) this.#found.push({ at, result });
    this.#next();
  }
}

/** @param {Point[]} points */
function pictureOf(points) {
  const values = points.map(point => point.value);
  const [low, high] = [Math.min(...values, 0), Math.max(...values)];
  const [from, to] = [points[0].at, points[points.length - 1].at];
  const place = (/** @type {Point} */ { at, value }) => {
    const x = ((at - from) / (to - from || 1)) * (WIDTH - 4) + 2;
    const y = HEIGHT - 2 - ((value - low) / (high - low || 1)) * (HEIGHT - 4);
    return `${x.toFixed(1)} ${y.toFixed(1)}`;
  };
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', `0 0 ${WIDTH} ${HEIGHT}`);
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', `M${points.map(place).join('L')}`);
  svg.append(path);
  return svg;
}

export class Sensitivity {
  /** @type {Api.Design | null} */ #design = null;
  #timer = 0;
  #asked = '';
  #drawn = '';
  /** @type {Point[][]} */ #strip = [];

  /** @param {import('../base/store.js').DesignStore} store */
  constructor(store) {
    this.store = store;
    this.small = new Series();
    this.large = new Series();
    this.cells = STRIP.map(() => h('span.sensitivity-cell'));
    this.strip = h(
      '.sensitivity',
      { role: 'group', 'aria-label': 'Sensitivity of the transmission error' },
      h('span.sensitivity-title', null, 'Transmission error with'),
      this.cells,
      h(
        'button.link',
        { type: 'button', onclick: () => this.chart.element.scrollIntoView({ block: 'center' }) },
        'more',
      ),
    );
    const keys = h(
      'select.small-select',
      {
        'aria-label': 'Number that is varied',
        onchange: () => store.setView('vary', keys.value === keyIn(IN_PLANE) ? '' : keys.value),
      },
      KEYS.map(pointer =>
        h('option', { value: keyIn(pointer), selected: pointer === this.#key }, labelOf(keyIn(pointer))),
      ),
    );
    const measures = h(
      'select.small-select',
      {
        'aria-label': 'What is shown',
        onchange: () => store.setView('shows', measures.value === MEASURES[0][0] ? '' : measures.value),
      },
      MEASURES.map(([key, name]) => h('option', { value: key, selected: key === this.#measure }, name)),
    );
    this.chart = new Chart({
      title: 'Sensitivity',
      name: 'Sensitivity of the design to one number',
      help:
        'One number of the design varied, all others as they are, at the load case with the largest share; the ' +
        'unmodified pair for comparison.',
      good:
        'Flat and below the unmodified pair over the whole range that your shafts, housing and grinding machine ' +
        'bring.',
      xLabel: 'value',
      zero: true,
      wide: true,
      controls: [measures, h('span.unit', null, ' over '), keys],
    });
    this.#drawStrip(STRIP.map(() => []));
    units.addEventListener('change', () => this.#drawStrip(this.#strip));
    store.addEventListener('change', event => {
      if (/** @type {CustomEvent} */ (event).detail !== 'view') return;
      keys.value = keyIn(this.#key);
      measures.value = this.#measure;
      this.#later();
    });
  }

  /** The number that is varied. */
  get #key() {
    return KEYS.find(pointer => keyIn(pointer) === this.store.view.get('vary')) ?? IN_PLANE;
  }

  get #measure() {
    return (MEASURES.find(([key]) => key === this.store.view.get('shows')) ?? MEASURES[0])[0];
  }

  /** @param {Api.Design} design */
  set(design) {
    this.#design = design;
    this.#later();
  }

  /** Nothing more is to come for the design of now. */
  get settled() {
    return this.#design !== null && this.#asked === this.#question() && this.#drawn === this.#asked;
  }

  /** At once. */
  now() {
    clearTimeout(this.#timer);
    this.#ask();
  }

  /** What the curves depend on. */
  #question() {
    const { gear_pair, modification, alignment, load_cases, supports, shafts, resolution } = this.#design ?? {};
    const parts = [gear_pair, modification, alignment, load_cases, supports, shafts, resolution];
    return JSON.stringify([...parts, this.#key, this.#measure]);
  }

  #later() {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#ask(), REST);
  }

  #ask() {
    const design = this.#design;
    if (!design?.gear_pair) return;
    const text = this.#question();
    if (text === this.#asked) return;
    this.#asked = text;
    const k = mainCase(design);
    /** @type {Point[][]} */
    const rows = STRIP.map(() => []);
    const single = { ...design, load_cases: [design.load_cases[k]] };
    const lists = STRIP.map(({ designs }) => designs(single));
    const flat = lists.flatMap((list, i) => list.map(each => ({ at: i * 1e6 + each.at, design: each.design })));
    this.small.ask(flat, found => {
      for (const { at, result } of found) {
        const i = Math.round(at / 1e6);
        const { peak_to_peak_um: value } = numbersOf(result, 0);
        if (typeof value === 'number') rows[i].push({ at: at - i * 1e6, value });
      }
      this.#drawStrip(rows);
      this.#askLarge(single);
    });
  }

  /** @param {Point[][]} rows */
  #drawStrip(rows) {
    this.#strip = rows;
    rows.forEach((points, i) => {
      const { name, unit } = STRIP[i];
      const values = points.map(point => shownValue(point.value, 'µm'));
      const range = `${sig(Math.min(...values), 2)} … ${sig(Math.max(...values), 2)} ${shownUnit('µm')}`;
      const ends = [points[0], points[points.length - 1]].map(
        point => point && tickText(Number(point.at.toPrecision(3))),
      );
      const nothing = name === 'relief' && this.#design && withRelief(this.#design, 2) === this.#design;
      fill(
        this.cells[i],
        h('span.sensitivity-name', null, points.length ? `${name} ${ends.join(' … ')} ${unit}` : name),
        points.length && !nothing ? pictureOf(points) : h('span.sensitivity-blank'),
        h('b', null, nothing ? 'no relief yet' : points.length ? range : '–'),
      );
    });
  }

  /**
   * A range round the value: its fault on both sides for angles, half and twice for amounts.
   * @param {Api.Design} design
   */
  #range(design) {
    const value = numberAt(design, this.#key);
    if (this.#key.startsWith('/alignment/shaft')) return [Math.min(-0.1, value), Math.max(0.1, value)];
    return value > 0 ? [0, 2 * value] : [0, /_mm$/.test(this.#key) ? 2 : /ratio|stagger/.test(this.#key) ? 0.5 : 20];
  }

  /** @param {Api.Design} design with one load case */
  #askLarge(design) {
    const [low, high] = this.#range(design);
    const both = [this.#key, this.#key.replace('/left/', '/right/')];
    const values = Array.from({ length: STEPS }, (_, i) => low + ((high - low) * i) / (STEPS - 1));
    /** @param {Api.Design} base */
    const varied = base =>
      values.map(at => ({ at, design: both.reduce((each, pointer) => withValue(each, pointer, at), base) }));
    const flank = this.#key.startsWith('/modification');
    const plainPair = flank ? [{ at: NaN, design: unmodified(design) }] : varied(unmodified(design));
    this.large.ask([...varied(design), ...plainPair], found => {
      const own = found.filter((_, i) => i < STEPS);
      const before = found.slice(own.length);
      this.#drawLarge(own, before, flank);
    });
  }

  /**
   * @param {{ at: number, result: Page.Result }[]} own @param {{ at: number, result: Page.Result }[]} before
   * @param {boolean} flank
   */
  #drawLarge(own, before, flank) {
    const measure = MEASURES.find(([key]) => key === this.#measure) ?? MEASURES[0];
    const key = this.#key.split('/').pop() ?? '';
    const unit = unitText(/_(um|mm|deg)$/.exec(key)?.[1]);
    const x = own.map(each => each.at);
    /** @param {Page.Result} result */
    const read = result => numbersOf(result, 0)[measure[0]] ?? null;
    /** @type {import('./chart.js').Curve[]} */
    const curves = [];
    if (before.length)
      curves.push({
        label: 'unmodified',
        x: flank ? x : before.map(each => each.at),
        y: flank ? x.map(() => read(before[0].result)) : before.map(each => read(each.result)),
        colour: REFERENCE_COLOUR,
        line: 'dashed',
      });
    curves.push({ label: 'this design', y: own.map(each => read(each.result)), colour: OWN_COLOUR });
    this.chart.name({ xLabel: labelOf(key), xUnit: unit, unit: measure[2] }, measure[1]);
    this.#drawn = this.#asked;
    if (!this.#design) return;
    this.chart.set({ x, curves, marks: [{ x: numberAt(this.#design, this.#key), label: 'now', strong: true }] });
  }
}
