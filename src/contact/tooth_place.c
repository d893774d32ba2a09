/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "contact/tooth_courses_private.h"

enum { MOST = EO_COURSE_PAIRS };

static const struct eo_contact_grid *grid_of(const struct eo_follow *follow)
{
  return follow->input->grid[follow->end];
}

static const struct eo_contact_position *position_of(const struct eo_follow *follow)
{
  return &grid_of(follow)->position[follow->place.j];
}

static void number_pairs(struct eo_follow_place *place, const struct eo_contact_position *position)
{
  int last = position->line[0].pair;
  place->first = last;
  for (int l = 1; l < position->lines; l++) {
    place->first = position->line[l].pair < place->first ? position->line[l].pair : place->first;
    last = position->line[l].pair > last ? position->line[l].pair : last;
  }
  place->pairs = last - place->first + 1;
}

/* Moves a pair away from where the flanks are without deviations. */
static void move_pair(struct eo_follow *follow, int k, double by)
{
  const struct eo_contact_position *position = position_of(follow);
  const double *gap = follow->input->gap[follow->end] + position->first;
  for (int l = 0; l < position->lines; l++)
    for (int i = position->line[l].first;
         position->line[l].pair - follow->place.first == k && i < position->line[l].first + position->line[l].cells;
         i++)
      follow->gap[position->first + i] = gap[i] + by;
}

/* Solves the position with the gaps at hand. */
static void solve(struct eo_follow *follow, struct eo_course_state *state)
{
  const struct eo_contact_grid *grid = grid_of(follow);
  const struct eo_contact_position *position = position_of(follow);
  int j = follow->place.j;
  eo_loaded_resolve_within(follow->workspace, grid, follow->gap, follow->input->compliance_factor, j,
                           follow->input->load[follow->end], follow->settled, &follow->solved);
  eo_loaded_last_shares(follow->workspace, position, follow->share);
  eo_loaded_last_reach(follow->workspace, position, follow->input->compliance_factor, follow->reach);
  memset(state, 0, sizeof *state);
  for (int k = 0; k < EO_COURSE_PAIRS; k++)
    state->reach[k] = -INFINITY;
  state->approach = follow->solved.approach[j];
  state->tangent = follow->solved.tangent[j];
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    int k = line->pair - follow->place.first;
    for (int i = line->first; i < line->first + line->cells; i++) {
      double q = follow->solved.line_load[position->first + i],
             pressure = q > 0 ? eo_loaded_pressure(grid, q, position->radius[i]) : 0;
      state->load[k] += q * position->length[i];
      state->share[k] += follow->share[i];
      state->reach[k] = fmax(state->reach[k], follow->reach[i]);
      state->square[k] = fmax(state->square[k], pressure * pressure);
    }
  }
}

/* Puts what lines of the same teeth carry at another position, zero where they are not there, in the place of this
   one's solution. */
static void go_on_from(struct eo_follow *follow, int from)
{
  const struct eo_contact_position *position = position_of(follow), *before = &grid_of(follow)->position[from];
  double *load = follow->solved.line_load;
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l], *same = NULL;
    for (int i = 0; i < before->lines && !same; i++)
      if (before->line[i].pair == line->pair && before->line[i].kind == line->kind &&
          before->line[i].cells == line->cells)
        same = &before->line[i];
    size_t bytes = sizeof *load * (size_t)line->cells;
    if (same)
      memcpy(load + position->first + line->first, load + before->first + same->first, bytes);
    else
      memset(load + position->first + line->first, 0, bytes);
  }
  follow->solved.approach[follow->place.j] = follow->solved.approach[from];
}

/* Teeth alike: where few are solved from the solution that there is, else from that of the place before. */
static void solve_alike(struct eo_follow *follow, int at)
{
  struct eo_follow_place *place = &follow->place;
  const struct eo_loaded_end *alike = isinf(follow->within) ? follow->input->alike[follow->end] : NULL;
  const struct eo_contact_position *position = position_of(follow);
  size_t bytes = sizeof(double) * (size_t)position->points;
  memcpy(follow->gap + position->first, follow->input->gap[follow->end] + position->first, bytes);
  if (alike) {
    memcpy(follow->solved.line_load + position->first, alike->line_load + position->first, bytes);
    follow->solved.approach[place->j] = alike->approach[place->j];
  } else if (at > 0)
    go_on_from(follow, place->j - follow->step);
  else
    memset(follow->solved.line_load + position->first, 0, bytes);
  solve(follow, &place->alike);
  memcpy(follow->start, follow->solved.line_load + position->first, bytes);
  place->leader = 0;
  for (int k = 1; k < place->pairs; k++)
    place->leader = place->alike.load[k] > place->alike.load[place->leader] ? k : place->leader;
}

/* Begins from teeth alike. */
static void go_back(struct eo_follow *follow)
{
  const struct eo_contact_position *position = position_of(follow);
  memcpy(follow->solved.line_load + position->first, follow->start, sizeof(double) * (size_t)position->points);
  follow->solved.approach[follow->place.j] = follow->place.alike.approach;
}

/* Where on its flanks a pair carries: as with teeth alike, evenly where it carries nothing. */
static void weigh(struct eo_follow *follow)
{
  const struct eo_follow_place *place = &follow->place;
  const struct eo_contact_position *position = position_of(follow);
  int cells[MOST] = {0};
  for (int l = 0; l < position->lines; l++)
    cells[position->line[l].pair - place->first] += position->line[l].cells;
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    int k = line->pair - place->first;
    for (int i = line->first; i < line->first + line->cells; i++)
      follow->weight[i] = place->alike.load[k] > 0 ? follow->start[i] * position->length[i] / place->alike.load[k]
                                                   : 1. / cells[k];
  }
}

/* What 1 m of each deviation of a member's tooth adds to the gap of a pair, where that carries. */
static struct eo_tooth_deviation unit_gaps(const struct eo_follow *follow, int k, int member)
{
  static const struct eo_tooth_deviation UNIT[] = {
      {.index = 1}, {.profile_slope = 1}, {.helix_slope = 1}, {.profile_crowning = 1}, {.lead_crowning = 1}};
  const struct eo_contact_grid *grid = grid_of(follow);
  const struct eo_contact_position *position = position_of(follow);
  double sum[5] = {0};
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    for (int i = line->first; line->pair - follow->place.first == k && i < line->first + line->cells; i++)
      for (int term = 0; term < 5 && (follow->formed || (term == 0 && sum[0] == 0)); term++) {
        const struct eo_tooth_deviation *tooth[2] = {NULL, NULL};
        tooth[member] = &UNIT[term];
        double gap = eo_hunting_gap(&grid->geometry, &position->point[i], follow->input->inwards, tooth);
        sum[term] = term == 0 ? gap : sum[term] + follow->weight[i] * gap;
      }
  }
  return (struct eo_tooth_deviation){sum[0], sum[1], sum[2], sum[3], sum[4]};
}

static int wrap(int number, int by)
{
  int rest = number % by;
  return rest < 0 ? rest + by : rest;
}

static int line_of(const struct eo_follow *follow, int k)
{
  return follow->place.first + k - follow->first_line;
}

static bool is_there(const struct eo_follow_place *place, int k)
{
  return isfinite(place->alike.reach[k]);
}

/* Gap of a pair in every cycle. */
static void set_apart(struct eo_follow *follow, int k)
{
  const struct eo_hunting_input *input = follow->input;
  double *apart = follow->apart + (size_t)line_of(follow, k) * (size_t)follow->cycles;
  if (follow->apart_known[line_of(follow, k)])
    return;
  follow->apart_known[line_of(follow, k)] = !follow->formed && is_there(&follow->place, k);
  memset(apart, 0, sizeof *apart * (size_t)follow->cycles);
  for (int member = 0; member < 2 && is_there(&follow->place, k); member++) {
    const struct eo_tooth_deviation *tooth = input->tooth[follow->end][member];
    int teeth = follow->teeth[member], number = wrap(-follow->place.first - k, teeth);
    if (!tooth)
      continue;
    struct eo_tooth_deviation unit = unit_gaps(follow, k, member);
    for (int i = 0; i < teeth; i++)
      follow->off[member][i] = unit.index * tooth[i].index + unit.profile_slope * tooth[i].profile_slope +
                               unit.helix_slope * tooth[i].helix_slope +
                               unit.profile_crowning * tooth[i].profile_crowning +
                               unit.lead_crowning * tooth[i].lead_crowning;
    for (int n = 0; n < follow->cycles; n++, number = number + 1 < teeth ? number + 1 : 0)
      apart[n] += follow->off[member][number];
  }
}

/* How far a solution is off what its neighbours let expect, m: its approach, and how that would answer to a tenth more
   of the load. */
static double off_of(const struct eo_follow *follow, const struct eo_course_state *found,
                     const struct eo_course_state *guess)
{
  double more = follow->input->load[follow->end] / 10;
  return fmax(fabs(found->approach - guess->approach), more * fabs(1 / found->tangent - 1 / guess->tangent));
}

/* Halves a stretch of a course, and its halves while what is half way is too far off what was expected. */
static void refine(struct eo_follow *follow, struct eo_tooth_course *course, double from, double to, int depth)
{
  double at = (from + to) / 2;
  struct eo_course_state guess;
  eo_tooth_course_find(course, 0, at, false, &guess);
  struct eo_course_state *state = eo_tooth_course_add(course, at);
  if (!state)
    return;
  move_pair(follow, course->mover, at);
  solve(follow, state);
  if (depth == 0 || off_of(follow, state, &guess) <= follow->within)
    return;
  refine(follow, course, at, to, depth - 1);
  refine(follow, course, from, at, depth - 1);
}

/* How far a pair is from the leader over the period, and nothing between. */
static void find_range(const struct eo_follow *follow, int k, double range[2])
{
  const double *apart = follow->apart + (size_t)line_of(follow, k) * (size_t)follow->cycles,
               *leader = follow->apart + (size_t)line_of(follow, follow->place.leader) * (size_t)follow->cycles;
  double low = 0, high = 0;
  for (int n = 0; n < follow->cycles; n++) {
    double from = apart[n] - leader[n];
    low = from < low ? from : low;
    high = from > high ? from : high;
  }
  range[0] = low;
  range[1] = high;
}

/* A pair carries, or would where it is nearest. */
static bool is_reached(int k, const struct eo_course_state *state, const double range[2])
{
  return range[1] > range[0] && state->reach[k] > range[0];
}

/* Where on the way back from the near end (0) or the far one the first pair touches that carries nothing there: another
   one, or the mover itself. The end where all carry; hardly as far as the middle. */
static double touch_of(const struct eo_course_state *state, int k, int side, double end, double middle)
{
  static const double HARDLY = 0.999;
  double most = side == 0 ? -INFINITY : state->reach[k], at, last = end + HARDLY * (middle - end);
  for (int other = 0; other < EO_COURSE_PAIRS && side == 0; other++)
    most = other != k ? fmax(most, state->reach[other]) : most;
  at = side == 0 ? end - fmin(0, most) : end + fmin(0, most);
  return side == 0 ? fmin(at, last) : fmax(at, last);
}

/* Solves one end of a course, where few are solved as the places before lead to. */
static void solve_end(struct eo_follow *follow, struct eo_tooth_course *course, int side, double at)
{
  struct eo_trail *trail = &follow->trail[2 * line_of(follow, course->mover) + side];
  if (isfinite(follow->within) || !eo_trail_lead(follow, trail))
    go_back(follow);
  move_pair(follow, course->mover, at);
  solve(follow, eo_tooth_course_add(course, at));
  eo_trail_add(follow, trail);
}

/* A pair that carries alone or nothing is moved while it does: nothing changes but that Z goes with the one that
   carries alone. */
static void move_state(struct eo_course_state *state, int mover, double by)
{
  double rise = state->share[mover] * by;
  state->approach += rise;
  for (int k = 0; k < EO_COURSE_PAIRS; k++)
    state->reach[k] += rise - (k == mover ? by : 0);
}

/* Puts what an outer node says where that begins. */
static void put_touch(struct eo_tooth_course *course, int node, double at)
{
  move_state(&course->state[node], course->mover, at - course->at[node]);
  course->at[node] = at;
}

/* Solves where a pair is nearest, farthest, and on the way as often as it takes; from a state in which it stands as it
   does without deviations. */
static void make_course(struct eo_follow *follow, struct eo_tooth_course *course, int k, const double range[2],
                        const struct eo_course_state *from)
{
  enum { DEPTH = 3 }; /* halves at most: as many nodes as there are */
  double middle = fmin(0, from->reach[k]);
  course->mover = k;
  course->nodes = 0;
  *eo_tooth_course_add(course, 0) = *from;
  memcpy(course->end, range, sizeof course->end);
  if (is_reached(k, from, range)) {
    put_touch(course, 0, middle);
    for (int i = 0; i < (middle < 0 ? 1 : 2); i++) { /* nothing changes behind where it touches */
      if (range[i] == 0)
        continue;
      solve_end(follow, course, i, range[i]);
      int node = i == 0 ? 0 : course->nodes - 1;
      double at = touch_of(&course->state[node], k, i, range[i], middle);
      put_touch(course, node, at);
      if (isfinite(follow->within))
        refine(follow, course, fmin(at, middle), fmax(at, middle), DEPTH);
    }
  }
  move_pair(follow, k, 0);
}

/* Of the second pair, with the first where its nodes are, but the outer ones where they were solved, so that what does
   not carry there does not touch while the second one moves. */
static void make_across(struct eo_follow *follow, const double range[2])
{
  struct eo_follow_place *place = &follow->place;
  const struct eo_tooth_course *first = &place->course[0];
  for (int i = 0; i < first->nodes; i++) {
    double at = i == 0 ? first->end[0] : i == first->nodes - 1 ? first->end[1] : first->at[i];
    struct eo_course_state from = first->state[i];
    move_state(&from, first->mover, at - first->at[i]);
    move_pair(follow, first->mover, at);
    make_course(follow, &place->across[i], place->course[1].mover, range, &from);
  }
  move_pair(follow, first->mover, 0);
}

/* Courses of the pairs that can carry beside the leader, those that carry more first. */
static void make_courses(struct eo_follow *follow)
{
  struct eo_follow_place *place = &follow->place;
  int mover[MOST], movers = 0;
  double range[MOST][2];
  for (int k = 0; k < place->pairs; k++) {
    find_range(follow, k, range[k]);
    if (k == place->leader || !is_reached(k, &place->alike, range[k]))
      continue;
    int i = movers++;
    for (; i > 0 && place->alike.load[mover[i - 1]] < place->alike.load[k]; i--)
      mover[i] = mover[i - 1];
    mover[i] = k;
  }
  place->courses = movers;
  place->crossed = movers > 1 && isfinite(follow->within);
  for (int i = 0; i < movers; i++)
    if (i != 1 || !place->crossed)
      make_course(follow, &place->course[i], mover[i], range[mover[i]], &place->alike);
    else
      place->course[i] = (struct eo_tooth_course){.mover = mover[i]};
  if (place->crossed)
    make_across(follow, range[mover[1]]);
}

void eo_follow_prepare(struct eo_follow *follow, int at)
{
  struct eo_follow_place *place = &follow->place;
  place->j = at * follow->step;
  number_pairs(place, position_of(follow));
  solve_alike(follow, at);
  if (follow->formed)
    weigh(follow);
  for (int k = 0; k < place->pairs; k++)
    set_apart(follow, k);
  make_courses(follow);
}

/* What a course adds where others have lifted Z by so much, which brings its pair as much nearer: theory (P6). */
static void add_course(const struct eo_follow *follow, const struct eo_tooth_course *course, double at, double lift,
                       bool loads, struct eo_course_state *state)
{
  struct eo_course_state from, to;
  int pairs = loads ? follow->place.pairs : 0;
  eo_tooth_course_find(course, pairs, -lift, loads, &from);
  eo_tooth_course_find(course, pairs, at - lift, loads, &to);
  state->approach += to.approach - from.approach;
  state->tangent += to.tangent - from.tangent;
  for (int k = 0; k < pairs; k++) {
    state->load[k] += to.load[k] - from.load[k];
    state->square[k] += to.square[k] - from.square[k];
  }
}

void eo_follow_find(const struct eo_follow *follow, int cycle, bool loads, struct eo_course_state *state)
{
  const struct eo_follow_place *place = &follow->place;
  const struct eo_tooth_course *first = &place->course[0];
  const double *apart = follow->apart + (size_t)line_of(follow, 0) * (size_t)follow->cycles + cycle;
  size_t cycles = (size_t)follow->cycles;
  double lead = apart[(size_t)place->leader * cycles],
         at = place->courses > 0 ? apart[(size_t)first->mover * cycles] - lead : 0;
  int pairs = loads || place->crossed ? place->pairs : 0;
  if (place->courses == 0)
    eo_course_state_copy(state, &place->alike, pairs, loads);
  else if (place->crossed)
    eo_tooth_course_cross(first, place->across, pairs, at, apart[(size_t)place->course[1].mover * cycles] - lead, loads,
                          state);
  else
    eo_tooth_course_find(first, pairs, at, loads, state);
  for (int c = place->crossed ? 2 : 1; c < place->courses; c++)
    add_course(follow, &place->course[c], apart[(size_t)place->course[c].mover * cycles] - lead,
               state->approach - place->alike.approach, loads, state);
  state->approach += lead;
}
