// SPDX-License-Identifier: GPL-3.0-or-later
// Starts the page: field tables, the design of the address, the views.
import { Analyst } from './base/analyst.js';
import { readPlace } from './base/address.js';
import { Away, Refusal, connection, get, post } from './base/api.js';
import { h } from './base/dom.js';
import { Jobs } from './base/jobs.js';
import { Library, Missing } from './base/library.js';
import { complete, designFields, fittedFields } from './base/schema.js';
import { DesignStore } from './base/store.js';
import { App } from './app.js';
import { Form } from './form/form.js';
import { Shell } from './shell/shell.js';
import { designView } from './views/design.js';

/**
 * The tabs, in their order; those without a title are reached otherwise. What is not the first view is fetched when
 * it is first opened. @type {import('./app.js').Entry[]}
 */
const VIEWS = [
  { id: 'design', title: 'Design', load: async () => designView },
  { id: 'optimize', title: 'Optimize', load: async () => (await import('./views/optimize.js')).optimizeView },
  { id: 'study', title: 'Study', load: async () => (await import('./views/study/study.js')).studyView },
  {
    id: 'tolerance',
    title: 'Tolerance',
    load: async () => (await import('./views/tolerance/tolerance.js')).toleranceView,
  },
  { id: 'compare', title: 'Compare', load: async () => (await import('./views/compare.js')).compareView },
  { id: 'rig', title: 'Rig', load: async () => (await import('./views/rig/rig.js')).rigView },
  { id: 'report', title: '', load: async () => (await import('./report.js')).reportView },
  { id: 'glossary', title: '', load: async () => (await import('./welcome/glossary.js')).glossaryView },
];

/** The design of the address, or the first example when there is nothing at it. @param {Library} library */
async function openFirst(library) {
  try {
    await library.openAddress(readPlace(location.hash).parameters);
  } catch (error) {
    if (!(error instanceof Missing)) throw error;
    await library.openFirst();
  }
}

/** The report is fetched after everything else, so that printing at once has it. @param {App} app */
async function prepareReport(app) {
  const { Paper } = await import('./report.js');
  new Paper(app).start();
}

/** @param {HTMLElement} page */
async function start(page) {
  const [description, examples] = await Promise.all([get('schema'), get('examples')]);
  const fields = designFields(description);
  const store = new DesignStore(design => complete(fields, design));
  const library = new Library(store, examples.items);
  await openFirst(library);
  const analyst = new Analyst(store);
  analyst.update();
  const form = new Form(store, fields);
  const jobs = new Jobs();
  const app = new App(VIEWS, { store, analyst, form, fields, fitted: fittedFields(description), library, jobs });
  const shell = new Shell(app);
  app.addEventListener('stored', () => shell.menu.open());
  page.replaceChildren(...shell.elements);
  page.removeAttribute('aria-busy');
  store.addEventListener('change', event => {
    if (['design', 'view'].includes(/** @type {CustomEvent} */ (event).detail)) app.note();
  });
  jobs.start();
  await app.follow();
  prepareReport(app);
}

/** Asks for the token of a server that has one; a cookie keeps it. @param {HTMLElement} page */
function askToken(page) {
  const token = h('input.text', { type: 'password', id: 'token', autocomplete: 'current-password', required: true });
  const fault = h('p.fault', { role: 'alert' });
  const give = async (/** @type {Event} */ event) => {
    event.preventDefault();
    try {
      await post('session', { token: token.value });
      startWhenThere(page);
    } catch (error) {
      fault.textContent = /** @type {Error} */ (error).message;
    }
  };
  page.replaceChildren(
    h(
      'main.first-word',
      null,
      h(
        'form.token-form',
        { onsubmit: give },
        h('h1', null, 'Easeoff'),
        h('label', { for: 'token' }, 'Token of this server'),
        token,
        h('button.primary', { type: 'submit' }, 'Open'),
        fault,
      ),
    ),
  );
  token.focus();
}

/** @param {HTMLElement} page */
async function startWhenThere(page) {
  try {
    await start(page);
  } catch (error) {
    if (error instanceof Refusal && error.status === 401) {
      askToken(page);
      return;
    }
    if (!(error instanceof Away)) {
      page.replaceChildren(
        h('p.first-word', { role: 'alert' }, `The page could not start: ${/** @type {Error} */ (error).message}`),
      );
      throw error;
    }
    page.replaceChildren(
      h('p.first-word', { role: 'status' }, 'The service does not answer yet; the page opens when it does.'),
    );
    const again = () => {
      if (connection.away) return;
      connection.removeEventListener('change', again);
      startWhenThere(page);
    };
    connection.addEventListener('change', again);
  }
}

startWhenThere(/** @type {HTMLElement} */ (document.getElementById('page')));
