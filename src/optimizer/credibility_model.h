/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What credibility-ga believes of the objective: a surrogate of some rows of the archive, their values cut off at the
   median (what is bad need not be known exactly), and its credibility by leave-one-out (surrogate.h). */
#ifndef EASEOFF_OPTIMIZER_CREDIBILITY_MODEL_H
#define EASEOFF_OPTIMIZER_CREDIBILITY_MODEL_H

#include "optimizer/true_rows.h"
#include "optimizer/settings.h"
#include "optimizer/composite.h"

struct eo_credibility_model {
  const struct eo_optimizer_settings *settings; /* borrowed */
  bool fitted;
  double spread; /* s: median less minimum of the values */
  struct eo_composite composite;
  int *rows;              /* [model_rows] of the archive; owned, as all below */
  double *x, *y, *sorted; /* [model_rows][n], [model_rows], likewise */
  struct eo_ranked_row {
    double key;
    int row;
  } * ranked; /* scratch [ranked_capacity], as is the next */
  bool *used;
  int ranked_capacity;
};

/* Room for settings->model_rows rows; settings and anatomy are borrowed. eo_credibility_model_done() also after an
   error, which is memory alone. */
enum eo_code eo_credibility_model_init(struct eo_credibility_model *model, const struct eo_optimizer_settings *settings,
                                       const struct eo_anatomy *anatomy, struct eo_error *error);
void eo_credibility_model_done(struct eo_credibility_model *model);

/* Room to rank so many rows: once before every fit. */
enum eo_code eo_credibility_model_reserve(struct eo_credibility_model *model, int rows, struct eo_error *error);

/* At most model_rows rows: a third the best, a third the newest, the rest nearest to the centre. */
void eo_credibility_model_fit(struct eo_credibility_model *model, const struct eo_archive *archive,
                              const double *centre);

/* Predicted value, negative: to maximise; and the same less what is doubtful, kappa s (1 - R). Without a surrogate 0:
   every point is as good as any other. */
double eo_credibility_predict(struct eo_credibility_model *model, const double *x);
double eo_credibility_score(struct eo_credibility_model *model, const double *x);

#endif
