// SPDX-License-Identifier: GPL-3.0-or-later
// The Compare view: designs, stored designs and optima side by side: one table, curves over one another.
import { get, list } from '../base/api.js';
import { fill, h } from '../base/dom.js';
import { change, changeText, choiceText, labelOf, plain, sig, unitText } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { valueAt } from '../base/pointer.js';
import { complete } from '../base/schema.js';
import { unmodified } from '../base/store.js';
import { Chart } from '../figures/chart.js';
import { caseText, counting, mainCase, sameCase } from '../figures/context.js';
import { NUMBERS, numbersOf } from '../headline.js';
import { reportData, reportHead } from '../report.js';

/** @typedef {{ key: string, label: string, title?: string, group: string, load: () => Promise<any> }} Candidate */

const DATA = [
  '/gear_pair/pinion_teeth',
  '/gear_pair/gear_teeth',
  '/gear_pair/normal_module_mm',
  '/gear_pair/helix_angle_deg',
  '/gear_pair/face_width_mm',
  '/gear_pair/centre_distance_mm',
  '/alignment/shaft_angle_error_in_plane_deg',
];
const FLANK = [
  'tip_relief_um',
  'tip_relief_start_mm',
  'root_relief_um',
  'root_relief_start_mm',
  'lead_crowning_um',
  'lead_slope_um',
  'profile_crowning_per_mm',
];

/** One result at a time for any number of designs; kept as long as the page. */
class Library {
  /** @type {Map<string, any>} */ #results = new Map();
  /** @type {{ key: string, body: any }[]} */ #queue = [];
  #busy = '';

  /** @param {() => void} tell */
  constructor(tell) {
    this.lane = new Lane({
      result: (_task, data) => this.#done(data, tell),
      refused: (_task, error) => this.#done({ error: error.message }, tell),
    });
  }

  /** The result, once it is there. @param {any} design */
  result(design) {
    const key = JSON.stringify(design);
    if (this.#results.has(key)) return this.#results.get(key);
    if (this.#busy !== key && !this.#queue.some(each => each.key === key)) this.#queue.push({ key, body: design });
    this.#next();
    return null;
  }

  #next() {
    const first = this.#busy === '' ? this.#queue.shift() : undefined;
    if (!first) return;
    this.#busy = first.key;
    this.lane.submit({ path: 'analyze?histories=1&maps=0', body: first.body });
  }

  /** @param {any} data @param {() => void} tell */
  #done(data, tell) {
    this.#results.set(this.#busy, data);
    this.#busy = '';
    this.#next();
    tell();
  }
}

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function compareView(app) {
  const { store, jobs, fields } = app;
  /** @type {Candidate[]} */ let candidates = [];
  /** @type {string[]} */ let items = ['unmodified', 'current'];
  /** @type {Map<string, any>} */ const designs = new Map();
  let sameLoad = true;
  const library = new Library(() => draw());
  const chart = (/** @type {string} */ title, /** @type {string} */ unit, /** @type {string} */ xLabel, more = {}) =>
    new Chart({ title, unit, xLabel, ...more });
  const charts = {
    lte: chart('Loaded TE', 'µm', 'mesh cycle', { cycle: true }),
    orders: chart('Orders of the loaded TE', 'µm', 'mesh order', { bars: true }),
    stiffness: chart('Mesh stiffness, left end', 'N/µm', 'mesh cycle', { cycle: true }),
    vibration: chart('Vibration, left end', 'm/s²', 'mesh cycle', { cycle: true }),
    vibrationOrders: chart('Orders of the vibration', 'm/s²', 'mesh order', { bars: true }),
    root: chart('Root stress, pinion left', 'MPa', 'mesh cycles'),
    profile: chart('Profile modification, pinion left', 'µm', 'from the pitch point to the tip', { xUnit: 'mm' }),
    lead: chart('Lead modification, pinion left', 'µm', 'from mid face', { xUnit: 'mm' }),
  };
  const choice = h('.choices');
  const table = h('.table-scroll');
  const top = h('.report');
  const end = h('.report');
  const load = h('input', {
    type: 'checkbox',
    id: 'same-load',
    checked: true,
    onchange: () => {
      sameLoad = load.checked;
      draw();
    },
  });
  const element = h(
    '.design-view.compare-view',
    null,
    top,
    h(
      'aside.form-pane',
      { 'aria-label': 'What to compare' },
      h('.form-scroll', null, choice),
      h(
        '.form-foot',
        null,
        h('label.field.flag', { for: 'same-load' }, load, h('span', null, 'all under the load cases of this design')),
      ),
    ),
    h(
      '.figure-pane',
      null,
      table,
      h(
        '.figures',
        null,
        Object.values(charts).map(each => each.element),
      ),
      end,
    ),
  );

  const gather = async () => {
    /** @param {string} path */
    const stored = async path => complete(fields, (await get(path)).design);
    const own = [
      {
        key: 'current',
        label: store.design.name || 'this design',
        group: 'On the table',
        load: async () => store.design,
      },
      { key: 'unmodified', label: 'unmodified', group: 'On the table', load: async () => unmodified(store.design) },
      ...(store.pin
        ? [{ key: 'pin', label: store.pin.label, group: 'On the table', load: async () => store.pin?.design }]
        : []),
    ];
    const optima = jobs
      .searches()
      .filter(job => job.best)
      .map(job => ({
        key: `job:${job.id}`,
        label: `best of search ${job.id}`,
        title: `${job.name || 'unnamed'}, ${choiceText(job.algorithm ?? '')}`,
        group: 'Searches',
        load: async () => ({
          ...(await get(`jobs/${job.id}`)).design,
          modification: jobs.all.get(job.id)?.best?.modification ?? job.best.modification,
        }),
      }));
    const kept = (await list('designs').catch(() => [])).map(design => ({
      key: `design:${design.id}`,
      label: design.name || 'unnamed',
      group: 'Stored',
      load: () => stored(`designs/${design.id}`),
    }));
    const examples = app.examples.map(({ name }) => ({
      key: `example:${name}`,
      label: name,
      group: 'Examples',
      load: async () => complete(fields, await get(`examples/${name}`)),
    }));
    candidates = [...own, ...optima, ...kept, ...examples];
    drawChoice();
    await draw();
  };

  const drawChoice = () => {
    const groups = [...new Set(candidates.map(candidate => candidate.group))];
    fill(
      choice,
      groups.map(name =>
        h(
          'fieldset.choice-group',
          null,
          h('legend', null, name),
          candidates
            .filter(candidate => candidate.group === name)
            .map(candidate => {
              const input = h('input', {
                type: 'checkbox',
                checked: items.includes(candidate.key),
                onchange: () => toggle(candidate.key, input.checked),
              });
              return h('label.choice', { title: candidate.title ?? null }, input, h('span', null, candidate.label));
            }),
        ),
      ),
    );
  };
  /** @param {string} key @param {boolean} on */
  const toggle = (key, on) => {
    items = on ? [...items, key] : items.filter(item => item !== key);
    app.go('compare', { items: items.join(',') });
  };

  /** Every chosen design with its result, or null while it is computed. */
  const chosen = async () => {
    const found = [];
    for (const key of items) {
      const candidate = candidates.find(each => each.key === key);
      if (!candidate) continue;
      const live = key === 'current' || key === 'unmodified' || key === 'pin';
      let design = live ? await candidate.load() : designs.get(key);
      if (!design) {
        design = await candidate.load().catch(() => null);
        if (!design) continue;
        designs.set(key, design);
      }
      found.push({ ...candidate, design: sameLoad ? { ...design, load_cases: store.design.load_cases } : design });
    }
    return found.map(item => ({ ...item, result: library.result(item.design) }));
  };

  let turn = 0;
  const draw = async () => {
    const now = ++turn;
    const all = await chosen();
    if (now !== turn) return;
    drawTable(all);
    drawCurves(all.filter(item => item.result && !item.result.error));
  };

  /** @param {any[]} all */
  const drawTable = all => {
    const first = all[0]?.result;
    const colours = all.map((_, i) => {
      const mark = h('span.dot');
      mark.style.setProperty('--swatch', `var(--c${(i % 8) + 1})`);
      return mark;
    });
    const head = h(
      'tr',
      null,
      h('td'),
      all.map((item, i) =>
        h(
          'th',
          { scope: 'col' },
          colours[i],
          ` ${item.label}`,
          item.result?.error
            ? h('span.fault', null, ` ${item.result.error}`)
            : item.result
              ? null
              : h('span.unit', null, ' …'),
        ),
      ),
    );
    const body = [];
    const value = (
      /** @type {any} */ item,
      /** @type {number | null | undefined} */ own,
      /** @type {number | null | undefined} */ base,
      digits = 3,
    ) =>
      h(
        'td.number',
        null,
        item.result ? sig(own, digits) : '…',
        base !== undefined && item.result !== first ? h('small', null, ` ${changeText(change(own, base))}`) : null,
      );
    body.push(
      h(
        'tr',
        null,
        h('th', { scope: 'row' }, 'J'),
        all.map(item => value(item, item.result?.objectives?.J, first?.objectives?.J)),
      ),
    );
    for (const [k, row] of (store.design.load_cases ?? []).entries()) {
      body.push(
        h(
          'tr.section',
          null,
          h('th', { scope: 'rowgroup', colspan: all.length + 1 }, `${caseText(row)} at ${row.speed_rpm} rpm`),
        ),
      );
      for (const { key, label, unit, scale = 1 } of NUMBERS) {
        const base = numbersOf(first, k)[key];
        body.push(
          h(
            'tr',
            null,
            h('th', { scope: 'row' }, label, h('span.unit', null, ` ${unit}`)),
            all.map(item => {
              const own = numbersOf(item.result, k)[key];
              return value(
                item,
                typeof own === 'number' ? own * scale : null,
                typeof base === 'number' ? base * scale : null,
              );
            }),
          ),
        );
      }
    }
    body.push(
      h(
        'tr.section',
        null,
        h('th', { scope: 'rowgroup', colspan: all.length + 1 }, 'Modification of the pinion, left / right'),
      ),
    );
    for (const key of FLANK) {
      /** @param {any} item */
      const ends = item =>
        ['left', 'right'].map(
          side => valueAt(item.result?.design ?? item.design, `/modification/pinion/${side}/${key}`) ?? 0,
        );
      if (all.every(item => ends(item).every(each => each === 0))) continue;
      const unit = /_(um|mm|per_mm)$/.exec(key)?.[1] ?? '';
      body.push(
        h(
          'tr',
          null,
          h('th', { scope: 'row' }, labelOf(key), h('span.unit', null, ` ${unitText(unit)}`)),
          all.map(item => {
            const [left, right] = ends(item);
            return h('td.number', null, left === right ? sig(left, 4) : `${sig(left, 4)} / ${sig(right, 4)}`);
          }),
        ),
      );
    }
    body.push(h('tr.section', null, h('th', { scope: 'rowgroup', colspan: all.length + 1 }, 'Pair')));
    for (const pointer of DATA) {
      const key = pointer.split('/')[2];
      const unit = /_(mm|deg)$/.exec(key)?.[1];
      body.push(
        h(
          'tr',
          null,
          h('th', { scope: 'row' }, labelOf(key), unit ? h('span.unit', null, ` ${unitText(unit)}`) : null),
          all.map(item => h('td.number', null, plain(valueAt(item.result?.design ?? item.design, pointer)))),
        ),
      );
    }
    fill(
      table,
      all.length
        ? h('table.numbers.comparison', null, h('thead', null, head), h('tbody', null, body))
        : h('p.empty', null, 'Choose at least one design.'),
    );
  };

  /** @param {any[]} all */
  const drawCurves = all => {
    if (!all.length) return;
    const own = store.design.load_cases ?? [];
    const k = store.loadCase >= 0 && store.loadCase < own.length ? store.loadCase : mainCase(store.design);
    const cases = all.map(item => sameCase(item.result, own[k], k) ?? item.result.load_cases[0]);
    /** @param {(loadCase: any, result: any) => any} y @param {(loadCase: any, result: any) => any} [x] */
    const curves = (y, x) =>
      all
        .map((item, i) => ({
          label: item.label,
          colour: `c${(i % 8) + 1}`,
          y: y(cases[i], item.result),
          x: x?.(cases[i], item.result),
        }))
        .filter(curve => curve.y);
    /** @param {number[]} values */
    const less = values => values.map(each => each - values.reduce((sum, other) => sum + other, 0) / values.length);
    charts.lte.set({
      x: cases[0].position,
      curves: curves(
        c => less(c.lte.pair_um),
        c => c.position,
      ),
    });
    charts.orders.set({ x: counting(8, 1), curves: curves(c => c.lte.orders_um.slice(1, 9)) });
    charts.stiffness.set({
      x: cases[0].position,
      curves: curves(
        c => c.mesh_stiffness.tangent_left_N_per_um,
        c => c.position,
      ),
    });
    if (cases[0].vibration?.position)
      charts.vibration.set({
        x: cases[0].vibration.position,
        curves: curves(
          c => c.vibration?.left?.history?.normal_m_per_s2,
          c => c.vibration?.position,
        ),
      });
    charts.vibrationOrders.set({
      x: counting(12, 1),
      curves: curves(c => c.vibration?.orders_normal_m_per_s2?.slice(1, 13)),
    });
    if (cases[0].root_stress?.pinion?.position)
      charts.root.set({
        x: cases[0].root_stress.pinion.position,
        curves: curves(
          c => c.root_stress?.pinion?.left?.history_MPa,
          c => c.root_stress?.pinion?.position,
        ),
      });
    const { modification } = all[0].result;
    charts.profile.set({
      x: modification.pinion.u_mm,
      curves: curves(
        (_c, result) => result.modification.pinion.left?.profile_um,
        (_c, result) => result.modification.pinion.u_mm,
      ),
    });
    charts.lead.set({
      x: modification.eta_mm,
      curves: curves(
        (_c, result) => result.modification.pinion.left?.lead_um,
        (_c, result) => result.modification.eta_mm,
      ),
    });
  };

  return {
    element,
    show(parameters) {
      const wanted = parameters.get('items');
      if (wanted !== null) items = wanted.split(',').filter(Boolean);
      gather();
    },
    print() {
      const result = app.analyst.result;
      fill(top, reportHead(`Comparison with ${store.design.name || 'this design'}`, result));
      if (result) fill(end, reportData(fields, result));
    },
  };
}
