/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Properties of the equations of motion: symmetry, zero modes, loads on them, reciprocity, the printed signs. */
#include "support/dynamics-fixture.h"
#include "support/tap.h"

#include <string.h>

#include "dynamics/condensation.h"
#include "numerics/dense.h"

/* Springs that differ from end to end and a coupled groove: nothing may rest on symmetry of the model. */
static struct eo_dynamics_parameters lopsided(double pinion_torsion, double gear_torsion)
{
  struct eo_dynamics_parameters p = paper_pair();
  p.gear_axial_stiffness[1] = 3.1e8;
  p.gear_axial_damping[1] = 4321;
  p.groove_torsional_stiffness[0] = pinion_torsion;
  p.groove_torsional_stiffness[1] = gear_torsion;
  p.groove_torsional_damping[0] = pinion_torsion > 0 ? 9 : 0;
  p.groove_torsional_damping[1] = gear_torsion > 0 ? 500 : 0;
  return p;
}

static double smallest_eigenvalue(int n, const double *matrix, double *largest)
{
  double copy[EO_MAX_FREEDOMS * EO_MAX_FREEDOMS], value[EO_MAX_FREEDOMS];
  for (int i = 0; i < n * n; i++)
    copy[i] = matrix[i];
  eo_dense_symmetric_eigen(n, copy, value);
  *largest = value[n - 1];
  return value[0];
}

static int symmetric(int n, const double *matrix)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      if (matrix[i * n + j] != matrix[j * n + i])
        return 0;
  return 1;
}

static void matrices(void)
{
  struct eo_dynamics_model m;
  const struct eo_dynamics_parameters p = lopsided(1.2e7, 8.4e8);
  double largest;
  ok(!eo_dynamics_model_init(&m, &p, NULL), "a lopsided model is made");
  ok(symmetric(12, m.stiffness) && symmetric(12, m.damping), "K and C are symmetric");
  ok(symmetric(m.oscillator.n, m.oscillator.stiffness) && symmetric(m.oscillator.n, m.oscillator.damping),
     "the reduced K and C are symmetric");
  double least = smallest_eigenvalue(12, m.stiffness, &largest);
  ok(least >= -1e-12 * largest, "K is positive semi-definite: %g of %g", least, largest);
  least = smallest_eigenvalue(12, m.damping, &largest);
  ok(least >= -1e-12 * largest, "C is positive semi-definite: %g of %g", least, largest);
  ok(!m.oscillator.symmetric, "ends that differ are not taken for mirror images");
}

/* Each zero mode must leave all springs, dampers and meshes alone. */
static double disturbance(const struct eo_dynamics_model *m)
{
  int n = m->freedoms, zeros = m->zero_modes;
  double worst = 0;
  for (int z = 0; z < zeros; z++) {
    double mode[EO_MAX_FREEDOMS], image[EO_MAX_FREEDOMS], size = 0;
    for (int i = 0; i < n; i++)
      mode[i] = m->zero[i * zeros + z];
    eo_dense_multiply(n, n, m->stiffness, mode, image);
    for (int i = 0; i < n; i++)
      size = fmax(size, fabs(image[i]) / 1e11);
    for (int end = 0; end < m->parameters.ends; end++) {
      double x = 0;
      for (int i = 0; i < n; i++)
        x += m->reading[EO_READING_NORMAL][end][i] * mode[i];
      size = fmax(size, fabs(x));
    }
    worst = fmax(worst, size);
  }
  return worst;
}

static void zero_modes(struct eo_dynamics_parameters p, int expected, const char *what)
{
  struct eo_dynamics_model m;
  struct eo_error error = {0};
  int failed = eo_dynamics_model_init(&m, &p, &error);
  ok(!failed, "%s: the model is made %s", what, error.text);
  ok(m.zero_modes == expected && m.oscillator.n + m.zero_modes + m.constraints == m.freedoms,
     "%s: the model has %d zero modes", what, m.zero_modes);
  double found = disturbance(&m);
  ok(found < 1e-14, "%s: the zero modes stretch nothing (%g)", what, found);
  eo_dynamics_model_load(&m, 828, EO_IMPACT_PAPER);
  ok(m.zero_mode_load < 1e-15, "%s: the torques do no work on the zero modes (%g)", what, m.zero_mode_load);
}

static struct eo_dynamics_parameters single(double helix)
{
  struct eo_dynamics_parameters p = paper_pair();
  p.ends = 1;
  p.base_helix_angle = helix;
  p.groove_axial_stiffness[0] = 2e8;
  return p;
}

/* Softness does not make a mode a zero mode: the count follows from geometry, not from a threshold on frequencies. */
static struct eo_dynamics_parameters soft(void)
{
  struct eo_dynamics_parameters p = paper_pair();
  p.bearing_stiffness[0] = 1e-3;
  p.gear_axial_stiffness[0] = p.gear_axial_stiffness[1] = 1e-3;
  return p;
}

static void impacts_on_zero_modes(void)
{
  struct eo_dynamics_model m;
  const struct eo_dynamics_parameters p = paper_pair();
  eo_dynamics_model_init(&m, &p, NULL);
  double equal = eo_dynamics_model_impact_drift(&m, (double[]){300, 300}),
         unequal = eo_dynamics_model_impact_drift(&m, (double[]){300, 100});
  ok(equal < 1e-12 * 300, "equal mean impacts do no work on the zero modes (%g)", equal);
  /* generalised force of the screw mode: z 1 at both pinion ends, theta such that X stays zero, unit modal mass */
  double tangent = tan(p.base_helix_angle) / p.base_radius[0];
  double mass = 2 * p.mass[0] + 2 * p.inertia[0] * tangent * tangent;
  double roll = p.inertia[0] / (p.base_radius[0] * p.base_radius[0]) +
                p.inertia[1] / (p.base_radius[1] * p.base_radius[1]);
  /* made orthogonal to the two rolling modes, in which pinion and gear turn by 1 / R */
  double overlap = p.inertia[0] * tangent / p.base_radius[0];
  double expected = tan(p.base_helix_angle) * 200 / sqrt(mass - 2 * overlap * overlap / roll);
  near(unequal, expected, 1e-10, "work of unequal mean impacts on the screw mode");
}

/* Betti and Maxwell: the response at one mesh to a force at the other is the same both ways. */
static void reciprocity(void)
{
  struct eo_dynamics_model m;
  struct eo_harmonic h[9];
  const struct eo_dynamics_parameters p = lopsided(1.2e7, 8.4e8);
  double worst = 0;
  eo_dynamics_model_init(&m, &p, NULL);
  eo_dynamics_model_load(&m, 828, EO_IMPACT_CONSISTENT);
  eo_condense(&m.oscillator, 2 * M_PI * 431, 8, true, h);
  for (int k = 1; k <= 8; k++)
    worst = fmax(worst, cabs(h[k].stiffness[0][1] - h[k].stiffness[1][0]) / cabs(h[k].stiffness[0][0]));
  ok(worst < 1e-12, "cross stiffnesses of the two meshes agree (%g)", worst);
  for (int k = 0; k <= 8; k++)
    worst = fmax(worst, cabs(h[k].transfer[0][0] - 1 / cos(p.base_helix_angle)) + cabs(h[k].transfer[0][1]));
  ok(worst < 1e-8, "consistent impacts are mesh forces times 1 / cos(beta_b) (%g)", worst);
}

/* The analytic slopes with frequency against differences. */
static void slopes(void)
{
  struct eo_dynamics_model m;
  struct eo_harmonic at[5], above[5], below[5];
  const struct eo_dynamics_parameters p = lopsided(1.2e7, 0);
  double w = 2 * M_PI * 431, step = 1e-5 * w, worst = 0;
  eo_dynamics_model_init(&m, &p, NULL);
  eo_dynamics_model_load(&m, 828, EO_IMPACT_PAPER);
  eo_condense(&m.oscillator, w, 4, true, at);
  eo_condense(&m.oscillator, w + step, 4, false, above);
  eo_condense(&m.oscillator, w - step, 4, false, below);
  for (int k = 1; k <= 4; k++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) {
        double complex s = (above[k].stiffness[i][j] - below[k].stiffness[i][j]) / (2 * step);
        double complex t = (above[k].transfer[i][j] - below[k].transfer[i][j]) / (2 * step);
        worst = fmax(worst, cabs(s - at[k].stiffness_slope[i][j]) / cabs(at[k].stiffness_slope[i][i]));
        worst = fmax(worst, cabs(t - at[k].transfer_slope[i][j]) /
                                (cabs(at[k].transfer[i][i]) / w + cabs(at[k].transfer_slope[i][i])));
      }
  ok(worst < 1e-4, "slopes with frequency agree with differences (%g)", worst);
}

/* The result does not depend on the stiffness added while condensing. */
static void shift_is_free(void)
{
  struct eo_dynamics_model m;
  struct eo_harmonic a[4], b[4];
  const struct eo_dynamics_parameters p = paper_pair();
  double worst = 0;
  eo_dynamics_model_init(&m, &p, NULL);
  eo_dynamics_model_load(&m, 828, EO_IMPACT_NONE);
  eo_condense(&m.oscillator, 3000, 3, false, a);
  m.oscillator.shift *= 3.7;
  eo_condense(&m.oscillator, 3000, 3, false, b);
  for (int k = 0; k < 4; k++)
    worst = fmax(worst,
                 cabs(a[k].stiffness[0][0] - b[k].stiffness[0][0]) / 1e8 + cabs(a[k].load[0] - b[k].load[0]) / 8638);
  ok(worst < 1e-8, "the added stiffness cancels (%g)", worst);
  near(creal(a[0].load[0]), eo_dynamics_mesh_load(&p, 828, 0), 1e-12, "the mean mesh force balances the torque");
}

static void modes_and_signs(void)
{
  struct eo_dynamics_model m;
  struct eo_dynamics_modes modes;
  struct eo_error error = {0};
  double complex pole;
  const struct eo_dynamics_parameters p = lopsided(1.2e7, 8.4e8);
  eo_dynamics_model_init(&m, &p, NULL);
  ok(!eo_dynamics_model_modes(&m, (double[]){1e9, 1.2e9}, &modes, NULL) && modes.n == 11,
     "a model with both couplings has eleven modes");
  int stable = 1;
  for (int i = 0; i < 2 * modes.n; i++)
    stable = stable && creal(modes.pole[i]) < 0;
  ok(stable, "all poles of the corrected equations are damped");
  double mass = 0;
  for (int i = 0; i < 12; i++)
    mass += m.mass[i] * modes.shape[3][i] * modes.shape[3][i];
  near(mass, 1, 1e-12, "mode shapes have unit modal mass");
  int failed = eo_dynamics_model_printed_pole(&m, (double[]){1e9, 1e9}, &pole, NULL);
  ok(!failed && creal(pole) > 1e4, "the printed signs flutter: %.0f 1/s", creal(pole));
  failed = eo_dynamics_model_modes(&m, (double[]){0, 1e9}, &modes, &error) == EO_ERROR_INPUT;
  ok(failed, "an impossible model is refused: %s", error.text);
  const struct eo_dynamics_parameters one = single(0.3);
  eo_dynamics_model_init(&m, &one, NULL);
  failed = eo_dynamics_model_printed_pole(&m, (double[]){1e9, 1e9}, &pole, &error) == EO_ERROR_INPUT;
  ok(failed, "a model without room is refused: %s", error.text);
}

static struct eo_dynamics_parameters held(double stiffness, bool coupled)
{
  struct eo_dynamics_parameters p = coupled ? lopsided(1.2e7, 8.4e8) : lopsided(0, 0);
  p.pinion_axial_stiffness = stiffness;
  return p;
}

/* Eigenfrequencies of M q" + K q = 0 from matrices typed row by row, Hz; those of rigid motions are 0. */
static void typed_frequencies(const struct eo_dynamics_parameters *p, double mesh, double frequency[12])
{
  double k[144] = {0}, square[12], mass[12], c = cos(p->base_helix_angle), s = sin(p->base_helix_angle);
  for (int i = 0; i < 12; i++)
    mass[i] = i % 3 == 2 ? p->inertia[i / 6] : p->mass[i / 6];
  for (int end = 0; end < 2; end++) {
    double hand = end ? -1 : 1, g[12] = {0};
    int a = 3 * end, b = 6 + 3 * end;
    g[a] = c, g[a + 1] = hand * s, g[a + 2] = c * p->base_radius[0];
    g[b] = -c, g[b + 1] = -hand * s, g[b + 2] = -c * p->base_radius[1];
    for (int i = 0; i < 144; i++)
      k[i] += mesh * g[i / 12] * g[i % 12];
    k[a * 12 + a] += p->bearing_stiffness[0];
    k[b * 12 + b] += p->bearing_stiffness[1];
    k[(b + 1) * 13] += p->gear_axial_stiffness[end];
  }
  for (int m = 0; m < 2; m++)
    for (int motion = 1; motion < 3; motion++) {
      double spring = motion == 1 ? p->groove_axial_stiffness[m] : p->groove_torsional_stiffness[m];
      int i = 6 * m + motion, j = i + 3;
      k[i * 13] += spring;
      k[j * 13] += spring;
      k[i * 12 + j] -= spring;
      k[j * 12 + i] -= spring;
    }
  for (int i = 1; i <= 4; i += 3) /* k_a (z_p1 + z_p2)/2 on each half: a quarter of k_a in each place */
    for (int j = 1; j <= 4; j += 3)
      k[i * 12 + j] += p->pinion_axial_stiffness / 4;
  for (int i = 0; i < 144; i++)
    k[i] /= sqrt(mass[i / 12] * mass[i % 12]);
  eo_dense_symmetric_eigen(12, k, square);
  for (int i = 0; i < 12; i++)
    frequency[i] = sqrt(fmax(square[i], 0)) / (2 * M_PI);
}

static void held_frequencies(bool coupled)
{
  struct eo_dynamics_model m;
  struct eo_dynamics_modes modes;
  double typed[12], worst = 0;
  const struct eo_dynamics_parameters p = held(3e8, coupled);
  eo_dynamics_model_init(&m, &p, NULL);
  eo_dynamics_model_modes(&m, (double[]){1.1e9, 1.1e9}, &modes, NULL);
  typed_frequencies(&p, 1.1e9, typed);
  for (int i = 0; i < modes.n; i++)
    worst = fmax(worst, fabs(modes.frequency[i] / typed[12 - modes.n + i] - 1));
  ok(modes.n == (coupled ? 11 : 10) && worst < 1e-9,
     "the model held%s has %d frequencies of the typed equations (%.1g)", coupled ? ", coupled" : "", modes.n, worst);
}

/* With next to no mesh the pinion swings along its axis as one body: k_a / (2 m_p). */
static void axial_swing(void)
{
  struct eo_dynamics_model m;
  struct eo_dynamics_modes modes;
  const struct eo_dynamics_parameters p = held(2.5e8, false);
  double expected = sqrt(2.5e8 / (2 * p.mass[0])) / (2 * M_PI), nearest = INFINITY;
  eo_dynamics_model_init(&m, &p, NULL);
  eo_dynamics_model_modes(&m, (double[]){1, 1}, &modes, NULL);
  for (int i = 0; i < modes.n; i++)
    if (fabs(modes.frequency[i] - expected) < fabs(nearest - expected))
      nearest = modes.frequency[i];
  near(nearest, expected, 1e-7, "frequency of the axial swing of a held pinion, sqrt(k_a / (2 m_p))");
}

/* Springs in series: D (left end more than the mean) = - s (X_L - X_R), k = 4 s sin2(beta_b). */
static void held_at_rest(void)
{
  struct eo_dynamics_model m;
  struct eo_dynamics_parameters p = held(3e8, true);
  p.gear_axial_stiffness[1] = p.gear_axial_stiffness[0];
  double s2 = pow(sin(p.base_helix_angle), 2), c2 = 1 - s2;
  double give = 2 * s2 / 3e8 + 2 * s2 / (p.gear_axial_stiffness[0] + p.gear_axial_stiffness[1]) +
                c2 * (1 / p.bearing_stiffness[0] + 1 / p.bearing_stiffness[1]);
  for (int member = 0; member < 2; member++)
    give += c2 * pow(p.base_radius[member], 2) / (2 * p.groove_torsional_stiffness[member]);
  eo_dynamics_model_init(&m, &p, NULL);
  near(eo_dynamics_model_axial_stiffness(&m), 2 * s2 / give, 1e-9, "hold of the ends at rest, all springs in series");
  p.bearing_stiffness[0] = p.bearing_stiffness[1] = p.gear_axial_stiffness[0] = p.gear_axial_stiffness[1] = INFINITY;
  p.groove_torsional_stiffness[0] = p.groove_torsional_stiffness[1] = INFINITY;
  for (int i = 0; i < 2; i++)
    p.bearing_damping[i] = p.gear_axial_damping[i] = p.groove_torsional_damping[i] = 0;
  eo_dynamics_model_init(&m, &p, NULL);
  near(eo_dynamics_model_axial_stiffness(&m), 3e8, 1e-9, "hold of the ends with all else rigid, the pinion's own");
  p.pinion_axial_stiffness = INFINITY;
  eo_dynamics_model_init(&m, &p, NULL);
  ok(isinf(eo_dynamics_model_axial_stiffness(&m)), "both ends have one deflection where all is rigid");
  p = held(3e8, false);
  eo_dynamics_model_init(&m, &p, NULL);
  ok(eo_dynamics_model_axial_stiffness(&m) == 0, "ends not coupled in torsion carry their own torque");
  p = held(0, true);
  eo_dynamics_model_init(&m, &p, NULL);
  ok(eo_dynamics_model_axial_stiffness(&m) == 0, "the ends of a floating pinion carry the same");
}

/* Everything rigid but the meshes and the machines' shafts: four inertias in a row, the gear's reduced by nothing. */
static void driver_and_load(void)
{
  struct eo_dynamics_model m;
  struct eo_dynamics_modes modes;
  struct eo_dynamics_parameters p = lopsided(INFINITY, INFINITY);
  double c = cos(p.base_helix_angle), mesh = 1.1e9, value[4];
  p.groove_torsional_damping[0] = p.groove_torsional_damping[1] = 0;
  for (int i = 0; i < 2; i++) {
    p.bearing_stiffness[i] = p.gear_axial_stiffness[i] = INFINITY;
    p.bearing_damping[i] = p.gear_axial_damping[i] = 0;
    p.groove_axial_stiffness[i] = 1e14; /* apart from it, the halves of the pinion */
  }
  p.pinion_axial_stiffness = INFINITY;
  p.machine_inertia[0] = 0.12, p.machine_inertia[1] = 3.1;
  p.machine_stiffness[0] = 2e5, p.machine_stiffness[1] = 6e5;
  int failed = eo_dynamics_model_init(&m, &p, NULL);
  ok(!failed && m.freedoms == 14 && m.zero_modes == 1, "a model with driver and load has %d zero mode of %d freedoms",
     m.zero_modes, m.freedoms);
  eo_dynamics_model_load(&m, 828, EO_IMPACT_NONE);
  ok(m.zero_mode_load < 1e-15, "the torques do no work on the zero mode of driver and load");
  eo_dynamics_model_modes(&m, (double[]){mesh, mesh}, &modes, NULL);
  const double inertia[4] = {0.12, 2 * p.inertia[0], 2 * p.inertia[1], 3.1};
  const double direction[3][4] = {{1, -1, 0, 0}, {0, c * p.base_radius[0], -c * p.base_radius[1], 0}, {0, 0, 1, -1}};
  const double spring[3] = {2e5, 2 * mesh, 6e5};
  double k[16] = {0};
  for (int e = 0; e < 3; e++)
    for (int i = 0; i < 16; i++)
      k[i] += spring[e] * direction[e][i / 4] * direction[e][i % 4] / sqrt(inertia[i / 4] * inertia[i % 4]);
  eo_dense_symmetric_eigen(4, k, value);
  int found = 0;
  for (int i = 1; i < 4; i++)
    for (int j = 0; j < modes.n; j++)
      found += fabs(modes.frequency[j] * 2 * M_PI / sqrt(value[i]) - 1) < 1e-6;
  ok(found == 3, "the frequencies of four inertias on three springs are among them (%d)", found);
  near(modes.frequency[0] * 2 * M_PI, sqrt(value[1]), 1e-7, "the lowest frequency with driver and load");
  p = paper_pair();
  p.machine_inertia[0] = 0.12;
  struct eo_error error = {0};
  failed = eo_dynamics_model_init(&m, &p, &error) == EO_ERROR_INPUT;
  ok(failed && !strcmp(error.pointer, "/supports/driver_stiffness_Nm_per_rad"),
     "a driver without an inertia is refused: %s", error.text);
}

int main(void)
{
  zero_modes(held(2e8, false), 2, "held, no coupling");
  zero_modes(held(2e8, true), 1, "held, both coupled");
  zero_modes(held(INFINITY, false), 2, "fixed, no coupling");
  zero_modes(held(INFINITY, true), 1, "fixed, both coupled");
  held_frequencies(false);
  held_frequencies(true);
  axial_swing();
  held_at_rest();
  driver_and_load();
  matrices();
  zero_modes(paper_pair(), 3, "no coupling");
  zero_modes(lopsided(1.2e7, 0), 2, "pinion coupled");
  zero_modes(lopsided(0, 8.4e8), 2, "gear coupled");
  zero_modes(lopsided(1.2e7, 8.4e8), 1, "both coupled");
  zero_modes(soft(), 3, "very soft supports");
  zero_modes(single(0.39), 1, "single helical");
  zero_modes(single(0), 1, "spur");
  impacts_on_zero_modes();
  reciprocity();
  slopes();
  shift_is_free();
  modes_and_signs();
  return tap_done();
}
