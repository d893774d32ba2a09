// SPDX-License-Identifier: GPL-3.0-or-later
// Light or dark: the reader's choice, else the system's. What goes to paper is always light.
import { h } from './dom.js';

const KEY = 'easeoff-theme';
const dark = matchMedia('(prefers-color-scheme: dark)');

/** @type {Map<string, string>} */
const colours = new Map();
/** @type {Map<string, string>} */
const printed = new Map();
/** Has the colours of the light theme, whatever the page has. */
const sheet = h('div', { 'data-theme': 'light', hidden: true });
let onSheet = false;

class Theme extends EventTarget {
  constructor() {
    super();
    dark.addEventListener('change', () => this.#apply());
    this.#apply();
  }

  get choice() {
    return localStorage.getItem(KEY) ?? 'system';
  }

  /** "system", "light", "dark" @param {string} choice */
  set choice(choice) {
    if (choice === 'system') localStorage.removeItem(KEY);
    else localStorage.setItem(KEY, choice);
    this.#apply();
  }

  get dark() {
    return document.documentElement.dataset.theme === 'dark';
  }

  /** Light for as long as a page is printed. @param {boolean} paper */
  print(paper) {
    this.paper = paper;
    this.#apply();
  }

  #apply() {
    const now = this.paper ? 'light' : this.choice === 'system' ? (dark.matches ? 'dark' : 'light') : this.choice;
    if (document.documentElement.dataset.theme === now) return;
    document.documentElement.dataset.theme = now;
    colours.clear();
    this.dispatchEvent(new Event('change'));
  }
}

export const theme = new Theme();

/** A colour of the style sheet for canvases: colour("case1"). @param {string} name */
export function colour(name) {
  const known = onSheet ? printed : colours;
  let value = known.get(name);
  if (value === undefined) {
    if (onSheet && !sheet.isConnected) document.body.append(sheet);
    value = getComputedStyle(onSheet ? sheet : document.documentElement)
      .getPropertyValue(`--${name}`)
      .trim();
    known.set(name, value);
  }
  return value;
}

/** Paints with the colours of paper. @template T @param {() => T} paint @returns {T} */
export function withPaperColours(paint) {
  onSheet = true;
  try {
    return paint();
  } finally {
    onSheet = false;
  }
}
