/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/measurement_parts.h"

#include <math.h>
#include <string.h>

#include "format/json.h"
#include "format/object.h"

static const struct eo_outline_row part_rows[] = {
    EO_KEY("from_s", "number", "after the first row, s", EO_AT(struct eo_part, from)),
    EO_KEY("to_s", "number", "after the first row, s", EO_AT(struct eo_part, to)),
    EO_KEY("turns", "number", "of the pinion, negative: the other way", EO_AT(struct eo_part, turns)),
    EO_KEY("lowest_rpm", "number", "of whole turns of the pinion", .unit = &eo_unit_rpm,
           EO_AT(struct eo_part, speed_low)),
    EO_KEY("highest_rpm", "number", "of whole turns of the pinion", .unit = &eo_unit_rpm,
           EO_AT(struct eo_part, speed_high)),
};
const struct eo_outline eo_part_outline = EO_OUTLINE("TurningPart", part_rows);

json_t *eo_parts_encode(const struct eo_parts *parts)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < parts->count && i < EO_PARTS; i++)
    eo_list_add(&list, eo_outline_encode(&eo_part_outline, &parts->part[i]));
  return eo_object_close(&list);
}

/* One number of every stretch; offset: where it lies in one. */
static json_t *track_column(const struct eo_transmission *transmission, size_t offset, const struct eo_unit *unit)
{
  double value[EO_TRACKS];
  for (int i = 0; i < transmission->tracks; i++)
    memcpy(&value[i], (const char *)&transmission->track[i] + offset, sizeof value[i]);
  return eo_json_reals(transmission->tracks, value, 1, unit, EO_DIGITS_CURVE);
}

static json_t *write_track_from(const void *t)
{
  return track_column(t, offsetof(struct eo_order_track, from), NULL);
}

static json_t *write_track_speed(const void *t)
{
  return track_column(t, offsetof(struct eo_order_track, speed), &eo_unit_rpm);
}

static json_t *write_track_turns(const void *t)
{
  return track_column(t, offsetof(struct eo_order_track, turns), NULL);
}

static json_t *write_track_rms(const void *t)
{
  return track_column(t, offsetof(struct eo_order_track, rms), &eo_unit_m_per_s2);
}

static json_t *write_track_amplitudes(const void *source)
{
  const struct eo_transmission *transmission = source;
  double amplitude[EO_MESH_ORDERS];
  struct eo_object list = eo_list_open();
  for (int i = 0; i < transmission->tracks; i++) {
    for (int h = 0; h < transmission->harmonics; h++)
      amplitude[h] = cabs(transmission->track[i].amplitude[h]);
    json_t *orders = eo_json_reals(transmission->harmonics, amplitude, 1, &eo_unit_um, EO_DIGITS_CURVE);
    eo_list_add(&list, orders);
  }
  return eo_object_close(&list);
}

/* Columns over the stretches. */
static const struct eo_outline_row order_track_rows[] = {
    EO_KEY("from_s", "[number]", "start of each stretch after the first row, s", .write = write_track_from),
    EO_KEY("speed_rpm", "[number]", "of the pinion, mean of each stretch", .unit = &eo_unit_rpm,
           .write = write_track_speed),
    EO_KEY("turns", "[number]", "of the pinion in each stretch", .write = write_track_turns),
    EO_KEY("rms_m_per_s2", "[number?]", "of the mesh orders at the speed of the stretch", .unit = &eo_unit_m_per_s2,
           .write = write_track_rms),
    EO_KEY("amplitude_um", "[[number?]]", "of the mesh orders, one list per stretch", .unit = &eo_unit_um,
           .write = write_track_amplitudes),
};
const struct eo_outline eo_order_tracks_outline = EO_OUTLINE("OrderTracks", order_track_rows);

static const struct eo_outline_row axis_rows[] = {
    EO_KEY("swing_urad", "number?", "first order of the pinion's encoder that was taken out of its angle",
           .unit = &eo_unit_urad, EO_AT(struct eo_transmission, axis_swing)),
    EO_KEY("noise_urad", "number?", "of a reading of the pinion's encoder, standard deviation", .unit = &eo_unit_urad,
           EO_AT(struct eo_transmission, axis_noise)),
    EO_KEY("bias", "number?", "part of the RMS that both would have taken away; put right",
           EO_AT(struct eo_transmission, axis_bias)),
};
const struct eo_outline eo_axis_outline = EO_OUTLINE("OrderAxis", axis_rows);

static const struct eo_outline_row torque_column_rows[] = {
    EO_KEY("mean", "number", "over what was measured", .unit = &eo_unit_Nm, EO_AT(struct eo_load_column, mean)),
    EO_KEY("lowest", "number", "of fiftieths of it", .unit = &eo_unit_Nm, EO_AT(struct eo_load_column, low)),
    EO_KEY("highest", "number", "of fiftieths of it", .unit = &eo_unit_Nm, EO_AT(struct eo_load_column, high)),
};
static const struct eo_outline torque_column_outline = EO_OUTLINE("TorqueColumn", torque_column_rows);

static const struct eo_outline_row speed_column_rows[] = {
    EO_KEY("mean", "number", "over what was measured", .unit = &eo_unit_rpm, EO_AT(struct eo_load_column, mean)),
    EO_KEY("lowest", "number", "of fiftieths of it", .unit = &eo_unit_rpm, EO_AT(struct eo_load_column, low)),
    EO_KEY("highest", "number", "of fiftieths of it", .unit = &eo_unit_rpm, EO_AT(struct eo_load_column, high)),
};
static const struct eo_outline speed_column_outline = EO_OUTLINE("SpeedColumn", speed_column_rows);

/* A column that is not there, or shows nothing, is null. */
static json_t *write_load_column(const struct eo_load_column *column, const struct eo_outline *outline)
{
  return column->mean > 0 ? eo_outline_encode(outline, column) : json_null();
}

static json_t *write_pinion_torque(const void *load)
{
  return write_load_column(&((const struct eo_load *)load)->torque[EO_PINION], &torque_column_outline);
}

static json_t *write_gear_torque(const void *load)
{
  return write_load_column(&((const struct eo_load *)load)->torque[EO_GEAR], &torque_column_outline);
}

static json_t *write_pinion_speed(const void *load)
{
  return write_load_column(&((const struct eo_load *)load)->speed[EO_PINION], &speed_column_outline);
}

static json_t *write_gear_speed(const void *load)
{
  return write_load_column(&((const struct eo_load *)load)->speed[EO_GEAR], &speed_column_outline);
}

static const struct eo_outline_row load_rows[] = {
    EO_KEY("pinion_torque_Nm", "object?", "null: there is no such column", .outline = &torque_column_outline,
           .write = write_pinion_torque),
    EO_KEY("gear_torque_Nm", "object?", "null: there is no such column", .outline = &torque_column_outline,
           .write = write_gear_torque),
    EO_KEY("pinion_speed_rpm", "object?", "null: there is no such column", .outline = &speed_column_outline,
           .write = write_pinion_speed),
    EO_KEY("gear_speed_rpm", "object?", "null: there is no such column", .outline = &speed_column_outline,
           .write = write_gear_speed),
};
const struct eo_outline eo_load_outline = EO_OUTLINE("MeasuredLoad", load_rows);
