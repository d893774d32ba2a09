/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/scatter_distribution.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_scatter_refuse_row(const struct eo_scatter_row *row, const char *pointer, const char *key,
                                   const char *why, struct eo_error *error)
{
  char place[80];
  bool listed = strncmp(pointer, "/tolerance/inputs/", strlen("/tolerance/inputs/")) == 0;
  snprintf(place, sizeof place, "%.60s%s%.12s", pointer, listed ? "/" : "", listed ? key : "");
  return eo_error_set(error, EO_ERROR_INPUT, place, "%.90s: %s", row->key, why);
}

/* Numbers with spaces, commas or semicolons between. */
static enum eo_code read_values(const struct eo_scatter_row *row, const char *pointer, struct eo_scatter_input *input,
                                struct eo_error *error)
{
  const char *at = row->values;
  input->values = 0;
  while (*(at += strspn(at, " ,;\t\n"))) {
    char *end;
    double value = strtod(at, &end);
    if (end == at || !isfinite(value))
      return eo_scatter_refuse_row(row, pointer, "values",
                                   "values are numbers with spaces, commas or semicolons between.", error);
    if (input->values == EO_SCATTER_LIST)
      return eo_scatter_refuse_row(row, pointer, "values", "too many values: 200 are the most.", error);
    input->value[input->values++] = value;
    at = end;
  }
  return input->values > 0
             ? EO_OK
             : eo_scatter_refuse_row(row, pointer, "values",
                                     "values are missing: state the measured deviations, \"0.8, -1.2, 2.1\", or "
                                     "another distribution.",
                                     error);
}
_Static_assert(EO_SCATTER_LIST == 200, "the number in the error above");

/* Rows with the same name of a group share a number; 0: none. */
static int group_number(const struct eo_tolerance_settings *settings, const struct eo_scatter_row *row)
{
  for (int i = 0; i < settings->rows && *row->group; i++)
    if (settings->row[i].kind == row->kind && strcmp(settings->row[i].group, row->group) == 0)
      return i + 1;
  return 0;
}

/* What each distribution reads of a row, in the order of enum eo_scatter_kind. 0 of a number says nothing: complete
   documents state it everywhere. */
enum { BIAS = 1, SIGMA = 2, CUT = 4, RANGE = 8, VALUES = 16, GROUP = 32 };
static const struct {
  const char *name;
  int reads;
} kinds[] = {{"normal", BIAS | SIGMA | CUT},
             {"uniform", RANGE},
             {"values", VALUES | GROUP},
             {"fixed_sum", BIAS | SIGMA | GROUP},
             {"half_normal", BIAS | SIGMA | CUT}};

static enum eo_code check_unread(const struct eo_scatter_row *row, const char *pointer, struct eo_error *error)
{
  const struct {
    const char *key;
    int part;
    bool stated;
  } all[] = {{"bias", BIAS, row->bias != 0},       {"sigma", SIGMA, row->sigma != 0},
             {"cut_sigma", CUT, !isnan(row->cut)}, {"low", RANGE, row->low != 0},
             {"high", RANGE, row->high != 0},      {"values", VALUES, *row->values != 0},
             {"group", GROUP, *row->group != 0}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    char why[160];
    if (!all[i].stated || kinds[row->kind].reads & all[i].part)
      continue;
    snprintf(why, sizeof why, "the distribution \"%s\" does not use %s: leave it out, or choose another distribution.",
             kinds[row->kind].name, all[i].key);
    return eo_scatter_refuse_row(row, pointer, all[i].key, why, error);
  }
  return EO_OK;
}

static enum eo_code set_range(struct eo_distribution *deviation, const struct eo_scatter_row *row, const char *pointer,
                              struct eo_error *error)
{
  char why[120];
  *deviation =
      (struct eo_distribution){.kind = EO_DISTRIBUTION_UNIFORM, .low = row->low, .high = row->high, .cut = INFINITY};
  if (row->low <= row->high)
    return EO_OK;
  snprintf(why, sizeof why, "low is above high: %.6g is to be the largest deviation, %.6g the least.", row->low,
           row->high);
  return eo_scatter_refuse_row(row, pointer, "low", why, error);
}

enum eo_code eo_scatter_set_distribution(struct eo_scatter_input *input, const struct eo_tolerance_settings *settings,
                                         const struct eo_scatter_row *row, const char *pointer, struct eo_error *error)
{
  input->deviation =
      (struct eo_distribution){.mean = row->bias, .sigma = row->sigma, .cut = isnan(row->cut) ? INFINITY : row->cut};
  EO_TRY(check_unread(row, pointer, error));
  switch (row->kind) {
  case EO_SCATTER_UNIFORM:
    return set_range(&input->deviation, row, pointer, error);
  case EO_SCATTER_HALF_NORMAL:
    input->deviation.kind = EO_DISTRIBUTION_HALF_NORMAL;
    return EO_OK;
  case EO_SCATTER_VALUES:
    input->deviation.kind = EO_DISTRIBUTION_LIST;
    input->together = group_number(settings, row);
    return read_values(row, pointer, input, error);
  case EO_SCATTER_FIXED_SUM:
    input->fixed_sum = group_number(settings, row);
    return input->fixed_sum
               ? EO_OK
               : eo_scatter_refuse_row(row, pointer, "group",
                                       "a fixed sum needs a group: give the inputs whose sum stays the same name.",
                                       error);
  default:
    return EO_OK;
  }
}

bool eo_scatter_moves(const struct eo_distribution *deviation)
{
  return deviation->kind == EO_DISTRIBUTION_LIST || deviation->mean != 0 || deviation->sigma != 0 ||
         deviation->low != 0 || deviation->high != 0;
}

void eo_scatter_words(const struct eo_scatter_input *input, char *text, size_t size)
{
  const struct eo_distribution *distribution = &input->deviation;
  int length = 0;
  if (input->target == EO_TARGET_SEED)
    snprintf(text, size, "teeth of its own for every pair");
  else if (distribution->kind == EO_DISTRIBUTION_UNIFORM)
    snprintf(text, size, "uniform, %+.4g .. %+.4g", distribution->low, distribution->high);
  else if (distribution->kind == EO_DISTRIBUTION_LIST)
    snprintf(text, size, "%d values", input->values);
  else
    length = snprintf(text, size, "%snormal, sigma %.4g",
                      distribution->kind == EO_DISTRIBUTION_HALF_NORMAL ? "half " : "", distribution->sigma);
  if (length > 0 && distribution->mean != 0)
    length += snprintf(text + length, size - (size_t)length, ", bias %+.4g", distribution->mean);
  if (length > 0 && !isinf(distribution->cut))
    length += snprintf(text + length, size - (size_t)length, ", cut at %.3g sigma", distribution->cut);
  if (length > 0 && input->fixed_sum > 0)
    snprintf(text + length, size - (size_t)length, ", fixed sum");
}
