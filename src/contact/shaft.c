/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/shaft.h"

#include "numerics/dense.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool eo_shafts_equal(const struct eo_shafts *a, const struct eo_shafts *b)
{
  bool equal = a->enabled == b->enabled;
  for (int i = 0; i < 2; i++)
    equal = equal && a->bearing_position[i][EO_LEFT] == b->bearing_position[i][EO_LEFT] &&
            a->bearing_position[i][EO_RIGHT] == b->bearing_position[i][EO_RIGHT] &&
            a->shaft_diameter[i] == b->shaft_diameter[i] && a->drive_side[i] == b->drive_side[i];
  return equal;
}

enum { NODES = EO_DEFLECTION_NODES, VECTOR = 2 * NODES, MOST_PIECES = 2 * (NODES - 1) + 7, MOST_SIZE = 2 * VECTOR };

/* A stretch of a body with one section. */
struct piece {
  double from, to;
  struct eo_shaft_section section;
};

/* One member with all that its influence depends on. */
struct body {
  const struct eo_geometry *geometry;
  int member, ends;
  double mid[2], width[2]; /* [end] z of mid face, face width, m */
  double helix[2];         /* [end] beta_b, rad */
  double bearing[2];
  double clamp; /* z where twist is measured from */
  double arm;   /* xi of the pitch point */
  bool inwards; /* eta runs towards the groove */
  int pieces;
  struct piece piece[MOST_PIECES];
};

struct eo_shaft_section eo_shaft_section_of(const struct eo_material *material, double diameter, double bore)
{
  double nu = material->poissons_ratio, shear_modulus = material->youngs_modulus / (2 * (1 + nu)),
         ratio = bore / diameter;
  double area = M_PI / 4 * (diameter * diameter - bore * bore), second = M_PI / 64 * (pow(diameter, 4) - pow(bore, 4));
  double thin = (1 + ratio * ratio) * (1 + ratio * ratio);
  double kappa = 6 * (1 + nu) * thin / ((7 + 6 * nu) * thin + (20 + 12 * nu) * ratio * ratio);
  return (struct eo_shaft_section){material->youngs_modulus * second, kappa * shear_modulus * area,
                                   2 * shear_modulus * second};
}

double eo_shaft_effective_diameter(const struct eo_geometry *geometry, int member)
{
  return 2 * geometry->root_radius[member] + 0.75 * geometry->normal_module;
}

/* z of a node: eta runs to the left on the left end, to the right on the right one, or the other way round. */
static double node_place(const struct body *body, int end, int node)
{
  double eta = body->width[end] * ((double)node / (NODES - 1) - 0.5);
  return body->mid[end] + ((end == EO_LEFT) != body->inwards ? -eta : eta);
}

static void add_piece(struct body *body, double from, double to, struct eo_shaft_section section)
{
  if (to > from)
    body->piece[body->pieces++] = (struct piece){from, to, section};
}

static void add_end(struct body *body, int end, struct eo_shaft_section section)
{
  for (int i = 0; i < NODES - 1; i++)
    if (end == EO_LEFT)
      add_piece(body, node_place(body, end, NODES - 1 - i), node_place(body, end, NODES - 2 - i), section);
    else
      add_piece(body, node_place(body, end, i), node_place(body, end, i + 1), section);
}

static void init_body(struct body *body, const struct eo_geometry *geometry, const struct eo_gear_pair *pair,
                      const struct eo_material *both, const struct eo_shafts *shafts, int member)
{
  const struct eo_material own = eo_material_of(both, member), *material = &own;
  double bore = pair->bore[member], beyond = eo_gear_pair_extra_width(pair, member) / 2, half[2];
  struct eo_shaft_section shaft = eo_shaft_section_of(material, shafts->shaft_diameter[member], bore);
  struct eo_shaft_section toothed = eo_shaft_section_of(material, eo_shaft_effective_diameter(geometry, member), bore);
  *body = (struct body){.geometry = geometry, .member = member, .ends = pair->ends};
  for (int end = 0; end < 2; end++) {
    body->helix[end] = eo_geometry_of_half(geometry, pair, end).base_helix_angle;
    body->width[end] = pair->ends == 2 ? eo_gear_pair_face_width(pair, end) : pair->face_width;
    body->mid[end] = (end == EO_LEFT ? -1 : 1) * eo_gear_pair_mid_face(pair, end);
    half[end] = eo_gear_pair_mid_face(pair, end) + body->width[end] / 2 + beyond;
  }
  memcpy(body->bearing, shafts->bearing_position[member], sizeof body->bearing);
  body->clamp = shafts->drive_side[member] == EO_DRIVE_LEFT ? -half[EO_LEFT] : half[EO_RIGHT];
  body->arm = member == EO_PINION ? geometry->tangent_length[EO_PINION] : -geometry->tangent_length[EO_GEAR];
  add_piece(body, body->bearing[EO_LEFT], -half[EO_LEFT], shaft);
  add_piece(body, -half[EO_LEFT], beyond - half[EO_LEFT], toothed);
  add_end(body, EO_LEFT, toothed);
  if (pair->ends == 2) {
    double edge = pair->groove_width / 2, inner = edge - beyond;
    add_piece(body, -edge, -inner, toothed);
    add_piece(body, -inner, inner, eo_shaft_section_of(material, pair->groove_diameter[member], bore));
    add_piece(body, inner, edge, toothed);
    add_end(body, EO_RIGHT, toothed);
  }
  add_piece(body, half[EO_RIGHT] - beyond, half[EO_RIGHT], toothed);
  add_piece(body, half[EO_RIGHT], body->bearing[EO_RIGHT], shaft);
}

/* Internal bending moment and shear at x of a simply supported beam under a unit force, or a unit moment, at z. */
static double moment_of_force(const double bearing[2], double z, double x)
{
  return (bearing[1] - z) / (bearing[1] - bearing[0]) * (x - bearing[0]) - fmax(0, x - z);
}

static double shear_of_force(const double bearing[2], double z, double x)
{
  return (bearing[1] - z) / (bearing[1] - bearing[0]) - (x > z);
}

static double moment_of_moment(const double bearing[2], double z, double x)
{
  return (x > z) - (x - bearing[0]) / (bearing[1] - bearing[0]);
}

static double shear_of_moment(const double bearing[2])
{
  return -1 / (bearing[1] - bearing[0]);
}

/* Internal forces at x under unit loads: one row per kind. */
enum { BENDING, SHEAR, SIDE_BENDING, SIDE_SHEAR, TWIST, KINDS };

static void internal_forces(const struct body *body, double x, double row[KINDS][MOST_SIZE])
{
  const struct eo_geometry *geometry = body->geometry;
  double radius = geometry->base_radius[body->member];
  for (int end = 0; end < body->ends; end++) {
    double normal = cos(body->helix[end]), lean = sin(body->helix[end]);
    for (int node = 0; node < NODES; node++) {
      double z = node_place(body, end, node), hand = (end == EO_LEFT) != body->inwards ? lean : -lean;
      double moment = moment_of_moment(body->bearing, z, x), shear = shear_of_moment(body->bearing);
      int level = end * VECTOR + node, tilt = level + NODES;
      row[BENDING][level] = normal * moment_of_force(body->bearing, z, x) - hand * body->arm * moment;
      row[SHEAR][level] = normal * shear_of_force(body->bearing, z, x) - hand * body->arm * shear;
      row[BENDING][tilt] = -hand * moment;
      row[SHEAR][tilt] = -hand * shear;
      row[SIDE_BENDING][level] = hand * radius * moment;
      row[SIDE_SHEAR][level] = hand * radius * shear;
      row[TWIST][level] = (x > fmin(body->clamp, z) && x < fmax(body->clamp, z)) ? radius * normal : 0;
      row[SIDE_BENDING][tilt] = row[SIDE_SHEAR][tilt] = row[TWIST][tilt] = 0;
    }
  }
}

/* matrix += weight row row', lower triangle. */
static void add_square(int size, const double *row, double weight, double *matrix)
{
  for (int i = 0; i < size; i++) {
    double factor = weight * row[i];
    for (int j = 0; factor != 0 && j <= i; j++)
      matrix[i * size + j] += factor * row[j];
  }
}

/* Two Gauss points: the products of moments are quadratic on a piece, the others constant. */
static void add_piece_work(const struct body *body, const struct piece *piece, int size, double *matrix)
{
  double row[KINDS][MOST_SIZE], length = piece->to - piece->from, middle = (piece->to + piece->from) / 2,
                                reach = length / (2 * sqrt(3));
  for (int point = 0; point < 2; point++) {
    internal_forces(body, middle + (point ? reach : -reach), row);
    add_square(size, row[BENDING], length / 2 / piece->section.bending, matrix);
    add_square(size, row[SIDE_BENDING], length / 2 / piece->section.bending, matrix);
  }
  add_square(size, row[SHEAR], length / piece->section.shear, matrix);
  add_square(size, row[SIDE_SHEAR], length / piece->section.shear, matrix);
  add_square(size, row[TWIST], length / piece->section.torsion, matrix);
}

/* The strongest eigenvectors, times the root of their eigenvalues; tilt is weighed by half the path of contact. */
static enum eo_code find_modes(struct eo_shaft_influence *influence, double reach, struct eo_error *error)
{
  int n = influence->size;
  double scale[MOST_SIZE], value[MOST_SIZE], *vector = malloc(sizeof *vector * (size_t)(n * n));
  if (!vector)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++)
    scale[i] = i % VECTOR < NODES ? 1 : reach;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      vector[i * n + j] = scale[i] * scale[j] * influence->matrix[i * n + j];
  int failed = eo_dense_symmetric_eigen(n, vector, value);
  for (int k = 0; k < EO_SHAFT_MODES && !failed; k++)
    for (int i = 0; i < n; i++)
      influence->mode[k * n + i] = sqrt(fmax(0, value[n - 1 - k])) * vector[(n - 1 - k) * n + i] / scale[i];
  free(vector);
  return failed
             ? eo_error_set(error, EO_ERROR_NUMERIC, "", "The eigenvalues of the shafts' influence could not be found.")
             : EO_OK;
}

enum eo_code eo_shaft_influence_init(struct eo_shaft_influence *influence, const struct eo_geometry *geometry,
                                     const struct eo_gear_pair *pair, const struct eo_material *material,
                                     const struct eo_shafts *shafts, bool inwards, struct eo_error *error)
{
  int n = pair->ends * VECTOR;
  struct eo_shaft_influence made = {.ends = pair->ends,
                                    .size = n,
                                    .matrix = calloc((size_t)n * n, sizeof(double)),
                                    .mode = calloc((size_t)EO_SHAFT_MODES * n, sizeof(double))};
  struct body *body = malloc(sizeof *body);
  enum eo_code code = made.matrix && made.mode && body ? EO_OK : eo_error_memory(error);
  for (int member = 0; member < 2 && !code; member++) {
    init_body(body, geometry, pair, material, shafts, member);
    body->inwards = inwards; /* the pieces, set by now, are the same */
    for (int i = 0; i < body->pieces; i++)
      add_piece_work(body, &body->piece[i], n, made.matrix);
  }
  for (int i = 0; i < n && !code; i++)
    for (int j = 0; j < i; j++)
      made.matrix[j * n + i] = made.matrix[i * n + j];
  if (!code)
    code = find_modes(&made, (geometry->path_end - geometry->path_start) / 2, error);
  free(body);
  if (code)
    eo_shaft_influence_done(&made);
  else
    *influence = made;
  return code;
}

void eo_shaft_influence_done(struct eo_shaft_influence *influence)
{
  if (!influence)
    return;
  free(influence->matrix);
  free(influence->mode);
  *influence = (struct eo_shaft_influence){0};
}

void eo_shaft_deflect(const struct eo_shaft_influence *influence, const struct eo_deflection *load,
                      struct eo_deflection *deflection)
{
  double in[MOST_SIZE], out[MOST_SIZE];
  memcpy(in, load, sizeof *in * (size_t)influence->size);
  eo_dense_multiply(influence->size, influence->size, influence->matrix, in, out);
  memcpy(deflection, out, sizeof *out * (size_t)influence->size);
}
