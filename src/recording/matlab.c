/* MATLAB files of versions 4, 5 and 7 by libmatio: numeric vectors, matrices with one channel per column, the same in
   structs. Runs in a process of its own. Version 7.3 is HDF5 and read as such. */
#include "recording/bytes.h"
#include "recording/readers.h"
#include "recording/source.h"

#include <matio.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CHANNELS EO_RECORDING_COLUMNS
#define WIDE 64                  /* a matrix with more columns is no table of channels */
#define VARIABLES 1024           /* of a file that are looked at */
#define PIECE 65536              /* values read at once from variables that are not compressed */
#define MEMORY ((size_t)1 << 19) /* bytes of a channel in memory */

struct matlab {
  mat_t *file;
  int64_t bytes;
  const char *spool_directory;
  int count, left_out;
  double interval; /* s, from a variable such as fs; 0: none */
  struct eo_series series[CHANNELS];
  struct eo_recording *column[CHANNELS]; /* owned */
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

static bool find_table(const matvar_t *v, struct table *t)
{
  if (v->rank != 2 || !v->dims || v->isComplex || !class_size(v->class_type))
    return false;
  int64_t rows = (int64_t)v->dims[0], columns = (int64_t)v->dims[1];
  if (rows < 1 || columns < 1 || rows > INT32_MAX || columns > INT32_MAX || rows * columns > INT32_MAX)
    return false;
  *t = rows >= columns ? (struct table){rows, columns, 1, rows} : (struct table){columns, rows, rows, 1};
  return t->channels <= WIDE;
}

/* The values first .. first + count - 1 of the variable as they are stored, column by column. */
static enum eo_code read_values(struct matlab *m, matvar_t *v, int64_t first, int64_t count, void *data,
                                struct eo_error *error)
{
  if (!Mat_VarReadDataLinear(m->file, v, data, (int)first, 1, (int)count))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "MATLAB: the values of \"%.60s\" cannot be read; the file is damaged or cut off.", v->name);
}

/* Gives each value of a piece to its channel. Only pieces that begin and end with whole runs of channels reach here
   when along > 1. */
static enum eo_code keep_values(struct matlab *m, const struct table *t, int64_t first, int64_t count, const void *data,
                                enum matio_classes class, double *values, struct eo_error *error)
{
  int base = m->count;
  for (int64_t c = 0; c < t->channels; c++) {
    int64_t from = t->along == 1 ? c * t->length : c, n = 0;
    if (t->along == 1)
      for (int64_t i = first > from ? first : from; i < first + count && i < from + t->length; i++)
        values[n++] = value_at(data, class, i - first);
    else
      for (int64_t i = 0; i + c < count; i += t->along)
        values[n++] = value_at(data, class, i + c);
    enum eo_code code = eo_recording_append(m->column[base + c], values, n, error);
    if (code)
      return code;
  }
  return EO_OK;
}

/* Compressed variables can only be read at once; their size is bounded by that of the file. */
static enum eo_code copy_values(struct matlab *m, matvar_t *v, const struct table *t, struct eo_error *error)
{
  int64_t total = t->length * t->channels, size = class_size(v->class_type);
  int64_t piece = v->compression == MAT_COMPRESSION_NONE ? PIECE / t->channels * t->channels : total;
  if (piece > total)
    piece = total;
  if (total * size > EO_SOURCE_FREE && total * size / EO_SOURCE_EXPANSION > m->bytes)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MATLAB: \"%.60s\" states %lld values; the file has only %lld bytes.", v->name,
                        (long long)total, (long long)m->bytes);
  void *data = calloc((size_t)piece, (size_t)size);
  double *values = malloc((size_t)piece * sizeof *values);
  enum eo_code code = data && values ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < total; first += piece) {
    int64_t n = total - first < piece ? total - first : piece;
    code = read_values(m, v, first, n, data, error);
    if (!code)
      code = keep_values(m, t, first, n, data, v->class_type, values, error);
  }
  free(values);
  free(data);
  return code;
}

/* A single number whose name says that it is the sampling rate or interval. */
static void use_scalar(struct matlab *m, matvar_t *v)
{
  char data[8] = "";
  struct eo_error error;
  if (read_values(m, v, 0, 1, data, &error))
    return;
  double interval = eo_series_stated_interval(v->name, value_at(data, v->class_type, 0));
  if (interval > 0)
    m->interval = interval;
}

static enum eo_code add_variable(struct matlab *m, matvar_t *v, struct eo_error *error)
{
  struct table t;
  if (!v || !v->name)
    return EO_OK;
  if (!find_table(v, &t) || m->count + t.channels > CHANNELS) {
    m->left_out++;
    return EO_OK;
  }
  if (t.length == 1) {
    use_scalar(m, v);
    return EO_OK;
  }
  enum eo_code code = EO_OK;
  for (int c = 0; !code && c < t.channels; c++) {
    code = eo_recording_new(&m->column[m->count + c], 1, m->spool_directory, error);
    if (!code && m->spool_directory)
      eo_recording_set_memory(m->column[m->count + c], MEMORY);
  }
  if (!code)
    code = copy_values(m, v, &t, error);
  for (int c = 0; c < t.channels; c++) {
    struct eo_series *s = &m->series[m->count++];
    s->length = t.length;
    if (t.channels > 1)
      snprintf(s->name, sizeof s->name, "%.50s %d", v->name, c + 1);
    else
      snprintf(s->name, sizeof s->name, "%s", v->name);
  }
  return code;
}

static enum eo_code add_struct(struct matlab *m, matvar_t *v, struct eo_error *error)
{
  char *const *names = Mat_VarGetStructFieldnames(v);
  unsigned fields = Mat_VarGetNumberOfFields(v);
  enum eo_code code = EO_OK;
  for (unsigned i = 0; !code && names && i < fields; i++)
    code = add_variable(m, Mat_VarGetStructFieldByName(v, names[i], 0), error);
  return code;
}

/* All variables are found before the first is read: reading moves the place where libmatio looks for the next one. */
static enum eo_code read_variables(struct matlab *m, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  matvar_t **list = calloc(VARIABLES, sizeof(matvar_t *));
  int count = 0;
  if (!list)
    return eo_error_memory(error);
  while (count < VARIABLES && (list[count] = Mat_VarReadNextInfo(m->file)))
    count++;
  for (int i = 0; !code && i < count; i++) {
    matvar_t *v = list[i];
    bool one = v->class_type == MAT_C_STRUCT && v->rank == 2 && v->dims && v->dims[0] == 1 && v->dims[1] == 1;
    code = one ? add_struct(m, v, error) : add_variable(m, v, error);
  }
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

static enum eo_code read_column(void *context, int series, int64_t first, int64_t count, double *values,
                                struct eo_error *error)
{
  const struct matlab *m = context;
  return eo_recording_read(m->column[series], first, count, values, error);
}

static enum eo_code read_file(struct matlab *m, const struct eo_reader_options *options,
                              const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  enum eo_code code = read_variables(m, error);
  if (code)
    return code;
  for (int i = 0; i < m->count; i++)
    m->series[i].interval = m->interval;
  if (m->left_out)
    eo_notes_add(notes, "%d variable%s %s no channel of real numbers and %s left out.", m->left_out,
                 m->left_out == 1 ? "" : "s", m->left_out == 1 ? "is" : "are", m->left_out == 1 ? "was" : "were");
  struct eo_series_file content = {m->series, m->count, m->bytes, options->max_bytes, read_column, m};
  return eo_series_copy(&content, sink, notes, error);
}

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
  struct matlab *m = calloc(1, sizeof *m);
  if (!m)
    return eo_error_memory(error);
  m->bytes = size;
  m->spool_directory = options->spool_directory;
  Mat_LogInitFunc("easeoff", ignore_message);
  m->file = Mat_Open(path, MAT_ACC_RDONLY);
  code = m->file ? read_file(m, options, sink, notes, error)
                 : eo_error_set(error, EO_ERROR_INPUT, "", "MATLAB: the file cannot be opened; its header is damaged.");
  if (m->file)
    Mat_Close(m->file);
  for (int i = 0; i < CHANNELS; i++)
    eo_recording_free(m->column[i]);
  free(m);
  return code;
}
