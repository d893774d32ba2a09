#include "evaluation/evaluator_private.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "numerics/periodic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROOT_STEP = 2, ROOT_BATCH = 8 }; /* BATCH: ends at a time, so that the stresses of a tooth stay in the cache */

/* Root stress of several ends: an item is a tooth of a member under a batch of them. */
struct roots {
  struct eo_evaluator *evaluator;
  int ends, teeth, first; /* ends: to compute; first: tooth */
  struct eo_end_result *end[EO_MAX_LOAD_CASES * 2];
  struct eo_root_peak *peak; /* [member][teeth][ends] */
};

static void find_tooth(const struct roots *roots, int thread, int item)
{
  struct eo_evaluator *e = roots->evaluator;
  int tooth = item % roots->teeth, member = item / roots->teeth % 2, first = item / roots->teeth / 2 * ROOT_BATCH;
  int count = roots->ends - first < ROOT_BATCH ? roots->ends - first : ROOT_BATCH;
  const struct eo_loaded_end *loaded[ROOT_BATCH];
  struct eo_root_history *history[ROOT_BATCH];
  for (int i = 0; i < count; i++) {
    loaded[i] = &roots->end[first + i]->loaded;
    history[i] = &roots->end[first + i]->root[member];
  }
  eo_root_tooth_compute(e->root[thread], member, roots->first + tooth, count, loaded, history,
                        roots->peak + (member * roots->teeth + tooth) * roots->ends + first);
}

static void copy_history(const struct eo_root_history *from, struct eo_root_history *to)
{
  memcpy(to->phase, from->phase, sizeof *to->phase * (size_t)from->phases);
  memcpy(to->stress, from->stress, sizeof *to->stress * (size_t)from->phases);
  to->maximum = from->maximum;
  to->arc = from->arc;
  to->eta = from->eta;
}

/* Ends that are neither as they were nor the same as the left one. */
static void list_ends(struct roots *roots, const struct eo_design *design)
{
  struct eo_evaluator *e = roots->evaluator;
  for (int k = 0; k < e->result.cases; k++)
    for (int end = 0; end < e->result.ends; end++)
      if (!e->rooted[end] && !(end == EO_RIGHT && eo_evaluator_copies_end(e, design)))
        roots->end[roots->ends++] = &e->result.load_case[k].end[end];
}

static enum eo_code make_root_workspaces(struct eo_evaluator *e, struct eo_error *error)
{
  const struct eo_root_modes *const modes[2] = {e->pair->root[0], e->pair->root[1]};
  int ends = 2 * e->most_cases < ROOT_BATCH ? 2 * e->most_cases : ROOT_BATCH, range[2];
  enum eo_code code = EO_OK;
  eo_contact_grid_pairs(e->pair->grid, range);
  for (int thread = 0; thread < e->threads && !code; thread++)
    code = e->root[thread] ? EO_OK
                           : eo_root_workspace_new(&e->root[thread], e->pair->grid, modes, ROOT_STEP, ends, error);
  if (!code && !e->peaks &&
      !(e->peaks = malloc(sizeof *e->peaks * (size_t)(range[1] - range[0] + 1) * 4 * (size_t)e->most_cases)))
    code = eo_error_memory(error);
  return code;
}

static enum eo_code prepare_roots(struct roots *roots, struct eo_evaluator *e, const struct eo_design *design,
                                  struct eo_error *error)
{
  int range[2];
  eo_contact_grid_pairs(e->pair->grid, range);
  enum eo_code code = make_root_workspaces(e, error);
  *roots = (struct roots){.evaluator = e, .teeth = range[1] - range[0] + 1, .first = range[0], .peak = e->peaks};
  list_ends(roots, design);
  return code;
}

static int count_teeth(const struct roots *roots)
{
  return (roots->ends + ROOT_BATCH - 1) / ROOT_BATCH * 2 * roots->teeth;
}

/* Histories from the teeth, and of the ends that had none to compute. */
static void finish_roots(const struct roots *roots, const struct eo_design *design)
{
  struct eo_evaluator *e = roots->evaluator;
  struct eo_evaluation *r = &e->result;
  for (int member = 0; member < 2; member++) {
    struct eo_root root = eo_flexibility_root(e->pair->flexibility, member);
    for (int i = 0; i < roots->ends; i++)
      eo_root_history_finish(&roots->end[i]->root[member], &root, e->pair->grid, ROOT_STEP,
                             roots->peak + member * roots->teeth * roots->ends + i, roots->ends);
  }
  for (int k = 0; k < r->cases; k++)
    for (int member = 0; member < 2; member++)
      for (int end = 0; end < r->ends; end++) {
        struct eo_root_history *history = &r->load_case[k].end[end].root[member];
        if (end == EO_RIGHT && eo_evaluator_copies_end(e, design))
          copy_history(&r->load_case[k].end[EO_LEFT].root[member], history);
        history->phases = roots->teeth *
                          ((r->positions + ROOT_STEP - 1) / ROOT_STEP); /* of those that are as they were, too */
      }
  for (int end = 0; end < r->ends; end++)
    e->rooted[end] = !(end == EO_RIGHT && r->equal_ends);
}

static void collect_objectives(struct eo_evaluation *r, bool root)
{
  for (int k = 0; k < r->cases; k++) {
    const struct eo_case_result *c = &r->load_case[k];
    struct eo_objective_case *o = &r->objective[k];
    *o = (struct eo_objective_case){.peak_to_peak = c->peak_to_peak,
                                    .rms = c->vibration.rms_pair[EO_READING_NORMAL],
                                    .root_stress = root ? 0 : NAN,
                                    .failed = c->contact_failures > 0 ||
                                              c->vibration.outcome == EO_VIBRATION_NOT_CONVERGED};
    for (int end = 0; end < r->ends; end++) {
      o->impact = fmax(o->impact, c->end[end].impact.force);
      o->contact_pressure = fmax(o->contact_pressure, c->end[end].max_pressure);
      o->edge_load_share = fmax(o->edge_load_share, c->end[end].edge_share);
      o->contact_loss = fmax(o->contact_loss, c->vibration.contact_loss[end]);
      for (int member = 0; root && member < 2; member++)
        o->root_stress = fmax(o->root_stress, c->end[end].root[member].maximum);
    }
  }
}

static enum eo_code find_modes(struct eo_evaluator *e, struct eo_error *error)
{
  struct eo_evaluation *r = &e->result;
  int n = e->pair->grid->positions, heaviest = 0;
  for (int k = 1; k < r->cases; k++)
    if (r->load_case[k].load_case.share > r->load_case[heaviest].load_case.share)
      heaviest = k;
  double stiffness[2];
  bool elastic = r->load_case[heaviest].contact_failures == 0;
  for (int end = 0; end < 2; end++) {
    stiffness[end] = eo_periodic_mean(n, r->load_case[heaviest].end[end < r->ends ? end : 0].loaded.tangent);
    elastic = elastic && stiffness[end] > 0; /* an end may carry nothing */
  }
  if (!elastic) {
    r->modes = (struct eo_dynamics_modes){0};
    return EO_OK;
  }
  return eo_dynamics_model_modes(eo_vibration_model(e->vibration), stiffness, &r->modes, error);
}

static void set_cases(struct eo_evaluator *e, const struct eo_design *design)
{
  struct eo_evaluation *r = &e->result;
  r->ends = design->gear_pair.ends;
  r->cases = design->load_cases;
  for (int k = 0; k < r->cases; k++) {
    r->load_case[k].load_case = design->load_case[k];
    r->load_case[k].force = design->load_case[k].torque / (r->ends * e->pair->geometry.base_radius[EO_PINION] *
                                                           cos(e->pair->geometry.base_helix_angle));
    for (int reading = 0; reading < EO_READINGS; reading++)
      r->load_case[k].band[reading][0] = r->load_case[k].band[reading][1] = NAN;
    r->load_case[k].body_iterations = 0;
    for (int end = 0; end < 2; end++) {
      r->load_case[k].end[end].deflection = (struct eo_deflection){0};
      for (int member = 0; member < 2; member++)
        r->load_case[k].end[end].root[member].phases = 0;
    }
  }
}

static enum eo_code fit_vibration(struct eo_evaluator *e, int harmonics, struct eo_error *error)
{
  if (e->vibration && e->vibration_harmonics == harmonics)
    return EO_OK;
  struct eo_vibration_solver *solver;
  enum eo_code code = eo_vibration_new(&solver, harmonics, 0, error);
  if (code)
    return code;
  eo_vibration_free(e->vibration);
  e->vibration = solver;
  e->vibration_harmonics = e->result.harmonics = harmonics;
  return EO_OK;
}

static enum eo_code solve_static(struct eo_evaluator *e, const struct eo_design *design,
                                 const struct eo_scenario *scenario, struct eo_error *error)
{
  enum eo_code code = eo_evaluator_fit_bodies(e, &design->shafts, error);
  if (!code)
    code = eo_evaluator_find_hold(e, design, error);
  if (code)
    return code;
  double start = eo_clock_milliseconds();
  set_cases(e, design);
  eo_evaluator_set_keys(e, design, scenario);
  code = eo_evaluator_solve_contact(e, design, scenario->compliance, error);
  e->result.static_ms = eo_clock_milliseconds() - start;
  return code;
}

static void find_impacts(struct eo_evaluator *e, const struct eo_design *design, const struct eo_scenario *scenario)
{
  double start = eo_clock_milliseconds();
  eo_evaluator_find_impacts(e, design, scenario->speed, scenario->compliance);
  e->result.impact_ms = eo_clock_milliseconds() - start;
}

static const struct eo_scenario nominal_scenario = {NAN, NAN, 1, 1};

enum eo_code eo_evaluator_contact(struct eo_evaluator *e, const struct eo_design *design,
                                  const struct eo_evaluation **evaluation, struct eo_error *error)
{
  enum eo_code code = solve_static(e, design, &nominal_scenario, error);
  if (code)
    return code;
  find_impacts(e, design, &nominal_scenario);
  *evaluation = &e->result;
  return EO_OK;
}

/* What the loads lead to: the way to the vibration is one item, each tooth of the root stress another, so that two
   threads are busy alike. */
struct consequences {
  struct eo_evaluator *evaluator;
  const struct eo_design *design;
  const struct eo_scenario *scenario;
  int want;
  struct roots roots;
  double root_ms[2]; /* [thread] */
};

static enum eo_code find_vibration(const struct consequences *c, struct eo_error *error)
{
  struct eo_evaluator *e = c->evaluator;
  find_impacts(e, c->design, c->scenario);
  double start = eo_clock_milliseconds();
  enum eo_code code = eo_evaluator_solve_dynamics(e, c->design, c->scenario->speed, c->scenario->compliance, c->want,
                                                  error);
  if (!code && c->want & EO_WANT_CURVES)
    code = find_modes(e, error);
  e->result.dynamics_ms = eo_clock_milliseconds() - start;
  return code;
}

static enum eo_code find_consequence(void *context, int thread, int item, struct eo_error *error)
{
  struct consequences *c = context;
  if (item == 0)
    return find_vibration(c, error);
  double start = eo_clock_milliseconds();
  find_tooth(&c->roots, thread, item - 1);
  c->root_ms[thread] += eo_clock_milliseconds() - start;
  return EO_OK;
}

static enum eo_code find_consequences(struct consequences *c, bool root, struct eo_error *error)
{
  struct eo_evaluator *e = c->evaluator;
  const struct eo_parallel parallel = {.threads = e->threads, .work = find_consequence, .context = c};
  enum eo_code code = root ? prepare_roots(&c->roots, e, c->design, error) : EO_OK;
  if (!code)
    code = eo_parallel_run(&parallel, 1 + (root ? count_teeth(&c->roots) : 0), error);
  if (!code && root)
    finish_roots(&c->roots, c->design);
  e->result.root_ms = c->root_ms[0] + c->root_ms[1];
  return code;
}

enum eo_code eo_evaluator_run(struct eo_evaluator *e, const struct eo_design *design,
                              const struct eo_scenario *scenario, int want, const struct eo_evaluation **evaluation,
                              struct eo_error *error)
{
  const struct eo_scenario *s = scenario ? scenario : &nominal_scenario;
  struct eo_evaluation *r = &e->result;
  bool root = e->pair->flexibility && (want & EO_WANT_ROOT || !isnan(design->objective.root_stress));
  enum eo_code code = fit_vibration(e, design->resolution.harmonics, error);
  if (!code)
    code = solve_static(e, design, s, error);
  struct consequences consequences = {.evaluator = e, .design = design, .scenario = s, .want = want};
  if (!code)
    code = find_consequences(&consequences, root, error);
  if (!code && want & EO_WANT_BAND)
    code = eo_evaluator_find_band(e, design, s->speed, s->compliance, error);
  if (code)
    return code;
  collect_objectives(r, root);
  *evaluation = r;
  return EO_OK;
}

bool eo_evaluator_vibration(const struct eo_evaluator *e, int load_case, struct eo_dynamics_parameters *parameters,
                            struct eo_vibration_case *load)
{
  *parameters = e->problem[load_case].parameters;
  *load = e->problem[load_case].load;
  return e->problem[load_case].solvable;
}

const struct eo_gap_field *eo_evaluator_field(const struct eo_evaluator *e, int end)
{
  return &e->field[eo_evaluator_kept_at(e, end)];
}

/* ---- fitness ---- */

int eo_evaluator_scenarios(const struct eo_design *design)
{
  return design->objective.robust == EO_ROBUST_OFF || design->objective.scenarios == 0 ? 1
                                                                                       : design->objective.scenarios;
}

enum eo_code eo_evaluator_raw(struct eo_evaluator *e, const struct eo_design *design, struct eo_objective_case *raw,
                              struct eo_error *error)
{
  int scenarios = eo_evaluator_scenarios(design);
  bool nominal = design->objective.robust == EO_ROBUST_OFF || design->objective.scenarios == 0;
  for (int s = 0; s < scenarios; s++) {
    const struct eo_evaluation *r;
    enum eo_code code = eo_evaluator_run(e, design, nominal ? NULL : &design->objective.scenario[s], 0, &r, error);
    if (code)
      return code;
    memcpy(raw + s * r->cases, r->objective, sizeof *raw * (size_t)r->cases);
  }
  return EO_OK;
}

void eo_evaluator_combine(const struct eo_design *design, const struct eo_geometry *geometry,
                          const struct eo_objective_case *raw, const struct eo_objective_case *unmodified,
                          struct eo_objective_value *value)
{
  int scenarios = eo_evaluator_scenarios(design), cases = design->load_cases;
  bool outside = eo_objective_relief_outside(&design->modification, geometry->rack_bottom, geometry->rack_top);
  struct eo_objective_value sum = {0}, one;
  for (int s = 0; s < scenarios; s++) {
    eo_objective_value(&design->objective, cases, design->load_case, raw + s * cases, unmodified + s * cases, outside,
                       &one);
    bool worst = design->objective.robust == EO_ROBUST_WORST;
    if (s == 0 || (worst && one.fitness < sum.fitness)) {
      sum = one;
    } else if (!worst) {
      for (int i = 0; i < 3; i++)
        sum.sums.f[i] += one.sums.f[i];
      sum.sums.failed |= one.sums.failed;
      sum.objective += one.objective;
      sum.violation += one.violation;
    }
  }
  *value = sum;
  if (design->objective.robust != EO_ROBUST_MEAN || scenarios == 1)
    return;
  for (int i = 0; i < 3; i++)
    value->sums.f[i] /= scenarios;
  value->objective /= scenarios;
  value->violation /= scenarios;
  value->fitness = value->sums.failed ? EO_FITNESS_WORST
                                      : 1 / value->objective - design->objective.penalty * value->violation;
}
