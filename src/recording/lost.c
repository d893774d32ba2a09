/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/lost.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

#define BLOCK 1024
#define CHUNKS 16 /* spread over the recording, from which the usual step is learnt */
#define CHUNK 256
#define FAR 20.0 /* usual steps */
#define MARKS 8  /* different values that are looked at in one column */

/* A value that is far from its neighbours. */
struct mark {
  double value, least, most; /* the smallest and the largest jump to it */
  int64_t runs, rows;
};

struct watch {
  double usual; /* size of a step that is none of 0: the median */
  double value; /* of the run of equal values that goes on */
  int64_t rows; /* in it */
  double jump;  /* to it: INFINITY: it is the first one */
  int64_t rises, falls;
  struct mark mark[MARKS];
  int marks;
};

static void add_mark(struct watch *watch)
{
  int i = 0;
  while (i < watch->marks && watch->mark[i].value != watch->value)
    i++;
  if (i == MARKS)
    return;
  struct mark *mark = &watch->mark[i];
  if (i == watch->marks) {
    watch->marks++;
    *mark = (struct mark){.value = watch->value, .least = INFINITY};
  }
  mark->runs++;
  mark->rows += watch->rows;
  if (isfinite(watch->jump)) {
    mark->least = fmin(mark->least, watch->jump);
    mark->most = fmax(mark->most, watch->jump);
  }
}

static void watch_value(struct watch *watch, double value)
{
  if (isnan(value) || !(watch->usual > 0))
    return;
  if (watch->rows && value == watch->value) {
    watch->rows++;
    return;
  }
  double step = watch->rows ? value - watch->value : INFINITY, limit = FAR * watch->usual;
  if (watch->rows && fabs(step) > limit && watch->jump > limit)
    add_mark(watch);
  watch->rises += step > 0 && step <= limit;
  watch->falls += step < 0 && step >= -limit;
  watch->value = value;
  watch->rows = 1;
  watch->jump = fabs(step);
}

/* In a column that goes one way. Where all jumps are alike they are those of an angle that trembles about its zero. */
static bool is_plain(const struct watch *watch, const struct mark *mark)
{
  int64_t less = watch->rises < watch->falls ? watch->rises : watch->falls, all = watch->rises + watch->falls;
  bool alike = mark->runs > 2 && mark->most - mark->least < FAR / 2 * watch->usual;
  return 10 * less <= all && all > 20 && !alike;
}

static void learn_usual(struct watch *watch, double *step, int steps)
{
  eo_sort_numbers(steps, step);
  *watch = (struct watch){.usual = steps ? step[steps / 2] : 0};
}

/* block: [BLOCK][columns]; step: [CHUNKS * CHUNK]. */
static enum eo_code learn(const struct eo_recording *recording, struct watch *watch, double *block, double *step,
                          struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  int64_t rows = eo_recording_rows(recording);
  for (int c = 0; c < columns; c++) {
    int steps = 0;
    for (int k = 0; k < CHUNKS; k++) {
      int64_t first = rows > CHUNK ? (rows - CHUNK) * k / (CHUNKS - 1) : 0,
              n = rows - first < CHUNK ? rows - first : CHUNK;
      EO_TRY(eo_recording_read(recording, first, n, block, error));
      for (int64_t i = 1; i < n; i++) {
        double size = fabs(block[i * columns + c] - block[(i - 1) * columns + c]);
        if (size > 0)
          step[steps++] = size;
      }
    }
    learn_usual(&watch[c], step, steps);
  }
  return EO_OK;
}

static enum eo_code look(const struct eo_recording *recording, struct watch *watch, double *block,
                         struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  int64_t rows = eo_recording_rows(recording);
  for (int64_t first = 0; first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    EO_TRY(eo_recording_read(recording, first, n, block, error));
    for (int64_t i = 0; i < n; i++)
      for (int c = 0; c < columns; c++)
        watch_value(&watch[c], block[i * columns + c]);
  }
  for (int c = 0; c < columns; c++)
    watch_value(&watch[c], INFINITY); /* ends the last run */
  return EO_OK;
}

/* The value that stands for lost ones most often; what does so in another column is enough of a reason. NULL: none. */
static const struct mark *find_lost(const struct watch *watch, int64_t rows, const double *known, int count)
{
  const struct mark *best = NULL;
  for (int i = 0; i < watch->marks; i++) {
    const struct mark *mark = &watch->mark[i];
    bool is = is_plain(watch, mark);
    for (int k = 0; k < count && !is; k++)
      is = mark->value == known[k];
    if (is && mark->rows > 1 && 2 * mark->rows < rows && (!best || mark->rows > best->rows))
      best = mark;
  }
  return best;
}

static void conclude(struct eo_recording *recording, const struct watch *watch, struct eo_notes *notes)
{
  double known[EO_RECORDING_COLUMNS];
  int columns = eo_recording_columns(recording), count = 0;
  bool done[EO_RECORDING_COLUMNS] = {false};
  for (int pass = 0; pass < 2; pass++)
    for (int c = 0; c < columns; c++) {
      const struct mark *mark = done[c]
                                    ? NULL
                                    : find_lost(&watch[c], eo_recording_length(recording, c), known, pass ? count : 0);
      if (!mark)
        continue;
      done[c] = true;
      known[count++] = mark->value;
      eo_recording_set_lost(recording, c, mark->value);
      eo_notes_add(notes, "\"%s\" holds %.9g in %lld rows, far from the values beside it: it stands for lost ones.",
                   eo_recording_name(recording, c), mark->value, (long long)mark->rows);
    }
}

enum eo_code eo_lost_find(struct eo_recording *recording, struct eo_notes *notes, struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  struct watch *watch = calloc((size_t)columns, sizeof *watch);
  double *block = malloc((BLOCK * (size_t)columns + CHUNKS * CHUNK) * sizeof *block);
  enum eo_code code = watch && block ? learn(recording, watch, block, block + BLOCK * (size_t)columns, error)
                                     : eo_error_memory(error);
  if (!code)
    code = look(recording, watch, block, error);
  if (!code)
    conclude(recording, watch, notes);
  free(watch);
  free(block);
  return code;
}
