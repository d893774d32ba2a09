/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's figures of the theory: over torque (8, 9, 17), over the mesh cycle (10 to 12), of the root (14, 15), over
   speed (18). */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>

#include "format/json.h"
#include "evaluation/design_sweep.h"

struct series {
  const char *name;
  bool dots;
  struct eo_series x, y;
};

static const struct eo_outline_row series_rows[] = {
    EO_KEY("name", "text", "for people", EO_AT(struct series, name)),
    EO_KEY("dots", "flag", "points of their own, no curve", EO_AT(struct series, dots)),
    EO_KEY("x", "[number]", "in the unit of x_label", EO_AT(struct series, x)),
    EO_KEY("y", "[number?]", "in the unit of y_label; null: not known", EO_AT(struct series, y)),
};
static const struct eo_outline series_outline = EO_OUTLINE("FigureSeries", series_rows);

struct drawn {
  struct figure figure;
  json_t *series;
};

static const struct eo_outline_row figure_rows[] = {
    EO_KEY("number", "text", "of the paper", EO_AT(struct drawn, figure.number)),
    EO_KEY("title", "text", "for people", EO_AT(struct drawn, figure.title)),
    EO_KEY("x_label", "text", "quantity and unit", EO_AT(struct drawn, figure.x_label)),
    EO_KEY("y_label", "text", "quantity and unit", EO_AT(struct drawn, figure.y_label)),
    EO_KEY("from_zero", "flag", "the y axis begins at 0", EO_AT(struct drawn, figure.from_zero)),
    EO_KEY("series", "[object]", "curves, and points", .outline = &series_outline, EO_AT(struct drawn, series)),
};
const struct eo_outline eo_reproduction_figure_outline = EO_OUTLINE("ReproducedFigure", figure_rows);

struct figure eo_reproduction_figure(const char *number, const char *title, const char *x_label, const char *y_label,
                                     bool from_zero)
{
  return (struct figure){number, title, x_label, y_label, from_zero, eo_list_open()};
}

void eo_reproduction_series(struct figure *figure, const char *name, int count, const double *x, const double *y,
                            bool dots)
{
  const struct series series = {name, dots, eo_series_of(count, x, EO_DIGITS_CURVE),
                                eo_series_of(count, y, EO_DIGITS_CURVE)};
  eo_list_add(&figure->list, eo_outline_encode(&series_outline, &series));
}

enum eo_code eo_reproduction_add_figures(struct reproduction *reproduction, int count, struct figure *figure,
                                         struct eo_error *error)
{
  bool failed = false;
  for (int i = 0; i < count; i++) {
    const struct drawn drawn = {figure[i], eo_object_close(&figure[i].list)};
    json_t *document = eo_outline_encode(&eo_reproduction_figure_outline, &drawn);
    failed = json_array_append_new(reproduction->figures, document) != 0 || failed;
  }
  return failed ? eo_error_memory(error) : EO_OK;
}

static const double RPM = M_PI / 30;
enum { MOST = 200 };

struct grid {
  int torques, speeds;
  double torque[MOST], speed[MOST];           /* N m, rad/s */
  double torque_axis[MOST], speed_axis[MOST]; /* N m, rpm */
};

/* 207 N m to 1242 N m in twelfths of 414, so that 414, 621, 828 and 1035 are among them; 400 to 3000 rpm. */
static void lay_out(const struct reproduction *reproduction, struct grid *grid)
{
  int fine = reproduction->plan->order.quick ? 1 : 2;
  grid->torques = 15 * fine + 1;
  for (int i = 0; i < grid->torques; i++)
    grid->torque[i] = grid->torque_axis[i] = 207 + 69. / fine * i;
  grid->speeds = 26 * fine + 1;
  for (int i = 0; i < grid->speeds; i++) {
    grid->speed_axis[i] = 400 + 100. / fine * i;
    grid->speed[i] = grid->speed_axis[i] * RPM;
  }
}

struct curves {
  double transmission[MOST], impact[MOST], rms[MOST], rotational[MOST]; /* um, N, m/s2 */
};

static void read_torques(const struct eo_sweep *sweep, int variant, struct curves *curves)
{
  for (int i = 0; i < sweep->torques; i++) {
    const struct eo_sweep_point *sweep_point = &sweep->point[variant][EO_SWEEP_UP][i];
    curves->transmission[i] = 1e6 * sweep->at_torque[variant][i].peak_to_peak;
    curves->impact[i] = fmax(sweep_point->impact[0], sweep_point->impact[1]);
    curves->rms[i] = sweep_point->rms_pair[EO_READING_NORMAL];
    curves->rotational[i] = sweep_point->rms_pair[EO_READING_ROTATIONAL];
  }
}

static void read_speeds(const struct eo_sweep *sweep, int variant, struct curves *curves)
{
  for (int i = 0; i < sweep->speeds; i++) {
    curves->rms[i] = sweep->point[variant][EO_SWEEP_UP][i].rms_pair[EO_READING_NORMAL];
    curves->rotational[i] = sweep->point[variant][EO_SWEEP_UP][i].rms_pair[EO_READING_ROTATIONAL];
  }
}

/* The sweep of one design, and (once) of the unmodified one. along_speed at 828 N m, else at 2000 rpm. */
static enum eo_code sweep(struct reproduction *reproduction, const struct grid *grid, int variant, bool along_speed,
                          enum eo_mesh_law law, struct curves *own, struct curves *unmodified, struct eo_error *error)
{
  static const double one_torque = 828, one_speed = 2000 * (M_PI / 30);
  const struct eo_sweep_plan plan = {.torques = along_speed ? 1 : grid->torques,
                                     .speeds = along_speed ? grid->speeds : 1,
                                     .torque = along_speed ? &one_torque : grid->torque,
                                     .speed = along_speed ? grid->speed : &one_speed,
                                     .threads = reproduction->plan->threads};
  struct eo_design *design = malloc(sizeof *design);
  struct eo_sweep this_sweep;
  if (!design)
    return eo_error_memory(error);
  *design = *reproduction->design[variant];
  design->resolution.mesh_law = law;
  enum eo_code code = eo_sweep_run(&this_sweep, reproduction->pair, design, &plan, NULL, error);
  free(design);
  for (int i = 0; i < EO_SWEEP_VARIANTS && !code; i++) {
    struct curves *curves = i == EO_SWEEP_DESIGN ? own : unmodified;
    if (curves && along_speed)
      read_speeds(&this_sweep, i, curves);
    else if (curves)
      read_torques(&this_sweep, i, curves);
  }
  eo_sweep_done(&this_sweep);
  return code;
}

static enum eo_code add_torques(struct reproduction *reproduction, const struct grid *grid,
                                const struct curves curves[VARIANTS], const struct curves paper_law[2],
                                struct eo_error *error)
{
  struct figure figure[3] = {
      eo_reproduction_figure("8", "Loaded transmission error, peak to peak", "torque, N m", "um", true),
      eo_reproduction_figure("9", "Entering meshing impact force", "torque, N m", "N", true),
      eo_reproduction_figure("17", "RMS of the vibration acceleration at 2000 rpm (theory)", "torque, N m", "m/s2",
                             true)};
  const struct {
    const char *name;
    const struct curves *curves;
  } of_rms[5] = {{"unmodified", &curves[UNMODIFIED]},
                 {"Table 3, case A", &curves[PAPER_A]},
                 {"our optimum, A", &curves[OWN_A]},
                 {"unmodified, secant", &paper_law[0]},
                 {"case A, secant", &paper_law[1]}};
  for (int i = 0; i < VARIANTS; i++) {
    const char *name = eo_reproduction_variant[i];
    eo_reproduction_series(&figure[0], name, grid->torques, grid->torque_axis, curves[i].transmission, false);
    eo_reproduction_series(&figure[1], name, grid->torques, grid->torque_axis, curves[i].impact, false);
  }
  for (int i = 0; i < 5; i++)
    eo_reproduction_series(&figure[2], of_rms[i].name, grid->torques, grid->torque_axis, of_rms[i].curves->rms, false);
  return eo_reproduction_add_figures(reproduction, 3, figure, error);
}

static void judge_torques(struct reproduction *reproduction, const struct grid *grid,
                          const struct curves curves[VARIANTS], const struct curves paper_law[2])
{
  int quieter[2] = {0, 0};
  for (int i = 0; i < grid->torques; i++) {
    quieter[0] += curves[PAPER_A].transmission[i] < curves[UNMODIFIED].transmission[i];
    quieter[1] += curves[PAPER_A].impact[i] < curves[UNMODIFIED].impact[i];
    if (fabs(grid->torque_axis[i] - 414) < 1e-6)
      for (int j = 0; j < 2; j++) {
        reproduction->rms_414[LAW_OURS][j] = curves[j ? PAPER_A : UNMODIFIED].rms[i];
        reproduction->rms_414[LAW_PAPER][j] = paper_law[j].rms[i];
      }
  }
  for (int j = 0; j < 2; j++)
    reproduction->torques_better[j] = (double)quieter[j] / grid->torques;
}

static enum eo_code draw_torques(struct reproduction *reproduction, const struct grid *grid,
                                 struct curves curves[VARIANTS], struct curves paper_law[2], struct eo_error *error)
{
  for (int i = PAPER_A; i < VARIANTS; i++)
    EO_TRY(sweep(reproduction, grid, i, false, EO_LAW_TANGENT, &curves[i], i == PAPER_A ? &curves[UNMODIFIED] : NULL,
                 error));
  EO_TRY(sweep(reproduction, grid, PAPER_A, false, EO_LAW_SECANT, &paper_law[1], &paper_law[0], error));
  judge_torques(reproduction, grid, curves, paper_law);
  return add_torques(reproduction, grid, curves, paper_law, error);
}

static enum eo_code over_torque(struct reproduction *reproduction, const struct grid *grid, struct eo_error *error)
{
  struct curves *curves = calloc(VARIANTS + 2, sizeof *curves);
  if (!curves)
    return eo_error_memory(error);
  enum eo_code code = draw_torques(reproduction, grid, curves, curves + VARIANTS, error);
  free(curves);
  return code;
}

static enum eo_code draw_speeds(struct reproduction *reproduction, const struct grid *grid, struct curves curves[5],
                                struct eo_error *error)
{
  static const char *const name[5] = {"unmodified", "Table 3, case A", "our optimum, A", "unmodified, secant",
                                      "case A, secant"};
  int better = 0;
  EO_TRY(sweep(reproduction, grid, PAPER_A, true, EO_LAW_TANGENT, &curves[1], &curves[0], error));
  EO_TRY(sweep(reproduction, grid, OWN_A, true, EO_LAW_TANGENT, &curves[2], NULL, error));
  EO_TRY(sweep(reproduction, grid, PAPER_A, true, EO_LAW_SECANT, &curves[4], &curves[3], error));
  for (int i = 0; i < grid->speeds; i++)
    better += curves[1].rms[i] < curves[0].rms[i];
  for (int i = 0; i < 2; i++)
    reproduction->speed_slope[i] = curves[i].rms[grid->speeds - 1] / curves[i].rms[0];
  reproduction->speeds_better = (double)better / grid->speeds;
  struct figure figure = eo_reproduction_figure("18", "RMS of the vibration acceleration at 828 N m (theory)",
                                                "speed, rpm", "m/s2", true);
  for (int i = 0; i < 5; i++)
    eo_reproduction_series(&figure, name[i], grid->speeds, grid->speed_axis, curves[i].rms, false);
  return eo_reproduction_add_figures(reproduction, 1, &figure, error);
}

static enum eo_code over_speed(struct reproduction *reproduction, const struct grid *grid, struct eo_error *error)
{
  struct curves *curves = calloc(5, sizeof *curves);
  if (!curves)
    return eo_error_memory(error);
  enum eo_code code = draw_speeds(reproduction, grid, curves, error);
  free(curves);
  return code;
}

enum { SAMPLES = 1024 };

static int read_column(const json_t *array, double *value)
{
  int count = (int)json_array_size(array);
  count = count < SAMPLES ? count : SAMPLES;
  for (int i = 0; i < count; i++) {
    const json_t *number = json_array_get(array, (size_t)i);
    value[i] = json_is_number(number) ? json_number_value(number) : NAN;
  }
  return count;
}

/* The paper's mean of the left and right part. */
static enum eo_code add_vibration(struct reproduction *reproduction, int k, const char *number, struct eo_error *error)
{
  char title[100];
  double x[SAMPLES], left[SAMPLES], right[SAMPLES];
  snprintf(title, sizeof title, "Relative vibration acceleration, %.0f N m, mean of both ends",
           reproduction->design[UNMODIFIED]->load_case[k].torque);
  struct figure figure = eo_reproduction_figure(number, title, "mesh cycle", "m/s2", false);
  for (int i = 0; i < VARIANTS; i++) {
    const json_t *value =
        json_object_get(json_array_get(json_object_get(reproduction->result[i], "load_cases"), (size_t)k), "vibration");
    int count = read_column(json_object_get(value, "position"), x);
    read_column(eo_json_find(value, "left/history/normal_m_per_s2"), left);
    read_column(eo_json_find(value, "right/history/normal_m_per_s2"), right);
    for (int j = 0; j < count; j++)
      left[j] = 0.5 * (left[j] + right[j]);
    eo_reproduction_series(&figure, eo_reproduction_variant[i], count, x, left, false);
  }
  return eo_reproduction_add_figures(reproduction, 1, &figure, error);
}

static enum eo_code add_root(struct reproduction *reproduction, int variant, const char *number, const char *title,
                             struct eo_error *error)
{
  struct figure figure = eo_reproduction_figure(number, title, "mesh cycle of one tooth", "MPa", true);
  for (int k = 0; k < TORQUES; k++) {
    char name[60];
    double x[SAMPLES], y[SAMPLES];
    const json_t *root = eo_json_find(
        json_array_get(json_object_get(reproduction->result[variant], "load_cases"), (size_t)k), "root_stress/pinion");
    int count = read_column(json_object_get(root, "position"), x);
    read_column(json_object_get(root, "history_MPa"), y);
    snprintf(name, sizeof name, "%.0f N m", reproduction->design[variant]->load_case[k].torque);
    eo_reproduction_series(&figure, name, count, x, y, false);
  }
  return eo_reproduction_add_figures(reproduction, 1, &figure, error);
}

enum eo_code eo_reproduction_figures(struct reproduction *reproduction, struct eo_error *error)
{
  struct grid grid;
  lay_out(reproduction, &grid);
  EO_TRY(eo_reproduction_report(reproduction, "figures over torque", 0.86, error));
  EO_TRY(over_torque(reproduction, &grid, error));
  EO_TRY(eo_reproduction_report(reproduction, "figures over speed", 0.9, error));
  EO_TRY(over_speed(reproduction, &grid, error));
  EO_TRY(add_vibration(reproduction, 0, "10", error));
  EO_TRY(add_vibration(reproduction, 1, "11", error));
  EO_TRY(add_vibration(reproduction, 2, "12", error));
  EO_TRY(add_root(reproduction, UNMODIFIED, "14", "Root bending stress of the unmodified pinion", error));
  EO_TRY(add_root(reproduction, PAPER_A, "15", "Root bending stress of the pinion of Table 3, case A", error));
  return add_root(reproduction, OWN_A, "15 a", "Root bending stress of the pinion of our optimum, case A", error);
}
