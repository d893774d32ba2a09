/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh law as stages take it: columns of numbers in the document's units. */
#ifndef EASEOFF_REFERENCE_STAGE_LAW_H
#define EASEOFF_REFERENCE_STAGE_LAW_H

#include "format/table.h"
#include "dynamics/law.h"

enum { EO_STAGE_LAW_ROWS = 64 };
enum eo_stage_law_kind { EO_STAGE_LAW_TANGENT, EO_STAGE_LAW_SECANT, EO_STAGE_LAW_TABLE, EO_STAGE_LAW_FOURIER };

struct eo_stage_law {
  enum eo_stage_law_kind kind;
  struct eo_numbers approach, tangent; /* [positions] */
  double load;                         /* N; NaN: of the torque */
  double datum;                        /* m */
  int order;
  int rows;
  struct eo_stage_law_row {
    double load;
    struct eo_numbers approach;
  } row[EO_STAGE_LAW_ROWS];
  double mean;                    /* N/m */
  struct eo_numbers cosine, sine; /* [order] */
};

extern const struct eo_table eo_stage_law_table;

/* load: of one end under the torque, N. backlash: 2 tau, m. pointer: of the law in the document. */
enum eo_code eo_stage_law_make(struct eo_law *law, const struct eo_stage_law *given, double load, double backlash,
                               const char *pointer, struct eo_error *error);

/* Mean over the mesh cycle of dF/dX under the static load, N/m. */
double eo_stage_law_stiffness(const struct eo_law *law, double load);

#endif
