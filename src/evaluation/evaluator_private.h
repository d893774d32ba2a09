/* The inside of an evaluator, shared by the files that make up one evaluation: contact, vibration, the order, storage.
 */
#ifndef EASEOFF_EVALUATION_EVALUATOR_PRIVATE_H
#define EASEOFF_EVALUATION_EVALUATOR_PRIVATE_H

#include "evaluation/evaluator.h"

struct eo_evaluator {
  const struct eo_pair *pair;
  int most_cases;
  struct eo_gap_field field[2];            /* [end] */
  struct eo_loaded_gaps gaps[2];           /* [end] */
  struct eo_end_key {                      /* what an end's fields, gaps and loads depend on beside the pair */
    struct eo_flank_modification flank[2]; /* [member] */
    double in_plane, out_of_plane, factor;
    int cases;
    double force[EO_MAX_LOAD_CASES];
  } known[2];             /* [end]: of what is kept; cases 0: nothing is */
  bool fresh[2];          /* [end]: to be solved in this run; the other end is as the last run left it */
  bool rooted[2];         /* [end]: its root stress belongs to what is kept */
  double axial_stiffness; /* between the ends and one axial position of the pinion, N/m: 0 floating, INFINITY rigid */
  int threads;            /* 1 or 2 */
  struct eo_loaded_workspace *contact, *second_contact; /* second_...: of the second thread; NULL until asked for */
  struct eo_elastic *bodies;                            /* NULL: rigid */
  struct eo_shafts shafts;                              /* those of the bodies */
  struct eo_loaded_gaps bent;                           /* of one end on bodies that stay as they are */
  struct eo_loaded_end spare[2];                        /* [end]: for the compliance band */
  struct eo_loaded_end
      *table;         /* [EO_EVALUATOR_TABLE_LOADS] of the table law, one end at a time; NULL until asked for */
  double *shifted;    /* [positions] scratch of one mesh law */
  double *table_rows; /* [EO_EVALUATOR_TABLE_LOADS][positions] */
  struct eo_root_workspace *root[2]; /* [thread]; NULL until asked for */
  struct eo_root_peak *peaks;        /* [member][teeth][most_cases * 2]; NULL until asked for */
  struct eo_vibration_solver *vibration;
  int vibration_harmonics;
  struct eo_law (*law)[2]; /* [most_cases][end] */
  struct vibration_problem {
    struct eo_dynamics_parameters parameters;
    struct eo_vibration_case load;
    bool solvable; /* false: no mesh law, or no converged contact to make one from */
  } * problem;     /* [most_cases], as last solved */
  struct eo_evaluation result;
};

enum { EO_EVALUATOR_SAMPLES = 256, EO_EVALUATOR_TABLE_LOADS = 12 };

/* Modification of both ends alike. */
bool eo_evaluator_same_flanks(const struct eo_modification *modification);

/* Where the gaps and fields of an end are kept: equal ends share the left one's. */
int eo_evaluator_kept_at(const struct eo_evaluator *e, int end);

/* Whether the right end's loads are the left one's. */
bool eo_evaluator_copies_end(const struct eo_evaluator *e, const struct eo_design *design);

/* Parameters of the dynamic model, mesh damping of the given mean mesh stiffness, N/m. */
enum eo_code eo_evaluator_parameters(const struct eo_evaluator *e, const struct eo_design *design, double stiffness,
                                     struct eo_dynamics_parameters *parameters, struct eo_error *error);

/* The contact half, in the order in which eo_evaluator_run() calls it. factor: of the compliance. */
enum eo_code eo_evaluator_fit_bodies(struct eo_evaluator *e, const struct eo_shafts *shafts, struct eo_error *error);
enum eo_code eo_evaluator_find_hold(struct eo_evaluator *e, const struct eo_design *design, struct eo_error *error);
void eo_evaluator_set_keys(struct eo_evaluator *e, const struct eo_design *design, const struct eo_scenario *scenario);
enum eo_code eo_evaluator_solve_contact(struct eo_evaluator *e, const struct eo_design *design, double factor,
                                        struct eo_error *error);
void eo_evaluator_find_impacts(struct eo_evaluator *e, const struct eo_design *design, double speed_factor,
                               double factor);

/* Both ends of one load case on elastic bodies, from their solution on rigid ones. */
void eo_evaluator_bend_bodies(struct eo_evaluator *e, const struct eo_design *design, double force, double factor,
                              struct eo_loaded_end both[2], struct eo_elastic_report *report);

/* The gap field of an end with the deflection of its bodies in a load case (NULL: rigid), valid until the next call. */
const struct eo_gap_field *eo_evaluator_field_of(struct eo_evaluator *e, const struct eo_case_result *c, int end);

/* The vibration half: every load case, then again at other compliances. */
enum eo_code eo_evaluator_solve_dynamics(struct eo_evaluator *e, const struct eo_design *design, double speed_factor,
                                         double factor, int want, struct eo_error *error);
enum eo_code eo_evaluator_find_band(struct eo_evaluator *e, const struct eo_design *design, double speed_factor,
                                    double factor, struct eo_error *error);

#endif
