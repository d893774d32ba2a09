// SPDX-License-Identifier: GPL-3.0-or-later
// The Optimize view: what is searched for and how; the searches; what the chosen one has found so far.
import { Refusal, ask, get, list, post, token } from '../base/api.js';
import { fill, h } from '../base/dom.js';
import { change, changeText, choiceText, dateText, duration, labelOf, sig, unitText } from '../base/format.js';
import { ACTIVE } from '../base/jobs.js';
import { complete, fieldAt } from '../base/schema.js';
import { Chart } from '../figures/chart.js';
import { Parallel, Scatter } from '../figures/scatter.js';
import { group } from '../form.js';
import { progressBar, progressText } from '../jobbar.js';

const FIRST = ['algorithm', 'variables', 'true_evaluations', 'seed'];
const ALGORITHMS = ['ga', 'fpga', 'credibility-ga', 'nsga2'];
const PAUSE = 700; // ms between two looks at a running search
const OBJECTIVES = /** @type {[string, string, string, number][]} */ ([
  ['J', 'J', '', 1],
  ['f1_um', 'TE, f1', 'µm', 1],
  ['f2_N', 'Impact, f2', 'kN', 1e-3],
  ['f3_m_per_s2', 'Vibration, f3', 'm/s²', 1],
]);

/** Algorithms that a key is for, from the end of its help; none: all. @param {string} help */
function algorithmsOf(help) {
  const words = /\(([^()]*)\)$/.exec(help)?.[1].split(/,\s*/) ?? [];
  return words.every(word => ALGORITHMS.includes(word)) ? words : [];
}

/** The form. @param {import('../app.js').App} app @param {() => void} submit */
function searchForm(app, submit) {
  const { form, store } = app;
  const details = h('div');
  const listed = h('.listed');
  let shape = '';
  const draw = () => {
    const { algorithm, variables, variable_list: rows = [] } = store.design.optimization ?? {};
    const now = JSON.stringify([algorithm, variables, rows.length]);
    if (now === shape) return;
    shape = now;
    const fields = fieldAt(form.fields, '/optimization')?.fields ?? [];
    const skip = fields
      .filter(
        field =>
          FIRST.includes(field.key) ||
          field.kind === 'object' ||
          (algorithmsOf(field.help ?? '').length > 0 && !algorithmsOf(field.help ?? '').includes(algorithm)),
      )
      .map(field => field.key);
    fill(details, form.fieldsOf('/optimization', { skip }));
    const remove = (/** @type {number} */ i) =>
      store.set(
        '/optimization/variable_list',
        rows.filter((/** @type {any} */ _row, /** @type {number} */ k) => k !== i),
      );
    fill(
      listed,
      variables === 'listed'
        ? [
            rows.map((/** @type {any} */ _row, /** @type {number} */ i) =>
              h(
                'fieldset.listed-row',
                null,
                h(
                  'legend',
                  null,
                  `Variable ${i + 1} `,
                  h(
                    'button.icon',
                    { type: 'button', 'aria-label': `Remove variable ${i + 1}`, onclick: () => remove(i) },
                    '✕',
                  ),
                ),
                ['member', 'end', 'parameter', 'bounds'].map(key =>
                  form.field(`/optimization/variable_list/${i}/${key}`),
                ),
              ),
            ),
            h(
              'button.small',
              {
                type: 'button',
                onclick: () =>
                  store.set('/optimization/variable_list', [
                    ...rows,
                    { member: 'pinion', end: 'both', parameter: 'tip_relief_um', bounds: null },
                  ]),
              },
              '+ variable',
            ),
          ]
        : null,
    );
    form.refresh();
  };
  store.addEventListener('change', draw);
  const element = h(
    'form.parameters',
    {
      'aria-label': 'Search',
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        submit();
      },
    },
    group(
      'search',
      'Search',
      true,
      [
        FIRST.map(key =>
          form.field(`/optimization/${key}`, { label: key === 'true_evaluations' ? 'Budget, evaluations' : undefined }),
        ),
        [listed],
      ].flat(),
    ),
    group('bounds', 'Bounds of the variables', true, form.fieldsOf('/optimization/bounds')),
    group('objective', 'Objective', true, form.fieldsOf('/objective', { skip: ['constraints'] })),
    group('constraints', 'Limits', false, form.fieldsOf('/objective/constraints')),
    group('algorithm', 'The algorithm in detail', false, [details]),
  );
  draw();
  return element;
}

/** Short names of the variables of a search's best or row. @param {string} name "pinion/both/tip_relief_um" */
function shortName(name) {
  const parts = name.split('/');
  const key = parts[parts.length - 1];
  const end = parts.length === 3 && parts[1] !== 'both' ? ` ${parts[1]}` : '';
  return `${labelOf(key)}${end}`;
}

export class JobDetail {
  /** @type {any} */ #job = null;
  /** @type {any} */ #result = null;
  /** @type {any} */ #design = null;
  #timer = 0;
  #last = 0;
  #rows = 0;

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.head = h('.job-head');
    this.convergence = new Chart({
      title: 'Convergence',
      unit: 'J',
      help: 'Best and mean value of each generation',
      xLabel: 'generation',
    });
    this.pfc = new Chart({
      title: 'Fitness computed',
      unit: '%',
      help: 'PFC: true evaluations of all fitness values needed so far',
      xLabel: 'generation',
      zero: true,
    });
    this.best = h('section.figure.with-table', { 'aria-label': 'Best so far' });
    this.history = new Scatter({
      title: 'History',
      help: 'Every true evaluation of the search, open what an earlier one knew; click opens one',
      x: 'evaluation',
      y: 'J',
    });
    this.parallel = new Parallel('All variables');
    this.front = new Scatter({
      title: 'Pareto front',
      help: 'Designs that none is better than in every objective; click opens one',
      x: 'f1 (µm)',
      y: 'f3 (m/s²)',
    });
    this.element = h(
      '.job-detail',
      { hidden: true },
      this.head,
      h(
        '.figures',
        null,
        this.convergence.element,
        this.pfc.element,
        this.best,
        this.front.element,
        this.history.element,
        this.parallel.element,
      ),
    );
  }

  /** @param {any} job */
  async choose(job) {
    if (this.#job?.id !== job?.id) {
      this.#result = this.#design = null;
      this.#rows = 0;
      this.convergence.set({ x: [], curves: [] });
      this.pfc.set({ x: [], curves: [] });
      this.front.element.hidden = this.history.element.hidden = this.parallel.element.hidden = true;
    }
    const before = this.#job;
    this.#job = job;
    this.element.hidden = !job;
    if (!job) return;
    this.#drawHead();
    this.#drawBest();
    if (!this.#design)
      this.#design = get(`jobs/${job.id}`)
        .then(whole => whole.design)
        .catch(() => null);
    if (before?.id !== job.id || before.state !== job.state || performance.now() - this.#last > PAUSE) this.#look();
    else if (!this.#timer) this.#timer = window.setTimeout(() => this.#look(), PAUSE);
  }

  async #look() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    this.#last = performance.now();
    const job = this.#job;
    try {
      const columns = await get(`jobs/${job.id}/generations`);
      if (this.#job.id !== job.id) return;
      this.#drawGenerations(columns);
      if (job.state === 'done' && job.has_result !== false && !this.#result) {
        const result = await get(`jobs/${job.id}/result`);
        if (this.#job.id !== job.id) return;
        this.#result = result;
        this.#drawBest();
        this.#drawFront();
      }
      await this.#drawHistory(job);
    } catch {
      // the next event looks again
    }
  }

  /** @param {any} columns */
  #drawGenerations(columns) {
    if (!columns.generation?.length) return;
    const x = columns.generation.map((/** @type {number} */ value) => value + 1);
    const curves = [{ label: 'best', y: columns.best, colour: 'c1' }];
    if (columns.mean?.some((/** @type {any} */ value) => value !== null))
      curves.unshift({ label: 'mean', y: columns.mean, colour: 'c3' });
    this.convergence.set({ x, curves });
    this.pfc.set({ x, curves: [{ label: 'PFC', y: columns.pfc_percent, colour: 'c2' }] });
  }

  /** @param {any} job */
  async #drawHistory(job) {
    const rows = await list(`jobs/${job.id}/history`, 4000);
    if (this.#job.id !== job.id || rows.length === this.#rows) return;
    this.#rows = rows.length;
    const names = [...new Set(rows.flatMap(row => Object.keys(variablesOf(row))))];
    const columns = ['evaluation', ...names.map(shortName), 'f1 (µm)', 'f2 (kN)', 'f3 (m/s²)', 'J'];
    const best = rows.reduce(
      (least, row) => (typeof row.J === 'number' && (least === null || row.J < least.J) ? row : least),
      null,
    );
    const dots = rows.map((row, i) => {
      const values = variablesOf(row);
      return {
        kind: /** @type {'new' | 'known'} */ (row.reused ? 'known' : 'new'),
        mark: row === best ? 'best' : undefined,
        values: [
          row.ordinal ?? i + 1,
          ...names.map(name => values[name] ?? null),
          row.f1_um ?? null,
          typeof row.f2_N === 'number' ? row.f2_N / 1000 : null,
          row.f3_m_per_s2 ?? null,
          row.J ?? null,
        ],
        pick: () => this.#openValues(values),
      };
    });
    this.history.element.hidden = this.parallel.element.hidden = rows.length === 0;
    this.history.set({ columns, dots });
    const shown = [...names.map((_, k) => k + 1), columns.length - 1];
    this.parallel.set({
      columns: shown.map(k => columns[k]),
      dots: dots.map(dot => ({ ...dot, values: shown.map(k => dot.values[k]) })),
    });
  }

  #drawFront() {
    const front = this.#result?.front;
    this.front.element.hidden = !Array.isArray(front) || front.length === 0;
    if (this.front.element.hidden) return;
    const names = this.#result.variables.map((/** @type {any} */ variable) => variable.name);
    this.front.set({
      columns: ['f1 (µm)', 'f2 (kN)', 'f3 (m/s²)', 'J', ...names.map(shortName)],
      dots: front.map((/** @type {any} */ point) => ({
        kind: 'front',
        mark: point.weighted ? 'best J' : point.knee ? 'knee' : undefined,
        values: [point.f1_um, point.f2_N / 1000, point.f3_m_per_s2, point.J, ...point.values],
        pick: () =>
          this.#openValues(
            Object.fromEntries(
              names.map((/** @type {string} */ name, /** @type {number} */ i) => [name, point.values[i]]),
            ),
          ),
      })),
    });
  }

  #drawHead() {
    const job = this.#job;
    /** @param {string} text @param {() => unknown} act @param {string} [kind] */
    const button = (text, act, kind = 'button') => h(kind, { type: 'button', onclick: () => this.#try(act) }, text);
    /** @param {string} verb */
    const act = verb => async () => {
      const answer = await post(`jobs/${job.id}/${verb}`);
      this.app.jobs.put(answer);
      if (verb === 'clone') this.app.go('optimize', { job: String(answer.id) });
    };
    const active = ACTIVE.includes(job.state);
    const { progress = {} } = job;
    const facts = [
      choiceText(job.algorithm ?? ''),
      progressText(job),
      typeof progress.true_evaluations === 'number' ? `${progress.true_evaluations} evaluations` : '',
      typeof progress.predicted === 'number' && progress.predicted ? `${progress.predicted} predicted` : '',
      typeof progress.pfc_percent === 'number' && !active ? `PFC ${sig(progress.pfc_percent, 3)} %` : '',
      typeof progress.seconds === 'number' ? duration(progress.seconds) : '',
      active && typeof progress.seconds_left === 'number' ? `${duration(progress.seconds_left)} left` : '',
    ].filter(Boolean);
    fill(
      this.head,
      h('h2', null, job.name || `Search ${job.id}`),
      h('span.facts', null, facts.join(' · ')),
      job.error ? h('span.fault', null, job.error.detail) : null,
      h(
        'span.actions',
        null,
        job.best ? button('Open the best', () => this.#openBest(), 'button.primary') : null,
        job.best
          ? button('Compare', () => this.app.go('compare', { items: `unmodified,job:${job.id},current` }))
          : null,
        active && !job.stopping ? button('Stop', act('cancel')) : null,
        job.state === 'failed' || job.state === 'cancelled' ? button('Go on', act('retry')) : null,
        button('Again', act('clone')),
        active
          ? null
          : button('Delete', async () => {
              await ask('DELETE', `jobs/${job.id}`);
              this.app.jobs.all.delete(job.id);
              this.app.jobs.dispatchEvent(new CustomEvent('change', { detail: null }));
              this.app.go('optimize');
            }),
      ),
    );
  }

  #drawBest() {
    const { best, unmodified } = this.#job;
    if (!best) {
      fill(this.best, h('h3', null, 'Best so far'), h('p.figure-note', null, 'Nothing is evaluated yet.'));
      return;
    }
    const rows = OBJECTIVES.map(([key, text, unit, scale]) =>
      h(
        'tr',
        null,
        h('th', { scope: 'row' }, text, unit ? h('span.unit', null, ` ${unit}`) : null),
        h('td.number', null, sig(best[key] * scale, 3)),
        h('td.number', null, unmodified ? sig(unmodified[key] * scale, 3) : ''),
        h('td.number', null, changeText(change(best[key], unmodified?.[key]))),
      ),
    );
    const flanks = changedValues(best.modification);
    fill(
      this.best,
      h('.figure-head', null, h('h3', null, this.#job.state === 'done' ? 'The best' : 'Best so far')),
      h(
        'table.numbers',
        null,
        h(
          'thead',
          null,
          h(
            'tr',
            null,
            ['', 'best', 'unmodified', 'change'].map(text => h('th', { scope: 'col' }, text)),
          ),
        ),
        h('tbody', null, rows),
      ),
      h(
        'table.numbers',
        null,
        h(
          'tbody',
          null,
          flanks.map(({ label, unit, values }) =>
            h(
              'tr',
              null,
              h('th', { scope: 'row' }, label, h('span.unit', null, ` ${unit}`)),
              values.map(value => h('td.number', null, sig(value, 4))),
            ),
          ),
        ),
      ),
    );
  }

  async #openBest() {
    const design = await this.#design;
    if (design) this.#open({ ...design, modification: this.#job.best.modification });
  }

  /** @param {Record<string, number>} values of variables: "pinion/both/tip_relief_um" */
  async #openValues(values) {
    const design = await this.#design;
    if (!design) return;
    const next = structuredClone(design);
    for (const [name, value] of Object.entries(values)) {
      const [member, end, key] = name.split('/');
      for (const each of end === 'both' ? ['left', 'right'] : [end]) {
        next.modification[member] ??= {};
        next.modification[member][each] = { ...next.modification[member][each], [key]: value };
      }
    }
    this.#open(next);
  }

  /**
   * The design of the search with another modification. What the designer left open stays open when it is the same
   * pair.
   * @param {any} design
   */
  async #open(design) {
    const { store, fields } = this.app;
    /** @param {any} whole */
    const pair = whole => JSON.stringify([whole.gear_pair, whole.material, whole.supports, whole.shafts]);
    const resolved = this.app.analyst.result?.design ?? store.design;
    const kept =
      pair(resolved) === pair(design)
        ? {
            gear_pair: store.design.gear_pair,
            material: store.design.material,
            supports: store.design.supports,
            shafts: store.design.shafts,
            optimization: store.design.optimization,
          }
        : {};
    store.open(complete(fields, { ...design, ...kept }), store.from);
    this.app.go('design');
  }

  /** @param {() => unknown} act */
  async #try(act) {
    try {
      await act();
    } catch (error) {
      this.head.append(h('span.fault', { role: 'alert' }, /** @type {Error} */ (error).message));
    }
  }
}

/** Variables of a history row by name; it lists nothing else. @param {any} row @returns {Record<string, number>} */
function variablesOf(row) {
  /** @type {Record<string, number>} */
  const values = {};
  for (const { member, key, left, right } of flankValues(row.modification)) {
    if (left === right) values[`${member}/both/${key}`] = left;
    else {
      values[`${member}/left/${key}`] = left;
      values[`${member}/right/${key}`] = right;
    }
  }
  return values;
}

/** Numbers of a modification, both ends beside each other. @param {any} modification */
function flankValues(modification) {
  /** @type {{ member: string, key: string, left: number, right: number }[]} */
  const rows = [];
  for (const [member, ends] of Object.entries(modification ?? {})) {
    if (!ends || typeof ends !== 'object') continue;
    for (const key of Object.keys(ends.left ?? {})) {
      const left = ends.left[key];
      const right = ends.right?.[key] ?? left;
      if (typeof left === 'number') rows.push({ member, key, left, right });
    }
  }
  return rows;
}

/** What is not zero, for people. @param {any} modification */
function changedValues(modification) {
  return flankValues(modification)
    .filter(({ left, right }) => left !== 0 || right !== 0)
    .map(({ member, key, left, right }) => ({
      label: `${labelOf(key)}${member === 'gear' ? ', gear' : ''}`,
      unit: unitText(/_(um|mm|per_mm)$/.exec(key)?.[1]),
      values: left === right ? [left] : [left, right],
    }));
}

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function optimizeView(app) {
  const { store, form, jobs } = app;
  let chosen = '';
  const trouble = h('p.fault', { role: 'alert' });
  const start = h('button.primary', { type: 'submit', form: 'search-form' }, 'Start the search');
  const detail = new JobDetail(app);
  const submit = async () => {
    trouble.textContent = '';
    start.disabled = true;
    try {
      const { data } = await ask('POST', 'jobs', {
        body: { kind: 'optimize', design: store.design },
        headers: { 'Idempotency-Key': token() },
      });
      const { design, ...job } = data;
      jobs.put(job);
      app.go('optimize', { job: String(data.id) });
    } catch (error) {
      const stray = form.showFaults(error instanceof Refusal ? error.faults : []);
      trouble.textContent = stray.length
        ? stray.map(fault => fault.detail).join(' ')
        : error instanceof Refusal && error.faults.length
          ? 'Some values are not possible, see above.'
          : /** @type {Error} */ (error).message;
    }
    start.disabled = false;
  };
  const parameters = searchForm(app, submit);
  parameters.id = 'search-form';
  const table = h('table.numbers.jobs');
  const empty = h(
    'p.empty',
    null,
    'No search has been started yet. What is searched for stands on the left; the pair, its load and everything else are those of the Design view.',
  );
  const foot = h('div');
  const right = h(
    '.figure-pane',
    null,
    h('section.job-list', { 'aria-label': 'Searches' }, table, empty),
    detail.element,
  );
  const element = h(
    '.design-view.optimize-view',
    null,
    h(
      'aside.form-pane',
      { 'aria-label': 'Search' },
      h('.form-scroll', null, parameters),
      foot,
      h('.form-foot', null, start, trouble),
    ),
    right,
  );
  const draw = () => {
    const searches = jobs.searches();
    empty.hidden = searches.length > 0;
    table.hidden = searches.length === 0;
    if (!searches.some(job => String(job.id) === chosen)) chosen = searches.length ? String(searches[0].id) : '';
    const focus = /** @type {HTMLElement | null} */ (document.activeElement?.closest('[data-job]'))?.dataset.job;
    fill(
      table,
      h(
        'thead',
        null,
        h(
          'tr',
          null,
          ['Search', 'Algorithm', 'State', 'Progress', 'Left', 'Best J', 'Started'].map(text =>
            h('th', { scope: 'col' }, text),
          ),
        ),
      ),
      h(
        'tbody',
        null,
        searches.map(job => row(job)),
      ),
    );
    if (focus) /** @type {HTMLElement | null} */ (table.querySelector(`[data-job="${focus}"] button`))?.focus();
    detail.choose(searches.find(job => String(job.id) === chosen) ?? null);
  };
  /** @param {any} job */
  const row = job =>
    h(
      String(job.id) === chosen ? 'tr.chosen' : 'tr',
      { 'data-job': job.id, onclick: () => app.go('optimize', { job: String(job.id) }) },
      h('th', { scope: 'row' }, h('button.link', { type: 'button' }, job.name || `search ${job.id}`)),
      h('td', null, choiceText(job.algorithm ?? '')),
      h('td.job-state', null, job.stopping ? 'stopping' : job.state),
      h('td', null, progressBar(job)),
      h(
        'td.number',
        null,
        ACTIVE.includes(job.state) && typeof job.progress?.seconds_left === 'number'
          ? duration(job.progress.seconds_left)
          : '',
      ),
      h('td.number', null, job.best ? sig(job.best.J, 3) : ''),
      h('td', null, dateText(job.started ?? job.created)),
    );
  let asked = false;
  jobs.addEventListener('change', () => {
    if (asked || !element.isConnected) return;
    asked = true;
    setTimeout(() => {
      asked = false;
      draw();
    }, 100);
  });
  return {
    element,
    show(parametersOfPlace) {
      chosen = parametersOfPlace.get('job') ?? chosen;
      foot.append(form.help);
      form.refresh();
      draw();
    },
  };
}
