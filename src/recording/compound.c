/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/compound.h"
#include "recording/column.h"
#include "recording/overflow.h"
#include "recording/steps.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 2048
#define PARTS 6             /* of one number at most: days to microseconds */
#define DEGREE 0.0174532925 /* rad, as near as units are told apart */
#define EPOCH 1e8           /* s: more are counted from a date, and too many for a double beside nanoseconds, */
#define EPOCH_END 9e9       /* up to what nanoseconds in 64 bits hold */
#define FAULTY 100          /* one row in so many may go the wrong way */

#define FRACTION_WORDS "fraction|frac|fractional|fractions|subsec|subsecond|subseconds|bruchteil"

/* One column of the new recording. */
struct group {
  int parts, column[PARTS];
  double scale[PARTS]; /* what one unit of a part is, in the unit of the sum */
  double base;         /* is taken from the first part, so that nothing of the last is lost */
  double turn;         /* after which a time starts again whose coarser parts or higher bits are missing; 0: not */
  bool angle, steps, overflows;
  bool floors;   /* of a negative angle: minutes and seconds count up from the degrees, as modulo does */
  bool signs;    /* there are negative degrees: of 0 degrees the rows before tell the sign, which "-0" loses */
  double before; /* the value of the row before */
  double step;   /* that led to it */
  double added;  /* turns passed, or the sum of the steps */
  int64_t up, down;
};

struct compound {
  const struct eo_recording *recording;
  int columns, groups;
  struct eo_column look[EO_RECORDING_COLUMNS];
  struct group group[EO_RECORDING_COLUMNS];
};

/* What the column is a part of, by its unit, else by the last word of its name: 1 a time, 2 an angle, 0 neither. A
   fraction of seconds whose unit its values must tell has scale 0. */
static int part_of(const struct compound *compound, int column, double *scale)
{
  const char *name = eo_recording_name(compound->recording, column), *end = name + strlen(name), *word;
  enum eo_quantity quantity = compound->look[column].quantity;
  *scale = compound->look[column].factor;
  if (quantity == EO_QUANTITY_NONE && eo_column_named(name, FRACTION_WORDS)) {
    *scale = 0;
    return 1;
  }
  for (word = end; word > name && isalpha((unsigned char)word[-1]);)
    word--;
  if (quantity == EO_QUANTITY_NONE && (word == name || end - word > 1)) /* "s" alone is a unit, in "t.s" anything */
    quantity = eo_unit_find(word, scale);
  return quantity == EO_QUANTITY_TIME ? 1 : quantity == EO_QUANTITY_ANGLE ? 2 : 0;
}

/* The power of ten that the values of a fraction fill; 0: they do not tell. */
static double fraction_scale(const struct eo_column *look)
{
  if (look->high < 1)
    return look->whole ? 0 : 1;
  for (double most = 10; most <= 1e9; most *= 10)
    if (look->high < most)
      return look->whole && look->high > 0.5 * most ? 1 / most : 0;
  return 0;
}

/* Seconds since 1970 beside what stays below a thousand, a million or a milliard and starts again. */
static double nameless_scale(const struct compound *compound, int column)
{
  static const double mosts[] = {1e3, 1e6, 1e9};
  const struct eo_column *first = &compound->look[column], *look = &compound->look[column + 1];
  if (first->quantity != EO_QUANTITY_NONE || look->quantity != EO_QUANTITY_NONE || first->low < EPOCH ||
      first->high > EPOCH_END || !first->rises || !look->whole || !look->resets)
    return 0;
  for (size_t i = 0; i < sizeof mosts / sizeof *mosts; i++)
    if (look->high < mosts[i])
      return look->high > 0.5 * mosts[i] ? 1 / mosts[i] : 0;
  return 0;
}

/* The next part of a time: smaller than the one before and never as much as one unit of it. */
static bool add_time_part(const struct compound *compound, struct group *group, int column)
{
  double scale, before = group->scale[group->parts - 1];
  const struct eo_column *look = &compound->look[column];
  if (!look->count || !compound->look[column - 1].whole)
    return false;
  if (part_of(compound, column, &scale) != 1)
    scale = group->parts == 1 ? nameless_scale(compound, column - 1) : 0;
  else if (scale == 0)
    scale = fraction_scale(look);
  if (!(scale > 0) || (scale >= before && !(scale == before && look->high < 1)) || look->low < 0 ||
      look->high * scale >= before)
    return false;
  group->scale[group->parts] = scale;
  group->column[group->parts++] = column;
  return true;
}

/* Minutes and seconds behind degrees, called by the units of time or of arc. */
static bool add_angle_part(const struct compound *compound, struct group *group, int column)
{
  double scale, wanted = group->parts == 1 ? 1. / 60 : 1. / 3600;
  const struct eo_column *look = &compound->look[column];
  int part = part_of(compound, column, &scale);
  if (!part || group->parts > 2 || !look->count || !compound->look[column - 1].whole || look->high >= 60 ||
      look->low <= -60)
    return false;
  scale = part == 1 ? scale / 3600 : scale / DEGREE;
  if (fabs(scale / wanted - 1) > 1e-6)
    return false;
  group->scale[group->parts] = wanted;
  group->column[group->parts++] = column;
  return true;
}

static double turn_of(const struct eo_column *look, double scale)
{
  static const double turns[][2] = {{3600, 86400}, {60, 3600}, {1, 60}};
  for (size_t i = 0; i < sizeof turns / sizeof *turns; i++)
    if (scale == turns[i][0] && look->high * scale < turns[i][1])
      return turns[i][1];
  return 0;
}

/* The columns from `column` on that may be one number, by their names and ranges. */
static struct group group_at(const struct compound *compound, int column)
{
  struct group group = {.parts = 1, .column = {column}, .before = NAN};
  const struct eo_column *look = &compound->look[column];
  double scale;
  int part = part_of(compound, column, &scale);
  group.angle = part == 2 && fabs(scale / DEGREE - 1) < 1e-6;
  if (part != 1 && !group.angle && column + 1 < compound->columns && nameless_scale(compound, column) > 0)
    part = 1, scale = 1;
  if (!look->count || !look->whole || (part != 1 && !group.angle) || scale == 0)
    return group;
  group.scale[0] = group.angle ? 1 : scale;
  int64_t length = eo_recording_length(compound->recording, column);
  for (int c = column + 1; c < compound->columns && group.parts < PARTS; c++)
    if (eo_recording_length(compound->recording, c) != length ||
        !(group.angle ? add_angle_part(compound, &group, c) : add_time_part(compound, &group, c)))
      break;
  group.signs = group.angle && look->low < 0;
  if (!group.angle) {
    group.base = look->low * scale > EPOCH && look->low * scale < EPOCH_END ? look->low : 0;
    group.turn = turn_of(look, scale);
  }
  return group;
}

/* Value of the group in a row, NaN where a part is missing. */
static double value_of(struct group *group, const double *row)
{
  double first = row[group->column[0]] - group->base, sum = first * group->scale[0], rest = 0;
  for (int i = 1; i < group->parts; i++)
    rest += row[group->column[i]] * group->scale[i];
  if (group->steps) {
    group->added += isnan(first) ? 0 : first;
    return isnan(first) ? NAN : group->added;
  }
  bool negative = first < 0 || (first == 0 && group->signs && group->before + group->step < 0);
  sum += group->angle && negative && !group->floors ? -rest : rest;
  if (group->turn > 0 && sum + group->added < group->before - group->turn / 2)
    group->added += group->turn;
  sum += group->added;
  if (isnan(sum))
    return sum;
  group->step = isnan(group->before) ? 0 : sum - group->before;
  group->before = sum;
  return sum;
}

/* Which way a group goes from row to row; an angle that starts again goes on. */
static void count_step(struct group *group, const double *row)
{
  double before = group->before, step = value_of(group, row) - before;
  if (group->angle && fabs(step) > 180)
    return;
  group->up += step > 0;
  group->down += step < 0;
}

static enum eo_code each_block(const struct eo_recording *recording,
                               enum eo_code (*take)(void *context, const double *rows, int64_t first, int64_t count,
                                                    struct eo_error *error),
                               void *context, struct eo_error *error)
{
  int64_t rows = eo_recording_rows(recording);
  double *block = malloc(BLOCK * (size_t)eo_recording_columns(recording) * sizeof *block);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    code = eo_recording_read(recording, first, n, block, error);
    if (!code)
      code = take(context, block, first, n, error);
  }
  free(block);
  return code;
}

static enum eo_code count_block(void *context, const double *rows, int64_t first, int64_t count, struct eo_error *error)
{
  struct compound *compound = context;
  (void)first;
  (void)error;
  for (int64_t i = 0; i < count; i++)
    for (int g = 0; g < compound->groups; g++)
      if (compound->group[g].parts > 1)
        count_step(&compound->group[g], rows + i * compound->columns);
  return EO_OK;
}

/* Together the parts go one way. */
static bool goes(const struct group *group)
{
  int64_t less = group->up < group->down ? group->up : group->down;
  return group->up + group->down > 0 && less <= (group->up + group->down) / FAULTY && (group->angle || group->up > 0);
}

static void begin_again(struct group *group)
{
  group->before = NAN;
  group->added = group->step = 0;
  group->up = group->down = 0;
}

/* Groups whose values do not bear out their names fall apart again; of negative angles the way of counting that goes
   one way is taken. */
static enum eo_code check_groups(struct compound *compound, struct eo_error *error)
{
  bool again = false;
  EO_TRY(each_block(compound->recording, count_block, compound, error));
  for (int g = 0; g < compound->groups; g++) {
    struct group *group = &compound->group[g];
    group->floors = group->parts > 1 && group->angle && !goes(group);
    again = again || group->floors;
    if (group->parts > 1 && !group->angle && !goes(group))
      group->parts = 1;
    begin_again(group);
  }
  if (again)
    EO_TRY(each_block(compound->recording, count_block, compound, error));
  for (int g = 0; again && g < compound->groups; g++) {
    struct group *group = &compound->group[g];
    if (group->parts > 1 && group->angle && !goes(group))
      group->parts = 1;
    begin_again(group);
  }
  return EO_OK;
}

/* Columns of a group that fell apart stand alone again. */
static void settle_groups(struct compound *compound)
{
  struct group *settled = compound->group;
  bool taken[EO_RECORDING_COLUMNS] = {false};
  struct group kept[EO_RECORDING_COLUMNS];
  int groups = 0, count = compound->groups;
  memcpy(kept, settled, (size_t)count * sizeof *kept);
  for (int g = 0; g < count; g++)
    for (int i = 0; i < kept[g].parts; i++)
      taken[kept[g].column[i]] = true;
  for (int c = 0, g = 0; c < compound->columns; c++) {
    if (g < count && kept[g].column[0] == c)
      settled[groups++] = kept[g++];
    else if (!taken[c])
      settled[groups++] = (struct group){.parts = 1, .column = {c}, .before = NAN};
  }
  compound->groups = groups;
}

/* Times alone whose counter starts again. */
static enum eo_code find_overflows(struct compound *compound, bool *any, struct eo_error *error)
{
  double turn[EO_RECORDING_COLUMNS];
  EO_TRY(eo_overflow_find(compound->recording, compound->look, turn, error));
  for (int g = 0; g < compound->groups; g++) {
    struct group *group = &compound->group[g];
    if (group->parts > 1 || group->steps || !(turn[group->column[0]] > 0))
      continue;
    *group = (struct group){.parts = 1,
                            .column = {group->column[0]},
                            .scale = {1},
                            .turn = turn[group->column[0]],
                            .overflows = true,
                            .before = NAN};
    *any = true;
  }
  return EO_OK;
}

static enum eo_code find_groups(struct compound *compound, bool *any, struct eo_error *error)
{
  *any = false;
  for (int c = 0; c < compound->columns; c++)
    EO_TRY(eo_column_look(compound->recording, c, &compound->look[c], error));
  for (int c = 0; c < compound->columns;) {
    struct group *group = &compound->group[compound->groups++];
    *group = group_at(compound, c);
    c += group->parts;
    *any = *any || group->parts > 1;
  }
  if (*any)
    EO_TRY(check_groups(compound, error));
  settle_groups(compound);
  *any = compound->groups < compound->columns;
  bool steps[EO_RECORDING_COLUMNS] = {false}; /* of columns that all stand alone */
  if (!*any)
    eo_steps_find(compound->recording, compound->look, steps);
  for (int g = 0; g < compound->groups; g++)
    if (steps[g])
      *any = compound->group[g].steps = true, compound->group[g].scale[0] = 1;
  return find_overflows(compound, any, error);
}

struct writer {
  struct compound *compound;
  struct eo_recording *out;
  double rows[BLOCK];
  int64_t line; /* of the next row, when no line is left out */
};

static enum eo_code write_block(void *context, const double *rows, int64_t first, int64_t count, struct eo_error *error)
{
  struct writer *writer = context;
  struct compound *compound = writer->compound;
  for (int64_t i = 0; i < count; i++) {
    int64_t line = eo_recording_line(compound->recording, first + i);
    for (int g = 0; g < compound->groups; g++) {
      struct group *group = &compound->group[g];
      bool alone = group->parts == 1 && !group->steps && !group->overflows;
      const double *row = rows + i * compound->columns;
      writer->rows[g] = alone ? row[group->column[0]] : value_of(group, row);
    }
    if (line && line != writer->line)
      eo_recording_set_line(writer->out, line);
    writer->line = line + 1;
    EO_TRY(eo_recording_append(writer->out, writer->rows, 1, error));
  }
  return EO_OK;
}

/* Names, units and clocks of the new columns; a clock refers to its times by their new number. */
static void describe(const struct compound *compound, struct eo_recording *out)
{
  const struct eo_recording *old = compound->recording;
  int moved[EO_RECORDING_COLUMNS];
  for (int g = 0; g < compound->groups; g++)
    for (int i = 0; i < compound->group[g].parts; i++)
      moved[compound->group[g].column[i]] = g;
  for (int g = 0; g < compound->groups; g++) {
    const struct group *group = &compound->group[g];
    int first = group->column[0];
    struct eo_clock clock = eo_recording_clock(old, first);
    const char *unit = eo_recording_unit(old, first);
    clock.column = clock.column < 0 ? -1 : moved[clock.column];
    if (group->base > 0)
      clock.epoch = (int64_t)group->base * llround(group->scale[0] * 1e9);
    eo_recording_set_column(out, g, eo_recording_name(old, first),
                            group->parts == 1 ? unit
                            : group->angle    ? "deg"
                                              : "s");
    eo_recording_set_length(out, g, eo_recording_length(old, first));
    eo_recording_set_clock(out, g, &clock);
    eo_recording_set_turn(out, g, eo_recording_turn(old, first));
  }
  eo_recording_set_tick(out, eo_recording_tick(old));
}

static void note_groups(const struct compound *compound, struct eo_notes *notes)
{
  int steps = 0;
  for (int g = 0; g < compound->groups; g++) {
    const struct group *group = &compound->group[g];
    const char *name = eo_recording_name(compound->recording, group->column[0]);
    steps += group->steps;
    if (group->steps)
      eo_notes_add(notes, "Column %d \"%s\" holds steps of time: their sums are the times.", group->column[0] + 1,
                   name);
    else if (group->overflows)
      eo_notes_add(notes,
                   "Column %d \"%s\" starts again every %.10g, as a counter that overflows does, %.0f times: its times "
                   "go on.",
                   group->column[0] + 1, name, group->turn, group->added / group->turn);
    else if (group->parts > 1)
      eo_notes_add(notes, "Columns %d to %d, from \"%s\" to \"%s\", are parts of one %s and were joined.",
                   group->column[0] + 1, group->column[group->parts - 1] + 1, name,
                   eo_recording_name(compound->recording, group->column[group->parts - 1]),
                   group->angle ? "angle" : "time");
  }
  if (steps > 1)
    eo_notes_add(notes, "The first steps of both columns are taken to begin at one time, which steps do not tell.");
}

static enum eo_code rewrite(struct compound *compound, const char *spool_directory, struct eo_recording **made,
                            struct eo_error *error)
{
  struct writer *writer = calloc(1, sizeof *writer);
  if (!writer)
    return eo_error_memory(error);
  writer->compound = compound;
  enum eo_code code = eo_recording_new(&writer->out, compound->groups, spool_directory, error);
  if (!code)
    code = each_block(compound->recording, write_block, writer, error);
  if (code)
    eo_recording_free(writer->out);
  else
    *made = writer->out;
  free(writer);
  return code;
}

enum eo_code eo_compound_join(struct eo_recording **recording, const char *spool_directory, struct eo_notes *notes,
                              struct eo_error *error)
{
  struct compound *compound = calloc(1, sizeof *compound);
  struct eo_recording *made = NULL;
  bool any = false;
  if (!compound)
    return eo_error_memory(error);
  compound->recording = *recording;
  compound->columns = eo_recording_columns(*recording);
  enum eo_code code = find_groups(compound, &any, error);
  if (!code && any)
    code = rewrite(compound, spool_directory, &made, error);
  if (!code && any) {
    describe(compound, made);
    note_groups(compound, notes);
    eo_recording_free(*recording);
    *recording = made;
  }
  free(compound);
  return code;
}
