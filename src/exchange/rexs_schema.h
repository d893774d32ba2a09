/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of the REXS schema that Easeoff uses: for each attribute its type, unit, range, words and the components it
   stands on; the relations with their roles. Every export is checked by it, every import too. Source: the public schema
   tables of REXS 1.0 to 2.0.0. */
#ifndef EASEOFF_EXCHANGE_REXS_SCHEMA_H
#define EASEOFF_EXCHANGE_REXS_SCHEMA_H

#include <stdbool.h>

#include "exchange/rexs_model.h"

enum eo_rexs_type {
  EO_REXS_NUMBER,
  EO_REXS_WHOLE,
  EO_REXS_FLAG,
  EO_REXS_WORD,
  EO_REXS_STRING,
  EO_REXS_COMPONENT,
  EO_REXS_NUMBERS,
};

struct eo_rexs_rule {
  const char *id;
  const char *on; /* component types, by one blank each, as of 1.3 */
  enum eo_rexs_type type;
  const char *unit; /* as 1.7 spells it */
  double low, high; /* inclusive; `above`: low is not in the range */
  bool above;
  const char *words; /* of a word, by one blank each; NULL */
  int since;         /* first version, as eo_rexs_version() gives it */
  bool beside;       /* says how the file is made or names a thing, so an import may leave it without a word */
};

/* True when the word is one of a list with one blank between them. */
bool eo_rexs_is_in(const char *list, const char *word);

/* 107 of "1.7", 200 of "2.0.0" and "2.0"; 0: not a version that is known. */
int eo_rexs_version(const char *version);

/* The rule of an attribute; NULL: Easeoff does not know it. Names of old and new versions are both taken. */
const struct eo_rexs_rule *eo_rexs_rule_of(const char *attribute);
bool eo_rexs_rule_on(const struct eo_rexs_rule *rule, const char *type);

/* Today's name of a component type or attribute of an older version, or the name itself. */
const char *eo_rexs_type_today(const char *type);
const char *eo_rexs_attribute_today(const char *attribute);
/* ... and what the version calls it. */
const char *eo_rexs_type_in(const char *type, int version);
const char *eo_rexs_attribute_in(const char *attribute, int version);

/* True for every type of component that any version has. */
bool eo_rexs_type_known(const char *type);

enum eo_rexs_unit_verdict { EO_REXS_UNIT_RIGHT, EO_REXS_UNIT_SPELT, EO_REXS_UNIT_WRONG, EO_REXS_UNIT_UNKNOWN };
/* What a file gives as the unit of a rule, against it: right as the version spells it, spelt otherwise, of another
   size, or no unit that is known. */
enum eo_rexs_unit_verdict eo_rexs_unit_judge(const char *unit, const char *given, int version);
/* How the version spells a unit of a rule. */
const char *eo_rexs_unit_in(const char *unit, int version);

/* What the tables say of a component of this type in this role of a relation. OPEN: a relation that Easeoff does not
   read, or a type that may stand there and that it does not write; UNKNOWN: none of the relation's roles; WRONG:
   another type of component is needed, `types` by one blank each. */
enum eo_rexs_role_verdict { EO_REXS_ROLE_RIGHT, EO_REXS_ROLE_OPEN, EO_REXS_ROLE_UNKNOWN, EO_REXS_ROLE_WRONG };
enum eo_rexs_role_verdict eo_rexs_role_judge(const char *relation, const char *role, const char *type,
                                             const char **types);
/* The roles of a relation, in the order of the tables: the one after `role`, NULL: the first. NULL behind the last. */
const char *eo_rexs_role_after(const char *relation, const char *role);

/* Something that a model has and must not have. */
struct eo_rexs_fault {
  const char
      *kind; /* "wrong_unit", "unknown_unit", "not_a_number", "not_a_boolean", "unknown_value", "out_of_range", .. */
  const struct eo_rexs_component *component; /* NULL: of a relation */
  const struct eo_rexs_attribute *attribute; /* NULL: of the component itself */
  const struct eo_rexs_relation *relation;
  char text[300];
  bool severe; /* false: an import goes on */
};

/* Every fault of the model, in its order; false: no memory. */
bool eo_rexs_check(const struct eo_rexs_model *model, void (*tell)(void *context, const struct eo_rexs_fault *fault),
                   void *context);

#endif
