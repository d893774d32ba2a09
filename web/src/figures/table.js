// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a figure as text: for a spreadsheet with a head that says whose they are, or for the clipboard.
import { subject } from './subject.js';

const DIGITS = 6;

/** @typedef {(string | number | null | undefined)[][]} Rows heading first */

/** @param {string | number | null | undefined} cell */
function cellText(cell) {
  if (cell === null || cell === undefined) return '';
  if (typeof cell === 'number') return Number.isFinite(cell) ? String(Number(cell.toPrecision(DIGITS))) : '';
  return /[",\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell;
}

/** @param {Rows} rows @param {string} mark */
export function joinRows(rows, mark) {
  return `${rows.map(row => row.map(cellText).join(mark)).join('\n')}\n`;
}

/** @param {string} title of the figure @param {string} about load case and what is shown @param {Rows} rows */
export function csvOf(title, about, rows) {
  const head = [subject.line, about ? `${title}: ${about}` : title].map(line => `# ${line.replaceAll('\n', ' ')}\n`);
  return head.join('') + joinRows(rows, ',');
}
