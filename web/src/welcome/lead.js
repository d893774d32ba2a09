// SPDX-License-Identifier: GPL-3.0-or-later
// The first sentence of the page and where to go from it; away for good when it is closed.
import { h } from '../base/dom.js';
import { openExamples, openOwnGear, startTour } from './open.js';

const KEY = 'easeoff-lead';

/** @param {import('../app.js').App} app */
export function leadLine(app) {
  const element = h('.lead-line', { hidden: localStorage.getItem(KEY) === 'away' });
  const close = () => {
    localStorage.setItem(KEY, 'away');
    element.hidden = true;
  };
  element.append(
    h(
      'p',
      null,
      h('b', null, 'Relieve the tooth tips until the pair runs quietly.'),
      ' The numbers compare this flank with the unmodified one. Drag a slider, or let the search do it.',
    ),
    h('button.primary', { type: 'button', onclick: () => openOwnGear(app) }, 'Your own gear…'),
    h('button', { type: 'button', onclick: () => openExamples(app) }, 'Examples'),
    h('button', { type: 'button', onclick: () => startTour(app) }, 'Tour'),
    h('button.icon', { type: 'button', 'aria-label': 'Hide this line for good', title: 'Hide', onclick: close }, '✕'),
  );
  return element;
}
