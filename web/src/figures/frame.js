// SPDX-License-Identifier: GPL-3.0-or-later
// What every figure has: a title, its switches, a menu (large, PNG, CSV, copy), and a body that keeps its size.
import { copyText, download, fileName, fill, h, newId } from '../base/dom.js';

/**
 * @typedef {object} Drawing
 * @property {() => HTMLCanvasElement | Promise<HTMLCanvasElement>} [picture]
 * @property {() => (string | number | null)[][]} [table] heading first
 * @property {() => void} [reset]
 */

/** @param {(string | number | null)[][]} rows @param {string} mark */
function joinRows(rows, mark) {
  return (
    rows
      .map(row =>
        row
          .map(cell => {
            if (cell === null || cell === undefined) return '';
            const text = String(cell);
            return typeof cell === 'string' && /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
          })
          .join(mark),
      )
      .join('\n') + '\n'
  );
}

export class Frame {
  /**
   * @param {{ title: string, unit?: string, help?: string, wide?: boolean, drawing: Drawing, controls?: HTMLElement[]
   * }} options
   */
  constructor({ title, unit, help, wide, drawing, controls = [] }) {
    this.title = title;
    this.drawing = drawing;
    const id = newId('figure');
    this.heading = h('h3', { id, title: help ?? null }, title, unit ? h('span.unit', null, ` ${unit}`) : null);
    this.body = h('.figure-body');
    this.legend = h('.legend');
    this.note = h('.figure-note', { hidden: true });
    this.menu = this.#menu();
    this.element = h(
      wide ? 'section.figure.wide' : 'section.figure',
      { 'aria-labelledby': id },
      h('.figure-head', null, this.heading, h('.figure-controls', null, ...controls), this.menu),
      this.body,
      this.legend,
      this.note,
    );
  }

  #menu() {
    const list = h('.menu-list', { role: 'menu', hidden: true });
    const button = h(
      'button.icon',
      { type: 'button', 'aria-label': `${this.title}: menu`, 'aria-haspopup': 'menu', 'aria-expanded': 'false' },
      '⋯',
    );
    const close = () => {
      list.hidden = true;
      button.setAttribute('aria-expanded', 'false');
      document.removeEventListener('pointerdown', outside);
    };
    /** @param {Event} event */
    const outside = event => {
      if (!holder.contains(/** @type {Node} */ (event.target))) close();
    };
    /** @param {string} label @param {() => void} act */
    const item = (label, act) =>
      h(
        'button',
        {
          type: 'button',
          role: 'menuitem',
          onclick: () => {
            close();
            act();
          },
        },
        label,
      );
    button.addEventListener('click', () => {
      if (!list.hidden) return close();
      fill(
        list,
        item('Open large', () => this.enlarge()),
        this.drawing.picture && item('Save as PNG', () => this.savePicture()),
        this.drawing.table && item('Save as CSV', () => this.saveTable()),
        this.drawing.table && item('Copy the numbers', () => this.copyTable()),
        this.drawing.reset && item('Reset the view', () => this.drawing.reset?.()),
      );
      list.hidden = false;
      button.setAttribute('aria-expanded', 'true');
      document.addEventListener('pointerdown', outside);
      /** @type {HTMLElement} */ (list.firstElementChild)?.focus();
    });
    const holder = h(
      '.menu',
      {
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key === 'Escape' && !list.hidden) {
            event.stopPropagation();
            close();
            button.focus();
          }
          if (event.key !== 'ArrowDown' && event.key !== 'ArrowUp') return;
          const items = /** @type {HTMLElement[]} */ ([...list.children]);
          const at = items.indexOf(/** @type {HTMLElement} */ (document.activeElement));
          items[(at + (event.key === 'ArrowDown' ? 1 : items.length - 1)) % items.length]?.focus();
          event.preventDefault();
        },
      },
      button,
      list,
    );
    return holder;
  }

  /** The figure fills a dialog until it is closed. */
  enlarge() {
    if (this.element.closest('dialog')) return;
    const place = h('.figure.placeholder', { css: { height: `${this.element.offsetHeight}px` } });
    if (this.element.classList.contains('wide')) place.classList.add('wide');
    const dialog = h('dialog', { 'aria-label': this.title, class: 'large' });
    this.element.replaceWith(place);
    dialog.append(
      h('button.icon.close', { type: 'button', 'aria-label': 'Close', onclick: () => dialog.close() }, '✕'),
      this.element,
    );
    document.body.append(dialog);
    dialog.addEventListener('close', () => {
      place.replaceWith(this.element);
      dialog.remove();
    });
    dialog.addEventListener('click', event => event.target === dialog && dialog.close());
    dialog.showModal();
  }

  async savePicture() {
    const canvas = await this.drawing.picture?.();
    canvas?.toBlob(blob => blob && download(`${fileName(this.title)}.png`, blob));
  }

  saveTable() {
    const rows = this.drawing.table?.();
    if (rows) download(`${fileName(this.title)}.csv`, new Blob([joinRows(rows, ',')], { type: 'text/csv' }));
  }

  async copyTable() {
    const rows = this.drawing.table?.();
    if (rows) await copyText(joinRows(rows, '\t'));
  }

  /** A sentence in place of the drawing; "" takes it away. @param {string} text */
  say(text) {
    this.note.textContent = text;
    this.note.hidden = text === '';
    this.body.classList.toggle('veiled', text !== '');
  }
}

/**
 * One of a few choices as buttons.
 * @param {string} label
 * @param {[string, string][]} choices value and text
 * @param {string} value
 * @param {(value: string) => void} take
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

/**
 * Puts a reading beside the pointer, inside its figure.
 * @param {HTMLElement} tip
 * @param {number} x of the pointer
 * @param {number} width of the figure
 */
export function placeTip(tip, x, width) {
  const own = tip.offsetWidth;
  const left = x + 12 + own <= width ? x + 12 : x - 12 - own;
  tip.style.left = `${Math.min(Math.max(left, -6), Math.max(-6, width - own + 6))}px`;
}

/**
 * Calls back once the element is in sight, and whenever it comes back.
 * @param {Element} element
 * @param {(visible: boolean) => void} tell
 */
export function whenSeen(element, tell) {
  const observer = new IntersectionObserver(entries => tell(entries[entries.length - 1].isIntersecting), {
    rootMargin: '80px',
  });
  observer.observe(element);
  return observer;
}
