/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text that Octave saves: one variable after the other, each with "# name:", "# type:" and its size before its values.
   Scalars, texts, matrices, ranges, and structs and cells of such. */
#include "base/decimal.h"
#include "recording/reader_private.h"
#include "recording/source.h"
#include "recording/tree_columns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define WIDE 64 /* a matrix with more columns is no table of channels */
#define DEPTH 8 /* of structs and cells in each other */
#define ELEMENTS 4096
#define RANGES 8 /* values of all ranges, for each byte of the file: they cost none */
#define LINE 256
#define BUFFER 65536

struct octave {
  struct eo_source *source;
  int64_t bytes, ranged; /* of the file; values of ranges so far */
  size_t at, size;
  bool again; /* the line was given back */
  int left_out;
  struct eo_tree_columns columns;
  char line[LINE]; /* the last one, cut to this */
  char buffer[BUFFER];
};

/* The next byte, -1 at the end. */
static enum eo_code next_byte(struct octave *octave, int *byte, struct eo_error *error)
{
  if (octave->at == octave->size) {
    octave->at = 0;
    EO_TRY(eo_source_read(octave->source, octave->buffer, sizeof octave->buffer, &octave->size, error));
  }
  *byte = octave->at < octave->size ? (unsigned char)octave->buffer[octave->at++] : -1;
  return EO_OK;
}

/* The next line into octave->line; *there: false at the end of the file. */
static enum eo_code next_line(struct octave *octave, bool *there, struct eo_error *error)
{
  size_t n = 0;
  int byte = '\n';
  *there = true;
  if (octave->again) {
    octave->again = false;
    return EO_OK;
  }
  EO_TRY(next_byte(octave, &byte, error));
  *there = byte >= 0;
  while (byte >= 0 && byte != '\n') {
    if (n + 1 < LINE && byte != '\r')
      octave->line[n++] = (char)byte;
    EO_TRY(next_byte(octave, &byte, error));
  }
  octave->line[n] = '\0';
  return EO_OK;
}

static enum eo_code refuse_end(const char *path, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, "", "Octave: the values of \"%.60s\" end early; the file is cut off.",
                      path);
}

/* The next number; NA and NaN are none. */
static enum eo_code next_number(struct octave *octave, const char *path, double *value, struct eo_error *error)
{
  char word[64];
  size_t n = 0;
  int byte = ' ';
  while (byte == ' ' || byte == '\n' || byte == '\r' || byte == '\t')
    EO_TRY(next_byte(octave, &byte, error));
  while (byte > ' ' && n + 1 < sizeof word) {
    word[n++] = (char)byte;
    EO_TRY(next_byte(octave, &byte, error));
  }
  word[n] = '\0';
  const char *after = eo_decimal_read(word, '.', value);
  if (n && (!strcmp(word, "NaN") || !strcmp(word, "NA") || !strcmp(word, "Inf") || !strcmp(word, "-Inf")))
    *value = NAN;
  else if (!after || *after)
    return refuse_end(path, error);
  return EO_OK;
}

/* What follows "# rows: " and the like in the last line; NULL: another line. */
static const char *value_of(const struct octave *octave, const char *key)
{
  size_t n = strlen(key);
  return octave->line[0] == '#' && octave->line[1] == ' ' && !strncmp(octave->line + 2, key, n) &&
                 octave->line[2 + n] == ':'
             ? octave->line + 3 + n + strspn(octave->line + 3 + n, " ")
             : NULL;
}

/* A line with a count under this key, which must come next. */
static enum eo_code take_count(struct octave *octave, const char *path, const char *key, int64_t *count,
                               struct eo_error *error)
{
  bool there;
  EO_TRY(next_line(octave, &there, error));
  const char *value = there ? value_of(octave, key) : NULL;
  *count = value ? strtoll(value, NULL, 10) : -1;
  if (*count >= 0 && *count <= INT32_MAX)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "", "Octave: \"%.60s\" does not state its \"%s\".", path, key);
}

/* The two sides of a matrix that are longer than 1; *by_columns: its values stand column by column. False: more. */
static enum eo_code take_sides(struct octave *octave, const char *path, int64_t side[2], bool *by_columns, bool *flat,
                               struct eo_error *error)
{
  bool there;
  int64_t dimensions;
  EO_TRY(next_line(octave, &there, error));
  octave->again = there;
  *flat = true;
  *by_columns = there && value_of(octave, "ndims");
  if (!*by_columns) {
    EO_TRY(take_count(octave, path, "rows", &side[0], error));
    return take_count(octave, path, "columns", &side[1], error);
  }
  EO_TRY(take_count(octave, path, "ndims", &dimensions, error));
  int count = 0;
  side[0] = side[1] = 1;
  for (int64_t i = 0; i < dimensions; i++) {
    double length;
    EO_TRY(next_number(octave, path, &length, error));
    if (!(length >= 0 && length <= INT32_MAX))
      return refuse_end(path, error);
    if (length != 1 && count++ < 2)
      side[count - 1] = (int64_t)length;
  }
  *flat = count <= 2;
  return EO_OK;
}

static bool is_whole(const char *type)
{
  return strstr(type, "int") || strstr(type, "bool");
}

static enum eo_code add_matrix(struct octave *octave, const char *type, const char *path, struct eo_error *error)
{
  int64_t side[2];
  bool by_columns, flat;
  EO_TRY(take_sides(octave, path, side, &by_columns, &flat, error));
  int64_t count = side[0] * side[1];
  bool down = side[0] >= side[1]; /* values of a channel follow each other along the longer side */
  int64_t channels = down ? side[1] : side[0], length = down ? side[0] : side[1];
  double value;
  if (flat && count == 1) {
    EO_TRY(next_number(octave, path, &value, error));
    eo_tree_add_number(octave->columns.tree, path, value);
    return EO_OK;
  }
  int base = flat && count > 0 && channels <= WIDE
                 ? eo_tree_add_series(octave->columns.tree, path, (int)channels, length, is_whole(type))
                 : -1;
  octave->left_out += base < 0;
  if (base < 0)
    return EO_OK; /* its lines are passed over on the way to the next name */
  EO_TRY(eo_tree_columns_add(&octave->columns, base, (int)channels, error));
  for (int64_t i = 0; i < count; i++) {
    int64_t row = by_columns ? i % side[0] : i / side[1], column = by_columns ? i / side[0] : i % side[1];
    EO_TRY(next_number(octave, path, &value, error));
    EO_TRY(eo_recording_append(octave->columns.column[base + (down ? column : row)], &value, 1, error));
  }
  return EO_OK;
}

/* "0:0.00025:2" is kept as such. */
static enum eo_code add_range(struct octave *octave, const char *path, struct eo_error *error)
{
  bool there;
  double first, last, step;
  EO_TRY(next_line(octave, &there, error));
  EO_TRY(next_number(octave, path, &first, error));
  EO_TRY(next_number(octave, path, &last, error));
  EO_TRY(next_number(octave, path, &step, error));
  double count = floor((last - first) / step * (1 + 1e-15) + 1e-10) + 1;
  bool fits = count >= 2 && count <= (double)octave->bytes; /* no channel beside it can be longer */
  octave->ranged += fits ? (int64_t)count : 0;
  int base = fits && octave->ranged <= RANGES * octave->bytes
                 ? eo_tree_add_series(octave->columns.tree, path, 1, (int64_t)count, false)
                 : -1;
  octave->left_out += base < 0;
  if (base < 0)
    return EO_OK;
  EO_TRY(eo_tree_columns_add(&octave->columns, base, 1, error));
  for (int64_t i = 0; i < (int64_t)count; i++) {
    double value = first + (double)i * step;
    EO_TRY(eo_recording_append(octave->columns.column[base], &value, 1, error));
  }
  return EO_OK;
}

/* One text, or several as a list. */
static enum eo_code add_texts(struct octave *octave, const char *path, struct eo_error *error)
{
  int64_t elements, length;
  char list[4096] = "";
  size_t used = 0;
  EO_TRY(take_count(octave, path, "elements", &elements, error));
  for (int64_t i = 0; i < elements; i++) {
    bool there;
    EO_TRY(take_count(octave, path, "length", &length, error));
    EO_TRY(next_line(octave, &there, error));
    if (there && used + strlen(octave->line) + 2 < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? "\n" : "", octave->line);
  }
  if (elements > 1)
    eo_tree_add_list(octave->columns.tree, path, list);
  else
    eo_tree_add_text(octave->columns.tree, path, list);
  return EO_OK;
}

static enum eo_code add_next(struct octave *octave, const char *group, const char *element, int depth, bool *there,
                             struct eo_error *error);

/* The variables of a struct, "name/field", or of a cell, "name 2". */
static enum eo_code add_members(struct octave *octave, const char *path, bool cell, int depth, struct eo_error *error)
{
  int64_t side[2] = {1, 1}, count;
  bool by_columns, flat, there = true;
  char element[EO_TREE_PATH];
  EO_TRY(take_sides(octave, path, side, &by_columns, &flat, error));
  if (cell)
    count = side[0] * side[1];
  else {
    EO_TRY(next_line(octave, &there, error)); /* what is left of the line with the dimensions */
    octave->again = there && *octave->line;
    EO_TRY(take_count(octave, path, "length", &count, error));
  }
  for (int64_t i = 0; i < count && i < ELEMENTS && there; i++) {
    if (cell && snprintf(element, sizeof element, "%s %lld", path, (long long)i + 1) >= (int)sizeof element)
      break;
    EO_TRY(add_next(octave, path, cell ? element : NULL, depth + 1, &there, error));
  }
  return EO_OK;
}

static enum eo_code add_type(struct octave *octave, const char *type, const char *path, int depth,
                             struct eo_error *error)
{
  size_t length = strlen(type);
  bool scalar = length >= 6 && !strcmp(type + length - 6, "scalar"),
       matrix = length >= 6 && !strcmp(type + length - 6, "matrix");
  double value;
  if (strstr(type, "complex") || strstr(type, "diagonal") || strstr(type, "sparse") || depth > DEPTH) {
    octave->left_out++;
    return EO_OK;
  }
  if (scalar || !strcmp(type, "bool")) {
    EO_TRY(next_number(octave, path, &value, error));
    eo_tree_add_number(octave->columns.tree, path, value);
    return EO_OK;
  }
  if (matrix)
    return add_matrix(octave, type, path, error);
  if (strstr(type, "range"))
    return add_range(octave, path, error);
  if (!strcmp(type, "string") || !strcmp(type, "sq_string"))
    return add_texts(octave, path, error);
  if (strstr(type, "struct") || !strcmp(type, "cell"))
    return add_members(octave, path, !strcmp(type, "cell"), depth, error);
  octave->left_out++;
  return EO_OK;
}

/* The next variable below a group ("": of the file). element: its path where it is one of a cell, else NULL. *there:
   false when no more comes. */
static enum eo_code add_next(struct octave *octave, const char *group, const char *element, int depth, bool *there,
                             struct eo_error *error)
{
  char path[EO_TREE_PATH], type[64];
  const char *name = NULL;
  while (!name) {
    EO_TRY(next_line(octave, there, error));
    if (!*there)
      return EO_OK;
    name = value_of(octave, "name");
  }
  int n = element ? snprintf(path, sizeof path, "%s", element)
                  : snprintf(path, sizeof path, "%s%s%s", group, *group ? "/" : "", name);
  EO_TRY(next_line(octave, there, error));
  const char *stated = *there ? value_of(octave, "type") : NULL;
  if (!stated)
    return refuse_end(path, error);
  snprintf(type, sizeof type, "%.60s", strncmp(stated, "global ", 7) ? stated : stated + 7);
  return n < (int)sizeof path ? add_type(octave, type, path, depth, error) : EO_OK;
}

static enum eo_code read_file(struct octave *octave, const char *path, const struct eo_reader_options *options,
                              const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  bool there = true;
  struct stat state;
  EO_TRY(eo_source_open(&octave->source, path, options->max_bytes, error));
  octave->bytes = stat(path, &state) ? 0 : state.st_size;
  EO_TRY(eo_tree_new(&octave->columns.tree, error));
  while (there)
    EO_TRY(add_next(octave, "", NULL, 0, &there, error));
  return eo_tree_columns_copy(&octave->columns, octave->left_out, octave->bytes, options, sink, notes, error);
}

enum eo_code eo_octave_read(const char *path, const struct eo_reader_options *options,
                            const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  struct octave *octave = calloc(1, sizeof *octave);
  if (!octave)
    return eo_error_memory(error);
  octave->columns.spool_directory = options->spool_directory;
  enum eo_code code = read_file(octave, path, options, sink, notes, error);
  eo_source_close(octave->source);
  eo_tree_columns_done(&octave->columns);
  free(octave);
  return code;
}
