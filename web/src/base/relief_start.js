// SPDX-License-Identifier: GPL-3.0-or-later
// Where a relief starts: on the rack, or as drawings and measuring machines have it. One way is stated; the service
// says what the place is in all of them (ReliefStart).
import { plain } from './format.js';
import { shownUnit, shownValue } from './units.js';

/** @typedef {'tip' | 'root'} Side */
/** @typedef {{ way: string, of: keyof Api.ReliefStart, name: string, unit: string }} Way end of its key, and words */
/** @typedef {Record<string, unknown> | null | undefined} Flank of a design */

/** @type {Way[]} */
export const WAYS = [
  { way: 'start_mm', of: 'u_mm', name: 'rack', unit: 'mm' },
  { way: 'diameter_mm', of: 'diameter_mm', name: 'diameter', unit: 'mm' },
  { way: 'roll_length_mm', of: 'roll_length_mm', name: 'length of roll', unit: 'mm' },
  { way: 'roll_angle_deg', of: 'roll_angle_deg', name: 'roll angle', unit: '°' },
  { way: 'length_mm', of: 'length_mm', name: 'from its end', unit: 'mm' },
];
const DIGITS = 6; // that are shown
const KEPT = 8; // that are stated: going round all ways leads back to a nanometre

/** @param {Side} side @param {Way} way */
export const keyOf = (side, { way }) => `${side}_relief_${way}`;

/** The way in which a flank states it. @param {Flank} flank @param {Side} side @returns {Way} */
export function wayOf(flank, side) {
  return WAYS.slice(1).find(way => typeof flank?.[keyOf(side, way)] === 'number') ?? WAYS[0];
}

/** The number of a way; of the rack from the pitch point. @param {Api.ReliefStart} start @param {Way} way */
export function valueOf(start, way) {
  return Math.abs(start[way.of]);
}

/** "diameter 141.2 mm" @param {Api.ReliefStart} start @param {Way} way */
export function textOf(start, way) {
  const value = way.unit === 'mm' ? shownValue(valueOf(start, way), 'mm') : valueOf(start, way);
  const unit = way.unit === 'mm' ? ` ${shownUnit('mm')}` : way.unit;
  return `${plain(Number(value.toPrecision(DIGITS)))}${unit}`;
}

/** The place in every way but one. @param {Api.ReliefStart} start @param {Way} stated */
export function otherTexts(start, stated) {
  return WAYS.filter(way => way !== stated).map(way => `${way.name} ${textOf(start, way)}`);
}

/**
 * The flank with its start stated in another way: where it is.
 * @param {Flank} flank @param {Side} side @param {Way} way @param {Api.ReliefStart} start
 */
export function restated(flank, side, way, start) {
  const others = Object.fromEntries(WAYS.slice(1).map(each => [keyOf(side, each), undefined]));
  const value = Number(valueOf(start, way).toPrecision(KEPT));
  return JSON.parse(JSON.stringify({ ...flank, ...others, [keyOf(side, WAYS[0])]: 0, [keyOf(side, way)]: value }));
}
