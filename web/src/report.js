// SPDX-License-Identifier: GPL-3.0-or-later
// The report: the verdict first, then every figure drawn for paper from its numbers, then data and assumptions. It is
// the same on the screen and on paper, and does not depend on what has been seen.
import { fill, h } from './base/dom.js';
import { choiceText, dateText, labelOf, plain } from './base/format.js';
import { valueAt } from './base/pointer.js';
import { fieldAt, unitOf } from './base/schema.js';
import { inInches, shownSentence, shownValue } from './base/units.js';
import { sheetAsSvg } from './figures/sheet.js';
import { tableOf } from './verdict.js';

/** @typedef {import('./base/schema.js').Field} Field */
/**
 * @typedef {object} Parts what a view gives to its report
 * @property {string} title
 * @property {Page.Result | null} result whose data and assumptions stand at the end
 * @property {HTMLElement[]} lead tables before the figures
 * @property {import('./figures/frame.js').Frame[]} figures
 * @property {string[]} missing what is still being computed
 */

const LEFT_OUT = ['optimization', 'name', 'modification', 'version'];
const NARROW = { width: 470, height: 220, foot: false };
const WIDE = { width: 960, height: 300, foot: false };
const LOOK = 500; // ms between two looks at what is missing

/** A word as people write it, a number in its unit. @param {Field} field @param {unknown} value */
function fieldText(field, value) {
  return field.choices && typeof value === 'string' ? choiceText(value) : valueText(value, field.unit);
}

/** @param {unknown} value @param {string | null} [unit] of the field @returns {string} */
function valueText(value, unit) {
  if (value === null || value === undefined) return '–';
  if (typeof value === 'number') return plain(Number(shownValue(value, unit).toPrecision(6)));
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (Array.isArray(value)) return value.map(each => valueText(each, unit)).join(', ');
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}

/** @param {Field[]} fields @param {unknown} value @returns {HTMLElement[]} */
function lines(fields, value) {
  return fields.flatMap(field => {
    if (field.entry || field.kind === 'list') return [];
    if (field.kind === 'object') return lines(field.fields ?? [], valueAt(value, `/${field.key}`));
    return [
      h(
        'div.report-line',
        null,
        h('dt', null, labelOf(field.key)),
        h('dd', null, `${fieldText(field, valueAt(value, `/${field.key}`))} ${unitOf(field)}`.trim()),
      ),
    ];
  });
}

/** @param {Field[]} fields @param {Page.Design} design */
function modification(fields, design) {
  const flanks = ['pinion', 'gear']
    .flatMap(member =>
      ['left', 'right'].map(end => ({ member, end, value: valueAt(design, `/modification/${member}/${end}`) })),
    )
    .filter(flank => flank.value);
  const keys = fields.find(field => field.key === 'modification')?.fields?.[0]?.fields?.[0]?.fields ?? [];
  /** Of a shape: whether something has it. @param {string} key */
  const matters = key => {
    const [, stem, what] = /^(.*?)_?(shape|exponent)$/.exec(key) ?? [];
    if (stem === undefined) return true;
    if (what === 'exponent' && !flanks.some(({ value }) => Object.values(value).includes('exponent'))) return false;
    const amounts = keys.filter(({ key: other, unit }) => unit === 'um' && other.includes(stem));
    return flanks.some(({ value }) => amounts.some(({ key: other }) => value[other]));
  };
  const shown = keys.filter(
    field =>
      field.kind !== 'object' &&
      !field.entry &&
      matters(field.key) &&
      flanks.some(({ value }) => value[field.key] && value[field.key] !== 'as_relief_shape'),
  );
  return tableOf(
    ['Modification', ...flanks.map(({ member, end }) => `${member}, ${end}`)],
    shown.map(field => [
      `${labelOf(field.key)} ${field.unit ? `(${unitOf(field)})` : ''}`,
      ...flanks.map(({ value }) => fieldText(field, value[field.key])),
    ]),
  );
}

/** @param {Page.Design} design */
function loadCases(design) {
  return tableOf(
    ['Load case', 'Torque (N m)', 'Speed (rpm)', 'Share of time'],
    design.load_cases.map((row, k) => [
      row.name || String(k + 1),
      valueText(row.torque_Nm),
      valueText(row.speed_rpm),
      valueText(row.share),
    ]),
  );
}

/**
 * What was not stated, with the value taken and its rule.
 * @param {Field[]} fields
 * @param {Api.Assumption[] | null} assumed
 */
function assumptions(fields, assumed) {
  if (!assumed?.length) return null;
  return h(
    'section',
    null,
    h('h3', null, 'Assumed'),
    tableOf(
      ['', 'value', 'rule'],
      assumed.map(({ key, value, rule }) => {
        const field = fieldAt(fields, key);
        const text = `${valueText(value, field?.unit)} ${unitOf(field)}`.trim();
        return [key.split('/').slice(1).map(labelOf).join(', '), text, shownSentence(rule)];
      }),
    ),
  );
}

/** Every assumption of a result. @param {Field[]} fields @param {Page.Result} result */
function reportData(fields, result) {
  const { design } = result;
  return h(
    'section.report-data',
    null,
    h('h2', null, 'Data and assumptions'),
    loadCases(design),
    modification(fields, design),
    assumptions(fields, result.assumed),
    fields
      .filter(field => field.kind === 'object' && !LEFT_OUT.includes(field.key))
      .map(field =>
        h(
          'section',
          null,
          h('h3', null, labelOf(field.key)),
          h('dl', null, lines(field.fields ?? [], valueAt(design, `/${field.key}`))),
        ),
      ),
  );
}

/** @param {import('./figures/frame.js').Frame} frame @param {boolean} narrow for a screen of one column */
function pictureOf(frame, narrow) {
  const wide = frame.element.classList.contains('wide') || frame.element.classList.contains('tall');
  const content = frame.content();
  const kind = wide ? 'figure.report-figure.wide' : 'figure.report-figure';
  if (content) return h(kind, null, sheetAsSvg(content, wide && !narrow ? WIDE : NARROW));
  const table = frame.body.querySelector('table');
  return table ? h(kind, null, h('h3', null, frame.title), table.cloneNode(true)) : null;
}

/** @param {Parts} parts @param {Field[]} fields @param {boolean} [narrow] @returns {HTMLElement} */
function reportOf(parts, fields, narrow = false) {
  const { title, result, lead, figures, missing } = parts;
  return h(
    'article.report',
    { 'data-theme': 'light' },
    h(
      'header.report-head',
      null,
      h('h1', null, title),
      h('p', null, `${result?.program ?? 'easeoff'} · ${dateText(new Date().toISOString())}`),
      result?.design_hash ? h('p.hash', null, `design number ${result.design_hash}`) : null,
    ),
    missing.length
      ? h('p.report-missing', null, `Not in this report, still being computed: ${missing.join(', ')}.`)
      : null,
    lead,
    h('section.report-figures', null, figures.map(frame => pictureOf(frame, narrow))),
    result ? reportData(fields, result) : null,
  );
}

/** Puts the report of the open view in the place of the page while it is printed. */
export class Paper {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    this.element = h('div', { id: 'paper' });
  }

  start() {
    document.body.append(this.element);
    window.addEventListener('beforeprint', () => {
      const parts = this.app.reportParts();
      if (parts) fill(this.element, reportOf(parts, this.app.fields));
    });
    window.addEventListener('afterprint', () => this.element.replaceChildren());
  }
}

/**
 * The report on the screen, and what it still waits for.
 * @param {import('./app.js').App} app
 * @returns {import('./app.js').View}
 */
export function reportView(app) {
  const state = h('span.report-state', { role: 'status' });
  const print = h('button.primary', { type: 'button', onclick: () => window.print() }, 'Print, or save as PDF');
  const sheet = h('.report-sheet');
  const element = h(
    '.report-view',
    null,
    h('.report-bar', null, h('button', { type: 'button', onclick: () => history.back() }, '← Back'), state, print),
    sheet,
  );
  const phone = matchMedia('(max-width: 760px)');
  let drawn = '';
  const draw = () => {
    if (app.current !== 'report') return;
    const parts = app.reportParts();
    const missing = parts ? parts.missing : ['the result'];
    state.textContent = missing.length ? `Still being computed: ${missing.join(', ')}` : 'The report is whole.';
    print.disabled = !parts;
    const { title, result } = parts ?? {};
    const shape = JSON.stringify([inInches(), title, result?.evaluation_hash, missing, app.store.pin?.label]);
    if (parts && shape !== drawn) fill(sheet, reportOf(parts, app.fields, phone.matches));
    drawn = shape;
    if (missing.length) setTimeout(draw, LOOK);
  };
  app.analyst.addEventListener('result', draw);
  return {
    element,
    async show() {
      drawn = '';
      await app.view('design');
      draw();
    },
  };
}
