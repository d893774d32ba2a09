/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of designs. Either blocks, each with a header "key;pinion;gear;unit" (the first word is free), one design per
   block; or a header of keys and one design per row. What could mean two things is asked for, not guessed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "exchange/cell_number.h"
#include "exchange/cells.h"
#include "exchange/design_keys.h"
#include "exchange/import.h"
#include "exchange/table_import.h"
#include "format/json.h"

enum { DESIGNS = 2000 };

struct reader {
  struct eo_import *out;
  const struct eo_cells *cells;
  bool comma;       /* is the decimal sign */
  bool wide;        /* one design per row */
  int row, ends;    /* of what is being read, from 0 */
  const char *head; /* first cell of the header of each block: "key", or what the table has in its place */
  json_t *design;
  json_t *given; /* path -> [line or column from 1, value] of the cells that were read */
};

/* A block of rows below its header. */
struct block {
  int first, last;    /* rows [first, last) */
  int value[2], unit; /* columns; -1: none */
};

static void fault(struct reader *reader, int column, const char *kind, const char *format, const char *a, const char *b)
{
  char text[400];
  snprintf(text, sizeof text, format, a, b);
  struct eo_import_fault *told = eo_import_fault(reader->out, kind, "%s", text);
  if (!told)
    return;
  told->line = reader->row + 1;
  told->column = column + 1;
}

/* Numbers: */

/* One decimal sign for the whole table; false: both stand in it. */
static bool find_decimal_sign(struct reader *reader)
{
  int point_row = -1;
  for (int row = 0; row < reader->cells->rows; row++)
    for (int column = 0; column < reader->cells->columns; column++) {
      const char *cell = eo_cells_at(reader->cells, row, column);
      reader->comma = reader->comma || eo_cell_has_decimal(cell, ',');
      point_row = eo_cell_has_decimal(cell, '.') ? row : point_row;
    }
  if (!reader->comma || point_row < 0)
    return true;
  reader->row = point_row;
  fault(reader, 0, "two_decimal_signs",
        "Numbers with a point and numbers with a comma stand in one table, so neither is sure%s%s; write all with one.",
        "", "");
  return false;
}

/* A number in the unit that the row states, or that its name is usually in. NaN: a fault is told. */
static double read_quantity(struct reader *reader, const struct eo_design_key *key, const char *name, const char *cell,
                            const char *unit, int column)
{
  double value = eo_cell_number(cell, reader->comma);
  bool angle = key->field->unit && strcmp(key->field->unit->suffix, "deg") == 0;
  if (isnan(value) && angle)
    value = eo_cell_sexagesimal(cell);
  if (isnan(value)) {
    fault(reader, column, "not_a_number", "%s is \"%.60s\"; a number is needed.", name, cell);
    return NAN;
  }
  if (*unit && !eo_design_key_convert(key->field, unit, &value)) {
    fault(reader, column, "wrong_unit", "The unit \"%.20s\" of %.100s is not one of it.", unit, name);
    return NAN;
  }
  if (!*unit && key->doubt == EO_KEY_DOUBT && value != 0) {
    if (fabs(value) <= 1) {
      fault(reader, column, "unit_needed", "%s is %.40s without a unit: that could be mm or um. State which.", name,
            cell);
      return NAN;
    }
    eo_import_say(reader->out, reader->out->assumed, "%s is in um", name);
  } else if (!*unit && key->doubt == EO_KEY_USUAL)
    eo_import_say(reader->out, reader->out->assumed, "%s is in %s", name, eo_design_key_unit(key->field));
  return value * key->factor;
}

/* Cells: */

/* A list as JSON; NULL: it is none. */
static json_t *read_list(const char *cell)
{
  struct eo_text wrapped = {0};
  struct eo_error error;
  eo_text_print(&wrapped, "{\"value\":%s}", cell);
  json_t *document = wrapped.failed ? NULL : eo_json_parse(wrapped.data, wrapped.size, &error);
  json_t *value = json_incref(json_object_get(document, "value"));
  json_decref(document);
  eo_text_done(&wrapped);
  return value;
}

static json_t *read_value(struct reader *reader, const struct eo_design_key *key, const char *name, const char *cell,
                          const char *unit, int column)
{
  if (strcmp(cell, "null") == 0)
    return json_null();
  if (*cell == '[' || *cell == '{') {
    json_t *list = read_list(cell);
    if (!list)
      fault(reader, column, "not_a_list", "%s is \"%.60s\"; a list as [1, 2] is needed.", name, cell);
    return list;
  }
  switch (key->field->kind) {
  case EO_FIELD_FLAG:
    if (strcasecmp(cell, "true") == 0 || strcasecmp(cell, "false") == 0)
      return json_boolean(strcasecmp(cell, "true") == 0);
    fault(reader, column, "not_a_boolean", "%s is \"%.60s\"; true or false is needed.", name, cell);
    return NULL;
  case EO_FIELD_CHOICE:
  case EO_FIELD_TEXT:
    return json_string(cell);
  default:
    break;
  }
  double value = read_quantity(reader, key, name, cell, unit, column);
  if (isnan(value))
    return NULL;
  bool whole = key->field->kind == EO_FIELD_INTEGER || key->field->kind == EO_FIELD_SEED;
  return whole ? eo_json_whole(value) : json_real(value);
}

/* The earlier cell that another value at the path would overrule, of it or of a key within it: its line, in a wide
   table its column, from 1; 0: none, or the same value. */
static int overruled(const struct reader *reader, const char *path, const json_t *value)
{
  const char *other;
  json_t *earlier;
  size_t length = strlen(path);
  json_object_foreach(reader->given, other, earlier)
  {
    if (strncmp(other, path, length) == 0 && (other[length] == '.' || !other[length]) &&
        !json_equal(json_array_get(earlier, 1), value))
      return (int)json_integer_value(json_array_get(earlier, 0));
  }
  return 0;
}

/* A value at a path, borrowed; none twice. */
static void put_at(struct reader *reader, const char *path, int column, json_t *value)
{
  int here = reader->wide ? column + 1 : reader->row + 1, earlier = overruled(reader, path, value);
  if (earlier) {
    char places[80];
    snprintf(places, sizeof places, reader->wide ? "columns %d and %d" : "lines %d and %d", earlier, here);
    fault(reader, column, "given_twice", "%.150s has different values in %s; keep one of them.", path, places);
    return;
  }
  enum eo_code code = eo_design_key_set(reader->design, path, json_incref(value));
  if (code == EO_ERROR_INPUT)
    fault(reader, column, "contradiction", "%.150s lies within a key that another cell gives a value as a whole.%s",
          path, "");
  if (code == EO_ERROR_MEMORY || json_object_set_new(reader->given, path, json_pack("[i, O]", here, value)) != 0)
    reader->out->failed = true;
}

static void put(struct reader *reader, const struct eo_design_key *key, int column, json_t *value)
{
  for (int i = 0; i < key->paths && value; i++)
    put_at(reader, key->path[i], column, value);
  json_decref(value);
}

static void put_name(struct reader *reader, int column)
{
  json_t *name = json_string(eo_cells_at(reader->cells, reader->row, column));
  put_at(reader, "name", column, name);
  json_decref(name);
}

/* "C_a [um]": the unit in the name. */
static void split_unit(const char *cell, char name[EO_KEY_PATH], char unit[40])
{
  size_t length = strcspn(cell, "[");
  const char *close = strchr(cell, ']');
  snprintf(name, EO_KEY_PATH, "%.*s", (int)length, cell);
  for (size_t end = strlen(name); end && name[end - 1] == ' ';)
    name[--end] = '\0';
  *unit = '\0';
  if (cell[length] && close)
    snprintf(unit, 40, "%.*s", (int)(close - cell - (long)length - 1), cell + length + 1);
}

static void unknown_key(struct reader *reader, int row, int column, const char *name)
{
  int reading = reader->row;
  reader->row = row;
  fault(reader, column, "unknown_key", "\"%.100s\" is neither a key of a design nor a symbol that is known here.%s",
        name, "");
  reader->row = reading;
}

/* One row: for each member its own value, or one for both. */
static void read_row(struct reader *reader, const struct block *block)
{
  char name[EO_KEY_PATH], unit[40];
  split_unit(eo_cells_at(reader->cells, reader->row, 0), name, unit);
  const char *stated = block->unit >= 0 ? eo_cells_at(reader->cells, reader->row, block->unit) : "";
  const char *cell[2] = {eo_cells_at(reader->cells, reader->row, block->value[0]),
                         block->value[1] >= 0 ? eo_cells_at(reader->cells, reader->row, block->value[1]) : ""};
  if (!*name || *name == '#' || (!*cell[0] && !*cell[1]))
    return;
  if (strcmp(name, "name") == 0) {
    put_name(reader, block->value[0]);
    return;
  }
  if (eo_design_key_is_derived(name)) {
    eo_import_say(reader->out, reader->out->not_used, "%s (line %d): it follows from the others", name,
                  reader->row + 1);
    return;
  }
  struct eo_design_key key[2];
  if (!eo_design_key_find(&key[0], name, 0, reader->ends) || !eo_design_key_find(&key[1], name, 1, reader->ends)) {
    unknown_key(reader, reader->row, 0, name);
    return;
  }
  if (!key[0].of_member && *cell[0] && *cell[1] && strcmp(cell[0], cell[1]) != 0) {
    fault(reader, block->value[1], "one_value", "%s has one value for both members, and here are two.%s", name, "");
    return;
  }
  for (int member = 0; member < 2; member++)
    if (*cell[member])
      put(reader, &key[member], block->value[member],
          read_value(reader, &key[member], name, cell[member], *stated ? stated : unit, block->value[member]));
}

/* Designs: */

static bool is_values(const char *cell)
{
  return strcasecmp(cell, "pinion") == 0 || strcasecmp(cell, "value") == 0;
}

/* A column of values is named in the row. */
static bool names_values(const struct eo_cells *cells, int row)
{
  for (int column = 1; column < cells->columns; column++)
    if (is_values(eo_cells_at(cells, row, column)))
      return true;
  return false;
}

static bool is_key(const char *head)
{
  return strcasecmp(head, "key") == 0;
}

static bool is_header(const struct reader *reader, int row)
{
  return strcasecmp(eo_cells_at(reader->cells, row, 0), reader->head) == 0 &&
         (is_key(reader->head) || names_values(reader->cells, row));
}

/* The first row names keys of a design. */
static bool is_wide(const struct reader *reader)
{
  char name[EO_KEY_PATH], unit[40];
  struct eo_design_key key;
  for (int column = 0; column < reader->cells->columns; column++) {
    split_unit(eo_cells_at(reader->cells, 0, column), name, unit);
    if (strcmp(name, "name") == 0 || eo_design_key_find(&key, name, 0, reader->ends))
      return true;
  }
  return false;
}

/* The word that heads the first column of blocks; NULL: there are none. */
static const char *find_head(const struct reader *reader)
{
  for (int row = 0; row < reader->cells->rows; row++)
    if (is_key(eo_cells_at(reader->cells, row, 0)))
      return "key";
  for (int row = 0; row < reader->cells->rows && !is_wide(reader); row++)
    if (names_values(reader->cells, row))
      return eo_cells_at(reader->cells, row, 0);
  return NULL;
}

static bool read_header(struct reader *reader, int row, struct block *block)
{
  *block = (struct block){.first = row + 1, .value = {-1, -1}, .unit = -1};
  for (int column = 1; column < reader->cells->columns; column++) {
    const char *cell = eo_cells_at(reader->cells, row, column);
    if (is_values(cell))
      block->value[0] = column;
    else if (strcasecmp(cell, "gear") == 0)
      block->value[1] = column;
    else if (strcasecmp(cell, "unit") == 0)
      block->unit = column;
    else if (*cell) {
      reader->row = row;
      fault(reader, column, "unknown_column", "The column \"%.40s\" is none of pinion, gear and unit.%s", cell, "");
    }
  }
  reader->row = row;
  if (block->value[0] < 0)
    fault(reader, 0, "no_values", "The header has no column \"pinion\"%s%s.", "", "");
  for (block->last = block->first; block->last < reader->cells->rows && !is_header(reader, block->last);)
    block->last++;
  return block->value[0] >= 0;
}

static void list_design(struct eo_import *out, const char *name)
{
  enum { LABEL = 120 };
  struct eo_import_pair *listed = eo_import_list(out);
  if (!listed)
    return;
  eo_text_clean(listed->label, LABEL, *name ? name : "without a name");
  listed->importable = true;
}

static const char *name_in(const struct eo_cells *cells, const struct block *block)
{
  for (int row = block->first; row < block->last; row++)
    if (strcmp(eo_cells_at(cells, row, 0), "name") == 0)
      return eo_cells_at(cells, row, block->value[0]);
  return "";
}

/* The number of ends decides how far a symbol of a modification reaches, so it is read first. */
static int ends_in(const struct reader *reader, const struct block *block)
{
  for (int row = block->first; row < block->last; row++)
    if (strcmp(eo_cells_at(reader->cells, row, 0), "gear_pair.ends") == 0)
      return strcmp(eo_cells_at(reader->cells, row, block->value[0]), "1") == 0 ? 1 : 2;
  return 2;
}

static int read_blocks(struct reader *reader, int wanted)
{
  int designs = 0;
  struct block block, chosen = {0};
  for (int row = 0; row < reader->cells->rows && designs < DESIGNS; row++) {
    if (!is_header(reader, row) || !read_header(reader, row, &block))
      continue;
    list_design(reader->out, name_in(reader->cells, &block));
    if (++designs == (wanted ? wanted : 1))
      chosen = block;
  }
  if (!chosen.first || (designs > 1 && !wanted))
    return designs;
  reader->ends = ends_in(reader, &chosen);
  for (reader->row = chosen.first; reader->row < chosen.last; reader->row++)
    read_row(reader, &chosen);
  return designs;
}

static void read_wide_row(struct reader *reader)
{
  char name[EO_KEY_PATH], unit[40];
  struct eo_design_key key;
  for (int column = 0; column < reader->cells->columns; column++) {
    const char *cell = eo_cells_at(reader->cells, reader->row, column);
    split_unit(eo_cells_at(reader->cells, 0, column), name, unit);
    if (!*cell || !*name)
      continue;
    if (strcmp(name, "name") == 0)
      put_name(reader, column);
    else if (!eo_design_key_find(&key, name, 0, reader->ends))
      unknown_key(reader, 0, column, name);
    else if (key.of_member)
      fault(reader, column, "member_needed",
            "\"%.100s\" could be the pinion's or the gear's; write the whole key, as %.150s.", name, key.path[0]);
    else
      put(reader, &key, column, read_value(reader, &key, name, cell, unit, column));
  }
}

static int read_rows(struct reader *reader, int wanted)
{
  int designs = 0, name_column = -1, ends_column = -1;
  for (int column = 0; column < reader->cells->columns; column++) {
    const char *header = eo_cells_at(reader->cells, 0, column);
    name_column = strcmp(header, "name") == 0 ? column : name_column;
    ends_column = strcmp(header, "gear_pair.ends") == 0 ? column : ends_column;
  }
  for (int row = 1; row < reader->cells->rows && designs < DESIGNS; row++) {
    list_design(reader->out, eo_cells_at(reader->cells, row, name_column));
    designs++;
  }
  if ((designs > 1 && !wanted) || wanted > designs)
    return designs;
  reader->row = wanted ? wanted : 1;
  reader->ends = strcmp(eo_cells_at(reader->cells, reader->row, ends_column), "1") == 0 ? 1 : 2;
  if (designs)
    read_wide_row(reader);
  return designs;
}

static void read_designs(struct reader *reader, const struct eo_import_options *options)
{
  int designs = 0;
  reader->head = find_head(reader);
  reader->wide = !reader->head && is_wide(reader);
  if (reader->head)
    designs = read_blocks(reader, options->pair);
  else if (reader->wide)
    designs = read_rows(reader, options->pair);
  if (!designs)
    eo_import_fault(
        reader->out, "no_design",
        "The table holds no design: it begins neither with key;pinion;gear;unit nor with a row of keys. Head "
        "its columns so.");
  else if (!options->pair && designs > 1)
    eo_import_fault(reader->out, "choice_needed", "The table has %d designs; choose one by its number (--pair N).",
                    designs);
  else if (options->pair > designs)
    eo_import_fault(reader->out, "no_such_pair", "There is no design %d; the table has 1 to %d.", options->pair,
                    designs);
  else
    reader->out->taken = options->pair ? options->pair : 1;
}

void eo_import_table(struct eo_import *out, const char *bytes, size_t size, bool workbook,
                     const struct eo_import_options *options)
{
  struct eo_cells cells;
  struct eo_error error;
  enum eo_code code = workbook ? eo_cells_read_workbook(&cells, bytes, size, &error)
                               : eo_cells_read(&cells, bytes, size, &error);
  struct reader reader = {.out = out, .cells = &cells, .ends = 2, .design = json_object(), .given = json_object()};
  snprintf(out->format, sizeof out->format, workbook ? "workbook" : "table");
  if (code == EO_ERROR_MEMORY || !reader.design || !reader.given)
    out->failed = true;
  else if (code)
    eo_import_fault(out, "not_readable", "%s", error.text);
  else if (find_decimal_sign(&reader))
    read_designs(&reader, options);
  eo_cells_done(&cells);
  json_decref(reader.given);
  if (out->taken)
    out->design = reader.design;
  else
    json_decref(reader.design);
}
