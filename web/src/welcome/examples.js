// SPDX-License-Identifier: GPL-3.0-or-later
// The examples as cards: a picture of the teeth, the pair in numbers, and what its modification gains.
import { post } from '../base/api.js';
import { h } from '../base/dom.js';
import { change, changeText, plain } from '../base/format.js';
import { halfTooth } from '../base/involute.js';
import { Lane } from '../base/lane.js';
import { colour } from '../base/theme.js';
import { shownUnit, shownValue } from '../base/units.js';
import { numbersOf } from '../numbers.js';

const [WIDTH, HEIGHT] = [200, 96];
const TEETH = 3; // on either side of the middle one

/** Teeth of the pinion as they are cut. @param {HTMLCanvasElement} canvas
 * @param {Page.Result['geometry']} geometry @param {Api.ResolvedDesign['gear_pair']} pair */
function drawTeeth(canvas, geometry, pair) {
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  canvas.width = WIDTH * devicePixelRatio;
  canvas.height = HEIGHT * devicePixelRatio;
  pen.scale(devicePixelRatio, devicePixelRatio);
  const half = halfTooth(geometry, pair, 0);
  const [root, tip] = [geometry.root_radius_mm[0], geometry.tip_radius_mm[0]];
  const scale = (HEIGHT * 0.5) / (tip - root);
  const pitch = (2 * Math.PI) / geometry.pinion_teeth;
  pen.translate(WIDTH / 2, HEIGHT * 0.16 + tip * scale);
  pen.beginPath();
  for (let k = -TEETH; k <= TEETH; k++) {
    const outline = [...half.map(([x, y]) => [-x, y]), ...[...half].reverse()];
    for (const [x, y] of outline) {
      const [sin, cos] = [Math.sin(k * pitch), Math.cos(k * pitch)];
      pen.lineTo((x * cos + y * sin) * scale, -(y * cos - x * sin) * scale);
    }
  }
  pen.lineTo(WIDTH, HEIGHT);
  pen.lineTo(-WIDTH, HEIGHT);
  pen.closePath();
  pen.fillStyle = colour('pinion');
  pen.fill();
  pen.strokeStyle = colour('text');
  pen.stroke();
}

/** @param {Api.Design} design */
function hasModification(design) {
  const { left = {}, right = {} } = design.modification?.pinion ?? {};
  const entries = [left, right].flatMap(flank => Object.entries(flank));
  return entries.some(([key, value]) => /_um$/.test(key) && Number(value) > 0);
}

/** @param {number | null} value mm */
const lengthText = value => `${plain(shownValue(value, 'mm'))} ${shownUnit('mm')}`;

/** What the modification changes at the load case with the largest torque of a result. @param {Page.Result} result */
function gainText(result) {
  const before = result.objectives?.unmodified?.load_cases;
  if (!before) return '';
  const k = Math.floor(before.length / 2);
  const own = numbersOf(result, k);
  return /** @type {const} */ ([
    ['transmission error', 'peak_to_peak_um'],
    ['impact', 'impact_N'],
    ['vibration', 'rms_m_per_s2'],
  ])
    .map(([name, key]) => `${name} ${changeText(change(own[key], before[k][key]))}`)
    .join(', ');
}

class Examples {
  /** @param {import('../app.js').App} app */
  constructor(app) {
    this.app = app;
    /** @type {{ design: Api.Design, gain: HTMLElement }[]} */ this.waiting = [];
    /** @type {Lane<Page.Result, HTMLElement>} */
    this.lane = new Lane({
      result: (task, data) => {
        task.note.textContent = `Gain at its middle load: ${gainText(data)}.`;
        this.#next();
      },
      refused: (task, error) => {
        task.note.textContent = error.message;
        this.#next();
      },
      preparing: task => {
        task.note.textContent = 'Its teeth are being prepared…';
      },
    });
    this.dialog = h(
      'dialog',
      { class: 'examples-dialog', 'aria-label': 'Examples' },
      h('button.icon.close', { type: 'button', 'aria-label': 'Close', onclick: () => this.dialog.close() }, '✕'),
      h('h2', null, 'Examples'),
      h(
        '.cards',
        null,
        app.examples.map(example => this.#card(example)),
      ),
    );
    this.dialog.addEventListener('close', () => {
      this.waiting = [];
      this.dialog.remove();
    });
    document.body.append(this.dialog);
    this.dialog.showModal();
  }

  /** @param {{ name: string, title: string }} example */
  #card({ name, title }) {
    const { app } = this;
    const canvas = h('canvas', { role: 'img', 'aria-label': `Teeth of the pinion of ${name}` });
    const facts = h('p.figure-note', null, '…');
    const gain = h('p.card-gain');
    this.#describe(name, canvas, facts, gain).catch(error => {
      facts.textContent = error.message;
    });
    return h(
      'button.card',
      {
        type: 'button',
        onclick: () => {
          this.dialog.close();
          app.attempt(() => app.opening(() => app.library.openExample(name), 'design'));
        },
      },
      canvas,
      h('b', null, name),
      h('p', null, title),
      facts,
      gain,
    );
  }

  /** @param {string} name @param {HTMLCanvasElement} canvas @param {HTMLElement} facts @param {HTMLElement} gain */
  async #describe(name, canvas, facts, gain) {
    const design = await this.app.library.example(name);
    const { geometry: g, design: whole, prepared } = await post('check', design);
    drawTeeth(canvas, /** @type {Page.Result['geometry']} */ (g), whole.gear_pair);
    facts.textContent = [
      `${g.pinion_teeth}/${g.gear_teeth} teeth`,
      `module ${lengthText(g.normal_module_mm)}`,
      `${plain(g.helix_angle_deg)}°`,
      `face ${lengthText(g.face_width_mm)}`,
    ].join(', ');
    if (!hasModification(design)) gain.textContent = 'Unmodified: a search finds its flank.';
    else if (!prepared) gain.textContent = 'Modified: its gain is computed when it is opened.';
    else {
      gain.textContent = '…';
      this.waiting.push({ design, gain });
      if (this.waiting.length === 1) this.#ask();
    }
  }

  #ask() {
    const first = this.waiting[0];
    if (first) this.lane.submit({ path: 'analyze?maps=0&rating=0&pitch=0', body: first.design, note: first.gain });
  }

  #next() {
    this.waiting.shift();
    this.#ask();
  }
}

/** @param {import('../app.js').App} app */
export function openExamples(app) {
  return new Examples(app);
}
