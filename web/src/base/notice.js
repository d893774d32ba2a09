// SPDX-License-Identifier: GPL-3.0-or-later
// A word that goes by itself; the shell shows it.

class Notice extends EventTarget {
  text = '';

  /** @param {string} text */
  say(text) {
    this.text = text;
    this.dispatchEvent(new Event('change'));
  }
}

export const notice = new Notice();
