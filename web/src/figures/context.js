// SPDX-License-Identifier: GPL-3.0-or-later
// What the figures show: one result, beside what it is compared with.

/** @typedef {{ label: string, result: Page.Result, line: 'dashed' | 'dotted' }} Reference */
/** @typedef {{ result: Page.Result, references: Reference[], loadCase: number }} Context */

/** Index of the load case whose share of time is largest. @param {Page.Design} design */
export function mainCase(design) {
  const shares = design.load_cases.map(row => row.share ?? 0);
  return shares.indexOf(Math.max(...shares));
}

/** On the pinion shaft, N m: stated, or what the power comes to at the speed. @param {Page.Loading} row */
export function torqueOf({ torque_Nm: torque, power_kW: power, speed_rpm: speed }) {
  return torque ?? ((power ?? 0) * 1000) / ((2 * Math.PI * speed) / 60);
}

/** Its torque, or the power that a document states in its place. @param {Page.Loading} row */
function loadText({ torque_Nm: torque, power_kW: power }) {
  if (typeof torque !== 'number') return typeof power === 'number' ? `${Number(power.toPrecision(5))} kW` : 'no load';
  return `${Number(torque.toPrecision(5))} N m`;
}

/**
 * Names of load cases that tell them apart: their own, else the torque, with the speed where the torque alone does not.
 * @param {Page.Loading[]} cases
 * @returns {string[]}
 */
export function caseNames(cases) {
  const torques = cases.map(loadText);
  const full = cases.map((row, i) => `${torques[i]}, ${Number(row.speed_rpm.toPrecision(6))} rpm`);
  return cases.map((row, i) => {
    if (row.name) return row.name;
    const twins = torques.map((_, k) => k).filter(k => torques[k] === torques[i]);
    if (twins.length === 1) return torques[i];
    return twins.filter(k => full[k] === full[i]).length === 1 ? full[i] : `${full[i]} (${twins.indexOf(i) + 1})`;
  });
}

/** The torque and the speed of a load case. @param {Page.Loading} row */
export function caseLong(row) {
  const text = `${loadText(row)} at ${Number(row.speed_rpm.toPrecision(6))} rpm`;
  return row.name ? `${row.name}: ${text}` : text;
}

/**
 * Places over the face of an end: halves of unequal width have each its own.
 * @param {{ eta_mm: number[], right_eta_mm?: number[] | null }} part @param {string} end
 */
export function faceOf(part, end) {
  return (end === 'right' && part.right_eta_mm) || part.eta_mm;
}

/**
 * The geometry of an end: halves that differ have each its own.
 * @param {Page.Result} result @param {string} end
 * @returns {Page.Result['geometry']}
 */
export function geometryOf(result, end) {
  const right = /** @type {unknown} */ (result.right_geometry); // one table describes both: what is computed is there
  return (end === 'right' && /** @type {Page.Result['geometry'] | undefined} */ (right)) || result.geometry;
}

/** tan(beta_b) of an end. @param {Page.Result} result @param {string} end */
export function leanOf(result, end) {
  return Math.tan((geometryOf(result, end).base_helix_angle_deg * Math.PI) / 180);
}

/**
 * Places on the profile of a member's end: halves of unequal helix have each its own.
 * @param {{ u_mm: number[], right_u_mm?: number[] }} member @param {string} end
 */
export function profileOf(member, end) {
  return (end === 'right' && member.right_u_mm) || member.u_mm;
}

/**
 * By how much of a mesh cycle the right half's phase is ahead: its width and helix, less the stagger.
 * @param {Page.Result} result
 */
export function rightPhase(result) {
  const { geometry, design } = result;
  const groove = design.gear_pair.groove_width_mm ?? 0;
  /** @param {string} end */
  const lead = (end) => ((groove + geometryOf(result, end).face_width_mm) / 2) * leanOf(result, end);
  const lag = result.right_geometry ? lead('right') - lead('left') : 0;
  return lag / geometry.transverse_base_pitch_mm - (design.alignment?.stagger ?? 0);
}

/** Names of the ends that there are. @param {Page.Result} result @returns {('left' | 'right')[]} */
export function endsOf(result) {
  return (result.design.gear_pair.ends ?? 2) === 1 ? ['left'] : ['left', 'right'];
}

/** @param {number} index */
export function caseColour(index) {
  return `case${(index % 8) + 1}`;
}

/**
 * The load case of a reference that stands for the same torque and speed, or the one in the same place.
 * @param {Page.Result | null | undefined} result
 * @param {Page.Loading} loadCase
 * @param {number} index
 */
export function sameCase(result, loadCase, index) {
  const cases = result?.load_cases ?? [];
  return (
    cases.find(c => c.torque_Nm === loadCase.torque_Nm && c.speed_rpm === loadCase.speed_rpm) ??
    cases[index]
  );
}

/** Numbers 0 .. count-1 or from the given start. @param {number} count @param {number} [start] */
export function counting(count, start = 0) {
  return Array.from({ length: count }, (_, i) => i + start);
}

/** A curve about its mean. @param {Page.Curve | null | undefined} values */
export function lessMean(values) {
  const known = (values ?? []).map(value => value ?? NaN);
  const mean = known.reduce((sum, value) => sum + value, 0) / known.length;
  return known.map(value => value - mean);
}

/** Colours of the ends: apart from those of the load cases, everywhere. */
export const END_COLOUR = { left: 'end-left', right: 'end-right' };
/** What a design is compared with. */
export const REFERENCE_COLOUR = 'reference';
/** The design on the table where there is but one curve of it. */
export const OWN_COLOUR = 'own';
