/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dynamic part of a load case. */
#include <math.h>
#include <stdlib.h>
#include <stdio.h>

#include "document/result_private.h"

static const char *const reading_name[EO_READINGS] = {"normal", "transverse", "rotational"};

static const struct channel {
  const char *key;
  const struct eo_unit *unit;
} channels[EO_CHANNELS] = {
    [EO_CHANNEL_DEFLECTION] = {"deflection_um", &eo_unit_um},
    [EO_CHANNEL_FORCE] = {"mesh_force_N", &eo_unit_N},
    [EO_CHANNEL_NORMAL] = {"normal_m_per_s2", &eo_unit_m_per_s2},
    [EO_CHANNEL_TRANSVERSE] = {"transverse_m_per_s2", &eo_unit_m_per_s2},
    [EO_CHANNEL_ROTATIONAL] = {"rotational_m_per_s2", &eo_unit_m_per_s2},
    [EO_CHANNEL_PINION_BEARING] = {"pinion_bearing_N", &eo_unit_N},
    [EO_CHANNEL_GEAR_BEARING] = {"gear_bearing_N", &eo_unit_N},
    [EO_CHANNEL_GEAR_THRUST] = {"gear_thrust_N", &eo_unit_N},
};

/* A periodic state was found and its curves were asked for. */
static bool has_curves(const struct eo_result_source *source, const struct eo_case_result *case_result)
{
  return source->analysis->want & EO_WANT_CURVES && case_result->vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
}

static const struct eo_outline_row reading_rows[] = {
    EO_KEY("normal", "number?", "relative acceleration along the line of action, normal to the teeth",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("transverse", "number?", "in the transverse plane", .unit = &eo_unit_m_per_s2),
    EO_KEY("rotational", "number?", "of the rotations alone: what encoders see", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline readings = EO_OUTLINE("Readings", reading_rows);

static json_t *encode_readings(const double *value, int stride, double known)
{
  struct eo_object object = eo_object_open_as(&readings);
  for (int i = 0; i < EO_READINGS; i++)
    eo_object_put_number(&object, reading_name[i], known * value[i * stride]);
  return eo_object_close(&object);
}

static const struct eo_outline_row band_rows[] = {
    EO_KEY("normal", "[number?]", "lowest, highest", .unit = &eo_unit_m_per_s2),
    EO_KEY("transverse", "[number?]", "lowest, highest", .unit = &eo_unit_m_per_s2),
    EO_KEY("rotational", "[number?]", "lowest, highest", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline bands = EO_OUTLINE("ReadingsBand", band_rows);

/* Lowest and highest RMS at 0.9, 1 and 1.1 times the compliance. */
static json_t *encode_band(const struct eo_case_result *case_result, double known)
{
  struct eo_object object = eo_object_open_as(&bands);
  for (int i = 0; i < EO_READINGS; i++) {
    double nominal = known * case_result->vibration.rms_pair[i], low = case_result->band[i][0],
           high = case_result->band[i][1], missing = low + high + nominal;
    double band[2] = {fmin(nominal, fmin(low, high)), fmax(nominal, fmax(low, high))};
    if (isnan(missing))
      band[0] = band[1] = NAN;
    eo_object_put(&object, reading_name[i], eo_json_reals(2, band, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER));
  }
  return eo_object_close(&object);
}

static json_t *encode_amplitudes(int harmonics, double complex *const order[2], int ends, const struct eo_unit *unit)
{
  double *amplitude = calloc((size_t)harmonics + 1, sizeof *amplitude);
  for (int k = 0; k <= harmonics && amplitude; k++)
    for (int end = 0; end < ends; end++)
      amplitude[k] += (k ? cabs(order[end][k]) : creal(order[end][k])) / ends;
  json_t *column = amplitude ? eo_json_reals(harmonics + 1, amplitude, 1, unit, EO_DIGITS_MAP) : NULL;
  free(amplitude);
  return column;
}

/* By channel; deflection and forces are normal. */
static const struct eo_outline_row channel_rows[] = {
    EO_KEY("deflection_um", "[number?]", "of the mesh, normal", .unit = &eo_unit_um),
    EO_KEY("mesh_force_N", "[number?]", "normal", .unit = &eo_unit_N),
    EO_KEY("normal_m_per_s2", "[number?]", "relative acceleration normal to the teeth", .unit = &eo_unit_m_per_s2),
    EO_KEY("transverse_m_per_s2", "[number?]", "in the transverse plane", .unit = &eo_unit_m_per_s2),
    EO_KEY("rotational_m_per_s2", "[number?]", "of the rotations alone", .unit = &eo_unit_m_per_s2),
    EO_KEY("pinion_bearing_N", "[number?]", "force of the pinion's bearing", .unit = &eo_unit_N),
    EO_KEY("gear_bearing_N", "[number?]", "force of the gear's bearing", .unit = &eo_unit_N),
    EO_KEY("gear_thrust_N", "[number?]", "axial force of the gear's bearing", .unit = &eo_unit_N),
};
static const struct eo_outline channel_curves = EO_OUTLINE("VibrationChannels", channel_rows);

static json_t *encode_curves(const struct eo_result_source *source, const struct eo_end_result *end_result, bool orders)
{
  struct eo_object object = eo_object_open_as(&channel_curves);
  for (int i = 0; i < EO_CHANNELS; i++)
    eo_object_put(&object, channels[i].key,
                  orders ? encode_amplitudes(source->evaluation->harmonics, &end_result->order[i], 1, channels[i].unit)
                         : eo_json_reals(source->evaluation->samples, end_result->curve[i], 1, channels[i].unit,
                                         source->map_digits));
  return eo_object_close(&object);
}

static const struct eo_outline_row end_rows[] = {
    EO_KEY("rms_m_per_s2", "object", "RMS of the accelerations", .outline = &readings),
    EO_KEY("dynamic_factor", "number?", "largest over static mesh force"),
    EO_KEY("contact_loss", "number?", "share of the mesh cycle without contact"),
    EO_KEY("mean_deflection_um", "number?", "of the mesh", .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_deflection_um", "number?", "of the mesh", .unit = &eo_unit_um),
    EO_KEY("mean_mesh_force_N", "number?", "normal", .unit = &eo_unit_N),
    EO_KEY("min_mesh_force_N", "number?", "normal", .unit = &eo_unit_N),
    EO_KEY("max_mesh_force_N", "number?", "normal", .unit = &eo_unit_N),
    EO_KEY("mean_pinion_bearing_N", "number?", "force of the pinion's bearing", .unit = &eo_unit_N),
    EO_KEY("max_pinion_bearing_N", "number?", "force of the pinion's bearing", .unit = &eo_unit_N),
    EO_KEY("mean_gear_bearing_N", "number?", "force of the gear's bearing", .unit = &eo_unit_N),
    EO_KEY("max_gear_bearing_N", "number?", "force of the gear's bearing", .unit = &eo_unit_N),
    EO_KEY("history", "object?", "over `position` of the vibration; null without histories or a periodic state",
           .outline = &channel_curves),
    EO_KEY("orders", "object?",
           "the mean, then the amplitudes of the mesh harmonics 1, 2, ...; null without a periodic state",
           .outline = &channel_curves),
};
static const struct eo_outline vibration_end = EO_OUTLINE("VibrationEnd", end_rows);

static json_t *encode_end(const struct eo_result_source *source, const struct eo_case_result *case_result, int end,
                          double known)
{
  const struct eo_vibration *vibration = &case_result->vibration;
  struct eo_object object = eo_object_open_as(&vibration_end);
  eo_object_put(&object, "rms_m_per_s2", encode_readings(&vibration->rms[0][end], 2, known));
  eo_object_put_number(&object, "dynamic_factor", known * vibration->dynamic_factor[end]);
  eo_object_put_number(&object, "contact_loss", known * vibration->contact_loss[end]);
  eo_object_put_number(&object, "mean_deflection_um", known * vibration->deflection_mean[end]);
  eo_object_put_number(&object, "peak_to_peak_deflection_um", known * vibration->deflection_swing[end]);
  eo_object_put_number(&object, "mean_mesh_force_N", known * vibration->force_mean[end]);
  eo_object_put_number(&object, "min_mesh_force_N", known * vibration->force_min[end]);
  eo_object_put_number(&object, "max_mesh_force_N", known * vibration->force_max[end]);
  for (int member = 0; member < 2; member++) {
    eo_object_put_number(&object, member ? "mean_gear_bearing_N" : "mean_pinion_bearing_N",
                         known * vibration->bearing_force_mean[member][end]);
    eo_object_put_number(&object, member ? "max_gear_bearing_N" : "max_pinion_bearing_N",
                         known * vibration->bearing_force_max[member][end]);
  }
  bool histories = has_curves(source, case_result) && eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result);
  bool orders = has_curves(source, case_result) && eo_result_has(source, EO_RESULT_NO_END_ORDERS, case_result);
  eo_object_put(&object, "history", histories ? encode_curves(source, &case_result->end[end], false) : json_null());
  eo_object_put(&object, "orders", orders ? encode_curves(source, &case_result->end[end], true) : json_null());
  return eo_object_close(&object);
}

/* Mean of the ends' amplitudes, as the RMS of the pair is the mean of theirs. */
static void put_pair_orders(struct eo_object *object, const struct eo_result_source *source,
                            const struct eo_case_result *case_result)
{
  bool wanted = has_curves(source, case_result) && eo_result_has_overview(source, EO_RESULT_NO_ORDERS, case_result);
  for (int i = EO_CHANNEL_NORMAL; i <= EO_CHANNEL_ROTATIONAL; i++) {
    char key[64];
    double complex *const order[2] = {case_result->end[0].order[i], case_result->end[1].order[i]};
    snprintf(key, sizeof key, "orders_%s", channels[i].key);
    eo_object_put(object, key,
                  wanted ? encode_amplitudes(source->evaluation->harmonics, order, source->ends, channels[i].unit)
                         : json_null());
  }
}

static json_t *encode_samples(const struct eo_result_source *source)
{
  int n = source->evaluation->samples;
  double *position = malloc(sizeof *position * (size_t)n);
  for (int i = 0; i < n && position; i++)
    position[i] = (double)i / n;
  json_t *column = position ? eo_json_reals(n, position, 1, NULL, EO_DIGITS_CURVE) : NULL;
  free(position);
  return column;
}

static const char *const outcomes[] = {"converged", "contact_lost", "not_converged", NULL};

static const struct eo_outline_row state_rows[] = {
    EO_KEY("mesh_periods", "integer", "after which the motion repeats, 1 to 4"),
    EO_KEY("rms_m_per_s2", "object", "RMS of the pair", .outline = &readings),
    EO_KEY("contact_loss", "number", "share of the mesh cycle without contact, worse end"),
    EO_KEY("floquet_multiplier", "number?",
           "size of the largest: what becomes of a small disturbance over one mesh period; null where the motion takes "
           "more "
           "than one"),
};
static const struct eo_outline vibration_state = EO_OUTLINE("VibrationState", state_rows);

static json_t *encode_states(const struct eo_vibration *vibration)
{
  json_t *array = json_array();
  for (int i = 0; i < vibration->states; i++) {
    const struct eo_vibration_state *this_state = &vibration->state[i];
    struct eo_object object = eo_object_open_as(&vibration_state);
    eo_object_put(&object, "mesh_periods", json_integer(this_state->repeat));
    eo_object_put(&object, "rms_m_per_s2", encode_readings(this_state->rms, 1, 1));
    eo_object_put_number(&object, "contact_loss", this_state->contact_loss);
    eo_object_put_number(&object, "floquet_multiplier", this_state->multiplier);
    json_array_append_new(array, eo_object_close(&object));
  }
  return array;
}

static const struct eo_outline_row vibration_rows[] = {
    EO_KEY(
        "outcome", "word",
        "contact_lost: teeth separate; not_converged: no stable periodic state was found, and what hangs on it is null",
        .words = outcomes),
    EO_KEY("mesh_periods", "integer?",
           "after which the motion repeats: 1, up to 4 where teeth separate; null without a state"),
    EO_KEY("floquet_multiplier", "number?",
           "size of the largest, below 1: stable; null without a state, or where the motion takes more than one mesh "
           "period"),
    EO_KEY("unstable_multiplier", "number?",
           "of a periodic state that was left because a disturbance of it grows; null: there was none"),
    EO_KEY("stable_states", "[object]",
           "found from several starts where contact is lost, the loudest first: the numbers here and f3 are its own",
           .outline = &vibration_state),
    EO_KEY("rms_range_m_per_s2", "[number?]", "lowest and highest normal RMS of the stable states",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("mesh_frequency_Hz", "number", "teeth per second", .unit = &eo_unit_Hz),
    EO_KEY("rms_m_per_s2", "object", "RMS of the pair: mean of the ends' RMS", .outline = &readings),
    EO_KEY("rms_band_m_per_s2", "object",
           "at 0.9 to 1.1 times the compliance; numbers null when the band was not asked for", .outline = &bands),
    EO_KEY("rms_of_mean_m_per_s2", "object", "RMS of the mean of the ends", .outline = &readings),
    EO_KEY("contact_loss", "number?", "share of the mesh cycle without contact, worse end"),
    EO_KEY("dynamic_factor", "number?", "largest over static mesh force, worse end"),
    EO_KEY("back_contact", "flag", "the back flanks touch"),
    EO_KEY("mean_pinion_thrust_N", "number?", "of the pinion's axial support, + to the right; 0: floating",
           .unit = &eo_unit_N),
    EO_KEY("max_pinion_thrust_N", "number?", "largest size of it", .unit = &eo_unit_N),
    EO_KEY("position", "[number]?", "phase of the mesh cycle, 0..1, of the histories; null without them"),
    EO_KEY("orders_normal_m_per_s2", "[number?]?",
           "mean of the ends' amplitudes: the mean, then mesh harmonics 1, 2, ...; null without a periodic state",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("orders_transverse_m_per_s2", "[number?]?", "the same of the transverse acceleration",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("orders_rotational_m_per_s2", "[number?]?", "the same of the rotational acceleration",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("left", "object", "left end", .outline = &vibration_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &vibration_end),
};
const struct eo_outline eo_outline_vibration = EO_OUTLINE("Vibration", vibration_rows);

json_t *eo_result_vibration(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  const struct eo_vibration *vibration = &case_result->vibration;
  struct eo_object object = eo_object_open_as(&eo_outline_vibration);
  double known = vibration->outcome == EO_VIBRATION_NOT_CONVERGED ? NAN : 1;
  eo_object_put(&object, "outcome", json_string(outcomes[vibration->outcome]));
  eo_object_put(&object, "mesh_periods", isnan(known) ? json_null() : json_integer(vibration->repeat));
  eo_object_put_number(&object, "floquet_multiplier", known * vibration->multiplier);
  eo_object_put_number(&object, "unstable_multiplier", vibration->unstable > 0 ? vibration->unstable : NAN);
  eo_object_put(&object, "stable_states", encode_states(vibration));
  double range[2] = {NAN, NAN};
  if (vibration->states > 0) {
    range[0] = vibration->state[vibration->states - 1].rms[EO_READING_NORMAL];
    range[1] = vibration->state[0].rms[EO_READING_NORMAL];
  }
  eo_object_put(&object, "rms_range_m_per_s2", eo_json_reals(2, range, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER));
  eo_object_put_number(&object, "mesh_frequency_Hz",
                       case_result->load_case.speed * source->pair->geometry.teeth[EO_PINION] / (2 * M_PI));
  eo_object_put(&object, "rms_m_per_s2", encode_readings(vibration->rms_pair, 1, known));
  eo_object_put(&object, "rms_band_m_per_s2", encode_band(case_result, known));
  eo_object_put(&object, "rms_of_mean_m_per_s2", encode_readings(vibration->rms_of_mean, 1, known));
  eo_object_put_number(&object, "contact_loss",
                       known * fmax(vibration->contact_loss[0], source->ends == 2 ? vibration->contact_loss[1] : 0));
  eo_object_put_number(&object, "dynamic_factor",
                       known *
                           fmax(vibration->dynamic_factor[0], source->ends == 2 ? vibration->dynamic_factor[1] : 0));
  eo_object_put(&object, "back_contact", json_boolean(vibration->back_contact));
  eo_object_put_number(&object, "mean_pinion_thrust_N", known * vibration->pinion_thrust_mean);
  eo_object_put_number(&object, "max_pinion_thrust_N", known * vibration->pinion_thrust_max);
  eo_object_put(&object, "position",
                eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result) ? encode_samples(source) : json_null());
  put_pair_orders(&object, source, case_result);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_end(source, case_result, end, known));
  return eo_object_close(&object);
}
