// SPDX-License-Identifier: GPL-3.0-or-later
// Round the views: title bar with the design's menu, what it is compared with, tabs, state; below, the job bar;
// between, a word when the service is away.
import { connection } from '../base/api.js';
import { h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { notice } from '../base/notice.js';
import { openPopover } from '../base/popover.js';
import { theme } from '../base/theme.js';
import { JobBar } from '../jobbar.js';
import { DesignMenu } from './design_menu.js';
import { Pins } from './pins.js';
import { openExamples, openOwnGear, startTour } from '../welcome/open.js';

const THEMES = /** @type {Record<string, [string, string]>} */ ({
  system: ['◐', 'as the system'],
  light: ['○', 'light'],
  dark: ['●', 'dark'],
});
const SHOWN = 6000; // ms of a notice

/** @param {DragEvent} event */
const hasFiles = event => Boolean(event.dataTransfer?.types.includes('Files'));

const HEAD_ROOM = 60; // px of the tabs before the current one, where they do not all fit

export class Shell {
  #timer = 0;

  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    this.menu = new DesignMenu(app);
    this.pins = new Pins(app);
    this.undo = this.#icon('↶', 'Undo', 'Ctrl+Z', () => this.#takeBack(null));
    this.redo = this.#icon('↷', 'Redo', 'Ctrl+Shift+Z', () => app.store.redo());
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
    this.theme = h('button.icon.theme', { type: 'button', onclick: () => this.#nextTheme() });
    this.away = h(
      'p.away-banner',
      { role: 'alert', hidden: true },
      'The service does not answer. Your design stays here; the page goes on by itself when it is back.',
    );
    this.notice = h('p.notice', { role: 'status', hidden: true });
    this.elements = [this.#skip(), this.#bar(), this.away, this.notice, app.stage, new JobBar(app).element];
    app.store.addEventListener('change', () => this.#refresh());
    app.addEventListener('view', () => this.#refresh());
    app.analyst.addEventListener('state', () => this.#drawState());
    connection.addEventListener('change', () => this.#drawState());
    notice.addEventListener('change', () => this.#say(notice.text));
    document.addEventListener('keydown', event => this.#key(event));
    document.addEventListener('dragover', event => hasFiles(event) && event.preventDefault());
    document.addEventListener('drop', event => this.#dropped(event));
    this.#drawTheme();
    this.#refresh();
  }

  /** A file that nothing on the page took: a design, of this program or of another. @param {DragEvent} event */
  #dropped(event) {
    if (event.defaultPrevented || !hasFiles(event)) return;
    event.preventDefault(); // the browser would leave the page for it
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    if (event.dataTransfer?.files.length === 1) this.menu.importFile(file);
    else notice.say('One file at a time, please.');
  }

  /** @param {string} mark @param {string} name @param {string} keys @param {() => void} act */
  #icon(mark, name, keys, act) {
    return h('button.icon', { type: 'button', title: `${name} (${keys})`, 'aria-label': name, onclick: act }, mark);
  }

  #skip() {
    return h(
      'a.skip',
      {
        href: '#stage',
        onclick: (/** @type {Event} */ event) => {
          event.preventDefault();
          this.app.stage.querySelector('input')?.focus();
        },
      },
      'To the parameters',
    );
  }

  #bar() {
    const { app } = this;
    return h(
      'header.bar',
      null,
      h(
        'h1.brand',
        null,
        h(
          'a',
          { href: '#design', 'aria-label': 'Easeoff' },
          h('img', { src: 'icon.svg', alt: '', width: 20, height: 20 }),
          h('span', null, 'Easeoff'),
        ),
      ),
      h('button.own-gear', { type: 'button', onclick: () => openOwnGear(app) }, 'Your own gear…'),
      this.menu.element,
      this.undo,
      this.redo,
      this.pins.element,
      this.tabs,
      this.state,
      this.#help(),
      this.theme,
    );
  }

  #help() {
    const { app } = this;
    const button = h(
      'button.icon',
      { type: 'button', 'aria-label': 'Help', title: 'Tour, examples, words, manuals', 'aria-expanded': 'false' },
      '?',
    );
    button.addEventListener('click', () =>
      openPopover(button, 'menu', (panel, close) => {
        /** @param {string} text @param {() => unknown} act */
        const item = (text, act) =>
          h('button', { type: 'button', role: 'menuitem', onclick: () => (close(), act()) }, text);
        panel.replaceChildren(
          item('A tour in three steps', () => startTour(app)),
          item('Examples', () => openExamples(app)),
          item('All words explained', () => app.go('glossary')),
          item(`Colours: ${this.#themeText()}`, () => this.#nextTheme()),
          h('a', { href: 'doc/', target: '_blank', rel: 'noopener', role: 'menuitem' }, 'Manuals: guide, API, theory'),
        );
      }),
    );
    return h('.menu', null, button);
  }

  #refresh() {
    const { store, current } = this.app;
    this.menu.refresh();
    this.pins.refresh();
    document.title = `${store.design.name || 'unnamed'} – Easeoff`;
    this.undo.disabled = !store.canUndo && !store.faults.size;
    this.redo.disabled = !store.canRedo;
    for (const tab of /** @type {HTMLCollectionOf<HTMLElement>} */ (this.tabs.children)) {
      const here = tab.dataset.view === current;
      if (here && tab.getAttribute('aria-current') !== 'true') this.tabs.scrollLeft = tab.offsetLeft - HEAD_ROOM;
      tab.setAttribute('aria-current', String(here));
    }
  }

  #drawState() {
    const { analyst } = this.app;
    this.away.hidden = !connection.away;
    this.state.classList.toggle('busy', analyst.state === 'preparing');
    if (connection.away) this.state.textContent = 'away';
    else if (analyst.state === 'preparing') {
      const fraction = analyst.job?.progress?.fraction;
      const part = typeof fraction === 'number' ? ` ${Math.round(100 * fraction)} %` : '…';
      this.state.textContent = `preparing the teeth${part}`;
    } else if (analyst.state === 'refused') this.state.textContent = 'not possible';
    else if (analyst.ms) this.state.textContent = `${sig(analyst.ms, 2)} ms`;
  }

  /** @param {string} text */
  #say(text) {
    this.notice.textContent = text;
    this.notice.hidden = false;
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => {
      this.notice.hidden = true;
    }, SHOWN);
  }

  #nextTheme() {
    const choices = Object.keys(THEMES);
    theme.choice = choices[(choices.indexOf(theme.choice) + 1) % choices.length];
    this.#drawTheme();
  }

  #themeText() {
    return (THEMES[theme.choice] ?? THEMES.system)[1];
  }

  #drawTheme() {
    const [mark] = THEMES[theme.choice] ?? THEMES.system;
    const text = this.#themeText();
    this.theme.textContent = mark;
    this.theme.title = `Colours: ${text}`;
    this.theme.setAttribute('aria-label', `Colours: ${text}`);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const { store } = this.app;
    if (key === 's') {
      event.preventDefault();
      this.app.attempt(() => this.menu.save());
      return;
    }
    if (key !== 'z' && key !== 'y') return;
    event.preventDefault();
    if (key === 'y' || event.shiftKey) store.redo();
    else this.#takeBack(event.target);
  }

  /** What is typed and no value yet is taken back first. @param {EventTarget | null} target */
  #takeBack(target) {
    const { store, form } = this.app;
    if (!form.giveUp(target)) store.undo();
  }
}
