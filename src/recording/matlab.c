/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MATLAB files of versions 4, 5 and 7 by libmatio: numeric vectors, matrices with one channel per column, the same in
   structs, arrays of structs and cells at any depth. Runs in a process of its own. Version 7.3 is HDF5 and read as
   such. */
#include "recording/bytes.h"
#include "recording/reader_private.h"
#include "recording/source.h"
#include "recording/tree_columns.h"

#include <matio.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define WIDE 64        /* a matrix with more columns is no table of channels */
#define VARIABLES 1024 /* of a file that are looked at */
#define DEPTH 8        /* of structs and cells in each other */
#define ELEMENTS 4096  /* of an array of structs or a cell that are looked at */
#define BATCH 4096     /* values of a channel that are kept at once */
#define PIECE 65536    /* values read at once from variables that are not compressed */

struct matlab {
  mat_t *file;
  int64_t bytes;  /* of the file */
  int64_t values; /* of all variables so far */
  int left_out;
  struct eo_notes *notes;
  struct eo_tree_columns columns;
};

static int64_t class_size(enum matio_classes class)
{
  switch (class) {
  case MAT_C_DOUBLE:
  case MAT_C_INT64:
  case MAT_C_UINT64:
    return 8;
  case MAT_C_SINGLE:
  case MAT_C_INT32:
  case MAT_C_UINT32:
    return 4;
  case MAT_C_INT16:
  case MAT_C_UINT16:
    return 2;
  case MAT_C_INT8:
  case MAT_C_UINT8:
    return 1;
  default:
    return 0;
  }
}

static double value_at(const void *data, enum matio_classes class, int64_t i)
{
  switch (class) {
  case MAT_C_DOUBLE:
    return ((const double *)data)[i];
  case MAT_C_SINGLE:
    return ((const float *)data)[i];
  case MAT_C_INT64:
    return (double)((const int64_t *)data)[i];
  case MAT_C_UINT64:
    return (double)((const uint64_t *)data)[i];
  case MAT_C_INT32:
    return ((const int32_t *)data)[i];
  case MAT_C_UINT32:
    return ((const uint32_t *)data)[i];
  case MAT_C_INT16:
    return ((const int16_t *)data)[i];
  case MAT_C_UINT16:
    return ((const uint16_t *)data)[i];
  case MAT_C_INT8:
    return ((const int8_t *)data)[i];
  default:
    return ((const uint8_t *)data)[i];
  }
}

/* Rows and columns of channels: values follow each other along the longer side. */
struct table {
  int64_t length, channels, along, across; /* steps in the variable from value to value and from channel to channel */
};

/* The two sides of a variable; dimensions of length 1 do not count ("1 x 1 x N", "2 x 1 x N" of Simulink). */
static bool find_sides(const matvar_t *this_t, int64_t *rows, int64_t *columns)
{
  int count = 0;
  *rows = *columns = 1;
  for (int i = 0; this_t->dims && i < this_t->rank; i++) {
    if (!this_t->dims[i] || this_t->dims[i] > INT64_MAX)
      return false;
    if (this_t->dims[i] > 1)
      *(count++ ? columns : rows) = (int64_t)this_t->dims[i];
  }
  return this_t->dims && this_t->rank >= 2 && count <= 2;
}

static bool find_table(const matvar_t *this_t, struct table *table)
{
  int64_t rows, columns;
  if (!find_sides(this_t, &rows, &columns) || this_t->isComplex || !class_size(this_t->class_type))
    return false;
  if (rows > INT32_MAX || columns > INT32_MAX || rows * columns > INT32_MAX)
    return false;
  *table = rows >= columns ? (struct table){rows, columns, 1, rows} : (struct table){columns, rows, rows, 1};
  return table->channels <= WIDE;
}

/* The values first .. first + count - 1 of the variable as they are stored, column by column. */
static enum eo_code read_values(struct matlab *matlab, matvar_t *this_t, int64_t first, int64_t count, void *data,
                                struct eo_error *error)
{
  if (!Mat_VarReadDataLinear(matlab->file, this_t, data, (int)first, 1, (int)count))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "MATLAB: the values of \"%.60s\" cannot be read; the file is damaged or cut off.", this_t->name);
}

/* Gives each value of a piece to its channel. Only pieces that begin and end with whole runs of channels reach here
   when along > 1. */
static enum eo_code keep_values(struct matlab *matlab, const struct table *table, int base, int64_t first,
                                int64_t count, const void *data, enum matio_classes class, struct eo_error *error)
{
  double values[BATCH];
  for (int64_t c = 0; c < table->channels; c++) {
    int64_t from = table->along == 1 ? c * table->length - first : c, end = count, n = 0;
    if (table->along == 1)
      end = from + table->length < count ? from + table->length : count;
    for (int64_t i = from > 0 ? from : 0; i < end; i += table->along) {
      values[n++] = value_at(data, class, i);
      if (n < BATCH && i + table->along < end)
        continue;
      EO_TRY(eo_recording_append(matlab->columns.column[base + c], values, n, error));
      n = 0;
    }
  }
  return EO_OK;
}

/* Compressed variables can only be read at once; their size is bounded by that of the file. */
static enum eo_code copy_values(struct matlab *matlab, matvar_t *this_t, const struct table *table, int base,
                                struct eo_error *error)
{
  int64_t total = table->length * table->channels, size = class_size(this_t->class_type);
  int64_t piece = this_t->compression == MAT_COMPRESSION_NONE ? PIECE / table->channels * table->channels : total;
  if (piece > total)
    piece = total;
  matlab->values += total;
  if (matlab->values > EO_SOURCE_FREE / 8 && matlab->values / EO_SOURCE_EXPANSION > matlab->bytes / 8)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MATLAB: \"%.60s\" states %lld values; the file has only %lld bytes.", this_t->name,
                        (long long)total, (long long)matlab->bytes);
  void *data = calloc((size_t)piece, (size_t)size);
  enum eo_code code = data ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < total; first += piece) {
    int64_t n = total - first < piece ? total - first : piece;
    code = read_values(matlab, this_t, first, n, data, error);
    if (!code)
      code = keep_values(matlab, table, base, first, n, data, this_t->class_type, error);
  }
  free(data);
  return code;
}

static bool is_whole(enum matio_classes class)
{
  return class != MAT_C_DOUBLE && class != MAT_C_SINGLE;
}

/* A text of one row; characters of two bytes beyond Latin 1 become '?'. */
static bool text_of(struct matlab *matlab, matvar_t *this_t, char *text, size_t size)
{
  *text = '\0';
  if (!this_t || this_t->class_type != MAT_C_CHAR || this_t->rank != 2 || !this_t->dims || this_t->dims[0] > 1 ||
      this_t->dims[1] >= size)
    return false;
  if (!this_t->data && Mat_VarReadDataAll(matlab->file, this_t))
    return false;
  size_t n = this_t->dims[1];
  if (this_t->data_type == MAT_T_UTF8 && this_t->nbytes > n) /* the dimensions count letters, some have two bytes */
    n = this_t->nbytes < size ? this_t->nbytes : size - 1;
  if (!this_t->data || this_t->nbytes < n * (size_t)this_t->data_size)
    return false;
  bool wide = this_t->data_type == MAT_T_UINT16 || this_t->data_type == MAT_T_UTF16;
  const unsigned char *bytes = this_t->data;
  const uint16_t *words = this_t->data;
  for (size_t i = 0; i < n; i++)
    text[i] = (char)(wide ? words[i] < 256 ? words[i] : '?' : bytes[i]);
  text[n] = '\0';
  return true;
}

/* Texts below each other, filled up with blanks: a list. */
static void add_text_rows(struct matlab *matlab, matvar_t *this_t, const char *path)
{
  char list[4096];
  if (this_t->rank != 2 || !this_t->dims || this_t->dims[0] < 2 || this_t->dims[0] > ELEMENTS ||
      this_t->dims[0] * (this_t->dims[1] + 1) > sizeof list ||
      (!this_t->data && Mat_VarReadDataAll(matlab->file, this_t)))
    return;
  size_t rows = this_t->dims[0], columns = this_t->dims[1], used = 0;
  bool wide = this_t->data_type == MAT_T_UINT16 || this_t->data_type == MAT_T_UTF16;
  const unsigned char *bytes = this_t->data;
  const uint16_t *words = this_t->data;
  if (!this_t->data || this_t->nbytes != rows * columns * (wide ? 2 : 1))
    return;
  for (size_t row = 0; row < rows; row++) {
    size_t begin = used;
    for (size_t c = 0; c < columns; c++) {
      unsigned letter = wide ? words[c * rows + row] : bytes[c * rows + row];
      list[used++] = letter < 256 && letter >= ' ' ? (char)letter : '?';
    }
    while (used > begin && list[used - 1] == ' ')
      used--;
    list[used++] = row + 1 < rows ? '\n' : '\0';
  }
  eo_tree_add_list(matlab->columns.tree, path, list);
}

static void add_number(struct matlab *matlab, matvar_t *this_t, const char *path)
{
  char data[8] = "";
  struct eo_error error;
  if (!read_values(matlab, this_t, 0, 1, data, &error))
    eo_tree_add_number(matlab->columns.tree, path, value_at(data, this_t->class_type, 0));
}

static enum eo_code add_channels(struct matlab *matlab, matvar_t *this_t, const char *path, struct eo_error *error)
{
  struct table table;
  if (!find_table(this_t, &table)) {
    matlab->left_out++;
    return EO_OK;
  }
  if (table.length == 1) {
    add_number(matlab, this_t, path);
    return EO_OK;
  }
  int base = eo_tree_add_series(matlab->columns.tree, path, (int)table.channels, table.length,
                                is_whole(this_t->class_type));
  if (base < 0) {
    matlab->left_out++;
    return EO_OK;
  }
  EO_TRY(eo_tree_columns_add(&matlab->columns, base, (int)table.channels, error));
  return copy_values(matlab, this_t, &table, base, error);
}

static enum eo_code add_variable(struct matlab *matlab, matvar_t *this_t, const char *path, int depth,
                                 struct eo_error *error);

/* Structs: "name/field", arrays of them "name(2)/field". */
static enum eo_code add_struct(struct matlab *matlab, matvar_t *this_t, const char *path, int depth,
                               struct eo_error *error)
{
  char *const *names = Mat_VarGetStructFieldnames(this_t);
  unsigned fields = Mat_VarGetNumberOfFields(this_t);
  size_t elements = 1;
  for (int i = 0; this_t->dims && i < this_t->rank; i++)
    elements = this_t->dims[i] < ELEMENTS && elements < ELEMENTS ? elements * this_t->dims[i] : ELEMENTS;
  enum eo_code code = EO_OK;
  for (size_t e = 0; !code && names && e < elements && e < ELEMENTS; e++)
    for (unsigned i = 0; !code && i < fields; i++) {
      char below[EO_TREE_PATH];
      int n = elements > 1 ? snprintf(below, sizeof below, "%s(%zu)/%s", path, e + 1, names[i])
                           : snprintf(below, sizeof below, "%s/%s", path, names[i]);
      matvar_t *field = Mat_VarGetStructFieldByName(this_t, names[i], e);
      if (field && n < (int)sizeof below)
        code = add_variable(matlab, field, below, depth + 1, error);
    }
  return code;
}

/* A cell of texts is a list; other cells are channels "name 1", "name 2". */
static enum eo_code add_cell(struct matlab *matlab, matvar_t *this_t, const char *path, int depth,
                             struct eo_error *error)
{
  size_t elements = this_t->data_size ? this_t->nbytes / (size_t)this_t->data_size : 0, used = 0;
  matvar_t **cell = this_t->data;
  char list[4096] = "", text[EO_RECORDING_NAME];
  bool texts = elements > 0 && cell;
  for (size_t i = 0; texts && i < elements; i++) {
    texts = text_of(matlab, cell[i], text, sizeof text) && used + strlen(text) + 2 < sizeof list;
    if (texts)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? "\n" : "", text);
  }
  if (texts) {
    eo_tree_add_list(matlab->columns.tree, path, list);
    return EO_OK;
  }
  enum eo_code code = EO_OK;
  for (size_t i = 0; !code && cell && i < elements && i < ELEMENTS; i++) {
    char below[EO_TREE_PATH];
    if (cell[i] && snprintf(below, sizeof below, "%s %zu", path, i + 1) < (int)sizeof below)
      code = add_variable(matlab, cell[i], below, depth + 1, error);
  }
  return code;
}

static enum eo_code add_variable(struct matlab *matlab, matvar_t *this_t, const char *path, int depth,
                                 struct eo_error *error)
{
  char text[256];
  if (this_t && depth > DEPTH)
    matlab->left_out++;
  if (!this_t || depth > DEPTH)
    return EO_OK;
  switch (this_t->class_type) {
  case MAT_C_STRUCT:
    return add_struct(matlab, this_t, path, depth, error);
  case MAT_C_CELL:
    return add_cell(matlab, this_t, path, depth, error);
  case MAT_C_CHAR:
    if (text_of(matlab, this_t, text, sizeof text))
      eo_tree_add_text(matlab->columns.tree, path, text);
    else
      add_text_rows(matlab, this_t, path);
    return EO_OK;
  case MAT_C_OBJECT:
  case MAT_C_OPAQUE:
  case MAT_C_FUNCTION:
    eo_notes_add(matlab->notes,
                 "The variable \"%.60s\" is an object (a table, timetable, timeseries or the like) whose numbers only "
                 "MATLAB reads; save s = table2struct(T, 'ToScalar', true) with the times in seconds instead.",
                 path);
    return EO_OK;
  default:
    return add_channels(matlab, this_t, path, error);
  }
}

/* All variables are found before the first is read: reading moves the place where libmatio looks for the next one. */
static enum eo_code read_variables(struct matlab *matlab, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  matvar_t **list = calloc(VARIABLES, sizeof(matvar_t *));
  int count = 0;
  if (!list)
    return eo_error_memory(error);
  while (count < VARIABLES && (list[count] = Mat_VarReadNextInfo(matlab->file)))
    count++;
  for (matvar_t *more; count == VARIABLES && (more = Mat_VarReadNextInfo(matlab->file)); matlab->left_out++)
    Mat_VarFree(more);
  for (int i = 0; !code && i < count; i++)
    if (list[i]->name)
      code = add_variable(matlab, list[i], list[i]->name, 0, error);
  for (int i = 0; i < count; i++)
    Mat_VarFree(list[i]);
  free(list);
  return code;
}

/* libmatio passes over what is missing at the end of a file. Each element of version 5 states its length: they must
   fill the file. */
static enum eo_code check_elements(const char *path, int64_t *bytes_of_file, struct eo_error *error)
{
  enum { HEADER = 128, MATRIX = 14, COMPRESSED = 15 };
  int file;
  int64_t size;
  unsigned char bytes[HEADER];
  enum eo_code code = eo_bytes_open(path, &file, &size, error);
  if (code)
    return code;
  code = eo_bytes_read(file, 0, bytes, size < HEADER ? (size_t)size : HEADER, error);
  bool version5 = !code && size >= HEADER && !memcmp(bytes, "MATLAB 5.0", 10), big = version5 && bytes[126] == 'M';
  for (int64_t at = HEADER; !code && version5 && at + 8 <= size;) {
    code = eo_bytes_read(file, at, bytes, 8, error);
    if (code)
      break;
    uint32_t type = eo_bytes_32(bytes, big), length = eo_bytes_32(bytes + 4, big);
    if (type != MATRIX && type != COMPRESSED)
      code = eo_error_set(error, EO_ERROR_INPUT, "",
                          "MATLAB: at byte %lld there is no variable but an element of type %u.", (long long)at, type);
    else if (length > size - at - 8)
      code = eo_error_set(error, EO_ERROR_INPUT, "",
                          "MATLAB: the variable at byte %lld has %u bytes, the file only %lld more: it is cut off.",
                          (long long)at, length, (long long)(size - at - 8));
    at += 8 + (int64_t)length;
  }
  close(file);
  *bytes_of_file = size;
  return code;
}

static enum eo_code read_file(struct matlab *matlab, const struct eo_reader_options *options,
                              const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  matlab->notes = notes;
  EO_TRY(eo_tree_new(&matlab->columns.tree, error));
  EO_TRY(read_variables(matlab, error));
  return eo_tree_columns_copy(&matlab->columns, matlab->left_out, matlab->bytes, options, sink, notes, error);
}

/* NOLINTNEXTLINE(readability-non-const-parameter): the type of a handler of matio */
static void ignore_message(int level, char *text)
{
  (void)level;
  (void)text;
}

enum eo_code eo_matlab_read(const char *path, const struct eo_reader_options *options,
                            const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  int64_t size;
  enum eo_code code = check_elements(path, &size, error);
  if (code)
    return code;
  struct matlab *matlab = calloc(1, sizeof *matlab);
  if (!matlab)
    return eo_error_memory(error);
  matlab->bytes = size;
  matlab->columns.spool_directory = options->spool_directory;
  Mat_LogInitFunc("easeoff", ignore_message);
  matlab->file = Mat_Open(path, MAT_ACC_RDONLY);
  code = matlab->file
             ? read_file(matlab, options, sink, notes, error)
             : eo_error_set(error, EO_ERROR_INPUT, "", "MATLAB: the file cannot be opened; its header is damaged.");
  if (matlab->file)
    Mat_Close(matlab->file);
  eo_tree_columns_done(&matlab->columns);
  free(matlab);
  return code;
}
