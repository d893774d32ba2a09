// SPDX-License-Identifier: GPL-3.0-or-later
// The phase of the mesh cycle that the pointer is on (0..1), or null: shown by every figure that has one.

class Phase extends EventTarget {
  /** @type {number | null} */ value = null;

  /** @param {number | null} value */
  set(value) {
    if (value === this.value) return;
    this.value = value;
    this.dispatchEvent(new Event('change'));
  }
}

export const phase = new Phase();
