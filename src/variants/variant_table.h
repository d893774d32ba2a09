/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of a study out of the data folder: sorted, filtered, in pages, as JSON, comma-separated values or text. The
   same table for whoever asks, whatever computed it. */
#ifndef EASEOFF_VARIANTS_VARIANT_TABLE_H
#define EASEOFF_VARIANTS_VARIANT_TABLE_H

#include "document/result_scalars.h"
#include "format/outline.h"
#include "store/store.h"
#include "variants/variant_plan.h"

/* Which rows, in which order. */
struct eo_variant_query {
  const char *filter; /* "objectives.J<0.4, outcome=converged": NAME and one of < <= > >= = !=, a number or an outcome;
                         all of them hold. NULL or "": every row */
  const char *sort;   /* name of what varies, of a column, "variant" or "outcome"; NULL or "": variant */
  bool descending;
  int first, most; /* of the rows that fit; most -1: all */
};

enum { EO_VARIANT_FILTERS = 32 };

struct eo_variant_table {
  int64_t job;
  struct eo_variant_plan plan;
  struct eo_scalars scalars;
  int done, fits; /* rows that have a result; of them those that the filter lets pass */
  int count;      /* rows below */
  int *variant;   /* [count], in order; owned */
};

/* Reads the study of a job and finds the rows. Errors: EO_ERROR_INPUT (no such job or no study, a filter or sort that
   is wrong), memory, the store's. done() in any case. */
enum eo_code eo_variant_table_init(struct eo_variant_table *table, struct eo_store *store, int64_t job,
                                   const struct eo_variant_query *query, struct eo_error *error);
void eo_variant_table_done(struct eo_variant_table *table);

extern const struct eo_outline eo_variant_table_outline, eo_variant_columns_outline;

/* { "items" [ { name, unit, help } ] }: what a study can keep. NULL without memory. */
json_t *eo_variant_columns_encode(const struct eo_scalars *scalars);

/* { "job", "name", "keys" [ { name, unit, paths } ], "columns" [ { name, unit, help } ], "variants", "done", "fits",
   "first", "items" [ { "variant", "outcome", "reason", "values" (of the keys), "numbers" (of the columns) } ] }.
   Errors: memory, the store's. */
enum eo_code eo_variant_table_encode(const struct eo_variant_table *table, struct eo_store *store,
                                     const struct eo_variant_query *query, json_t **document, struct eo_error *error);

/* A heading and a line for each row; empty where there is no number. The heading of what varies can be read again as
   the table of a study. Appends. */
enum eo_code eo_variant_table_csv(const struct eo_variant_table *table, struct eo_store *store, struct eo_text *text,
                                  struct eo_error *error);

/* For people: as many columns as they have room for, the short ends of their names. */
enum eo_code eo_variant_table_print(const struct eo_variant_table *table, struct eo_store *store, struct eo_text *text,
                                    struct eo_error *error);

/* The design of one variant, complete: what a click on a row opens. Errors: EO_ERROR_INPUT (no such job, no such
   variant, a design that cannot be). */
enum eo_code eo_variant_table_design(struct eo_store *store, int64_t job, int variant, struct eo_design *design,
                                     struct eo_error *error);

#endif
