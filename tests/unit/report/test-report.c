/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report read line by line against the result document: every number of rating, tribology and load cases stands in
   it, beside its key; what was not stated is said; the bytes are those of the design alone. */
#include <stdlib.h>
#include <string.h>

#include "document/examples.h"
#include "document/result.h"
#include "flexibility/closed_form.h"
#include "format/inch.h"
#include "format/json.h"
#include "format/plot.h"
#include "report/report.h"
#include "support/tap.h"

static const struct eo_closed_form form = {
    .compliance = 1.5e-9, .length = 12e-3, .centre = -0.8e-3, .linear = 20, .quadratic = 4000};

struct subject {
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_pair *pair;
};

/* A pair that is not the paper's, coarse. */
static struct subject *start(const char *example)
{
  struct subject *s = calloc(1, sizeof *s);
  struct eo_error error;
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  eo_example_build(example, &s->design);
  s->design.resolution.positions = 24;
  s->design.resolution.te_harmonics = 8;
  s->design.resolution.cells_per_line = 16;
  if (eo_design_complete(&s->design, &s->geometry, &error) || eo_pair_new(&s->pair, &s->design, &options, NULL, &error))
    printf("Bail out! %s\n", error.text);
  return s;
}

static void end(struct subject *s)
{
  eo_pair_free(s->pair);
  free(s);
}

static struct eo_text report_in(const struct subject *s, const struct eo_warnings *warnings, bool inches)
{
  struct eo_text text = {0};
  struct eo_error error;
  const struct eo_page page = {&text, inches};
  if (eo_report_make(s->pair, &s->design, warnings, NULL, &page, &error))
    printf("# %s\n", error.text);
  return text;
}

static struct eo_text report_of(const struct subject *s, const struct eo_warnings *warnings)
{
  return report_in(s, warnings, false);
}

static json_t *result_of(const struct subject *s)
{
  struct eo_analysis *analysis;
  struct eo_error error;
  json_t *result = NULL;
  if (!eo_analysis_new(&analysis, s->pair, &error) &&
      !eo_analysis_run(analysis, &s->design, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES | EO_WANT_RATING, &error))
    result = eo_result_encode(analysis, &s->design, NULL);
  eo_analysis_free(analysis);
  return result;
}

/* Whether some line of this key has the value in one of its cells. */
static bool has_line(const char *page, const char *key, double value)
{
  char name[120], cell[60];
  snprintf(name, sizeof name, "<code>%s</code></td>", key);
  snprintf(cell, sizeof cell, ">%.6g<", value);
  for (const char *line = strstr(page, name); line; line = strstr(line + 1, name)) {
    const char *stop = strchr(line, '\n'), *found = strstr(line, cell);
    if (found && found < stop)
      return true;
  }
  return false;
}

struct reading {
  const char *page;
  int numbers, missing;
};

static void read_value(struct reading *reading, const char *key, const json_t *value);

static void read_object(struct reading *reading, const char *outer, const json_t *object)
{
  const char *key;
  json_t *value;
  /* one number per end stands in the line of the key around it */
  bool ends = json_is_number(json_object_get(object, "left")) && json_object_size(object) <= 2;
  json_object_foreach((json_t *)object, key, value) read_value(reading, ends ? outer : key, value);
}

static void read_value(struct reading *reading, const char *key, const json_t *value)
{
  if (json_is_object(value))
    read_object(reading, key, value);
  for (size_t i = 0; json_is_object(json_array_get(value, 0)) && i < json_array_size(value); i++)
    read_object(reading, key, json_array_get(value, i));
  if (!json_is_number(value))
    return;
  reading->numbers++;
  if (!has_line(reading->page, key, json_number_value(value)) && reading->missing++ < 5)
    printf("# %s = %.6g is not in the report\n", key, json_number_value(value));
}

static void test_lines(const char *example, int least, bool inches)
{
  static const char *const parts[] = {"rating", "tribology", "load_cases"};
  struct subject *s = start(example);
  struct eo_text page = report_in(s, NULL, inches);
  json_t *metric = result_of(s), *result = inches ? eo_inch_from_mm(metric) : json_incref(metric);
  struct reading reading = {.page = page.data};
  json_object_del(json_object_get(result, "rating"), "settings"); /* its keys have a path */
  for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
    read_value(&reading, parts[i], json_object_get(result, parts[i]));
  ok(reading.numbers > least && !reading.missing, "%s%s: each of %d numbers of the result stands in the report",
     example, inches ? " in inches" : "", reading.numbers);
  json_decref(result);
  json_decref(metric);
  eo_text_done(&page);
  end(s);
}

/* "value" among escaped text. */
static bool holds(const struct eo_text *page, const char *text)
{
  struct eo_text escaped = {0};
  eo_text_add_escaped(&escaped, text);
  bool found = strstr(page->data, escaped.data) != NULL;
  eo_text_done(&escaped);
  return found;
}

static void test_words(void)
{
  struct subject *s = start("narrow");
  struct eo_warnings warnings = {0};
  char hash[EO_HASH_LENGTH + 1];
  eo_warnings_add(&warnings, "The angle < 3 \"deg\" & more is assumed.");
  struct eo_text page = report_of(s, &warnings), again = report_of(s, &warnings);
  json_t *result = result_of(s);
  const json_t *unchecked = eo_json_find(result, "rating/unchecked");
  bool all = json_array_size(unchecked) > 0;
  for (size_t i = 0; i < json_array_size(unchecked); i++)
    all = all && holds(&page, json_string_value(json_array_get(unchecked, i)));
  ok(all, "the report says of everything that it is unchecked");
  ok(holds(&page, "ISO 6336-3:2006") && holds(&page, "Dowson and Higginson") && holds(&page, "S_Hmin"),
     "the report names standards and formulae by name and edition");
  ok(holds(&page, warnings.text[0]), "the report has the warnings, with their special characters");
  ok(!eo_design_hash(&s->design, hash, NULL) && holds(&page, hash), "the report has the design's hash");
  ok(page.size == again.size && memcmp(page.data, again.data, page.size) == 0, "a second report has the same bytes");
  ok(!strstr(page.data, "http://") || strstr(page.data, "http://www.w3.org/2000/svg") == strstr(page.data, "http://"),
     "the report fetches nothing from elsewhere");
  json_decref(result);
  eo_text_done(&page);
  eo_text_done(&again);
  s->design.rating.member[EO_PINION].material = EO_STRUCTURAL;
  s->design.rating.edition = EO_ISO6336_2019;
  page = report_of(s, NULL);
  ok(strstr(page.data, "Not rated: ") && holds(&page, "ISO 6336-3:2019") && strstr(page.data, "min_film_um"),
     "the report says why something is not rated, and has the rest");
  eo_text_done(&page);
  end(s);
}

/* A unit alone: "mm/s", "N/(mm um)", "um mm/N" and "14mm" of the style are none. */
static bool is_alone(const char *page, const char *at, size_t length)
{
  static const char joined[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_/()";
  return !strchr(joined, at[length]) && (at == page || !strchr(joined, at[-1])) && strncmp(at, "um mm", 5) != 0;
}

static int count_word(const char *page, const char *word)
{
  int count = 0;
  for (const char *at = strstr(page, word); at; at = strstr(at + 1, word))
    count += is_alone(page, at, strlen(word));
  return count;
}

/* Of a pair with warnings, an assumed backlash, charts and maps nothing is left that has a length in mm or um. */
static void test_inches(void)
{
  struct subject *s = start("narrow");
  struct eo_warnings warnings = {0};
  eo_warnings_add(&warnings, "The tip of the pinion is taken as 50.8 mm, 25.4 um less than its rack makes it.");
  struct eo_text metric = report_of(s, &warnings), inch = report_in(s, &warnings, true);
  json_t *result = result_of(s);
  double module = eo_json_find_number(result, "geometry/normal_module_mm") / 25.4;
  ok(count_word(metric.data, "mm") > 100 && count_word(metric.data, "um") > 60, "a report is in mm by itself");
  ok(count_word(inch.data, "mm") == 0 && count_word(inch.data, "um") == 0 && count_word(inch.data, "in") > 100 &&
         count_word(inch.data, "thou") > 60,
     "a report in inches leaves %d mm and %d um", count_word(inch.data, "mm"), count_word(inch.data, "um"));
  ok(has_line(inch.data, "/geometry/normal_module_in", module), "the report in inches has the module: %.6g in", module);
  ok(strstr(inch.data, "taken as 2 in, 1 thou less") != NULL, "the report in inches has its warning in inches");
  ok(strstr(inch.data, ">roll length, in<") && strstr(inch.data, ">deviation, thou<") &&
         strstr(inch.data, ">thou, transverse<"),
     "the report in inches has its axes in inches");
  ok(!strstr(inch.data, "<svg></svg>") && count_word(inch.data, "path") == count_word(metric.data, "path"),
     "the report in inches has every curve of the one in mm");
  json_decref(result);
  eo_text_done(&metric);
  eo_text_done(&inch);
  end(s);
}

int main(void)
{
  test_lines("narrow", 300, false);
  test_lines("single", 150, false);
  test_lines("narrow", 300, true);
  test_inches();
  test_words();
  return tap_done();
}
