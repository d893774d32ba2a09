/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/settling.h"

#include <math.h>
#include <string.h>

enum { PATIENCE = 30 };
/* Where the integration's own noise keeps the state from settling further. */
static const double noise = 1e-5, progress_factor = 0.9;
/* Unless the state comes back so much nearer after several periods than after fewer, it may still be on its way to
   repeating after fewer: a slow decay that alternates looks like twice the period. */
static const double distinct = 1e-3;

void eo_settling_init(struct eo_settling *settling, int n, double settled, int max_repeat)
{
  *settling = (struct eo_settling){.n = n, .settled = settled, .max_repeat = max_repeat};
  for (int i = 0; i < EO_LONGEST_REPEAT; i++)
    settling->best[i] = INFINITY;
}

double *eo_settling_begin(struct eo_settling *settling, const double *y)
{
  int at = settling->seen % EO_LONGEST_REPEAT;
  memcpy(settling->before[at], y, sizeof *y * 2 * (size_t)settling->n);
  settling->swing[at] = 0;
  return &settling->swing[at];
}

/* Change of the state over the last `repeat` periods against the largest swing within them. */
static double change_over(const struct eo_settling *settling, int repeat, const double *y)
{
  const double *before = settling->before[(settling->seen - repeat) % EO_LONGEST_REPEAT];
  double change = 0, swing = 0;
  for (int i = 0; i < settling->n; i++)
    change = fmax(change,
                  fmax(fabs(y[i] - before[i]), fabs(y[settling->n + i] - before[settling->n + i]) / (2 * M_PI)));
  for (int i = 1; i <= repeat; i++)
    swing = fmax(swing, settling->swing[(settling->seen - i) % EO_LONGEST_REPEAT]);
  return swing > 0 ? change / swing : 0;
}

int eo_settling_end(struct eo_settling *settling, const double *y)
{
  int found = 0;
  double sooner = INFINITY; /* smallest change after fewer periods */
  settling->seen++;
  for (int i = 0; i < settling->max_repeat && i < settling->seen && !found; i++) {
    double change = settling->change[i] = change_over(settling, i + 1, y);
    settling->idle[i]++;
    if (change < progress_factor * settling->best[i]) {
      settling->best[i] = change;
      settling->idle[i] = 0;
    }
    bool still = settling->idle[i] >= PATIENCE && change <= noise && change < sooner / 2;
    if ((change <= settling->settled && change <= distinct * sooner) || still)
      found = i + 1;
    sooner = fmin(sooner, change);
  }
  return found;
}

double eo_settling_change(const struct eo_settling *settling)
{
  double change = settling->change[0];
  for (int i = 1; i < settling->max_repeat && i < settling->seen; i++)
    change = fmin(change, settling->change[i]);
  return change;
}
