// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of the rig: measured beside predicted over speed and torque; orders, transmission error and spectrum of
// one recording.
import { plain, sig } from '../../base/format.js';
import { Chart } from '../../figures/chart.js';
import { caseColour } from '../../figures/context.js';
import { MeasuredOrders, MeasuredPoints } from '../../figures/measured.js';

export const WHAT =
  'Rotational acceleration where the encoders sit, of the mesh orders alone: the second derivative of r_b φ of ' +
  'the gear less that of the pinion. Not the normal or transverse acceleration that the Design view shows ' +
  'first.';
const SAME_SPEED = 20; // rpm: recordings whose speeds differ by less stand together

/** @typedef {import('./bench.js').Bench} Bench */

/** A curve over the mesh cycle moved by a part of it. @param {Page.Curve} values @param {number} part */
function moved(values, part) {
  const count = values.length;
  return values.map((_, i) => {
    const place = ((((i / count - part) % 1) + 1) % 1) * count;
    const below = Math.floor(place) % count;
    const t = place - Math.floor(place);
    return (values[below] ?? NaN) * (1 - t) + (values[(below + 1) % count] ?? NaN) * t;
  });
}

/**
 * Series of one pair at one torque (or speed).
 * @param {Bench} bench @param {'torque' | 'speed'} across @param {number} chosen @param {(id: number) => void} choose
 */
function seriesOver(bench, across, chosen, choose) {
  /** @type {Map<string, import('../../figures/measured.js').Series>} */
  const series = new Map();
  for (const item of bench.items) {
    const [load, turns] = [item.torque_Nm ?? NaN, item.result.speed_rpm.mean ?? NaN];
    const group =
      across === 'speed'
        ? `${plain(Number(load.toPrecision(4)))} N m`
        : `${plain(Math.round(turns / SAME_SPEED) * SAME_SPEED)} rpm`;
    const label = `${group}, ${item.label}`;
    const beside = bench.of(item.id);
    const own = series.get(label) ?? { label, group, colour: '', open: item.label === 'unmodified', points: [] };
    series.set(label, own);
    own.points.push({
      x: across === 'speed' ? turns : load,
      measured: item.result.rms_m_per_s2.value ?? NaN,
      sigma: item.result.rms_m_per_s2.sigma ?? NaN,
      predicted: beside?.predicted ?? null,
      label: `${item.file}: ${plain(load)} N m, ${sig(turns, 5)} rpm`,
      outlier: beside?.outlier,
      chosen: item.id === chosen,
      pick: () => choose(item.id),
    });
  }
  const all = [...series.values()].sort(
    (a, b) => parseFloat(a.label) - parseFloat(b.label) || a.label.localeCompare(b.label),
  );
  const groups = [...new Set(all.map(each => each.group))];
  for (const each of all) each.colour = caseColour(groups.indexOf(each.group));
  return all;
}

const MEMBERS = /** @type {const} */ (['pinion', 'gear']);

/**
 * A predicted average over a turn at the places of a measured one, turned to where it lies nearest: the zero of the
 * encoders is arbitrary. Encoders see the gear's lag with the other sign.
 * @param {Page.Curve} measured @param {number[]} lag of the prediction
 */
function alongside(measured, lag) {
  const n = measured.length;
  const seen = measured.map((_, i) => -lag[Math.floor(((i + 0.5) / n) * lag.length)]);
  const mean = measured.reduce((/** @type {number} */ sum, value) => sum + (value ?? 0), 0) / n;
  let best = 0;
  let most = -Infinity;
  for (let shift = 0; shift < n; shift++) {
    let sum = 0;
    for (let i = 0; i < n; i++) sum += ((measured[i] ?? mean) - mean) * seen[(i + shift) % n];
    if (sum > most) [most, best] = [sum, shift];
  }
  return seen.map((_, i) => mean + seen[(i + best) % n]);
}

export class RigFigures {
  constructor() {
    this.speed = new MeasuredPoints({
      title: 'Vibration over speed',
      unit: 'm/s²',
      help: WHAT,
      xLabel: 'pinion speed, rpm',
    });
    this.torque = new MeasuredPoints({
      title: 'Vibration over torque',
      unit: 'm/s²',
      help: WHAT,
      xLabel: 'torque, N m',
    });
    this.orders = new MeasuredOrders({
      title: 'Mesh orders',
      unit: 'm/s²',
      help: `${WHAT} Whiskers: one standard deviation.`,
    });
    this.te = new Chart({
      title: 'Transmission error in phase',
      unit: 'µm',
      help:
        'Mesh orders of the transmission error over one mesh cycle, moved to where the prediction lies: the zero ' +
        'of the encoders is arbitrary.',
      xLabel: 'mesh cycle',
      cycle: true,
    });
    this.spectrum = new Chart({
      title: 'Spectrum',
      unit: 'm/s²',
      help:
        'Acceleration over orders of the pinion; upright lines: mesh orders. Where the design states single teeth, ' +
        'what they excite, mean of the ends, is drawn with it.',
      xLabel: 'order of the pinion',
      zero: true,
      wide: true,
    });
    this.turn = new Chart({
      title: 'TE over one turn',
      unit: 'µm',
      help:
        'Average over the turns of each shaft, without drift: its first orders are eccentricity, a bad tooth a step. ' +
        'Where the design states single teeth, their loaded transmission error is turned to where it lies nearest.',
      xLabel: 'turn',
    });
  }

  get frames() {
    return [
      this.speed.painting.frame,
      this.torque.painting.frame,
      this.orders.painting.frame,
      this.te.frame,
      this.spectrum.frame,
      this.turn.frame,
    ];
  }

  /** @param {Bench} bench @param {number} chosen @param {(id: number) => void} choose */
  drawPoints(bench, chosen, choose) {
    this.speed.set(seriesOver(bench, 'speed', chosen, choose));
    this.torque.set(seriesOver(bench, 'torque', chosen, choose));
  }

  /** @param {Bench} bench @param {Api.ListedMeasurement} item */
  drawOrders(bench, item) {
    const { mesh } = item.result;
    const predicted = bench.of(item.id)?.detail?.orders?.predicted_m_per_s2;
    const measured = mesh.acceleration_m_per_s2.map(value => value ?? NaN);
    this.orders.set(
      measured,
      measured.map((value, i) => {
        const [amplitude, sigma] = [mesh.amplitude_um[i] ?? 0, mesh.sigma_um[i] ?? 0];
        return amplitude > 0 ? (value * sigma) / amplitude : 0;
      }),
      measured.map((_value, i) => predicted?.[i] ?? null),
    );
  }

  /** The recording and its partner of the other pair. @param {Bench} bench @param {Api.ListedMeasurement} item */
  drawTe(bench, item) {
    /** @type {import('../../figures/chart.js').Curve[]} */
    const curves = [];
    let position = null;
    for (const each of [item, bench.partner(item)]) {
      const curve = each && bench.of(each.id)?.detail?.te;
      if (!curve) continue;
      position = curve.position;
      const part = curve.shift ?? 0;
      const colour = each === item ? 'measured' : 'reference';
      curves.push({ label: `${each.label}, measured`, y: moved(curve.measured_um, part), colour });
      if (curve.predicted_um.every(value => value !== null))
        curves.push({
          label: `${each.label}, predicted`,
          y: moved(curve.predicted_um, part),
          colour,
          line: 'dashed',
        });
    }
    this.te.set({ x: position ?? [], curves });
  }

  /**
   * @param {Api.ListedMeasurement} item @param {Api.MeasuredResult} result of the whole measurement
   * @param {boolean} named the orders have names
   * @param {Api.PitchCase | null} teeth what single teeth do over the hunting period in the load case nearest to it,
   *   or null
   */
  drawSpectrum(item, result, named, teeth) {
    const spectrum = teeth?.spectrum;
    const lines = spectrum?.rotational_m_per_s2;
    this.spectrum.set({
      x: result.spectrum.order,
      curves: [
        { label: item.file ?? '', y: result.spectrum.acceleration_m_per_s2, colour: 'measured', width: 1 },
        ...(spectrum && lines
          ? [
              {
                label: 'predicted from single teeth',
                x: lines.map((_, i) => i * spectrum.step),
                y: lines,
                colour: 'predicted',
                width: 1,
              },
            ]
          : []),
      ],
      marks: result.mesh.order.map((order, i) => ({
        x: order,
        label: named ? `${i + 1}×` : '',
        strong: i === 0,
      })),
    });
    const count = result.te.pinion_turn_um.length;
    const x = Array.from({ length: count }, (_, i) => (i + 0.5) / count);
    const measured = [result.te.pinion_turn_um, result.te.gear_turn_um];
    this.turn.set({
      x,
      curves: MEMBERS.flatMap((member, i) => {
        const colour = `member-${member}`;
        const own = { label: member, y: measured[i], colour, width: 1 };
        const other = teeth?.lte?.[`${member}_turn_um`];
        if (!other) return [own];
        return [own, { label: `${member}, predicted`, y: alongside(measured[i], other), colour, line: 'dashed' }];
      }),
    });
  }
}
