/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The march by equal steps against CVODE on a two-degree oscillator with one mesh: full contact, contact lost for a
   part of the period with gated damping, and the order of its error. */
#include <math.h>
#include <string.h>

#include "dynamics/integration.h"
#include "dynamics/march.h"
#include "support/tap.h"

enum { N = 2, SAMPLES = 64 };
static const double load = 1000, stiffness = 1e8; /* N, N/m */

/* Two unit masses, the first behind the mesh, the second on a spring between them and to the ground. */
static struct eo_oscillator make_oscillator(void)
{
  struct eo_oscillator o = {.n = N, .ends = 1, .shift = 0.8 * stiffness};
  const double k[N * N] = {3e7, -3e7, -3e7, 9e7}, c[N * N] = {400, -200, -200, 900};
  memcpy(o.stiffness, k, sizeof k);
  memcpy(o.damping, c, sizeof c);
  o.mesh[0][0] = 1;
  o.load[0] = load;
  return o;
}

/* Where both end after the motion has settled, r and r' over the mean velocity. */
static double difference(const struct eo_oscillator *o, const struct eo_cycle *cycle, double angle,
                         struct eo_integration *run, struct eo_march *found)
{
  const struct eo_integration_options options = {1e-10, 1e-8, 1000, SAMPLES, 1};
  const struct eo_march_options march = {angle, 1e-8, 1, 1000, 1000, 1};
  const double start[2 * N] = {load / stiffness, 0, 0, 0};
  struct eo_error error;
  double worst = 0, largest[2] = {0};
  bool settled = !eo_integrate(o, cycle, &options, start, run, NULL, &error) && run->periodic &&
                 !eo_march(o, cycle, &march, start, found, &error) && found->periodic;
  if (!ok(settled, "both integrations settle, after %d and %d periods", run->periods, found->periods))
    return NAN;
  for (int i = 0; i < 2 * N; i++)
    largest[i / N] = fmax(largest[i / N], fabs(run->state[i]));
  for (int i = 0; i < 2 * N; i++)
    worst = fmax(worst, fabs(found->state[i] - run->state[i]) / largest[i / N]);
  return worst;
}

static bool loses_contact(const struct eo_integration *run)
{
  bool lost = false;
  for (int i = 0; i < SAMPLES; i++)
    lost = lost || run->mesh[2 * i].margin <= 0;
  return lost;
}

int main(void)
{
  double acceleration[SAMPLES * N], swing[] = {0.1, 0.5};
  struct eo_mesh_state mesh[SAMPLES * 2];
  const struct eo_oscillator o = make_oscillator();
  for (int lost = 0; lost < 2; lost++) {
    struct eo_integration run = {.acceleration = acceleration, .mesh = mesh};
    struct eo_march found;
    struct eo_law law = {0};
    struct eo_error error;
    const double k[3] = {stiffness, swing[lost] * stiffness, 0};
    /* Below the first mode, 8600 1/s; and below the second, 12083 1/s, where teeth separate. */
    struct eo_cycle cycle = {.frequency = lost ? 11500 : 7000, .law = {&law}, .mesh_damping = 300, .gated = lost};
    ok(!eo_law_set_stiffness(&law, 1, k, 0, -1, &error), "a law is made");
    double coarse = difference(&o, &cycle, 0.02, &run, &found), fine = difference(&o, &cycle, 0.005, &run, &found);
    ok(loses_contact(&run) == lost, "the teeth %s", lost ? "separate" : "stay in contact");
    ok(fine < (lost ? 1e-2 : 1e-3), "the march is within %.1e of CVODE", fine);
    ok(coarse / fine > (lost ? 3 : 12), "a quarter of the step brings the march %.1f times nearer", coarse / fine);
    eo_law_done(&law);
  }
  return tap_done();
}
