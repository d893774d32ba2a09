// SPDX-License-Identifier: GPL-3.0-or-later
// What is taken off one flank of a result at any place of it, and how its face lies on the screen. Curves and surfaces
// of flanks run over y, which belongs to the body: + towards the face end that meets first when the drive flanks carry.
// What a load case has over its face runs over eta, + towards the end that meets first then.
import { gridValue } from './colours.js';
import { endsOf, profileOf } from './context.js';

/** @typedef {'drive' | 'coast'} Side */

/** The flanks that carry. @param {Page.LoadCase | undefined} loadCase @returns {Side} */
export function sideOf(loadCase) {
  return loadCase?.flank === 'coast' ? 'coast' : 'drive';
}

/**
 * The curves of a flank; null: unmodified, or not in the answer.
 * @param {Page.Result} result @param {Page.Member} member @param {Page.End} end @param {Side} side
 * @returns {Api.CoastFlankCurves | null}
 */
export function flankOf(result, member, end, side) {
  const flank = result.modification?.[member]?.[end] ?? null;
  return side === 'coast' ? (flank?.coast ?? null) : flank;
}

/** Whether any coast flank is modified, or carries. @param {Page.Result} result */
export function hasCoast(result) {
  const members = /** @type {const} */ (['pinion', 'gear']);
  return (
    result.load_cases.some(row => sideOf(row) === 'coast') ||
    members.some(member => endsOf(result).some(end => flankOf(result, member, end, 'coast')))
  );
}

/**
 * Places of the surface of a flank: halves of unequal helix or width have each their own.
 * @param {Page.Result} result @param {Page.Member} member @param {Page.End} end
 */
export function surfacePlaces(result, member, end) {
  const { modification } = result;
  const curves = modification?.[member];
  const right = end === 'right';
  return {
    u: (right && curves?.right_surface_u_mm) || (curves?.surface_u_mm ?? []),
    y: (right && modification?.right_surface_eta_mm) || (modification?.surface_eta_mm ?? []),
  };
}

/** Fractional index of a place among even ones. @param {number[]} places @param {number} at */
function indexOf(places, at) {
  const last = places.length - 1;
  return ((at - places[0]) / (places[last] - places[0])) * last;
}

/**
 * Linear interpolation, 0 without a curve, its end values outside.
 * @param {number[] | undefined} x
 * @param {number[] | undefined} y
 * @param {number} at
 */
export function valueAtPlace(x, y, at) {
  if (!x || !y) return 0;
  const place = indexOf(x, at);
  const below = Math.min(Math.max(Math.floor(place), 0), x.length - 2);
  const t = Math.min(Math.max(place - below, 0), 1);
  return y[below] + t * (y[below + 1] - y[below]);
}

/**
 * What is taken off a flank at u and y, µm: of its surface where its profiles vary over the face (a grid, twist,
 * triangular relief), else the sum of its profile and its lead.
 * @param {Page.Result} result @param {Page.Member} member @param {Page.End} end @param {Side} side
 * @param {number[]} faces eta_mm of the end
 * @returns {(u: number, y: number) => number}
 */
export function takenOff(result, member, end, side, faces) {
  const flank = flankOf(result, member, end, side);
  const curves = result.modification?.[member];
  if (!flank || !curves) return () => 0;
  const { surface_um: surface } = flank;
  if (surface) {
    const places = surfacePlaces(result, member, end);
    return (u, y) => gridValue(surface, indexOf(places.u, u), indexOf(places.y, y));
  }
  const profile = profileOf(curves, end);
  return (u, y) => valueAtPlace(profile, flank.profile_um, u) + valueAtPlace(faces, flank.lead_um, y);
}

/**
 * Whether eta runs from right to left on the screen, where the left end stands left of the right one and the left face
 * of the only one is on the left.
 * @param {Page.LoadCase} loadCase @param {Page.End} end @param {boolean} two ends
 */
export function runsLeft(loadCase, end, two) {
  const first = loadCase.axial?.meets_first ?? (two ? 'outer' : 'right');
  if (!two) return first === 'left';
  return (end === 'left') === (first !== 'inner');
}

/** The same of y. @param {Page.LoadCase} loadCase @param {Page.End} end @param {boolean} two */
export function faceRunsLeft(loadCase, end, two) {
  return runsLeft(loadCase, end, two) === (sideOf(loadCase) === 'drive');
}
