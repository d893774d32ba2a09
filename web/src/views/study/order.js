// SPDX-License-Identifier: GPL-3.0-or-later
// What a study varies: keys with their values, how they are sampled, what is kept; and what it would cost.
import { Refusal, ask, post, token } from '../../base/api.js';
import { fill, h } from '../../base/dom.js';
import { sig, timeText } from '../../base/format.js';
import { KeyField } from './key_field.js';
import { keysOf } from './key_words.js';

const PAUSE = 400; // ms after the last key before the cost is asked for

/** "0:30:4", "0, 10, 20" or words, as the service takes them. @param {string} key @param {string} text */
export function axisOf(key, text) {
  const parts = text.split(':').map(Number);
  if (text.includes(':') && parts.length <= 3 && parts.every(Number.isFinite)) {
    const [from, to, points] = parts;
    return { key, from, to, ...(points ? { points } : {}) };
  }
  const list = text
    .split(',')
    .map(part => part.trim())
    .filter(Boolean);
  const numbers = list.map(Number);
  return numbers.every(Number.isFinite) ? { key, values: numbers } : { key, words: list.join(',') };
}

export class StudyOrder {
  #timer = 0;
  #turn = 0;

  /** @param {import('../../app.js').App} app @param {(job: any) => void} begun */
  constructor(app, begun) {
    this.app = app;
    this.begun = begun;
    /** Numbers of the design. @type {import('./key_words.js').Key[]} */
    this.keys = [];
    /** @type {{ row: HTMLElement, key: KeyField, values: HTMLInputElement }[]} */
    this.varied = [];
    this.axes = h('div.study-axes');
    this.sampling = h(
      'select',
      { id: 'study-sampling', onchange: () => this.#changed() },
      h('option', { value: 'factorial' }, 'every value with every other'),
      h('option', { value: 'latin' }, 'Latin hypercube'),
      h('option', { value: 'sobol' }, 'Sobol sequence'),
    );
    this.samples = h('input.text', {
      id: 'study-samples',
      type: 'number',
      min: 1,
      value: 64,
      oninput: () => this.#changed(),
    });
    this.columns = h('input.text', {
      id: 'study-columns',
      placeholder: 'objectives and what they are made of',
      title: 'Paths of numbers in the result, * for anything: objectives.*, load_cases.*.lte.*',
      oninput: () => this.#changed(),
    });
    this.cost = h('p.figure-note', { role: 'status' });
    this.trouble = h('.fault', { role: 'alert' });
    this.start = h('button.primary', { type: 'submit', form: 'study-form' }, 'Start the study');
    this.element = h(
      '.form-scroll',
      null,
      h(
        'form.parameters',
        {
          id: 'study-form',
          'aria-label': 'Study',
          autocomplete: 'off',
          onsubmit: (/** @type {Event} */ event) => {
            event.preventDefault();
            this.#submit();
          },
        },
        h('h2', null, 'What varies'),
        this.axes,
        h('button', { type: 'button', onclick: () => this.#add('', '') }, 'One more'),
        h('p.figure-note', null, 'Values: 0, 10, 20 – or 0:30:4 for four from 0 to 30 – or 0:30 for samples between.'),
        h('label', { for: 'study-sampling' }, 'Combined as'),
        this.sampling,
        h('label', { for: 'study-samples' }, 'Samples'),
        this.samples,
        h('label', { for: 'study-columns' }, 'Numbers kept'),
        this.columns,
        this.cost,
      ),
    );
    this.foot = h('.form-foot', null, this.start, this.trouble);
    this.#add('modification.pinion.*.tip_relief_um', '0:30:4');
    this.#add('modification.pinion.*.lead_crowning_um', '0:20:3');
    app.store.addEventListener('change', () => {
      if (app.current === 'study') this.refresh();
    });
  }

  /** @param {string} path @param {string} text values */
  #add(path, text) {
    const number = this.axes.childElementCount + 1;
    const changed = () => this.#changed();
    const key = new KeyField(`Key ${number}`, path, () => this.keys, changed);
    const values = h('input.text.study-values', {
      'aria-label': `Values ${number}`,
      placeholder: '0:30:4',
      value: text,
      oninput: changed,
    });
    const drop = () => {
      row.remove();
      this.varied = this.varied.filter(each => each.row !== row);
      this.#changed();
    };
    const row = h(
      '.study-axis',
      null,
      key.element,
      values,
      h('button.quiet', { type: 'button', 'aria-label': `Leave out ${number}`, onclick: drop }, '×'),
    );
    this.varied.push({ row, key, values });
    this.axes.append(row);
    this.#changed();
  }

  refresh() {
    const { form, store } = this.app;
    this.keys = keysOf(form.fields, store.design.load_cases?.length ?? 0);
    for (const { key } of this.varied) key.refresh();
    this.#changed();
  }

  /** @returns {Api.StudyOrder} */
  #document() {
    const vary = this.varied.flatMap(({ key, values }) => {
      const text = values.value.trim();
      return key.value && text ? [axisOf(key.value, text)] : [];
    });
    return {
      design: this.app.store.design,
      vary,
      sampling: /** @type {Api.StudyOrder['sampling']} */ (this.sampling.value),
      samples: Number(this.samples.value) || 64,
      ...(this.columns.value.trim() ? { columns: this.columns.value.trim() } : {}),
    };
  }

  #changed() {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#askCost(), PAUSE);
    this.samples.disabled = this.sampling?.value === 'factorial';
  }

  async #askCost() {
    if (this.app.current !== 'study') return;
    const turn = ++this.#turn;
    try {
      const cost = await post('study-cost', this.#document());
      if (turn !== this.#turn) return;
      const all = cost.evaluation_s === null ? null : cost.evaluation_s * cost.variants;
      const each = all === null ? '' : `: ${timeText(all)} of a processor`;
      const memory = `${sig(cost.memory_bytes / 1e9, 2)} GB`;
      this.cost.textContent =
        `${cost.variants} variants of ${cost.pairs} gear pair${cost.pairs === 1 ? '' : 's'}${each}; ` +
        `teeth that are new are prepared in at most ${timeText(cost.preparation_s)} and ${memory}.`;
      fill(this.trouble);
    } catch (error) {
      if (turn === this.#turn) this.#complain(error);
    }
  }

  /** @param {unknown} error */
  #complain(error) {
    const faults = error instanceof Refusal ? error.faults : [];
    this.cost.textContent = '';
    fill(
      this.trouble,
      faults.length
        ? faults.map(fault => h('p', null, `${fault.pointer} ${fault.detail}`))
        : h('p', null, /** @type {Error} */ (error).message),
    );
  }

  async #submit() {
    this.app.form.flush();
    this.start.disabled = true;
    try {
      const { data } = await ask('POST', 'studies', {
        body: this.#document(),
        headers: { 'Idempotency-Key': token() },
      });
      const { design: _design, ...job } = data;
      this.app.jobs.put(job);
      this.begun(data);
    } catch (error) {
      this.#complain(error);
    }
    this.start.disabled = false;
  }
}
