/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a model of the whole cube says that it is worth looking: its minima far and near, then what nobody knows. Costs
   no true evaluation. */
#ifndef EASEOFF_OPTIMIZER_GLOBAL_MINIMA_H
#define EASEOFF_OPTIMIZER_GLOBAL_MINIMA_H

#include "optimizer/credibility_model.h"
#include "optimizer/view_distance.h"

enum { EO_GLOBAL_STARTS = 48 };

struct eo_global_minima {
  int variables;
  double *sample;  /* [samples][variables]; owned, as all below */
  double *score;   /* [samples] */
  double *minimum; /* [EO_GLOBAL_STARTS][variables] */
  double value[EO_GLOBAL_STARTS];
};

/* Room for the samples and the minima of so many variables. Errors: memory. */
enum eo_code eo_global_minima_init(struct eo_global_minima *global, int variables, struct eo_error *error);
void eo_global_minima_done(struct eo_global_minima *global);

/* Points of the cube round which nobody looks: rows of the archive. */
struct eo_global_bars {
  const int *row;
  int count;
  double radius;
  struct eo_view_distance *distance; /* borrowed; knows the rows */
  int starts;                        /* of descents on the model, at most EO_GLOBAL_STARTS */
};

/* Fills chosen[][n] from `first` to `count`: minima of the fitted model, from the row `best` and from samples, each
   `apart` (a distance in the cube) from all rows and from what is chosen, at most `minima` of them; then the samples
   with the best score. batch counts the random numbers. Returns how many there are. */
int eo_global_minima_choose(struct eo_global_minima *global, struct eo_credibility_model *model,
                            const struct eo_archive *archive, const struct eo_global_bars *bars, int best, int batch,
                            int minima, double *chosen, int first, int count);

#endif
