// SPDX-License-Identifier: GPL-3.0-or-later
// The ease-off of both ends as surfaces in space, painted from back to front with their axes: the same on the screen,
// as SVG and on paper.
import { colour } from '../base/theme.js';
import { shownUnit, shownValue } from '../base/units.js';
import { SMALL } from './canvas.js';
import { gridValue, scaleColour } from './colours.js';
import { endsOf, faceOf, geometryOf, leanOf, rightPhase } from './context.js';
import { runsLeft, sideOf, takenOff } from './flanks.js';
import { tickText, ticks } from './ticks.js';

export const ROWS = 25; // root to tip
export const COLUMNS = 31; // over the face
const FACE = 1.5; // length of a face in the picture, as root to tip
const TALL = 0.55; // of the largest ease-off
const GAP = 0.2; // between the ends
const LEAST = 20; // um that the height stands for at least
const NEAR = 0.08; // of a mesh cycle round a contact line that is bright: more than a cell, so that it is a line
const PALE = 0.7; // of the colour elsewhere
const LIGHT = 2; // of the slope in the brightness
const NARROW = 460; // px of a picture that has room for short words alone
const ROOM = { left: 16, right: 74, top: 16, bottom: 16 };

/** @typedef {{ turn: number, tilt: number }} View radians */
/** @typedef {[number, number, number]} Place across, up, root to tip */
/**
 * @typedef {object} Surface
 * @property {'left' | 'right'} end
 * @property {number} width of its face, mm @property {[number, number]} path mm
 * @property {boolean} outwards eta runs from the groove to the outer face, of one end to the right
 * @property {Float32Array} taken um @property {Float32Array} pressure MPa @property {Float32Array} cycle of touching
 */
/** @typedef {{ surfaces: Surface[], most: number, depth: number, two: boolean, face: number }} Relief */

/**
 * Of the flanks of both members that carry at an end, together.
 * @param {Page.Result} result
 * @param {Page.LoadCase} loadCase
 * @param {'left' | 'right'} end
 * @returns {Surface}
 */
function surfaceOf(result, loadCase, end) {
  const { modification } = result;
  const g = geometryOf(result, end);
  const faces = modification ? faceOf(modification, end) : [0, g.face_width_mm];
  const width = faces[faces.length - 1] - faces[0];
  const side = sideOf(loadCase);
  const pinion = takenOff(result, 'pinion', end, side, faces);
  const gear = takenOff(result, 'gear', end, side, faces);
  const two = endsOf(result).length === 2;
  const pattern = loadCase.contact?.pattern;
  const lean = leanOf(result, end);
  const ahead = end === 'right' ? rightPhase(result) : 0;
  const count = ROWS * COLUMNS;
  /** @type {Surface} */
  const surface = {
    end,
    width,
    path: [g.path_start_mm, g.path_end_mm],
    outwards: runsLeft(loadCase, end, two) === (two && end === 'left'),
    taken: new Float32Array(count),
    pressure: new Float32Array(count),
    cycle: new Float32Array(count),
  };
  for (let i = 0; i < ROWS; i++) {
    const up = i / (ROWS - 1);
    const s = g.path_start_mm + up * (g.path_end_mm - g.path_start_mm);
    for (let j = 0; j < COLUMNS; j++) {
      const across = j / (COLUMNS - 1);
      const eta = (across - 0.5) * width;
      const at = i * COLUMNS + j;
      const y = side === 'coast' ? -eta : eta;
      surface.taken[at] = pinion(g.rack_factor * s, y) + gear(-g.rack_factor * s, y);
      const grid = pattern?.[end]?.pressure_MPa;
      if (grid) surface.pressure[at] = gridValue(grid, up * (grid.length - 1), across * (grid[0].length - 1));
      surface.cycle[at] = (s - eta * lean) / g.transverse_base_pitch_mm - ahead;
    }
  }
  return surface;
}

/** @param {import('./context.js').Context} context @returns {Relief} */
export function reliefOf({ result, loadCase }) {
  const row = result.load_cases[loadCase];
  const ends = endsOf(result);
  const surfaces = ends.map(end => surfaceOf(result, row, end));
  const largest = Math.max(...surfaces.map(surface => Math.max(...surface.taken)));
  const { geometry: g } = result;
  return {
    surfaces,
    most: Math.max(1, ...Object.values(row.contact?.max_pressure_MPa ?? {}).map(Number)),
    depth: Math.max(LEAST, largest),
    two: ends.length === 2,
    face: g.face_width_mm,
  };
}

/** Turns and tilts places into the picture. */
class Projection {
  /** @param {View} view @param {Relief} relief @param {number} width @param {number} height */
  constructor(view, relief, width, height) {
    this.sin = [Math.sin(view.turn), Math.sin(view.tilt)];
    this.cos = [Math.cos(view.turn), Math.cos(view.tilt)];
    this.scale = 1;
    this.move = [0, 0];
    const side = relief.two ? GAP / 2 + FACE : FACE / 2;
    this.corners = [-side, side].flatMap(x =>
      [-TALL, 0].flatMap(y => [-0.5, 0.5].map(z => this.#turned(/** @type {Place} */ ([x, y, z])))),
    );
    const xs = this.corners.map(corner => corner[0]);
    const ys = this.corners.map(corner => corner[1]);
    const [w, t] = [width - ROOM.left - ROOM.right, height - ROOM.top - ROOM.bottom];
    const [left, right] = [Math.min(...xs) - 0.12, Math.max(...xs) + 0.22];
    const [top, bottom] = [Math.min(...ys) - 0.08, Math.max(...ys) + 0.2];
    this.scale = Math.min(w / (right - left), t / (bottom - top));
    this.narrow = width < NARROW;
    this.move = [
      ROOM.left + (w - this.scale * (right - left)) / 2 - this.scale * left,
      ROOM.top + (t - this.scale * (bottom - top)) / 2 - this.scale * top,
    ];
  }

  /** @param {Place} place @returns {[number, number, number]} across, down, towards the reader */
  #turned([x, y, z]) {
    const across = x * this.cos[0] + z * this.sin[0];
    const away = -x * this.sin[0] + z * this.cos[0];
    return [across, away * this.sin[1] - y * this.cos[1], away * this.cos[1] + y * this.sin[1]];
  }

  /** @param {Place} place @returns {[number, number]} */
  at(place) {
    const [across, down] = this.#turned(place);
    return [this.move[0] + this.scale * across, this.move[1] + this.scale * down];
  }

  /** How near the reader a place is. @param {Place} place */
  nearness(place) {
    return this.#turned(place)[2];
  }
}

/** @param {Relief} relief @param {Surface} surface @param {number} i @param {number} j @returns {Place} */
function placeOf(relief, surface, i, j) {
  const along = j / (COLUMNS - 1);
  const part = surface.outwards ? along : 1 - along;
  const out = relief.two ? GAP / 2 + part * FACE : (part - 0.5) * FACE;
  const across = relief.two && surface.end === 'left' ? -out : out;
  return [across, (-TALL * surface.taken[i * COLUMNS + j]) / relief.depth, 0.5 - i / (ROWS - 1)];
}

/** @param {number[]} colour @param {number[]} ground @param {number} part @param {number} light */
function mixed(colour, ground, part, light) {
  const parts = colour.map((value, k) => (ground[k] + (value - ground[k]) * part) * light);
  return `rgb(${parts.map(value => Math.round(Math.min(255, value))).join()})`;
}

/** "#eceff2" @param {string} text */
function channels(text) {
  return [1, 3, 5].map(at => parseInt(text.slice(at, at + 2), 16));
}

/**
 * @param {CanvasRenderingContext2D} pen @param {Projection} projection @param {Relief} relief @param {Surface} surface
 * @param {number} phase
 */
function paintSurface(pen, projection, relief, surface, phase) {
  const ground = channels(colour('relief'));
  /** @type {{ corners: Place[], at: number, near: number }[]} */
  const faces = [];
  for (let i = 0; i < ROWS - 1; i++) {
    for (let j = 0; j < COLUMNS - 1; j++) {
      const corners = [
        placeOf(relief, surface, i, j),
        placeOf(relief, surface, i, j + 1),
        placeOf(relief, surface, i + 1, j + 1),
        placeOf(relief, surface, i + 1, j),
      ];
      faces.push({ corners, at: i * COLUMNS + j, near: projection.nearness(corners[0]) });
    }
  }
  faces.sort((a, b) => a.near - b.near);
  pen.lineWidth = 0.5;
  for (const { corners, at } of faces) {
    let distance = surface.cycle[at] - phase;
    distance -= Math.round(distance);
    const part = surface.pressure[at] / relief.most;
    const bright = part > 0.01 ? Math.max(Math.exp(-((distance / NEAR) ** 2)), PALE) : 0;
    const slope = corners[1][1] - corners[0][1] + (corners[3][1] - corners[0][1]);
    pen.fillStyle = mixed(scaleColour(part), ground, bright, Math.min(1.04, Math.max(0.78, 1 + LIGHT * slope)));
    pen.strokeStyle = pen.fillStyle;
    pen.beginPath();
    corners.forEach((corner, k) =>
      k === 0 ? pen.moveTo(...projection.at(corner)) : pen.lineTo(...projection.at(corner)),
    );
    pen.closePath();
    pen.fill();
    pen.stroke();
  }
  paintWires(pen, projection, relief, surface);
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {Projection} projection
 * @param {Relief} relief
 * @param {Surface} surface
 */
function paintWires(pen, projection, relief, surface) {
  pen.strokeStyle = colour('muted');
  pen.globalAlpha = 0.5;
  pen.lineWidth = 0.75;
  pen.beginPath();
  for (let i = 0; i < ROWS; i += 6)
    for (let j = 0; j < COLUMNS; j++) {
      const place = projection.at(placeOf(relief, surface, i, j));
      if (j === 0) pen.moveTo(...place);
      else pen.lineTo(...place);
    }
  for (let j = 0; j < COLUMNS; j += 6)
    for (let i = 0; i < ROWS; i++) {
      const place = projection.at(placeOf(relief, surface, i, j));
      if (i === 0) pen.moveTo(...place);
      else pen.lineTo(...place);
    }
  pen.stroke();
  pen.globalAlpha = 1;
}

/** @param {CanvasRenderingContext2D} pen @param {Projection} projection @param {Place[]} places */
function line(pen, projection, places) {
  pen.beginPath();
  places.forEach((place, k) => (k === 0 ? pen.moveTo(...projection.at(place)) : pen.lineTo(...projection.at(place))));
  pen.stroke();
}

/**
 * Face width along the front edge, root and tip at the side, micrometres upright.
 * @param {CanvasRenderingContext2D} pen @param {Projection} projection @param {Relief} relief
 */
function paintAxes(pen, projection, relief) {
  const front = projection.nearness([0, 0, 0.5]) > projection.nearness([0, 0, -0.5]) ? 0.5 : -0.5;
  const side = relief.two ? GAP / 2 + FACE : FACE / 2;
  const right = projection.at([side, 0, 0])[0] > projection.at([-side, 0, 0])[0] ? side : -side;
  pen.font = SMALL;
  pen.lineWidth = 1;
  pen.strokeStyle = colour('mark');
  pen.fillStyle = colour('muted');
  for (const { end } of relief.surfaces) {
    const [from, to] = relief.two ? [GAP / 2, GAP / 2 + FACE] : [-FACE / 2, FACE / 2];
    const sign = end === 'left' && relief.two ? -1 : 1;
    line(pen, projection, [
      [sign * from, -TALL, front],
      [sign * to, -TALL, front],
    ]);
    pen.textAlign = 'center';
    for (const part of [0, 0.5, 1]) {
      const [x, y] = projection.at([sign * (from + part * FACE), -TALL, front]);
      pen.fillText(tickText(Number(shownValue(part * relief.face, 'mm').toPrecision(5))), x, y + 13);
    }
    const [x, y] = projection.at([sign * (from + FACE / 2), -TALL, front]);
    const name = projection.narrow ? end : `${end} end, face width`;
    pen.fillText(`${relief.two ? name : 'face width'}, ${shownUnit('mm')}`, x, y + 26);
  }
  line(pen, projection, [
    [right, -TALL, 0.5],
    [right, -TALL, -0.5],
  ]);
  pen.textAlign = 'left';
  for (const [text, z] of /** @type {[string, number][]} */ ([
    ['root', 0.5],
    ['tip', -0.5],
  ])) {
    const [x, y] = projection.at([right, -TALL, z]);
    pen.fillText(text, x + 8, y + (z === -front ? 17 : 4)); // the heights end at the far one
  }
  paintHeights(pen, projection, relief, [right, -front]);
}

/**
 * @param {CanvasRenderingContext2D} pen @param {Projection} projection @param {Relief} relief
 * @param {[number, number]} corner across and root to tip
 */
function paintHeights(pen, projection, relief, [x, z]) {
  line(pen, projection, [
    [x, 0, z],
    [x, -TALL, z],
  ]);
  const depth = shownValue(relief.depth, 'µm');
  for (const value of ticks(0, depth)) {
    const [left, top] = projection.at([x, (-TALL * value) / depth, z]);
    pen.beginPath();
    pen.moveTo(left, top);
    pen.lineTo(left + 4, top);
    pen.stroke();
    const unit = `${shownUnit('µm')}${projection.narrow ? '' : ' taken off'}`;
    pen.fillText(value === 0 ? `0 ${unit}` : tickText(value), left + 7, top + 3);
  }
}

/** @param {CanvasRenderingContext2D} pen @param {number} most @param {number} width @param {number} height */
function paintScale(pen, most, width, height) {
  const [left, top, tall] = [width - 52, 34, Math.min(150, height - 70)];
  for (let i = 0; i < tall; i++) {
    pen.fillStyle = `rgb(${scaleColour(1 - i / tall)
      .map(Math.round)
      .join()})`;
    pen.fillRect(left, top + i, 8, 1.3);
  }
  pen.fillStyle = colour('muted');
  pen.font = SMALL;
  pen.textAlign = 'right';
  pen.fillText('pressure, MPa', width - 6, top - 10);
  pen.textAlign = 'left';
  for (const value of ticks(0, most)) pen.fillText(tickText(value), left + 12, top + tall * (1 - value / most) + 3);
}

/** How much the heights are drawn larger than the lengths. @param {Relief} relief */
export function exaggeration(relief) {
  return TALL / (relief.depth / 1000) / (FACE / relief.face);
}

/**
 * @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height
 * @param {Relief} relief @param {View} view @param {number} phase
 */
export function paintRelief(pen, width, height, relief, view, phase) {
  const projection = new Projection(view, relief, width, height);
  const order = [...relief.surfaces].sort(
    (a, b) =>
      projection.nearness(placeOf(relief, a, ROWS >> 1, COLUMNS >> 1)) -
      projection.nearness(placeOf(relief, b, ROWS >> 1, COLUMNS >> 1)),
  );
  for (const surface of order) paintSurface(pen, projection, relief, surface, phase);
  paintAxes(pen, projection, relief);
  paintScale(pen, relief.most, width, height);
  pen.fillStyle = colour('muted');
  pen.textAlign = 'left';
  const factor = exaggeration(relief);
  pen.fillText(`heights × ${Number(factor.toPrecision(2))}`, 8, height - 6);
}
