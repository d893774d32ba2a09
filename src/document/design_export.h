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
};

/* NULL after the last; NULL: there is none of this name. */
const struct eo_export *eo_export_at(int index);
const struct eo_export *eo_export_find(const char *name);

/* A name for the file, made of the design's name: "paper-pair-flank-points.csv"; size >= 40. */
void eo_export_file_name(const struct eo_export *format, const struct eo_design *design, char *name, size_t size);

#endif
