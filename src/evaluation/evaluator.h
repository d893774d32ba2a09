/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One true evaluation: gear -> contact -> dynamics -> objective. The order is written in one place, order.c; what is
   still valid from the run before is decided in another, reuse.c. An evaluator belongs to one thread and owns all
   workspaces; results do not depend on what it evaluated before. */
#ifndef EASEOFF_EVALUATION_EVALUATOR_H
#define EASEOFF_EVALUATION_EVALUATOR_H

#include "base/team.h"
#include "contact/elastic.h"
#include "contact/face_load.h"
#include "contact/loaded.h"
#include "dynamics/vibration.h"
#include "evaluation/pair.h"
#include "evaluation/objective.h"

/* Raised with every change after which the same design gives other numbers: what a history keeps belongs to one
   version. */
enum { EO_EVALUATOR_VERSION = 3 };

/* What to compute beyond the objectives. */
enum {
  EO_WANT_ROOT = 1,   /* root stress (computed anyway when it is constrained) */
  EO_WANT_BAND = 2,   /* RMS at 0.9 and 1.1 times the compliance */
  EO_WANT_CURVES = 4, /* histories and orders of the vibration */
  EO_WANT_RATING = 8, /* rating and tribology: two more contact analyses; of an analysis alone */
  EO_WANT_PITCH = 16, /* the hunting period, where the design states single teeth; of an analysis alone */
};

enum { EO_CURVE_CHANNELS = EO_CHANNELS };

struct eo_end_result {
  struct eo_loaded_end loaded;
  double *unloaded;    /* [positions] Z0, m, normal */
  double *stiffness;   /* [positions] P / (Z - Z0), N/m, normal; Z0 with the bodies as the load holds them */
  double datum;        /* smallest gap anywhere on the flank, m */
  double loaded_datum; /* the same with the bodies as the load holds them */
  struct eo_deflection deflection; /* of elastic bodies, mean over the mesh cycle; 0: rigid */
  struct eo_impact impact;
  struct eo_face_load face;                 /* over the face, among the pairs */
  double max_pressure;                      /* Pa */
  double max_line_load;                     /* N/m */
  double edge_share;                        /* largest share of P on tip-edge points over the cycle */
  double transmission_peak;                 /* peak-to-peak LTE of this end alone, transverse, m */
  struct eo_root_history root[2];           /* [member]; empty unless computed */
  double *curve[EO_CURVE_CHANNELS];         /* [samples] each; with EO_WANT_CURVES */
  double complex *order[EO_CURVE_CHANNELS]; /* [harmonics + 1] each; with EO_WANT_CURVES */
};

struct eo_case_result {
  struct eo_load_case load_case;
  double force;         /* P per end, normal, N; P' of both where their helices differ */
  double even_force[2]; /* [end] what it carries on a floating pinion without a thrust: P, or its share by its helix */
  double end_force[2];  /* [end] of a floating pinion: that, and what a coupling's thrust moves from one to the other */
  struct eo_running running; /* flank, sense, alignment */
  bool at_stop;              /* the pinion has play, and on the mean it is at a stop */
  struct eo_end_result end[2];
  double *transmission;        /* [positions] LTE of the pair, transverse, m */
  double peak_to_peak, mean;   /* of it, m */
  double dynamic_force_factor; /* largest dynamic over static mesh force */
  struct eo_vibration vibration;
  double law_reach; /* swing of the mesh force, share of P, up to which the mesh law follows the loaded contact */
  double band[EO_READINGS][2]; /* pair's RMS at 0.9 and 1.1 times the compliance; NaN unless asked for */
  int contact_failures;        /* positions whose loaded contact did not converge */
  int body_iterations;         /* the most that elastic bodies took at one position; 0: rigid */
};

struct eo_evaluation {
  int ends, cases, positions, samples, harmonics;
  bool equal_ends;
  bool torsion_left_out; /* flanks of both ends are alike and "paper" does not couple them, though their loads differ */
  struct eo_case_result *load_case;    /* [cases] */
  struct eo_objective_case *objective; /* [cases] */
  struct eo_dynamics_modes modes;      /* with the mean mesh stiffness of the heaviest share */
  int solutions; /* of loaded contact over the whole mesh cycle, one end and load each, that this run took; those on
                    elastic bodies and of held pinions apart */
  /* where the time went, ms; root: of both threads, beside impact and dynamics */
  double static_ms, impact_ms, dynamics_ms, root_ms;
};

struct eo_evaluator;

/* The pair is borrowed. most_cases: load cases it has room for. */
enum eo_code eo_evaluator_new(struct eo_evaluator **evaluator, const struct eo_pair *pair, int most_cases,
                              struct eo_error *error);
void eo_evaluator_free(struct eo_evaluator *evaluator);

/* Threads that one evaluation may use, 1 (as made) or 2: both ends at once, then root stress beside the vibration. The
   results do not depend on it. */
enum eo_code eo_evaluator_use_threads(struct eo_evaluator *evaluator, int threads, struct eo_error *error);

/* Its threads, for what its caller makes of the results between runs. */
struct eo_team *eo_evaluator_team(const struct eo_evaluator *evaluator);

/* Evaluates alignment, supports, load cases, modification and dynamics of a resolved design. scenario: NULL for the
   nominal one. evaluation stays valid until the next run. Errors: EO_ERROR_INPUT (supports), memory; what does not
   converge is an outcome. */
enum eo_code eo_evaluator_run(struct eo_evaluator *evaluator, const struct eo_design *design,
                              const struct eo_scenario *scenario, int want, const struct eo_evaluation **evaluation,
                              struct eo_error *error);

/* The static half alone: loaded contact and entering impact, no vibration. */
enum eo_code eo_evaluator_contact(struct eo_evaluator *evaluator, const struct eo_design *design,
                                  const struct eo_evaluation **evaluation, struct eo_error *error);
/* The same under a scenario; NULL: the nominal one. */
enum eo_code eo_evaluator_contact_at(struct eo_evaluator *evaluator, const struct eo_design *design,
                                     const struct eo_scenario *scenario, const struct eo_evaluation **evaluation,
                                     struct eo_error *error);

/* Raw values over the scenarios that count (the nominal one, or those of a robust objective):
   raw[eo_evaluator_scenarios()][cases]. */
int eo_evaluator_scenarios(const struct eo_design *design);
enum eo_code eo_evaluator_raw(struct eo_evaluator *evaluator, const struct eo_design *design,
                              struct eo_objective_case *raw, struct eo_error *error);

/* The same from a scenario on: raw still begins with the first. */
enum eo_code eo_evaluator_raw_from(struct eo_evaluator *evaluator, const struct eo_design *design, int first,
                                   struct eo_objective_case *raw, struct eo_error *error);

/* J and fitness from raw values of the design and of the same design without modification: nominal, mean or worst over
   the scenarios. */
void eo_evaluator_combine(const struct eo_design *design, const struct eo_geometry *geometry,
                          const struct eo_objective_case *raw, const struct eo_objective_case *unmodified,
                          struct eo_objective_value *value);

/* The vibration problem of a load case as the last evaluation (without a compliance band) solved it, for sweeps over
   speed. The laws in load are borrowed, valid until the next run. False: the loaded contact gave no mesh law; that case
   has no periodic state. */
bool eo_evaluator_vibration(const struct eo_evaluator *evaluator, int load_case,
                            struct eo_dynamics_parameters *parameters, struct eo_vibration_case *load);

/* Impacts of one load case as pulses of the equations of motion. impact[2], pulse[2]: [end]; speed: of the pinion,
   rad/s. */
void eo_evaluator_pulses(const struct eo_pair *pair, const struct eo_impact *impact, double speed,
                         struct eo_pulse *pulse);

/* The gap field of an end on rigid bodies in a load case of the last evaluation: borrowed, valid until the next run. */
const struct eo_gap_field *eo_evaluator_field(const struct eo_evaluator *evaluator, int load_case, int end);

/* The pair it evaluates. */
const struct eo_pair *eo_evaluator_pair(const struct eo_evaluator *evaluator);

/* Positions by which the right end lags behind the left one as phases grow: the stagger, less what a half of another
   width is ahead. */
int eo_evaluator_stagger(const struct eo_pair *pair, const struct eo_design *design, const struct eo_running *running);
/* The same in positions of which so many make a mesh cycle. */
int eo_evaluator_stagger_of(const struct eo_pair *pair, const struct eo_design *design,
                            const struct eo_running *running, int positions);

#endif
