// SPDX-License-Identifier: GPL-3.0-or-later
// The public API, and whether it answers.
import { shownSentence } from './units.js';

/** @typedef {Api.ProblemError} Fault */

/** What the service refused, with its reasons, in the units in which lengths are shown when they are read. */
export class Refusal extends Error {
  /** @param {number} status @param {Partial<Api.Problem> | null} problem */
  constructor(status, problem) {
    super();
    this.status = status;
    this.type = String(problem?.type ?? '');
    /** Everything that the problem says besides. @type {Record<string, unknown>} */
    this.more = { ...problem };
  }

  get message() {
    const { detail, title } = this.more;
    return shownSentence(String(detail || title || `The service answered ${this.status}.`));
  }

  /** @returns {Fault[]} */
  get faults() {
    const faults = Array.isArray(this.more.errors) ? /** @type {Fault[]} */ (this.more.errors) : [];
    return faults.map(fault => ({ ...fault, detail: shownSentence(fault.detail) }));
  }
}

/** The service does not answer at all. */
export class Away extends Error {
  constructor() {
    super('The service does not answer.');
  }
}

/**
 * What OpenAPI says that a path answers to a method; the type Api is written from it when the page is built.
 * @template M, P
 * @typedef {M extends 'GET' ? Api.GetAnswer<P> : M extends 'POST' ? Api.PostAnswer<P>
 *   : M extends 'PUT' ? Api.PutAnswer<P> : Api.DeleteAnswer<P>} AnswerTo
 */
/**
 * What a path takes with a method.
 * @template M, P
 * @typedef {M extends 'GET' ? Api.GetBody<P> : M extends 'POST' ? Api.PostBody<P>
 *   : M extends 'PUT' ? Api.PutBody<P> : Api.DeleteBody<P>} BodyOf
 */

const BASE = new URL('api/v1/', document.baseURI);
const FIRST_RETRY = 1000;
const LONGEST_RETRY = 5000;

class Connection extends EventTarget {
  away = false;

  /** A stream has broken: is the service still there? */
  async doubt() {
    if (this.away) return;
    try {
      const response = await fetch(new URL('health', BASE), { cache: 'no-store' });
      if (!response.ok) throw new Error();
    } catch {
      this.lost();
    }
  }

  /** Starts asking until the service is back; listeners of "change" hear both turns. */
  lost() {
    if (this.away) return;
    this.away = true;
    this.dispatchEvent(new Event('change'));
    this.#retry(FIRST_RETRY);
  }

  /** @param {number} wait */
  #retry(wait) {
    setTimeout(async () => {
      try {
        const response = await fetch(new URL('health', BASE), { cache: 'no-store' });
        if (!response.ok) throw new Error();
        this.away = false;
        this.dispatchEvent(new Event('change'));
      } catch {
        this.#retry(Math.min(LONGEST_RETRY, wait * 1.5));
      }
    }, wait);
  }
}

export const connection = new Connection();

/** @param {Response} response @param {boolean | undefined} whole */
async function readBody(response, whole) {
  if (whole && response.ok) return response.blob();
  const type = response.headers.get('content-type') ?? '';
  if (/json/.test(type)) return response.json();
  const text = await response.text();
  return text === '' ? null : text;
}

/** @param {unknown} body */
const typeOf = body => (body instanceof Blob ? 'application/octet-stream' : 'application/json');

/**
 * @template {'GET' | 'POST' | 'PUT' | 'DELETE'} M
 * @template {string} P
 * @template {boolean} [W=false]
 * @param {M} method @param {P} path below /api/v1/
 * @param {{ body?: BodyOf<M, P>, headers?: Record<string, string>, signal?: AbortSignal, whole?: W }} [options]
 *   whole: a file, byte for byte, as a Blob
 * @returns {Promise<{ status: number, data: W extends true ? Blob : AnswerTo<M, P>, headers: Headers }>} of a status
 *   below 400
 */
export async function ask(method, path, { body, headers = {}, signal, whole } = {}) {
  /** @type {Response} */
  let response;
  let data;
  try {
    response = await fetch(new URL(path, BASE), {
      method,
      signal,
      headers: body === undefined ? headers : { 'content-type': typeOf(body), ...headers },
      body: body instanceof Blob ? body : body === undefined ? undefined : JSON.stringify(body),
    });
    data = await readBody(response, whole);
  } catch (error) {
    if (signal?.aborted) throw error;
    if (error instanceof SyntaxError) throw new Refusal(500, { title: 'The answer of the service cannot be read.' });
    connection.lost();
    throw new Away();
  }
  if (response.status >= 400) throw new Refusal(response.status, data);
  return { status: response.status, data, headers: response.headers };
}

/** @template {string} P @param {P} path @returns {Promise<Api.GetAnswer<P>>} */
export async function get(path) {
  return (await ask('GET', path)).data;
}

/**
 * @template {string} P
 * @param {P} path @param {Api.PostBody<P>} body @param {Record<string, string>} [headers]
 * @returns {Promise<Api.PostAnswer<P>>}
 */
export async function post(path, body, headers) {
  return (await ask('POST', path, { body: /** @type {BodyOf<'POST', P>} */ (body), headers })).data;
}

/**
 * One row of what a paged list holds.
 * @template P
 * @typedef {Api.GetAnswer<P> extends { items: Array<infer Row> } ? Row : never} RowOf
 */

/** Everything of a paged list. @template {string} P @param {P} path @param {number} [most] */
export async function list(path, most = 2000) {
  /** @type {RowOf<P>[]} */
  const items = [];
  let cursor = null;
  do {
    const mark = path.includes('?') ? '&' : '?';
    const place = `${path}${mark}limit=200${cursor ? `&cursor=${encodeURIComponent(cursor)}` : ''}`;
    const page = /** @type {{ items: RowOf<P>[], next: string | null }} */ (await get(place));
    items.push(...page.items);
    cursor = page.next;
  } while (cursor && items.length < most);
  return items;
}

/** The address of something to download or to stream. @param {string} path */
export function address(path) {
  return new URL(path, BASE).href;
}

/** A random token, for lanes and idempotency keys. */
export function token() {
  return Array.from(crypto.getRandomValues(new Uint8Array(12)), byte => byte.toString(16).padStart(2, '0')).join('');
}
