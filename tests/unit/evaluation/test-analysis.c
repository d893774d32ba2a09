/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The analysis and its result document, on a compliance in closed form: what it must not depend on, what must agree
   with what, and every name that is relied on. */
#include <stdlib.h>

#include "support/contract.h"
#include "document/examples.h"
#include "document/result.h"
#include "flexibility/closed_form.h"
#include "support/tap.h"

enum { ALL = EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES | EO_WANT_RATING };

static const struct eo_closed_form form = {
    .compliance = 1.5e-9, .length = 12e-3, .centre = -0.8e-3, .linear = 20, .quadratic = 4000};

struct subject {
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_pair *pair;
  struct eo_analysis *analysis;
};

static void complete(struct subject *s)
{
  struct eo_error error;
  if (eo_design_complete(&s->design, &s->geometry, &error))
    printf("# %s: %s\n", error.pointer, error.text);
}

static struct subject *start_at(const char *example, int positions)
{
  struct subject *s = calloc(1, sizeof *s);
  struct eo_error error;
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  eo_example_build(example, &s->design);
  s->design.resolution.positions = positions;
  s->design.resolution.te_harmonics = positions > 20 ? 10 : positions / 2 - 1;
  s->design.resolution.cells_per_line = 20;
  complete(s);
  if (eo_pair_new(&s->pair, &s->design, &options, NULL, &error) || eo_analysis_new(&s->analysis, s->pair, &error))
    printf("Bail out! %s\n", error.text);
  return s;
}

static struct subject *start(const char *example)
{
  return start_at(example, 32);
}

static void end(struct subject *s)
{
  eo_analysis_free(s->analysis);
  eo_pair_free(s->pair);
  free(s);
}

/* The document as compact text without the timing. */
static struct eo_text run(struct subject *s)
{
  struct eo_error error;
  struct eo_text text = {0};
  if (eo_analysis_run(s->analysis, &s->design, ALL, &error)) {
    printf("# %s: %s\n", error.pointer, error.text);
    return text;
  }
  json_t *result = eo_result_encode(s->analysis, &s->design, NULL);
  json_object_del(result, "timing_ms");
  eo_json_write(&text, result, EO_JSON_COMPACT);
  json_decref(result);
  return text;
}

static bool same(struct eo_text *a, struct eo_text *b)
{
  bool equal = a->size && a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
  eo_text_done(a);
  eo_text_done(b);
  return equal;
}

static json_t *result_of(struct subject *s)
{
  struct eo_error error;
  return eo_analysis_run(s->analysis, &s->design, ALL, &error) ? NULL : eo_result_encode(s->analysis, &s->design, NULL);
}

static double last(const json_t *result, const char *path)
{
  const json_t *cases = json_object_get(result, "load_cases");
  return eo_json_find_number(json_array_get(cases, json_array_size(cases) - 1), path);
}

static void check_names(const char *example, int ends)
{
  struct subject *s = start(example);
  json_t *result = result_of(s);
  ok(result && contract_check(result, ends, false) == 0, "%s has every name that is relied on", example);
  json_decref(result);
  end(s);
}

/* Results depend on the design alone: not on what was analysed before, nor on what is remembered. */
static void check_memory(void)
{
  struct subject *s = start("paper-case-a"), *fresh = start("paper-case-a");
  struct eo_text first = run(s);
  double spent = s->analysis->unmodified_ms;
  struct eo_text again = run(s);
  ok(spent > 0 && s->analysis->unmodified_ms == 0, "the unmodified pair is evaluated once");
  ok(same(&first, &again), "a second run gives the same bytes");
  s->design.modification.flank[EO_PINION][EO_LEFT].tip_relief *= 2;
  s->design.alignment.shaft_angle_in_plane = 0;
  s->design.load_cases = 2;
  struct eo_text other = run(s);
  ok(s->analysis->unmodified_ms > 0, "another alignment has another unmodified pair");
  eo_text_done(&other);
  s->design = fresh->design;
  struct eo_text back = run(s), expected = run(fresh);
  ok(same(&back, &expected), "another design in between leaves the bytes");
  end(s);
  end(fresh);
}

/* The document by parts, on two threads, is the document. */
static void check_writing(void)
{
  struct subject *s = start("paper-case-b");
  struct eo_error error;
  s->analysis->threads = 2;
  eo_analysis_run(s->analysis, &s->design, ALL, &error);
  static const unsigned lean = EO_RESULT_NO_HISTORIES | EO_RESULT_NO_LTE | EO_RESULT_NO_SHARES | EO_RESULT_NO_TRIBOLOGY;
  const unsigned some[] = {0, 1, 2, 3, lean, lean | EO_RESULT_CURVES_OF(1), ~EO_RESULT_NO_LTE & 0x7ff};
  for (size_t i = 0; i < sizeof some / sizeof *some; i++) {
    unsigned left_out = some[i];
    struct eo_text whole = {0}, parts = {0};
    json_t *document = eo_result_encode_part(s->analysis, &s->design, NULL, left_out);
    eo_json_write(&whole, document, EO_JSON_COMPACT);
    enum eo_code code = eo_result_write(s->analysis, &s->design, NULL, left_out, &parts, &error);
    size_t size = whole.size;
    ok(!code && same(&whole, &parts), "an answer written by parts has the same %zu bytes", size);
    json_decref(document);
  }
  end(s);
}

/* What two documents have in common is the same, but for nulls in the leaner one. Returns the number of faults. */
static int differences(const json_t *full, const json_t *lean)
{
  int count = 0;
  const char *key;
  json_t *value;
  size_t index;
  if (json_is_null(lean))
    return 0;
  if (json_is_object(full) && json_is_object(lean)) {
    json_object_foreach((json_t *)full, key, value) count += differences(value, json_object_get(lean, key));
    return count;
  }
  if (json_is_array(full) && json_array_size(full) == json_array_size(lean)) {
    json_array_foreach((json_t *)full, index, value) count += differences(value, json_array_get(lean, index));
    return count;
  }
  return !json_equal(full, lean);
}

/* A slider's step: the curves on screen of one load case. Every number is still there. */
static void check_lean(void)
{
  struct subject *s = start("paper-case-b");
  struct eo_error error;
  struct eo_text text = {0};
  eo_analysis_run(s->analysis, &s->design, EO_WANT_CURVES | EO_WANT_ROOT, &error);
  const unsigned lean = EO_RESULT_NO_HISTORIES | EO_RESULT_NO_TRIBOLOGY | EO_RESULT_NO_FACE_LOAD |
                        EO_RESULT_NO_UNLOADED | EO_RESULT_NO_DESIGN | EO_RESULT_CURVES_OF(1);
  json_t *full = eo_result_encode(s->analysis, &s->design, NULL);
  json_t *part = eo_result_encode_part(s->analysis, &s->design, NULL, lean);
  json_t *cases = json_object_get(part, "load_cases");
  eo_json_write(&text, part, EO_JSON_COMPACT);
  ok(text.size < 60000, "a slider's step takes %zu bytes, at most 60000", text.size);
  json_object_del(full, "timing_ms");
  ok(differences(full, part) == 0, "what stands in a slider's step is what the full answer says");
  for (int k = 0; k < 3; k++) {
    json_t *one = json_array_get(cases, (size_t)k), *lte = json_object_get(one, "lte");
    ok(json_is_array(json_object_get(lte, "pair_um")) == (k == 1) &&
           json_is_number(json_object_get(lte, "peak_to_peak_um")),
       "load case %d has its numbers, and curves only if it is number 1", k);
  }
  eo_text_done(&text);
  json_decref(full);
  json_decref(part);
  end(s);
}

/* Two threads, ends that change one at a time, ends that become equal, ends that share their load, bodies that bend,
   impacts in the motion: the same bytes as a new analysis gives on one thread. */
static void check_threads(void)
{
  struct subject *s = start("paper-case-b");
  int different = 0;
  s->analysis->threads = 2;
  for (int i = 0; i < 9; i++) {
    struct eo_modification *m = &s->design.modification;
    if (i == 1 || i == 3)
      m->flank[EO_PINION][EO_RIGHT].tip_relief += 1e-6;
    if (i == 2)
      m->flank[EO_PINION][EO_LEFT].root_relief += 1e-6;
    if (i == 4)
      s->design.alignment.shaft_angle_in_plane = 0;
    if (i >= 4)
      m->flank[EO_PINION][EO_RIGHT] = m->flank[EO_PINION][EO_LEFT];
    if (i >= 5)
      m->flank[EO_PINION][EO_RIGHT].lead_crowning += 1e-6;
    s->design.alignment.pinion_axial = i == 6 ? EO_AXIAL_FIXED : EO_AXIAL_FLOATING;
    s->design.shafts.enabled = i == 7;
    s->design.resolution.impact_in_dynamics = i == 8 ? EO_IMPACT_CONSISTENT : EO_IMPACT_NONE;
    struct subject *fresh = start("paper-case-b");
    fresh->design = s->design;
    struct eo_text here = run(s), there = run(fresh);
    different += !same(&here, &there);
    end(fresh);
  }
  ok(different == 0, "an answer on two threads, end by end, has the bytes of one made anew on one");
  end(s);
}

static void check_unmodified(void)
{
  struct subject *s = start("paper");
  json_t *result = result_of(s);
  close_to(eo_json_find_number(result, "objectives/J"), 1, 1e-12, "J of the unmodified pair");
  close_to(eo_json_find_number(result, "objectives/fitness"), 1, 1e-12, "fitness of the unmodified pair");
  ok(eo_json_find_number(result, "objectives/f2_N") == eo_json_find_number(result, "objectives/unmodified/f2_N"),
     "the unmodified pair is its own reference");
  json_decref(result);
  end(s);
}

/* f_i = sum share value / number of cases, J = sum w f / f(unmodified), from the document's own numbers. */
static void check_objectives(void)
{
  static const char *const value[3] = {"peak_to_peak_um", "impact_N", "rms_m_per_s2"}, *const sum[3] = {"f1_um", "f2_N",
                                                                                                        "f3_m_per_s2"};
  static const double weight[3] = {0.4, 0.15, 0.45}, share[3] = {0.2, 0.5, 0.3};
  struct subject *s = start("paper-case-b");
  json_t *result = result_of(s);
  const json_t *after = json_object_get(result, "objectives"), *before = json_object_get(after, "unmodified");
  double objective = 0;
  for (int i = 0; i < 3; i++) {
    double f = 0, reference = 0;
    for (size_t k = 0; k < 3; k++) {
      f += share[k] * eo_json_find_number(json_array_get(json_object_get(after, "load_cases"), k), value[i]) / 3;
      reference += share[k] * eo_json_find_number(json_array_get(json_object_get(before, "load_cases"), k), value[i]) /
                   3;
    }
    near(eo_json_find_number(after, sum[i]), f, 1e-10, sum[i]);
    objective += weight[i] * f / reference;
  }
  near(eo_json_find_number(after, "J"), objective, 1e-10, "J of the pair");
  near(eo_json_find_number(after, "fitness"), 1 / objective, 1e-10, "fitness of the pair");
  json_decref(result);
  end(s);
}

/* Columns against the single numbers beside them. */
static void check_columns(void)
{
  struct subject *s = start("paper-case-b");
  s->design.alignment.stagger = 0.25;
  complete(s);
  json_t *result = result_of(s);
  const json_t *c = json_array_get(json_object_get(result, "load_cases"), 1);
  const json_t *pair = eo_json_find(c, "lte/pair_um"), *left = eo_json_find(c, "lte/left_um"),
               *right = eo_json_find(c, "lte/right_um");
  double worst = 0, low = INFINITY, high = -INFINITY, missing = 0, force = 0;
  for (size_t j = 0; j < json_array_size(pair); j++) {
    double z = json_number_value(json_array_get(pair, j)), sum = 0;
    worst =
        fmax(worst,
             fabs(z - (json_number_value(json_array_get(left, j)) + json_number_value(json_array_get(right, j))) / 2));
    low = fmin(low, z);
    high = fmax(high, z);
    for (size_t i = 0; i < json_array_size(eo_json_find(c, "contact/load_share/right")); i++)
      sum += json_number_value(json_array_get(json_array_get(eo_json_find(c, "contact/load_share/right"), i), j));
    missing = fmax(missing, fabs(sum - 1));
  }
  close_to(worst, 0, 1e-6, "the pair's transmission error is the mean of the ends', um, staggered too");
  close_to(high - low, eo_json_find_number(c, "lte/peak_to_peak_um"), 1e-6,
           "peak to peak of the pair's transmission error, um");
  close_to(missing, 0, 1e-6, "sum of the shares of the tooth pairs");
  const json_t *history = eo_json_find(c, "vibration/left/history/normal_m_per_s2");
  for (size_t i = 0; i < json_array_size(history); i++)
    force += pow(json_number_value(json_array_get(history, i)), 2) / (double)json_array_size(history);
  near(sqrt(force), eo_json_find_number(c, "vibration/left/rms_m_per_s2/normal"), 1e-4,
       "RMS of the acceleration's history");
  const json_t *orders = eo_json_find(c, "vibration/left/orders/normal_m_per_s2");
  force = 0;
  for (size_t i = 1; i < json_array_size(orders); i++)
    force += pow(json_number_value(json_array_get(orders, i)), 2) / 2;
  near(sqrt(force), eo_json_find_number(c, "vibration/left/rms_m_per_s2/normal"), 1e-4,
       "RMS of the acceleration's orders");
  const json_t *band = eo_json_find(c, "vibration/rms_band_m_per_s2/normal");
  double rms = eo_json_find_number(c, "vibration/rms_m_per_s2/normal");
  ok(json_number_value(json_array_get(band, 0)) <= rms && rms <= json_number_value(json_array_get(band, 1)) &&
         json_number_value(json_array_get(band, 0)) < json_number_value(json_array_get(band, 1)),
     "the band encloses the RMS");
  json_decref(result);
  end(s);
}

static bool warns(const json_t *result, const char *text)
{
  const json_t *warnings = json_object_get(result, "warnings");
  for (size_t i = 0; i < json_array_size(warnings); i++)
    if (strstr(json_string_value(json_array_get(warnings, i)), text))
      return true;
  return false;
}

static void check_warnings(void)
{
  struct subject *s = start("paper");
  s->design.objective.peak_to_peak = 1e-8;
  json_t *result = result_of(s);
  ok(warns(result, "Edge contact at 828 N m and 2000 rpm, right end"),
     "a warning tells of edge contact, with its place");
  ok(warns(result, "limit on the peak-to-peak transmission error is exceeded"), "a warning tells of a violated limit");
  ok(eo_json_find_number(result, "objectives/violation") > 0 && eo_json_find_number(result, "objectives/fitness") < 1,
     "a violated limit costs fitness");
  json_decref(result);
  s->design.load_cases = 1;
  s->design.load_case[0].torque = 20;
  s->design.load_case[0].speed = 560;
  s->design.load_case[0].share = 1;
  result = result_of(s);
  const char *outcome =
      json_string_value(eo_json_find(json_array_get(json_object_get(result, "load_cases"), 0), "outcome"));
  ok(outcome && strcmp(outcome, "contact_lost") == 0 && warns(result, "Contact is lost at 20 N m") &&
         last(result, "vibration/contact_loss") > 0,
     "lost contact is an outcome: %s", outcome ? outcome : "none");
  json_decref(result);
  end(s);
}

/* A pinion held axially by bearings that do not give, at a large shaft angle error: one end carries nothing, and there
   is no secant stiffness about its load. */
static void check_failure(void)
{
  struct subject *s = start_at("paper", 8);
  struct eo_error error;
  s->design.load_cases = 1;
  s->design.load_case[0].torque = 50;
  s->design.alignment.pinion_axial = EO_AXIAL_FIXED;
  s->design.resolution.mesh_law = EO_LAW_SECANT;
  eo_supports_make_rigid(&s->design.supports);
  json_t *result = eo_analysis_run(s->analysis, &s->design, 0, &error)
                       ? NULL
                       : eo_result_encode(s->analysis, &s->design, NULL);
  ok(json_is_null(eo_json_find(result, "objectives/J")) && warns(result, "No stable periodic vibration was found"),
     "what has no vibration has no J, and says so");
  ok(json_is_null(eo_json_find(result, "eigenfrequencies_Hz")), "what was not asked for is null");
  json_decref(result);
  end(s);
}

static void check_robust(void)
{
  struct subject *s = start("paper-case-a");
  s->design.objective.robust = EO_ROBUST_MEAN;
  complete(s);
  json_t *result = result_of(s);
  ok(eo_json_find_number(result, "objectives/scenarios") == 7, "seven scenarios by default");
  double mean = eo_json_find_number(result, "objectives/J"), rms = last(result, "vibration/rms_m_per_s2/normal");
  json_decref(result);
  s->design.objective.robust = EO_ROBUST_WORST;
  result = result_of(s);
  ok(eo_json_find_number(result, "objectives/J") > mean, "the worst scenario is worse than the mean");
  ok(last(result, "vibration/rms_m_per_s2/normal") == rms,
     "the curves stay those of the nominal alignment under scenarios");
  json_decref(result);
  end(s);
}

/* A number of the first load case's left end. */
static double rated(const json_t *result, const char *path)
{
  return eo_json_find_number(json_array_get(eo_json_find(result, "rating/load_cases"), 0), path);
}

static void check_rating(void)
{
  struct subject *s = start("shifted");
  json_t *result = result_of(s), *none;
  const json_t *first = json_array_get(json_object_get(result, "load_cases"), 0);
  double worse =
      fmax(json_number_value(json_array_get(eo_json_find(json_array_get(eo_json_find(result, "rating/load_cases"), 0),
                                                         "left/computed/K_Hbeta_tolerances"),
                                            0)),
           json_number_value(json_array_get(eo_json_find(json_array_get(eo_json_find(result, "rating/load_cases"), 0),
                                                         "left/computed/K_Hbeta_tolerances"),
                                            1)));
  ok(json_is_true(eo_json_find(result, "rating/verdict/passes")), "a sound pair passes");
  ok(rated(result, "left/computed/K_Hbeta") == eo_json_find_number(first, "contact/face_load/K_Hbeta/left"),
     "K_Hbeta as designed is that of the load over the face");
  ok(rated(result, "left/used/K_Hbeta") == worse && worse > rated(result, "left/computed/K_Hbeta"),
     "the worse direction of the tolerances rates: %.4g", worse);
  near(rated(result, "left/pinion/sigma_H_MPa"),
       rated(result, "left/sigma_H0_MPa") * rated(result, "left/pinion/Z_BD") *
           sqrt(rated(result, "left/K_gamma") * rated(result, "left/used/K_V") * rated(result, "left/used/K_Hbeta") *
                rated(result, "left/used/K_Halpha")),
       1e-9, "sigma_H of the numbers that stand beside it");
  double loss = eo_json_find_number(json_array_get(eo_json_find(result, "tribology/load_cases"), 0), "power_loss_W");
  double power = s->design.load_case[0].torque * s->design.load_case[0].speed;
  ok(loss > 0.001 * power && loss < 0.03 * power, "friction takes %.3g %% of the power", 100 * loss / power);
  json_decref(result);
  for (int k = 0; k < s->design.load_cases; k++)
    s->design.load_case[k].hours = 100 * (k + 1);
  result = result_of(s);
  double hours = 100. * s->design.load_cases * (s->design.load_cases + 1) / 2;
  near(eo_json_find_number(result, "rating/verdict/required_life_h"), hours, 1e-9,
       "hours of the load cases, which are the life");
  near(rated(result, "left/pinion/N_L"), 60 * 100 * s->design.load_case[0].speed * 30 / M_PI, 1e-9,
       "load cycles in these hours");
  json_decref(result);
  s->design.rating.member[EO_GEAR].material = EO_THROUGH_HARDENED_ALLOY;
  result = result_of(s);
  const char *reason = json_string_value(eo_json_find(result, "rating/reason"));
  ok(reason && json_is_null(eo_json_find(result, "rating/verdict/passes")) &&
         json_is_null(eo_json_find(result, "rating/verdict/S_H")) &&
         json_is_array(eo_json_find(result, "tribology/load_cases")),
     "what cannot be rated says why: %s", reason ? reason : "nothing");
  json_decref(result);
  struct eo_error error;
  none = eo_analysis_run(s->analysis, &s->design, 0, &error) ? NULL : eo_result_encode(s->analysis, &s->design, NULL);
  ok(json_is_null(json_object_get(none, "rating")), "no rating where none was asked for");
  json_decref(none);
  end(s);
}

/* A limit on the rating: the objective sees what the rating says, and the evaluation stays what it was. */
static void check_rating_limit(void)
{
  struct subject *s = start("shifted");
  json_t *free_result = result_of(s);
  double safety = fmin(eo_json_find_number(free_result, "rating/verdict/S_H"),
                       eo_json_find_number(free_result, "rating/verdict/S_H_static"));
  double rms = last(free_result, "vibration/rms_m_per_s2/normal");
  ok(json_is_null(eo_json_find(json_array_get(eo_json_find(free_result, "objectives/load_cases"), 0), "flank_safety")),
     "the objective has no safety where no limit asks for it");
  json_decref(free_result);
  s->design.objective.flank_safety = 2 * safety;
  json_t *result = result_of(s);
  const json_t *cases = eo_json_find(result, "objectives/load_cases");
  near(eo_json_find_number(json_array_get(cases, 0), "flank_safety"), safety, 1e-9,
       "the limited safety against the rated one");
  ok(json_is_null(json_object_get(json_array_get(cases, 1), "flank_safety")),
     "the limited safety counts once, at the first load case");
  near(eo_json_find_number(result, "objectives/violation"), 1, 1e-9, "violation by half of what is wanted");
  ok(warns(result, "The limit on the flank safety S_H is not reached"), "a warning tells of a safety below its limit");
  ok(last(result, "vibration/rms_m_per_s2/normal") == rms, "the vibration is the same number beside a limited safety");
  json_decref(result);
  s->design.objective.flank_safety = NAN;
  s->design.objective.film_ratio = 1e-3;
  s->design.objective.contact_temperature = 1000;
  result = result_of(s);
  ok(eo_json_find_number(result, "objectives/violation") == 0, "limits that are kept violate nothing");
  json_decref(result);
  s->design.rating.member[EO_GEAR].material = EO_STRUCTURAL;
  s->design.objective.root_safety = 1;
  result = result_of(s);
  ok(eo_json_find_number(result, "objectives/violation") > 100, "what cannot be rated keeps no limit on it");
  json_decref(result);
  end(s);
}

int main(void)
{
  check_names("paper-case-b", 2);
  check_names("single", 1);
  check_memory();
  check_writing();
  check_lean();
  check_threads();
  check_unmodified();
  check_objectives();
  check_columns();
  check_warnings();
  check_failure();
  check_robust();
  check_rating();
  check_rating_limit();
  return tap_done();
}
