// SPDX-License-Identifier: GPL-3.0-or-later
import { h, newId } from './dom.js';

/**
 * One of a few choices as buttons.
 * @template {string} T
 * @param {string} label
 * @param {[T, string][]} choices value and text
 * @param {T} value
 * @param {(value: T) => void} take
 */
export function switcher(label, choices, value, take) {
  const name = newId('switch');
  const group = h('span.switch', { role: 'radiogroup', 'aria-label': label });
  for (const [choice, text] of choices) {
    const input = h('input', {
      type: 'radio',
      name,
      value: choice,
      checked: choice === value,
      onchange: () => take(choice),
    });
    group.append(h('label', null, input, h('span', null, text)));
  }
  return group;
}
