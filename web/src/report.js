// SPDX-License-Identifier: GPL-3.0-or-later
// What a report has that the screen has not: title, date, version, hash, and every assumption of the design.
import { h } from './base/dom.js';
import { labelOf, plain, unitText } from './base/format.js';
import { valueAt } from './base/pointer.js';

const LEFT_OUT = ['optimization', 'name', 'modification'];

/** @param {any} value @returns {string} */
function valueText(value) {
  if (value === null || value === undefined) return '–';
  if (typeof value === 'number') return plain(Number(value.toPrecision(6)));
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (Array.isArray(value)) return value.map(valueText).join(', ');
  return String(value);
}

/** @param {import('./base/schema.js').Field} field @param {any} value @returns {HTMLElement} */
function line(field, value) {
  return h(
    'div.report-line',
    null,
    h('dt', null, labelOf(field.key)),
    h('dd', null, `${valueText(value)} ${unitText(field.unit)}`.trim()),
  );
}

/** @param {import('./base/schema.js').Field[]} fields @param {any} value @returns {HTMLElement[]} */
function lines(fields, value) {
  return fields.flatMap(field => {
    if (field.kind === 'object') return lines(field.fields ?? [], value?.[field.key]);
    if (field.kind === 'list') return [];
    return [line(field, value?.[field.key])];
  });
}

/** @param {import('./base/schema.js').Field[]} fields @param {any} design @returns {HTMLElement} */
function modification(fields, design) {
  const flanks = ['pinion', 'gear']
    .flatMap(member =>
      ['left', 'right'].map(end => ({ member, end, value: valueAt(design, `/modification/${member}/${end}`) })),
    )
    .filter(flank => flank.value);
  const keys = fields.find(field => field.key === 'modification')?.fields?.[0]?.fields?.[0]?.fields ?? [];
  return h(
    'table.numbers',
    null,
    h(
      'thead',
      null,
      h(
        'tr',
        null,
        h('th', null, 'Modification'),
        flanks.map(({ member, end }) => h('th', { scope: 'col' }, `${member}, ${end}`)),
      ),
    ),
    h(
      'tbody',
      null,
      keys.map(field =>
        h(
          'tr',
          null,
          h('th', { scope: 'row' }, `${labelOf(field.key)} ${field.unit ? `(${unitText(field.unit)})` : ''}`),
          flanks.map(({ value }) => h('td.number', null, valueText(value[field.key]))),
        ),
      ),
    ),
  );
}

/** @param {any} design @returns {HTMLElement} */
function loadCases(design) {
  return h(
    'table.numbers',
    null,
    h(
      'thead',
      null,
      h(
        'tr',
        null,
        ['Torque (N m)', 'Speed (rpm)', 'Share of time'].map(text => h('th', { scope: 'col' }, text)),
      ),
    ),
    h(
      'tbody',
      null,
      design.load_cases.map((/** @type {any} */ row) =>
        h(
          'tr',
          null,
          h('td.number', null, valueText(row.torque_Nm)),
          h('td.number', null, valueText(row.speed_rpm)),
          h('td.number', null, valueText(row.share)),
        ),
      ),
    ),
  );
}

/** @param {string} title @param {any} result @returns {HTMLElement} */
export function reportHead(title, result) {
  return h(
    'header.report-head',
    null,
    h('h1', null, title),
    h(
      'p',
      null,
      `${result?.program ?? 'easeoff'} · ${new Date().toLocaleString(undefined, { dateStyle: 'long', timeStyle: 'short' })}`,
    ),
    result?.design_hash ? h('p.hash', null, `design ${result.design_hash}`) : null,
  );
}

/**
 * Every assumption of a result.
 * @param {import('./base/schema.js').Field[]} fields
 * @param {any} result
 * @returns {HTMLElement}
 */
export function reportData(fields, result) {
  const { design } = result;
  return h(
    'section.report-data',
    null,
    h('h2', null, 'Data and assumptions'),
    loadCases(design),
    modification(fields, design),
    fields
      .filter(field => field.kind === 'object' && !LEFT_OUT.includes(field.key))
      .map(field =>
        h(
          'section',
          null,
          h('h3', null, labelOf(field.key)),
          h('dl', null, lines(field.fields ?? [], design[field.key])),
        ),
      ),
  );
}
