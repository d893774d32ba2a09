/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/made_check_document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "document/tolerance_document.h"
#include "evaluation/scalar.h"
#include "format/json.h"
#include "format/text_table.h"
#include "tolerance/interval.h"
#include "tolerance/statistics.h"

static const double percents[] = {50, 90, 95, 99};
enum { PERCENTS = sizeof percents / sizeof *percents };
static const double level = 0.95;

struct number {
  const struct eo_design *design;
  char key[96];
  int load_case; /* of a term; 0: over the duty cycle */
  int rows;
  struct eo_summary summary;
  struct eo_report_percentile percentile[PERCENTS];
};

static json_t *write_percentiles(const void *source)
{
  const struct number *number = source;
  json_t *array = json_array();
  for (int i = 0; i < PERCENTS && array; i++)
    array = eo_json_append(array, eo_outline_encode(&eo_outline_percentile, &number->percentile[i]));
  return array;
}

static bool has_rows(const void *source)
{
  return ((const struct number *)source)->rows > 0;
}

static const struct eo_outline_row number_rows[] = {
    EO_KEY("key", "text", "J, f1_um, f2_N, f3_m_per_s2, or the output of a term", EO_AT(struct number, key)),
    EO_KEY("load_case", "integer", "of a term, from 1; 0: over the duty cycle", EO_AT(struct number, load_case)),
    EO_KEY("mean", "number?", "of the pairs", EO_AT(struct number, summary.mean), .known = has_rows),
    EO_KEY("deviation", "number?", "standard deviation", EO_AT(struct number, summary.deviation), .known = has_rows),
    EO_KEY("largest", "number?", "of any pair", EO_AT(struct number, summary.largest), .known = has_rows),
    EO_KEY("percentiles", "[object]", "50, 90, 95 and 99 %", .outline = &eo_outline_percentile,
           .write = write_percentiles),
};
static const struct eo_outline number_outline = EO_OUTLINE("MadeNumber", number_rows);

struct share {
  int count, pairs;
  double fraction;
  struct eo_share_interval interval;
};

static const struct eo_outline_row share_rows[] = {
    EO_KEY("count", "integer", "pairs", EO_AT(struct share, count)),
    EO_KEY("fraction", "number", "of all", EO_AT(struct share, fraction)),
    EO_KEY("low", "number", "of its 95 % interval (Clopper and Pearson)", EO_AT(struct share, interval.low)),
    EO_KEY("high", "number", "likewise", EO_AT(struct share, interval.high)),
};
static const struct eo_outline share_outline = EO_OUTLINE("MadeShare", share_rows);

static struct share share_of(int count, int pairs)
{
  return (struct share){count, pairs, (double)count / pairs, eo_clopper_pearson(count, pairs, level)};
}

struct row {
  const struct eo_made_check *check;
  const struct eo_design *design;
  double *column; /* [pairs], scratch */
  int of, failed;
  char name[64];
  struct share worse_J, worse_anywhere;
};

static void describe_number(const struct row *row, int k, struct number *number)
{
  static const char *const keys[EO_MADE_SUMS] = {"J", "f1_um", "f2_N", "f3_m_per_s2"};
  const struct eo_made_check *check = row->check;
  const double *value = check->value + (size_t)row->of * (size_t)check->pairs * (size_t)check->numbers;
  const struct eo_objective_term *term = k >= EO_MADE_SUMS ? &row->design->objective.term[k - EO_MADE_SUMS] : NULL;
  double unit = k == 1 ? 1e-6 : 1;
  *number = (struct number){.design = row->design, .load_case = term ? term->load_case : 0};
  snprintf(number->key, sizeof number->key, "%s", term ? eo_scalar_keys[term->output] : keys[k]);
  for (int i = 0; i < check->pairs; i++) {
    double own = value[(size_t)i * (size_t)check->numbers + (size_t)k] / unit;
    if (isfinite(own))
      row->column[number->rows++] = own;
  }
  if (number->rows > 0)
    number->summary = eo_summary_of(number->rows, row->column);
  eo_sort_numbers(number->rows, row->column);
  for (int p = 0; p < PERCENTS; p++)
    number->percentile[p] = eo_report_percentile_of(number->rows, row->column, percents[p]);
}

static json_t *write_numbers(const void *source)
{
  const struct row *row = source;
  struct number number;
  json_t *array = json_array();
  for (int k = 0; k < row->check->numbers && array; k++) {
    describe_number(row, k, &number);
    array = eo_json_append(array, eo_outline_encode(&number_outline, &number));
  }
  return array;
}

static const struct eo_outline_row row_rows[] = {
    EO_KEY("name", "text", "the first is the unmodified pair", EO_AT(struct row, name)),
    EO_KEY("failed", "integer", "pairs that did not converge", EO_AT(struct row, failed)),
    EO_KEY("worse_J", "object", "pairs with a larger J than the unmodified pair made alike", .outline = &share_outline,
           EO_AT(struct row, worse_J)),
    EO_KEY("worse_anywhere", "object",
           "pairs with a larger swing, impact or vibration at some load case than the unmodified pair made alike",
           .outline = &share_outline, EO_AT(struct row, worse_anywhere)),
    EO_KEY("numbers", "[object]", "J, f1, f2, f3, terms", .outline = &number_outline, .write = write_numbers),
};
static const struct eo_outline row_outline = EO_OUTLINE("MadeDesign", row_rows);

static void count_worse(struct row *row)
{
  const struct eo_made_check *check = row->check;
  size_t block = (size_t)check->pairs * (size_t)check->numbers;
  int J = 0, anywhere = 0;
  for (int i = 0; i < check->pairs; i++) {
    double own = check->value[(size_t)row->of * block + (size_t)i * (size_t)check->numbers],
           before = check->value[(size_t)i * (size_t)check->numbers];
    row->failed += !isfinite(own);
    J += own > before || (!isfinite(own) && isfinite(before));
    anywhere += check->worse[row->of * check->pairs + i] || (!isfinite(own) && isfinite(before));
  }
  row->worse_J = share_of(J, check->pairs);
  row->worse_anywhere = share_of(anywhere, check->pairs);
}

struct whole {
  const struct eo_made_check *check;
  const struct eo_design *design;
  int pairs, skipped;
};

static json_t *write_designs(const void *source)
{
  const struct whole *whole = source;
  struct row row = {.check = whole->check, .design = whole->design};
  row.column = malloc(sizeof *row.column * (size_t)whole->check->pairs);
  json_t *array = row.column ? json_array() : NULL;
  for (int i = 0; i < whole->check->designs && array; i++) {
    row.of = i;
    row.failed = 0;
    snprintf(row.name, sizeof row.name, "%s", whole->check->name[i]);
    count_worse(&row);
    array = eo_json_append(array, eo_outline_encode(&row_outline, &row));
  }
  free(row.column);
  return array;
}

static const struct eo_outline_row whole_rows[] = {
    EO_KEY("pairs", "integer", "as made, the same for every design", EO_AT(struct whole, pairs)),
    EO_KEY("skipped", "integer", "pairs before them in the sequence, which the search has seen",
           EO_AT(struct whole, skipped)),
    EO_KEY("designs", "[object]", "side by side", .outline = &row_outline, .write = write_designs),
};
const struct eo_outline eo_made_check_outline = EO_OUTLINE("MadeCheck", whole_rows);

json_t *eo_made_check_encode(const struct eo_made_check *check, const struct eo_design *design)
{
  const struct whole whole = {check, design, check->pairs, check->skipped};
  return eo_outline_encode(&eo_made_check_outline, &whole);
}

void eo_made_check_done(struct eo_made_check *check)
{
  free(check->value);
  free(check->worse);
  *check = (struct eo_made_check){0};
}

static double percentile_of(const json_t *number, double percent, const char *key)
{
  const json_t *row;
  size_t i;
  json_array_foreach(json_object_get(number, "percentiles"), i,
                     row) if (eo_json_find_number(row, "percent") == percent) return eo_json_find_number(row, key);
  return NAN;
}

static void add_share(struct eo_text_table *sheet, const json_t *share)
{
  eo_text_table_number(sheet, 100 * eo_json_find_number(share, "fraction"), NULL, 3);
  eo_text_table_number(sheet, 100 * eo_json_find_number(share, "low"), NULL, 3);
  eo_text_table_number(sheet, 100 * eo_json_find_number(share, "high"), NULL, 3);
}

static void add_number(struct eo_text_table *sheet, const json_t *design, const json_t *number, int digits)
{
  char name[120];
  const double shown[] = {50, 90, 95, 99};
  double load_case = eo_json_find_number(number, "load_case");
  snprintf(name, sizeof name, load_case > 0 ? "%.90s, load case %.0f" : "%.90s",
           json_string_value(json_object_get(number, "key")), load_case);
  eo_text_table_string(sheet, json_string_value(json_object_get(design, "name")));
  eo_text_table_string(sheet, name);
  eo_text_table_number(sheet, eo_json_find_number(number, "mean"), NULL, digits);
  for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
    eo_text_table_number(sheet, percentile_of(number, shown[i], "value"), NULL, digits);
  eo_text_table_number(sheet, percentile_of(number, 95, "low"), NULL, digits);
  eo_text_table_number(sheet, percentile_of(number, 95, "high"), NULL, digits);
}

void eo_made_check_table(const json_t *document, int digits, struct eo_text_table *sheet)
{
  static const char *const headings[] = {"design", "number", "mean", "50 %", "90 %", "95 %", "99 %", "95 % from", "to"};
  const json_t *design, *number;
  size_t i, k;
  eo_text_table_init(sheet, 9, headings);
  json_array_foreach(json_object_get(document, "designs"), i, design)
      json_array_foreach(json_object_get(design, "numbers"), k, number) add_number(sheet, design, number, digits);
}

void eo_made_check_shares(const json_t *document, struct eo_text_table *sheet)
{
  static const char *const headings[] = {
      "design", "J worse than unmodified, %", "from", "to", "worse anywhere, %", "from", "to", "failed"};
  const json_t *design;
  size_t i;
  eo_text_table_init(sheet, 8, headings);
  json_array_foreach(json_object_get(document, "designs"), i, design)
  {
    if (i == 0)
      continue;
    eo_text_table_string(sheet, json_string_value(json_object_get(design, "name")));
    add_share(sheet, json_object_get(design, "worse_J"));
    add_share(sheet, json_object_get(design, "worse_anywhere"));
    eo_text_table_number(sheet, eo_json_find_number(design, "failed"), NULL, 4);
  }
}

void eo_made_check_summary(const json_t *document, struct eo_text *text)
{
  struct eo_text_table sheet;
  eo_text_print(text, "On %.0f other pairs as made, the same for each:\n", eo_json_find_number(document, "pairs"));
  eo_made_check_table(document, 4, &sheet);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
  eo_made_check_shares(document, &sheet);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
}
