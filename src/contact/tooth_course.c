/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/tooth_course.h"

#include <math.h>
#include <stddef.h>

/* Nothing else carries; the pair carries nothing. */
static bool is_alone(const struct eo_course_state *state, int mover)
{
  return state->share[mover] > 1 - 1e-9;
}

static bool is_away(const struct eo_course_state *state, int mover)
{
  return state->share[mover] == 0;
}

struct eo_course_state *eo_tooth_course_add(struct eo_tooth_course *course, double at)
{
  int i = course->nodes;
  if (i == EO_COURSE_NODES)
    return NULL;
  for (; i > 0 && course->at[i - 1] > at; i--) {
    course->at[i] = course->at[i - 1];
    course->state[i] = course->state[i - 1];
  }
  course->at[i] = at;
  course->nodes++;
  return &course->state[i];
}

void eo_course_state_copy(struct eo_course_state *state, const struct eo_course_state *from, int pairs, bool loads)
{
  state->approach = from->approach;
  state->tangent = from->tangent;
  for (int k = 0; k < pairs; k++)
    state->share[k] = from->share[k];
  for (int k = 0; k < pairs && loads; k++) {
    state->load[k] = from->load[k];
    state->square[k] = from->square[k];
  }
}

/* Node that the stretch about a place begins with. */
static int stretch_of(const struct eo_tooth_course *course, double at)
{
  int i = 0;
  while (i < course->nodes - 2 && at > course->at[i + 1])
    i++;
  return i;
}

static double bounded(double value, double low, double high)
{
  return value < low ? low : value > high ? high : value;
}

/* What a pair takes of 1 N more goes to nothing where it leaves the others, and what they take where it carries alone,
   by the power of the distance that the change of Z asks for. */
static double power_of(double share, double width, double rise)
{
  static const double MOST = 20;
  return rise > 0 ? bounded(share * width / rise - 1, 0, MOST) : MOST;
}

/* Z at a share t of the width between two states, and its slope, the share of the pair. */
static double approach_between(const struct eo_course_state *from, const struct eo_course_state *to, int mover,
                               double width, double t, double *share)
{
  double a = from->share[mover], b = to->share[mover], rise = to->approach - from->approach;
  bool alone = is_alone(from, mover), away = is_away(to, mover);
  if (away && !alone) {
    double power = power_of(a, width, rise), part = pow(1 - t, power);
    *share = a * part;
    return to->approach - rise * part * (1 - t); /* theory (P9) */
  }
  if (alone && !away) {
    double power = power_of(1 - b, width, width - rise), part = pow(t, power);
    *share = 1 - (1 - b) * part;
    return from->approach + width * t - (width - rise) * part * t;
  }
  double c = a * width, d = b * width;
  *share = (c + t * (2 * (3 * rise - 2 * c - d) + 3 * t * (c + d - 2 * rise))) / width;
  return from->approach + t * (c + t * (3 * rise - 2 * c - d + t * (c + d - 2 * rise)));
}

/* k_tan there: that of all but the pair is straight, or where it takes most that of the pair. */
static double tangent_between(const struct eo_course_state *from, const struct eo_course_state *to, int mover, double t,
                              double share)
{
  double a = from->share[mover], b = to->share[mover];
  bool alone = is_alone(from, mover), away = is_away(to, mover);
  share = bounded(share, a < b ? a : b, a < b ? b : a);
  if (alone && away)
    return from->tangent + t * (to->tangent - from->tangent);
  if (alone || (!away && a + b > 1))
    return (from->tangent * a + t * (to->tangent * b - from->tangent * a)) / share;
  double first = from->tangent * (1 - a), last = to->tangent * (1 - b);
  return (first + t * (last - first)) / (1 - share);
}

/* How far loads and squares of pressures are from one state to the other: those of all but the pair go with Z, and all
   of them where it takes most with how far Z stays behind it. */
static double way_between(const struct eo_course_state *from, const struct eo_course_state *to, int mover, double width,
                          double t, double approach)
{
  double rise = to->approach - from->approach, risen = approach - from->approach,
         part = from->share[mover] + to->share[mover] > 1 ? (width * t - risen) / (width - rise) : risen / rise;
  return isfinite(part) ? bounded(part, 0, 1) : t;
}

/* What each pair takes of 1 N more: the others share what the mover leaves. */
static void share_between(const struct eo_course_state *from, const struct eo_course_state *to, int mover, int pairs,
                          double t, double share, struct eo_course_state *state)
{
  double first = 1 - from->share[mover], last = 1 - to->share[mover];
  for (int k = 0; k < pairs; k++) {
    double a = from->share[k] / first, b = to->share[k] / last;
    state->share[k] = first > 0 && last > 0 ? (1 - share) * (a + t * (b - a))
                                            : from->share[k] + t * (to->share[k] - from->share[k]);
  }
  if (mover < pairs)
    state->share[mover] = share;
}

/* Between two states, at a share of the width between them. */
static void find_between(const struct eo_course_state *from, const struct eo_course_state *to, int mover, int pairs,
                         double width, double t, bool loads, struct eo_course_state *state)
{
  double share;
  state->approach = approach_between(from, to, mover, width, t, &share);
  state->tangent = tangent_between(from, to, mover, t, share);
  share_between(from, to, mover, pairs, t, share, state);
  double way = loads ? way_between(from, to, mover, width, t, state->approach) : 0;
  for (int k = 0; k < pairs && loads; k++) {
    state->load[k] = from->load[k] + way * (to->load[k] - from->load[k]);
    state->square[k] = from->square[k] + way * (to->square[k] - from->square[k]);
  }
}

/* Keeps a place between the outer nodes; returns by how much it is beyond them. */
static double bring_inside(const struct eo_tooth_course *course, double *at)
{
  double asked = *at;
  *at = bounded(asked, course->at[0], course->at[course->nodes - 1]);
  return asked - *at;
}

void eo_tooth_course_find(const struct eo_tooth_course *course, int pairs, double at, bool loads,
                          struct eo_course_state *state)
{
  double beyond = bring_inside(course, &at);
  int i = stretch_of(course, at);
  if (course->nodes == 1) {
    eo_course_state_copy(state, &course->state[0], pairs, loads);
    state->approach += beyond * state->share[course->mover];
    return;
  }
  double width = course->at[i + 1] - course->at[i], t = (at - course->at[i]) / width;
  find_between(&course->state[i], &course->state[i + 1], course->mover, pairs, width, t, loads, state);
  state->approach += beyond * course->state[t > 0.5 ? i + 1 : i].share[course->mover];
}

/* From where its first node was solved: all that is not the pair stands `beyond` further away from it, which it takes
   with it as it carries alone. */
static void find_alone(const struct eo_tooth_course *across, int pairs, double beyond, double other, bool loads,
                       struct eo_course_state *state)
{
  eo_tooth_course_find(across, pairs, other - beyond, loads, state);
  state->approach += beyond;
}

void eo_tooth_course_cross(const struct eo_tooth_course *course, const struct eo_tooth_course *across, int pairs,
                           double at, double other, bool loads, struct eo_course_state *state)
{
  enum { STEPS = 2 }; /* to where another one touches, which what lowers Z keeps from it */
  int i = stretch_of(course, at), last = course->nodes - 1;
  struct eo_course_state from, to;
  eo_tooth_course_find(&across[i + 1], pairs, other, loads, &to);
  double begin = course->at[i], end = course->at[i + 1];
  if (i + 1 == last && is_away(&course->state[last], course->mover))
    end += to.approach - course->state[last].approach; /* what lifts the others brings it back into contact */
  if (i == 0) {
    find_alone(&across[0], pairs, begin - course->end[0], other, loads, &from);
    bool alone = is_alone(&course->state[0], course->mover);
    for (int step = 0; step < STEPS && alone && !is_away(&from, course->mover); step++) {
      begin += (course->state[0].approach - from.approach) / from.share[course->mover];
      find_alone(&across[0], pairs, begin - course->end[0], other, loads, &from);
    }
  } else
    eo_tooth_course_find(&across[i], pairs, other, loads, &from);
  if (at >= end)
    *state = to;
  else if (i == 0 && at <= begin)
    find_alone(&across[0], pairs, at - course->end[0], other, loads, state);
  else
    find_between(&from, &to, course->mover, pairs, end - begin, (at - begin) / (end - begin), loads, state);
}
