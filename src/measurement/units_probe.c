/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/units_probe.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "measurement/terms.h"

enum { MOST_ROWS = 1 << 18, LINES = 5, FLOOR = 6 };
static const double LEAST_SEEN = 3; /* decades, of all lines together */

/* Rows as read, the drift of the TE taken off, under a Hann window. */
struct probe {
  int rows;
  double (*row)[3]; /* [rows] t, pinion angle, TE */
};

static void drift_terms(double x, double value[EO_DRIFT_TERMS])
{
  value[0] = 1;
  value[1] = x;
  value[2] = (3 * x * x - 1) / 2;
  value[3] = (5 * x * x - 3) * x / 2;
}

static enum eo_code flatten(struct probe *probe, struct eo_error *error)
{
  struct eo_normal normal;
  double coefficient[EO_DRIFT_TERMS], condition, value[EO_DRIFT_TERMS + 1];
  enum eo_code code = eo_normal_init(&normal, EO_DRIFT_TERMS, error);
  for (int i = 0; i < probe->rows && !code; i++) {
    double *row = eo_normal_row(&normal);
    drift_terms(2.0 * i / (probe->rows - 1) - 1, row);
    row[EO_DRIFT_TERMS] = probe->row[i][2];
    eo_normal_add(&normal);
  }
  if (!code)
    code = eo_normal_solve(&normal, coefficient, &condition, error);
  for (int i = 0; i < probe->rows && !code; i++) {
    drift_terms(2.0 * i / (probe->rows - 1) - 1, value);
    for (int k = 0; k < EO_DRIFT_TERMS; k++)
      probe->row[i][2] -= coefficient[k] * value[k];
    probe->row[i][2] *= 1 - cos(2 * M_PI * i / (probe->rows - 1));
  }
  eo_normal_done(&normal);
  return code;
}

static double power_at(const struct probe *probe, double order)
{
  double complex sum = 0;
  for (int i = 0; i < probe->rows; i++)
    sum += probe->row[i][2] * cexp(-I * order * probe->row[i][1]);
  return creal(sum) * creal(sum) + cimag(sum) * cimag(sum);
}

static const double LEAST_TURNS = 3;      /* of a shaft, of which a line can be told from the drift */
static const double BELOW_FOLDING = 0.45; /* of the rows per turn: above half of them orders fold */
static const double ASIDE = 2.5;          /* resolutions beside a line, where its own window is down */

/* How much the lines stand out when both angles are multiplied by the factor, in decades; NaN where the recording is
   too short or too coarse to show them. */
static double lines_seen(const struct probe *probe, const int teeth[2], double factor)
{
  const double order[LINES] = {(double)teeth[0] / teeth[1], 1, teeth[0], 2.0 * teeth[0], 3.0 * teeth[0]};
  double turns = fabs(probe->row[probe->rows - 1][1] - probe->row[0][1]) * factor / (2 * M_PI), seen = 0;
  double highest = BELOW_FOLDING * probe->rows / turns;
  if (turns < LEAST_TURNS || teeth[0] > highest)
    return NAN;
  for (int k = 0; k < LINES && order[k] < highest; k++) {
    double floor = 0;
    for (int j = 0; j < FLOOR; j++) {
      int step = j / 2;
      double aside = (j % 2 ? 1 : -1) * (ASIDE + step) / turns;
      floor += power_at(probe, (order[k] + aside) * factor) / FLOOR;
    }
    seen += log10(1 + power_at(probe, order[k] * factor) / fmax(floor, DBL_MIN)) * (order[k] > LEAST_TURNS / turns);
  }
  return seen;
}

/* What the angles may be in, with the factor for what is read as degrees, or as lines of which one edge counts. */
struct unit {
  double factor;
  const char *sentence; /* behind "Both angles are" or "The counters take" */
};

enum { UNITS = 6 };

/* What a guess may have taken for one another, rad. */
static const struct unit guessed[] = {{M_PI / 180, "Both angles are in degrees, not in the stated unit"},
                                      {1, "Both angles are in radians, not in the stated unit"},
                                      {M_PI / 200, "Both angles are in gon"},
                                      {2 * M_PI, "Both angles are in turns"}};

/* The units that a doubt leaves, the one that was read first; returns how many. */
static int open_units(const struct eo_unit_doubt *doubt, struct unit unit[UNITS])
{
  int n = 0;
  unit[n++] = (struct unit){1, ""};
  if (doubt->kind == EO_DOUBT_UNIT) {
    for (size_t i = 0; i < sizeof guessed / sizeof *guessed; i++)
      if (fabs(guessed[i].factor / doubt->scale - 1) > 1e-9)
        unit[n++] = (struct unit){guessed[i].factor / doubt->scale, guessed[i].sentence};
    return n;
  }
  unit[n++] = (struct unit){180 / M_PI, "Both angles are in radians, not in the stated unit"};
  unit[n++] = (struct unit){M_PI / 180, "Both angles are in degrees, not in the stated unit"};
  if (doubt->kind == EO_DOUBT_GRAD)
    unit[n++] = (struct unit){0.9, "Both angles are in gon, which \"grad\" means outside Germany"};
  if (doubt->kind == EO_DOUBT_EDGES) {
    unit[n++] = (struct unit){0.5, "Both counters take two edges of each line"};
    unit[n++] = (struct unit){0.25, "Both counters take four edges of each line"};
  }
  return n;
}

/* The rows of the run with the most of them. */
static int64_t longest_run(const struct eo_angles *angles, int64_t *first)
{
  int64_t most = 0;
  for (int i = 0; i <= angles->breaks; i++) {
    int64_t begin = i ? angles->run[i - 1] : 0, end = i < angles->breaks ? angles->run[i] : angles->rows;
    if (end - begin > most) {
      most = end - begin;
      *first = begin;
    }
  }
  return most;
}

/* Reads the rows: what is left of the path difference in column 2, without its slow part. */
static enum eo_code fill_probe(struct probe *probe, const struct eo_angles *angles, int64_t first,
                               const struct eo_transmission_settings *settings, struct eo_error *error)
{
  EO_TRY(eo_angles_read(angles, first, probe->rows, probe->row[0], error));
  for (int i = 0; i < probe->rows; i++)
    probe->row[i][2] = settings->base_radius[EO_GEAR] * probe->row[i][2] -
                       settings->base_radius[EO_PINION] * probe->row[i][1];
  return flatten(probe, error);
}

/* A recording that is too short as it is read does not speak against that. */
static double most_seen(const struct probe *probe, const struct eo_transmission_settings *settings,
                        const struct eo_unit_doubt *doubt)
{
  struct unit unit[UNITS];
  double seen[UNITS] = {0};
  int best = 0, units = open_units(doubt, unit);
  for (int i = 0; i < units; i++) {
    seen[i] = lines_seen(probe, settings->teeth, unit[i].factor);
    best = fmax(seen[i], 0) > fmax(seen[best], 0) ? i : best;
  }
  return seen[best] > (isnan(seen[0]) ? 2 : 1) * LEAST_SEEN ? unit[best].factor : NAN;
}

enum eo_code eo_units_probe(const struct eo_angles *angles, const struct eo_transmission_settings *settings,
                            const struct eo_unit_doubt *doubt, double *factor, struct eo_error *error)
{
  int64_t first = 0, rows = longest_run(angles, &first);
  struct probe probe = {.rows = rows < MOST_ROWS ? (int)rows : MOST_ROWS};
  probe.row = malloc(sizeof *probe.row * (size_t)probe.rows);
  enum eo_code code = probe.row ? fill_probe(&probe, angles, first, settings, error) : eo_error_memory(error);
  if (!code)
    *factor = most_seen(&probe, settings, doubt);
  free(probe.row);
  return code;
}

static void repair(struct eo_angles *angles, const struct eo_unit_doubt *doubt, double factor, double speed,
                   struct eo_findings *findings)
{
  struct unit unit[UNITS];
  const char *sentence = "";
  int units = open_units(doubt, unit);
  for (int i = 0; i < units; i++)
    sentence = unit[i].factor == factor ? unit[i].sentence : sentence;
  angles->factor[0] *= factor;
  angles->factor[1] *= factor;
  eo_findings_add(findings, EO_FINDING_UNITS, EO_SEVERITY_REPAIRED, -1, factor,
                  "%s: shaft and mesh orders only show at %.6g rpm, not at %.6g rpm; read so.", sentence,
                  speed * factor, speed);
}

enum eo_code eo_units_judge(struct eo_angles *angles, const struct eo_transmission_settings *settings,
                            const struct eo_unit_doubt *doubt, struct eo_findings *findings, struct eo_error *error)
{
  double factor, speed = fabs(angles->rate[angles->from[0]] * angles->factor[0]) * 30 / M_PI;
  enum eo_code code = eo_units_probe(angles, settings, doubt, &factor, error);
  if (code)
    return code;
  if (isnan(factor) && angles->units_in_doubt)
    eo_findings_add(findings, EO_FINDING_UNITS, EO_SEVERITY_REFUSED, -1, NAN,
                    "Which channel is in degrees and which in radians cannot be told; state the speed.");
  else if (isnan(factor) && doubt->kind == EO_DOUBT_WIDTH)
    eo_findings_add(findings, EO_FINDING_UNITS, EO_SEVERITY_REFUSED, -1, NAN,
                    "The counts start again where a counter overflows, nothing says that this is a turn, and no mesh "
                    "orders show as if it were: give the counts per turn.");
  else if (!isnan(factor) && factor != 1)
    repair(angles, doubt, factor, speed, findings);
  return EO_OK;
}
