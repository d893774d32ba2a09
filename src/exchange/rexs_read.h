/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers of REXS files. What is wrong with a file as such stops them: one problem, with the place. */
#ifndef EASEOFF_EXCHANGE_REXS_READ_H
#define EASEOFF_EXCHANGE_REXS_READ_H

#include "base/error.h"
#include "exchange/rexs_model.h"

/* What stopped a reader. kind: a word of its own for each ("not_well_formed", "document_type", "too_large", ...). */
struct eo_rexs_problem {
  const char *kind;
  struct eo_error error; /* pointer: "line 4, column 2", or "" */
  int line, column;      /* 0: not known */
};

/* Fills the problem; returns false. */
bool eo_rexs_refuse(struct eo_rexs_problem *problem, const char *kind, int line, int column, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* The same of a file that holds more of something than a limit allows. limit: EO_REXS_ATTRIBUTES ..., or
   EO_REXS_REFERENCES. */
bool eo_rexs_refuse_many(struct eo_rexs_problem *problem, int line, int column, int limit);

/* All of these begin with an empty model; false: *problem says why, and the model is to be released all the same. */
bool eo_rexs_read_xml(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem);
bool eo_rexs_read_json(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem);

/* Any of the forms, told by the first bytes. Of an archive the first entry whose name ends like a REXS file is read. */
bool eo_rexs_read(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem);

/* Base64 of little-endian int32, float32 or float64: the numbers, in the model's memory; -1: it is none. */
int eo_rexs_decode_numbers(struct eo_rexs_model *model, const char *text, const char *code, double **value);

#endif
