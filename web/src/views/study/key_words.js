// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a design in words, for those who choose one: "Tip relief, pinion, both ends" for
// modification.pinion.*.tip_relief_um.
import { labelOf } from '../../base/format.js';
import { isNumeric, ownUnitOf } from '../../base/schema.js';

/** @typedef {{ path: string, words: string, group: string, unit: string, help: string }} Key */

const LEFT_OUT = ['version', 'optimization', 'objective', 'tolerance'];

/** A part of a path in words; nothing where its group says it. @param {string} part @param {string} before */
function partWords(part, before) {
  if (before === 'load_cases') return part === '*' ? 'every load case' : `load case ${part}`;
  if (part === '*') return 'both ends';
  return part === 'left' || part === 'right' ? `${part} end` : labelOf(part).toLowerCase();
}

/** @param {string} group @param {string[]} parts of a path, without its group and its key */
function whereWords(group, parts) {
  return parts.map((part, i) => partWords(part, i ? parts[i - 1] : group)).join(', ');
}

/**
 * @param {import('../../base/schema.js').Field[]} fields of a document
 * @param {number} cases load cases of the design
 * @returns {Key[]}
 */
export function keysOf(fields, cases) {
  /** @type {Key[]} */
  const keys = [];
  /** @param {import('../../base/schema.js').Field[]} level @param {string[]} parts */
  const walk = (level, parts) => {
    for (const field of level) {
      if (field.entry || (parts.length === 0 && LEFT_OUT.includes(field.key))) continue;
      const own = [...parts, field.key];
      if (field.kind === 'object' && field.fields) {
        if (field.key === 'left') walk(field.fields, [...parts, '*']); // both ends alike
        walk(field.fields, own);
      } else if (field.kind === 'list' && field.fields && field.key === 'load_cases') {
        const each = Array.from({ length: cases }, (_, i) => String(i + 1));
        for (const which of cases > 1 ? ['*', ...each] : each) walk(field.fields, [...own, which]);
      } else if (isNumeric(field)) keys.push(keyAt(field, own));
    }
  };
  walk(fields, []);
  return named(keys);
}

/** @param {import('../../base/schema.js').Field} field @param {string[]} parts @returns {Key} */
function keyAt(field, parts) {
  const [group] = parts;
  const where = whereWords(group, parts.slice(1, -1));
  return {
    path: parts.join('.'),
    words: [labelOf(field.key), where].filter(Boolean).join(', '),
    group: parts.length > 1 ? labelOf(group) : 'Design',
    unit: ownUnitOf(field), // values are given as a document has them
    help: field.help ?? '',
  };
}

/** Words that two have say the group as well. @param {Key[]} keys */
function named(keys) {
  /** @type {Map<string, number>} */
  const count = new Map();
  for (const { words } of keys) count.set(words, (count.get(words) ?? 0) + 1);
  return keys.map(key =>
    (count.get(key.words) ?? 0) > 1 ? { ...key, words: `${key.words}, ${key.group.toLowerCase()}` } : key,
  );
}

/**
 * Those that have every word that is typed: in their name, group, unit or path.
 * @param {Key[]} keys @param {string} text
 */
export function matching(keys, text) {
  const words = text.toLowerCase().split(/[\s,]+/).filter(Boolean);
  return keys.filter(({ path, words: name, group, unit }) => {
    const all = `${name} ${group} ${unit} ${path}`.toLowerCase();
    return words.every(word => all.includes(word));
  });
}
