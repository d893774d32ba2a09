// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of a recording is measured: the stretches that were found in it, or a range of times.
import { h } from '../../base/dom.js';
import { plain } from '../../base/format.js';
import { readQuantity } from '../../base/quantity.js';

/** @typedef {Pick<Api.MeasurementForm, 'part' | 'run_up' | 'from_s' | 'to_s'>} Choice */

const STEADY = 0.97; // of the highest speed: below it the shafts run up or down

/** @param {number} value @param {number} [digits] */
const short = (value, digits = 4) => plain(Number(value.toPrecision(digits)));

/** @param {Api.TurningPart} part */
function partText({ from_s: from, to_s: to, turns, lowest_rpm: low, highest_rpm: high }) {
  const speed = low < STEADY * high ? `${short(low)} … ${short(high)} rpm` : `${short(high)} rpm`;
  return `${short(from)} … ${short(to)} s, ${short(Math.abs(turns), 3)} turns, ${speed}`;
}

/** @param {string} name @param {number} value */
function timeField(name, value) {
  return h('input.tiny', { type: 'text', inputmode: 'decimal', 'aria-label': name, value: short(value, 5) });
}

/**
 * What was measured of a recording, what else is in it, and a range to type; each choice is measured beside this one.
 * @param {Api.MeasuredResult} result
 * @param {(choice: Choice) => void} measure
 */
export function partsOf({ part, parts }, measure) {
  /**
   * @param {string} text @param {Choice} choice @param {string} [about] what it is, for those who do not see its row
   */
  const button = (text, choice, about) =>
    h('button.small', { type: 'button', 'aria-label': about, onclick: () => measure(choice) }, text);
  const [from, to] = [timeField('From, s', part.from_s), timeField('To, s', part.to_s)];
  const range = () => {
    const [low, high] = [from, to].map(field => readQuantity(field.value, 's').value ?? NaN);
    const good = low >= 0 && low < high;
    for (const field of [from, to]) field.setAttribute('aria-invalid', String(!good));
    if (good) measure({ from_s: low, to_s: high });
  };
  const rows = parts.map((each, i) =>
    h(
      'li',
      null,
      `${partText(each)} `,
      button('steady state', { part: i + 1 }, `Measure the steady state of stretch ${i + 1}`),
      each.lowest_rpm < STEADY * each.highest_rpm
        ? button('with its run-up', { part: i + 1, run_up: 'included' }, `Measure stretch ${i + 1} with its run-up`)
        : null,
    ),
  );
  return h(
    'section.parts',
    { 'aria-label': 'Part of the recording' },
    h('p', null, h('b', null, 'Measured: '), `${partText(part)}.`),
    h('h4', null, parts.length > 1 ? `${parts.length} stretches without a stop` : 'Without a stop'),
    h('ol.stretches', null, rows),
    h(
      '.switches',
      null,
      h('span.range-fields', null, from, '…', to, ' s'),
      h('button.small', { type: 'button', onclick: range }, 'Measure these times'),
      button('The whole recording', {}),
    ),
  );
}
