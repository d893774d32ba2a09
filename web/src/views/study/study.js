// SPDX-License-Identifier: GPL-3.0-or-later
// The Study view: what varies, the studies, the table of the chosen one with its parallel coordinates.
import { ask, post } from '../../base/api.js';
import { fill, h } from '../../base/dom.js';
import { choiceText, dateText, duration } from '../../base/format.js';
import { ACTIVE } from '../../base/jobs.js';
import { documentOf } from '../../base/store.js';
import { progressBar } from '../../jobbar.js';
import { StudyOrder } from './order.js';
import { Coordinates } from './coordinates.js';
import { Rows } from './rows.js';
import { VariantTable } from './variant_table.js';
import { shownSentence } from '../../base/units.js';

const COLUMNS = ['Study', 'Samples', 'State', 'Progress', 'Left', 'Started'];
const RARE = ['Samples', 'Started']; // not on a phone
const PAUSE = 150; // ms between two drawings of the list
const LOOK = 1500; // ms between two looks at the rows of a study that runs

class StudyView {
  #chosen = '';
  #asked = false;
  #shown = '';
  #looked = 0;
  #timer = 0;

  /** @param {import('../../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.order = new StudyOrder(app, job => app.go('study', { job: String(job.id) }));
    this.list = h('table.numbers.jobs');
    this.empty = h(
      'p.empty',
      null,
      'No study has been started yet. What varies stands on the left; all else is the design on the table.',
    );
    this.rows = new Rows();
    this.head = h('.job-head');
    this.count = h('p.figure-note', { role: 'status' });
    this.coordinates = new Coordinates(this.rows);
    this.table = new VariantTable(this.rows, row => this.#pick(row));
    this.picked = h('.picked-variant', { role: 'status' });
    this.detail = h(
      '.job-detail.study-detail',
      { hidden: true },
      this.head,
      this.coordinates.element,
      this.count,
      this.picked,
      this.table.element,
    );
    this.element = h(
      '.design-view.optimize-view.study-view',
      null,
      h('aside.form-pane', { 'aria-label': 'Study' }, this.order.element, this.order.foot),
      h(
        '.figure-pane',
        null,
        h('section.job-list', { 'aria-label': 'Studies' }, this.list, this.empty),
        this.detail,
      ),
    );
    app.jobs.addEventListener('change', () => this.#later());
    this.rows.addEventListener('change', () => this.#drawCount());
  }

  #studies() {
    return [...this.app.jobs.all.values()].filter(job => job.kind === 'study').sort((a, b) => b.id - a.id);
  }

  #later() {
    if (this.#asked || !this.element.isConnected) return;
    this.#asked = true;
    setTimeout(() => {
      this.#asked = false;
      this.#draw();
    }, PAUSE);
  }

  #draw() {
    const studies = this.#studies();
    this.empty.hidden = studies.length > 0;
    this.list.hidden = studies.length === 0;
    if (!this.#chosen && studies.length) this.#chosen = String(studies[0].id);
    fill(
      this.list,
      h(
        'thead',
        null,
        h('tr', null, ...COLUMNS.map(text => h(RARE.includes(text) ? 'th.rare' : 'th', { scope: 'col' }, text))),
      ),
      h('tbody', null, ...studies.map(job => this.#row(job))),
    );
    this.#choose(studies.find(job => String(job.id) === this.#chosen) ?? null);
  }

  /** @param {Api.Job} job */
  #row(job) {
    const left = ACTIVE.includes(job.state) ? job.progress?.seconds_left : null;
    return h(
      String(job.id) === this.#chosen ? 'tr.chosen' : 'tr',
      { 'data-job': job.id, onclick: () => this.app.go('study', { job: String(job.id) }) },
      h('th', { scope: 'row' }, h('button.link', { type: 'button' }, job.name || `study ${job.id}`)),
      h('td.rare', null, choiceText(job.algorithm ?? '')),
      h('td.job-state', null, job.stopping ? 'stopping' : job.state),
      h('td', null, progressBar(job)),
      h('td.number', null, typeof left === 'number' ? duration(left) : ''),
      h('td.rare', null, dateText(job.started ?? job.created)),
    );
  }

  /** @param {Api.Job | null} job */
  #choose(job) {
    this.detail.hidden = !job;
    if (!job) return;
    this.#drawHead(job);
    const active = ACTIVE.includes(job.state);
    const state = `${job.id} ${active}`;
    if (state !== this.#shown || (active && performance.now() - this.#looked > LOOK)) this.#look(job, state);
    else if (active && !this.#timer)
      this.#timer = window.setTimeout(() => {
        this.#timer = 0;
        this.#later();
      }, LOOK);
  }

  /** @param {Api.Job} job @param {string} state */
  async #look(job, state) {
    if (!this.#shown.startsWith(`${job.id} `)) fill(this.picked);
    this.#shown = state;
    this.#looked = Infinity; // until this look is over
    try {
      await this.rows.load(job.id);
    } catch (error) {
      this.count.textContent = /** @type {Error} */ (error).message;
    }
    this.#looked = performance.now();
  }

  /** @param {Api.Job} job */
  #drawHead(job) {
    const active = ACTIVE.includes(job.state);
    /** @type {Partial<Api.JobProgress>} */
    const progress = job.progress ?? {};
    /** @param {string} text @param {() => unknown} act */
    const button = (text, act) => h('button', { type: 'button', onclick: () => this.app.attempt(act) }, text);
    /** @param {'cancel' | 'retry'} verb */
    const act = verb => async () => this.app.jobs.put(await post(`jobs/${job.id}/${verb}`, {}));
    const remove = async () => {
      await ask('DELETE', `jobs/${job.id}`);
      this.app.jobs.remove(job.id);
      this.#chosen = this.#shown = '';
      this.app.jobs.dispatchEvent(new CustomEvent('change', { detail: null }));
      this.app.go('study');
    };
    const facts = [
      active ? progress.what : '',
      active && typeof progress.seconds_left === 'number' ? `${duration(progress.seconds_left)} left` : '',
    ].filter(Boolean);
    fill(
      this.head,
      h('h2', null, job.name || `Study ${job.id}`),
      h('span.facts', null, facts.join(' · ')),
      job.error ? h('span.fault', null, shownSentence(job.error.detail)) : null,
      h(
        'span.actions',
        null,
        h('a.button', { href: `api/v1/studies/${job.id}/table.csv`, download: `study-${job.id}.csv` }, 'CSV'),
        active && !job.stopping ? button('Stop', act('cancel')) : null,
        job.state === 'failed' || job.state === 'cancelled' ? button('Go on', act('retry')) : null,
        active ? null : button('Delete', remove),
      ),
    );
  }

  #drawCount() {
    const { rows } = this;
    const brushes = rows.brushes.size;
    fill(
      this.count,
      `${rows.order.length} of ${rows.count} rows${rows.variants > rows.count ? `, ${rows.variants} variants` : ''}`,
      brushes
        ? h('button.link', { type: 'button', onclick: () => rows.clearBrushes() }, ' show all rows')
        : ' – drag along an axis to keep a range',
    );
  }

  /** A row was clicked: what can be done with its variant. @param {number} row */
  #pick(row) {
    const { app, rows } = this;
    const variant = rows.variant[row];
    const open = async () => {
      const { data } = await ask('GET', `studies/${rows.study}/variants/${variant}/design`);
      app.library.openNew(documentOf({ ...data, name: `${data.name || 'design'}, variant ${variant}` }));
    };
    fill(
      this.picked,
      h('strong', null, `Variant ${variant}`),
      ` ${rows.outcome[row]}${rows.reason[row] ? `: ${shownSentence(rows.reason[row])}` : ''} `,
      h('button', { type: 'button', onclick: () => app.attempt(() => app.opening(open, 'design')) }, 'Open'),
      h(
        'button',
        {
          type: 'button',
          onclick: () =>
            app.attempt(async () => {
              await app.opening(open, 'design');
              app.go('compare', { items: 'unmodified,current' });
            }),
        },
        'Compare',
      ),
    );
  }

  /** @param {URLSearchParams} parameters */
  show(parameters) {
    this.#chosen = parameters.get('job') ?? this.#chosen;
    this.order.refresh();
    this.#draw();
  }
}

/** @param {import('../../app.js').App} app @returns {import('../../app.js').View} */
export function studyView(app) {
  return new StudyView(app);
}
