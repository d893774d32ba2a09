// SPDX-License-Identifier: GPL-3.0-or-later
// The Optimize view: what is searched for and how; the searches; what the chosen one has found so far.
import { Refusal, ask, token } from '../base/api.js';
import { fill, h, unlessHeld } from '../base/dom.js';
import { choiceText, dateText, duration, sig } from '../base/format.js';
import { ACTIVE } from '../base/jobs.js';
import { progressBar } from '../jobbar.js';
import { JobDetail } from './search/job_detail.js';
import { SearchForm } from './search/search_form.js';

const COLUMNS = ['Search', 'Algorithm', 'State', 'Progress', 'Left', 'Best J', 'Started'];
const RARE = ['Algorithm', 'Started']; // not on a phone
const PAUSE = 100; // ms between two drawings of the list

class OptimizeView {
  #chosen = '';
  #asked = false;

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.trouble = h('.fault', { role: 'alert' });
    this.start = h('button.primary', { type: 'submit', form: 'search-form' }, 'Start the search');
    this.detail = new JobDetail(app);
    this.search = new SearchForm(app, () => this.#submit());
    this.table = h('table.numbers.jobs');
    this.empty = h(
      'p.empty',
      null,
      'No search has been started yet. The form says what is searched for; the pair, its load and everything else ' +
        'are those of the Design view.',
    );
    this.missing = h('p.trouble', { role: 'alert', hidden: true });
    this.foot = h('div');
    this.element = h(
      '.design-view.optimize-view',
      null,
      h(
        'aside.form-pane',
        { 'aria-label': 'Search' },
        h('.form-scroll', null, this.search.element),
        this.foot,
        h('.form-foot', null, this.start, this.trouble),
      ),
      h(
        '.figure-pane',
        null,
        h('section.job-list', { 'aria-label': 'Searches' }, this.missing, this.table, this.empty),
        this.detail.element,
      ),
    );
    this.redraw = unlessHeld(this.element, () => this.#draw());
    app.jobs.addEventListener('change', () => this.#later());
    app.analyst.addEventListener('state', () => this.#drawFaults([]));
    app.analyst.addEventListener('result', () => this.search.refresh());
  }

  async #submit() {
    const { app } = this;
    app.form.flush();
    if (this.#drawFaults([])) return;
    this.start.disabled = true;
    try {
      const { data } = await ask('POST', 'jobs', {
        body: { kind: 'optimize', design: app.store.design },
        headers: { 'Idempotency-Key': token() },
      });
      const { design: _design, ...job } = data;
      app.jobs.put(job);
      app.go('optimize', { job: String(data.id) });
    } catch (error) {
      const faults = error instanceof Refusal ? error.faults : [];
      if (!this.#drawFaults(faults)) this.trouble.textContent = /** @type {Error} */ (error).message;
    }
    this.start.disabled = false;
  }

  /**
   * What keeps a search from starting, each with the way to its field.
   * @param {import('../base/api.js').Fault[]} faults
   */
  #drawFaults(faults) {
    if (this.app.current !== 'optimize') return false;
    const troubles = this.app.form.showFaults(faults);
    fill(
      this.trouble,
      troubles.map(({ name, detail, lead }) =>
        h('p', null, lead ? h('button.link', { type: 'button', onclick: lead }, name) : name, `: ${detail}`),
      ),
    );
    return troubles.length > 0;
  }

  #later() {
    if (this.#asked || !this.element.isConnected) return;
    this.#asked = true;
    setTimeout(() => {
      this.#asked = false;
      this.redraw();
    }, PAUSE);
  }

  #draw() {
    const { jobs } = this.app;
    const searches = jobs.searches();
    this.empty.hidden = searches.length > 0;
    this.table.hidden = searches.length === 0;
    const there = searches.some(job => String(job.id) === this.#chosen);
    this.missing.hidden = !jobs.known || there || this.#chosen === '';
    this.missing.textContent = this.missing.hidden
      ? ''
      : `Search ${this.#chosen} is not on this server: it was deleted, or the link is of another server.`;
    if (!there && this.#chosen === '' && searches.length) this.#chosen = String(searches[0].id);
    const focus = /** @type {HTMLElement | null} */ (document.activeElement?.closest('[data-job]'))?.dataset.job;
    fill(
      this.table,
      h(
        'thead',
        null,
        h(
          'tr',
          null,
          COLUMNS.map(text => h(RARE.includes(text) ? 'th.rare' : 'th', { scope: 'col' }, text)),
        ),
      ),
      h(
        'tbody',
        null,
        searches.map(job => this.#row(job)),
      ),
    );
    if (focus) /** @type {HTMLElement | null} */ (this.table.querySelector(`[data-job="${focus}"] button`))?.focus();
    this.detail.choose(searches.find(job => String(job.id) === this.#chosen) ?? null);
  }

  /** @param {Api.Job} job */
  #row(job) {
    const left = ACTIVE.includes(job.state) ? job.progress?.seconds_left : null;
    return h(
      String(job.id) === this.#chosen ? 'tr.chosen' : 'tr',
      { 'data-job': job.id, onclick: () => this.app.go('optimize', { job: String(job.id) }) },
      h('th', { scope: 'row' }, h('button.link', { type: 'button' }, job.name || `search ${job.id}`)),
      h('td.rare', null, choiceText(job.algorithm ?? '')),
      h('td.job-state', null, job.stopping ? 'stopping' : job.state),
      h('td', null, progressBar(job)),
      h('td.number', null, typeof left === 'number' ? duration(left) : ''),
      h('td.number', null, job.best ? sig(job.best.J, 3) : ''),
      h('td.rare', null, dateText(job.started ?? job.created)),
    );
  }

  /** @param {URLSearchParams} parameters */
  show(parameters) {
    this.#chosen = parameters.get('job') ?? this.#chosen;
    this.foot.append(this.app.form.help);
    this.app.form.refresh();
    this.search.refresh();
    this.#drawFaults([]);
    this.#draw();
  }
}

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function optimizeView(app) {
  return new OptimizeView(app);
}
