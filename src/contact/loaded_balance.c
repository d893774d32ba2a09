/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact of both ends of an axially held pinion. */
#include "contact/loaded.h"

#include <math.h>
#include <string.h>

struct eo_double_helix eo_contact_double_helix(const struct eo_contact_grid *left, const struct eo_contact_grid *right)
{
  return eo_double_helix_of(left->geometry.base_helix_angle, right->geometry.base_helix_angle);
}

/* Position j of an end that carries nothing. */
static void release_end(const struct eo_contact_grid *grid, int j, double approach, struct eo_loaded_end *end)
{
  const struct eo_contact_position *position = &grid->position[j];
  end->load[j] = end->tangent[j] = 0;
  end->approach[j] = approach;
  memset(end->line_load + position->first, 0, sizeof *end->line_load * (size_t)position->points);
}

static double least_gap(const struct eo_loaded_half *half, int j)
{
  const struct eo_contact_position *position = &half->grid->position[j];
  double least = INFINITY;
  for (int i = 0; i < position->points; i++)
    least = fmin(least, half->gaps->gap[position->first + i]);
  return least;
}

static void resolve(const struct eo_loaded_half *half, double factor, int j, double load, struct eo_loaded_end *end)
{
  eo_loaded_resolve(half->workspace, half->grid, half->gaps->gap, factor, j, load, end);
}

double eo_axial_beyond_play(const struct eo_axial_hold *hold, double apart)
{
  return apart - fmax(-hold->play, fmin(hold->play, apart));
}

/* One mesh position of both ends: P'_L = P + shift, P'_R = P - shift (gear/double_helix.h). Equilibrium of the pinion
   along its axis, Z'_L - Z'_R (beyond the play between stops) + (shift - that of a floating pinion) (lean of both
   ends)^2/k = 0, grows with the shift: Newton, kept between the shifts already known to be too small and too large.
   When even the whole load does not bring the other end into contact, that end carries nothing. */
bool eo_loaded_balance_position(const struct eo_loaded_half half[2], double factor, const struct eo_axial_hold *hold,
                                const int at[2], double load, struct eo_loaded_end result[2])
{
  enum { STEPS = 60, LONG = 20 };
  static const double SOLVED = 1e-12; /* m, to which approaches are solved: what is left may never get smaller */
  const struct eo_double_helix helix = eo_contact_double_helix(half[EO_LEFT].grid, half[EO_RIGHT].grid);
  const double *scale = helix.scale;
  double lean = eo_double_helix_lean(&helix), soft = isinf(hold->stiffness) ? 0 : lean * lean / hold->stiffness;
  double shift = result[EO_LEFT].load[at[EO_LEFT]] - load, bound[2] = {-load, load};
  bool tried[2] = {false, false};
  for (int i = 0; i < STEPS; i++) {
    double apart = eo_axial_beyond_play(hold,
                                        result[0].approach[at[0]] - result[1].approach[at[1]] * scale[1] - hold->rest);
    double miss = apart + soft * (shift - hold->shift); /* theory (C6) */
    double give = hold->play > 0 && apart == 0
                      ? 0
                      : 1 / result[0].tangent[at[0]] + scale[1] * scale[1] / result[1].tangent[at[1]];
    double next = shift - miss / (give + soft);
    int up = miss < 0, heavy = up ? EO_LEFT : EO_RIGHT, light = 1 - heavy;
    bound[1 - up] = shift;
    if (fabs(next - shift) < 1e-9 * load || (i >= LONG && fabs(miss) < SOLVED))
      return true;
    if (!(next > bound[0] && next < bound[1])) {
      if (fabs(bound[up]) == load && !tried[up]) {
        tried[up] = true;
        resolve(&half[heavy], factor, at[heavy], 2 * load * scale[heavy], &result[heavy]);
        double beside = heavy == EO_LEFT ? load - hold->shift : load + hold->shift,
               rest = heavy == EO_LEFT ? -hold->rest : hold->rest,
               approach = (result[heavy].approach[at[heavy]] * scale[heavy] + hold->play + soft * beside + rest) /
                          scale[light];
        if (approach <= least_gap(&half[light], at[light])) {
          release_end(half[light].grid, at[light], approach, &result[light]);
          return true;
        }
      }
      next = (shift + bound[up]) / 2;
    }
    shift = next;
    resolve(&half[EO_LEFT], factor, at[EO_LEFT], load + shift, &result[EO_LEFT]);
    resolve(&half[EO_RIGHT], factor, at[EO_RIGHT], (load - shift) * scale[EO_RIGHT], &result[EO_RIGHT]);
  }
  return false;
}

void eo_loaded_balance(const struct eo_loaded_half half[2], double compliance_factor, const struct eo_axial_hold *hold,
                       int stagger, double load, struct eo_loaded_end result[2])
{
  int positions = half[EO_LEFT].grid->positions;
  if (hold->stiffness <= 0 || half[EO_LEFT].grid->geometry.base_helix_angle == 0)
    return;
  for (int j = 0; j < positions; j++) {
    int at[2] = {j, (j + positions - stagger % positions) % positions};
    result[EO_LEFT].failures += !eo_loaded_balance_position(half, compliance_factor, hold, at, load, result);
  }
}
