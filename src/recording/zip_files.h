/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Zip and tar files by libarchive, among them the workbooks of spreadsheets: one rig file inside is unpacked, one table
   of numbers is written as text; what comes out is read like any other file. Internal to the readers. */
#ifndef EASEOFF_RECORDING_ZIP_FILES_H
#define EASEOFF_RECORDING_ZIP_FILES_H

#include "recording/series.h"

#include <stdio.h>

struct archive;

#define EO_ARCHIVE_PIECE ((size_t)64 << 10)

/* The archive that is being read, with the limits that keep hostile ones small. */
struct eo_archive {
  const char *path;
  int64_t bytes, taken, limit; /* size of the file; bytes that came out of it so far and may come out */
  struct archive *handle;
  struct eo_error *error;
  struct eo_notes *notes; /* NULL: none are taken */
  bool flat;              /* one file of XML in the place of an archive */
  bool
      tables; /* of a spreadsheet all that are nearly as large as the largest are written, below a line with the name */
};

/* Calls visit for each file in the archive, in order; visit returns false to stop. Errors: EO_ERROR_INPUT. */
enum eo_code eo_archive_visit(struct eo_archive *archive,
                              bool (*visit)(void *context, struct eo_archive *archive, const char *name),
                              void *context);

/* Bytes of the file that is visited, 0 at its end, -1 with an error. */
int64_t eo_archive_read(struct eo_archive *archive, void *bytes, size_t size);

/* Writes the largest table of a workbook (.xlsx) or of an OpenDocument spreadsheet (.ods) as text with tabs, or several
   (archive->tables), each below "Sheet: NAME" where there are more than one; name: of the largest. Errors:
   EO_ERROR_INPUT, EO_ERROR_MEMORY, EO_ERROR_FILE. */
enum eo_code eo_workbook_write(struct eo_archive *archive, FILE *file, char *name, size_t size);
enum eo_code eo_opendocument_write(struct eo_archive *archive, FILE *file, char *name, size_t size);

/* Unpacks the file options->unpack_number, or the table of a spreadsheet, to options->unpack_to; the sink gets a column
   without rows for each file of the archive, with its name. Only by eo_isolate_read. */
eo_series_reader eo_archive_unpack;

#endif
