/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/face_load.h"

#include <math.h>

/* Of two numbers, none of them NaN. */
static inline double larger(double a, double b)
{
  return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
  return a < b ? a : b;
}

/* Adds a force that lies evenly between two places, in slices from the face end on, to the slices it covers; what hangs
   over a face end counts in the last slice. */
static void spread(struct eo_face_load *face, double from, double to, double force)
{
  static const double LEAST = 1e-9; /* of a slice */
  from = smaller(larger(from, 0), EO_FACE_SLICES - LEAST);
  to = smaller(larger(to, from + LEAST), EO_FACE_SLICES);
  double per_slice = force / (to - from);
  int first = (int)from, last = smaller(to, EO_FACE_SLICES - 1) > first ? (int)smaller(to, EO_FACE_SLICES - 1) : first;
  for (int i = first; i <= last; i++)
    face->load[i] += per_slice * (smaller(to, i + 1) - larger(from, i));
}

/* What one mesh position adds: forces to the slices, lengths of its lines, the largest load of a pair on the real
   flanks and on flanks that share evenly. */
struct sums {
  double force, length, line_load;
  double pair, even_pair; /* shares of the end's load */
};

/* Load of the pair that line number `first` begins, over all its lines; 0 when an earlier line has counted it. */
static double pair_load(const struct eo_contact_position *position, const double *line_load, int first)
{
  double sum = 0;
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    if (line->pair != position->line[first].pair)
      continue;
    if (l < first)
      return 0;
    for (int i = line->first; i < line->first + line->cells; i++)
      sum += line_load[i] * position->length[i];
  }
  return sum;
}

static void add_position(struct eo_face_load *face, struct sums *sums, const struct eo_contact_grid *grid,
                         const struct eo_loaded_end *end, int position)
{
  const struct eo_contact_position *contact_position = &grid->position[position];
  const double *line_load = end->line_load + contact_position->first;
  double slices = EO_FACE_SLICES / grid->geometry.face_width, lines = 0, longest = 0, heaviest = 0;
  double half = cos(grid->geometry.base_helix_angle) * slices / 2;
  for (int i = 0; i < contact_position->points; i++) {
    if (line_load[i] == 0)
      continue;
    double force = line_load[i] * contact_position->length[i],
           middle = contact_position->point[i].eta * slices + EO_FACE_SLICES / 2.0,
           reach = contact_position->length[i] * half;
    spread(face, middle - reach, middle + reach, force);
    sums->force += force;
    sums->line_load = larger(sums->line_load, line_load[i]);
  }
  for (int l = 0; l < contact_position->lines; l++) {
    double length = 0;
    for (int i = contact_position->line[l].first; i < contact_position->line[l].first + contact_position->line[l].cells;
         i++)
      length += contact_position->line[l].kind == EO_POINT_LINE ? contact_position->length[i] : 0;
    lines += length;
    longest = fmax(longest, length);
    heaviest = fmax(heaviest, pair_load(contact_position, line_load, l));
  }
  sums->length += lines;
  if (lines > 0)
    sums->even_pair = fmax(sums->even_pair, longest / lines);
  if (end->load[position] > 0)
    sums->pair = fmax(sums->pair, heaviest / end->load[position]);
}

void eo_face_load_find(struct eo_face_load *face, const struct eo_contact_grid *grid, const struct eo_loaded_end *end)
{
  double slice = grid->geometry.face_width / EO_FACE_SLICES, most = 0;
  struct sums sums = {0};
  *face = (struct eo_face_load){.face_factor = NAN, .share_factor = NAN, .line_factor = NAN};
  for (int i = 0; i < EO_FACE_SLICES; i++)
    face->eta[i] = (i + 0.5) * slice - grid->geometry.face_width / 2;
  for (int j = 0; j < grid->positions; j++)
    add_position(face, &sums, grid, end, j);
  for (int i = 0; i < EO_FACE_SLICES; i++) {
    face->load[i] /= grid->positions * slice;
    most = fmax(most, face->load[i]);
  }
  if (!(sums.force > 0))
    return;
  face->face_factor = most * grid->geometry.face_width * grid->positions / sums.force; /* theory (W1) */
  face->share_factor = fmax(1, sums.pair / sums.even_pair);                            /* theory (W2) */
  face->line_factor = sums.line_load * sums.length / sums.force;
}
