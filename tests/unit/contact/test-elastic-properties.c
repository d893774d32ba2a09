/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact on bodies that twist and bend: that the coupled solution is one (against plain iteration, and by
   putting it back), what must hold for any drive side, support and stagger, and that the option leaves no trace when it
   is off. Teeth have a compliance in closed form, so that no finite elements are needed. */
#include "contact/elastic.h"
#include "evaluation/evaluator.h"
#include "flexibility/closed_form.h"
#include "support/paper-pair.h"
#include "support/shaft-load.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 16, NODES = EO_DEFLECTION_NODES };

static const double LOAD = 8638.6; /* of the paper's 828 N m */
static const struct eo_closed_form teeth = {6e-9, 0.02, 0, 20, 0};

/* Everything that one kind of pair needs; results of both ends. */
struct bench {
  struct eo_gear_pair pair;
  struct eo_geometry geometry;
  struct eo_material steel;
  struct eo_contact_grid *grid;
  struct eo_loaded_workspace *workspace;
  struct eo_gap_field field[2];
  struct eo_loaded_gaps gaps[2];
  struct eo_loaded_end result[2];
};

static struct eo_shafts paper_shafts(enum eo_drive_side pinion, enum eo_drive_side gear)
{
  return (struct eo_shafts){.enabled = true,
                            .bearing_position = {{-0.1075, 0.1075}, {-0.1075, 0.1075}},
                            .shaft_diameter = {0.0757, 0.2176},
                            .drive_side = {pinion, gear}};
}

static void build(struct bench *b, int ends, double in_plane_deg, double crowning)
{
  struct eo_error error = {0};
  struct eo_contact_grid_settings settings = {
      .positions = POSITIONS, .cells = 20, .tip_edges = true, .edge_cells = 6, .edge_reach = NAN};
  struct eo_flank_modification flank = {.lead_crowning = crowning}, none = {0};
  *b = (struct bench){.pair = paper_pair(), .steel = paper_steel()};
  b->pair.ends = ends;
  b->pair.groove_diameter[EO_PINION] = 0.0946;
  b->pair.groove_diameter[EO_GEAR] = 0.272;
  enum eo_code code = eo_geometry_init(&b->geometry, &b->pair, &error);
  if (!code)
    code = eo_contact_grid_new(&b->grid, &b->geometry, &b->steel, &settings, NULL,
                               (struct eo_kernel){eo_closed_form_kernel, &teeth}, NULL, &error);
  if (!code)
    code = eo_loaded_workspace_new(&b->workspace, b->grid, &error);
  for (int end = 0; end < 2 && !code; end++) {
    code = eo_loaded_gaps_init(&b->gaps[end], b->grid, &error) ? error.code
                                                               : eo_loaded_end_init(&b->result[end], b->grid, &error);
    double pivot = ends == 2 ? (b->geometry.face_width + b->pair.groove_width) / 2 : 0;
    eo_gap_field_init(&b->field[end], &b->geometry, &flank, &none, end, in_plane_deg * M_PI / 180, 0, pivot,
                      b->grid->corner);
    eo_loaded_gaps_set(&b->gaps[end], b->grid, &b->field[end]);
  }
  if (code)
    printf("# %s\n", error.text);
}

static void clear_bench(struct bench *b)
{
  for (int end = 0; end < 2; end++) {
    eo_loaded_gaps_done(&b->gaps[end]);
    eo_loaded_end_done(&b->result[end]);
  }
  eo_loaded_workspace_free(b->workspace);
  eo_contact_grid_free(b->grid);
}

static void solve(struct bench *b, const struct eo_shafts *shafts, const struct eo_elastic_case *load,
                  struct eo_elastic_report *report, struct eo_elastic **keep)
{
  struct eo_error error = {0};
  struct eo_elastic *elastic;
  const struct eo_contact_grid *const grid[2] = {b->grid, b->grid};
  struct eo_loaded_workspace *const workspace[2] = {b->workspace, b->workspace};
  if (eo_elastic_new(&elastic, grid, &b->pair, shafts, false, &error))
    printf("# %s\n", error.text);
  for (int end = 0; end < b->pair.ends; end++)
    eo_loaded_solve(b->workspace, b->grid, &b->gaps[end], load->compliance_factor, 1, &load->load, &b->result[end]);
  eo_elastic_solve(elastic, workspace, b->gaps, load, b->result, report);
  if (keep)
    *keep = elastic;
  else
    eo_elastic_free(elastic);
}

/* Share of the load of an end on the outer half of its face, mean over the cycle. */
static double outer_share(const struct bench *b, int end)
{
  double outer = 0, total = 0;
  for (int j = 0; j < POSITIONS; j++)
    for (int i = 0; i < b->grid->position[j].points; i++) {
      const struct eo_contact_position *p = &b->grid->position[j];
      double force = b->result[end].line_load[p->first + i] * p->length[i];
      outer += p->point[i].eta > 0 ? force : 0;
      total += force;
    }
  return outer / total;
}

static double difference(int n, const double *a, const double *b)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* A small rotation of a rigid body in the plane of action is a shaft angle error; at tip corners but for the cosine by
   which the normal there is turned. */
static void test_field(void)
{
  struct bench b;
  build(&b, 2, 0, 5e-6);
  double angle = 1e-4, worst = 0, beyond = 0, slope_error = 0, lowest = INFINITY,
         alpha = b.geometry.working_pressure_angle;
  double offset = (b.geometry.face_width + b.pair.groove_width) / 2, cosine = cos(b.geometry.base_helix_angle),
         sine = sin(b.geometry.base_helix_angle);
  for (int end = 0; end < 2; end++) {
    struct eo_gap_field turned;
    struct eo_flank_modification flank = {.lead_crowning = 5e-6}, none = {0};
    struct eo_deflection rigid;
    double sign = end == EO_LEFT ? -1 : 1;
    eo_gap_field_init(&turned, &b.geometry, &flank, &none, end, -angle * sin(alpha), angle * cos(alpha), offset,
                      b.grid->corner);
    for (int i = 0; i < NODES; i++) {
      double eta = b.geometry.face_width * (i / (NODES - 1.) - 0.5);
      rigid.part[0][i] = sign * cosine * (offset + eta) * angle;
      rigid.part[1][i] = sign * sine * angle;
    }
    b.field[end].deflection = &rigid;
    for (int k = 0; k < 900; k++) {
      double s = -15.5e-3 + 30e-3 * k / 900, eta = b.geometry.face_width * (k % 37 / 36. - 0.5), slope[2];
      double here = eo_gap_field_at(&b.field[end], s, eta, &slope[0], NULL),
             off = fabs(here - eo_gap_field_at(&turned, s, eta, &slope[1], NULL));
      bool inside = s > b.geometry.path_start && s < b.geometry.path_end;
      if (!inside) {
        beyond = fmax(beyond, off / (cosine * (offset + eta) * angle));
        continue;
      }
      worst = fmax(worst, off);
      slope_error = fmax(slope_error, fabs(slope[0] - slope[1]));
      lowest = fmin(lowest, here - eo_gap_field_datum(&b.field[end]));
    }
    worst = fmax(worst, fabs(eo_gap_field_datum(&turned) - eo_gap_field_datum(&b.field[end])));
  }
  ok(worst < 2e-9 && slope_error < 3e-6,
     "a rigid rotation as a deflection is the shaft angle error: off by %.2g m, slope %.2g", worst, slope_error);
  ok(beyond < 3e-3, "a rigid rotation is the shaft angle error beyond the path too, off by %.2g", beyond);
  ok(lowest > -1e-12 && lowest < 5e-7, "no gap is below the datum, %.2g m", lowest);
  clear_bench(&b);
}

static void set_load(const struct bench *b, int end, int j, struct eo_deflection *load)
{
  const struct eo_contact_position *p = &b->grid->position[j];
  memset(load, 0, sizeof *load);
  for (int i = 0; i < p->points; i++) {
    shaft_load_add(load, b->geometry.face_width, p->path[i], p->point[i].eta,
                   b->result[end].line_load[p->first + i] * p->length[i]);
  }
}

/* Contact, loads, deflection, gaps, and again, over the whole cycle. */
static int iterate(struct bench *b, const struct eo_shafts *shafts, double most)
{
  struct eo_error error;
  struct eo_shaft_influence influence;
  struct eo_loaded_gaps bent[2];
  double change = 1, load = LOAD;
  int count = 0;
  eo_shaft_influence_init(&influence, &b->geometry, &b->pair, &b->steel, shafts, false, &error);
  for (int end = 0; end < 2; end++) {
    eo_loaded_gaps_init(&bent[end], b->grid, &error);
    memcpy(bent[end].gap, b->gaps[end].gap, sizeof(double) * (size_t)b->grid->points);
  }
  for (count = 0; count < 200 && change > most; count++) {
    change = 0;
    for (int end = 0; end < 2; end++)
      eo_loaded_solve(b->workspace, b->grid, &bent[end], 1, 1, &load, &b->result[end]);
    for (int j = 0; j < POSITIONS; j++) {
      const struct eo_contact_position *p = &b->grid->position[j];
      struct eo_deflection force[2], deflection[2];
      for (int end = 0; end < 2; end++)
        set_load(b, end, j, &force[end]);
      eo_shaft_deflect(&influence, force, deflection);
      for (int end = 0; end < 2; end++)
        for (int i = 0; i < p->points; i++) {
          double gap = b->gaps[end].gap[p->first + i] +
                       shaft_deflection_at(&deflection[end], b->geometry.face_width, p->path[i], p->point[i].eta);
          change = fmax(change, fabs(gap - bent[end].gap[p->first + i]));
          bent[end].gap[p->first + i] = gap;
        }
    }
  }
  for (int end = 0; end < 2; end++)
    eo_loaded_gaps_done(&bent[end]);
  eo_shaft_influence_done(&influence);
  return count;
}

static void test_against_iteration(void)
{
  struct bench b, plain;
  struct eo_shafts shafts = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_LEFT);
  struct eo_elastic_report report;
  build(&b, 2, 0.02, 0);
  build(&plain, 2, 0.02, 0);
  solve(&b, &shafts, &(struct eo_elastic_case){LOAD, 1, {.stiffness = 0}, 0}, &report, NULL);
  int count = iterate(&plain, &shafts, 1e-12);
  double approach = 0, load = 0;
  for (int end = 0; end < 2; end++) {
    approach = fmax(approach, difference(POSITIONS, b.result[end].approach, plain.result[end].approach));
    load = fmax(load, difference(b.grid->points, b.result[end].line_load, plain.result[end].line_load));
  }
  ok(report.failures == 0 && report.most_iterations <= 5,
     "the bodies take at most %d iterations at a position, %d in all", report.most_iterations, report.iterations);
  ok(approach < 2e-11 && load < 2,
     "plain iteration (%d times round) finds the same: Z within %.2g m, line load within %.2g N/m", count, approach,
     load);
  ok(report.change > 1e-9 && report.change < 1e-6, "the deflection changes by %.3g um over the mesh cycle",
     1e6 * report.change);
  clear_bench(&b);
  clear_bench(&plain);
}

/* Ends with equal flanks on bodies driven from the left. */
static void test_ends_differ(void)
{
  struct bench b;
  struct eo_shafts shafts = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_LEFT);
  struct eo_elastic_report report;
  build(&b, 2, 0, 0);
  solve(&b, &shafts, &(struct eo_elastic_case){LOAD, 1, {.stiffness = 0}, 0}, &report, NULL);
  double left = outer_share(&b, EO_LEFT), right = outer_share(&b, EO_RIGHT);
  ok(left > 0.53 && left > right + 0.02,
     "torque from the left: %.3f of the left end's load, %.3f of the right one's on its outer half", left, right);
  ok(report.mean[EO_RIGHT].part[0][NODES / 2] > report.mean[EO_LEFT].part[0][NODES / 2] + 2e-6,
     "the end far from the drive gives way by %.2f um more",
     1e6 * (report.mean[EO_RIGHT].part[0][NODES / 2] - report.mean[EO_LEFT].part[0][NODES / 2]));
  clear_bench(&b);
}

static void test_mirror(void)
{
  struct bench b, mirrored;
  struct eo_shafts left = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_RIGHT),
                   right = paper_shafts(EO_DRIVE_RIGHT, EO_DRIVE_LEFT);
  struct eo_elastic_report report;
  left.bearing_position[EO_PINION][EO_RIGHT] = 0.15;
  right.bearing_position[EO_PINION][EO_LEFT] = -0.15;
  build(&b, 2, 0, 3e-6);
  build(&mirrored, 2, 0, 3e-6);
  solve(&b, &left, &(struct eo_elastic_case){LOAD, 1, {.stiffness = 0}, 0}, &report, NULL);
  solve(&mirrored, &right, &(struct eo_elastic_case){LOAD, 1, {.stiffness = 0}, 0}, &report, NULL);
  double most = 0, ends = difference(POSITIONS, b.result[0].approach, b.result[1].approach);
  for (int end = 0; end < 2; end++)
    most = fmax(most, difference(POSITIONS, b.result[end].approach, mirrored.result[1 - end].approach));
  ok(most < 1e-12 && ends > 1e-7,
     "mirrored drive sides and bearings exchange the ends: within %.2g m, the ends %.2g m apart", most, ends);
  clear_bench(&b);
  clear_bench(&mirrored);
}

/* Put back into the contact at fixed gaps, the solution must come out again. */
static void test_put_back(const char *what, double stiffness, int stagger, double factor, double in_plane_deg)
{
  struct bench b;
  struct eo_shafts shafts = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_LEFT);
  struct eo_elastic_report report;
  struct eo_elastic *elastic;
  struct eo_elastic_case load = {LOAD, factor, {.stiffness = stiffness}, stagger};
  struct eo_error error;
  build(&b, 2, in_plane_deg, 0);
  solve(&b, &shafts, &load, &report, &elastic);
  double *bent = calloc((size_t)b.grid->points, sizeof(double)), apart = 0, sum = 0, change = 0;
  double lean = sin(b.geometry.base_helix_angle),
         soft = stiffness > 0 && isfinite(stiffness) ? 4 * lean * lean / stiffness : 0;
  for (int j = 0; j < POSITIONS && stiffness > 0; j++) {
    int other = (j + POSITIONS - stagger) % POSITIONS;
    double shift = (b.result[0].load[j] - b.result[1].load[other]) / 2;
    apart = fmax(apart, fabs(b.result[0].approach[j] - b.result[1].approach[other] + soft * shift));
    sum = fmax(sum, fabs(b.result[0].load[j] + b.result[1].load[other] - 2 * LOAD));
  }
  struct eo_loaded_end again;
  eo_loaded_end_init(&again, b.grid, &error);
  for (int end = 0; end < 2; end++) {
    eo_elastic_gaps(elastic, b.gaps, stagger, b.result, end, bent);
    memcpy(again.line_load, b.result[end].line_load, sizeof(double) * (size_t)b.grid->points);
    memcpy(again.approach, b.result[end].approach, sizeof(double) * POSITIONS);
    for (int j = 0; j < POSITIONS; j++)
      eo_loaded_resolve(b.workspace, b.grid, bent, factor, j, b.result[end].load[j], &again);
    change = fmax(change, difference(POSITIONS, again.approach, b.result[end].approach));
  }
  ok(report.failures == 0 && change < 1.5e-11, "%s: %d iterations at most, put back within %.2g m", what,
     report.most_iterations, change);
  if (stiffness > 0)
    ok(apart < 1e-11 && sum < 1e-6, "%s: axial balance within %.2g m, loads within %.2g N", what, apart, sum);
  eo_loaded_end_done(&again);
  free(bent);
  eo_elastic_free(elastic);
  clear_bench(&b);
}

/* A shaft angle error far too large for a held pinion: one end carries all but nothing, and that is a result. */
static void test_one_end_lifted(void)
{
  struct bench b;
  struct eo_shafts shafts = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_LEFT);
  struct eo_elastic_report report;
  build(&b, 2, 0.15, 0);
  solve(&b, &shafts, &(struct eo_elastic_case){LOAD, 1, {.stiffness = INFINITY}, 0}, &report, NULL);
  ok(report.failures == 0 && b.result[0].load[0] < 0.01 * LOAD, "one end lifted off: %d failures, %.3g N left on it",
     report.failures, b.result[0].load[0]);
  clear_bench(&b);
}

/* Bodies so slender that plain iteration diverges. */
static void test_slender(void)
{
  struct bench b, plain;
  struct eo_shafts shafts = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_RIGHT);
  struct eo_elastic_report report;
  shafts.shaft_diameter[EO_PINION] = 0.03;
  for (int i = 0; i < 2; i++)
    shafts.bearing_position[i][EO_LEFT] = -(shafts.bearing_position[i][EO_RIGHT] = 0.6);
  build(&b, 2, 0.1, 0);
  build(&plain, 2, 0.1, 0);
  solve(&b, &shafts, &(struct eo_elastic_case){LOAD, 1, {.stiffness = 0}, 0}, &report, NULL);
  int count = iterate(&plain, &shafts, 1e-10);
  ok(report.failures == 0 && report.most_iterations <= 12 && count == 200,
     "slender shafts: %d iterations at most; plain iteration gave up after %d", report.most_iterations, count);
  clear_bench(&b);
  clear_bench(&plain);
}

static void test_single_end(void)
{
  struct bench b;
  struct eo_shafts shafts = paper_shafts(EO_DRIVE_LEFT, EO_DRIVE_LEFT);
  struct eo_elastic_report report;
  double share[2];
  build(&b, 1, 0, 0);
  for (int side = 0; side < 2; side++) {
    shafts.drive_side[EO_PINION] = shafts.drive_side[EO_GEAR] = side;
    for (int i = 0; i < 2; i++) {
      shafts.bearing_position[i][EO_LEFT] = -0.055;
      shafts.bearing_position[i][EO_RIGHT] = 0.055;
    }
    solve(&b, &shafts, &(struct eo_elastic_case){2 * LOAD, 1, {.stiffness = INFINITY}, 0}, &report, NULL);
    share[side] = outer_share(&b, EO_LEFT);
  }
  /* outer: + eta, to the left on the only end */
  ok(report.failures == 0 && share[0] > share[1] + 0.01,
     "single helical: %.3f of the load on the left half driven from the left, %.3f from the right", share[0], share[1]);
  clear_bench(&b);
}

/* The contact's answer to a change of its gaps and of its load, by differences. */
static void test_response(void)
{
  struct bench b;
  build(&b, 2, 0.05, 0);
  double load = LOAD, step = 2e-9, factor = 0.9, worst = 0, scale = 0, change[1000], answer[1000], expected;
  const struct eo_contact_position *p = &b.grid->position[5];
  struct eo_loaded_end *end = &b.result[0];
  double *bent = malloc(sizeof(double) * (size_t)b.grid->points), *before = malloc(sizeof(double) * (size_t)p->points);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[0], factor, 1, &load, end);
  for (int kind = 0; kind < 2; kind++) {
    memcpy(bent, b.gaps[0].gap, sizeof(double) * (size_t)b.grid->points);
    eo_loaded_resolve(b.workspace, b.grid, bent, factor, 5, load, end);
    memcpy(before, end->line_load + p->first, sizeof(double) * (size_t)p->points);
    double approach = end->approach[5];
    for (int i = 0; i < p->points; i++) {
      change[i] = 1 + sin(200 * p->point[i].eta);
      bent[p->first + i] += kind ? 0 : step * change[i];
    }
    double rise = eo_loaded_response(b.workspace, p, factor, kind ? NULL : change, answer);
    eo_loaded_resolve(b.workspace, b.grid, bent, factor, 5, kind ? load + 20 : load, end);
    expected = (end->approach[5] - approach) / (kind ? 20 : step);
    near(rise, expected, 0.01, kind ? "dZ/dP" : "change of the approach per unit of gap");
    worst = scale = 0;
    for (int i = 0; i < p->points; i++) {
      double rate = (end->line_load[p->first + i] - before[i]) * p->length[i] / (kind ? 20 : step);
      worst = fmax(worst, fabs(rate - answer[i]));
      scale = fmax(scale, fabs(rate));
    }
    ok(worst < 0.02 * scale, "change of the loads with the %s, off by %.2g", kind ? "load" : "gaps", worst / scale);
  }
  free(bent);
  free(before);
  clear_bench(&b);
}

static void set_design(struct eo_design *d)
{
  memset(d, 0, sizeof *d);
  d->gear_pair = paper_pair();
  d->material = paper_steel();
  d->supports = (struct eo_supports){.bearing_stiffness = {8e8, 1e9},
                                     .gear_axial_stiffness = {2e8, 2e8},
                                     .groove_axial_stiffness = {NAN, NAN},
                                     .groove_torsional_stiffness = {NAN, NAN},
                                     .mass = {NAN, NAN},
                                     .inertia = {NAN, NAN},
                                     .bearing_damping_ratio = 0.05,
                                     .groove_damping_ratio = 0.02,
                                     .mesh_damping_ratio = 0.07,
                                     .mesh_damping_stiffness = NAN};
  d->shafts = (struct eo_shafts){.bearing_position = {{NAN, NAN}, {NAN, NAN}}, .shaft_diameter = {NAN, NAN}};
  d->load_cases = 1;
  d->load_case[0] = (struct eo_load_case){.torque = 828, .speed = 2000 * M_PI / 30, .share = 1};
  d->objective.weight[0] = 1;
  d->resolution = (struct eo_resolution){.positions = POSITIONS,
                                         .cells_per_line = 20,
                                         .tip_edge_contact = true,
                                         .impact_patch = 5e-3,
                                         .harmonics = 24,
                                         .te_harmonics = 6};
  for (int i = 0; i < 2; i++)
    d->gear_pair.groove_diameter[i] = NAN;
}

static void test_option(void)
{
  static struct eo_design d;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *r;
  double first[POSITIONS], first_contact[POSITIONS], impact, stiffness, bent[POSITIONS], rms;
  set_design(&d);
  enum eo_code code = eo_geometry_init(&geometry, &d.gear_pair, &error);
  eo_design_resolve(&d, &geometry);
  if (!code)
    code = eo_pair_new(&pair, &d, &(struct eo_pair_options){.kernel = {eo_closed_form_kernel, &teeth}}, NULL, &error);
  if (!code)
    code = eo_evaluator_new(&evaluator, pair, 1, &error);
  if (!code)
    code = eo_evaluator_run(evaluator, &d, NULL, 0, &r, &error);
  if (!ok(!code, "an evaluation on rigid bodies succeeds %s", error.text))
    return;
  const struct eo_case_result *c = &r->load_case[0];
  memcpy(first, c->transmission, sizeof first);
  memcpy(first_contact, c->end[0].unloaded, sizeof first_contact);
  impact = c->end[0].impact.force;
  stiffness = 0;
  for (int j = 0; j < POSITIONS; j++)
    stiffness = fmax(stiffness, c->end[0].stiffness[j]);
  rms = c->vibration.rms_pair[0];
  ok(r->equal_ends && c->body_iterations == 0, "equal ends on rigid bodies are computed once");

  d.shafts.enabled = true;
  code = eo_evaluator_run(evaluator, &d, NULL, EO_WANT_BAND, &r, &error);
  memcpy(bent, c->transmission, sizeof bent);
  ok(!code && !r->equal_ends && c->contact_failures == 0 && c->body_iterations > 1,
     "the ends on elastic bodies differ, after %d iterations", c->body_iterations);
  ok(fabs(c->end[0].impact.force - c->end[1].impact.force) > 20 && c->end[0].impact.force > impact,
     "entering impact %.0f N rigid, %.0f N left, %.0f N right", impact, c->end[0].impact.force, c->end[1].impact.force);
  ok(c->vibration.rms_pair[0] != rms && isfinite(c->band[0][0]) && isfinite(c->band[0][1]),
     "vibration %.3g m/s2 rigid, %.3g on elastic bodies", rms, c->vibration.rms_pair[0]);
  double unloaded = fmax(difference(POSITIONS, c->end[0].unloaded, first_contact),
                         difference(POSITIONS, c->end[1].unloaded, first_contact));
  ok(unloaded == 0 && c->end[1].datum == c->end[0].datum && c->end[1].loaded_datum > c->end[1].datum + 2e-6,
     "unloaded contact stays that of rigid bodies; loaded, the right end's flanks are %.2f um further apart",
     1e6 * (c->end[1].loaded_datum - c->end[1].datum));
  int strange = 0;
  for (int end = 0; end < 2; end++)
    for (int j = 0; j < POSITIONS; j++)
      strange += !(c->end[end].stiffness[j] > 0.5 * stiffness && c->end[end].stiffness[j] < stiffness);
  ok(strange == 0, "uneven gaps make the teeth softer, by less than half");

  d.resolution.mesh_law = EO_LAW_TABLE;
  code = eo_evaluator_run(evaluator, &d, NULL, 0, &r, &error);
  struct eo_dynamics_parameters parameters;
  struct eo_vibration_case problem;
  double rows[64], miss = 0;
  eo_evaluator_vibration(evaluator, 0, &parameters, &problem);
  for (int j = 0; j < POSITIONS; j++) {
    eo_law_rows(problem.law[EO_RIGHT], (double)j / POSITIONS, rows);
    miss += (eo_law_deflection(problem.law[EO_RIGHT], rows, c->force) - c->end[EO_RIGHT].loaded.approach[j]) /
            POSITIONS;
  }
  close_to(miss, 0, 1e-10, "the load of the table law at the loaded approach, mean over the cycle");
  ok(!code && memcmp(bent, c->transmission, sizeof bent) == 0,
     "a second evaluation on elastic bodies gives the same bytes");

  d.resolution.mesh_law = EO_LAW_TANGENT;
  d.shafts.enabled = false;
  code = eo_evaluator_run(evaluator, &d, NULL, 0, &r, &error);
  ok(!code && memcmp(first, c->transmission, sizeof first) == 0 && c->end[0].impact.force == impact,
     "an evaluation after elastic bodies gives the bytes of one that never had them");
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
}

int main(void)
{
  test_field();
  test_response();
  test_against_iteration();
  test_ends_differ();
  test_mirror();
  test_put_back("floating", 0, 0, 1, 0.02);
  test_put_back("floating, staggered, softer teeth", 0, 5, 1.3, 0.05);
  test_put_back("fixed", INFINITY, 0, 1, 0.01);
  test_put_back("fixed, staggered", INFINITY, 7, 1, 0);
  test_put_back("on a spring", 2e8, 3, 1, 0.03);
  test_one_end_lifted();
  test_slender();
  test_single_end();
  test_option();
  return tap_done();
}
