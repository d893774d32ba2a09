// SPDX-License-Identifier: GPL-3.0-or-later
// Whose figures these are: stated on every picture and in every table that leaves the page.

class Subject {
  /** @type {Page.Result | null} */ #result = null;
  #name = '';

  /** @param {string} name of the design @param {Page.Result} result */
  set(name, result) {
    this.#name = name;
    this.#result = result;
  }

  get name() {
    return this.#name || 'unnamed';
  }

  get hash() {
    return String(this.#result?.design_hash ?? '').slice(0, 12);
  }

  get program() {
    return this.#result?.program ?? 'easeoff';
  }

  /** "2026-11-30 19:27", in the reader's time. */
  get date() {
    const now = new Date();
    const local = new Date(now.getTime() - now.getTimezoneOffset() * 60000);
    return local.toISOString().slice(0, 16).replace('T', ' ');
  }

  /** One line: program, design, date. */
  get line() {
    return [this.program, `design “${this.name}”`, this.hash && `number ${this.hash}`, this.date]
      .filter(Boolean)
      .join(' · ');
  }
}

export const subject = new Subject();
