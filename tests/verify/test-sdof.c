/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The single degree of freedom where closed forms exist: grazing, the linear response, the folds of case A. */
#include "support/tap.h"
#include "dynamics/sdof.h"

static const struct eo_sdof a = {.damping = 0.05, .mean_force = 0.1, .alternating_force = 0.05, .frequency = 0.78};

static double linear_amplitude(const struct eo_sdof *s, double w)
{
  return s->alternating_force * w * w / hypot(1 - w * w, 2 * s->damping * w);
}

static void grazing(void)
{
  double w[2];
  ok(eo_sdof_grazing(&a, w) == 2, "the oscillator has two grazing frequencies");
  /* 3 u^2 - 7.96 u + 4 = 0 for u = W^2 */
  close_to(w[0], sqrt((7.96 - sqrt(7.96 * 7.96 - 48)) / 6), 1e-12, "lower grazing frequency");
  close_to(w[1], sqrt((7.96 + sqrt(7.96 * 7.96 - 48)) / 6), 1e-12, "upper grazing frequency");
  for (int i = 0; i < 2; i++)
    close_to(linear_amplitude(&a, w[i]), a.mean_force, 1e-12, "amplitude at grazing, the mean deflection");
  const struct eo_sdof weak = {.damping = 0.5, .mean_force = 1, .alternating_force = 0.1, .frequency = 1};
  ok(eo_sdof_grazing(&weak, w) == 0, "a weak force never grazes");
}

static void states(void)
{
  struct eo_sdof_response low, high, start;
  ok(!eo_sdof_solve(&a, EO_SDOF_LOW, NULL, &low, NULL) && low.converged, "the small state is found");
  ok(!eo_sdof_solve(&a, EO_SDOF_HIGH, NULL, &high, NULL) && high.converged, "the large state is found");
  near(low.amplitude[0], linear_amplitude(&a, a.frequency), 1e-9, "amplitude of the small state, linear");
  near(low.floquet, exp(-a.damping * 2 * M_PI / a.frequency), 1e-6,
       "multiplier of the small state, that of the linear oscillator");
  ok(high.rms > 3 * low.rms && high.contact_loss > 0.5 && !high.back_contact,
     "the large state loses contact, without touching the back");
  ok(high.floquet < 1, "the large state is stable: %.5f", high.floquet);
  /* where teeth are apart the velocity decays, in contact the phase plane does: the trace of damping is the same
     throughout */
  near(high.floquet, exp(-a.damping * 2 * M_PI / a.frequency), 1e-4, "product of its complex multipliers, exp(-2 z T)");
  ok(!eo_sdof_solve(&a, EO_SDOF_STATE, (double[]){0.82361119, 0.13814359}, &start, NULL),
     "the large state is found from its start values");
  near(start.rms, high.rms, 1e-7, "amplitude of the large state, that of the followed branch");
}

static void folds(void)
{
  struct eo_sdof_folds found;
  double w[2];
  ok(!eo_sdof_folds(&a, 0.3, 3, &found, NULL) && found.count == 2, "case A has two folds");
  eo_sdof_grazing(&a, w);
  ok(found.going_up[0] && !found.going_up[1], "the first fold is met going up");
  close_to(found.contact_lost, w[0], 1e-3, "frequency at which contact is first lost, the grazing one");
  /* independent time integration (explicit Runge-Kutta, tolerance 1e-8): contact is lost slightly up to 0.828, the jump
     lies between 0.828 and 0.829; the reference's 0.8206 is the grazing frequency */
  ok(found.frequency[0] > 0.828 && found.frequency[0] < 0.829, "the amplitude jumps up at %.5f", found.frequency[0]);
  close_to(found.frequency[1], 0.708, 2e-3, "frequency of the downward jump");
}

int main(void)
{
  grazing();
  states();
  folds();
  return tap_done();
}
