// SPDX-License-Identifier: GPL-3.0-or-later
// Load capacity by ISO 6336 as the service rates it: the verdict, safeties and load factors of each load case, what the
// rating does not check.
import { fill, h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { capacityText } from '../verdict.js';
import { caseNames, endsOf } from './context.js';
import { Frame } from './frame.js';

const MEMBERS = /** @type {const} */ (['pinion', 'gear']);
const HEAD = ['load case', 'end', 'S_H', 'S_F', 'K_V', 'K_Hβ', 'K_Hβ, method C', 'K_Hα'];

/** The smaller safety of both members. @param {Api.RatedEnd} side @param {'S_H' | 'S_F'} key */
function least(side, key) {
  return Math.min(...MEMBERS.map(member => side[member]?.[key] ?? Infinity));
}

export class Rating {
  /** @type {import('./table.js').Rows} */ #rows = [];

  constructor() {
    this.frame = new Frame({
      title: 'Load capacity',
      name: 'Load capacity by ISO 6336',
      help:
        'Safeties against pitting (S_H) and against tooth breakage (S_F), the smaller of both members, and the load ' +
        'factors that the rating used; K_Hβ from the contact analysis next to that of method C.',
      good: 'Above the required safety at every load case; load factors near 1.',
      wide: true,
      drawing: { table: () => this.#rows },
    });
    this.frame.element.classList.add('with-table', 'keyless');
    fill(this.frame.body, h('p.figure-note', null, 'It is rated when the design rests.'));
  }

  /** @param {Page.Result} result with its rating */
  set(result) {
    const { rating } = result;
    if (!rating) return;
    if (rating.outcome !== 'rated' || !rating.load_cases) {
      fill(this.frame.body, h('p', null, capacityText(rating)));
      return;
    }
    const names = caseNames(result.load_cases);
    const rows = rating.load_cases.flatMap((row, k) =>
      endsOf(result).map(/** @returns {[string, Page.End, ...Page.Curve]} */ end => {
        const side = row[end];
        if (!side) return [names[k], end];
        const { used, method_c: methodC } = side;
        const numbers = [
          least(side, 'S_H'),
          least(side, 'S_F'),
          used.K_V,
          used.K_Hbeta,
          methodC.K_Hbeta,
          used.K_Halpha,
        ];
        return [names[k], end, ...numbers];
      }),
    );
    this.#rows = [HEAD, ...rows];
    fill(this.frame.body, h('p', null, capacityText(rating)), table(rows, endsOf(result).length), unchecked(rating));
  }
}

/** @param {[string, Page.End, ...Page.Curve][]} rows @param {number} ends */
function table(rows, ends) {
  return h(
    'table.numbers',
    null,
    h(
      'thead',
      null,
      h(
        'tr',
        null,
        HEAD.map(text => h('th', { scope: 'col' }, text)),
      ),
    ),
    h(
      'tbody',
      null,
      rows.map(([name, end, ...numbers]) =>
        h(
          'tr',
          null,
          end === 'left' ? h('th', { scope: 'row', rowspan: ends }, name) : null,
          h('td', null, end),
          numbers.map(value => h('td.number', null, sig(value, 3))),
        ),
      ),
    ),
  );
}

/** @param {Api.Rating} rating */
function unchecked(rating) {
  /** @param {string} title @param {string[]} texts */
  const listed = (title, texts) =>
    texts?.length
      ? h(
          'details.more',
          null,
          h('summary', null, title),
          h(
            'ul.findings',
            null,
            texts.map(text => h('li', null, text)),
          ),
        )
      : null;
  return [listed('What it does not check', rating.unchecked), listed('Standards', rating.standards)];
}
