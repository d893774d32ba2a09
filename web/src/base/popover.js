// SPDX-License-Identifier: GPL-3.0-or-later
// A panel below a button: filled when it opens, closed by Escape, by a press outside or by what is chosen; the focus
// stays in it while it is filled again, and goes back to the button.
import { h } from './dom.js';

/** @type {(() => void) | null} */ let closeOpen = null;

/** The items one can reach by arrow keys. @param {HTMLElement} panel */
const items = panel =>
  [...panel.querySelectorAll('button, a[href], input, [tabindex="0"]')].map(each => /** @type {HTMLElement} */ (each));

/**
 * Opens a panel, or closes it when it is open.
 * @param {HTMLElement} button
 * @param {'menu' | 'explanation' | 'panel'} kind menu: arrow keys move between its items
 * @param {(panel: HTMLElement, close: () => void) => void} draw
 * @returns {(() => void) | null} draws it anew while it is open; null when it was closed
 */
export function openPopover(button, kind, draw) {
  if (button.getAttribute('aria-expanded') === 'true') {
    closeOpen?.();
    return null;
  }
  closeOpen?.();
  const panel = h(
    `div.menu-list.popover-${kind}`,
    kind === 'menu'
      ? { role: 'menu' }
      : { role: 'dialog', 'aria-label': button.getAttribute('aria-label') ?? button.title },
  );
  const close = () => {
    if (closeOpen !== close) return;
    closeOpen = null;
    const inside = panel.contains(document.activeElement);
    panel.remove();
    button.setAttribute('aria-expanded', 'false');
    document.removeEventListener('pointerdown', outside);
    document.removeEventListener('keydown', key, true);
    window.removeEventListener('hashchange', close);
    if (inside) button.focus();
  };
  /** @param {Event} event */
  const outside = event => {
    const target = /** @type {Node} */ (event.target);
    if (!panel.contains(target) && !button.contains(target)) close();
  };
  /** @param {KeyboardEvent} event */
  const key = event => {
    if (event.key === 'Escape') {
      event.stopPropagation();
      event.preventDefault();
      close();
      button.focus();
    } else if (panel.contains(document.activeElement) && kind !== 'explanation') move(event, panel);
  };
  closeOpen = close;
  draw(panel, close);
  button.setAttribute('aria-expanded', 'true');
  button.after(panel);
  if (kind === 'explanation') panel.tabIndex = -1;
  (kind === 'explanation' ? panel : items(panel)[0])?.focus();
  keepInSight(panel);
  document.addEventListener('pointerdown', outside);
  document.addEventListener('keydown', key, true);
  window.addEventListener('hashchange', close);
  return () => {
    if (closeOpen !== close) return;
    const at = items(panel).indexOf(/** @type {HTMLElement} */ (document.activeElement));
    const typed = document.activeElement instanceof HTMLInputElement && panel.contains(document.activeElement);
    if (typed) return draw(panel, close);
    draw(panel, close);
    if (at >= 0) items(panel)[at]?.focus();
  };
}

/** @param {KeyboardEvent} event @param {HTMLElement} panel */
function move(event, panel) {
  if (event.key !== 'ArrowDown' && event.key !== 'ArrowUp') return;
  const all = items(panel);
  const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
  all[(at + (event.key === 'ArrowDown' ? 1 : all.length - 1)) % all.length]?.focus();
  event.preventDefault();
}

/** Moves a panel that would stick out of the window. @param {HTMLElement} panel */
function keepInSight(panel) {
  const box = panel.getBoundingClientRect();
  const beyond = box.right - document.documentElement.clientWidth + 8;
  if (beyond > 0) panel.style.transform = `translateX(${-beyond}px)`;
  else if (box.left < 8) panel.style.transform = `translateX(${8 - box.left}px)`;
}
