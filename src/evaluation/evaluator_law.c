/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include "contact/load_bow.h"
#include "numerics/periodic.h"

#include <stdlib.h>
#include <string.h>

enum eo_code eo_evaluator_parameters(const struct eo_evaluator *evaluator, const struct eo_design *design,
                                     double stiffness, bool held, struct eo_dynamics_parameters *parameters,
                                     struct eo_error *error)
{
  bool differ = design->gear_pair.ends == 2 && (evaluator->pair->right || !eo_reuse_same_flanks(design));
  return eo_dynamics_parameters_init(parameters, &evaluator->pair->geometry, design->gear_pair.ends,
                                     held ? eo_alignment_axial_stiffness(&design->alignment) : 0, &design->supports,
                                     differ, stiffness, error);
}

/* Loads of the table law over P: close together where contact lines grow from nothing and about P, where the straight
   pieces between them have to have the slope of the curve. */
static const double TABLE_LOAD[EO_EVALUATOR_TABLE_LOADS] = {1e-4, 0.03, 0.1,  0.25, 0.5, 0.75,
                                                            0.92, 1,    1.08, 1.3,  1.8, 3};

/* What is solved for the default law: forces of ends that act on each other swing, and those of a held pinion need not
   be anywhere near P. */
enum tangent_form { FORM_STRAIGHT = 1, FORM_BENT, FORM_TABLE };
static enum tangent_form tangent_form(const struct eo_evaluator *evaluator, const struct eo_design *design,
                                      const struct eo_dynamics_parameters *parameters)
{
  bool coupled = parameters->ends == 2 && parameters->groove_torsional_stiffness[0] > 0 &&
                 parameters->groove_torsional_stiffness[1] > 0;
  if (!coupled || (evaluator->result.equal_ends && design->alignment.stagger == 0))
    return FORM_STRAIGHT;
  return parameters->pinion_axial_stiffness > 0 ? FORM_TABLE : FORM_BENT;
}

bool eo_evaluator_wants_around(const struct eo_evaluator *evaluator, const struct eo_design *design)
{
  struct eo_dynamics_parameters parameters;
  bool wanted = false;
  for (int held = 0; held < 2 && design->resolution.mesh_law == EO_LAW_TANGENT; held++)
    wanted = wanted ||
             (eo_evaluator_parameters(evaluator, design, 1, held, &parameters, &(struct eo_error){0}) == EO_OK &&
              tangent_form(evaluator, design, &parameters) == FORM_BENT);
  return wanted;
}

bool eo_evaluator_law_is_table(const struct eo_evaluator *evaluator, const struct eo_design *design,
                               const struct eo_dynamics_parameters *parameters)
{
  enum eo_mesh_law law = design->resolution.mesh_law;
  return law == EO_LAW_TABLE || (law != EO_LAW_SECANT && tangent_form(evaluator, design, parameters) == FORM_TABLE);
}

/* Measured against tables of 37 and of 70 loads (paper pair, unmodified and both optima, 0.1 deg, 700 to 8000 rpm): the
   straight law is within 2 % in RMS up to a tenth of P and within 4 % at a sixth; the bent one within 3 % up to its
   outer loads and within 4 % at a third of P. */
double eo_evaluator_law_reach(const struct eo_evaluator *evaluator, const struct eo_design *design,
                              const struct eo_dynamics_parameters *parameters)
{
  static const double STRAIGHT = 0.1, BENT = 0.25;
  enum tangent_form form = tangent_form(evaluator, design, parameters);
  if (design->resolution.mesh_law != EO_LAW_TANGENT || form == FORM_TABLE)
    return INFINITY;
  return form == FORM_BENT ? BENT : STRAIGHT;
}

const struct eo_loaded_gaps *eo_evaluator_gaps_of(struct eo_evaluator *evaluator, const struct eo_run *run,
                                                  const struct eo_case_result *load_case, int end)
{
  struct eo_loaded_gaps *bent = &evaluator->gaps_on_bent_bodies;
  const struct eo_meeting *meeting = eo_meeting_of(evaluator, load_case);
  if (!evaluator->bodies_are_elastic)
    return &meeting->gaps[eo_reuse_stored_at(evaluator, end)];
  const struct eo_loaded_end both[2] = {load_case->end[EO_LEFT].loaded, load_case->end[EO_RIGHT].loaded};
  eo_elastic_gaps(eo_meeting_bodies(evaluator, &load_case->running), meeting->gaps,
                  eo_evaluator_stagger(evaluator->pair, run->design, &load_case->running), both, end, bent->gap);
  return bent;
}

static enum eo_code make_table_storage(struct eo_evaluator *evaluator, struct eo_error *error)
{
  if (evaluator->table)
    return EO_OK;
  if (!(evaluator->table = calloc(EO_EVALUATOR_TABLE_LOADS, sizeof *evaluator->table)))
    return eo_error_memory(error);
  for (int i = 0; i < EO_EVALUATOR_TABLE_LOADS; i++)
    EO_TRY(eo_loaded_end_init(&evaluator->table[i], eo_evaluator_larger_grid(evaluator), error));
  return EO_OK;
}

/* Z of the end at other loads, in the table. */
static enum eo_code solve_table(struct eo_evaluator *evaluator, const struct eo_run *run,
                                const struct eo_law_request *request, int loads, const double *load,
                                struct eo_error *error)
{
  struct eo_solution solution[EO_EVALUATOR_TABLE_LOADS];
  EO_TRY(make_table_storage(evaluator, error));
  const struct eo_loaded_gaps *gaps = eo_evaluator_gaps_of(evaluator, run, request->load_case, request->end);
  for (int i = 0; i < loads; i++)
    solution[i] = (struct eo_solution){request->end, gaps, load[i], &evaluator->table[i], NULL};
  eo_evaluator_solve(evaluator, run, loads, solution);
  return EO_OK;
}

/* F(X, phi) from loaded contact at many loads. */
static enum eo_code set_table_law(struct eo_evaluator *evaluator, const struct eo_run *run,
                                  const struct eo_law_request *request, int order, struct eo_law *law,
                                  struct eo_error *error)
{
  int n = evaluator->result.positions;
  double load[EO_EVALUATOR_TABLE_LOADS];
  for (int i = 0; i < EO_EVALUATOR_TABLE_LOADS; i++)
    load[i] = TABLE_LOAD[i] * request->load_case->even_force[request->end];
  EO_TRY(solve_table(evaluator, run, request, EO_EVALUATOR_TABLE_LOADS, load, error));
  for (int i = 0; i < EO_EVALUATOR_TABLE_LOADS; i++)
    memcpy(evaluator->table_rows + i * n, evaluator->table[i].approach, sizeof(double) * (size_t)n);
  return eo_law_set_table(law, EO_EVALUATOR_TABLE_LOADS, n, load, evaluator->table_rows, order, 0, error);
}

/* The tangent law with the bow of the curve about P, where mesh forces swing without any vibration: ends that are
   coupled in torsion but lead each other along their transmission errors press on each other by a tenth of P, and
   stiffness varies with the load as sharply as with the phase. */
static enum eo_code set_bent_law(struct eo_evaluator *evaluator, const struct eo_law_request *request, int order,
                                 double back, struct eo_law *law, struct eo_error *error)
{
  enum { INSIDE = EO_EVALUATOR_TABLE_ROWS - 2 }; /* between the outer loads; and where the tangents end: 0, 2 P */
  int n = evaluator->result.positions;
  const struct eo_loaded_end *loaded = request->loaded;
  double force = request->load_case->even_force[request->end],
         load[EO_EVALUATOR_TABLE_ROWS] = {0, [INSIDE + 1] = 2 * force}, first = EO_LOADED_NEARBY_SHARE[0] - 1,
         last = EO_LOADED_NEARBY_SHARE[EO_LOADED_NEARBY - 1] - 1;
  for (int i = 0; i < INSIDE; i++)
    load[i + 1] = force + loaded->load[0] * (first + (last - first) * i / (INSIDE - 1));
  for (int j = 0; j < n; j++) {
    struct eo_load_bow bow;
    eo_load_bow_init(&bow, loaded, j);
    for (int i = 0; i < EO_EVALUATOR_TABLE_ROWS; i++)
      evaluator->table_rows[i * n + j] = eo_load_bow_at(&bow, (load[i] - force) / loaded->load[j]);
  }
  EO_TRY(eo_law_set_table(law, EO_EVALUATOR_TABLE_ROWS, n, load, evaluator->table_rows, order, 0, error));
  if (eo_law_touches_above(law, back))
    return eo_law_set_back(law, back, eo_periodic_mean(n, loaded->tangent), error);
  return EO_OK;
}

/* Deflections that give the secant law about P the stiffness and datum of an end that does not carry P. */
static const double *secant_deflections(struct eo_evaluator *evaluator, const struct eo_law_request *request)
{
  int n = evaluator->result.positions;
  const struct eo_loaded_end *loaded = request->loaded;
  double force = request->load_case->even_force[request->end],
         datum = request->load_case->end[request->end].loaded_datum;
  bool even = true;
  for (int j = 0; j < n; j++)
    even = even && loaded->load[j] == force;
  if (even)
    return loaded->approach;
  for (int j = 0; j < n; j++)
    evaluator->shifted[j] = datum + (loaded->approach[j] - datum) * force / loaded->load[j];
  return evaluator->shifted;
}

/* Mesh harmonics of the laws. */
static int order_of(const struct eo_evaluator *evaluator, const struct eo_design *design)
{
  int n = evaluator->result.positions;
  return design->resolution.te_harmonics < n / 2 ? design->resolution.te_harmonics : n / 2 - 1;
}

/* What a law is made from that takes more solutions of loaded contact; no form: one that takes none. back: where the
   other flanks meet, behind the backlash. */
static struct eo_law_key key_of(const struct eo_evaluator *evaluator, const struct eo_run *run,
                                const struct eo_law_request *request)
{
  const struct eo_design *design = run->design;
  const struct eo_end_result *end = &request->load_case->end[request->end];
  struct eo_law_key key = {.order = order_of(evaluator, design),
                           .force = request->load_case->even_force[request->end],
                           .compliance = run->scenario.compliance,
                           .back = end->deflection.part[0][EO_DEFLECTION_NODES / 2] - design->gear_pair.backlash};
  if (eo_evaluator_law_is_table(evaluator, design, request->parameters))
    key.form = FORM_TABLE;
  else if (design->resolution.mesh_law == EO_LAW_TANGENT &&
           tangent_form(evaluator, design, request->parameters) == FORM_BENT)
    key.form = FORM_BENT;
  return key;
}

static enum eo_code set_law(struct eo_evaluator *evaluator, const struct eo_run *run,
                            const struct eo_law_request *request, const struct eo_law_key *key, struct eo_law *law,
                            struct eo_error *error)
{
  const struct eo_loaded_end *loaded = request->loaded;
  int n = evaluator->result.positions;
  if (key->form == FORM_TABLE)
    return set_table_law(evaluator, run, request, key->order, law, error);
  if (key->form == FORM_BENT)
    return set_bent_law(evaluator, request, key->order, key->back, law, error);
  if (run->design->resolution.mesh_law == EO_LAW_SECANT)
    return eo_law_set_secant(law, n, secant_deflections(evaluator, request), key->force,
                             request->load_case->end[request->end].loaded_datum, key->order, key->back, error);
  return eo_law_set_tangent(law, n, loaded->approach, loaded->tangent, key->force, key->order, key->back, error);
}

static bool same_key(const struct eo_law_key *a, const struct eo_law_key *b)
{
  return a->form == b->form && a->order == b->order && a->force == b->force && a->compliance == b->compliance &&
         a->back == b->back;
}

/* A law that took more solutions is kept as long as its loads are: reuse.c. */
enum eo_code eo_evaluator_set_law(struct eo_evaluator *evaluator, const struct eo_run *run,
                                  const struct eo_law_request *request, struct eo_law *law, struct eo_error *error)
{
  struct eo_law_key key = key_of(evaluator, run, request),
                    *kept = &evaluator->law_of[request->load_case - evaluator->result.load_case][request->end];
  if (key.form && same_key(&key, kept))
    return EO_OK;
  kept->form = 0;
  EO_TRY(set_law(evaluator, run, request, &key, law, error));
  if (request->load_case->running.backwards)
    eo_law_reverse(law);
  *kept = key;
  return EO_OK;
}
