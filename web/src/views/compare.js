// SPDX-License-Identifier: GPL-3.0-or-later
// The Compare view: designs, stored designs and optima side by side: one table, curves over one another.
import { get, list } from '../base/api.js';
import { fill, h } from '../base/dom.js';
import { choiceText } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { documentOf, unmodified } from '../base/store.js';
import { switcher } from '../base/switcher.js';
import { units } from '../base/units.js';
import { Chart } from '../figures/chart.js';
import { caseLong, counting, faceOf, lessMean, mainCase, sameCase } from '../figures/context.js';
import { designColour, drawComparison } from './compare_table.js';

/**
 * @typedef {{ key: string, label: string, title?: string, group: string,
 *   load: () => Promise<Api.Design | null | undefined> }} Candidate
 */
/** @typedef {import('./compare_table.js').Item} Item */
/** @typedef {Item & { result: Page.Result }} Solved */
/** @typedef {{ row: Api.Design['load_cases'][number], k: number }} Chosen load case of the design on the table */
/** @typedef {Page.Curve | null | undefined} Values */

const LIVE = ['current', 'unmodified', 'pin']; // change with the design on the table
const ORDERS = { te: 8, vibration: 12 };

/** One result at a time for any number of designs; kept as long as the page. */
class Results {
  /** @type {Map<string, Page.Result | Error>} */ #results = new Map();
  /** @type {{ key: string, body: Api.Design }[]} */ #queue = [];
  #busy = '';

  /** @param {() => void} tell */
  constructor(tell) {
    /** @type {Lane<Page.Result>} */
    this.lane = new Lane({
      result: (_task, data) => this.#done(data, tell),
      refused: (_task, error) => this.#done(error, tell),
    });
  }

  /** The result, or why there is none, once it is known. @param {Api.Design} design */
  result(design) {
    const key = JSON.stringify(design);
    const known = this.#results.get(key);
    if (known) return known;
    if (this.#busy !== key && !this.#queue.some(each => each.key === key)) this.#queue.push({ key, body: design });
    this.#next();
    return null;
  }

  #next() {
    const first = this.#busy === '' ? this.#queue.shift() : undefined;
    if (!first) return;
    this.#busy = first.key;
    this.lane.submit({ path: 'analyze?histories=1&maps=0&rating=0&pitch=0', body: first.body });
  }

  /** @param {Page.Result | Error} data @param {() => void} tell */
  #done(data, tell) {
    this.#results.set(this.#busy, data);
    this.#busy = '';
    this.#next();
    tell();
  }
}

/** Curves of the chosen designs over one another, of one end. */
class CompareCurves {
  #end = /** @type {Page.End} */ ('left');
  /** @type {[Solved[], Chosen] | null} */ #last = null;

  constructor() {
    /** @param {string} title @param {string} unit @param {string} xLabel @param {object} [more] */
    const chart = (title, unit, xLabel, more = {}) => new Chart({ title, unit, xLabel, ...more });
    this.lte = chart('Loaded TE', 'µm', 'mesh cycle', { cycle: true, name: 'Loaded transmission error' });
    this.orders = chart('Orders of the loaded TE', 'µm', 'mesh order', { bars: true });
    this.stiffness = chart('Mesh stiffness', 'N/µm', 'mesh cycle', { cycle: true });
    this.vibration = chart('Vibration', 'm/s²', 'mesh cycle', { cycle: true });
    this.vibrationOrders = chart('Orders of the vibration', 'm/s²', 'mesh order', { bars: true });
    this.root = chart('Root stress of the pinion', 'MPa', 'mesh cycles');
    this.profile = chart('Profile modification of the pinion', 'µm', 'from the pitch point to the tip', {
      xUnit: 'mm',
    });
    this.lead = chart('Lead modification of the pinion', 'µm', 'from mid face', { xUnit: 'mm' });
    this.charts = [
      this.lte,
      this.orders,
      this.vibration,
      this.vibrationOrders,
      this.stiffness,
      this.root,
      this.profile,
      this.lead,
    ];
    this.ends = h(
      '.compare-ends',
      null,
      'curves of one end: ',
      switcher(
        'End',
        [
          ['left', 'left'],
          ['right', 'right'],
        ],
        'left',
        value => {
          this.#end = value;
          if (this.#last) this.draw(...this.#last);
        },
      ),
    );
  }

  /** @param {Solved[]} items @param {Chosen} chosen */
  draw(items, chosen) {
    this.#last = [items, chosen];
    if (!items.length) return;
    const end = this.#end;
    const { row, k } = chosen;
    const cases = items.map(item => sameCase(item.result, row, k) ?? item.result.load_cases[0]);
    /**
     * @param {(loadCase: Page.LoadCase, result: Page.Result) => Values} y
     * @param {(loadCase: Page.LoadCase, result: Page.Result) => number[] | null | undefined} [x]
     */
    const curves = (y, x) =>
      items.flatMap((item, i) => {
        const values = y(cases[i], item.result);
        const places = x?.(cases[i], item.result) ?? undefined;
        return values ? [{ label: item.label, colour: designColour(i), y: values, x: places }] : [];
      });
    /**
     * @param {Chart} chart @param {number[] | null | undefined} x @param {ReturnType<typeof curves>} drawn
     * @param {string} about
     */
    const put = (chart, x, drawn, about) => {
      chart.frame.setCase(about);
      if (x) chart.set({ x, curves: drawn });
    };
    const text = caseLong(row);
    const one = `${text}, ${end} end`;
    const first = cases[0];
    put(
      this.lte,
      first.position,
      curves(
        c => lessMean(c.lte.pair_um),
        c => c.position,
      ),
      text,
    );
    put(
      this.orders,
      counting(ORDERS.te, 1),
      curves(c => c.lte.orders_um?.slice(1, ORDERS.te + 1)),
      text,
    );
    put(
      this.stiffness,
      first.position,
      curves(
        c => c.mesh_stiffness[/** @type {const} */ (`tangent_${end}_N_per_um`)],
        c => c.position,
      ),
      one,
    );
    put(
      this.vibration,
      first.vibration?.position,
      curves(
        c => c.vibration?.[end]?.history?.normal_m_per_s2,
        c => c.vibration?.position,
      ),
      one,
    );
    put(
      this.vibrationOrders,
      counting(ORDERS.vibration, 1),
      curves(c => c.vibration?.orders_normal_m_per_s2?.slice(1, ORDERS.vibration + 1)),
      text,
    );
    put(
      this.root,
      first.root_stress?.pinion?.position,
      curves(
        c => c.root_stress?.pinion?.[end]?.history_MPa,
        c => c.root_stress?.pinion?.position,
      ),
      one,
    );
    const { modification } = items[0].result;
    put(
      this.profile,
      modification?.pinion.u_mm,
      curves(
        (_c, result) => result.modification?.pinion[end]?.profile_um,
        (_c, result) => result.modification?.pinion.u_mm,
      ),
      `${end} end`,
    );
    put(
      this.lead,
      modification && faceOf(modification, end),
      curves(
        (_c, result) => result.modification?.pinion[end]?.lead_um,
        (_c, result) => result.modification && faceOf(result.modification, end),
      ),
      `${end} end`,
    );
  }
}

class CompareView {
  /** @type {Candidate[]} */ #candidates = [];
  /** @type {string[]} */ #items = ['unmodified', 'current'];
  /** @type {Map<string, Api.Design>} */ #designs = new Map();
  /** @type {Item[]} */ #chosen = [];
  #turn = 0;

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.results = new Results(() => this.#draw());
    this.curves = new CompareCurves();
    units.addEventListener('change', () => this.app.current === 'compare' && this.#draw());
    this.choice = h('.choices');
    this.table = h('.table-scroll', { tabindex: '0', role: 'region', 'aria-label': 'Comparison' });
    this.sameLoad = h('input', { type: 'checkbox', id: 'same-load', checked: true, onchange: () => this.#draw() });
    const flag = h(
      'label.field.flag',
      { for: 'same-load' },
      this.sameLoad,
      h('span', null, 'all under the load cases of this design'),
    );
    this.element = h(
      '.design-view.compare-view',
      null,
      h(
        'aside.form-pane',
        { 'aria-label': 'What to compare' },
        h('.form-scroll', null, this.choice),
        h('.form-foot', null, flag),
      ),
      h(
        '.figure-pane',
        null,
        this.table,
        h(
          'div',
          null,
          h('h2.unseen', null, 'Curves of the designs'),
          this.curves.ends,
          h(
            '.figures',
            null,
            this.curves.charts.map(chart => chart.element),
          ),
        ),
      ),
    );
  }

  /** @returns {Candidate[]} */
  #onTable() {
    const { store } = this.app;
    const group = 'On the table';
    return [
      { key: 'current', label: store.design.name || 'this design', group, load: async () => store.design },
      { key: 'unmodified', label: 'unmodified', group, load: async () => unmodified(store.design) },
      ...(store.pin ? [{ key: 'pin', label: store.pin.label, group, load: async () => store.pin?.design }] : []),
    ];
  }

  /** @returns {Candidate[]} */
  #optima() {
    const { jobs } = this.app;
    return jobs
      .searches()
      .filter(job => job.best)
      .map(job => ({
        key: `job:${job.id}`,
        label: `${job.name || 'unnamed'}, best of search ${job.id}`,
        title: choiceText(job.algorithm ?? ''),
        group: 'Searches',
        load: async () => {
          const { design } = await get(`jobs/${job.id}`);
          const best = jobs.all.get(job.id)?.best?.modification ?? job.best?.modification;
          const result = best ? null : await get(`jobs/${job.id}/result`);
          const modification = best ?? (result && 'best' in result ? result.best?.modification : null);
          return design && modification ? documentOf({ ...design, modification }) : null;
        },
      }));
  }

  async #gather() {
    const { library, examples } = this.app;
    const kept = (await list('designs').catch(() => [])).map(design => ({
      key: `design:${design.id}`,
      label: design.name || 'unnamed',
      group: 'Stored',
      load: async () => (await get(`designs/${design.id}`)).design,
    }));
    this.#candidates = [
      ...this.#onTable(),
      ...this.#optima(),
      ...kept,
      ...examples.map(({ name }) => ({
        key: `example:${name}`,
        label: name,
        group: 'Examples',
        load: () => library.example(name),
      })),
    ];
    this.#drawChoice();
    await this.#draw();
  }

  #drawChoice() {
    const groups = [...new Set(this.#candidates.map(candidate => candidate.group))];
    /** @param {Candidate} candidate */
    const entry = candidate => {
      const input = h('input', {
        type: 'checkbox',
        checked: this.#items.includes(candidate.key),
        onchange: () => this.#toggle(candidate.key, input.checked),
      });
      return h('label.choice', { title: candidate.title ?? null }, input, h('span', null, candidate.label));
    };
    fill(
      this.choice,
      groups.map(name =>
        h(
          'fieldset.choice-group',
          null,
          h('legend', null, name),
          this.#candidates.filter(candidate => candidate.group === name).map(entry),
        ),
      ),
    );
  }

  /** @param {string} key @param {boolean} on */
  #toggle(key, on) {
    const items = on ? [...this.#items, key] : this.#items.filter(item => item !== key);
    this.app.go('compare', { items: items.join(',') });
  }

  /** Every chosen design with its result, or null while it is computed. @returns {Promise<Item[]>} */
  async #collect() {
    const { store } = this.app;
    const found = await Promise.all(
      this.#items.map(async key => {
        const candidate = this.#candidates.find(each => each.key === key);
        if (!candidate) return this.#missing(key);
        const known = LIVE.includes(key) ? null : this.#designs.get(key);
        const design = known ?? (await candidate.load().catch(() => null));
        if (!design) return this.#missing(key);
        this.#designs.set(key, design);
        const loaded = this.sameLoad.checked ? { ...design, load_cases: store.design.load_cases } : design;
        const answer = this.results.result(loaded);
        if (answer instanceof Error) return { ...candidate, design: loaded, result: null, missing: answer.message };
        return { ...candidate, design: loaded, result: answer };
      }),
    );
    return found.filter(item => item !== null);
  }

  /** What an address asks for and the server has not. @param {string} key @returns {Item | null} */
  #missing(key) {
    if (key === 'pin' || !this.app.jobs.known) return null;
    const [kind, id] = key.split(':');
    const label = kind === 'job' ? `search ${id}` : kind === 'design' ? `stored design ${id}` : (id ?? key);
    return { key, label, design: null, result: null, missing: 'is not on this server' };
  }

  async #draw() {
    const now = ++this.#turn;
    const items = await this.#collect();
    if (now !== this.#turn) return;
    this.#chosen = items;
    const { store } = this.app;
    const cases = store.design.load_cases ?? [];
    drawComparison(this.table, items, cases);
    const k = store.loadCase >= 0 && store.loadCase < cases.length ? store.loadCase : mainCase(store.design);
    this.curves.draw(
      items.filter(/** @returns {item is Solved} */ item => item.result !== null),
      { row: cases[k], k },
    );
  }

  /** @param {URLSearchParams} parameters */
  show(parameters) {
    const wanted = parameters.get('items');
    if (wanted !== null) this.#items = wanted.split(',').filter(Boolean);
    this.#gather();
  }

  /** @returns {import('../report.js').Parts | null} */
  report() {
    const { store, analyst } = this.app;
    const waiting = this.#chosen.filter(item => !item.result && !item.missing).map(item => item.label);
    return {
      title: `Comparison with ${store.design.name || 'this design'}`,
      result: analyst.result,
      lead: [/** @type {HTMLElement} */ (this.table.cloneNode(true))],
      figures: this.curves.charts.map(chart => chart.frame),
      missing: waiting,
    };
  }
}

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function compareView(app) {
  return new CompareView(app);
}
