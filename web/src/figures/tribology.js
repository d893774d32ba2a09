// SPDX-License-Identifier: GPL-3.0-or-later
// Flash temperature, specific film thickness and sliding speed over the path of contact.
import { sig } from '../base/format.js';
import { Chart } from './chart.js';
import { END_COLOUR, OWN_COLOUR, caseLong, endsOf } from './context.js';
import { tribologyCurves } from './tribology_curves.js';

const ABSCISSA = { xLabel: 'roll length of the pinion', xUnit: 'mm' };

export class Tribology {
  constructor() {
    this.flash = new Chart({
      title: 'Flash temperature',
      name: 'Flash temperature over the path of contact, after Blok',
      unit: 'K',
      help:
        'How much hotter than the teeth the contact is, the most over the face, from the root of the pinion to its ' +
        'tip. Friction, oil and temperature of the teeth are those of the rating.',
      good: 'Low is good; nothing slides at the pitch point.',
      zero: true,
      ...ABSCISSA,
    });
    this.film = new Chart({
      title: 'Specific film thickness λ',
      name: 'Specific film thickness λ over the path of contact',
      unit: '',
      help:
        'The film thickness of the oil over the roughness R_q of both flanks together, the least over the face, ' +
        'after Dowson and Higginson: isothermal, fully flooded, the oil as warm as the teeth.',
      good: 'Above 1 the film is thicker than the roughness; high is good.',
      zero: true,
      ...ABSCISSA,
    });
    this.sliding = new Chart({
      title: 'Sliding speed',
      name: 'Sliding speed over the path of contact',
      unit: 'm/s',
      help: 'Speed of the pinion’s flank along the profile less that of the gear’s.',
      good: 'Near zero is good.',
      ...ABSCISSA,
    });
    this.charts = [this.flash, this.film, this.sliding];
    this.frames = this.charts.map(chart => chart.frame);
    for (const frame of this.frames) frame.say('It is computed when the design rests.');
  }

  /**
   * @param {Page.Result | null} result with its rating; null before there is one
   * @param {number} index of the load case
   * @param {boolean} fresh of the design on the table, not of the one before
   */
  set(result, index, fresh) {
    for (const frame of this.frames) frame.element.classList.toggle('waiting', Boolean(result) && !fresh);
    const curves = result && tribologyCurves(result, index, endsOf(result));
    if (!curves) return;
    const { roll, pitchPoint, flash, filmRatio, sliding, peak } = curves;
    const marks = [{ x: pitchPoint, label: 'pitch point' }];
    /** @param {import('./tribology_curves.js').EndCurve[]} ends @returns {import('./chart.js').Curve[]} */
    const named = ends => ends.map(({ end, y }) => ({ label: `${end} end`, y, colour: END_COLOUR[end] }));
    const about = caseLong(result.load_cases[index]);
    for (const frame of this.frames) frame.say('');
    this.flash.frame.setCase(`${about}, at most ${sig(peak.flash, 3)} K`);
    this.film.frame.setCase(`${about}, at least ${sig(peak.filmRatio, 3)}`);
    this.sliding.frame.setCase(`${about}, at most ${sig(peak.sliding, 3)} m/s under load`);
    this.flash.set({ x: roll, curves: named(flash), marks });
    this.film.set({ x: roll, curves: named(filmRatio), marks });
    this.sliding.set({ x: roll, curves: [{ label: 'pinion less gear', y: sliding, colour: OWN_COLOUR }], marks });
  }
}
