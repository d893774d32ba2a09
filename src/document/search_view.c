/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/search_view.h"

#include <math.h>

enum { PROFILE = 9, FACE = 3 };

/* Both flanks that meet there, at the points of a grid over the field of contact; returns where the next ones go. */
static double *see_flanks(const struct eo_search_view *view, const struct eo_flank_modification *const flank[2],
                          double *seen)
{
  const struct eo_geometry *geometry = view->geometry;
  struct eo_modification_shape shape[2];
  for (int member = 0; member < 2; member++) {
    eo_modification_init(&shape[member], geometry, member, flank[member]);
    eo_modification_complete(&shape[member], NULL, false);
  }
  for (int j = 0; j < FACE; j++) {
    struct eo_modification_shape slice[2];
    const double eta = geometry->face_width * (j / (FACE - 1.) - 0.5);
    for (int member = 0; member < 2; member++)
      eo_modification_slice(&shape[member], eta, &slice[member]);
    for (int i = 0; i < PROFILE; i++) {
      const double s = geometry->path_start + (geometry->path_end - geometry->path_start) * i / (PROFILE - 1.);
      double gap = 0, slope[2];
      for (int member = 0; member < 2; member++)
        gap += eo_modification_profile(&slice[member], geometry->rack_factor * eo_geometry_own_path(member, s), slope) +
               eo_modification_lead(&slice[member], eta * slice[member].lengthen, slope);
      *seen++ = gap / (view->depth + fabs(gap)); /* theory (H8) */
    }
  }
  return seen;
}

static void see(void *context, const double *x, double *seen)
{
  struct eo_search_view *view = context;
  eo_study_space_apply(view->space, view->base, x, &view->modification);
  const struct eo_modification *modification = &view->modification;
  for (int end = 0; end < view->ends; end++)
    for (int side = 0; side < view->sides; side++)
      seen = see_flanks(view,
                        (const struct eo_flank_modification *const[2]){
                            side ? &modification->coast[EO_PINION][end] : &modification->flank[EO_PINION][end],
                            side ? &modification->coast[EO_GEAR][end] : &modification->flank[EO_GEAR][end]},
                        seen);
}

/* What the teeth give under the largest torque, by the stiffness c_gamma = 20 N/(mm um) that ISO 6336-1 takes for
   steel. */
static double depth_of(const struct eo_design *design, const struct eo_geometry *geometry)
{
  const double steel = 206e9, stiffness = 20e9 * design->material.youngs_modulus / steel; /* Pa */
  double torque = 0;
  for (int k = 0; k < design->load_cases; k++)
    torque = fmax(torque, fabs(design->load_case[k].torque));
  return torque / (design->gear_pair.ends * geometry->base_radius[EO_PINION] * geometry->face_width * stiffness);
}

struct eo_view eo_search_view_init(struct eo_search_view *search_view, const struct eo_design *design,
                                   const struct eo_study_space *space, const struct eo_geometry *geometry)
{
  *search_view = (struct eo_search_view){.space = space,
                                         .base = &design->modification,
                                         .geometry = geometry,
                                         .ends = design->gear_pair.ends,
                                         .sides = 1,
                                         .depth = depth_of(design, geometry)};
  for (int i = 0; i < space->count; i++)
    if (space->variable[i].side == EO_COAST_FLANK)
      search_view->sides = 2;
  const bool bends = search_view->depth > 0 && isfinite(search_view->depth);
  return (struct eo_view){bends ? search_view->ends * search_view->sides * PROFILE * FACE : 0, see, search_view};
}
