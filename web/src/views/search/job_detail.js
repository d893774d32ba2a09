// SPDX-License-Identifier: GPL-3.0-or-later
// One search: what it is doing, its best in numbers, its figures, and what can be done with it.
import { ask, get, list, post } from '../../base/api.js';
import { fill, h } from '../../base/dom.js';
import { change, changeText, choiceText, duration, sig, timeText } from '../../base/format.js';
import { ACTIVE } from '../../base/jobs.js';
import { documentOf } from '../../base/store.js';
import { shownSentence, shownUnit, shownValue, units } from '../../base/units.js';
import { progressText } from '../../jobbar.js';
import { JobFigures } from './job_figures.js';
import { MEASURES, footnote, meanOf } from './measures.js';
import { changedValues, withGrids, withValues } from './variables.js';

const PAUSE = 700; // ms between two looks at a running search
const MOST_ROWS = 4000;

export class JobDetail {
  /** @type {Api.Job | null} */ #job = null;
  /** @type {Api.OptimizationResult | null} */ #result = null;
  /** The design that it started from, resolved. @type {Api.Design | null} */ #design = null;
  /** @type {Api.JobHistoryRow[]} */ #rows = [];
  #timer = 0;
  #last = 0;

  /** @param {import('../../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.head = h('.job-head');
    this.best = h('section.figure.with-table', { 'aria-label': 'Best so far' });
    this.figures = new JobFigures(values => this.#openValues(values));
    units.addEventListener('change', () => this.#job && this.#drawBest());
    this.element = h('.job-detail', { hidden: true }, this.head, this.figures.elements(this.best));
  }

  /** @param {Api.Job | null} job */
  choose(job) {
    const before = this.#job;
    this.#job = job;
    this.element.hidden = !job;
    if (before?.id !== job?.id) {
      this.#result = this.#design = null;
      this.#rows = [];
      this.figures.clear();
    }
    if (!job) return;
    this.#drawHead(job);
    this.#drawBest();
    if (before?.id !== job.id || before.state !== job.state || performance.now() - this.#last > PAUSE) this.#look();
    else if (!this.#timer) this.#timer = window.setTimeout(() => this.#look(), PAUSE);
  }

  async #look() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    this.#last = performance.now();
    const job = this.#job;
    if (!job) return;
    const gone = () => this.#job?.id !== job.id;
    try {
      const columns = await get(`jobs/${job.id}/generations`);
      if (gone()) return;
      this.figures.drawGenerations(columns);
      const design = this.#design ?? (await get(`jobs/${job.id}`)).design;
      if (!design) return;
      const start = documentOf(design);
      const rows = await list(`jobs/${job.id}/history`, MOST_ROWS);
      const done = job.state === 'done' && job.has_result !== false;
      const answer = done ? (this.#result ?? (await get(`jobs/${job.id}/result`))) : null;
      const result = answer && 'best' in answer ? answer : null;
      if (gone()) return;
      this.#design = start;
      this.#rows = rows;
      this.#result = result;
      this.#drawHead(this.#job ?? job); // which may have ended meanwhile
      this.#drawBest();
      this.figures.draw({ design: start, best: this.#bestOf(), rows, result });
    } catch {
      // the next event looks again
    }
  }

  /**
   * The best with its flank: the list of jobs has both for searches of the service; of those of the terminal the result
   * has them, and the history as long as they run.
   * @returns {Partial<Api.JobPoint> | null}
   */
  #bestOf() {
    const best = this.#job?.best;
    if (!best) return null;
    if (best.modification)
      return this.#design ? { ...best, modification: withGrids(this.#design, best.modification) } : best;
    const found = this.#result?.best;
    if (found) return { ...found.objectives, modification: found.modification };
    const rows = this.#rows.filter(row => typeof row.J === 'number');
    const least = [...rows].sort((a, b) => Number(a.J) - Number(b.J))[0];
    if (!least || !this.#design) return best;
    const { modification } = withValues(this.#design, flatten(least.modification));
    return { ...least, modification: /** @type {Api.Modification} */ (modification) };
  }

  #unmodifiedOf() {
    return this.#job?.unmodified ?? this.#result?.unmodified ?? null;
  }

  /** @param {Api.Job} job */
  #drawHead(job) {
    const active = ACTIVE.includes(job.state);
    /** @type {Partial<Api.JobProgress>} */
    const progress = job.progress ?? {};
    const facts = [
      choiceText(job.algorithm ?? ''),
      progressText(job),
      typeof progress.true_evaluations === 'number' ? `${progress.true_evaluations} evaluations` : '',
      typeof progress.predicted === 'number' && progress.predicted ? `${progress.predicted} predicted` : '',
      typeof progress.pfc_percent === 'number' && !active ? `PFC ${sig(progress.pfc_percent, 3)} %` : '',
      typeof progress.seconds === 'number' ? timeText(progress.seconds) : '',
      active && typeof progress.seconds_left === 'number' ? `${duration(progress.seconds_left)} left` : '',
    ].filter(Boolean);
    fill(
      this.head,
      h('h2', null, job.name || `Search ${job.id}`),
      h('span.facts', null, facts.join(' · ')),
      job.error ? h('span.fault', null, shownSentence(job.error.detail)) : null,
      h('span.actions', null, this.#actions(job, active)),
    );
  }

  /** @param {Api.Job} job @param {boolean} active */
  #actions(job, active) {
    const { app } = this;
    /** @param {string} text @param {() => unknown} act @param {string} [kind] */
    const button = (text, act, kind = 'button') => h(kind, { type: 'button', onclick: () => app.attempt(act) }, text);
    /** @param {'cancel' | 'retry' | 'clone'} verb */
    const act = verb => async () => {
      const answer = await post(`jobs/${job.id}/${verb}`, {});
      app.jobs.put(answer);
      if (verb === 'clone') app.go('optimize', { job: String(answer.id) });
    };
    const remove = async () => {
      await ask('DELETE', `jobs/${job.id}`);
      app.jobs.remove(job.id);
      app.jobs.dispatchEvent(new CustomEvent('change', { detail: null }));
      app.go('optimize');
    };
    const ready = Boolean(this.#bestOf()?.modification);
    return [
      ready ? button('Open the best', () => this.#openBest(), 'button.primary') : null,
      job.best ? button('Compare', () => app.go('compare', { items: `unmodified,job:${job.id},current` })) : null,
      active && !job.stopping ? button('Stop', act('cancel')) : null,
      job.state === 'failed' || job.state === 'cancelled' ? button('Go on', act('retry')) : null,
      button('Again', act('clone')),
      active ? null : button('Delete', remove),
    ];
  }

  #drawBest() {
    const best = this.#bestOf();
    const title = this.#job?.state === 'done' ? 'The best' : 'Best so far';
    if (!best) {
      fill(this.best, h('h3', null, title), h('p.figure-note', null, 'Nothing is evaluated yet.'));
      return;
    }
    const before = this.#unmodifiedOf();
    const cases = this.#design?.load_cases?.length ?? 0;
    const rows = MEASURES.map(measure => ({
      name: measure.name,
      unit: measure.unit,
      own: cases ? meanOf(best, measure, cases) : null,
      before: cases ? meanOf(before, measure, cases) : null,
    }));
    rows.push({ name: 'Objective J', unit: '', own: best.J ?? null, before: before?.J ?? 1 });
    fill(
      this.best,
      h('.figure-head', null, h('h3', null, title), h('span.figure-note', null, 'duty-cycle means')),
      h(
        'table.numbers.wrapping',
        null,
        h(
          'thead',
          null,
          h(
            'tr',
            null,
            ['', 'best', 'unmodified', 'change'].map(text =>
              h('th', { scope: 'col' }, text || h('span.unseen', null, 'number')),
            ),
          ),
        ),
        h(
          'tbody',
          null,
          rows.map(({ name, unit, own, before: plain }) =>
            h(
              'tr',
              null,
              h('th', { scope: 'row' }, name, unit ? h('span.unit', null, ` ${shownUnit(unit)}`) : null),
              h('td.number', null, sig(shownValue(own, unit), 3)),
              h('td.number', null, sig(shownValue(plain, unit), 3)),
              h('td.number', null, changeText(change(own, plain))),
            ),
          ),
        ),
      ),
      this.#flankTable(best),
      cases ? h('p.figure-note', null, footnote(cases)) : null,
    );
  }

  /** @param {Partial<Api.JobPoint>} best */
  #flankTable(best) {
    const rows = changedValues(best.modification, this.#design?.modification);
    if (!rows.length) return null;
    return h(
      'table.numbers',
      null,
      h(
        'tbody',
        null,
        rows.map(({ label, unit, values }) =>
          h(
            'tr',
            null,
            h('th', { scope: 'row' }, label, h('span.unit', null, ` ${shownUnit(unit)}`)),
            values.map(value => h('td.number', null, sig(shownValue(value, unit), 4))),
          ),
        ),
      ),
    );
  }

  async #openBest() {
    const best = this.#bestOf();
    if (!this.#design || !best?.modification) return;
    await this.#open(documentOf({ ...this.#design, modification: best.modification }));
  }

  /** @param {Record<string, number>} values of variables */
  async #openValues(values) {
    const design = this.#design;
    if (design) await this.app.attempt(() => this.#open(withValues(design, values)));
  }

  /**
   * The design of the search with another modification. What the designer left open stays open when it is the same
   * pair.
   * @param {Api.Design} design
   */
  async #open(design) {
    const { store, app } = { store: this.app.store, app: this.app };
    /** @param {Page.Design} whole */
    const pair = whole => JSON.stringify([whole.gear_pair, whole.material, whole.supports, whole.shafts]);
    const resolved = app.analyst.result?.design ?? store.design;
    const same = pair(resolved) === pair(design);
    const { gear_pair, material, supports, shafts, optimization } = store.design;
    const kept = same ? { gear_pair, material, supports, shafts, optimization } : {};
    await app.opening(async () => store.open({ ...design, ...kept }, store.from), 'design');
  }
}

/** Values of a history row by the names of variables. @param {Api.JobHistoryRow['modification']} modification */
function flatten(modification) {
  /** @type {Record<string, number>} */
  const values = {};
  for (const [member, ends] of Object.entries(modification ?? {}))
    for (const [end, flank] of Object.entries(ends ?? {}))
      for (const [key, value] of Object.entries(flank ?? {}))
        if (typeof value === 'number') values[`${member}/${end}/${key}`] = value;
  return values;
}
