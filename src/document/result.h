/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result document: one true evaluation as JSON. The terminal, the server and the files of --csv show this and
   nothing else.

   Top level: program, design (every default resolved), design_hash (SHA-256 of the canonical design), evaluation_hash
   (the same without name, rating, pitch, objective and optimization), resolution, geometry, modification,
   unloaded_contact, load_cases, objectives, eigenfrequencies_Hz, damping_ratios, warnings, timing_ms (the only part
   that differs between two runs).

   Curves are columns over a `position` beside them (0..1 of the mesh cycle of the left end; the right end's columns are
   shifted by the stagger). Transmission error is transverse, along the line of action; stiffness, forces and pressure
   are normal to the flank. A member named left or right belongs to that end; with one end there is only left. What was
   not computed or is not finite is null. Curves have 9 significant digits, maps and histories 6, single numbers 12. */
#ifndef EASEOFF_DOCUMENT_RESULT_H
#define EASEOFF_DOCUMENT_RESULT_H

#include <jansson.h>

#include "format/file_set.h"
#include "document/design_document.h"
#include "format/outline.h"
#include "format/text.h"
#include "evaluation/analysis.h"

extern const struct eo_outline eo_result_outline;

/* New document of the analysis' last run; design is the one that was analysed. warnings (may be NULL): of reading the
   design, they come first. NULL without memory. */
json_t *eo_result_encode(const struct eo_analysis *analysis, const struct eo_design *design,
                         const struct eo_warnings *warnings);

/* The same without what is long: null stands in its place. Numbers are always there. */
enum {
  EO_RESULT_NO_MAPS = 1,      /* pressure and clearance over the flank */
  EO_RESULT_NO_HISTORIES = 2, /* of the vibration and of the root stress */
  /* The curves of a part each, in the order of EO_RESULT_PART_WORDS. */
  EO_RESULT_NO_MODIFICATION = 4,
  EO_RESULT_NO_UNLOADED = 8,
  EO_RESULT_NO_LTE = 16,
  EO_RESULT_NO_STIFFNESS = 32,
  EO_RESULT_NO_FACE_LOAD = 64,
  EO_RESULT_NO_SHARES = 128,
  EO_RESULT_NO_PATTERN = 256,
  EO_RESULT_NO_ORDERS = 512,
  EO_RESULT_NO_TRIBOLOGY = 1024,
  EO_RESULT_NO_DESIGN = 2048,      /* resolved */
  EO_RESULT_NO_PITCH = 4096,       /* curves of the hunting period */
  EO_RESULT_NO_ASSUMED = 8192,     /* what is assumed of the design; dimensions */
  EO_RESULT_NO_END_ORDERS = 16384, /* of the vibration, all channels of each end */
  EO_RESULT_FIRST_PART = EO_RESULT_NO_MODIFICATION,
  EO_RESULT_PARTS = 13,
};
#define EO_RESULT_PART_WORDS                                                                                     \
  "modification|unloaded_contact|lte|mesh_stiffness|face_load|load_share|pattern|orders|tribology|design|pitch|" \
  "assumed|end_orders"

/* Added to what is left out. Of all load cases only number k (from 0) has curves, maps and histories. Whatever is left
   out, every load case has the curves that load cases are compared by: the transmission error over the mesh cycle, its
   orders and those of the pair's vibration. Curves have at most n significant digits, LEAST or more; maps and histories
   two fewer. */
#define EO_RESULT_CURVES_OF(k) ((unsigned)((k) + 1) << 16)
enum { EO_RESULT_OVERVIEW = 1 << 15, EO_RESULT_LEAST_DIGITS = 5 };
#define EO_RESULT_DIGITS(n) ((unsigned)(n) << 24)
json_t *eo_result_encode_part(const struct eo_analysis *analysis, const struct eo_design *design,
                              const struct eo_warnings *warnings, unsigned left_out);

/* The same as compact JSON, appended to the text, on as many threads as the analysis may use. The same bytes as
   eo_json_write() gives. */
enum eo_code eo_result_write(const struct eo_analysis *analysis, const struct eo_design *design,
                             const struct eo_warnings *warnings, unsigned left_out, struct eo_text *text,
                             struct eo_error *error);

/* For people: each load case unmodified and as designed, the objectives, warnings, where the time went. */
void eo_result_summary(const json_t *result, bool inches, struct eo_text *text);

/* One line per load case, CSV: what stands in "objectives", as designed and unmodified. */
void eo_result_summary_csv(const json_t *result, struct eo_text *text);

/* The same right from an analysis. Errors: memory. */
enum eo_code eo_result_write_csv(const struct eo_analysis *analysis, const struct eo_design *design,
                                 struct eo_text *text, struct eo_error *error);

/* The curves as files of comma-separated values with the same names and units: summary, modification, unloaded contact,
   and for every load case curves, root stress, vibration, orders and one contact pattern per end. */
void eo_result_files(const json_t *result, struct eo_file_set *bundle);

#endif
