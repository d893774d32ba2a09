#include "evaluation/evaluator_private.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"

bool eo_evaluator_same_flanks(const struct eo_modification *m)
{
  return eo_modification_equal(&m->flank[EO_PINION][EO_LEFT], &m->flank[EO_PINION][EO_RIGHT]) &&
         eo_modification_equal(&m->flank[EO_GEAR][EO_LEFT], &m->flank[EO_GEAR][EO_RIGHT]);
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

/* Gaps, then the loaded contact of every load case at one end. */
static void load_end(struct eo_evaluator *e, struct eo_loaded_workspace *workspace, int end)
{
  const struct eo_end_key *key = &e->known[end];
  eo_gap_field_init(&e->field[end], &e->pair->geometry, &key->flank[EO_PINION], &key->flank[EO_GEAR], end,
                    key->in_plane, key->out_of_plane, e->pair->pivot[end], e->pair->grid->corner);
  eo_loaded_gaps_set(&e->gaps[end], e->pair->grid, &e->field[end]);
  struct eo_evaluation *r = &e->result;
  double force[EO_MAX_LOAD_CASES];
  struct eo_loaded_end loaded[EO_MAX_LOAD_CASES];
  for (int k = 0; k < r->cases; k++) {
    force[k] = r->load_case[k].force;
    loaded[k] = r->load_case[k].end[end].loaded;
  }
  eo_loaded_solve(workspace, e->pair->grid, &e->gaps[end], key->factor, r->cases, force, loaded);
  for (int k = 0; k < r->cases; k++)
    r->load_case[k].end[end].loaded.failures = loaded[k].failures;
}

int eo_evaluator_stagger(const struct eo_design *design, int positions)
{
  return (int)lround(design->alignment.stagger * positions) % positions;
}

/* How stiffly the ends are held to one axial position of the pinion: the springs of the dynamic model at rest, so that
   the loads here and the mean forces of the vibration are the same. Elastic bodies twist in the gaps already: their
   grooves count as rigid here. */
enum eo_code eo_evaluator_find_hold(struct eo_evaluator *e, const struct eo_design *design, struct eo_error *error)
{
  struct eo_dynamics_parameters parameters;
  struct eo_dynamics_model model;
  e->axial_stiffness = 0;
  if (design->gear_pair.ends == 1 || eo_alignment_axial_stiffness(&design->alignment) == 0)
    return EO_OK;
  enum eo_code code = eo_evaluator_parameters(e, design, 1, &parameters, error);
  for (int member = 0; member < 2 && !code && design->shafts.enabled; member++)
    if (parameters.groove_torsional_stiffness[member] > 0) {
      parameters.groove_torsional_stiffness[member] = INFINITY;
      parameters.groove_torsional_damping[member] = 0;
    }
  if (!code)
    code = eo_dynamics_model_init(&model, &parameters, error);
  if (!code)
    e->axial_stiffness = eo_dynamics_model_axial_stiffness(&model);
  return code;
}

static bool same_key(const struct eo_end_key *a, const struct eo_end_key *b)
{
  return a->cases == b->cases && a->in_plane == b->in_plane && a->out_of_plane == b->out_of_plane &&
         a->factor == b->factor && eo_modification_equal(&a->flank[0], &b->flank[0]) &&
         eo_modification_equal(&a->flank[1], &b->flank[1]) &&
         memcmp(a->force, b->force, sizeof *a->force * (size_t)a->cases) == 0;
}

/* Notes what an end is about to be solved for; false when that is what is kept. */
static bool is_news(struct eo_evaluator *e, const struct eo_modification *m, int end, double in_plane,
                    double out_of_plane, double factor)
{
  struct eo_end_key key = {.flank = {m->flank[EO_PINION][end], m->flank[EO_GEAR][end]},
                           .in_plane = in_plane,
                           .out_of_plane = out_of_plane,
                           .factor = factor,
                           .cases = e->result.cases};
  for (int k = 0; k < key.cases; k++)
    key.force[k] = e->result.load_case[k].force;
  bool news = !same_key(&key, &e->known[end]);
  e->known[end] = key;
  return news;
}

/* Which ends have to be solved anew. */
void eo_evaluator_set_keys(struct eo_evaluator *e, const struct eo_design *design, const struct eo_scenario *scenario)
{
  const struct eo_modification *m = &design->modification;
  double in_plane = isnan(scenario->in_plane) ? design->alignment.shaft_angle_in_plane : scenario->in_plane;
  double out_of_plane = isnan(scenario->out_of_plane) ? design->alignment.shaft_angle_out_of_plane
                                                      : scenario->out_of_plane;
  e->result.equal_ends = e->result.ends == 2 && eo_evaluator_same_flanks(m) && in_plane == 0 && out_of_plane == 0 &&
                         !e->bodies;
  for (int end = 0; end < e->result.ends; end++) {
    bool copied = end == EO_RIGHT && e->result.equal_ends;
    e->fresh[end] = !copied && is_news(e, m, end, in_plane, out_of_plane, scenario->compliance);
    e->rooted[end] = e->rooted[end] && !copied && !e->fresh[end];
  }
}

/* Where the gaps and fields of an end are kept: equal ends share the left one's. */
int eo_evaluator_kept_at(const struct eo_evaluator *e, int end)
{
  return e->result.equal_ends ? EO_LEFT : end;
}

/* Makes the bodies' influence when the design asks for elastic bodies and they have changed. */
enum eo_code eo_evaluator_fit_bodies(struct eo_evaluator *e, const struct eo_shafts *shafts, struct eo_error *error)
{
  if (shafts->enabled && e->bodies && eo_shafts_equal(shafts, &e->shafts))
    return EO_OK;
  eo_elastic_free(e->bodies);
  e->bodies = NULL;
  if (!shafts->enabled)
    return EO_OK;
  enum eo_code code = e->bent.gap ? EO_OK : eo_loaded_gaps_init(&e->bent, e->pair->grid, error);
  e->shafts = *shafts;
  return code ? code : eo_elastic_new(&e->bodies, e->pair->grid, &e->pair->gear_pair, shafts, error);
}

/* From the solution on rigid bodies to that on elastic ones. */
void eo_evaluator_bend_bodies(struct eo_evaluator *e, const struct eo_design *design, double force, double factor,
                              struct eo_loaded_end both[2], struct eo_elastic_report *report)
{
  struct eo_elastic_case load = {force, factor, e->axial_stiffness,
                                 eo_evaluator_stagger(design, e->pair->grid->positions)};
  eo_elastic_solve(e->bodies, e->contact, e->gaps, &load, both, report);
  both[EO_LEFT].failures += report->failures;
}

/* The gap field of an end as the bodies of a load case hold it; on rigid ones with c NULL. */
const struct eo_gap_field *eo_evaluator_field_of(struct eo_evaluator *e, const struct eo_case_result *c, int end)
{
  struct eo_gap_field *field = &e->field[eo_evaluator_kept_at(e, end)];
  field->deflection = c && e->bodies ? &c->end[end].deflection : NULL;
  return field;
}

static void bend_cases(struct eo_evaluator *e, const struct eo_design *design, double factor)
{
  for (int k = 0; k < e->result.cases; k++) {
    struct eo_case_result *c = &e->result.load_case[k];
    struct eo_loaded_end both[2] = {c->end[EO_LEFT].loaded, c->end[EO_RIGHT].loaded};
    struct eo_elastic_report report;
    eo_evaluator_bend_bodies(e, design, c->force, factor, both, &report);
    c->body_iterations = report.most_iterations;
    for (int end = 0; end < e->result.ends; end++) {
      c->end[end].loaded.failures = both[end].failures;
      c->end[end].deflection = report.mean[end];
    }
  }
}

/* Whether an axially held pinion shares its load unevenly between the ends. */
static bool shares_unevenly(const struct eo_evaluator *e, const struct eo_design *design)
{
  const struct eo_evaluation *r = &e->result;
  return r->ends == 2 && e->axial_stiffness > 0 &&
         !(r->equal_ends && eo_evaluator_stagger(design, e->pair->grid->positions) == 0);
}

bool eo_evaluator_copies_end(const struct eo_evaluator *e, const struct eo_design *design)
{
  return e->result.equal_ends && !shares_unevenly(e, design);
}

/* Peaks over the mesh cycle and the secant stiffness of one end. */
static void summarise_end(struct eo_evaluator *e, struct eo_case_result *c, int end)
{
  const struct eo_contact_grid *grid = e->pair->grid;
  struct eo_end_result *r = &c->end[end];
  double low = INFINITY, high = -INFINITY, steepest = 0; /* q / rho, which the largest pressure goes with */
  const double *first_contact = e->bodies ? e->bent.unloaded : r->unloaded;
  memcpy(r->unloaded, e->gaps[eo_evaluator_kept_at(e, end)].unloaded, sizeof *r->unloaded * (size_t)grid->positions);
  r->max_pressure = r->max_line_load = r->edge_share = 0;
  r->datum = r->loaded_datum = eo_gap_field_datum(eo_evaluator_field_of(e, NULL, end));
  if (e->bodies) {
    r->loaded_datum = eo_gap_field_datum(eo_evaluator_field_of(e, c, end));
    eo_loaded_first_contact(grid, eo_evaluator_field_of(e, c, end), e->bent.unloaded);
  }
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    double edge = 0;
    for (int i = 0; i < p->points; i++) {
      double q = r->loaded.line_load[p->first + i];
      r->max_line_load = q > r->max_line_load ? q : r->max_line_load;
      if (q > steepest * p->radius[i]) {
        steepest = q / p->radius[i];
        r->max_pressure = eo_loaded_pressure(grid, q, p->radius[i]);
      }
      edge += p->kind[i] == EO_POINT_LINE ? 0 : q * p->length[i];
    }
    r->edge_share = fmax(r->edge_share, r->loaded.load[j] > 0 ? edge / r->loaded.load[j] : 0);
    r->stiffness[j] = r->loaded.load[j] / (r->loaded.approach[j] - first_contact[j]);
    low = fmin(low, r->loaded.approach[j]);
    high = fmax(high, r->loaded.approach[j]);
  }
  r->transmission_peak = (high - low) / cos(grid->geometry.base_helix_angle);
}

static void summarise_cases(struct eo_evaluator *e, int end)
{
  for (int k = 0; k < e->result.cases; k++)
    summarise_end(e, &e->result.load_case[k], end);
}

/* LTE of the pair: the mean of the ends, the right one behind by the stagger. */
static void summarise_pair(struct eo_evaluator *e, const struct eo_design *design, struct eo_case_result *c)
{
  int n = e->pair->grid->positions, stagger = eo_evaluator_stagger(design, n), last = e->result.ends - 1;
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

struct ends {
  struct eo_evaluator *evaluator;
  int end[2];
  bool final; /* the loads of the ends alone are those of the pair */
};

static enum eo_code load_item(void *context, int thread, int item, struct eo_error *error)
{
  const struct ends *ends = context;
  struct eo_evaluator *e = ends->evaluator;
  (void)error;
  load_end(e, thread ? e->second_contact : e->contact, ends->end[item]);
  if (ends->final)
    summarise_cases(e, ends->end[item]);
  return EO_OK;
}

static enum eo_code load_ends(struct eo_evaluator *e, bool final, struct eo_error *error)
{
  struct ends ends = {.evaluator = e, .final = final};
  const struct eo_parallel parallel = {.threads = e->threads, .work = load_item, .context = &ends};
  struct eo_evaluation *r = &e->result;
  int count = 0;
  for (int end = 0; end < r->ends; end++)
    if (e->fresh[end])
      ends.end[count++] = end;
  enum eo_code code = eo_parallel_run(&parallel, count, error);
  for (int k = 0; k < r->cases && r->equal_ends; k++)
    copy_end(e->pair->grid, &r->load_case[k].end[EO_RIGHT].loaded, &r->load_case[k].end[EO_LEFT].loaded);
  return code;
}

enum eo_code eo_evaluator_solve_contact(struct eo_evaluator *e, const struct eo_design *design, double factor,
                                        struct eo_error *error)
{
  struct eo_evaluation *r = &e->result;
  const struct eo_contact_grid *grid = e->pair->grid;
  double stiffness = e->axial_stiffness;
  bool final = !e->bodies && !shares_unevenly(e, design);
  enum eo_code code = load_ends(e, final, error);
  if (code)
    return code;
  if (r->equal_ends)
    e->known[EO_RIGHT].cases = 0; /* its fields stayed behind */
  int stagger = eo_evaluator_stagger(design, grid->positions);
  if (e->bodies || stiffness > 0)
    e->known[EO_LEFT].cases = e->known[EO_RIGHT].cases = 0; /* the loads below are no longer those of the ends alone */
  if (e->bodies)
    bend_cases(e, design, factor);
  else if (shares_unevenly(e, design))
    for (int k = 0; k < r->cases; k++) {
      struct eo_loaded_gaps gaps[2] = {e->gaps[EO_LEFT], e->gaps[eo_evaluator_kept_at(e, EO_RIGHT)]};
      struct eo_loaded_end both[2] = {r->load_case[k].end[EO_LEFT].loaded, r->load_case[k].end[EO_RIGHT].loaded};
      eo_loaded_balance(e->contact, grid, gaps, factor, stiffness, stagger, r->load_case[k].force, both);
      for (int end = 0; end < 2; end++)
        r->load_case[k].end[end].loaded.failures = both[end].failures;
    }
  for (int end = 0; end < r->ends; end++)
    if (!final || !e->fresh[end])
      summarise_cases(e, end);
  for (int k = 0; k < r->cases; k++)
    summarise_pair(e, design, &r->load_case[k]);
  return EO_OK;
}

void eo_evaluator_find_impacts(struct eo_evaluator *e, const struct eo_design *design, double speed_factor,
                               double factor)
{
  struct eo_evaluation *r = &e->result;
  for (int k = 0; k < r->cases; k++)
    for (int end = 0; end < r->ends; end++) {
      struct eo_case_result *c = &r->load_case[k];
      if (end == EO_RIGHT && eo_evaluator_copies_end(e, design))
        c->end[end].impact = c->end[EO_LEFT].impact;
      else
        eo_impact_find(&c->end[end].impact, e->pair->grid, eo_evaluator_field_of(e, c, end), e->pair->kernel,
                       &e->pair->impact, c->end[end].loaded.approach, c->load_case.speed * speed_factor, factor);
    }
  for (int end = 0; end < r->ends; end++)
    eo_evaluator_field_of(e, NULL, end);
}
