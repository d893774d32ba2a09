/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/measurement_document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "document/layout_document.h"
#include "document/measure_order.h"
#include "document/measurement_parts.h"
#include "document/result_private.h"
#include "gear/names.h"

static json_t *column(int count, const double *value, const struct eo_unit *unit)
{
  return eo_json_reals(count, value, 1, unit, EO_DIGITS_CURVE);
}

static const char *label_name(bool unmodified)
{
  return eo_measure_label[unmodified];
}

static json_t *write_finding_row(const void *finding)
{
  int64_t row = ((const struct eo_finding *)finding)->row;
  return row < 0 ? json_null() : json_integer(row + 1);
}

static json_t *write_finding_line(const void *finding)
{
  int64_t line = ((const struct eo_finding *)finding)->line;
  return line > 0 ? json_integer(line) : json_null();
}

static const struct eo_outline_row finding_rows[] = {
    EO_KEY("kind", "word", "what it is about", .words = eo_finding_names, EO_AT(struct eo_finding, kind)),
    EO_KEY("severity", "word", "repaired: taken care of; refused: there is no result", .words = eo_severity_names,
           EO_AT(struct eo_finding, severity)),
    EO_KEY("channel", "word?", "null: both", .words = eo_member_name, EO_AT(struct eo_finding, channel)),
    EO_KEY("row", "integer?", "of the recording, from 1", .write = write_finding_row),
    EO_KEY("line", "integer?", "of the file, from 1", .write = write_finding_line),
    EO_KEY("value", "number?", "what was found, in the unit that text says", EO_AT(struct eo_finding, value)),
    EO_KEY("text", "text", "a sentence for people", EO_AT(struct eo_finding, text)),
};
static const struct eo_outline finding_outline = EO_OUTLINE("Finding", finding_rows);

static json_t *write_amplitudes(const void *ellipse)
{
  return column(2, ((const struct eo_ellipse *)ellipse)->amplitude, NULL);
}

static json_t *write_offsets(const void *ellipse)
{
  return column(2, ((const struct eo_ellipse *)ellipse)->offset, NULL);
}

static json_t *write_ratio(const void *ellipse)
{
  const struct eo_ellipse *this_ellipse = ellipse;
  return eo_json_quantity(this_ellipse->amplitude[0] / this_ellipse->amplitude[1], NULL);
}

static json_t *write_phase(const void *ellipse)
{
  return eo_json_quantity(M_PI / 2 + ((const struct eo_ellipse *)ellipse)->skew, &eo_unit_deg);
}

static const struct eo_outline_row ellipse_rows[] = {
    EO_KEY("amplitude", "[number?]", "sine, cosine, in the recording's unit", .write = write_amplitudes),
    EO_KEY("offset", "[number?]", "sine, cosine, in the recording's unit", .write = write_offsets),
    EO_KEY("ratio", "number?", "amplitude of the sine over that of the cosine", .write = write_ratio),
    EO_KEY("phase_deg", "number?", "between them", .unit = &eo_unit_deg, .write = write_phase),
};
static const struct eo_outline ellipse_outline = EO_OUTLINE("RawTracks", ellipse_rows);

/* Of a channel that was recorded as an angle or a count there is none. */
static json_t *write_ellipse(const struct eo_measurement *measurement, int channel)
{
  bool drawn = measurement->raw[channel] && measurement->ellipse[channel].amplitude[0] > 0;
  return drawn ? eo_outline_encode(&ellipse_outline, &measurement->ellipse[channel]) : json_null();
}

static json_t *write_pinion_ellipse(const void *measurement)
{
  return write_ellipse(measurement, EO_PINION);
}

static json_t *write_gear_ellipse(const void *measurement)
{
  return write_ellipse(measurement, EO_GEAR);
}

static const struct eo_outline_row track_rows[] = {
    EO_KEY("pinion", "object?", "of the pinion's encoder", .outline = &ellipse_outline, .write = write_pinion_ellipse),
    EO_KEY("gear", "object?", "of the gear's encoder", .outline = &ellipse_outline, .write = write_gear_ellipse),
};
static const struct eo_outline track_outline = EO_OUTLINE("SignalTracks", track_rows);

static json_t *write_tracks(const void *measurement)
{
  return eo_outline_encode(&track_outline, measurement);
}

static const struct eo_outline_row signal_rows[] = {
    EO_KEY("rows", "integer", "of the recording", EO_AT(struct eo_measurement, rows)),
    EO_KEY("interval_ms", "number?", "between two rows", .unit = &eo_unit_ms, EO_AT(struct eo_measurement, interval)),
    EO_KEY("ratio", "number?", "of the turns of both channels", EO_AT(struct eo_measurement, ratio)),
    EO_KEY("tracks", "object", "what raw tracks look like; null for angles and counts", .outline = &track_outline,
           .write = write_tracks),
};
static const struct eo_outline signal_outline = EO_OUTLINE("Signal", signal_rows);

/* What a document is written from. */
struct source {
  const struct eo_measurement *measurement;
  const struct eo_measurement_label *label;
};

static const struct eo_measurement_label *label_of(const void *source)
{
  return ((const struct source *)source)->label;
}

static const struct eo_measurement *measurement_of(const void *source)
{
  return ((const struct source *)source)->measurement;
}

static json_t *write_file(const void *source)
{
  return label_of(source)->file ? json_string(label_of(source)->file) : json_null();
}

static json_t *write_label(const void *source)
{
  return json_string(label_name(label_of(source)->unmodified));
}

static json_t *write_torque(const void *source)
{
  return eo_json_quantity(label_of(source)->torque, &eo_unit_Nm);
}

static json_t *write_end(const void *source)
{
  return json_string(eo_end_name[label_of(source)->end]);
}

static json_t *write_notes(const void *source)
{
  const struct eo_notes *notes = label_of(source)->notes;
  struct eo_object list = eo_list_open();
  for (int i = 0; notes && i < notes->count && i < EO_NOTES; i++)
    eo_list_add(&list, json_string(notes->text[i]));
  return eo_object_close(&list);
}

static json_t *write_layout(const void *source)
{
  return label_of(source)->layout ? json_deep_copy(label_of(source)->layout) : json_null();
}

static json_t *write_findings(const void *source)
{
  const struct eo_findings *findings = &measurement_of(source)->findings;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < findings->count && i < EO_MAX_FINDINGS; i++)
    eo_list_add(&list, eo_outline_encode(&finding_outline, &findings->finding[i]));
  return eo_object_close(&list);
}

static json_t *write_refused(const void *source)
{
  return json_boolean(measurement_of(source)->refused);
}

static json_t *write_signal(const void *source)
{
  return eo_outline_encode(&signal_outline, measurement_of(source));
}

static json_t *write_load(const void *source)
{
  return eo_outline_encode(&eo_load_outline, &measurement_of(source)->load);
}

static json_t *write_result(const void *source)
{
  const struct eo_measurement *measurement = measurement_of(source);
  return measurement->refused ? json_null()
                              : eo_outline_encode(&eo_measured_result_outline, &measurement->transmission);
}

static const struct eo_outline_row measurement_rows[] = {
    EO_KEY("file", "text?", "name as it came", .write = write_file),
    EO_KEY("label", "word", "which pair was measured", .words = eo_measure_label, .write = write_label),
    EO_KEY("torque_Nm", "number?", "on the pinion shaft; null: neither stated nor recorded", .unit = &eo_unit_Nm,
           .write = write_torque),
    EO_KEY("end", "word", "where the encoders sat", .words = eo_end_name, .write = write_end),
    EO_KEY("notes", "[text]", "what the reader of the file has to say", .write = write_notes),
    EO_KEY("layout", "object?", "what the columns hold, as it was found", .outline = &eo_layout_outline,
           .write = write_layout),
    EO_KEY("findings", "[object]", "what is remarkable", .outline = &finding_outline, .write = write_findings),
    EO_KEY("refused", "flag", "there is no result", .write = write_refused),
    EO_KEY("signal", "object", "the recording itself", .outline = &signal_outline, .write = write_signal),
    EO_KEY("load", "object", "columns of torque and speed over what was measured", .outline = &eo_load_outline,
           .write = write_load),
    EO_KEY("result", "object?", "null when refused", .outline = &eo_measured_result_outline, .write = write_result),
};
const struct eo_outline eo_measurement_outline = EO_OUTLINE("MeasurementOfFile", measurement_rows);

json_t *eo_measurement_encode(const struct eo_measurement *measurement, const struct eo_measurement_label *label)
{
  const struct source source = {measurement, label};
  return eo_outline_encode(&eo_measurement_outline, &source);
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
    {.outline = &eo_measured_head},
    EO_KEY("residual_um", "number?", "what no order explains, RMS", .unit = &eo_unit_um),
    EO_KEY("te", "object", "transmission error", .outline = &brief_te),
};
static const struct eo_outline brief_result = EO_OUTLINE("BriefResult", brief_result_rows);

static const struct eo_outline_row brief_rows[] = {
    EO_KEY("file", "text?", "name as it came"),
    EO_KEY("label", "word", "which pair was measured", .words = eo_measure_label),
    EO_KEY("torque_Nm", "number?", "on the pinion shaft; null: neither stated nor recorded", .unit = &eo_unit_Nm),
    EO_KEY("end", "word", "where the encoders sat", .words = eo_end_name),
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

enum eo_code eo_measured_decode(const json_t *document, struct eo_measured *measured, struct eo_error *error)
{
  const char *file = json_string_value(json_object_get(document, "file")),
             *label = json_string_value(json_object_get(document, "label"));
  const char *end = json_string_value(json_object_get(document, "end"));
  memset(measured, 0, sizeof *measured);
  if (!json_is_object(json_object_get(document, "result")))
    return eo_error_set(error, EO_ERROR_INPUT, "/result", "The measurement has no result: its recording was refused.");
  snprintf(measured->name, sizeof measured->name, "%s", file ? file : "");
  measured->unmodified = label && strcmp(label, label_name(true)) == 0;
  measured->end = end && strcmp(end, eo_end_name[EO_LEFT]) == 0 ? EO_LEFT : EO_RIGHT;
  measured->torque = eo_unit_in(&eo_unit_Nm, number_at(document, "torque_Nm", -1));
  measured->speed = eo_unit_in(&eo_unit_rpm, number_at(document, "result/speed_rpm/mean", -1));
  measured->rms = number_at(document, "result/rms_m_per_s2/value", -1);
  measured->rms_sigma = number_at(document, "result/rms_m_per_s2/sigma", -1);
  measured->harmonics = (int)json_array_size(eo_json_find(document, "result/mesh/amplitude_um"));
  measured->harmonics = measured->harmonics < EO_MESH_ORDERS ? measured->harmonics : EO_MESH_ORDERS;
  for (int h = 0; h < measured->harmonics; h++) {
    double amplitude = eo_unit_in(&eo_unit_um, number_at(document, "result/mesh/amplitude_um", h));
    measured->order[h] =
        (struct eo_order_line){.order = number_at(document, "result/mesh/order", h),
                               .amplitude = amplitude * cexp(I * number_at(document, "result/mesh/phase_rad", h)),
                               .sigma = eo_unit_in(&eo_unit_um, number_at(document, "result/mesh/sigma_um", h)),
                               .acceleration = number_at(document, "result/mesh/acceleration_m_per_s2", h)};
  }
  measured->warnings = count_warnings(document);
  if (!(measured->torque > 0) || !(measured->speed > 0) || !(measured->rms >= 0) || measured->harmonics < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/result",
                        "The document is no measurement: torque, speed, RMS or mesh orders are missing.");
  return EO_OK;
}
