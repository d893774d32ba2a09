// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and words for people.

const SYMBOLS = /** @type {Record<string, string>} */ ({
  um: 'µm',
  deg: '°',
  Nm: 'N m',
  N_per_um: 'N/µm',
  m_per_s2: 'm/s²',
  kg_m2: 'kg m²',
  kg_per_m3: 'kg/m³',
  Nm_per_rad: 'N m/rad',
  per_mm: '1/mm',
  mm2_per_s: 'mm²/s',
  C: '°C',
  per_um: '1/µm',
  'm/s2': 'm/s²',
});

/** The unit as it is printed. @param {string | null | undefined} unit */
export function unitText(unit) {
  if (!unit) return '';
  return SYMBOLS[unit] ?? unit;
}

const SUFFIX = new RegExp(
  '_(um|mm|deg|C|Nm|rpm|MPa|GPa|per_GPa|N|N_per_um|Nm_per_rad|kg|kg_m2|kg_per_m3|per_mm|per_inch|mm2_per_s|m_per_s2|' +
    'W_per_m_K|J_per_kg_K|Hz)$',
);
/** Keys whose words are not those of their name. */
const NAMES = /** @type {Record<string, string>} */ ({
  viscosity_40: 'Viscosity at 40 °C',
  viscosity_100: 'Viscosity at 100 °C',
  pressure_viscosity: 'Pressure-viscosity coefficient',
  te_harmonics: 'TE harmonics',
  hub_windup: 'Wind-up of the hub',
  f1: 'f1, TE',
  f2: 'f2, impact',
  f3: 'f3, vibration',
  peak_to_peak: 'TE, peak to peak',
  impact: 'Entering impact',
  rms: 'Vibration, RMS',
  rms_m_per_s2: 'Vibration, RMS',
  period_peak_to_peak: 'TE over the hunting period, peak to peak',
  period_rms: 'Vibration over the hunting period, RMS',
  pinion_order: 'Shaft order of the pinion',
  gear_order: 'Shaft order of the gear',
  sideband: 'Sideband of the mesh order',
  tooth_load: 'Largest load of a tooth',
  tooth_pressure: 'Largest pressure of a tooth',
  tooth_root_stress: 'Largest root stress of a tooth',
});
const CHOICES = /** @type {Record<string, string>} */ ({
  ga: 'plain genetic (GA)',
  fpga: 'published method (FPGA)',
  nsga2: 'Pareto front (NSGA-II)',
  'credibility-ga': 'fast (credibility GA)',
  half_normal: 'half normal',
  as_stated: 'as stated below',
  iso_class: 'a class of ISO 1328-1',
  sobol: 'Sobol points',
  latin: 'Latin hypercube',
  random: 'at random',
  factorial: 'every with every other',
  shared: 'one flank for both ends (5 variables)',
  per_end: 'a flank for each end (10 variables)',
  listed: 'variables of a list',
  unmodified: 'that of the unmodified pair',
  harmonic_balance: 'harmonic balance',
  objectives: 'transmission error, impact and vibration',
  nominal_and_robust: 'the nominal pair against the pairs as made',
  terms: 'the further terms against each other',
  percentile: 'what most of the pairs stay below',
  mean_plus_sigmas: 'mean and some standard deviations',
  peak_to_peak_um: 'transmission error, peak to peak (µm)',
  peak_to_peak_left_um: 'transmission error of the left end (µm)',
  peak_to_peak_right_um: 'transmission error of the right end (µm)',
  mean_um: 'transmission error, mean (µm)',
  order_1_um: 'transmission error, first mesh order (µm)',
  order_2_um: 'transmission error, second mesh order (µm)',
  order_3_um: 'transmission error, third mesh order (µm)',
  max_pressure_MPa: 'contact pressure (MPa)',
  max_pressure_left_MPa: 'contact pressure of the left end (MPa)',
  max_pressure_right_MPa: 'contact pressure of the right end (MPa)',
  max_line_load_N_per_mm: 'load per length of contact line (N/mm)',
  edge_load_share: 'load on tip edges, share',
  K_Hbeta: 'load over the face, K_Hβ',
  K_Halpha: 'sharing among the pairs, K_Hα',
  impact_N: 'entering impact (N)',
  rms_m_per_s2: 'vibration, RMS (m/s²)',
  dynamic_factor: 'dynamic over static mesh force',
  contact_loss: 'time without contact, share',
  root_stress_MPa: 'root stress (MPa)',
});

/** "tip_relief_start_mm" -> "Tip relief start". @param {string} key */
export function labelOf(key) {
  const name = key.replace(SUFFIX, '');
  if (NAMES[name]) return NAMES[name];
  const text = name.replaceAll('_', ' ');
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** @param {string} choice */
export function choiceText(choice) {
  return CHOICES[choice] ?? choice.replaceAll('_', ' ');
}

/**
 * Significant digits, no exponent where a person would not write one.
 * @param {number | null | undefined} value
 * @param {number} [digits]
 */
export function sig(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4)
    return value
      .toExponential(digits - 1)
      .replace('-', '−')
      .replace('e+', 'e');
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(decimals, 8)).replace('-', '−');
}

/** What a number field shows: six digits; what is not touched keeps the others. @param {unknown} value */
export function plain(value) {
  if (typeof value !== 'number' || !Number.isFinite(value)) return '';
  return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(6)));
}

/**
 * Change of a value against a reference in per cent; undefined without one.
 * @param {number | null | undefined} value
 * @param {number | null | undefined} reference
 */
export function change(value, reference) {
  if (
    typeof value !== 'number' ||
    typeof reference !== 'number' ||
    !Number.isFinite(value) ||
    !Number.isFinite(reference) ||
    reference === 0
  )
    return undefined;
  return (100 * (value - reference)) / Math.abs(reference);
}

/** "−66 %". @param {number | undefined} percent */
export function changeText(percent) {
  if (percent === undefined) return '';
  if (Math.abs(percent) < 0.05) return '±0 %';
  const text = Math.abs(percent) < 10 ? Math.abs(percent).toFixed(1) : Math.abs(percent).toFixed(0);
  return `${percent < 0 ? '−' : '+'}${text} %`;
}

/** "00:07", "1:02:03". @param {number | null | undefined} seconds */
export function duration(seconds) {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return '–';
  const whole = Math.max(0, Math.round(seconds));
  const parts = [Math.floor(whole / 60) % 60, whole % 60].map(part => String(part).padStart(2, '0'));
  return whole >= 3600 ? `${Math.floor(whole / 3600)}:${parts.join(':')}` : parts.join(':');
}

/** In a sentence: "2 s", "3 min", "1.5 h". @param {number} seconds */
export function timeText(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 1) return 'less than 1\u00a0s';
  if (seconds < 90) return `${Math.round(seconds)}\u00a0s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)}\u00a0min`;
  return `${plain(Number((seconds / 3600).toPrecision(2)))}\u00a0h`;
}

/** @param {string | null | undefined} text ISO 8601 */
export function dateText(text) {
  if (!text) return '';
  const date = new Date(text);
  return Number.isNaN(date.getTime())
    ? text
    : date.toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });
}
