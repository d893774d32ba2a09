/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units as rig software writes them. */
#ifndef EASEOFF_RECORDING_RECORDED_UNIT_H
#define EASEOFF_RECORDING_RECORDED_UNIT_H
#include <stdbool.h>

enum eo_quantity {
  EO_QUANTITY_NONE,
  EO_QUANTITY_TIME,
  EO_QUANTITY_ANGLE,
  EO_QUANTITY_COUNT,
  EO_QUANTITY_VOLTAGE,
  EO_QUANTITY_CURRENT,
  EO_QUANTITY_FREQUENCY,
  EO_QUANTITY_SPEED,
  EO_QUANTITY_TORQUE,
  EO_QUANTITY_OTHER
};

/* What the text of a unit means: its quantity, EO_QUANTITY_NONE when the text is no known unit. *factor takes a value
   to s, rad, counts, V, A, Hz, rad/s or N m; 1 for other quantities. Brackets around the unit and case do not matter,
   except where case tells units apart ("S" for siemens, "nm" for lengths). Micro, degree, prime and raised signs are
   known in UTF-8 and Latin 1. */
enum eo_quantity eo_unit_find(const char *text, double *factor);

/* The same of a column's unit, which may be a multiple: "0.0001 deg", "x1000 rpm". */
enum eo_quantity eo_unit_find_multiple(const char *text, double *factor);

/* Splits "angle [deg]", "angle (deg)", "angle / deg", "angle_deg", "angle in deg" into name and unit, both cut to their
   size. unit is "" when there is none that is known or stands in brackets; round brackets around a word that is no unit
   ("(raw)", "(encoder 1)") belong to the name. */
void eo_unit_split(const char *label, char *name, int name_size, char *unit, int unit_size);

#endif
