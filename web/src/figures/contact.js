// SPDX-License-Identifier: GPL-3.0-or-later
// Contact pattern and pressure of both ends on the plane of action's flank coordinates: the face across, root to tip
// upwards.
import { fill, h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { phase } from '../base/phase.js';
import { colour } from '../base/theme.js';
import { inInches, shownUnit, shownValue } from '../base/units.js';
import { Painting, SMALL } from './canvas.js';
import { gridValue, scaleColour } from './colours.js';
import { caseLong, endsOf, faceOf, leanOf, rightPhase, sameCase } from './context.js';
import { runsLeft } from './flanks.js';
import { placeTip } from './frame.js';

const PIXELS = [132, 76]; // of one end's picture
const EDGE = 5; // height of the strip of a tip edge

/** @typedef {{ left: number, top: number, width: number, height: number, mirrored: boolean }} Panel */

export class Contact {
  /** @type {import('./context.js').Context | null} */ #context = null;
  #most = 1;
  #pictures = { left: document.createElement('canvas'), right: document.createElement('canvas') };
  /** @type {Partial<Record<Page.End, Panel>>} */ #panels = {};

  constructor() {
    this.painting = new Painting(
      {
        title: 'Contact pressure',
        unit: 'MPa',
        help:
          'Largest contact pressure at each place of the pinion flank over the mesh cycle. Dashed: where the ' +
          'pair it is compared with carries load; lines: the contact lines at the pointer.',
        good: 'Load in the middle of the flank, none on tip, root and face ends.',
      },
      (pen, width, height) => this.#paint(pen, width, height),
      {
        table: () => this.#table(),
        label: 'Map of the contact pressure on both ends',
        empty: () => !this.#pattern(),
      },
    );
    this.elements = [this.painting.element];
    this.tip = h('.tip', { hidden: true });
    this.painting.frame.body.append(this.tip);
    phase.addEventListener('change', () => this.painting.repaint());
    this.painting.canvas.addEventListener('pointermove', event => this.#read(event));
    this.painting.canvas.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
      phase.set(null);
    });
  }

  /** @param {import('./context.js').Context} context */
  set(context) {
    this.#context = context;
    const pattern = this.#pattern();
    if (!pattern) return;
    const before = sameCase(
      context.references[0]?.result,
      context.result.load_cases[context.loadCase],
      context.loadCase,
    );
    this.#most = Math.max(peak(context.result.load_cases[context.loadCase]), before ? peak(before) : 0, 1);
    const row = context.result.load_cases[context.loadCase];
    const peaks = endsOf(context.result).map(end => `${end} end ${sig(row.contact.max_pressure_MPa[end], 4)} MPa`);
    this.painting.frame.setCase(caseLong(row));
    this.painting.describe(`Contact pressure on the pinion flank, largest: ${peaks.join(', ')}.`);
    this.painting.repaint();
  }

  /** @returns {Page.Pattern | null} null: not in the answer, or not found */
  #pattern() {
    const pattern = this.#context?.result.load_cases[this.#context.loadCase]?.contact?.pattern;
    return pattern?.s_mm ? /** @type {Page.Pattern} */ (pattern) : null;
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    const pattern = this.#pattern();
    const context = this.#context;
    if (!pattern || !context) return;
    const ends = endsOf(context.result);
    const frame = { left: 34, top: 16, right: 46, bottom: 20 };
    const gap = ends.length === 2 ? 16 : 0;
    const panelWidth = (width - frame.left - frame.right - gap) / ends.length;
    const panelHeight = height - frame.top - frame.bottom;
    ends.forEach((end, i) => {
      const panel = {
        left: frame.left + i * (panelWidth + gap),
        top: frame.top,
        width: panelWidth,
        height: panelHeight,
        mirrored: runsLeft(context.result.load_cases[context.loadCase], end, ends.length === 2),
      };
      this.#panels[end] = panel;
      this.#paintEnd(pen, end, panel);
      pen.fillStyle = colour('muted');
      pen.font = SMALL;
      pen.textAlign = 'center';
      const name = ends.length === 2 ? `${end} end` : 'left … face … right';
      pen.fillText(name, panel.left + panel.width / 2, height - 6);
      const most = context.result.load_cases[context.loadCase].contact.max_pressure_MPa[end];
      pen.fillText(`max ${sig(most, 4)}`, panel.left + panel.width / 2, 11);
    });
    this.#paintScale(pen, width, frame.top, panelHeight);
    pen.textAlign = 'right';
    pen.fillText('tip', frame.left - 5, frame.top + 8);
    pen.fillText('root', frame.left - 5, frame.top + panelHeight);
  }

  /** @param {CanvasRenderingContext2D} pen @param {'left' | 'right'} end @param {Panel} panel */
  #paintEnd(pen, end, panel) {
    const side = this.#pattern()?.[end];
    if (!side) return;
    const picture = this.#pictures[end];
    paintGrid(picture, side.pressure_MPa, this.#most, panel.mirrored);
    pen.fillStyle = colour('sunken');
    pen.fillRect(panel.left, panel.top, panel.width, panel.height);
    pen.imageSmoothingEnabled = true;
    pen.drawImage(picture, panel.left, panel.top, panel.width, panel.height);
    this.#paintEdges(pen, side, panel);
    this.#paintOutlines(pen, end, panel);
    this.#paintLines(pen, end, panel);
    pen.strokeStyle = colour('line');
    pen.lineWidth = 1;
    pen.strokeRect(panel.left, panel.top, panel.width, panel.height);
  }

  /**
   * The pinion's tip edge above, the gear's (the pinion's root) below.
   * @param {CanvasRenderingContext2D} pen
   * @param {Page.PatternEnd} pattern
   * @param {Panel} panel
   */
  #paintEdges(pen, pattern, panel) {
    const step = panel.width / pattern.pinion_tip_edge_MPa.length;
    for (const [key, top] of /** @type {['pinion_tip_edge_MPa' | 'gear_tip_edge_MPa', number][]} */ ([
      ['pinion_tip_edge_MPa', panel.top],
      ['gear_tip_edge_MPa', panel.top + panel.height - EDGE],
    ])) {
      pattern[key].forEach((value, j) => {
        if (!value || value < 0) return;
        const column = panel.mirrored ? pattern[key].length - 1 - j : j;
        pen.fillStyle = `rgb(${scaleColour(value / this.#most)
          .map(Math.round)
          .join()})`;
        pen.fillRect(panel.left + column * step, top, step + 0.5, EDGE);
      });
    }
  }

  /**
   * Where the reference carries load.
   * @param {CanvasRenderingContext2D} pen
   * @param {'left' | 'right'} end
   * @param {Panel} panel
   */
  #paintOutlines(pen, end, panel) {
    const context = /** @type {import('./context.js').Context} */ (this.#context);
    const reference = context.references[0];
    const other =
      reference && sameCase(reference.result, context.result.load_cases[context.loadCase], context.loadCase);
    const grid = other?.contact?.pattern?.[end]?.pressure_MPa;
    if (!grid) return;
    pen.strokeStyle = colour('text');
    pen.lineWidth = 1;
    pen.setLineDash([4, 3]);
    pen.beginPath();
    outline(
      grid,
      0.02 * this.#most,
      (row, column) => [
        panel.left + (panel.mirrored ? 1 - column : column) * panel.width,
        panel.top + (1 - row) * panel.height,
      ],
      pen,
    );
    pen.stroke();
    pen.setLineDash([]);
  }

  /**
   * Contact lines s = c + eta tan(beta_b) at the phase of the pointer.
   * @param {CanvasRenderingContext2D} pen
   * @param {'left' | 'right'} end
   * @param {Panel} panel
   */
  #paintLines(pen, end, panel) {
    if (phase.value === null) return;
    const { result } = /** @type {import('./context.js').Context} */ (this.#context);
    const { geometry } = result;
    const pattern = this.#pattern();
    if (!pattern) return;
    const [low, high] = [pattern.s_mm[0], pattern.s_mm[pattern.s_mm.length - 1]];
    const half = -faceOf(pattern, end)[0];
    const pitch = geometry.transverse_base_pitch_mm;
    const lean = leanOf(result, end);
    const at = phase.value + (end === 'right' ? rightPhase(result) : 0);
    pen.save();
    pen.beginPath();
    pen.rect(panel.left, panel.top, panel.width, panel.height);
    pen.clip();
    pen.strokeStyle = colour('text');
    pen.lineWidth = 1.25;
    pen.beginPath();
    for (let k = -6; k <= 6; k++) {
      for (const eta of [-half, half]) {
        const s = (at + k) * pitch + eta * lean;
        const across = (eta + half) / (2 * half);
        const x = panel.left + (panel.mirrored ? 1 - across : across) * panel.width;
        const y = panel.top + (1 - (s - low) / (high - low)) * panel.height;
        if (eta < 0) pen.moveTo(x, y);
        else pen.lineTo(x, y);
      }
    }
    pen.stroke();
    pen.restore();
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} top @param {number} height */
  #paintScale(pen, width, top, height) {
    const left = width - 38;
    for (let i = 0; i < height; i++) {
      pen.fillStyle = `rgb(${scaleColour(1 - i / height)
        .map(Math.round)
        .join()})`;
      pen.fillRect(left, top + i, 7, 1.2);
    }
    pen.fillStyle = colour('muted');
    pen.textAlign = 'left';
    pen.font = SMALL;
    for (const part of [0, 0.5, 1])
      pen.fillText(
        sig(part * this.#most, 3),
        left + 10,
        top + height * (1 - part) + (part === 1 ? 7 : part === 0 ? 0 : 3),
      );
  }

  /** @param {PointerEvent} event */
  #read(event) {
    const pattern = this.#pattern();
    const context = this.#context;
    if (!pattern || !context) return;
    for (const end of endsOf(context.result)) {
      const [panel, side] = [this.#panels[end], pattern[end]];
      if (!panel || !side) continue;
      const u = (event.offsetX - panel.left) / panel.width;
      const v = 1 - (event.offsetY - panel.top) / panel.height;
      if (u < 0 || u > 1 || v < 0 || v > 1) continue;
      const across = panel.mirrored ? 1 - u : u;
      const rows = pattern.s_mm.length - 1;
      const face = faceOf(pattern, end);
      const columns = face.length - 1;
      const { geometry } = context.result;
      const s = pattern.s_mm[0] + v * (pattern.s_mm[rows] - pattern.s_mm[0]);
      const eta = face[0] + across * (face[columns] - face[0]);
      const radius = Math.hypot(geometry.base_radius_mm[0], geometry.tangent_length_mm[0] + s);
      fill(
        this.tip,
        h('.tip-x', null, `${end} end`),
        h(
          '.tip-row',
          null,
          h('span', null, 'pressure, MPa'),
          h('b', null, sig(gridValue(side.pressure_MPa, v * rows, across * columns), 4)),
        ),
        placeRow('pinion radius', radius, 2),
        placeRow('from mid face', eta, 1),
      );
      this.tip.hidden = false;
      placeTip(this.tip, event.offsetX, this.painting.frame.body.clientWidth);
      const cycle =
        (s - eta * leanOf(context.result, end)) / geometry.transverse_base_pitch_mm;
      phase.set(cycle - Math.floor(cycle));
      return;
    }
    this.tip.hidden = true;
  }

  #table() {
    const pattern = this.#pattern();
    if (!pattern || !this.#context) return [];
    /** @type {(string | number | null)[][]} */
    const rows = [['end', 's (mm)', 'eta (mm)', 'pressure (MPa)']];
    for (const end of endsOf(this.#context.result)) {
      pattern[end]?.pressure_MPa.forEach((line, i) => {
        line.forEach((value, j) => rows.push([end, pattern.s_mm[i], faceOf(pattern, end)[j], value]));
      });
    }
    return rows;
  }
}

/** @param {string} name @param {number} value mm @param {number} decimals of mm; of inches one more */
function placeRow(name, value, decimals) {
  const text = shownValue(value, 'mm').toFixed(inInches() ? decimals + 1 : decimals);
  return h('.tip-row', null, h('span', null, `${name}, ${shownUnit('mm')}`), h('b', null, text));
}

/** @param {Page.LoadCase} loadCase */
function peak(loadCase) {
  return Math.max(...Object.values(loadCase.contact.max_pressure_MPa).map(Number));
}

/** @param {HTMLCanvasElement} canvas @param {Page.Curve[]} grid @param {number} most @param {boolean} mirrored */
function paintGrid(canvas, grid, most, mirrored) {
  const [width, height] = PIXELS;
  canvas.width = width;
  canvas.height = height;
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  const image = pen.createImageData(width, height);
  for (let y = 0; y < height; y++) {
    const row = (1 - y / (height - 1)) * (grid.length - 1);
    for (let x = 0; x < width; x++) {
      const across = x / (width - 1);
      const value = gridValue(grid, row, (mirrored ? 1 - across : across) * (grid[0].length - 1));
      if (!(value > 0)) continue;
      const at = 4 * (y * width + x);
      const [r, g, b] = scaleColour(value / most);
      image.data[at] = r;
      image.data[at + 1] = g;
      image.data[at + 2] = b;
      image.data[at + 3] = Math.min(255, (value / (0.03 * most)) * 255);
    }
  }
  pen.putImageData(image, 0, 0);
}

/**
 * Line of equal value (marching squares), in parts 0..1 of the grid.
 * @param {Page.Curve[]} grid
 * @param {number} level
 * @param {(row: number, column: number) => [number, number]} place
 * @param {CanvasRenderingContext2D} pen
 */
function outline(grid, level, place, pen) {
  const [rows, columns] = [grid.length - 1, grid[0].length - 1];
  for (let i = 0; i < rows; i++) {
    for (let j = 0; j < columns; j++) {
      const corner = [
        [i, j],
        [i, j + 1],
        [i + 1, j + 1],
        [i + 1, j],
      ];
      /** @type {[number, number][]} */
      const crossings = [];
      for (let k = 0; k < 4; k++) {
        const [a, b] = [corner[k], corner[(k + 1) % 4]];
        const [va, vb] = [(grid[a[0]][a[1]] ?? 0) - level, (grid[b[0]][b[1]] ?? 0) - level];
        if (va > 0 === vb > 0) continue;
        const t = va / (va - vb);
        crossings.push(place((a[0] + t * (b[0] - a[0])) / rows, (a[1] + t * (b[1] - a[1])) / columns));
      }
      for (let k = 0; k + 1 < crossings.length; k += 2) {
        pen.moveTo(...crossings[k]);
        pen.lineTo(...crossings[k + 1]);
      }
    }
  }
}
