/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact of both ends of an axially held pinion. */
#include "contact/loaded.h"

#include <math.h>
#include <string.h>

/* Position j of an end that carries nothing. */
static void release_end(const struct eo_contact_grid *grid, int j, double approach, struct eo_loaded_end *end)
{
  const struct eo_contact_position *p = &grid->position[j];
  end->load[j] = end->tangent[j] = 0;
  end->approach[j] = approach;
  memset(end->line_load + p->first, 0, sizeof *end->line_load * (size_t)p->points);
}

static double least_gap(const struct eo_contact_grid *grid, const struct eo_loaded_gaps *gaps, int j)
{
  const struct eo_contact_position *p = &grid->position[j];
  double least = INFINITY;
  for (int i = 0; i < p->points; i++)
    least = fmin(least, gaps->gap[p->first + i]);
  return least;
}

/* One mesh position of both ends: P_L = P + shift, P_R = P - shift. Equilibrium of the pinion along its axis,
   Z_L - Z_R + shift 4 sin^2(beta_b)/k = 0, grows with the shift: Newton, kept between the shifts already known to be
   too small and too large. When even the whole load does not bring the other end into contact, that end carries
   nothing. */
static bool balance_position(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid,
                             const struct eo_loaded_gaps gaps[2], double factor, double soft, const int at[2],
                             double load, struct eo_loaded_end result[2])
{
  enum { STEPS = 60 };
  double shift = 0, bound[2] = {-load, load};
  bool tried[2] = {false, false};
  for (int i = 0; i < STEPS; i++) {
    double miss = result[0].approach[at[0]] - result[1].approach[at[1]] + soft * shift;
    double rate = 1 / result[0].tangent[at[0]] + 1 / result[1].tangent[at[1]] + soft, next = shift - miss / rate;
    int up = miss < 0, heavy = up ? EO_LEFT : EO_RIGHT, light = 1 - heavy;
    bound[1 - up] = shift;
    if (fabs(next - shift) < 1e-9 * load)
      return true;
    if (!(next > bound[0] && next < bound[1])) {
      if (fabs(bound[up]) == load && !tried[up]) {
        tried[up] = true;
        eo_loaded_resolve(ws, grid, gaps[heavy].gap, factor, at[heavy], 2 * load, &result[heavy]);
        double approach = result[heavy].approach[at[heavy]] + soft * load;
        if (approach <= least_gap(grid, &gaps[light], at[light])) {
          release_end(grid, at[light], approach, &result[light]);
          return true;
        }
      }
      next = (shift + bound[up]) / 2;
    }
    shift = next;
    eo_loaded_resolve(ws, grid, gaps[EO_LEFT].gap, factor, at[EO_LEFT], load + shift, &result[EO_LEFT]);
    eo_loaded_resolve(ws, grid, gaps[EO_RIGHT].gap, factor, at[EO_RIGHT], load - shift, &result[EO_RIGHT]);
  }
  return false;
}

void eo_loaded_balance(struct eo_loaded_workspace *workspace, const struct eo_contact_grid *grid,
                       const struct eo_loaded_gaps gaps[2], double compliance_factor, double stiffness, int stagger,
                       double load, struct eo_loaded_end result[2])
{
  double lean = sin(grid->geometry.base_helix_angle), soft = isinf(stiffness) ? 0 : 4 * lean * lean / stiffness;
  if (stiffness <= 0 || lean == 0)
    return;
  for (int j = 0; j < grid->positions; j++) {
    int at[2] = {j, (j + grid->positions - stagger % grid->positions) % grid->positions};
    result[EO_LEFT].failures += !balance_position(workspace, grid, gaps, compliance_factor, soft, at, load, result);
  }
}
