/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What holds for every evaluation, on a coarse finite-element pair: equal ends once or twice, no memory, scenarios,
   laws, bands, threads. */
#include "design/design_grids.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/evaluator.h"
#include "evaluation/objective_anatomy.h"
#include "support/tap.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* A design has hundreds of kilobytes: each test has those of its own on the stack, not those of all. */
#define NOT_INLINE __attribute__((noinline))

enum { MOST_CASES = 4, POSITIONS = 32 };

static struct eo_pair *pair;
static struct eo_evaluator *evaluator;

static void stop(const struct eo_error *error)
{
  printf("Bail out! %s: %s\n", error->pointer, error->text);
  exit(1);
}

/* An example of the paper with a coarse mesh and without shaft error. */
static struct eo_design design_of(const char *name)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build(name, &design);
  design.alignment.shaft_angle_in_plane = 0;
  design.resolution.elements.layers = 8;
  design.resolution.elements.flank_rows = 5;
  design.resolution.elements.fillet_elements = 8;
  design.resolution.elements.body = EO_BODY_SECTOR;
  design.resolution.elements.sector_teeth = 3;
  design.resolution.positions = POSITIONS;
  design.resolution.cells_per_line = 15;
  if (eo_design_complete(&design, &geometry, &error))
    stop(&error);
  return design;
}

static struct eo_pair *make_pair(const struct eo_design *design)
{
  struct eo_pair_options options = {0};
  struct eo_pair *made;
  struct eo_error error;
  if (eo_pair_new(&made, design, &options, NULL, &error))
    stop(&error);
  return made;
}

static struct eo_evaluator *make_evaluator(const struct eo_pair *of)
{
  struct eo_evaluator *made;
  struct eo_error error;
  if (eo_evaluator_new(&made, of, MOST_CASES, &error))
    stop(&error);
  return made;
}

static const struct eo_evaluation *run(const struct eo_design *design, const struct eo_scenario *scenario, int want)
{
  const struct eo_evaluation *r;
  struct eo_error error;
  if (eo_evaluator_run(evaluator, design, scenario, want, &r, &error))
    stop(&error);
  return r;
}

/* Everything an evaluation says about its load cases, in one array: a fingerprint that any change shows in. */
enum { PER_END = 4 * POSITIONS + 12, PER_CASE = 2 * PER_END + POSITIONS + 40 };
struct record {
  int count;
  double value[MOST_CASES * PER_CASE];
};

static void put(struct record *record, int n, const double *value)
{
  memcpy(record->value + record->count, value, sizeof *value * (size_t)n);
  record->count += n;
}

static void put_end(struct record *record, const struct eo_end_result *e)
{
  double single[] = {e->datum,        e->max_pressure, e->max_line_load, e->edge_share,      e->transmission_peak,
                     e->impact.force, e->impact.phase, e->impact.speed,  e->impact.duration, e->impact.start,
                     e->impact.eta};
  put(record, POSITIONS, e->loaded.approach);
  put(record, POSITIONS, e->loaded.tangent);
  put(record, POSITIONS, e->unloaded);
  put(record, POSITIONS, e->stiffness);
  put(record, (int)(sizeof single / sizeof *single), single);
}

static struct record record_of(const struct eo_evaluation *r)
{
  struct record record = {0};
  for (int k = 0; k < r->cases; k++) {
    const struct eo_case_result *c = &r->load_case[k];
    double single[] = {c->peak_to_peak,
                       c->mean,
                       c->dynamic_force_factor,
                       c->vibration.dynamic_factor[0],
                       c->vibration.dynamic_factor[1],
                       c->vibration.contact_loss[0],
                       r->objective[k].impact,
                       r->objective[k].contact_pressure};
    for (int end = 0; end < r->ends; end++)
      put_end(&record, &c->end[end]);
    put(&record, POSITIONS, c->transmission);
    put(&record, 2 * EO_READINGS, &c->vibration.rms[0][0]);
    put(&record, EO_READINGS, c->vibration.rms_pair);
    put(&record, (int)(sizeof single / sizeof *single), single);
  }
  return record;
}

static bool same(const struct record *a, const struct record *b)
{
  return a->count == b->count && memcmp(a->value, b->value, sizeof *a->value * (size_t)a->count) == 0;
}

static bool finite_record(const struct record *record)
{
  bool finite = true;
  for (int i = 0; i < record->count; i++)
    finite = finite && isfinite(record->value[i]);
  return finite;
}

static NOT_INLINE void test_equal_ends(void)
{
  struct eo_design design = design_of("paper-case-a");
  const struct eo_evaluation *r = run(&design, NULL, 0);
  struct record once = record_of(r);
  ok(r->equal_ends, "aligned ends with the same flanks are computed once");
  design.alignment.shaft_angle_in_plane = 1e-200; /* too small to change a bit, but not zero */
  r = run(&design, NULL, 0);
  struct record twice = record_of(r);
  ok(!r->equal_ends && same(&once, &twice), "ends computed once equal computing both to the last bit");
  ok(finite_record(&once), "an evaluation has no number that is none");
}

/* A single helical pair under half the torque is one end of the herringbone pair. */
static NOT_INLINE void test_single_end(void)
{
  struct eo_design design = design_of("paper-case-a"), single = design;
  struct eo_geometry geometry;
  struct eo_error error;
  struct record both = record_of(run(&design, NULL, 0));
  single.gear_pair.ends = 1;
  memset(single.modification.flank[EO_PINION] + EO_RIGHT, 0, sizeof(struct eo_flank_modification));
  for (int k = 0; k < single.load_cases; k++)
    single.load_case[k].torque /= 2;
  ok(eo_geometry_init(&geometry, &single.gear_pair, &error) == EO_OK, "a pair with one end is made");
  eo_design_resolve(&single, &geometry);
  struct eo_pair *kept_pair = pair;
  struct eo_evaluator *kept = evaluator;
  ok(!eo_pair_serves(pair, &single), "a pair with one end needs its own preparation");
  pair = make_pair(&single);
  evaluator = make_evaluator(pair);
  const struct eo_evaluation *r = run(&single, NULL, 0);
  ok(r->ends == 1 &&
         memcmp(r->load_case[1].end[0].loaded.approach, both.value + both.count / 3, sizeof(double) * POSITIONS) == 0,
     "the contact of a single end is that of one end of the herringbone pair under twice the torque");
  ok(r->load_case[1].vibration.outcome != EO_VIBRATION_NOT_CONVERGED && r->objective[1].rms > 0,
     "a single end vibrates");
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  evaluator = kept;
  pair = kept_pair;
}

/* Left and right flanks and the shaft errors exchanged. */
static NOT_INLINE void test_mirror(void)
{
  struct eo_design design = design_of("paper-case-b"), mirrored;
  design.alignment.shaft_angle_in_plane = 1e-3;
  mirrored = design;
  mirrored.alignment.shaft_angle_in_plane = -1e-3;
  mirrored.modification.flank[EO_PINION][EO_LEFT] = design.modification.flank[EO_PINION][EO_RIGHT];
  mirrored.modification.flank[EO_PINION][EO_RIGHT] = design.modification.flank[EO_PINION][EO_LEFT];
  const struct eo_evaluation *r = run(&design, NULL, 0);
  double rms[2] = {r->load_case[1].vibration.rms[0][0], r->load_case[1].vibration.rms[0][1]},
         force[2] = {r->load_case[1].end[0].impact.force, r->load_case[1].end[1].impact.force};
  double peak = r->load_case[1].peak_to_peak;
  r = run(&mirrored, NULL, 0);
  near(r->load_case[1].peak_to_peak, peak, 1e-12, "transmission error of the mirrored pair");
  ok(r->load_case[1].end[0].impact.force == force[1] && r->load_case[1].end[1].impact.force == force[0],
     "the mirrored pair has the impacts exchanged");
  near(r->load_case[1].vibration.rms[0][0], rms[1], 1e-6, "vibration of the mirrored pair's left end");
  near(r->load_case[1].vibration.rms[0][1], rms[0], 1e-6, "vibration of the mirrored pair's right end");
}

static NOT_INLINE void test_no_memory(void)
{
  struct eo_design a = design_of("paper-case-a"), b = design_of("paper-case-b"), plain = design_of("paper");
  a.alignment.shaft_angle_in_plane = 1.7e-3;
  struct record first = record_of(run(&a, NULL, 0));
  b.resolution.mesh_law = EO_LAW_TABLE;
  b.resolution.harmonics = 12;
  b.load_cases = 1;
  b.alignment.pinion_axial = EO_AXIAL_SPRING;
  b.alignment.stagger = 0.3;
  run(&b, NULL, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES);
  plain.resolution.mesh_law = EO_LAW_SECANT;
  run(&plain, NULL, EO_WANT_CURVES);
  struct record again = record_of(run(&a, NULL, 0));
  ok(same(&first, &again), "an evaluator remembers nothing: the same bytes after other designs, laws and wishes");
  struct record wanting = record_of(run(&a, NULL, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES));
  ok(same(&first, &wanting), "asking for more changes nothing");
  const struct eo_evaluation *r;
  struct eo_error error;
  bool equal = eo_evaluator_contact(evaluator, &a, &r, &error) == EO_OK;
  for (int j = 0; j < POSITIONS; j++)
    equal = equal && r->load_case[0].transmission[j] == first.value[2 * (4 * POSITIONS + 11) + j];
  ok(equal, "contact alone is the static half of an evaluation");
}

struct worker {
  struct eo_design design;
  struct record record;
};

static void *work(void *argument)
{
  struct worker *w = argument;
  struct eo_evaluator *own = make_evaluator(pair);
  const struct eo_evaluation *r;
  struct eo_error error;
  for (int i = 0; i < 3; i++)
    if (eo_evaluator_run(own, &w->design, NULL, 0, &r, &error))
      stop(&error);
  w->record = record_of(r);
  eo_evaluator_free(own);
  return NULL;
}

static NOT_INLINE void test_threads(void)
{
  static struct worker worker[2];
  pthread_t thread[2];
  for (int i = 0; i < 2; i++) {
    worker[i].design = design_of(i ? "paper-case-b" : "paper-case-a");
    worker[i].design.alignment.shaft_angle_in_plane = 1.7e-3;
    pthread_create(&thread[i], NULL, work, &worker[i]);
  }
  for (int i = 0; i < 2; i++)
    pthread_join(thread[i], NULL);
  for (int i = 0; i < 2; i++) {
    struct record alone = record_of(run(&worker[i].design, NULL, 0));
    ok(same(&alone, &worker[i].record), "two evaluators on one pair at once give the same bytes as alone");
  }
}

static NOT_INLINE void test_scenarios(void)
{
  struct eo_design plain = design_of("paper");
  double mean = run(&plain, NULL, 0)->load_case[0].mean, force = run(&plain, NULL, 0)->load_case[0].end[0].impact.speed;
  const struct eo_evaluation *r = run(&plain, &(struct eo_scenario){NAN, NAN, 1.1, 1}, 0);
  ok(r->load_case[0].mean > 1.09 * mean && r->load_case[0].mean <= 1.1 * mean * (1 + 1e-9),
     "a tenth more compliance gives %.4f of the deflection", r->load_case[0].mean / mean);
  r = run(&plain, &(struct eo_scenario){NAN, NAN, 1, 1.2}, 0);
  near(r->load_case[0].mean, mean, 1e-15, "mean transmission error at another running speed");
  near(r->load_case[0].end[0].impact.speed, 1.2 * force, 1e-12, "speed of the impact at another running speed");
  near(r->load_case[0].vibration.frequency, 1.2 * plain.load_case[0].speed * 17, 1e-12,
       "mesh frequency at another running speed");
  struct eo_design tilted = plain;
  tilted.alignment.shaft_angle_in_plane = 1e-3;
  tilted.alignment.shaft_angle_out_of_plane = 2e-4;
  struct record direct = record_of(run(&tilted, NULL, 0)),
                scenario = record_of(run(&plain, &(struct eo_scenario){1e-3, 2e-4, 1, 1}, 0));
  ok(same(&direct, &scenario), "shaft errors of a scenario replace the nominal ones");
  struct record nominal = record_of(run(&tilted, &(struct eo_scenario){NAN, NAN, 1, 1}, 0));
  ok(same(&direct, &nominal), "a scenario without shaft errors leaves the nominal ones");
}

/* The parts put together are J without penalties, but for what lies between the samples of a curve. */
static void check_anatomy(const struct eo_design *given, const struct eo_objective_case *raw,
                          const struct eo_objective_case *before, double objective, enum eo_robust robust)
{
  struct eo_design design = *given;
  struct eo_anatomy anatomy;
  struct eo_error error;
  design.objective.robust = robust;
  const int scenarios = eo_evaluator_scenarios(&design), rows = scenarios * design.load_cases;
  const enum eo_code code = eo_objective_anatomy(&design, scenarios, before, &anatomy, &error);
  if (robust == EO_ROBUST_WORST) {
    ok(code == EO_OK && anatomy.parts == 0 && anatomy.groups == 0, "the worst of several scenarios has no parts");
    return;
  }
  ok(code == EO_OK && anatomy.groups == 3 * rows, "the anatomy of J has %d parts of %d load cases and scenarios",
     anatomy.parts, rows);
  double *part = malloc((size_t)anatomy.parts * sizeof *part);
  eo_objective_parts(raw, rows, part);
  near(eo_anatomy_sum(&anatomy, part), objective, 0.01, "sum of the parts of J");
  for (int row = 0; row < rows; row++) /* with the whole range in place of the samples' */
    part[row * anatomy.parts / rows] = raw[row].peak_to_peak;
  for (int row = 0; row < rows; row++)
    for (int i = 1; i < EO_OBJECTIVE_SAMPLES; i++)
      part[row * anatomy.parts / rows + i] = 0;
  near(eo_anatomy_sum(&anatomy, part), objective, 1e-12, "sum of the parts with the range of the whole curve");
  free(part);
  free(anatomy.group);
}

static NOT_INLINE void test_robust(void)
{
  struct eo_design design = design_of("paper-case-a"), unmodified = design;
  struct eo_objective_case raw[3 * MOST_CASES], before[3 * MOST_CASES];
  struct eo_objective_value one[3], mean, worst;
  struct eo_error error;
  memset(&unmodified.modification, 0, sizeof unmodified.modification);
  design.objective.scenarios = unmodified.objective.scenarios = 3;
  design.objective.contact_pressure = unmodified.objective.contact_pressure = 900e6;
  for (int s = 0; s < 3; s++)
    design.objective.scenario[s] = unmodified.objective.scenario[s] = (struct eo_scenario){s * 0.8e-3, NAN, 1,
                                                                                           1 + 0.05 * s};
  design.objective.robust = unmodified.objective.robust = EO_ROBUST_MEAN;
  ok(eo_evaluator_scenarios(&design) == 3, "a design of three scenarios counts three");
  ok(eo_evaluator_raw(evaluator, &design, raw, &error) == EO_OK &&
         eo_evaluator_raw(evaluator, &unmodified, before, &error) == EO_OK,
     "raw values of both modifications are found");
  eo_evaluator_combine(&design, &pair->geometry, raw, before, &mean);
  design.objective.robust = EO_ROBUST_WORST;
  eo_evaluator_combine(&design, &pair->geometry, raw, before, &worst);
  int cases = design.load_cases;
  for (int s = 0; s < 3; s++)
    eo_objective_value(&design.objective, cases, design.load_case, raw + s * cases, before + s * cases, false, &one[s]);
  near(mean.objective, (one[0].objective + one[1].objective + one[2].objective) / 3, 1e-14,
       "mean objective of the scenarios");
  check_anatomy(&design, raw, before, mean.objective, EO_ROBUST_MEAN);
  check_anatomy(&design, raw, before, NAN, EO_ROBUST_WORST);
  near(mean.fitness,
       1 / mean.objective - design.objective.penalty * (one[0].violation + one[1].violation + one[2].violation) / 3,
       1e-14, "fitness of the mean");
  near(worst.fitness, fmin(one[0].fitness, fmin(one[1].fitness, one[2].fitness)), 0, "worst fitness of the scenarios");
  ok(one[0].violation > 0 || one[2].violation > 0, "a constraint of one scenario bites");
  double j[3] = {one[0].objective, one[1].objective, one[2].objective}, largest = fmax(j[0], fmax(j[1], j[2])),
         middle = j[0] + j[1] + j[2] - largest - fmin(j[0], fmin(j[1], j[2])), centre = (j[0] + j[1] + j[2]) / 3;
  design.objective.robust = EO_ROBUST_PERCENTILE;
  design.objective.robust_percent = 75;
  eo_evaluator_combine(&design, &pair->geometry, raw, before, &mean);
  near(mean.objective, (middle + largest) / 2, 1e-14, "75 % of three lies half way to the largest");
  design.objective.robust = EO_ROBUST_SIGMAS;
  design.objective.robust_sigmas = 2;
  eo_evaluator_combine(&design, &pair->geometry, raw, before, &mean);
  near(mean.objective, centre + 2 * sqrt((pow(j[0] - centre, 2) + pow(j[1] - centre, 2) + pow(j[2] - centre, 2)) / 2),
       1e-12, "mean and two standard deviations of J");
  ok(mean.violation > 0, "a limit that one scenario does not meet is not met");
  raw[1].failed = true;
  eo_evaluator_combine(&design, &pair->geometry, raw, before, &worst);
  design.objective.robust = EO_ROBUST_MEAN;
  eo_evaluator_combine(&design, &pair->geometry, raw, before, &mean);
  ok(worst.fitness == EO_FITNESS_WORST && mean.fitness == EO_FITNESS_WORST,
     "one scenario that failed spoils mean and worst");
}

/* Drawn pairs: the same deviations for both designs; a relief that is not there does not scatter. */
static NOT_INLINE void test_drawn(void)
{
  static struct eo_design design, made;
  struct eo_geometry geometry;
  struct eo_objective_case raw[4 * MOST_CASES], again[4 * MOST_CASES];
  struct eo_scenario scenario;
  struct eo_error error;
  design = design_of("paper-case-a");
  design.objective.robust = EO_ROBUST_PERCENTILE;
  design.objective.scatter_pairs = 4;
  design.tolerance.rows = 2;
  for (int i = 0; i < 2; i++) {
    design.tolerance.row[i] = (struct eo_scatter_row){.sigma = 5, .cut = NAN};
    strcpy(design.tolerance.row[i].key, i ? "modification.*.*.tip_relief_um" : "modification.*.*.helix_slope_um");
  }
  ok(eo_design_complete(&design, &geometry, &error) == EO_OK && design.drawn.pairs == 4 && design.drawn.inputs == 8,
     "four pairs of eight inputs are drawn");
  ok(eo_evaluator_scenarios(&design) == 4, "an evaluation counts the drawn pairs");
  eo_drawn_pair_apply(&design, 1, &made, &scenario);
  ok(made.modification.flank[EO_PINION][EO_LEFT].tip_relief != design.modification.flank[EO_PINION][EO_LEFT].tip_relief,
     "the relief of a drawn pair scatters");
  ok(made.modification.flank[EO_GEAR][EO_LEFT].tip_relief == 0, "a relief that is not made does not scatter");
  near(made.modification.flank[EO_GEAR][EO_LEFT].helix_slope, design.drawn.deviation[1][2], 1e-12,
       "slope of a drawn pair, its deviation");
  ok(eo_evaluator_raw(evaluator, &design, raw, &error) == EO_OK &&
         eo_evaluator_raw(evaluator, &design, again, &error) == EO_OK,
     "raw values of four pairs are found");
  ok(memcmp(raw, again, sizeof *raw * 4 * (size_t)design.load_cases) == 0 &&
         raw[0].peak_to_peak != raw[design.load_cases].peak_to_peak,
     "the drawn pairs differ, and are the same each time");
  design.objective.robust = EO_ROBUST_OFF;
  ok(eo_design_complete(&design, &geometry, &error) == EO_OK && design.drawn.pairs == 0,
     "no pairs are drawn where none are asked for");
}

static double rms_with(struct eo_design design, enum eo_mesh_law law, enum eo_solver solver)
{
  design.resolution.mesh_law = law;
  design.resolution.solver = solver;
  return run(&design, NULL, 0)->load_case[1].vibration.rms_pair[EO_READING_NORMAL];
}

/* The table is straight between its loads, so that it equals the tangent law to a per cent or two while teeth stay in
   contact; the secant law agrees only without gaps, and then roughly. */
static NOT_INLINE void test_laws(void)
{
  struct eo_design a = design_of("paper-case-a"), plain = design_of("paper");
  double tangent = rms_with(a, EO_LAW_TANGENT, EO_SOLVER_HARMONIC_BALANCE),
         table = rms_with(a, EO_LAW_TABLE, EO_SOLVER_HARMONIC_BALANCE);
  near(table, tangent, 0.02, "RMS by the table and the tangent law in contact, m/s2");
  near(rms_with(plain, EO_LAW_SECANT, EO_SOLVER_HARMONIC_BALANCE),
       rms_with(plain, EO_LAW_TANGENT, EO_SOLVER_HARMONIC_BALANCE), 0.2,
       "RMS by the secant and the tangent law without gaps, m/s2");
  near(rms_with(a, EO_LAW_TANGENT, EO_SOLVER_TIME_INTEGRATION), tangent, 1e-4,
       "RMS by time integration and harmonic balance, m/s2");
}

static NOT_INLINE void test_band(void)
{
  struct eo_design design = design_of("paper-case-a");
  design.alignment.shaft_angle_in_plane = 1e-3;
  const struct eo_evaluation *r = run(&design, NULL, EO_WANT_BAND);
  double band[2] = {r->load_case[1].band[EO_READING_NORMAL][0], r->load_case[1].band[EO_READING_NORMAL][1]};
  for (int side = 0; side < 2; side++) {
    struct eo_scenario scenario = {NAN, NAN, side ? 1.1 : 0.9, 1};
    near(band[side], run(&design, &scenario, 0)->load_case[1].vibration.rms_pair[EO_READING_NORMAL], 2e-5,
         "band of the RMS, in a scenario as in the nominal state, m/s2");
  }
  ok(isnan(run(&design, NULL, 0)->load_case[1].band[EO_READING_NORMAL][0]),
     "an evaluation has no band unless it is asked for");
}

static NOT_INLINE void test_curves(void)
{
  struct eo_design design = design_of("paper-case-b");
  const struct eo_evaluation *r = run(&design, NULL, EO_WANT_CURVES);
  const struct eo_case_result *c = &r->load_case[1];
  for (int end = 0; end < 2; end++) {
    double square = 0, orders = 0;
    for (int i = 0; i < r->samples; i++)
      square += c->end[end].curve[EO_CHANNEL_NORMAL][i] * c->end[end].curve[EO_CHANNEL_NORMAL][i] / r->samples;
    for (int h = 1; h <= r->harmonics; h++)
      orders += creal(c->end[end].order[EO_CHANNEL_NORMAL][h] * conj(c->end[end].order[EO_CHANNEL_NORMAL][h])) / 2;
    near(sqrt(square), c->vibration.rms[EO_READING_NORMAL][end], 1e-9, "RMS of the curve, m/s2");
    near(sqrt(orders), c->vibration.rms[EO_READING_NORMAL][end], 1e-9, "RMS of the orders, m/s2");
  }
}

static NOT_INLINE void test_root_stress(void)
{
  struct eo_design design = design_of("paper");
  const struct eo_evaluation *r = run(&design, NULL, EO_WANT_ROOT);
  ok(r->objective[1].root_stress > 30e6 && r->objective[1].root_stress < 80e6, "the root stress is %.1f MPa",
     1e-6 * r->objective[1].root_stress);
  ok(r->objective[2].root_stress > r->objective[1].root_stress &&
         r->objective[1].root_stress > r->objective[0].root_stress,
     "the root stress grows with the torque");
  r = run(&design, NULL, 0);
  ok(isnan(r->objective[1].root_stress) && r->load_case[1].end[0].root[0].phases == 0,
     "the root stress is not computed unless asked for");
  design.objective.root_stress = 1e9;
  ok(run(&design, NULL, 0)->objective[1].root_stress > 0, "the root stress is computed where it is constrained");
}

/* Of a tooth under the loads of a mesh position: from the finite elements' own influence, without modes. */
static double exact_stress(const struct eo_pair *of, int member, int tooth, const struct eo_contact_position *position,
                           const double *line_load)
{
  struct eo_root root = eo_flexibility_root(of->flexibility, member);
  struct eo_root_place place;
  double *force = malloc(sizeof *force * (size_t)position->points),
         *stress = malloc(sizeof *stress * (size_t)(root.points * (root.layers + 1) * EO_STRESSES));
  for (int i = 0; i < position->points; i++)
    force[i] = line_load[position->first + i] * position->length[i];
  eo_root_find_largest(of->flexibility, member, tooth, position->points, position->point, force, stress, &place);
  free(force);
  free(stress);
  return place.stress;
}

static bool can_touch(const struct eo_contact_position *position, int tooth)
{
  bool can = false;
  for (int l = 0; l < position->lines; l++)
    can = can || position->line[l].pair == tooth;
  return can;
}

/* The largest at any position, and the largest difference[2] of the history where others alone carry load, and where
   the tooth may. */
static double compare_roots(const struct eo_pair *of, const struct eo_end_result *end, int member, double *difference)
{
  const struct eo_contact_grid *grid = of->grid;
  double largest = 0;
  int range[2];
  eo_contact_grid_pairs(grid, range);
  difference[0] = difference[1] = 0;
  for (int tooth = range[0]; tooth <= range[1]; tooth++)
    for (int j = 0; j < grid->positions; j++) {
      double exact = exact_stress(of, member, tooth, &grid->position[j], end->loaded.line_load),
             found = end->root[member].stress[(tooth - range[0]) * grid->positions + j];
      largest = fmax(largest, exact);
      double *worst = &difference[can_touch(&grid->position[j], tooth)];
      *worst = fmax(*worst, fabs(found - exact));
    }
  return largest;
}

/* Unmodified teeth of a narrow pair meet with the edge of a tip, some of them at one position only: what is largest
   there must not be passed over. */
static NOT_INLINE void test_root_peak(void)
{
  struct eo_design design = design_of("narrow");
  struct eo_evaluator *shared = evaluator;
  struct eo_pair *narrow = make_pair(&design);
  design.modification = eo_design_unmodified(&design);
  evaluator = make_evaluator(narrow);
  const struct eo_evaluation *r = run(&design, NULL, EO_WANT_ROOT);
  for (int member = 0; member < 2; member++) {
    const struct eo_end_result *end = &r->load_case[0].end[EO_LEFT];
    double difference[2], largest = compare_roots(narrow, end, member, difference);
    ok(fabs(end->root[member].maximum / largest - 1) < 1e-3 && difference[1] < 2e-3 * largest,
       "%s: the largest root stress of any position, %.3f MPa, is found: %.3f; histories within %.1e of it",
       member ? "gear" : "pinion", 1e-6 * largest, 1e-6 * end->root[member].maximum, difference[1] / largest);
    ok(difference[0] < 3e-4 * largest, "%s: the root stress is within %.1e of it where other teeth alone carry load",
       member ? "gear" : "pinion", difference[0] / largest);
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(narrow);
  evaluator = shared;
}

static bool same_end(const struct eo_end_result *a, const struct eo_end_result *b)
{
  return memcmp(&a->impact, &b->impact, sizeof a->impact) == 0 && a->max_pressure == b->max_pressure &&
         a->max_line_load == b->max_line_load && a->edge_share == b->edge_share && a->datum == b->datum &&
         memcmp(a->stiffness, b->stiffness, sizeof *a->stiffness * POSITIONS) == 0 &&
         a->face.face_factor == b->face.face_factor;
}

/* An end that did not change keeps what follows from its loads, and strikes at the speed that is asked for. */
static NOT_INLINE void test_kept_end(void)
{
  struct eo_evaluator *shared = evaluator, *fresh;
  struct eo_design design = design_of("paper-case-b");
  run(&design, NULL, 0);
  design.load_case[0].speed *= 1.5;
  design.modification.flank[EO_PINION][EO_LEFT].tip_relief += 1e-6;
  const struct eo_evaluation *kept = run(&design, NULL, 0), *made;
  evaluator = fresh = make_evaluator(pair);
  made = run(&design, NULL, 0);
  evaluator = shared;
  bool same = true;
  for (int k = 0; k < kept->cases; k++)
    for (int end = 0; end < 2; end++)
      same = same && same_end(&kept->load_case[k].end[end], &made->load_case[k].end[end]);
  ok(same, "an end that is kept shows what a new evaluation does, at another speed too");
  eo_evaluator_free(fresh);
}

/* Loads that shafts or a held pinion move from what is stored take the root stress with them. */
static NOT_INLINE void test_root_stress_moves(void)
{
  struct eo_evaluator *shared = evaluator, *own;
  for (int i = 0; i < 2; i++) {
    struct eo_design design = design_of("paper");
    double moved[2], alone[2];
    run(&design, NULL, EO_WANT_ROOT);
    design.alignment.stagger = i == 0 ? 0 : 0.25;
    run(&design, NULL, EO_WANT_ROOT);
    design.shafts.enabled = i == 0;
    design.alignment.pinion_axial = i == 0 ? EO_AXIAL_FLOATING : EO_AXIAL_FIXED;
    const struct eo_evaluation *r = run(&design, NULL, EO_WANT_ROOT);
    for (int end = 0; end < 2; end++)
      moved[end] = r->load_case[1].end[end].root[EO_PINION].maximum;
    evaluator = own = make_evaluator(pair);
    r = run(&design, NULL, EO_WANT_ROOT);
    for (int end = 0; end < 2; end++)
      alone[end] = r->load_case[1].end[end].root[EO_PINION].maximum;
    evaluator = shared;
    eo_evaluator_free(own);
    ok(moved[0] == alone[0] && moved[1] == alone[1],
       "root stress with %s after a run without: %.3f, %.3f MPa, is %.3f, %.3f", i == 0 ? "shafts" : "a held pinion",
       1e-6 * moved[0], 1e-6 * moved[1], 1e-6 * alone[0], 1e-6 * alone[1]);
  }
}

static NOT_INLINE void test_axial(void)
{
  struct eo_design design = design_of("paper-case-a");
  design.alignment.pinion_axial = EO_AXIAL_FIXED;
  design.alignment.shaft_angle_in_plane = 1e-4;
  const struct eo_evaluation *r = run(&design, NULL, 0);
  ok(fabs(r->load_case[1].end[0].loaded.load[0] / r->load_case[1].force - 1) > 0.01 && !r->objective[1].failed,
     "a fixed pinion shares unevenly");
  double share = r->load_case[1].end[0].loaded.load[0] / r->load_case[1].force;
  const struct eo_supports supports = design.supports;
  eo_supports_make_rigid(&design.supports);
  r = run(&design, NULL, 0);
  ok(fabs(r->load_case[1].end[0].loaded.load[0] / r->load_case[1].force - 1) > 1.5 * fabs(share - 1),
     "the less bearings and grooves give, the less evenly a fixed pinion shares");
  ok(r->load_case[1].end[0].loaded.approach[3] == r->load_case[1].end[1].loaded.approach[3] ||
         fabs(r->load_case[1].end[0].loaded.approach[3] - r->load_case[1].end[1].loaded.approach[3]) < 1e-12,
     "rigid bearings and grooves make one approach of both ends");
  design.alignment.shaft_angle_in_plane = 1.7e-3;
  design.resolution.mesh_law = EO_LAW_SECANT;
  r = run(&design, NULL, 0);
  struct record record = record_of(r);
  ok(fmin(r->load_case[1].end[0].loaded.load[0], r->load_case[1].end[1].loaded.load[0]) == 0,
     "a pinion bears on one end only under a large shaft error");
  ok(r->objective[1].failed && r->load_case[1].vibration.outcome == EO_VIBRATION_NOT_CONVERGED,
     "a pinion on one end has no secant vibration about its load");
  ok(finite_record(&record), "a pinion on one end has no number that is none");
  design.supports = supports;
  design.resolution.mesh_law = EO_LAW_TANGENT;
  design.alignment.shaft_angle_in_plane = 0;
  design.alignment.stagger = 0.5;
  r = run(&design, NULL, 0);
  struct record stagger = record_of(r);
  design.alignment.shaft_angle_in_plane = 1e-200;
  struct record twice = record_of(run(&design, NULL, 0));
  ok(r->load_case[1].end[0].loaded.load[3] != r->load_case[1].force && same(&stagger, &twice),
     "equal ends half a pitch apart share unevenly too");
}

/* The loads of the ends at rest are those of the vibration at a crawl, mean and least and most: one set of springs. */
static NOT_INLINE void test_held_share(void)
{
  static const enum eo_axial how[2] = {EO_AXIAL_SPRING, EO_AXIAL_FIXED};
  for (int i = 0; i < 2; i++) {
    struct eo_design design = design_of("paper-case-a");
    design.alignment.pinion_axial = how[i];
    design.alignment.pinion_axial_stiffness = 1.5e8;
    design.alignment.shaft_angle_in_plane = 3e-4;
    for (int k = 0; k < design.load_cases; k++)
      design.load_case[k].speed = 2;
    const struct eo_evaluation *r = run(&design, NULL, 0);
    const struct eo_case_result *c = &r->load_case[1];
    for (int end = 0; end < 2; end++) {
      double mean = 0, least = INFINITY, most = 0;
      for (int j = 0; j < r->positions; j++) {
        double load = c->end[end].loaded.load[j];
        mean += load / r->positions;
        least = fmin(least, load);
        most = fmax(most, load);
      }
      near(c->vibration.force_mean[end], mean, 3e-3, "mean force of the vibration of a held pinion over that at rest");
      near(c->vibration.force_max[end], most, 1e-2, "largest force of a held pinion");
      near(c->vibration.force_min[end], least, 1e-2, "least force of a held pinion");
    }
    double uneven = c->vibration.force_mean[0] / c->vibration.force_mean[1];
    ok(fabs(uneven - 1) > 0.05, "the ends of a held pinion share unevenly: %.3f", uneven);
    near(c->vibration.pinion_thrust_mean,
         -sin(0.39218390684663407) * (c->vibration.force_mean[0] - c->vibration.force_mean[1]), 1e-6,
         "thrust of a held pinion, the difference of the ends'");
  }
}

/* Ends coupled in torsion whose transmission errors differ press on each other: the default law against a table. */
static NOT_INLINE void test_coupled_law(void)
{
  struct eo_design design = design_of("paper-case-b");
  double tangent[EO_MAX_LOAD_CASES];
  const struct eo_evaluation *r = run(&design, NULL, 0);
  for (int k = 0; k < r->cases; k++)
    tangent[k] = r->load_case[k].vibration.rms_pair[0];
  design.resolution.mesh_law = EO_LAW_TABLE;
  r = run(&design, NULL, 0);
  for (int k = 0; k < r->cases; k++)
    near(tangent[k], r->load_case[k].vibration.rms_pair[0], 0.03, "RMS of coupled ends, default law against the table");
}

static void ask_again(struct eo_design *design)
{
  (void)design;
}
static void change_left_end(struct eo_design *design)
{
  design->modification.flank[EO_PINION][EO_LEFT].tip_relief += 1e-6;
}
static void change_both_ends(struct eo_design *design)
{
  change_left_end(design);
  design->modification.flank[EO_GEAR][EO_RIGHT].tip_relief += 1e-6;
}
static void change_harmonics(struct eo_design *design)
{
  design->resolution.te_harmonics -= 4;
}
static void change_backlash(struct eo_design *design)
{
  design->gear_pair.backlash /= 2;
}
static void change_damping(struct eo_design *design)
{
  design->supports.mesh_damping_ratio /= 2;
}
static void ask_for_tables(struct eo_design *design)
{
  design->resolution.mesh_law = EO_LAW_TABLE;
}
static void ask_for_tangents(struct eo_design *design)
{
  design->resolution.mesh_law = EO_LAW_TANGENT;
}

/* Ends that differ have laws from loads about theirs, which come with their solution; tables take twelve of their own.
   An end that has not changed keeps both, and nothing that comes out depends on it. The last step: one end was solved
   without the loads about its own. */
static NOT_INLINE void test_kept_laws(void)
{
  enum { ALONE = 1, TABLE = 12 };
  static const struct {
    const char *what;
    void (*change)(struct eo_design *design);
    int solutions; /* of each load case */
  } step[] = {{"from nothing", ask_again, 2 * ALONE},
              {"the same again", ask_again, 0},
              {"one end changes", change_left_end, ALONE},
              {"and again", change_left_end, ALONE},
              {"both ends change", change_both_ends, 2 * ALONE},
              {"the damping changes", change_damping, 0},
              {"the harmonics of the laws change", change_harmonics, 0},
              {"the backlash changes", change_backlash, 0},
              {"tables of many loads", ask_for_tables, 2 * TABLE},
              {"one end of them changes", change_left_end, ALONE + TABLE},
              {"the usual law again", ask_for_tangents, ALONE}};
  struct eo_design design = design_of("paper-case-b");
  struct eo_evaluator *shared = evaluator, *kept = make_evaluator(pair);
  for (size_t i = 0; i < sizeof step / sizeof *step; i++) {
    step[i].change(&design);
    evaluator = kept;
    const struct eo_evaluation *r = run(&design, NULL, 0);
    int solutions = r->solutions, expected = step[i].solutions * r->cases;
    const struct record here = record_of(r);
    evaluator = make_evaluator(pair);
    const struct record alone = record_of(run(&design, NULL, 0));
    eo_evaluator_free(evaluator);
    ok(solutions == expected && same(&here, &alone),
       "%s: %d solutions of loaded contact, to be %d; the numbers are those of an evaluator of its own", step[i].what,
       solutions, expected);
  }
  eo_evaluator_free(kept);
  evaluator = shared;
}

int main(void)
{
  struct eo_design design = design_of("paper");
  pair = make_pair(&design);
  evaluator = make_evaluator(pair);
  ok(eo_pair_serves(pair, &design), "a coarse pair is prepared in %.1f s", pair->seconds);
  test_equal_ends();
  test_single_end();
  test_mirror();
  test_no_memory();
  test_threads();
  test_scenarios();
  test_robust();
  test_drawn();
  test_laws();
  test_band();
  test_curves();
  test_root_stress();
  test_root_peak();
  test_kept_end();
  test_root_stress_moves();
  test_axial();
  test_held_share();
  test_coupled_law();
  test_kept_laws();
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return tap_done();
}
