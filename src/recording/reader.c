/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* mkostemp */
#include "recording/reader.h"
#include "recording/compound.h"
#include "recording/isolate.h"
#include "recording/reader_private.h"
#include "recording/tables.h"
#include "recording/zip_files.h"

#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define HEAD 4096 /* bytes from which a kind is told */

static bool begins(const unsigned char *head, size_t size, const char *with, size_t length)
{
  return size >= length && !memcmp(head, with, length);
}

/* Kinds that people try and that no reader reads. */
static enum eo_code refuse_others(const unsigned char *head, size_t size, struct eo_error *error)
{
  static const struct {
    const char *with;
    size_t length;
    const char *what;
  } others[] = {
      {"\xd0\xcf\x11\xe0", 4, "The file is an old Office document; save the table as text."},
      {"TDSh", 4, "The file is a TDMS index; upload the .tdms file itself."},
      {"%PDF", 4, "The file is a PDF; upload the measurement itself."},
      {"RIFF", 4,
       "The file is a sound file (WAV): its numbers have no unit; save the channels as text, TDMS, MATLAB or "
       "HDF5, with their scale."},
      {"PAR1", 4, "The file is a Parquet table; save it as text (pandas: read_parquet(...).to_csv(...))."},
      {"ARROW1", 6, "The file is an Arrow or Feather table; save it as text (pandas: read_feather(...).to_csv(...))."},
      {"FEA1", 4, "The file is a Feather table; save it as text (pandas: read_feather(...).to_csv(...))."},
      {"\x93NUMPY", 6, "The file is a NumPy array; save it as text or .mat (numpy.savetxt, scipy.io.savemat)."},
      {"|CF,", 4, "The file is an imc FAMOS file; export it from FAMOS or imc STUDIO as text, MATLAB or TDMS."},
      {"|CK,", 4, "The file is an imc FAMOS file; export it from FAMOS or imc STUDIO as text, MATLAB or TDMS."},
      {"DEWESoft", 8, "The file is a DEWESoft recording; export it from DEWESoft as text, MATLAB, UFF 58 or HDF5."},
      {"DXD", 3, "The file is a DEWESoft recording; export it from DEWESoft as text, MATLAB, UFF 58 or HDF5."},
      {"LOGG", 4, "The file is a Vector BLF log; convert it to MDF 4, or export its channels as text."},
      {"DIAEXTENDED", 11, "The file is the heading of a DIAdem file; save the channels as TDMS or text."},
      {"<?xml", 5, "The file is XML; save the channels as TDMS or text (DIAdem writes .tdm: save it as TDMS)."},
      {"{\"", 2, "The file is JSON; save the channels as text, one line for each row."},
      {"SQLite format 3", 15, "The file is a SQLite database; save the table as text."},
      {"CDF\001", 4,
       "The file is a netCDF of the classic kind; convert it to HDF5 (nccopy -k nc4) or save it as text."},
      {"CDF\002", 4,
       "The file is a netCDF of the classic kind; convert it to HDF5 (nccopy -k nc4) or save it as text."},
      {"fLaC", 4, "The file is a sound file; save the channels as text, TDMS, MATLAB or HDF5, with their scale."},
      {"RF64", 4, "The file is a sound file; save the channels as text, TDMS, MATLAB or HDF5, with their scale."},
      {"\x80\004\x95", 3, "The file is a Python pickle; save the table as text."},
      {"7z\xbc\xaf", 4, "The file is a 7z archive; unpack it, or use zip or gzip."},
      {"Rar!", 4, "The file is a RAR archive; unpack it, or use zip or gzip."},
      {"BZh", 3, "The file is compressed with bzip2; use gzip or none."},
      {"\xfd"
       "7zXZ",
       5, "The file is compressed with xz; use gzip or none."},
      {"(\xb5/\xfd", 4, "The file is compressed with zstd; use gzip or none."},
      {"\x1f\x8b", 2, "The file is a gzip file in a gzip file; compress it once."},
  };
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    if (begins(head, size, others[i].with, others[i].length))
      return eo_error_set(error, EO_ERROR_INPUT, "", "%s", others[i].what);
  return EO_OK;
}

/* Text of two bytes a character: with a byte order mark, or with every second byte 0. 1: low bytes first, 2: high
   bytes first, 0: no. */
static int wide_order(const unsigned char *head, size_t size)
{
  if (size >= 2 && head[0] == 0xff && head[1] == 0xfe)
    return 1;
  if (size >= 2 && head[0] == 0xfe && head[1] == 0xff)
    return 2;
  size_t zero[2] = {0, 0}, looked = size < 64 ? size & ~(size_t)1 : 64;
  for (size_t i = 0; i < looked; i++)
    zero[i % 2] += head[i] == 0;
  if (looked < 8 || zero[0] + zero[1] < looked * 2 / 5)
    return 0;
  return zero[0] == 0 ? 1 : zero[1] == 0 ? 2 : 0;
}

/* Text has no zero bytes. */
static enum eo_code refuse_zeros(const unsigned char *head, size_t size, struct eo_error *error)
{
  const unsigned char *zero = memchr(head, 0, size);
  if (!zero)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "The file is of no known kind: it is no text (byte %zu is 0) and not MATLAB, TDMS, UFF, HDF5 or "
                      "MDF. "
                      "Save the channels as one of these.",
                      (size_t)(zero - head));
}

static bool is_hdf5(const unsigned char *head, size_t size)
{
  for (size_t at = 0; at + 8 <= size; at = at ? 2 * at : 512)
    if (!memcmp(head + at, "\x89HDF\r\n\x1a\n", 8))
      return true;
  return false;
}

/* A .mat file of version 4 has no signature: five small numbers, the last the length of the first name, which ends with
   0. */
static bool is_matlab4(const unsigned char *head, size_t size)
{
  uint32_t word[5];
  if (size < 24)
    return false;
  memcpy(word, head, sizeof word);
  bool other_order = word[0] > 5000;
  for (int i = 0; other_order && i < 5; i++)
    word[i] = __builtin_bswap32(word[i]);
  uint32_t digits = word[0];
  return digits < 5000 && digits % 10 <= 2 && digits / 10 % 10 <= 5 && digits / 100 % 10 == 0 && word[1] > 0 &&
         word[2] > 0 && word[3] <= 1 && word[4] >= 2 && word[4] <= 64 && 20 + word[4] <= size &&
         head[20 + word[4] - 1] == 0 && head[20] > ' ' && head[20] < 127;
}

/* "# Created by Octave 8.4.0, ...", then the name of the first variable. */
static bool is_octave(const unsigned char *head, size_t size)
{
  const unsigned char *end = begins(head, size, "# Created by Octave", 19) ? memchr(head, '\n', size) : NULL;
  return end && begins(end + 1, size - (size_t)(end + 1 - head), "# name: ", 8);
}

/* The first block of a tape archive states the sum of its own bytes, in octal, with blanks in the place of the sum. */
static bool is_tar(const unsigned char *head, size_t size)
{
  enum { BLOCK = 512, FIELD = 148, FIELD_END = 156 };
  unsigned long sum = 0;
  char stated[FIELD_END - FIELD + 1] = "";
  if (size < BLOCK || !head[0])
    return false;
  for (size_t i = 0; i < BLOCK; i++)
    sum += i >= FIELD && i < FIELD_END ? ' ' : head[i];
  memcpy(stated, head + FIELD, FIELD_END - FIELD);
  return strtoul(stated, NULL, 8) == sum;
}

/* An OpenDocument spreadsheet of one file (.fods). */
static bool is_flat_document(const unsigned char *head, size_t size)
{
  static const char root[] = "<office:document ";
  return memmem(head, size, "<?xml", 5) && memmem(head, size, root, sizeof root - 1);
}

/* A universal file begins with a line that holds "-1" alone and one with the number of a data set that such files begin
 * with. */
static bool is_uff(const unsigned char *head, size_t size)
{
  size_t at = 0;
  while (at < size && (head[at] == '\r' || head[at] == '\n' || head[at] == ' '))
    at++;
  if (!begins(head + at, size - at, "-1", 2))
    return false;
  for (at += 2; at < size && head[at] != '\n'; at++)
    if (head[at] != ' ' && head[at] != '\r')
      return false;
  static const int known[] = {15, 18, 55, 58, 82, 151, 164, 757, 780, 1858, 2411, 2412, 2414, 2420};
  int number = 0;
  for (at++; at < size && head[at] == ' '; at++)
    ;
  for (; at < size && head[at] >= '0' && head[at] <= '9' && number < 100000; at++)
    number = number * 10 + (head[at] - '0');
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (number == known[i])
      return at < size && (head[at] == ' ' || head[at] == '\r' || head[at] == '\n' || (head[at] | 0x20) == 'b');
  return false;
}

static enum eo_code tell_kind(const unsigned char *head, size_t size, enum eo_reader_kind *kind, struct eo_error *error)
{
  if (!size)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The file is empty.");
  if (begins(head, size, "TDSm", 4))
    *kind = EO_READER_TDMS;
  else if (begins(head, size, "MATLAB 5.0 MAT", 14) || begins(head, size, "MATLAB 7.3 MAT", 14) ||
           is_matlab4(head, size))
    *kind = EO_READER_MATLAB;
  else if (is_hdf5(head, size))
    *kind = EO_READER_HDF5;
  else if (begins(head, size, "MDF     ", 8) || begins(head, size, "UnFinMF ", 8))
    *kind = EO_READER_MDF;
  else if (is_octave(head, size))
    *kind = EO_READER_OCTAVE;
  else if (is_uff(head, size))
    *kind = EO_READER_UFF;
  else if (begins(head, size, "PK\003\004", 4) || is_tar(head, size) || is_flat_document(head, size))
    *kind = EO_READER_ARCHIVE;
  else {
    enum eo_code code = refuse_others(head, size, error);
    if (!code && !wide_order(head, size))
      code = refuse_zeros(head, size, error);
    if (code)
      return code;
    *kind = EO_READER_TEXT;
  }
  return EO_OK;
}

/* What the first bytes say. */
struct sign {
  enum eo_reader_kind kind;
  bool gzip;
  bool hdf5; /* also of MATLAB's 7.3 */
  int wide;  /* text of two bytes a character, see wide_order() */
};

static enum eo_code read_sign(const char *path, struct sign *sign, struct eo_error *error)
{
  struct eo_source *source;
  unsigned char head[HEAD];
  size_t size;
  enum eo_code code = eo_source_open(&source, path, EO_READER_BYTES, error);
  if (code)
    return code;
  code = eo_source_read(source, head, sizeof head, &size, error);
  if (!code)
    code = tell_kind(head, size, &sign->kind, error);
  sign->gzip = eo_source_is_gzip(source);
  sign->hdf5 = !code && is_hdf5(head, size);
  sign->wide = !code && sign->kind == EO_READER_TEXT ? wide_order(head, size) : 0;
  eo_source_close(source);
  return code;
}

static enum eo_code read_text(const char *path, int wide, const struct eo_reader_options *options,
                              struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  struct eo_source *source;
  enum eo_code code = eo_source_open(&source, path, options->max_bytes, error);
  if (code)
    return code;
  if (wide)
    eo_source_decode_wide(source, wide == 2);
  code = eo_delimited_read(source, options, recording, notes, error);
  eo_source_close(source);
  return code;
}

static enum eo_code read_isolated_matlab(const char *path, const struct eo_reader_options *options,
                                         const struct eo_series_sink *sink, struct eo_notes *notes,
                                         struct eo_error *error)
{
  return eo_isolate_read(eo_matlab_read, path, options, sink, notes, error);
}

static enum eo_code read_isolated_hdf5(const char *path, const struct eo_reader_options *options,
                                       const struct eo_series_sink *sink, struct eo_notes *notes,
                                       struct eo_error *error)
{
  return eo_isolate_read(eo_hdf5_read, path, options, sink, notes, error);
}

static enum eo_code read_series(eo_series_reader *reader, const char *path, const struct eo_reader_options *options,
                                struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  struct eo_series_recorder recorder = {.spool_directory = options->spool_directory, .progress = options->progress};
  struct eo_series_sink sink = eo_series_recorder_sink(&recorder);
  enum eo_code code = reader(path, options, &sink, notes, error);
  if (code)
    eo_recording_free(recorder.recording);
  else
    *recording = recorder.recording;
  return code;
}

/* Binary kinds are read at many places: what gzip hides is put into a file first, which goes when it has been read. */
static enum eo_code read_inflated(eo_series_reader *reader, const char *path, const struct eo_reader_options *options,
                                  struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  char inflated[PATH_MAX];
  enum eo_code code = eo_source_inflate(path, options->max_bytes, options->spool_directory, inflated, sizeof inflated,
                                        error);
  if (code)
    return code;
  code = read_series(reader, inflated, options, recording, notes, error);
  unlink(inflated);
  return code;
}

static enum eo_code read_kind(const char *path, const struct sign *sign, const struct eo_reader_options *options,
                              struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  static eo_series_reader *const readers[EO_READER_KINDS] = {
      [EO_READER_TDMS] = eo_tdms_read,       [EO_READER_UFF] = eo_uff_read,
      [EO_READER_MDF] = eo_mdf_read,         [EO_READER_MATLAB] = read_isolated_matlab,
      [EO_READER_HDF5] = read_isolated_hdf5, [EO_READER_OCTAVE] = eo_octave_read,
  };
  if (sign->kind == EO_READER_TEXT)
    return read_text(path, sign->wide, options, recording, notes, error);
  eo_series_reader *reader = readers[sign->hdf5 ? EO_READER_HDF5 : sign->kind];
  return (sign->gzip ? read_inflated : read_series)(reader, path, options, recording, notes, error);
}

/* Names of the files in an archive. */
struct names {
  int count;
  char name[EO_TABLES][EO_RECORDING_NAME];
};

/* What the process that unpacks says of it. */
static enum eo_code take_names(void *context, const struct eo_series *column, int columns, struct eo_error *error)
{
  struct names *names = context;
  (void)error;
  names->count = columns < EO_TABLES ? columns : EO_TABLES;
  for (int i = 0; i < names->count; i++)
    memcpy(names->name[i], column[i].name, sizeof column[i].name);
  return EO_OK;
}

static enum eo_code take_no_rows(void *context, const double *rows, int64_t count, struct eo_error *error)
{
  (void)context;
  (void)rows;
  (void)count;
  (void)error;
  return EO_OK;
}

static enum eo_code read_archive(const char *path, const struct sign *sign, bool inner,
                                 const struct eo_reader_options *options, struct eo_recording **recording,
                                 struct eo_notes *notes, struct eo_error *error);

/* One file of an archive. What an archive in an archive holds may together be no more times as large than what any
   file of this size may grow to. */
static enum eo_code read_unpacked(const char *path, bool inner, const char *unpacked, int number, struct names *names,
                                  const struct eo_reader_options *options, struct eo_recording **recording,
                                  struct eo_notes *notes, struct eo_error *error)
{
  struct eo_reader_options own = *options;
  struct eo_series_sink sink = {take_names, take_no_rows, names};
  struct sign sign = {0};
  own.unpack_to = unpacked;
  own.unpack_number = number;
  EO_TRY(eo_isolate_read(eo_archive_unpack, path, &own, &sink, notes, error));
  EO_TRY(read_sign(unpacked, &sign, error));
  if (sign.kind == EO_READER_ARCHIVE && inner)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "\"%.60s\" is an archive in an archive in an archive; unpack the outer ones.",
                        names->name[number]);
  eo_notes_add(notes, "Read from \"%.60s\" in the archive.", names->name[number]);
  own = *options;
  own.max_bytes = eo_source_growth(path, options->max_bytes);
  return sign.kind == EO_READER_ARCHIVE ? read_archive(unpacked, &sign, true, &own, recording, notes, error)
                                        : read_kind(unpacked, &sign, &own, recording, notes, error);
}

/* The name of a file without its folders and its kind. */
static void set_label(struct eo_table *table, const char *name)
{
  const char *base = strrchr(name, '/'), *dot = strrchr(name, '.');
  base = base ? base + 1 : name;
  int length = dot > base ? (int)(dot - base) : (int)strlen(base);
  snprintf(table->label, sizeof table->label, "%.*s", length, base);
}

/* Every file of the archive that holds a recording is a table of it; others are left out with a word. Where none does,
   the first says why. */
static enum eo_code read_files(const char *path, bool inner, const char *unpacked,
                               const struct eo_reader_options *options, struct eo_tables *tables,
                               struct eo_notes *notes, struct eo_error *error)
{
  struct names names = {.count = 1};
  struct eo_error first = {0};
  for (int i = 0; i < names.count; i++) {
    struct eo_table *table = &tables->table[tables->count];
    *table = (struct eo_table){0};
    enum eo_code code = read_unpacked(path, inner, unpacked, i, &names, options, &table->recording, notes, error);
    if (code && (code != EO_ERROR_INPUT || names.count == 1))
      return code;
    if (code)
      eo_notes_add(notes, "\"%.60s\" in the archive was left out: %.160s", names.name[i], error->text);
    if (code && !first.code)
      first = *error;
    set_label(table, names.name[i]);
    tables->count += !code;
  }
  if (tables->count == 0)
    *error = first;
  else
    memset(error, 0, sizeof *error);
  return tables->count ? EO_OK : first.code;
}

/* The files of an archive, or one table out of a spreadsheet, are unpacked in a process of its own and then read like
   any other. */
static enum eo_code read_plain_archive(const char *path, bool inner, const struct eo_reader_options *options,
                                       struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  char unpacked[PATH_MAX];
  if (!options->spool_directory ||
      snprintf(unpacked, sizeof unpacked, "%s/unpacked-XXXXXX", options->spool_directory) >= (int)sizeof unpacked)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no folder to unpack the archive to.");
  int file = mkostemp(unpacked, O_CLOEXEC);
  if (file < 0)
    return eo_error_set(error, EO_ERROR_FILE, "", "No temporary file could be made in %s.", options->spool_directory);
  close(file);
  struct eo_tables *tables = calloc(1, sizeof *tables);
  enum eo_code code = tables ? read_files(path, inner, unpacked, options, tables, notes, error)
                             : eo_error_memory(error);
  unlink(unpacked);
  if (!code) {
    tables->files = true;
    code = eo_tables_join(tables, options->spool_directory, recording, notes, error);
  } else if (tables)
    eo_tables_free(tables);
  free(tables);
  return code;
}

/* inner: the archive was a file of another one. */
static enum eo_code read_archive(const char *path, const struct sign *sign, bool inner,
                                 const struct eo_reader_options *options, struct eo_recording **recording,
                                 struct eo_notes *notes, struct eo_error *error)
{
  char inflated[PATH_MAX];
  if (!sign->gzip)
    return read_plain_archive(path, inner, options, recording, notes, error);
  EO_TRY(eo_source_inflate(path, options->max_bytes, options->spool_directory, inflated, sizeof inflated, error));
  enum eo_code code = read_plain_archive(inflated, inner, options, recording, notes, error);
  unlink(inflated);
  return code;
}

enum eo_code eo_reader_read(const char *path, const struct eo_reader_options *options, struct eo_recording **recording,
                            struct eo_notes *notes, struct eo_error *error)
{
  struct eo_reader_options own = {0};
  struct sign sign;
  enum eo_code code = read_sign(path, &sign, error);
  if (code)
    return code;
  if (options)
    own = *options;
  if (!own.max_bytes)
    own.max_bytes = EO_READER_BYTES;
  struct eo_recording *read = NULL;
  code = sign.kind == EO_READER_ARCHIVE ? read_archive(path, &sign, false, &own, &read, notes, error)
                                        : read_kind(path, &sign, &own, &read, notes, error);
  if (!code)
    code = eo_compound_join(&read, own.spool_directory, notes, error);
  if (code)
    eo_recording_free(read);
  else
    *recording = read;
  return code;
}
