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

void eo_settling_init(struct eo_settling *s, int n, double settled, int max_repeat)
{
  *s = (struct eo_settling){.n = n, .settled = settled, .max_repeat = max_repeat};
  for (int i = 0; i < EO_LONGEST_REPEAT; i++)
    s->best[i] = INFINITY;
}

double *eo_settling_begin(struct eo_settling *s, const double *y)
{
  int at = s->seen % EO_LONGEST_REPEAT;
  memcpy(s->before[at], y, sizeof *y * 2 * (size_t)s->n);
  s->swing[at] = 0;
  return &s->swing[at];
}

/* Change of the state over the last `repeat` periods against the largest swing within them. */
static double change_over(const struct eo_settling *s, int repeat, const double *y)
{
  const double *before = s->before[(s->seen - repeat) % EO_LONGEST_REPEAT];
  double change = 0, swing = 0;
  for (int i = 0; i < s->n; i++)
    change = fmax(change, fmax(fabs(y[i] - before[i]), fabs(y[s->n + i] - before[s->n + i]) / (2 * M_PI)));
  for (int i = 1; i <= repeat; i++)
    swing = fmax(swing, s->swing[(s->seen - i) % EO_LONGEST_REPEAT]);
  return swing > 0 ? change / swing : 0;
}

int eo_settling_end(struct eo_settling *s, const double *y)
{
  int found = 0;
  double sooner = INFINITY; /* smallest change after fewer periods */
  s->seen++;
  for (int i = 0; i < s->max_repeat && i < s->seen && !found; i++) {
    double change = s->change[i] = change_over(s, i + 1, y);
    s->idle[i]++;
    if (change < progress_factor * s->best[i]) {
      s->best[i] = change;
      s->idle[i] = 0;
    }
    bool still = s->idle[i] >= PATIENCE && change <= noise && change < sooner / 2;
    if ((change <= s->settled && change <= distinct * sooner) || still)
      found = i + 1;
    sooner = fmin(sooner, change);
  }
  return found;
}

double eo_settling_change(const struct eo_settling *s)
{
  double change = s->change[0];
  for (int i = 1; i < s->max_repeat && i < s->seen; i++)
    change = fmin(change, s->change[i]);
  return change;
}
