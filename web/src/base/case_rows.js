// SPDX-License-Identifier: GPL-3.0-or-later
// Load cases as a spreadsheet has them, copied as text.
import { readQuantity } from './quantity.js';

/** @typedef {Partial<Record<'torque_Nm' | 'speed_rpm' | 'share', number>> & { name?: string }} CaseRow */

const NUMBERS = /** @type {const} */ (['torque_Nm', 'speed_rpm', 'share']);

/**
 * Rows of a spreadsheet: torque, speed and share in this order or as their headings say; what is no number is a name.
 * @param {string} text
 * @returns {{ rows: CaseRow[], fault: string }}
 */
export function readRows(text) {
  const lines = text.split(/\r?\n/).filter(line => line.trim() !== '');
  const cells = lines.map(line => line.split(/\t|;|\s{2,}/).map(cell => cell.trim()));
  /** @type {readonly (keyof CaseRow)[]} */
  let order = NUMBERS;
  const isHead = cells[0]?.every(cell => readQuantity(cell).value === undefined);
  if (isHead) {
    const keys = cells
      .shift()
      ?.map(cell => NUMBERS.find(key => cell.toLowerCase().includes(key.split('_')[0])) ?? 'name');
    if (keys?.includes('torque_Nm')) order = keys;
  }
  const rows = [];
  for (const [i, line] of cells.entries()) {
    const row = isHead ? rowByHead(line, order) : rowByOrder(line);
    if (row.torque_Nm === undefined) return { rows: [], fault: `Row ${i + 1} has no torque: “${line.join(' ')}”.` };
    rows.push(row);
  }
  return { rows, fault: '' };
}

/** @param {string[]} line @param {readonly (keyof CaseRow)[]} order */
function rowByHead(line, order) {
  /** @type {CaseRow} */
  const row = {};
  line.forEach((cell, i) => {
    const key = order[i];
    if (!key || cell === '') return;
    if (key === 'name') row.name = cell;
    else row[key] = readQuantity(cell, key.split('_')[1] ?? '%').value;
  });
  return row;
}

/** @param {string[]} line */
function rowByOrder(line) {
  /** @type {CaseRow} */
  const row = {};
  const numbers = line.filter(cell => /\d/.test(cell) && readQuantity(cell, 'any').fault !== 'Not a number.');
  NUMBERS.forEach((key, i) => {
    if (numbers[i] !== undefined) row[key] = readQuantity(numbers[i], key.split('_')[1] ?? '%').value;
  });
  const name = line.find(cell => cell !== '' && !numbers.includes(cell));
  if (name) row.name = name;
  return row;
}
