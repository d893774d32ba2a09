// SPDX-License-Identifier: GPL-3.0-or-later
// Round the views: title bar with the design's menu, what it is compared with, tabs, state; below, the job bar;
// between, a word when the service is away.
import { Refusal, ask, connection, get, list } from './base/api.js';
import { copyText, download, fileName, fill, h } from './base/dom.js';
import { dateText, sig } from './base/format.js';
import { complete } from './base/schema.js';
import { theme } from './base/theme.js';
import { JobBar } from './jobbar.js';

const THEMES = /** @type {Record<string, [string, string]>} */ ({
  system: ['◐', 'as the system'],
  light: ['○', 'light'],
  dark: ['●', 'dark'],
});
const EXPORTS = [
  ['flank-points', 'Flank points (CSV)'],
  ['modification-chart', 'Modification chart (CSV)'],
  ['topography', 'Topography (CSV)'],
];

export class Shell {
  /** @type {import('./base/store.js').Pin[]} */ #pins = [];

  /** @param {import('./app.js').App} app @param {Map<string, any>} bases */
  constructor(app, bases) {
    this.app = app;
    this.bases = bases;
    this.name = h('span.design-name');
    this.menu = this.#menu();
    this.undo = h(
      'button.icon',
      { type: 'button', title: 'Undo (Ctrl+Z)', 'aria-label': 'Undo', onclick: () => app.store.undo() },
      '↶',
    );
    this.redo = h(
      'button.icon',
      { type: 'button', title: 'Redo (Ctrl+Shift+Z)', 'aria-label': 'Redo', onclick: () => app.store.redo() },
      '↷',
    );
    this.pin = h('select', {
      'aria-label': 'Compare with',
      title: 'What the numbers and dashed curves compare with',
      onchange: () => this.#choosePin(),
    });
    this.tabs = h(
      'nav.tabs',
      { 'aria-label': 'Views' },
      app.entries
        .filter(entry => entry.title)
        .map(entry =>
          h('button', { type: 'button', 'data-view': entry.id, onclick: () => app.go(entry.id) }, entry.title),
        ),
    );
    this.state = h('span.state', { role: 'status', 'aria-live': 'off' });
    this.theme = h('button.icon', { type: 'button', onclick: () => this.#nextTheme() });
    this.away = h(
      'p.away-banner',
      { role: 'alert', hidden: true },
      'The service does not answer. Your design stays here; the page goes on by itself when it is back.',
    );
    this.notice = h('p.notice', { role: 'status', hidden: true });
    const bar = h(
      'header.bar',
      null,
      h('a.brand', { href: '#design', 'aria-label': 'Easeoff' }, brand(), h('span', null, 'Easeoff')),
      this.menu,
      this.undo,
      this.redo,
      h('label.pin', null, h('span', null, 'against'), this.pin),
      this.tabs,
      this.state,
      this.theme,
    );
    this.elements = [
      h(
        'a.skip',
        {
          href: '#stage',
          onclick: (/** @type {Event} */ event) => {
            event.preventDefault();
            app.stage.querySelector('input')?.focus();
          },
        },
        'To the parameters',
      ),
      bar,
      this.away,
      this.notice,
      app.stage,
      new JobBar(app).element,
    ];
    app.store.addEventListener('change', () => this.#refresh());
    app.addEventListener('view', () => this.#refresh());
    app.analyst.addEventListener('state', () => this.#drawState());
    connection.addEventListener('change', () => this.#drawState());
    document.addEventListener('keydown', event => this.#key(event));
    this.#drawTheme();
    this.#refresh();
  }

  #refresh() {
    const { store, current } = this.app;
    const stored = store.from.id ? '' : ' *';
    this.name.textContent = (store.design.name || 'unnamed') + (store.canUndo || !store.from.id ? stored : '');
    document.title = `${store.design.name || 'unnamed'} – Easeoff`;
    this.undo.disabled = !store.canUndo;
    this.redo.disabled = !store.canRedo;
    for (const tab of this.tabs.children)
      tab.setAttribute('aria-current', String(/** @type {HTMLElement} */ (tab).dataset.view === current));
    this.#drawPins();
  }

  #drawState() {
    const { analyst } = this.app;
    this.away.hidden = !connection.away;
    this.state.classList.toggle('busy', analyst.state === 'preparing');
    if (connection.away) this.state.textContent = 'away';
    else if (analyst.state === 'preparing') {
      const fraction = analyst.job?.progress?.fraction;
      this.state.textContent = `preparing the teeth${typeof fraction === 'number' ? ` ${Math.round(100 * fraction)} %` : '…'}`;
    } else if (analyst.state === 'refused') this.state.textContent = 'not possible';
    else if (analyst.ms) this.state.textContent = `${sig(analyst.ms, 2)} ms`;
  }

  // ---- what it is compared with ----

  #drawPins() {
    const { pin } = this.app.store;
    const options = [
      h('option', { value: '' }, 'unmodified'),
      ...this.#pins.map((each, i) => h('option', { value: String(i) }, each.label)),
      h('option', { value: 'pin' }, 'pin this design'),
    ];
    const shape = options.map(option => option.textContent).join('|');
    if (this.pin.dataset.shape !== shape) {
      fill(this.pin, options);
      this.pin.dataset.shape = shape;
    }
    this.pin.value = pin ? String(this.#pins.indexOf(pin)) : '';
  }

  #choosePin() {
    const { store } = this.app;
    if (this.pin.value === 'pin') {
      const count = this.#pins.length + 1;
      const pin = { label: `pinned ${count}`, design: store.design };
      this.#pins.push(pin);
      store.setPin(pin);
    } else store.setPin(this.pin.value === '' ? null : this.#pins[Number(this.pin.value)]);
  }

  // ---- the design's menu ----

  #menu() {
    const panel = h('.menu-list.design-menu', { hidden: true });
    const button = h(
      'button.design-button',
      { type: 'button', 'aria-haspopup': 'true', 'aria-expanded': 'false', title: 'Open, store, import, export' },
      this.name,
      ' ▾',
    );
    /** @param {Event} event */
    const outside = event => {
      if (!holder.contains(/** @type {Node} */ (event.target))) this.#closeMenu();
    };
    this.#closeMenu = () => {
      panel.hidden = true;
      button.setAttribute('aria-expanded', 'false');
      document.removeEventListener('pointerdown', outside);
    };
    button.addEventListener('click', async () => {
      if (!panel.hidden) return this.#closeMenu();
      this.#drawMenu(panel, []);
      panel.hidden = false;
      button.setAttribute('aria-expanded', 'true');
      document.addEventListener('pointerdown', outside);
      panel.querySelector('button')?.focus();
      try {
        this.#drawMenu(panel, await list('designs'));
      } catch {
        // the examples are there all the same
      }
    });
    const holder = h(
      '.menu',
      {
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key === 'Escape' && !panel.hidden) {
            this.#closeMenu();
            button.focus();
          }
        },
      },
      button,
      panel,
    );
    return holder;
  }

  #closeMenu = () => {};

  /** @param {HTMLElement} panel @param {any[]} designs */
  #drawMenu(panel, designs) {
    const { store } = this.app;
    /** @param {string} text @param {() => unknown} act @param {string} [note] */
    const item = (text, act, note) =>
      h(
        'button',
        {
          type: 'button',
          onclick: () => {
            this.#closeMenu();
            this.#try(act);
          },
        },
        h('span', null, text),
        note ? h('small', null, note) : null,
      );
    const upload = h('input.away', {
      type: 'file',
      accept: '.json,application/json',
      tabindex: '-1',
      'aria-hidden': 'true',
      onchange: () => this.#try(() => this.#import(upload)),
    });
    fill(
      panel,
      h(
        '.menu-column',
        null,
        h('h2', null, 'This design'),
        store.from.id ? item('Store', () => this.#save(false)) : null,
        item('Store as new', () => this.#save(true)),
        item('Import JSON…', () => upload.click()),
        upload,
        item('Export JSON', () => this.#export()),
        EXPORTS.map(([format, text]) =>
          item(`Export ${text.charAt(0).toLowerCase()}${text.slice(1)}`, () => this.#exportAs(format)),
        ),
        item('Copy a link to it', () => this.#copyLink()),
        item('Print a report…', () => window.print()),
      ),
      h(
        '.menu-column',
        null,
        h('h2', null, 'Examples'),
        this.app.examples.map(example => item(example.name, () => this.#openExample(example.name), example.title)),
      ),
      designs.length
        ? h(
            '.menu-column',
            null,
            h('h2', null, 'Stored'),
            designs.map(design =>
              h(
                '.menu-row',
                null,
                item(
                  design.name || 'unnamed',
                  () => this.#openStored(design.id),
                  dateText(design.updated ?? design.created),
                ),
                h(
                  'button.icon',
                  {
                    type: 'button',
                    'aria-label': `Delete ${design.name}`,
                    title: 'Delete',
                    onclick: () => {
                      this.#closeMenu();
                      this.#try(() => this.#delete(design));
                    },
                  },
                  '✕',
                ),
              ),
            ),
          )
        : null,
    );
  }

  /** Tells what went wrong instead of nothing. @param {() => unknown} act */
  async #try(act) {
    try {
      await act();
    } catch (error) {
      this.say(
        error instanceof Refusal && error.faults.length
          ? error.faults.map(fault => `${fault.pointer} ${fault.detail}`).join(' ')
          : /** @type {Error} */ (error).message,
      );
    }
  }

  #timer = 0;

  /** A word that goes by itself. @param {string} text */
  say(text) {
    this.notice.textContent = text;
    this.notice.hidden = false;
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => {
      this.notice.hidden = true;
    }, 6000);
  }

  /** @param {string} name */
  async #openExample(name) {
    const key = `example:${name}`;
    if (!this.bases.has(key))
      this.bases.set(key, complete(this.app.fields, await get(`examples/${encodeURIComponent(name)}`)));
    this.app.store.open(this.bases.get(key), { example: name });
    this.app.go(this.app.current || 'design');
  }

  /** @param {string} id */
  async #openStored(id) {
    const answer = await ask('GET', `designs/${encodeURIComponent(id)}`);
    const design = complete(this.app.fields, answer.data.design);
    this.bases.set(`id:${id}`, design);
    this.app.store.open(design, { id, etag: answer.headers.get('etag') ?? '' });
    this.app.go('design');
  }

  /** @param {boolean} fresh */
  async #save(fresh) {
    const { store } = this.app;
    const body = { name: store.design.name || 'unnamed', design: store.design };
    if (fresh || !store.from.id) {
      const answer = await ask('POST', 'designs', { body });
      this.#stored(answer.data.id, answer.headers.get('etag'));
      this.say(`Stored as “${body.name}”.`);
      return;
    }
    const { id } = store.from;
    const etag = store.from.etag || (await ask('GET', `designs/${encodeURIComponent(id)}`)).headers.get('etag') || '*';
    const answer = await ask('PUT', `designs/${encodeURIComponent(id)}`, { body, headers: { 'If-Match': etag } });
    this.#stored(id, answer.headers.get('etag'));
    this.say('Stored.');
  }

  /** @param {string} id @param {string | null} etag */
  #stored(id, etag) {
    const { store } = this.app;
    this.bases.set(`id:${id}`, store.design);
    store.from = { example: '', id: String(id), etag: etag ?? '' };
    this.app.note();
    this.#refresh();
  }

  /** @param {any} design */
  async #delete(design) {
    if (!window.confirm(`Delete the stored design “${design.name}”?`)) return;
    const etag = (await ask('GET', `designs/${encodeURIComponent(design.id)}`)).headers.get('etag') ?? '*';
    await ask('DELETE', `designs/${encodeURIComponent(design.id)}`, { headers: { 'If-Match': etag } });
    if (this.app.store.from.id === String(design.id)) this.app.store.from = { example: 'paper', id: '', etag: '' };
    this.app.note();
    this.say('Deleted.');
  }

  /** @param {HTMLInputElement} upload */
  async #import(upload) {
    const file = upload.files?.[0];
    if (!file) return;
    /** @type {any} */
    let document;
    try {
      document = JSON.parse(await file.text());
    } catch {
      throw new Error(`${file.name} is not JSON.`);
    }
    const design = document?.design?.gear_pair ? document.design : document;
    await ask('POST', 'check', { body: design });
    this.app.store.open(
      complete(this.app.fields, { load_cases: this.bases.get('example:paper')?.load_cases, ...design }),
      { example: 'paper' },
    );
    this.app.go('design');
  }

  #export() {
    const { design } = this.app.store;
    download(
      `${fileName(design.name || 'design')}.json`,
      new Blob([`${JSON.stringify(design, null, 2)}\n`], { type: 'application/json' }),
    );
  }

  /** @param {string} format */
  async #exportAs(format) {
    const { design } = this.app.store;
    const answer = await ask('POST', `export/${format}`, { body: design });
    const text = typeof answer.data === 'string' ? answer.data : JSON.stringify(answer.data, null, 2);
    download(`${fileName(design.name || 'design')}-${format}.csv`, new Blob([text], { type: 'text/csv' }));
  }

  async #copyLink() {
    this.app.note();
    await copyText(location.href);
    this.say('The link is copied; it holds the whole design.');
  }

  // ---- theme, keys ----

  #nextTheme() {
    const choices = Object.keys(THEMES);
    theme.choice = choices[(choices.indexOf(theme.choice) + 1) % choices.length];
    this.#drawTheme();
  }

  #drawTheme() {
    const [mark, text] = THEMES[theme.choice] ?? THEMES.system;
    this.theme.textContent = mark;
    this.theme.title = `Colours: ${text}`;
    this.theme.setAttribute('aria-label', `Colours: ${text}`);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    if (key === 's') {
      event.preventDefault();
      this.#try(() => this.#save(false));
      return;
    }
    if (
      (key !== 'z' && key !== 'y') ||
      (event.target instanceof HTMLInputElement &&
        event.target.type === 'text' &&
        event.target.value !== event.target.defaultValue &&
        this.app.store.faults.size)
    )
      return;
    event.preventDefault();
    if (key === 'y' || event.shiftKey) this.app.store.redo();
    else this.app.store.undo();
  }
}

function brand() {
  return h('img', { src: 'icon.svg', alt: '', width: 20, height: 20 });
}
