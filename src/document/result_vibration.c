/* The dynamic part of a load case. */
#include <math.h>
#include <stdlib.h>
#include <stdio.h>

#include "document/result_parts.h"

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
static bool has_curves(const struct eo_result_source *source, const struct eo_case_result *c)
{
  return source->analysis->want & EO_WANT_CURVES && c->vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
}

static json_t *encode_readings(const double *value, int stride, double known)
{
  struct eo_result_object o = eo_result_open();
  for (int i = 0; i < EO_READINGS; i++)
    eo_result_put_number(&o, reading_name[i], known * value[i * stride], &eo_unit_m_per_s2);
  return eo_result_close(&o);
}

/* Lowest and highest RMS at 0.9, 1 and 1.1 times the compliance. */
static json_t *encode_band(const struct eo_case_result *c, double known)
{
  struct eo_result_object o = eo_result_open();
  for (int i = 0; i < EO_READINGS; i++) {
    double nominal = known * c->vibration.rms_pair[i], low = c->band[i][0], high = c->band[i][1], missing = low + high + nominal;
    double band[2] = {fmin(nominal, fmin(low, high)), fmax(nominal, fmax(low, high))};
    if (isnan(missing))
      band[0] = band[1] = NAN;
    eo_result_put(&o, reading_name[i], eo_json_reals(2, band, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER));
  }
  return eo_result_close(&o);
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

static json_t *encode_curves(const struct eo_result_source *source, const struct eo_end_result *r, bool orders)
{
  struct eo_result_object o = eo_result_open();
  for (int i = 0; i < EO_CHANNELS; i++)
    eo_result_put(&o, channels[i].key,
                  orders ? encode_amplitudes(source->evaluation->harmonics, &r->order[i], 1, channels[i].unit)
                         : eo_json_reals(source->evaluation->samples, r->curve[i], 1, channels[i].unit, EO_DIGITS_MAP));
  return eo_result_close(&o);
}

static json_t *encode_end(const struct eo_result_source *source, const struct eo_case_result *c, int end, double known)
{
  const struct eo_vibration *v = &c->vibration;
  struct eo_result_object o = eo_result_open();
  eo_result_put(&o, "rms_m_per_s2", encode_readings(&v->rms[0][end], 2, known));
  eo_result_put_number(&o, "dynamic_factor", known * v->dynamic_factor[end], NULL);
  eo_result_put_number(&o, "contact_loss", known * v->contact_loss[end], NULL);
  eo_result_put_number(&o, "mean_deflection_um", known * v->deflection_mean[end], &eo_unit_um);
  eo_result_put_number(&o, "peak_to_peak_deflection_um", known * v->deflection_swing[end], &eo_unit_um);
  eo_result_put_number(&o, "mean_mesh_force_N", known * v->force_mean[end], &eo_unit_N);
  eo_result_put_number(&o, "min_mesh_force_N", known * v->force_min[end], &eo_unit_N);
  eo_result_put_number(&o, "max_mesh_force_N", known * v->force_max[end], &eo_unit_N);
  for (int member = 0; member < 2; member++) {
    eo_result_put_number(&o, member ? "mean_gear_bearing_N" : "mean_pinion_bearing_N", known * v->bearing_force_mean[member][end], &eo_unit_N);
    eo_result_put_number(&o, member ? "max_gear_bearing_N" : "max_pinion_bearing_N", known * v->bearing_force_max[member][end], &eo_unit_N);
  }
  bool histories = !(source->left_out & EO_RESULT_NO_HISTORIES);
  eo_result_put(&o, "history", histories && has_curves(source, c) ? encode_curves(source, &c->end[end], false) : json_null());
  eo_result_put(&o, "orders", has_curves(source, c) ? encode_curves(source, &c->end[end], true) : json_null());
  return eo_result_close(&o);
}

/* Mean of the ends' amplitudes, as the RMS of the pair is the mean of theirs. */
static void put_pair_orders(struct eo_result_object *o, const struct eo_result_source *source, const struct eo_case_result *c)
{
  for (int i = EO_CHANNEL_NORMAL; i <= EO_CHANNEL_ROTATIONAL; i++) {
    char key[64];
    double complex *const order[2] = {c->end[0].order[i], c->end[1].order[i]};
    snprintf(key, sizeof key, "orders_%s", channels[i].key);
    eo_result_put(o, key, has_curves(source, c) ? encode_amplitudes(source->evaluation->harmonics, order, source->ends, channels[i].unit) : json_null());
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

json_t *eo_result_vibration(struct eo_result_source *source, const struct eo_case_result *c)
{
  static const char *const outcomes[] = {"converged", "contact_lost", "not_converged"};
  const struct eo_vibration *v = &c->vibration;
  struct eo_result_object o = eo_result_open();
  double known = v->outcome == EO_VIBRATION_NOT_CONVERGED ? NAN : 1;
  eo_result_put(&o, "outcome", json_string(outcomes[v->outcome]));
  eo_result_put_number(&o, "mesh_frequency_Hz", c->load_case.speed * source->pair->geometry.teeth[EO_PINION] / (2 * M_PI), &eo_unit_Hz);
  eo_result_put(&o, "rms_m_per_s2", encode_readings(v->rms_pair, 1, known));
  eo_result_put(&o, "rms_band_m_per_s2", encode_band(c, known));
  eo_result_put(&o, "rms_of_mean_m_per_s2", encode_readings(v->rms_of_mean, 1, known));
  eo_result_put_number(&o, "contact_loss", known * fmax(v->contact_loss[0], source->ends == 2 ? v->contact_loss[1] : 0), NULL);
  eo_result_put_number(&o, "dynamic_factor", known * fmax(v->dynamic_factor[0], source->ends == 2 ? v->dynamic_factor[1] : 0), NULL);
  eo_result_put(&o, "back_contact", json_boolean(v->back_contact));
  eo_result_put(&o, "position", encode_samples(source));
  put_pair_orders(&o, source, c);
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, eo_result_end[end], encode_end(source, c, end, known));
  return eo_result_close(&o);
}
