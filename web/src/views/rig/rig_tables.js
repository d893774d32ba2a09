// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of the rig: the measurements beside their prediction, the reductions, what is known of one recording.
import { address } from '../../base/api.js';
import { fill, h } from '../../base/dom.js';
import { dateText, plain, sig } from '../../base/format.js';
import { shownSentence, shownUnit, shownValue } from '../../base/units.js';
import { findingList } from './recordings.js';

const HEAD = /** @type {[string, string][]} */ ([
  ['recording', ''],
  ['pair', ''],
  ['torque', 'N m'],
  ['speed', 'rpm'],
  ['measured RMS', 'm/s²'],
  ['predicted', 'm/s²'],
  ['ratio', ''],
  ['TE', 'µm'],
  ['finding', ''],
  ['file', ''],
]);
const HASH = 12; // digits shown of a check sum

/** @typedef {import('./bench.js').Bench} Bench */
/** @typedef {ReturnType<Bench['of']>} Beside what the comparison says of it */
/** @typedef {{ choose: (id: number) => void, remove: (item: Api.ListedMeasurement) => void }} Acts */

/** @param {string} name @param {HTMLElement} table */
function scrolled(name, table) {
  return h('.table-scroll', { tabindex: '0', role: 'region', 'aria-label': name }, table);
}

/** @param {Api.ListedMeasurement[]} items by torque, speed, pair */
export function ordered(items) {
  return [...items].sort(
    (a, b) =>
      Number(a.torque_Nm) - Number(b.torque_Nm) ||
      Number(a.result.speed_rpm.mean) - Number(b.result.speed_rpm.mean) ||
      a.label.localeCompare(b.label) ||
      a.id - b.id,
  );
}

/** @param {Api.ListedMeasurement} item @param {Beside} beside */
function findingMarks(item, beside) {
  const worst = ['warning', 'repaired', 'note'].find(severity =>
    item.findings.some(finding => finding.severity === severity),
  );
  const texts = item.findings.map(finding => shownSentence(finding.text)).join('\n');
  return [
    beside?.outlier ? h('span.severity.warning', { title: shownSentence(beside.reason ?? '') }, 'outlier') : null,
    worst ? h(`span.severity.${worst}`, { title: texts }, worst === 'warning' ? 'doubtful' : worst) : null,
  ];
}

/** @param {Api.ListedMeasurement} item @param {Acts} acts */
function actionLinks(item, acts) {
  /** @param {Event} event */
  const here = event => event.stopPropagation();
  return [
    h(
      'a.icon',
      {
        href: address(`measurements/${item.id}/file`),
        download: item.file,
        title: 'The recording as it came',
        'aria-label': `Download ${item.file}`,
        onclick: here,
      },
      '↓',
    ),
    h(
      'button.icon',
      {
        type: 'button',
        title: 'Delete',
        'aria-label': `Delete ${item.file}`,
        onclick: (/** @type {Event} */ event) => {
          here(event);
          acts.remove(item);
        },
      },
      '✕',
    ),
  ];
}

/** @param {Bench} bench @param {Api.ListedMeasurement} item @param {boolean} chosen @param {Acts} acts */
function measurementRow(bench, item, chosen, acts) {
  const beside = bench.of(item.id);
  const { rms_m_per_s2: rms, speed_rpm: turns, te: error } = item.result;
  const name = h('button.link', { type: 'button', 'aria-pressed': String(chosen) }, item.file);
  return h(
    chosen ? 'tr.chosen' : 'tr',
    { onclick: () => acts.choose(item.id) },
    h('th', { scope: 'row' }, name),
    h('td', null, item.label),
    h('td.number', null, plain(item.torque_Nm)),
    h('td.number', null, turns.mean.toFixed(1)),
    h('td.number', null, h('b', null, sig(rms.value, 4)), ` ± ${sig(rms.sigma, 2)}`),
    h('td.number', null, beside ? sig(beside.predicted, 4) : '…'),
    h('td.number', null, beside ? sig(beside.ratio, 3) : '…'),
    h('td.number', null, sig(shownValue(error.peak_to_peak_um, 'um'), 3)),
    h('td', null, findingMarks(item, beside)),
    h('td.actions', null, actionLinks(item, acts)),
  );
}

/** @param {HTMLElement} place @param {Bench} bench @param {number} chosen @param {string} what @param {Acts} acts */
export function drawMeasurements(place, bench, chosen, what, acts) {
  const link = h(
    'a.small-link',
    {
      href: address(`designs/${bench.designId}/comparison.csv`),
      download: 'comparison.csv',
      title: 'Compared with the stored design',
    },
    'CSV',
  );
  const orders = bench.items[0]?.result.harmonics ?? '';
  fill(
    place,
    h(
      '.figure-head',
      null,
      h('h3', { title: what }, 'Measurements'),
      h('span.figure-note', null, `rotational acceleration, mesh orders 1 to ${orders}`),
      h('.figure-controls', null, link),
    ),
    scrolled(
      'Measurements, all columns',
      h(
        'table.numbers.jobs',
        null,
        h(
          'thead',
          null,
          h(
            'tr',
            null,
            HEAD.map(([text, unit]) =>
              h('th', { scope: 'col' }, text, unit ? h('span.unit', null, ` ${shownUnit(unit)}`) : null),
            ),
          ),
        ),
        h(
          'tbody',
          null,
          ordered(bench.items).map(item => measurementRow(bench, item, item.id === chosen, acts)),
        ),
      ),
    ),
  );
}

/** @param {HTMLElement} place @param {Bench} bench @param {number} chosen */
export function drawReductions(place, bench, chosen) {
  const found = bench.comparison?.reductions ?? [];
  place.hidden = found.length === 0;
  const rows = [...found]
    .sort((a, b) => a.torque_Nm - b.torque_Nm || a.speed_rpm - b.speed_rpm)
    .map(each =>
      h(
        each.id === chosen ? 'tr.chosen' : 'tr',
        null,
        h('td.number', null, plain(each.torque_Nm)),
        h('td.number', null, each.speed_rpm.toFixed(0)),
        h('td.number', null, h('b', null, `${sig(each.measured_percent, 3)} %`), ` ± ${sig(each.sigma_percent, 2)}`),
        h('td.number', null, `${sig(each.predicted_percent, 3)} %`),
      ),
    );
  const head = ['torque N m', 'speed rpm', 'measured', 'predicted'].map(text => h('th', { scope: 'col' }, text));
  fill(
    place,
    h('.figure-head', null, h('h3', null, 'Less vibration by the modification')),
    scrolled(
      'Reductions, all columns',
      h('table.numbers', null, h('thead', null, h('tr', null, head)), h('tbody', null, rows)),
    ),
  );
}

/** @param {Api.RawTracks} ellipse */
function trackText(ellipse) {
  const amplitudes = ellipse.amplitude.map(value => sig(value, 3)).join(' / ');
  return `amplitude ${amplitudes}, ratio ${sig(ellipse.ratio, 4)}, phase ${sig(ellipse.phase_deg, 4)}°`;
}

/** "1.23 µm", or in thousandths of an inch. @param {number | null} value @param {number} digits */
function micrometres(value, digits) {
  return `${sig(shownValue(value, 'um'), digits)} ${shownUnit('µm')}`;
}

/** What is known of one recording. @param {Api.Measurement} whole @returns {[string, string][]} */
function factsOf(whole) {
  const { result, signal } = whole;
  if (!result) return [];
  const { speed_rpm: speed, shafts, rms_m_per_s2: rms } = result;
  const stated = whole.stated_speed_rpm ? `, stated ${plain(whole.stated_speed_rpm)}` : '';
  /** @type {[string, string][]} */
  const facts = [
    [
      'Recorded',
      `${signal.rows} rows, ${sig(result.seconds, 3)} s, ${sig(result.turns.pinion, 4)} turns of the pinion`,
    ],
    ['Speed', `${sig(speed.mean, 6)} rpm (${sig(speed.lowest, 6)} … ${sig(speed.highest, 6)})${stated}`],
    [
      'Eccentricity',
      `pinion ${micrometres(shafts.pinion.amplitude_um[0], 3)}, gear ${micrometres(shafts.gear.amplitude_um[0], 3)}`,
    ],
    ['Unexplained', `${micrometres(result.residual_um, 2)} RMS`],
    ['RMS by FFT', `${sig(rms.spectrum, 4)} m/s², with sidebands ${sig(rms.band, 4)}`],
  ];
  for (const [name, tracks] of /** @type {const} */ ([
    ['Pinion', signal.tracks?.pinion],
    ['Gear', signal.tracks?.gear],
  ]))
    if (tracks) facts.push([`${name} tracks`, trackText(tracks)]);
  const [file] = whole.files;
  facts.push([
    'File',
    `${plain(file.size / 1e6)} MB, ${dateText(whole.created)}, SHA-256 ${file.sha256.slice(0, HASH)}…`,
  ]);
  return facts;
}

/**
 * @param {HTMLElement} place @param {Api.ListedMeasurement} item @param {Api.Measurement} whole @param {Beside} beside
 * @param {HTMLElement | null} parts which part of it was measured
 */
export function drawAbout(place, item, whole, beside, parts) {
  const { findings, notes } = whole;
  fill(
    place,
    h('.figure-head', null, h('h3', null, item.file)),
    beside?.outlier ? h('p.fault', null, `Outlier: ${shownSentence(beside.reason ?? '')}`) : null,
    findings.length ? findingList(findings) : h('p.figure-note', null, 'Nothing is wrong with this recording.'),
    h(
      'table.numbers.facts',
      null,
      h(
        'tbody',
        null,
        factsOf(whole).map(([name, value]) => h('tr', null, h('th', { scope: 'row' }, name), h('td', null, value))),
      ),
    ),
    parts,
    h(
      'details.more',
      null,
      h('summary', null, 'How it was read'),
      h(
        'ul.findings',
        null,
        notes.map(text => h('li', null, shownSentence(text))),
      ),
    ),
  );
}
