// SPDX-License-Identifier: GPL-3.0-or-later
// The verdict of a result: before and after for every load case, and what to know about it.
import { h } from './base/dom.js';
import { change, changeText, plain, sig } from './base/format.js';
import { shownSentence, shownUnit } from './base/units.js';
import { caseLong } from './figures/context.js';
import { NUMBERS, numbersBefore, numbersOf, shownNumber } from './numbers.js';

/** "−117.501 µm", and no sentence that begins with a number. @param {string} text */
const isNumber = text => /^[−\d–±+.]/.test(text) && text.length < 24 && !/[a-z]{4}/.test(text);

/** @param {string[]} head @param {(string | HTMLElement)[][]} rows first cell of a row is its heading */
export function tableOf(head, rows) {
  /** @param {number} i */
  const numeric = i => i > 0 && rows.some(row => isNumber(String(row[i])));
  return h(
    'table.numbers',
    null,
    h(
      'thead',
      null,
      h(
        'tr',
        null,
        head.map((text, i) =>
          h(numeric(i) ? 'th.number' : 'th', { scope: 'col' }, text || h('span.unseen', null, 'name')),
        ),
      ),
    ),
    h(
      'tbody',
      null,
      rows.map(([name, ...cells]) =>
        h(
          'tr',
          null,
          name ? h('th', { scope: 'row' }, name) : h('td'),
          cells.map(cell => h(isNumber(String(cell)) ? 'td.number' : 'td', null, cell)),
        ),
      ),
    ),
  );
}

/**
 * Before and after, for every load case.
 * @param {Page.Result} result
 * @param {import('./figures/context.js').Reference | undefined} reference
 */
export function verdict(result, reference) {
  const rows = result.load_cases.flatMap((row, k) => {
    const own = numbersOf(result, k);
    const before = numbersBefore(reference?.result, row, k);
    return NUMBERS.map((number, i) => [
      i === 0 ? caseLong(row) : '',
      `${number.name}, ${shownUnit(number.unit)}`,
      sig(shownNumber(before[number.key], number), 3),
      sig(shownNumber(own[number.key], number), 3),
      changeText(change(own[number.key], before[number.key])),
    ]);
  });
  const total = [
    'All load cases',
    'objective J',
    sig(reference?.result?.objectives?.J, 3),
    sig(result.objectives?.J, 3),
    changeText(change(result.objectives?.J, reference?.result?.objectives?.J)),
  ];
  return h(
    'section.verdict',
    null,
    h('h2', null, 'Result'),
    tableOf(['load case', '', reference?.label ?? 'before', 'this design', 'change'], [...rows, total]),
  );
}

/** "3.6e8 h" @param {Page.Reading} hours */
function lifeText(hours) {
  if (hours === null) return 'unknown';
  return hours > 1e6 ? 'more than 1 000 000 h' : `${plain(Number(hours.toPrecision(3)))} h`;
}

/** The load capacity in one sentence. @param {Api.Rating | null} rating */
export function capacityText(rating) {
  if (!rating) return '';
  if (rating.outcome !== 'rated') return `Not rated: ${shownSentence(rating.reason ?? 'no reason given')}`;
  const { passes, S_H: flank, S_Hmin: flankMin, S_F: root, S_Fmin: rootMin, life_h: life } = rating.verdict;
  return (
    `${passes ? 'Passes' : 'Does not pass'}: flank S_H ${sig(flank, 3)} (needs ${sig(flankMin, 3)}), ` +
    `root S_F ${sig(root, 3)} (needs ${sig(rootMin, 3)}), life ${lifeText(life)} ` +
    `(needs ${lifeText(rating.verdict.required_life_h)}).`
  );
}

/**
 * Warnings that differ only in their numbers stand together: the first, and the others below it.
 * @param {string[]} texts
 */
export function groupedWarnings(texts) {
  /** @type {Map<string, string[]>} */
  const groups = new Map();
  for (const text of texts.map(shownSentence)) {
    const key = text.replace(/[\d.,]+/g, '#').replace(/\b(left|right)\b/g, '#');
    groups.set(key, [...(groups.get(key) ?? []), text]);
  }
  return [...groups.values()].map(([first, ...others]) =>
    h(
      'li',
      null,
      first,
      others.length
        ? h(
            'details.more',
            null,
            h('summary', null, `and ${others.length} more of this kind`),
            h(
              'ul',
              null,
              others.map(text => h('li', null, text)),
            ),
          )
        : null,
    ),
  );
}

/** @param {string[]} texts @param {boolean} [all] none folded, as on paper */
export function warningList(texts, all = false) {
  if (!texts.length) return [];
  return [
    h('h2', null, 'What to know about this result'),
    h('ul', null, all ? texts.map(text => h('li', null, shownSentence(text))) : groupedWarnings(texts)),
  ];
}
