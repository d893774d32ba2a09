/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/measurement_parts.h"

#include <math.h>

#include "format/json.h"
#include "format/object.h"

static json_t *column(int count, const double *value, const struct eo_unit *unit)
{
  return eo_json_reals(count, value, 1, unit, EO_DIGITS_CURVE);
}

static const struct eo_outline_row part_rows[] = {
    EO_KEY("from_s", "number", "after the first row, s"),
    EO_KEY("to_s", "number", "after the first row, s"),
    EO_KEY("turns", "number", "of the pinion, negative: the other way"),
    EO_KEY("lowest_rpm", "number", "of whole turns of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("highest_rpm", "number", "of whole turns of the pinion", .unit = &eo_unit_rpm),
};
const struct eo_outline eo_part_outline = EO_OUTLINE("TurningPart", part_rows);

json_t *eo_part_encode(const struct eo_part *part)
{
  struct eo_object o = eo_object_open_as(&eo_part_outline);
  eo_object_put_number(&o, "from_s", part->from);
  eo_object_put_number(&o, "to_s", part->to);
  eo_object_put_number(&o, "turns", part->turns);
  eo_object_put_number(&o, "lowest_rpm", part->speed_low);
  eo_object_put_number(&o, "highest_rpm", part->speed_high);
  return eo_object_close(&o);
}

json_t *eo_parts_encode(const struct eo_parts *parts)
{
  json_t *list = json_array();
  bool failed = !list;
  for (int i = 0; i < parts->count && i < EO_PARTS; i++)
    failed = failed || json_array_append_new(list, eo_part_encode(&parts->part[i])) != 0;
  return failed ? (json_decref(list), NULL) : list;
}

static const struct eo_outline_row order_track_rows[] = {
    EO_KEY("from_s", "[number]", "start of each stretch after the first row, s"),
    EO_KEY("speed_rpm", "[number]", "of the pinion, mean of each stretch", .unit = &eo_unit_rpm),
    EO_KEY("turns", "[number]", "of the pinion in each stretch"),
    EO_KEY("rms_m_per_s2", "[number?]", "of the mesh orders at the speed of the stretch", .unit = &eo_unit_m_per_s2),
    EO_KEY("amplitude_um", "[[number?]]", "of the mesh orders, one list per stretch", .unit = &eo_unit_um),
};
const struct eo_outline eo_order_tracks_outline = EO_OUTLINE("OrderTracks", order_track_rows);

static json_t *encode_amplitudes(const struct eo_transmission *t)
{
  double amplitude[EO_MESH_ORDERS];
  json_t *list = json_array();
  bool failed = !list;
  for (int i = 0; i < t->tracks; i++) {
    for (int h = 0; h < t->harmonics; h++)
      amplitude[h] = cabs(t->track[i].amplitude[h]);
    failed = failed || json_array_append_new(list, column(t->harmonics, amplitude, &eo_unit_um)) != 0;
  }
  return failed ? (json_decref(list), NULL) : list;
}

/* Columns over the stretches. */
json_t *eo_order_tracks_encode(const struct eo_transmission *t)
{
  double from[EO_TRACKS], speed[EO_TRACKS], turns[EO_TRACKS], rms[EO_TRACKS];
  struct eo_object o = eo_object_open_as(&eo_order_tracks_outline);
  for (int i = 0; i < t->tracks; i++) {
    from[i] = t->track[i].from;
    speed[i] = t->track[i].speed;
    turns[i] = t->track[i].turns;
    rms[i] = t->track[i].rms;
  }
  eo_object_put(&o, "from_s", column(t->tracks, from, NULL));
  eo_object_put(&o, "speed_rpm", column(t->tracks, speed, &eo_unit_rpm));
  eo_object_put(&o, "turns", column(t->tracks, turns, NULL));
  eo_object_put(&o, "rms_m_per_s2", column(t->tracks, rms, &eo_unit_m_per_s2));
  eo_object_put(&o, "amplitude_um", encode_amplitudes(t));
  return eo_object_close(&o);
}

static const struct eo_outline_row axis_rows[] = {
    EO_KEY("swing_urad", "number?", "first order of the pinion's encoder that was taken out of its angle"),
    EO_KEY("noise_urad", "number?", "of a reading of the pinion's encoder, standard deviation"),
    EO_KEY("bias", "number?", "part of the RMS that both would have taken away; put right"),
};
const struct eo_outline eo_axis_outline = EO_OUTLINE("OrderAxis", axis_rows);

json_t *eo_axis_encode(const struct eo_transmission *t)
{
  struct eo_object o = eo_object_open_as(&eo_axis_outline);
  eo_object_put(&o, "swing_urad", eo_json_quantity(1e6 * t->axis_swing, NULL));
  eo_object_put(&o, "noise_urad", eo_json_quantity(1e6 * t->axis_noise, NULL));
  eo_object_put(&o, "bias", eo_json_quantity(t->axis_bias, NULL));
  return eo_object_close(&o);
}

static const struct eo_outline_row torque_column_rows[] = {
    EO_KEY("mean", "number", "over what was measured", .unit = &eo_unit_Nm),
    EO_KEY("lowest", "number", "of fiftieths of it", .unit = &eo_unit_Nm),
    EO_KEY("highest", "number", "of fiftieths of it", .unit = &eo_unit_Nm),
};
static const struct eo_outline torque_column_outline = EO_OUTLINE("TorqueColumn", torque_column_rows);

static const struct eo_outline_row speed_column_rows[] = {
    EO_KEY("mean", "number", "over what was measured", .unit = &eo_unit_rpm),
    EO_KEY("lowest", "number", "of fiftieths of it", .unit = &eo_unit_rpm),
    EO_KEY("highest", "number", "of fiftieths of it", .unit = &eo_unit_rpm),
};
static const struct eo_outline speed_column_outline = EO_OUTLINE("SpeedColumn", speed_column_rows);

static json_t *encode_load_column(const struct eo_load_column *c, const struct eo_outline *outline)
{
  if (!(c->mean > 0))
    return json_null();
  struct eo_object o = eo_object_open_as(outline);
  eo_object_put_number(&o, "mean", c->mean);
  eo_object_put_number(&o, "lowest", c->low);
  eo_object_put_number(&o, "highest", c->high);
  return eo_object_close(&o);
}

static const struct eo_outline_row load_rows[] = {
    EO_KEY("pinion_torque_Nm", "object?", "null: there is no such column", .outline = &torque_column_outline),
    EO_KEY("gear_torque_Nm", "object?", "null: there is no such column", .outline = &torque_column_outline),
    EO_KEY("pinion_speed_rpm", "object?", "null: there is no such column", .outline = &speed_column_outline),
    EO_KEY("gear_speed_rpm", "object?", "null: there is no such column", .outline = &speed_column_outline),
};
const struct eo_outline eo_load_outline = EO_OUTLINE("MeasuredLoad", load_rows);

json_t *eo_load_encode(const struct eo_load *load)
{
  struct eo_object o = eo_object_open_as(&eo_load_outline);
  eo_object_put(&o, "pinion_torque_Nm", encode_load_column(&load->torque[EO_PINION], &torque_column_outline));
  eo_object_put(&o, "gear_torque_Nm", encode_load_column(&load->torque[EO_GEAR], &torque_column_outline));
  eo_object_put(&o, "pinion_speed_rpm", encode_load_column(&load->speed[EO_PINION], &speed_column_outline));
  eo_object_put(&o, "gear_speed_rpm", encode_load_column(&load->speed[EO_GEAR], &speed_column_outline));
  return eo_object_close(&o);
}
