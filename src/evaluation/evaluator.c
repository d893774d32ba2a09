#include "evaluation/evaluator.h"

#include "numerics/periodic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct eo_evaluator {
  const struct eo_pair *pair;
  int most_cases;
  struct eo_gap_field field[2];            /* [end] */
  struct eo_loaded_gaps gaps[2];           /* [end] */
  struct eo_loaded_workspace *contact;
  struct eo_loaded_end spare[2];           /* [end]: for the compliance band */
  struct eo_loaded_end *table;             /* [TABLE_LOADS] of the table law, one end at a time; NULL until asked for */
  double *table_rows;                      /* [TABLE_LOADS][positions] */
  struct eo_vibration_solver *vibration;
  int vibration_harmonics;
  struct eo_law (*law)[2];                 /* [most_cases][end] */
  struct eo_evaluation result;
};

enum { CURVE_SAMPLES = 256, TABLE_LOADS = 12 };

/* Loads of the table law over P: close together where contact lines grow from nothing and about P, where the straight pieces between them
   have to have the slope of the curve. */
static const double TABLE_LOAD[TABLE_LOADS] = {1e-4, 0.03, 0.1, 0.25, 0.5, 0.75, 0.92, 1, 1.08, 1.3, 1.8, 3};

static double milliseconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* ---- contact ---- */

static bool same_flanks(const struct eo_modification *m)
{
  return memcmp(&m->flank[EO_PINION][EO_LEFT], &m->flank[EO_PINION][EO_RIGHT], sizeof m->flank[0][0]) == 0 &&
         memcmp(&m->flank[EO_GEAR][EO_LEFT], &m->flank[EO_GEAR][EO_RIGHT], sizeof m->flank[0][0]) == 0;
}

static void copy_end(const struct eo_contact_grid *grid, struct eo_loaded_end *to, const struct eo_loaded_end *from)
{
  size_t n = (size_t)grid->positions;
  memcpy(to->load, from->load, n * sizeof(double));
  memcpy(to->approach, from->approach, n * sizeof(double));
  memcpy(to->tangent, from->tangent, n * sizeof(double));
  memcpy(to->line_load, from->line_load, (size_t)grid->points * sizeof(double));
  to->failures = from->failures;
}

/* Loaded contact of every load case at one end. */
static void load_end(struct eo_evaluator *e, const struct eo_design *design, int end, double factor)
{
  struct eo_evaluation *r = &e->result;
  double force[EO_MAX_LOAD_CASES];
  struct eo_loaded_end loaded[EO_MAX_LOAD_CASES];
  for (int k = 0; k < r->cases; k++) {
    force[k] = r->load_case[k].force;
    loaded[k] = r->load_case[k].end[end].loaded;
  }
  eo_loaded_solve(e->contact, e->pair->grid, &e->gaps[end], factor, design->load_cases, force, loaded);
  for (int k = 0; k < r->cases; k++)
    r->load_case[k].end[end].loaded.failures = loaded[k].failures;
}

static int stagger_positions(const struct eo_design *design, int positions)
{
  return (int)lround(design->alignment.stagger * positions) % positions;
}

static double axial_stiffness(const struct eo_alignment *alignment)
{
  return alignment->pinion_axial == EO_AXIAL_FIXED ? INFINITY
         : alignment->pinion_axial == EO_AXIAL_SPRING ? alignment->pinion_axial_stiffness : 0;
}

static void set_fields(struct eo_evaluator *e, const struct eo_design *design, const struct eo_scenario *scenario)
{
  const struct eo_modification *m = &design->modification;
  double in_plane = isnan(scenario->in_plane) ? design->alignment.shaft_angle_in_plane : scenario->in_plane;
  double out_of_plane = isnan(scenario->out_of_plane) ? design->alignment.shaft_angle_out_of_plane : scenario->out_of_plane;
  e->result.equal_ends = e->result.ends == 2 && same_flanks(m) && in_plane == 0 && out_of_plane == 0;
  for (int end = 0; end < e->result.ends; end++) {
    if (end == EO_RIGHT && e->result.equal_ends)
      continue;
    eo_gap_field_init(&e->field[end], &e->pair->geometry, &m->flank[EO_PINION][end], &m->flank[EO_GEAR][end], end, in_plane, out_of_plane,
                      e->pair->pivot[end], e->pair->grid->corner);
    eo_loaded_gaps_set(&e->gaps[end], e->pair->grid, &e->field[end]);
  }
}

/* Where the gaps and fields of an end are kept: equal ends share the left one's. */
static int kept_at(const struct eo_evaluator *e, int end)
{
  return e->result.equal_ends ? EO_LEFT : end;
}

/* Whether an axially held pinion shares its load unevenly between the ends. */
static bool shares_unevenly(const struct eo_evaluator *e, const struct eo_design *design)
{
  const struct eo_evaluation *r = &e->result;
  return r->ends == 2 && axial_stiffness(&design->alignment) > 0 && !(r->equal_ends && stagger_positions(design, e->pair->grid->positions) == 0);
}

static void solve_contact(struct eo_evaluator *e, const struct eo_design *design, double factor)
{
  struct eo_evaluation *r = &e->result;
  const struct eo_contact_grid *grid = e->pair->grid;
  for (int end = 0; end < r->ends; end++)
    if (end == EO_RIGHT && r->equal_ends)
      for (int k = 0; k < r->cases; k++)
        copy_end(grid, &r->load_case[k].end[end].loaded, &r->load_case[k].end[EO_LEFT].loaded);
    else
      load_end(e, design, end, factor);
  if (shares_unevenly(e, design))
    for (int k = 0; k < r->cases; k++) {
      struct eo_loaded_gaps gaps[2] = {e->gaps[EO_LEFT], e->gaps[kept_at(e, EO_RIGHT)]};
      struct eo_loaded_end both[2] = {r->load_case[k].end[EO_LEFT].loaded, r->load_case[k].end[EO_RIGHT].loaded};
      eo_loaded_balance(e->contact, grid, gaps, factor, axial_stiffness(&design->alignment), stagger_positions(design, grid->positions),
                        r->load_case[k].force, both);
      for (int end = 0; end < 2; end++)
        r->load_case[k].end[end].loaded.failures = both[end].failures;
    }
}

/* Peaks over the mesh cycle and the secant stiffness of one end. */
static void summarise_end(struct eo_evaluator *e, struct eo_case_result *c, int end)
{
  const struct eo_contact_grid *grid = e->pair->grid;
  struct eo_end_result *r = &c->end[end];
  double low = INFINITY, high = -INFINITY;
  memcpy(r->unloaded, e->gaps[kept_at(e, end)].unloaded, sizeof *r->unloaded * (size_t)grid->positions);
  r->max_pressure = r->max_line_load = r->edge_share = 0;
  r->datum = eo_gap_field_datum(&e->field[kept_at(e, end)]);
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    double edge = 0;
    for (int i = 0; i < p->points; i++) {
      double q = r->loaded.line_load[p->first + i];
      r->max_line_load = fmax(r->max_line_load, q);
      r->max_pressure = fmax(r->max_pressure, q > 0 ? eo_loaded_pressure(grid, q, p->radius[i]) : 0);
      edge += p->kind[i] == EO_POINT_LINE ? 0 : q * p->length[i];
    }
    r->edge_share = fmax(r->edge_share, edge / r->loaded.load[j]);
    r->stiffness[j] = r->loaded.load[j] / (r->loaded.approach[j] - r->unloaded[j]);
    low = fmin(low, r->loaded.approach[j]);
    high = fmax(high, r->loaded.approach[j]);
  }
  r->transmission_peak = (high - low) / cos(grid->geometry.base_helix_angle);
}

/* LTE of the pair: the mean of the ends, the right one behind by the stagger. */
static void summarise_pair(struct eo_evaluator *e, const struct eo_design *design, struct eo_case_result *c)
{
  int n = e->pair->grid->positions, stagger = stagger_positions(design, n), last = e->result.ends - 1;
  double low = INFINITY, high = -INFINITY, normal = cos(e->pair->geometry.base_helix_angle);
  c->mean = 0;
  for (int j = 0; j < n; j++) {
    double z = (c->end[EO_LEFT].loaded.approach[j] + c->end[last].loaded.approach[(j + n - stagger) % n]) / 2 / normal;
    c->transmission[j] = z;
    c->mean += z / n;
    low = fmin(low, z);
    high = fmax(high, z);
  }
  c->peak_to_peak = high - low;
  c->contact_failures = 0;
  for (int end = 0; end <= last; end++)
    c->contact_failures += c->end[end].loaded.failures;
}

static void find_impacts(struct eo_evaluator *e, const struct eo_design *design, double speed_factor, double factor)
{
  struct eo_evaluation *r = &e->result;
  bool same = r->equal_ends && !shares_unevenly(e, design);
  for (int k = 0; k < r->cases; k++)
    for (int end = 0; end < r->ends; end++) {
      struct eo_case_result *c = &r->load_case[k];
      if (end == EO_RIGHT && same)
        c->end[end].impact = c->end[EO_LEFT].impact;
      else
        eo_impact_find(&c->end[end].impact, e->pair->grid, &e->field[kept_at(e, end)], e->pair->kernel, &e->pair->impact,
                       c->end[end].loaded.approach, c->load_case.speed * speed_factor, factor);
    }
}

/* ---- dynamics ---- */

static double mean(int n, const double *value)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i];
  return sum / n;
}

/* F(X, phi) from loaded contact at many loads. */
static enum eo_code set_table_law(struct eo_evaluator *e, struct eo_law *law, const struct eo_case_result *c, int end, double factor, int order,
                                  struct eo_error *error)
{
  int n = e->pair->grid->positions;
  double load[TABLE_LOADS];
  for (int i = 0; i < TABLE_LOADS; i++)
    load[i] = TABLE_LOAD[i] * c->force;
  if (!e->table) {
    e->table = calloc(TABLE_LOADS, sizeof *e->table);
    e->table_rows = malloc(sizeof(double) * (size_t)(TABLE_LOADS * n));
    if (!e->table || !e->table_rows)
      return eo_error_memory(error);
    for (int i = 0; i < TABLE_LOADS; i++) {
      enum eo_code code = eo_loaded_end_init(&e->table[i], e->pair->grid, error);
      if (code)
        return code;
    }
  }
  eo_loaded_solve(e->contact, e->pair->grid, &e->gaps[kept_at(e, end)], factor, TABLE_LOADS, load, e->table);
  for (int i = 0; i < TABLE_LOADS; i++)
    memcpy(e->table_rows + i * n, e->table[i].approach, sizeof(double) * (size_t)n);
  return eo_law_set_table(law, TABLE_LOADS, n, load, e->table_rows, order, 0, error);
}

static enum eo_code set_law(struct eo_evaluator *e, const struct eo_design *design, struct eo_law *law, const struct eo_case_result *c, int end,
                            const struct eo_loaded_end *loaded, double factor, struct eo_error *error)
{
  const struct eo_resolution *resolution = &design->resolution;
  int n = e->pair->grid->positions, order = resolution->te_harmonics < n / 2 ? resolution->te_harmonics : n / 2 - 1;
  double back = -design->gear_pair.backlash;
  switch (resolution->mesh_law) {
  case EO_LAW_SECANT:
    return eo_law_set_secant(law, n, loaded->approach, c->force, c->end[end].datum, order, back, error);
  case EO_LAW_TABLE:
    return set_table_law(e, law, c, end, factor, order, error);
  case EO_LAW_TANGENT:
    break;
  }
  return eo_law_set_tangent(law, n, loaded->approach, loaded->tangent, c->force, order, back, error);
}

static void set_pulses(const struct eo_evaluator *e, const struct eo_case_result *c, double speed, struct eo_vibration_case *load)
{
  double period = 2 * M_PI / (speed * e->pair->geometry.teeth[EO_PINION]);
  for (int end = 0; end < e->result.ends; end++) {
    const struct eo_impact *impact = &c->end[end].impact;
    load->pulse[end] = (struct eo_pulse){.shape = EO_PULSE_NONE};
    if (impact->touched && impact->force > 0)
      load->pulse[end] = (struct eo_pulse){.shape = EO_PULSE_HALF_SINE, .amplitude = impact->force, .start = impact->start,
        .duration = fmin(1, impact->duration / period)};
  }
}

/* An end that carries nothing somewhere in the cycle has no mesh law about its load. */
static bool carries_throughout(const struct eo_loaded_end *end, int positions)
{
  bool carries = true;
  for (int j = 0; j < positions; j++)
    carries = carries && end->load[j] > 0;
  return carries;
}

static enum eo_code vibrate(struct eo_evaluator *e, const struct eo_design *design, int k, double speed_factor, double factor,
                            const struct eo_loaded_end *loaded[2], struct eo_vibration *vibration, struct eo_error *error)
{
  struct eo_case_result *c = &e->result.load_case[k];
  struct eo_dynamics_parameters parameters;
  int ends = e->result.ends, n = e->pair->grid->positions;
  double stiffness = mean(n, loaded[0]->tangent);
  if (ends == 2)
    stiffness = (stiffness + mean(n, loaded[1]->tangent)) / 2;
  struct eo_vibration_case load = {.torque = c->load_case.torque, .speed = c->load_case.speed * speed_factor,
    .pinion_teeth = e->pair->geometry.teeth[EO_PINION], .phase_right = -design->alignment.stagger, .gated = true,
    .impact = design->resolution.impact_in_dynamics};
  enum eo_code code = eo_dynamics_parameters_init(&parameters, &e->pair->geometry, &design->gear_pair, &design->material, &design->supports,
                                                  ends == 2 && !same_flanks(&design->modification), stiffness, error);
  if (!code)
    code = eo_vibration_set_model(e->vibration, &parameters, error);
  if (!code && !(carries_throughout(loaded[0], n) && carries_throughout(loaded[ends - 1], n))) {
    *vibration = (struct eo_vibration){.outcome = EO_VIBRATION_NOT_CONVERGED, .ends = ends, .harmonics = e->vibration_harmonics};
    return EO_OK;
  }
  for (int end = 0; end < ends && !code; end++) {
    load.law[end] = &e->law[k][end];
    code = set_law(e, design, &e->law[k][end], c, end, loaded[end], factor, error);
  }
  if (!code && load.impact != EO_IMPACT_NONE)
    set_pulses(e, c, load.speed, &load);
  if (!code)
    code = design->resolution.solver == EO_SOLVER_TIME_INTEGRATION
               ? eo_vibration_integrate(e->vibration, &load, NULL, vibration, NULL, error)
               : eo_vibration_solve(e->vibration, &load, EO_START_COLD, vibration, error);
  return code;
}

static void read_curves(struct eo_evaluator *e, struct eo_case_result *c)
{
  for (int end = 0; end < e->result.ends; end++)
    for (int channel = 0; channel < EO_CURVE_CHANNELS; channel++) {
      eo_vibration_history(e->vibration, (enum eo_channel)channel, end, CURVE_SAMPLES, c->end[end].curve[channel]);
      eo_vibration_orders(e->vibration, (enum eo_channel)channel, end, c->end[end].order[channel]);
    }
}

static enum eo_code solve_dynamics(struct eo_evaluator *e, const struct eo_design *design, double speed_factor, double factor, int want,
                                   struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int k = 0; k < e->result.cases && !code; k++) {
    struct eo_case_result *c = &e->result.load_case[k];
    const struct eo_loaded_end *loaded[2] = {&c->end[0].loaded, &c->end[1].loaded};
    code = vibrate(e, design, k, speed_factor, factor, loaded, &c->vibration, error);
    c->dynamic_force_factor = 1;
    for (int end = 0; end < e->result.ends && !code; end++)
      c->dynamic_force_factor = fmax(c->dynamic_force_factor, c->vibration.dynamic_factor[end]);
    if (!code && want & EO_WANT_CURVES && c->vibration.outcome != EO_VIBRATION_NOT_CONVERGED)
      read_curves(e, c);
  }
  return code;
}

/* RMS at other compliances: contact and dynamics again, one load case at a time. */
static enum eo_code find_band(struct eo_evaluator *e, const struct eo_design *design, double speed_factor, double factor, struct eo_error *error)
{
  struct eo_evaluation *r = &e->result;
  enum eo_code code = EO_OK;
  for (int k = 0; k < r->cases && !code; k++)
    for (int side = 0; side < 2 && !code; side++) {
      struct eo_case_result *c = &r->load_case[k];
      struct eo_vibration vibration;
      double scaled = factor * (side ? 1.1 : 0.9);
      const struct eo_loaded_end *loaded[2] = {&e->spare[0], &e->spare[1]};
      for (int end = 0; end < r->ends; end++)
        if (end == EO_RIGHT && r->equal_ends)
          loaded[end] = &e->spare[EO_LEFT];
        else
          eo_loaded_solve(e->contact, e->pair->grid, &e->gaps[end], scaled, 1, &c->force, &e->spare[end]);
      code = vibrate(e, design, k, speed_factor, scaled, loaded, &vibration, error);
      c->band[side] = code || vibration.outcome == EO_VIBRATION_NOT_CONVERGED ? NAN : vibration.rms_pair[EO_READING_NORMAL];
    }
  return code;
}

/* ---- the order ---- */

static void find_root_stress(struct eo_evaluator *e)
{
  enum { STEP = 2 };
  struct eo_evaluation *r = &e->result;
  for (int k = 0; k < r->cases && e->pair->flexibility; k++)
    for (int end = 0; end < r->ends; end++)
      for (int member = 0; member < 2; member++)
        eo_root_history_compute(&r->load_case[k].end[end].root[member], e->pair->flexibility, member, e->pair->grid,
                                &r->load_case[k].end[end].loaded, STEP);
}

static void collect_objectives(struct eo_evaluation *r, bool root)
{
  for (int k = 0; k < r->cases; k++) {
    const struct eo_case_result *c = &r->load_case[k];
    struct eo_objective_case *o = &r->objective[k];
    *o = (struct eo_objective_case){.peak_to_peak = c->peak_to_peak, .rms = c->vibration.rms_pair[EO_READING_NORMAL], .root_stress = root ? 0 : NAN,
      .failed = c->contact_failures > 0 || c->vibration.outcome == EO_VIBRATION_NOT_CONVERGED};
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
  for (int end = 0; end < 2; end++)
    stiffness[end] = mean(n, r->load_case[heaviest].end[end < r->ends ? end : 0].loaded.tangent);
  return eo_dynamics_model_modes(eo_vibration_model(e->vibration), stiffness, &r->modes, error);
}

static void set_cases(struct eo_evaluator *e, const struct eo_design *design)
{
  struct eo_evaluation *r = &e->result;
  r->ends = design->gear_pair.ends;
  r->cases = design->load_cases;
  for (int k = 0; k < r->cases; k++) {
    r->load_case[k].load_case = design->load_case[k];
    r->load_case[k].force = design->load_case[k].torque /
                            (r->ends * e->pair->geometry.base_radius[EO_PINION] * cos(e->pair->geometry.base_helix_angle));
    r->load_case[k].band[0] = r->load_case[k].band[1] = NAN;
    for (int end = 0; end < 2; end++)
      for (int member = 0; member < 2; member++)
        r->load_case[k].end[end].root[member].phases = 0;
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

static void solve_static(struct eo_evaluator *e, const struct eo_design *design, const struct eo_scenario *scenario)
{
  struct eo_evaluation *r = &e->result;
  double start = milliseconds();
  set_cases(e, design);
  set_fields(e, design, scenario);
  solve_contact(e, design, scenario->compliance);
  for (int k = 0; k < r->cases; k++) {
    for (int end = 0; end < r->ends; end++)
      summarise_end(e, &r->load_case[k], end);
    summarise_pair(e, design, &r->load_case[k]);
  }
  double contact = milliseconds();
  find_impacts(e, design, scenario->speed, scenario->compliance);
  r->static_ms = contact - start;
  r->impact_ms = milliseconds() - contact;
}

static const struct eo_scenario nominal_scenario = {NAN, NAN, 1, 1};

enum eo_code eo_evaluator_contact(struct eo_evaluator *e, const struct eo_design *design, const struct eo_evaluation **evaluation,
                                  struct eo_error *error)
{
  (void)error;
  solve_static(e, design, &nominal_scenario);
  *evaluation = &e->result;
  return EO_OK;
}

enum eo_code eo_evaluator_run(struct eo_evaluator *e, const struct eo_design *design, const struct eo_scenario *scenario, int want,
                              const struct eo_evaluation **evaluation, struct eo_error *error)
{
  const struct eo_scenario *s = scenario ? scenario : &nominal_scenario;
  struct eo_evaluation *r = &e->result;
  bool root = e->pair->flexibility && (want & EO_WANT_ROOT || design->objective.root_stress.enabled);
  enum eo_code code = fit_vibration(e, design->resolution.harmonics, error);
  if (code)
    return code;
  solve_static(e, design, s);
  double impact = milliseconds();
  if (root)
    find_root_stress(e);
  double rooted = milliseconds();
  code = solve_dynamics(e, design, s->speed, s->compliance, want, error);
  if (!code && want & EO_WANT_CURVES)
    code = find_modes(e, error);
  r->dynamics_ms = milliseconds() - rooted;
  r->root_ms = rooted - impact;
  if (!code && want & EO_WANT_BAND)
    code = find_band(e, design, s->speed, s->compliance, error);
  if (code)
    return code;
  collect_objectives(r, root);
  *evaluation = r;
  return EO_OK;
}

const struct eo_law *eo_evaluator_law(const struct eo_evaluator *e, int load_case, int end)
{
  return &e->law[load_case][end];
}

/* ---- fitness ---- */

int eo_evaluator_scenarios(const struct eo_design *design)
{
  return design->objective.robust == EO_ROBUST_OFF || design->objective.scenarios == 0 ? 1 : design->objective.scenarios;
}

enum eo_code eo_evaluator_raw(struct eo_evaluator *e, const struct eo_design *design, struct eo_objective_case *raw, struct eo_error *error)
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

void eo_evaluator_combine(const struct eo_design *design, const struct eo_geometry *geometry, const struct eo_objective_case *raw,
                          const struct eo_objective_case *unmodified, struct eo_objective_value *value)
{
  int scenarios = eo_evaluator_scenarios(design), cases = design->load_cases;
  bool outside = eo_objective_relief_outside(&design->modification, geometry->rack_bottom, geometry->rack_top);
  struct eo_objective_value sum = {0}, one;
  for (int s = 0; s < scenarios; s++) {
    eo_objective_value(&design->objective, cases, design->load_case, raw + s * cases, unmodified + s * cases, outside, &one);
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
  value->fitness = value->sums.failed ? EO_FITNESS_WORST : 1 / value->objective - design->objective.penalty * value->violation;
}

/* ---- storage ---- */

static enum eo_code init_end(struct eo_end_result *end, const struct eo_contact_grid *grid, struct eo_error *error)
{
  size_t n = (size_t)grid->positions;
  enum eo_code code = eo_loaded_end_init(&end->loaded, grid, error);
  for (int member = 0; member < 2 && !code; member++)
    code = eo_root_history_init(&end->root[member], grid, error);
  if (code)
    return code;
  end->unloaded = calloc(n, sizeof(double));
  end->stiffness = calloc(n, sizeof(double));
  if (!end->unloaded || !end->stiffness)
    return eo_error_memory(error);
  for (int i = 0; i < EO_CURVE_CHANNELS; i++) {
    end->curve[i] = calloc(CURVE_SAMPLES, sizeof(double));
    end->order[i] = calloc(EO_MAX_HARMONICS + 1, sizeof(double complex));
    if (!end->curve[i] || !end->order[i])
      return eo_error_memory(error);
  }
  return EO_OK;
}

static void done_end(struct eo_end_result *end)
{
  eo_loaded_end_done(&end->loaded);
  for (int member = 0; member < 2; member++)
    eo_root_history_done(&end->root[member]);
  free(end->unloaded);
  free(end->stiffness);
  for (int i = 0; i < EO_CURVE_CHANNELS; i++) {
    free(end->curve[i]);
    free(end->order[i]);
  }
}

static enum eo_code init_storage(struct eo_evaluator *e, struct eo_error *error)
{
  const struct eo_contact_grid *grid = e->pair->grid;
  struct eo_evaluation *r = &e->result;
  size_t most = (size_t)e->most_cases;
  enum eo_code code = EO_OK;
  r->positions = grid->positions;
  r->samples = CURVE_SAMPLES;
  r->load_case = calloc(most, sizeof *r->load_case);
  r->objective = calloc(most, sizeof *r->objective);
  e->law = calloc(most, sizeof *e->law);
  if (!r->load_case || !r->objective || !e->law)
    return eo_error_memory(error);
  for (int k = 0; k < e->most_cases && !code; k++) {
    r->load_case[k].transmission = calloc((size_t)grid->positions, sizeof(double));
    if (!r->load_case[k].transmission)
      return eo_error_memory(error);
    for (int end = 0; end < 2 && !code; end++)
      code = init_end(&r->load_case[k].end[end], grid, error);
  }
  for (int end = 0; end < 2 && !code; end++) {
    code = eo_loaded_gaps_init(&e->gaps[end], grid, error);
    if (!code)
      code = eo_loaded_end_init(&e->spare[end], grid, error);
  }
  return code ? code : eo_loaded_workspace_new(&e->contact, grid, error);
}

enum eo_code eo_evaluator_new(struct eo_evaluator **evaluator, const struct eo_pair *pair, int most_cases, struct eo_error *error)
{
  struct eo_evaluator *e = calloc(1, sizeof *e);
  if (!e)
    return eo_error_memory(error);
  e->pair = pair;
  e->most_cases = most_cases;
  enum eo_code code = init_storage(e, error);
  if (code)
    eo_evaluator_free(e);
  else
    *evaluator = e;
  return code;
}

void eo_evaluator_free(struct eo_evaluator *e)
{
  if (!e)
    return;
  struct eo_evaluation *r = &e->result;
  for (int k = 0; r->load_case && k < e->most_cases; k++) {
    free(r->load_case[k].transmission);
    for (int end = 0; end < 2; end++) {
      done_end(&r->load_case[k].end[end]);
      eo_law_done(e->law ? &e->law[k][end] : NULL);
    }
  }
  for (int end = 0; end < 2; end++) {
    eo_loaded_gaps_done(&e->gaps[end]);
    eo_loaded_end_done(&e->spare[end]);
  }
  for (int i = 0; e->table && i < TABLE_LOADS; i++)
    eo_loaded_end_done(&e->table[i]);
  free(e->table);
  free(e->table_rows);
  eo_loaded_workspace_free(e->contact);
  eo_vibration_free(e->vibration);
  free(e->law);
  free(r->load_case);
  free(r->objective);
  free(e);
}
