/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of teeth as text: what measuring machines and spreadsheets write. */
#include "document/pitch_document.h"
#include "gear/names.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TEETH = 2000, MOST_COLUMNS = 32, MOST_CELL = 64, FLANKS = 8 };

enum heading {
  TOOTH,
  INDEX,
  SINGLE,
  PROFILE_SLOPE,
  HELIX_SLOPE,
  PROFILE_CROWNING,
  LEAD_CROWNING,
  MEMBER,
  END,
  FLANK,
  HEADINGS
};
static const char *const heading_name[HEADINGS] = {
    "tooth",  "index_um", "single_um", "profile_slope_um", "helix_slope_um", "profile_crowning_um", "lead_crowning_um",
    "member", "end",      "flank"};

/* Where the reading stands. */
struct reading {
  const char *at;
  int line, column; /* from 1 */
  char separator;
  bool decimal_comma;
  int columns;
  enum heading heading[MOST_COLUMNS];
  bool has[HEADINGS];
  double *value;                   /* [FLANKS][HEADINGS][MOST_TEETH + 1], owned; NaN: not stated */
  int least[FLANKS], most[FLANKS]; /* tooth numbers seen */
  int line_of[FLANKS];             /* of the last row of a flank; 0: none */
  int decimals[FLANKS];            /* of its finest single pitch deviation */
};

static double *value_of(const struct reading *reading, int flank, int heading, int tooth)
{
  return reading->value + ((size_t)flank * HEADINGS + (size_t)heading) * (MOST_TEETH + 1) + tooth;
}

static enum eo_code refuse(const struct reading *reading, struct eo_error *error, const char *what, const char *cell)
{
  return eo_error_set(error, EO_ERROR_INPUT, NULL, "Line %d, column %d of the table: \"%s\" %s", reading->line,
                      reading->column, cell, what);
}

/* The next cell of the line without the blanks around it; false behind the last. */
static bool next_cell(struct reading *reading, char cell[MOST_CELL])
{
  const char *end = reading->at;
  if (*reading->at == 0 || *reading->at == '\n' || *reading->at == '\r')
    return false;
  while (*end && *end != reading->separator && *end != '\n' && *end != '\r')
    end++;
  const char *first = reading->at, *last = end;
  while (first < last && (*first == ' ' || *first == '"'))
    first++;
  while (last > first && (last[-1] == ' ' || last[-1] == '"'))
    last--;
  snprintf(cell, MOST_CELL, "%.*s", (int)(last - first), first);
  reading->at = *end == reading->separator ? end + 1 : end;
  reading->column++;
  return true;
}

static void next_line(struct reading *reading)
{
  reading->at += strcspn(reading->at, "\n");
  reading->at += *reading->at == '\n';
  reading->line++;
  reading->column = 0;
}

/* Blank lines and those that begin with #. */
static void skip_remarks(struct reading *reading)
{
  while (*reading->at) {
    const char *from = reading->at + strspn(reading->at, " \t\r");
    if (*from != '#' && *from != '\n')
      return;
    next_line(reading);
  }
}

static enum eo_code read_headings(struct reading *reading, bool whole, struct eo_error *error)
{
  char cell[MOST_CELL];
  while (next_cell(reading, cell)) {
    int found = 0;
    for (char *c = cell; *c; c++)
      *c = (char)tolower((unsigned char)*c);
    while (found < HEADINGS && strcmp(cell, heading_name[found]) != 0)
      found++;
    if (found == HEADINGS || (!whole && found >= MEMBER))
      return refuse(reading, error,
                    whole ? "is no heading; those known are tooth, index_um, single_um, profile_slope_um, "
                            "helix_slope_um, profile_crowning_um, lead_crowning_um, member, end and flank."
                          : "is no heading; those of one flank are tooth, index_um, single_um, profile_slope_um, "
                            "helix_slope_um, profile_crowning_um and lead_crowning_um.",
                    cell);
    if (reading->has[found] || reading->columns == MOST_COLUMNS)
      return refuse(reading, error, "stands there twice.", cell);
    reading->has[found] = true;
    reading->heading[reading->columns++] = (enum heading)found;
  }
  if (!reading->has[TOOTH] || (reading->has[INDEX] && reading->has[SINGLE]) ||
      !(reading->has[INDEX] || reading->has[SINGLE] || reading->has[PROFILE_SLOPE] || reading->has[HELIX_SLOPE] ||
        reading->has[PROFILE_CROWNING] || reading->has[LEAD_CROWNING]))
    return eo_error_set(error, EO_ERROR_INPUT, NULL,
                        "Line %d of the table: headings name tooth and what is stated of it, with one of index_um and "
                        "single_um at most.",
                        reading->line);
  if (whole && !reading->has[MEMBER])
    return eo_error_set(error, EO_ERROR_INPUT, NULL,
                        "Line %d of the table: in a table of the whole pair a column member says pinion or gear.",
                        reading->line);
  next_line(reading);
  return EO_OK;
}

static enum eo_code read_number(const struct reading *reading, char *cell, double *number, struct eo_error *error)
{
  char *rest;
  for (char *c = cell; reading->decimal_comma && *c; c++)
    *c = *c == ',' ? '.' : *c;
  *number = strtod(cell, &rest);
  return rest == cell || *rest || !isfinite(*number) ? refuse(reading, error, "is not a number.", cell) : EO_OK;
}

static enum eo_code read_word(const struct reading *reading, const char *cell, const char *const word[2], int *index,
                              struct eo_error *error)
{
  char what[MOST_CELL];
  snprintf(what, sizeof what, "is neither %s nor %s.", word[0], word[1]);
  *index = strcmp(cell, word[1]) == 0;
  return *index || strcmp(cell, word[0]) == 0 ? EO_OK : refuse(reading, error, what, cell);
}

/* Decimals that are not 0 of a number with a point. */
static int decimals_of(const char *cell)
{
  const char *point = strchr(cell, '.'), *exponent = strpbrk(cell, "eE");
  int decimals = 0;
  for (int i = 1; point && isdigit((unsigned char)point[i]); i++)
    decimals = point[i] == '0' ? decimals : i;
  return decimals - (exponent ? (int)strtol(exponent + 1, NULL, 10) : 0);
}

/* One row: its numbers, the tooth and the flank they belong to. */
static enum eo_code read_row(struct reading *reading, struct eo_error *error)
{
  static const char *const *const words[3] = {eo_member_name, eo_end_name, eo_flank_side_name};
  char cell[MOST_CELL];
  double number[HEADINGS] = {0};
  int place[3] = {0}, i = 0, decimals = 0;
  for (; i < reading->columns && next_cell(reading, cell); i++) {
    enum heading heading = reading->heading[i];
    EO_TRY(heading >= MEMBER ? read_word(reading, cell, words[heading - MEMBER], &place[heading - MEMBER], error)
                             : read_number(reading, cell, &number[heading], error));
    decimals = heading == SINGLE ? decimals_of(cell) : decimals;
  }
  if (i < reading->columns || next_cell(reading, cell))
    return eo_error_set(error, EO_ERROR_INPUT, NULL, "Line %d of the table does not have %d cells as the headings do.",
                        reading->line, reading->columns);
  int tooth = (int)number[TOOTH], flank = 4 * place[0] + 2 * place[1] + place[2];
  if (number[TOOTH] != tooth || tooth < 0 || tooth > MOST_TEETH)
    return eo_error_set(error, EO_ERROR_INPUT, NULL, "Line %d of the table: %g is not the number of a tooth.",
                        reading->line, number[TOOTH]);
  if (*value_of(reading, flank, TOOTH, tooth) == tooth)
    return eo_error_set(error, EO_ERROR_INPUT, NULL, "Line %d of the table: tooth %d of this flank is there already.",
                        reading->line, tooth);
  for (int heading = 0; heading < MEMBER; heading++)
    *value_of(reading, flank, heading, tooth) = number[heading];
  reading->least[flank] = reading->line_of[flank] == 0 || tooth < reading->least[flank] ? tooth : reading->least[flank];
  reading->most[flank] = tooth > reading->most[flank] ? tooth : reading->most[flank];
  reading->line_of[flank] = reading->line;
  reading->decimals[flank] = decimals > reading->decimals[flank] ? decimals : reading->decimals[flank];
  next_line(reading);
  return EO_OK;
}

/* The object under a key, made where it is missing. */
static json_t *reach(json_t *object, const char *key)
{
  if (!json_object_get(object, key))
    json_object_set_new(object, key, json_object());
  return json_object_get(object, key);
}

/* Of a table that tells flanks apart; "" where all have the same rows. */
static void say_whose(bool whole, int flank, char whose[60])
{
  *whose = '\0';
  if (whole)
    snprintf(whose, 60, " of the %s, %s end, %s flank,", eo_member_name[flank / 4], eo_end_name[flank / 2 % 2],
             eo_flank_side_name[flank % 2]);
}

/* f_i = F_i - F_i-1 adds up to 0 round a gear, but for the rounding of the numbers: of each evenly within half of its
   last place, four times the spread of their sum at most; and of numbers that were computed on, a five-hundredth of
   what unrelated ones add up to. */
static enum eo_code check_closed(const struct reading *reading, bool whole, int flank, struct eo_error *error)
{
  static const double SPREADS = 4, CLOSED = 0.002;
  char whose[60];
  double sum = 0, squares = 0, teeth = reading->most[flank] - reading->least[flank] + 1;
  for (int tooth = reading->least[flank]; tooth <= reading->most[flank]; tooth++) {
    double single = *value_of(reading, flank, SINGLE, tooth);
    sum += single;
    squares += single * single;
  }
  double rounding = pow(10, -reading->decimals[flank]) * fmin(SPREADS * sqrt(teeth / 12), teeth / 2);
  if (fabs(sum) <= fmax(rounding, CLOSED * sqrt(squares)))
    return EO_OK;
  say_whose(whole, flank, whose);
  return eo_error_set(
      error, EO_ERROR_INPUT, NULL,
      "The single pitch deviations (single_um)%s add up to %.4g um over %g teeth; round a gear they add "
      "up to 0, that of the first tooth against the last included. If they are index deviations, name "
      "the column index_um.",
      whose, sum, teeth);
}

/* The arrays of one flank; single pitch deviations add up to index deviations, tooth 0 having 0. */
static enum eo_code put_flank(const struct reading *reading, bool whole, int flank, json_t *object,
                              struct eo_error *error)
{
  int first = reading->least[flank];
  char whose[60];
  say_whose(whole, flank, whose);
  for (int tooth = first; tooth <= reading->most[flank]; tooth++)
    if (*value_of(reading, flank, TOOTH, tooth) != tooth)
      return eo_error_set(error, EO_ERROR_INPUT, NULL, "The table%s leaves out tooth %d (its last row is line %d).",
                          whose, tooth, reading->line_of[flank]);
  if (first > 1)
    return eo_error_set(error, EO_ERROR_INPUT, NULL,
                        "The table%s begins with tooth %d: teeth are counted from 0 or from 1.", whose, first);
  if (reading->has[SINGLE])
    EO_TRY(check_closed(reading, whole, flank, error));
  for (int heading = INDEX; heading <= LEAD_CROWNING; heading++) {
    json_t *row = reading->has[heading] ? json_array() : NULL;
    double sum = 0;
    for (int tooth = first; row && tooth <= reading->most[flank]; tooth++) {
      double value = *value_of(reading, flank, heading, tooth);
      sum += tooth > first ? value : 0;
      json_array_append_new(row, json_real(heading == SINGLE ? sum : value));
    }
    if (row && json_object_set_new(object, heading_name[heading == SINGLE ? INDEX : heading], row) != 0)
      return eo_error_memory(error);
  }
  return EO_OK;
}

static enum eo_code put_all(const struct reading *reading, bool whole, json_t *object, struct eo_error *error)
{
  for (int flank = 0; flank < FLANKS; flank++) {
    json_t *place = object;
    if (reading->line_of[flank] == 0)
      continue;
    if (whole) {
      place = reach(reach(object, eo_member_name[flank / 4]), eo_end_name[flank / 2 % 2]);
      place = flank % 2 ? reach(place, "coast") : place;
    }
    EO_TRY(put_flank(reading, whole, flank, place, error));
  }
  return EO_OK;
}

static enum eo_code read_all(struct reading *reading, bool whole, json_t *object, struct eo_error *error)
{
  skip_remarks(reading);
  EO_TRY(read_headings(reading, whole, error));
  skip_remarks(reading);
  if (!*reading->at)
    return eo_error_set(error, EO_ERROR_INPUT, NULL, "The table has headings and not one tooth below them.");
  for (; *reading->at; skip_remarks(reading))
    EO_TRY(read_row(reading, error));
  return put_all(reading, whole, object, error);
}

enum eo_code eo_pitch_from_text(const char *text, bool whole, json_t *object, struct eo_error *error)
{
  struct reading reading = {.at = text,
                            .line = 1,
                            .separator = strchr(text, ';')    ? ';'
                                         : strchr(text, '\t') ? '\t'
                                                              : ','};
  size_t count = (size_t)FLANKS * HEADINGS * (MOST_TEETH + 1);
  reading.decimal_comma = reading.separator != ',' && !strchr(text, '.');
  reading.value = malloc(sizeof *reading.value * count);
  if (!reading.value)
    return eo_error_memory(error);
  for (size_t i = 0; i < count; i++)
    reading.value[i] = NAN;
  enum eo_code code = read_all(&reading, whole, object, error);
  free(reading.value);
  return code;
}
