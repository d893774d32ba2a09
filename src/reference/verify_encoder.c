/* Reference recordings of two encoders: findings, RMS and orders of the mesh against the truth they were made from. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/case_pair.h"
#include "reference/verify.h"
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
  const json_t *file;
  struct eo_verification *v;
  struct eo_measurement_settings settings; /* of the file as a whole */
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

/* A finding is named by a text, or by the first text in an object. */
static const char *finding_text(const json_t *value)
{
  const char *key;
  json_t *member;
  if (json_is_object(value) && !json_object_get(value, "kind"))
    json_object_foreach((json_t *)value, key, member) if (json_is_string(member)) return json_string_value(member);
  return json_string_value(json_is_object(value) ? json_object_get(value, "kind") : value);
}

static double either(const json_t *object, const char *key, const char *other, double missing)
{
  double value = eo_verify_number(object, key);
  return isnan(value) ? eo_verify_number_or(object, other, missing) : value;
}

/* "teeth": [17, 44], under this key or one that has "teeth" in it or is "z...". */
static double teeth_of(const json_t *object, int member)
{
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key,
                      value) if ((strstr(key, "teeth") || key[0] == 'z') && json_array_size(value) == 2 &&
                                 json_is_integer(json_array_get(value, 0))) return eo_verify_at(value, (size_t)member);
  return NAN;
}

/* Tooth numbers, radii, orders and speed as an object states them; what it leaves out stays. */
static void read_settings(const json_t *object, struct eo_measurement_settings *s)
{
  static const char *const teeth[2] = {"z1", "z2"}, *const radius[2] = {"rb1_mm", "rb2_mm"},
                           *const metre[2] = {"rb1_m", "rb2_m"};
  struct eo_transmission_settings *t = &s->transmission;
  for (int i = 0; i < 2; i++) {
    double count = either(object, teeth[i], teeth[i], NAN);
    if (isnan(count))
      count = teeth_of(object, i);
    if (count > 0)
      t->teeth[i] = (int)count;
    double length = eo_verify_number(object, radius[i]);
    t->base_radius[i] = isnan(length) ? eo_verify_number_or(object, metre[i], t->base_radius[i]) : 1e-3 * length;
    length = eo_verify_element(object, "base_radius_mm", i);
    t->base_radius[i] = isnan(length) ? t->base_radius[i] : 1e-3 * length;
  }
  t->harmonics = (int)either(object, "harmonics", "H", t->harmonics);
  double speed = either(object, "speed_rpm", "stated_rpm", NAN);
  s->stated_speed = isnan(speed) ? s->stated_speed : speed * M_PI / 30;
}

/* The paper's pair unless the file says otherwise. */
static enum eo_code set_pair(struct run *r, struct eo_error *error)
{
  struct eo_design *design = calloc(1, sizeof *design);
  const json_t *pair = json_object_get(r->file, "pair");
  struct eo_geometry geometry;
  enum eo_code code = design ? EO_OK : eo_error_memory(error);
  if (!code && json_is_object(pair) && json_object_get(pair, "mn"))
    code = eo_case_design(pair, design, error);
  else if (!code)
    eo_example_build("paper", design);
  if (!code)
    code = eo_geometry_init(&geometry, &design->gear_pair, error);
  for (int i = 0; i < 2 && !code; i++) {
    r->settings.transmission.teeth[i] = geometry.teeth[i];
    r->settings.transmission.base_radius[i] = geometry.base_radius[i];
  }
  r->settings.stated_speed = NAN;
  read_settings(r->file, &r->settings);
  read_settings(json_object_get(r->file, "mesh"), &r->settings);
  free(design);
  return code;
}

/* ---- what is expected ---- */

static bool among(const struct eo_findings *findings, enum eo_finding_kind kind)
{
  return eo_findings_find(findings, kind) != NULL;
}

static void check_findings(struct eo_verification *v, const char *label, const json_t *item,
                           const struct eo_findings *found)
{
  bool expected[EO_FINDING_KINDS] = {false};
  size_t index;
  json_t *value;
  int surprises = 0;
  if (!json_is_array(json_object_get(item, "expected_findings")))
    return;
  json_array_foreach(json_object_get(item, "expected_findings"), index, value)
  {
    const char *text = finding_text(value);
    enum eo_finding_kind kind;
    char quantity[120];
    if (!text || !finding_kind(text, &kind)) {
      eo_verify_ignore(v, "%s: \"%.60s\" is not a finding", label, text ? text : "(no text)");
      continue;
    }
    expected[kind] = true;
    snprintf(quantity, sizeof quantity, "finding %.60s", text);
    eo_verify_add(v, label, quantity, among(found, kind), 1, 0);
  }
  for (int i = 0; i < found->count && i < EO_MAX_FINDINGS; i++)
    if (found->finding[i].severity >= EO_SEVERITY_REPAIRED && !expected[found->finding[i].kind]) {
      surprises++;
      eo_verify_ignore(v, "%s: not expected: %s", label, found->finding[i].text);
    }
  eo_verify_add(v, label, "findings not expected", surprises, 0, 0);
}

/* An order may deviate by four standard deviations of the noise beside it. */
static void check_orders(struct eo_verification *v, const char *label, const json_t *truth, double relative,
                         const struct eo_transmission *t)
{
  for (int h = 0; h < t->harmonics; h++) {
    char quantity[60];
    double amplitude = eo_verify_element(truth, "line_amp_um", h),
           acceleration = eo_verify_element(truth, "line_acc", h), rms = eo_verify_element(truth, "rms_by_H", h);
    double noise = 4 * t->mesh[h].sigma, weight = pow(t->mesh[h].order * t->speed, 2);
    snprintf(quantity, sizeof quantity, "amplitude of mesh order %d", h + 1);
    if (!isnan(amplitude))
      eo_verify_add(v, label, quantity, 1e6 * cabs(t->mesh[h].amplitude), amplitude,
                    relative * amplitude + 1e6 * noise);
    snprintf(quantity, sizeof quantity, "acceleration of mesh order %d", h + 1);
    if (!isnan(acceleration))
      eo_verify_add(v, label, quantity, t->mesh[h].acceleration, acceleration,
                    relative * acceleration + weight * noise);
    snprintf(quantity, sizeof quantity, "RMS of %d orders", h + 1);
    if (!isnan(rms))
      eo_verify_add(v, label, quantity, t->rms_upto[h], rms, relative * rms);
  }
}

static double stated_rms(const json_t *truth, int *orders)
{
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)truth, key, value) if (strncmp(key, "rms_mesh_lines", 14) == 0 && json_is_number(value))
  {
    const char *count = strstr(key, "_H");
    *orders = count ? atoi(count + 2) : 0;
    return json_number_value(value);
  }
  *orders = 0;
  return eo_verify_number(truth, "rms");
}

static void check_numbers(struct eo_verification *v, const char *label, const json_t *item,
                          const struct eo_measurement *m)
{
  static const char *const known[] = {"mean_rpm", "line_amp_um", "line_acc", "rms_by_H", "rms", NULL};
  const json_t *truth = json_object_get(item, "truth"), *reference = json_object_get(item, "reference_pipeline");
  double relative = either(item, "tolerance_rms_rel", "tolerance", 0.002), speed = eo_verify_number(truth, "mean_rpm");
  const struct eo_transmission *t = &m->transmission;
  int orders;
  double rms = stated_rms(truth, &orders), other = eo_verify_number(reference, "rms_lines_ls");
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)truth, key, value)
  {
    bool read = strncmp(key, "rms_mesh_lines", 14) == 0;
    for (int i = 0; known[i]; i++)
      read = read || strcmp(key, known[i]) == 0;
    if (!read)
      eo_verify_ignore(v, "%s: truth: \"%s\" is not read", label, key);
  }
  int upto = orders > 0 && orders <= t->harmonics ? orders : t->harmonics;
  if (!isnan(rms))
    eo_verify_add(v, label, "RMS", m->refused || upto < 1 ? NAN : t->rms_upto[upto - 1], rms, relative * rms);
  if (m->refused)
    return;
  if (!isnan(other))
    eo_verify_add(v, label, "RMS beside the reference's least squares", t->rms, other, relative * other);
  if (!isnan(speed))
    eo_verify_add(v, label, "mean speed", t->speed * 30 / M_PI, speed, 1e-4 * speed);
  check_orders(v, label, truth, relative, t);
}

/* ---- one recording ---- */

/* The layout of the entry; lines per turn also as a key of their own or in the words of the note. */
static enum eo_code find_tracks(const json_t *item, const struct eo_recording *recording, struct eo_notes *notes,
                                struct eo_tracks *tracks, struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_layout_request layout;
  const char *note = json_string_value(json_object_get(item, "note"));
  if (!faults)
    return eo_error_memory(error);
  eo_layout_decode(json_object_get(item, "layout"), &layout, faults);
  double stated = eo_case_count(note ? note : "", " lines", 0);
  double lines = either(item, "lines_per_rev", "lines", either(item, "lines_per_turn", "lines_per_turn", stated));
  for (int i = 0; i < 2; i++)
    layout.choice.lines[i] = layout.choice.lines[i] > 0 ? layout.choice.lines[i] : lines;
  enum eo_code code = eo_faults_first(faults, error);
  free(faults);
  return code ? code : eo_layout_find(recording, &layout.choice, tracks, notes, error);
}

static bool refusal_expected(const json_t *item)
{
  size_t index;
  json_t *value;
  if (json_is_true(json_object_get(item, "refused")))
    return true;
  json_array_foreach(json_object_get(item, "expected_findings"), index, value)
  {
    const char *text = finding_text(value);
    enum eo_finding_kind kind;
    if (text && finding_kind(text, &kind) &&
        (kind == EO_FINDING_SLIP || kind == EO_FINDING_TEETH || kind == EO_FINDING_CONSTANT ||
         kind == EO_FINDING_TOO_SHORT || kind == EO_FINDING_TIME || kind == EO_FINDING_SAMPLE_RATE ||
         kind == EO_FINDING_SATURATED || kind == EO_FINDING_UNITS))
      return true;
  }
  return false;
}

static enum eo_code run_file(struct run *r, const json_t *item, const char *label, struct eo_error *error)
{
  struct eo_measurement_settings settings = r->settings;
  struct eo_measurement *m = calloc(1, sizeof *m);
  struct eo_recording *recording = NULL;
  struct eo_notes *notes = calloc(1, sizeof *notes);
  struct eo_tracks tracks;
  char *path = eo_verify_path(r->v, label);
  enum eo_code code = m && notes && path ? eo_reader_read(path, NULL, &recording, notes, error)
                                         : eo_error_memory(error);
  read_settings(item, &settings);
  if (!code)
    code = find_tracks(item, recording, notes, &tracks, error);
  if (!code)
    code = eo_measurement_run(m, recording, &tracks, &settings, NULL, error);
  if (!code) {
    check_findings(r->v, label, item, &m->findings);
    if (!m->refused || !refusal_expected(item))
      check_numbers(r->v, label, item, m);
  }
  if (m)
    eo_measurement_done(m);
  eo_recording_free(recording);
  free(path);
  free(notes);
  free(m);
  return code;
}

enum eo_code eo_verify_encoder(const json_t *file, struct eo_verification *v, struct eo_error *error)
{
  static const char *const known[] = {"file",
                                      "note",
                                      "truth",
                                      "tolerance_rms_rel",
                                      "expected_findings",
                                      "reference_pipeline",
                                      "layout",
                                      "lines",
                                      "lines_per_turn",
                                      "lines_per_rev",
                                      "teeth",
                                      "z",
                                      "z1",
                                      "z2",
                                      "speed_rpm",
                                      "stated_rpm",
                                      "harmonics",
                                      "H",
                                      "refused",
                                      "columns",
                                      NULL};
  struct run r = {.file = file, .v = v};
  enum eo_code code = set_pair(&r, error);
  size_t index;
  json_t *item;
  if (code)
    return code;
  if (!json_is_array(json_object_get(file, "files")))
    return eo_error_set(error, EO_ERROR_INPUT, "/files", "An encoder case file needs a list of files.");
  json_array_foreach(json_object_get(file, "files"), index, item)
  {
    const char *label = json_string_value(json_object_get(item, "file"));
    code = label ? run_file(&r, item, label, error)
                 : eo_error_set(error, EO_ERROR_INPUT, "", "The entry names no file.");
    if (code && code != EO_ERROR_INPUT && code != EO_ERROR_NUMERIC && code != EO_ERROR_FILE)
      return code;
    if (code) /* this file alone */
      eo_verify_broken(v, label ? label : "(no file)", error);
    eo_verify_unknown(v, label ? label : "(no file)", item, known);
  }
  return EO_OK;
}
