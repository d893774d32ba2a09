/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/leaps.h"

#include <math.h>
#include <stdlib.h>

enum {
  BLOCK = 4096,
  MOST_TURNS = 1 << 16,
  ORDERS = EO_USUAL_ORDERS,
  SIDE = 3,        /* groups of windows that are compared on either side */
  WIDEST = 64,     /* windows in a group: more of them, where noise covers the orders of one */
  PHASES = 720,    /* leaps of the first order that are tried */
  MOST_LEAPS = 64, /* kept; angles hold fewer runs */
};
static const double STEADY = 0.02;  /* relative: the speed may change phases as well, near a resonance at once */
static const double GOES_ON = 1e-3; /* relative: by so much the speed may leap itself */
static const double PLAIN = 40;     /* times what the groups of a side scatter: a steady change leads to 25 at most */
static const double MATTERS = 0.04; /* of the power on both sides: 0.2 rad, less than 0.5 % of the amplitude */
static const double SHIFT = 0.05;   /* of the difference may be left when one side is shifted: a load changes more */
static const double BACK = 0.25;    /* turns: less is trembling */

/* What a window of two turns that fades at both ends sums up. Two of them overlap by one turn. */
struct window {
  double rows, level;
  double complex unit[ORDERS], product[ORDERS];
};

/* Where a turn of the pinion begins. */
struct border {
  int64_t row; /* -1: none, what lies on either side does not belong together */
  double time; /* s, between two rows */
};

struct leap {
  int turn, width; /* it lies in that turn, or so many before or behind it */
  double left;     /* relative power: of what the shift does not explain, and of the scatter */
  double of_a_pitch;
};

struct finder {
  const struct eo_transmission_settings *settings;
  int orders, turns;             /* turns: borders that are known */
  struct border *border;         /* owned, [MOST_TURNS + 2] */
  struct window *window;         /* owned, [MOST_TURNS + 2] */
  double complex (*sum)[ORDERS]; /* owned, [MOST_TURNS + 2]: of the amplitudes of all windows before */
  double zero, error;            /* pinion's angle and transmission error where the run begins */
  int first;                     /* turn with which it begins */
  double turn, time;             /* of the last row */
  struct leap leap[MOST_LEAPS];
  int leaps;
};

static double error_of(const struct finder *finder, const double row[3])
{
  return finder->settings->base_radius[EO_GEAR] * row[2] - finder->settings->base_radius[EO_PINION] * row[1];
}

static void begin_run(struct finder *finder, int64_t index, const double row[3])
{
  finder->first = finder->turns > 0 ? finder->turns + 1 : 0;
  if (finder->first)
    finder->border[finder->turns] = (struct border){.row = -1};
  finder->border[finder->first] = (struct border){index, row[0]};
  finder->turns = finder->first + 1;
  finder->zero = row[1];
  finder->error = error_of(finder, row);
}

static void add_to(struct finder *finder, int at, double weight, double angle, double error)
{
  struct window *window = &finder->window[at];
  double complex unit = cexp(-I * finder->settings->teeth[EO_PINION] * angle), power = weight;
  window->rows += weight;
  window->level += weight * error;
  for (int h = 0; h < finder->orders; h++) {
    power *= unit;
    window->unit[h] += power;
    window->product[h] += power * error;
  }
}

static void add_row(struct finder *finder, int64_t index, const double row[3], bool begins)
{
  double turn = fabs(row[1] - finder->zero) / (2 * M_PI) + finder->first;
  if (finder->turns > MOST_TURNS)
    return;
  if (begins || !finder->turns || turn < finder->turns - 1 - BACK || turn >= finder->turns + 1) {
    begin_run(finder, index, row);
    turn = finder->first;
  } else if (turn >= finder->turns) {
    double share = (finder->turns - finder->turn) / (turn - finder->turn);
    finder->border[finder->turns] = (struct border){index, finder->time + share * (row[0] - finder->time)};
    finder->turns++;
  }
  int at = finder->turns - 1;
  double rise = pow(sin(M_PI / 2 * fmax(turn - at, 0)), 2), error = error_of(finder, row) - finder->error;
  add_to(finder, at, rise, row[1], error);
  if (at > finder->first)
    add_to(finder, at - 1, 1 - rise, row[1], error);
  finder->turn = turn;
  finder->time = row[0];
}

static bool begins_run(const struct eo_angles *angles, int64_t row)
{
  for (int i = 0; i < angles->breaks; i++)
    if (angles->run[i] == row)
      return true;
  return false;
}

static enum eo_code read_rows(struct finder *finder, const struct eo_angles *angles, const struct eo_progress *progress,
                              struct eo_error *error)
{
  double(*rows)[3] = malloc(sizeof *rows * BLOCK);
  enum eo_code code = rows ? EO_OK : eo_error_memory(error);
  for (int64_t at = 0; at < angles->rows && !code; at += BLOCK) {
    int count = angles->rows - at < BLOCK ? (int)(angles->rows - at) : BLOCK;
    code = eo_angles_read(angles, at, count, rows[0], error);
    if (!code && eo_progress_report(progress, "phases", (double)at / (double)angles->rows))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    for (int i = 0; i < count && !code; i++)
      add_row(finder, at + i, rows[i], begins_run(angles, at + i));
  }
  free(rows);
  return code;
}

/* The amplitudes of all windows before each, the level of the transmission error taken out. */
static void sum_up(struct finder *finder)
{
  for (int t = 0; t < finder->turns; t++) {
    const struct window *window = &finder->window[t];
    for (int h = 0; h < finder->orders; h++) {
      double complex product = window->product[h] - window->level / window->rows * window->unit[h];
      finder->sum[t + 1][h] = finder->sum[t][h] + (window->rows > 0 ? 2 * product / window->rows : 0);
    }
  }
}

static double time_of(const struct finder *finder, int from, int to)
{
  return (finder->border[to].time - finder->border[from].time) / (to - from);
}

/* Turns that belong together, at one speed or at one that goes on as it went: channels that are not read at the same
   time shift all orders when the speed leaps. */
static bool is_steady(const struct finder *finder, int turn, int width)
{
  int side = SIDE * width + 1, from = turn - side, to = turn + 1 + side;
  double least = INFINITY, most = 0;
  if (from < 0 || to >= finder->turns)
    return false;
  for (int t = from; t < to; t++) {
    if (finder->border[t].row < 0 || finder->border[t + 1].row < 0)
      return false;
    least = fmin(least, time_of(finder, t, t + 1));
    most = fmax(most, time_of(finder, t, t + 1));
  }
  double change = time_of(finder, turn - 1, turn) - time_of(finder, from, from + 1) + time_of(finder, to - 1, to) -
                  time_of(finder, turn + 1, turn + 2);
  double leap = time_of(finder, turn + 1, to) - time_of(finder, from, turn) - change / 2 * (side + 1) / (side - 1);
  return most < (1 + STEADY) * least && fabs(leap) < GOES_ON * least;
}

/* An order on either side of a turn: the mean of its amplitudes in SIDE groups of windows, and their scatter. */
struct sides {
  double complex mean[2][ORDERS];
  double scatter;           /* power of one group, over all orders */
  double difference, power; /* of the means, likewise; power: mean of both */
};

/* Velocities: of accelerations most is noise, and of ways the first order alone would tell. */
static double weight_of(int h)
{
  return pow(h + 1, 2);
}

static void compare(const struct finder *finder, int turn, int width, struct sides *sides)
{
  *sides = (struct sides){.scatter = 0};
  for (int h = 0; h < finder->orders; h++) {
    double complex group[2][SIDE];
    for (int side = 0; side < 2; side++)
      for (int i = 0; i < SIDE; i++) {
        int from = side ? turn + 1 + i * width : turn - 1 - (i + 1) * width;
        group[side][i] = (finder->sum[from + width][h] - finder->sum[from][h]) / width;
        sides->mean[side][h] += group[side][i] / SIDE;
      }
    for (int side = 0; side < 2; side++) {
      for (int i = 0; i < SIDE; i++)
        sides->scatter += weight_of(h) * pow(cabs(group[side][i] - sides->mean[side][h]), 2) / (2 * (SIDE - 1));
      sides->power += weight_of(h) * pow(cabs(sides->mean[side][h]), 2) / 2;
    }
    sides->difference += weight_of(h) * pow(cabs(sides->mean[1][h] - sides->mean[0][h]), 2);
  }
}

/* What is left of the difference when the orders before are shifted by the angle that leaves least. */
static double shifted(const struct finder *finder, const struct sides *sides, double *angle)
{
  double least = INFINITY;
  for (int k = 0; k < PHASES; k++) {
    double left = 0;
    for (int h = 0; h < finder->orders; h++)
      left += weight_of(h) *
              pow(cabs(sides->mean[1][h] - sides->mean[0][h] * cexp(2 * M_PI * I * k * (h + 1) / PHASES)), 2);
    if (left < least) {
      least = left;
      *angle = remainder((double)k / PHASES, 1);
    }
  }
  return least;
}

static bool leaps_at(const struct finder *finder, int turn, int width, struct leap *leap)
{
  struct sides sides;
  if (!is_steady(finder, turn, width))
    return false;
  compare(finder, turn, width, &sides);
  if (sides.difference < PLAIN * sides.scatter || sides.difference < MATTERS * sides.power)
    return false;
  *leap = (struct leap){.turn = turn, .width = width};
  leap->left = shifted(finder, &sides, &leap->of_a_pitch) / sides.difference;
  bool shifts = leap->left < SHIFT;
  leap->left += sides.scatter / sides.difference;
  return shifts;
}

/* Another one that was found lies within what this one was compared with. */
static int find_near(const struct finder *finder, const struct leap *leap)
{
  int i = 0;
  while (i < finder->leaps && abs(finder->leap[i].turn - leap->turn) > SIDE * leap->width)
    i++;
  return i;
}

/* Of those of one width that are near to each other the one that leaves least is true; one that fewer windows tell
 * comes first. */
static void find_leaps(struct finder *finder, int width)
{
  for (int turn = 0; turn < finder->turns; turn++) {
    struct leap leap;
    if (!leaps_at(finder, turn, width, &leap))
      continue;
    int near = find_near(finder, &leap);
    bool is_new = near == finder->leaps && near < MOST_LEAPS;
    if (is_new)
      finder->leaps++;
    if (is_new || (near < finder->leaps && finder->leap[near].width == width && finder->leap[near].left > leap.left))
      finder->leap[near] = leap;
  }
}

static void add_run(struct eo_angles *angles, int64_t row)
{
  int at = angles->breaks++;
  for (; at > 0 && angles->run[at - 1] > row; at--)
    angles->run[at] = angles->run[at - 1];
  angles->run[at] = row;
}

static void conclude(const struct finder *finder, struct eo_angles *angles, struct eo_findings *findings)
{
  int first = 0;
  bool too_many = angles->breaks + 2 * finder->leaps > EO_RUNS;
  for (int i = 0; i < finder->leaps; i++) {
    const struct leap *leap = &finder->leap[i];
    first = leap->turn < finder->leap[first].turn ? i : first;
    for (int end = 0; end < 2 && !too_many; end++)
      add_run(angles, finder->border[leap->turn + (end ? 1 + leap->width : -leap->width)].row);
  }
  const struct border *border = &finder->border[finder->leap[first].turn];
  eo_findings_add(
      findings, EO_FINDING_DROPPED, too_many ? EO_SEVERITY_REFUSED : EO_SEVERITY_REPAIRED, -1, finder->leaps,
      "Rows are missing in %d place%s, the first about row %lld after %.4g s, though time and angles go on: "
      "the mesh orders leap there by %.2g of a pitch and keep their amplitudes. %s",
      finder->leaps, finder->leaps > 1 ? "s" : "", (long long)border->row + 1, border->time - angles->origin,
      fabs(finder->leap[first].of_a_pitch),
      too_many ? "State the times of a stretch between two of them (from, to)."
               : "What lies between two of them is a part of its own.")
      ->row = border->row;
}

static enum eo_code find(struct finder *finder, struct eo_angles *angles, struct eo_findings *findings,
                         const struct eo_progress *progress, struct eo_error *error)
{
  EO_TRY(read_rows(finder, angles, progress, error));
  sum_up(finder);
  for (int width = 1; width <= WIDEST; width *= 4)
    find_leaps(finder, width);
  if (finder->leaps)
    conclude(finder, angles, findings);
  return EO_OK;
}

enum eo_code eo_leaps_cut(struct eo_angles *angles, const struct eo_transmission_settings *settings,
                          struct eo_findings *findings, const struct eo_progress *progress, struct eo_error *error)
{
  double per_turn = 2 * M_PI / fabs(angles->rate[angles->from[0]] * angles->factor[0] * angles->interval);
  double most = 0.45 * per_turn / settings->teeth[EO_PINION];
  struct finder *finder = most >= 1 ? calloc(1, sizeof *finder) : NULL;
  if (!(most >= 1))
    return EO_OK;
  if (!finder)
    return eo_error_memory(error);
  finder->settings = settings;
  finder->orders = most < ORDERS ? (int)most : ORDERS;
  finder->border = calloc(MOST_TURNS + 3, sizeof *finder->border);
  finder->window = calloc(MOST_TURNS + 3, sizeof *finder->window);
  finder->sum = calloc(MOST_TURNS + 3, sizeof *finder->sum);
  enum eo_code code = finder->border && finder->window && finder->sum ? find(finder, angles, findings, progress, error)
                                                                      : eo_error_memory(error);
  free(finder->border);
  free(finder->window);
  free(finder->sum);
  free(finder);
  return code;
}
