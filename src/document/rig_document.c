/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/rig_document.h"

#include <math.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"
#include "gear/names.h"

static const struct eo_unit unit_us = {"us", "us", 1e6, true}, unit_mV = {"mV", "mV", 1e3, true},
                            unit_V = {"V", "V", 1, false};

enum { MOST_ORDERS = 8 };                                       /* of which the truth tells */
static const double SPEED_CHANGES = 0.02, TORQUE_CHANGES = 0.1; /* relative, over the recording: said by a finding */

static const char *const outputs[] = {"angles", "counts", "sine-cosine", "pulses", "increments", "square", NULL};
static const char *const faults[] = {"none",         "swapped",      "reversed",       "teeth", "radians",
                                     "radians-gear", "dropped",      "dropped-silent", "slip",  "lost-count",
                                     "constant",     "stuck",        "saturated",      "time",  "nan",
                                     "spike",        "missed-pulse", "double-pulse",   NULL};
static const char *const separators[] = {"comma", "semicolon", "tab", "blank", NULL}, *const headings[] = {
                                                                                          "names", "units-row", "block",
                                                                                          "none", NULL};

#define SYNTHETIC(member) synthetic.member
static const struct eo_field fields[] = {
    EO_NUMBER_DERIVED(struct eo_rig_request, torque, "torque_Nm", NULL, 1e-3, 1e8,
                      "of the load case with the largest share", "torque on the pinion"),
    EO_NUMBER_DERIVED(struct eo_rig_request, speed, "speed_rpm", &eo_unit_rpm, 0.1, 1e6,
                      "of the load case with the largest share", "mean speed of the pinion"),
    EO_CHOICE(struct eo_rig_request, end, "end", eo_end_name, EO_RIGHT, "where the encoders sit"),
    EO_FLAG(struct eo_rig_request, unmodified, "unmodified", 0, "record the pair without its modification"),
    EO_INTEGER(struct eo_rig_request, harmonics, "harmonics", 1, EO_SYNTHETIC_ORDERS, 12,
               "mesh orders of the response in the recording"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(turns), "turns", NULL, 0.1, 1e7, 45, "turns of the pinion"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(sample_rate), "sample_rate_Hz", &eo_unit_Hz, 1, 1e8, 20000,
              "samples per second"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(drift), "speed_drift", NULL, -1.9, 1.9, 0,
              "change of speed from start to end, relative; 1.9 is a run-up from a twentieth of the mean speed"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(swing), "speed_swing", NULL, 0, 0.5, 0,
              "amplitude of a swing of the speed, relative"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(swing_turns), "speed_swing_turns", NULL, 0.1, 1e6, 60,
              "period of that swing in turns of the pinion"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(step), "speed_step", NULL, -1.9, 1.9, 0,
              "change of the speed half way, between two steady states, relative"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(run_up), "run_up_turns", NULL, 0, 1e6, 0,
              "first turns in which the speed rises from a tenth to that of the rest"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(rest[0]), "rest_before_s", NULL, 0, 1e6, 0, "standstill at the start"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(rest[1]), "rest_after_s", NULL, 0, 1e6, 0, "standstill at the end"),
    EO_FLAG(struct eo_rig_request, SYNTHETIC(turn_back), "turn_back", 0, "the shafts turn back to where they began"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(eccentricity[EO_PINION]), "pinion_eccentricity_um", &eo_unit_um, 0, 1000,
              20, "first order of the pinion shaft, along the line of action"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(eccentricity[EO_GEAR]), "gear_eccentricity_um", &eo_unit_um, 0, 1000, 30,
              "first order of the gear shaft"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(noise), "noise_urad", &eo_unit_urad, 0, 1e4, 0.02,
              "noise of each angle, standard deviation"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(jitter), "jitter_us", &unit_us, 0, 1e4, 0,
              "jitter of the sampling, both channels alike"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(skew), "skew_us", &unit_us, 0, 1e4, 0,
              "jitter of the gear channel alone"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(gear_rate), "gear_sample_rate_Hz", &eo_unit_Hz, 0, 1e8, 0,
              "samples per second of the gear, with a time column of its own; 0: those of the pinion"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(gear_delay), "gear_delay_us", &unit_us, 0, 1e9, 0,
              "time by which the gear's samples are later, with a time column of their own"),
    EO_NUMBER(struct eo_rig_request, shown_torque_change, "torque_change", NULL, -1.9, 1.9, 0,
              "change of the recorded torque from start to end, relative"),
    EO_FLAG(struct eo_rig_request, shows_torque, "torque_column", 0, "a column with the torque of the pinion"),
    EO_FLAG(struct eo_rig_request, SYNTHETIC(shows_speed), "speed_column", 0, "a column with the speed of the pinion"),
    EO_FLAG(struct eo_rig_request, SYNTHETIC(index), "index_pulse", 0, "counts start again at an index pulse"),
    EO_INTEGER(struct eo_rig_request, SYNTHETIC(missing[EO_PINION]), "pinion_missing_teeth", 0, 100000, 0,
               "teeth that the pinion's pulse wheel lacks"),
    EO_INTEGER(struct eo_rig_request, SYNTHETIC(missing[EO_GEAR]), "gear_missing_teeth", 0, 100000, 0,
               "teeth that the gear's pulse wheel lacks"),
    EO_INTEGER(struct eo_rig_request, SYNTHETIC(lines[EO_PINION]), "pinion_lines", 1, 1000000, 18000,
               "lines per turn of the pinion's encoder"),
    EO_INTEGER(struct eo_rig_request, SYNTHETIC(lines[EO_GEAR]), "gear_lines", 1, 1000000, 18000,
               "lines per turn of the gear's encoder"),
    EO_INTEGER(struct eo_rig_request, SYNTHETIC(interpolation), "interpolation", 0, 1000000, 0,
               "steps per line that angles and counts are rounded to; 0: not rounded"),
    EO_CHOICE(struct eo_rig_request, SYNTHETIC(output), "output", outputs, EO_SYNTHETIC_ANGLES,
              "what the columns hold"),
    EO_FLAG(struct eo_rig_request, SYNTHETIC(wrapped), "wrapped", 0, "angles start again every turn"),
    EO_FLAG(struct eo_rig_request, SYNTHETIC(radians), "radians", 0, "angles in radians, as the heading says"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(amplitude), "track_amplitude_V", &unit_V, 1e-3, 100, 0.5,
              "amplitude of the raw tracks"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(offset), "track_offset", NULL, -1, 1, 0.03,
              "offset of the raw tracks / amplitude"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(gain), "track_gain", NULL, -0.9, 9, 0.05,
              "amplitude of the sine / amplitude of the cosine - 1"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(phase), "track_phase_deg", &eo_unit_deg, -60, 60, 2,
              "phase of the raw tracks beyond 90 degrees"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(track_noise), "track_noise_mV", &unit_mV, 0, 1e4, 0,
              "noise of the raw tracks"),
    EO_NUMBER(struct eo_rig_request, SYNTHETIC(track_step), "track_step_mV", &unit_mV, 0, 1e4, 0,
              "step of the converter of the raw tracks; 0: none"),
    EO_CHOICE(struct eo_rig_request, SYNTHETIC(fault), "fault", faults, EO_FAULT_NONE,
              "what is wrong with the recording"),
    EO_NUMBER(struct eo_rig_request, fault_row, "fault_row", NULL, 0, 1e9, 10000, "row of the fault, from 0"),
    EO_NUMBER(struct eo_rig_request, fault_size, "fault_size", NULL, -1000, 1e6, 1,
              "size of the fault: rows, or teeth of the gear too many"),
    {.key = "seed",
     .kind = EO_FIELD_SEED,
     .offset = offsetof(struct eo_rig_request, synthetic.seed),
     .low = 0,
     .high = 9007199254740991.0,
     .fallback = 1,
     .help = "seed of all random numbers"},
    EO_CHOICE(struct eo_rig_request, separator, "separator", separators, EO_RIG_COMMA, "what separates the columns"),
    EO_CHOICE(struct eo_rig_request, heading, "heading", headings, EO_RIG_NAMES,
              "names with units, names and a row of units, a block of remarks before them, or nothing"),
    EO_FLAG(struct eo_rig_request, decimal_comma, "decimal_comma", 0,
            "decimal comma (not with commas between columns)"),
    EO_FLAG(struct eo_rig_request, byte_order_mark, "byte_order_mark", 0, "UTF-8 byte order mark at the start"),
    EO_FLAG(struct eo_rig_request, carriage_return, "carriage_return", 0, "lines end with CR LF"),
};
const struct eo_table eo_rig_table = EO_TABLE("a synthetic rig", struct eo_rig_request, fields);

enum eo_code eo_rig_complete(struct eo_rig_request *request, const struct eo_design *design, struct eo_error *error)
{
  const struct eo_load_case *largest = &design->load_case[0];
  for (int i = 1; i < design->load_cases; i++)
    if (design->load_case[i].share > largest->share)
      largest = &design->load_case[i];
  if (isnan(request->torque))
    request->torque = largest->torque;
  if (isnan(request->speed))
    request->speed = largest->speed;
  if (request->decimal_comma && request->separator == EO_RIG_COMMA)
    return eo_error_set(error, EO_ERROR_INPUT, "/decimal_comma",
                        "A decimal comma needs another separator than the comma.");
  return EO_OK;
}

enum eo_code eo_rig_predict(const struct eo_rig_request *request, const struct eo_pair *pair,
                            const struct eo_design *design, struct eo_rig_prediction *prediction,
                            struct eo_error *error)
{
  struct eo_evaluator *evaluator = NULL;
  EO_TRY(eo_evaluator_new(&evaluator, pair, 1, error));
  enum eo_code code = eo_prediction_run(prediction, evaluator, design, request->unmodified, request->torque,
                                        request->speed, request->end, request->harmonics, error);
  eo_evaluator_free(evaluator);
  EO_TRY(code);
  return prediction->valid
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "", "The design has no periodic vibration at %g N m and %g rpm.",
                            request->torque, request->speed * 30 / M_PI);
}

void eo_rig_set_pair(struct eo_rig_request *request, const struct eo_geometry *geometry,
                     const struct eo_supports *supports, const struct eo_rig_prediction *prediction)
{
  struct eo_synthetic *synthetic = &request->synthetic;
  for (int i = 0; i < 2; i++) {
    synthetic->teeth[i] = geometry->teeth[i];
    synthetic->base_radius[i] = geometry->base_radius[i];
  }
  synthetic->pinion_share = eo_prediction_pinion_share(supports, geometry);
  synthetic->speed = prediction->speed;
  synthetic->orders = prediction->harmonics;
  memcpy(synthetic->order, prediction->order, sizeof *synthetic->order * (size_t)prediction->harmonics);
  synthetic->row = (int64_t)request->fault_row;
  synthetic->size = (int64_t)request->fault_size;
  synthetic->torque = request->shows_torque ? request->torque : 0;
  synthetic->torque_change = request->shown_torque_change;
}

static const char separator_of[] = {',', ';', '\t', ' '};

static void write_heading(const struct eo_rig_request *request, FILE *stream)
{
  const struct eo_synthetic *synthetic = &request->synthetic;
  const char *end = request->carriage_return ? "\r\n" : "\n";
  int columns = eo_synthetic_columns(synthetic);
  if (request->byte_order_mark)
    fputs("\xef\xbb\xbf", stream);
  if (request->heading == EO_RIG_BLOCK)
    fprintf(stream, "# synthetic rig%s# torque: %g N m%s# speed: %g rpm%s# sampling rate: %g Hz%s%s", end,
            request->torque, end, request->speed * 30 / M_PI, end, synthetic->sample_rate, end, end);
  for (int pass = 0; pass < (request->heading == EO_RIG_UNITS_ROW ? 2 : 1) && request->heading != EO_RIG_BARE; pass++)
    for (int c = 0; c < columns; c++) {
      const char *name = eo_synthetic_heading(synthetic, c), *unit = strrchr(name, '_');
      if (request->heading != EO_RIG_UNITS_ROW)
        fputs(name, stream);
      else if (pass)
        fputs(unit ? unit + 1 : "", stream);
      else
        fprintf(stream, "%.*s", (int)(unit ? unit - name : (long)strlen(name)), name);
      fputs(c + 1 < columns ? (char[]){separator_of[request->separator], 0} : end, stream);
    }
}

static void write_cell(const struct eo_rig_request *request, double value, int decimals, FILE *stream)
{
  char text[64];
  snprintf(text, sizeof text, "%.*f", decimals, value);
  char *point = request->decimal_comma ? strchr(text, '.') : NULL;
  if (point)
    *point = ',';
  fputs(text, stream);
}

/* The shorter column of pulse times ends with empty cells. */
static void write_row(const struct eo_rig_request *request, const double *row, FILE *stream)
{
  int columns = eo_synthetic_columns(&request->synthetic);
  for (int c = 0; c < columns; c++) {
    if (isnan(row[c]))
      fputs(request->synthetic.output == EO_SYNTHETIC_PULSES ? "" : "NaN", stream);
    else
      write_cell(request, row[c], eo_synthetic_decimals(&request->synthetic, c), stream);
    if (c + 1 < columns)
      fputc(separator_of[request->separator], stream);
  }
  fputs(request->carriage_return ? "\r\n" : "\n", stream);
}

enum eo_code eo_rig_write(const struct eo_rig_request *request, const struct eo_progress *progress, FILE *stream,
                          struct eo_error *error)
{
  enum { BLOCK = 1024 };
  double rows[BLOCK * EO_SYNTHETIC_COLUMNS];
  int64_t total = eo_synthetic_rows(&request->synthetic);
  int columns = eo_synthetic_columns(&request->synthetic);
  write_heading(request, stream);
  for (int64_t first = 0; first < total && !ferror(stream); first += BLOCK) {
    int64_t count = total - first < BLOCK ? total - first : BLOCK;
    if (eo_progress_report(progress, "recording", (double)first / (double)total))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    eo_synthetic_fill(&request->synthetic, first, count, rows);
    for (int64_t i = 0; i < count; i++)
      write_row(request, rows + i * columns, stream);
  }
  if (fflush(stream) || ferror(stream))
    return eo_error_set(error, EO_ERROR_FILE, "", "The recording could not be written.");
  return EO_OK;
}

/* What the recording holds of each mesh order. */
struct truth {
  double speed;
  int orders;
  double amplitude[EO_SYNTHETIC_ORDERS];    /* um */
  double acceleration[EO_SYNTHETIC_ORDERS]; /* m/s2 */
  double rms[EO_SYNTHETIC_ORDERS];          /* m/s2, of the orders up to this one */
  struct eo_series amplitudes, accelerations, sums;
};

#define OF_TRUTH(member) EO_AT(struct truth, member)
static const struct eo_outline_row speed_rows[] = {
    EO_KEY("mean_rpm", "number", "of the pinion", .unit = &eo_unit_rpm, OF_TRUTH(speed)),
};
static const struct eo_outline_row order_rows[] = {
    EO_KEY("line_amp_um", "[number]", "of each mesh order", OF_TRUTH(amplitudes)),
    EO_KEY("line_acc", "[number]", "of each mesh order, m/s2", OF_TRUTH(accelerations)),
    EO_KEY("rms_by_H", "[number]", "of the orders up to each, m/s2", OF_TRUTH(sums)),
};
static const struct eo_outline speed_outline = EO_OUTLINE("RigSpeed", speed_rows),
                               order_outline = EO_OUTLINE("RigOrders", order_rows);

static json_t *encode_truth(const struct eo_synthetic *synthetic)
{
  struct truth truth = {.speed = eo_synthetic_speed(synthetic),
                        .orders = synthetic->orders < MOST_ORDERS ? synthetic->orders : MOST_ORDERS};
  struct eo_object object = eo_object_open();
  char key[40];
  for (int h = 1; h <= truth.orders; h++) {
    truth.amplitude[h - 1] = 1e6 * cabs(synthetic->order[h - 1]);
    truth.acceleration[h - 1] = cabs(synthetic->order[h - 1]) * pow(h * synthetic->teeth[EO_PINION] * truth.speed, 2);
    truth.rms[h - 1] = eo_synthetic_rms(synthetic, h);
  }
  truth.amplitudes = eo_series_of(truth.orders, truth.amplitude, EO_DIGITS_NUMBER);
  truth.accelerations = eo_series_of(truth.orders, truth.acceleration, EO_DIGITS_NUMBER);
  truth.sums = eo_series_of(truth.orders, truth.rms, EO_DIGITS_NUMBER);
  snprintf(key, sizeof key, "rms_mesh_lines_H%d", truth.orders); /* a key that says of how many orders */
  eo_outline_put(&object, &speed_outline, &truth);
  eo_object_put(&object, key, eo_json_quantity(truth.rms[truth.orders - 1], NULL));
  eo_outline_put(&object, &order_outline, &truth);
  return eo_object_close(&object);
}

static const char *expected_finding(enum eo_synthetic_fault fault)
{
  static const char *const expected[EO_FAULTS] = {
      NULL,         "swapped",  "reversed", "teeth",     "radians", "radians", "dropped rows", "dropped rows", "slip",
      "lost-count", "constant", "constant", "saturated", "time",    "nan",     "spike",        "pulse",        "pulse"};
  return expected[fault];
}

static json_t *list_findings(const struct eo_synthetic *synthetic)
{
  struct eo_object list = eo_list_open();
  const char *fault = expected_finding(synthetic->fault);
  if (fault || synthetic->wrapped)
    eo_list_add(&list, json_string(fault ? fault : "wrapped"));
  if (eo_synthetic_swing(synthetic) > SPEED_CHANGES || synthetic->rest[0] > 0 || synthetic->rest[1] > 0 ||
      synthetic->turn_back || synthetic->run_up > 0)
    eo_list_add(&list, json_string("unsteady"));
  if (synthetic->torque != 0 && fabs(synthetic->torque_change) > TORQUE_CHANGES)
    eo_list_add(&list, json_string("torque"));
  return eo_object_close(&list);
}

static json_t *write_count(const void *source)
{
  (void)source;
  return json_string("count");
}

/* What the file cannot say of its encoders. */
struct stated_layout {
  json_t *lines;
  bool counted;
};

static const struct eo_outline_row stated_rows[] = {
    EO_KEY("lines", "[integer]", "per turn of the pinion's and the gear's encoder", EO_AT(struct stated_layout, lines)),
    EO_KEY("unit", "text", "count: they are counts since the row before", .when = "of increments", .write = write_count,
           EO_IF(struct stated_layout, counted)),
};
static const struct eo_outline stated_outline = EO_OUTLINE("RigLayout", stated_rows);

static json_t *encode_layout(const struct eo_synthetic *synthetic)
{
  bool increments = synthetic->output == EO_SYNTHETIC_INCREMENTS;
  int per_line = synthetic->output == EO_SYNTHETIC_COUNTS || increments ? synthetic->interpolation : 1;
  const struct stated_layout layout = {
      json_pack("[i, i]", synthetic->lines[EO_PINION] * per_line, synthetic->lines[EO_GEAR] * per_line), increments};
  return eo_outline_encode(&stated_outline, &layout);
}

/* The file of the case. */
struct recorded {
  const char *file;
  json_t *truth, *findings, *layout;
  double tolerance;
  bool with_layout;
};

#define OF_RECORDED(member) EO_AT(struct recorded, member)
static const struct eo_outline_row recorded_rows[] = {
    EO_KEY("file", "text", "in the same folder", OF_RECORDED(file)),
    EO_KEY("truth", "{any}", "speed and mesh orders", OF_RECORDED(truth)),
    EO_KEY("tolerance_rms_rel", "number", "of the RMS", OF_RECORDED(tolerance)),
    EO_KEY("expected_findings", "[text]", "what has to be found in it", OF_RECORDED(findings)),
    EO_KEY("layout", "object", "what it cannot say of its encoders", .when = "but of angles",
           .outline = &stated_outline, OF_RECORDED(layout), EO_IF(struct recorded, with_layout)),
};
static const struct eo_outline recorded_outline = EO_OUTLINE("RigFile", recorded_rows);

struct rig_case {
  const char *kind;
  json_t *teeth, *base_radius, *files;
};

#define OF_CASE(member) EO_AT(struct rig_case, member)
static const struct eo_outline_row case_rows[] = {
    EO_KEY("kind", "text", "of the case file", OF_CASE(kind)),
    EO_KEY("teeth", "[integer]", "of the pinion and the gear", OF_CASE(teeth)),
    EO_KEY("base_radius_mm", "[number]", "of the pinion and the gear", OF_CASE(base_radius)),
    EO_KEY("files", "[object]", "one", .outline = &recorded_outline, OF_CASE(files)),
};
static const struct eo_outline case_outline = EO_OUTLINE("RigCase", case_rows);

json_t *eo_rig_truth(const struct eo_rig_request *request, const char *file)
{
  const struct eo_synthetic *synthetic = &request->synthetic;
  bool angles = synthetic->output == EO_SYNTHETIC_ANGLES;
  struct eo_object files = eo_list_open();
  const struct recorded recorded = {.file = file,
                                    .truth = encode_truth(synthetic),
                                    .findings = list_findings(synthetic),
                                    .layout = angles ? NULL : encode_layout(synthetic),
                                    .tolerance = 0.01,
                                    .with_layout = !angles};
  eo_list_add(&files, eo_outline_encode(&recorded_outline, &recorded));
  const struct rig_case rig_case = {
      .kind = "encoder",
      .teeth = json_pack("[i, i]", synthetic->teeth[EO_PINION], synthetic->teeth[EO_GEAR]),
      .base_radius = json_pack("[o, o]", eo_json_real(synthetic->base_radius[EO_PINION], &eo_unit_mm),
                               eo_json_real(synthetic->base_radius[EO_GEAR], &eo_unit_mm)),
      .files = eo_object_close(&files)};
  return eo_outline_encode(&case_outline, &rig_case);
}
