/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a design as rows of a table: paths into the document ("gear_pair.face_width_mm",
   "load_cases.1.torque_Nm"), the member left out where a row has a column for each ("gear_pair.teeth",
   "modification.left.tip_relief_um"), and the symbols of the standards as other names ("z", "m_n", "C_a"). */
#ifndef EASEOFF_EXCHANGE_DESIGN_KEYS_H
#define EASEOFF_EXCHANGE_DESIGN_KEYS_H

#include <stdbool.h>

#include <jansson.h>

#include "base/error.h"
#include "format/table.h"

enum { EO_KEY_PATH = 200, EO_KEY_PATHS = 2 };

/* How sure a number without a unit is. */
enum eo_key_doubt {
  EO_KEY_SURE,  /* the key says the unit */
  EO_KEY_USUAL, /* a symbol that is always in this unit: assumed, and said */
  EO_KEY_DOUBT, /* a symbol that stands in mm and in um: above 1 it is um, else the unit is asked for */
};

struct eo_design_key {
  const struct eo_field *field; /* of the first path */
  int paths;                    /* a modification by its symbol: of both ends */
  char path[EO_KEY_PATHS][EO_KEY_PATH];
  bool of_member; /* the column decides whose it is; else both columns are one value */
  double factor;  /* on a value in the key's unit; 1 */
  enum eo_key_doubt doubt;
};

/* What a row's name means for a member (0, 1); false: nothing. ends: of the pair, 1 or 2. */
bool eo_design_key_find(struct eo_design_key *key, const char *name, int member, int ends);

/* True for symbols that follow from others: d, d_f, ... */
bool eo_design_key_is_derived(const char *name);

/* The name of a row for a path of the document: the member taken out where the other member has the same key; *member
   its index, -1: common. */
void eo_design_key_name(const char *path, char name[EO_KEY_PATH], int *member);

/* The unit of the field as a cell, "" for none. */
const char *eo_design_key_unit(const struct eo_field *field);

/* A number in a stated unit as the field's unit has it; false: the unit is not of its kind. */
bool eo_design_key_convert(const struct eo_field *field, const char *unit, double *value);

/* Sets the value at a path, taken over; objects and rows of lists are made. EO_ERROR_INPUT: where one of them should be
   stands something else; EO_ERROR_MEMORY. */
enum eo_code eo_design_key_set(json_t *design, const char *path, json_t *value);

#endif
