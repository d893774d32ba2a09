#include "contact/root.h"

#include <math.h>
#include <stdlib.h>

enum eo_code eo_root_history_init(struct eo_root_history *history, const struct eo_contact_grid *grid, struct eo_error *error)
{
  int range[2];
  eo_contact_grid_pairs(grid, range);
  size_t most = (size_t)((range[1] - range[0] + 1) * grid->positions);
  *history = (struct eo_root_history){.phase = calloc(most, sizeof(double)), .stress = calloc(most, sizeof(double))};
  if (history->phase && history->stress)
    return EO_OK;
  eo_root_history_done(history);
  return eo_error_memory(error);
}

void eo_root_history_done(struct eo_root_history *history)
{
  free(history->phase);
  free(history->stress);
  *history = (struct eo_root_history){0};
}

enum { MOST_POINTS = 4096 };

/* The first root point at or below the 30 degree tangent, ISO 6336-3's critical section. Above it the surface feels the dent of a
   contact close by, which the mesh of the root does not resolve, more than the bending of the tooth. */
static int critical_section(const struct eo_root *root)
{
  int i = root->first > 1 ? root->first : 1;
  for (; i < root->points - 2; i++) {
    const double *before = root->position + 2 * (i - 1), *after = root->position + 2 * (i + 1);
    if (fabs(after[0] - before[0]) >= tan(M_PI / 6) * fabs(after[1] - before[1]))
      break;
  }
  return i;
}

/* Largest principal stress in one root, from a point of it inwards, under the loads of one position. */
static double root_stress(const struct eo_flexibility *flexibility, int member, const struct eo_root *root, int from,
                          const struct eo_contact_position *p, int tooth, const double *line_load, double *stress, double *arc, double *eta)
{
  struct eo_flank_point point[MOST_POINTS];
  double force[MOST_POINTS], largest = 0;
  int loaded = 0;
  for (int i = 0; i < p->points && loaded < MOST_POINTS; i++)
    if (line_load[i] > 0) {
      point[loaded] = p->point[i];
      force[loaded++] = line_load[i] * p->length[i];
    }
  eo_flexibility_root_stress(flexibility, member, tooth, loaded, point, force, from, root->points, stress);
  for (int i = 0; i < root->points - from; i++)
    for (int layer = 0; layer <= root->layers; layer++) {
      double s = eo_stress_principal(stress + (i * (root->layers + 1) + layer) * EO_STRESSES);
      if (s > largest) {
        largest = s;
        *arc = root->arc[from + i];
        *eta = root->width * ((double)layer / root->layers - 0.5);
      }
    }
  return largest;
}

void eo_root_history_compute(struct eo_root_history *history, const struct eo_flexibility *flexibility, int member,
                             const struct eo_contact_grid *grid, const struct eo_loaded_end *end, int step)
{
  struct eo_root root = eo_flexibility_root(flexibility, member);
  double *stress = malloc(sizeof *stress * (size_t)(root.points * (root.layers + 1) * EO_STRESSES));
  int range[2], from = critical_section(&root);
  eo_contact_grid_pairs(grid, range);
  history->phases = 0;
  history->maximum = 0;
  for (int tooth = range[0]; stress && tooth <= range[1]; tooth++)
    for (int j = 0; j < grid->positions; j += step) {
      const struct eo_contact_position *p = &grid->position[j];
      double arc = 0, eta = 0, s = root_stress(flexibility, member, &root, from, p, tooth, end->line_load + p->first, stress, &arc, &eta);
      history->phase[history->phases] = p->phase / grid->geometry.transverse_base_pitch + tooth;
      history->stress[history->phases++] = s;
      if (s > history->maximum) {
        history->maximum = s;
        history->arc = arc;
        history->eta = eta;
      }
    }
  free(stress);
}
