/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a struct holds before its document is read. */
#include <stdint.h>
#include <string.h>

#include "format/table.h"

static void *member(void *target, const struct eo_field *field)
{
  return (char *)target + field->offset;
}

static void default_numbers(const struct eo_field *field, double *value)
{
  for (int i = 0; i < field->count; i++)
    value[i] = field->fallbacks ? eo_unit_in(field->unit, field->fallbacks[i]) : NAN;
}

static void default_rows(const struct eo_field *field, void *target)
{
  char *row = member(target, field);
  for (int i = 0; i < field->count; i++)
    eo_table_defaults(field->table, row + (size_t)i * field->table->size);
  if (field->row_count)
    memcpy(row, field->rows, (size_t)field->row_count * field->table->size);
  *(int *)((char *)target + field->count_offset) = field->row_count;
}

static void default_field(const struct eo_field *field, void *target)
{
  void *place = member(target, field);
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    *(double *)place = eo_unit_in(field->unit, field->fallback);
    break;
  case EO_FIELD_INTEGER:
  case EO_FIELD_CHOICE:
    *(int *)place = isnan(field->fallback) ? 0 : (int)field->fallback;
    break;
  case EO_FIELD_SEED:
    *(uint64_t *)place = (uint64_t)field->fallback;
    break;
  case EO_FIELD_FLAG:
    *(bool *)place = field->fallback != 0;
    break;
  case EO_FIELD_TEXT:
    memset(place, 0, (size_t)field->count);
    strncpy(place, field->fallback_text ? field->fallback_text : "", (size_t)field->count - 1);
    break;
  case EO_FIELD_NUMBERS:
    default_numbers(field, place);
    break;
  case EO_FIELD_OBJECT:
    eo_table_defaults(field->table, place);
    if (field->flags & EO_FIELD_NULLABLE)
      *(int *)((char *)target + field->count_offset) = 0;
    break;
  case EO_FIELD_LIST:
    default_rows(field, target);
    break;
  case EO_FIELD_SERIES:
    *(struct eo_numbers *)place = (struct eo_numbers){0};
    break;
  case EO_FIELD_MATRIX:
    *(struct eo_matrix *)place = (struct eo_matrix){0};
    break;
  case EO_FIELD_DOCUMENT:
    *(const json_t **)place = NULL;
    break;
  case EO_FIELD_NAMES:
    memset(place, 0, (size_t)field->count * (size_t)field->room);
    break;
  }
}

void eo_table_defaults(const struct eo_table *table, void *target)
{
  for (int i = 0; i < table->count; i++)
    if (!(table->field[i].flags & EO_FIELD_ELSEWHERE))
      default_field(&table->field[i], target);
}
