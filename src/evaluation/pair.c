/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/pair.h"

#include "base/clock.h"
#include "design/pair_identity.h"
#include "design/resolution.h"
#include "numerics/threads.h"

#include <math.h>
#include <stdlib.h>

/* By the trapezoidal rule. */
static double pitch_deflection(const struct eo_flexibility *flexibility, int member, double width)
{
  enum { STRETCHES = 56, POINTS = STRETCHES + 1 };
  struct eo_flank_point point[POINTS];
  double compliance[POINTS * POINTS] = {0}, sum = 0;
  for (int i = 0; i < POINTS; i++)
    point[i] = (struct eo_flank_point){0, {0, 0}, width * ((double)i / STRETCHES - 0.5)};
  eo_flexibility_add_compliance(flexibility, member, POINTS, point, compliance);
  for (int i = 0; i < POINTS; i++)
    sum += compliance[STRETCHES / 2 * POINTS + i] * width / STRETCHES * (i == 0 || i == STRETCHES ? 0.5 : 1);
  return sum;
}

static enum eo_code prepare_flexibility(struct eo_pair *pair, const struct eo_pair_options *options,
                                        const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&pair->resolution);
  EO_TRY(eo_flexibility_prepare(&pair->geometry, &pair->gear_pair, &pair->material, &settings, options->cache_directory,
                                progress, &pair->flexibility, error));
  pair->kernel = eo_flexibility_kernel(pair->flexibility);
  for (int member = 0; member < 2; member++) {
    pair->pitch_deflection[member] = pitch_deflection(pair->flexibility, member, pair->geometry.face_width);
    EO_TRY(eo_root_modes_new(&pair->root_modes[member], pair->flexibility, member, error));
  }
  return EO_OK;
}

static enum eo_code prepare(struct eo_pair *pair, const struct eo_pair_options *options,
                            const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_contact_grid_settings grid = options->grid ? *options->grid : eo_contact_grid_default(&pair->resolution);
  pair->kernel = options->kernel;
  if (!pair->kernel.evaluate)
    EO_TRY(prepare_flexibility(pair, options, progress, error));
  EO_TRY(eo_geometry_set_apart(&pair->geometry, &pair->gear_pair, pair->centre_distance_deviation, error));
  EO_TRY(eo_contact_grid_new(&pair->grid, &pair->geometry, &pair->material, &grid, options->phase, pair->kernel,
                             progress, error));
  for (int side = 0; side < 2; side++)
    pair->grid->corner[side].rule = options->tilt_rule;
  return pair->flexibility ? eo_root_tables_new(&pair->root, pair->grid, pair->root_modes, error) : EO_OK;
}

/* Half of the way of a preparation that makes both halves, one after the other. */
struct half_way {
  const struct eo_progress *whole;
  double from;
};

static int report_half(void *context, const char *what, double fraction)
{
  const struct half_way *way = context;
  return eo_progress_report(way->whole, what, way->from + fraction / 2);
}

static enum eo_code new_half(struct eo_pair **result, const struct eo_design *design,
                             const struct eo_pair_options *options, const struct eo_progress *progress,
                             struct eo_error *error);

/* The right half where it differs, at the phases that its helices have. */
static enum eo_code add_right_half(struct eo_pair *pair, const struct eo_design *design,
                                   const struct eo_pair_options *options, const struct eo_progress *progress,
                                   struct eo_error *error)
{
  struct eo_pair_options own = *options;
  const struct eo_geometry *geometry = &pair->geometry;
  int n = pair->grid->positions;
  double step = geometry->transverse_base_pitch / n, lag = eo_geometry_right_lead(geometry, &design->gear_pair),
         rest = lag - step * round(lag / step);
  struct eo_design *right = malloc(sizeof *right);
  double *phase = malloc(sizeof *phase * (size_t)n);
  enum eo_code code = right && phase ? EO_OK : eo_error_memory(error);
  if (!code) {
    for (int j = 0; j < n; j++)
      phase[j] = pair->grid->position[j].phase + rest;
    pair->ahead[0] = (int)lround((lag - rest) / step);
    pair->ahead[1] = (int)lround((-lag - rest) / step);
    *right = *design;
    right->gear_pair = eo_gear_pair_half(&design->gear_pair, EO_RIGHT);
    own.phase = phase;
    code = new_half(&pair->right, right, &own, progress, error);
  }
  free(right);
  free(phase);
  return code;
}

enum eo_code eo_pair_new(struct eo_pair **result, const struct eo_design *design, const struct eo_pair_options *options,
                         const struct eo_progress *progress, struct eo_error *error)
{
  if (!eo_gear_pair_is_uneven(&design->gear_pair))
    return new_half(result, design, options, progress, error);
  struct half_way way[2] = {{progress, 0}, {progress, 0.5}};
  const struct eo_progress half[2] = {{.report = report_half, .context = &way[0]},
                                      {.report = report_half, .context = &way[1]}};
  struct eo_pair *pair = NULL;
  EO_TRY(new_half(&pair, design, options, progress ? &half[0] : NULL, error));
  enum eo_code code = add_right_half(pair, design, options, progress ? &half[1] : NULL, error);
  if (code) {
    eo_pair_free(pair);
    return code;
  }
  pair->seconds += pair->right->seconds;
  *result = pair;
  return EO_OK;
}

/* Both halves, where they are alike. */
static enum eo_code new_half(struct eo_pair **result, const struct eo_design *design,
                             const struct eo_pair_options *options, const struct eo_progress *progress,
                             struct eo_error *error)
{
  double start = (1e-3 * eo_clock_milliseconds());
  eo_threads_limit();
  struct eo_pair *pair = calloc(1, sizeof *pair);
  if (!pair)
    return eo_error_memory(error);
  pair->gear_pair = design->gear_pair;
  pair->material = design->material;
  pair->resolution = design->resolution;
  pair->centre_distance_deviation = design->alignment.centre_distance_deviation;
  pair->impact = (struct eo_impact_settings){.patch = design->resolution.impact_patch,
                                             .stations = options->impact_stations};
  enum eo_code code = eo_geometry_init(&pair->geometry, &pair->gear_pair, error);
  if (!code) {
    eo_impact_inertia(&pair->geometry, &pair->material, pair->impact.inertia);
    code = prepare(pair, options, progress, error);
  }
  if (code) {
    eo_pair_free(pair);
    return code;
  }
  for (int end = 0; end < 2; end++)
    pair->pivot[end] = options->own_pivots || pair->gear_pair.ends == 1 ? 0
                                                                        : eo_gear_pair_mid_face(&pair->gear_pair, end);
  pair->seconds = (1e-3 * eo_clock_milliseconds()) - start;
  *result = pair;
  return EO_OK;
}

/* Phases stay: base pitches, face and helix on the base cylinder do. */
static enum eo_code set_apart(struct eo_pair *apart, const struct eo_pair *pair, double deviation, bool root,
                              struct eo_error *error)
{
  struct eo_contact_grid_settings settings = eo_contact_grid_default(&pair->resolution);
  int n = pair->grid->positions;
  EO_TRY(eo_geometry_init(&apart->geometry, &pair->gear_pair, error));
  EO_TRY(eo_geometry_set_apart(&apart->geometry, &pair->gear_pair, deviation, error));
  double *phase = malloc(sizeof *phase * (size_t)n);
  if (!phase)
    return eo_error_memory(error);
  for (int j = 0; j < n; j++)
    phase[j] = pair->grid->position[j].phase;
  enum eo_code code = eo_contact_grid_new(&apart->grid, &apart->geometry, &apart->material, &settings, phase,
                                          apart->kernel, NULL, error);
  free(phase);
  EO_TRY(code);
  for (int side = 0; side < 2; side++)
    apart->grid->corner[side].rule = pair->grid->corner[side].rule;
  for (int member = 0; member < 2 && root && pair->root; member++)
    EO_TRY(eo_root_modes_new(&apart->root_modes[member], pair->flexibility, member, error));
  if (apart->root_modes[EO_GEAR])
    EO_TRY(eo_root_tables_new(&apart->root, apart->grid, apart->root_modes, error)); /* which turns the modes */
  return pair->right ? eo_pair_apart(&apart->right, pair->right, deviation, root, error) : EO_OK;
}

enum eo_code eo_pair_apart(struct eo_pair **result, const struct eo_pair *pair, double deviation, bool root,
                           struct eo_error *error)
{
  struct eo_pair *apart = malloc(sizeof *apart);
  if (!apart)
    return eo_error_memory(error);
  *apart = *pair;
  apart->borrows = true;
  apart->centre_distance_deviation = deviation;
  apart->grid = NULL;
  apart->root = NULL;
  apart->root_modes[EO_PINION] = apart->root_modes[EO_GEAR] = NULL;
  apart->right = NULL;
  enum eo_code code = set_apart(apart, pair, deviation, root, error);
  if (code)
    eo_pair_free(apart);
  else
    *result = apart;
  return code;
}

void eo_pair_free(struct eo_pair *pair)
{
  if (!pair)
    return;
  eo_pair_free(pair->right);
  eo_root_tables_free(pair->root);
  eo_contact_grid_free(pair->grid);
  for (int member = 0; member < 2; member++)
    eo_root_modes_free(pair->root_modes[member]);
  if (!pair->borrows)
    eo_flexibility_free(pair->flexibility);
  free(pair);
}

struct eo_iso_stiffness_input eo_pair_iso_stiffness_input(const struct eo_pair *pair)
{
  const struct eo_gear_pair *gear_pair = &pair->gear_pair;
  return (struct eo_iso_stiffness_input){
      .teeth = {gear_pair->teeth[0], gear_pair->teeth[1]},
      .virtual_teeth = EO_ISO_VIRTUAL_CUBED,
      .normal_pressure_angle = gear_pair->normal_pressure_angle,
      .helix_angle = gear_pair->helix_angle,
      .profile_shift = {gear_pair->profile_shift[0], gear_pair->profile_shift[1]},
      .dedendum_coefficient = (eo_gear_pair_rack(gear_pair, EO_PINION).dedendum_coefficient +
                               eo_gear_pair_rack(gear_pair, EO_GEAR).dedendum_coefficient) /
                              2, /* ISO 6336-1 C_B of unlike racks: the mean */
      .transverse_contact_ratio = pair->geometry.transverse_contact_ratio,
      .blank_factor = 1,
      .theory_factor = 0.8, /* C_M of ISO 6336-1, solid discs measured against theory */
      .youngs_modulus = eo_material_mean_modulus(&pair->material)};
}

bool eo_pair_serves(const struct eo_pair *pair, const struct eo_design *design)
{
  struct eo_pair_identity own = eo_pair_identity_of(&pair->gear_pair, &pair->material, &pair->resolution,
                                                    pair->centre_distance_deviation),
                          asked = eo_pair_identity_of_design(design);
  return eo_pair_identity_equal(&own, &asked);
}
