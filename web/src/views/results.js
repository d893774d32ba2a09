// SPDX-License-Identifier: GPL-3.0-or-later
// Every figure of a result, kept in step; fetched when the form stands.
import { fill, h } from '../base/dom.js';
import { Contact } from '../figures/contact.js';
import { GearDrawing } from '../figures/gear.js';
import { Impact } from '../figures/impact.js';
import { RootStress, Sharing, Stiffness } from '../figures/mesh.js';
import { ModificationCharts } from '../figures/modification.js';
import { Sensitivity } from '../figures/sensitivity.js';
import { SingleTeeth } from '../figures/single_teeth.js';
import { SpeedSweep, TorqueSweep } from '../figures/sweeps.js';
import { Topography } from '../figures/topography.js';
import { Rating } from '../figures/rating.js';
import { Transmission } from '../figures/transmission.js';
import { Tribology } from '../figures/tribology.js';
import { Vibration } from '../figures/vibration.js';
import { warningList } from '../verdict.js';
import { shownSentence } from '../base/units.js';

export class Results {
  /** @type {import('../figures/context.js').Context | null} */ #context = null;
  #asked = false;
  #warnings = '';

  /** @param {import('../base/store.js').DesignStore} store */
  constructor(store) {
    const again = () => this.#later();
    const transmission = new Transmission(again);
    const contact = new Contact();
    const stiffness = new Stiffness(again);
    const sharing = new Sharing(again);
    const impact = new Impact();
    const vibration = new Vibration(again);
    const root = new RootStress(again);
    const charts = new ModificationCharts();
    const topography = new Topography();
    const drawing = new GearDrawing();
    this.sensitivity = new Sensitivity(store);
    this.rating = new Rating();
    this.tribology = new Tribology();
    this.speed = new SpeedSweep(store);
    this.torque = new TorqueSweep();
    this.teeth = new SingleTeeth();
    this.figures = [transmission, contact, stiffness, sharing, impact, vibration, root, charts, topography, drawing];
    this.notes = h('section.notes', { 'aria-label': 'Warnings' });
    /** In the order of the page and of the report. */
    this.frames = [
      transmission.chart.frame,
      contact.painting.frame,
      transmission.orders.frame,
      vibration.cycle.frame,
      vibration.orders.frame,
      impact.frame,
      this.sensitivity.chart.frame,
      this.speed.chart.frame,
      this.torque.chart.frame,
      stiffness.chart.frame,
      sharing.chart.frame,
      root.chart.frame,
      this.rating.frame,
      ...this.tribology.frames,
      ...this.teeth.frames,
      charts.profile.frame,
      charts.lead.frame,
      drawing.painting.frame,
      topography.painting.frame,
    ];
    this.element = h(
      '.figures',
      null,
      this.frames.map(frame => frame.element),
      this.notes,
    );
  }

  /** @param {import('../figures/context.js').Context} context */
  set(context) {
    this.#context = context;
    this.#later();
  }

  /** The newest context at the next frame; what came between is never drawn. */
  #later() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.draw();
    });
  }

  draw() {
    const context = this.#context;
    if (!context) return;
    for (const figure of this.figures) figure.set(context);
    this.speed.show(context);
    const warnings = context.result.warnings ?? [];
    const text = warnings.map(shownSentence).join('\n');
    if (text === this.#warnings) return;
    this.#warnings = text;
    fill(this.notes, warningList(warnings));
  }
}
