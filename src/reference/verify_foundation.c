/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Teeth on an uncoupled elastic foundation, where the loaded contact has closed-form answers. The solver is the one
   that analyses designs; only the compliance is prescribed, and the local approach made a hundred thousand times
   stiffer than steel's so that it does not count. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/verify_foundation.h"
#include "contact/loaded.h"

/* Every cell on a spring of its own: stiffness per face width times the width of the cell. */
static void foundation(const void *context, int n, const struct eo_flank_point *point, double *compliance)
{
  double stiffness = *(const double *)context;
  memset(compliance, 0, sizeof *compliance * (size_t)n * (size_t)n);
  for (int i = 0; i < n; i++) {
    int next = i + 1 < n && point[i + 1].pair == point[i].pair ? i + 1 : i - 1; /* cells of a line are equal */
    compliance[(size_t)i * (size_t)(n + 1)] = 1 / (stiffness * fabs(point[next].eta - point[i].eta));
  }
}

struct rig {
  struct eo_contact_grid *grid;
  struct eo_loaded_gaps gaps;
  struct eo_loaded_end end;
  struct eo_loaded_workspace *workspace;
};

static void done(struct rig *rig)
{
  eo_loaded_workspace_free(rig->workspace);
  eo_loaded_end_done(&rig->end);
  eo_loaded_gaps_done(&rig->gaps);
  eo_contact_grid_free(rig->grid);
}

/* phase: [positions]. */
static enum eo_code init(struct rig *rig, const struct eo_geometry *geometry, int positions, int cells,
                         const double *phase, const double *stiffness, struct eo_error *error)
{
  const struct eo_material rigid = {.youngs_modulus = 206e14, .poissons_ratio = 0.3};
  const struct eo_contact_grid_settings settings = {.positions = positions, .cells = cells, .edge_reach = NAN};
  const struct eo_kernel kernel = {foundation, stiffness};
  *rig = (struct rig){0};
  EO_TRY(eo_contact_grid_new(&rig->grid, geometry, &rigid, &settings, phase, kernel, NULL, error));
  EO_TRY(eo_loaded_gaps_init(&rig->gaps, rig->grid, error));
  EO_TRY(eo_loaded_end_init(&rig->end, rig->grid, error));
  return eo_loaded_workspace_new(&rig->workspace, rig->grid, error);
}

static enum eo_code solve(struct rig *rig, double load, struct eo_error *error)
{
  eo_loaded_solve(rig->workspace, rig->grid, &rig->gaps, 1, 1, &load, &rig->end);
  int failures = rig->end.failures;
  return failures ? eo_error_set(error, EO_ERROR_NUMERIC, "", "The loaded contact did not converge at %d positions.",
                                 failures)
                  : EO_OK;
}

/* A spur pair with one pair of teeth in contact at the pitch point. */
static enum eo_code spur_geometry(struct eo_geometry *geometry, double face_width, struct eo_error *error)
{
  struct eo_gear_pair pair = {.ends = 1,
                              .teeth = {25, 40},
                              .normal_module = 4e-3,
                              .normal_pressure_angle = 20 * M_PI / 180,
                              .face_width = face_width,
                              .addendum_coefficient = 1,
                              .dedendum_coefficient = 1.25,
                              .fillet_radius_coefficient = 0.38,
                              .centre_distance = NAN,
                              .tip_diameter = {NAN, NAN},
                              .backlash = 1e-4};
  return eo_geometry_init(geometry, &pair, error);
}

/* Load per face width at the face end that comes first into contact: the cells hold their mean, the distribution is
   linear. */
static double edge_load(const struct rig *rig)
{
  const double *q = rig->end.line_load;
  return q[0] + (q[0] - q[1]) / 2;
}

enum { SPUR_CELLS = 160 };

/* One pair of spur teeth, one position, springs all alike; the shafts are out of line by so much over the face. */
static enum eo_code lean(struct rig *rig, double face_width, double stiffness, double line_load, double misalignment,
                         struct eo_error *error)
{
  const double phase = 0;
  struct eo_geometry geometry;
  EO_TRY(spur_geometry(&geometry, face_width, error));
  EO_TRY(init(rig, &geometry, 1, SPUR_CELLS, &phase, &stiffness, error));
  if (rig->grid->points != SPUR_CELLS)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "More than one pair of teeth is in contact at the pitch point.");
  for (int i = 0; i < SPUR_CELLS; i++)
    rig->gaps.gap[i] = misalignment * (rig->grid->position[0].point[i].eta / face_width + 0.5);
  return solve(rig, line_load * face_width, error);
}

enum eo_code eo_verify_load_distribution(double stiffness, double line_load, double misalignment, double *factor,
                                         struct eo_error *error)
{
  struct rig rig = {0};
  enum eo_code code = lean(&rig, 40e-3, stiffness, line_load, misalignment, error);
  if (!code)
    *factor = edge_load(&rig) / line_load;
  done(&rig);
  return code;
}

/* Mesh positions as far as can be from those at which a contact line enters or leaves: springs of a vanishing line's
   cells would be soft beyond measure. In base pitches, lines enter at s_A less the lean of the line, and leave
   eps_alpha later (eps_beta is whole). */
static void spread_positions(const struct eo_geometry *geometry, int positions, double *phase)
{
  double step = 1. / positions, leave = fmod(geometry->transverse_contact_ratio, step);
  double offset = leave > step / 2 ? leave / 2 : (leave + step) / 2;
  double enter = geometry->path_start / geometry->transverse_base_pitch - geometry->overlap_ratio / 2;
  for (int i = 0; i < positions; i++) {
    double place = enter + offset + i * step;
    phase[i] = geometry->transverse_base_pitch * (place - floor(place));
  }
}

enum eo_code eo_verify_overlap(const struct eo_geometry *geometry, double *peak_to_peak, double *length_variation,
                               struct eo_error *error)
{
  enum { POSITIONS = 16, CELLS = 20 };
  const double stiffness = 15e9, load = 300e3 * geometry->face_width;
  double phase[POSITIONS], low = INFINITY, high = -INFINITY, shortest = INFINITY, longest = 0;
  struct rig rig = {0};
  spread_positions(geometry, POSITIONS, phase);
  enum eo_code code = init(&rig, geometry, POSITIONS, CELLS, phase, &stiffness, error);
  if (!code)
    code = solve(&rig, load, error);
  for (int i = 0; i < POSITIONS && !code; i++) {
    double length = 0, deflection = rig.end.approach[i] / cos(geometry->base_helix_angle);
    for (int k = 0; k < rig.grid->position[i].points; k++)
      length += rig.grid->position[i].length[k];
    low = fmin(low, deflection);
    high = fmax(high, deflection);
    shortest = fmin(shortest, length);
    longest = fmax(longest, length);
  }
  *peak_to_peak = high - low;
  *length_variation = longest / shortest - 1;
  done(&rig);
  return code;
}
