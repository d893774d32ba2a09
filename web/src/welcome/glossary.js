// SPDX-License-Identifier: GPL-3.0-or-later
// All words of the page, explained once.
import { h } from '../base/dom.js';

/** @type {[string, [string, string][]][]} */
const WORDS = [
  [
    'The pair',
    [
      [
        'Herringbone gear',
        'Two helical halves of opposite hand on one body, with a groove between them; their axial forces ' +
          'cancel. Each half is called an end here, left and right.',
      ],
      ['Pinion, gear', 'The smaller and the larger member; the pinion drives unless a load case says otherwise.'],
      ['Normal module', 'Size of the teeth: reference diameter × cos(helix angle) / number of teeth.'],
      ['Helix angle', 'Slope of the teeth against the axis at the reference cylinder.'],
      ['Groove', 'Room between the two ends in which the tool runs out.'],
      [
        'Apex',
        'Where the helices of both halves would meet. A leading apex comes into mesh before the face ends, a ' +
          'trailing one behind them.',
      ],
      [
        'Stagger',
        'By what part of a pitch the teeth of one half stand behind those of the other; half a pitch evens out ' +
          'the mesh.',
      ],
      [
        'Axial float',
        'A pinion that no bearing holds along its axis moves until both halves carry the same axial force.',
      ],
      [
        'Profile shift',
        'By how many modules the tool stands away from where it would cut a plain tooth; thickens the root of ' +
          'a small pinion.',
      ],
      [
        'Mesh cycle',
        'The time from one tooth taking its place to the next one taking the same; one base pitch of rolling.',
      ],
    ],
  ],
  [
    'The flank',
    [
      [
        'Modification',
        'Micrometres taken off the exact flank on purpose, so that teeth bent by load still meet gently.',
      ],
      ['Ease-off', 'What is taken off both flanks together, over the face and the height of the teeth.'],
      [
        'Tip relief, root relief',
        'Material taken off near the tip or the root, from a start towards the end of the flank.',
      ],
      [
        'Drive flank, coast flank',
        'The two sides of a tooth: the drive flank carries in the usual direction, the coast flank when the gear ' +
          'drives or the machine runs astern.',
      ],
      ['Profile crowning', 'Material taken off towards root and tip in one smooth curve.'],
      [
        'Lead crowning',
        'Material taken off towards both face ends, so that the middle carries when the shafts are not parallel.',
      ],
      [
        'Helix slope, profile slope',
        'Material taken off more and more from one face end to the other, or from root to tip (C_Hβ, C_Hα).',
      ],
      [
        'Twist',
        'A profile slope that turns from one face end to the other; grinding a crowned helical flank makes one ' +
          'by itself.',
      ],
      ['End relief', 'Material taken off over a stretch at a face end.'],
      [
        'K-chart',
        'The profile drawn upright from root to tip, with what is taken off to the side, as an inspection ' +
          'sheet has it.',
      ],
      ['Misalignment', 'Angle between the shafts that should be zero: in the plane of the axes and out of it.'],
    ],
  ],
  [
    'What it does',
    [
      [
        'Transmission error (TE)',
        'How far the gear is behind or ahead of where a perfect, rigid pair would be, measured along the line ' +
          'of action.',
      ],
      [
        'Loaded TE, PPLTE',
        'The same under load; PPLTE is its peak-to-peak value over one mesh cycle, the excitation of gear noise.',
      ],
      ['Mesh stiffness', 'Force that pushes the teeth together by one micrometre; it changes as pairs come and go.'],
      [
        'Entering impact',
        'The blow of a tooth that meets its partner before its time because the teeth before it are bent.',
      ],
      ['Load sharing', 'Which part of the load one tooth pair carries on its way through the mesh.'],
      [
        'Vibration',
        'Acceleration of the teeth relative to each other in steady running, normal to the flank, transverse, ' +
          'or by rotation alone.',
      ],
      ['Mesh order', 'A multiple of the mesh frequency, which is speed × number of teeth.'],
      [
        'Mode',
        'One of the natural ways in which the pair on its bearings swings; a mesh order that meets one is a resonance.',
      ],
      ['Root stress, contact pressure', 'Largest stress in the fillet and largest Hertzian pressure on the flank.'],
      ['Edge contact', 'Load on the sharp edge of a tip, where there should be none.'],
    ],
  ],
  [
    'As made',
    [
      [
        'Tolerance class',
        'What ISO 1328-1 allows a flank or a pitch to deviate; the smaller the number, the better the gear.',
      ],
      [
        'Pitch deviation',
        'How far a tooth stands from its place: against the one before it (single), or since the first (index, total).',
      ],
      ['Run-out', 'How far the toothing stands off its axis: once per turn teeth are nearer and farther.'],
      [
        'Hunting period',
        'The time until the same two teeth meet again; only then everything has happened that can.',
      ],
      ['Sideband', 'An order next to a mesh order, one or several turns of a shaft away; uneven teeth make them.'],
      [
        'Percentile',
        'The value below which so many per cent of the pairs stay: 95 % of the pairs as made are better than the 95th.',
      ],
      ['Yield', 'The share of pairs as made that keep all limits.'],
    ],
  ],
  [
    'Strength',
    [
      [
        'Safety S_H, S_F',
        'Strength of flank and root over their stress by ISO 6336; below 1 the gear does not reach its life.',
      ],
      ['K_Hβ', 'The largest load per face width over the mean one: how unevenly the face carries.'],
      ['K_γ', 'The larger load of the two halves over an even share.'],
      ['Film ratio', 'Thickness of the oil film over the roughness of the flanks; above 2 or so they hardly touch.'],
    ],
  ],
  [
    'The search',
    [
      ['Duty cycle', 'The load cases together, each with its share of operating time.'],
      [
        'Objective J',
        'Transmission error, impact and vibration over the duty cycle, each divided by that of the unmodified ' +
          'pair, weighted and added; 1 is the unmodified pair.',
      ],
      [
        'f1, f2, f3',
        'The three objectives in the form of the published method: means weighted by share of time, divided by ' +
          'the number of load cases.',
      ],
      [
        'Evaluation',
        'One design computed in full by the model; a predicted value is one that the search only expects.',
      ],
      ['PFC', 'Percentage of fitness computed: evaluations by the model, of all values that the search needed.'],
      ['Pareto front', 'Designs of which none is better than another in every objective.'],
    ],
  ],
  [
    'The rig',
    [
      ['Encoder', 'Measures the angle of a shaft; one on each shaft gives the transmission error.'],
      ['Recording, measurement', 'What the rig wrote, and what is found in it.'],
      [
        'Reduction',
        'By how many per cent the modified pair vibrates less than the unmodified one, measured and predicted.',
      ],
    ],
  ],
];

/** @returns {import('../app.js').View} */
export function glossaryView() {
  const element = h(
    '.glossary-view',
    { tabindex: '-1' },
    h(
      '.glossary-bar',
      null,
      h('button', { type: 'button', onclick: () => history.back() }, '← Back'),
      h('h2', null, 'Words'),
    ),
    WORDS.map(([title, words]) =>
      h(
        'section',
        null,
        h('h3', null, title),
        h(
          'dl',
          null,
          words.map(([word, text]) => [h('dt', null, word), h('dd', null, text)]),
        ),
      ),
    ),
  );
  return { element, show: () => element.focus() };
}
