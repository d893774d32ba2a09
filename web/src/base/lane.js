// Requests that a newer one makes pointless: one in flight, the newest waiting.
import { Away, Refusal, ask, connection, token } from './api.js';

const POLL = 400; // ms between two looks at a preparation

/**
 * @typedef {object} Task
 * @property {string} path
 * @property {any} body
 * @property {string} pair what has to be prepared: equal texts share a preparation
 * @property {any} [note] handed back with the result
 */

/** @typedef {{ result?: (task: Task, data: any, ms: number) => void, refused?: (task: Task, error: Error) => void,
 *   preparing?: (task: Task, job: any) => void }} Listener */

/** @param {number} ms */
const sleep = ms => new Promise(resolve => setTimeout(resolve, ms));

export class Lane {
  /** @type {Task | null} */ #waiting = null;
  /** @type {Task | null} */ #interrupted = null;
  #busy = false;
  #token = token();

  /** @param {Listener} listener */
  constructor(listener) {
    this.listener = listener;
    connection.addEventListener('change', () => {
      if (!connection.away && this.#interrupted) this.submit(this.#waiting ?? this.#interrupted);
    });
  }

  /** @param {Task} task */
  submit(task) {
    this.#waiting = task;
    this.#interrupted = null;
    if (!this.#busy) this.#work();
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

  /** @param {Task} task @param {Error} error */
  #fail(task, error) {
    if (error instanceof Away) {
      this.#interrupted = task;
      this.#waiting = null;
      return;
    }
    if (error instanceof Refusal && error.status === 409 && error.type.endsWith('/overtaken')) return;
    if (error instanceof Refusal && (error.status === 429 || error.status === 503)) {
      setTimeout(() => !this.#busy && this.submit(task), 1000);
      return;
    }
    this.listener.refused?.(task, error);
  }

  /** @param {Task} task */
  async #run(task) {
    const start = performance.now();
    const answer = await ask('POST', task.path, { body: task.body, headers: { 'Easeoff-Lane': this.#token } });
    if (answer.status === 202) {
      await this.#prepare(task, answer.data.job ?? answer.data);
      return;
    }
    const ms = performance.now() - start;
    // the next request is on its way while this result is drawn
    queueMicrotask(() => this.listener.result?.(task, answer.data, ms));
  }

  /**
   * Waits for the preparation of the pair; a newer task of another pair ends it.
   * @param {Task} task
   * @param {any} job
   */
  async #prepare(task, job) {
    let state = job;
    while (state.state === 'queued' || state.state === 'preparing' || state.state === 'running') {
      this.listener.preparing?.(this.#waiting ?? task, state);
      await sleep(POLL);
      if (this.#waiting && this.#waiting.pair !== task.pair) {
        ask('POST', `jobs/${job.id}/cancel`, { body: {} }).catch(() => {});
        return;
      }
      state = (await ask('GET', `jobs/${job.id}`)).data;
    }
    if (state.state === 'failed') throw new Refusal(422, state.error ?? { title: 'The pair could not be prepared.' });
    if (state.state === 'cancelled' && !this.#waiting)
      throw new Refusal(409, { title: 'The preparation of the teeth was stopped.' });
    if (!this.#waiting) this.#waiting = task;
  }
}
