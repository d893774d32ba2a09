// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of a search: how it converges, what it has tried, and the best so far beside where it started.
import { h } from '../../base/dom.js';
import { Lane } from '../../base/lane.js';
import { documentOf, unmodified } from '../../base/store.js';
import { Chart } from '../../figures/chart.js';
import { OWN_COLOUR, REFERENCE_COLOUR, caseLong, lessMean, mainCase } from '../../figures/context.js';
import { Parallel, Scatter } from '../../figures/scatter.js';
import { MEASURE_COLUMNS, meansOf } from './measures.js';
import { shortName, valuesOf, variablesOf } from './variables.js';

/** @typedef {import('../../figures/scatter.js').Dot} Dot */
/**
 * @typedef {object} Search
 * @property {Api.Design} design that it started from
 * @property {Partial<Api.JobPoint> | null} best modification and objectives
 * @property {Api.JobHistoryRow[]} rows of its history
 * @property {Api.OptimizationResult | null} result when it is done
 */

/** Results of a few designs, asked for one after the other; those of a best that is no longer one are dropped. */
class Compared {
  /** @type {Map<string, Page.Result>} */ results = new Map();
  /** @type {{ name: string, design: Api.Design }[]} */ #left = [];
  #asked = '';

  /** @param {() => void} tell */
  constructor(tell) {
    /** @type {Lane<Page.Result>} */
    this.lane = new Lane({
      result: (task, data) => {
        this.results.set(task.note, data);
        tell();
        this.#next();
      },
      refused: () => this.#next(),
    });
  }

  /** @param {{ name: string, design: Api.Design }[]} designs */
  ask(designs) {
    const text = JSON.stringify(designs);
    if (text === this.#asked) return;
    this.#asked = text;
    this.#left = [...designs];
    this.#next();
  }

  clear() {
    this.results.clear();
    this.#asked = '';
  }

  #next() {
    const first = this.#left.shift();
    if (first)
      this.lane.submit({ path: 'analyze?maps=0&root_stress=0&rating=0&pitch=0', body: first.design, note: first.name });
  }
}

export class JobFigures {
  #rows = -1;
  /** @type {Search | null} */ #search = null;
  #drawnBest = '';

  /** @param {(values: Record<string, number>) => void} open opens the design of a dot */
  constructor(open) {
    this.open = open;
    this.convergence = new Chart({
      title: 'Convergence',
      unit: 'J',
      help: 'Best and mean objective of each generation of the search.',
      good: 'A curve that has become flat: more evaluations would gain little.',
      xLabel: 'generation',
      whole: true,
    });
    this.pfc = new Chart({
      title: 'Evaluations by the model',
      name: 'Percentage of fitness computed (PFC)',
      unit: '%',
      help: 'Evaluations by the model, of all values that the search needed so far; the others were predicted.',
      good: 'Low: the search guesses well and computes little.',
      xLabel: 'generation',
      whole: true,
      zero: true,
    });
    this.te = new Chart({
      title: 'Loaded TE of the best',
      name: 'Loaded transmission error of the best so far',
      unit: 'µm',
      help:
        'Compared with the unmodified pair and the design at the start of the search, at the load case with the ' +
        'largest share.',
      good: 'Flatter than both.',
      xLabel: 'mesh cycle',
    });
    this.flank = new Chart({
      title: 'Flank of the best',
      name: 'Profile modification of the best so far',
      unit: 'µm',
      help: 'Material taken off the pinion of the left end, from root to tip.',
      xLabel: 'from the pitch point to the tip',
      xUnit: 'mm',
    });
    this.history = new Scatter({
      title: 'History',
      help:
        'Every design that the search computed (full) or took from earlier ones (open), with its start and its ' +
        'best; a click opens one.',
      x: 'evaluation',
      y: 'J',
    });
    this.parallel = new Parallel('All variables');
    this.front = new Scatter({
      title: 'Pareto front',
      help: 'Designs of which none is better in every objective; a click opens one.',
      x: MEASURE_COLUMNS[0],
      y: MEASURE_COLUMNS[2],
    });
    this.compared = new Compared(() => this.#drawCompared());
  }

  /** @param {HTMLElement} best the table of the best */
  elements(best) {
    return h(
      '.figures',
      null,
      best,
      this.te.element,
      this.flank.element,
      this.convergence.element,
      this.front.element,
      this.history.element,
      this.pfc.element,
      this.parallel.element,
    );
  }

  clear() {
    this.#rows = -1;
    this.#drawnBest = '';
    this.#search = null;
    this.compared.clear();
    for (const chart of [this.convergence, this.pfc, this.te, this.flank]) chart.set({ x: [], curves: [] });
    this.front.element.hidden = this.history.element.hidden = this.parallel.element.hidden = true;
  }

  /** @param {Api.Generations} columns */
  drawGenerations(columns) {
    if (!columns.generation?.length) return;
    const x = columns.generation.map(value => value + 1);
    const curves = [{ label: 'best', y: columns.best, colour: 'best' }];
    if (columns.mean?.some(value => value !== null))
      curves.unshift({ label: 'mean', y: columns.mean, colour: 'mean' });
    this.convergence.set({ x, curves });
    this.pfc.set({ x, curves: [{ label: 'PFC', y: columns.pfc_percent, colour: OWN_COLOUR }] });
  }

  /** @param {Search} search */
  draw(search) {
    this.#search = search;
    const best = JSON.stringify(search.best?.modification ?? null);
    const changed = search.rows.length !== this.#rows || best !== this.#drawnBest;
    if (changed) this.#drawHistory(search);
    if (search.result?.front?.length) this.#drawFront(search);
    this.#rows = search.rows.length;
    if (best === this.#drawnBest) return;
    this.#drawnBest = best;
    const { design } = search;
    this.compared.ask([
      ...(search.best?.modification
        ? [{ name: 'best', design: documentOf({ ...design, modification: search.best.modification }) }]
        : []),
      { name: 'start', design },
      { name: 'unmodified', design: unmodified(design) },
    ]);
  }

  /** @param {Search} search */
  #drawHistory({ rows, design, best }) {
    const start = this.compared.results.get('start')?.objectives;
    const cases = design.load_cases.length;
    const names = [...new Set(rows.flatMap(row => Object.keys(variablesOf(row))))];
    const columns = ['evaluation', ...names.map(shortName), ...MEASURE_COLUMNS, 'J'];
    const least = best?.J ?? NaN;
    const states = Math.max(0, ...rows.map(row => row.states));
    const found = rows.find(row => typeof row.J === 'number' && Math.abs(row.J - least) <= 1e-9 * least);
    /** @type {Dot[]} */
    const dots = rows.map((row, i) => {
      const values = variablesOf(row);
      return {
        kind: row.reused || row.states < states ? 'known' : 'new',
        mark: row === found ? 'best' : undefined,
        values: [
          row.ordinal ?? i + 1,
          ...names.map(name => values[name] ?? null),
          ...meansOf(row, cases),
          row.J ?? null,
        ],
        pick: () => this.open(values),
      };
    });
    /** @param {string} mark @param {import('./variables.js').Flanks} modification
     * @param {import('./measures.js').Objectives & { J?: Page.Reading }} objectives @param {number} place */
    const extra = (mark, modification, objectives, place) =>
      dots.push({
        kind: 'known',
        mark,
        values: [place, ...valuesOf(names, modification), ...meansOf(objectives, cases), objectives?.J ?? null],
      });
    if (start) extra('start', design.modification, start, 0);
    if (best?.modification && !found) extra('best, known before', best.modification, best, rows.length);
    this.history.element.hidden = this.parallel.element.hidden = rows.length === 0;
    const known = rows.filter(row => row.reused).length;
    const partly = rows.filter(row => row.states < states).length;
    this.history.painting.frame.note.hidden = false;
    const before = known ? `, ${known} of them known before` : '';
    const first = partly ? `, ${partly} looked at with the first pairs as made alone (open)` : '';
    this.history.painting.frame.note.textContent = `${rows.length} designs${before}${first}; equal ones stand once.`;
    this.history.set({ columns, dots });
    const shown = [...names.map((_, k) => k + 1), columns.length - 1];
    this.parallel.set({
      columns: shown.map(k => columns[k]),
      dots: dots.map(dot => ({ ...dot, values: shown.map(k => dot.values[k]) })),
    });
  }

  /** @param {Search} search */
  #drawFront({ result, design }) {
    if (!result?.front) return;
    const cases = design.load_cases.length;
    const names = result.variables.map(variable => variable.name);
    const other = (design.optimization?.front ?? 'objectives') !== 'objectives';
    const axes = other ? (result.front_axes ?? []) : [];
    this.front.element.hidden = false;
    if (axes.length > 1) this.front.turn(axes[0], axes[1]);
    this.front.set({
      columns: [...axes, ...MEASURE_COLUMNS, 'J', ...names.map(shortName)],
      dots: result.front.map(point => ({
        kind: 'front',
        mark: point.weighted ? 'best J' : point.knee ? 'knee' : undefined,
        values: [...(axes.length ? point.axes : []), ...meansOf(point, cases), point.J, ...point.values],
        pick: () =>
          this.open(
            Object.fromEntries(
              names.map((/** @type {string} */ name, /** @type {number} */ i) => [name, point.values[i]]),
            ),
          ),
      })),
    });
  }

  /** Best, start and unmodified beside each other. */
  #drawCompared() {
    const search = this.#search;
    const { results } = this.compared;
    const first = results.get('best') ?? results.get('start');
    if (!search || !first) return;
    const k = mainCase(search.design);
    /** @type {{ name: string, colour: string, line?: 'dashed' | 'dotted' }[]} */
    const looks = [
      { name: 'unmodified', colour: REFERENCE_COLOUR, line: 'dashed' },
      { name: 'start', colour: REFERENCE_COLOUR, line: 'dotted' },
      { name: 'best', colour: 'best' },
    ];
    const shown = looks.filter(({ name }) => results.has(name));
    this.te.frame.setCase(caseLong(search.design.load_cases[k]));
    this.te.set({
      x: first.load_cases[k].position ?? [],
      curves: shown.flatMap(({ name, colour, line }) => {
        const row = results.get(name)?.load_cases[k];
        return row ? [{ label: name, x: row.position ?? undefined, y: lessMean(row.lte.pair_um), colour, line }] : [];
      }),
    });
    const pinion = first.modification?.pinion;
    this.flank.set({
      x: pinion?.u_mm ?? [],
      curves: shown.flatMap(({ name, colour, line }) => {
        const member = results.get(name)?.modification?.pinion;
        return member?.left ? [{ label: name, x: member.u_mm, y: member.left.profile_um, colour, line }] : [];
      }),
    });
    if (results.has('start')) this.#drawHistory(search);
  }
}
