// SPDX-License-Identifier: GPL-3.0-or-later
// Modules of the page that need no browser: numbers as people write them, documents, addresses, the tooth's section.
import { readPlace, writePlace, putDifference, takeDifference } from '../../web/src/base/address.js';
import { change, changeText, duration, labelOf, plain, sig } from '../../web/src/base/format.js';
import { halfAngle, halfTooth } from '../../web/src/base/involute.js';
import { differences, leaves, same, valueAt, withValue } from '../../web/src/base/pointer.js';
import { guess } from '../../web/src/base/recording.js';
import { parseNumber, readQuantity } from '../../web/src/base/quantity.js';
import { complete, fieldAt, fittedFields, numberFault, placesOf } from '../../web/src/base/schema.js';

globalThis.document ??= { baseURI: 'http://localhost/' };
globalThis.sessionStorage ??= { getItem: () => null, setItem: () => {} };
globalThis.window ??= globalThis;
globalThis.localStorage ??= { getItem: () => null, setItem: () => {} };
globalThis.CustomEvent ??= class extends Event {
  constructor(name, { detail } = {}) {
    super(name);
    this.detail = detail;
  }
};
const { readRows } = await import('../../web/src/base/case_rows.js');
const { caseLong, caseNames, torqueOf } = await import('../../web/src/figures/context.js');
const { shownSentence, useInches } = await import('../../web/src/base/units.js');
const { Jobs } = await import('../../web/src/base/jobs.js');
const { DesignStore } = await import('../../web/src/base/store.js');
const { emptyText } = await import('../../web/src/views/tolerance/empty_text.js');
const { byComponent } = await import('../../web/src/shell/import_file.js');

let count = 0;
let failed = 0;
const ok = (condition, what) => {
  count += 1;
  if (!condition) failed += 1;
  console.log(`${condition ? 'ok' : 'not ok'} ${count} - ${what}`);
};
const is = (value, expected, what) =>
  ok(
    same(value, expected),
    `${what}${same(value, expected) ? '' : `: ${JSON.stringify(value)}, expected ${JSON.stringify(expected)}`}`,
  );
const near = (value, expected, tolerance, what) =>
  ok(Math.abs(value - expected) <= tolerance, `${what}: ${value} against ${expected}`);

// ---- pairs as made, before there are any ----
for (const [block, asked, what, word] of [
  [undefined, 0, 'nothing is chosen', 'Choose how the gears are made'],
  [{ preset: 'as_stated', inputs: [], single_teeth: true }, 0, 'single teeth alone', 'teeth of its own'],
  [{ preset: 'iso_class', single_teeth: true }, 0, 'a preset', 'draw the pairs'],
  [{ centre_distance: true }, 0, 'the centre distance alone', 'draw the pairs'],
  [{ preset: 'as_stated', inputs: [{ key: 'compliance_factor' }] }, 0, 'inputs of your own', 'draw the pairs'],
  [{ single_teeth: true }, 2, 'pairs that were asked for', 'on their way'],
])
  ok(emptyText(block, asked).includes(word), `the right sentence stands there with ${what}`);
ok(!emptyText({ single_teeth: true }, 0).includes('Choose how'), 'single teeth are taken as a choice');

// ---- lengths in sentences, as tests/unit/format/test-inch.c has them ----
is(
  shownSentence('The face, 70 mm, is wide.'),
  'The face, 70 mm, is wide.',
  'a sentence stays in mm where nothing is chosen',
);
useInches(true);
for (const [metric, inch] of [
  ['The face, 70 mm, is wide.', 'The face, 2.7559 in, is wide.'],
  ['177800 is outside 0.5 .. 5000 mm.', '7000 is outside 0.019685 .. 196.85 in.'],
  ['From diameter 152.4001 to 177.8 mm, roll 5 to 7 deg.', 'From diameter 6.000004 to 7 in, roll 5 to 7 deg.'],
  [
    'The gears 17 and 18 are 254 and 127 mm wide; 18 and more.',
    'The gears 17 and 18 are 10 and 5 in wide; 18 and more.',
  ],
  ['2/3 (0.06 mm + 0.0005 a + 0.03 m_n)', '2/3 (0.0023622 in + 0.0005 a + 0.03 m_n)'],
  ['-25.4 um, 1e-05 mm, 5.08 µm', '-1 thou, 3.937e-7 in, 0.2 thou'],
  ['8 N/um, 3 mm/s, 7 mm2, 7 mm², 5 N mm, 600 N m', '8 N/um, 3 mm/s, 7 mm2, 7 mm², 5 N mm, 600 N m'],
  ['ISO 286-1 and 25.4 mm; A2 mm; v1.2 mm', 'ISO 286-1 and 1 in; A2 mm; v1.2 mm'],
])
  is(shownSentence(metric), inch, 'a sentence is said in inches');
useInches(false);

// ---- where two documents differ ----
is(
  differences(
    { a: 1, b: { c: 2, d: [1, 2] }, e: [{ f: 1 }, { f: 2 }], g: 'x' },
    { a: 1, b: { c: 3, d: [1, 5] }, e: [{ f: 1 }, { f: 4 }], h: { i: 5 } },
  ),
  ['/b/c', '/b/d/1', '/e/1/f', '/g', '/h/i'],
  'numbers, elements and what is there in one alone are differences',
);
is(differences({ e: [1] }, { e: [1, 2] }), ['/e'], 'a list of another length is a difference as a whole');
is(differences({ a: { b: null } }, { a: { b: 3 } }), ['/a/b'], 'a number in place of none is a difference');
is(differences({ a: { b: 1 } }, { a: 2 }), ['/a'], 'something of another kind is a difference as a whole');

// ---- what is taken off a flank, at any place ----
{
  const { runsLeft, faceRunsLeft, takenOff } = await import('../../web/src/figures/flanks.js');
  const flank = { profile_um: [4, 0, 6], lead_um: [1, 0, 3], surface_um: null, coast: null };
  const surface = [
    [0, 10],
    [20, 50],
  ];
  const member = { u_mm: [-2, 0, 2], surface_u_mm: [-2, 2], left: flank, right: { ...flank, surface_um: surface } };
  const result = { modification: { eta_mm: [-10, 0, 10], surface_eta_mm: [-10, 10], pinion: member, gear: member } };
  const at = (end, side, ...place) => takenOff(result, 'pinion', end, side, [-10, 0, 10])(...place);
  near(at('left', 'drive', 1, -5), 3.5, 1e-12, 'value where profile and lead add up');
  near(at('right', 'drive', 0, 0), 20, 1e-12, 'value where profiles vary over the face');
  near(at('right', 'drive', 2, 10), 50, 1e-12, 'value at the corner of such a surface');
  near(at('left', 'coast', 1, -5), 0, 0, 'value of a coast flank that is not modified');
  const outer = { flank: 'drive', axial: { meets_first: 'outer' } };
  const inner = { flank: 'coast', axial: { meets_first: 'inner' } };
  is(
    [runsLeft(outer, 'left', true), runsLeft(outer, 'right', true)],
    [true, false],
    'eta outwards runs to the left on the left end alone',
  );
  is(
    [runsLeft(inner, 'left', true), runsLeft(inner, 'right', true)],
    [false, true],
    'eta inwards runs to the left on the right end alone',
  );
  is([faceRunsLeft(outer, 'left', true), faceRunsLeft(inner, 'left', true)], [true, true], 'y belongs to the body');
  is(
    runsLeft({ axial: { meets_first: 'left' } }, 'left', false),
    true,
    'eta of one end runs to the left where the left meets first',
  );
}

// ---- jobs: answers, lists and events in any order ----
{
  let answer;
  const fetched = globalThis.fetch;
  globalThis.fetch = () => new Promise(resolve => (answer = items => resolve(Response.json({ items }))));
  const jobs = new Jobs();
  const job = (id, state, ms) => ({ id, state, updated: `2026-01-01T00:00:00.${ms}Z` });
  const states = () => [...jobs.all.values()].map(({ id, state }) => `${id} ${state}`);
  const listed = async (between, items) => {
    const done = jobs.reload();
    while (!answer) await null;
    between();
    answer(items);
    await done;
    answer = null;
  };
  jobs.put(job(1, 'done', 200));
  jobs.put(job(1, 'queued', 100));
  is(states(), ['1 done'], 'the answer to an order does not undo the end that came before it');
  jobs.put(job(1, 'running', 200));
  is(states(), ['1 done'], 'an order within a millisecond does not undo the end either');
  jobs.put(job(1, 'queued', 300));
  is(states(), ['1 queued'], 'a retry undoes the end that came before it');
  jobs.put(job(2, 'done', 100));
  await listed(
    () => {
      jobs.put(job(1, 'done', 500));
      jobs.put(job(3, 'queued', 500));
      jobs.remove(4);
    },
    [job(1, 'running', 400), job(4, 'done', 100), job(5, 'done', 100)],
  );
  is(states(), ['1 done', '3 queued', '5 done'], 'a list is older than what came while it was read');
  globalThis.fetch = fetched;
}

// ---- names of rig files ----
is(
  guess('mod_828Nm_2000rpm.csv'),
  { label: 'modified', torque: '828', speed: '2000' },
  'torque and speed are guessed from the units in a name',
);
is(
  guess('Unmodified 1035,5 N m 600 rpm.tdms'),
  { label: 'unmodified', torque: '1035.5', speed: '600' },
  'a name with blanks and a comma is guessed',
);
is(
  guess('u-621-1000.csv.gz'),
  { label: 'unmodified', torque: '621', speed: '1000' },
  'bare numbers in a name are torque, then speed',
);
is(guess('run7.csv'), { label: '', torque: '', speed: '' }, 'a name that says nothing guesses nothing');

// ---- load cases ----
const byPower = { power_kW: 100, speed_rpm: 1500 };
is(
  caseNames([byPower, { torque_Nm: 828, speed_rpm: 2000 }]),
  ['100 kW', '828 N m'],
  'a load case that states its power is called by it',
);
is(caseLong(byPower), '100 kW at 1500 rpm', 'a load case that states its power has it in full');
near(torqueOf(byPower), 100000 / (2 * Math.PI * 25), 1e-9, 'torque of a load case that states its power, N m');

// ---- numbers ----
is(parseNumber('1,5'), 1.5, 'a comma is a decimal sign');
is(parseNumber(' 1 234.5 '), 1234.5, 'spaces in a number are passed over');
is(parseNumber('−2e-3'), -0.002, 'a printed minus is read');
is(parseNumber('1.2.3'), undefined, 'a number with two points is none');
is(parseNumber(''), undefined, 'an empty text is no number');
is(parseNumber('12px'), undefined, 'a number with a unit is none');
is(parseNumber('1e999'), undefined, 'a number that is too large is none');
is(parseNumber('1.234,5'), 1234.5, 'points of thousands are passed over');
is(parseNumber('1,234.5'), 1234.5, 'commas of thousands are passed over');
is(parseNumber('12,345,678'), 12345678, 'commas of thousands may stand twice');
is(parseNumber('0,125'), 0.125, 'no thousands begin with a nought');
ok(/1250 or 1\.25/.test(readQuantity('1,250').fault), 'what can be read in two ways is asked about');
is(readQuantity('0.5 in', 'mm').value, 12.7, 'a length in inches becomes mm');
is(readQuantity('2 thou', 'um').value, 50.8, 'a length in thousandths of an inch becomes µm');
is(readQuantity('0,4 kN m', 'Nm').value, 400, 'a torque in kN m becomes N m');
is(readQuantity('828 N·m', 'Nm').value, 828, 'a dot between units is read');
is(readQuantity("1'200 rpm", 'rpm').value, 1200, 'an apostrophe of thousands is passed over');
ok(readQuantity('5 kg', 'mm').fault !== undefined, 'a unit of another kind is a fault');
is(sig(0.60714, 3), '0.607', 'a number is shown with three digits');
is(sig(1888.4, 3), '1888', 'a number is never shown with less than its whole part');
is(sig(-0.05, 2), '−0.050', 'a number below zero is shown with a minus sign');
is(sig(null), '–', 'what is not known is shown as a dash');
is(plain(12.233164931618317), '12.2332', 'a number in a field is shown with six digits');
is(plain(9007199254740991), '9007199254740991', 'a seed keeps every digit');
is(changeText(change(0.607, 1.31)), '−54 %', 'a change is shown in per cent');
is(changeText(change(1, 1)), '±0 %', 'no change is shown as none');
is(change(1, 0), undefined, 'a change against nothing is none');
is([duration(7), duration(3671), duration(null)], ['00:07', '1:01:11', '–'], 'the time left is shown by the clock');
is(labelOf('tip_relief_start_mm'), 'Tip relief start', 'a key has its label');

// ---- documents ----
const document = { a: { b: [1, 2, { c: 3 }] }, d: 4 };
const changed = withValue(document, '/a/b/2/c', 5);
is([valueAt(changed, '/a/b/2/c'), valueAt(document, '/a/b/2/c')], [5, 3], 'a changed copy leaves the original');
ok(changed.a !== document.a && Array.isArray(changed.a.b), 'lists stay lists in a changed copy');
is(valueAt(document, '/x/y'), undefined, 'a value that is not there is undefined');
is(
  [...leaves({ a: { b: 1 }, c: [1, 2] })],
  [
    ['a.b', 1],
    ['c', [1, 2]],
  ],
  'the leaves of a document are found',
);

// ---- field tables ----
const fields = [
  { key: 'name', kind: 'text', default: '', help: '' },
  {
    key: 'pair',
    kind: 'object',
    fields: [
      { key: 'teeth', kind: 'integer', low: 4, high: 2000, required: true },
      { key: 'width_mm', kind: 'number', low: 0.5, high: 5000, default: null, nullable: true },
    ],
  },
  { key: 'rows', kind: 'list', fields: [{ key: 'share', kind: 'number', default: null, nullable: true }] },
];
is(
  complete(fields, { pair: { teeth: 17 }, rows: [{}] }),
  { pair: { teeth: 17, width_mm: null }, rows: [{ share: null }], name: '' },
  'the defaults are written out',
);
is(fieldAt(fields, '/rows/3/share')?.key, 'share', 'the field of a row is found');
is(fieldAt(fields, '/pair/none'), undefined, 'a field that is not there is undefined');
const fitted = [{ key: 'axial_N', kind: 'numbers', unit: 'N', usual: [1, 1000] }];
is(
  fittedFields({ fit: { fields: [{ key: 'unknowns', kind: 'object', fields: fitted }] } }),
  fitted,
  'the inputs that can be fitted are those of the order',
);
const springs = ['axial_N', 'axial_left_N', 'axial_right_N', 'axial_back_N'].map(key => ({ key, kind: 'number' }));
is(
  placesOf(
    [
      { key: 'held', kind: 'object', fields: springs },
      { key: 'cases', kind: 'list', fields: springs },
    ],
    'axial_N',
  ),
  ['/held/axial_N', '/held/axial_left_N', '/held/axial_right_N'],
  'a fitted input stands under its key, or once for each end',
);
ok(
  numberFault(fields[1].fields[0], 3) !== '' &&
    numberFault(fields[1].fields[0], 4.5) !== '' &&
    numberFault(fields[1].fields[0], 4) === '',
  'range and whole number of a field are checked',
);

// ---- addresses ----
const base = { name: 'x', gear_pair: { teeth: 17, module: 6 }, load_cases: [{ torque: 1 }] };
const design = { name: 'y & z', gear_pair: { teeth: 18, module: 6 }, load_cases: [{ torque: 2 }, { torque: 3 }] };
const parameters = new URLSearchParams();
putDifference(base, design, parameters);
const place = readPlace(writePlace('design', parameters));
is(place.view, 'design', 'the view of an address is read');
is(takeDifference(base, place.parameters), design, 'a design comes back by way of its address');
is(readPlace(''), { view: 'design', parameters: {} }, 'no address at all is the design view');

// ---- the store ----
const store = new DesignStore();
const flank = { tip: 0, start: 0 };
store.open(
  { gear_pair: { ends: 2 }, modification: { pinion: { left: flank, right: flank } }, load_cases: [] },
  { example: 'paper' },
  { fresh: true },
);
ok(store.tied && !store.canUndo, 'equal ends are tied from the start');
for (const tip of [1, 2, 3]) store.set('/modification/pinion/left/tip', tip, { live: true });
store.settle();
is(
  [store.get('/modification/pinion/left/tip'), store.get('/modification/pinion/right/tip')],
  [3, 3],
  'left and right change together while they are tied',
);
store.set('/modification/pinion/left/start', 1);
store.undo();
is(store.get('/modification/pinion/right/start'), 0, 'undo takes both ends back');
store.undo();
is([store.get('/modification/pinion/left/tip'), store.canUndo], [0, false], 'a whole stroke of the slider is one step');
store.redo();
is(store.get('/modification/pinion/right/tip'), 3, 'redo gives the stroke again');
store.tie(false);
store.set('/modification/pinion/right/tip', 9);
is(
  [store.get('/modification/pinion/left/tip'), store.get('/modification/pinion/right/tip')],
  [3, 9],
  'each end changes for itself when they are not tied',
);
store.tie(true);
is(store.get('/modification/pinion/right/tip'), 3, 'the right end takes what the left has when they are tied again');

// ---- the tooth's section: closed forms of a 17-tooth gear of module 6, 20 degrees, 24 degrees helix, no profile shift
// ----
const radians = Math.PI / 180;
const transverse = 6 / Math.cos(24 * radians);
const pressure = Math.atan(Math.tan(20 * radians) / Math.cos(24 * radians));
const reference = (17 * transverse) / 2;
const baseRadius = reference * Math.cos(pressure);
// the rack's straight flank ends where its rounding begins, that much below the pitch line (ISO 53)
const below = 1.25 * 6 - 0.38 * 6 * (1 - Math.sin(20 * radians));
const form = Math.hypot(baseRadius, baseRadius * Math.tan(pressure) - below / Math.sin(pressure));
const geometry = {
  pinion_teeth: 17,
  gear_teeth: 44,
  normal_module_mm: 6,
  normal_pressure_angle_deg: 20,
  transverse_pressure_angle_deg: pressure / radians,
  helix_angle_deg: 24,
  profile_shift: [0, 0],
  reference_radius_mm: [reference, 0],
  base_radius_mm: [baseRadius, 0],
  tip_radius_mm: [reference + 6, 0],
  form_radius_mm: [form, 0],
  active_start_radius_mm: [form + 0.2, 0],
  tangent_length_mm: [baseRadius * Math.tan(pressure), 0],
};
const pair = { fillet_radius_coefficient: 0.38, dedendum_coefficient: 1.25 };
near(
  2 * reference * halfAngle(geometry, 0, reference),
  (Math.PI * transverse) / 2,
  1e-9,
  'tooth thickness at the reference circle',
);
const tooth = halfTooth(geometry, pair, 0);
const radii = tooth.map(([x, y]) => Math.hypot(x, y));
near(radii[0], reference - 1.25 * 6, 1e-9, 'radius at the start of the fillet, that of the root circle');
ok(
  radii.every((radius, i) => i === 0 || radius >= radii[i - 1] - 1e-9),
  'the radius grows from root to tip',
);
const own = halfTooth(geometry, { ...pair, pinion_dedendum_coefficient: 1.4 }, 0);
near(Math.hypot(...own[0]), reference - 1.4 * 6, 1e-9, 'radius of the root of a member with a rack of its own');
const jump = Math.max(...tooth.slice(1).map(([x, y], i) => Math.hypot(x - tooth[i][0], y - tooth[i][1])));
ok(jump < 1.5, `fillet and involute meet without a step (longest piece ${jump.toFixed(2)} mm)`);
const last = tooth[tooth.length - 1];
near(Math.hypot(...last), reference + 6, 1e-9, 'radius of the tip');
const [plainFlank, lower] = [halfTooth(geometry, pair, 0, () => 0), halfTooth(geometry, pair, 0, () => 0.1)];
ok(
  plainFlank.every(
    ([x, y], i) => Math.abs(Math.hypot(x - lower[i][0], y - lower[i][1]) - 0.1) < 1e-9 && lower[i][0] < x,
  ),
  'what is taken off is taken off the flank, square to it',
);

store.open({ gear_pair: { ends: 2 } }, { id: '1', etag: 'a' });
store.set('/name', 'x');
ok(store.changed, 'a design that changes differs from what is stored');
store.kept('1', 'b');
ok(!store.changed && store.from.etag === 'b', 'a design that is stored again does not differ');
store.set('/name', 'y');
store.kept('2', 'c');
store.undo();
is([store.from.id, store.changed], ['2', true], 'a design that is stored as a new one stays so with undo');
store.open({ gear_pair: { ends: 2 } }, { id: '3' });
store.setFault('/name', 'no');
store.undo();
is([store.from.id, store.faults.size], ['2', 0], 'undo brings back whose it was, and ends what was typed');

// ---- rows of a spreadsheet ----
is(
  readRows('500\t1000\t0,5\n600\t2000\t0.5').rows,
  [
    { torque_Nm: 500, speed_rpm: 1000, share: 0.5 },
    { torque_Nm: 600, speed_rpm: 2000, share: 0.5 },
  ],
  'columns of torque, speed and share are read',
);
is(
  readRows('case\tspeed\ttorque\nsea\t900\t1,5 kN m').rows,
  [{ name: 'sea', speed_rpm: 900, torque_Nm: 1500 }],
  'columns are read in the order of their headings, with units',
);
ok(/Row 2/.test(readRows('500\t1\n\tx').fault), 'a row without a torque is named');

// ---- tribology over the path of contact ----
const { overFace, tribologyCurves } = await import('../../web/src/figures/tribology_curves.js');
const touched = [
  [null, null, null],
  [null, 30, 20],
  [5, 0, null],
];
is(overFace(touched, Math.max), [null, 30, 5], 'the most over the face is found');
is(overFace(touched, Math.min), [null, 20, 0], 'the least over the face counts no row without contact as zero');
const side = { flash_K: touched, film_um: touched, max_flash_K: 31, min_film_ratio: 0, max_sliding_m_per_s: 1 };
const rated = {
  geometry: { tangent_length_mm: [20, 50] },
  tribology: {
    s_mm: [-5, 0, 5],
    load_cases: [{ roughness_um: 2, sliding_m_per_s: [-1, 0, 1], left: side, right: side }],
  },
};
const path = tribologyCurves(rated, 0, ['left', 'right']);
is([path.roll, path.pitchPoint], [[15, 20, 25], 20], 'the path has the roll length of the pinion');
is(
  path.filmRatio.map(({ end, y }) => [end, y]),
  [
    ['left', [null, 10, 0]],
    ['right', [null, 10, 0]],
  ],
  'the film over the roughness is taken of each end',
);
is(path.peak, { flash: 31, filmRatio: 0, sliding: 1 }, 'the peaks are those of all points of the contact');
is(path.sliding, [-1, 0, 1], 'nothing slides at the pitch point');
is(tribologyCurves(rated, 1, ['left']), null, 'a load case that is not there has no curves');
is(tribologyCurves({ ...rated, tribology: null }, 0, ['left']), null, 'a result without a rating has no curves');

// ---- the lane of requests: whose preparation is waited for, left and asked for again ----
const { Lane } = await import('../../web/src/base/lane.js');

/** A service that prepares the pair of `teeth`; stopped: numbers of jobs that somebody else stops. */
function serve({ stopped = [] } = {}) {
  const log = [];
  const jobs = new Map();
  const ready = new Set();
  const answer = (status, data) =>
    new Response(JSON.stringify(data), { status, headers: { 'content-type': 'application/json' } });
  globalThis.fetch = async (url, { method, body } = {}) => {
    const path = new URL(url).pathname.replace('/api/v1/', '');
    const [, id, verb] = /^jobs\/(\d+)\/?(.*)$/.exec(path) ?? [];
    if (verb === 'cancel') log.push(`cancel ${id}`);
    if (verb === 'cancel') return answer(200, {});
    if (id && method === 'GET') {
      const job = jobs.get(Number(id));
      job.looks += 1;
      if (stopped.includes(job.id)) return answer(200, { id: job.id, state: 'cancelled' });
      if (job.looks === 3) ready.add(job.teeth);
      return answer(200, { id: job.id, state: job.looks < 3 ? 'preparing' : 'done' });
    }
    const { teeth, harmonics } = JSON.parse(body);
    if (ready.has(teeth)) return answer(200, { teeth, harmonics });
    let job = [...jobs.values()].find(one => one.teeth === teeth && !stopped.includes(one.id));
    if (!job) jobs.set(jobs.size + 1, (job = { id: jobs.size + 1, teeth, looks: 0 }));
    log.push(`wait ${job.id}`);
    return answer(202, { job: { id: job.id, state: 'preparing' } });
  };
  return log;
}

/** What comes of tasks that follow each other while the first one's pair is prepared. */
function follow(bodies) {
  return new Promise(resolve => {
    const lane = new Lane({
      result: (_task, data) => resolve(data),
      refused: (_task, error) => resolve(error.message),
      preparing: () => bodies.length && lane.submit({ path: 'analyze', body: bodies.shift() }),
    });
    lane.submit({ path: 'analyze', body: bodies.shift() });
  });
}

let log = serve();
is(
  await follow([
    { teeth: 17, harmonics: 24 },
    { teeth: 17, harmonics: 12 },
  ]),
  { teeth: 17, harmonics: 12 },
  'the newer question is answered',
);
is(log, ['wait 1', 'wait 1'], 'a change that needs the same pair stops no preparation');
log = serve();
is(await follow([{ teeth: 19 }, { teeth: 17 }]), { teeth: 17 }, 'the newer pair is answered');
is(log, ['wait 1', 'wait 2', 'cancel 1'], 'a preparation that is of no use any more is stopped');
log = serve({ stopped: [1] });
is(await follow([{ teeth: 19 }]), { teeth: 19 }, 'a preparation that somebody else stopped is asked for once more');
log = serve({ stopped: [1, 2, 3, 4] });
is(
  await follow([{ teeth: 19 }]),
  'The preparation of the teeth was stopped.',
  'a preparation that is stopped again is not asked for again',
);

is(
  byComponent(['gear_casing 2', 'width of bearing 49', 'name of bearing 49', 'name of shaft 6']),
  ['gear_casing 2', 'width, name of bearing 49', 'name of shaft 6'],
  'attributes of one component that an import did not use stand on one line',
);

console.log(`1..${count}`);
process.exit(failed ? 1 : 0);
