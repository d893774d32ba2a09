/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/orientation.h"

#include <math.h>

static const double DEGREES = 180 / M_PI;
static const double SAME_RATIO = 1e-3; /* relative: of steps from row to row, medians */

bool eo_orientation_nearest(double ratio, double tolerance, const int teeth[2], int nearest[2])
{
  double other = round(teeth[0] / ratio), own = round(teeth[1] * ratio);
  if (other > 0 && other <= 400 && fabs(teeth[0] / other / ratio - 1) < tolerance) {
    nearest[0] = teeth[0];
    nearest[1] = (int)other;
    return true;
  }
  if (own > 0 && own <= 400 && fabs(own / teeth[1] / ratio - 1) < tolerance) {
    nearest[0] = (int)own;
    nearest[1] = teeth[1];
    return true;
  }
  for (int sum = 2; sum <= 800; sum++) {
    double p = round(sum * ratio / (1 + ratio)), q = sum - p;
    if (p > 0 && q > 0 && p <= 400 && q <= 400 && fabs(p / q / ratio - 1) < tolerance) {
      nearest[0] = (int)p;
      nearest[1] = (int)q;
      return true;
    }
  }
  return false;
}

static bool matches(const struct eo_angles *angles, double ratio, double expected)
{
  return fabs(ratio / expected - 1) < angles->ratio_tolerance;
}

/* Counters that start again every few rows may have gone on by once more, or less, of what they hold. The other steps
   from row to row that fit the teeth; true when there are such. step: as counted, then the others, rad. */
static bool may_step_otherwise(const struct eo_angles *angles, const int teeth[2], double step[2])
{
  double own[2], expected = (double)teeth[0] / teeth[1];
  for (int c = 0; c < 2; c++)
    own[c] = angles->rate[c] * angles->interval;
  for (int first = -1; first <= 1; first++)
    for (int second = -1; second <= 1; second++) {
      bool none = (first && !(angles->around[0] > 0)) || (second && !(angles->around[1] > 0)) || (!first && !second);
      double one = own[0] + first * angles->around[0], two = own[1] + second * angles->around[1],
             ratio = fabs(two / one);
      if (none || (fabs(ratio / expected - 1) > SAME_RATIO && fabs(ratio * expected - 1) > SAME_RATIO))
        continue;
      step[0] = one;
      step[1] = two;
      return true;
    }
  return false;
}

/* remedy: what else tells, beside another recording. */
static void refuse_steps(const struct eo_angles *angles, const double step[2], const char *remedy,
                         struct eo_findings *findings)
{
  int channel = angles->around[0] > 0 ? 0 : 1;
  double around = angles->around[channel];
  eo_findings_add(findings, EO_FINDING_SAMPLE_RATE, EO_SEVERITY_REFUSED, channel, step[channel] / around,
                  "From row to row the %s's counter goes on by %.3g of the counts after which it starts again, or by "
                  "%.3g: with steps near half of them or beyond the counter does not tell. %s at a higher rate or with "
                  "more bits.",
                  channel ? "gear" : "pinion", angles->rate[channel] * angles->interval / around,
                  step[channel] / around, remedy);
}

static void refuse_teeth(const struct eo_angles *angles, const int teeth[2], struct eo_findings *findings)
{
  int nearest[2];
  double ratio = fabs(angles->ratio), step[2];
  if (may_step_otherwise(angles, teeth, step))
    refuse_steps(angles, step, "Record", findings);
  else if (eo_orientation_nearest(ratio, angles->ratio_tolerance, teeth, nearest))
    eo_findings_add(
        findings, EO_FINDING_TEETH, EO_SEVERITY_REFUSED, -1, ratio,
        "The gear turns %.6f times as far as the pinion, which is %d/%d, not the %d/%d = %.6f of the design.", ratio,
        nearest[0], nearest[1], teeth[0], teeth[1], (double)teeth[0] / teeth[1]);
  else
    eo_findings_add(findings, EO_FINDING_TEETH, EO_SEVERITY_REFUSED, -1, ratio,
                    "The gear turns %.6f times as far as the pinion, no ratio of tooth numbers (%d/%d would be %.6f): "
                    "check lines per turn and couplings.",
                    ratio, teeth[0], teeth[1], (double)teeth[0] / teeth[1]);
}

/* One channel in degrees, one in radians: the one that starts again every turn, or the stated speed, tells which is
   right. excess: gear over pinion beyond the ratio of the teeth, 57.3 or its inverse. */
static void settle_units(struct eo_angles *angles, double excess, double stated, struct eo_findings *findings)
{
  int wrong = -1;
  double speed = fabs(angles->rate[angles->from[0]]);
  if (angles->wrapped[0] != angles->wrapped[1])
    wrong = angles->wrapped[angles->from[0]] ? 1 : 0;
  else if (!isnan(stated))
    wrong = fabs(log(speed / stated)) < 1 ? 1 : 0;
  if (wrong < 0) {
    wrong = 1; /* for the time being: the lines of the spectrum decide about both */
    angles->units_in_doubt = true;
  }
  double factor = wrong == 1 ? 1 / excess : excess;
  angles->factor[wrong] *= factor;
  eo_findings_add(findings, EO_FINDING_UNITS, EO_SEVERITY_REPAIRED, wrong, excess,
                  "One channel is in degrees and the other in radians: their ratio is off by %.5g. The %s was brought "
                  "to the unit of the %s.",
                  excess, wrong ? "gear" : "pinion", wrong ? "pinion" : "gear");
}

static bool settle_ratio(struct eo_angles *angles, const int teeth[2], double stated, struct eo_findings *findings)
{
  static const double unit[3] = {1, 180 / M_PI, M_PI / 180};
  double expected = (double)teeth[0] / teeth[1], ratio = fabs(angles->ratio);
  for (int u = 0; u < 3; u++)
    for (int swap = 0; swap < 2; swap++) {
      if (!matches(angles, swap ? 1 / ratio : ratio, expected * unit[u]))
        continue;
      angles->from[0] = swap;
      angles->from[1] = !swap;
      if (swap)
        eo_findings_add(findings, EO_FINDING_SWAPPED, EO_SEVERITY_REPAIRED, -1, ratio,
                        "Pinion and gear are swapped: the second channel turns %.6f times as far as the first, which "
                        "is %d/%d; exchanged.",
                        ratio, teeth[1], teeth[0]);
      if (u > 0)
        settle_units(angles, unit[u], stated, findings);
      return true;
    }
  refuse_teeth(angles, teeth, findings);
  return false;
}

static void settle_directions(struct eo_angles *angles, struct eo_findings *findings)
{
  int sign[2] = {angles->rate[angles->from[0]] < 0 ? -1 : 1, angles->rate[angles->from[1]] < 0 ? -1 : 1};
  angles->factor[0] *= sign[0];
  angles->factor[1] *= sign[1];
  if (sign[0] != sign[1]) {
    int wrong = sign[0] < 0 ? 0 : 1;
    eo_findings_add(
        findings, EO_FINDING_REVERSED, EO_SEVERITY_REPAIRED, wrong, angles->ratio,
        "The %s encoder counts backwards while the other counts forwards (ratio %.6f); its sign was changed.",
        wrong ? "gear" : "pinion", angles->ratio);
  } else if (sign[0] < 0) {
    eo_findings_add(findings, EO_FINDING_REVERSED, EO_SEVERITY_NOTE, -1, angles->ratio,
                    "Both angles fall: the pair runs backwards; both signs were changed.");
  }
}

static void settle_speed(struct eo_angles *angles, double stated, struct eo_findings *findings)
{
  double speed = fabs(angles->rate[angles->from[0]] * angles->factor[0]), off = speed / stated;
  if (isnan(stated) || fabs(off - 1) < 0.05)
    return;
  double factor = fabs(off * DEGREES - 1) < 0.05 ? DEGREES : fabs(off / DEGREES - 1) < 0.05 ? 1 / DEGREES : 1;
  if (factor != 1) {
    angles->factor[0] *= factor;
    angles->factor[1] *= factor;
    eo_findings_add(
        findings, EO_FINDING_UNITS, EO_SEVERITY_REPAIRED, -1, off,
        "Both angles are in %s, not in the stated unit: the speed would be %.5g rpm instead of %.5g rpm; read so.",
        factor > 1 ? "radians" : "degrees", 30 / M_PI * speed, 30 / M_PI * stated);
  } else if (angles->around[0] > 0 || angles->around[1] > 0) {
    eo_findings_add(findings, EO_FINDING_SPEED, EO_SEVERITY_REFUSED, -1, 30 / M_PI * speed,
                    "The pinion would run at %.6g rpm, not at the stated %.6g rpm: its counter starts again every few "
                    "rows, and steps beyond half of its counts look like others. Record at a higher rate or with more "
                    "bits.",
                    30 / M_PI * speed, 30 / M_PI * stated);
  } else {
    eo_findings_add(findings, EO_FINDING_SPEED, EO_SEVERITY_WARNING, -1, 30 / M_PI * speed,
                    "The pinion runs at %.6g rpm, not at the stated %.6g rpm.", 30 / M_PI * speed, 30 / M_PI * stated);
  }
}

void eo_orientation_judge(struct eo_angles *angles, const int teeth[2], double stated, struct eo_findings *findings)
{
  double step[2];
  if (!(fabs(angles->ratio) > 0) || !isfinite(angles->ratio)) {
    eo_findings_add(findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, -1, angles->ratio,
                    "One of the shafts does not turn.");
    return;
  }
  if (!settle_ratio(angles, teeth, stated, findings))
    return;
  if (isnan(stated) && may_step_otherwise(angles, teeth, step)) {
    refuse_steps(angles, step, "State the speed, or record", findings);
    return;
  }
  settle_directions(angles, findings);
  settle_speed(angles, stated, findings);
}
