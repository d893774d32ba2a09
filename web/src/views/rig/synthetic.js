// SPDX-License-Identifier: GPL-3.0-or-later
// A synthetic recording: what two encoders would see of the design on the table, to try things out.
import { download, h } from '../../base/dom.js';
import { plain } from '../../base/format.js';
import { Lane } from '../../base/lane.js';
import { readQuantity } from '../../base/quantity.js';
import { mainCase, torqueOf } from '../../figures/context.js';
import { group } from '../../form/group.js';

const OUTPUTS = ['angles', 'counts', 'sine-cosine', 'pulses'];
const FAULTS = ['none', 'swapped', 'reversed', 'slip', 'dropped', 'teeth', 'saturated', 'spike'];
const LINES = 1024; // of encoders that do not give angles

/** @param {string} label @param {string[]} values */
function select(label, values) {
  return h(
    'select',
    { 'aria-label': label },
    values.map(value => h('option', { value }, value)),
  );
}

/** @typedef {NonNullable<Api.RigOrder['rig']>['output']} Output */
/** @typedef {NonNullable<Api.RigOrder['rig']>['fault']} Fault */

export class Synthetic {
  #keep = false;
  #asked = { name: '', torque: 0, speed: 0 };

  /** @param {import('../../app.js').App} app @param {import('./recordings.js').Recordings} recordings */
  constructor(app, recordings) {
    this.app = app;
    this.recordings = recordings;
    this.pair = select('Synthetic pair', ['modified', 'unmodified']);
    this.torque = h('input.number', { type: 'text', inputmode: 'decimal', 'aria-label': 'Synthetic torque, N m' });
    this.speed = h('input.number', { type: 'text', inputmode: 'decimal', 'aria-label': 'Synthetic speed, rpm' });
    this.output = select('Synthetic columns', OUTPUTS);
    this.fault = select('Synthetic fault', FAULTS);
    this.note = h('p.figure-note', { role: 'status' });
    /** @type {Lane<string>} */
    this.lane = new Lane({
      result: (_task, data) => this.#take(data),
      refused: (_task, error) => this.#say(error.message),
      preparing: () => this.#say('The teeth are being prepared…'),
    });
    /** @param {string} label @param {HTMLElement} entry */
    const row = (label, entry) => h('.field', null, h('span.label', null, label), entry);
    this.element = group('teaching', 'Synthetic recording', false, [
      h(
        'p.figure-note',
        null,
        'Records what two encoders would see of this design, with noise and eccentricity, to try things out. ' +
          'Torque and speed left empty are those of the load case with the largest share.',
      ),
      row('Pair', this.pair),
      row('Torque, N m', this.torque),
      row('Speed, rpm', this.speed),
      row('Columns', this.output),
      row('Fault', this.fault),
      h(
        '.form-foot.switches',
        null,
        h('button.small', { type: 'button', onclick: () => this.#run(false) }, 'Record and use'),
        h('button.small', { type: 'button', onclick: () => this.#run(true) }, 'Download'),
      ),
      this.note,
    ]);
  }

  /** @param {string} text */
  #say(text) {
    this.note.textContent = text;
  }

  /**
   * What is typed, or what is usual when nothing is.
   * @param {HTMLInputElement} input
   * @param {string} unit
   * @param {number} usual
   */
  #read(input, unit, usual) {
    if (input.value.trim() === '') return usual;
    const { value = NaN } = readQuantity(input.value, unit);
    input.setAttribute('aria-invalid', String(!(value > 0)));
    return value;
  }

  /** @param {boolean} keep as a file */
  #run(keep) {
    this.#keep = keep;
    const { design } = this.app.store;
    const usual = design.load_cases[mainCase(design)];
    const torque = this.#read(this.torque, 'Nm', torqueOf(usual));
    const speed = this.#read(this.speed, 'rpm', usual.speed_rpm);
    if (!(torque > 0 && speed > 0)) return this.#say('Torque and speed are numbers above zero, or left empty.');
    const pair = this.pair.value;
    this.#asked = { name: `${pair}-${plain(torque)}Nm-${plain(speed)}rpm.csv`, torque, speed };
    this.#say('Recording…');
    this.lane.submit({
      path: 'rig',
      body: {
        design,
        rig: {
          torque_Nm: torque,
          speed_rpm: speed,
          unmodified: pair === 'unmodified',
          output: /** @type {Output} */ (this.output.value),
          fault: /** @type {Fault} */ (this.fault.value),
          ...(this.output.value === 'angles' ? {} : { pinion_lines: LINES, gear_lines: LINES }),
        },
      },
    });
  }

  /** @param {string} data */
  #take(data) {
    this.#say('');
    const { name, torque, speed } = this.#asked;
    const file = new File([data], name, { type: 'text/csv' });
    if (this.#keep) download(name, file);
    else this.recordings.add([file], { label: this.pair.value, torque: plain(torque), speed: plain(speed) });
  }
}
