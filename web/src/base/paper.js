// SPDX-License-Identifier: GPL-3.0-or-later
// The page as paper: tells every figure to draw itself, in sight or not, in the size and colours of a report.
import { theme } from './theme.js';

class Paper extends EventTarget {
  on = false;

  start() {
    window.addEventListener('beforeprint', () => this.#turn(true));
    window.addEventListener('afterprint', () => this.#turn(false));
  }

  /** @param {boolean} on */
  #turn(on) {
    if (this.on === on) return;
    this.on = on;
    document.body.classList.toggle('paper', on);
    theme.print(on);
    this.dispatchEvent(new Event('change'));
  }
}

export const paper = new Paper();
