// SPDX-License-Identifier: GPL-3.0-or-later
// Starts the page: field tables, the design of the address, the views.
import { Analyst } from './base/analyst.js';
import { putDifference, readPlace, takeDifference } from './base/address.js';
import { Away, Refusal, connection, get, post } from './base/api.js';
import { h } from './base/dom.js';
import { Jobs } from './base/jobs.js';
import { complete, designFields } from './base/schema.js';
import { DesignStore } from './base/store.js';
import { paper } from './base/paper.js';
import { App } from './app.js';
import { Form } from './form.js';
import { Shell } from './shell.js';
import { compareView } from './views/compare.js';
import { designView } from './views/design.js';
import { optimizeView } from './views/optimize.js';
import { rigView } from './views/rig.js';

/** The tabs, in their order; one module each. @type {import('./app.js').Entry[]} */
const VIEWS = [
  { id: 'design', title: 'Design', make: designView },
  { id: 'optimize', title: 'Optimize', make: optimizeView },
  { id: 'compare', title: 'Compare', make: compareView },
  { id: 'rig', title: 'Rig', make: rigView },
];

const store = new DesignStore();
/** Documents that addresses start from. @type {Map<string, any>} */
const bases = new Map();
/** @type {import('./base/schema.js').Field[]} */
let fields = [];

/** @param {{ example?: string, id?: string }} from @returns {Promise<{ design: any, etag: string }>} */
async function baseOf({ example, id }) {
  const key = id ? `id:${id}` : `example:${example}`;
  let base = bases.get(key);
  if (!base) {
    const document = id
      ? (await get(`designs/${encodeURIComponent(id)}`)).design
      : await get(`examples/${encodeURIComponent(example || 'paper')}`);
    base = complete(fields, document);
    bases.set(key, base);
  }
  return { design: base, etag: '' };
}

/** The parameters of the address that say what the design is. */
function addressOf() {
  const parameters = new URLSearchParams();
  const { example, id } = store.from;
  if (id) parameters.set('id', id);
  else parameters.set('from', example || 'paper');
  const base = bases.get(id ? `id:${id}` : `example:${example || 'paper'}`);
  if (base) putDifference(base, store.design, parameters);
  return parameters;
}

/** Opens what an address says, unless it is open already. @param {URLSearchParams} parameters */
async function openPlace(parameters) {
  const now = addressOf();
  const wanted = new URLSearchParams(
    [...parameters].filter(
      ([key]) => key === 'id' || key === 'from' || key === 'name' || key === 'load_cases' || key.includes('.'),
    ),
  );
  if (store.design.gear_pair && (wanted.toString() === now.toString() || wanted.size === 0)) return;
  const from = { example: parameters.get('from') ?? 'paper', id: parameters.get('id') ?? '' };
  try {
    const { design } = await baseOf(from);
    store.open(takeDifference(design, wanted), from.id ? { id: from.id } : from, { fresh: !store.design.gear_pair });
  } catch (error) {
    if (error instanceof Away) throw error;
    const { design } = await baseOf({ example: 'paper' });
    store.open(design, { example: 'paper' }, { fresh: true });
  }
}

/** @param {HTMLElement} page */
async function start(page) {
  const { parameters } = readPlace(location.hash);
  const [description, examples] = await Promise.all([get('schema'), get('examples')]);
  fields = designFields(description);
  await baseOf({ example: 'paper' });
  await openPlace(parameters);
  const analyst = new Analyst(store);
  const form = new Form(store, fields);
  const jobs = new Jobs();
  const app = new App(VIEWS, { store, analyst, form, fields, examples: examples.items, jobs, addressOf, openPlace });
  page.replaceChildren(...new Shell(app, bases).elements);
  analyst.update();
  await app.follow();
  store.addEventListener('change', event => {
    if (/** @type {CustomEvent} */ (event).detail === 'design') app.note();
  });
  app.note();
  jobs.start();
  paper.addEventListener('change', () => {
    if (paper.on) app.print();
  });
  paper.start();
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
