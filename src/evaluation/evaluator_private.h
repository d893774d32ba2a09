/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The inside of an evaluator, shared by the files that make up one evaluation. order.c calls them; a step's name is its
   line in that list. */
#ifndef EASEOFF_EVALUATION_EVALUATOR_PRIVATE_H
#define EASEOFF_EVALUATION_EVALUATOR_PRIVATE_H

#include "base/clock.h"
#include "evaluation/evaluator.h"
#include "evaluation/meeting_field.h"
#include "numerics/fft.h"

#include <math.h>
#include <stdatomic.h>
#include <stddef.h>

/* BATCH: loads that pass over the mesh cycle together, so that what they share stays in the cache. */
enum {
  EO_EVALUATOR_SAMPLES = 256,
  EO_EVALUATOR_TABLE_LOADS = 12,
  EO_EVALUATOR_TABLE_ROWS = 15,
  EO_EVALUATOR_BATCH = 12
};

/* Beside EO_WANT_...: stop after the entering impact. */
enum { EO_WANT_CONTACT_ALONE = 1 << 8 };

struct eo_roots;

/* What one run is asked for. */
struct eo_run {
  const struct eo_design *design; /* resolved, borrowed */
  struct eo_scenario scenario;    /* with shaft angle errors as numbers */
  int want;                       /* EO_WANT_... */
  bool root;                      /* with root stress */
  bool rating;                    /* with the rating: a limit asks for it */
  struct eo_team *team;           /* borrowed */
  struct eo_roots *roots;         /* borrowed; the root stress of this run */
};

/* What the gap fields, the gaps and the loads of one end depend on beside the pair and the grids. */
struct eo_end_key {
  struct eo_flank_modification flank[2][2]; /* [flank side][member] */
  double offset, compliance;
  bool around; /* with Z at neighbouring loads */
  int cases;   /* 0: nothing is stored */
  struct eo_running running[EO_MAX_LOAD_CASES];
  double force[EO_MAX_LOAD_CASES];
};

/* What a mesh law that takes more solutions of loaded contact was made from, beside the loads that are stored. */
struct eo_law_key {
  int form; /* 0: nothing is stored */
  int order;
  double force, compliance, back;
};

struct eo_design_rating;

/* One way in which the teeth meet, with all load cases that do so: a flank, a sense, an alignment. */
struct eo_meeting {
  struct eo_running running;
  struct eo_gap_field field[2]; /* [end] */
  double datum[2];              /* [end] smallest gap anywhere on the flank, m */
  struct eo_loaded_gaps gaps[2];
  struct eo_incoming_gaps incoming[2]; /* [end] on rigid bodies */
};

struct eo_evaluator {
  const struct eo_pair *pair;
  struct eo_design *made; /* a pair as drawn for a robust objective; owned; NULL until there is one */
  int most_cases;
  int threads;          /* 1 or 2 */
  struct eo_team *team; /* owned */

  /* what is still valid from the last run: reuse.c */
  struct eo_end_key solved_for[2]; /* [end] */
  bool needs_solving[2];           /* [end]: in this run; the other end is as the last run left it */
  bool kept[2];                    /* [end]: its loads, and all that follows from them, are those of the last run */
  bool root_valid[2];              /* [end]: its root stress belongs to the loads that are stored */
  struct eo_law_key (*law_of)[2];  /* [most_cases][end]: its mesh law does */

  /* contact */
  int meetings;
  struct eo_meeting *meeting[EO_MAX_LOAD_CASES]; /* owned; NULL until there is one */
  int meeting_of[EO_MAX_LOAD_CASES];             /* [load case] */
  struct eo_flank_grids grids;                   /* those of the splines */
  struct eo_flank_grids laid_grids;              /* the design's, with the numbers that stand in their place */
  struct eo_flank_spline *spline[2][2][2];       /* [flank side][member][end]; owned; NULL: no grid */
  struct eo_loaded_workspace *loaded[2][2];      /* [thread][half]; of the second thread NULL until asked for, of the
                                                    second half NULL where it is like the first */
  double axial_rest;      /* what unequal helices part when at rest, m per N: eo_dynamics_model_axial_rest() */
  double axial_stiffness; /* between the ends and one axial position of the pinion, N/m: 0 floating, INFINITY rigid */
  bool bodies_are_elastic;
  struct eo_elastic *elastic_bodies[2];      /* [inwards]; NULL: rigid, or not asked for */
  struct eo_shafts shafts;                   /* those of the bodies */
  struct eo_loaded_gaps gaps_on_bent_bodies; /* of one end at a time, on bodies that stay as they are */
  struct eo_loaded_end spare[2];             /* [end]: for the compliance band */

  /* root stress */
  struct eo_root_workspace *root[2][2]; /* [thread][half]; NULL until asked for */
  struct eo_root_peak *peaks[2];        /* [half]: [member][teeth][most_cases * 2]; NULL until asked for */
  struct eo_root_loads *root_loads[2];  /* [half]: [most_cases * 2]; NULL until asked for */

  /* mesh laws and vibration */
  struct eo_loaded_end *table;              /* [EO_EVALUATOR_TABLE_LOADS], one end at a time; NULL until asked for */
  double *table_rows;                       /* [EO_EVALUATOR_TABLE_ROWS][positions] scratch of one mesh law */
  double *shifted;                          /* [positions] scratch of one mesh law */
  struct eo_law (*law)[2];                  /* [most_cases][end] */
  struct eo_vibration_solver *vibration[2]; /* [thread]; NULL until needed */
  int vibration_harmonics[2];
  struct eo_fft_tables *fft; /* of hunting periods */
  struct eo_vibration_problem {
    struct eo_dynamics_parameters parameters;
    struct eo_vibration_case load;
    bool solvable; /* false: no mesh law, or no converged contact to make one from */
  } * problem;     /* [most_cases], as last solved */

  struct eo_design_rating *rating; /* NULL until a limit asks for it */

  struct eo_evaluation result;
};

/* What an end is solved on. */
static inline const struct eo_contact_grid *eo_evaluator_grid(const struct eo_evaluator *evaluator, int end)
{
  return eo_pair_half(evaluator->pair, end)->grid;
}

/* Which of two things that halves have for themselves is an end's. */
static inline int eo_evaluator_half(const struct eo_evaluator *evaluator, int end)
{
  return end == EO_RIGHT && evaluator->pair->right;
}

/* The one with more points: what is made for it has room for either. */
static inline const struct eo_contact_grid *eo_evaluator_larger_grid(const struct eo_evaluator *evaluator)
{
  const struct eo_contact_grid *left = eo_evaluator_grid(evaluator, EO_LEFT),
                               *right = eo_evaluator_grid(evaluator, EO_RIGHT);
  return right->points > left->points ? right : left;
}

static inline struct eo_loaded_workspace *eo_evaluator_workspace(const struct eo_evaluator *evaluator, int thread,
                                                                 int end)
{
  return evaluator->loaded[thread][eo_evaluator_half(evaluator, end)];
}

/* In meeting.c. */

/* Which load cases meet in one way, and the splines of grids that have changed. */
enum eo_code eo_evaluator_find_meetings(struct eo_evaluator *evaluator, const struct eo_run *run,
                                        struct eo_error *error);

/* How a load case of the evaluator meets. */
struct eo_meeting *eo_meeting_of(const struct eo_evaluator *evaluator, const struct eo_case_result *load_case);

/* How the pinion is held in a load case. */
struct eo_axial_hold eo_meeting_hold(const struct eo_evaluator *evaluator, const struct eo_design *design,
                                     const struct eo_case_result *load_case);

/* The bodies of a load case; NULL: rigid. */
struct eo_elastic *eo_meeting_bodies(const struct eo_evaluator *evaluator, const struct eo_running *running);

void eo_meetings_done(struct eo_evaluator *evaluator);

/* In evaluator_contact.c. */

/* Loaded contact of one end under one load. */
struct eo_solution {
  int end;
  const struct eo_loaded_gaps *gaps; /* borrowed */
  double load;
  struct eo_loaded_end *result; /* borrowed */
  struct eo_end_result *owner;  /* whose result it is, for its root stress; NULL: nobody's. Borrowed */
};

/* Solves them at the compliance of the run, on both threads where there are two; those with the same gaps stand
   together. Each is as it would be alone. */
void eo_evaluator_solve(struct eo_evaluator *evaluator, const struct eo_run *run, int solutions,
                        const struct eo_solution *solution);

void eo_evaluator_set_cases(struct eo_evaluator *evaluator, const struct eo_run *run);
enum eo_code eo_evaluator_fit_bodies(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error);
enum eo_code eo_evaluator_find_hold(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error);

/* Steps of one end, on any thread. */
typedef void eo_end_step(struct eo_evaluator *evaluator, const struct eo_run *run, int end);

/* Of an end that is not kept. */
eo_end_step eo_end_set_fields;

/* At every point of every end that is not kept. */
void eo_evaluator_set_gaps(struct eo_evaluator *evaluator, const struct eo_run *run);

/* Every end and load that is not kept. */
void eo_evaluator_solve_cases(struct eo_evaluator *evaluator, const struct eo_run *run);

void eo_evaluator_copy_equal_end(struct eo_evaluator *evaluator);
void eo_evaluator_bend_cases(struct eo_evaluator *evaluator, const struct eo_run *run);
void eo_evaluator_balance_cases(struct eo_evaluator *evaluator, const struct eo_run *run);

/* Both ends of one load case on elastic bodies, from their solution on rigid ones. */
void eo_evaluator_bend_bodies(struct eo_evaluator *evaluator, const struct eo_run *run,
                              const struct eo_case_result *load_case, struct eo_loaded_end both[2],
                              struct eo_elastic_report *report);

/* Parameters of the dynamic model, mesh damping of the given mean mesh stiffness, N/m. held: between stops the pinion
   is not. */
enum eo_code eo_evaluator_parameters(const struct eo_evaluator *evaluator, const struct eo_design *design,
                                     double stiffness, bool held, struct eo_dynamics_parameters *parameters,
                                     struct eo_error *error);

/* In evaluator_summary.c. */

/* A step of every end. */
eo_end_step eo_end_summarise;

void eo_evaluator_summarise_pairs(struct eo_evaluator *evaluator, const struct eo_run *run);
void eo_evaluator_find_impacts(struct eo_evaluator *evaluator, const struct eo_run *run);

/* In evaluator_roots.c. */

enum { EO_ROOT_BATCH = 8 }; /* ends at a time, so that the stresses of a tooth stay in the cache */

/* Root stress of several ends of one half; the work is one tooth of a member. */
struct eo_root_group {
  struct eo_roots *roots;
  int half, ends;
  int place[EO_ROOT_BATCH]; /* among the ends of the half */
  struct eo_end_result *end[EO_ROOT_BATCH];
  struct eo_work_list list;
};
struct eo_root_half {
  int ends, teeth, first_tooth; /* ends: to compute; teeth: of a member that are in mesh over the cycle */
  struct eo_end_result *end[EO_MAX_LOAD_CASES * 2];
  bool offered[EO_MAX_LOAD_CASES * 2];
};
struct eo_roots {
  struct eo_evaluator *evaluator;
  struct eo_team *team;        /* borrowed */
  bool wanted, early;          /* early: the loads of an end alone are those it has in the end */
  bool copies_left;            /* the right end is a copy of the left one */
  struct eo_root_half half[2]; /* both ends in the first where they are alike */
  atomic_int groups;
  struct eo_root_group group[EO_MAX_LOAD_CASES * 2];
  double milliseconds[2]; /* [thread] */
};

/* Lists the ends whose root stress is to be found, before loads are solved. */
enum eo_code eo_roots_begin(struct eo_roots *roots, struct eo_evaluator *evaluator, const struct eo_run *run,
                            struct eo_error *error);

/* The loads of these ends of one half are what they are: whoever has time begins. On any thread. */
void eo_roots_offer(struct eo_roots *roots, int ends, struct eo_end_result *const *end);

/* Those of all ends are. */
void eo_roots_offer_rest(struct eo_roots *roots);
void eo_roots_finish(struct eo_roots *roots);

/* In evaluator_vibration.c. */

enum eo_code eo_evaluator_set_laws(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error);
enum eo_code eo_evaluator_find_vibrations(struct eo_evaluator *evaluator, const struct eo_run *run,
                                          struct eo_error *error);
enum eo_code eo_evaluator_find_modes(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error);
enum eo_code eo_evaluator_find_band(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error);

/* In evaluator_law.c. */

/* One end of a load case that is to become a mesh law. */
struct eo_law_request {
  const struct eo_case_result *load_case;
  const struct eo_dynamics_parameters *parameters;
  const struct eo_loaded_end *loaded; /* at the compliance of the run */
  int end;
};

/* EO_ERROR_INPUT: next to no load, with a stiffness so uneven that its first harmonics are negative somewhere. */
enum eo_code eo_evaluator_set_law(struct eo_evaluator *evaluator, const struct eo_run *run,
                                  const struct eo_law_request *request, struct eo_law *law, struct eo_error *error);

/* The gaps at which an end is loaded: elastic bodies stay as the load case bends them. Of those, until the next call.
 */
const struct eo_loaded_gaps *eo_evaluator_gaps_of(struct eo_evaluator *evaluator, const struct eo_run *run,
                                                  const struct eo_case_result *load_case, int end);

/* Whether a law will be made from Z at the loads about P too. */
bool eo_evaluator_wants_around(const struct eo_evaluator *evaluator, const struct eo_design *design);

/* Whether the law is a table of loaded contact at many loads. */
bool eo_evaluator_law_is_table(const struct eo_evaluator *evaluator, const struct eo_design *design,
                               const struct eo_dynamics_parameters *parameters);

/* Swing of the mesh force, share of P, up to which the law follows the loaded contact. */
double eo_evaluator_law_reach(const struct eo_evaluator *evaluator, const struct eo_design *design,
                              const struct eo_dynamics_parameters *parameters);

/* In evaluator_fitness.c. */

void eo_evaluator_collect_objectives(struct eo_evaluator *evaluator, const struct eo_run *run);

/* In evaluator_rating.c: what the limits on the rating look at. First, on the evaluator itself, whose results are lost;
   then from its result, into the objective of the first load case. */
enum eo_code eo_evaluator_lean(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error);
void eo_evaluator_rate(struct eo_evaluator *evaluator, const struct eo_run *run);

/* In reuse.c. */

/* Tells equal ends, and which ends need solving; notes what will be stored after this run. */
void eo_reuse_compare(struct eo_evaluator *evaluator, const struct eo_run *run);

/* Nothing that is stored is valid. */
void eo_reuse_forget(struct eo_evaluator *evaluator);

/* Flanks of both ends alike, grids included. */
bool eo_reuse_same_flanks(const struct eo_design *design);

/* Where the gaps and the field of an end are stored: equal ends share the left one's. */
int eo_reuse_stored_at(const struct eo_evaluator *evaluator, int end);

/* Whether a held pinion moves load from one end to the other. */
bool eo_reuse_shares_unevenly(const struct eo_evaluator *evaluator, const struct eo_design *design);

/* Whether the right end carries exactly what the left one does, so that its results are copies. */
bool eo_reuse_copies_left(const struct eo_evaluator *evaluator, const struct eo_design *design);

#endif
