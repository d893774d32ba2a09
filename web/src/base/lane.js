// SPDX-License-Identifier: GPL-3.0-or-later
// Requests that a newer one makes pointless: one in flight, the newest waiting.
import { Away, Refusal, ask, connection, token } from './api.js';

const POLL = 400; // ms between two looks at a preparation
const TRIES = 3; // times that a preparation is asked for again when somebody else stops it

/** How many lanes of this page wait for a preparation. @type {Map<number, number>} */
const waiting = new Map();

/** One lane less; whether it was the last one. @param {number} id */
function isLastToLeave(id) {
  const others = (waiting.get(id) ?? 1) - 1;
  if (others > 0) waiting.set(id, others);
  else waiting.delete(id);
  return others <= 0;
}

/**
 * @template [N=any]
 * @typedef {object} Task
 * @property {string} path
 * @property {unknown} body
 * @property {number} [tries] asked again because somebody else stopped its preparation
 * @property {N} note handed back with the result
 */

/**
 * @template R, N
 * @typedef {{ result?: (task: Task<N>, data: R, ms: number) => void, refused?: (task: Task<N>, error: Error) => void,
 *   preparing?: (task: Task<N>, job: Api.Job) => void }} Listener
 */

/** @param {number} ms */
const sleep = ms => new Promise(resolve => setTimeout(resolve, ms));

/**
 * @template R what its questions are answered with
 * @template [N=string] what is written beside each of them
 */
export class Lane {
  /** @type {Task<N> | null} */ #waiting = null;
  /** @type {Task<N> | null} */ #interrupted = null;
  #busy = false;
  /** Number of the preparation that the last task waited for; 0: none. */
  #preparation = 0;
  #token = token();

  /** @param {Listener<R, N>} listener */
  constructor(listener) {
    this.listener = listener;
    connection.addEventListener('change', () => {
      if (!connection.away && this.#interrupted) this.#put(this.#waiting ?? this.#interrupted);
    });
  }

  /** @template {string} P @param {{ path: P, body: Api.PostBody<P>, note?: N }} task */
  submit(task) {
    this.#put(/** @type {Task<N>} */ (task));
  }

  /** @param {Task<N>} task */
  #put(task) {
    this.#waiting = task;
    this.#interrupted = null;
    if (!this.#busy) this.#work();
  }

  /**
   * Ends what is in flight: a smaller question in its place, whose answer nobody takes.
   * @template {string} P @param {{ path: P, body: Api.PostBody<P> }} task
   */
  overtake(task) {
    this.#waiting = null;
    ask('POST', task.path, { body: task.body, headers: { 'Easeoff-Lane': this.#token } }).catch(() => {});
  }

  async #work() {
    this.#busy = true;
    while (this.#waiting) {
      const task = this.#waiting;
      this.#waiting = null;
      try {
        await this.#run(task);
      } catch (error) {
        this.#fail(task, /** @type {Error} */ (error));
      }
    }
    this.#busy = false;
  }

  /** @param {Task<N>} task @param {Error} error */
  #fail(task, error) {
    if (error instanceof Away) {
      this.#interrupted = task;
      this.#waiting = null;
      return;
    }
    if (error instanceof Refusal && error.status === 409 && error.type.endsWith('/overtaken')) return;
    if (error instanceof Refusal && (error.status === 429 || error.status === 503)) {
      setTimeout(() => !this.#busy && this.#put(task), 1000);
      return;
    }
    this.listener.refused?.(task, error);
  }

  /** @param {Task<N>} task */
  async #run(task) {
    const start = performance.now();
    const answer = await ask('POST', task.path, { body: task.body, headers: { 'Easeoff-Lane': this.#token } });
    const job = answer.status === 202 ? /** @type {Api.Preparing} */ (answer.data).job : null;
    this.#leave(job?.id ?? 0);
    if (job) {
      await this.#prepare(task, job);
      return;
    }
    const ms = performance.now() - start;
    // the next request is on its way while this result is drawn
    queueMicrotask(() => this.listener.result?.(task, /** @type {R} */ (answer.data), ms));
  }

  /**
   * The service says which preparation a task waits for: a change that needs the same pair has the same one. Another is
   * of no use here any more and is stopped by the last lane of this page that leaves it.
   * @param {number} id of the preparation to wait for now; 0: none
   */
  #leave(id) {
    const left = this.#preparation;
    this.#preparation = id;
    if (left === id) return;
    if (id) waiting.set(id, (waiting.get(id) ?? 0) + 1);
    if (left && isLastToLeave(left)) ask('POST', `jobs/${left}/cancel`, { body: {} }).catch(() => {});
  }

  /**
   * Waits for the preparation of the pair, until there is a newer task: that one asks the service for itself.
   * @param {Task} task
   * @param {Api.Job} job
   */
  async #prepare(task, job) {
    let state = job;
    while (state.state === 'queued' || state.state === 'preparing' || state.state === 'running') {
      this.listener.preparing?.(this.#waiting ?? task, state);
      await sleep(POLL);
      if (this.#waiting) return;
      state = (await ask('GET', `jobs/${job.id}`)).data;
    }
    this.#preparation = 0;
    isLastToLeave(job.id);
    if (state.state === 'failed') throw new Refusal(422, state.error ?? { title: 'The pair could not be prepared.' });
    // another page that no longer needs the pair may have stopped it
    const stopped = state.state === 'cancelled';
    const tries = task.tries ?? 0;
    if (stopped && tries >= TRIES && !this.#waiting)
      throw new Refusal(409, { title: 'The preparation of the teeth was stopped.' });
    if (!this.#waiting) this.#waiting = stopped ? { ...task, tries: tries + 1 } : task;
  }
}
