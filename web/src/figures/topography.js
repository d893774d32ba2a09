// SPDX-License-Identifier: GPL-3.0-or-later
// The ease-off of both ends in space, with the load of the mesh cycle moving over it. three.js is fetched when this is
// first seen.
import { h } from '../base/dom.js';
import { phase } from '../base/phase.js';
import { theme } from '../base/theme.js';
import { Frame, whenSeen } from './frame.js';

const CYCLE = 4000; // ms of one mesh cycle when it plays

export class Topography {
  /** @type {import('./scene.js').Scene | null} */ #scene = null;
  /** @type {import('./context.js').Context | null} */ #context = null;
  #seen = false;
  #loading = false;
  #playing = false;
  #own = 0;

  constructor() {
    this.play = h(
      'button.small',
      { type: 'button', 'aria-pressed': 'false', onclick: () => this.#toggle() },
      '▶ mesh cycle',
    );
    this.frame = new Frame({
      title: 'Ease-off',
      unit: 'of both flanks together',
      wide: true,
      help: 'Material taken off pinion and gear together, seen on the pinion flank; bright: load on the contact lines. Drag turns it',
      controls: [this.play],
      drawing: {
        picture: () => this.#picture(),
        reset: () => this.#scene?.home(),
        table: () => this.#scene?.table() ?? [],
      },
    });
    this.elements = [this.frame.element];
    this.frame.element.classList.replace('wide', 'tall');
    this.frame.legend.textContent = 'drag to turn; opened large, the wheel comes closer';
    whenSeen(this.frame.element, visible => {
      this.#seen = visible;
      if (visible) this.#load();
    });
    phase.addEventListener('change', () => this.#draw());
    theme.addEventListener('change', () => this.#draw());
    new ResizeObserver(() => this.#draw()).observe(this.frame.body);
  }

  /** @param {import('./context.js').Context} context */
  set(context) {
    this.#context = context;
    if (this.#seen) {
      this.#scene?.set(context);
      this.#draw();
    }
  }

  async #load() {
    if (this.#scene) {
      if (this.#context) this.#scene.set(this.#context);
      this.#draw();
      return;
    }
    if (this.#loading) return;
    this.#loading = true;
    try {
      const { Scene } = await import('./scene.js');
      this.#scene = new Scene(this.frame.body, () => this.#draw());
      if (this.#context) this.#scene.set(this.#context);
      this.#draw();
    } catch {
      this.frame.say('This browser shows no 3D picture (WebGL is off).');
    }
  }

  #toggle() {
    this.#playing = !this.#playing;
    this.play.textContent = this.#playing ? '❚❚ mesh cycle' : '▶ mesh cycle';
    this.play.setAttribute('aria-pressed', String(this.#playing));
    let last = performance.now();
    /** @param {number} now */
    const step = now => {
      if (!this.#playing) return;
      this.#own = (this.#own + (now - last) / CYCLE) % 1;
      last = now;
      if (this.#seen) this.#draw();
      requestAnimationFrame(step);
    };
    if (this.#playing) requestAnimationFrame(step);
  }

  #draw() {
    if (this.#seen) this.#scene?.draw(this.#playing ? this.#own : (phase.value ?? this.#own));
  }

  async #picture() {
    await this.#load();
    this.#scene?.draw(this.#own);
    return this.#scene?.picture() ?? document.createElement('canvas');
  }
}
