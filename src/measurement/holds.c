/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/angles_private.h"

#include <math.h>

static const double HELD = 0.3;   /* relative: how far the way behind held values may be from the usual */
static const double PAIRS = 0.05; /* of the rows: more that repeat the one before are in the nature of a counter */

/* What a channel shows behind rows that repeat a value is where its shaft has come to meanwhile: a converter or a bus
   gave its last value once more. A rest is followed by a usual step. */
static bool goes_on_behind(const struct eo_angles_maker *maker, int channel, const struct eo_scan_hold *hold)
{
  const struct eo_scan_column *column = &maker->scan->column[channel][0];
  double period = maker->sampler.period[channel] / maker->sampler.scale[channel],
         way = copysign(column->typical, (double)column->rises) * (double)(hold->rows + 1), off = hold->step - way,
         slack = fmax(HELD * fabs(way), 2 * column->typical);
  if (isnan(hold->step)) /* the other channel went on until the end */
    return column->longest_row + 1 == hold->row && column->longest == hold->rows + 1;
  return fabs(period > 0 ? remainder(off, period) : off) < (period > 0 ? fmin(slack, period / 4) : slack);
}

/* Steps of a few counts repeat by nature. */
void eo_holds_find(struct eo_angles_maker *maker, int channel)
{
  struct eo_scan_column *column = &maker->scan->column[channel][0];
  int64_t rows = 0;
  int kept = 0;
  for (int i = 0; i < column->holds && i < EO_SCAN_HOLDS; i++)
    if (goes_on_behind(maker, channel, &column->hold[i])) {
      column->hold[kept++] = column->hold[i];
      rows += column->hold[i].rows;
    }
  if (!kept || column->holds > EO_SCAN_HOLDS || (double)column->pairs > PAIRS * (double)maker->scan->used ||
      3 * rows > maker->scan->used)
    return;
  maker->sampler.hold[channel] = column->hold;
  maker->sampler.holds[channel] = kept;
  eo_angles_at_row(maker,
                   eo_findings_add(maker->findings, EO_FINDING_NAN, EO_SEVERITY_REPAIRED, channel, (double)rows,
                                   "%lld rows repeat the %s's value before them while the shaft goes on, the first is "
                                   "row %lld; they were left out.",
                                   (long long)rows, eo_channel_name(channel), (long long)column->hold[0].row + 1),
                   column->hold[0].row);
}

bool eo_holds_left_out(const struct eo_angles_maker *maker, int channel, int64_t row)
{
  for (int i = 0; i < maker->sampler.holds[channel]; i++)
    if (row == maker->sampler.hold[channel][i].row)
      return true;
  return false;
}
