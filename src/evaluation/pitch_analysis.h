/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the deviations of single teeth do over the hunting period, for every load case of an evaluation: transmission
   error over whole revolutions, its orders, the vibration it excites, the teeth that carry most. */
#ifndef EASEOFF_EVALUATION_PITCH_ANALYSIS_H
#define EASEOFF_EVALUATION_PITCH_ANALYSIS_H

#include "contact/hunting.h"
#include "dynamics/long_response.h"
#include "evaluation/evaluator.h"

enum { EO_PITCH_SHAFT_ORDERS = 4, EO_PITCH_MESH_ORDERS = 6, EO_PITCH_SIDEBANDS = 2, EO_PITCH_SIDED = 3 };
enum { EO_PITCH_ORDERS = 2 * EO_PITCH_SHAFT_ORDERS + EO_PITCH_MESH_ORDERS + 4 * EO_PITCH_SIDEBANDS * EO_PITCH_SIDED };

/* One line of the spectra by name: "gear 2", "mesh 1", "mesh 1 - pinion 2". */
struct eo_pitch_order {
  char name[32];
  double order;                     /* per revolution of the pinion */
  double transmission;              /* amplitude of the pair's transmission error, transverse, m */
  double acceleration[EO_READINGS]; /* amplitude of the mean of the ends, m/s2; NaN without a response */
};

struct eo_pitch_case {
  struct eo_load_case load_case;
  struct eo_pitch_meeting meeting;
  struct eo_hunting hunting, stretch; /* stretch: of a pair that is sketched, by which it vibrates */
  double force[2];                    /* [end] P, N */
  double *transmission;               /* [instants] of the pair, transverse, m, by mesh position */
  double mean, peak_to_peak;          /* of it over the period, m */
  double *cycle_mean, *cycle_swing;   /* [cycles] of each cycle, m */
  double *turn[2];                    /* [member]: [teeth positions] in the order of time, mean over its turns (the
                                         time-synchronous average) less the mean of all, m */
  double float_mean, float_swing;     /* of the pinion along its axis, + to the right, m; 0 with one end */
  int lines;                          /* instants/2 + 1: line k is at order k / (revolutions of the pinion) */
  double complex *line;               /* one-sided spectrum of the transmission error, see eo_fft_spectrum() */
  int orders;
  struct eo_pitch_order order[EO_PITCH_ORDERS];
  struct eo_long_response response;
};

struct eo_pitch_analysis {
  int cases;
  struct eo_pitch_case *load_case;           /* [cases] */
  bool used[2];                              /* [flank side]: a load case has it */
  struct eo_tooth_deviation *tooth[2][2][2]; /* [flank side][member][end]: [teeth] in the body's count; NULL */
  struct eo_pitch_size size[2][2][2];        /* F_p and f_p of them */
  struct eo_flank_tolerance tolerance[2];    /* [member] of the class that is stated; NaN: none is */
  double milliseconds;
};

struct eo_pitch_question {
  const struct eo_design *design; /* states single teeth; what the evaluator has run */
  double compliance_factor, speed_factor;
  bool root, vibration; /* with root stresses, where the pair has them; with the response */
  int threads;
  const struct eo_progress *progress;
};

/* After the evaluator has run the design, its contact at least. Errors: as eo_hunting_run() and
   eo_long_response_find(), cancelled. eo_pitch_analysis_done() also after an error. */
enum eo_code eo_pitch_analysis_run(struct eo_pitch_analysis *analysis, struct eo_evaluator *evaluator,
                                   const struct eo_pitch_question *question, struct eo_error *error);
void eo_pitch_analysis_done(struct eo_pitch_analysis *analysis);

#endif
