/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_deviations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/pattern.h"
#include "design/resolution.h"
#include "evaluation/meeting_field.h"
#include "gear/names.h"
#include "reference/case_pair.h"

enum { MOST_POSITIONS = 4096, MOST_POINTS = 4096 };

/* One half of the pair as it was prepared last; kept while the next case wants the same one. */
struct half {
  const char *pair_name;
  int flexibility;
  double face_width, phase; /* m */
  int positions;
  struct eo_pair *pair;
  struct eo_loaded_workspace *workspace;
};

struct bench {
  struct eo_case *file;
  struct eo_verification *v;
  struct eo_closed_form form;
  struct half half[2];
};

/* A case at work: [end]. */
struct trial {
  struct bench *bench;
  struct eo_case *item, *tolerance;
  int ends;
  struct eo_design design;
  struct eo_running running;
  struct eo_axial_hold hold;
  struct eo_flank_spline *spline[2][2]; /* [member][end] */
  struct eo_gap_field field[2];
  struct eo_loaded_gaps gaps[2];
  struct eo_loaded_end loaded[2];
  double constant[2]; /* of the gaps, m */
};

static const char *const flexibilities[] = {"closed_form", "fe", NULL};

static enum eo_code check_pairs(void *context, struct eo_case *pairs, struct eo_error *error)
{
  return eo_verify_deviation_pairs(((const struct bench *)context)->v, pairs, error);
}

static enum eo_code check_tolerances(void *context, struct eo_case *block, struct eo_error *error)
{
  return eo_verify_flank_tolerances(((const struct bench *)context)->v, block, error);
}

static void drop(struct half *half)
{
  eo_loaded_workspace_free(half->workspace);
  eo_pair_free(half->pair);
  *half = (struct half){0};
}

/* phase: of mid face ahead of the left half's, m. */
static enum eo_code prepare_half(struct bench *bench, struct half *half, const struct half *wanted,
                                 const struct eo_design *design, struct eo_error *error)
{
  struct eo_design own = *design;
  struct eo_geometry geometry;
  double phase[MOST_POSITIONS];
  int n = own.resolution.positions;
  if (half->pair && strcmp(half->pair_name, wanted->pair_name) == 0 && half->flexibility == wanted->flexibility &&
      half->face_width == wanted->face_width && half->phase == wanted->phase && half->positions == wanted->positions)
    return EO_OK;
  drop(half);
  own.gear_pair.face_width = wanted->face_width;
  EO_TRY(eo_geometry_init(&geometry, &own.gear_pair, error));
  eo_design_resolve(&own, &geometry);
  for (int j = 0; j < n; j++)
    phase[j] = j * geometry.transverse_base_pitch / n + wanted->phase;
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&own.resolution);
  grid.partial_cells = false; /* the references load a cell by its middle */
  struct eo_pair_options options = {.grid = &grid,
                                    .phase = wanted->phase != 0 ? phase : NULL,
                                    .own_pivots = true,
                                    .tilt_rule = eo_case_tilt_rule(bench->file)};
  if (wanted->flexibility == 0)
    options.kernel = (struct eo_kernel){eo_closed_form_kernel, &bench->form};
  *half = *wanted;
  EO_TRY(eo_pair_new(&half->pair, &own, &options, NULL, error));
  return eo_loaded_workspace_new(&half->workspace, half->pair->grid, error);
}

static struct eo_case *end_of(struct eo_case *object, const struct trial *trial, int end)
{
  return object ? eo_case_find(object, eo_case_end_name[trial->ends == 1 ? 2 : end]) : NULL;
}

/* How the pinion is held. The constants of the gaps that a file gives are those of its apex offset. */
static void read_axial(struct trial *trial, double lean)
{
  static const char *const ways[] = {"floating", "fixed", "spring", "single", NULL};
  struct eo_case *offset = eo_case_find(trial->item, "apex_offset_um");
  int way = eo_case_need(trial->item, "pinion_axial") ? eo_case_choice(trial->item, "pinion_axial", ways, 0) : 0;
  double spring = way == 2 ? eo_case_number(trial->item, "pinion_axial_stiffness_N_per_m") : 0;
  trial->hold.stiffness = way == 1 ? INFINITY : spring;
  for (int member = 0; member < 2 && offset; member++)
    trial->design.alignment.apex_offset[member] = 1e-6 * eo_case_number(offset, eo_member_name[member]);
  if (offset)
    eo_case_remark(offset, "definition");
  struct eo_case *constant = eo_case_find(trial->item, "gap_constant_um");
  for (int end = 0; end < 2 && constant; end++) {
    double *a = trial->design.alignment.apex_offset, sign = trial->running.inwards ? -1 : 1;
    trial->constant[end] = 1e-6 * eo_case_element(constant, end);
    if (offset)
      eo_verify_number(trial->bench->v, eo_case_at(constant, end), end ? 1e6 * sign * lean * (a[0] - a[1]) : 0, 0,
                       1e-4);
  }
  if (offset)
    trial->constant[0] = trial->constant[1] = 0;
}

static void read_flanks(struct trial *trial)
{
  struct eo_case *flanks = eo_case_need(trial->item, "flanks");
  bool coast = trial->running.flank == EO_COAST_FLANK;
  for (int end = 0; end < trial->ends; end++) {
    struct eo_case *of_end = end_of(flanks, trial, end);
    if (!of_end)
      eo_case_fault(flanks, "The flanks of every end are expected here.");
    for (int member = 0; member < 2; member++)
      eo_case_flank(eo_case_find(of_end, eo_member_name[member]), trial->running.flank, member, end,
                    coast ? &trial->design.modification.coast[member][end]
                          : &trial->design.modification.flank[member][end],
                    &trial->design.grids);
  }
}

static enum eo_code read_case(struct trial *trial, struct eo_error *error)
{
  struct bench *bench = trial->bench;
  struct eo_case *name = eo_case_need(trial->item, "pair"), *errors = eo_case_find(trial->item, "shaft_error_deg"),
                 *widths = eo_case_find(trial->item, "face_width_mm");
  struct eo_case *pair = eo_case_is_text(name) ? eo_case_find(eo_case_need(bench->file, "pairs"), eo_case_text(name))
                                               : NULL;
  struct half wanted = {.pair_name = eo_case_is_text(name) ? eo_case_text(name) : "",
                        .flexibility = eo_case_choice(trial->item, "flexibility", flexibilities, 0)};
  if (!pair) {
    eo_case_fault(name ? name : trial->item, "There is no such pair.");
    return EO_OK;
  }
  eo_case_deviation_pair(pair, &trial->design);
  trial->design.resolution.positions = wanted.positions = eo_case_whole_or(trial->item, "positions_per_cycle", 8, 1024,
                                                                           64);
  trial->ends = trial->design.gear_pair.ends;
  trial->running.flank = eo_case_choice(trial->item, "flank_used", eo_flank_side_name, 0) == 1 ? EO_COAST_FLANK
                                                                                               : EO_DRIVE_FLANK;
  trial->running.inwards = trial->running.flank == EO_COAST_FLANK;
  trial->running.in_plane = eo_case_number_or(errors, "inplane", 0) * M_PI / 180;
  trial->running.out_of_plane = eo_case_number_or(errors, "crossing", 0) * M_PI / 180;
  double width = trial->design.gear_pair.face_width,
         lag = 1e-3 * eo_case_number_or(trial->item, "phase_right_minus_left_mm", 0);
  read_flanks(trial);
  struct eo_geometry geometry;
  if (!eo_case_faulty(trial->item))
    EO_TRY(eo_geometry_init(&geometry, &trial->design.gear_pair, error));
  read_axial(trial, eo_case_faulty(trial->item) ? 0 : sin(geometry.base_helix_angle));
  for (int end = 0; end < trial->ends && !eo_case_faulty(trial->item); end++) {
    wanted.face_width = widths ? 1e-3 * eo_case_number(widths, eo_case_end_name[end]) : width;
    wanted.phase = end == EO_RIGHT ? lag : 0;
    if (!eo_case_faulty(trial->item))
      EO_TRY(prepare_half(bench, &bench->half[end], &wanted, &trial->design, error));
  }
  return EO_OK;
}

static enum eo_code set_gaps(struct trial *trial, struct eo_error *error)
{
  for (int end = 0; end < trial->ends; end++) {
    const struct eo_pair *pair = trial->bench->half[end].pair;
    for (int member = 0; member < 2; member++) {
      struct eo_flank_grid grid = eo_flank_grid_at(&trial->design.grids, trial->running.flank, member, end);
      if (grid.u_knots)
        EO_TRY(eo_flank_spline_new(&trial->spline[member][end], &grid, error));
    }
    const struct eo_flank_spline *const spline[2] = {trial->spline[EO_PINION][end], trial->spline[EO_GEAR][end]};
    eo_meeting_field_init(&trial->field[end], pair, &trial->design, spline, &trial->running, end);
    trial->field[end].offset += trial->constant[end];
    EO_TRY(eo_loaded_gaps_init(&trial->gaps[end], pair->grid, error));
    EO_TRY(eo_loaded_end_init(&trial->loaded[end], pair->grid, error));
    eo_loaded_gaps_set(&trial->gaps[end], pair->grid, &trial->field[end]);
  }
  return EO_OK;
}

/* Both ends under a torque; returns P of an end. */
static double solve(struct trial *trial, double torque)
{
  const struct eo_geometry *geometry = &trial->bench->half[0].pair->geometry;
  double force = torque / (trial->ends * geometry->base_radius[EO_PINION] * cos(geometry->base_helix_angle));
  struct eo_loaded_half half[2] = {{0}};
  for (int end = 0; end < trial->ends; end++) {
    const struct half *own = &trial->bench->half[end];
    half[end] = (struct eo_loaded_half){own->workspace, own->pair->grid, &trial->gaps[end]};
    eo_loaded_solve(own->workspace, own->pair->grid, &trial->gaps[end], 1, 1, &force, &trial->loaded[end]);
  }
  if (trial->ends == 2)
    eo_loaded_balance(half, 1, &trial->hold, 0, force, trial->loaded);
  return force;
}

/* Mean and swing of numbers. */
struct span {
  double mean, low, high;
};

static struct span span_of(int n, const double *value)
{
  struct span span = {0, INFINITY, -INFINITY};
  for (int j = 0; j < n; j++) {
    span.mean += value[j] / n;
    span.low = fmin(span.low, value[j]);
    span.high = fmax(span.high, value[j]);
  }
  return span;
}

static double relative(const struct trial *trial, const char *key, double usual)
{
  return eo_case_relative_or(trial->tolerance, key, usual);
}

static double absolute(const struct trial *trial, const char *key, double usual)
{
  return eo_case_absolute_or(trial->tolerance, key, usual);
}

static void check_ends(const struct trial *trial, struct eo_case *row, const char *key, const double value[2],
                       double unit, double rel, double abs)
{
  if (eo_case_find(row, key))
    eo_verify_list(trial->bench->v, eo_case_find(row, key), trial->ends, value, unit, rel, abs);
}

static double highest_pressure(const struct eo_contact_grid *grid, const struct eo_loaded_end *end)
{
  double highest = 0;
  for (int j = 0; j < grid->positions; j++)
    for (int i = 0; i < grid->position[j].points; i++)
      highest = fmax(
          highest, eo_loaded_pressure(grid, end->line_load[grid->position[j].first + i], grid->position[j].radius[i]));
  return highest;
}

/* Loads of tooth pairs at some positions, within a share of P. */
static void check_pair_loads(const struct trial *trial, struct eo_case *rows, double force)
{
  double within = relative(trial, "pair_loads_rel_of_P", 0.003) * force;
  double share[MOST_POSITIONS];
  for (int i = 0; i < eo_case_size(rows); i++) {
    struct eo_case *row = eo_case_at(rows, i), *hands = eo_case_need(row, "hands");
    int j = eo_case_whole(row, "position", 0, trial->bench->half[0].pair->grid->positions - 1);
    for (int end = 0; end < trial->ends && !eo_case_faulty(row); end++) {
      struct eo_case *pairs = eo_case_at(hands, end);
      const struct eo_contact_grid *grid = trial->bench->half[end].pair->grid;
      for (int k = 0; k < eo_case_size(pairs); k++) {
        struct eo_case *expected = eo_case_at(pairs, k);
        eo_contact_pair_share(grid, &trial->loaded[end], (int)eo_case_key_number(expected), share);
        eo_verify_number(trial->bench->v, expected, share[j] * trial->loaded[end].load[j], 0, within);
      }
    }
  }
}

/* Transmission errors, transverse, of the ends and of the pair: curve[2] is their mean. */
static void set_curves(const struct trial *trial, double curve[3][MOST_POSITIONS])
{
  int n = trial->bench->half[0].pair->grid->positions, last = trial->ends - 1;
  double normal = cos(trial->bench->half[0].pair->geometry.base_helix_angle);
  for (int j = 0; j < n; j++) {
    for (int end = 0; end < trial->ends; end++)
      curve[end][j] = trial->loaded[end].approach[j] / normal;
    curve[2][j] = (curve[0][j] + curve[last][j]) / 2;
  }
}

/* Displacement of the pinion as the files have it, (Z_L - Z_R) / (2 sin beta_b) on either flank. */
static void check_float(const struct trial *trial, struct eo_case *row)
{
  const struct eo_contact_grid *grid = trial->bench->half[0].pair->grid;
  double z[MOST_POSITIONS], lean = sin(grid->geometry.base_helix_angle), within = absolute(trial, "float_um", 0.03);
  for (int j = 0; j < grid->positions && trial->ends == 2; j++)
    z[j] = (trial->loaded[EO_LEFT].approach[j] - trial->loaded[EO_RIGHT].approach[j]) / (2 * lean);
  if (trial->ends == 1)
    return;
  struct span span = span_of(grid->positions, z);
  eo_verify_member(trial->bench->v, row, "float_mean_um", 1e6 * span.mean, 0, within);
  eo_verify_member(trial->bench->v, row, "float_pp_um", 1e6 * (span.high - span.low), 0, within);
}

static enum eo_code check_result(struct trial *trial, struct eo_case *row)
{
  static double curve[3][MOST_POSITIONS];
  struct eo_verification *verification = trial->bench->v;
  double force = solve(trial, eo_case_number(row, "T_Nm")), swing[2] = {0}, mean[2] = {0}, pressure[2] = {0},
         tangent[2] = {0}, least[2] = {0}, most[2] = {0}, load[2] = {0};
  int n = trial->bench->half[0].pair->grid->positions;
  double pp_rel = relative(trial, "PPLTE_rel", 0.005), pp_um = absolute(trial, "PPLTE_um", 0.01),
         mean_rel = relative(trial, "LTE_mean_rel", 0.002), load_rel = relative(trial, "load_rel", 0.003);
  set_curves(trial, curve);
  for (int end = 0; end < trial->ends; end++) {
    struct span lte = span_of(n, curve[end]), loads = span_of(n, trial->loaded[end].load);
    swing[end] = lte.high - lte.low;
    mean[end] = lte.mean;
    pressure[end] = highest_pressure(trial->bench->half[end].pair->grid, &trial->loaded[end]);
    tangent[end] = span_of(n, trial->loaded[end].tangent).mean;
    least[end] = loads.low;
    most[end] = loads.high;
    load[end] = loads.mean;
  }
  struct span pair = span_of(n, curve[2]);
  eo_verify_member(verification, row, "PPLTE_um", 1e6 * (pair.high - pair.low), pp_rel, pp_um);
  eo_verify_member(verification, row, "LTE_mean_um", 1e6 * pair.mean, mean_rel, 0);
  check_ends(trial, row, "PPLTE_hands_um", swing, 1e6, pp_rel, pp_um);
  check_ends(trial, row, "LTE_mean_hands_um", mean, 1e6, mean_rel, 0);
  check_ends(trial, row, "max_pressure_MPa", pressure, 1e-6, relative(trial, "max_pressure_rel", 0.005), 0);
  check_ends(trial, row, "k_tan_mean_N_um", tangent, 1e-6, relative(trial, "k_tan_rel", 0.005), 0);
  check_ends(trial, row, "load_min_N", least, 1, 0, load_rel * force);
  check_ends(trial, row, "load_max_N", most, 1, 0, load_rel * force);
  check_ends(trial, row, "load_mean_N", load, 1, 0, load_rel * force);
  check_float(trial, row);
  check_pair_loads(trial, eo_case_find(row, "pair_loads_N"), force);
  if (trial->loaded[0].failures + trial->loaded[1].failures)
    eo_verify_diverged(verification, row);
  return EO_OK;
}

static void check_curve(struct trial *trial, struct eo_case *block)
{
  static double curve[3][MOST_POSITIONS];
  static const char *const key[3] = {"LTE_left_um", "LTE_right_um", "LTE_pair_um"};
  int n = trial->bench->half[0].pair->grid->positions;
  double force = solve(trial, eo_case_number(block, "T_Nm")), within = absolute(trial, "curve_um", 0.015);
  set_curves(trial, curve);
  for (int i = 0; i < 3; i++)
    if (eo_case_find(block, key[i]))
      eo_verify_list(trial->bench->v, eo_case_find(block, key[i]), n, curve[i], 1e6, 0, within);
  check_pair_loads(trial, eo_case_find(block, "pair_loads_N"), force);
}

static int end_index(const struct trial *trial, struct eo_case *row)
{
  int end = eo_case_need(row, "hand") ? eo_case_choice(row, "hand", eo_case_end_name, -1) : -1;
  return end == 2 ? 0 : end < trial->ends ? end : -1;
}

/* Gaps of the flanks alone: without shaft errors and constants. */
static void check_gap_points(struct trial *trial, struct eo_case *rows)
{
  for (int i = 0; i < eo_case_size(rows); i++) {
    struct eo_case *row = eo_case_at(rows, i), *gap = eo_case_need(row, "gap_um"),
                   *this_case = eo_case_need(row, "s_mm"), *eta = eo_case_need(row, "eta_mm");
    int end = end_index(trial, row), count = eo_case_size(gap);
    struct eo_gap_field *field = &trial->field[end < 0 ? 0 : end];
    const struct eo_pair *pair = trial->bench->half[end < 0 ? 0 : end].pair;
    eo_gap_field_init_shapes(field, &pair->geometry, field->shape, end, 0, 0, 0, pair->grid->corner);
    eo_verify_size(trial->bench->v, this_case, count);
    for (int k = 0; k < count && !eo_case_faulty(row); k++)
      eo_verify_number(trial->bench->v, eo_case_at(gap, k),
                       1e6 * eo_gap_field_at(field, 1e-3 * eo_case_element(this_case, k),
                                             1e-3 * eo_case_element(eta, k), NULL, NULL),
                       0, absolute(trial, "gap_um", 0.02));
    if (eo_case_find(row, "first_order_um"))
      eo_case_skip(eo_case_find(row, "first_order_um"));
    if (eo_case_find(row, "laid_on_involute_um"))
      eo_case_skip(eo_case_find(row, "laid_on_involute_um"));
    eo_verify_note(trial->bench->v, "first_order_um and laid_on_involute_um are for information and are not compared.");
  }
}

static void check_interpolation(const struct trial *trial, struct eo_case *rows)
{
  for (int i = 0; i < eo_case_size(rows); i++) {
    struct eo_case *row = eo_case_at(rows, i), *delta = eo_case_need(row, "delta_um"),
                   *this_case = eo_case_need(row, "u_mm"), *the_case = eo_case_need(row, "y_mm");
    int end = end_index(trial, row),
        member = eo_case_need(row, "member") ? eo_case_choice(row, "member", eo_member_name, -1) : -1;
    const struct eo_flank_spline *spline = end < 0 || member < 0 ? NULL : trial->spline[member][end];
    if (!spline)
      eo_case_fault(row, "This flank has no grid.");
    for (int k = 0; k < eo_case_size(delta) && !eo_case_faulty(row); k++)
      eo_verify_number(trial->bench->v, eo_case_at(delta, k),
                       1e6 * eo_flank_spline_at(spline, 1e-3 * eo_case_element(this_case, k),
                                                1e-3 * eo_case_element(the_case, k), NULL),
                       0, 1e-4);
  }
}

/* Deviations tooth by tooth on the flanks of the case. */
static enum eo_code run_pitch(const struct trial *trial, struct eo_error *error)
{
  struct eo_pitch_bench bench = {.ends = trial->ends, .inwards = trial->running.inwards, .hold = trial->hold};
  for (int end = 0; end < trial->ends; end++) {
    bench.grid[end] = trial->bench->half[end].pair->grid;
    bench.gap[end] = trial->gaps[end].gap;
  }
  return eo_verify_pitch(trial->bench->v, trial->item, &bench, error);
}

static enum eo_code run_trial(struct trial *trial, struct eo_error *error)
{
  struct eo_case *expected = eo_case_need(trial->item, "expected"), *results = eo_case_find(expected, "results");
  EO_TRY(read_case(trial, error));
  if (eo_case_find(trial->item, "discretisation"))
    eo_case_skip(eo_case_find(trial->item, "discretisation"));
  absolute(trial, "gap_um", 1); /* all cases state the same tolerances, whether they use them or not */
  absolute(trial, "float_um", 1);
  relative(trial, "load_rel", 0.5);
  static const char *const remarks[] = {"curve_note", "gap_points_note", "interpolation_note"};
  for (int i = 0; i < 3; i++)
    eo_case_remark(expected, remarks[i]);
  if (eo_case_faulty(trial->item))
    return EO_OK;
  EO_TRY(set_gaps(trial, error));
  if (eo_case_find(trial->item, "pitch"))
    return run_pitch(trial, error);
  for (int i = 0; i < eo_case_size(results); i++)
    EO_TRY(check_result(trial, eo_case_at(results, i)));
  if (eo_case_find(expected, "curve"))
    check_curve(trial, eo_case_find(expected, "curve"));
  check_interpolation(trial, eo_case_find(expected, "interpolation"));
  check_gap_points(trial, eo_case_find(expected, "gap_points"));
  return EO_OK;
}

static enum eo_code run_case(void *context, struct eo_case *item, struct eo_error *error)
{
  struct bench *bench = context;
  struct trial *trial = calloc(1, sizeof *trial);
  if (!trial)
    return eo_error_memory(error);
  trial->bench = bench;
  trial->item = item;
  trial->tolerance = eo_case_find(item, "tolerance");
  enum eo_code code = run_trial(trial, error);
  for (int end = 0; end < 2; end++) {
    eo_loaded_gaps_done(&trial->gaps[end]);
    eo_loaded_end_done(&trial->loaded[end]);
    for (int member = 0; member < 2; member++)
      eo_flank_spline_free(trial->spline[member][end]);
  }
  free(trial);
  return code;
}

static enum eo_code read_conventions(struct bench *bench)
{
  struct eo_case *words = eo_case_find(bench->file, "conventions");
  struct eo_case *form = words ? eo_case_find(words, "closed_form_flexibility") : NULL;
  if (form)
    eo_case_closed_form(form, &bench->form);
  else
    eo_case_fault(bench->file, "The closed-form flexibility is stated in \"conventions\".");
  return EO_OK;
}

static const struct eo_verify_block blocks[] = {
    {"pairs", EO_BLOCK_EITHER, check_pairs},
    {"iso_1328_1_2013", EO_BLOCK_WHOLE, check_tolerances},
    {"cases", EO_BLOCK_EACH, run_case},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_deviations(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct bench *bench = calloc(1, sizeof *bench);
  if (!bench)
    return eo_error_memory(error);
  bench->file = file;
  bench->v = verification;
  eo_case_need(file, "cases");
  read_conventions(bench);
  enum eo_code code = eo_case_faulty(file) ? EO_OK : eo_verify_blocks(verification, file, blocks, bench, error);
  for (int end = 0; end < 2; end++)
    drop(&bench->half[end]);
  free(bench);
  return code;
}
