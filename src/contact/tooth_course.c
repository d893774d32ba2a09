/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/tooth_course.h"

#include <stddef.h>

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

/* Of the parabola through a node and its neighbours, at an end of the last three. */
static double parabola_slope(const struct eo_tooth_course *course, int i)
{
  int n = course->nodes, a = i == 0 ? 0 : i == n - 1 ? n - 3 : i - 1;
  if (n < 3)
    return (course->state[n - 1].tangent - course->state[0].tangent) / (course->at[n - 1] - course->at[0]);
  double first = course->at[a + 1] - course->at[a], second = course->at[a + 2] - course->at[a + 1],
         before = (course->state[a + 1].tangent - course->state[a].tangent) / first,
         behind = (course->state[a + 2].tangent - course->state[a + 1].tangent) / second,
         curve = (behind - before) / (first + second);
  return before + curve * (2 * course->at[i] - course->at[a] - course->at[a + 1]);
}

void eo_tooth_course_settle(struct eo_tooth_course *course)
{
  for (int i = 0; i < course->nodes; i++)
    course->bend[i] = course->nodes > 1 ? parabola_slope(course, i) : 0;
}

/* Node that the stretch about a place begins with. */
static int stretch_of(const struct eo_tooth_course *course, double at)
{
  int i = 0;
  while (i < course->nodes - 2 && at > course->at[i + 1])
    i++;
  return i;
}

/* t: share of the width. */
static double cubic(double from, double to, double from_slope, double to_slope, double width, double t)
{
  double rise = to - from, a = from_slope * width, b = to_slope * width;
  return from + t * (a + t * (3 * rise - 2 * a - b + t * (a + b - 2 * rise)));
}

/* Between two states, at a share of the width between them: the approach by their slopes, all else straight. */
static void find_between(const struct eo_course_state *from, const struct eo_course_state *to, int mover, int pairs,
                         double width, double t, bool loads, struct eo_course_state *state)
{
  state->approach = cubic(from->approach, to->approach, from->share[mover], to->share[mover], width, t);
  state->tangent = from->tangent + t * (to->tangent - from->tangent);
  for (int k = 0; k < pairs; k++)
    state->share[k] = from->share[k] + t * (to->share[k] - from->share[k]);
  for (int k = 0; k < pairs && loads; k++) {
    state->load[k] = from->load[k] + t * (to->load[k] - from->load[k]);
    state->square[k] = from->square[k] + t * (to->square[k] - from->square[k]);
  }
}

static double tangent_in(const struct eo_tooth_course *course, int i, double width, double t)
{
  return cubic(course->state[i].tangent, course->state[i + 1].tangent, course->bend[i], course->bend[i + 1], width, t);
}

void eo_tooth_course_find(const struct eo_tooth_course *course, int pairs, double at, bool loads,
                          struct eo_course_state *state)
{
  int i = stretch_of(course, at);
  if (course->nodes == 1) {
    eo_course_state_copy(state, &course->state[0], pairs, loads);
    return;
  }
  double width = course->at[i + 1] - course->at[i], t = (at - course->at[i]) / width;
  find_between(&course->state[i], &course->state[i + 1], course->mover, pairs, width, t, loads, state);
  state->tangent = tangent_in(course, i, width, t);
}

void eo_tooth_course_level(const struct eo_tooth_course *course, double at, double *approach, double *tangent)
{
  const struct eo_course_state *from = &course->state[stretch_of(course, at)], *to = from + 1;
  int i = (int)(from - course->state);
  *approach = from->approach;
  *tangent = from->tangent;
  if (course->nodes == 1)
    return;
  double width = course->at[i + 1] - course->at[i], t = (at - course->at[i]) / width;
  *approach = cubic(from->approach, to->approach, from->share[course->mover], to->share[course->mover], width, t);
  *tangent = tangent_in(course, i, width, t);
}

void eo_tooth_course_cross(const struct eo_tooth_course *course, const struct eo_tooth_course *across, int pairs,
                           double at, double other, bool loads, struct eo_course_state *state)
{
  int i = stretch_of(course, at);
  struct eo_course_state from, to;
  double width = course->at[i + 1] - course->at[i], t = (at - course->at[i]) / width,
         straight = course->state[i].tangent + t * (course->state[i + 1].tangent - course->state[i].tangent);
  eo_tooth_course_find(&across[i], pairs, other, loads, &from);
  eo_tooth_course_find(&across[i + 1], pairs, other, loads, &to);
  find_between(&from, &to, course->mover, pairs, width, t, loads, state);
  state->tangent += tangent_in(course, i, width, t) - straight;
}
