/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files for other programs: points of the flanks for grinding and measuring machines, charts of the modification. One
   function for the terminal and the server. */
#ifndef EASEOFF_DOCUMENT_DESIGN_EXPORT_H
#define EASEOFF_DOCUMENT_DESIGN_EXPORT_H

#include "format/text.h"
#include "design/design.h"
#include "gear/geometry.h"

struct eo_export {
  const char *name;    /* "flank-points" */
  const char *summary; /* one line */
  const char *type;    /* media type */
  const char *ending;  /* "csv" */
  void (*write)(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text);
  /* the same with a grid of its own: rows from root to tip, columns over the face; NULL: it has no grid */
  void (*write_grid)(const struct eo_design *design, const struct eo_geometry *geometry, const int grid[2],
                     struct eo_text *text);
};

/* The usual grid; as text in a help too. */
#define EO_EXPORT_ROWS 21
#define EO_EXPORT_COLUMNS 31
enum { EO_EXPORT_GRID_LEAST = 2, EO_EXPORT_GRID_MOST = 401 };

/* NULL after the last; NULL: there is none of this name. */
const struct eo_export *eo_export_at(int index);
const struct eo_export *eo_export_find(const char *name);

/* rows, columns: EO_EXPORT_GRID_LEAST .. EO_EXPORT_GRID_MOST, or 0 for the usual ones. EO_ERROR_INPUT where a format
   has no grid to choose. */
enum eo_code eo_export_write(const struct eo_export *format, const struct eo_design *design,
                             const struct eo_geometry *geometry, int rows, int columns, struct eo_text *text,
                             struct eo_error *error);

/* Whether every column of a format names its unit, so that it can be given in inches (format/inch.h). */
bool eo_export_has_columns(const struct eo_export *format);

/* A name for the file, made of the design's name: "paper-pair-flank-points.csv"; size >= 40. */
void eo_export_file_name(const struct eo_export *format, const struct eo_design *design, char *name, size_t size);

#endif
