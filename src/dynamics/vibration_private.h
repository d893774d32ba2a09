/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the files of the vibration solver; nobody else includes it. */
#ifndef EASEOFF_DYNAMICS_VIBRATION_PRIVATE_H
#define EASEOFF_DYNAMICS_VIBRATION_PRIVATE_H

#include "dynamics/balance.h"
#include "dynamics/vibration.h"

enum { EO_MAX_LAW_ROWS = 1024 };

struct eo_vibration_solver {
  int harmonics;
  struct eo_dynamics_model model;
  struct eo_balance *balance;
  struct eo_harmonic *harmonic; /* [1 + harmonics], condensed at: */
  double condensed_frequency, condensed_torque;
  enum eo_impact_in_dynamics condensed_impact;
  double *x; /* [2][1 + 2 harmonics] last solution, valid when solved */
  bool solved;
  double *motion[2];           /* [1 + 2 EO_MAX_HARMONICS] prescribed motion of each end */
  struct eo_spectrum spectrum; /* owns deflection[0], of which the other arrays are parts */
};

/* Checks the case, loads the model and fills the cycle. */
enum eo_code eo_vibration_prepare(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                  struct eo_cycle *cycle, struct eo_error *error);

/* The oscillator condensed at the frequency of the case, into s->harmonic. */
void eo_vibration_condense(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, double frequency);

/* Static state at the mean deflection of the law, condensed already: the start of a time integration; [2 n]. */
void eo_vibration_static_state(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle, double *state);

/* State at phase 0 of the spectrum last read; [2 n]. */
void eo_vibration_spectrum_state(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle, double *state);

/* Arrays of a time integration. samples: of all periods recorded. */
enum eo_code eo_vibration_make_run(struct eo_integration *run, const struct eo_oscillator *oscillator, int samples,
                                   struct eo_error *error);
void eo_vibration_free_run(struct eo_integration *run);

/* Spectrum and result from the harmonic balance, and from a recorded period. */
void eo_vibration_read_balance(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                               const struct eo_cycle *cycle, const struct eo_balance_report *report,
                               struct eo_vibration *result);
enum eo_code eo_vibration_read_run(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                   const struct eo_cycle *cycle, const struct eo_integration *run, int samples,
                                   struct eo_vibration *result, struct eo_error *error);

#endif
