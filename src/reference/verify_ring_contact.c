/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/iso6336.h"
#include "document/examples.h"
#include "evaluation/evaluator.h"
#include "gear/modification.h"
#include "reference/case_pair.h"
#include "reference/verify_ring.h"

enum { MOST_STRESSES = 64 };

/* A root stress that another support's is compared with. */
struct root_stress {
  const char *of_case; /* the file's */
  int key;
  double stress, expected; /* MPa */
};

/* One loaded contact. */
struct run {
  struct eo_ring_case *c;
  struct eo_design design;
  struct eo_flexibility *flexibility;
  struct eo_pair *pair;
  struct eo_evaluator *evaluator;
  const struct eo_evaluation *found;
  struct root_stress stress[MOST_STRESSES]; /* [stresses] of the supports before */
  int stresses;
};

static void run_done(struct run *run)
{
  eo_evaluator_free(run->evaluator);
  eo_pair_free(run->pair);
  eo_flexibility_free(run->flexibility);
  run->flexibility = NULL;
  run->evaluator = NULL;
  run->pair = NULL;
}

static enum eo_code run_prepare(struct run *run, bool pairs, struct eo_error *error)
{
  run_done(run);
  enum eo_code code = eo_ring_prepare(run->c, pairs, 0, &run->design, &run->flexibility, error);
  if (code)
    return code;
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&run->design.resolution);
  struct eo_pair_options options = {
      .own_pivots = true, .grid = &grid, .kernel = eo_flexibility_kernel(run->flexibility)};
  grid.partial_cells = false; /* the references load a cell by its middle */
  code = eo_pair_new(&run->pair, &run->design, &options, NULL, error);
  return code ? code : eo_evaluator_new(&run->evaluator, run->pair, 1, error);
}

static double mean_of(const double *value, int n)
{
  double sum = 0;
  for (int j = 0; j < n; j++)
    sum += value[j] / n;
  return sum;
}

/* Means over the positions and both ends, N/m: P/Z, which the reference calls c; P over the approach from the first
   contact anywhere on the flank, k; dP/dZ. */
static void stiffness_of(const struct run *run, double *level, double *secant, double *tangent)
{
  const struct eo_case_result *case_result = &run->found->load_case[0];
  int n = run->found->positions;
  *level = *secant = *tangent = 0;
  for (int end = 0; end < 2; end++) {
    for (int j = 0; j < n; j++)
      *level += case_result->force / case_result->end[end].loaded.approach[j] / (2 * n);
    *secant += mean_of(case_result->end[end].stiffness, n) / 2;
    *tangent += mean_of(case_result->end[end].loaded.tangent, n) / 2;
  }
}

/* Load of one pair at a position of the left end over the load of the end. */
static double share_of(const struct run *run, int j, int pair)
{
  const struct eo_case_result *case_result = &run->found->load_case[0];
  const struct eo_contact_position *position = &run->pair->grid->position[j];
  const double *q = case_result->end[EO_LEFT].loaded.line_load + position->first;
  double sum = 0;
  for (int i = 0; i < position->points; i++)
    sum += position->point[i].pair == pair ? q[i] * position->length[i] : 0;
  return sum / case_result->force;
}

static double largest_share(const struct run *run)
{
  int range[2];
  double largest = 0;
  eo_contact_grid_pairs(run->pair->grid, range);
  for (int j = 0; j < run->found->positions; j++)
    for (int pair = range[0]; pair <= range[1]; pair++)
      largest = fmax(largest, share_of(run, j, pair));
  return largest;
}

/* The largest stress along the profile, below the start of the critical section, Pa, and what the division of the root
   leaves open in it. */
struct along {
  double stress, open;
};

/* The stress of a node is the mean strain between its two neighbours. Over twice that distance it would be the mean of
   the neighbours' own: what is left of a smooth stress goes with the square of the distance, so a third of the
   difference is how far the node's value is out. */
static void find_largest_along(const struct eo_root *root, const double *stress, struct along *largest)
{
  int across = root->layers + 1;
  for (int i = root->first; i < root->points; i++)
    for (int layer = 0; layer < across; layer++) {
      const double *at = stress + (size_t)(i * across + layer) * EO_STRESSES;
      if (*at <= largest->stress)
        continue;
      const double *before = at - across * EO_STRESSES, *after = at + across * EO_STRESSES;
      *largest = (struct along){*at, i < root->points - 1 ? fabs(*at - 0.5 * (*before + *after)) / 3 : 0};
    }
}

/* The largest stress along the profile of the pinion's roots over the cycle and both ends: what the reference calls
   root stress. That it is not the principal stress shows in its ratios: between supports, and from the unmodified pair
   to the misaligned one, the stress along the profile has them within 1 %, the principal stress does not (its direction
   turns with the load's place). own: loads on other teeth left out. */
static enum eo_code largest_stress(const struct run *run, bool own, struct along *largest, struct eo_error *error)
{
  const struct eo_flexibility *flexibility = run->flexibility;
  const struct eo_contact_grid *grid = run->pair->grid;
  struct eo_root root = eo_flexibility_root(flexibility, EO_PINION);
  double *stress = malloc(sizeof *stress * (size_t)(root.points * (root.layers + 1) * EO_STRESSES));
  double *force = malloc(sizeof *force * (size_t)grid->most_points);
  enum eo_code code = stress && force ? EO_OK : eo_error_memory(error);
  int range[2];
  eo_contact_grid_pairs(grid, range);
  *largest = (struct along){0};
  for (int end = 0; end < 2 && !code; end++)
    for (int j = 0; j < grid->positions; j++)
      for (int tooth = range[0]; tooth <= range[1]; tooth++) {
        const struct eo_contact_position *position = &grid->position[j];
        const double *q = run->found->load_case[0].end[end].loaded.line_load + position->first;
        for (int i = 0; i < position->points; i++)
          force[i] = own && position->point[i].pair != tooth ? 0 : q[i] * position->length[i];
        eo_flexibility_root_stress(flexibility, EO_PINION, tooth, position->points, position->point, force, 0,
                                   root.points, stress);
        find_largest_along(&root, stress, largest);
      }
  free(stress);
  free(force);
  return code;
}

/* The file's "ratios between supports 0.01": the same case and key under another support of the ring; a sector's
   neighbours stand in a mesh of their own, coarser than the reference's. */
static void check_ratio(struct run *run, struct eo_case *wanted, const char *of_case, int key, double stress)
{
  static const double OF_RATIO = 0.01;
  double expected = eo_case_real(wanted);
  if (isnan(expected) || run->design.resolution.elements.body != EO_BODY_RING)
    return;
  for (int i = 0; i < run->stresses; i++) {
    const struct root_stress *other = &run->stress[i];
    if (other->key != key || strcmp(other->of_case, of_case) != 0)
      continue;
    double ratio = expected / other->expected;
    eo_verify_derived(run->c->v, wanted, "over the same of the first support", stress / other->stress, ratio,
                      OF_RATIO * fabs(ratio));
    return;
  }
  if (run->stresses < MOST_STRESSES)
    run->stress[run->stresses++] = (struct root_stress){of_case, key, stress, expected};
}

/* Tolerance: the file's, which is that of its nine elements, and what our own division leaves open. A finer division is
   no way to do without the latter: on the reference's nine elements ours is 4.6 to 5.03 % above it, on 12, 15 and 20 it
   is 4.9 to 6.8, 5.7 to 6.9 and 5.9 to 7.3 % (floating), and on 6, 2.4 to 4.1 %. What the two codes differ by lies
   between them, not in our mesh. */
static enum eo_code check_root(struct run *run, const char *of_case, struct eo_case *block, struct eo_error *error)
{
  static const char *const key[2] = {"loads_on_itself", "loads_on_all_teeth"};
  enum eo_code code = EO_OK;
  for (int all = 0; all < 2 && !code && block; all++) {
    struct along largest;
    struct eo_case *wanted = eo_case_find(block, key[all]);
    code = largest_stress(run, !all, &largest, error);
    double tolerance = run->c->tolerance.root * fabs(eo_case_real(wanted)) + 1e-6 * largest.open;
    eo_verify_number(run->c->v, wanted, 1e-6 * largest.stress, 0, tolerance);
    check_ratio(run, wanted, of_case, all, 1e-6 * largest.stress);
  }
  return code;
}

/* Phase of the pair -> its share, left end. */
static void check_shares(struct run *run, struct eo_case *block)
{
  static const double NEAR = 0.01; /* of the base pitch */
  const struct eo_contact_grid *grid = run->pair->grid;
  double pitch = grid->geometry.transverse_base_pitch;
  int range[2];
  eo_contact_grid_pairs(grid, range);
  for (int i = 0; i < eo_case_size(block); i++) {
    struct eo_case *wanted = eo_case_at(block, i);
    double phase = 1e-3 * eo_case_key_number(wanted), share = NAN;
    for (int j = 0; j < grid->positions; j++)
      for (int pair = range[0]; pair <= range[1]; pair++)
        if (fabs(grid->position[j].phase + pair * pitch - phase) < NEAR * pitch)
          share = share_of(run, j, pair);
    if (isnan(share))
      eo_case_fault(wanted, "No pair stands at this phase.");
    else
      eo_verify_number(run->c->v, wanted, share, 0, run->c->tolerance.share);
  }
}

/* "unmodified 828", "A, in plane, 828": modification, shaft angle error, torque in N m. */
static void read_name(struct run *run, struct eo_case *block)
{
  struct eo_design *design = &run->design;
  struct eo_case *mods = eo_case_find(eo_case_find(run->c->file, "modification"), "mods");
  const char *name = eo_case_key(block), *number = name + strlen(name);
  struct eo_flank_modification *flank = design->modification.flank[EO_PINION];
  struct eo_design example;
  char word[41];
  snprintf(word, sizeof word, "%.*s", (int)strcspn(name, " ,"), name);
  while (number > name && strchr("0123456789.", number[-1]))
    number--;
  const char *rest = name + strlen(word);
  bool plane = strncmp(rest, ", in plane,", 11) == 0;
  if (!(strtod(number, NULL) > 0) || rest + (plane ? 12 : 1) != number)
    eo_case_fault(block,
                  "The name must be like \"unmodified 828\" or \"A, in plane, 828\": modification, torque in N m.");
  if (!mods && strcmp(word, "A") == 0 && eo_example_build("paper-case-a", &example))
    flank[EO_LEFT] = example.modification.flank[EO_PINION][EO_LEFT];
  else
    eo_case_named_modification(mods, word, block, &design->gear_pair, &flank[EO_LEFT]);
  flank[EO_RIGHT] = flank[EO_LEFT];
  design->alignment.shaft_angle_in_plane = plane ? 0.1 * M_PI / 180 : 0;
  design->load_case[0].torque = strtod(number, NULL);
}

static enum eo_code check_case(struct run *run, struct eo_case *block, struct eo_error *error)
{
  struct eo_verification *verification = run->c->v;
  const struct eo_ring_tolerances *tolerances = &run->c->tolerance;
  read_name(run, block);
  if (eo_case_faulty(block))
    return EO_OK;
  enum eo_code code = eo_evaluator_contact(run->evaluator, &run->design, &run->found, error);
  if (code)
    return code;
  const struct eo_case_result *case_result = &run->found->load_case[0];
  double level, secant, tangent, normal = cos(run->pair->geometry.base_helix_angle);
  if (case_result->contact_failures) {
    eo_verify_diverged(verification, block);
    return EO_OK;
  }
  stiffness_of(run, &level, &secant, &tangent);
  eo_verify_member(verification, block, "LTE_mean_um", 1e6 * case_result->mean, tolerances->stiffness, 0);
  eo_verify_member(verification, block, "PPLTE_um", 1e6 * case_result->peak_to_peak, tolerances->swing[1],
                   tolerances->swing[0]);
  eo_verify_member(verification, block, "k_secant_N_per_um", 1e-6 * secant, tolerances->stiffness, 0);
  eo_verify_member(verification, block, "k_tangent_N_per_um", 1e-6 * tangent, tolerances->stiffness, 0);
  eo_verify_member(verification, block, "c_N_per_mm_um",
                   1e-9 * level * normal * normal / run->pair->geometry.face_width, tolerances->stiffness, 0);
  eo_verify_member(verification, block, "share_max", largest_share(run), 0, tolerances->share);
  eo_verify_list(verification, eo_case_find(block, "LTE_um_of_32_positions"), run->found->positions,
                 case_result->transmission, 1e6, tolerances->stiffness, 0);
  check_shares(run, eo_case_find(block, "share_by_phase_of_pair"));
  return check_root(run, eo_case_key(block), eo_case_find(block, "root_pinion_max_MPa"), error);
}

static void set_contact(struct run *run, int positions, int cells)
{
  run->design.resolution.positions = positions;
  run->design.resolution.cells_per_line = cells;
  run->design.resolution.tip_edge_contact = false;
}

static enum eo_code check_support(struct run *run, struct eo_case *cases, struct eo_error *error)
{
  run->design = run->c->design;
  eo_ring_support(run->c, eo_case_key(cases), cases, &run->design);
  if (eo_case_faulty(cases))
    return EO_OK;
  set_contact(run, 32, 30);
  enum eo_code code = run_prepare(run, false, error);
  for (int i = 0; i < eo_case_size(cases) && !code; i++)
    code = check_case(run, eo_case_at(cases, i), error);
  return code;
}

enum eo_code eo_ring_check_ltca(void *context, struct eo_case *block, struct eo_error *error)
{
  struct run *run = calloc(1, sizeof *run);
  enum eo_code code = run ? EO_OK : eo_error_memory(error);
  if (run)
    run->c = context;
  for (int i = 0; i < eo_case_size(block) && !code && !eo_case_faulty(block); i++)
    if (!eo_case_is_commentary(eo_case_key(eo_case_peek(block, i))))
      code = check_support(run, eo_case_at(block, i), error);
  if (run)
    run_done(run);
  free(run);
  return code;
}

/* "17/44 24": teeth and helix. */
static void read_pair(struct run *run, struct eo_case *row)
{
  struct eo_design *design = &run->design;
  int z[2] = {0, 0};
  double helix = NAN;
  *design = run->c->design;
  if (sscanf(eo_case_key(row), "%d/%d %lf", &z[0], &z[1], &helix) != 3)
    eo_case_fault(row, "A pair is called like \"17/44 24\": teeth and helix.");
  for (int m = 0; m < 2; m++)
    design->gear_pair.teeth[m] = z[m];
  design->gear_pair.helix_angle = helix * M_PI / 180;
  /* What was derived for the other pair. */
  design->gear_pair.centre_distance = NAN;
  for (int m = 0; m < 2; m++)
    design->gear_pair.tip_diameter[m] = design->gear_pair.bore[m] = design->gear_pair.groove_diameter[m] = NAN;
  design->load_case[0].torque = eo_case_number(row, "T_Nm");
}

static void check_iso(struct run *run, struct eo_case *block)
{
  static const double ROUNDING = 1e-3;
  static const char *const key[2] = {"C_M 0.8", "C_M 1"};
  static const double factor[2] = {0.8, 1};
  for (int i = 0; i < 2 && block; i++) {
    struct eo_iso_stiffness iso;
    struct eo_iso_stiffness_input input = eo_pair_iso_stiffness_input(run->pair);
    input.theory_factor = factor[i];
    input.virtual_teeth = EO_ISO_VIRTUAL_EXACT; /* as the reference has it */
    eo_iso_stiffness(&iso, &input);
    eo_verify_member(run->c->v, block, key[i], 1e-9 * iso.mesh_alpha, ROUNDING, 0);
  }
}

static enum eo_code check_pair_support(struct run *run, struct eo_case *block, struct eo_error *error)
{
  const struct eo_ring_tolerances *tolerances = &run->c->tolerance;
  struct eo_geometry geometry;
  eo_ring_support(run->c, eo_case_key(block), block, &run->design);
  if (eo_case_faulty(block))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &run->design.gear_pair, error);
  if (code)
    return code;
  eo_design_resolve(&run->design, &geometry);
  set_contact(run, 16, 16);
  code = run_prepare(run, true, error);
  if (!code)
    code = eo_evaluator_contact(run->evaluator, &run->design, &run->found, error);
  if (code)
    return code;
  double level, secant, tangent, normal = cos(geometry.base_helix_angle);
  stiffness_of(run, &level, &secant, &tangent);
  eo_verify_member(run->c->v, block, "c", 1e-9 * level * normal * normal / geometry.face_width, tolerances->stiffness,
                   0);
  eo_verify_member(run->c->v, block, "LTE_mean_um", 1e6 * run->found->load_case[0].mean, tolerances->stiffness, 0);
  eo_verify_member(run->c->v, block, "PPLTE_um", 1e6 * run->found->load_case[0].peak_to_peak,
                   tolerances->pairs_swing[1], tolerances->pairs_swing[0]);
  return EO_OK;
}

static enum eo_code check_pair(void *context, struct eo_case *row, struct eo_error *error)
{
  struct run *run = context;
  enum eo_code code = EO_OK;
  read_pair(run, row);
  struct eo_case *iso = eo_case_find(row, "iso_c_gamma_alpha");
  for (int i = 0; i < eo_case_size(row) && !code && !eo_case_faulty(row); i++) {
    const char *key = eo_case_key(eo_case_peek(row, i));
    if (strcmp(key, "T_Nm") != 0 && strcmp(key, "iso_c_gamma_alpha") != 0)
      code = check_pair_support(run, eo_case_at(row, i), error);
  }
  if (!code && run->pair)
    check_iso(run, iso);
  return code;
}

enum eo_code eo_ring_check_pairs(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_ring_case *ring_case = context;
  struct run *run = calloc(1, sizeof *run);
  if (!run)
    return eo_error_memory(error);
  run->c = ring_case;
  enum eo_code code = eo_verify_each(ring_case->v, eo_case_need(block, "rows"), check_pair, run, error);
  run_done(run);
  free(run);
  return code;
}
