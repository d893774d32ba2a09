/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bad input to the dynamics: every refusal has a sentence and a pointer, every outcome finite numbers. */
#include <string.h>

#include "support/dynamics-fixture.h"
#include "support/tap.h"
#include "dynamics/sdof.h"
#include "dynamics/speed_sweep.h"

static void refused(enum eo_code code, const struct eo_error *error, const char *pointer)
{
  ok(code == EO_ERROR_INPUT && error->text[0] && !strcmp(error->pointer, pointer), "the input is refused: %s: %s",
     error->pointer, error->text);
}

static void parameters(void)
{
  struct eo_error error = {0};
  struct {
    size_t offset;
    double value;
    const char *pointer;
  } bad[] = {
      {offsetof(struct eo_dynamics_parameters, mass[0]), 0, "/supports/pinion_mass_kg"},
      {offsetof(struct eo_dynamics_parameters, mass[1]), -1, "/supports/gear_mass_kg"},
      {offsetof(struct eo_dynamics_parameters, inertia[0]), NAN, "/supports/pinion_inertia_kg_m2"},
      {offsetof(struct eo_dynamics_parameters, bearing_stiffness[0]), 0, "/supports/pinion_bearing_stiffness_N_per_um"},
      {offsetof(struct eo_dynamics_parameters, bearing_stiffness[1]), -1e9,
       "/supports/gear_bearing_stiffness_N_per_um"},
      {offsetof(struct eo_dynamics_parameters, bearing_damping[1]), -1, "/supports/bearing_damping_ratio"},
      {offsetof(struct eo_dynamics_parameters, gear_axial_stiffness[1]), NAN,
       "/supports/gear_axial_stiffness_right_N_per_um"},
      {offsetof(struct eo_dynamics_parameters, groove_axial_stiffness[0]), 0,
       "/supports/pinion_groove_axial_stiffness_N_per_um"},
      {offsetof(struct eo_dynamics_parameters, groove_torsional_stiffness[1]), -1,
       "/supports/gear_groove_torsional_stiffness_Nm_per_rad"},
      {offsetof(struct eo_dynamics_parameters, groove_torsional_damping[0]), 1,
       "/supports/pinion_groove_torsional_stiffness_Nm_per_rad"},
      {offsetof(struct eo_dynamics_parameters, mesh_damping), -1, "/supports/mesh_damping_ratio"},
      {offsetof(struct eo_dynamics_parameters, base_radius[1]), 0, "/gear_pair"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    struct eo_dynamics_parameters p = paper_pair();
    *(double *)((char *)&p + bad[i].offset) = bad[i].value;
    refused(eo_dynamics_parameters_check(&p, &error), &error, bad[i].pointer);
  }
  struct eo_dynamics_parameters p = paper_pair();
  p.ends = 3;
  refused(eo_dynamics_parameters_check(&p, &error), &error, "/gear_pair/ends");
}

static void cases(void)
{
  struct eo_error error = {0};
  struct eo_vibration_solver *solver = NULL;
  struct eo_vibration r;
  struct eo_law law = {0}, empty = {0};
  const struct eo_dynamics_parameters p = paper_pair();
  stiffness_law(&law, 1);
  refused(eo_vibration_new(&solver, 0, 0, &error), &error, "/resolution/harmonics");
  refused(eo_vibration_new(&solver, 24, 40, &error), &error, "/resolution/harmonics");
  refused(eo_vibration_new(&solver, 100000, 0, &error), &error, "/resolution/harmonics");
  ok(!solver, "a refused solver leaves nothing behind");
  eo_vibration_new(&solver, 8, 0, NULL);
  struct eo_vibration_case load = paper_case(&law, &law);
  ok(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error) == EO_ERROR_NUMERIC,
     "a solver without a model is refused");
  eo_vibration_set_model(solver, &p, NULL);
  load.torque = 0;
  refused(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error), &error, "/load_cases/torque_Nm");
  load = paper_case(&law, &law);
  load.speed = 0;
  refused(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error), &error, "/load_cases/speed_rpm");
  load.speed = NAN;
  refused(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error), &error, "/load_cases/speed_rpm");
  load = paper_case(&law, &law);
  load.pinion_teeth = 0;
  refused(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error), &error, "/gear_pair/pinion_teeth");
  load = paper_case(&law, &empty);
  ok(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error) == EO_ERROR_NUMERIC, "%s",
     "a law that was never set is refused");
  load = paper_case(&law, &law);
  load.impact = EO_IMPACT_PAPER;
  load.pulse[0] = (struct eo_pulse){EO_PULSE_HALF_SINE, 100, 0, 0};
  refused(eo_vibration_solve(solver, &load, EO_START_COLD, &r, &error), &error, "");
  load.impact = EO_IMPACT_NONE;
  struct eo_vibration_case falling[2] = {load, load};
  falling[0].speed = 100;
  falling[1].speed = 50;
  refused(eo_vibration_follow(solver, 2, falling, &r, 1, &r, &error), &error, "");
  refused(eo_vibration_follow(solver, 0, falling, &r, 1, &r, &error), &error, "");
  eo_vibration_free(solver);
  eo_vibration_free(NULL);
  eo_law_done(&law);
}

static int all_finite(const struct eo_vibration *r)
{
  const double *value = &r->frequency;
  if (!isfinite(*value) || !isfinite(r->residual) || !isfinite(r->power_supplied) || !isfinite(r->power_dissipated))
    return 0;
  for (int reading = 0; reading < EO_READINGS; reading++)
    if (!isfinite(r->rms[reading][0]) || !isfinite(r->rms_pair[reading]) || !isfinite(r->rms_of_mean[reading]))
      return 0;
  return isfinite(r->force_min[0]) && isfinite(r->force_max[0]) && isfinite(r->dynamic_factor[0]) &&
         isfinite(r->bearing_force_max[0][0]);
}

/* Undamped, at the eigenfrequencies themselves: a finite answer, or an outcome. */
static void undamped_resonance(void)
{
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_dynamics_modes modes;
  struct eo_vibration_solver *solver = NULL;
  struct eo_law law = {0};
  const double k[1] = {1.1e9};
  scale_damping(&p, 0);
  eo_law_set_stiffness(&law, 0, k, 5e-5, -5e-5, NULL);
  eo_vibration_new(&solver, 8, 0, NULL);
  eo_vibration_set_model(solver, &p, NULL);
  ok(!eo_dynamics_model_modes(eo_vibration_model(solver), (double[]){1.1e9, 1.1e9}, &modes, NULL) && modes.n > 0,
     "the undamped pair has modes");
  for (int mode = 0; mode < modes.n; mode++)
    for (int impact = 0; impact < 2; impact++) {
      struct eo_vibration r;
      struct eo_vibration_case load = paper_case(&law, &law);
      load.speed = 2 * M_PI * modes.frequency[mode] / 17;
      load.impact = impact ? EO_IMPACT_CONSISTENT : EO_IMPACT_NONE;
      load.pulse[0] = load.pulse[1] = (struct eo_pulse){EO_PULSE_HALF_SINE, 5000, 0, 0.2};
      enum eo_code code = eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
      /* without a varying force nothing may move, however singular the equations */
      ok(!code && all_finite(&r) && (impact || r.rms_pair[0] < 1e-6),
         "the undamped pair at %.1f Hz%s is solved: outcome %d, RMS %.3g", modes.frequency[mode],
         impact ? " with impacts" : "", (int)r.outcome, r.rms_pair[0]);
    }
  eo_vibration_free(solver);
  eo_law_done(&law);
}

/* A spur gear's axial motion is felt by no mesh; undamped and exactly at its resonance it must not stop anything. */
static void unfelt_resonance(void)
{
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_vibration_solver *solver = NULL;
  struct eo_law law = {0};
  struct eo_vibration r;
  p.ends = 1;
  p.base_helix_angle = 0;
  scale_damping(&p, 0);
  p.mass[0] = p.mass[1] = 4;
  p.groove_axial_stiffness[0] = p.gear_axial_stiffness[0] = 4 * 1024.0 * 1024.0;
  stiffness_law(&law, 1);
  eo_vibration_new(&solver, 8, 0, NULL);
  eo_vibration_set_model(solver, &p, NULL);
  struct eo_vibration_case load = paper_case(&law, NULL);
  load.pinion_teeth = 16;
  load.speed = 64;
  ok(!eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL) && r.outcome == EO_VIBRATION_CONVERGED &&
         all_finite(&r),
     "a resonance that no mesh feels does no harm");
  eo_vibration_free(solver);
  eo_law_done(&law);
}

static void single_freedom(void)
{
  struct eo_error error = {0};
  struct eo_sdof_response r;
  struct eo_sdof bad = {.damping = -1, .mean_force = 0.1, .frequency = 1};
  refused(eo_sdof_solve(&bad, EO_SDOF_LOW, NULL, &r, &error), &error, "/z");
  bad = (struct eo_sdof){.damping = 0.1, .mean_force = 0, .frequency = 1};
  refused(eo_sdof_solve(&bad, EO_SDOF_LOW, NULL, &r, &error), &error, "/Fm");
  bad = (struct eo_sdof){.damping = 0.1, .mean_force = 1, .stiffness_share = 1, .frequency = 1};
  refused(eo_sdof_solve(&bad, EO_SDOF_LOW, NULL, &r, &error), &error, "/e");
  bad = (struct eo_sdof){.damping = 0.1, .mean_force = 1, .frequency = 0};
  refused(eo_sdof_solve(&bad, EO_SDOF_LOW, NULL, &r, &error), &error, "/W");
}

int main(void)
{
  parameters();
  cases();
  undamped_resonance();
  unfelt_resonance();
  single_freedom();
  return tap_done();
}
