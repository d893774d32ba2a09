// SPDX-License-Identifier: GPL-3.0-or-later
// A tour of three steps: what to move, what to watch, what to leave to the search.
import { h } from '../base/dom.js';

/** @typedef {{ target: string, title: string, text: string }} Step */

/** @type {Step[]} */
const STEPS = [
  {
    target: '.flank',
    title: '1 of 3: move the flank',
    text:
      'Each slider takes micrometres off the teeth: tip relief, where it starts, crowning. Drag one; everything ' +
      'on the right follows.',
  },
  {
    target: '.headline',
    title: '2 of 3: watch the numbers',
    text:
      'Transmission error, impact and vibration compared with those of the unmodified pair: green and ▼ is quieter. ' +
      'Press a name to read what it is. Choose the load case on the left of them.',
  },
  {
    target: '.form-foot .primary',
    title: '3 of 3: let the search do it',
    text:
      'Optimize tries some hundred flanks and keeps the best over all load cases. It goes on when the page is ' +
      'closed.',
  },
];

/** @param {import('../app.js').App} app */
export function startTour(app) {
  app.go('design');
  let at = 0;
  const panel = h('.tour', { role: 'dialog', 'aria-label': 'Tour', tabindex: '-1' });
  /** @type {Element | null} */ let marked = null;
  const end = () => {
    marked?.classList.remove('tour-target');
    panel.remove();
    document.removeEventListener('keydown', key);
  };
  /** @param {KeyboardEvent} event */
  const key = event => {
    if (event.key === 'Escape') end();
  };
  const back = () => {
    at -= 1;
    draw();
  };
  const draw = () => {
    const { target, title, text } = STEPS[at];
    marked?.classList.remove('tour-target');
    marked = document.querySelector(target);
    marked?.classList.add('tour-target');
    marked?.scrollIntoView({ block: 'nearest' });
    const last = at === STEPS.length - 1;
    panel.replaceChildren(
      h('h3', null, title),
      h('p', null, text),
      h(
        '.dialog-foot',
        null,
        h(
          'button.primary',
          {
            type: 'button',
            onclick: () => {
              if (last) return end();
              at += 1;
              draw();
            },
          },
          last ? 'Done' : 'Next',
        ),
        at > 0 ? h('button', { type: 'button', onclick: back }, 'Back') : null,
        h('button', { type: 'button', onclick: end }, 'End the tour'),
      ),
    );
    /** @type {HTMLElement | null} */ (panel.querySelector('.primary'))?.focus();
  };
  document.body.append(panel);
  document.addEventListener('keydown', key);
  draw();
}
