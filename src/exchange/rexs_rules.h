/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables behind rexs_schema.h. */
#ifndef EASEOFF_EXCHANGE_REXS_RULES_H
#define EASEOFF_EXCHANGE_REXS_RULES_H

#include "exchange/rexs_schema.h"

extern const struct eo_rexs_rule eo_rexs_rules[];
extern const int eo_rexs_rule_count;
extern const char *const eo_rexs_types[], *const eo_rexs_units[]; /* each ends with NULL */

struct eo_rexs_renamed {
  const char *today, *before; /* NULL ends the list */
  int until;                  /* the last version with the older name */
};
extern const struct eo_rexs_renamed eo_rexs_renamed_types[], eo_rexs_renamed_attributes[];

/* Roles by relation, each relation with all of its roles. */
struct eo_rexs_relation_role {
  const char *relation, *role, *types; /* NULL ends the list; types by one blank each */
  bool others;                         /* types of components that Easeoff does not write stand in this role as well */
};
extern const struct eo_rexs_relation_role eo_rexs_roles[];

#endif
