/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/grid.h"

#include "numerics/gram.h"
#include "numerics/lowrank.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* (1 - nu^2)/(pi E) of a member: its share of what a line load brings the members together. */
static double local_compliance(const struct eo_material *material)
{
  return (1 - material->poissons_ratio * material->poissons_ratio) / (M_PI * material->youngs_modulus);
}

/* Weber and Banaschek's members one by one: A_i q (2 ln(2 h_i/b) - nu_i/(1 - nu_i)), b^2 = 4 q rho (A_1 + A_2). */
static double unlike_constant(const struct eo_geometry *geometry, const struct eo_material *material, double s)
{
  double compliance[2], sum = 0, constant = 0;
  for (int i = 0; i < 2; i++) {
    struct eo_material own = eo_material_of(material, i);
    sum += compliance[i] = local_compliance(&own);
    constant += compliance[i] *
                (2 * log(2 * eo_geometry_depth(geometry, i, s)) - own.poissons_ratio / (1 - own.poissons_ratio));
  }
  return constant / sum - log(4 * eo_geometry_relative_radius(geometry, s) * sum);
}

double eo_contact_local_constant(const struct eo_geometry *geometry, const struct eo_material *material, double s)
{
  if (!eo_material_is_one(material))
    return unlike_constant(geometry, material, s);
  double nu = material->poissons_ratio, modulus = material->youngs_modulus / (1 - nu * nu);
  double depth = eo_geometry_depth(geometry, EO_PINION, s) * eo_geometry_depth(geometry, EO_GEAR, s);
  return log(4 * depth * M_PI * modulus / (8 * eo_geometry_relative_radius(geometry, s))) -
         nu / (1 - nu); /* theory (C2) */
}

/* The stretches of s that carry points: the path of contact, then the two corners. */
struct stretch {
  double low, high;
  int cells;
  enum eo_point_kind kind;
};

static int list_stretches(const struct eo_geometry *geometry, const struct eo_contact_grid_settings *settings,
                          struct stretch stretch[3])
{
  double reach = isnan(settings->edge_reach) ? geometry->normal_module * 4 / 15 : settings->edge_reach;
  stretch[0] = (struct stretch){geometry->path_start, geometry->path_end, settings->cells, EO_POINT_LINE};
  stretch[1] = (struct stretch){geometry->path_start - reach, geometry->path_start, settings->edge_cells,
                                EO_POINT_GEAR_TIP};
  stretch[2] = (struct stretch){geometry->path_end, geometry->path_end + reach, settings->edge_cells,
                                EO_POINT_PINION_TIP};
  return settings->tip_edges ? 3 : 1;
}

/* Pairs whose contact line can cross [low, high] anywhere on the face. */
static void pair_range(const struct eo_geometry *geometry, double phase, const struct stretch *stretch, int range[2])
{
  double lean = geometry->face_width / 2 * tan(geometry->base_helix_angle);
  range[0] = (int)floor((stretch->low - lean - phase) / geometry->transverse_base_pitch);
  range[1] = (int)ceil((stretch->high + lean - phase) / geometry->transverse_base_pitch);
}

static int count_points(const struct eo_geometry *geometry, double phase, const struct stretch *stretch, int stretches,
                        int *lines)
{
  int count = 0;
  *lines = 0;
  for (int i = 0; i < stretches; i++) {
    int range[2];
    double eta[2];
    pair_range(geometry, phase, &stretch[i], range);
    for (int k = range[0]; k <= range[1]; k++)
      if (eo_gap_field_line_range(geometry, phase + k * geometry->transverse_base_pitch, stretch[i].low,
                                  stretch[i].high, eta)) {
        count += stretch[i].cells;
        ++*lines;
      }
  }
  return count;
}

static enum eo_code allocate_position(struct eo_contact_position *position, struct eo_error *error)
{
  size_t n = (size_t)position->points;
  position->line = calloc((size_t)position->lines, sizeof *position->line);
  position->point = calloc(n, sizeof *position->point);
  position->path = calloc(n, sizeof *position->path);
  position->kind = calloc(n, sizeof *position->kind);
  position->length = calloc(n, sizeof *position->length);
  position->law = calloc(n, sizeof *position->law);
  position->per_depth = calloc(n, sizeof *position->per_depth);
  position->strength = calloc(n, sizeof *position->strength);
  position->radius = calloc(n, sizeof *position->radius);
  return position->line && position->point && position->path && position->kind && position->length && position->law &&
                 position->per_depth && position->strength && position->radius
             ? EO_OK
             : eo_error_memory(error);
}

static void fill_line(struct eo_contact_position *position, int first, const struct eo_gap_field *field,
                      const struct eo_material *material, const struct stretch *stretch, int pair, const double eta[2])
{
  const struct eo_geometry *geometry = field->geometry;
  double tangent = tan(geometry->base_helix_angle), width = (eta[1] - eta[0]) / stretch->cells;
  for (int i = 0; i < stretch->cells; i++) {
    struct eo_flank_point *point = &position->point[first + i];
    point->pair = pair;
    point->eta = eta[0] + (i + 0.5) * width;
    /* theory (Y1) */
    double s = position->phase + pair * geometry->transverse_base_pitch + point->eta * tangent,
           clamped = fmin(fmax(s, geometry->path_start), geometry->path_end);
    eo_gap_field_at(field, s, point->eta, NULL, point->s);
    for (int member = 0; member < 2; member++)
      point->s[member] = eo_geometry_drawn_path(geometry, member, point->s[member]);
    position->path[first + i] = s;
    position->kind[first + i] = stretch->kind;
    position->length[first + i] = width / cos(geometry->base_helix_angle);
    position->law[first + i] = eo_contact_local_constant(geometry, material, clamped);
    position->radius[first + i] = eo_geometry_relative_radius(geometry, clamped);
  }
}

/* The local law as the table of its inverse takes it. */
static void scale_law(struct eo_contact_position *position, double compliance_scale)
{
  for (int i = 0; i < position->points; i++) {
    position->per_depth[i] = exp(-position->law[i]) / compliance_scale;
    position->strength[i] = exp(position->law[i]) * position->length[i];
  }
}

static enum eo_code fill_position(struct eo_contact_position *position, const struct eo_gap_field *field,
                                  const struct eo_material *material, const struct stretch *stretch, int stretches,
                                  struct eo_error *error)
{
  const struct eo_geometry *geometry = field->geometry;
  position->points = count_points(geometry, position->phase, stretch, stretches, &position->lines);
  enum eo_code code = allocate_position(position, error);
  int filled = 0, lines = 0;
  for (int i = 0; i < stretches && !code; i++) {
    int range[2];
    double eta[2];
    pair_range(geometry, position->phase, &stretch[i], range);
    for (int k = range[0]; k <= range[1]; k++)
      if (eo_gap_field_line_range(geometry, position->phase + k * geometry->transverse_base_pitch, stretch[i].low,
                                  stretch[i].high, eta)) {
        position->line[lines++] = (struct eo_contact_line){k, stretch[i].kind, filled, stretch[i].cells};
        fill_line(position, filled, field, material, &stretch[i], k, eta);
        filled += stretch[i].cells;
      }
  }
  return code;
}

/* The few strongest modes carry Newton's matrix; what they leave, the rounding of the modes included, is added back as
   a correction, so the compliance is exact. */
static enum eo_code factor_position(struct eo_contact_position *position, struct eo_kernel kernel, double *compliance,
                                    struct eo_error *error)
{
  static const double TOLERANCE = 5e-3;
  size_t n = (size_t)position->points;
  double *factor = NULL;
  int stride = 0;
  kernel.evaluate(kernel.context, position->points, position->point, compliance);
  enum eo_code code = eo_lowrank_factor(position->points, compliance, TOLERANCE, &position->rank, &stride, &factor,
                                        error);
  if (code)
    return code;
  position->stride = eo_gram_width(position->rank - (position->rank > 0));
  position->factor = eo_gram_allocate((long)position->points * position->stride / 2);
  position->remainder_stride = (position->points + EO_GRAM_FLOATS - 1) / EO_GRAM_FLOATS * EO_GRAM_FLOATS;
  position->remainder = eo_gram_allocate((long)position->points * position->remainder_stride / 2);
  for (int i = 0; position->factor && i < position->points; i++)
    for (int k = 0; k < position->rank; k++)
      position->factor[i * position->stride + k] = (float)factor[i * stride + k];
  free(factor);
  if (!position->factor || !position->remainder)
    return eo_error_memory(error);
  kernel.evaluate(kernel.context, position->points, position->point, compliance);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      const float *a = position->factor + i * (size_t)position->stride,
                  *b = position->factor + j * (size_t)position->stride;
      double sum = compliance[i * n + j];
      for (int k = 0; k < position->rank; k++)
        sum -= (double)a[k] * (double)b[k];
      position->remainder[i * (size_t)position->remainder_stride + j] = (float)sum;
    }
  return EO_OK;
}

static void free_position(struct eo_contact_position *position)
{
  free(position->line);
  free(position->point);
  free(position->path);
  free(position->kind);
  free(position->length);
  free(position->law);
  free(position->per_depth);
  free(position->strength);
  free(position->radius);
  free(position->factor);
  free(position->remainder);
}

void eo_contact_grid_free(struct eo_contact_grid *grid)
{
  if (!grid)
    return;
  for (int i = 0; grid->position && i < grid->positions; i++)
    free_position(&grid->position[i]);
  free(grid->position);
  free(grid);
}

void eo_contact_grid_pairs(const struct eo_contact_grid *grid, int range[2])
{
  range[0] = 0;
  range[1] = 0;
  for (int j = 0; j < grid->positions; j++)
    for (int l = 0; l < grid->position[j].lines; l++) {
      int pair = grid->position[j].line[l].pair;
      range[0] = pair < range[0] ? pair : range[0];
      range[1] = pair > range[1] ? pair : range[1];
    }
}

const struct eo_contact_line *eo_contact_same_line(const struct eo_contact_position *position,
                                                   const struct eo_contact_line *line)
{
  for (int i = 0; i < position->lines; i++)
    if (position->line[i].pair == line->pair && position->line[i].kind == line->kind &&
        position->line[i].cells == line->cells)
      return &position->line[i];
  return NULL;
}

/* Where the teeth touch at every position. */
static enum eo_code fill_positions(struct eo_contact_grid *grid, const struct eo_material *material,
                                   const struct eo_contact_grid_settings *settings, const double *phase,
                                   struct eo_gap_field *field, struct eo_error *error)
{
  const struct eo_flank_modification none = {0};
  struct stretch stretch[3];
  int stretches = list_stretches(&grid->geometry, settings, stretch);
  eo_gap_field_init(field, &grid->geometry, &none, &none, EO_RIGHT, 0, 0, 0, grid->corner);
  for (int i = 0; i < grid->positions; i++) {
    struct eo_contact_position *position = &grid->position[i];
    position->phase = phase ? phase[i] : grid->geometry.transverse_base_pitch * i / grid->positions;
    EO_TRY(fill_position(position, field, material, stretch, stretches, error));
    scale_law(position, grid->compliance_scale);
    position->first = grid->points;
    grid->points += position->points;
    grid->most_points = position->points > grid->most_points ? position->points : grid->most_points;
  }
  return EO_OK;
}

/* compliance: [most_points * most_points], written to. */
static enum eo_code factor_positions(struct eo_contact_grid *grid, struct eo_kernel kernel, double *compliance,
                                     const struct eo_progress *progress, struct eo_error *error)
{
  for (int i = 0; i < grid->positions; i++) {
    EO_TRY(factor_position(&grid->position[i], kernel, compliance, error));
    grid->most_rank = grid->position[i].rank > grid->most_rank ? grid->position[i].rank : grid->most_rank;
    if (eo_progress_report(progress, "contact grid", (i + 1.0) / grid->positions))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "Cancelled.");
  }
  return EO_OK;
}

static enum eo_code fill_grid(struct eo_contact_grid *grid, const struct eo_material *material,
                              const struct eo_contact_grid_settings *settings, const double *phase,
                              struct eo_kernel kernel, const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_gap_field *field = malloc(sizeof *field);
  enum eo_code code = field ? fill_positions(grid, material, settings, phase, field, error) : eo_error_memory(error);
  free(field);
  EO_TRY(code);
  double *compliance = malloc(sizeof *compliance * (size_t)grid->most_points * (size_t)grid->most_points);
  code = compliance ? factor_positions(grid, kernel, compliance, progress, error) : eo_error_memory(error);
  free(compliance);
  return code;
}

enum eo_code eo_contact_grid_new(struct eo_contact_grid **result, const struct eo_geometry *geometry,
                                 const struct eo_material *material, const struct eo_contact_grid_settings *settings,
                                 const double *phase, struct eo_kernel kernel, const struct eo_progress *progress,
                                 struct eo_error *error)
{
  struct eo_contact_grid *grid = calloc(1, sizeof *grid);
  if (!grid)
    return eo_error_memory(error);
  double nu = material->poissons_ratio;
  grid->geometry = *geometry;
  grid->material = *material;
  eo_corner_gap_init(grid->corner, geometry);
  grid->compliance_scale = 2 * (1 - nu * nu) / (M_PI * eo_material_contact_modulus(material));
  grid->partial_cells = settings->partial_cells;
  grid->positions = settings->positions;
  grid->position = calloc((size_t)settings->positions, sizeof *grid->position);
  enum eo_code code = grid->position ? fill_grid(grid, material, settings, phase, kernel, progress, error)
                                     : eo_error_memory(error);
  if (code)
    eo_contact_grid_free(grid);
  else
    *result = grid;
  return code;
}
