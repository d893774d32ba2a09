// SPDX-License-Identifier: GPL-3.0-or-later
// Single teeth over the hunting period: their deviations, the transmission error over whole revolutions, the orders of
// both shafts and of the mesh with its sidebands, what each tooth carries.
import { switcher } from '../base/switcher.js';
import { Chart } from './chart.js';
import { END_COLOUR, caseColour, caseLong, caseNames, counting, endsOf, lessMean } from './context.js';

const MEMBERS = /** @type {Page.Member[]} */ (['pinion', 'gear']);
const LEAST = 1e-5; // of the largest line: smaller ones are left at the bottom

/** @param {Page.Member} member @returns {[Page.Member, string][]} */
const named = member => [[member, member]];

export class SingleTeeth {
  #member = /** @type {Page.Member} */ ('pinion');
  #reading = /** @type {keyof Omit<Api.PitchSpectrum, 'step'>} */ ('lte_um');
  /** @type {Page.Result | null} */ #result = null;
  #loadCase = 0;

  constructor() {
    const again = () => this.#draw();
    /** @param {string} label */
    const members = label =>
      switcher(label, MEMBERS.flatMap(named), this.#member, value => {
        this.#member = value;
        again();
      });
    this.deviations = new Chart({
      title: 'Index deviations',
      name: 'Index deviations of the teeth',
      unit: 'µm',
      help:
        'How far the flank of each tooth stands from its place, with eccentricity and wobble; + comes into ' +
        'contact earlier. The total F_p is the distance from lowest to highest.',
      good: 'Small is good.',
      xLabel: 'tooth',
      whole: true,
      controls: [members('Teeth of')],
    });
    this.period = new Chart({
      title: 'Loaded TE over the hunting period',
      unit: 'µm',
      help:
        'The loaded transmission error of the pair until the same teeth meet again, less its mean, at the chosen ' +
        'load case. Drag over a part to see its mesh cycles.',
      good: 'Flat is good.',
      xLabel: 'revolutions of the pinion',
      wide: true,
    });
    this.spectrum = new Chart({
      title: 'Orders of shafts and mesh',
      name: 'Orders over the hunting period',
      unit: '',
      help:
        'Amplitude over the order per revolution of the pinion: shaft orders low, mesh orders at multiples of its ' +
        'teeth with sidebands at the distance of the shafts next to them. µm of the transmission error, m/s² of the ' +
        'normal or rotational acceleration that it excites.',
      good: 'Small is good; sidebands next to a mesh order are heard as roughness.',
      xLabel: 'order per revolution of the pinion',
      wide: true,
      zero: true,
      controls: [
        switcher(
          'Spectrum of',
          [
            ['lte_um', 'TE'],
            ['normal_m_per_s2', 'normal'],
            ['rotational_m_per_s2', 'rotat.'],
          ],
          this.#reading,
          value => {
            this.#reading = value;
            again();
          },
        ),
      ],
    });
    this.loads = new Chart({
      title: 'Largest load of each tooth',
      unit: 'N',
      help: 'The largest normal force that each tooth carries in the hunting period, at the chosen load case.',
      good: 'Even is good: a tooth that stands out carries for its neighbours.',
      xLabel: 'tooth',
      whole: true,
      controls: [members('Loads of')],
    });
    this.charts = [this.period, this.spectrum, this.deviations, this.loads];
    this.frames = this.charts.map(chart => chart.frame);
    this.#hide(true);
  }

  /** @param {boolean} hidden */
  #hide(hidden) {
    for (const chart of this.charts) chart.element.hidden = hidden;
  }

  /** @param {Page.Result | null} result with its pitch; null: teeth are alike @param {number} loadCase */
  set(result, loadCase) {
    this.#result = result;
    this.#loadCase = loadCase;
    this.#draw();
  }

  #draw() {
    const result = this.#result;
    const pitch = result?.pitch;
    this.#hide(!pitch);
    if (!result || !pitch) return;
    const chosen = pitch.load_cases[Math.min(this.#loadCase, pitch.load_cases.length - 1)];
    this.#drawDeviations(result, pitch);
    this.#drawPeriod(pitch, chosen);
    this.#drawSpectrum(result, pitch);
    this.#drawLoads(result, chosen);
  }

  /** @param {Page.Result} result @param {Api.Pitch} pitch */
  #drawDeviations(result, pitch) {
    const curves = endsOf(result).flatMap(end =>
      /** @type {const} */ (['drive', 'coast']).flatMap(side => {
        const flank = pitch.deviations[this.#member][end]?.[side];
        if (!flank) return [];
        const label = side === 'coast' ? `${end} end, coast` : `${end} end`;
        return [{ label, y: flank.index_um, colour: END_COLOUR[end], ...(side === 'coast' && { line: 'dashed' }) }];
      }),
    );
    this.deviations.frame.about = this.#member;
    this.deviations.set({
      x: counting(curves[0]?.y.length ?? 0),
      curves: /** @type {import('./chart.js').Curve[]} */ (curves),
    });
  }

  /** @param {Api.Pitch} pitch @param {Api.PitchCase} chosen */
  #drawPeriod(pitch, chosen) {
    const y = chosen.lte.pair_um;
    if (!y) return;
    const perTurn = y.length / pitch.pinion_revolutions;
    this.period.frame.setCase(caseLong(chosen));
    this.period.set({
      x: counting(y.length).map(i => i / perTurn),
      curves: [{ label: 'pair', y: lessMean(y), colour: 'own' }],
    });
  }

  /**
   * All load cases: lines too small to see are left out, so that the curve stays a light one.
   * @param {Page.Result} result @param {Api.Pitch} pitch
   */
  #drawSpectrum(result, pitch) {
    const names = caseNames(result.load_cases);
    /** @type {import('./chart.js').Curve[]} */
    const curves = [];
    let step = 1;
    let longest = 0;
    pitch.load_cases.forEach(({ spectrum }, k) => {
      const lines = spectrum?.[this.#reading];
      if (!lines) return;
      const most = Math.max(...lines.slice(1));
      step = spectrum.step;
      longest = Math.max(longest, lines.length);
      const y = lines.map((/** @type {number} */ value, /** @type {number} */ i) =>
        i > 0 && value > LEAST * most ? value : 0,
      );
      curves.push({ label: names[k], y, colour: caseColour(k) });
    });
    this.spectrum.name({ unit: this.#reading === 'lte_um' ? 'µm' : 'm/s²' });
    this.spectrum.frame.about = 'all load cases';
    this.spectrum.set({ x: counting(longest).map(i => i * step), curves });
  }

  /** @param {Page.Result} result @param {Api.PitchCase} chosen */
  #drawLoads(result, chosen) {
    const ends = chosen.teeth?.[this.#member];
    if (!ends) return;
    this.loads.frame.setCase(caseLong(chosen));
    this.loads.set({
      x: counting(ends.left.load_N.length),
      curves: endsOf(result).map(end => ({ label: `${end} end`, y: ends[end]?.load_N ?? [], colour: END_COLOUR[end] })),
    });
  }
}
