/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reference recordings of two encoders: findings, RMS and orders of the mesh against the truth they were made from. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/case_pair.h"
#include "document/examples.h"
#include "document/layout_document.h"
#include "gear/geometry.h"
#include "measurement/measurement.h"
#include "recording/reader.h"

/* Words in which a case may name a finding. */
static const struct {
  const char *part;
  enum eo_finding_kind kind;
} words[] = {{"swap", EO_FINDING_SWAPPED},
             {"exchang", EO_FINDING_SWAPPED},
             {"revers", EO_FINDING_REVERSED},
             {"sign", EO_FINDING_REVERSED},
             {"direction", EO_FINDING_REVERSED},
             {"teeth", EO_FINDING_TEETH},
             {"tooth", EO_FINDING_TEETH},
             {"ratio", EO_FINDING_TEETH},
             {"radian", EO_FINDING_UNITS},
             {"degree", EO_FINDING_UNITS},
             {"unit", EO_FINDING_UNITS},
             {"wrap", EO_FINDING_WRAPPED},
             {"slip", EO_FINDING_SLIP},
             {"jump", EO_FINDING_SLIP},
             {"step", EO_FINDING_SLIP},
             {"pulse", EO_FINDING_PULSE},
             {"torque", EO_FINDING_TORQUE},
             {"drop", EO_FINDING_DROPPED},
             {"gap", EO_FINDING_DROPPED},
             {"missing", EO_FINDING_DROPPED},
             {"constant", EO_FINDING_CONSTANT},
             {"stuck", EO_FINDING_CONSTANT},
             {"satur", EO_FINDING_SATURATED},
             {"clip", EO_FINDING_SATURATED},
             {"short", EO_FINDING_TOO_SHORT},
             {"few", EO_FINDING_TOO_SHORT},
             {"revolution", EO_FINDING_TOO_SHORT},
             {"steady", EO_FINDING_UNSTEADY},
             {"rate", EO_FINDING_SAMPLE_RATE},
             {"monoton", EO_FINDING_TIME},
             {"time", EO_FINDING_TIME},
             {"nan", EO_FINDING_NAN},
             {"number", EO_FINDING_NAN},
             {"spike", EO_FINDING_SPIKE},
             {"ellip", EO_FINDING_TRACK},
             {"gain", EO_FINDING_TRACK},
             {"offset", EO_FINDING_TRACK},
             {"raw", EO_FINDING_TRACK},
             {"outlier", EO_FINDING_SPIKE},
             {"phase", EO_FINDING_TRACK},
             {"amplitude", EO_FINDING_TRACK},
             {"track", EO_FINDING_TRACK},
             {"speed", EO_FINDING_SPEED},
             {"noise", EO_FINDING_RESOLUTION},
             {"resolution", EO_FINDING_RESOLUTION}};

struct run {
  struct eo_case *file;
  struct eo_verification *v;
  struct eo_measurement_settings settings; /* of the file as a whole */
  double speed[2];                         /* lowest and highest of the load cases, rad/s; 0: not known */
};

static bool finding_kind(const char *text, enum eo_finding_kind *kind)
{
  char lower[80] = "";
  for (size_t i = 0; text[i] && i + 1 < sizeof lower; i++)
    lower[i] = (char)tolower((unsigned char)text[i]);
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strstr(lower, words[i].part)) {
      *kind = words[i].kind;
      return true;
    }
  return false;
}

/* A finding is named by a text, or by the "kind" of an object; false with a fault when it is none. */
static bool read_finding(struct eo_case *value, enum eo_finding_kind *kind)
{
  const char *text = eo_case_is_object(value) ? eo_case_word(value, "kind") : eo_case_text(value);
  if (text && finding_kind(text, kind))
    return true;
  if (text)
    eo_case_fault(value, "\"%.60s\" is not a finding.", text);
  return false;
}

/* Numbers of teeth as a pair under "teeth" or "z", or one by one. */
static void read_teeth(struct eo_case *object, int teeth[2])
{
  enum { MOST = 100000 };
  static const char *const single[2] = {"z1", "z2"};
  const char *both = eo_case_find(object, "teeth") ? "teeth" : "z";
  double pair[2];
  if (eo_case_find(object, both)) {
    if (eo_case_numbers(eo_case_find(object, both), 2, 2, pair) < 0)
      return;
    for (int i = 0; i < 2; i++) {
      if (!(pair[i] >= 1 && pair[i] <= MOST && pair[i] == floor(pair[i])))
        eo_case_fault(eo_case_find(object, both), "Numbers of teeth are whole, from 1.");
      else
        teeth[i] = (int)pair[i];
    }
  } else
    for (int i = 0; i < 2; i++)
      teeth[i] = eo_case_whole_or(object, single[i], 1, MOST, teeth[i]);
}

/* Tooth numbers, radii, orders and speed as an object states them; what it leaves out stays. */
static void read_settings(struct eo_case *object, struct eo_measurement_settings *measurement_settings)
{
  enum { MOST_ORDERS = 10000 };
  static const char *const millimetre[2] = {"rb1_mm", "rb2_mm"}, *const metre[2] = {"rb1_m", "rb2_m"};
  struct eo_transmission_settings *transmission_settings = &measurement_settings->transmission;
  struct eo_case *both = eo_case_find(object, "base_radius_mm");
  read_teeth(object, transmission_settings->teeth);
  for (int i = 0; i < 2; i++) {
    if (both)
      transmission_settings->base_radius[i] = 1e-3 * eo_case_element(both, i);
    else if (eo_case_find(object, millimetre[i]))
      transmission_settings->base_radius[i] = 1e-3 * eo_case_number(object, millimetre[i]);
    else
      transmission_settings->base_radius[i] = eo_case_number_or(object, metre[i],
                                                                transmission_settings->base_radius[i]);
  }
  transmission_settings->harmonics = eo_case_whole_or(object, eo_case_find(object, "harmonics") ? "harmonics" : "H", 1,
                                                      MOST_ORDERS, transmission_settings->harmonics);
  measurement_settings->stated_speed = eo_case_number_or(object,
                                                         eo_case_find(object, "speed_rpm") ? "speed_rpm" : "stated_rpm",
                                                         measurement_settings->stated_speed * 30 / M_PI) *
                                       M_PI / 30;
}

/* The paper's pair unless the file says otherwise. */
static enum eo_code set_pair(struct run *run, struct eo_error *error)
{
  struct eo_design *design = calloc(1, sizeof *design);
  struct eo_case *pair = eo_case_find(run->file, "pair");
  struct eo_geometry geometry;
  if (!design)
    return eo_error_memory(error);
  if (pair)
    eo_case_design(pair, design);
  else
    eo_example_build("paper", design);
  enum eo_code code = eo_case_faulty(run->file) ? EO_OK : eo_geometry_init(&geometry, &design->gear_pair, error);
  for (int i = 0; i < design->load_cases && !code; i++) {
    double speed = design->load_case[i].speed;
    run->speed[0] = i && run->speed[0] < speed ? run->speed[0] : speed;
    run->speed[1] = fmax(run->speed[1], speed);
  }
  free(design);
  if (code || eo_case_faulty(run->file))
    return code;
  for (int i = 0; i < 2; i++) {
    run->settings.transmission.teeth[i] = geometry.teeth[i];
    run->settings.transmission.base_radius[i] = geometry.base_radius[i];
  }
  run->settings.stated_speed = NAN;
  memcpy(run->settings.expected_speed, run->speed, sizeof run->speed);
  read_settings(run->file, &run->settings);
  read_settings(eo_case_find(run->file, "mesh"), &run->settings);
  return EO_OK;
}

/* Every finding of the list, and none besides that repairs or refuses. */
static void check_findings(struct eo_verification *verification, struct eo_case *list, const struct eo_findings *found)
{
  bool expected[EO_FINDING_KINDS] = {false};
  int surprises = 0;
  if (!list)
    return;
  if (!eo_case_is_list(list))
    eo_case_fault(list, "A list of findings is expected here.");
  for (int i = 0; i < eo_case_size(list); i++) {
    enum eo_finding_kind kind;
    char quantity[100];
    if (!read_finding(eo_case_at(list, i), &kind))
      continue;
    const struct eo_case *value = eo_case_at(list, i);
    expected[kind] = true;
    snprintf(quantity, sizeof quantity, "finding %.60s",
             eo_case_is_text(value) ? json_string_value(eo_case_json(value)) : "of this kind");
    eo_verify_fact(verification, eo_case_at(list, i), quantity, eo_findings_find(found, kind) != NULL);
  }
  for (int i = 0; i < found->count && i < EO_MAX_FINDINGS; i++)
    if (found->finding[i].severity >= EO_SEVERITY_REPAIRED && !expected[found->finding[i].kind]) {
      surprises++;
      eo_verify_note(verification, "not expected: %s", found->finding[i].text);
    }
  eo_verify_fact(verification, list, "no other finding", surprises == 0);
}

/* An order may deviate by four standard deviations of the noise beside it. */
static void check_orders(struct eo_verification *verification, struct eo_case *truth, double relative,
                         const struct eo_transmission *transmission)
{
  const double deviations = 4;
  struct eo_case *amplitude = eo_case_find(truth, "line_amp_um"), *acceleration = eo_case_find(truth, "line_acc"),
                 *rms = eo_case_find(truth, "rms_by_H");
  struct eo_case *const lists[] = {amplitude, acceleration, rms};
  for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
    if (lists[i] && (!eo_case_is_list(lists[i]) || eo_case_size(lists[i]) > transmission->harmonics))
      eo_case_fault(lists[i], "A list of at most %d numbers, the orders measured, is expected here.",
                    transmission->harmonics);
  for (int h = 0; h < transmission->harmonics && !eo_case_faulty(truth); h++) {
    double noise = deviations * transmission->mesh[h].sigma,
           weight = pow(transmission->mesh[h].order * transmission->speed, 2);
    struct eo_case *a = eo_case_at(amplitude, h), *b = eo_case_at(acceleration, h);
    if (a)
      eo_verify_number(verification, a, 1e6 * cabs(transmission->mesh[h].amplitude), 0,
                       relative * fabs(eo_case_real(a)) + 1e6 * noise);
    if (b)
      eo_verify_number(verification, b, transmission->mesh[h].acceleration, 0,
                       relative * fabs(eo_case_real(b)) + weight * noise);
    eo_verify_number(verification, eo_case_at(rms, h), transmission->rms_upto[h], relative, 0);
  }
}

/* "rms", "rms_mesh_lines" and "rms_mesh_lines_H8": of all orders, or of so many. */
static void check_rms(struct eo_verification *verification, struct eo_case *truth, double relative,
                      const struct eo_measurement *measurement)
{
  static const char stem[] = "rms_mesh_lines";
  const struct eo_transmission *transmission = &measurement->transmission;
  for (int i = 0; i < eo_case_size(truth); i++) {
    const char *key = eo_case_key(eo_case_peek(truth, i));
    bool all = strcmp(key, "rms") == 0 || strcmp(key, stem) == 0;
    char *end = NULL;
    if (!all && (strncmp(key, stem, strlen(stem)) != 0 || strncmp(key + strlen(stem), "_H", 2) != 0))
      continue;
    long orders = all ? transmission->harmonics : strtol(key + strlen(stem) + 2, &end, 10);
    if (orders < 1 || (end && *end))
      eo_case_fault(eo_case_peek(truth, i), "The key says how many orders, like rms_mesh_lines_H8.");
    if (orders > transmission->harmonics && !measurement->refused)
      eo_verify_note(verification, "%s is compared with the %d orders that this recording shows.", key,
                     transmission->harmonics);
    int upto = orders > transmission->harmonics ? transmission->harmonics : (int)orders;
    eo_verify_number(verification, eo_case_peek(truth, i),
                     measurement->refused || upto < 1 ? NAN : transmission->rms_upto[upto - 1], relative, 0);
  }
}

static void check_numbers(struct eo_verification *verification, struct eo_case *item,
                          const struct eo_measurement *measurement)
{
  const double of_speed = 1e-4;
  struct eo_case *truth = eo_case_find(item, "truth");
  double relative = eo_case_relative_or(item, eo_case_find(item, "tolerance") ? "tolerance" : "tolerance_rms_rel",
                                        0.002);
  const struct eo_transmission *transmission = &measurement->transmission;
  if (!truth)
    return;
  if (eo_case_size(truth) == 0)
    eo_case_fault(truth, "Numbers are expected here.");
  if (measurement->refused) {
    eo_verify_fact(verification, truth, "measured, not refused", false);
    eo_case_skip(truth);
    return;
  }
  check_rms(verification, truth, relative, measurement);
  eo_verify_member(verification, eo_case_find(item, "reference_pipeline"), "rms_lines_ls", transmission->rms, relative,
                   0);
  eo_verify_member(verification, truth, "mean_rpm", transmission->speed * 30 / M_PI, of_speed, 0);
  check_orders(verification, truth, relative, transmission);
}

static const char *temporary_folder(void)
{
  const char *folder = getenv("TMPDIR");
  return folder ? folder : "/tmp";
}

/* The layout of the entry; lines per turn also as a key of their own or in the words of the note. */
static enum eo_code find_tracks(const struct run *run, struct eo_case *item, struct eo_recording **recording,
                                struct eo_notes *notes, struct eo_tracks *tracks, struct eo_error *error)
{
  static const char *const names[] = {"lines_per_rev", "lines", "lines_per_turn"};
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_layout_request layout;
  struct eo_case *stated = eo_case_find(item, "layout");
  double lines = eo_case_count(item, "note", " lines", 0);
  if (!faults)
    return eo_error_memory(error);
  eo_layout_decode(eo_case_json(stated), &layout, faults);
  eo_case_skip(stated); /* the decoder refuses what it does not know */
  for (int i = 0; i < faults->count && i < EO_MAX_FAULTS; i++)
    eo_case_fault(stated, "%s: %s", faults->fault[i].pointer, faults->fault[i].text);
  free(faults);
  for (size_t i = sizeof names / sizeof *names; i-- > 0;)
    lines = eo_case_number_or(item, names[i], lines);
  for (int i = 0; i < 2; i++)
    layout.choice.lines[i] = layout.choice.lines[i] > 0 ? layout.choice.lines[i] : lines;
  struct eo_layout_pair pair = {.teeth = {run->settings.transmission.teeth[0], run->settings.transmission.teeth[1]},
                                .speed = {run->speed[0], run->speed[1]}};
  return eo_case_faulty(item)
             ? EO_OK
             : eo_layout_find(recording, &layout.choice, &pair, temporary_folder(), tracks, notes, error);
}

/* A recording with such a finding has no numbers. */
static bool refusal_expected(struct eo_case *item)
{
  static const enum eo_finding_kind refusing[] = {EO_FINDING_SLIP,      EO_FINDING_TEETH, EO_FINDING_CONSTANT,
                                                  EO_FINDING_TOO_SHORT, EO_FINDING_TIME,  EO_FINDING_SAMPLE_RATE,
                                                  EO_FINDING_SATURATED, EO_FINDING_UNITS};
  struct eo_case *list = eo_case_find(item, "expected_findings");
  bool expected = eo_case_flag_or(item, "refusal_accepted", false) || eo_case_flag_or(item, "refused", false);
  for (int i = 0; i < eo_case_size(list); i++) {
    enum eo_finding_kind kind;
    if (read_finding(eo_case_at(list, i), &kind))
      for (size_t k = 0; k < sizeof refusing / sizeof *refusing; k++)
        expected = expected || kind == refusing[k];
  }
  return expected;
}

static void check_measurement(struct eo_verification *verification, struct eo_case *item,
                              const struct eo_measurement *measurement)
{
  bool accepted = refusal_expected(item);
  eo_verify_exact(verification, eo_case_find(item, "refused"), measurement->refused);
  check_findings(verification, eo_case_find(item, "expected_findings"), &measurement->findings);
  if (measurement->refused && accepted) {
    eo_verify_fact(verification, item, "refused, as may be", true);
    eo_verify_uncompared(verification, eo_case_find(item, "truth"), "the recording is refused, as it may be.");
    eo_case_relative_or(item, eo_case_find(item, "tolerance") ? "tolerance" : "tolerance_rms_rel", 0.002);
  } else
    check_numbers(verification, item, measurement);
}

/* What is read and measured of one file. */
struct file {
  struct eo_measurement *measurement;
  struct eo_recording *recording;
  struct eo_notes *notes;
  char *path;
};

static enum eo_code measure_file(struct run *run, struct eo_case *item, const struct eo_measurement_settings *settings,
                                 struct file *file, struct eo_error *error)
{
  struct eo_tracks tracks;
  const struct eo_reader_options options = {.spool_directory = temporary_folder()};
  file->measurement = calloc(1, sizeof *file->measurement);
  file->notes = calloc(1, sizeof *file->notes);
  if (!file->measurement || !file->notes || !file->path)
    return eo_error_memory(error);
  EO_TRY(eo_reader_read(file->path, &options, &file->recording, file->notes, error));
  EO_TRY(find_tracks(run, item, &file->recording, file->notes, &tracks, error));
  if (eo_case_faulty(item))
    return EO_OK;
  EO_TRY(eo_measurement_run(file->measurement, file->recording, &tracks, settings, NULL, error));
  if (!eo_case_faulty(item))
    check_measurement(run->v, item, file->measurement);
  return EO_OK;
}

static enum eo_code run_file(void *context, struct eo_case *item, struct eo_error *error)
{
  struct run *run = context;
  struct eo_measurement_settings settings = run->settings;
  const char *name = eo_case_word(item, "file");
  eo_case_remark(item, "columns");
  read_settings(item, &settings);
  if (eo_case_faulty(item))
    return EO_OK;
  struct file file = {.path = eo_verify_path(run->v, name)};
  enum eo_code code = measure_file(run, item, &settings, &file, error);
  if (code == EO_ERROR_INPUT && refusal_expected(item)) { /* a question instead of a number */
    eo_verify_uncompared(run->v, eo_case_find(item, "truth"), error->text);
    eo_verify_fact(run->v, item, "refused, as may be", true);
    eo_case_relative_or(item, eo_case_find(item, "tolerance") ? "tolerance" : "tolerance_rms_rel", 0.002);
    code = EO_OK;
  }
  if (file.measurement)
    eo_measurement_done(file.measurement);
  eo_recording_free(file.recording);
  free(file.path);
  free(file.notes);
  free(file.measurement);
  return code;
}

static const struct eo_verify_block blocks[] = {
    {"files", EO_BLOCK_EACH, run_file},
    {"pair", EO_BLOCK_INPUT, NULL},
    {"teeth", EO_BLOCK_INPUT, NULL},
    {"z", EO_BLOCK_INPUT, NULL},
    {"z1", EO_BLOCK_INPUT, NULL},
    {"z2", EO_BLOCK_INPUT, NULL},
    {"rb1_mm", EO_BLOCK_INPUT, NULL},
    {"rb2_mm", EO_BLOCK_INPUT, NULL},
    {"rb1_m", EO_BLOCK_INPUT, NULL},
    {"rb2_m", EO_BLOCK_INPUT, NULL},
    {"base_radius_mm", EO_BLOCK_INPUT, NULL},
    {"harmonics", EO_BLOCK_INPUT, NULL},
    {"H", EO_BLOCK_INPUT, NULL},
    {"speed_rpm", EO_BLOCK_INPUT, NULL},
    {"stated_rpm", EO_BLOCK_INPUT, NULL},
    {"mesh_order_line", EO_BLOCK_REMARKS, NULL},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_encoder(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct run run = {.file = file, .v = verification};
  eo_case_need(file, "files");
  enum eo_code code = set_pair(&run, error);
  return code || eo_case_faulty(file) ? code : eo_verify_blocks(verification, file, blocks, &run, error);
}
