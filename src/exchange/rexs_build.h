/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Building a REXS model in the words of a version: today's names and units go in, the version's come out; what the
   version does not have yet is left out. */
#ifndef EASEOFF_EXCHANGE_REXS_BUILD_H
#define EASEOFF_EXCHANGE_REXS_BUILD_H

#include "exchange/rexs_model.h"
#include "format/text.h"

struct eo_rexs_builder {
  struct eo_rexs_model *model;
  int version; /* as eo_rexs_version() gives it */
};

/* A new component; its id. name may be "". */
int eo_rexs_build(struct eo_rexs_builder *builder, int id, const char *type, const char *name);

/* Attributes of the component built last, or of what a load case varies. A number that is NaN is left out. */
void eo_rexs_build_number(struct eo_rexs_builder *builder, const char *attribute, double value);
void eo_rexs_build_whole(struct eo_rexs_builder *builder, const char *attribute, int value);
void eo_rexs_build_flag(struct eo_rexs_builder *builder, const char *attribute, bool value);
void eo_rexs_build_word(struct eo_rexs_builder *builder, const char *attribute, const char *value);
void eo_rexs_build_numbers(struct eo_rexs_builder *builder, const char *attribute, int count, const double *value);

/* A relation: pairs of role and id, ended by NULL. order 0: none. */
void eo_rexs_relate(struct eo_rexs_builder *builder, const char *type, int order, ...) __attribute__((sentinel));

/* A load case; what follows of eo_rexs_vary_one() is of it. */
void eo_rexs_build_load_case(struct eo_rexs_builder *builder, int id);
void eo_rexs_vary_one(struct eo_rexs_builder *builder, int id, const char *type);

enum eo_rexs_form { EO_REXS_XML, EO_REXS_JSON, EO_REXS_ZIP };

/* The model as a file. Without memory the text has failed. */
void eo_rexs_write(const struct eo_rexs_model *model, enum eo_rexs_form form, struct eo_text *text);

#endif
