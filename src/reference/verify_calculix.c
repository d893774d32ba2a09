/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact/root.h"
#include "design/resolution.h"
#include "evaluation/evaluator.h"
#include "reference/case_pair.h"
#include "reference/verify_contact.h"

enum { MOST_PHASES = 512 };

struct calculix {
  struct eo_case *file;
  struct eo_verification *v;
  struct eo_design design;
  struct eo_geometry geometry;
};

/* A number in the file's words, for instance after "mn " in "z 17/44, mn 6"; a fault when it is not there and there is
   no substitute (NaN). */
static double stated(struct eo_case *what, const char *mark, double missing)
{
  const char *text = eo_case_text(what), *found = text ? strstr(text, mark) : NULL;
  char *end;
  double value = found ? strtod(found + strlen(mark), &end) : missing;
  if (text && (isnan(value) || (found && end == found + strlen(mark))))
    eo_case_fault(what, "The words do not say \"%sNUMBER\".", mark);
  return value;
}

/* The pair of the words "z 17/44, mn 6, beta 24, b 55"; helix and face width are the paper's where only its teeth and
   module are stated. */
static void read_words(struct eo_case *what, struct eo_design *design)
{
  const double teeth = stated(what, "z ", NAN), other = stated(what, "/", NAN), module = stated(what, "mn ", NAN);
  const bool paper = teeth == 17 && other == 44 && module == 6;
  json_t *made = json_pack("{s:[f,f], s:f, s:f, s:f}", "z", teeth, other, "mn", module, "beta_deg",
                           stated(what, "beta ", paper ? 24 : NAN), "b", stated(what, ", b ", paper ? 55 : NAN));
  struct eo_case *input = eo_case_faulty(what) ? (json_decref(made), NULL) : eo_case_open(made);
  if (!input)
    return;
  eo_case_design(input, design);
  if (eo_case_faulty(input))
    eo_case_fault(what, "%s", eo_case_faults(input)->fault[0].text);
  eo_case_close(input);
}

static enum eo_code read_file(struct calculix *calculix, struct eo_error *error)
{
  struct eo_design *design = &calculix->design;
  struct eo_case *what = eo_case_need(calculix->file, "what"), *input = eo_case_find(calculix->file, "input");
  double force = stated(what, "normal force ", NAN);
  if (input)
    eo_case_design(input, design);
  else
    read_words(what, design);
  design->resolution.elements.body = EO_BODY_SECTOR;
  design->resolution.elements.sector_teeth = eo_case_count(calculix->file, "boundary", "-tooth sectors", 3);
  design->resolution.elements.neighbour_coupling = false;
  design->resolution.tip_edge_contact = true;
  if (eo_case_faulty(calculix->file))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&calculix->geometry, &design->gear_pair, error);
  if (code)
    return code;
  eo_design_resolve(design, &calculix->geometry);
  design->load_case[0].torque = 2 * force * calculix->geometry.base_radius[0] *
                                cos(calculix->geometry.base_helix_angle);
  return EO_OK;
}

/* The modification of a block: "mod", or none in a block called unmodified. */
static void read_modification(const struct calculix *calculix, struct eo_case *block, struct eo_design *design)
{
  static const char *const plain[] = {"unmodified", "unmod"};
  struct eo_case *mod = eo_case_find(block, "mod");
  struct eo_flank_modification *flank = design->modification.flank[EO_PINION];
  bool named = mod != NULL;
  for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
    named = named || strncmp(eo_case_key(block), plain[i], strlen(plain[i])) == 0;
  if (!named)
    eo_case_fault(block, "The block states no modification \"mod\", and its name does not begin with unmodified.");
  if (eo_case_is_text(mod))
    eo_case_named_modification(NULL, eo_case_text(mod), mod, &calculix->design.gear_pair, &flank[EO_LEFT]);
  else
    eo_case_modification(mod, &calculix->design.gear_pair, &flank[EO_LEFT]);
  flank[EO_RIGHT] = flank[EO_LEFT];
}

/* Shares of the pairs that stand near the phases which the keys name, mm. */
static void check_shares(const struct calculix *calculix, struct eo_case *shares, const struct eo_pair *pair,
                         const struct eo_evaluation *evaluation, int j)
{
  const double tolerance = 0.015, near = 1e-2;
  const struct eo_contact_position *position = &pair->grid->position[j];
  const double *line_load = evaluation->load_case[0].end[0].loaded.line_load + position->first;
  const double pitch = pair->geometry.transverse_base_pitch;
  for (int k = 0; k < eo_case_size(shares); k++) {
    struct eo_case *share = eo_case_at(shares, k);
    double load = 0, place = 1e-3 * eo_case_key_number(share), whole = (place - position->phase) / pitch;
    if (fabs(whole - round(whole)) > near)
      eo_case_fault(share, "No pair of teeth is in this place at the phase of %g mm.", 1e3 * position->phase);
    for (int i = 0; i < position->points; i++)
      if (position->point[i].pair == (int)round(whole))
        load += line_load[i] * position->length[i];
    eo_verify_number(calculix->v, share, load / evaluation->load_case[0].force, 0, tolerance);
  }
}

/* The load, N, at which the position j stands at a prescribed approach (m, normal); NaN when it is not found. The force
   over the approach is smooth and nearly straight, so a few steps along the tangent stiffness do. */
static double load_at(struct eo_evaluator *evaluator, struct eo_design *design, const struct eo_pair *pair, int j,
                      double approach, const struct eo_evaluation **evaluation, struct eo_error *error)
{
  enum { MOST_STEPS = 12 };
  const double close = 1e-10, per_torque = 2 * pair->geometry.base_radius[0] * cos(pair->geometry.base_helix_angle);
  for (int step = 0; step < MOST_STEPS; step++) {
    if (eo_evaluator_contact(evaluator, design, evaluation, error) || (*evaluation)->load_case[0].contact_failures)
      return NAN;
    const struct eo_loaded_end *end = &(*evaluation)->load_case[0].end[0].loaded;
    double missing = approach - end->approach[j];
    if (fabs(missing) < close)
      return (*evaluation)->load_case[0].force;
    design->load_case[0].torque = per_torque * fmax((*evaluation)->load_case[0].force + end->tangent[j] * missing, 1);
  }
  return NAN;
}

/* Position of the grid at which all pairs of a case stand at the prescribed approach. */
struct standing {
  const struct calculix *x;
  const struct eo_pair *pair;
  const struct eo_contact_position *p;
  const double *line_load; /* of the position's points */
  double total;            /* load of all pairs, N */
};

/* Number of the pair that stands at the phase which the key names, mm; false: none of this position. */
static bool pair_of(const struct standing *at, struct eo_case *value, int *pair)
{
  static const double NEAR = 1e-2;
  double whole = (1e-3 * eo_case_key_number(value) - at->p->phase) / at->pair->geometry.transverse_base_pitch;
  *pair = (int)round(whole);
  return fabs(whole - round(whole)) <= NEAR;
}

/* Loads of single pairs: the pairs of a case have no coupling, so each carries its own. Tolerance: the level of the
   curve, what the file states of its own, and that of the shares. */
static void check_pair_loads(const struct standing *at, struct eo_case *loads, double uncertainty)
{
  static const double OF_LEVEL = 0.03, OF_TOTAL = 0.015;
  for (int k = 0; k < eo_case_size(loads); k++) {
    struct eo_case *one = eo_case_at(loads, k);
    double load = 0;
    int pair;
    if (!pair_of(at, one, &pair))
      continue;
    for (int i = 0; i < at->p->points; i++)
      if (at->p->point[i].pair == pair)
        load += at->line_load[i] * at->p->length[i];
    eo_verify_number(at->x->v, one, load, OF_LEVEL + uncertainty, OF_TOTAL * at->total);
  }
}

/* The largest principal stress over the profile, below the start of the critical section, at one place of the face, Pa:
   straight between the layers. */
static double largest_at(const struct eo_root *root, const double *stress, double eta)
{
  double largest = 0, layer = fmin(fmax((eta / root->width + 0.5) * root->layers, 0), root->layers);
  int across = root->layers + 1, below = (int)fmin(floor(layer), root->layers - 1);
  for (int i = root->first; i < root->points; i++) {
    const double *at = stress + (size_t)(i * across + below) * EO_STRESSES;
    double way = layer - below;
    largest = fmax(largest, (1 - way) * eo_stress_principal(at) + way * eo_stress_principal(at + EO_STRESSES));
  }
  return largest;
}

/* Whether a place of the face lies where the line of contact leaves the active profile at the member's root: the dent
   of the contact is in the figure there, which is not counted as root stress (struct eo_root, first). */
static bool is_at_contact(const struct standing *at, int member, int pair, double eta)
{
  static const double LAYER = 5e-3; /* of a mesh of about 12 layers over the paper's face */
  const struct eo_geometry *geometry = &at->pair->geometry;
  double end = member == EO_PINION ? geometry->path_start : geometry->path_end,
         c = at->p->phase + pair * geometry->transverse_base_pitch;
  return fabs(end - c - eta * tan(geometry->base_helix_angle)) < LAYER * tan(geometry->base_helix_angle);
}

/* [largest principal stress of the root, MPa; where over the face, mm]. A maximum over the face is flat, so its place
   is compared by the stress that we have there. Tolerance: what the elements of both leave open, of the value; and of
   the table's largest, because where a corner of the flank alone carries little its load is the less certain. */
static void check_root_of(const struct standing *at, struct eo_case *one, int member, int pair, double *force,
                          double *stress, double scale)
{
  static const double OF_VALUE = 0.05, OF_LARGEST = 0.05;
  const struct eo_flexibility *flexibility = at->pair->flexibility;
  struct eo_root root = eo_flexibility_root(flexibility, member);
  struct eo_root_place place;
  double wanted[2];
  if (eo_case_numbers(one, 2, 2, wanted) < 0)
    return;
  for (int i = 0; i < at->p->points; i++)
    force[i] = at->p->point[i].pair == pair ? at->line_load[i] * at->p->length[i] : 0;
  eo_root_find_largest(flexibility, member, pair, at->p->points, at->p->point, force, stress, &place);
  double tolerance = OF_VALUE * fabs(wanted[0]) + OF_LARGEST * scale;
  eo_verify_number(at->x->v, eo_case_at(one, 0), 1e-6 * place.stress, 0, tolerance);
  if (!is_at_contact(at, member, pair, 1e-3 * wanted[1]))
    eo_verify_derived(at->x->v, eo_case_at(one, 1), "stress at this place, MPa",
                      1e-6 * largest_at(&root, stress, 1e-3 * wanted[1]), wanted[0], tolerance);
}

static enum eo_code check_roots(const struct standing *at, struct eo_case *block, struct eo_error *error)
{
  static const char *const table[2] = {"root_pinion_MPa_at_prescribed_Z", "root_gear_MPa_at_prescribed_Z"};
  enum eo_code code = EO_OK;
  for (int member = 0; member < 2 && !code; member++) {
    struct eo_case *roots = eo_case_find(block, table[member]);
    struct eo_root root = eo_flexibility_root(at->pair->flexibility, member);
    double *stress = malloc(sizeof *stress * (size_t)(root.points * (root.layers + 1) * EO_STRESSES));
    double *force = malloc(sizeof *force * (size_t)at->p->points), scale = 0, value[2];
    if (!stress || !force)
      code = eo_error_memory(error);
    for (int k = 0; k < eo_case_size(roots); k++)
      if (eo_case_numbers(eo_case_at(roots, k), 2, 2, value) == 2)
        scale = fmax(scale, value[0]);
    for (int k = 0; k < eo_case_size(roots) && !code; k++) {
      int pair;
      if (pair_of(at, eo_case_at(roots, k), &pair))
        check_root_of(at, eo_case_at(roots, k), member, pair, force, stress, scale);
    }
    free(stress);
    free(force);
  }
  return code;
}

/* Loads and root stresses of single pairs when all stand at one prescribed transverse approach. */
static enum eo_code check_prescribed(const struct calculix *calculix, struct eo_case *block,
                                     struct eo_evaluator *evaluator, const struct eo_pair *pair,
                                     const struct eo_design *given, struct eo_error *error)
{
  struct eo_case *loads = eo_case_find(block, "pair_load_N");
  struct eo_design design = *given;
  const struct eo_evaluation *evaluation;
  enum eo_code code = EO_OK;
  if (!eo_case_find(block, "Z_prescribed_um"))
    return EO_OK;
  const double approach = 1e-6 * eo_case_number(block, "Z_prescribed_um") * cos(pair->geometry.base_helix_angle);
  const double uncertainty = eo_case_number_or(block, "pair_load_uncertainty_rel", 0);
  for (int j = 0; j < pair->grid->positions && !code; j++) {
    struct standing at = {calculix, pair, &pair->grid->position[j], NULL, 0};
    at.total = load_at(evaluator, &design, pair, j, approach, &evaluation, error);
    if (isnan(at.total)) {
      eo_verify_diverged(calculix->v, block);
      return EO_OK;
    }
    at.line_load = evaluation->load_case[0].end[0].loaded.line_load + at.p->first;
    check_pair_loads(&at, loads, uncertainty);
    code = check_roots(&at, block, error);
  }
  return code;
}

/* The level within 3 %; the curve, less the difference of the means, within 0.1 um; its sampled range as the two
   curves' extremes may each be out. */
static void check_transmission(const struct calculix *calculix, struct eo_case *block, int n, const double *lte)
{
  const double of_mean = 0.03, of_curve = 0.1;
  double wanted[MOST_PHASES], mean = 0, expected = 0, low = INFINITY, high = -INFINITY;
  struct eo_case *list = eo_case_need(block, "LTE_um");
  if (eo_case_numbers(list, n, MOST_PHASES, wanted) < 0)
    return;
  for (int j = 0; j < n; j++) {
    mean += 1e6 * lte[j] / n;
    expected += wanted[j] / n;
    low = fmin(low, 1e6 * lte[j]);
    high = fmax(high, 1e6 * lte[j]);
  }
  eo_verify_derived(calculix->v, list, "mean LTE um", mean, expected, of_mean * fabs(expected));
  for (int j = 0; j < n; j++)
    eo_verify_number(calculix->v, eo_case_at(list, j), 1e6 * lte[j] - (mean - expected), 0, of_curve);
  eo_verify_member(calculix->v, block, "LTE_mean_um", mean, of_mean, 0);
  eo_verify_member(calculix->v, block, "LTE_pp_sampled_um", high - low, 0, 2 * of_curve);
}

static enum eo_code check_contact(struct calculix *calculix, struct eo_case *block, const struct eo_pair *pair,
                                  struct eo_evaluator *evaluator, const struct eo_design *design,
                                  struct eo_error *error)
{
  const int n = design->resolution.positions;
  const struct eo_evaluation *evaluation;
  struct eo_case *share = eo_case_find(block, "share");
  EO_TRY(eo_evaluator_contact(evaluator, design, &evaluation, error));
  if (evaluation->load_case[0].contact_failures) {
    eo_verify_diverged(calculix->v, block);
    return EO_OK;
  }
  check_transmission(calculix, block, n, evaluation->load_case[0].transmission);
  if (share)
    eo_verify_size(calculix->v, share, n);
  for (int j = 0; j < n && j < eo_case_size(share); j++)
    check_shares(calculix, eo_case_at(share, j), pair, evaluation, j);
  return check_prescribed(calculix, block, evaluator, pair, design, error);
}

static enum eo_code solve_block(struct calculix *calculix, struct eo_case *block, struct eo_design *design, int n,
                                const double *phase, struct eo_error *error)
{
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&design->resolution);
  const struct eo_pair_options options = {.grid = &grid, .phase = phase, .own_pivots = true};
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  grid.positions = design->resolution.positions = n;
  EO_TRY(eo_pair_new(&pair, design, &options, NULL, error));
  enum eo_code code = eo_evaluator_new(&evaluator, pair, 1, error);
  if (!code)
    code = check_contact(calculix, block, pair, evaluator, design, error);
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return code;
}

static enum eo_code check_block(void *context, struct eo_case *block, struct eo_error *error)
{
  struct calculix *calculix = context;
  struct eo_design design = calculix->design;
  double phase[MOST_PHASES];
  int n = eo_case_numbers(eo_case_need(block, "phases_mm"), -1, MOST_PHASES, phase);
  read_modification(calculix, block, &design);
  if (n == 0)
    eo_case_fault(eo_case_find(block, "phases_mm"), "Phases are expected here.");
  if (eo_case_faulty(block))
    return EO_OK;
  for (int j = 0; j < n; j++)
    phase[j] *= 1e-3;
  return solve_block(calculix, block, &design, n, phase, error);
}

enum eo_code eo_verify_calculix(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  /* Any other key is a block of its own. */
  static const struct eo_verify_block blocks[] = {{"boundary", EO_BLOCK_REMARKS, NULL},
                                                  {"input", EO_BLOCK_INPUT, NULL},
                                                  {"kind", EO_BLOCK_INPUT, NULL},
                                                  {"*", EO_BLOCK_WHOLE, check_block},
                                                  {NULL, EO_BLOCK_INPUT, NULL}};
  struct calculix *calculix = calloc(1, sizeof *calculix);
  if (!calculix)
    return eo_error_memory(error);
  calculix->file = file;
  calculix->v = verification;
  enum eo_code code = read_file(calculix, error);
  if (!code && !eo_case_faulty(file))
    code = eo_verify_blocks(verification, file, blocks, calculix, error);
  free(calculix);
  return code;
}
