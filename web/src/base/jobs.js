// SPDX-License-Identifier: GPL-3.0-or-later
// The jobs of the service, live from one stream of events for all pages of this browser.
import { address, connection, list } from './api.js';

const CHANNEL = 'easeoff-events';

export const ACTIVE = ['queued', 'preparing', 'running'];

/**
 * Two changes within a millisecond: a job that has ended does not run again so soon.
 * @param {Api.Job | Page.JobEvent} job
 * @param {Api.Job} known
 */
const older = (job, known) => {
  const [then, now] = [job.updated ?? '', known.updated ?? ''];
  return then < now || (then === now && ACTIVE.includes(job.state ?? '') && !ACTIVE.includes(known.state));
};

export class Jobs extends EventTarget {
  /** @type {Map<number, Api.Job>} */ all = new Map();
  /** @type {Set<number>} */ #removed = new Set();
  /** The list has been read. */
  known = false;
  /** @type {EventSource | null} */ #source = null;
  #channel = 'BroadcastChannel' in window ? new BroadcastChannel(CHANNEL) : null;

  start() {
    this.reload();
    this.#channel?.addEventListener('message', event => this.#take(event.data));
    connection.addEventListener('change', () => {
      if (!connection.away) this.reload();
    });
    if (navigator.locks && this.#channel) this.#lead();
    else this.#alone();
  }

  /**
   * One page of this browser holds the stream and tells the others: a browser opens six connections to a host, no
   * more.
   */
  #lead() {
    navigator.locks.request(CHANNEL, () => new Promise(() => this.#open())).catch(() => this.#alone());
  }

  /** Without locks every page has its own stream, as long as it is seen. */
  #alone() {
    const turn = () => {
      if (document.hidden) {
        this.#source?.close();
        this.#source = null;
      } else if (!this.#source) {
        this.#open();
        this.reload();
      }
    };
    document.addEventListener('visibilitychange', turn);
    turn();
  }

  #open() {
    const source = new EventSource(address('events'));
    this.#source = source;
    source.addEventListener('open', () => this.reload()); // what happened before it is in the list
    source.addEventListener('job', event => {
      const job = JSON.parse(event.data);
      this.#channel?.postMessage(job);
      this.#take(job);
    });
    source.addEventListener('error', () => {
      connection.doubt();
      if (source.readyState !== EventSource.CLOSED) return;
      connection.lost();
      const again = () => {
        if (connection.away) return;
        connection.removeEventListener('change', again);
        this.#open();
      };
      connection.addEventListener('change', again);
    });
  }

  async reload() {
    const before = new Set(this.all.keys());
    try {
      const items = await list('jobs', 400);
      for (const job of items) this.#merge(job);
      // What has come while the list was on its way is not missing in it.
      const listed = new Set(items.map(job => job.id));
      for (const id of before) if (!listed.has(id)) this.all.delete(id);
      this.known = true;
      this.dispatchEvent(new CustomEvent('change', { detail: null }));
    } catch {
      // comes again with the connection
    }
  }

  /**
   * Answers, lists and events come over connections of their own, in any order: what is known stays where it is newer.
   * @param {Api.Job | Page.JobEvent} job
   */
  #merge(job) {
    const known = this.all.get(job.id);
    if (this.#removed.has(job.id) || (known && older(job, known))) return;
    this.all.set(job.id, /** @type {Api.Job} */ ({ ...known, ...job }));
  }

  /** @param {Page.JobEvent} job */
  #take(job) {
    if (!job?.id) return;
    if (job.deleted) this.remove(job.id);
    else this.#merge(job);
    this.dispatchEvent(new CustomEvent('change', { detail: job.id }));
  }

  /** @param {number} id of a job that the service has deleted; numbers do not come again */
  remove(id) {
    this.#removed.add(id);
    this.all.delete(id);
  }

  /** @param {Api.Job} job what an answer said */
  put(job) {
    this.#channel?.postMessage(job);
    this.#take(job);
  }

  /** Optimizations, newest first. */
  searches() {
    return [...this.all.values()]
      .filter(job => job.kind === 'optimize')
      .sort((a, b) => String(b.created).localeCompare(String(a.created)) || Number(b.id) - Number(a.id));
  }
}
