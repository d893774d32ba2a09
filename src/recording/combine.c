/* Two recordings of one run become one: the second is brought to the times of the first. */
#include "recording/column.h"
#include "recording/layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 4096
#define POINTS 16 /* rows of a polynomial */
#define SAME 1e-6 /* of a row's interval: times that differ less are equal */

/* A recording read forwards through a window of rows. */
struct window {
  const struct eo_recording *recording;
  int columns, time;                   /* columns of the recording; that of time, -1: even */
  double scale;                        /* s per unit of time */
  double period[EO_RECORDING_COLUMNS]; /* of columns that start again, 0: they do not */
  double shift[EO_RECORDING_COLUMNS];  /* turns counted so far, in the column's unit */
  int64_t rows, first;                 /* of the recording; row number of the window's first */
  int64_t held;                        /* rows in the window */
  double *row;                         /* [2 * BLOCK][columns]; unwrapped */
  double *t;                           /* [2 * BLOCK], s */
};

struct combination {
  struct window side[2]; /* pinion, gear */
  struct eo_recording *out;
  int columns;
  double *rows; /* [BLOCK][columns] */
  int64_t filled, kept;
};

static enum eo_code open_window(struct window *w, int side, const struct eo_recording *recording,
                                const struct eo_layout_choice *choice, struct eo_error *error)
{
  struct eo_column look;
  w->recording = recording;
  w->columns = eo_recording_columns(recording);
  w->rows = eo_recording_rows(recording);
  w->time = -1;
  w->scale = 1;
  double best = 0;
  for (int c = 0; c < w->columns; c++) {
    enum eo_code code = eo_column_look(recording, c, &look, error);
    if (code)
      return code;
    bool named = choice && choice->time && !strcmp(eo_recording_name(recording, c), choice->time);
    double score = named                                                             ? 4
                   : look.falls || look.resets || look.rises < 2                     ? 0
                   : look.quantity == EO_QUANTITY_TIME                               ? 3
                   : eo_column_named(eo_recording_name(recording, c), "t|time|zeit") ? 2
                   : c == 0 && w->columns > 1 && look.spread < 1e-3                  ? 1
                                                                                     : 0;
    if (score > best) {
      best = score;
      w->time = c;
      w->scale = look.quantity == EO_QUANTITY_TIME ? look.factor : 1;
    }
    bool one_way = look.rises > 4 * look.falls || look.falls > 4 * look.rises;
    w->period[c] = one_way && look.resets ? eo_column_turn(&look) : 0;
    if (one_way && look.resets && choice && choice->lines[side] > 0 && look.whole)
      w->period[c] = choice->lines[side];
    if (one_way && look.resets && !(w->period[c] > 0))
      return eo_error_set(error, EO_ERROR_INPUT, "/lines",
                          "The values of the %s start again after about %.6g; give the counts per turn.",
                          side ? "gear" : "pinion", look.period);
  }
  if (choice && choice->time_scale > 0)
    w->scale = choice->time_scale;
  if (w->time >= 0)
    w->period[w->time] = 0;
  w->row = malloc(2 * BLOCK * (size_t)w->columns * sizeof *w->row);
  w->t = malloc(2 * BLOCK * sizeof *w->t);
  return w->row && w->t ? EO_OK : eo_error_memory(error);
}

static void close_window(struct window *w)
{
  free(w->row);
  free(w->t);
}

/* Counts turns on over a new row; n: its place in the window. The row before is there unless it is the first of all. */
static void unwrap_row(struct window *w, int64_t n)
{
  for (int c = 0; c < w->columns; c++) {
    double *value = &w->row[n * w->columns + c];
    if (w->period[c] <= 0)
      continue;
    *value += w->shift[c];
    double step = n ? *value - w->row[(n - 1) * w->columns + c] : 0;
    double turns = isnan(step) ? 0 : round(step / w->period[c]);
    *value -= turns * w->period[c];
    w->shift[c] -= turns * w->period[c];
  }
}

/* Drops rows before `keep` (row of the recording) and fills the window up. */
static enum eo_code move_window(struct window *w, int64_t keep, struct eo_error *error)
{
  int64_t drop = keep - w->first;
  if (drop > 0) {
    memmove(w->row, w->row + drop * w->columns, (size_t)((w->held - drop) * w->columns) * sizeof *w->row);
    memmove(w->t, w->t + drop, (size_t)(w->held - drop) * sizeof *w->t);
    w->first += drop;
    w->held -= drop;
  }
  int64_t n = w->rows - w->first - w->held, room = 2 * BLOCK - w->held;
  n = n < room ? n : room;
  enum eo_code code = eo_recording_read(w->recording, w->first + w->held, n, w->row + w->held * w->columns, error);
  for (int64_t i = w->held; !code && i < w->held + n; i++) {
    unwrap_row(w, i);
    w->t[i] = w->time >= 0 ? w->row[i * w->columns + w->time] * w->scale
                           : eo_recording_clock(w->recording, 0).start +
                                 (double)(w->first + i) * eo_recording_clock(w->recording, 0).interval;
  }
  w->held += code ? 0 : n;
  return code;
}

/* Values of all columns at a time inside rows from .. from + POINTS - 1 of the window, by the polynomial through them.
 */
static void interpolate(const struct window *w, int64_t from, double t, double *values)
{
  double weight[POINTS];
  for (int i = 0; i < POINTS; i++) {
    weight[i] = 1;
    for (int k = 0; k < POINTS; k++)
      if (k != i)
        weight[i] *= (t - w->t[from + k]) / (w->t[from + i] - w->t[from + k]);
  }
  for (int c = 0; c < w->columns; c++) {
    const double *column = w->row + from * w->columns + c;
    double base = column[(long)POINTS / 2 * w->columns], sum = 0;
    for (int i = 0; i < POINTS; i++)
      sum += weight[i] * (column[(long)i * w->columns] - base);
    values[c] = base + sum;
  }
}

static enum eo_code flush(struct combination *m, struct eo_error *error)
{
  enum eo_code code = eo_recording_append(m->out, m->rows, m->filled, error);
  m->kept += m->filled;
  m->filled = 0;
  return code;
}

/* Time, the first side's other columns, the second side's other columns. */
static enum eo_code put_row(struct combination *m, double t, const double *first, const double *second,
                            struct eo_error *error)
{
  double *to = m->rows + m->filled * m->columns;
  const double *from[2] = {first, second};
  *to++ = t;
  for (int side = 0; side < 2; side++)
    for (int c = 0; c < m->side[side].columns; c++)
      if (c != m->side[side].time)
        *to++ = from[side][c];
  return ++m->filled == BLOCK ? flush(m, error) : EO_OK;
}

/* Goes through the first side's rows with the second's window moving along. */
static enum eo_code combine_rows(struct combination *m, struct eo_error *error)
{
  struct window *a = &m->side[0], *b = &m->side[1];
  double values[EO_RECORDING_COLUMNS];
  int64_t at = 0; /* row of b: the last one not after t */
  enum eo_code code = move_window(b, 0, error);
  for (int64_t row = 0; !code && row < a->rows; row++) {
    if (row >= a->first + a->held || !a->held)
      code = move_window(a, row ? row - 1 : 0, error); /* the row before stays, for its turns */
    if (code)
      return code;
    double t = a->t[row - a->first];
    while (!code && at + 1 < b->rows) {
      if (at + 2 + POINTS > b->first + b->held && b->first + b->held < b->rows)
        code = move_window(b, at > POINTS ? at - POINTS : 0, error);
      if (code || !(b->t[at + 1 - b->first] <= t))
        break;
      at++;
    }
    if (code)
      return code;
    double before = b->t[at - b->first],
           step = at + 1 < b->rows ? b->t[at + 1 - b->first] - before : before - b->t[at - 1 - b->first];
    const double *exact = fabs(t - before) <= SAME * step ? b->row + (at - b->first) * b->columns
                          : at + 1 < b->rows && fabs(t - before - step) <= SAME * step
                              ? b->row + (at + 1 - b->first) * b->columns
                              : NULL;
    int64_t from = at - POINTS / 2 + 1;
    if (!exact && (t < before || from < 0 || from + POINTS > b->rows))
      continue; /* at the ends a polynomial swings: only its middle is used */
    if (!exact)
      interpolate(b, from - b->first, t, values);
    code = put_row(m, t, a->row + (row - a->first) * a->columns, exact ? exact : values, error);
  }
  return code ? code : flush(m, error);
}

/* Equal names of the two files are told apart by a number, which also says which encoder is which. */
static void name_columns(const struct combination *m)
{
  int to = 1;
  eo_recording_set_column(m->out, 0, "time", "s");
  for (int side = 0; side < 2; side++) {
    const struct eo_recording *r = m->side[side].recording;
    for (int c = 0; c < m->side[side].columns; c++) {
      char name[EO_RECORDING_NAME + 16];
      if (c == m->side[side].time)
        continue;
      snprintf(name, sizeof name, "%.40s%s%s", eo_recording_name(r, c), *eo_recording_name(r, c) ? " " : "",
               side ? "gear" : "pinion");
      eo_recording_set_column(m->out, to++, name, eo_recording_unit(r, c));
    }
  }
}

static enum eo_code combine_pulses(struct combination *m, struct eo_error *error)
{
  double block[2][BLOCK];
  const struct eo_recording *side[2] = {m->side[0].recording, m->side[1].recording};
  int64_t rows = m->side[0].rows > m->side[1].rows ? m->side[0].rows : m->side[1].rows;
  for (int64_t first = 0; first < rows; first += BLOCK) {
    int64_t count = rows - first < BLOCK ? rows - first : BLOCK;
    for (int s = 0; s < 2; s++) {
      int64_t left = m->side[s].rows - first, n = left < 0 ? 0 : left < count ? left : count;
      enum eo_code code = n ? eo_recording_read(side[s], first, n, block[s], error) : EO_OK;
      if (code)
        return code;
      for (int64_t i = 0; i < count; i++)
        m->rows[2 * i + s] = i < n ? block[s][i] : NAN;
    }
    enum eo_code code = eo_recording_append(m->out, m->rows, count, error);
    if (code)
      return code;
  }
  for (int s = 0; s < 2; s++) {
    eo_recording_set_length(m->out, s, m->side[s].rows);
    eo_recording_set_column(m->out, s, s ? "gear" : "pinion",
                            *eo_recording_unit(side[s], 0) ? eo_recording_unit(side[s], 0) : "s");
  }
  return EO_OK;
}

static bool has_time(const struct window *w)
{
  return w->time >= 0 || eo_recording_clock(w->recording, 0).interval > 0;
}

static enum eo_code combine(struct combination *m, const struct eo_layout_choice *choice, const char *spool_directory,
                            struct eo_notes *notes, struct eo_error *error)
{
  bool pulses = choice && choice->kind == EO_LAYOUT_PULSES;
  for (int s = 0; s < 2; s++) {
    struct window *w = &m->side[s];
    pulses = pulses || (w->columns == 1 && !(eo_recording_clock(w->recording, 0).interval > 0));
    if (!pulses && (!has_time(w) || w->rows < POINTS))
      return eo_error_set(error, EO_ERROR_INPUT, "/time",
                          "The file of the %s has no time and no sampling rate, or fewer than %d rows.",
                          s ? "gear" : "pinion", POINTS);
  }
  m->columns = pulses ? 2 : 1;
  for (int s = 0; s < 2 && !pulses; s++)
    m->columns += m->side[s].columns - (m->side[s].time >= 0);
  if (pulses && (m->side[0].columns != 1 || m->side[1].columns != 1))
    return eo_error_set(error, EO_ERROR_INPUT, "/columns", "Of two files with pulse times each must have one column.");
  m->rows = malloc(BLOCK * (size_t)m->columns * sizeof *m->rows);
  enum eo_code code = m->rows ? eo_recording_new(&m->out, m->columns, spool_directory, error) : eo_error_memory(error);
  if (!code)
    code = pulses ? combine_pulses(m, error) : combine_rows(m, error);
  if (code || pulses)
    return code;
  if (!m->kept)
    return eo_error_set(error, EO_ERROR_INPUT, "/time", "The times of the two files do not overlap.");
  name_columns(m);
  eo_notes_add(notes, "Two files were combined by their time: %lld of %lld rows of the pinion's have both angles.",
               (long long)m->kept, (long long)m->side[0].rows);
  return EO_OK;
}

enum eo_code eo_layout_combine(const struct eo_recording *pinion, const struct eo_recording *gear,
                               const struct eo_layout_choice *choice, const char *spool_directory,
                               struct eo_recording **combined, struct eo_notes *notes, struct eo_error *error)
{
  struct combination *m = calloc(1, sizeof *m);
  if (!m)
    return eo_error_memory(error);
  enum eo_code code = open_window(&m->side[0], 0, pinion, choice, error);
  if (!code)
    code = open_window(&m->side[1], 1, gear, choice, error);
  if (!code)
    code = combine(m, choice, spool_directory, notes, error);
  if (code)
    eo_recording_free(m->out);
  else
    *combined = m->out;
  close_window(&m->side[0]);
  close_window(&m->side[1]);
  free(m->rows);
  free(m);
  return code;
}
