/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/flank_grid_document.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "gear/gear_pair.h"
#include "gear/names.h"

enum { MOST_TEXT = 1 << 20 };

struct grid_document {
  struct eo_numbers u, y;
  struct eo_matrix delta;
  char kind[12];
};

static const char *const kinds[] = {"measured", "designed", NULL};

static const struct eo_field grid_fields[] = {
    EO_SERIES(struct grid_document, u, "u_mm", &eo_unit_mm, EO_GRID_KNOTS, -200, 200, EO_FIELD_ASCENDING,
              "rack coordinate of each row from the pitch point, + towards the member's own tip, increasing"),
    EO_SERIES(struct grid_document, y, "y_mm", &eo_unit_mm, EO_GRID_KNOTS, -2500, 2500, EO_FIELD_ASCENDING,
              "axial place of each column from mid face, + towards the face end that meets first on the drive flank, "
              "increasing"),
    EO_MATRIX(struct grid_document, delta, "delta_um", &eo_unit_um, EO_GRID_KNOTS, -1000, 1000,
              "what is taken off, normal: one row for each u, one number for each y; natural bicubic spline between "
              "them, the nearest border value beyond"),
    {.key = "csv",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_ELSEWHERE,
     .count = MOST_TEXT,
     .help =
         "in place of u_mm, y_mm and delta_um: a table as text, y in mm in the first row behind a corner cell, then "
         "rows of u in mm and delta in um"},
    EO_WORD_DERIVED(
        struct grid_document, kind, "kind", kinds, 0, NULL,
        "measured; designed where numbers of it vary: variables of a search, axes of a study, grid_nodes",
        "measured: how the flank is, of the unmodified pair too; designed: what a designer or a search takes "
        "off, which the unmodified pair goes without"),
};
const struct eo_table eo_flank_grid_table = EO_TABLE("a flank's grid", struct grid_document, grid_fields);

/* Text: */

/* Where the reading of a table stands. */
struct cursor {
  const char *at;
  int line, column; /* from 1 */
  const char *separators;
  bool decimal_comma;
};

/* Semicolons and tabs leave the comma to decimals; else commas separate. */
static void choose_separators(struct cursor *cursor)
{
  bool apart = strchr(cursor->at, ';') || strchr(cursor->at, '\t');
  cursor->separators = apart ? ";\t" : ",";
  cursor->decimal_comma = apart && !strchr(cursor->at, '.');
}

static bool at_line_end(const struct cursor *cursor)
{
  return *cursor->at == 0 || *cursor->at == '\n' || *cursor->at == '\r';
}

static void skip_blanks(struct cursor *cursor)
{
  while (*cursor->at == ' ' || (*cursor->at == '\t' && !strchr(cursor->separators, '\t')))
    cursor->at++;
}

static void next_line(struct cursor *cursor)
{
  while (*cursor->at && *cursor->at != '\n')
    cursor->at++;
  cursor->at += *cursor->at == '\n';
  cursor->line++;
  cursor->column = 1;
}

static void skip_remarks(struct cursor *cursor)
{
  for (;;) {
    const char *from = cursor->at;
    while (*from && isspace((unsigned char)*from) && *from != '\n')
      from++;
    if (*from != '#' && *from != '\n')
      return;
    next_line(cursor);
  }
}

/* Behind a cell: its separator, or blanks alone. */
static void leave_cell(struct cursor *cursor)
{
  skip_blanks(cursor);
  if (*cursor->at && strchr(cursor->separators, *cursor->at))
    cursor->at++;
  skip_blanks(cursor);
  cursor->column++;
}

static bool read_cell(struct cursor *cursor, double *number, struct eo_error *error)
{
  char cell[64];
  size_t length = strcspn(cursor->at, cursor->decimal_comma ? ";\t \r\n" : ",;\t \r\n");
  if (length > 0 && length < sizeof cell) {
    char *end;
    memcpy(cell, cursor->at, length);
    cell[length] = 0;
    for (char *c = cell; cursor->decimal_comma && *c; c++)
      *c = *c == ',' ? '.' : *c;
    *number = strtod(cell, &end);
    if (*end == 0) {
      cursor->at += length;
      leave_cell(cursor);
      return true;
    }
  }
  eo_error_set(error, EO_ERROR_INPUT, NULL, "Line %d, column %d of the table: \"%.*s\" is not a number.", cursor->line,
               cursor->column, (int)(length < 40 ? length : 40), cursor->at);
  return false;
}

/* One row of numbers; those of the first row follow a corner cell, which may hold anything. */
static json_t *read_row(struct cursor *cursor, json_t *first, struct eo_error *error)
{
  json_t *row = json_array();
  double number;
  while (row && !at_line_end(cursor)) {
    if (!read_cell(cursor, &number, error) ||
        json_array_append_new(first && cursor->column == 2 ? first : row, json_real(number)) != 0) {
      json_decref(row);
      return NULL;
    }
  }
  next_line(cursor);
  return row;
}

static json_t *read_heading(struct cursor *cursor, struct eo_error *error)
{
  skip_blanks(cursor);
  cursor->at += strcspn(cursor->at, cursor->decimal_comma ? ";\t\r\n" : ",;\t \r\n");
  leave_cell(cursor);
  return read_row(cursor, NULL, error);
}

json_t *eo_flank_grid_from_text(const char *text, struct eo_error *error)
{
  struct cursor cursor = {text, 1, 1, "", false};
  choose_separators(&cursor);
  skip_remarks(&cursor);
  json_t *value = read_heading(&cursor, error), *value_of = json_array(), *rows = json_array();
  bool good = value && value_of && rows;
  for (skip_remarks(&cursor); good && *cursor.at; skip_remarks(&cursor)) {
    int line = cursor.line;
    json_t *row = read_row(&cursor, value_of, error);
    good = row != NULL;
    if (good && json_array_size(row) != json_array_size(value)) {
      eo_error_set(error, EO_ERROR_INPUT, NULL,
                   "Line %d of the table has %zu numbers behind u, but the first row states %zu places y.", line,
                   json_array_size(row), json_array_size(value));
      json_decref(row);
      good = false;
    } else if (good)
      good = json_array_append_new(rows, row) == 0;
  }
  if (good)
    return json_pack("{s:o, s:o, s:o}", "u_mm", value_of, "y_mm", value, "delta_um", rows);
  json_decref(value_of);
  json_decref(value);
  json_decref(rows);
  return NULL;
}

void eo_flank_grid_to_text(const struct eo_flank_grid *grid, struct eo_text *text)
{
  eo_text_add(text, "u_mm\\y_mm");
  for (int j = 0; j < grid->y_knots; j++)
    eo_text_print(text, ",%.9g", eo_unit_out(&eo_unit_mm, grid->y[j]));
  for (int i = 0; i < grid->u_knots; i++) {
    eo_text_print(text, "\n%.9g", eo_unit_out(&eo_unit_mm, grid->u[i]));
    for (int j = 0; j < grid->y_knots; j++)
      eo_text_print(text, ",%.6g", eo_unit_out(&eo_unit_um, grid->delta[i * grid->y_knots + j]));
  }
  eo_text_add(text, "\n");
}

/* Documents: */

/* The three arrays belong together, and two knots at least make a surface. */
static bool fits(const struct grid_document *document, const struct eo_path *path, struct eo_faults *faults)
{
  if (document->u.count < 2 || document->y.count < 2)
    eo_faults_at(faults, path,
                 "A grid needs at least 2 places u_mm and 2 places y_mm (4 of each to bend), not %d x %d.",
                 document->u.count, document->y.count);
  else if (document->delta.rows != document->u.count || document->delta.columns != document->y.count)
    eo_faults_at(faults, path, "delta_um is %d x %d, but there are %d places u_mm (rows) and %d places y_mm (columns).",
                 document->delta.rows, document->delta.columns, document->u.count, document->y.count);
  else
    return true;
  return false;
}

static void decode_grid(const json_t *object, const struct eo_path *path, struct grid_document *document,
                        struct eo_faults *faults)
{
  const json_t *text = json_object_get(object, "csv");
  json_t *kind = json_object_get(object, "kind");
  struct eo_path place = {path, "csv", 0};
  struct eo_error error;
  if (!text) {
    eo_table_decode(&eo_flank_grid_table, object, path, document, faults);
    return;
  }
  if (!json_is_string(text) || json_object_size(object) > 1 + (kind != NULL)) {
    eo_faults_at(faults, &place,
                 "A table is a text and stands alone, without u_mm, y_mm and delta_um; kind may stand with it.");
    return;
  }
  eo_error_set(&error, EO_ERROR_MEMORY, NULL, "Not enough memory.");
  json_t *read = json_string_length(text) < MOST_TEXT ? eo_flank_grid_from_text(json_string_value(text), &error) : NULL;
  if (read && kind)
    json_object_set(read, "kind", kind);
  if (read)
    eo_table_decode(&eo_flank_grid_table, read, path, document, faults);
  else if (json_string_length(text) >= MOST_TEXT)
    eo_faults_at(faults, &place, "A table of %zu bytes is longer than the %d allowed.", json_string_length(text),
                 MOST_TEXT - 1);
  else if (error.code == EO_ERROR_MEMORY)
    eo_faults_memory(faults);
  else
    eo_faults_at(faults, &place, "%s", error.text);
  json_decref(read);
}

static void add_grid(const json_t *flank, const struct eo_path *path, enum eo_flank_side side, int member, int end,
                     struct eo_flank_grids *grids, struct eo_faults *faults)
{
  const json_t *object = json_object_get(flank, "grid");
  struct eo_path place = {path, "grid", 0};
  struct grid_document document = {0};
  struct eo_error error;
  int before = faults->count;
  if (!object || json_is_null(object))
    return;
  decode_grid(object, &place, &document, faults);
  if (faults->count == before && fits(&document, &place, faults)) {
    eo_table_round_to_document(&eo_flank_grid_table, &document);
    struct eo_flank_grid grid = {.u_knots = document.u.count,
                                 .y_knots = document.y.count,
                                 .u = document.u.value,
                                 .y = document.y.value,
                                 .delta = document.delta.value,
                                 .kind = strcmp(document.kind, kinds[EO_GRID_DESIGNED]) == 0 ? EO_GRID_DESIGNED
                                                                                             : EO_GRID_MEASURED,
                                 .kind_stated = *document.kind != 0};
    if (eo_flank_grids_put(grids, side, member, end, &grid, &error))
      eo_faults_at(faults, &place, "%s", error.text);
  }
  eo_table_done(&eo_flank_grid_table, &document);
}

void eo_flank_grids_decode(const json_t *modification, int ends, struct eo_flank_grids *grids, struct eo_faults *faults)
{
  struct eo_path top = {NULL, "modification", 0};
  memset(grids, 0, sizeof *grids);
  for (int member = 0; member < 2; member++) {
    struct eo_path of_member = {&top, eo_member_name[member], 0};
    const json_t *ends_of_member = json_object_get(modification, eo_member_name[member]);
    for (int end = 0; end < ends; end++) {
      struct eo_path of_end = {&of_member, eo_end_name[end], 0}, of_coast = {&of_end, "coast", 0};
      const json_t *flank = json_object_get(ends_of_member, eo_end_name[end]);
      add_grid(flank, &of_end, EO_DRIVE_FLANK, member, end, grids, faults);
      add_grid(json_object_get(flank, "coast"), &of_coast, EO_COAST_FLANK, member, end, grids, faults);
    }
  }
}

/* The object under a key, made where it is missing. */
static json_t *reach(json_t *object, const char *key, bool *failed)
{
  json_t *inner = json_object_get(object, key);
  if (inner)
    return inner;
  eo_json_put(object, key, json_object(), failed);
  return json_object_get(object, key);
}

/* The kind where it is stated, or is not what an absent one means. */
static json_t *encode_grid(const struct eo_flank_grid *grid)
{
  bool says_kind = grid->kind_stated || grid->kind != EO_GRID_MEASURED;
  /* encoding reads alone */
  struct grid_document document = {{grid->u_knots, (double *)grid->u},
                                   {grid->y_knots, (double *)grid->y},
                                   {grid->u_knots, grid->y_knots, (double *)grid->delta},
                                   ""};
  if (says_kind)
    snprintf(document.kind, sizeof document.kind, "%s", kinds[grid->kind]);
  json_t *object = eo_table_encode(&eo_flank_grid_table, &document);
  if (object && !says_kind)
    json_object_del(object, "kind");
  return object;
}

void eo_flank_grids_encode(const struct eo_flank_grids *grids, int ends, json_t *modification, bool *failed)
{
  for (int side = 0; side < 2; side++)
    for (int member = 0; member < 2; member++)
      for (int end = 0; end < ends; end++) {
        struct eo_flank_grid grid = eo_flank_grid_at(grids, (enum eo_flank_side)side, member, end);
        if (grid.u_knots == 0)
          continue;
        json_t *flank = reach(reach(modification, eo_member_name[member], failed), eo_end_name[end], failed);
        flank = side == EO_COAST_FLANK ? reach(flank, "coast", failed) : flank;
        eo_json_put(flank, "grid", encode_grid(&grid), failed);
      }
}

bool eo_flank_shape(const struct eo_design *design, const struct eo_geometry *geometry, enum eo_flank_side side,
                    int member, int end, struct eo_modification_shape *shape, struct eo_flank_spline **spline)
{
  const struct eo_modification *modification = &design->modification;
  const struct eo_flank_modification *flank = side == EO_DRIVE_FLANK ? &modification->flank[member][end]
                                                                     : &modification->coast[member][end];
  struct eo_flank_grid grid = eo_flank_grid_at(&design->grids, side, member, end);
  size_t size = sizeof(double) * (size_t)grid.u_knots * (size_t)grid.y_knots;
  double *delta = flank->nodes && size ? malloc(size) : NULL;
  struct eo_error error;
  *spline = NULL;
  if (delta) {
    memcpy(delta, grid.delta, size);
    eo_grid_nodes_lay(flank->nodes, flank->node, grid.u_knots, grid.y_knots, delta);
    grid.delta = delta;
  }
  bool failed = (flank->nodes && size && !delta) || (grid.u_knots && eo_flank_spline_new(spline, &grid, &error));
  free(delta);
  eo_modification_init(shape, geometry, member, flank);
  eo_modification_complete(shape, *spline, false);
  return failed;
}

bool eo_design_shows_coast(const struct eo_design *design)
{
  bool shows = false;
  for (int k = 0; k < design->load_cases; k++)
    shows = shows || design->load_case[k].flank == EO_COAST_FLANK;
  for (int i = 0; i < 2; i++)
    for (int end = 0; end < design->gear_pair.ends; end++)
      shows = shows || !eo_modification_is_none(&design->modification.coast[i][end]) ||
              design->grids.place[EO_COAST_FLANK][i][end].u_knots > 0;
  return shows;
}
