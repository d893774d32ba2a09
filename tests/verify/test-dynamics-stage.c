/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dynamics fed with the static arrays of evaluation.json (case S02), its default parameters for two gear pairs, and
   the harmonic balance against time integration on the same arrays. */
#include "support/cases-json.h"
#include "support/dynamics-fixture.h"
#include "design/design.h"
#include "dynamics/parameters.h"

enum { POSITIONS = 64, ORDER = 10, HARMONICS = 24 };

static void row_of(const json_t *rows, int end, double unit, double *value)
{
  for (int i = 0; i < POSITIONS; i++)
    value[i] = unit * json_number_value(json_array_get(json_array_get(rows, end), i));
}

struct stage {
  double z[2][POSITIONS], k[2][POSITIONS], load;
};

static struct stage read_stage(const json_t *s02)
{
  struct stage s;
  const json_t *stage = json_object_get(s02, "stage");
  for (int end = 0; end < 2; end++) {
    row_of(json_object_get(stage, "Z_um"), end, 1e-6, s.z[end]);
    row_of(json_object_get(stage, "kt_N_um"), end, 1e6, s.k[end]);
  }
  const struct eo_dynamics_parameters p = paper_pair();
  s.load = eo_dynamics_mesh_load(&p, number_of(s02, "T_Nm"), 0);
  return s;
}

static void against_reference(struct eo_vibration_solver *solver, const json_t *s02, const struct stage *s)
{
  struct eo_law law[2] = {{0}, {0}};
  struct eo_vibration r;
  const json_t *out = json_object_get(s02, "out");
  const json_t *datum = json_object_get(json_object_get(s02, "ends"), "datum_Z_um");
  struct eo_vibration_case load = paper_case(&law[0], &law[1]);
  for (int end = 0; end < 2; end++) {
    struct eo_error error = {0};
    int failed = eo_law_set_tangent(&law[end], POSITIONS, s->z[end], s->k[end], s->load, ORDER, -1e-4, &error);
    ok(!failed, "the stiffness law of S02 is set %s", error.text);
  }
  ok(!eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL) && r.outcome == EO_VIBRATION_CONVERGED,
     "the tangent law of S02 converges");
  near(r.rms_pair[EO_READING_NORMAL], number_of(out, "rms_n"), 1e-3, "normal RMS of S02");
  near(r.rms_pair[EO_READING_TRANSVERSE], number_of(out, "rms_t"), 1e-3, "transverse RMS of S02");
  near(r.rms_pair[EO_READING_ROTATIONAL], number_of(out, "rms_rot"), 1e-3, "rotational RMS of S02");
  near(r.force_min[0] / s->load, number_of(s02, "Fmin_over_P"), 1e-3, "smallest force of S02");
  double complex order[1 + HARMONICS];
  eo_vibration_orders(solver, EO_CHANNEL_NORMAL, 0, order);
  const json_t *harmonics = json_object_get(s02, "acc_harmonics_n");
  ok(json_array_size(harmonics) > 0, "the case S02 has harmonics of its acceleration");
  for (size_t k = 1; k <= json_array_size(harmonics); k++)
    close_to(cabs(order[k]), json_number_value(json_array_get(harmonics, k - 1)), 1e-3 * 12.3,
             "acceleration harmonic of S02");
  for (int end = 0; end < 2; end++)
    eo_law_set_secant(&law[end], POSITIONS, s->z[end], s->load, 1e-6 * json_number_value(json_array_get(datum, end)),
                      ORDER, -1e-4, NULL);
  ok(!eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL) && r.outcome == EO_VIBRATION_CONVERGED,
     "the secant law of S02 converges");
  near(r.rms_pair[EO_READING_NORMAL], number_of(out, "rms_n_secant"), 1e-3, "normal RMS of S02 by the secant law");
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
}

/* A reversed sense of the phase, or one end reversed against the other, is not the same case. */
static void sense_of_phase_matters(struct eo_vibration_solver *solver, const json_t *s02, const struct stage *s)
{
  struct eo_law law = {0};
  struct eo_vibration r;
  double z[POSITIONS], k[POSITIONS], expected = number_of(json_object_get(s02, "out"), "rms_n");
  for (int i = 0; i < POSITIONS; i++) {
    z[i] = s->z[0][(POSITIONS - i) % POSITIONS];
    k[i] = s->k[0][(POSITIONS - i) % POSITIONS];
  }
  struct eo_vibration_case load = paper_case(&law, &law);
  eo_law_set_tangent(&law, POSITIONS, z, k, s->load, ORDER, -1e-4, NULL);
  eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  ok(fabs(r.rms_pair[0] / expected - 1) > 2e-3, "a reversed sense of the phase is told apart: %.4f against %.4f",
     r.rms_pair[0], expected);
  eo_law_done(&law);
}

/* The table law T1 of dynamics.json is nonlinear in the load, so that the three torques are three cases. */
static void table_law(struct eo_law *law)
{
  json_t *dynamics = load_cases("dynamics.json");
  const json_t *table = json_object_get(dynamics, "table_T1"), *loads = json_object_get(table, "P"),
               *rows = json_object_get(table, "Z");
  int count = (int)json_array_size(loads), positions = (int)json_array_size(json_array_get(rows, 0));
  double p[32], z[32 * 64];
  for (int i = 0; i < count; i++) {
    p[i] = json_number_value(json_array_get(loads, i));
    for (int j = 0; j < positions; j++)
      z[i * positions + j] = json_number_value(json_array_get(json_array_get(rows, i), j));
  }
  ok(!eo_law_set_table(law, count, positions, p, z, positions / 2, 5e-5, NULL), "table T1 of %d loads is set", count);
  json_decref(dynamics);
}

static void balance_against_integration(struct eo_vibration_solver *solver)
{
  struct eo_law law = {0};
  table_law(&law);
  for (int torque = 621; torque <= 1035; torque += 207) {
    struct eo_vibration balance, integration;
    struct eo_vibration_case load = paper_case(&law, &law);
    load.torque = torque;
    load.phase_right = 0.2;
    eo_vibration_solve(solver, &load, EO_START_COLD, &balance, NULL);
    eo_vibration_integrate(solver, &load, NULL, &integration, NULL, NULL);
    ok(integration.outcome == EO_VIBRATION_CONVERGED, "time integration at %d N m settles in %d periods", torque,
       integration.periods);
    for (int end = 0; end < 2; end++)
      for (int reading = 0; reading < EO_READINGS; reading++)
        near(balance.rms[reading][end], integration.rms[reading][end], 1e-4, "RMS, balance against integration");
  }
  eo_law_done(&law);
}

static struct eo_supports default_supports(void)
{
  return (struct eo_supports){.bearing_stiffness = {8e8, 1e9},
                              .gear_axial_stiffness = {2e8, 2e8},
                              .groove_axial_stiffness = {NAN, NAN},
                              .groove_torsional_stiffness = {NAN, NAN},
                              .mass = {NAN, NAN},
                              .inertia = {NAN, NAN},
                              .bearing_damping_ratio = 0.05,
                              .groove_damping_ratio = 0.02,
                              .mesh_damping_ratio = 0.07,
                              .mesh_damping_stiffness = NAN};
}

/* Geometry from the reference's own check values: only the dynamics is on trial here. */
static void pair_of(const json_t *pair, struct eo_geometry *g, struct eo_gear_pair *p)
{
  const json_t *input = json_object_get(pair, "input"), *check = json_object_get(pair, "check");
  double mn = number_of(input, "mn") * 1e-3, beta = number_of(input, "beta") * M_PI / 180;
  *g = (struct eo_geometry){.base_helix_angle = number_of(check, "bb"), .normal_module = mn};
  *p = (struct eo_gear_pair){.ends = 2,
                             .normal_module = mn,
                             .face_width = number_of(input, "b") * 1e-3,
                             .groove_width = number_of(input, "groove") * 1e-3,
                             .groove_diameter = {NAN, NAN},
                             .bore = {NAN, 2 * number_of(pair, "gear_bore_radius_m")}};
  static const char *const teeth[2] = {"z1", "z2"}, *const base[2] = {"rb1", "rb2"};
  for (int m = 0; m < 2; m++) {
    g->base_radius[m] = number_of(check, base[m]) * 1e-3;
    g->reference_radius[m] = number_of(input, teeth[m]) * mn / (2 * cos(beta));
    g->root_radius[m] = g->reference_radius[m] - mn * (number_of(input, "ha") + number_of(input, "c"));
  }
}

/* Masses, inertias and springs of the groove as a design derives them. */
static struct eo_supports resolved_supports(const struct eo_gear_pair *pair, const struct eo_geometry *geometry)
{
  static struct eo_design design;
  design = (struct eo_design){.gear_pair = *pair, .supports = default_supports()};
  design.material = (struct eo_material){.youngs_modulus = 206e9, .poissons_ratio = 0.3, .density = 7850};
  eo_design_resolve(&design, geometry);
  return design.supports;
}

static void default_parameters(const json_t *evaluation, const char *name)
{
  struct eo_geometry g;
  struct eo_gear_pair pair;
  struct eo_dynamics_parameters p;
  struct eo_error error = {0};
  struct eo_supports supports;
  const json_t *given = json_object_get(json_object_get(evaluation, "pairs"), name);
  const json_t *expected = json_object_get(json_object_get(evaluation, "dynamics_params"), name);
  pair_of(given, &g, &pair);
  supports = resolved_supports(&pair, &g);
  int failed = eo_dynamics_parameters_init(&p, &g, 2, 0, &supports, false, 20e9 * pair.face_width, &error);
  ok(!failed, "%s parameters are derived %s", name, error.text);
  const struct {
    const char *key;
    double value;
  } row[] = {{"Rp", p.base_radius[0]},
             {"Rg", p.base_radius[1]},
             {"mp", p.mass[0]},
             {"Ip", p.inertia[0]},
             {"mg", p.mass[1]},
             {"Ig", p.inertia[1]},
             {"kpy", p.bearing_stiffness[0]},
             {"kgy", p.bearing_stiffness[1]},
             {"kg1z", p.gear_axial_stiffness[0]},
             {"kpz", p.groove_axial_stiffness[0]},
             {"kgz", p.groove_axial_stiffness[1]},
             {"kt_p", p.groove_torsional_stiffness[0]},
             {"kt_g", p.groove_torsional_stiffness[1]},
             {"cpy", p.bearing_damping[0]},
             {"cgy", p.bearing_damping[1]},
             {"cg1z", p.gear_axial_damping[0]},
             {"cg2z", p.gear_axial_damping[1]},
             {"cpz", p.groove_axial_damping[0]},
             {"cgz", p.groove_axial_damping[1]},
             {"cm", p.mesh_damping},
             {"me", eo_dynamics_equivalent_mass(&p)}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    near(row[i].value, number_of(expected, row[i].key), 1e-12, row[i].key);
}

/* The torsional springs G J / L of dynamics.json, when the ends differ. */
static void torsional_coupling(const json_t *evaluation)
{
  struct eo_geometry g;
  struct eo_gear_pair pair;
  struct eo_dynamics_parameters p;
  struct eo_error error = {0};
  struct eo_supports supports;
  pair_of(json_object_get(json_object_get(evaluation, "pairs"), "P0"), &g, &pair);
  supports = resolved_supports(&pair, &g);
  eo_dynamics_parameters_init(&p, &g, 2, 0, &supports, true, 1e9, NULL);
  near(p.groove_torsional_stiffness[0], 12487038.99751322, 1e-12, "torsional stiffness of the pinion's groove kt_p");
  near(p.groove_torsional_stiffness[1], 841121351.5381075, 1e-12, "torsional stiffness of the gear's groove kt_g");
  near(p.groove_torsional_damping[0], 0.04 * sqrt(12487038.99751322 * 0.008133856745044276 / 2), 1e-12,
       "torsional damping of the pinion's groove ct_p");
  supports.groove_torsional_stiffness[EO_GEAR] = NAN;
  ok(eo_dynamics_parameters_init(&p, &g, 2, 0, &supports, true, 1e9, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/supports/gear_groove_torsional_stiffness_Nm_per_rad") == 0,
     "a spring that nobody derived is refused: %s", error.text);
  supports.mass[EO_PINION] = NAN;
  ok(eo_dynamics_parameters_init(&p, &g, 2, 0, &supports, false, 1e9, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/supports/pinion_mass_kg") == 0,
     "a mass that nobody derived is refused: %s", error.text);
}

int main(void)
{
  json_t *evaluation = load_cases("evaluation.json");
  const json_t *s02 = find_case(json_object_get(evaluation, "cases"), "S02");
  struct eo_vibration_solver *solver = NULL;
  const struct eo_dynamics_parameters p = paper_pair();
  const struct stage s = read_stage(s02);
  ok(!eo_vibration_new(&solver, HARMONICS, 0, NULL) && !eo_vibration_set_model(solver, &p, NULL), "the solver is made");
  against_reference(solver, s02, &s);
  sense_of_phase_matters(solver, s02, &s);
  balance_against_integration(solver);
  default_parameters(evaluation, "P0");
  default_parameters(evaluation, "P2");
  torsional_coupling(evaluation);
  eo_vibration_free(solver);
  json_decref(evaluation);
  return tap_done();
}
