/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_turns.h"
#include "recording/column.h"
#include "recording/letters.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY 96

/* The key as it stands in its cell, else with what is before it in the line. */
struct eo_stated eo_header_fact(const char *from, const char *number, double value, const char *unit)
{
  char key[KEY], cell[KEY];
  eo_header_trim(key, sizeof key, from, number);
  const char *cut = key;
  for (const char *p = key; *p; p++)
    if (strchr(";\t|,", *p))
      cut = p + 1;
  eo_header_trim(cell, sizeof cell, cut, key + strlen(key));
  struct eo_stated stated = eo_stated_read(cell, value, unit);
  return stated.kind || cut == key ? stated : eo_stated_read(key, value, unit);
}

/* True when the number in the key is that of a column; "t0" has none. */
static bool is_numbered(const struct eo_text_format *format, const struct eo_stated *stated)
{
  if (stated->number < 0 || (stated->kind != EO_STATED_TURN && stated->kind != EO_STATED_FOLD))
    return false;
  for (int c = 0; c < format->cells; c++)
    if (eo_stated_number(format->name[c]) == stated->number)
      return true;
  return false;
}

bool eo_header_means(const struct eo_text_format *format, const struct eo_stated *stated, int column)
{
  int member = eo_stated_member(format->name[column]);
  if (is_numbered(format, stated))
    return eo_stated_number(format->name[column]) == stated->number;
  return stated->member < 0 || member < 0 || member == stated->member;
}

/* "(pinion)" behind the number; -1: nobody's. */
static int member_behind(const struct eo_header_number *number)
{
  char words[KEY];
  const char *open = memchr(number->after, '(', (size_t)(number->behind - number->after));
  if (!open)
    return -1;
  eo_header_trim(words, sizeof words, open + 1, number->behind);
  return eo_stated_member(words);
}

/* Where the key of a number ends: before the mark that it multiplies, too. */
static const char *key_end(const struct eo_header_number *number)
{
  for (ptrdiff_t i = 1; i < 3 && number->at - i >= number->from; i++)
    if (eo_header_times(number->at - i, number->after) == (size_t)i)
      return number->at - i;
  return number->at;
}

/* "x4", "(4x)", "4-fold" behind lines per turn. */
static bool multiplies(const struct eo_header_number *number)
{
  return key_end(number) < number->at ||
         eo_letters_listed(number->unit, strcspn(number->unit, " "), "x|fach|fold|times");
}

/* Numbers of a list are of one kind: with the same unit, or with none but at one of them. */
static bool is_like(const struct eo_header_number *before, const struct eo_header_number *number)
{
  double factor;
  return !*number->unit || !strcmp(before->unit, number->unit) || member_behind(number) >= 0 ||
         (!*before->unit && (eo_unit_find(number->unit, &factor) == EO_QUANTITY_COUNT ||
                             eo_stated_read("encoder", number->value, number->unit).kind == EO_STATED_TURN));
}

/* Commas and the like that part the cells of the rows part no list, but behind a key with a colon; before a unit that
   makes counts per turn of the number before as well, only a slash or a word does: "512/2048 PPR". */
static bool goes_on(const struct eo_turns *turns, const struct eo_text_format *format,
                    const struct eo_header_number *number)
{
  const struct eo_header_number *before = &turns->before;
  if (!before->at || !is_like(before, number))
    return false;
  const char *key = turns->count ? turns->from : before->from, *first = turns->count ? turns->first : before->at;
  size_t gap = (size_t)(number->at - before->after), words = (size_t)(first - key);
  if (turns->stated.kind != EO_STATED_TURN && memchr(before->after, ',', gap))
    return false;
  if (!memchr(key, ':', words) && !memchr(key, '=', words) && memchr(before->after, format->separator, gap))
    return false;
  return eo_header_list_gap(before->after, number->at) || eo_header_list_gap(before->behind, number->at);
}

/* One more number of a list, read with the key of the first; EO_STATED_NOTHING: it is none. */
static struct eo_stated next_of_list(struct eo_turns *turns, const struct eo_text_format *format,
                                     const struct eo_header_number *number)
{
  const struct eo_header_number *before = &turns->before;
  const char *from = turns->count ? turns->from : before->from, *first = turns->count ? turns->first : before->at,
             *unit = *number->unit ? number->unit : before->unit;
  struct eo_stated stated = eo_header_fact(from, first, number->value, unit);
  if (stated.kind != EO_STATED_TURN || stated.member >= 0 || is_numbered(format, &stated))
    return (struct eo_stated){.member = -1, .number = -1};
  stated.member = member_behind(number);
  if (stated.member >= 0)
    return stated;
  if (!turns->count) {
    turns->turn[turns->count++] = eo_header_fact(from, first, before->value, unit).value;
    turns->from = from;
    turns->first = first;
  }
  if (turns->count < EO_TURNS)
    turns->turn[turns->count++] = stated.value;
  turns->end = number->behind;
  return stated;
}

/* What the number itself states by the words around it. */
static struct eo_stated state_alone(const struct eo_text_format *format, const struct eo_header_number *number,
                                    const char *end)
{
  double grouped;
  int groups;
  struct eo_stated stated = eo_header_fact(number->from, key_end(number), number->value, number->unit);
  if (stated.kind == EO_STATED_SCALE && *number->unit) /* "Scale: 0.0001 deg/LSB"; no cell is scaled here */
    stated = eo_stated_read("", number->value, number->unit);
  if (!stated.kind && !eo_stated_keeps(number->unit))
    stated = eo_header_fact(number->from, key_end(number), number->value, "");
  if (stated.kind != EO_STATED_TURN)
    return stated;
  if (stated.member < 0)
    stated.member = member_behind(number);
  if (format->point == ',' && stated.value == number->value && /* no count per turn has three decimals */
      eo_text_grouped(number->at, end, ',', &groups, &grouped) == number->after)
    stated.value = grouped;
  return stated;
}

/* "1 count = 0.0001 deg": the number before the mark states nothing. */
static bool is_one_of_unit(const struct eo_header_number *number, const char *end)
{
  double factor;
  const char *p = number->behind;
  while (p < end && *p == ' ')
    p++;
  return number->value == 1 && p < end && *p == '=' && eo_unit_find(number->unit, &factor) == EO_QUANTITY_COUNT;
}

struct eo_stated eo_turns_state(struct eo_turns *turns, const struct eo_text_format *format,
                                const struct eo_header_number *number, const char *end)
{
  struct eo_stated stated = {.member = -1, .number = -1};
  bool lines = turns->stated.kind == EO_STATED_TURN && turns->stated.lines;
  if (is_one_of_unit(number, end))
    return stated;
  if (lines && multiplies(number))
    stated = (struct eo_stated){.kind = EO_STATED_FOLD, .value = number->value, .member = -1, .number = -1};
  else if (goes_on(turns, format, number))
    stated = next_of_list(turns, format, number);
  if (!stated.kind)
    stated = state_alone(format, number, end);
  if (stated.kind == EO_STATED_FOLD && lines && stated.member < 0)
    stated.member = turns->stated.member, stated.number = turns->stated.number;
  if (stated.kind == EO_STATED_TURN)
    turns->stated = stated;
  turns->before = *number;
  return stated;
}

bool eo_turns_known(const struct eo_text_format *format, int column)
{
  return format->turn[column] > 0 || format->lines[column] > 0;
}

/* Up to four of each line are its edges. */
static double *folds_of(struct eo_text_format *format, const struct eo_stated *stated)
{
  return stated->value <= 4 ? format->edges : format->fold;
}

void eo_turns_set(struct eo_text_format *format, int column, const struct eo_stated *stated)
{
  if (stated->kind == EO_STATED_FOLD) {
    folds_of(format, stated)[column] = stated->value;
    return;
  }
  *(stated->lines ? &format->lines[column] : &format->turn[column]) = stated->value;
  format->vague[column] = stated->lines ? format->vague[column] : stated->vague;
}

/* What multiplies goes to lines that were stated before and that nothing multiplies yet; else to all that are meant. */
static void use_fold(struct eo_text_format *format, const struct eo_stated *stated)
{
  const double *folds = folds_of(format, stated);
  bool known = false, lacking = false;
  for (int c = 0; c < format->cells; c++) {
    bool turn = eo_header_means(format, stated, c) && eo_turns_known(format, c);
    known = known || turn;
    lacking = lacking || (turn && !(folds[c] > 0));
  }
  for (int c = 0; c < format->cells; c++)
    if (eo_header_means(format, stated, c) && (!known || eo_turns_known(format, c)) && (!lacking || !(folds[c] > 0)))
      eo_turns_set(format, c, stated);
}

void eo_turns_use(struct eo_text_format *format, const struct eo_stated *stated)
{
  if (stated->kind == EO_STATED_FOLD)
    use_fold(format, stated);
  for (int c = 0; c < format->cells && stated->kind == EO_STATED_TURN; c++) {
    bool told = stated->lines ? format->lines[c] > 0 : format->turn[c] > 0 && (stated->vague || !format->vague[c]);
    if (eo_header_means(format, stated, c) && !told)
      eo_turns_set(format, c, stated);
  }
}

/* Whose name stands first in the words; -1: nobody's. */
static int first_named(const char *from, const char *end)
{
  int member = -1;
  for (const char *p = from; p < end && member < 0;) {
    char word[32];
    const char *last = p;
    while (last < end && !strchr(" /,:;()|&", *last))
      last++;
    snprintf(word, sizeof word, "%.*s", (int)(last - p < 31 ? last - p : 31), p);
    member = eo_stated_member(word);
    p = last + 1;
  }
  return member;
}

/* The column of each number of the list in its order, -1: they cannot be told. *whose: it is by whose they are. */
static bool places_of(const struct eo_turns *turns, const struct eo_text_format *format, int place[EO_TURNS],
                      bool *whose)
{
  int column[2] = {-1, -1}, count = 0;
  for (int c = format->cells - 1; c >= 0; c--)
    if (eo_stated_member(format->name[c]) >= 0)
      column[eo_stated_member(format->name[c])] = c;
  *whose = column[0] >= 0 && column[1] >= 0;
  if (*whose) {
    int first = first_named(turns->from, turns->first);
    place[0] = column[first > 0], place[1] = column[!(first > 0)];
    return turns->count == 2 && (first >= 0 || column[0] < column[1]);
  }
  for (int c = 0; c < format->cells; c++)
    if (!eo_text_is_called_time(format, c) && count++ < turns->count)
      place[count - 1] = c;
  return count == turns->count;
}

void eo_turns_end(const struct eo_turns *turns, struct eo_text_format *format)
{
  int place[EO_TURNS];
  bool whose;
  if (turns->count < 2)
    return;
  bool known = places_of(turns, format, place, &whose);
  for (int c = 0; c < format->cells; c++) {
    int member = whose ? eo_stated_member(format->name[c]) : -1;
    format->turn[c] = format->lines[c] = 0;
    for (int i = 0; known && i < turns->count; i++)
      if (c == place[i] || (whose && member >= 0 && member == eo_stated_member(format->name[place[i]])))
        *(turns->stated.lines ? &format->lines[c] : &format->turn[c]) = turns->turn[i];
  }
  char text[96];
  eo_header_trim(text, sizeof text, turns->from, turns->end);
  snprintf(format->listed, sizeof format->listed,
           !known  ? "\"%s\" does not say which of its counts per turn is whose."
           : whose ? "\"%s\" is read as the counts per turn of the %s, then of the %s."
                   : "\"%s\" is read as the counts per turn of the columns in their order.",
           text, whose && known && eo_stated_member(format->name[place[0]]) ? "gear" : "pinion",
           whose && known && eo_stated_member(format->name[place[0]]) ? "pinion" : "gear");
}

void eo_turns_of_name(struct eo_text_format *format, int column, const struct eo_cell *cell)
{
  struct eo_header_number number = {.from = cell->text};
  const char *end = cell->text + cell->length;
  for (const char *p = cell->text; p < end; p++) {
    if (!isdigit((unsigned char)*p) || (p > cell->text && !strchr(" ([,;=:/_{<", p[-1])))
      continue;
    number.at = p;
    number.after = eo_header_number_at(format, p, end, true, &number.value);
    if (!number.after || number.after > end)
      return;
    eo_header_unit(number.after, end, number.unit, sizeof number.unit);
    struct eo_stated stated = eo_header_fact(number.from, p, number.value, number.unit);
    if (stated.kind == EO_STATED_TURN && stated.value >= 16)
      eo_turns_set(format, column, &stated);
    p = number.after - 1;
  }
}

/* True for a column of whole numbers that are no times and no tracks: what multiplies lines shows in them. */
static bool counts(const struct eo_text_format *format, int column, const char *row)
{
  struct eo_cell cell = {0};
  double factor;
  const char *at = row, *end = strchr(row, format->line_end);
  end = end ? end : row + strlen(row);
  if (eo_text_is_called_time(format, column) || eo_column_named(format->name[column], "sin|cos|sine|cosine"))
    return false;
  if (*format->unit[column])
    return eo_unit_find(format->unit[column], &factor) == EO_QUANTITY_COUNT;
  for (int c = 0; c <= column; c++)
    if (!eo_text_next_cell(&at, end, format->separator, &cell))
      return false;
  return cell.length && strspn(cell.text, "-0123456789") >= cell.length;
}

/* Counters that take as many edges of every encoder's lines. */
static bool same_edges(const struct eo_text_format *format, const char *row)
{
  double edges = -1;
  for (int c = 0; c < format->cells; c++)
    if (format->lines[c] > 0 && !(format->turn[c] > 0) && counts(format, c, row)) {
      if (edges >= 0 && edges != fmax(format->edges[c], 1))
        return false;
      edges = fmax(format->edges[c], 1);
    }
  return true;
}

void eo_turns_settle(struct eo_text_format *format, const char *head)
{
  const char *row = head + format->first_byte;
  bool same = same_edges(format, row);
  for (int c = 0; c < format->cells; c++) {
    bool counting = counts(format, c, row), told = format->turn[c] > 0;
    double fold = fmax(format->fold[c], 1) * (same ? 1 : fmax(format->edges[c], 1));
    format->fold[c] = counting && !told && format->lines[c] > 0 ? fold : 0;
    if (format->lines[c] > 0 && (!counting || !told))
      format->turn[c] = format->lines[c] * fmax(format->fold[c], 1);
  }
}

void eo_turns_note(const struct eo_text_format *format, struct eo_notes *notes)
{
  if (*format->listed)
    eo_notes_add(notes, "%s", format->listed);
  for (int c = 0; c < format->cells; c++)
    if (format->fold[c] > 1)
      eo_notes_add(notes, "The file states %.9g lines per turn for \"%s\" and %.9g counts for each.", format->lines[c],
                   format->name[c], format->fold[c]);
}
