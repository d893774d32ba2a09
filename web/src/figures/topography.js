// SPDX-License-Identifier: GPL-3.0-or-later
// The ease-off of both ends in space, with the load of the mesh cycle moving over it; turned by dragging or by keys.
import { h } from '../base/dom.js';
import { sig } from '../base/format.js';
import { phase } from '../base/phase.js';
import { shownUnit, shownValue } from '../base/units.js';
import { Painting } from './canvas.js';
import { caseLong } from './context.js';
import { COLUMNS, ROWS, paintRelief, reliefOf } from './relief.js';

const CYCLE = 4000; // ms of one mesh cycle when it plays
const STEP = Math.PI / 36; // of a key
const SPEED = 0.008; // radians for each px of a drag
const MOST_TILT = Math.PI / 2;
const VIEWS = /** @type {[string, import('./relief.js').View][]} */ ([
  ['oblique', { turn: -0.5, tilt: 0.62 }],
  ['front', { turn: 0, tilt: 0.12 }],
  ['side', { turn: -MOST_TILT, tilt: 0.12 }],
  ['top', { turn: 0, tilt: MOST_TILT }],
]);

export class Topography {
  /** @type {import('./relief.js').Relief | null} */ #relief = null;
  /** @type {import('./context.js').Context | null} */ #context = null;
  #view = { ...VIEWS[0][1] };
  #playing = false;
  #own = 0;

  constructor() {
    this.play = h(
      'button.small',
      { type: 'button', 'aria-pressed': 'false', onclick: () => this.#toggle() },
      '▶ mesh cycle',
    );
    const views = h(
      'span.views',
      { role: 'group', 'aria-label': 'View from' },
      VIEWS.map(([name, view]) => h('button.small', { type: 'button', onclick: () => this.#look(view) }, name)),
    );
    this.painting = new Painting(
      {
        title: 'Ease-off',
        name: 'Ease-off of both flanks together',
        help:
          'Material taken off pinion and gear together, over the face and from root to tip of the pinion flank; ' +
          'the colour is the contact pressure, bright on the contact lines of one mesh position.',
        good: 'Load in the middle of the face, none on its edges.',
        controls: [views, this.play],
      },
      (pen, width, height) => this.#paint(pen, width, height),
      {
        table: () => this.#table(),
        empty: () => this.#relief === null,
        reset: () => this.#look(VIEWS[0][1]),
      },
    );
    this.elements = [this.painting.element];
    this.painting.element.classList.add('tall');
    this.#listen(this.painting.canvas);
    phase.addEventListener('change', () => this.painting.repaint());
  }

  /** @param {import('./context.js').Context} context */
  set(context) {
    const same = this.#context?.result === context.result && this.#context?.loadCase === context.loadCase;
    this.#context = context;
    if (same) return;
    const row = context.result.load_cases[context.loadCase];
    this.#relief = reliefOf(context);
    this.painting.frame.setCase(caseLong(row));
    const most = `${sig(shownValue(this.#relief.depth, 'µm'), 3)} ${shownUnit('µm')}`;
    this.painting.describe(`Ease-off of both flanks, at most ${most} taken off; arrow keys turn it.`);
    this.painting.repaint();
  }

  /** @param {import('./relief.js').View} view */
  #look(view) {
    this.#view = { ...view };
    this.painting.repaint();
  }

  /** @param {number} turn @param {number} tilt */
  #turn(turn, tilt) {
    this.#look({
      turn: this.#view.turn + turn,
      tilt: Math.min(MOST_TILT, Math.max(0, this.#view.tilt + tilt)),
    });
  }

  /** @param {HTMLCanvasElement} canvas */
  #listen(canvas) {
    canvas.tabIndex = 0;
    canvas.style.touchAction = 'pan-y'; // a finger still scrolls the page
    canvas.style.cursor = 'grab';
    canvas.addEventListener('pointerdown', event => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('pointermove', event => {
      if (event.buttons & 1) this.#turn(-event.movementX * SPEED, event.movementY * SPEED);
    });
    const keys = /** @type {Record<string, [number, number]>} */ ({
      ArrowLeft: [-STEP, 0],
      ArrowRight: [STEP, 0],
      ArrowUp: [0, STEP],
      ArrowDown: [0, -STEP],
    });
    canvas.addEventListener('keydown', event => {
      const step = keys[event.key];
      if (!step) return;
      event.preventDefault();
      this.#turn(...step);
    });
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
      this.painting.repaint();
      requestAnimationFrame(step);
    };
    if (this.#playing) requestAnimationFrame(step);
  }

  /** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height */
  #paint(pen, width, height) {
    if (!this.#relief) return;
    const now = this.#playing ? this.#own : (phase.value ?? this.#own);
    paintRelief(pen, width, height, this.#relief, this.#view, now);
  }

  #table() {
    const relief = this.#relief;
    if (!relief) return [];
    /** @type {import('./table.js').Rows} */
    const rows = [['end', 's (mm)', 'eta (mm)', 'taken off (µm)', 'pressure (MPa)']];
    for (const { end, taken, pressure, path, width } of relief.surfaces)
      taken.forEach((depth, at) => {
        const [i, j] = [Math.floor(at / COLUMNS), at % COLUMNS];
        rows.push([
          end,
          path[0] + (i / (ROWS - 1)) * (path[1] - path[0]),
          (j / (COLUMNS - 1) - 0.5) * width,
          depth,
          pressure[at],
        ]);
      });
    return rows;
  }
}
