// SPDX-License-Identifier: GPL-3.0-or-later
// Where designs come from and where they go: examples, stored designs, files, addresses.
import { putDifference, takeDifference } from './address.js';
import { Refusal, ask, get } from './api.js';

/** @typedef {import('./store.js').DesignStore} Store */

/** What a design of the service was changed to since it was opened here. */
export class Conflict extends Error {
  /** @param {Api.Design} theirs @param {string} etag */
  constructor(theirs, etag) {
    super('Somebody else has stored this design since you opened it.');
    this.theirs = theirs;
    this.etag = etag;
  }
}

/** There is nothing at an address. */
export class Missing extends Error {}

const PIN = 'pin.'; // before the keys of the pinned design

/** Keys of an address that say what the design is. @param {string} key */
const isDesignKey = key =>
  !key.startsWith(PIN) && (['id', 'from', 'name', 'load_cases'].includes(key) || key.includes('.'));

const OWN = 'own'; // in an address: a design that is nobody's yet and stated from nothing
const NOTHING = { design: /** @type {Api.Design} */ ({}), etag: '' };
const FIRST = 'paper-case-a'; // on the table when nobody says anything: a modification beside the unmodified pair

export class Library {
  /** Documents that addresses start from. @type {Map<string, { design: Api.Design, etag: string }>} */
  #bases = new Map();

  /** @param {Store} store @param {{ name: string, title: string }[]} examples */
  constructor(store, examples) {
    this.store = store;
    this.examples = examples;
  }

  /**
   * @param {{ example?: string, id?: string }} from
   * @returns {Promise<{ design: Api.Design, etag: string }>} a stored design as it is now
   */
  async #fetch({ example, id }) {
    try {
      if (!id) return { design: await get(`examples/${encodeURIComponent(example ?? '')}`), etag: '' };
      const answer = await ask('GET', `designs/${encodeURIComponent(id)}`);
      return { design: answer.data.design, etag: answer.headers.get('etag') ?? '' };
    } catch (error) {
      if (!(error instanceof Refusal) || (error.status !== 404 && error.status !== 422 && error.status !== 400))
        throw error;
      throw new Missing(
        id ? `Stored design ${id} is not on this server.` : `There is no example “${example}” on this server.`,
      );
    }
  }

  /** @param {{ example?: string, id?: string }} from @param {boolean} [anew] not what was fetched before */
  async base(from, anew = false) {
    if (!from.id && !from.example) return NOTHING;
    const key = from.id ? `id:${from.id}` : `example:${from.example}`;
    let base = anew ? undefined : this.#bases.get(key);
    if (!base) {
      base = await this.#fetch(from);
      this.#bases.set(key, base);
    }
    return base;
  }

  /** The document of an example. @param {string} name */
  async example(name) {
    return (await this.base({ example: name })).design;
  }

  /**
   * What an address says of a design: where it comes from and what differs from that.
   * @param {{ example?: string, id?: string }} from @param {Api.Design} design
   */
  #tell({ example, id }, design) {
    const parameters = new URLSearchParams(id ? { id } : { from: example || OWN });
    const base = id || example ? this.#bases.get(id ? `id:${id}` : `example:${example}`) : NOTHING;
    if (base) putDifference(base.design, design, parameters);
    return parameters;
  }

  /** Where a design comes from, as an address says it. @param {URLSearchParams} parameters @param {string} unsaid */
  #source(parameters, unsaid) {
    const id = parameters.get('id') ?? '';
    const example = parameters.get('from') ?? unsaid;
    return { id, example: id || example === OWN ? '' : example };
  }

  /** The parameters of the address that say what the design is. */
  address() {
    return this.#tell(this.store.from, this.store.design);
  }

  /** Adds what is pinned, as its difference from the design that it came from. @param {URLSearchParams} parameters */
  putPin(parameters) {
    const { pin } = this.store;
    if (!pin) return;
    parameters.set('pin', pin.label);
    for (const [key, value] of this.#tell(pin.from ?? {}, pin.design)) parameters.set(`${PIN}${key}`, value);
  }

  /** Pins what an address says, unless it is pinned already. @param {URLSearchParams} parameters */
  async openPin(parameters) {
    const { store } = this;
    const [wanted, now] = [parameters, new URLSearchParams()];
    this.putPin(now);
    const own = [...wanted].filter(([key]) => key === 'pin' || key.startsWith(PIN));
    if (new URLSearchParams(own).toString() === now.toString()) return;
    const label = wanted.get('pin');
    if (label === null) return store.setPin(null);
    const difference = new URLSearchParams(own.map(([key, value]) => [key.slice(PIN.length), value]));
    const from = this.#source(difference, FIRST);
    const { design } = await this.base(from);
    store.setPin({ label, design: takeDifference(design, difference), from });
  }

  /** Opens what an address says, unless it is open already. @param {URLSearchParams} parameters */
  async openAddress(parameters) {
    const { store } = this;
    const wanted = new URLSearchParams([...parameters].filter(([key]) => isDesignKey(key)));
    const open = Boolean(store.design.gear_pair);
    if (open && (wanted.size === 0 || wanted.toString() === this.address().toString())) return;
    const from = this.#source(parameters, wanted.size ? 'paper' : FIRST);
    const { design, etag } = await this.base(from);
    const whole = takeDifference(design, wanted);
    if (!whole.gear_pair) throw new Missing('This link states no gear pair.');
    store.open(whole, { ...from, etag, base: design === NOTHING.design ? null : design }, { fresh: !open });
  }

  /** Something to start with when an address leads nowhere. */
  async openFirst() {
    const { design } = await this.base({ example: FIRST });
    this.store.open(design, { example: FIRST }, { fresh: true });
  }

  /** @param {string} name */
  async openExample(name) {
    this.store.open(await this.example(name), { example: name });
  }

  /** @param {string} id */
  async openStored(id) {
    const { design, etag } = await this.base({ id }, true);
    this.store.open(design, { id, etag });
  }

  /** A design that is nobody's yet: from a file, or made here. @param {Api.Design} design */
  openNew(design) {
    this.store.open(design, {});
  }

  /**
   * Reads a file and opens what is in it.
   * @param {File} file
   */
  async openFile(file) {
    let document;
    try {
      document = JSON.parse(await file.text());
    } catch {
      throw new Error(`${file.name} is not JSON.`);
    }
    const design = document?.design?.gear_pair ? document.design : document;
    const checked = await ask('POST', 'check', { body: design });
    this.openNew(design.load_cases ? design : { ...design, load_cases: checked.data.design?.load_cases });
  }

  /** Stores the design on the table as a new one. @returns {Promise<string>} its name */
  async storeNew() {
    const { store } = this;
    const body = { name: store.design.name || 'unnamed', design: store.design };
    const answer = await ask('POST', 'designs', { body });
    this.#kept(String(answer.data.id), answer.headers.get('etag') ?? '');
    return body.name;
  }

  /**
   * Stores it where it came from; as a new one when it came from nowhere.
   * @param {string} [over] state that is overwritten knowingly
   * @returns {Promise<string>} its name
   */
  async save(over) {
    const { store } = this;
    const { id, etag } = store.from;
    if (!id) return this.storeNew();
    const path = `designs/${encodeURIComponent(id)}`;
    const body = { name: store.design.name || 'unnamed', design: store.design };
    try {
      const answer = await ask('PUT', path, { body, headers: { 'If-Match': over ?? etag ?? '' } });
      this.#kept(id, answer.headers.get('etag') ?? '');
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      if (error.status === 404) {
        store.orphaned(id);
        return this.storeNew();
      }
      if (error.status !== 412) throw error;
      const theirs = await this.#fetch({ id });
      throw new Conflict(theirs.design, theirs.etag);
    }
    return body.name;
  }

  /** @param {string} id @param {string} etag */
  #kept(id, etag) {
    this.#bases.set(`id:${id}`, { design: this.store.design, etag });
    this.store.kept(id, etag);
  }

  /** @param {string} id */
  async remove(id) {
    const path = `designs/${encodeURIComponent(id)}`;
    const etag = (await ask('GET', path)).headers.get('etag') ?? '*';
    await ask('DELETE', path, { headers: { 'If-Match': etag } });
    this.store.orphaned(id);
  }
}
