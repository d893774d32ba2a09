/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The history of the fitness-predicted genetic algorithm: rows with a credibility that predict their neighbourhood, and
   how they age: theory (H1) to (H5). What was settled:
   - the region is closed (e <= r_share); an empty one has credibility 0;
   - (H1) sums over the m rows of the region (the printed n is a misprint; option all keeps every row);
   - (H4) as printed deletes rows that are unique in space when each coordinate has neighbours; unless literal is set, a
     row goes only when another row is within the threshold of it, a true row only when a true one is;
   - at the end of a generation redundant rows leave, then predicted rows lose credibility, then those below R_0 leave.
 */
#ifndef EASEOFF_OPTIMIZER_PREDICTION_HISTORY_H
#define EASEOFF_OPTIMIZER_PREDICTION_HISTORY_H

#include "base/error.h"

#include <stdbool.h>

struct eo_history_law {
  double share_radius, weight_decay;          /* r_share, alpha */
  double credibility_loss, removal_threshold; /* beta, R_0 */
  double redundancy_threshold;                /* I_r* */
  bool rms, weights_over_all, literal_redundancy;
};

struct eo_history {
  int variables, count, capacity;
  double *x;           /* [count][variables]; owned, as all below */
  double *fitness;     /* [count] */
  double *credibility; /* [count] R */
  bool *predicted;     /* [count] */
  double *distance;    /* [capacity] e to the point last predicted; scratch, as all below */
  double *weight;      /* [capacity] w likewise, 0 outside the region */
  double *redundancy;  /* [capacity] I_r; infinite for the first and last row of a coordinate */
  bool *removed;       /* [capacity] */
  void *order;         /* [capacity] */
};

struct eo_history_estimate {
  int region;         /* m */
  double credibility; /* R(i), 0 for an empty region */
  double fitness;     /* weighted, NaN for an empty region */
};

/* Empty, with room for capacity rows. Errors: memory. */
enum eo_code eo_history_init(struct eo_history *history, int variables, int capacity, struct eo_error *error);
void eo_history_done(struct eo_history *history);

/* Adds a row; the history grows as needed. */
enum eo_code eo_history_add(struct eo_history *history, const double *x, double fitness, double credibility,
                            bool predicted, struct eo_error *error);

/* (H1) to (H3) at x; history->distance and history->weight hold e and w afterwards. */
struct eo_history_estimate eo_history_predict(struct eo_history *history, const struct eo_history_law *law,
                                              const double *x);

/* Whether an individual is predicted, R(i) >= R*. */
bool eo_history_trusts(const struct eo_history_estimate *estimate, double trust_threshold);

/* The steps at the end of a generation, (H4) and (H5). The first two mark rows in history->removed and return how many,
 * the last takes them out. */
int eo_history_mark_redundant(struct eo_history *history, const struct eo_history_law *law);
int eo_history_decay(struct eo_history *history, const struct eo_history_law *law);
void eo_history_compact(struct eo_history *history);

#endif
