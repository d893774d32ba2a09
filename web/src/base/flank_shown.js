// SPDX-License-Identifier: GPL-3.0-or-later
// The flank that is worked on in the form: figures of one flank turn to it.

class FlankShown extends EventTarget {
  member = /** @type {Page.Member} */ ('pinion');
  side = /** @type {'drive' | 'coast'} */ ('drive');

  /** @param {Page.Member} member @param {'drive' | 'coast'} side */
  set(member, side) {
    if (member === this.member && side === this.side) return;
    this.member = member;
    this.side = side;
    this.dispatchEvent(new Event('change'));
  }
}

export const flankShown = new FlankShown();
