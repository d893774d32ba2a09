/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An answer depends on what is asked, not on what was asked before, with whom it shares a batch or on how many threads:
   one analysis is led through many designs in a mixed order, and every document is that of an analysis made for it
   alone on one thread, to the last byte. With finite elements, so that root stress is among it. Says which version of
   the kernel it ran on; tests/history.sh runs it on each. An argument names a folder to keep the prepared pair in. */
#include <string.h>

#include "document/result.h"
#include "numerics/gram.h"
#include "support/study-fixture.h"
#include "support/tap.h"

static void set_base(struct eo_design *d)
{
  coarse_design(d, "ga", 1);
  d->alignment.shaft_angle_in_plane = 1.7e-3;
  for (int end = 0; end < 2; end++) {
    d->modification.flank[EO_PINION][end].tip_relief = 20e-6;
    d->modification.flank[EO_PINION][end].lead_crowning = 4e-6;
  }
}

static void leave(struct eo_design *d)
{
  (void)d;
}
static void change_left(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_LEFT].tip_relief += 1e-6;
}
static void change_right(struct eo_design *d)
{
  d->modification.flank[EO_GEAR][EO_RIGHT].root_relief += 2e-6;
}
static void align(struct eo_design *d)
{
  d->alignment.shaft_angle_in_plane = 0;
}
static void hold_axially(struct eo_design *d)
{
  d->alignment.pinion_axial = EO_AXIAL_FIXED;
  d->alignment.stagger = 0.25;
}
static void bend_shafts(struct eo_design *d)
{
  d->shafts.enabled = true;
}
static void take_fewer_loads(struct eo_design *d)
{
  d->load_cases = 2;
}
static void lose_contact(struct eo_design *d)
{
  d->load_cases = 1; /* the search for stable states takes a second or more for each */
  d->load_case[0].torque = 20;
  d->load_case[0].speed *= 1.3;
  d->load_case[0].share = 1;
}
static void take_table(struct eo_design *d)
{
  d->resolution.mesh_law = EO_LAW_TABLE;
}
static void strike(struct eo_design *d)
{
  d->load_cases = 1;
  d->load_case[0].share = 1;
  d->resolution.impact_in_dynamics = EO_IMPACT_CONSISTENT;
}
static void want_robust(struct eo_design *d)
{
  d->load_cases = 1;
  d->load_case[0].share = 1;
  d->objective.robust = EO_ROBUST_WORST;
}
static void take_more_harmonics(struct eo_design *d)
{
  d->resolution.harmonics = 9;
}

enum { ALL = EO_WANT_ROOT | EO_WANT_CURVES };

static const struct question {
  const char *what;
  void (*change)(struct eo_design *design);
  int want;
} questions[] = {
    {"a design", leave, ALL | EO_WANT_BAND},
    {"its left end changed", change_left, ALL},
    {"its right end changed", change_right, ALL},
    {"both ends alike", align, ALL},
    {"without root stress", leave, 0},
    {"root stress alone", leave, EO_WANT_ROOT},
    {"a pinion held axially", hold_axially, ALL},
    {"shafts that bend", bend_shafts, EO_WANT_ROOT},
    {"fewer load cases", take_fewer_loads, ALL},
    {"contact lost", lose_contact, EO_WANT_CURVES},
    {"a table law", take_table, EO_WANT_CURVES},
    {"impacts in the motion", strike, EO_WANT_CURVES},
    {"the worst of several scenarios", want_robust, EO_WANT_ROOT},
    {"more harmonics", take_more_harmonics, ALL},
};
enum { QUESTIONS = sizeof questions / sizeof *questions };

static struct eo_text ask(struct eo_analysis *analysis, const struct question *question)
{
  static struct eo_design design;
  struct eo_text text = {0};
  set_base(&design);
  question->change(&design);
  if (!complete(&design) || eo_analysis_run(analysis, &design, question->want, &error)) {
    printf("# %s: %s: %s\n", question->what, error.pointer, error.text);
    return text;
  }
  json_t *result = eo_result_encode(analysis, &design, NULL);
  json_object_del(result, "timing_ms");
  eo_json_write(&text, result, EO_JSON_COMPACT);
  json_decref(result);
  return text;
}

/* What an analysis says that was never asked anything else. */
static struct eo_text ask_anew(const struct eo_pair *pair, const struct question *question)
{
  struct eo_analysis *analysis = NULL;
  eo_analysis_new(&analysis, pair, &error);
  struct eo_text text = ask(analysis, question);
  eo_analysis_free(analysis);
  return text;
}

static void show_difference(const struct eo_text *a, const struct eo_text *b)
{
  size_t i = 0;
  while (i < a->size && i < b->size && a->data[i] == b->data[i])
    i++;
  size_t from = i < 60 ? 0 : i - 60;
  printf("# ...%.*s\n# ...%.*s\n", 100, a->data ? a->data + from : "", 100, b->data ? b->data + from : "");
}

/* Lap by lap through the list, each with another stride, so that a question has another one before it each time; on one
   thread and on two. */
static void test_order(const struct eo_pair *pair)
{
  struct eo_analysis *analysis = NULL;
  struct eo_text expected[QUESTIONS];
  enum { LAPS = 2 };
  static const int stride[LAPS] = {1, 5}; /* no divisors of the number of questions */
  int wrong[QUESTIONS] = {0}, asked[QUESTIONS] = {0};
  for (int i = 0; i < QUESTIONS; i++)
    expected[i] = ask_anew(pair, &questions[i]);
  eo_analysis_new(&analysis, pair, &error);
  for (int step = 0; step < LAPS * QUESTIONS; step++) {
    int i = step * stride[step / QUESTIONS] % QUESTIONS;
    analysis->threads = 1 + step % 3 % 2;
    struct eo_text text = ask(analysis, &questions[i]);
    bool same = text.size && text.size == expected[i].size && memcmp(text.data, expected[i].data, text.size) == 0;
    if (!same && !wrong[i])
      show_difference(&text, &expected[i]);
    wrong[i] += !same;
    asked[i]++;
    eo_text_done(&text);
  }
  for (int i = 0; i < QUESTIONS; i++) {
    ok(asked[i] == LAPS && wrong[i] == 0, "%s: %zu bytes, the same %d times", questions[i].what, expected[i].size,
       asked[i] - wrong[i]);
    eo_text_done(&expected[i]);
  }
  eo_analysis_free(analysis);
}

int main(int argc, char **argv)
{
  static struct eo_design design;
  const struct eo_pair_options options = {.cache_directory = argc > 1 ? argv[1] : NULL};
  struct eo_pair *pair = NULL;
  set_base(&design);
  if (!complete(&design) || eo_pair_new(&pair, &design, &options, NULL, &error)) {
    printf("Bail out! %s\n", error.text);
    return 99;
  }
  printf("# version %s of the kernel\n", eo_gram_select()->name);
  test_order(pair);
  eo_pair_free(pair);
  return tap_done();
}
