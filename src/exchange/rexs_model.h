/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A REXS model as it stands in a file: relations, components with attributes, load cases. Nothing is interpreted here.
   Read from XML, JSON and zip archives of either; written as XML, JSON and zip. */
#ifndef EASEOFF_EXCHANGE_REXS_MODEL_H
#define EASEOFF_EXCHANGE_REXS_MODEL_H

#include <stdbool.h>
#include <stddef.h>

/* Limits of a file that is read; what is beyond them is refused with a sentence. */
#define EO_REXS_BYTES ((size_t)64 << 20) /* unpacked */
enum {
  EO_REXS_ATTRIBUTES = 200000,
  EO_REXS_COMPONENTS = 20000, /* those that load cases vary counted each time */
  EO_REXS_RELATIONS = 40000,
  EO_REXS_LOAD_CASES = 2000,
  EO_REXS_CELLS = 4000000, /* numbers in arrays */
  EO_REXS_DEPTH = 16,      /* elements within elements; the deepest of the schema is 9 */
};

/* Where something stands: a line and a column of XML from 1; of JSON 0, 0 and the index in its list. */
struct eo_rexs_place {
  int line, column, index;
};

enum eo_rexs_shape { EO_REXS_SCALAR, EO_REXS_ARRAY, EO_REXS_NESTED };

struct eo_rexs_attribute {
  const char *id, *unit; /* unit "": absent */
  const char *text;      /* a scalar as it is written, without blanks around it */
  enum eo_rexs_shape shape;
  int count;           /* cells of an array; of a matrix row by row */
  const double *value; /* NaN: a cell that is no number */
  struct eo_rexs_place place;
};

struct eo_rexs_component {
  int id;
  const char *type, *name; /* name "": absent */
  int count;
  struct eo_rexs_attribute *attribute; /* [count] */
  struct eo_rexs_place place;
};

enum { EO_REXS_REFERENCES = 12 };
struct eo_rexs_relation {
  int id, order; /* order 0: absent */
  const char *type;
  int count;
  struct eo_rexs_reference {
    int id;
    const char *role, *hint;
  } reference[EO_REXS_REFERENCES];
  struct eo_rexs_place place;
};

struct eo_rexs_load_case {
  int id, count;
  struct eo_rexs_component *component; /* [count]: what varies, by the ids of the model's components */
};

struct eo_rexs_block;

struct eo_rexs_model {
  const char *version, *application, *application_version, *date; /* "": absent */
  bool json;
  int relations, components, load_cases;
  struct eo_rexs_relation *relation; /* owned, as are the next two */
  struct eo_rexs_component *component;
  struct eo_rexs_load_case *load_case;
  int relations_room, components_room, load_cases_room, varying, attributes, cells;
  int *by_id;                  /* indices of the components in the order of their ids; owned, NULL: not made yet */
  struct eo_rexs_block *block; /* texts and numbers; owned */
  bool failed;                 /* an allocation failed */
};

void eo_rexs_done(struct eo_rexs_model *model);

/* Memory that lasts as long as the model; NULL: failed is set. */
void *eo_rexs_memory(struct eo_rexs_model *model, size_t size);
/* A copy of a text; "" without memory. */
const char *eo_rexs_text(struct eo_rexs_model *model, const char *text, size_t length);
const char *eo_rexs_print(struct eo_rexs_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* New at the end of its list; NULL: no memory. Pointers of the same list move. */
struct eo_rexs_relation *eo_rexs_add_relation(struct eo_rexs_model *model);
struct eo_rexs_component *eo_rexs_add_component(struct eo_rexs_model *model);
struct eo_rexs_load_case *eo_rexs_add_load_case(struct eo_rexs_model *model);
struct eo_rexs_component *eo_rexs_add_varying(struct eo_rexs_model *model, struct eo_rexs_load_case *load_case);
struct eo_rexs_attribute *eo_rexs_add_attribute(struct eo_rexs_model *model, struct eo_rexs_component *component);

/* Once all components are there: finding one by its id is quick. */
void eo_rexs_index(struct eo_rexs_model *model);

/* By id; NULL: there is none. Any one of duplicates. */
struct eo_rexs_component *eo_rexs_find(const struct eo_rexs_model *model, int id);
/* The attribute of that name, the last where it stands twice; an older name counts as today's. component may be NULL.
 */
const struct eo_rexs_attribute *eo_rexs_attribute(const struct eo_rexs_component *component, const char *id);
/* What a relation says of a role; 0: nothing. */
int eo_rexs_role(const struct eo_rexs_relation *relation, const char *role);
bool eo_rexs_is(const struct eo_rexs_component *component, const char *type);

/* A number as REXS writes it, all of the text; NaN: it is none. */
double eo_rexs_number(const char *text);

#endif
