// SPDX-License-Identifier: GPL-3.0-or-later
// Rig files on their way: what is dropped or chosen, what is known of each, its upload and what the service found in
// it.
import { Refusal } from '../../base/api.js';
import { fill, h, newId } from '../../base/dom.js';
import { plain } from '../../base/format.js';
import { parseNumber } from '../../base/quantity.js';
import { guess } from '../../base/recording.js';
import { RefusedRecording, upload } from '../../base/upload.js';
import { torqueOf } from '../../figures/context.js';
import { group } from '../../form/group.js';
import { shownSentence } from '../../base/units.js';

/**
 * @typedef {{ file: File, gear: File | null, label: string, torque: string, speed: string, state: 'waiting' |
 * 'sending' | 'reading' | 'refused' | 'failed', part: number, error: Error | null, bar: HTMLElement | null,
 * again?: import('./parts.js').Choice & Pick<Api.Measurement, 'end'> & { layout: Api.AskedLayout | null } }} Recording
 * again: another part of what was measured before, as it was read then
 */

const AT_ONCE = 2;
const TRIES = 5;
const PAUSE = 2000; // ms before a busy service is asked again
const SEVERITY = /** @type {Record<string, string>} */ ({
  refused: 'no result',
  warning: 'doubtful',
  repaired: 'repaired',
  note: 'note',
});

/** Findings in plain words, the gravest first. @param {(Api.BriefFinding & { line?: Page.Reading })[]} findings */
export function findingList(findings) {
  const order = ['refused', 'warning', 'repaired', 'note'];
  const sorted = [...findings].sort((a, b) => order.indexOf(a.severity) - order.indexOf(b.severity));
  return h(
    'ul.findings',
    null,
    sorted.map(finding =>
      h(
        'li',
        null,
        h(`span.severity.${finding.severity}`, null, SEVERITY[finding.severity] ?? finding.severity),
        ' ',
        shownSentence(finding.text),
        finding.line ? h('span.unit', null, ` line ${finding.line}`) : null,
      ),
    ),
  );
}

/** @param {import('../../base/api.js').Fault} fault */
function faultText({ pointer, detail }) {
  return pointer === '/torque_Nm' ? `${detail} At which torque was it recorded? Type it above.` : detail;
}

/** Override of what the columns mean; what is left open is guessed. */
class LayoutForm {
  constructor() {
    /** @param {string} label @param {[string, string][]} choices */
    const select = (label, choices) =>
      h(
        'select',
        { 'aria-label': label },
        choices.map(([value, text]) => h('option', { value }, text)),
      );
    /** @param {string} label @param {string} hint */
    const text = (label, hint) => h('input', { type: 'text', 'aria-label': label, placeholder: hint, class: 'short' });
    this.kind = select('What the columns hold', [
      ['', 'guess'],
      ['angles', 'angles'],
      ['sine-cosine', 'raw sine and cosine'],
      ['pulses', 'pulse times'],
    ]);
    this.unit = select('Unit of the angles', [
      ['', 'guess'],
      ['deg', 'degrees'],
      ['rad', 'radians'],
      ['turn', 'turns'],
      ['count', 'counts'],
    ]);
    this.time = text('Time column', 'guess');
    this.timeUnit = select('Unit of the time', [
      ['', 'guess'],
      ['s', 's'],
      ['ms', 'ms'],
      ['us', 'µs'],
      ['ns', 'ns'],
    ]);
    this.rate = text('Sampling rate without time column, Hz', '–');
    this.pinion = text('Pinion column or columns', 'guess');
    this.gear = text('Gear column or columns', 'guess');
    this.lines = text('Lines per turn, pinion and gear', '–');
    this.guessed = h('p.figure-note');
    /** @param {string} label @param {HTMLElement} entry */
    const row = (label, entry) => h('.field', null, h('span.label', null, label), entry);
    this.element = group('layout', 'What the columns mean', false, [
      h(
        'p.figure-note',
        null,
        'Guessed from names, units and values. Say it where the guess is wrong: a name, or a number from 1; ' +
          'two with a comma for raw tracks.',
      ),
      row('Columns hold', this.kind),
      row('Unit', this.unit),
      row('Pinion', this.pinion),
      row('Gear', this.gear),
      row('Time', this.time),
      row('Time unit', this.timeUnit),
      row('Rate, Hz', this.rate),
      row('Lines per turn', this.lines),
      this.guessed,
    ]);
  }

  /** JSON, or nothing when all is open. */
  value() {
    /** @type {Api.AskedLayout} */
    const layout = {};
    /** @param {string} text */
    const column = text => (/^\d+$/.test(text) ? Number(text) : text);
    /** @param {HTMLInputElement} field */
    const columns = field =>
      field.value
        .split(/[,;]/)
        .map(part => part.trim())
        .filter(Boolean)
        .map(column);
    if (this.kind.value) layout.kind = /** @type {Api.AskedLayout['kind']} */ (this.kind.value);
    if (this.unit.value) layout.unit = /** @type {Api.AskedLayout['unit']} */ (this.unit.value);
    if (this.time.value.trim()) layout.time = column(this.time.value.trim());
    if (this.timeUnit.value)
      layout.time_unit = /** @type {Api.AskedLayout['time_unit']} */ (this.timeUnit.value);
    const rate = parseNumber(this.rate.value);
    if (rate !== undefined) layout.sample_rate_Hz = rate;
    for (const [member, field] of /** @type {[Page.Member, HTMLInputElement][]} */ ([
      ['pinion', this.pinion],
      ['gear', this.gear],
    ])) {
      const list = columns(field);
      if (list.length) (layout.columns ??= {})[member] = list.length > 1 ? list : list[0];
    }
    const lines = this.lines.value
      .split(/[,;]/)
      .map(part => parseNumber(part))
      .filter(value => value !== undefined);
    if (lines.length) layout.lines = lines.length > 1 ? lines : lines[0];
    return Object.keys(layout).length ? layout : null;
  }

  /** Shows what the service made of a file. @param {Api.Layout | null} layout */
  show(layout) {
    if (!layout) return;
    /** @param {unknown} value */
    const text = value => (Array.isArray(value) ? value.join(', ') : String(value ?? '–'));
    const { kind = '', unit, columns, time, time_unit: timeUnit, lines } = layout;
    const parts = [
      `${kind}${unit ? ` in ${unit}` : ''}`,
      `pinion ${text(columns?.pinion)}`,
      `gear ${text(columns?.gear)}`,
      `time ${text(time)}${timeUnit ? ` in ${timeUnit}` : ''}`,
      lines ? `lines ${text(lines)}` : '',
    ];
    this.guessed.textContent = `Last file: ${parts.filter(Boolean).join(', ')}.`;
  }

  open() {
    this.element.open = true;
  }
}

/** Again while the service is busy. @template T @param {() => Promise<T>} act @returns {Promise<T>} */
async function patiently(act) {
  for (let left = TRIES; ; left--) {
    try {
      return await act();
    } catch (error) {
      if (left === 0 || !(error instanceof Refusal) || (error.status !== 429 && error.status !== 503)) throw error;
      await new Promise(resolve => setTimeout(resolve, PAUSE));
    }
  }
}

export class Recordings {
  /** @type {Recording[]} */ #queue = [];

  /**
   * @param {{ designId: () => Promise<string>, kept: (measurement: Api.Measurement, known: boolean) => void,
   *   loadCases: () => Api.Design['load_cases'] }} host
   */
  constructor(host) {
    this.host = host;
    this.layout = new LayoutForm();
    this.chooser = h('input.away', {
      type: 'file',
      multiple: true,
      tabindex: '-1',
      'aria-hidden': 'true',
      onchange: () => {
        this.add([...(this.chooser.files ?? [])]);
        this.chooser.value = '';
      },
    });
    this.two = h('input', { type: 'checkbox', id: newId('two') });
    this.end = h(
      'select',
      { 'aria-label': 'Where the encoders sit' },
      h('option', { value: 'right' }, 'right end'),
      h('option', { value: 'left' }, 'left end'),
    );
    this.harmonics = h('input.number', { type: 'text', inputmode: 'numeric', value: '8', 'aria-label': 'Mesh orders' });
    this.drop = h(
      '.drop',
      {
        onclick: () => this.chooser.click(),
        ondragover: (/** @type {DragEvent} */ event) => {
          event.preventDefault();
          this.drop.classList.add('over');
        },
        ondragleave: () => this.drop.classList.remove('over'),
        ondrop: (/** @type {DragEvent} */ event) => this.#dropped(event),
      },
      h(
        'button',
        {
          type: 'button',
          onclick: (/** @type {Event} */ event) => {
            event.stopPropagation();
            this.chooser.click();
          },
        },
        'Choose files',
      ),
      h(
        'p',
        null,
        'or drop what the rig recorded: text, spreadsheets, MATLAB, TDMS, UFF 58, HDF5, MDF 4, gzip, zip, tar',
      ),
    );
    this.list = h('.recordings');
    this.element = h(
      'div',
      null,
      h('.drop-box', null, this.drop, this.chooser),
      this.list,
      group('encoders', 'Encoders', true, [
        h('.field', null, h('span.label', null, 'End where the encoders are'), this.end),
        h('.field', null, h('span.label', null, 'Mesh orders of the RMS'), this.harmonics),
        h('label.field.flag', { for: this.two.id }, this.two, h('span', null, 'one file for each: pinion, then gear')),
      ]),
      this.layout.element,
    );
  }

  /** @param {DragEvent} event */
  #dropped(event) {
    event.preventDefault();
    this.drop.classList.remove('over');
    this.add([...(event.dataTransfer?.files ?? [])]);
  }

  /** @param {File[]} files @param {Partial<Recording>} [known] */
  add(files, known = {}) {
    const ordered = [...files].sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
    for (let i = 0; i < ordered.length; i += this.two.checked ? 2 : 1) {
      const said = guess(ordered[i].name);
      this.#queue.push({
        file: ordered[i],
        gear: this.two.checked ? (ordered[i + 1] ?? null) : null,
        label: said.label || 'modified',
        torque: said.torque || this.#certainTorque(),
        speed: said.speed,
        state: 'waiting',
        part: 0,
        error: null,
        bar: null,
        ...known,
      });
    }
    this.draw();
  }

  /** The torque when all load cases have the same: else only who recorded it knows. */
  #certainTorque() {
    const torques = new Set(this.host.loadCases().map(torqueOf));
    return torques.size === 1 ? plain([...torques][0]) : '';
  }

  draw() {
    const waiting = this.#queue.filter(item => item.state === 'waiting').length;
    const button = h(
      'button.primary',
      { type: 'button', disabled: waiting === 0, onclick: () => this.send() },
      waiting > 1 ? `Measure ${waiting} recordings` : 'Measure',
    );
    fill(
      this.list,
      this.#queue.length ? h('.form-foot', null, button) : null,
      this.#queue.map(item => this.#row(item)),
    );
  }

  /** @param {Recording} item */
  #row(item) {
    const idle = item.state !== 'sending' && item.state !== 'reading';
    /** @param {'torque' | 'speed'} key @param {string} label @param {string} unit */
    const number = (key, label, unit) =>
      h(
        'label.part',
        null,
        h('input.number', {
          type: 'text',
          inputmode: 'decimal',
          'aria-label': `${label} of ${item.file.name}, ${unit}`,
          title: label,
          placeholder: key === 'torque' ? '?' : '',
          value: item[key],
          disabled: !idle,
          onchange: (/** @type {Event} */ event) => {
            item[key] = /** @type {HTMLInputElement} */ (event.target).value;
            this.#again(item);
          },
        }),
        h('span.unit', null, unit),
      );
    const label = h(
      'select',
      {
        'aria-label': 'Label',
        disabled: !idle,
        onchange: () => {
          item.label = label.value;
          this.#again(item);
        },
      },
      ['modified', 'unmodified'].map(each => h('option', { value: each, selected: each === item.label }, each)),
    );
    const bar = h(
      'span.progress',
      {
        role: 'progressbar',
        'aria-label': `Upload of ${item.file.name}`,
        'aria-valuenow': Math.round(100 * item.part),
      },
      h('span', { css: { width: `${100 * item.part}%` } }),
    );
    item.bar = /** @type {HTMLElement} */ (bar.firstElementChild);
    const state = item.state === 'sending' ? [bar] : item.state === 'reading' ? ['is being read…'] : [];
    const faults = item.error instanceof Refusal ? item.error.faults : [];
    return h(
      '.recording',
      { 'data-state': item.state },
      h(
        '.recording-head',
        null,
        h('b', null, item.file.name, item.gear ? ` + ${item.gear.name}` : ''),
        state,
        idle
          ? h(
              'button.icon',
              {
                type: 'button',
                'aria-label': `Leave ${item.file.name} out`,
                title: 'Leave out',
                onclick: () => {
                  this.#queue = this.#queue.filter(other => other !== item);
                  this.draw();
                },
              },
              '✕',
            )
          : null,
      ),
      h('.recording-parts', null, label, number('torque', 'Torque', 'N m'), number('speed', 'Speed', 'rpm')),
      item.error
        ? h(
            'div',
            { role: 'alert' },
            item.error instanceof RefusedRecording
              ? findingList(item.error.findings)
              : h('p.fault', null, faults.length ? faults.map(faultText).join(' ') : item.error.message),
            h(
              '.switches',
              null,
              h(
                'button.small',
                {
                  type: 'button',
                  onclick: () => {
                    this.#again(item);
                    this.send();
                  },
                },
                'Try again',
              ),
              h('button.small', { type: 'button', onclick: () => this.layout.open() }, 'Say what the columns mean'),
            ),
          )
        : null,
    );
  }

  /** @param {Recording} item */
  #again(item) {
    if (item.state !== 'refused' && item.state !== 'failed') return;
    item.state = 'waiting';
    item.error = null;
    this.draw();
  }

  async send() {
    const work = async () => {
      for (let item = this.#next(); item; item = this.#next()) await this.#sendOne(item);
    };
    await Promise.all(Array.from({ length: AT_ONCE }, work));
  }

  #next() {
    const item = this.#queue.find(each => each.state === 'waiting');
    if (item) item.state = 'sending';
    return item;
  }

  /** @param {Recording} item */
  async #sendOne(item) {
    item.part = 0;
    item.error = null;
    this.draw();
    try {
      const form = new FormData();
      form.set('design', await this.host.designId());
      form.set('label', item.label);
      const [torque, speed] = [parseNumber(item.torque), parseNumber(item.speed)];
      if (item.torque.trim()) form.set('torque_Nm', torque === undefined ? item.torque : String(torque));
      if (item.speed.trim()) form.set('speed_rpm', speed === undefined ? item.speed : String(speed));
      const { end = this.end.value, layout = this.layout.value(), ...part } = item.again ?? {};
      form.set('end', end);
      if (this.harmonics.value.trim()) form.set('harmonics', this.harmonics.value.trim());
      for (const [key, value] of Object.entries(part)) form.set(key, String(value));
      if (layout) form.set('layout', JSON.stringify(layout));
      form.append('file', item.file, item.file.name);
      if (item.gear) form.append('file', item.gear, item.gear.name);
      const { status, data } = await patiently(() => upload('measurements', form, part => this.#progress(item, part)));
      this.#queue = this.#queue.filter(other => other !== item);
      this.layout.show(data.layout);
      this.host.kept(data, status === 200);
    } catch (error) {
      item.error = /** @type {Error} */ (error);
      item.state = error instanceof RefusedRecording ? 'refused' : 'failed';
      if (error instanceof RefusedRecording) this.layout.show(error.layout);
    }
    this.draw();
  }

  /** @param {Recording} item @param {number} part */
  #progress(item, part) {
    item.part = part;
    item.bar?.style.setProperty('width', `${100 * part}%`);
    if (part < 1 || item.state !== 'sending') return;
    item.state = 'reading';
    this.draw();
  }
}
