// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of the topography. Heights are exaggerated; the picture is drawn when something changes, never by
// itself.
import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene as World,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { colour } from '../base/theme.js';
import { gridValue, scaleColour } from './colours.js';
import { endsOf } from './context.js';
import { valueAtPlace } from './gear.js';

const ROWS = 61; // root to tip
const COLUMNS = 61; // over the face
const LENGTH = 1.5; // of a face on the screen, DEPTH root to tip
const DEPTH = 1.5;
const HEIGHT = 0.55;
const GAP = 0.16;

/**
 * @typedef {{ mesh: Mesh, grid: LineSegments, height: Float32Array, pressure: Float32Array, cycle: Float32Array }}
 * Surface
 */

export class Scene {
  /** @type {Map<string, Surface>} */ #surfaces = new Map();
  /** @type {import('./context.js').Context | null} */ #context = null;
  #most = 1;
  #phase = 0;

  /** @param {HTMLElement} body @param {() => void} changed the view was turned */
  constructor(body, changed) {
    this.body = body;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.domElement.setAttribute('aria-label', 'Topography of the ease-off of both ends');
    this.renderer.domElement.setAttribute('role', 'img');
    body.append(this.renderer.domElement);
    this.world = new World();
    this.camera = new PerspectiveCamera(32, 1, 0.1, 50);
    this.world.add(new AmbientLight(0xffffff, 1.5));
    const sun = new DirectionalLight(0xffffff, 1.1);
    sun.position.set(-2, 4, 3);
    this.world.add(sun);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.enablePan = false;
    this.renderer.domElement.style.touchAction = 'pan-y'; // a finger still scrolls the page
    this.controls.addEventListener('change', changed);
    this.home();
  }

  home() {
    this.camera.position.set(0, 1.9, 2.75);
    this.controls.target.set(0, -0.12, 0.1);
    this.controls.update();
  }

  /** @param {import('./context.js').Context} context */
  set(context) {
    this.#context = context;
    const ends = endsOf(context.result);
    for (const [end, surface] of this.#surfaces)
      surface.mesh.visible = surface.grid.visible = ends.includes(/** @type {any} */ (end));
    for (const end of ends) this.#shape(end, ends.length === 2);
  }

  /** @param {'left' | 'right'} end */
  #surface(end) {
    let surface = this.#surfaces.get(end);
    if (surface) return surface;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * ROWS * COLUMNS), 3));
    geometry.setAttribute('color', new BufferAttribute(new Float32Array(3 * ROWS * COLUMNS), 3));
    const index = [];
    const lines = [];
    for (let i = 0; i < ROWS; i++) {
      for (let j = 0; j < COLUMNS; j++) {
        const at = i * COLUMNS + j;
        if (i < ROWS - 1 && j < COLUMNS - 1)
          index.push(at, at + 1, at + COLUMNS, at + 1, at + COLUMNS + 1, at + COLUMNS);
        if (j < COLUMNS - 1 && i % 10 === 0) lines.push(at, at + 1);
        if (i < ROWS - 1 && j % 6 === 0) lines.push(at, at + COLUMNS);
      }
    }
    geometry.setIndex(index);
    const wires = new BufferGeometry();
    wires.setAttribute('position', geometry.getAttribute('position'));
    wires.setIndex(lines);
    const mesh = new Mesh(
      geometry,
      new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1 }),
    );
    const grid = new LineSegments(wires, new LineBasicMaterial({ transparent: true, opacity: 0.45 }));
    this.world.add(mesh, grid);
    const count = ROWS * COLUMNS;
    surface = {
      mesh,
      grid,
      height: new Float32Array(count),
      pressure: new Float32Array(count),
      cycle: new Float32Array(count),
    };
    this.#surfaces.set(end, surface);
    return surface;
  }

  /**
   * Heights, pressures and the phase at which each place touches.
   * @param {'left' | 'right'} end
   * @param {boolean} two
   */
  #shape(end, two) {
    const { result, loadCase } = /** @type {import('./context.js').Context} */ (this.#context);
    const g = result.geometry;
    const { pinion, gear, eta_mm: faces } = result.modification;
    const pattern = result.load_cases[loadCase].contact?.pattern;
    const surface = this.#surface(end);
    const position = /** @type {BufferAttribute} */ (surface.mesh.geometry.getAttribute('position'));
    const lean = Math.tan((g.base_helix_angle_deg * Math.PI) / 180);
    const stagger = end === 'right' ? (result.design.alignment?.stagger ?? 0) : 0;
    const scale = HEIGHT / Math.max(20, largest(result));
    this.#most = Math.max(1, ...Object.values(result.load_cases[loadCase].contact?.max_pressure_MPa ?? {}).map(Number));
    for (let i = 0; i < ROWS; i++) {
      const up = i / (ROWS - 1);
      const s = g.path_start_mm + up * (g.path_end_mm - g.path_start_mm);
      for (let j = 0; j < COLUMNS; j++) {
        const across = j / (COLUMNS - 1);
        const eta = (across - 0.5) * g.face_width_mm;
        const at = i * COLUMNS + j;
        const taken =
          valueAtPlace(pinion?.u_mm, pinion?.[end]?.profile_um, g.rack_factor * s) +
          valueAtPlace(faces, pinion?.[end]?.lead_um, eta) +
          valueAtPlace(gear?.u_mm, gear?.[end]?.profile_um, -g.rack_factor * s) +
          valueAtPlace(faces, gear?.[end]?.lead_um, eta);
        const outwards = two ? GAP / 2 + across * LENGTH : (across - 0.5) * LENGTH;
        surface.height[at] = taken;
        surface.pressure[at] = pattern
          ? gridValue(pattern[end].pressure_MPa, up * (pattern.s_mm.length - 1), across * (pattern.eta_mm.length - 1))
          : 0;
        surface.cycle[at] = (s - eta * lean) / g.transverse_base_pitch_mm + stagger;
        position.setXYZ(at, two && end === 'left' ? -outwards : outwards, -taken * scale, (0.5 - up) * DEPTH);
      }
    }
    position.needsUpdate = true;
    surface.mesh.geometry.computeVertexNormals();
    surface.mesh.geometry.computeBoundingSphere();
    surface.grid.geometry.computeBoundingSphere();
  }

  /** The load near the contact lines of this phase. @param {Surface} surface */
  #paint(surface) {
    const colours = /** @type {BufferAttribute} */ (surface.mesh.geometry.getAttribute('color'));
    const still = new Color(colour('sunken'));
    const mixed = new Color();
    for (let at = 0; at < surface.height.length; at++) {
      let distance = surface.cycle[at] - this.#phase;
      distance -= Math.round(distance);
      const near = Math.exp(-((distance / 0.045) ** 2));
      const part = surface.pressure[at] / this.#most;
      const [r, g, b] = scaleColour(part);
      mixed.setRGB(r / 255, g / 255, b / 255, 'srgb');
      mixed.lerpColors(still, mixed, part > 0 ? Math.max(near, 0.28) : 0);
      colours.setXYZ(at, mixed.r, mixed.g, mixed.b);
    }
    colours.needsUpdate = true;
  }

  /** @param {number} phase */
  draw(phase) {
    const { clientWidth: width, clientHeight: height } = this.body;
    if (!this.#context || width === 0 || height === 0) return;
    this.#phase = phase;
    this.controls.enableZoom = this.body.closest('dialog') !== null; // elsewhere the wheel scrolls
    for (const surface of this.#surfaces.values()) {
      this.#paint(surface);
      /** @type {LineBasicMaterial} */ (surface.grid.material).color.set(colour('muted'));
    }
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.world, this.camera);
  }

  picture() {
    const source = this.renderer.domElement;
    const canvas = document.createElement('canvas');
    canvas.width = source.width;
    canvas.height = source.height;
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    pen.fillStyle = colour('panel');
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(source, 0, 0);
    return canvas;
  }

  /** @returns {(string | number | null)[][]} */
  table() {
    if (!this.#context) return [];
    const g = this.#context.result.geometry;
    /** @type {(string | number | null)[][]} */
    const rows = [['end', 's (mm)', 'eta (mm)', 'taken off (um)']];
    for (const [end, surface] of this.#surfaces) {
      if (!surface.mesh.visible) continue;
      surface.height.forEach((taken, at) => {
        const [i, j] = [Math.floor(at / COLUMNS), at % COLUMNS];
        rows.push([
          end,
          g.path_start_mm + (i / (ROWS - 1)) * (g.path_end_mm - g.path_start_mm),
          (j / (COLUMNS - 1) - 0.5) * g.face_width_mm,
          Number(taken.toPrecision(6)),
        ]);
      });
    }
    return rows;
  }
}

/** The deepest place of all flanks together. @param {any} result */
function largest(result) {
  const { pinion, gear } = result.modification;
  let most = 0;
  for (const end of endsOf(result)) {
    for (const member of [pinion, gear]) {
      if (member?.[end]) most = Math.max(most, Math.max(...member[end].profile_um) + Math.max(...member[end].lead_um));
    }
  }
  return most;
}
