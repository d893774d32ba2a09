/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's figures of the theory: over torque (8, 9, 17), over the mesh cycle (10 to 12), of the root (14, 15), over
   speed (18). */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>

#include "format/json.h"
#include "evaluation/design_sweep.h"

json_t *eo_reproduction_figure(const char *number, const char *title, const char *x_label, const char *y_label,
                               bool from_zero)
{
  return json_pack("{s:s, s:s, s:s, s:s, s:b, s:[]}", "number", number, "title", title, "x_label", x_label, "y_label",
                   y_label, "from_zero", from_zero, "series");
}

void eo_reproduction_series(json_t *figure, const char *name, int count, const double *x, const double *y, bool dots)
{
  json_t *series = json_pack("{s:s, s:b, s:o, s:o}", "name", name, "dots", dots, "x",
                             eo_json_reals(count, x, 1, NULL, EO_DIGITS_CURVE), "y",
                             eo_json_reals(count, y, 1, NULL, EO_DIGITS_CURVE));
  json_array_append_new(json_object_get(figure, "series"), series);
}

static const double RPM = M_PI / 30;
enum { MOST = 200 };

struct grid {
  int torques, speeds;
  double torque[MOST], speed[MOST];           /* N m, rad/s */
  double torque_axis[MOST], speed_axis[MOST]; /* N m, rpm */
};

/* 207 N m to 1242 N m in twelfths of 414, so that 414, 621, 828 and 1035 are among them; 400 to 3000 rpm. */
static void lay_out(const struct reproduction *r, struct grid *g)
{
  int fine = r->plan->quick ? 1 : 2;
  g->torques = 15 * fine + 1;
  for (int i = 0; i < g->torques; i++)
    g->torque[i] = g->torque_axis[i] = 207 + 69. / fine * i;
  g->speeds = 26 * fine + 1;
  for (int i = 0; i < g->speeds; i++) {
    g->speed_axis[i] = 400 + 100. / fine * i;
    g->speed[i] = g->speed_axis[i] * RPM;
  }
}

struct curves {
  double transmission[MOST], impact[MOST], rms[MOST], rotational[MOST]; /* um, N, m/s2 */
};

static void read_torques(const struct eo_sweep *sweep, int variant, struct curves *c)
{
  for (int i = 0; i < sweep->torques; i++) {
    const struct eo_sweep_point *p = &sweep->point[variant][EO_SWEEP_UP][i];
    c->transmission[i] = 1e6 * sweep->at_torque[variant][i].peak_to_peak;
    c->impact[i] = fmax(p->impact[0], p->impact[1]);
    c->rms[i] = p->rms_pair[EO_READING_NORMAL];
    c->rotational[i] = p->rms_pair[EO_READING_ROTATIONAL];
  }
}

static void read_speeds(const struct eo_sweep *sweep, int variant, struct curves *c)
{
  for (int i = 0; i < sweep->speeds; i++) {
    c->rms[i] = sweep->point[variant][EO_SWEEP_UP][i].rms_pair[EO_READING_NORMAL];
    c->rotational[i] = sweep->point[variant][EO_SWEEP_UP][i].rms_pair[EO_READING_ROTATIONAL];
  }
}

/* The sweep of one design, and (once) of the unmodified one. along_speed at 828 N m, else at 2000 rpm. */
static enum eo_code sweep(struct reproduction *r, const struct grid *g, int variant, bool along_speed,
                          enum eo_mesh_law law, struct curves *own, struct curves *unmodified, struct eo_error *error)
{
  static const double one_torque = 828, one_speed = 2000 * (M_PI / 30);
  const struct eo_sweep_plan plan = {.torques = along_speed ? 1 : g->torques,
                                     .speeds = along_speed ? g->speeds : 1,
                                     .torque = along_speed ? &one_torque : g->torque,
                                     .speed = along_speed ? g->speed : &one_speed,
                                     .threads = r->plan->threads};
  struct eo_design *design = malloc(sizeof *design);
  struct eo_sweep s;
  if (!design)
    return eo_error_memory(error);
  *design = *r->design[variant];
  design->resolution.mesh_law = law;
  enum eo_code code = eo_sweep_run(&s, r->pair, design, &plan, NULL, error);
  free(design);
  for (int i = 0; i < EO_SWEEP_VARIANTS && !code; i++) {
    struct curves *c = i == EO_SWEEP_DESIGN ? own : unmodified;
    if (c && along_speed)
      read_speeds(&s, i, c);
    else if (c)
      read_torques(&s, i, c);
  }
  eo_sweep_done(&s);
  return code;
}

static void add_torques(struct reproduction *r, const struct grid *g, const struct curves c[VARIANTS],
                        const struct curves paper_law[2])
{
  json_t *eight = eo_reproduction_figure("8", "Loaded transmission error, peak to peak", "torque, N m", "um", true);
  json_t *nine = eo_reproduction_figure("9", "Entering meshing impact force", "torque, N m", "N", true);
  json_t *seventeen = eo_reproduction_figure("17", "RMS of the vibration acceleration at 2000 rpm (theory)",
                                             "torque, N m", "m/s2", true);
  for (int i = 0; i < VARIANTS; i++) {
    eo_reproduction_series(eight, eo_reproduction_variant[i], g->torques, g->torque_axis, c[i].transmission, false);
    eo_reproduction_series(nine, eo_reproduction_variant[i], g->torques, g->torque_axis, c[i].impact, false);
  }
  eo_reproduction_series(seventeen, "unmodified", g->torques, g->torque_axis, c[UNMODIFIED].rms, false);
  eo_reproduction_series(seventeen, "Table 3, case A", g->torques, g->torque_axis, c[PAPER_A].rms, false);
  eo_reproduction_series(seventeen, "our optimum, A", g->torques, g->torque_axis, c[OWN_A].rms, false);
  eo_reproduction_series(seventeen, "unmodified, secant", g->torques, g->torque_axis, paper_law[0].rms, false);
  eo_reproduction_series(seventeen, "case A, secant", g->torques, g->torque_axis, paper_law[1].rms, false);
  json_array_append_new(r->figures, eight);
  json_array_append_new(r->figures, nine);
  json_array_append_new(r->figures, seventeen);
}

static void judge_torques(struct reproduction *r, const struct grid *g, const struct curves c[VARIANTS],
                          const struct curves paper_law[2])
{
  int quieter[2] = {0, 0};
  for (int i = 0; i < g->torques; i++) {
    quieter[0] += c[PAPER_A].transmission[i] < c[UNMODIFIED].transmission[i];
    quieter[1] += c[PAPER_A].impact[i] < c[UNMODIFIED].impact[i];
    if (fabs(g->torque_axis[i] - 414) < 1e-6)
      for (int j = 0; j < 2; j++) {
        r->rms_414[LAW_OURS][j] = c[j ? PAPER_A : UNMODIFIED].rms[i];
        r->rms_414[LAW_PAPER][j] = paper_law[j].rms[i];
      }
  }
  for (int j = 0; j < 2; j++)
    r->torques_better[j] = (double)quieter[j] / g->torques;
}

static enum eo_code over_torque(struct reproduction *r, const struct grid *g, struct eo_error *error)
{
  struct curves *c = calloc(VARIANTS + 2, sizeof *c), *paper_law = c + VARIANTS;
  enum eo_code code = c ? EO_OK : eo_error_memory(error);
  for (int i = PAPER_A; i < VARIANTS && !code; i++)
    code = sweep(r, g, i, false, EO_LAW_TANGENT, &c[i], i == PAPER_A ? &c[UNMODIFIED] : NULL, error);
  if (!code)
    code = sweep(r, g, PAPER_A, false, EO_LAW_SECANT, &paper_law[1], &paper_law[0], error);
  if (!code) {
    add_torques(r, g, c, paper_law);
    judge_torques(r, g, c, paper_law);
  }
  free(c);
  return code;
}

static enum eo_code over_speed(struct reproduction *r, const struct grid *g, struct eo_error *error)
{
  struct curves *c = calloc(5, sizeof *c);
  enum eo_code code = c ? sweep(r, g, PAPER_A, true, EO_LAW_TANGENT, &c[1], &c[0], error) : eo_error_memory(error);
  if (!code)
    code = sweep(r, g, OWN_A, true, EO_LAW_TANGENT, &c[2], NULL, error);
  if (!code)
    code = sweep(r, g, PAPER_A, true, EO_LAW_SECANT, &c[4], &c[3], error);
  if (!code) {
    static const char *const name[5] = {"unmodified", "Table 3, case A", "our optimum, A", "unmodified, secant",
                                        "case A, secant"};
    json_t *figure = eo_reproduction_figure("18", "RMS of the vibration acceleration at 828 N m (theory)", "speed, rpm",
                                            "m/s2", true);
    int better = 0;
    for (int i = 0; i < 5; i++)
      eo_reproduction_series(figure, name[i], g->speeds, g->speed_axis, c[i].rms, false);
    for (int i = 0; i < g->speeds; i++)
      better += c[1].rms[i] < c[0].rms[i];
    for (int i = 0; i < 2; i++)
      r->speed_slope[i] = c[i].rms[g->speeds - 1] / c[i].rms[0];
    r->speeds_better = (double)better / g->speeds;
    json_array_append_new(r->figures, figure);
  }
  free(c);
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
static void add_vibration(struct reproduction *r, int k, const char *number)
{
  char title[100];
  double x[SAMPLES], left[SAMPLES], right[SAMPLES];
  snprintf(title, sizeof title, "Relative vibration acceleration, %.0f N m, mean of both ends",
           r->design[UNMODIFIED]->load_case[k].torque);
  json_t *figure = eo_reproduction_figure(number, title, "mesh cycle", "m/s2", false);
  for (int i = 0; i < VARIANTS; i++) {
    const json_t *v = json_object_get(json_array_get(json_object_get(r->result[i], "load_cases"), (size_t)k),
                                      "vibration");
    int count = read_column(json_object_get(v, "position"), x);
    read_column(eo_json_find(v, "left/history/normal_m_per_s2"), left);
    read_column(eo_json_find(v, "right/history/normal_m_per_s2"), right);
    for (int j = 0; j < count; j++)
      left[j] = 0.5 * (left[j] + right[j]);
    eo_reproduction_series(figure, eo_reproduction_variant[i], count, x, left, false);
  }
  json_array_append_new(r->figures, figure);
}

static void add_root(struct reproduction *r, int variant, const char *number, const char *title)
{
  json_t *figure = eo_reproduction_figure(number, title, "mesh cycle of one tooth", "MPa", true);
  for (int k = 0; k < TORQUES; k++) {
    char name[60];
    double x[SAMPLES], y[SAMPLES];
    const json_t *root = eo_json_find(json_array_get(json_object_get(r->result[variant], "load_cases"), (size_t)k),
                                      "root_stress/pinion");
    int count = read_column(json_object_get(root, "position"), x);
    read_column(json_object_get(root, "history_MPa"), y);
    snprintf(name, sizeof name, "%.0f N m", r->design[variant]->load_case[k].torque);
    eo_reproduction_series(figure, name, count, x, y, false);
  }
  json_array_append_new(r->figures, figure);
}

enum eo_code eo_reproduction_figures(struct reproduction *r, struct eo_error *error)
{
  struct grid grid;
  lay_out(r, &grid);
  enum eo_code code = eo_reproduction_report(r, "figures over torque", 0.86, error);
  if (!code)
    code = over_torque(r, &grid, error);
  if (!code)
    code = eo_reproduction_report(r, "figures over speed", 0.9, error);
  if (!code)
    code = over_speed(r, &grid, error);
  if (code)
    return code;
  add_vibration(r, 0, "10");
  add_vibration(r, 1, "11");
  add_vibration(r, 2, "12");
  add_root(r, UNMODIFIED, "14", "Root bending stress of the unmodified pinion");
  add_root(r, PAPER_A, "15", "Root bending stress of the pinion of Table 3, case A");
  add_root(r, OWN_A, "15 a", "Root bending stress of the pinion of our optimum, case A");
  return EO_OK;
}
