// SPDX-License-Identifier: GPL-3.0-or-later
// What is searched for and how: variables, algorithm in words, budget with what it costs, bounds, objective.
import { fill, h } from '../../base/dom.js';
import { timeText } from '../../base/format.js';
import { fallbackOf, fieldAt } from '../../base/schema.js';
import { group } from '../../form/group.js';

const FIRST = ['variables', 'algorithm', 'true_evaluations', 'seed'];
const ALGORITHMS = ['ga', 'fpga', 'credibility-ga', 'nsga2'];
const LOOKS = {
  variables: { label: 'Search for' },
  algorithm: { label: 'Algorithm' },
  true_evaluations: { label: 'Budget, evaluations' },
  seed: { label: 'Seed' },
};
const WORDS = /** @type {Record<string, string>} */ ({
  'credibility-ga': 'Fast: predicts most designs from those computed and computes only the promising ones.',
  fpga: 'The published method: a genetic algorithm that predicts the fitness of designs near known ones.',
  ga: 'A plain genetic algorithm: computes every design.',
  nsga2: 'Finds the Pareto front: all designs of which none is better in every objective.',
});
/** Keys of the objective for gears that scatter. */
const SCATTER = [
  'robust',
  'robust_percent',
  'robust_sigmas',
  'scatter_pairs',
  'first_pairs',
  'check_pairs',
];
const WEIGHTS = ['transmission error', 'impact', 'vibration'];
const COUNTS = /** @type {Record<string, number>} */ ({ shared: 5, per_end: 10 });

/** Algorithms that a key is for, from the end of its help; none: all. @param {string} help */
function algorithmsOf(help) {
  const words = /\(([^()]*)\)$/.exec(help)?.[1].split(/,\s*/) ?? [];
  return words.every(word => ALGORITHMS.includes(word)) ? words : [];
}

/** Keys of a variable that numbers of a grid alone have. */
const OF_GRIDS = ['row', 'column'];

export class SearchForm {
  #shape = '';

  /** @param {import('../../app.js').App} app @param {() => void} submit */
  constructor(app, submit) {
    this.app = app;
    this.form = app.form;
    this.store = app.store;
    this.fields = app.form.set();
    this.changing = app.form.set();
    this.details = h('div');
    this.listed = h('.listed');
    this.terms = h('.listed');
    this.limits = h('.listed');
    this.algorithm = h('p.figure-note');
    this.cost = h('p.figure-note', { role: 'status' });
    this.weights = h('p.figure-note');
    this.element = h(
      'form.parameters',
      {
        'aria-label': 'Search',
        id: 'search-form',
        autocomplete: 'off',
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          submit();
        },
      },
      group('search', 'Search', true, this.#search()),
      group('bounds', 'Bounds of the variables', true, this.fields.fieldsOf('/optimization/bounds')),
      group('objective', 'What is good', true, [
        ...this.fields.fieldsOf('/objective', {
          skip: ['constraints', 'terms', 'limits', 'scenarios', 'penalty', ...SCATTER],
          looks: { weights: { label: 'Weights', parts: WEIGHTS }, normalise: { label: 'Each divided by' } },
        }),
        this.weights,
        this.terms,
      ]),
      group('scatter', 'Good for pairs as made', false, this.fields.fieldsOf('/objective', { only: SCATTER })),
      group('constraints', 'Limits', false, [
        ...this.fields.fieldsOf('/objective/constraints'),
        this.limits,
        ...this.fields.fieldsOf('/objective', { only: ['penalty'] }),
      ]),
      group('algorithm', 'The algorithm in detail', false, [this.details]),
    );
    this.store.addEventListener('change', () => this.refresh());
    app.form.finders.push(pointer => {
      const own = pointer.startsWith('/optimization') || pointer.startsWith('/objective');
      if (own && app.current !== 'optimize') app.go('optimize');
    });
    this.refresh();
  }

  #search() {
    return [
      ...FIRST.map(key =>
        this.fields.field(
          `/optimization/${key}`,
          /** @type {Record<string, import('../../form/fieldset.js').Look>} */ (LOOKS)[key],
        ),
      ),
      this.algorithm,
      this.listed,
      this.cost,
    ];
  }

  /** The value of a key, or its default. @param {string} key of the optimization */
  #value(key) {
    const field = fieldAt(this.form.fields, `/optimization/${key}`);
    return this.store.get(`/optimization/${key}`) ?? (field ? fallbackOf(field) : undefined);
  }

  refresh() {
    const [algorithm, variables] = [this.#value('algorithm'), this.#value('variables')];
    const rows = this.store.get('/optimization/variable_list') ?? [];
    this.algorithm.textContent = WORDS[algorithm] ?? '';
    const weights = this.store.get('/objective/weights') ?? [];
    const sum = weights.reduce((/** @type {number} */ total, /** @type {number} */ value) => total + value, 0);
    const parts = weights.map(
      (/** @type {number} */ value, /** @type {number} */ i) => `${Math.round((100 * value) / sum)} % ${WEIGHTS[i]}`,
    );
    this.weights.textContent = sum ? `That is ${parts.join(', ')}.` : '';
    this.#drawCost(algorithm, COUNTS[variables] ?? rows.length);
    const [terms, limits] = ['terms', 'limits'].map(key => this.store.get(`/objective/${key}`) ?? []);
    const ofGrids = rows.map((/** @type {{ parameter?: string }} */ row) => row.parameter === 'grid_um');
    const shape = JSON.stringify([algorithm, variables, ofGrids, terms.length, limits.length]);
    if (shape === this.#shape) return;
    this.#shape = shape;
    this.changing.release();
    this.#drawDetails(algorithm);
    const variable = { member: 'pinion', end: 'both', parameter: 'tip_relief_um', bounds: null };
    const keys = ['member', 'end', 'flank', 'parameter', 'row', 'column', 'bounds'];
    if (variables === 'listed') this.#drawRows(this.listed, '/optimization/variable_list', 'variable', keys, variable);
    else fill(this.listed);
    const term = { output: 'order_1_um', load_case: null, weight: 0.2, scale: null, percent: null };
    this.#drawRows(this.terms, '/objective/terms', 'term of the objective', Object.keys(term), term);
    const limit = { output: 'max_pressure_MPa', load_case: null, at_most: 1500, percent: null };
    this.#drawRows(this.limits, '/objective/limits', 'limit', Object.keys(limit), limit);
  }

  /** What the search costs, before it is started. @param {string} algorithm @param {number} count of variables */
  #drawCost(algorithm, count) {
    const budget = this.#value('true_evaluations');
    const genetic = algorithm === 'ga' || algorithm === 'fpga';
    const limit = genetic && !budget ? 'at most' : 'about';
    const most = budget ?? (genetic ? this.#value('population') * this.#value('generations') : 500 + 100 * count);
    const each = this.#secondsEach();
    const time = each ? `, ${timeText(most * each)} on this machine as it is now` : '';
    this.cost.textContent = `${count} variables, ${limit} ${most} evaluations${time}.`;
  }

  /** Of an evaluation, as the last search of this pair took; else as the last result did. */
  #secondsEach() {
    const name = this.store.design.name;
    const done = this.app.jobs
      .searches()
      .filter(job => job.name === name)
      .map(({ progress }) => ({ seconds: progress?.seconds ?? 0, count: progress?.true_evaluations ?? 0 }))
      .find(({ seconds, count }) => seconds > 1 && count > 20);
    if (done) return done.seconds / done.count;
    const ms = this.app.analyst.result?.timing_ms?.evaluation;
    return typeof ms === 'number' ? ms / 1000 : 0;
  }

  /** @param {string} algorithm */
  #drawDetails(algorithm) {
    const fields = fieldAt(this.form.fields, '/optimization')?.fields ?? [];
    const skip = fields
      .filter(field => {
        const own = algorithmsOf(field.help ?? '');
        return FIRST.includes(field.key) || field.kind === 'object' || (own.length > 0 && !own.includes(algorithm));
      })
      .map(field => field.key);
    fill(this.details, this.changing.fieldsOf('/optimization', { skip }));
  }

  /**
   * The rows of a list, each with its fields, one to take it out and one to add another.
   * @param {HTMLElement} place
   * @param {string} pointer of the list
   * @param {string} name of a row
   * @param {string[]} keys
   * @param {object} fresh what a new row has
   */
  #drawRows(place, pointer, name, keys, fresh) {
    const { store } = this;
    const rows = () => /** @type {object[]} */ (store.get(pointer) ?? []);
    /** @param {number} i */
    const remove = i =>
      store.set(
        pointer,
        rows().filter((_row, k) => k !== i),
      );
    const title = name.charAt(0).toUpperCase() + name.slice(1);
    fill(
      place,
      rows().map((/** @type {{ parameter?: string }} */ row, i) =>
        h(
          'fieldset.listed-row',
          null,
          h(
            'legend',
            null,
            `${title} ${i + 1} `,
            h(
              'button.icon',
              { type: 'button', 'aria-label': `Remove ${name} ${i + 1}`, onclick: () => remove(i) },
              '✕',
            ),
          ),
          keys
            .filter(key => row.parameter === 'grid_um' || !OF_GRIDS.includes(key))
            .map(key => this.changing.field(`${pointer}/${i}/${key}`)),
        ),
      ),
      h('button.small', { type: 'button', onclick: () => store.set(pointer, [...rows(), fresh]) }, `+ ${name}`),
    );
  }
}
