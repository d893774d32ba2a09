/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/long_motion.h"

#include <math.h>
#include <string.h>

#include "dynamics/propagator.h"
#include "numerics/dense.h"

enum { N = EO_MAX_COORDINATES, SIZE = 2 * N };

/* Two modes at a time. */
typedef double pair __attribute__((vector_size(16)));

/* First-order form s' = A s + B f of s = (r, r'/scale). */
struct form {
  int n, ends;
  double scale; /* 1/s */
  double matrix[SIZE * SIZE];
  double force[2][SIZE];                                             /* B by meshes */
  double complex value[SIZE], vector[SIZE * SIZE], excited[2][SIZE]; /* excited: by 1 N, 1/s */
};

static void fill_form(struct form *form, const struct eo_oscillator *oscillator, double damping, double mean)
{
  int n = form->n, size = 2 * n;
  memset(form->matrix, 0, sizeof form->matrix);
  memset(form->force, 0, sizeof form->force);
  for (int i = 0; i < n; i++) {
    form->matrix[i * size + n + i] = form->scale;
    for (int j = 0; j < n; j++) {
      double k = oscillator->stiffness[i * n + j], c = oscillator->damping[i * n + j];
      for (int end = 0; end < form->ends; end++) {
        k += mean * oscillator->mesh[end][i] * oscillator->mesh[end][j];
        c += damping * oscillator->mesh[end][i] * oscillator->mesh[end][j];
      }
      form->matrix[(n + i) * size + j] = -k / form->scale;
      form->matrix[(n + i) * size + n + j] = -c;
    }
    for (int end = 0; end < form->ends; end++)
      form->force[end][n + i] = oscillator->mesh[end][i] / form->scale;
  }
}

/* Modes and what a push excites of each. False: they do not span all motions, as where one is damped critically. */
static bool find_modes(struct form *form)
{
  static const double LOST = 1e-9; /* of the pushes */
  int size = 2 * form->n, pivot[SIZE];
  double copy[SIZE * SIZE];
  double complex vector[SIZE * SIZE], both[2 * SIZE];
  memcpy(copy, form->matrix, sizeof copy);
  if (eo_dense_eigenvectors(size, copy, form->value, form->vector))
    return false;
  memcpy(vector, form->vector, sizeof vector);
  for (int i = 0; i < 2 * size; i++)
    both[i] = form->force[i / size][i % size];
  if (eo_dense_complex_solve(size, vector, pivot, 2, both))
    return false;
  for (int end = 0; end < form->ends; end++) {
    double off = 0, all = 0;
    memcpy(form->excited[end], both + end * size, sizeof *both * (size_t)size);
    for (int i = 0; i < size; i++) {
      double complex found = 0;
      double parts = 0;
      for (int m = 0; m < size; m++) {
        double complex part = form->vector[i * size + m] * form->excited[end][m];
        found += part;
        parts += cabs(part);
      }
      off = fmax(off, fmax(cabs(found - form->force[end][i]), 1e-16 * parts));
      all = fmax(all, fabs(form->force[end][i]));
    }
    if (!(off <= LOST * all))
      return false;
  }
  return true;
}

static void set_part(struct eo_motion_row *row, int mode, double complex value)
{
  row->part[0][mode] = creal(value);
  row->part[1][mode] = cimag(value);
}

/* (e^x - 1)/x and what follows of it by (phi - phi(0))/x, by their series where that would lose digits. */
static void find_phis(double complex x, double complex phi[3])
{
  static const double FACTORIAL[3] = {1, 2, 6};
  for (int k = 0; k < 3; k++) {
    if (cabs(x) < 0.1) {
      double complex sum = 0;
      for (int term = 12; term > k; term--)
        sum = 1 + sum * x / (term + 1);
      phi[k] = sum / FACTORIAL[k];
    } else {
      phi[k] = k == 0 ? (cexp(x) - 1) / x : (phi[k - 1] - 1 / FACTORIAL[k - 1]) / x;
    }
  }
}

/* One of a pair of conjugates, or a real mode. */
static void set_mode(struct eo_long_motion *motion, const struct form *form, const struct eo_oscillator *oscillator,
                     int m, const double (*weight)[N])
{
  int n = form->n, size = 2 * n, mode = motion->modes++;
  double complex value = form->value[m], turn = cexp(value * motion->step), phi[3];
  double twice = cimag(value) != 0 ? 2 : 1;
  find_phis(value * motion->step, phi);
  set_part(&motion->turn, mode, turn);
  for (int end = 0; end < form->ends; end++) {
    double complex excited = form->excited[end][m] * motion->step, deflection = 0, rate = 0;
    for (int i = 0; i < n; i++) {
      deflection += twice * oscillator->mesh[end][i] * form->vector[i * size + m];
      rate += twice * oscillator->mesh[end][i] * form->scale * form->vector[(n + i) * size + m];
    }
    /* theory (P7) */
    double complex before = (phi[2] - phi[1] / 2) * excited, from = (phi[0] - 2 * phi[2]) * excited,
                   to = (phi[2] + phi[1] / 2) * excited, early = motion->forgets ? 0 : before / turn;
    set_part(&motion->before[end], mode, motion->forgets ? before : 0);
    set_part(&motion->early[end], mode, early);
    set_part(&motion->to[end], mode, to);
    set_part(&motion->kick[end], mode, turn * to + from + early);
    set_part(&motion->rest[end], mode, early - to - form->excited[end][m] / value);
    set_part(&motion->deflection[end], mode, deflection);
    set_part(&motion->rate[end], mode, rate);
  }
  for (int k = 0; k < motion->readings; k++) {
    double complex reading = 0;
    for (int i = 0; i < n; i++)
      reading += twice * weight[k][i] * form->scale * value * form->vector[(n + i) * size + m];
    set_part(&motion->reading[k], mode, reading);
  }
}

/* Re(a b) over the modes. */
static double product(const struct eo_long_motion *motion, const struct eo_motion_row *a, const struct eo_motion_row *b)
{
  double sum = 0;
  for (int m = 0; m < motion->modes; m++)
    sum += a->part[0][m] * b->part[0][m] - a->part[1][m] * b->part[1][m];
  return sum;
}

static void set_gains(struct eo_long_motion *motion, const struct eo_oscillator *oscillator, const double (*weight)[N])
{
  for (int i = 0; i < motion->ends; i++)
    for (int j = 0; j < motion->ends; j++) {
      motion->gain[i][j] = product(motion, &motion->deflection[i], &motion->to[j]);
      motion->rate_gain[i][j] = product(motion, &motion->rate[i], &motion->to[j]);
      motion->early_gain[i][j] = -product(motion, &motion->deflection[i], &motion->early[j]);
      motion->early_rate_gain[i][j] = -product(motion, &motion->rate[i], &motion->early[j]);
    }
  for (int k = 0; k < motion->readings; k++)
    for (int end = 0; end < motion->ends; end++) {
      motion->early_direct[k][end] = -product(motion, &motion->reading[k], &motion->early[end]);
      motion->direct[k][end] = product(motion, &motion->reading[k], &motion->to[end]);
      for (int i = 0; i < oscillator->n; i++)
        motion->direct[k][end] += weight[k][i] * oscillator->mesh[end][i];
    }
}

/* What the push before has in a mode is kept as what it had a step earlier, 1/turn of it: at low speeds that loses the
   digits, and at last there is no such number. */
static bool forgets(const struct form *form, double step)
{
  static const double LEFT = 1e-4; /* so that twelve digits stay */
  bool found = false;
  for (int m = 0; m < 2 * form->n; m++)
    found |= cabs(cexp(form->value[m] * step)) < LEFT;
  return found;
}

/* A mode that is damped critically has no second one: a millionth more damping parts them. */
enum eo_code eo_long_motion_init(struct eo_long_motion *motion, const struct eo_oscillator *oscillator, double damping,
                                 double mean, double step, int readings, const double (*weight)[N],
                                 struct eo_error *error)
{
  struct form form = {.n = oscillator->n, .ends = oscillator->ends};
  const double both[2] = {mean, mean};
  *motion = (struct eo_long_motion){.ends = oscillator->ends, .step = step, .readings = readings};
  form.scale = eo_propagator_mesh_rate(oscillator, both);
  fill_form(&form, oscillator, damping, mean);
  bool found = find_modes(&form);
  if (!found) {
    fill_form(&form, oscillator, damping * (1 + 1e-6), mean);
    found = find_modes(&form);
  }
  if (!found)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The modes of the lumped model could not be found.");
  motion->forgets = forgets(&form, step);
  for (int m = 0; m < 2 * form.n; m++)
    if (cimag(form.value[m]) >= 0)
      set_mode(motion, &form, oscillator, m, weight);
  motion->modes += motion->modes % 2;
  set_gains(motion, oscillator, weight);
  return EO_OK;
}

bool eo_long_motion_still(const struct eo_oscillator *oscillator, double mean, double deflection[2])
{
  double k[N * N], place[N];
  int n = oscillator->n, pivot[N];
  memcpy(place, oscillator->load, sizeof place);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      k[i * n + j] = oscillator->stiffness[i * n + j];
      for (int end = 0; end < oscillator->ends; end++)
        k[i * n + j] += mean * oscillator->mesh[end][i] * oscillator->mesh[end][j];
    }
  bool found = eo_dense_solve(n, k, pivot, 1, place) == 0;
  for (int end = 0; end < oscillator->ends; end++) {
    deflection[end] = 0;
    for (int i = 0; i < n; i++)
      deflection[end] += oscillator->mesh[end][i] * place[i];
  }
  return found;
}

void eo_long_motion_rest(struct eo_long_motion *motion, const double force[2])
{
  memset(&motion->state, 0, sizeof motion->state);
  for (int end = 0; end < motion->ends; end++)
    for (int i = 0; i < 2; i++)
      for (int m = 0; m < motion->modes; m++)
        motion->state.part[i][m] += force[end] * motion->rest[end].part[i][m];
}

static inline pair at(const struct eo_motion_row *row, int part, int m)
{
  return *(const pair *)&row->part[part][m];
}

/* ends, forgets: known where it is compiled. */
static inline void go(struct eo_long_motion *motion, int ends, bool forgets, const double *before, const double *force,
                      pair *x, pair *v)
{
  for (int m = 0; m < motion->modes; m += 2) {
    pair a = at(&motion->state, 0, m), b = at(&motion->state, 1, m), c = at(&motion->turn, 0, m),
         s = at(&motion->turn, 1, m), real = c * a - s * b, imaginary = c * b + s * a;
    for (int end = 0; end < ends; end++) {
      real += force[end] * at(&motion->kick[end], 0, m);
      imaginary += force[end] * at(&motion->kick[end], 1, m);
      if (forgets) {
        real += before[end] * at(&motion->before[end], 0, m);
        imaginary += before[end] * at(&motion->before[end], 1, m);
      }
    }
    for (int end = 0; end < ends; end++) {
      x[end] += at(&motion->deflection[end], 0, m) * real - at(&motion->deflection[end], 1, m) * imaginary;
      v[end] += at(&motion->rate[end], 0, m) * real - at(&motion->rate[end], 1, m) * imaginary;
    }
    *(pair *)&motion->state.part[0][m] = real;
    *(pair *)&motion->state.part[1][m] = imaginary;
  }
}

void eo_long_motion_go(struct eo_long_motion *motion, const double before[2], const double force[2],
                       double deflection[2], double rate[2])
{
  pair x[2] = {{0}}, v[2] = {{0}};
  if (motion->forgets)
    go(motion, motion->ends, true, before, force, x, v);
  else if (motion->ends == 2)
    go(motion, 2, false, before, force, x, v);
  else
    go(motion, 1, false, before, force, x, v);
  for (int i = 0; i < motion->ends; i++) {
    deflection[i] = x[i][0] + x[i][1];
    rate[i] = v[i][0] + v[i][1];
    for (int j = 0; j < motion->ends; j++) {
      deflection[i] += motion->early_gain[i][j] * force[j];
      rate[i] += motion->early_rate_gain[i][j] * force[j];
    }
  }
}

double eo_long_motion_read(const struct eo_long_motion *motion, int reading, const double before[2],
                           const double force[2])
{
  pair both = {0};
  for (int m = 0; m < motion->modes; m += 2)
    both += at(&motion->reading[reading], 0, m) * at(&motion->state, 0, m) -
            at(&motion->reading[reading], 1, m) * at(&motion->state, 1, m);
  double sum = both[0] + both[1];
  for (int end = 0; end < motion->ends; end++)
    sum += motion->direct[reading][end] * force[end] + motion->early_direct[reading][end] * before[end];
  return sum;
}
