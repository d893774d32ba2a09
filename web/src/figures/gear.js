// SPDX-License-Identifier: GPL-3.0-or-later
// Transverse section at mid face: teeth in mesh, line of action, points of contact; the modification drawn larger than
// it is.
import { halfAngle, halfTooth } from '../base/involute.js';
import { phase } from '../base/phase.js';
import { colour } from '../base/theme.js';
import { Painting, SMALL } from './canvas.js';
import { flankOf, sideOf, valueAtPlace } from './flanks.js';

const AROUND = 3; // teeth drawn on either side
const SCALES = [200, 100, 50, 20];

/** @typedef {[number, number]} Point */
/** @typedef {{ plain: Point[][], active: Point[][], modified: Point[][] }} Teeth half profiles of both members */

export class GearDrawing {
  /** @type {Page.Result | null} */ #result = null;
  /** @type {Teeth | null} */ #teeth = null;
  #scale = 100;
  /** The flanks that carry. @type {import('./flanks.js').Side} */ #side = 'drive';

  constructor() {
    this.painting = new Painting(
      {
        title: 'Teeth in mesh',
        help:
          'Transverse section at mid face, the pinion above. The line of action with the points of contact; in ' +
          'colour what the modification takes off the flanks that carry, drawn larger.',
      },
      (pen, width, height) => this.#paint(pen, width, height),
      { label: 'Transverse section of the teeth in mesh', empty: () => this.#result === null },
    );
    this.elements = [this.painting.element];
    phase.addEventListener('change', () => this.painting.repaint());
  }

  /** @param {import('./context.js').Context} context */
  set({ result, loadCase }) {
    this.#result = result;
    this.#side = sideOf(result.load_cases[loadCase]);
    this.#teeth = null;
    this.painting.repaint();
  }

  /** Half profiles of both members, without and with the modification of the left end. */
  #profiles() {
    if (this.#teeth) return this.#teeth;
    if (!this.#result) return null;
    const result = this.#result;
    const { geometry: g, design, modification } = result;
    /** @param {Page.Member} member */
    const profileOf = member => flankOf(result, member, 'left', this.#side)?.profile_um;
    const largest = Math.max(1, ...(profileOf('pinion') ?? []), ...(profileOf('gear') ?? []));
    this.#scale = SCALES.find(scale => (scale * largest) / 1000 < 0.2 * g.normal_module_mm) ?? 10;
    /** @param {0 | 1} index @param {Page.Member} member */
    const modified = (index, member) => {
      const [places, profile] = [modification?.[member]?.u_mm, profileOf(member)];
      return halfTooth(
        g,
        design.gear_pair,
        index,
        sigma => (this.#scale / 1000) * valueAtPlace(places, profile, g.rack_factor * sigma),
      );
    };
    this.#teeth = {
      plain: [halfTooth(g, design.gear_pair, 0), halfTooth(g, design.gear_pair, 1)],
      active: [halfTooth(g, design.gear_pair, 0, () => 0), halfTooth(g, design.gear_pair, 1, () => 0)],
      modified: [modified(0, 'pinion'), modified(1, 'gear')],
    };
    return this.#teeth;
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    if (!this.#result?.geometry) return;
    const g = this.#result.geometry;
    const scale = height / (4.9 * g.transverse_module_mm);
    /** Lengths round the pitch point to pixels. @param {Point} point @returns {Point} */
    const place = ([x, y]) => [width / 2 + x * scale, height / 2 - y * scale];
    const pressure = (g.working_pressure_angle_deg * Math.PI) / 180;
    const centres = [g.working_radius_mm[0], -g.working_radius_mm[1]];
    const c = (phase.value ?? 0.25) * g.transverse_base_pitch_mm;
    const teeth = this.#profiles();
    if (!teeth) return;
    pen.save();
    pen.beginPath();
    pen.rect(0, 0, width, height); // the circles are larger than the picture
    pen.clip();
    for (const member of /** @type {(0 | 1)[]} */ ([1, 0]))
      this.#paintMember(pen, member, teeth, centres[member], pressure, c, place);
    this.#paintAction(pen, pressure, c, place);
    pen.restore();
    pen.fillStyle = colour('muted');
    pen.font = SMALL;
    pen.textAlign = 'left';
    pen.fillText(`taken off × ${this.#scale}`, 8, height - 7);
    pen.fillText('pinion', 8, 14);
    pen.textAlign = 'right';
    pen.fillText('gear', width - 8, height - 7);
  }

  /**
   * @param {CanvasRenderingContext2D} pen @param {0 | 1} member @param {Teeth} teeth
   * @param {number} centre height above the pitch point
   * @param {number} pressure @param {number} c @param {(point: Point) => Point} place
   */
  #paintMember(pen, member, teeth, centre, pressure, c, place) {
    if (!this.#result) return;
    const g = this.#result.geometry;
    const count = member === 0 ? g.pinion_teeth : g.gear_teeth;
    const touch = /** @type {Point} */ ([c * Math.cos(pressure), -c * Math.sin(pressure) - centre]);
    const radius = Math.hypot(...touch);
    // the middle of the tooth that touches at c; its loaded flank is on the counterclockwise side of both members
    const middle = Math.atan2(touch[1], touch[0]) - halfAngle(g, member, radius);
    /** @param {Point[]} half @param {number} side @param {number} tooth */
    const turned = (half, side, tooth) =>
      half.map(([x, y]) => {
        const angle = middle + (tooth * 2 * Math.PI) / count - Math.PI / 2;
        const [px, py] = [-side * x, y];
        return /** @type {Point} */ ([
          px * Math.cos(angle) - py * Math.sin(angle),
          px * Math.sin(angle) + py * Math.cos(angle) + centre,
        ]);
      });
    pen.beginPath();
    const inner = g.root_radius_mm[member] - 3 * g.normal_module_mm;
    for (let k = -AROUND; k <= AROUND; k++) {
      const outline = [...turned(teeth.plain[member], -1, k), ...turned(teeth.plain[member], 1, k).reverse()];
      for (const [i, point] of outline.entries()) {
        if (k === -AROUND && i === 0) pen.moveTo(...place(point));
        else pen.lineTo(...place(point));
      }
    }
    for (const k of [AROUND + 0.5, 0, -AROUND - 0.5]) {
      const angle = middle + (k * 2 * Math.PI) / count;
      pen.lineTo(...place([Math.max(inner, 0) * Math.cos(angle), Math.max(inner, 0) * Math.sin(angle) + centre]));
    }
    pen.closePath();
    pen.fillStyle = colour(member === 0 ? 'pinion' : 'gear');
    pen.fill();
    pen.strokeStyle = colour('text');
    pen.lineWidth = 1;
    pen.stroke();
    // what the modification takes off the loaded flank
    pen.fillStyle = colour('taken');
    for (let k = -AROUND; k <= AROUND; k++) {
      pen.beginPath();
      for (const point of [...turned(teeth.active[member], 1, k), ...turned(teeth.modified[member], 1, k).reverse()])
        pen.lineTo(...place(point));
      pen.closePath();
      pen.fill();
    }
    pen.setLineDash([3, 3]);
    pen.strokeStyle = colour('muted');
    pen.beginPath();
    const [x, y] = place([0, centre]);
    pen.arc(x, y, Math.abs(place([0, g.working_radius_mm[member]])[1] - place([0, 0])[1]), 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([]);
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {number} pressure
   * @param {number} c
   * @param {(point: Point) => Point} place
   */
  #paintAction(pen, pressure, c, place) {
    if (!this.#result) return;
    const g = this.#result.geometry;
    /** @param {number} s @returns {Point} */
    const at = s => place([s * Math.cos(pressure), -s * Math.sin(pressure)]);
    pen.strokeStyle = colour('accent');
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(...at(-g.tangent_length_mm[0]));
    pen.lineTo(...at(g.tangent_length_mm[1]));
    pen.stroke();
    pen.lineWidth = 2.5;
    pen.beginPath();
    pen.moveTo(...at(g.path_start_mm));
    pen.lineTo(...at(g.path_end_mm));
    pen.stroke();
    pen.fillStyle = colour('bad');
    for (let k = -4; k <= 4; k++) {
      const s = c + k * g.transverse_base_pitch_mm;
      if (s < g.path_start_mm || s > g.path_end_mm) continue;
      pen.beginPath();
      pen.arc(...at(s), 3.5, 0, 2 * Math.PI);
      pen.fill();
    }
  }
}
