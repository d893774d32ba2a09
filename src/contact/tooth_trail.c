/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where solutions of courses begin: from the places before, which is so near that mostly one matrix does. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/tooth_courses_private.h"

static const struct eo_contact_position *position_of(const struct eo_follow *follow)
{
  return &follow->input->grid[follow->end]->position[follow->place.j];
}

static int leader_of(const struct eo_follow *follow)
{
  return follow->place.first + follow->place.leader;
}

/* Of the solution so many places before the one at hand. */
static int entry_of(const struct eo_trail *trail, int back)
{
  return (trail->at + 1 - back) % EO_HUNTING_BEFORE;
}

/* What lines of the same teeth carried goes on as it did, q = 3 q1 - 3 q2 + q3. */
bool eo_trail_lead(struct eo_follow *follow, const struct eo_trail *trail)
{
  const struct eo_contact_position *position = position_of(follow);
  int known = trail->leader == leader_of(follow) ? trail->known : 0, j = follow->place.j;
  double *load = follow->solved.line_load + position->first, z[EO_HUNTING_BEFORE] = {0};
  if (known == 0 || trail->at != j / follow->step - 1)
    return false;
  memset(load, 0, sizeof *load * (size_t)position->points);
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    const double *q[EO_HUNTING_BEFORE] = {NULL};
    for (int i = 0; i < known; i++) {
      const struct eo_contact_line *same = eo_contact_same_line(position - (i + 1) * follow->step, line);
      q[i] = same ? trail->load[entry_of(trail, i + 1)] + same->first : NULL;
    }
    for (int i = 0; q[0] && i < line->cells; i++)
      load[line->first + i] = fmax(0, q[1] && q[2] ? 3 * (q[0][i] - q[1][i]) + q[2][i]
                                      : q[1]       ? 2 * q[0][i] - q[1][i]
                                                   : q[0][i]);
  }
  for (int i = 0; i < known; i++)
    z[i] = trail->approach[entry_of(trail, i + 1)];
  follow->solved.approach[j] = known > 2 ? 3 * (z[0] - z[1]) + z[2] : known == 2 ? 2 * z[0] - z[1] : z[0];
  return true;
}

void eo_trail_add(const struct eo_follow *follow, struct eo_trail *trail)
{
  const struct eo_contact_position *position = position_of(follow);
  int at = follow->place.j / follow->step, entry = at % EO_HUNTING_BEFORE;
  bool goes_on = trail->known > 0 && trail->at == at - 1 && trail->leader == leader_of(follow);
  trail->known = goes_on ? trail->known + (trail->known < EO_HUNTING_BEFORE) : 1;
  trail->at = at;
  trail->leader = leader_of(follow);
  trail->approach[entry] = follow->solved.approach[follow->place.j];
  memcpy(trail->load[entry], follow->solved.line_load + position->first, sizeof(double) * (size_t)position->points);
}

bool eo_trails_init(struct eo_follow *follow, int points)
{
  int trails = 2 * follow->lines;
  follow->trail = calloc((size_t)trails, sizeof *follow->trail);
  follow->trail_room = calloc((size_t)trails * EO_HUNTING_BEFORE * (size_t)points, sizeof *follow->trail_room);
  for (int i = 0; follow->trail && follow->trail_room && i < trails * EO_HUNTING_BEFORE; i++)
    follow->trail[i / EO_HUNTING_BEFORE].load[i % EO_HUNTING_BEFORE] = follow->trail_room + (size_t)i * (size_t)points;
  return follow->trail && follow->trail_room;
}

void eo_trails_forget(struct eo_follow *follow)
{
  for (int i = 0; i < 2 * follow->lines; i++)
    follow->trail[i].known = 0;
}

void eo_trails_done(struct eo_follow *follow)
{
  free(follow->trail);
  free(follow->trail_room);
  follow->trail = NULL;
  follow->trail_room = NULL;
}
