/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The design document: JSON <-> struct eo_design. */
#ifndef EASEOFF_DOCUMENT_DESIGN_DOCUMENT_H
#define EASEOFF_DOCUMENT_DESIGN_DOCUMENT_H

#include <jansson.h>

#include "base/hash.h"
#include "format/faults.h"
#include "format/outline.h"
#include "format/table.h"
#include "design/design.h"
#include "gear/geometry.h"

extern const struct eo_table eo_design_table, eo_gear_pair_table, eo_material_table, eo_alignment_table,
    eo_supports_table, eo_shafts_table, eo_load_case_table, eo_flank_modification_table, eo_member_modification_table,
    eo_modification_table, eo_modification_terms_table, eo_tolerance_table, eo_rating_table, eo_rating_member_table,
    eo_lubricant_table, eo_objective_table, eo_scenario_table, eo_resolution_table;

/* Keys of a flank's modification that may be optimized, and numbers of its grid; ends with NULL. */
extern const char *const eo_variable_parameters[];
#define EO_GRID_PARAMETER "grid_um"
extern const struct eo_field eo_grid_number_field; /* of struct eo_grid_node */

/* What a designer should know of a design that is otherwise right: what was changed or left out in reading it, what is
   unusual, what a search would refuse. */
struct eo_warnings {
  int count;
  char text[16][640];
  char key[16][96]; /* JSON pointer of the field it belongs to, "" for none */
};
void eo_warnings_add(struct eo_warnings *warnings, const char *format, ...) __attribute__((format(printf, 2, 3)));
void eo_warnings_at(struct eo_warnings *warnings, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Reads a design: an older document is migrated, every key checked, defaults for what is absent, a torque from its
   power; shares are scaled to the sum 1 and the modification
   of an end that does not exist is dropped, each with a warning. False when there is a fault; *design is then
   untouched. warnings may be NULL. */
bool eo_design_decode(const json_t *document, struct eo_design *design, struct eo_warnings *warnings,
                      struct eo_faults *faults);

/* The load cases as part of another document than a design: the torque follows from a power; signs of torque and speed
   become direction and driver, with a warning that says so; all state their share or none does; scaled to the sum 1.
   rows: the array as the document has it, for the words beside the signs; NULL: none are checked. */
void eo_load_cases_settle(const json_t *rows, struct eo_load_case *load_case, int count, struct eo_warnings *warnings,
                          struct eo_faults *faults);

/* Adds what can work but is unusual in a complete design, each with number, limit and remedy, at its field; and what a
   search would be refused for. */
void eo_design_note_findings(const struct eo_design *design, const struct eo_geometry *geometry,
                             struct eo_warnings *warnings);

/* The warnings that belong to a field. New array; NULL without memory. */
extern const struct eo_outline eo_outline_finding;
json_t *eo_design_findings(const struct eo_warnings *warnings);

/* All of them as texts; NULL: none. New; NULL without memory. */
json_t *eo_warnings_encode(const struct eo_warnings *warnings);

/* New document with every key; derived values that are not resolved are null. NULL without memory. */
json_t *eo_design_encode(const struct eo_design *design);

/* The same as compact text; without memory the text has failed. */
void eo_design_write(const struct eo_design *design, struct eo_text *text);

/* Out of a document as text, read and completed. Errors: EO_ERROR_INPUT (the first fault), memory. */
enum eo_code eo_design_read(const char *text, size_t size, struct eo_design *design, struct eo_geometry *geometry,
                            struct eo_warnings *warnings, struct eo_error *error);

/* Settles what was entered in another way (gear/entry.h), resolves every derived default, moves each number to the
   nearest one that the document can express and checks what needs more than one key. Settings of a search are not
   looked at: eo_design_check_search() and eo_study_space_init() do. Afterwards analysing *design and analysing its
   document are the same thing, bit for bit. Outputs untouched on failure. */
enum eo_code eo_design_complete(struct eo_design *design, struct eo_geometry *geometry, struct eo_error *error);

/* SHA-256 of the canonical document (keys sorted, shortest decimals, no spaces). */
enum eo_code eo_design_hash(const struct eo_design *design, char hex[EO_HASH_LENGTH + 1], struct eo_error *error);

/* Both of a design that is encoded already; NULL: that had no memory. */
enum eo_code eo_design_hash_document(const json_t *document, char hex[EO_HASH_LENGTH + 1], struct eo_error *error);
enum eo_code eo_design_evaluation_hash_document(const json_t *document, char hex[EO_HASH_LENGTH + 1],
                                                struct eo_error *error);

/* Everything the raw values of one evaluation depend on but the modification, as canonical JSON, and its hash: the
   design without name, modification, objective, optimization, shares of the load cases and what only shows; the
   scenarios of a robust objective, whether root stress is wanted, and the evaluator's version. Appends to spec. */
enum eo_code eo_design_problem(const struct eo_design *design, struct eo_text *spec, char hex[EO_HASH_LENGTH + 1],
                               struct eo_error *error);

#endif
