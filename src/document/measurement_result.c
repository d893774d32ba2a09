/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result of a measurement: orders, curves, spectrum, parts, as they stand in its document. */
#include "document/measurement_parts.h"

#include <math.h>

#include "format/json.h"
#include "format/object.h"
#include "gear/names.h"

enum { CURVE = 128, SPECTRUM_POINTS = 2000 };

static json_t *column(int count, const double *value, const struct eo_unit *unit)
{
  return eo_json_reals(count, value, 1, unit, EO_DIGITS_CURVE);
}

/* Orders, written as columns. */
struct lines {
  int count;
  const struct eo_order_line *line; /* [count] */
};

static json_t *write_orders(const void *source)
{
  const struct lines *lines = source;
  double order[EO_MESH_ORDERS];
  for (int i = 0; i < lines->count; i++)
    order[i] = lines->line[i].order;
  return column(lines->count, order, NULL);
}

static json_t *write_line_amplitudes(const void *source)
{
  const struct lines *lines = source;
  double amplitude[EO_MESH_ORDERS];
  for (int i = 0; i < lines->count; i++)
    amplitude[i] = cabs(lines->line[i].amplitude);
  return eo_json_reals(lines->count, amplitude, 1, &eo_unit_um, EO_DIGITS_NUMBER);
}

static json_t *write_line_phases(const void *source)
{
  const struct lines *lines = source;
  double phase[EO_MESH_ORDERS];
  for (int i = 0; i < lines->count; i++)
    phase[i] = carg(lines->line[i].amplitude);
  return eo_json_reals(lines->count, phase, 1, NULL, EO_DIGITS_NUMBER);
}

static json_t *write_line_sigmas(const void *source)
{
  const struct lines *lines = source;
  double sigma[EO_MESH_ORDERS];
  for (int i = 0; i < lines->count; i++)
    sigma[i] = lines->line[i].sigma;
  return column(lines->count, sigma, &eo_unit_um);
}

static json_t *write_line_accelerations(const void *source)
{
  const struct lines *lines = source;
  double acceleration[EO_MESH_ORDERS];
  for (int i = 0; i < lines->count; i++)
    acceleration[i] = lines->line[i].acceleration;
  return eo_json_reals(lines->count, acceleration, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER);
}

static const struct eo_outline_row line_rows[] = {
    EO_KEY("order", "[number]", "per turn of the pinion; columns of all lines", .write = write_orders),
    EO_KEY("amplitude_um", "[number?]", "of the transmission error", .unit = &eo_unit_um,
           .write = write_line_amplitudes),
    EO_KEY("phase_rad", "[number?]", "against the first mesh position, rad", .write = write_line_phases),
    EO_KEY("sigma_um", "[number?]", "standard deviation of the amplitude", .unit = &eo_unit_um,
           .write = write_line_sigmas),
    EO_KEY("acceleration_m_per_s2", "[number?]", "amplitude of the acceleration", .unit = &eo_unit_m_per_s2,
           .write = write_line_accelerations),
};
static const struct eo_outline line_outline = EO_OUTLINE("OrderLines", line_rows);

static json_t *encode_lines(int count, const struct eo_order_line *line)
{
  const struct lines lines = {count, line};
  return eo_outline_encode(&line_outline, &lines);
}

/* One line beside a mesh order. */
struct sideband {
  int mesh_order, shaft, turns;
  struct eo_order_line line;
};

static json_t *write_sideband_amplitude(const void *sideband)
{
  return eo_json_quantity(cabs(((const struct sideband *)sideband)->line.amplitude), &eo_unit_um);
}

static const struct eo_outline_row sideband_rows[] = {
    EO_KEY("mesh_order", "integer", "next to which it stands", EO_AT(struct sideband, mesh_order)),
    EO_KEY("shaft", "word", "whose turns", .words = eo_member_name, EO_AT(struct sideband, shaft)),
    EO_KEY("turns", "integer", "away from the mesh order, in orders of that shaft", EO_AT(struct sideband, turns)),
    EO_KEY("order", "number", "per turn of the pinion", EO_AT(struct sideband, line.order)),
    EO_KEY("amplitude_um", "number?", "of the transmission error", .unit = &eo_unit_um,
           .write = write_sideband_amplitude),
    EO_KEY("acceleration_m_per_s2", "number?", "amplitude of the acceleration", .unit = &eo_unit_m_per_s2,
           EO_AT(struct sideband, line.acceleration)),
};
static const struct eo_outline sideband_outline = EO_OUTLINE("Sideband", sideband_rows);

/* Of all sidebands those that stand out of the noise, by mesh order. */
static json_t *write_sidebands(const void *source)
{
  static const int turns[EO_SIDEBANDS] = {-2, -1, 1, 2};
  const struct eo_transmission *transmission = source;
  struct eo_object list = eo_list_open();
  for (int h = 0; h < transmission->harmonics; h++)
    for (int k = 0; k < 2 * EO_SIDEBANDS; k++) {
      int shaft = k / EO_SIDEBANDS, at = k % EO_SIDEBANDS;
      const struct sideband sideband = {h + 1, shaft, turns[at], transmission->sideband[h][shaft][at]};
      if (cabs(sideband.line.amplitude) < 4 * sideband.line.sigma)
        continue;
      eo_list_add(&list, eo_outline_encode(&sideband_outline, &sideband));
    }
  return eo_object_close(&list);
}

static json_t *write_pinion_shaft(const void *t)
{
  return encode_lines(EO_SHAFT_ORDERS, ((const struct eo_transmission *)t)->shaft[EO_PINION]);
}

static json_t *write_gear_shaft(const void *t)
{
  return encode_lines(EO_SHAFT_ORDERS, ((const struct eo_transmission *)t)->shaft[EO_GEAR]);
}

static const struct eo_outline_row shaft_rows[] = {
    EO_KEY("pinion", "object", "orders 1, 2, ... of the pinion shaft", .outline = &line_outline,
           .write = write_pinion_shaft),
    EO_KEY("gear", "object", "of the gear shaft", .outline = &line_outline, .write = write_gear_shaft),
};
static const struct eo_outline shaft_outline = EO_OUTLINE("ShaftOrders", shaft_rows);

/* What is written of the spectrum: the largest acceleration in each of at most SPECTRUM_POINTS stretches of it. */
struct spectrum {
  int turns, count;
  double order[SPECTRUM_POINTS], acceleration[SPECTRUM_POINTS];
};

static json_t *write_spectrum_orders(const void *source)
{
  const struct spectrum *spectrum = source;
  return column(spectrum->count, spectrum->order, NULL);
}

static json_t *write_spectrum_accelerations(const void *source)
{
  const struct spectrum *spectrum = source;
  return eo_json_reals(spectrum->count, spectrum->acceleration, 1, &eo_unit_m_per_s2, EO_DIGITS_MAP);
}

static const struct eo_outline_row spectrum_rows[] = {
    EO_KEY("turns", "integer", "of the pinion that it was made from", EO_AT(struct spectrum, turns)),
    EO_KEY("order", "[number]", "per turn of the pinion", .write = write_spectrum_orders),
    EO_KEY("acceleration_m_per_s2", "[number?]", "largest of the stretch about that order", .unit = &eo_unit_m_per_s2,
           .write = write_spectrum_accelerations),
};
static const struct eo_outline spectrum_outline = EO_OUTLINE("OrderSpectrum", spectrum_rows);

static json_t *write_spectrum(const void *source)
{
  const struct eo_transmission *transmission = source;
  struct spectrum spectrum = {.turns = transmission->spectrum_turns};
  int stretch = transmission->spectrum_lines / SPECTRUM_POINTS + 1;
  for (int first = 1; first < transmission->spectrum_lines && spectrum.count < SPECTRUM_POINTS;
       first += stretch, spectrum.count++) {
    spectrum.acceleration[spectrum.count] = -1;
    for (int k = first; k < first + stretch && k < transmission->spectrum_lines; k++) {
      double at = (double)k / transmission->spectrum_turns,
             value = pow(at * transmission->speed, 2) * transmission->spectrum[k];
      if (value > spectrum.acceleration[spectrum.count]) {
        spectrum.acceleration[spectrum.count] = value;
        spectrum.order[spectrum.count] = at;
      }
    }
  }
  return eo_outline_encode(&spectrum_outline, &spectrum);
}

static json_t *write_rms_upto(const void *source)
{
  const struct eo_transmission *transmission = source;
  return eo_json_reals(transmission->harmonics, transmission->rms_upto, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER);
}

static const struct eo_outline_row rms_rows[] = {
    EO_KEY("value", "number?", "rotational acceleration of the mesh orders, RMS", .unit = &eo_unit_m_per_s2,
           EO_AT(struct eo_transmission, rms)),
    EO_KEY("sigma", "number?", "its standard deviation", .unit = &eo_unit_m_per_s2,
           EO_AT(struct eo_transmission, rms_sigma)),
    EO_KEY("upto", "[number?]", "of the mesh orders up to 1, 2, ...", .unit = &eo_unit_m_per_s2,
           .write = write_rms_upto),
    EO_KEY("spectrum", "number?", "the same from the spectrum", .unit = &eo_unit_m_per_s2,
           EO_AT(struct eo_transmission, rms_spectrum)),
    EO_KEY("band", "number?", "with what stands next to the mesh orders", .unit = &eo_unit_m_per_s2,
           EO_AT(struct eo_transmission, rms_band)),
};
static const struct eo_outline rms_outline = EO_OUTLINE("MeasuredRms", rms_rows);

static json_t *write_positions(const void *t)
{
  double position[CURVE];
  (void)t;
  for (int i = 0; i < CURVE; i++)
    position[i] = (i + 0.5) / CURVE;
  return column(CURVE, position, NULL);
}

static json_t *write_mesh_curve(const void *t)
{
  double mesh[CURVE];
  for (int i = 0; i < CURVE; i++)
    mesh[i] = eo_transmission_mesh(t, (i + 0.5) / CURVE);
  return column(CURVE, mesh, &eo_unit_um);
}

static json_t *write_average(const void *t)
{
  return column(EO_CYCLE_BINS, ((const struct eo_transmission *)t)->cycle, &eo_unit_um);
}

static json_t *write_pinion_turn(const void *t)
{
  return eo_json_reals(EO_TURN_BINS, ((const struct eo_transmission *)t)->turn[EO_PINION], 1, &eo_unit_um,
                       EO_DIGITS_MAP);
}

static json_t *write_gear_turn(const void *t)
{
  return eo_json_reals(EO_TURN_BINS, ((const struct eo_transmission *)t)->turn[EO_GEAR], 1, &eo_unit_um, EO_DIGITS_MAP);
}

static const struct eo_outline_row te_rows[] = {
    EO_KEY("peak_to_peak_um", "number?", "of the mesh orders together", .unit = &eo_unit_um,
           EO_AT(struct eo_transmission, mesh_peak_to_peak)),
    EO_KEY("position", "[number]", "phase of the mesh cycle, 0..1", .write = write_positions),
    EO_KEY("mesh_um", "[number?]", "mesh orders together, over position", .unit = &eo_unit_um,
           .write = write_mesh_curve),
    EO_KEY("average_um", "[number?]", "average of all mesh cycles, over equal parts of the cycle", .unit = &eo_unit_um,
           .write = write_average),
    EO_KEY("pinion_turn_um", "[number?]", "average over equal parts of the pinion's turn", .unit = &eo_unit_um,
           .write = write_pinion_turn),
    EO_KEY("gear_turn_um", "[number?]", "average over equal parts of the gear's turn", .unit = &eo_unit_um,
           .write = write_gear_turn),
};
static const struct eo_outline te_outline = EO_OUTLINE("MeasuredTransmissionError", te_rows);

static const struct eo_outline_row turn_rows[] = {
    EO_KEY("pinion", "number", "turns", EO_AT(struct eo_transmission, revolutions[EO_PINION])),
    EO_KEY("gear", "number", "turns", EO_AT(struct eo_transmission, revolutions[EO_GEAR]))};
static const struct eo_outline turn_outline = EO_OUTLINE("Turns", turn_rows);

static const struct eo_outline_row speed_rows[] = {
    EO_KEY("mean", "number", "of the pinion", .unit = &eo_unit_rpm, EO_AT(struct eo_transmission, speed)),
    EO_KEY("lowest", "number", "of the pinion", .unit = &eo_unit_rpm, EO_AT(struct eo_transmission, speed_low)),
    EO_KEY("highest", "number", "of the pinion", .unit = &eo_unit_rpm, EO_AT(struct eo_transmission, speed_high)),
};
static const struct eo_outline speed_outline = EO_OUTLINE("MeasuredSpeed", speed_rows);

/* Objects that tell of the transmission error as a whole. */
static json_t *write_turns(const void *t)
{
  return eo_outline_encode(&turn_outline, t);
}

static json_t *write_speeds(const void *t)
{
  return eo_outline_encode(&speed_outline, t);
}

static json_t *write_rms(const void *t)
{
  return eo_outline_encode(&rms_outline, t);
}

static json_t *write_mesh(const void *t)
{
  return encode_lines(((const struct eo_transmission *)t)->harmonics, ((const struct eo_transmission *)t)->mesh);
}

static json_t *write_shafts(const void *t)
{
  return eo_outline_encode(&shaft_outline, t);
}

static json_t *write_te(const void *t)
{
  return eo_outline_encode(&te_outline, t);
}

static json_t *write_drift(const void *t)
{
  return column(3, ((const struct eo_transmission *)t)->drift + 1, &eo_unit_um);
}

static json_t *write_parts(const void *t)
{
  return eo_parts_encode(&((const struct eo_transmission *)t)->parts);
}

static json_t *write_axis(const void *t)
{
  return eo_outline_encode(&eo_axis_outline, t);
}

static json_t *write_order_tracks(const void *t)
{
  return eo_outline_encode(&eo_order_tracks_outline, t);
}

/* What the whole result and the brief one begin with. */
static const struct eo_outline_row measured_rows[] = {
    EO_KEY("rows", "integer", "of the recording that were used", EO_AT(struct eo_transmission, rows)),
    EO_KEY("seconds", "number", "that they last, s", EO_AT(struct eo_transmission, seconds)),
    EO_KEY("turns", "object", "in that time", .outline = &turn_outline, .write = write_turns),
    EO_KEY("speed_rpm", "object", "of the pinion", .outline = &speed_outline, .write = write_speeds),
    EO_KEY("harmonics", "integer", "mesh orders that were fitted", EO_AT(struct eo_transmission, harmonics)),
    EO_KEY("rms_m_per_s2", "object", "vibration", .outline = &rms_outline, .write = write_rms),
    EO_KEY("mesh", "object", "mesh orders", .outline = &line_outline, .write = write_mesh),
};
const struct eo_outline eo_measured_head = EO_OUTLINE(NULL, measured_rows);

static const struct eo_outline_row result_rows[] = {
    {.outline = &eo_measured_head},
    EO_KEY("sidebands", "[object]", "those that stand out of the noise, by mesh order", .outline = &sideband_outline,
           .write = write_sidebands),
    EO_KEY("shafts", "object", "shaft orders", .outline = &shaft_outline, .write = write_shafts),
    EO_KEY("te", "object", "transmission error", .outline = &te_outline, .write = write_te),
    EO_KEY("residual_um", "number?", "what no order explains, RMS", .unit = &eo_unit_um,
           EO_AT(struct eo_transmission, residual)),
    EO_KEY("drift_um", "[number?]", "Legendre coefficients 1, 2, 3 over the time", .unit = &eo_unit_um,
           .write = write_drift),
    EO_KEY("hunting_turns", "integer", "turns of the pinion after which the same teeth meet",
           EO_AT(struct eo_transmission, hunting)),
    EO_KEY("spectrum", "object", "of the acceleration over order", .outline = &spectrum_outline,
           .write = write_spectrum),
    EO_KEY("part", "object", "what was measured", .outline = &eo_part_outline,
           EO_AT(struct eo_transmission, parts.measured)),
    EO_KEY("parts", "[object]", "all in which the pinion turns one way without a stop", .outline = &eo_part_outline,
           .write = write_parts),
    EO_KEY("axis", "object", "the measured angle of the pinion, over which orders are taken",
           .outline = &eo_axis_outline, .write = write_axis),
    EO_KEY("tracks", "object", "the orders of successive stretches", .outline = &eo_order_tracks_outline,
           .write = write_order_tracks),
};
const struct eo_outline eo_measured_result_outline = EO_OUTLINE("MeasuredResult", result_rows);
