/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The periodic vibration of one load case: the lumped model under its mesh laws, solved by harmonic balance or by time
   integration, and everything that is read off it. One workspace per thread; results do not depend on what it solved
   before, except for a start from the last solution, which the caller asks for. */
#ifndef EASEOFF_DYNAMICS_VIBRATION_H
#define EASEOFF_DYNAMICS_VIBRATION_H

#include "base/error.h"
#include "base/progress.h"
#include "dynamics/integration.h"
#include "dynamics/model.h"

/* phi = speed teeth t / (2 pi): the mesh phase of the left end; the right end is at phi + phase_right. */
struct eo_vibration_case {
  double torque; /* total on the pinion, N m, > 0 */
  double speed;  /* of the pinion, rad/s, > 0 */
  int pinion_teeth;
  const struct eo_law *law[2]; /* [end], borrowed */
  double phase_right;
  bool gated; /* mesh damping only in contact */
  enum eo_impact_in_dynamics impact;
  struct eo_pulse pulse[2]; /* [end], N along the transverse line of action */
  int axial_order;          /* of the prescribed axial float of the pinion, paper's eps_z(phi); 0: none */
  const double
      *axial_motion; /* [1 + 2 order] series, m; only its rate and curvature act: the mean is absorbed by the float */
};

enum eo_vibration_start {
  EO_START_COLD, /* the teeth held together, then Newton; time integration gives a start if that fails */
  EO_START_WARM, /* Newton from the last solution of this workspace */
};

enum eo_vibration_outcome {
  EO_VIBRATION_CONVERGED,     /* a periodic state, teeth in contact throughout */
  EO_VIBRATION_CONTACT_LOST,  /* a periodic state in which teeth separate */
  EO_VIBRATION_NOT_CONVERGED, /* none was found; the numbers below are all zero */
};

/* A stable periodic state of a load case. */
struct eo_vibration_state {
  int repeat;              /* mesh periods after which it repeats, 1..4 */
  double rms[EO_READINGS]; /* mean of the ends' RMS, m/s2 */
  double contact_loss;     /* share of the cycle, worse end */
  double multiplier;       /* size of the largest Floquet multiplier, < 1; NaN with repeat > 1 */
};
enum { EO_MAX_STATES = 4 };

/* The zero modes are no part of any number here: neither torques nor meshes nor consistent impacts excite them. The
   paper's impacts do when they differ between the ends, because they leave out the axial component of the force; their
   mean would let the pinion drift away and their alternating part rattle it along its screw, so both are dropped with
   the modes. Accelerations in m/s2, [reading] as enum eo_reading; RMS over a mesh period without the mean. */
struct eo_vibration {
  enum eo_vibration_outcome outcome;
  int ends, harmonics;
  double frequency;             /* angular mesh frequency, rad/s */
  int iterations;               /* Newton's */
  int periods;                  /* of the time integration, if it ran */
  double residual;              /* of the force balance / mean load; change over the last period for time integration */
  double rms[EO_READINGS][2];   /* left, right */
  double rms_pair[EO_READINGS]; /* mean of the ends' RMS */
  double rms_of_mean[EO_READINGS];                  /* RMS of the ends' mean */
  double freedom_rms[EO_MAX_FREEDOMS];              /* accelerations of the coordinates */
  double freedom_mean[EO_MAX_FREEDOMS];             /* mean displacement, zero modes at zero, m or rad */
  double deflection_mean[2], deflection_swing[2];   /* X, mean and peak to peak, m */
  double force_mean[2], force_min[2], force_max[2]; /* dynamic mesh force, damping included, N */
  double dynamic_factor[2];                         /* force_max / mean mesh load of the torque */
  double contact_loss[2];                           /* share of the cycle out of contact */
  bool back_contact;                                /* back flanks touch */
  double bearing_force_mean[2][2];                  /* radial [member][end], signed along y, N */
  double bearing_force_max[2][2];                   /* largest size over the period */
  double axial_force_mean[2], axial_force_max[2];   /* gear thrust bearings [end], N */
  double pinion_thrust_mean, pinion_thrust_max;     /* of the pinion's axial support, + to the right; 0: floating */
  double power_supplied;                            /* by the varying mesh (law and impacts) to the vibration, W */
  double power_dissipated;                          /* in mesh, bearings and groove, W; equal in the periodic state */
  double impact_drift; /* mean impact load on the zero modes, left out like all motion in them, N/sqrt(kg) */
  int repeat;          /* mesh periods after which the state repeats; everything above is taken over all of them, but
                          spectra are of the mesh harmonics alone */
  /* Of eo_vibration_settle(); else NaN and none. */
  double multiplier; /* size of the largest Floquet multiplier; NaN with repeat > 1 */
  double unstable;   /* of the periodic state that was left because it is not stable; 0: there was none */
  int states;        /* stable states found */
  struct eo_vibration_state state[EO_MAX_STATES]; /* the loudest first: the one that is described above */
};

/* Complex amplitudes over the mesh harmonics: value = a_0 + Re sum a_k exp(2 pi i k phi). */
struct eo_spectrum {
  int harmonics, ends, freedoms;
  double frequency;
  double complex *deflection[2]; /* [1 + harmonics], m */
  double complex *force[2];      /* N */
  double complex *freedom;       /* [1 + harmonics][freedoms], displacements without the zero modes */
};

struct eo_vibration_solver; /* opaque */

/* harmonics 1..EO_MAX_HARMONICS, samples of the time grid under contact loss (0: chosen).
   Errors: EO_ERROR_INPUT, EO_ERROR_MEMORY. */
enum eo_code eo_vibration_new(struct eo_vibration_solver **solver, int harmonics, int samples, struct eo_error *error);
void eo_vibration_free(struct eo_vibration_solver *solver); /* NULL is fine */

/* Sets the model; what does not depend on the mesh is computed once per model and speed. Errors: EO_ERROR_INPUT. */
enum eo_code eo_vibration_set_model(struct eo_vibration_solver *solver, const struct eo_dynamics_parameters *parameters,
                                    struct eo_error *error);
const struct eo_dynamics_model *eo_vibration_model(const struct eo_vibration_solver *solver);

/* Harmonic balance. Errors: EO_ERROR_INPUT (torque, speed, pulses), EO_ERROR_MEMORY. */
enum eo_code eo_vibration_solve(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                enum eo_vibration_start start, struct eo_vibration *result, struct eo_error *error);

/* The vibration that teeth can keep up. Harmonic balance first; where contact is never lost and the state is stable
   that is the answer. Where contact is lost, no state was found or the one found is not stable, time integration goes
   from that state and from the static one, and from where the balance leads when the speed comes up or down to this one
   if that is another state, until the motion repeats after at most four mesh periods. The result is the stable state
   with the largest normal RMS, all that were found are listed, and none found is EO_VIBRATION_NOT_CONVERGED. Errors: as
   eo_vibration_solve(). */
enum eo_code eo_vibration_settle(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                 struct eo_vibration *result, struct eo_error *error);

/* The same search when the answer is to come by time integration: from the static state first. */
enum eo_code eo_vibration_settle_integrated(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                            struct eo_vibration *result, struct eo_error *error);

/* Of a state by harmonic balance that the solver holds, with contact lost: sets its multiplier, and where it is not
   stable puts in its place what the motion comes to when it is left, by one time integration, or
   EO_VIBRATION_NOT_CONVERGED where that repeats after no four periods. Errors: as eo_vibration_solve(). */
enum eo_code eo_vibration_keep_stable(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                      struct eo_vibration *result, struct eo_error *error);

/* Time integration from the static state to the periodic one; NULL options: eo_integration_defaults. */
enum eo_code eo_vibration_integrate(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                    const struct eo_integration_options *options, struct eo_vibration *result,
                                    const struct eo_progress *progress, struct eo_error *error);

/* Floquet multipliers of the last solution found by harmonic balance: multiplier[2 n], n = freedoms - zero modes. */
enum eo_code eo_vibration_stability(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                    double complex *multiplier, struct eo_error *error);

/* Spectrum of the last solution; valid until the next one. */
const struct eo_spectrum *eo_vibration_spectrum(const struct eo_vibration_solver *solver);

enum eo_channel {
  EO_CHANNEL_DEFLECTION, /* X, m */
  EO_CHANNEL_FORCE,      /* dynamic mesh force, N */
  EO_CHANNEL_NORMAL,     /* accelerations, m/s2 */
  EO_CHANNEL_TRANSVERSE,
  EO_CHANNEL_ROTATIONAL,
  EO_CHANNEL_PINION_BEARING, /* radial bearing forces, N */
  EO_CHANNEL_GEAR_BEARING,
  EO_CHANNEL_GEAR_THRUST, /* axial bearing force of the gear, N */
  EO_CHANNELS
};

/* Harmonics 0..spectrum.harmonics of one channel of one end. */
void eo_vibration_orders(const struct eo_vibration_solver *solver, enum eo_channel channel, int end,
                         double complex *order);

/* history[end][channel][samples] at phases i / samples. */
void eo_vibration_histories(const struct eo_vibration_solver *solver, int samples, double *const *const *history);

#endif
