// SPDX-License-Identifier: GPL-3.0-or-later
// What every figure has: a title, what it means, its load case, its switches, a menu (large, pictures, numbers), and a
// body that keeps its size.
import { copyText, download, fileName, fill, h, newId } from '../base/dom.js';
import { notice } from '../base/notice.js';
import { openPopover } from '../base/popover.js';
import { shownBelow, shownHead, shownUnit, units } from '../base/units.js';
import { sheetAsCanvas, sheetAsSvg } from './sheet.js';
import { subject } from './subject.js';
import { csvOf, joinRows } from './table.js';

/**
 * @typedef {object} Drawing
 * @property {(pen: CanvasRenderingContext2D, width: number, height: number) => void} [paint] as it goes to paper
 * @property {() => import('./sheet.js').Key[]} [keys] of the legend
 * @property {() => import('./table.js').Rows} [table] heading first; lengths in mm and µm, as "(mm)" in its head says
 * @property {() => void} [reset]
 * @property {boolean} [empty] nothing to show yet
 */
/**
 * @typedef {object} FrameOptions
 * @property {string} title @property {string} [unit] @property {string} [name] in full, where the title is short
 * @property {string} [help] what is shown @property {string} [good] what is good
 * @property {boolean} [wide] @property {HTMLElement[]} [controls] @property {Drawing} drawing
 */

export class Frame {
  /** @type {string | undefined} */ #unit;
  /** @type {string} load case or cases, and what else is chosen */ about = '';
  /** What that is. */ aboutWhat = 'Load case';

  /** @param {FrameOptions} options */
  constructor({ title, unit, name, help, good, wide, drawing, controls = [] }) {
    this.title = title;
    this.#unit = unit;
    this.drawing = drawing;
    this.texts = [name ?? title, help, good].filter(text => text !== undefined);
    const id = newId('figure');
    this.unitMark = h('span.unit', { hidden: !unit });
    this.heading = h('h3', { id }, title, this.unitMark);
    this.#spellUnit();
    units.addEventListener('change', () => this.#spellUnit());
    this.chip = h('span.case-chip', { hidden: true });
    this.body = h('.figure-body');
    this.legend = h('.legend');
    this.note = h('.figure-note', { hidden: true });
    this.element = h(
      wide ? 'section.figure.wide' : 'section.figure',
      { 'aria-labelledby': id },
      h(
        '.figure-head',
        null,
        this.heading,
        this.#aboutButton(),
        this.chip,
        h('.figure-controls', null, ...controls),
        this.#menuButton(),
      ),
      this.body,
      this.legend,
      this.note,
    );
  }

  /** As it is shown. */
  get unit() {
    return shownUnit(this.#unit);
  }

  /** @param {string | undefined} unit as the numbers have it: "µm" */
  set unit(unit) {
    this.#unit = unit;
    this.#spellUnit();
  }

  #spellUnit() {
    this.unitMark.textContent = this.unit ? ` ${this.unit}` : '';
    this.unitMark.hidden = !this.unit;
  }

  /** The numbers as they are saved and copied. @returns {import('./table.js').Rows} */
  table() {
    const [head, ...rows] = this.drawing.table?.() ?? [];
    if (!head) return [];
    const shown = rows.map(row => row.map((cell, i) => shownBelow(cell, head[i])));
    return [head.map(cell => (typeof cell === 'string' ? shownHead(cell) : cell)), ...shown];
  }

  /** For which load case it is. @param {string} text of one case; "" for all of them */
  setCase(text) {
    this.about = text;
    this.chip.textContent = text;
    this.chip.hidden = text === '';
  }

  #aboutButton() {
    const [name, ...sentences] = this.texts;
    const button = h(
      'button.icon.about',
      { type: 'button', 'aria-label': `What is this: ${name}`, 'aria-expanded': 'false' },
      'i',
    );
    button.addEventListener('click', () =>
      openPopover(button, 'explanation', panel =>
        fill(
          panel,
          h('h4', null, this.unit ? `${name}, ${this.unit}` : name),
          sentences.map(text => h('p', null, text)),
          this.about ? h('p', null, `${this.aboutWhat}: ${this.about}.`) : null,
          h('p', null, h('a', { href: '#glossary' }, 'All words explained')),
        ),
      ),
    );
    return button;
  }

  #menuButton() {
    const button = h(
      'button.icon',
      { type: 'button', 'aria-label': `${this.title}: menu`, 'aria-haspopup': 'menu', 'aria-expanded': 'false' },
      '⋯',
    );
    button.addEventListener('click', () =>
      openPopover(button, 'menu', (panel, close) => {
        /** @param {string} label @param {() => unknown} act */
        const item = (label, act) =>
          h('button', { type: 'button', role: 'menuitem', onclick: () => (close(), act()) }, label);
        fill(
          panel,
          item('Open large', () => this.enlarge()),
          this.drawing.paint && item('Save as PNG', () => this.savePicture()),
          this.drawing.paint && item('Save as SVG', () => this.saveDrawing()),
          this.drawing.table && item('Save as CSV', () => this.saveTable()),
          this.drawing.table && item('Copy the numbers', () => this.copyTable()),
          this.drawing.reset && item('Reset the view', () => this.drawing.reset?.()),
        );
      }),
    );
    return h('.menu', null, button);
  }

  /** The figure fills a dialog until it is closed. */
  enlarge() {
    if (this.element.closest('dialog')) return;
    const place = h('.figure.placeholder', { css: { height: `${this.element.offsetHeight}px` } });
    for (const kind of ['wide', 'tall']) place.classList.toggle(kind, this.element.classList.contains(kind));
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

  /**
   * The figure as it goes to paper; null when there is nothing to show.
   * @returns {import('./sheet.js').Content | null}
   */
  content() {
    const { paint, keys, empty } = this.drawing;
    if (!paint || empty) return null;
    return {
      title: this.texts[0] ?? this.title,
      unit: this.unit,
      about: this.about,
      keys: keys?.() ?? [],
      paint,
    };
  }

  /** @param {string} kind of the file */
  #fileName(kind) {
    return `${fileName(subject.name)}-${fileName(this.title)}.${kind}`;
  }

  /** What to save, or a word why there is nothing. */
  #whole() {
    const content = this.content();
    if (!content) notice.say(`${this.title}: there is nothing to save yet.`);
    return content;
  }

  savePicture() {
    const content = this.#whole();
    if (content) sheetAsCanvas(content).toBlob(blob => blob && download(this.#fileName('png'), blob));
  }

  saveDrawing() {
    const content = this.#whole();
    if (!content) return;
    const text = new XMLSerializer().serializeToString(sheetAsSvg(content));
    download(this.#fileName('svg'), new Blob([text], { type: 'image/svg+xml' }));
  }

  saveTable() {
    const rows = this.table();
    const text = csvOf(this.texts[0] ?? this.title, this.about, rows);
    if (rows.length) download(this.#fileName('csv'), new Blob([text], { type: 'text/csv' }));
    else notice.say(`${this.title}: there are no numbers yet.`);
  }

  async copyTable() {
    const rows = this.table();
    if (rows.length) await copyText(joinRows(rows, '\t'));
    notice.say(rows.length ? `Copied: ${rows.length - 1} rows.` : `${this.title}: there are no numbers yet.`);
  }

  /** A sentence in place of the drawing; "" takes it away. @param {string} text */
  say(text) {
    this.note.textContent = text;
    this.note.hidden = text === '';
    this.body.classList.toggle('veiled', text !== '');
  }
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
