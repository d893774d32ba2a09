// SPDX-License-Identifier: GPL-3.0-or-later
// The transverse section of a generated tooth, from the geometry the service reports: involute, fillet of the rack's
// rounded tip, root circle.
// The formulas are those of ISO 21771 and of the trochoid in src/gear/fillet.c; lengths in mm, angles in rad.

/** @typedef {[number, number]} Point */

const INVOLUTE = 24;
const FILLET = 14;

/** @param {number} angle */
const inv = angle => Math.tan(angle) - angle;
/** @param {number} degrees */
const radians = degrees => (degrees * Math.PI) / 180;

/**
 * Angle from the tooth's middle to the involute at a radius.
 * @param {Page.Result['geometry']} g
 * @param {0 | 1} member
 * @param {number} radius
 */
export function halfAngle(g, member, radius) {
  const teeth = member === 0 ? g.pinion_teeth : g.gear_teeth;
  const middle =
    Math.PI / 2 / teeth + (2 * g.profile_shift[member] * Math.tan(radians(g.normal_pressure_angle_deg))) / teeth;
  return (
    middle +
    inv(radians(g.transverse_pressure_angle_deg)) -
    inv(Math.acos(Math.min(1, g.base_radius_mm[member] / radius)))
  );
}

/**
 * @param {Page.Result['geometry']} g
 * @param {Api.ResolvedDesign['gear_pair']} pair
 * @param {0 | 1} member
 * @returns {Point[]} from the lowest point to the form radius
 */
function fillet(g, pair, member) {
  const module = g.normal_module_mm;
  const pressure = radians(g.normal_pressure_angle_deg);
  const shift = g.profile_shift[member] * module;
  const [rounding, dedendum] =
    member === 0
      ? [pair.pinion_fillet_radius_coefficient, pair.pinion_dedendum_coefficient]
      : [pair.gear_fillet_radius_coefficient, pair.gear_dedendum_coefficient];
  const radius = (rounding ?? Number(pair.fillet_radius_coefficient)) * module;
  const reference = g.reference_radius_mm[member];
  const stretch = 1 / Math.cos(radians(g.helix_angle_deg));
  const up = shift - (dedendum ?? Number(pair.dedendum_coefficient)) * module + radius;
  const across =
    (Math.PI * module) / 4 + shift * Math.tan(pressure) - up * Math.tan(pressure) + radius / Math.cos(pressure);
  /** @type {Point[]} */
  const points = [];
  for (let i = 0; i <= FILLET; i++) {
    const psi = Math.PI / 2 + ((pressure - Math.PI / 2) * i) / FILLET;
    const x = (across - radius * Math.cos(psi)) * stretch;
    const y = up - radius * Math.sin(psi);
    const roll = x - (y * Math.cos(psi)) / (Math.sin(psi) * stretch);
    const [c, s] = [Math.cos(roll / reference), Math.sin(roll / reference)];
    points.push([(x - roll) * c + (y + reference) * s, -(x - roll) * s + (y + reference) * c]);
  }
  return points;
}

/**
 * The right half of a tooth whose middle is the y axis: from the root through fillet and involute to the tip.
 * @param {Page.Result['geometry']} g
 * @param {Api.ResolvedDesign['gear_pair']} pair of its resolved design @param {0 | 1} member
 * @param {(sigma: number) => number} [taken] what is taken off at a path coordinate, + towards the member's tip, mm:
 *   the active involute alone, that much lower
 * @returns {Point[]}
 */
export function halfTooth(g, pair, member, taken) {
  const points = taken ? [] : fillet(g, pair, member);
  const [from, to] = [taken ? g.active_start_radius_mm[member] : g.form_radius_mm[member], g.tip_radius_mm[member]];
  const base = g.base_radius_mm[member];
  for (let i = 0; i <= INVOLUTE; i++) {
    const radius = from + ((to - from) * i) / INVOLUTE;
    const angle = halfAngle(g, member, radius);
    const normal = angle - Math.acos(Math.min(1, base / radius));
    const depth = taken
      ? taken(Math.sqrt(Math.max(0, radius * radius - base * base)) - g.tangent_length_mm[member])
      : 0;
    points.push([
      radius * Math.sin(angle) - depth * Math.cos(normal),
      radius * Math.cos(angle) + depth * Math.sin(normal),
    ]);
  }
  return points;
}
