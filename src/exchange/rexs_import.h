/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a pair of a REXS model to a design: the parts of the import and what they share. */
#ifndef EASEOFF_EXCHANGE_REXS_IMPORT_H
#define EASEOFF_EXCHANGE_REXS_IMPORT_H

#include "exchange/import.h"
#include "exchange/rexs_train.h"
#include "gear/geometry.h"

struct eo_rexs_import {
  struct eo_import *out;
  const struct eo_import_options *options;
  const struct eo_rexs_model *model;
  const struct eo_rexs_train *train;
  const struct eo_rexs_pair *pair;
  struct eo_rexs_wheel wheel[2][2]; /* [member][end] */
  double rotation;                  /* of the driver about x: +1, -1 */
  double left[2], right[2];         /* the common face of each end, along x, mm */
  double middle;                    /* of the groove, or of the face of one end, along x, mm */
  double width[2];                  /* common face width of each end, mm */
  struct eo_gear_pair gear_pair;    /* as the design will have it */
  struct eo_geometry geometry;      /* of it */
};

/* Sets a number of the design at object/key (object made when it is not there), where the table has the key; false: it
   has not, or the value is NaN. */
bool eo_rexs_put(struct eo_rexs_import *import, const struct eo_table *table, json_t *object, const char *key,
                 double value);
bool eo_rexs_put_word(struct eo_rexs_import *import, const struct eo_table *table, json_t *object, const char *key,
                      const char *word);
/* The object of that name in a document, made when it is not there; borrowed. */
json_t *eo_rexs_part(struct eo_rexs_import *import, json_t *document, const char *key);

/* "cylindrical_gear 11". */
const char *eo_rexs_name(const struct eo_rexs_component *component, char name[80]);

/* Which way the driver turns, and which flank of it is loaded; false: the file leaves it open, a fault says so. */
bool eo_rexs_find_rotation(struct eo_rexs_import *import);
/* 0 left, 1 right: the flank of a wheel that carries load, seen along its own u axis. */
int eo_rexs_loaded_side(const struct eo_rexs_import *import, int member, int end);

/* A member's tool ("tool") or settings ("manufacturing_settings") of the step of highest order, which finishes the
   flank; lowest: of the lowest, which makes the root. NULL: none. */
const struct eo_rexs_component *eo_rexs_step(const struct eo_rexs_import *import, int member, const char *role,
                                             bool lowest);
/* The shift x_E with which a step cuts; NaN: not stated. */
double eo_rexs_generated(const struct eo_rexs_import *import, int member, bool lowest);
/* The rack or racks, x_E of the root, and what a stated root circle contradicts. */
void eo_rexs_put_rack(struct eo_rexs_import *import, json_t *gear_pair);
void eo_rexs_put_generated(struct eo_rexs_import *import, json_t *gear_pair);
void eo_rexs_name_root(struct eo_rexs_import *import);
/* Fills import->geometry from gear_pair; false: it is no pair, and error says why. */
bool eo_rexs_make_geometry(struct eo_rexs_import *import, const json_t *gear_pair, struct eo_error *error);

/* gear_pair and the common face; false: a fault is told. */
bool eo_rexs_read_gear_pair(struct eo_rexs_import *import, json_t *design);
/* gear_pair.hand and alignment.apex, when the rotation is found. */
void eo_rexs_read_hand(struct eo_rexs_import *import, json_t *design);
/* material, shafts, alignment: bodies and bearings beside the teeth. */
void eo_rexs_read_bodies(struct eo_rexs_import *import, json_t *design);
void eo_rexs_read_modification(struct eo_rexs_import *import, json_t *design);
void eo_rexs_read_loads(struct eo_rexs_import *import, json_t *design);
/* Names everything that the parts before did not read. */
void eo_rexs_name_unused(struct eo_rexs_import *import);

#endif
