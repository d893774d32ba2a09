/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stages of one flank: what a modification takes off it, and its exact surface. */
#include <math.h>

#include "reference/stage.h"
#include "reference/stage_input.h"
#include "gear/surface.h"

struct input {
  struct eo_design design;
  int member, end;
  struct eo_numbers s, u, eta, v;
};

/* The flank that was asked for. */
static enum eo_code find_shape(const struct input *given, struct eo_geometry *geometry,
                               struct eo_modification_shape *shape, struct eo_error *error)
{
  struct eo_design design = given->design;
  enum eo_code code = eo_stage_complete(&design, geometry, given->end, error);
  if (!code)
    eo_modification_init(shape, geometry, given->member, &design.modification.flank[given->member][given->end]);
  return code;
}

/* Either s or u states the places along the profile. */
static enum eo_code check_profile(const struct input *given, struct eo_error *error)
{
  if (given->s.count && given->u.count)
    return eo_error_set(error, EO_ERROR_INPUT, "/u_mm", "Places are given by s_mm or by u_mm, not by both.");
  if (!given->s.count && !given->u.count)
    return eo_error_set(error, EO_ERROR_INPUT, "/s_mm", "At least one place is needed, in s_mm or u_mm.");
  return EO_OK;
}

#define PLACES                                                                                                  \
  EO_STAGE_GEAR_PAIR(struct input), EO_STAGE_MODIFICATION(struct input), EO_STAGE_MEMBER(struct input, member), \
      EO_STAGE_END(struct input, end),                                                                          \
      EO_SERIES(struct input, s, "s_mm", &eo_unit_mm, EO_STAGE_MOST, -1e3, 1e3, 0,                              \
                "places: path coordinate from the pitch point, + to the pinion's tip"),                         \
      EO_SERIES(struct input, u, "u_mm", &eo_unit_mm, EO_STAGE_MOST, -1e3, 1e3, 0,                              \
                "instead of s_mm: profile coordinate, + to the member's own tip")

static const struct eo_field modification_input[] = {
    PLACES,
    EO_SERIES(
        struct input, eta, "eta_mm", &eo_unit_mm, EO_STAGE_MOST, -5e3, 5e3, 0,
        "places: axial from mid face, + on the side that meets first; as many as of s_mm or u_mm; empty: mid face"),
};
static const struct eo_table modification_input_table = EO_TABLE("the input", struct input, modification_input);

enum { U, X, DELTA, PROFILE, LEAD, SLOPE_BELOW, SLOPE_ABOVE, LEAD_SLOPE, MODIFICATION_COLUMNS };
struct modification_output {
  double lead_coefficient;
  struct eo_numbers column[MODIFICATION_COLUMNS];
};

static const struct eo_field modification_output[] = {
    EO_OUT(struct modification_output, lead_coefficient, "lead_crowning_per_um", &eo_unit_per_um,
           "a_l of the lead crowning"),
    EO_OUT_SERIES(struct modification_output, column[U], "u_mm", &eo_unit_mm,
                  "profile coordinate, + to the member's own tip"),
    EO_OUT_SERIES(struct modification_output, column[X], "x_mm", &eo_unit_mm, "lead coordinate eta / cos(beta)"),
    EO_OUT_SERIES(struct modification_output, column[DELTA], "delta_um", &eo_unit_um, "taken off, normal to the flank"),
    EO_OUT_SERIES(struct modification_output, column[PROFILE], "profile_um", &eo_unit_um, "its part d(u)"),
    EO_OUT_SERIES(struct modification_output, column[LEAD], "lead_um", &eo_unit_um, "its part l(x)"),
    EO_OUT_SERIES(struct modification_output, column[SLOPE_BELOW], "profile_slope_below", NULL,
                  "d delta / du just below u"),
    EO_OUT_SERIES(struct modification_output, column[SLOPE_ABOVE], "profile_slope_above", NULL,
                  "d delta / du just above u; differs at the kink of a linear relief"),
    EO_OUT_SERIES(struct modification_output, column[LEAD_SLOPE], "lead_slope", NULL, "d delta / dx"),
};
static const struct eo_table modification_output_table = EO_TABLE("the output", struct modification_output,
                                                                  modification_output);

static enum eo_code run_modification(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct modification_output *found = out;
  struct eo_geometry geometry;
  struct eo_modification_shape shape;
  bool by_path = given->s.count > 0;
  int rows = by_path ? given->s.count : given->u.count;
  EO_TRY(check_profile(given, error));
  if (given->eta.count)
    EO_TRY(eo_stage_same_length(by_path ? &given->s : &given->u, by_path ? "/s_mm" : "/u_mm", &given->eta, "/eta_mm",
                                error));
  EO_TRY(find_shape(given, &geometry, &shape, error));
  EO_TRY(eo_stage_columns(MODIFICATION_COLUMNS, found->column, rows, error));
  const struct eo_flank_modification *flank = &given->design.modification.flank[given->member][given->end];
  found->lead_coefficient = eo_modification_lead_coefficient(&geometry, flank->lead_crowning);
  for (int i = 0; i < rows; i++) {
    double u = by_path ? geometry.rack_factor * eo_geometry_own_path(given->member, given->s.value[i])
                       : given->u.value[i];
    double x = given->eta.count ? given->eta.value[i] / cos(geometry.helix_angle) : 0, slope[2], lead_slope;
    double profile = eo_modification_profile(&shape, u, slope), lead = eo_modification_lead(&shape, x, &lead_slope);
    const double row[MODIFICATION_COLUMNS] = {u, x, profile + lead, profile, lead, slope[0], slope[1], lead_slope};
    for (int k = 0; k < MODIFICATION_COLUMNS; k++)
      found->column[k].value[i] = row[k];
  }
  return EO_OK;
}

const struct eo_stage eo_stage_modification = {"modification",
                                               "what is taken off a flank at given places",
                                               &modification_input_table,
                                               &modification_output_table,
                                               true,
                                               run_modification};

static const struct eo_field surface_input[] = {
    PLACES,
    EO_SERIES(struct input, eta, "eta_mm", &eo_unit_mm, EO_STAGE_MOST, -5e3, 5e3, 0,
              "with s_mm: axial from mid face, + on the side that meets first; as many as of s_mm; empty: mid face"),
    EO_SERIES(struct input, v, "v_mm", &eo_unit_mm, EO_STAGE_MOST, -1e4, 1e4, 0,
              "with u_mm: along the trace of the generating rack; as many as of u_mm"),
};
static const struct eo_table surface_input_table = EO_TABLE("the input", struct input, surface_input);

enum { SURFACE_U, SURFACE_V, POSITION, NORMAL = POSITION + 3, ROLL = NORMAL + 3, SURFACE_COLUMNS };
struct surface_output {
  struct eo_numbers column[SURFACE_COLUMNS];
};

static const struct eo_field surface_output[] = {
    EO_OUT_SERIES(struct surface_output, column[SURFACE_U], "u_mm", &eo_unit_mm,
                  "profile coordinate, + to the member's own tip"),
    EO_OUT_SERIES(struct surface_output, column[SURFACE_V], "v_mm", &eo_unit_mm, "along the rack's trace"),
    EO_OUT_SERIES(struct surface_output, column[POSITION], "position_x_mm", &eo_unit_mm,
                  "tangential, in the pinion's direction of motion, against the gear's; right hand of the pair, the "
                  "left end is its mirror image"),
    EO_OUT_SERIES(struct surface_output, column[POSITION + 1], "position_y_mm", &eo_unit_mm,
                  "radial, through the pitch point at roll 0"),
    EO_OUT_SERIES(struct surface_output, column[POSITION + 2], "position_z_mm", &eo_unit_mm,
                  "along the axis from mid face: with eta on the pinion, against it on the gear"),
    EO_OUT_SERIES(struct surface_output, column[NORMAL], "normal_x", NULL, "unit normal, out of the tooth"),
    EO_OUT_SERIES(struct surface_output, column[NORMAL + 1], "normal_y", NULL, "likewise"),
    EO_OUT_SERIES(struct surface_output, column[NORMAL + 2], "normal_z", NULL, "likewise"),
    EO_OUT_SERIES(struct surface_output, column[ROLL], "roll_deg", &eo_unit_deg, "generating roll angle"),
};
static const struct eo_table surface_output_table = EO_TABLE("the output", struct surface_output, surface_output);

static enum eo_code check_places(const struct input *given, struct eo_error *error)
{
  enum eo_code code = check_profile(given, error);
  if (code)
    return code;
  if (given->u.count)
    return eo_stage_same_length(&given->u, "/u_mm", &given->v, "/v_mm", error);
  return given->eta.count ? eo_stage_same_length(&given->s, "/s_mm", &given->eta, "/eta_mm", error) : EO_OK;
}

static enum eo_code run_surface(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct surface_output *found = out;
  struct eo_geometry geometry;
  struct eo_modification_shape shape;
  int rows = given->s.count ? given->s.count : given->u.count;
  enum eo_code code = check_places(given, error);
  if (!code)
    code = find_shape(given, &geometry, &shape, error);
  if (!code)
    code = eo_stage_columns(SURFACE_COLUMNS, found->column, rows, error);
  for (int i = 0; i < rows && !code; i++) {
    struct eo_surface_point surface_point;
    double u, v;
    if (given->s.count)
      eo_surface_coordinates(&geometry, given->member, given->s.value[i], given->eta.count ? given->eta.value[i] : 0,
                             &u, &v);
    else {
      u = given->u.value[i];
      v = given->v.value[i];
    }
    eo_surface_evaluate(&geometry, given->member, &shape, u, v, &surface_point);
    found->column[SURFACE_U].value[i] = u;
    found->column[SURFACE_V].value[i] = v;
    found->column[ROLL].value[i] = surface_point.roll;
    for (int k = 0; k < 3; k++) {
      found->column[POSITION + k].value[i] = surface_point.position[k];
      found->column[NORMAL + k].value[i] = surface_point.normal[k];
    }
  }
  return code;
}

const struct eo_stage eo_stage_surface = {
    "surface", "exact points and normals of a flank", &surface_input_table, &surface_output_table, true, run_surface};
