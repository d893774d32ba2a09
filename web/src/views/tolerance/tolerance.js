// SPDX-License-Identifier: GPL-3.0-or-later
// The Tolerance view: what scatters in gears as they are made, and what many pairs of this design come to.
import { get, post } from '../../base/api.js';
import { fill, h } from '../../base/dom.js';
import { dateText, duration, labelOf, plain, unitText } from '../../base/format.js';
import { ACTIVE } from '../../base/jobs.js';
import { Lane } from '../../base/lane.js';
import { readQuantity } from '../../base/quantity.js';
import { documentOf } from '../../base/store.js';
import { shownSentence, shownUnit, shownValue, typedText, units } from '../../base/units.js';
import { Chart } from '../../figures/chart.js';
import { group } from '../../form/group.js';
import { progressBar } from '../../jobbar.js';
import { emptyText } from './empty_text.js';
import { influences, inputTable, percentiles, unitOfKey, yields } from './tolerance_tables.js';

const MADE = ['preset', 'class', 'edition', 'centre_distance'];
const DRAWN = ['pairs', 'method', 'sampling', 'seed', 'vibration', 'root_stress', 'single_teeth'];
const LOOKS = {
  preset: { label: 'Scatter' },
  class: { label: 'Tolerance class' },
  edition: { label: 'ISO 1328-1 of' },
  pairs: { label: 'Pairs drawn' },
  method: { label: 'Computed' },
  vibration: { label: 'with their vibration' },
  root_stress: { label: 'with their root stress' },
  centre_distance: { label: 'with the centre distance' },
  single_teeth: { label: 'with teeth of their own' },
};
const FIRST = 64; // pairs of the first answer; a job has all of them
const FIRST_WITH_TEETH = 2; // a hunting period of each
const LIMITS = /** @type {[string, string, string][]} */ ([
  ['peak_to_peak_um', 'TE, at most', 'um'],
  ['rms_m_per_s2', 'Vibration, at most', 'm_per_s2'],
  ['max_pressure_MPa', 'Pressure, at most', 'MPa'],
]);

class ToleranceView {
  /** @type {Api.Tolerance | null} */ #result = null;
  /** Pairs of the answer that is on its way; 0: none. */
  #asked = 0;
  /** The job that draws all pairs; 0: none. */
  #job = 0;
  /** The newest job of the service when something ended here; 0: nothing has. */
  #ended = 0;
  #stopped = false;
  /** The design, as text, that the figures belong to; empty: one that was drawn before this page was opened. */
  #of = '';

  /** @param {import('../../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.fields = app.form.set();
    /** @type {Lane<Api.Tolerance, number>} */
    this.lane = new Lane({
      result: (task, data) => this.#takeFirst(task.note, data),
      refused: (_task, error) => this.#end(error.message),
      preparing: (_task, { progress }) =>
        this.#say(`The teeth are prepared, ${Math.round(100 * (progress?.fraction ?? 0))} %`),
    });
    this.start = h('button.primary', { type: 'button', onclick: () => this.#begin() }, 'Draw the pairs');
    this.stop = h('button', { type: 'button', hidden: true, onclick: () => this.#halt() }, 'Stop');
    this.state = h('p.aside', { role: 'status' });
    this.limits = h('div');
    this.output = h('select', { id: 'tolerance-output', onchange: () => this.#draw() });
    this.histogram = new Chart({
      title: 'Pairs',
      name: 'Distribution over the pairs',
      unit: '',
      xLabel: 'value',
      zero: true,
      wide: true,
      help: 'How many of the pairs lie in each of 25 equal parts; the lines: as drawn, and the 95 % percentile.',
    });
    this.percentiles = h('section.figure.with-table', { tabindex: '0', 'aria-label': 'Percentiles' });
    this.influences = h('section.figure.with-table', { 'aria-label': 'What decides' });
    this.yields = h('section.figure.with-table', { 'aria-label': 'Yield' });
    this.inputs = h('section.figure.with-table.scattering-card', { 'aria-label': 'What scatters' });
    this.notes = h('section.tolerance-notes', { 'aria-label': 'Notes' });
    this.worst = h('button', { type: 'button', onclick: () => this.#openWorst() }, 'Open the worst pair');
    this.empty = h('p.empty');
    this.figures = h(
      '.figures',
      null,
      this.histogram.element,
      this.percentiles,
      this.influences,
      this.yields,
      this.inputs,
    );
    this.head = h('.tolerance-head', null, h('label', { for: 'tolerance-output' }, 'Number '), this.output, this.worst);
    this.element = this.#layOut();
    app.store.addEventListener('change', () => this.#note());
    units.addEventListener('change', () => {
      this.#drawLimits();
      this.#draw();
    });
    app.jobs.addEventListener('change', () => {
      if (this.element.isConnected) this.#recall();
      this.#follow();
    });
    this.#drawLimits();
    this.#draw();
  }

  #layOut() {
    const fields = (/** @type {string[]} */ only) => this.fields.fieldsOf('/tolerance', { only, looks: LOOKS });
    return h(
      '.design-view.tolerance-view',
      null,
      h(
        'aside.form-pane',
        { 'aria-label': 'Gears as made' },
        h(
          '.form-scroll',
          null,
          h(
            'form.parameters',
            {
              'aria-label': 'Gears as made',
              autocomplete: 'off',
              onsubmit: (/** @type {Event} */ event) => event.preventDefault(),
            },
            group('made', 'How the gears are made', true, fields(MADE)),
            group('drawn', 'How they are drawn', true, fields(DRAWN)),
            group('good', 'A good pair has', true, [this.limits]),
          ),
        ),
        h('.form-foot', null, this.start, this.stop, this.state),
      ),
      h(
        '.figure-pane',
        null,
        this.empty,
        this.head,
        this.notes,
        this.figures,
      ),
    );
  }

  /** Limits of all load cases, one for each of a few numbers; others in the document stay. */
  #drawLimits() {
    const { store } = this.app;
    const stated = () => store.design.tolerance?.limits ?? [];
    /** @param {string} key */
    const mine = key => stated().find(limit => limit.output === key && !limit.load_case);
    /** @param {string} key @param {string} text @param {string} unit */
    const change = (key, text, unit) => {
      const others = stated().filter(limit => limit !== mine(key));
      const { value, fault } = readQuantity(typedText(text, unit), unit);
      if (text.trim() !== '' && fault !== undefined) return fault;
      store.set('/tolerance/limits', text.trim() === '' ? others : [...others, { output: key, at_most: value }]);
      return '';
    };
    fill(this.limits);
    for (const [key, label, unit] of LIMITS) {
      const fault = h('span.fault', { role: 'alert' });
      const input = h('input.number', {
        id: `limit-${key}`,
        type: 'text',
        inputmode: 'decimal',
        placeholder: 'any',
        value: plain(shownValue(mine(key)?.at_most, unit)),
        onchange: () => {
          fault.textContent = change(key, input.value, unit);
        },
      });
      this.limits.append(
        h(
          '.field',
          null,
          h('label', { for: input.id }, label),
          h('span.entry', null, input, h('span.unit', null, shownUnit(unitText(unit)))),
          fault,
        ),
      );
    }
  }

  get #wanted() {
    return this.app.store.design.tolerance?.pairs ?? 1000;
  }

  #begin() {
    this.app.form.flush();
    this.#stopped = false;
    this.#of = JSON.stringify(this.app.store.design);
    const first = this.app.store.design.tolerance?.single_teeth ? FIRST_WITH_TEETH : FIRST;
    this.#asked = Math.min(first, this.#wanted);
    this.#lock();
    this.lane.submit({
      path: 'tolerance',
      body: { design: JSON.parse(this.#of), pairs: this.#asked },
      note: this.#asked,
    });
    this.#say(`${this.#asked} pairs are computed`);
  }

  #lock() {
    this.#sayEmpty();
    this.start.disabled = true;
    this.stop.hidden = false;
  }

  /** The first pairs are shown at once. @param {number} pairs @param {Api.Tolerance} data */
  #takeFirst(pairs, data) {
    if (pairs !== this.#asked) return;
    this.#show(data);
    if (this.#stopped || pairs >= this.#wanted) this.#end(this.#stopped ? `Stopped at ${pairs} pairs.` : '');
    else this.#order();
  }

  /** A job of the service for all of them: it goes on when this page is closed. */
  async #order() {
    const body = { design: JSON.parse(this.#of), pairs: this.#wanted };
    try {
      const ticket = await post('tolerance', body, { Prefer: 'respond-async' });
      if (!('job' in ticket) || !ticket.job) return;
      this.#job = ticket.job.id;
      this.app.jobs.put(ticket.job);
      if (this.#stopped) this.#halt();
    } catch (error) {
      this.#end(/** @type {Error} */ (error).message);
    }
  }

  /** Where the job is. */
  #follow() {
    const job = this.app.jobs.all.get(this.#job);
    if (!job) return;
    if (!ACTIVE.includes(job.state)) this.#finish(job);
    else {
      const left = job.progress?.seconds_left;
      const time = typeof left === 'number' ? `, ${duration(left)} left` : '';
      fill(this.state, progressBar(job), ` ${job.progress?.what || job.state}${time}`);
    }
  }

  /** @param {Api.Job} job */
  async #finish(job) {
    this.#job = 0;
    const done = job.state === 'done';
    if (!done && !(job.state === 'cancelled' && job.has_result)) {
      const failed = job.state === 'failed';
      this.#end(failed ? shownSentence(job.error?.detail ?? 'The job failed.') : 'Stopped; what was drawn is kept.');
      return;
    }
    try {
      const result = await get(`jobs/${job.id}/result`);
      if ('pairs' in result) this.#show(result);
      if (done) this.#end(this.#of ? '' : `${job.name}, ${dateText(job.finished)}`);
      else this.#end('Stopped; these are the pairs that were drawn.');
    } catch (error) {
      this.#end(/** @type {Error} */ (error).message);
    }
  }

  /** @param {Api.Tolerance} data */
  #show(data) {
    this.#result = data;
    this.#drawChoice();
    this.#draw();
  }

  #halt() {
    this.#stopped = true;
    if (this.#job)
      post(`jobs/${this.#job}/cancel`, {})
        .then(answer => this.app.jobs.put(answer))
        .catch(error => this.#say(error.message));
    else {
      this.lane.overtake({ path: 'tolerance', body: { design: JSON.parse(this.#of), pairs: 1 } });
      this.#end(this.#result ? `Stopped at ${this.#result.pairs} pairs.` : 'Stopped.');
    }
  }

  /**
   * The newest job, when this page has drawn nothing yet: its pairs, or how far it is. An older one would take the
   * place of how the last one ended.
   */
  #recall() {
    const [newest] = [...this.app.jobs.all.values()]
      .filter(job => job.kind === 'tolerance')
      .filter(job => ACTIVE.includes(job.state) || (job.has_result && job.state !== 'failed'))
      .sort((a, b) => b.id - a.id);
    if (!newest || newest.id <= this.#ended || this.#result || this.#asked || this.#job) return;
    this.#job = newest.id;
    this.#lock();
  }

  /** @param {string} text */
  #end(text) {
    this.#asked = 0;
    this.#ended = Math.max(0, ...this.app.jobs.all.keys());
    this.#sayEmpty();
    this.start.disabled = false;
    this.stop.hidden = true;
    this.#say(text);
  }

  /** @param {string} text */
  #say(text) {
    fill(this.state, text);
  }

  /** The design has changed: what is shown belongs to the one before. */
  #note() {
    this.#sayEmpty();
    if (this.#result && this.#of && !this.#asked && JSON.stringify(this.app.store.design) !== this.#of)
      this.#say('The design has changed since these pairs were drawn.');
  }

  /** While there are no figures: what was chosen, or that they are on their way. */
  #sayEmpty() {
    fill(this.empty, emptyText(this.app.store.design.tolerance, this.#asked + this.#job));
  }

  #drawChoice() {
    const chosen = this.output.value;
    if (!this.#result) return;
    const cases = this.#result.design.load_cases.length;
    fill(
      this.output,
      this.#result.outputs.map(({ key, load_case: k }, i) => {
        const text = `${labelOf(key)}${cases > 1 ? `, load case ${k}` : ''}`;
        return h('option', { value: String(i), selected: String(i) === chosen }, text);
      }),
    );
  }

  #draw() {
    const result = this.#result;
    this.empty.hidden = result !== null;
    this.#sayEmpty();
    this.head.hidden = result === null;
    this.figures.hidden = result === null;
    if (!result) return;
    const output = result.outputs[Number(this.output.value) || 0];
    const unit = unitOfKey(output.key);
    this.#drawHistogram(output, unit);
    fill(this.percentiles, percentiles(result, output, unit));
    fill(this.influences, influences(output));
    fill(this.yields, yields(result.yields));
    this.yields.hidden = result.yields.length === 0;
    fill(this.inputs, inputTable(result));
    fill(
      this.notes,
      result.warnings.map(text => h('p.aside', null, shownSentence(text))),
    );
  }

  /** A step for each part. @param {Api.ScatterOutput} output @param {string} unit */
  #drawHistogram(output, unit) {
    const { least: from, largest: to, count } = output.histogram;
    const width = (to - from) / count.length;
    const x = count.flatMap((_n, i) => [
      from + i * width,
      from + (i + 1) * width * (1 - 1e-9),
    ]);
    const y = count.flatMap(n => [n, n]);
    const high = output.percentiles.find(row => row.percent === 95)?.value;
    const marks = typeof high === 'number' ? [{ x: high, label: '95 %', strong: true }] : [];
    if (output.nominal !== null && output.nominal >= from && output.nominal <= to)
      marks.push({ x: output.nominal, label: 'as drawn', strong: false });
    this.histogram.name({ xLabel: labelOf(output.key), xUnit: unit }, `${labelOf(output.key)}, ${output.rows} pairs`);
    if (to > from)
      this.histogram.set({ x, curves: [{ label: 'pairs', y, colour: 'own', line: 'solid', width: 2 }], marks });
    else this.histogram.frame.say('Every pair has the same value.');
  }

  #openWorst() {
    const { library } = this.app;
    const worst = this.#result?.worst.design;
    if (worst) this.app.opening(() => library.openNew(documentOf(worst)), 'design');
  }

  show() {
    this.#note();
    this.#recall();
    this.#follow();
  }
}

/** @param {import('../../app.js').App} app @returns {import('../../app.js').View} */
export function toleranceView(app) {
  return new ToleranceView(app);
}
