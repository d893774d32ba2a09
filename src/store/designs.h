/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored designs: a name and a document (JSON is text to this floor), each with a revision that every change raises.
   Functions that write open their own transaction. Texts that a visit gets are borrowed until it returns. */
#ifndef EASEOFF_STORE_DESIGNS_H
#define EASEOFF_STORE_DESIGNS_H

#include "store/store.h"

struct eo_stored_design {
  int64_t id;                    /* never used again after a deletion */
  int64_t revision;              /* 1, 2, ...: the entity tag */
  const char *name;              /* for people; not unique */
  const char *document;          /* JSON */
  const char *created, *updated; /* UTC, 2026-01-31T12:34:56.789Z */
};

enum eo_design_outcome {
  EO_DESIGN_DONE,
  EO_DESIGN_MISSING, /* there is none with this number */
  EO_DESIGN_STALE,   /* it has another revision than expected */
  EO_DESIGN_FULL,    /* as many designs as may be are there already */
  EO_DESIGN_USED,    /* measurements belong to it */
};

typedef enum eo_code eo_store_visit_design(void *context, const struct eo_stored_design *design,
                                           struct eo_error *error);

/* Adds name and document unless most designs are there; visit (may be NULL) gets the whole row. Outcomes: DONE, FULL.
 */
enum eo_code eo_store_add_design(struct eo_store *store, const char *name, const char *document, int64_t most,
                                 eo_store_visit_design *visit, void *context, enum eo_design_outcome *outcome,
                                 struct eo_error *error);

/* Replaces name and document where the revision is the one expected (0: any); visit (may be NULL) gets the row as it is
   then, or as it stands when the outcome is STALE. Outcomes: DONE, MISSING, STALE. */
enum eo_code eo_store_change_design(struct eo_store *store, int64_t id, int64_t expected, const char *name,
                                    const char *document, eo_store_visit_design *visit, void *context,
                                    enum eo_design_outcome *outcome, struct eo_error *error);

/* Outcomes: DONE, MISSING, STALE, USED. expected: as above. */
enum eo_code eo_store_remove_design(struct eo_store *store, int64_t id, int64_t expected,
                                    enum eo_design_outcome *outcome, struct eo_error *error);

/* One row; *outcome is DONE (visit was called) or MISSING. */
enum eo_code eo_store_find_design(struct eo_store *store, int64_t id, eo_store_visit_design *visit, void *context,
                                  enum eo_design_outcome *outcome, struct eo_error *error);

/* At most limit rows with a number below before (0: from the newest), newest first. Page on with the number of the last
   one seen. */
enum eo_code eo_store_list_designs(struct eo_store *store, int64_t before, int limit, eo_store_visit_design *visit,
                                   void *context, struct eo_error *error);

#endif
