// SPDX-License-Identifier: GPL-3.0-or-later
// The Rig view: what a rig recorded, what was found in it, and how it compares with the prediction for the design on
// the table.
import { Away, ask, get } from '../../base/api.js';
import { choose } from '../../base/dialog.js';
import { h } from '../../base/dom.js';
import { plain } from '../../base/format.js';
import { units } from '../../base/units.js';

import { Bench } from './bench.js';
import { FitPanel } from './fit.js';
import { partsOf } from './parts.js';
import { Recordings } from './recordings.js';
import { RigFigures, WHAT } from './rig_figures.js';
import { drawAbout, drawMeasurements, drawReductions } from './rig_tables.js';
import { Synthetic } from './synthetic.js';

class RigView {
  #chosen = 0;
  /** The chosen measurement with everything known of it. @type {Api.Measurement | null} */ #whole = null;
  /** @type {Promise<string> | null} */ #storing = null;
  /** Parts of the chosen measurement. @type {{ id: number, element: HTMLElement | null } | null} */ #parts = null;

  /** @param {import('../../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.bench = new Bench(app.store);
    this.recordings = new Recordings({
      designId: () => this.#designId(),
      kept: measurement => {
        this.#chosen = measurement.id;
        this.#whole = measurement;
        this.bench.load().catch(() => {});
      },
      loadCases: () => app.store.design.load_cases ?? [],
    });
    this.fit = new FitPanel(app, () => app.store.from.id);
    this.figures = new RigFigures();
    this.table = h('section.figure.with-table.tall', { 'aria-label': 'Measurements' });
    this.about = h('section.figure.with-table', { 'aria-label': 'About the recording' });
    this.reductions = h('section.figure.with-table', { 'aria-label': 'Reductions' });
    this.note = h('p.trouble', { role: 'status', hidden: true });
    this.empty = emptyBench();
    this.area = this.#area();
    this.element = this.#frame();
    this.#listen();
  }

  #area() {
    const { speed, torque, orders, te, spectrum, turn } = this.figures;
    return h(
      '.figures',
      null,
      this.table,
      speed.element,
      torque.element,
      this.reductions,
      orders.element,
      te.element,
      this.about,
      spectrum.element,
      turn.element,
      this.fit.result,
    );
  }

  #frame() {
    const pane = h(
      '.figure-pane',
      {
        ondragover: (/** @type {DragEvent} */ event) => event.preventDefault(),
        ondrop: (/** @type {DragEvent} */ event) => {
          event.preventDefault();
          this.recordings.add([...(event.dataTransfer?.files ?? [])]);
        },
      },
      this.note,
      this.empty,
      this.area,
    );
    const synthetic = new Synthetic(this.app, this.recordings);
    return h(
      '.design-view.rig-view',
      null,
      h(
        'aside.form-pane',
        { 'aria-label': 'Recordings' },
        h('.form-scroll', null, this.recordings.element, this.fit.element, synthetic.element),
      ),
      pane,
    );
  }

  #listen() {
    const { store } = this.app;
    const isOpen = () => this.app.current === 'rig';
    for (const source of [this.bench, units]) source.addEventListener('change', () => this.#draw());
    this.app.analyst.addEventListener('teeth', () => isOpen() && this.#drawChosen());
    store.addEventListener('change', () => {
      if (isOpen()) this.bench.later();
    });
    store.addEventListener('open', () => {
      if (isOpen()) this.bench.load().catch(() => {});
    });
  }

  /** The number of the stored design that recordings belong to; it is stored first when it is not. */
  #designId() {
    const { store, library } = this.app;
    if (store.from.id) return Promise.resolve(store.from.id);
    this.#storing ??= library
      .storeNew()
      .then(() => {
        this.app.note();
        return store.from.id;
      })
      .finally(() => {
        this.#storing = null;
      });
    return this.#storing;
  }

  /** @param {number} id */
  async #choose(id) {
    this.#chosen = id;
    this.#draw();
    try {
      const measurement = await get(`measurements/${id}`);
      if (this.#chosen !== id) return;
      this.#whole = measurement;
      this.#drawChosen();
    } catch (error) {
      if (!(error instanceof Away)) this.note.textContent = /** @type {Error} */ (error).message;
    }
  }

  /** Kept as long as the recording is the chosen one: a time may be half typed. @param {Api.Measurement} whole */
  #partsOf(whole) {
    if (this.#parts?.id === whole.id) return this.#parts.element;
    const { result } = whole;
    const measure = (/** @type {import('./parts.js').Choice} */ choice) =>
      this.app.attempt(() => this.#measure(whole, choice));
    this.#parts = { id: whole.id, element: result && partsOf(result, measure) };
    return this.#parts.element;
  }

  /**
   * Another part of a recording, as a measurement of its own.
   * @param {Api.Measurement} whole @param {import('./parts.js').Choice} choice
   */
  async #measure({ id, files, label, end, torque_Nm: torque, stated_speed_rpm: speed, asked_layout: layout }, choice) {
    const [file, gear = null] = await Promise.all(
      files.map(async ({ name }, i) => {
        const { data } = await ask('GET', `measurements/${id}/file?part=${i + 1}`, { whole: true });
        return new File([data], name);
      }),
    );
    this.recordings.add([file], {
      gear,
      label,
      torque: torque === null ? '' : plain(torque),
      speed: speed === null ? '' : plain(speed),
      again: { ...choice, end, layout },
    });
    await this.recordings.send();
  }

  /** @param {Api.ListedMeasurement} item */
  async #remove(item) {
    const answer = await choose(
      `Delete the measurement ${item.file} (${plain(item.torque_Nm)} N m)?`,
      ['Its recording goes with it.'],
      [
        { value: 'delete', text: 'Delete', primary: true },
        { value: '', text: 'Keep' },
      ],
    );
    if (answer !== 'delete') return;
    await ask('DELETE', `measurements/${item.id}`);
    if (this.#chosen === item.id) this.#chosen = 0;
    await this.bench.load();
  }

  #draw() {
    const { bench } = this;
    const { items } = bench;
    this.note.textContent = bench.note || bench.leftOut;
    this.note.hidden = this.note.textContent === '';
    this.empty.hidden = items.length > 0;
    this.area.hidden = items.length === 0;
    if (!items.length) return;
    if (!items.some(item => item.id === this.#chosen)) {
      this.#choose(items[0].id);
      return;
    }
    const pick = (/** @type {number} */ id) => this.#choose(id);
    drawMeasurements(this.table, bench, this.#chosen, WHAT, {
      choose: pick,
      remove: item => this.app.attempt(() => this.#remove(item)),
    });
    this.figures.drawPoints(bench, this.#chosen, pick);
    drawReductions(this.reductions, bench, this.#chosen);
    this.#drawChosen();
  }

  /** What single teeth do, of the load case nearest in torque; null where teeth are alike. @param {number} torque */
  #teethAt(torque) {
    const cases = this.app.analyst.teeth?.pitch?.load_cases ?? [];
    const apart = (/** @type {Api.PitchCase} */ row) => Math.abs(Math.log(row.torque_Nm / torque));
    return [...cases].sort((a, b) => apart(a) - apart(b))[0] ?? null;
  }

  #drawChosen() {
    const { bench, figures } = this;
    const item = bench.items.find(each => each.id === this.#chosen);
    if (!item) return;
    figures.drawOrders(bench, item);
    figures.drawTe(bench, item);
    if (this.#whole?.id !== this.#chosen || !this.#whole.result) return;
    figures.drawSpectrum(
      item,
      this.#whole.result,
      Boolean(this.app.store.design.gear_pair?.pinion_teeth),
      this.#teethAt(item.torque_Nm ?? NaN),
    );
    const whole = this.#whole;
    drawAbout(this.about, item, whole, bench.of(item.id), this.#partsOf(whole));
    this.recordings.layout.show(this.#whole.layout);
  }

  show() {
    this.bench.load().catch(error => {
      this.note.hidden = false;
      this.note.textContent = error.message;
    });
  }

  /** @returns {import('../../report.js').Parts} */
  report() {
    const { store, analyst } = this.app;
    const tables = [this.table, this.reductions, this.about].filter(each => !each.hidden && each.childElementCount);
    const copies = tables.map(table => /** @type {HTMLElement} */ (table.cloneNode(true)));
    for (const copy of copies)
      for (const control of copy.querySelectorAll('.actions, .figure-controls')) control.remove();
    return {
      title: `Rig measurements of ${store.design.name || 'this design'}`,
      result: analyst.result,
      lead: this.bench.items.length ? copies : [h('p', null, 'There are no measurements of this design.')],
      figures: this.bench.items.length ? this.figures.frames : [],
      missing: this.bench.items.length && !this.bench.comparison ? ['the comparison with the prediction'] : [],
    };
  }
}

function emptyBench() {
  return h(
    '.empty',
    null,
    h('h2', null, 'Measured and predicted'),
    h(
      'p',
      null,
      'Drop recordings of two encoders here, on the pinion and the gear shaft: one file for each torque and ' +
        'speed, of the unmodified and of the modified pair. They are kept with the design and compared with its ' +
        'prediction at their torque and measured speed.',
    ),
    h('p', null, 'Without a rig at hand, make one under “Synthetic recording”.'),
  );
}

/** @param {import('../../app.js').App} app @returns {import('../../app.js').View} */
export function rigView(app) {
  return new RigView(app);
}
