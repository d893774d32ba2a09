/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/long_sketch.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "dynamics/long_motion.h"
#include "numerics/periodic.h"

enum { N = EO_MAX_COORDINATES, STEPS = 2 /* of a position */ };

struct sketch {
  const struct eo_long_case *load;
  int ends;
  struct eo_long_motion motion; /* beside where the constant loads leave the meshes at their mean stiffness */
  double stiffness;             /* mean of a mesh, N/m */
  double nominal[2], still[2];  /* [end] P, N; X at rest, m */
  double push[2], before[2];    /* [end] at this instant and the last, N */
  double sum[2], squares[2];    /* [end] of the accelerations */
};

/* Between samples of a position, cubic (Catmull and Rom 1974); the last positions stay as they are. */
static double between(int n, const double *value, int i, int part)
{
  double t = (double)part / STEPS, a = value[i > 0 ? i - 1 : 0], b = value[i], c = value[i + 1 < n ? i + 1 : n - 1],
         d = value[i + 2 < n ? i + 2 : n - 1];
  return b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/* What meshes differ from constant stiffness, as in theory (P5), where pushes at the end of a step put them: x with
   none there. */
static void find_pushes(const struct sketch *sketch, const double x[2], const double deflection[2],
                        const double tangent[2], double push[2])
{
  const struct eo_long_motion *motion = &sketch->motion;
  double found[2] = {0};
  for (int end = 0; end < sketch->ends; end++) {
    double there = x[end] + sketch->still[end];
    for (int j = 0; j < sketch->ends; j++)
      there += motion->gain[end][j] * push[j];
    double force = sketch->nominal[end] + tangent[end] * (there - deflection[end]);
    found[end] = sketch->stiffness * there - (force > 0 ? force : 0);
  }
  memcpy(push, found, sizeof found);
}

/* One step; the pushes at its end follow from those of before and are corrected twice. */
static void take_step(struct sketch *sketch, const double deflection[2], const double tangent[2])
{
  enum { CORRECTIONS = 2 };
  double next[2], x[2], rate[2];
  for (int end = 0; end < 2; end++)
    next[end] = 2 * sketch->push[end] - sketch->before[end];
  eo_long_motion_go(&sketch->motion, sketch->before, sketch->push, x, rate);
  for (int correction = 0; correction < CORRECTIONS; correction++)
    find_pushes(sketch, x, deflection, tangent, next);
  memcpy(sketch->before, sketch->push, sizeof sketch->before);
  memcpy(sketch->push, next, sizeof sketch->push);
}

static void look(struct sketch *sketch)
{
  for (int end = 0; end < sketch->ends; end++) {
    double acceleration = eo_long_motion_read(&sketch->motion, end, sketch->before, sketch->push);
    sketch->sum[end] += acceleration;
    sketch->squares[end] += acceleration * acceleration;
  }
}

/* From where the mean stiffness holds the mesh at its deflection. */
static void march(struct sketch *sketch)
{
  const struct eo_long_case *load = sketch->load;
  int samples = load->cycles * load->positions, lead = EO_LONG_SKETCH_LEAD * load->positions;
  for (int end = 0; end < sketch->ends; end++)
    sketch->before[end] = sketch->push[end] = sketch->stiffness * load->deflection[end][0] - sketch->nominal[end];
  eo_long_motion_rest(&sketch->motion, sketch->push);
  for (int i = 0; i < samples; i++)
    for (int part = 0; part < STEPS; part++) {
      double deflection[2] = {0}, tangent[2] = {0};
      for (int end = 0; end < sketch->ends; end++) {
        deflection[end] = between(samples, load->deflection[end], i, part);
        tangent[end] = between(samples, load->tangent[end], i, part);
      }
      take_step(sketch, deflection, tangent);
      if (i >= lead)
        look(sketch);
    }
}

static enum eo_code set_motion(struct sketch *sketch, const struct eo_dynamics_model *model, struct eo_error *error)
{
  const struct eo_oscillator *oscillator = &model->oscillator;
  const struct eo_long_case *load = sketch->load;
  double weight[2][N] = {{0}}, step = 2 * M_PI / (load->speed * load->pinion_teeth * load->positions * STEPS);
  for (int end = 0; end < sketch->ends; end++)
    memcpy(weight[end], oscillator->mesh[end], sizeof weight[end]);
  if (!eo_long_motion_still(oscillator, sketch->stiffness, sketch->still))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The lumped model has no place at rest.");
  return eo_long_motion_init(&sketch->motion, oscillator, load->parameters->mesh_damping, sketch->stiffness, step,
                             sketch->ends, (const double(*)[N])weight, error);
}

enum eo_code eo_long_sketch_rms(const struct eo_long_case *load, double *rms, struct eo_error *error)
{
  struct sketch sketch = {.load = load, .ends = load->parameters->ends};
  struct eo_dynamics_model model;
  int samples = load->cycles * load->positions, seen = STEPS * (load->cycles - EO_LONG_SKETCH_LEAD) * load->positions;
  EO_TRY(eo_dynamics_model_init(&model, load->parameters, error));
  eo_dynamics_model_load(&model, load->torque, EO_IMPACT_NONE);
  for (int end = 0; end < sketch.ends; end++) {
    sketch.nominal[end] = eo_dynamics_mesh_load(load->parameters, load->torque, end);
    sketch.stiffness += eo_periodic_mean(samples, load->tangent[end]) / sketch.ends;
  }
  EO_TRY(set_motion(&sketch, &model, error));
  march(&sketch);
  *rms = 0;
  for (int end = 0; end < sketch.ends; end++) {
    double mean = sketch.sum[end] / seen;
    *rms += sqrt(fmax(0, sketch.squares[end] / seen - mean * mean)) / sketch.ends;
  }
  return EO_OK;
}
