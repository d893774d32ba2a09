// SPDX-License-Identifier: GPL-3.0-or-later
// The Rig view: what a rig recorded, what was found in it, and how it compares with the prediction for the design on
// the table.
import { Away, address, ask, get, list } from '../base/api.js';
import { download, fill, h } from '../base/dom.js';
import { dateText, plain, sig } from '../base/format.js';
import { Lane } from '../base/lane.js';
import { Chart } from '../figures/chart.js';
import { mainCase } from '../figures/context.js';
import { MeasuredOrders, MeasuredPoints } from '../figures/measured.js';
import { group } from '../form.js';
import { reportData, reportHead } from '../report.js';
import { FitPanel } from './fit.js';
import { Recordings, findingList } from './recordings.js';

const REST = 350; // ms without a change before the comparison is asked for
const WHAT =
  'Rotational acceleration where the encoders sit, of the mesh orders alone: the second derivative of r_b φ of the gear less that of the pinion. Not the normal or transverse acceleration that the Design view shows first.';
const FAULTS = ['none', 'swapped', 'reversed', 'slip', 'dropped', 'teeth', 'saturated', 'spike'];

/** A curve over the mesh cycle moved by a part of it. @param {number[]} values @param {number} part */
function moved(values, part) {
  const count = values.length;
  return values.map((_, i) => {
    const place = ((((i / count - part) % 1) + 1) % 1) * count;
    const below = Math.floor(place) % count;
    const t = place - Math.floor(place);
    return values[below] * (1 - t) + values[(below + 1) % count] * t;
  });
}

/** Measurements of a design with their comparison. */
class Bench extends EventTarget {
  /** @type {any[]} */ items = [];
  /** @type {any} */ comparison = null;
  #timer = 0;
  #id = '';
  #asked = '';

  /** @param {import('../base/store.js').DesignStore} store */
  constructor(store) {
    super();
    this.store = store;
    this.note = '';
    this.lane = new Lane({
      result: (_task, data) => {
        this.comparison = data;
        this.#say('');
      },
      refused: (_task, error) => this.#say(error.message),
      preparing: (_task, job) =>
        this.#say(
          `The prediction waits for the teeth${typeof job?.progress?.fraction === 'number' ? `: ${Math.round(100 * job.progress.fraction)} %` : '…'}`,
        ),
    });
  }

  get designId() {
    return this.store.from.id;
  }

  /** @param {string} text */
  #say(text) {
    this.note = text;
    this.dispatchEvent(new Event('change'));
  }

  async load() {
    const id = this.designId;
    if (id !== this.#id) {
      this.#id = id;
      this.comparison = null;
      this.#asked = '';
    }
    this.items = id ? await list(`measurements?design=${encodeURIComponent(id)}`, 256) : [];
    this.#say('');
    this.later(true);
  }

  /** @param {boolean} [anew] */
  later(anew = false) {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#compare(anew), anew ? 0 : REST);
  }

  /** @param {boolean} anew */
  #compare(anew) {
    if (!this.items.length || !this.designId) {
      this.comparison = null;
      this.#say('');
      return;
    }
    const { design } = this.store;
    const text = JSON.stringify(design);
    if (!anew && text === this.#asked) return;
    this.#asked = text;
    this.lane.submit({
      path: `designs/${encodeURIComponent(this.designId)}/comparison`,
      body: design,
    });
  }

  /** What the comparison says of a measurement. @param {number} id */
  of(id) {
    const c = this.comparison;
    const at = c ? c.id.indexOf(id) : -1;
    if (at < 0) return null;
    const m = c.measurements;
    return {
      predicted: m.predicted_rms_m_per_s2[at],
      ratio: m.ratio[at],
      outlier: m.outlier[at],
      reason: m.reason[at],
      detail: c.details[at],
      reduction: c.reductions.find((/** @type {any} */ each) => each.id === id),
    };
  }
}

/** A synthetic recording. @param {import('../app.js').App} app @param {Recordings} recordings */
function teaching(app, recordings) {
  const unmodified = h(
    'select',
    { 'aria-label': 'Synthetic pair' },
    h('option', { value: '' }, 'modified'),
    h('option', { value: 'unmodified' }, 'unmodified'),
  );
  const torque = h('input.number', { type: 'text', inputmode: 'decimal', 'aria-label': 'Synthetic torque, N m' });
  const speed = h('input.number', { type: 'text', inputmode: 'decimal', 'aria-label': 'Synthetic speed, rpm' });
  const output = h(
    'select',
    { 'aria-label': 'Synthetic columns' },
    ['angles', 'counts', 'sine-cosine', 'pulses'].map(value => h('option', { value }, value)),
  );
  const fault = h(
    'select',
    { 'aria-label': 'Synthetic fault' },
    FAULTS.map(value => h('option', { value }, value)),
  );
  const note = h('p.figure-note', { role: 'status' });
  /** @type {{ name: string, torque: number, speed: number }} */ let asked = { name: '', torque: 0, speed: 0 };
  const lane = new Lane({
    result: (_task, data) => {
      note.textContent = '';
      const file = new File([data], asked.name, { type: 'text/csv' });
      if (keep) download(asked.name, file);
      else
        recordings.add([file], {
          label: unmodified.value || 'modified',
          torque: plain(asked.torque),
          speed: plain(asked.speed),
        });
    },
    refused: (_task, error) => {
      note.textContent = error.message;
    },
    preparing: () => {
      note.textContent = 'The teeth are being prepared…';
    },
  });
  let keep = false;
  const run = (/** @type {boolean} */ save) => {
    keep = save;
    const usual = app.store.design.load_cases[mainCase(app.store.design)];
    asked = {
      name: '',
      torque: Number(torque.value) || usual.torque_Nm,
      speed: Number(speed.value) || usual.speed_rpm,
    };
    asked.name = `${unmodified.value || 'modified'}-${plain(asked.torque)}Nm-${plain(asked.speed)}rpm.csv`;
    note.textContent = 'Recording…';
    lane.submit({
      path: 'rig',
      body: {
        design: app.store.design,
        rig: {
          torque_Nm: asked.torque,
          speed_rpm: asked.speed,
          unmodified: unmodified.value !== '',
          output: output.value,
          fault: fault.value,
          ...(output.value === 'angles' ? {} : { pinion_lines: 1024, gear_lines: 1024 }),
        },
      },
    });
  };
  /** @param {string} label @param {HTMLElement} entry */
  const row = (label, entry) => h('.field', null, h('span.label', null, label), entry);
  return group('teaching', 'Synthetic recording', false, [
    h(
      'p.figure-note',
      null,
      'Records what two encoders would see of this design, with noise and eccentricity, to try things out.',
    ),
    row('Pair', unmodified),
    row('Torque, N m', torque),
    row('Speed, rpm', speed),
    row('Columns', output),
    row('Fault', fault),
    h(
      '.form-foot.switches',
      null,
      h('button.small', { type: 'button', onclick: () => run(false) }, 'Record and use'),
      h('button.small', { type: 'button', onclick: () => run(true) }, 'Download'),
    ),
    note,
  ]);
}

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function rigView(app) {
  const { store } = app;
  const bench = new Bench(store);
  let chosen = 0;
  /** @type {any} */ let whole = null;

  const designId = async () => {
    if (store.from.id) return String(store.from.id);
    const name = store.design.name || 'unnamed';
    const answer = await ask('POST', 'designs', { body: { name, design: store.design } });
    store.from = { example: '', id: String(answer.data.id), etag: answer.headers.get('etag') ?? '' };
    store.dispatchEvent(new CustomEvent('change', { detail: 'view' }));
    app.note();
    return store.from.id;
  };
  /** @type {Promise<string> | null} */ let storing = null;
  const recordings = new Recordings({
    designId: () => {
      storing ??= designId().finally(() => {
        storing = null;
      });
      return storing;
    },
    kept: measurement => {
      chosen = measurement.id;
      whole = measurement;
      bench.load().catch(() => {});
    },
    loadCase: () => store.design.load_cases?.[mainCase(store.design)],
  });
  const fit = new FitPanel(app, () => store.from.id);

  const speed = new MeasuredPoints({
    title: 'Vibration over speed',
    unit: 'm/s²',
    help: WHAT,
    xLabel: 'pinion speed, rpm',
  });
  const torque = new MeasuredPoints({
    title: 'Vibration over torque',
    unit: 'm/s²',
    help: WHAT,
    xLabel: 'torque, N m',
  });
  const orders = new MeasuredOrders({
    title: 'Mesh orders',
    unit: 'm/s²',
    help: `${WHAT} Whiskers: one standard deviation.`,
  });
  const te = new Chart({
    title: 'Transmission error in phase',
    unit: 'µm',
    help: 'Mesh orders of the TE over one mesh cycle, moved to where the prediction lies: the zero of the encoders is arbitrary',
    xLabel: 'mesh cycle',
    cycle: true,
  });
  const spectrum = new Chart({
    title: 'Spectrum',
    unit: 'm/s²',
    help: 'Acceleration over orders of the pinion; upright lines: mesh orders',
    xLabel: 'order of the pinion',
    zero: true,
    wide: true,
  });
  const turn = new Chart({
    title: 'TE over one turn',
    unit: 'µm',
    help: 'Average over the turns of each shaft, without drift: its first orders are eccentricity',
    xLabel: 'turn',
  });
  const table = h('section.figure.with-table.tall', { 'aria-label': 'Measurements' });
  const about = h('section.figure.with-table', { 'aria-label': 'About the recording' });
  const reductions = h('section.figure.with-table', { 'aria-label': 'Reductions' });
  const note = h('p.trouble', { role: 'status', hidden: true });
  const empty = h(
    '.empty',
    null,
    h('h2', null, 'Measured and predicted'),
    h(
      'p',
      null,
      'Drop recordings of two encoders here, on the pinion and the gear shaft: one file for each torque and speed, of the unmodified and of the modified pair. They are kept with the design and shown beside its prediction at their torque and measured speed.',
    ),
    h('p', null, 'Without a rig at hand, make one under “Synthetic recording”.'),
  );
  const figures = h(
    '.figures',
    null,
    table,
    speed.element,
    torque.element,
    reductions,
    orders.element,
    te.element,
    about,
    spectrum.element,
    turn.element,
    fit.result,
  );
  const top = h('.report');
  const end = h('.report');
  const pane = h(
    '.figure-pane',
    {
      ondragover: (/** @type {DragEvent} */ event) => event.preventDefault(),
      ondrop: (/** @type {DragEvent} */ event) => {
        event.preventDefault();
        recordings.add([...(event.dataTransfer?.files ?? [])]);
      },
    },
    note,
    empty,
    figures,
    end,
  );
  const element = h(
    '.design-view.rig-view',
    null,
    top,
    h(
      'aside.form-pane',
      { 'aria-label': 'Recordings' },
      h('.form-scroll', null, recordings.element, fit.element, teaching(app, recordings)),
    ),
    pane,
  );

  /** @param {number} id */
  const choose = async id => {
    chosen = id;
    draw();
    try {
      const measurement = await get(`measurements/${id}`);
      if (chosen !== id) return;
      whole = measurement;
      drawChosen();
    } catch (error) {
      if (!(error instanceof Away)) note.textContent = /** @type {Error} */ (error).message;
    }
  };

  /** @param {any} item */
  const remove = async item => {
    if (!window.confirm(`Delete the measurement ${item.file} (${plain(item.torque_Nm)} N m) and its file?`)) return;
    await ask('DELETE', `measurements/${item.id}`).catch(() => {});
    if (chosen === item.id) chosen = 0;
    await bench.load();
  };

  const draw = () => {
    const { items } = bench;
    const other =
      bench.comparison && JSON.stringify(bench.comparison.left_out) !== '[]'
        ? `Left out of the comparison: ${bench.comparison.left_out.map((/** @type {any} */ item) => `${items.find(each => each.id === item.id)?.file ?? item.id}: ${item.reason}`).join(' ')}`
        : '';
    note.textContent = bench.note || other;
    note.hidden = note.textContent === '';
    empty.hidden = items.length > 0;
    figures.hidden = items.length === 0;
    if (!items.length) return;
    if (!items.some(item => item.id === chosen)) {
      choose(items[0].id);
      return;
    }
    drawTable();
    drawPoints();
    drawReductions();
    drawChosen();
  };

  const drawTable = () => {
    const sorted = [...bench.items].sort(
      (a, b) =>
        a.torque_Nm - b.torque_Nm ||
        a.result.speed_rpm.mean - b.result.speed_rpm.mean ||
        a.label.localeCompare(b.label) ||
        a.id - b.id,
    );
    const rows = sorted.map(item => {
      const beside = bench.of(item.id);
      const worst = ['warning', 'repaired', 'note'].find(severity =>
        item.findings.some((/** @type {any} */ finding) => finding.severity === severity),
      );
      const { rms_m_per_s2: rms, speed_rpm: turns, te: error } = item.result;
      const row = h(
        item.id === chosen ? 'tr.chosen' : 'tr',
        { onclick: () => choose(item.id) },
        h(
          'th',
          { scope: 'row' },
          h(
            'button.link',
            {
              type: 'button',
              'aria-pressed': String(item.id === chosen),
              onclick: (/** @type {Event} */ event) => {
                event.stopPropagation();
                choose(item.id);
              },
            },
            item.file,
          ),
        ),
        h('td', null, item.label),
        h('td.number', null, plain(item.torque_Nm)),
        h('td.number', null, turns.mean.toFixed(1)),
        h('td.number', null, h('b', null, sig(rms.value, 4)), ` ± ${sig(rms.sigma, 2)}`),
        h('td.number', null, beside ? sig(beside.predicted, 4) : '…'),
        h('td.number', null, beside ? sig(beside.ratio, 3) : '…'),
        h('td.number', null, sig(error.peak_to_peak_um, 3)),
        h(
          'td',
          null,
          beside?.outlier ? h('span.severity.warning', { title: beside.reason }, 'outlier') : null,
          worst
            ? h(
                `span.severity.${worst}`,
                { title: item.findings.map((/** @type {any} */ finding) => finding.text).join('\n') },
                worst === 'warning' ? 'doubtful' : worst,
              )
            : null,
        ),
        h(
          'td.actions',
          null,
          h(
            'a.icon',
            {
              href: address(`measurements/${item.id}/file`),
              download: item.file,
              title: 'The recording as it came',
              'aria-label': `Download ${item.file}`,
              onclick: (/** @type {Event} */ event) => event.stopPropagation(),
            },
            '↓',
          ),
          h(
            'button.icon',
            {
              type: 'button',
              title: 'Delete',
              'aria-label': `Delete ${item.file}`,
              onclick: (/** @type {Event} */ event) => {
                event.stopPropagation();
                remove(item);
              },
            },
            '✕',
          ),
        ),
      );
      return row;
    });
    const head = [
      ['recording', ''],
      ['pair', ''],
      ['torque', 'N m'],
      ['speed', 'rpm'],
      ['measured RMS', 'm/s²'],
      ['predicted', 'm/s²'],
      ['ratio', ''],
      ['TE', 'µm'],
      ['', ''],
      ['', ''],
    ];
    fill(
      table,
      h(
        '.figure-head',
        null,
        h('h3', { title: WHAT }, 'Measurements'),
        h(
          'span.figure-note',
          null,
          'rotational acceleration, mesh orders 1 to ',
          String(bench.items[0].result.harmonics),
        ),
        h(
          '.figure-controls',
          null,
          h(
            'a.small-link',
            {
              href: address(`designs/${store.from.id}/comparison.csv`),
              download: 'comparison.csv',
              title: 'Beside the stored design',
            },
            'CSV',
          ),
        ),
      ),
      h(
        '.table-scroll',
        { tabindex: '0', role: 'region', 'aria-label': 'Table' },
        h(
          'table.numbers.jobs',
          null,
          h(
            'thead',
            null,
            h(
              'tr',
              null,
              head.map(([text, unit]) =>
                h('th', { scope: 'col' }, text, unit ? h('span.unit', null, ` ${unit}`) : null),
              ),
            ),
          ),
          h('tbody', null, rows),
        ),
      ),
    );
  };

  /** Series of one pair at one torque (or speed). @param {'torque' | 'speed'} across */
  const seriesOver = across => {
    /** @type {Map<string, import('../figures/measured.js').Series>} */
    const series = new Map();
    for (const item of bench.items) {
      const [load, turns] = [item.torque_Nm, item.result.speed_rpm.mean];
      const fixed =
        across === 'speed' ? `${plain(Number(load.toPrecision(4)))} N m` : `${plain(Math.round(turns / 20) * 20)} rpm`;
      const key = `${fixed}, ${item.label}`;
      const beside = bench.of(item.id);
      if (!series.has(key))
        series.set(key, { label: key, group: fixed, colour: 'c1', open: item.label === 'unmodified', points: [] });
      series.get(key)?.points.push({
        x: across === 'speed' ? turns : load,
        measured: item.result.rms_m_per_s2.value,
        sigma: item.result.rms_m_per_s2.sigma,
        predicted: beside?.predicted ?? null,
        label: `${item.file}: ${plain(load)} N m, ${sig(turns, 5)} rpm`,
        outlier: beside?.outlier,
        chosen: item.id === chosen,
        pick: () => choose(item.id),
      });
    }
    const ordered = [...series.values()].sort(
      (a, b) => parseFloat(a.label) - parseFloat(b.label) || a.label.localeCompare(b.label),
    );
    const groups = [...new Set(ordered.map(each => each.label.split(',')[0]))];
    for (const each of ordered) each.group = each.label.split(',')[0];
    for (const each of ordered) each.colour = `c${(groups.indexOf(each.label.split(',')[0]) % 8) + 1}`;
    return ordered;
  };

  const drawPoints = () => {
    speed.set(seriesOver('speed'));
    torque.set(seriesOver('torque'));
  };

  const drawReductions = () => {
    const found = bench.comparison?.reductions ?? [];
    reductions.hidden = found.length === 0;
    const rows = [...found]
      .sort((a, b) => a.torque_Nm - b.torque_Nm || a.speed_rpm - b.speed_rpm)
      .map(each =>
        h(
          each.id === chosen ? 'tr.chosen' : 'tr',
          null,
          h('td.number', null, plain(each.torque_Nm)),
          h('td.number', null, each.speed_rpm.toFixed(0)),
          h('td.number', null, h('b', null, `${sig(each.measured_percent, 3)} %`), ` ± ${sig(each.sigma_percent, 2)}`),
          h('td.number', null, `${sig(each.predicted_percent, 3)} %`),
        ),
      );
    fill(
      reductions,
      h('.figure-head', null, h('h3', null, 'Less vibration by the modification')),
      h(
        '.table-scroll',
        { tabindex: '0', role: 'region', 'aria-label': 'Table' },
        h(
          'table.numbers',
          null,
          h(
            'thead',
            null,
            h(
              'tr',
              null,
              ['torque N m', 'speed rpm', 'measured', 'predicted'].map(text => h('th', { scope: 'col' }, text)),
            ),
          ),
          h('tbody', null, rows),
        ),
      ),
    );
  };

  /** The unmodified measurement at the torque and speed of another. @param {any} item */
  const partner = item =>
    bench.items.find(
      each =>
        each.label !== item.label &&
        Math.abs(each.torque_Nm / item.torque_Nm - 1) < 0.01 &&
        Math.abs(each.result.speed_rpm.mean / item.result.speed_rpm.mean - 1) < 0.02,
    );

  const drawChosen = () => {
    const item = bench.items.find(each => each.id === chosen);
    if (!item) return;
    drawOrders(item);
    drawTe(item);
    if (whole?.id === chosen) drawWhole(item);
  };

  /** @param {any} item */
  const drawOrders = item => {
    const { mesh } = item.result;
    const predicted = bench.of(item.id)?.detail?.orders?.predicted_m_per_s2;
    orders.set(
      mesh.acceleration_m_per_s2,
      mesh.acceleration_m_per_s2.map((/** @type {number} */ value, /** @type {number} */ i) =>
        mesh.amplitude_um[i] > 0 ? (value * mesh.sigma_um[i]) / mesh.amplitude_um[i] : 0,
      ),
      mesh.acceleration_m_per_s2.map((/** @type {number} */ _value, /** @type {number} */ i) => predicted?.[i] ?? null),
    );
  };

  /** @param {any} item */
  const drawTe = item => {
    const curves = [];
    let position = null;
    for (const each of [item, partner(item)]) {
      const curve = each && bench.of(each.id)?.detail?.te;
      if (!curve) continue;
      position = curve.position;
      const part = curve.shift ?? 0;
      const colour = each === item ? 'c1' : 'c3';
      curves.push({ label: `${each.label}, measured`, y: moved(curve.measured_um, part), colour });
      if (curve.predicted_um.every((/** @type {any} */ value) => value !== null))
        curves.push({
          label: `${each.label}, predicted`,
          y: moved(curve.predicted_um, part),
          colour,
          line: /** @type {const} */ ('dashed'),
        });
    }
    te.set({ x: position ?? [], curves });
  };

  /** @param {any} item */
  const drawWhole = item => {
    const { result, findings, notes, signal } = whole;
    const teeth = store.design.gear_pair?.pinion_teeth;
    spectrum.set({
      x: result.spectrum.order,
      curves: [{ label: item.file, y: result.spectrum.acceleration_m_per_s2, colour: 'c1', width: 1 }],
      marks: result.mesh.order.map((/** @type {number} */ order, /** @type {number} */ i) => ({
        x: order,
        label: teeth ? `${i + 1}×` : '',
        strong: i === 0,
      })),
    });
    const count = result.te.pinion_turn_um.length;
    turn.set({
      x: Array.from({ length: count }, (_, i) => (i + 0.5) / count),
      curves: [
        { label: 'pinion', y: result.te.pinion_turn_um, colour: 'c1', width: 1 },
        { label: 'gear', y: result.te.gear_turn_um, colour: 'c2', width: 1 },
      ],
    });
    /** @param {string} name @param {any} value */
    const fact = (name, value) => h('tr', null, h('th', { scope: 'row' }, name), h('td', null, value));
    /** @param {any} ellipse */
    const track = ellipse =>
      `amplitude ${ellipse.amplitude.map((/** @type {number} */ value) => sig(value, 3)).join(' / ')}, ratio ${sig(ellipse.ratio, 4)}, phase ${sig(ellipse.phase_deg, 4)}°`;
    const beside = bench.of(item.id);
    fill(
      about,
      h('.figure-head', null, h('h3', null, item.file)),
      beside?.outlier ? h('p.fault', null, `Outlier: ${beside.reason}`) : null,
      findings.length ? findingList(findings) : h('p.figure-note', null, 'Nothing is wrong with this recording.'),
      h(
        'table.numbers.facts',
        null,
        h(
          'tbody',
          null,
          fact(
            'Recorded',
            `${whole.signal.rows} rows, ${sig(result.seconds, 3)} s, ${sig(result.turns.pinion, 4)} turns of the pinion`,
          ),
          fact(
            'Speed',
            `${sig(result.speed_rpm.mean, 6)} rpm (${sig(result.speed_rpm.lowest, 6)} … ${sig(result.speed_rpm.highest, 6)})${whole.stated_speed_rpm ? `, stated ${plain(whole.stated_speed_rpm)}` : ''}`,
          ),
          fact(
            'Eccentricity',
            `pinion ${sig(result.shafts.pinion.amplitude_um[0], 3)} µm, gear ${sig(result.shafts.gear.amplitude_um[0], 3)} µm`,
          ),
          fact('Unexplained', `${sig(result.residual_um, 2)} µm RMS`),
          fact(
            'RMS by FFT',
            `${sig(result.rms_m_per_s2.spectrum, 4)} m/s², with sidebands ${sig(result.rms_m_per_s2.band, 4)}`,
          ),
          signal.tracks?.pinion ? fact('Pinion tracks', track(signal.tracks.pinion)) : null,
          signal.tracks?.gear ? fact('Gear tracks', track(signal.tracks.gear)) : null,
          fact(
            'File',
            `${plain(whole.files[0].size / 1e6)} MB, ${dateText(whole.created)}, SHA-256 ${whole.files[0].sha256.slice(0, 12)}…`,
          ),
        ),
      ),
      h(
        'details.more',
        null,
        h('summary', null, 'How it was read'),
        h(
          'ul.findings',
          null,
          notes.map((/** @type {string} */ text) => h('li', null, text)),
        ),
      ),
    );
    recordings.layout.show(whole.layout);
  };

  bench.addEventListener('change', draw);
  store.addEventListener('change', () => {
    if (app.current === 'rig') bench.later();
  });
  store.addEventListener('open', () => {
    if (app.current === 'rig') bench.load().catch(() => {});
  });

  return {
    element,
    show() {
      bench.load().catch(error => {
        note.hidden = false;
        note.textContent = error.message;
      });
    },
    print() {
      const { result } = app.analyst;
      fill(top, reportHead(`Rig measurements of ${store.design.name || 'this design'}`, result));
      if (result) fill(end, reportData(app.fields, result));
    },
  };
}
