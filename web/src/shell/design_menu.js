// SPDX-License-Identifier: GPL-3.0-or-later
// The design's menu: your own gear, stored designs with a search by name, examples, files, links, the report.
import { ask, get, list } from '../base/api.js';
import { choose } from '../base/dialog.js';
import { copyText, download, fileName, fill, h } from '../base/dom.js';
import { dateText, labelOf, plain } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { Conflict } from '../base/library.js';
import { notice } from '../base/notice.js';
import { leaves, same } from '../base/pointer.js';
import { openPopover } from '../base/popover.js';
import { inInches } from '../base/units.js';
import { openOwnGear } from '../welcome/open.js';

const KINDS = /** @type {Record<string, string>} */ ({
  'text/csv': 'CSV',
  'image/svg+xml': 'SVG',
  'application/json': 'JSON',
  'application/xml': 'XML',
  'application/zip': 'zip',
  'application/vnd.openxmlformats-officedocument.spreadsheetml.sheet': 'xlsx',
  'model/step': 'STEP',
  'model/stl': 'STL',
});
const MANY = 6; // stored designs that need a search
const MOST_DIFFERENCES = 12; // shown of a conflict

/** "k-chart drawing (SVG)" @param {string} name @param {string} type */
function exportName(name, type) {
  const kind = KINDS[type.split(';')[0]];
  return name.replaceAll('-', ' ') + (kind ? ` (${kind})` : '');
}

/** @param {unknown} value */
function valueText(value) {
  if (typeof value === 'number') return plain(value);
  return value === undefined || value === null ? '–' : typeof value === 'string' ? value : JSON.stringify(value);
}

export class DesignMenu {
  /** @type {Api.ListedDesign[] | null} */ #stored = null;
  /** What the service exports: name, title, type. @type {Api.Export[]} */ #exports = [];
  #wanted = '';

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.name = h('span.design-name');
    this.button = h(
      'button.design-button',
      {
        type: 'button',
        'aria-haspopup': 'dialog',
        'aria-expanded': 'false',
        title: 'Open, store, import, export',
        onclick: () => this.open(),
      },
      this.name,
      ' ▾',
    );
    this.upload = h('input.away', {
      type: 'file',
      accept: '.json,.xml,.rexs,.rexsj,.rexsz,.zip,.csv,.txt,.xlsx,.ods,application/json',
      tabindex: '-1',
      'aria-hidden': 'true',
      onchange: () => {
        const file = this.upload.files?.[0];
        if (file) this.importFile(file);
        this.upload.value = '';
      },
    });
    this.element = h('.menu', null, this.button, this.upload);
    this.reports = new Lane({
      result: (task, data) => download(task.note, new Blob([data], { type: 'text/html' })),
      refused: (_task, error) => notice.say(error.message),
      preparing: () => notice.say('The report waits for the teeth to be prepared.'),
    });
  }

  refresh() {
    const { store } = this.app;
    const name = `${store.design.name || 'unnamed'}${store.changed ? ' *' : ''}`;
    this.name.textContent = name;
    const where = store.from.id ? 'stored' : store.from.example ? `example ${store.from.example}` : 'not stored';
    const state =
      store.changed && (store.from.id || store.from.example)
        ? `changed since it was ${store.from.id ? 'stored' : 'opened'}`
        : '';
    this.button.title = [name.replace(/ \*$/, ''), where, state].filter(Boolean).join(', ');
  }

  /** @param {File} file */
  importFile(file) {
    return this.app.attempt(async () => (await import('./import_file.js')).importFile(this.app, file));
  }

  async open() {
    this.#wanted = '';
    const again = openPopover(this.button, 'panel', (panel, close) => this.#draw(panel, close));
    if (!again) return;
    try {
      this.#stored = await list('designs');
      if (!this.#exports.length) this.#exports = (await get('export')).items;
      again();
    } catch {
      // the examples are there all the same
    }
  }

  /** @param {HTMLElement} panel @param {() => void} close */
  #draw(panel, close) {
    const { app } = this;
    const { store, library } = app;
    /** @param {string} text @param {() => unknown} act @param {string} [note] */
    const item = (text, act, note) =>
      h(
        'button',
        {
          type: 'button',
          onclick: () => {
            close();
            app.attempt(act);
          },
        },
        h('span', null, text),
        note ? h('small', null, note) : null,
      );
    panel.classList.add('design-menu');
    fill(
      panel,
      h(
        '.menu-column',
        null,
        h('h2', null, 'This design'),
        store.from.id ? item('Store', () => this.save()) : null,
        item('Store as new', () => this.saveNew()),
        item('Import a file…', () => this.upload.click(), 'JSON, REXS (XML, JSON, zip), a table; or drop it'),
        item('Export JSON', () => this.#export()),
        this.#exports
          .filter(({ name }) => name !== 'design')
          .map(format =>
            item(`Export ${exportName(format.name, format.type)}`, () => this.#exportAs(format), format.title),
          ),
        item('Copy a link to it', () => this.#copyLink()),
        item('Print a report…', () => app.go('report')),
        item('Save the report to sign', () => this.#saveReport(), 'one HTML file: rating, tables, figures'),
      ),
      h(
        '.menu-column',
        null,
        h('h2', null, 'Open'),
        item('Your own gear…', () => openOwnGear(app), 'five numbers and a load'),
        app.examples.map(example =>
          item(example.name, () => app.opening(() => library.openExample(example.name)), example.title),
        ),
      ),
      this.#storedColumn(item),
    );
  }

  /** @param {(text: string, act: () => unknown, note?: string) => HTMLElement} item */
  #storedColumn(item) {
    const { app } = this;
    const all = this.#stored;
    if (!all?.length)
      return h('.menu-column', null, h('h2', null, 'Stored'), h('p.figure-note', null, all ? 'None yet.' : '…'));
    const rows = h('.menu-rows');
    const draw = () => {
      const words = this.#wanted.toLowerCase().split(/\s+/).filter(Boolean);
      const found = all.filter(design => words.every(word => String(design.name).toLowerCase().includes(word)));
      fill(
        rows,
        found.map(design => this.#row(design, item)),
        found.length ? null : h('p.figure-note', null, 'No stored design has such a name.'),
      );
    };
    const search = h('input', {
      type: 'text',
      'aria-label': 'Search the stored designs by name',
      placeholder: `search ${all.length} designs by name`,
      value: this.#wanted,
      oninput: () => {
        this.#wanted = search.value;
        draw();
      },
    });
    draw();
    return h(
      '.menu-column',
      null,
      h('h2', null, 'Stored'),
      all.length >= MANY || app.store.from.id ? search : null,
      rows,
    );
  }

  /** @param {Api.ListedDesign} design @param {(text: string, act: () => unknown, note?: string) => HTMLElement} item */
  #row(design, item) {
    const { app } = this;
    const name = design.name || 'unnamed';
    const here = String(design.id) === app.store.from.id;
    return h(
      '.menu-row',
      null,
      item(
        name,
        () => app.opening(() => app.library.openStored(String(design.id))),
        `${dateText(design.updated ?? design.created)}${here ? ', on the table' : ''}`,
      ),
      h(
        'button.icon',
        {
          type: 'button',
          'aria-label': `Delete ${name}`,
          title: 'Delete',
          onclick: () => app.attempt(() => this.#remove(design)),
        },
        '✕',
      ),
    );
  }

  async saveNew() {
    const { app } = this;
    app.form.flush();
    const name = await app.library.storeNew();
    app.note();
    notice.say(`Stored as “${name}”.`);
  }

  async save() {
    const { app } = this;
    app.form.flush();
    try {
      const name = await app.library.save();
      app.note();
      notice.say(`Stored: “${name}”.`);
    } catch (error) {
      if (!(error instanceof Conflict)) throw error;
      await this.#settle(error);
    }
  }

  /** Two have changed one design: whose stays? @param {Conflict} conflict */
  async #settle(conflict) {
    const { app } = this;
    const [mine, theirs] = [leaves(app.store.design), leaves(conflict.theirs)];
    const keys = [...new Set([...mine.keys(), ...theirs.keys()])].filter(key => !same(mine.get(key), theirs.get(key)));
    const rows = keys
      .slice(0, MOST_DIFFERENCES)
      .map(key =>
        h(
          'tr',
          null,
          h('th', { scope: 'row' }, key.split('.').map(labelOf).join(', ')),
          h('td.number', null, valueText(mine.get(key))),
          h('td.number', null, valueText(theirs.get(key))),
        ),
      );
    const table = h(
      'table.numbers',
      null,
      h(
        'thead',
        null,
        h(
          'tr',
          null,
          ['', 'yours', 'stored now'].map(text => h('th', { scope: 'col' }, text)),
        ),
      ),
      h('tbody', null, rows),
    );
    const more = keys.length - rows.length;
    const answer = await choose(
      'Somebody else has stored this design since you opened it.',
      [
        keys.length ? table : h('p', null, 'Both are the same.'),
        more > 0 ? h('p.figure-note', null, `and ${more} more`) : null,
      ],
      [
        { value: 'new', text: 'Store mine as a new design', primary: true },
        { value: 'theirs', text: 'Open theirs' },
        { value: 'over', text: 'Store mine over theirs' },
      ],
    );
    if (answer === 'new') await this.saveNew();
    if (answer === 'theirs') await app.opening(() => app.library.openStored(app.store.from.id));
    if (answer === 'over') {
      await app.library.save(conflict.etag);
      app.note();
      notice.say('Stored over theirs.');
    }
  }

  /** @param {Api.ListedDesign} design */
  async #remove(design) {
    const answer = await choose(
      `Delete the stored design “${design.name}”?`,
      ['What is on the table stays; recordings that belong to the design go with it.'],
      [
        { value: 'delete', text: 'Delete', primary: true },
        { value: '', text: 'Keep' },
      ],
    );
    if (answer !== 'delete') return;
    await this.app.library.remove(String(design.id));
    this.app.note();
    notice.say('Deleted.');
  }

  #export() {
    const { design } = this.app.store;
    download(
      `${fileName(design.name || 'design')}.json`,
      new Blob([`${JSON.stringify(design, null, 2)}\n`], { type: 'application/json' }),
    );
  }

  /** Byte for byte what the service answers, under the name that it gives. @param {Api.Export} format */
  async #exportAs({ name: format, inches }) {
    const units = inches && inInches() ? '?units=inch' : '';
    const answer = await ask('POST', `export/${format}${units}`, { body: this.app.store.design, whole: true });
    const name = /filename="([^"]+)"/.exec(answer.headers.get('content-disposition') ?? '');
    download(name ? name[1] : format, answer.data);
    const notes = answer.headers.get('easeoff-notes');
    if (notes) notice.say(`In this file: ${notes}.`);
  }

  /** The document of the service, which one signs and sends. */
  #saveReport() {
    const { design } = this.app.store;
    notice.say('The report is being written…');
    const path = inInches() ? 'report?units=inch' : 'report';
    this.reports.submit({ path, body: design, note: `${fileName(design.name || 'design')}-report.html` });
  }

  async #copyLink() {
    this.app.note();
    await copyText(location.href);
    notice.say('The link is copied; it holds the whole design.');
  }
}
