// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of fields that open and close.
import { h } from '../base/dom.js';

/** Opens the groups round an element. @param {HTMLElement} element */
export function unfold(element) {
  for (let group = element.closest('details'); group; group = group.parentElement?.closest('details') ?? null)
    group.open = true;
}

/**
 * A group that opens and closes, and remembers it.
 * @param {string} key
 * @param {string} title
 * @param {boolean} open
 * @param {(HTMLElement | null)[]} children
 * @param {HTMLElement | null} [aside]
 */
export function group(key, title, open, children, aside = null) {
  const remembered = sessionStorage.getItem(`easeoff-group-${key}`);
  const element = h(
    'details.group',
    { open: remembered === null ? open : remembered === 'open' },
    h('summary', null, h('h2', null, title), aside),
    h('.group-body', null, children),
  );
  element.addEventListener('toggle', () =>
    sessionStorage.setItem(`easeoff-group-${key}`, element.open ? 'open' : 'closed'),
  );
  return element;
}

/** What is seldom needed, closed below what often is. @param {string} title @param {(HTMLElement | null)[]} children */
export function more(title, children) {
  return h('details.more', null, h('summary', null, title), h('.group-body', null, children));
}
