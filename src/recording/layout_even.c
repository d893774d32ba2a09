/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the rows are even within what their times tell. */
#include "recording/layout_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

#define BLOCK 2048  /* rows read at once */
#define STEPS 20000 /* steps from which the resolution of times is told */
#define FEW 20      /* fewer odd steps than this are gaps or repeated rows, not the resolution of the times */
#define COUNTS 1024 /* rows between steps of the time, from which the usual number is told */
#define LEAST_COUNTS 5
#define MOSTLY 0.8      /* of them: alike but for a row */
#define CLOCK_SURE 2e-3 /* relative: times that tell the rate less closely ask for it */

/* Straight line through the times over the number of the row, by least squares, and what it leaves. Where most rows
   have the time of the row before, the rows at which it steps tell more: the line through the first and the last of
   them. */
struct line {
  int64_t count;
  double row, time; /* means */
  double square, product;
  double slope, most;               /* per row; largest distance */
  double before;                    /* the last time */
  int64_t edges;                    /* rows at which the time steps */
  double edge_row[2], edge_time[2]; /* of the first and the last of them */
  double odd;                       /* rows by which other steps are off at most */
  double each[COUNTS];              /* rows for a unit of time, from one step to the next */
  int counts, lost;                 /* of each, and of those that differ from the usual number */
};

static void add_time(struct line *line, double row, double time)
{
  double before = row - line->row;
  line->count++;
  line->row += before / (double)line->count;
  line->time += (time - line->time) / (double)line->count;
  line->square += before * (row - line->row);
  line->product += before * (time - line->time);
  if (line->count > 1 && time > line->before) {
    int at = line->edges++ > 0;
    if (at && line->counts < COUNTS)
      line->each[line->counts++] = (row - line->edge_row[line->edges > 2]) / (time - line->edge_time[line->edges > 2]);
    line->edge_row[at] = row;
    line->edge_time[at] = time;
  }
  line->before = time;
}

/* The second look: how far times are from the line, and steps from those of even rows. */
static void look_at(struct line *line, double row, double time)
{
  line->most = fmax(line->most, fabs(time - line->time - line->slope * (row - line->row)));
  if (row > line->edge_row[0] && time > line->before && line->edges > 1) {
    double each = (line->edge_time[1] - line->edge_time[0]) / (line->edge_row[1] - line->edge_row[0]);
    line->odd = fmax(line->odd, fabs(row - line->edge_row[0] - (time - line->edge_time[0]) / each));
  }
  line->before = time;
}

static enum eo_code pass(const struct eo_guess *guess, int column, struct line *line, bool fit, struct eo_error *error)
{
  int64_t rows = eo_recording_length(guess->recording, column);
  double *block = malloc(BLOCK * (size_t)guess->columns * sizeof *block);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    code = eo_recording_read(guess->recording, first, n, block, error);
    for (int64_t i = 0; !code && i < n; i++) {
      double time = block[i * guess->columns + column];
      if (isnan(time))
        continue;
      if (fit)
        add_time(line, (double)(first + i), time);
      else
        look_at(line, (double)(first + i), time);
    }
  }
  free(block);
  line->slope = line->product / line->square;
  return code;
}

/* The smallest distance of a step from the usual one, when there are enough such steps or most rows have the time of
   the row before: what the times resolve. 0: all steps are equal. */
static double resolution(double *step, int64_t count, bool *standing)
{
  if (count < 2 * FEW)
    return 0;
  eo_sort_numbers(count, step);
  double usual = step[count / 2], least = INFINITY;
  *standing = usual == 0;
  int64_t odd = 0;
  for (int64_t i = 0; i < count; i++) {
    double distance = fabs(step[i] - usual);
    odd += distance > 1e-4 * usual;
    if (distance > 1e-4 * usual && distance < least)
      least = distance;
  }
  return odd >= FEW || (*standing && odd) ? least : 0;
}

/* A row that is there twice says nothing of what the times resolve; the first row of a block is not compared. */
static bool is_repeated(const struct eo_guess *guess, const double *rows, int64_t at)
{
  size_t width = (size_t)guess->columns;
  return at > 0 && !memcmp(rows + (size_t)at * width, rows + (size_t)(at - 1) * width, width * sizeof *rows);
}

static enum eo_code find_resolution(const struct eo_guess *guess, int column, double *quantum, bool *standing,
                                    struct eo_error *error)
{
  int64_t rows = eo_recording_length(guess->recording, column), count = 0;
  rows = rows < STEPS ? rows : STEPS;
  double *step = malloc((size_t)(rows + 1) * sizeof *step), *row = malloc((size_t)guess->columns * sizeof *row * BLOCK),
         before = NAN;
  enum eo_code code = step && row ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    code = eo_recording_read(guess->recording, first, n, row, error);
    for (int64_t i = 0; !code && i < n; i++) {
      double time = row[i * guess->columns + column];
      if (!isnan(time - before) && !(time == before && is_repeated(guess, row, i)))
        step[count++] = time - before;
      before = time;
    }
  }
  *quantum = code ? 0 : resolution(step, count, standing);
  free(step);
  free(row);
  return code;
}

/* Rows for a unit of time where a regular clock tells them but for a few steps in which rows were lost, sorting each[];
   0: it does not, or lost none. */
static double usual_count(struct line *line, double quantum)
{
  double sum = 0;
  int alike = 0;
  eo_sort_numbers(line->counts, line->each);
  double middle = line->counts ? line->each[line->counts / 2] : 0;
  for (int i = 0; i < line->counts; i++)
    if (fabs(line->each[i] - middle) * quantum < 1.5) {
      sum += line->each[i];
      alike++;
    }
  line->lost = line->counts - alike;
  if (line->counts < LEAST_COUNTS || alike < MOSTLY * line->counts)
    line->lost = 0;
  return line->lost ? sum / alike : 0;
}

/* Times that stand for many rows: the line through their steps, where it is sure enough. */
static enum eo_code settle_standing(const struct eo_guess *guess, int column, struct line *line, double quantum,
                                    struct eo_layout_clock *clock, struct eo_error *error)
{
  char text[80];
  double rows = line->edge_row[1] - line->edge_row[0], sure = line->edges > 1 ? (1 + line->odd) / rows : INFINITY,
         usual = usual_count(line, quantum);
  if (usual > 0)
    sure = 2 * (1 + line->lost) / rows;
  if (!(sure < CLOCK_SURE))
    return eo_error_set(error, EO_ERROR_INPUT, "/sample_rate_Hz",
                        "%s only tells steps of %.3g s, %lld of them in the recording: that does not tell the sampling "
                        "rate within %.2g %%; give it.",
                        eo_layout_label(guess, column, text, sizeof text), quantum * clock->scale,
                        (long long)line->edges, 100 * CLOCK_SURE);
  clock->interval = (usual > 0 ? 1 / usual : (line->edge_time[1] - line->edge_time[0]) / rows) * clock->scale;
  clock->start = line->edge_time[0] * clock->scale - line->edge_row[0] * clock->interval;
  return EO_OK;
}

enum eo_code eo_layout_make_even(struct eo_guess *guess, struct eo_error *error)
{
  char text[80];
  for (int member = 0; member < 2; member++) {
    struct eo_layout_clock *clock = &guess->clock[member];
    struct line line = {0};
    double quantum;
    bool standing = false;
    int column = clock->column;
    if (column < 0)
      continue;
    enum eo_code code = find_resolution(guess, column, &quantum, &standing, error);
    if (!code && quantum > 0)
      code = pass(guess, column, &line, true, error);
    if (!code && quantum > 0)
      code = pass(guess, column, &line, false, error);
    if (code)
      return code;
    if (!(quantum > 0) || !(line.slope > 0) || (!standing && line.most > 1.01 * quantum))
      continue;
    clock->interval = line.slope * clock->scale;
    clock->start = (line.time - line.slope * line.row) * clock->scale;
    code = standing ? settle_standing(guess, column, &line, quantum, clock, error) : EO_OK;
    if (code)
      return code;
    clock->column = -1;
    if (member && guess->clock[0].start == clock->start)
      continue;
    if (line.lost)
      eo_notes_add(guess->notes, "In %d of %d steps of the time rows were lost, or written twice.", line.lost,
                   line.counts);
    eo_notes_add(guess->notes,
                 "%s only tells steps of %.3g s; within that its rows are even, %.9g s each: the rows count.",
                 eo_layout_label(guess, column, text, sizeof text), quantum * clock->scale, clock->interval);
  }
  return EO_OK;
}
