/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/long_sketch.h"

#include <complex.h>
#include <math.h>
#include <stddef.h>

#include "numerics/dense.h"
#include "numerics/periodic.h"

enum { N = EO_MAX_COORDINATES, STEPS = 3 /* of a position */ };

/* One mode with the meshes at their mean stiffness, and its exact step under a force that is straight in it. */
struct mode {
  double mesh[2];                   /* dX_j of it */
  double still;                     /* under the constant loads */
  double square, damping;           /* omega^2, 1/s2; 1/s */
  double own[2][2], from[2], to[2]; /* state, force at the beginning and at the end of the step */
  double state[2];                  /* beside `still`, and its rate */
};

struct sketch {
  const struct eo_long_case *load;
  int modes, ends;
  struct mode mode[N];
  double stiffness, step; /* mean of a mesh, N/m; s */
  double nominal[2];      /* [end] P, N */
  double push[2], before[2];
  double sum[2], squares[2]; /* [end] of the accelerations */
};

static void set_step(struct mode *mode, double h)
{
  double half = mode->damping / 2, fade = exp(-half * h);
  double complex s = csqrt(half * half - mode->square);
  double c = fade * creal(ccosh(s * h)), d = fade * creal(cabs(s) * h > 1e-9 ? csinh(s * h) / s : h);
  double w = mode->square;
  mode->own[0][0] = c + half * d;
  mode->own[0][1] = d;
  mode->own[1][0] = -w * d;
  mode->own[1][1] = c - half * d;
  /* force 1 at the beginning, 0 at the end; and the other way round: particular solution f/w - damping f'/w^2 */
  for (int k = 0; k < 2; k++) {
    double rate = (k == 0 ? -1 : 1) / h, lag = -mode->damping * rate / (w * w), first = (k == 0) / w + lag,
           last = (k == 1) / w + lag, *into = k == 0 ? mode->from : mode->to;
    into[0] = last - mode->own[0][0] * first - mode->own[0][1] * rate / w;
    into[1] = rate / w - mode->own[1][0] * first - mode->own[1][1] * rate / w;
  }
}

static enum eo_code set_modes(struct sketch *sketch, const struct eo_dynamics_model *model, struct eo_error *error)
{
  const struct eo_oscillator *oscillator = &model->oscillator;
  int n = oscillator->n;
  double k[N * N], square[N];
  sketch->modes = n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      k[i * n + j] = oscillator->stiffness[i * n + j];
      for (int end = 0; end < sketch->ends; end++)
        k[i * n + j] += sketch->stiffness * oscillator->mesh[end][i] * oscillator->mesh[end][j];
    }
  if (eo_dense_symmetric_eigen(n, k, square))
    return eo_error_memory(error);
  for (int m = 0; m < n; m++) {
    const double *shape = k + (size_t)m * (size_t)n;
    struct mode *mode = &sketch->mode[m];
    *mode = (struct mode){.square = square[m]};
    for (int i = 0; i < n; i++) {
      mode->still += shape[i] * oscillator->load[i] / square[m];
      for (int j = 0; j < n; j++)
        mode->damping += shape[i] * oscillator->damping[i * n + j] * shape[j];
      for (int end = 0; end < sketch->ends; end++)
        mode->mesh[end] += shape[i] * oscillator->mesh[end][i];
    }
    for (int end = 0; end < sketch->ends; end++)
      mode->damping += sketch->load->parameters->mesh_damping * mode->mesh[end] * mode->mesh[end];
    set_step(mode, sketch->step);
  }
  return EO_OK;
}

/* Between samples of a position, cubic (Catmull and Rom 1974); the last positions stay as they are. */
static double between(int n, const double *value, int i, int third)
{
  double t = (double)third / STEPS, a = value[i > 0 ? i - 1 : 0], b = value[i], c = value[i + 1 < n ? i + 1 : n - 1],
         d = value[i + 2 < n ? i + 2 : n - 1];
  return b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/* What a mesh differs from constant stiffness, as in theory (P5), at its state. */
static void find_pushes(const struct sketch *sketch, const double deflection[2], const double tangent[2],
                        double push[2])
{
  for (int end = 0; end < sketch->ends; end++) {
    double x = 0;
    for (int m = 0; m < sketch->modes; m++)
      x += sketch->mode[m].mesh[end] * (sketch->mode[m].state[0] + sketch->mode[m].still);
    double force = sketch->nominal[end] + tangent[end] * (x - deflection[end]);
    push[end] = sketch->stiffness * x - (force > 0 ? force : 0);
  }
}

/* One step; the pushes at its end follow from those of before and are corrected once. */
static void take_step(struct sketch *sketch, const double deflection[2], const double tangent[2])
{
  double next[2], found[2];
  for (int end = 0; end < 2; end++)
    next[end] = 2 * sketch->push[end] - sketch->before[end];
  for (int m = 0; m < sketch->modes; m++) {
    struct mode *mode = &sketch->mode[m];
    double q = mode->state[0], v = mode->state[1], from = 0, to = 0;
    for (int end = 0; end < sketch->ends; end++) {
      from += mode->mesh[end] * sketch->push[end];
      to += mode->mesh[end] * next[end];
    }
    for (int i = 0; i < 2; i++)
      mode->state[i] = mode->own[i][0] * q + mode->own[i][1] * v + mode->from[i] * from + mode->to[i] * to;
  }
  find_pushes(sketch, deflection, tangent, found);
  for (int m = 0; m < sketch->modes; m++) {
    struct mode *mode = &sketch->mode[m];
    double more = 0;
    for (int end = 0; end < sketch->ends; end++)
      more += mode->mesh[end] * (found[end] - next[end]);
    mode->state[0] += mode->to[0] * more;
    mode->state[1] += mode->to[1] * more;
  }
  for (int end = 0; end < sketch->ends; end++) {
    sketch->before[end] = sketch->push[end];
    sketch->push[end] = found[end];
  }
}

static void look(struct sketch *sketch)
{
  double acceleration[2] = {0};
  for (int m = 0; m < sketch->modes; m++) {
    const struct mode *mode = &sketch->mode[m];
    double own = -mode->square * mode->state[0] - mode->damping * mode->state[1];
    for (int end = 0; end < sketch->ends; end++)
      own += mode->mesh[end] * sketch->push[end];
    for (int end = 0; end < sketch->ends; end++)
      acceleration[end] += mode->mesh[end] * own;
  }
  for (int end = 0; end < sketch->ends; end++) {
    sketch->sum[end] += acceleration[end];
    sketch->squares[end] += acceleration[end] * acceleration[end];
  }
}

/* From where the mean stiffness holds the mesh at its deflection. */
static void march(struct sketch *sketch)
{
  const struct eo_long_case *load = sketch->load;
  int samples = load->cycles * load->positions, lead = EO_LONG_SKETCH_LEAD * load->positions;
  for (int end = 0; end < sketch->ends; end++)
    sketch->before[end] = sketch->push[end] = sketch->stiffness * load->deflection[end][0] - sketch->nominal[end];
  for (int m = 0; m < sketch->modes; m++)
    for (int end = 0; end < sketch->ends; end++)
      sketch->mode[m].state[0] += sketch->mode[m].mesh[end] * sketch->push[end] / sketch->mode[m].square;
  for (int i = 0; i < samples; i++)
    for (int third = 0; third < STEPS; third++) {
      double deflection[2] = {0}, tangent[2] = {0};
      for (int end = 0; end < sketch->ends; end++) {
        deflection[end] = between(samples, load->deflection[end], i, third);
        tangent[end] = between(samples, load->tangent[end], i, third);
      }
      take_step(sketch, deflection, tangent);
      if (i >= lead)
        look(sketch);
    }
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
  sketch.step = 2 * M_PI / (load->speed * load->pinion_teeth * load->positions * STEPS);
  EO_TRY(set_modes(&sketch, &model, error));
  march(&sketch);
  *rms = 0;
  for (int end = 0; end < sketch.ends; end++) {
    double mean = sketch.sum[end] / seen;
    *rms += sqrt(fmax(0, sketch.squares[end] / seen - mean * mean)) / sketch.ends;
  }
  return EO_OK;
}
