// SPDX-License-Identifier: GPL-3.0-or-later
// A field that takes a number of a design by its words: what is typed is searched for; a path is taken as it is.
import { fill, h, newId } from '../../base/dom.js';
import { matching } from './key_words.js';

/** @typedef {import('./key_words.js').Key} Key */

export class KeyField {
  #marked = -1;
  /** @type {Key[]} */ #shown = [];

  /**
   * @param {string} name of the field
   * @param {string} path that stands in it at first
   * @param {() => Key[]} keys that can be chosen
   * @param {() => void} changed
   */
  constructor(name, path, keys, changed) {
    this.keys = keys;
    this.changed = changed;
    const id = newId('keys');
    this.list = h('ul.key-list', { id, role: 'listbox', 'aria-label': 'Numbers of the design', hidden: true });
    this.path = h('code.key-path');
    this.unit = h('span.unit');
    this.input = h('input.text.study-key', {
      type: 'text',
      role: 'combobox',
      autocomplete: 'off',
      spellcheck: false,
      'aria-label': name,
      'aria-expanded': 'false',
      'aria-controls': id,
      'aria-autocomplete': 'list',
      placeholder: 'search: relief, face width, N m …',
      value: this.#wordsOf(path),
      oninput: () => {
        this.#open(this.input.value);
        this.#tell();
      },
      onfocus: () => this.input.select(),
      onclick: () => this.#open(''),
      onblur: () => this.#close(),
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.#press(event),
    });
    this.element = h('.key-field', null, this.input, this.list, h('.key-note', null, this.path, this.unit));
    this.#note();
  }

  /** What is chosen, as the service takes it. */
  get value() {
    const text = this.input.value.trim();
    return this.#found(text)?.path ?? text;
  }

  /** @param {string} text words or a path */
  #found(text) {
    return this.keys().find(({ words, path }) => words === text || path === text);
  }

  /** @param {string} path */
  #wordsOf(path) {
    return this.#found(path)?.words ?? path;
  }

  /** The design may have other numbers now. */
  refresh() {
    if (document.activeElement !== this.input) this.input.value = this.#wordsOf(this.value);
    this.#note();
  }

  #note() {
    const found = this.#found(this.value);
    this.path.textContent = this.value;
    this.unit.textContent = found?.unit ? ` in ${found.unit}` : '';
    this.input.title = found?.help ?? '';
  }

  #tell() {
    this.#note();
    this.changed();
  }

  /** @param {string} text what is searched for */
  #open(text) {
    this.#shown = matching(this.keys(), text);
    this.#mark(-1);
    let group = '';
    fill(
      this.list,
      this.#shown.flatMap((key, i) => {
        const heading = key.group === group ? [] : [h('li.key-group', { role: 'presentation' }, key.group)];
        group = key.group;
        return [...heading, this.#option(key, i)];
      }),
      this.#shown.length ? null : h('li.key-group', { role: 'presentation' }, 'No number of a design is called so.'),
    );
    this.list.hidden = false;
    this.input.setAttribute('aria-expanded', 'true');
  }

  /** @param {Key} key @param {number} i */
  #option(key, i) {
    return h(
      'li.key-option',
      {
        role: 'option',
        id: `${this.list.id}-${i}`,
        title: key.help,
        // before the field loses the focus
        onpointerdown: (/** @type {Event} */ event) => {
          event.preventDefault();
          this.#choose(key);
        },
      },
      h('span', null, key.words, key.unit ? h('span.unit', null, ` ${key.unit}`) : null),
      h('code.key-path', null, key.path),
    );
  }

  #close() {
    this.list.hidden = true;
    this.input.setAttribute('aria-expanded', 'false');
    this.input.removeAttribute('aria-activedescendant');
    this.refresh();
  }

  /** @param {Key} key */
  #choose(key) {
    this.input.value = key.words;
    this.#close();
    this.#tell();
  }

  /** @param {number} i -1: none */
  #mark(i) {
    this.#marked = i;
    for (const option of this.list.querySelectorAll('[role=option]')) {
      const chosen = option.id === `${this.list.id}-${i}`;
      option.setAttribute('aria-selected', String(chosen));
      if (chosen) option.scrollIntoView({ block: 'nearest' });
    }
    if (i >= 0) this.input.setAttribute('aria-activedescendant', `${this.list.id}-${i}`);
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const open = !this.list.hidden;
    if (event.key === 'Escape' && open) this.#close();
    else if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      if (!open) this.#open('');
      const step = event.key === 'ArrowDown' ? 1 : -1;
      const count = this.#shown.length;
      if (count) this.#mark((this.#marked + step + count) % count);
    } else if (event.key === 'Enter' && open && this.#marked >= 0) {
      event.preventDefault();
      this.#choose(this.#shown[this.#marked]);
    }
  }
}
