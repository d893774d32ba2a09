// SPDX-License-Identifier: GPL-3.0-or-later
// The Design view: parameters left, numbers above, figures right; on a narrow screen one below the other.
import { fill, h } from '../base/dom.js';
import { differences } from '../base/pointer.js';
import { units } from '../base/units.js';
import { caseLong, mainCase } from '../figures/context.js';
import { subject } from '../figures/subject.js';
import { Headline } from '../headline.js';
import { verdict, warningList } from '../verdict.js';
import { leadLine } from '../welcome/lead.js';
import { Parameters } from './parameters.js';

const AGAIN = 2000; // ms after which figures that could not be fetched are asked for again

/** @typedef {import('./results.js').Results} Results */

/** @param {import('../form/form.js').Place} place */
const link = ({ name, lead }) => h('button.link', { type: 'button', onclick: lead }, name);

/** What is not possible, each with the way to its field. */
class TroubleLine {
  constructor() {
    this.element = h('.trouble', { role: 'alert', hidden: true });
  }

  /** @param {import('../form/form.js').Trouble[]} troubles @param {string} message without a field */
  show(troubles, message) {
    this.element.hidden = troubles.length === 0 && message === '';
    fill(
      this.element,
      troubles.map(({ name, detail, lead, after }) =>
        h('p', null, [
          lead ? link({ name, lead }) : name,
          name ? `: ${detail}` : detail,
          after.length ? ' It was possible before a change of ' : null,
          after.map((place, i) => [i ? ', ' : '', link(place)]),
          after.length ? '.' : null,
        ]),
      ),
      troubles.length ? null : message,
      this.element.hidden ? null : h('small', null, 'The figures show the last design that was possible.'),
    );
  }
}

class DesignView {
  #drawn = false;
  /** The figures, once they are fetched: the form does not wait for them. @type {Results | null} */
  results = null;

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.parameters = new Parameters(app.store, app.form);
    this.headline = new Headline(app.store);
    this.strip = h('.sensitivity');
    this.figures = h('.figures');
    this.trouble = new TroubleLine();
    this.foot = h('div');
    this.progress = h('.preparing-note', { role: 'status', hidden: true });
    this.element = h(
      '.design-view',
      null,
      h(
        'aside.form-pane',
        { 'aria-label': 'Parameters' },
        h('.form-scroll', null, this.parameters.element),
        this.foot,
        h('.form-foot', null, h('button.primary', { type: 'button', onclick: () => app.go('optimize') }, 'Optimize…')),
      ),
      h('.head-pane', null, leadLine(app), this.headline.element, this.strip, this.trouble.element),
      h('.figure-pane', null, this.progress, this.figures),
    );
    new ResizeObserver(() => {
      const height = `${this.headline.element.offsetHeight}px`;
      this.element.style.setProperty('--headline-height', height);
    }).observe(this.headline.element);
    app.analyst.addEventListener('result', () => {
      this.#drawResult();
      this.#sweep();
    });
    app.analyst.addEventListener('rating', () => this.#drawRating());
    app.analyst.addEventListener('teeth', () => this.#drawTeeth());
    app.analyst.addEventListener('state', () => this.#drawState());
    units.addEventListener('change', () => {
      this.#drawResult();
      this.#drawState();
    });
    app.form.finders.push(pointer => this.#find(pointer));
    this.#fetchFigures();
  }

  async #fetchFigures() {
    try {
      const { Results } = await import('./results.js');
      this.results = new Results(this.app.store);
    } catch {
      setTimeout(() => this.#fetchFigures(), AGAIN);
      return;
    }
    this.strip.replaceWith(this.results.sensitivity.strip);
    this.figures.replaceWith(this.results.element);
    this.#drawResult();
    this.#drawRating();
    this.#sweep();
  }

  /** Fields of the design stand here; those of the search elsewhere. @param {string} pointer */
  #find(pointer) {
    const search = pointer.startsWith('/optimization') || pointer.startsWith('/objective');
    if (!search && this.app.current !== 'design') this.app.go('design');
  }

  /** @returns {import('../figures/context.js').Context | null} */
  #context() {
    const { analyst, store } = this.app;
    const { result } = analyst;
    if (!result) return null;
    const count = result.load_cases.length;
    const chosen = store.loadCase >= 0 && store.loadCase < count ? store.loadCase : mainCase(result.design);
    // another load case has its curves with the full answer, which comes when the slider rests
    if (!analyst.partial) analyst.shown = chosen;
    return { result, references: analyst.references(), loadCase: Math.min(analyst.shown, count - 1) };
  }

  #drawResult() {
    const context = this.#context();
    if (!context) return;
    const { form, store } = this.app;
    subject.set(store.design.name ?? '', context.result);
    form.resolved = context.result.design;
    form.showFindings(context.result.findings ?? []);
    if (context.result.modification) this.parameters.flank.showStarts(context.result);
    this.headline.set(context);
    this.results?.set(context);
    this.#drawTeeth();
    this.#drawTribology();
    if (this.#drawn) return;
    this.#drawn = true;
    form.refresh();
  }

  #drawRating() {
    const { rated } = this.app.analyst;
    if (!rated) return;
    this.results?.rating.set(rated);
    this.headline.rate(rated);
    this.#drawTribology();
  }

  /** The rating is that of the design on the table, which it follows a second later. */
  #rated() {
    const { rated, result } = this.app.analyst;
    return Boolean(rated && rated.design_hash === result?.design_hash);
  }

  #drawTribology() {
    this.results?.tribology.set(this.app.analyst.rated, this.#context()?.loadCase ?? 0, this.#rated());
  }

  #drawTeeth() {
    this.results?.teeth.set(this.app.analyst.teeth, this.#context()?.loadCase ?? 0);
  }

  #drawState() {
    const { analyst, form } = this.app;
    const refused = analyst.state === 'refused';
    const preparing = analyst.state === 'preparing';
    const changed = refused && analyst.possible ? differences(analyst.possible, this.app.store.design) : [];
    const { faults, message } = analyst;
    const whole = faults.length || !message ? faults : [{ pointer: '', detail: message }];
    const troubles = form.showFaults(refused ? whole : [], changed);
    this.trouble.show(troubles, refused && !troubles.length ? message : '');
    this.element.classList.toggle('refused', refused);
    this.element.classList.toggle('preparing', preparing);
    const fraction = analyst.job?.progress?.fraction;
    this.progress.hidden = !preparing;
    if (preparing)
      this.progress.textContent = `Preparing the teeth of this pair, once${
        typeof fraction === 'number' ? `: ${Math.round(100 * fraction)} %` : '…'
      }`;
  }

  #sweep() {
    const { store, analyst } = this.app;
    if (!this.results || !analyst.result || store.faults.size || analyst.state === 'refused') return;
    this.results.speed.set(store.design, store.pin);
    this.results.torque.set(store.design, store.pin);
    this.results.sensitivity.set(store.design);
  }

  show() {
    this.foot.append(this.app.form.help);
    this.app.form.refresh();
    this.#drawResult();
    this.#drawState();
  }

  /** @returns {import('../report.js').Parts | null} */
  report() {
    const context = this.#context();
    const { results } = this;
    if (!context || !results) return null;
    const { store, analyst } = this.app;
    this.#drawResult();
    results.draw();
    this.#sweep();
    const late = [results.speed, results.torque, results.sensitivity].filter(each => !each.settled);
    for (const each of late) each.now();
    const missing = late.map(each => each.chart.frame.title);
    const old = this.#rated() ? [] : results.tribology.frames;
    missing.push(...old.map(frame => frame.title));
    if (analyst.state === 'preparing') missing.push('the teeth of the pair');
    return {
      title: store.design.name || 'Gear pair',
      result: context.result,
      lead: [
        verdict(context.result, context.references[0]),
        h('section', null, warningList(context.result.warnings ?? [], true)),
        h('p', null, `Figures of one load case are those of ${caseLong(context.result.load_cases[context.loadCase])}.`),
      ],
      figures: results.frames.filter(frame => !old.includes(frame)),
      missing,
    };
  }
}

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function designView(app) {
  return new DesignView(app);
}
