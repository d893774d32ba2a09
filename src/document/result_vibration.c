/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dynamic part of a load case. */
#include <math.h>
#include <stdlib.h>

#include "document/result_private.h"

/* A periodic state was found and its curves were asked for. */
static bool has_curves(const struct eo_result_source *source, const struct eo_case_result *case_result)
{
  return source->analysis->want & EO_WANT_CURVES && case_result->vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
}

struct readings {
  double value[EO_READINGS];
};

static const struct eo_outline_row reading_rows[] = {
    EO_KEY("normal", "number?", "relative acceleration along the line of action, normal to the teeth",
           .unit = &eo_unit_m_per_s2, EO_AT(struct readings, value[EO_READING_NORMAL])),
    EO_KEY("transverse", "number?", "in the transverse plane", .unit = &eo_unit_m_per_s2,
           EO_AT(struct readings, value[EO_READING_TRANSVERSE])),
    EO_KEY("rotational", "number?", "of the rotations alone: what encoders see", .unit = &eo_unit_m_per_s2,
           EO_AT(struct readings, value[EO_READING_ROTATIONAL])),
};
static const struct eo_outline readings = EO_OUTLINE("Readings", reading_rows);

/* known: 1, or NaN where they mean nothing. */
static struct readings find_readings(const double *value, int stride, double known)
{
  struct readings found;
  for (int i = 0; i < EO_READINGS; i++)
    found.value[i] = known * value[i * stride];
  return found;
}

/* Lowest and highest of each reading. */
struct reading_bands {
  double limit[EO_READINGS][2];
  struct eo_series band[EO_READINGS];
};

static const struct eo_outline_row band_rows[] = {
    EO_KEY("normal", "[number?]", "lowest, highest", .unit = &eo_unit_m_per_s2,
           EO_AT(struct reading_bands, band[EO_READING_NORMAL])),
    EO_KEY("transverse", "[number?]", "lowest, highest", .unit = &eo_unit_m_per_s2,
           EO_AT(struct reading_bands, band[EO_READING_TRANSVERSE])),
    EO_KEY("rotational", "[number?]", "lowest, highest", .unit = &eo_unit_m_per_s2,
           EO_AT(struct reading_bands, band[EO_READING_ROTATIONAL])),
};
static const struct eo_outline bands = EO_OUTLINE("ReadingsBand", band_rows);

/* Lowest and highest RMS at 0.9, 1 and 1.1 times the compliance. */
static void find_band(const struct eo_case_result *case_result, double known, struct reading_bands *bands_found)
{
  for (int i = 0; i < EO_READINGS; i++) {
    double nominal = known * case_result->vibration.rms_pair[i], low = case_result->band[i][0],
           high = case_result->band[i][1];
    bool missing = isnan(low + high + nominal);
    bands_found->limit[i][0] = missing ? NAN : fmin(nominal, fmin(low, high));
    bands_found->limit[i][1] = missing ? NAN : fmax(nominal, fmax(low, high));
    bands_found->band[i] = eo_series_of(2, bands_found->limit[i], EO_DIGITS_NUMBER);
  }
}

/* Mean of the ends' amplitudes of a channel: the mean, then mesh harmonics 1, 2, ... */
static void find_amplitudes(int harmonics, double complex *const order[2], int ends, double *amplitude)
{
  for (int k = 0; k <= harmonics; k++) {
    amplitude[k] = 0;
    for (int end = 0; end < ends; end++)
      amplitude[k] += (k ? cabs(order[end][k]) : creal(order[end][k])) / ends;
  }
}

/* By channel; deflection and forces are normal. */
struct channels {
  struct eo_series curve[EO_CHANNELS];
};

#define OF_CHANNEL(name) EO_AT(struct channels, curve[EO_CHANNEL_##name])
static const struct eo_outline_row channel_rows[] = {
    EO_KEY("deflection_um", "[number?]", "of the mesh, normal", .unit = &eo_unit_um, OF_CHANNEL(DEFLECTION)),
    EO_KEY("mesh_force_N", "[number?]", "normal", .unit = &eo_unit_N, OF_CHANNEL(FORCE)),
    EO_KEY("normal_m_per_s2", "[number?]", "relative acceleration normal to the teeth", .unit = &eo_unit_m_per_s2,
           OF_CHANNEL(NORMAL)),
    EO_KEY("transverse_m_per_s2", "[number?]", "in the transverse plane", .unit = &eo_unit_m_per_s2,
           OF_CHANNEL(TRANSVERSE)),
    EO_KEY("rotational_m_per_s2", "[number?]", "of the rotations alone", .unit = &eo_unit_m_per_s2,
           OF_CHANNEL(ROTATIONAL)),
    EO_KEY("pinion_bearing_N", "[number?]", "force of the pinion's bearing", .unit = &eo_unit_N,
           OF_CHANNEL(PINION_BEARING)),
    EO_KEY("gear_bearing_N", "[number?]", "force of the gear's bearing", .unit = &eo_unit_N, OF_CHANNEL(GEAR_BEARING)),
    EO_KEY("gear_thrust_N", "[number?]", "axial force of the gear's bearing", .unit = &eo_unit_N,
           OF_CHANNEL(GEAR_THRUST)),
};
static const struct eo_outline channel_curves = EO_OUTLINE("VibrationChannels", channel_rows);

static json_t *encode_histories(const struct eo_result_source *source, const struct eo_end_result *end_result)
{
  struct channels view;
  for (int i = 0; i < EO_CHANNELS; i++)
    view.curve[i] = eo_series_of(source->evaluation->samples, end_result->curve[i], source->map_digits);
  return eo_outline_encode(&channel_curves, &view);
}

static json_t *encode_orders(const struct eo_result_source *source, const struct eo_end_result *end_result)
{
  int harmonics = source->evaluation->harmonics;
  double *amplitude = malloc(sizeof *amplitude * EO_CHANNELS * ((size_t)harmonics + 1));
  struct channels view;
  if (!amplitude)
    return NULL;
  for (int i = 0; i < EO_CHANNELS; i++) {
    double *own = amplitude + (size_t)i * ((size_t)harmonics + 1);
    find_amplitudes(harmonics, &end_result->order[i], 1, own);
    view.curve[i] = eo_series_of(harmonics + 1, own, EO_DIGITS_MAP | source->ready);
  }
  json_t *encoded = eo_outline_encode(&channel_curves, &view);
  free(amplitude);
  return encoded;
}

struct vibration_end {
  struct readings rms;
  double factor, loss, deflection, deflection_swing, force, least_force, most_force;
  double bearing[2], most_bearing[2];
  json_t *history, *orders;
};

#define OF_END(name) EO_AT(struct vibration_end, name)
static const struct eo_outline_row end_rows[] = {
    EO_KEY("rms_m_per_s2", "object", "RMS of the accelerations", .outline = &readings, OF_END(rms)),
    EO_KEY("dynamic_factor", "number?", "largest over static mesh force", OF_END(factor)),
    EO_KEY("contact_loss", "number?", "share of the mesh cycle without contact", OF_END(loss)),
    EO_KEY("mean_deflection_um", "number?", "of the mesh", .unit = &eo_unit_um, OF_END(deflection)),
    EO_KEY("peak_to_peak_deflection_um", "number?", "of the mesh", .unit = &eo_unit_um, OF_END(deflection_swing)),
    EO_KEY("mean_mesh_force_N", "number?", "normal", .unit = &eo_unit_N, OF_END(force)),
    EO_KEY("min_mesh_force_N", "number?", "normal", .unit = &eo_unit_N, OF_END(least_force)),
    EO_KEY("max_mesh_force_N", "number?", "normal", .unit = &eo_unit_N, OF_END(most_force)),
    EO_KEY("mean_pinion_bearing_N", "number?", "force of the pinion's bearing", .unit = &eo_unit_N,
           OF_END(bearing[EO_PINION])),
    EO_KEY("max_pinion_bearing_N", "number?", "force of the pinion's bearing", .unit = &eo_unit_N,
           OF_END(most_bearing[EO_PINION])),
    EO_KEY("mean_gear_bearing_N", "number?", "force of the gear's bearing", .unit = &eo_unit_N,
           OF_END(bearing[EO_GEAR])),
    EO_KEY("max_gear_bearing_N", "number?", "force of the gear's bearing", .unit = &eo_unit_N,
           OF_END(most_bearing[EO_GEAR])),
    EO_KEY("history", "object?", "over `position` of the vibration; null without histories or a periodic state",
           .outline = &channel_curves, OF_END(history)),
    EO_KEY("orders", "object?",
           "the mean, then the amplitudes of the mesh harmonics 1, 2, ...; null without a periodic state",
           .outline = &channel_curves, OF_END(orders)),
};
static const struct eo_outline vibration_end = EO_OUTLINE("VibrationEnd", end_rows);

static json_t *encode_end(const struct eo_result_source *source, const struct eo_case_result *case_result, int end,
                          double known)
{
  const struct eo_vibration *vibration = &case_result->vibration;
  bool curves = has_curves(source, case_result);
  bool histories = curves && eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result);
  bool orders = curves && eo_result_has(source, EO_RESULT_NO_END_ORDERS, case_result);
  struct vibration_end view = {
      .rms = find_readings(&vibration->rms[0][end], 2, known),
      .factor = known * vibration->dynamic_factor[end],
      .loss = known * vibration->contact_loss[end],
      .deflection = known * vibration->deflection_mean[end],
      .deflection_swing = known * vibration->deflection_swing[end],
      .force = known * vibration->force_mean[end],
      .least_force = known * vibration->force_min[end],
      .most_force = known * vibration->force_max[end],
      .history = histories ? encode_histories(source, &case_result->end[end]) : json_null(),
      .orders = orders ? encode_orders(source, &case_result->end[end]) : json_null(),
  };
  for (int member = 0; member < 2; member++) {
    view.bearing[member] = known * vibration->bearing_force_mean[member][end];
    view.most_bearing[member] = known * vibration->bearing_force_max[member][end];
  }
  return eo_outline_encode(&vibration_end, &view);
}

/* Mean of the ends' amplitudes, as the RMS of the pair is the mean of theirs. */
static json_t *encode_pair_orders(const struct eo_result_source *source, const struct eo_case_result *case_result,
                                  int channel)
{
  int harmonics = source->evaluation->harmonics;
  double complex *const order[2] = {case_result->end[0].order[channel], case_result->end[1].order[channel]};
  if (!has_curves(source, case_result) || !eo_result_has_overview(source, EO_RESULT_NO_ORDERS, case_result))
    return json_null();
  double *amplitude = malloc(sizeof *amplitude * ((size_t)harmonics + 1));
  if (!amplitude)
    return NULL;
  find_amplitudes(harmonics, order, source->ends, amplitude);
  json_t *column = eo_json_reals(harmonics + 1, amplitude, 1, &eo_unit_m_per_s2, EO_DIGITS_MAP | source->ready);
  free(amplitude);
  return column;
}

static json_t *encode_samples(const struct eo_result_source *source)
{
  int n = source->evaluation->samples;
  double *position = malloc(sizeof *position * (size_t)n);
  for (int i = 0; i < n && position; i++)
    position[i] = (double)i / n;
  json_t *column = position ? eo_json_reals(n, position, 1, NULL, EO_DIGITS_CURVE | source->ready) : NULL;
  free(position);
  return column;
}

static const char *const outcomes[] = {"converged", "contact_lost", "not_converged", NULL};

struct state {
  int repeat;
  struct readings rms;
  double loss, multiplier;
};

static const struct eo_outline_row state_rows[] = {
    EO_KEY("mesh_periods", "integer", "after which the motion repeats, 1 to 4", EO_AT(struct state, repeat)),
    EO_KEY("rms_m_per_s2", "object", "RMS of the pair", .outline = &readings, EO_AT(struct state, rms)),
    EO_KEY("contact_loss", "number", "share of the mesh cycle without contact, worse end", EO_AT(struct state, loss)),
    EO_KEY("floquet_multiplier", "number?",
           "size of the largest: what becomes of a small disturbance over one mesh period; null where the motion takes "
           "more "
           "than one",
           EO_AT(struct state, multiplier)),
};
static const struct eo_outline vibration_state = EO_OUTLINE("VibrationState", state_rows);

static json_t *encode_states(const struct eo_vibration *vibration)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < vibration->states; i++) {
    const struct eo_vibration_state *found = &vibration->state[i];
    const struct state view = {found->repeat, find_readings(found->rms, 1, 1), found->contact_loss, found->multiplier};
    eo_list_add(&list, eo_outline_encode(&vibration_state, &view));
  }
  return eo_object_close(&list);
}

/* What a load case says about its vibration. */
struct vibration {
  bool two, back_contact;
  int outcome;
  double repeat, multiplier, unstable, frequency, loss, factor, thrust, most_thrust, range_limit[2];
  struct readings rms, rms_of_mean;
  struct reading_bands band;
  struct eo_series range;
  json_t *states, *position, *orders[EO_CHANNELS], *end[2];
};

#define OF_VIBRATION(name) EO_AT(struct vibration, name)
static const struct eo_outline_row vibration_rows[] = {
    EO_KEY(
        "outcome", "word",
        "contact_lost: teeth separate; not_converged: no stable periodic state was found, and what hangs on it is null",
        .words = outcomes, OF_VIBRATION(outcome)),
    EO_KEY("mesh_periods", "integer?",
           "after which the motion repeats: 1, up to 4 where teeth separate; null without a state",
           OF_VIBRATION(repeat)),
    EO_KEY("floquet_multiplier", "number?",
           "size of the largest, below 1: stable; null without a state, or where the motion takes more than one mesh "
           "period",
           OF_VIBRATION(multiplier)),
    EO_KEY("unstable_multiplier", "number?",
           "of a periodic state that was left because a disturbance of it grows; null: there was none",
           OF_VIBRATION(unstable)),
    EO_KEY("stable_states", "[object]",
           "found from several starts where contact is lost, the loudest first: the numbers here and f3 are its own",
           .outline = &vibration_state, OF_VIBRATION(states)),
    EO_KEY("rms_range_m_per_s2", "[number?]", "lowest and highest normal RMS of the stable states",
           .unit = &eo_unit_m_per_s2, OF_VIBRATION(range)),
    EO_KEY("mesh_frequency_Hz", "number", "teeth per second", .unit = &eo_unit_Hz, OF_VIBRATION(frequency)),
    EO_KEY("rms_m_per_s2", "object", "RMS of the pair: mean of the ends' RMS", .outline = &readings, OF_VIBRATION(rms)),
    EO_KEY("rms_band_m_per_s2", "object",
           "at 0.9 to 1.1 times the compliance; numbers null when the band was not asked for", .outline = &bands,
           OF_VIBRATION(band)),
    EO_KEY("rms_of_mean_m_per_s2", "object", "RMS of the mean of the ends", .outline = &readings,
           OF_VIBRATION(rms_of_mean)),
    EO_KEY("contact_loss", "number?", "share of the mesh cycle without contact, worse end", OF_VIBRATION(loss)),
    EO_KEY("dynamic_factor", "number?", "largest over static mesh force, worse end", OF_VIBRATION(factor)),
    EO_KEY("back_contact", "flag", "the back flanks touch", OF_VIBRATION(back_contact)),
    EO_KEY("mean_pinion_thrust_N", "number?", "of the pinion's axial support, + to the right; 0: floating",
           .unit = &eo_unit_N, OF_VIBRATION(thrust)),
    EO_KEY("max_pinion_thrust_N", "number?", "largest size of it", .unit = &eo_unit_N, OF_VIBRATION(most_thrust)),
    EO_KEY("position", "[number]?", "phase of the mesh cycle, 0..1, of the histories; null without them",
           OF_VIBRATION(position)),
    EO_KEY("orders_normal_m_per_s2", "[number?]?",
           "mean of the ends' amplitudes: the mean, then mesh harmonics 1, 2, ...; null without a periodic state",
           .unit = &eo_unit_m_per_s2, OF_VIBRATION(orders[EO_CHANNEL_NORMAL])),
    EO_KEY("orders_transverse_m_per_s2", "[number?]?", "the same of the transverse acceleration",
           .unit = &eo_unit_m_per_s2, OF_VIBRATION(orders[EO_CHANNEL_TRANSVERSE])),
    EO_KEY("orders_rotational_m_per_s2", "[number?]?", "the same of the rotational acceleration",
           .unit = &eo_unit_m_per_s2, OF_VIBRATION(orders[EO_CHANNEL_ROTATIONAL])),
    EO_KEY("left", "object", "left end", .outline = &vibration_end, OF_VIBRATION(end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &vibration_end, OF_VIBRATION(end[EO_RIGHT]),
           EO_IF(struct vibration, two)),
};
const struct eo_outline eo_outline_vibration = EO_OUTLINE("Vibration", vibration_rows);

/* Lowest and highest of the stable states, the loudest of which is the first. */
static void find_range(const struct eo_vibration *vibration, struct vibration *view)
{
  bool found = vibration->states > 0;
  view->range_limit[0] = found ? vibration->state[vibration->states - 1].rms[EO_READING_NORMAL] : NAN;
  view->range_limit[1] = found ? vibration->state[0].rms[EO_READING_NORMAL] : NAN;
  view->range = eo_series_of(2, view->range_limit, EO_DIGITS_NUMBER);
}

static double worse_end(const struct eo_result_source *source, const double value[2])
{
  return fmax(value[0], source->ends == 2 ? value[1] : 0);
}

json_t *eo_result_vibration(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  const struct eo_vibration *vibration = &case_result->vibration;
  bool histories = eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result);
  double known = vibration->outcome == EO_VIBRATION_NOT_CONVERGED ? NAN : 1,
         pitches = case_result->load_case.speed * source->pair->geometry.teeth[EO_PINION];
  struct vibration view = {
      .two = source->ends == 2,
      .back_contact = vibration->back_contact,
      .outcome = (int)vibration->outcome,
      .repeat = known * vibration->repeat,
      .multiplier = known * vibration->multiplier,
      .unstable = vibration->unstable > 0 ? vibration->unstable : NAN,
      .frequency = pitches / (2 * M_PI),
      .loss = known * worse_end(source, vibration->contact_loss),
      .factor = known * worse_end(source, vibration->dynamic_factor),
      .thrust = known * vibration->pinion_thrust_mean,
      .most_thrust = known * vibration->pinion_thrust_max,
      .rms = find_readings(vibration->rms_pair, 1, known),
      .rms_of_mean = find_readings(vibration->rms_of_mean, 1, known),
      .states = encode_states(vibration),
      .position = histories ? encode_samples(source) : json_null(),
  };
  find_range(vibration, &view);
  find_band(case_result, known, &view.band);
  for (int i = EO_CHANNEL_NORMAL; i <= EO_CHANNEL_ROTATIONAL; i++)
    view.orders[i] = encode_pair_orders(source, case_result, i);
  for (int end = 0; end < source->ends; end++)
    view.end[end] = encode_end(source, case_result, end, known);
  return eo_outline_encode(&eo_outline_vibration, &view);
}
