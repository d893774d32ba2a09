/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Conversions of MDF channels from raw values to those with a unit. */
#include "recording/mdf.h"

#include <math.h>
#include <stdlib.h>

enum { CONVERSION_LINKS = 4 }; /* name, unit, comment, inverse; then the branches */

void eo_mdf_conversion_free(struct eo_mdf_conversion *conversion)
{
  for (int i = 0; conversion && conversion->branch && i < conversion->branches; i++)
    eo_mdf_conversion_free(conversion->branch[i]);
  if (conversion) {
    free(conversion->branch);
    free(conversion->term);
  }
  free(conversion);
}

static enum eo_code read_terms(struct eo_mdf *mdf, const struct eo_mdf_block *block,
                               struct eo_mdf_conversion *conversion, struct eo_error *error)
{
  enum { TERMS_AT = 24 }; /* kind, precision, flags, counts, range of values */
  int count = eo_bytes_16(block->data + 6, false);
  mdf->terms += count;
  if (count > EO_MDF_TERMS || TERMS_AT + 8 * (int64_t)count > block->size)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the conversion at byte %lld states %d numbers, more than its block holds.",
                        (long long)block->at, count);
  if (mdf->terms > EO_MDF_ALL_TERMS)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the conversions up to byte %lld hold more than %d numbers together.",
                        (long long)block->at, EO_MDF_ALL_TERMS);
  unsigned char *bytes = malloc(8 * (size_t)count + 1);
  conversion->term = calloc((size_t)count + 1, sizeof *conversion->term);
  enum eo_code code = bytes && conversion->term ? EO_OK : eo_error_memory(error);
  if (!code)
    code = eo_bytes_read(mdf->file, block->data_at + TERMS_AT, bytes, 8 * (size_t)count, error);
  for (int i = 0; !code && i < count; i++)
    conversion->term[i] = eo_bytes_double(bytes + 8 * i, false);
  conversion->terms = code ? 0 : count;
  free(bytes);
  return code;
}

static enum eo_code read_nested(struct eo_mdf *mdf, int64_t at, int depth, struct eo_mdf_conversion **conversion,
                                struct eo_error *error);

/* Where values become texts, each of them is a link: to a text, or to another conversion. */
static enum eo_code read_branches(struct eo_mdf *mdf, const struct eo_mdf_block *block, int depth,
                                  struct eo_mdf_conversion *conversion, struct eo_error *error)
{
  int64_t count = block->links - CONVERSION_LINKS;
  if (count < 1 || count > EO_MDF_TERMS)
    return EO_OK;
  mdf->terms += count;
  unsigned char *links = malloc(8 * (size_t)count);
  conversion->branch = calloc((size_t)count, sizeof(struct eo_mdf_conversion *));
  conversion->branches = conversion->branch ? (int)count : 0;
  enum eo_code code = links && conversion->branch ? EO_OK : eo_error_memory(error);
  if (!code)
    code = eo_bytes_read(mdf->file, block->data_at - 8 * count, links, 8 * (size_t)count, error);
  for (int i = 0; !code && i < conversion->branches; i++) {
    struct eo_mdf_block branch;
    int64_t at = (int64_t)eo_bytes_64(links + 8 * i, false);
    if (at)
      code = eo_mdf_open(mdf, at, NULL, &branch, error);
    if (!code && at && !strcmp(branch.id, "CC"))
      code = read_nested(mdf, at, depth + 1, &conversion->branch[i], error);
  }
  free(links);
  return code;
}

/* Tables hold at least one row; their terms come in rows of two or three and one default. */
static bool is_complete(const struct eo_mdf_conversion *conversion)
{
  switch (conversion->kind) {
  case EO_MDF_LINEAR:
    return conversion->terms >= 2;
  case EO_MDF_RATIONAL:
    return conversion->terms >= 6;
  case EO_MDF_INTERPOLATED:
  case EO_MDF_TABLE:
    return conversion->terms >= 2 && conversion->terms % 2 == 0;
  case EO_MDF_RANGES:
    return conversion->terms >= 4 && conversion->terms % 3 == 1;
  case EO_MDF_TEXTS:
    return conversion->branches >= conversion->terms;
  case EO_MDF_TEXT_RANGES:
    return conversion->terms % 2 == 0 && conversion->branches >= conversion->terms / 2;
  default:
    return true;
  }
}

static enum eo_code read_nested(struct eo_mdf *mdf, int64_t at, int depth, struct eo_mdf_conversion **conversion,
                                struct eo_error *error)
{
  struct eo_mdf_block block;
  *conversion = NULL;
  if (!at)
    return EO_OK;
  enum eo_code code = eo_mdf_open(mdf, at, "CC", &block, error);
  if (code)
    return code;
  struct eo_mdf_conversion *mdf_conversion = calloc(1, sizeof *mdf_conversion);
  if (!mdf_conversion)
    return eo_error_memory(error);
  *conversion = mdf_conversion;
  mdf_conversion->kind = block.data[0] > EO_MDF_TEXT_RANGES ? EO_MDF_FORMULA
                                                            : (enum eo_mdf_conversion_kind)block.data[0];
  if (depth >= EO_MDF_NESTED)
    mdf_conversion->kind = EO_MDF_FORMULA;
  if (mdf_conversion->kind == EO_MDF_EQUAL || mdf_conversion->kind == EO_MDF_FORMULA)
    return EO_OK;
  code = read_terms(mdf, &block, mdf_conversion, error);
  if (!code && (mdf_conversion->kind == EO_MDF_TEXTS || mdf_conversion->kind == EO_MDF_TEXT_RANGES))
    code = read_branches(mdf, &block, depth, mdf_conversion, error);
  if (!code && !is_complete(mdf_conversion))
    code = eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the conversion at byte %lld has too few numbers.",
                        (long long)at);
  return code;
}

enum eo_code eo_mdf_conversion_read(struct eo_mdf *mdf, int64_t at, struct eo_mdf_conversion **conversion,
                                    struct eo_error *error)
{
  enum eo_code code = read_nested(mdf, at, 0, conversion, error);
  if (code) {
    eo_mdf_conversion_free(*conversion);
    *conversion = NULL;
  }
  return code;
}

bool eo_mdf_is_numeric(const struct eo_mdf_conversion *conversion)
{
  if (!conversion || (conversion->kind != EO_MDF_TEXTS && conversion->kind != EO_MDF_TEXT_RANGES))
    return !conversion || conversion->kind != EO_MDF_FORMULA;
  bool any = false;
  for (int i = 0; i < conversion->branches; i++) {
    if (conversion->branch[i] && !eo_mdf_is_numeric(conversion->branch[i]))
      return false;
    any = any || conversion->branch[i];
  }
  return any;
}

/* Pairs of key and value with rising keys: straight lines between them, the ends' values beyond; without lines the
   value of the nearest key, of two equally near ones the lower. */
static double table_value(const struct eo_mdf_conversion *conversion, double x)
{
  int n = conversion->terms / 2, i = 0;
  if (isnan(x) || x <= conversion->term[0])
    return isnan(x) ? x : conversion->term[1];
  while (i + 1 < n && conversion->term[2 * (i + 1)] < x)
    i++;
  if (i + 1 == n)
    return conversion->term[2 * i + 1];
  double low = conversion->term[2 * i], high = conversion->term[2 * i + 2], from = conversion->term[2 * i + 1],
         to = conversion->term[2 * i + 3];
  double part = (x - low) / (high - low);
  if (conversion->kind == EO_MDF_TABLE)
    return part <= 0.5 ? from : to;
  return from + part * (to - from);
}

/* Ranges of integers include their upper ends, those of floating values do not. */
static bool lies_in(double x, double low, double high, bool whole)
{
  return x >= low && (whole ? x <= high : x < high || (low == high && x == low));
}

/* Triples low, high, value, then the value of all that lies in no range. */
static double range_value(const struct eo_mdf_conversion *conversion, double x, bool whole)
{
  for (int i = 0; i + 3 < conversion->terms; i += 3)
    if (lies_in(x, conversion->term[i], conversion->term[i + 1], whole))
      return conversion->term[i + 2];
  return conversion->term[conversion->terms - 1];
}

/* One branch for each key or range, then, where there is one more, that of all other values. */
static double branch_value(const struct eo_mdf_conversion *conversion, double x, bool whole)
{
  int keys = conversion->kind == EO_MDF_TEXTS ? conversion->terms : conversion->terms / 2, i = 0;
  if (conversion->kind == EO_MDF_TEXTS)
    while (i < keys && conversion->term[i] != x)
      i++;
  else
    while (i < keys && !lies_in(x, conversion->term[2 * i], conversion->term[2 * i + 1], whole))
      i++;
  return i < conversion->branches && conversion->branch[i] ? eo_mdf_convert(conversion->branch[i], x, whole) : NAN;
}

double eo_mdf_convert(const struct eo_mdf_conversion *conversion, double x, bool whole)
{
  if (!conversion)
    return x;
  switch (conversion->kind) {
  case EO_MDF_LINEAR:
    return conversion->term[0] + conversion->term[1] * x;
  case EO_MDF_RATIONAL:
    return ((conversion->term[0] * x + conversion->term[1]) * x + conversion->term[2]) /
           ((conversion->term[3] * x + conversion->term[4]) * x + conversion->term[5]);
  case EO_MDF_INTERPOLATED:
  case EO_MDF_TABLE:
    return table_value(conversion, x);
  case EO_MDF_RANGES:
    return range_value(conversion, x, whole);
  case EO_MDF_TEXTS:
  case EO_MDF_TEXT_RANGES:
    return branch_value(conversion, x, whole);
  case EO_MDF_EQUAL:
  case EO_MDF_FORMULA:
    break;
  }
  return x;
}
