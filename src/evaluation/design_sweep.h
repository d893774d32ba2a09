/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A design over torque and speed, and the same design without modification beside it:
   loaded contact and mesh laws once per torque, vibration at every speed, upwards and downwards. */
#ifndef EASEOFF_EVALUATION_DESIGN_SWEEP_H
#define EASEOFF_EVALUATION_DESIGN_SWEEP_H

#include "evaluation/evaluator.h"

enum { EO_SWEEP_DESIGN, EO_SWEEP_UNMODIFIED, EO_SWEEP_VARIANTS };
enum { EO_SWEEP_UP, EO_SWEEP_DOWN, EO_SWEEP_DIRECTIONS };
enum { EO_SWEEP_MOST_POINTS = 20000, EO_SWEEP_KEY = 200 }; /* torques times speeds; bytes of a key */

struct eo_sweep_plan {
  int torques, speeds;
  const double *torque; /* [torques], total on the pinion, N m, ascending; 0 torques: that of the load case with the
                           largest share */
  const double *speed;  /* [speeds], of the pinion, rad/s, ascending; 0 speeds: likewise */
  int threads;          /* 0: eo_parallel_cores() */

  /* In place of torques (0 of them) a number of the design: at each step the design's own torque, that of its load case
     with the largest share. */
  int steps;                    /* 0: none */
  const char *key;              /* the number's name */
  const double *value;          /* [steps], as the document has it */
  const struct eo_design *step; /* [steps], resolved, served by the pair */
};

/* Static: at one torque. NaN, and no modes, where the loaded contact did not converge. */
struct eo_sweep_torque {
  double peak_to_peak, mean;       /* LTE of the pair, transverse, m */
  double stiffness[2], tangent[2]; /* [end] means over the mesh cycle of P/(Z - Z0) and dP/dZ, N/m, normal */
  double max_pressure[2];          /* Pa */
  double max_line_load[2];         /* N/m */
  double edge_share[2];            /* largest share of P on tip edges */
  int contact_failures;            /* positions of the mesh cycle that did not converge */
  struct eo_dynamics_modes modes;  /* with the mean tangent stiffness */
};

/* At one torque and speed. Where only one direction found a periodic state it stands for both. Numbers of the vibration
   are NaN where no periodic state was found. */
struct eo_sweep_point {
  enum eo_vibration_outcome outcome;
  double impact[2];                                                            /* general entering impact [end], N */
  double rms[EO_READINGS][2], rms_pair[EO_READINGS], rms_of_mean[EO_READINGS]; /* m/s2 */
  double dynamic_factor[2], contact_loss[2];
  bool back_contact;
};

/* A speed at which mesh order `order` meets an eigenfrequency. */
struct eo_sweep_crossing {
  int torque, mode, order; /* index, index, 1.. */
  double frequency;        /* Hz */
  double speed;            /* of the pinion, rad/s */
};

struct eo_sweep {
  int ends, torques, speeds;                            /* a step of another number counts as a torque */
  double *torque, *speed;                               /* [torques], [speeds] */
  double *value;                                        /* [torques], of that number; NULL: none */
  char key[EO_SWEEP_KEY];                               /* its name */
  struct eo_sweep_torque *at_torque[EO_SWEEP_VARIANTS]; /* [torques] */
  struct eo_sweep_point *point[EO_SWEEP_VARIANTS][EO_SWEEP_DIRECTIONS]; /* [torques][speeds] */
  bool branches[EO_SWEEP_VARIANTS];                                     /* up and down differ somewhere */
  int crossings;
  struct eo_sweep_crossing
      *crossing; /* of the design within the speeds, orders 1..te_harmonics; by torque, mode and order */
};

/* design: resolved, served by the pair; its load cases are not used but for the defaults. The same bytes for any number
   of threads. Where the design asks for time integration every speed is integrated on its own and both directions are
   the same. Errors: EO_ERROR_INPUT (torques or speeds that are not positive or do not ascend, too many points,
   supports), EO_ERROR_MEMORY, EO_ERROR_CANCELLED; what does not converge is an outcome. eo_sweep_done() also after an
   error. */
enum eo_code eo_sweep_run(struct eo_sweep *sweep, const struct eo_pair *pair, const struct eo_design *design,
                          const struct eo_sweep_plan *plan, const struct eo_progress *progress, struct eo_error *error);
void eo_sweep_done(struct eo_sweep *sweep); /* NULL is fine */

#endif
