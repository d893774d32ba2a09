/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/measurement_document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "document/layout_document.h"
#include "document/measurement_parts.h"
#include "document/result_private.h"

enum { CURVE = 128, SPECTRUM_POINTS = 2000 };

static const char *const channel_name[] = {"pinion", "gear", NULL}, *const labels[] = {"modified", "unmodified", NULL},
                         *const ends[] = {"left", "right", NULL};

static json_t *column(int count, const double *value, const struct eo_unit *unit)
{
  return eo_json_reals(count, value, 1, unit, EO_DIGITS_CURVE);
}

static const char *label_name(bool unmodified)
{
  return labels[unmodified];
}

static const struct eo_outline_row finding_rows[] = {
    EO_KEY("kind", "word", "what it is about", .words = eo_finding_names),
    EO_KEY("severity", "word", "repaired: taken care of; refused: there is no result", .words = eo_severity_names),
    EO_KEY("channel", "word?", "null: both", .words = channel_name),
    EO_KEY("row", "integer?", "of the recording, from 1"),
    EO_KEY("line", "integer?", "of the file, from 1"),
    EO_KEY("value", "number?", "what was found, in the unit that text says"),
    EO_KEY("text", "text", "a sentence for people"),
};
static const struct eo_outline finding_outline = EO_OUTLINE("Finding", finding_rows);

static json_t *encode_findings(const struct eo_findings *findings)
{
  json_t *list = json_array();
  bool failed = !list;
  for (int i = 0; i < findings->count && i < EO_MAX_FINDINGS; i++) {
    const struct eo_finding *f = &findings->finding[i];
    struct eo_object o = eo_object_open_as(&finding_outline);
    eo_object_put(&o, "kind", json_string(eo_finding_name(f->kind)));
    eo_object_put(&o, "severity", json_string(eo_severity_name(f->severity)));
    eo_object_put(&o, "channel", f->channel < 0 ? json_null() : json_string(channel_name[f->channel]));
    eo_object_put(&o, "row", f->row < 0 ? json_null() : json_integer(f->row + 1));
    eo_object_put(&o, "line", f->line > 0 ? json_integer(f->line) : json_null());
    eo_object_put_number(&o, "value", f->value);
    eo_object_put(&o, "text", json_string(f->text));
    failed = failed || json_array_append_new(list, eo_object_close(&o)) != 0;
  }
  return failed ? (json_decref(list), NULL) : list;
}

static const struct eo_outline_row ellipse_rows[] = {
    EO_KEY("amplitude", "[number?]", "sine, cosine, in the recording's unit"),
    EO_KEY("offset", "[number?]", "sine, cosine, in the recording's unit"),
    EO_KEY("ratio", "number?", "amplitude of the sine over that of the cosine"),
    EO_KEY("phase_deg", "number?", "between them", .unit = &eo_unit_deg),
};
static const struct eo_outline ellipse_outline = EO_OUTLINE("RawTracks", ellipse_rows);

static json_t *encode_ellipse(const struct eo_ellipse *e)
{
  struct eo_object o = eo_object_open_as(&ellipse_outline);
  eo_object_put(&o, "amplitude", column(2, e->amplitude, NULL));
  eo_object_put(&o, "offset", column(2, e->offset, NULL));
  eo_object_put_number(&o, "ratio", e->amplitude[0] / e->amplitude[1]);
  eo_object_put_number(&o, "phase_deg", M_PI / 2 + e->skew);
  return eo_object_close(&o);
}

static const struct eo_outline_row track_rows[] = {
    EO_KEY("pinion", "object?", "of the pinion's encoder", .outline = &ellipse_outline),
    EO_KEY("gear", "object?", "of the gear's encoder", .outline = &ellipse_outline),
};
static const struct eo_outline track_outline = EO_OUTLINE("SignalTracks", track_rows);

static const struct eo_outline_row signal_rows[] = {
    EO_KEY("rows", "integer", "of the recording"),
    EO_KEY("interval_ms", "number?", "between two rows", .unit = &eo_unit_ms),
    EO_KEY("ratio", "number?", "of the turns of both channels"),
    EO_KEY("tracks", "object", "what raw tracks look like; null for angles and counts", .outline = &track_outline),
};
static const struct eo_outline signal_outline = EO_OUTLINE("Signal", signal_rows);

static json_t *encode_signal(const struct eo_measurement *m)
{
  struct eo_object o = eo_object_open_as(&signal_outline), tracks = eo_object_open_as(&track_outline);
  eo_object_put(&o, "rows", json_integer(m->rows));
  eo_object_put_number(&o, "interval_ms", m->interval);
  eo_object_put_number(&o, "ratio", m->ratio);
  for (int channel = 0; channel < 2; channel++)
    eo_object_put(&tracks, channel_name[channel],
                  m->raw[channel] && m->ellipse[channel].amplitude[0] > 0 ? encode_ellipse(&m->ellipse[channel])
                                                                          : json_null());
  eo_object_put(&o, "tracks", eo_object_close(&tracks));
  return eo_object_close(&o);
}

static json_t *encode_notes(const struct eo_notes *notes)
{
  json_t *list = json_array();
  bool failed = !list;
  for (int i = 0; notes && i < notes->count && i < EO_NOTES && !failed; i++)
    failed = json_array_append_new(list, json_string(notes->text[i])) != 0;
  return failed ? (json_decref(list), NULL) : list;
}

static const struct eo_outline_row line_rows[] = {
    EO_KEY("order", "[number]", "per turn of the pinion; columns of all lines"),
    EO_KEY("amplitude_um", "[number?]", "of the transmission error", .unit = &eo_unit_um),
    EO_KEY("phase_rad", "[number?]", "against the first mesh position, rad"),
    EO_KEY("sigma_um", "[number?]", "standard deviation of the amplitude", .unit = &eo_unit_um),
    EO_KEY("acceleration_m_per_s2", "[number?]", "RMS of the line", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline line_outline = EO_OUTLINE("OrderLines", line_rows);

static json_t *encode_lines(int count, const struct eo_order_line *line)
{
  double order[EO_MESH_ORDERS], amplitude[EO_MESH_ORDERS], phase[EO_MESH_ORDERS], sigma[EO_MESH_ORDERS],
      acceleration[EO_MESH_ORDERS];
  struct eo_object o = eo_object_open_as(&line_outline);
  for (int i = 0; i < count; i++) {
    order[i] = line[i].order;
    amplitude[i] = cabs(line[i].amplitude);
    phase[i] = carg(line[i].amplitude);
    sigma[i] = line[i].sigma;
    acceleration[i] = line[i].acceleration;
  }
  eo_object_put(&o, "order", column(count, order, NULL));
  eo_object_put(&o, "amplitude_um", eo_json_reals(count, amplitude, 1, &eo_unit_um, EO_DIGITS_NUMBER));
  eo_object_put(&o, "phase_rad", eo_json_reals(count, phase, 1, NULL, EO_DIGITS_NUMBER));
  eo_object_put(&o, "sigma_um", column(count, sigma, &eo_unit_um));
  eo_object_put(&o, "acceleration_m_per_s2",
                eo_json_reals(count, acceleration, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER));
  return eo_object_close(&o);
}

static const struct eo_outline_row sideband_rows[] = {
    EO_KEY("mesh_order", "integer", "beside which it stands"),
    EO_KEY("shaft", "word", "whose turns", .words = channel_name),
    EO_KEY("turns", "integer", "away from the mesh order, in orders of that shaft"),
    EO_KEY("order", "number", "per turn of the pinion"),
    EO_KEY("amplitude_um", "number?", "of the transmission error", .unit = &eo_unit_um),
    EO_KEY("acceleration_m_per_s2", "number?", "RMS of the line", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline sideband_outline = EO_OUTLINE("Sideband", sideband_rows);

/* Of all sidebands those that stand out of the noise, by mesh order. */
static json_t *encode_sidebands(const struct eo_transmission *t)
{
  static const int turns[EO_SIDEBANDS] = {-2, -1, 1, 2};
  json_t *list = json_array();
  bool failed = !list;
  for (int h = 0; h < t->harmonics; h++)
    for (int k = 0; k < 2 * EO_SIDEBANDS; k++) {
      const struct eo_order_line *line = &t->sideband[h][k / EO_SIDEBANDS][k % EO_SIDEBANDS];
      if (cabs(line->amplitude) < 4 * line->sigma)
        continue;
      struct eo_object o = eo_object_open_as(&sideband_outline);
      eo_object_put(&o, "mesh_order", json_integer(h + 1));
      eo_object_put(&o, "shaft", json_string(channel_name[k / EO_SIDEBANDS]));
      eo_object_put(&o, "turns", json_integer(turns[k % EO_SIDEBANDS]));
      eo_object_put_number(&o, "order", line->order);
      eo_object_put_number(&o, "amplitude_um", cabs(line->amplitude));
      eo_object_put_number(&o, "acceleration_m_per_s2", line->acceleration);
      failed = failed || json_array_append_new(list, eo_object_close(&o)) != 0;
    }
  return failed ? (json_decref(list), NULL) : list;
}

static const struct eo_outline_row shaft_rows[] = {
    EO_KEY("pinion", "object", "orders 1, 2, ... of the pinion shaft", .outline = &line_outline),
    EO_KEY("gear", "object", "of the gear shaft", .outline = &line_outline),
};
static const struct eo_outline shaft_outline = EO_OUTLINE("ShaftOrders", shaft_rows);

static json_t *encode_shafts(const struct eo_transmission *t)
{
  struct eo_object o = eo_object_open_as(&shaft_outline);
  for (int member = 0; member < 2; member++)
    eo_object_put(&o, channel_name[member], encode_lines(EO_SHAFT_ORDERS, t->shaft[member]));
  return eo_object_close(&o);
}

static const struct eo_outline_row spectrum_rows[] = {
    EO_KEY("turns", "integer", "of the pinion that it was made from"),
    EO_KEY("order", "[number]", "per turn of the pinion"),
    EO_KEY("acceleration_m_per_s2", "[number?]", "largest of the stretch about that order", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline spectrum_outline = EO_OUTLINE("OrderSpectrum", spectrum_rows);

/* The largest acceleration in each of at most SPECTRUM_POINTS stretches of the spectrum. */
static json_t *encode_spectrum(const struct eo_transmission *t)
{
  double order[SPECTRUM_POINTS], acceleration[SPECTRUM_POINTS];
  int stretch = t->spectrum_lines / SPECTRUM_POINTS + 1, count = 0;
  struct eo_object o = eo_object_open_as(&spectrum_outline);
  for (int first = 1; first < t->spectrum_lines && count < SPECTRUM_POINTS; first += stretch, count++) {
    acceleration[count] = -1;
    for (int k = first; k < first + stretch && k < t->spectrum_lines; k++) {
      double at = (double)k / t->spectrum_turns, value = pow(at * t->speed, 2) * t->spectrum[k];
      if (value > acceleration[count]) {
        acceleration[count] = value;
        order[count] = at;
      }
    }
  }
  eo_object_put(&o, "turns", json_integer(t->spectrum_turns));
  eo_object_put(&o, "order", column(count, order, NULL));
  eo_object_put(&o, "acceleration_m_per_s2", eo_json_reals(count, acceleration, 1, &eo_unit_m_per_s2, EO_DIGITS_MAP));
  return eo_object_close(&o);
}

static const struct eo_outline_row rms_rows[] = {
    EO_KEY("value", "number?", "rotational acceleration of the mesh orders, RMS", .unit = &eo_unit_m_per_s2),
    EO_KEY("sigma", "number?", "its standard deviation", .unit = &eo_unit_m_per_s2),
    EO_KEY("upto", "[number?]", "of the mesh orders up to 1, 2, ...", .unit = &eo_unit_m_per_s2),
    EO_KEY("spectrum", "number?", "the same from the spectrum", .unit = &eo_unit_m_per_s2),
    EO_KEY("band", "number?", "with what stands beside the mesh orders", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline rms_outline = EO_OUTLINE("MeasuredRms", rms_rows);

static json_t *encode_rms(const struct eo_transmission *t)
{
  struct eo_object o = eo_object_open_as(&rms_outline);
  eo_object_put_number(&o, "value", t->rms);
  eo_object_put_number(&o, "sigma", t->rms_sigma);
  eo_object_put(&o, "upto", eo_json_reals(t->harmonics, t->rms_upto, 1, &eo_unit_m_per_s2, EO_DIGITS_NUMBER));
  eo_object_put_number(&o, "spectrum", t->rms_spectrum);
  eo_object_put_number(&o, "band", t->rms_band);
  return eo_object_close(&o);
}

static const struct eo_outline_row te_rows[] = {
    EO_KEY("peak_to_peak_um", "number?", "of the mesh orders together", .unit = &eo_unit_um),
    EO_KEY("position", "[number]", "phase of the mesh cycle, 0..1"),
    EO_KEY("mesh_um", "[number?]", "mesh orders together, over position", .unit = &eo_unit_um),
    EO_KEY("average_um", "[number?]", "average of all mesh cycles, over equal parts of the cycle", .unit = &eo_unit_um),
    EO_KEY("pinion_turn_um", "[number?]", "average over equal parts of the pinion's turn", .unit = &eo_unit_um),
    EO_KEY("gear_turn_um", "[number?]", "average over equal parts of the gear's turn", .unit = &eo_unit_um),
};
static const struct eo_outline te_outline = EO_OUTLINE("MeasuredTransmissionError", te_rows);

static json_t *encode_te(const struct eo_transmission *t)
{
  double position[CURVE], mesh[CURVE];
  struct eo_object o = eo_object_open_as(&te_outline);
  for (int i = 0; i < CURVE; i++) {
    position[i] = (i + 0.5) / CURVE;
    mesh[i] = eo_transmission_mesh(t, position[i]);
  }
  eo_object_put_number(&o, "peak_to_peak_um", t->mesh_peak_to_peak);
  eo_object_put(&o, "position", column(CURVE, position, NULL));
  eo_object_put(&o, "mesh_um", column(CURVE, mesh, &eo_unit_um));
  eo_object_put(&o, "average_um", column(EO_CYCLE_BINS, t->cycle, &eo_unit_um));
  for (int member = 0; member < 2; member++) {
    char key[40];
    snprintf(key, sizeof key, "%s_turn_um", channel_name[member]);
    eo_object_put(&o, key, eo_json_reals(EO_TURN_BINS, t->turn[member], 1, &eo_unit_um, EO_DIGITS_MAP));
  }
  return eo_object_close(&o);
}

static const struct eo_outline_row turn_rows[] = {EO_KEY("pinion", "number", "turns"),
                                                  EO_KEY("gear", "number", "turns")};
static const struct eo_outline turn_outline = EO_OUTLINE("Turns", turn_rows);

static const struct eo_outline_row speed_rows[] = {
    EO_KEY("mean", "number", "of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("lowest", "number", "of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("highest", "number", "of the pinion", .unit = &eo_unit_rpm),
};
static const struct eo_outline speed_outline = EO_OUTLINE("MeasuredSpeed", speed_rows);

/* What the whole result and the brief one begin with. */
static const struct eo_outline_row measured_rows[] = {
    EO_KEY("rows", "integer", "of the recording that were used"),
    EO_KEY("seconds", "number", "that they last, s"),
    EO_KEY("turns", "object", "in that time", .outline = &turn_outline),
    EO_KEY("speed_rpm", "object", "of the pinion", .outline = &speed_outline),
    EO_KEY("harmonics", "integer", "mesh orders that were fitted"),
    EO_KEY("rms_m_per_s2", "object", "vibration", .outline = &rms_outline),
    EO_KEY("mesh", "object", "mesh orders", .outline = &line_outline),
};
static const struct eo_outline measured = EO_OUTLINE(NULL, measured_rows);

static const struct eo_outline_row result_rows[] = {
    {.outline = &measured},
    EO_KEY("sidebands", "[object]", "those that stand out of the noise, by mesh order", .outline = &sideband_outline),
    EO_KEY("shafts", "object", "shaft orders", .outline = &shaft_outline),
    EO_KEY("te", "object", "transmission error", .outline = &te_outline),
    EO_KEY("residual_um", "number?", "what no order explains, RMS", .unit = &eo_unit_um),
    EO_KEY("drift_um", "[number?]", "Legendre coefficients 1, 2, 3 over the time", .unit = &eo_unit_um),
    EO_KEY("hunting_turns", "integer", "turns of the pinion after which the same teeth meet"),
    EO_KEY("spectrum", "object", "of the acceleration over order", .outline = &spectrum_outline),
    EO_KEY("part", "object", "what was measured", .outline = &eo_part_outline),
    EO_KEY("parts", "[object]", "all in which the pinion turns one way without a stop", .outline = &eo_part_outline),
    EO_KEY("axis", "object", "the measured angle of the pinion, over which orders are taken",
           .outline = &eo_axis_outline),
    EO_KEY("tracks", "object", "the orders of successive stretches", .outline = &eo_order_tracks_outline),
};
static const struct eo_outline result_outline = EO_OUTLINE("MeasuredResult", result_rows);

static json_t *encode_result(const struct eo_transmission *t)
{
  struct eo_object o = eo_object_open_as(&result_outline), speed = eo_object_open_as(&speed_outline),
                   turns = eo_object_open_as(&turn_outline);
  eo_object_put(&o, "rows", json_integer(t->rows));
  eo_object_put_number(&o, "seconds", t->seconds);
  eo_object_put_number(&turns, "pinion", t->revolutions[EO_PINION]);
  eo_object_put_number(&turns, "gear", t->revolutions[EO_GEAR]);
  eo_object_put(&o, "turns", eo_object_close(&turns));
  eo_object_put_number(&speed, "mean", t->speed);
  eo_object_put_number(&speed, "lowest", t->speed_low);
  eo_object_put_number(&speed, "highest", t->speed_high);
  eo_object_put(&o, "speed_rpm", eo_object_close(&speed));
  eo_object_put(&o, "harmonics", json_integer(t->harmonics));
  eo_object_put(&o, "rms_m_per_s2", encode_rms(t));
  eo_object_put(&o, "mesh", encode_lines(t->harmonics, t->mesh));
  eo_object_put(&o, "sidebands", encode_sidebands(t));
  eo_object_put(&o, "shafts", encode_shafts(t));
  eo_object_put(&o, "te", encode_te(t));
  eo_object_put_number(&o, "residual_um", t->residual);
  eo_object_put(&o, "drift_um", column(3, t->drift + 1, &eo_unit_um));
  eo_object_put(&o, "hunting_turns", json_integer(t->hunting));
  eo_object_put(&o, "spectrum", encode_spectrum(t));
  eo_object_put(&o, "part", eo_part_encode(&t->parts.measured));
  eo_object_put(&o, "parts", eo_parts_encode(&t->parts));
  eo_object_put(&o, "axis", eo_axis_encode(t));
  eo_object_put(&o, "tracks", eo_order_tracks_encode(t));
  return eo_object_close(&o);
}

static const struct eo_outline_row measurement_rows[] = {
    EO_KEY("file", "text?", "name as it came"),
    EO_KEY("label", "word", "which pair was measured", .words = labels),
    EO_KEY("torque_Nm", "number?", "on the pinion shaft; null: neither stated nor recorded", .unit = &eo_unit_Nm),
    EO_KEY("end", "word", "where the encoders sat", .words = ends),
    EO_KEY("notes", "[text]", "what the reader of the file has to say"),
    EO_KEY("layout", "object?", "what the columns hold, as it was found", .outline = &eo_layout_outline),
    EO_KEY("findings", "[object]", "what is remarkable", .outline = &finding_outline),
    EO_KEY("refused", "flag", "there is no result"),
    EO_KEY("signal", "object", "the recording itself", .outline = &signal_outline),
    EO_KEY("load", "object", "columns of torque and speed over what was measured", .outline = &eo_load_outline),
    EO_KEY("result", "object?", "null when refused", .outline = &result_outline),
};
const struct eo_outline eo_measurement_outline = EO_OUTLINE("MeasurementOfFile", measurement_rows);

json_t *eo_measurement_encode(const struct eo_measurement *m, const struct eo_measurement_label *label)
{
  struct eo_object o = eo_object_open_as(&eo_measurement_outline);
  eo_object_put(&o, "file", label->file ? json_string(label->file) : json_null());
  eo_object_put(&o, "label", json_string(label_name(label->unmodified)));
  eo_object_put_number(&o, "torque_Nm", label->torque);
  eo_object_put(&o, "end", json_string(eo_result_end[label->end]));
  eo_object_put(&o, "notes", encode_notes(label->notes));
  eo_object_put(&o, "layout", label->layout ? json_deep_copy(label->layout) : json_null());
  eo_object_put(&o, "findings", encode_findings(&m->findings));
  eo_object_put(&o, "refused", json_boolean(m->refused));
  eo_object_put(&o, "signal", encode_signal(m));
  eo_object_put(&o, "load", eo_load_encode(&m->load));
  eo_object_put(&o, "result", m->refused ? json_null() : encode_result(&m->transmission));
  return eo_object_close(&o);
}

static const struct eo_outline_row brief_finding_rows[] = {
    EO_KEY("kind", "word", "what it is about", .words = eo_finding_names),
    EO_KEY("severity", "word", "repaired: taken care of; refused: there is no result", .words = eo_severity_names),
    EO_KEY("text", "text", "a sentence for people"),
};
static const struct eo_outline brief_finding = EO_OUTLINE("BriefFinding", brief_finding_rows);

static const struct eo_outline_row brief_te_rows[] = {
    EO_KEY("peak_to_peak_um", "number?", "of the mesh orders together", .unit = &eo_unit_um)};
static const struct eo_outline brief_te = EO_OUTLINE("BriefTransmissionError", brief_te_rows);

static const struct eo_outline_row brief_result_rows[] = {
    {.outline = &measured},
    EO_KEY("residual_um", "number?", "what no order explains, RMS", .unit = &eo_unit_um),
    EO_KEY("te", "object", "transmission error", .outline = &brief_te),
};
static const struct eo_outline brief_result = EO_OUTLINE("BriefResult", brief_result_rows);

static const struct eo_outline_row brief_rows[] = {
    EO_KEY("file", "text?", "name as it came"),
    EO_KEY("label", "word", "which pair was measured", .words = labels),
    EO_KEY("torque_Nm", "number?", "on the pinion shaft; null: neither stated nor recorded", .unit = &eo_unit_Nm),
    EO_KEY("end", "word", "where the encoders sat", .words = ends),
    EO_KEY("refused", "flag", "there is no result"),
    EO_KEY("findings", "[object]", "what is remarkable", .outline = &brief_finding),
    EO_KEY("result", "object", "without its curves", .outline = &brief_result),
};
const struct eo_outline eo_measurement_brief = EO_OUTLINE("BriefMeasurement", brief_rows);

static double number_at(const json_t *document, const char *path, int index)
{
  const json_t *value = eo_json_find(document, path);
  value = index < 0 ? value : json_array_get(value, (size_t)index);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static int count_warnings(const json_t *document)
{
  int warnings = 0;
  size_t index;
  json_t *finding;
  json_array_foreach(json_object_get(document, "findings"), index, finding)
  {
    const char *severity = json_string_value(json_object_get(finding, "severity"));
    warnings += severity && (strcmp(severity, "warning") == 0 || strcmp(severity, "refused") == 0);
  }
  return warnings;
}

enum eo_code eo_measured_decode(const json_t *document, struct eo_measured *m, struct eo_error *error)
{
  const char *file = json_string_value(json_object_get(document, "file")),
             *label = json_string_value(json_object_get(document, "label"));
  const char *end = json_string_value(json_object_get(document, "end"));
  memset(m, 0, sizeof *m);
  if (!json_is_object(json_object_get(document, "result")))
    return eo_error_set(error, EO_ERROR_INPUT, "/result", "The measurement has no result: its recording was refused.");
  snprintf(m->name, sizeof m->name, "%s", file ? file : "");
  m->unmodified = label && strcmp(label, label_name(true)) == 0;
  m->end = end && strcmp(end, eo_result_end[EO_LEFT]) == 0 ? EO_LEFT : EO_RIGHT;
  m->torque = eo_unit_in(&eo_unit_Nm, number_at(document, "torque_Nm", -1));
  m->speed = eo_unit_in(&eo_unit_rpm, number_at(document, "result/speed_rpm/mean", -1));
  m->rms = number_at(document, "result/rms_m_per_s2/value", -1);
  m->rms_sigma = number_at(document, "result/rms_m_per_s2/sigma", -1);
  m->harmonics = (int)json_array_size(eo_json_find(document, "result/mesh/amplitude_um"));
  m->harmonics = m->harmonics < EO_MESH_ORDERS ? m->harmonics : EO_MESH_ORDERS;
  for (int h = 0; h < m->harmonics; h++) {
    double amplitude = eo_unit_in(&eo_unit_um, number_at(document, "result/mesh/amplitude_um", h));
    m->order[h] =
        (struct eo_order_line){.order = number_at(document, "result/mesh/order", h),
                               .amplitude = amplitude * cexp(I * number_at(document, "result/mesh/phase_rad", h)),
                               .sigma = eo_unit_in(&eo_unit_um, number_at(document, "result/mesh/sigma_um", h)),
                               .acceleration = number_at(document, "result/mesh/acceleration_m_per_s2", h)};
  }
  m->warnings = count_warnings(document);
  if (!(m->torque > 0) || !(m->speed > 0) || !(m->rms >= 0) || m->harmonics < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/result",
                        "The document is no measurement: torque, speed, RMS or mesh orders are missing.");
  return EO_OK;
}
