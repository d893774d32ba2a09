// SPDX-License-Identifier: GPL-3.0-or-later
// What is taken off the flanks, as on an inspection sheet: profile traces upright from root to tip, lead traces along
// the face.
import { colour } from '../base/theme.js';
import { textOf, wayOf } from '../base/relief_start.js';
import { shownValue, unitInstead } from '../base/units.js';
import { fill, h } from '../base/dom.js';
import { flankShown } from '../base/flank_shown.js';
import { switcher } from '../base/switcher.js';
import { Painting, SMALL } from './canvas.js';
import { END_COLOUR, endsOf, faceOf, profileOf } from './context.js';
import { faceRunsLeft, flankOf, hasCoast, sideOf, surfacePlaces } from './flanks.js';
import { tickText } from './ticks.js';

/** Grids over what is taken off, in the unit that is shown: ends at least, whole steps of them, and lines. */
const GRIDS = {
  µm: { least: 10, fine: 10, coarse: 50, steps: [5, 10, 20, 50, 100, 200, 500, 1000] },
  thou: { least: 0.4, fine: 0.2, coarse: 2, steps: [0.2, 0.5, 1, 2, 5, 10, 20, 50] },
};
const gridNow = () => (unitInstead('µm') ? GRIDS.thou : GRIDS.µm);
const LINES = { dashed: [5, 4], dotted: [1.5, 3] };

/** @typedef {{ at: number[], value: number[] }} Trace */

export class ModificationCharts {
  #member = /** @type {Page.Member} */ ('pinion');
  /** Chosen here or worked on in the form; else the flanks that carry. @type {import('./flanks.js').Side | null} */
  #chosen = null;
  #controls = h('span.switches');
  #drawn = '';
  /** @type {import('./context.js').Context | null} */ #context = null;

  constructor() {
    flankShown.addEventListener('change', () => {
      this.#member = flankShown.member;
      this.#chosen = flankShown.side;
      this.#repaint();
    });
    this.profile = new Painting(
      {
        title: 'Profile modification',
        unit: 'µm',
        help:
          'Material taken off along the profile, to the right, as on an inspection sheet (K-chart): root below, ' +
          'tip above.',
        controls: [this.#controls],
      },
      (pen, width, height) => this.#paintProfile(pen, width, height),
      {
        table: () => this.#table('profile_um', 'from the pitch point (mm)'),
        keys: () => this.#keys('profile_um'),
        empty: () => this.#context === null,
      },
    );
    this.lead = new Painting(
      {
        title: 'Lead modification',
        unit: 'µm',
        help: 'Material taken off along the face of each end, downwards.',
      },
      (pen, width, height) => this.#paintLead(pen, width, height),
      {
        table: () => this.#table('lead_um', 'from mid face (mm)'),
        keys: () => this.#keys('lead_um'),
        empty: () => this.#context === null,
      },
    );
    this.elements = [this.profile.element, this.lead.element];
  }

  /** @param {import('./context.js').Context} context */
  set(context) {
    this.#context = context;
    this.#repaint();
  }

  /** @param {'profile_um' | 'lead_um'} what @returns {import('./sheet.js').Key[]} */
  #keys(what) {
    const context = this.#context;
    if (!context) return [];
    const varies = this.#varies(what);
    const edges = what === 'profile_um' ? 'thin: at both face ends' : 'thin: at root and tip';
    return [
      ...endsOf(context.result).map(end => ({ label: `${end} end`, colour: END_COLOUR[end] })),
      ...(varies ? [{ label: edges, colour: 'muted' }] : []),
      ...context.references.map(({ label, line }) => ({ label, line, colour: 'reference' })),
    ];
  }

  /** @returns {import('./flanks.js').Side} */
  get #side() {
    return this.#chosen ?? sideOf(this.#context?.result.load_cases[this.#context.loadCase]);
  }

  /**
   * Said where there are several traces of a flank.
   * @param {Painting} painting @param {'profile_um' | 'lead_um'} what @param {string} text
   */
  #note({ frame }, what, text) {
    frame.aboutWhat = 'Flank';
    frame.note.textContent = text;
    frame.note.hidden = !this.#varies(what);
  }

  /** @param {'profile_um' | 'lead_um'} what */
  #varies(what) {
    return endsOf(/** @type {import('./context.js').Context} */ (this.#context).result).some(
      end => this.#edges(end, what).length,
    );
  }

  #drawControls() {
    const both = Boolean(this.#context && hasCoast(this.#context.result));
    const shape = [this.#member, this.#side, both].join();
    if (shape === this.#drawn) return;
    this.#drawn = shape;
    const members = /** @type {[Page.Member, string][]} */ ([
      ['pinion', 'pinion'],
      ['gear', 'gear'],
    ]);
    const sides = /** @type {['drive' | 'coast', string][]} */ ([
      ['drive', 'drive'],
      ['coast', 'coast'],
    ]);
    fill(
      this.#controls,
      switcher('Member', members, this.#member, value => {
        this.#member = value;
        this.#repaint();
      }),
      both
        ? switcher('Flank', sides, this.#side, value => {
            this.#chosen = value;
            this.#repaint();
          })
        : null,
    );
  }

  #repaint() {
    this.#drawControls();
    if (!this.#context) return;
    const about = this.#side === 'coast' ? `${this.#member}, coast flank` : this.#member;
    this.profile.frame.about = about;
    this.lead.frame.setCase(about);
    this.#note(this.profile, 'profile_um', 'Thick: in mid face; thin: at both face ends.');
    this.#note(this.lead, 'lead_um', 'Thick: at the pitch point; thin: at root and tip.');
    this.profile.repaint();
    this.lead.repaint();
  }

  /**
   * @param {Page.Result} result @param {Page.End} end @param {'profile_um' | 'lead_um'} what @returns {Trace | null}
   */
  #trace(result, end, what) {
    const modification = result?.modification;
    const member = modification?.[this.#member];
    const flank = flankOf(result, this.#member, end, this.#side);
    if (!modification || !member) return null;
    if (!flank) {
      const at = what === 'profile_um' ? profileOf(member, end) : faceOf(modification, end);
      return { at, value: at.map(() => 0) };
    }
    return { at: what === 'profile_um' ? profileOf(member, end) : faceOf(modification, end), value: flank[what] };
  }

  /**
   * Where profiles vary over the face: those of both face ends; leads at root and tip.
   * @param {Page.End} end @param {'profile_um' | 'lead_um'} what @returns {Trace[]}
   */
  #edges(end, what) {
    const { result } = /** @type {import('./context.js').Context} */ (this.#context);
    const surface = flankOf(result, this.#member, end, this.#side)?.surface_um;
    if (!surface) return [];
    const { u, y } = surfacePlaces(result, this.#member, end);
    const [rows, columns] = [surface.length - 1, surface[0].length - 1];
    return what === 'profile_um'
      ? [0, columns].map(j => ({ at: u, value: surface.map(row => row[j]) }))
      : [0, rows].map(i => ({ at: y, value: surface[i] }));
  }

  /** Largest value of all that is drawn, in steps, as it is shown. @param {'profile_um' | 'lead_um'} what */
  #range(what) {
    const context = /** @type {import('./context.js').Context} */ (this.#context);
    let low = 0;
    const { least, fine, coarse } = gridNow();
    let high = least;
    for (const result of [context.result, ...context.references.map(reference => reference.result)]) {
      for (const end of endsOf(context.result)) {
        const edges = result === context.result ? this.#edges(end, what) : [];
        for (const taken of [this.#trace(result, end, what), ...edges].flatMap(trace => trace?.value ?? [])) {
          const value = shownValue(taken, 'µm');
          low = Math.min(low, value);
          high = Math.max(high, value);
        }
      }
    }
    const step = high - low > 2 * coarse ? coarse : fine;
    return { low: Math.floor(low / step) * step, high: Math.ceil(high / step) * step };
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paintProfile(pen, width, height) {
    if (!this.#context?.result.modification) return;
    const ends = endsOf(this.#context.result);
    const range = this.#range('profile_um');
    const box = { left: 34, top: 10, height: height - 40 };
    const gap = 22;
    const panelWidth = (width - box.left - 12 - gap * (ends.length - 1)) / ends.length;
    ends.forEach((end, i) => {
      const left = box.left + i * (panelWidth + gap);
      /** @param {number} value */
      const across = value => left + (panelWidth * (value - range.low)) / (range.high - range.low);
      this.#grid(
        pen,
        range,
        value => [
          [across(value), box.top],
          [across(value), box.top + box.height],
        ],
        value => [across(value), height - 19, 'center'],
      );
      this.#traces(pen, end, 'profile_um', (at, value, trace) => [
        across(value),
        box.top + box.height * (1 - (at - trace.at[0]) / (trace.at[trace.at.length - 1] - trace.at[0])),
      ]);
      this.#starts(pen, end, left, panelWidth, box);
      pen.fillStyle = colour('muted');
      pen.textAlign = 'center';
      pen.fillText(ends.length === 2 ? `${end} end` : 'taken off', left + panelWidth / 2, height - 5);
    });
    pen.textAlign = 'right';
    pen.fillText('tip', box.left - 6, box.top + 8);
    pen.fillText('root', box.left - 6, box.top + box.height);
  }

  /**
   * Where the reliefs start.
   * @param {CanvasRenderingContext2D} pen
   * @param {'left' | 'right'} end
   * @param {number} left
   * @param {number} width
   * @param {{ top: number, height: number }} box
   */
  #starts(pen, end, left, width, box) {
    const { result } = /** @type {import('./context.js').Context} */ (this.#context);
    const trace = this.#trace(result, end, 'profile_um');
    const curves = flankOf(result, this.#member, end, this.#side);
    const drive = result.design.modification?.[this.#member]?.[end];
    const flank = this.#side === 'coast' ? drive?.coast : drive;
    if (!trace || !flank || !curves) return;
    const [bottom, top] = [trace.at[0], trace.at[trace.at.length - 1]];
    pen.strokeStyle = colour('line');
    pen.setLineDash([2, 3]);
    for (const [side, start] of /** @type {const} */ ([
      ['tip', curves.tip_relief_start],
      ['root', curves.root_relief_start],
    ])) {
      if (!start) continue;
      const u = start.u_mm;
      const y = box.top + box.height * (1 - (u - bottom) / (top - bottom));
      pen.beginPath();
      pen.moveTo(left, y);
      pen.lineTo(left + width, y);
      pen.stroke();
      pen.fillStyle = colour('muted');
      pen.textAlign = 'right';
      pen.fillText(textOf(start, wayOf(flank, side)), left + width, side === 'tip' ? y - 3 : y + 10);
    }
    pen.setLineDash([]);
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paintLead(pen, width, height) {
    if (!this.#context?.result.modification) return;
    const ends = endsOf(this.#context.result);
    const row = this.#context.result.load_cases[this.#context.loadCase];
    const range = this.#range('lead_um');
    const box = { left: 34, top: 10, height: height - 34 };
    const gap = 22;
    const panelWidth = (width - box.left - 12 - gap * (ends.length - 1)) / ends.length;
    /** @param {number} value */
    const down = value => box.top + (box.height * (value - range.low)) / (range.high - range.low);
    ends.forEach((end, i) => {
      const left = box.left + i * (panelWidth + gap);
      this.#grid(
        pen,
        range,
        value => [
          [left, down(value)],
          [left + panelWidth, down(value)],
        ],
        i === 0 ? value => [box.left - 5, down(value) + 3, 'right'] : undefined,
      );
      const mirrored = faceRunsLeft(row, end, ends.length === 2);
      this.#traces(pen, end, 'lead_um', (at, value, trace) => {
        const part = (at - trace.at[0]) / (trace.at[trace.at.length - 1] - trace.at[0]);
        return [left + panelWidth * (mirrored ? 1 - part : part), down(value)];
      });
      pen.fillStyle = colour('muted');
      pen.textAlign = 'center';
      pen.fillText(ends.length === 2 ? `${end} end` : 'left … face … right', left + panelWidth / 2, height - 5);
    });
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {{ low: number, high: number }} range
   * @param {(value: number) => number[][]} line
   * @param {((value: number) => [number, number, string]) | undefined} label
   */
  #grid(pen, range, line, label) {
    const step = niceStep(range.high - range.low);
    pen.font = SMALL;
    pen.lineWidth = 1;
    for (let k = 0; range.low + k * step <= range.high + 1e-9; k++) {
      const value = Number((range.low + k * step).toPrecision(9));
      const [from, to] = line(value);
      pen.strokeStyle = colour(Math.abs(value) < 1e-9 ? 'mark' : 'grid');
      pen.beginPath();
      pen.moveTo(from[0], from[1]);
      pen.lineTo(to[0], to[1]);
      pen.stroke();
      if (!label) continue;
      const [x, y, align] = label(value);
      pen.fillStyle = colour('muted');
      pen.textAlign = /** @type {CanvasTextAlign} */ (align);
      pen.fillText(tickText(value), x, y);
    }
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {'left' | 'right'} end
   * @param {'profile_um' | 'lead_um'} what
   * @param {(at: number, value: number, trace: Trace) => [number, number]} place
   */
  #traces(pen, end, what, place) {
    const context = /** @type {import('./context.js').Context} */ (this.#context);
    /** @param {Trace | null} trace @param {number[]} dash @param {number} width */
    const draw = (trace, dash, width) => {
      if (!trace) return;
      pen.setLineDash(dash);
      pen.lineWidth = width;
      pen.strokeStyle = colour(END_COLOUR[end]);
      pen.beginPath();
      trace.at.forEach((at, i) => {
        const [x, y] = place(at, shownValue(trace.value[i], 'µm'), trace);
        if (i === 0) pen.moveTo(x, y);
        else pen.lineTo(x, y);
      });
      pen.stroke();
      pen.setLineDash([]);
    };
    for (const reference of context.references)
      draw(this.#trace(reference.result, end, what), LINES[reference.line], 1.25);
    for (const edge of this.#edges(end, what)) draw(edge, [], 0.75);
    draw(this.#trace(context.result, end, what), [], 2);
  }

  /** @param {'profile_um' | 'lead_um'} what @param {string} place @returns {(string | number | null)[][]} */
  #table(what, place) {
    const context = this.#context;
    if (!context) return [];
    const ends = endsOf(context.result);
    const traces = ends.map(end => this.#trace(context.result, end, what));
    const first = traces[0];
    if (!first) return [];
    return [
      [place, ...ends.map(end => `${this.#member} ${end} (µm)`)],
      ...first.at.map((at, i) => [at, ...traces.map(trace => trace?.value[i] ?? null)]),
    ];
  }
}

/** @param {number} span */
function niceStep(span) {
  const { steps } = gridNow();
  return steps.find(step => span / step <= 5.001) ?? steps[steps.length - 1];
}
