/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage_law.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/oscillator.h"
#include "numerics/fourier.h"

enum { MOST_POSITIONS = 4096 };

static const struct eo_field row[] = {
    EO_NUMBER_REQUIRED(struct eo_stage_law_row, load, "load_N", &eo_unit_N, 0, 1e12, "normal load of one end"),
    EO_SERIES(struct eo_stage_law_row, approach, "Z_um", &eo_unit_um, MOST_POSITIONS, -1e6, 1e6, EO_FIELD_REQUIRED,
              "approach at equal steps of the mesh cycle"),
};
static const struct eo_table row_table = EO_TABLE("a load of the table law", struct eo_stage_law_row, row);

static const char *const kinds[] = {"tangent", "secant", "table", "fourier", NULL};

static const struct eo_field law[] = {
    EO_CHOICE(struct eo_stage_law, kind, "kind", kinds, EO_STAGE_LAW_TANGENT,
              "P + k_tan (X - Z); P/(Z - datum) (X - datum); linear between the loads of a table; k(phi) f(X), "
              "f with the two sides of the backlash"),
    EO_SERIES(struct eo_stage_law, approach, "Z_um", &eo_unit_um, MOST_POSITIONS, -1e6, 1e6, 0,
              "tangent, secant: approach at equal steps of the mesh cycle"),
    EO_SERIES(struct eo_stage_law, tangent, "kt_N_per_um", &eo_unit_N_per_um, MOST_POSITIONS, 1e-9, 1e9, 0,
              "tangent: stiffness dP/dZ at the same places"),
    EO_NUMBER_DERIVED(struct eo_stage_law, load, "load_N", &eo_unit_N, 1e-6, 1e12, "of the torque",
                      "tangent, secant: load P of one end at which Z was found"),
    EO_NUMBER(struct eo_stage_law, datum, "datum_um", &eo_unit_um, -1e6, 1e6, 0,
              "secant: approach of the first contact anywhere on the flank"),
    EO_INTEGER(struct eo_stage_law, order, "te_harmonics", 0, EO_MAX_HARMONICS, 10,
               "tangent, secant, table: mesh harmonics kept, at most half the positions"),
    EO_LIST(struct eo_stage_law, row, rows, "rows", &row_table, 0, EO_STAGE_LAW_ROWS,
            "table: at least two, loads ascending"),
    EO_NUMBER_DERIVED(struct eo_stage_law, mean, "mean_N_per_um", &eo_unit_N_per_um, 1e-9, 1e9, "needed with fourier",
                      "fourier: mean of k(phi)"),
    EO_SERIES(struct eo_stage_law, cosine, "cosine_N_per_um", &eo_unit_N_per_um, EO_MAX_HARMONICS, -1e9, 1e9, 0,
              "fourier: coefficients of cos(2 pi n phi), n = 1.."),
    EO_SERIES(struct eo_stage_law, sine, "sine_N_per_um", &eo_unit_N_per_um, EO_MAX_HARMONICS, -1e9, 1e9, 0,
              "fourier: coefficients of sin(2 pi n phi)"),
};
const struct eo_table eo_stage_law_table = EO_TABLE("a mesh law", struct eo_stage_law, law);

static enum eo_code refuse(const char *pointer, const char *key, const char *what, struct eo_error *error)
{
  char place[120];
  snprintf(place, sizeof place, "%s/%s", pointer, key);
  return eo_error_set(error, EO_ERROR_INPUT, place, "%s", what);
}

static enum eo_code make_table(struct eo_law *out, const struct eo_stage_law *given, int order, const char *pointer,
                               struct eo_error *error)
{
  int positions = given->rows ? given->row[0].approach.count : 0;
  double load[EO_STAGE_LAW_ROWS];
  if (given->rows < 2 || positions < 2)
    return refuse(pointer, "rows", "A table law needs at least two loads and two positions.", error);
  double *approach = malloc(sizeof *approach * (size_t)given->rows * (size_t)positions);
  if (!approach)
    return eo_error_memory(error);
  enum eo_code code = EO_OK;
  for (int i = 0; i < given->rows && !code; i++) {
    load[i] = given->row[i].load;
    if (given->row[i].approach.count == positions)
      memcpy(approach + (size_t)i * (size_t)positions, given->row[i].approach.value,
             sizeof *approach * (size_t)positions);
    else
      code = refuse(pointer, "rows", "All loads of a table law need the same number of positions.", error);
  }
  if (!code)
    code = eo_law_set_table(out, given->rows, positions, load, approach, order < positions / 2 ? order : positions / 2,
                            0, error);
  free(approach);
  return code;
}

static enum eo_code make_fourier(struct eo_law *out, const struct eo_stage_law *given, double backlash,
                                 const char *pointer, struct eo_error *error)
{
  double series[1 + 2 * EO_MAX_HARMONICS] = {given->mean};
  if (isnan(given->mean))
    return refuse(pointer, "mean_N_per_um", "A law by Fourier coefficients needs its mean.", error);
  for (int n = 0; n < given->cosine.count; n++)
    series[2 * n + 1] = given->cosine.value[n];
  for (int n = 0; n < given->sine.count; n++)
    series[2 * n + 2] = given->sine.value[n];
  return eo_law_set_stiffness(out, given->cosine.count > given->sine.count ? given->cosine.count : given->sine.count,
                              series, backlash / 2, -backlash / 2, error);
}

enum eo_code eo_stage_law_make(struct eo_law *out, const struct eo_stage_law *given, double load, double backlash,
                               const char *pointer, struct eo_error *error)
{
  int n = given->approach.count, order = n > 1 && given->order >= n / 2 ? (n - 1) / 2 : given->order;
  double nominal = isnan(given->load) ? load : given->load;
  if (given->kind == EO_STAGE_LAW_TABLE)
    return make_table(out, given, given->order, pointer, error);
  if (given->kind == EO_STAGE_LAW_FOURIER)
    return make_fourier(out, given, backlash, pointer, error);
  if (n < 2)
    return refuse(pointer, "Z_um", "This kind of law needs the approach at two positions or more.", error);
  if (given->kind == EO_STAGE_LAW_SECANT)
    return eo_law_set_secant(out, n, given->approach.value, nominal, given->datum, order, -backlash, error);
  if (given->tangent.count != n)
    return refuse(pointer, "kt_N_per_um", "Z_um and kt_N_per_um must be equally long.", error);
  return eo_law_set_tangent(out, n, given->approach.value, given->tangent.value, nominal, order, -backlash, error);
}

double eo_stage_law_stiffness(const struct eo_law *this_law, double load)
{
  enum { PHASES = 256 };
  double sum = 0, value[EO_STAGE_LAW_ROWS + 2];
  for (int i = 0; i < PHASES; i++) {
    eo_law_rows(this_law, (double)i / PHASES, value);
    sum += eo_law_force(this_law, value, eo_law_deflection(this_law, value, load), 1).slope;
  }
  return sum / PHASES;
}
