// SPDX-License-Identifier: GPL-3.0-or-later
// A question in a dialog: a title, what it is about, and buttons that answer it.
import { h } from './dom.js';

/** @typedef {{ value: string, text: string, primary?: boolean }} Answer */

/**
 * @param {string} title
 * @param {import('./dom.js').Child[]} content
 * @param {Answer[]} answers
 * @returns {Promise<string>} value of the answer; "" when the dialog was left by Escape
 */
export function choose(title, content, answers) {
  return new Promise(resolve => {
    const dialog = h('dialog', { class: 'question', 'aria-label': title });
    let chosen = '';
    dialog.append(
      h('h2', null, title),
      h('.dialog-body', null, content),
      h(
        '.dialog-foot',
        null,
        answers.map(({ value, text, primary }) =>
          h(
            primary ? 'button.primary' : 'button',
            {
              type: 'button',
              onclick: () => {
                chosen = value;
                dialog.close();
              },
            },
            text,
          ),
        ),
      ),
    );
    dialog.addEventListener('close', () => {
      dialog.remove();
      resolve(chosen);
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
