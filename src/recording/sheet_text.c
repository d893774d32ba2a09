/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/sheet_text.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define TICKS 864000000000LL /* tenths of a microsecond in a day: what a number of days still resolves */

static int go_to(struct eo_sheet_text *sheet, int column)
{
  if (column < sheet->written || column >= EO_SHEET_COLUMNS)
    return 0;
  for (; sheet->written < column; sheet->written++)
    putc('\t', sheet->file);
  return 1;
}

void eo_sheet_text_cell(struct eo_sheet_text *sheet, int column, const char *text)
{
  if (!go_to(sheet, column))
    return;
  while (*text == ' ')
    text++;
  for (; *text; text++)
    putc(*text == '\t' || *text == '\n' || *text == '\r' ? ' ' : *text, sheet->file);
}

static void print_time(struct eo_sheet_text *sheet, int64_t ticks)
{
  int64_t second = ticks / 10000000;
  char text[64];
  snprintf(text, sizeof text, "%02d:%02d:%02d.%07d", (int)(second / 3600), (int)(second / 60 % 60), (int)(second % 60),
           (int)(ticks % 10000000));
  fputs(text, sheet->file);
}

/* Year, month and day from days since 1970, by years that begin in March. */
static void print_date(struct eo_sheet_text *sheet, int64_t day)
{
  int64_t shifted = day + 719468, era = (shifted >= 0 ? shifted : shifted - 146096) / 146097;
  int64_t of_era = shifted - era * 146097;
  int64_t of_year = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  int64_t rest = of_era - (365 * of_year + of_year / 4 - of_year / 100), month = (5 * rest + 2) / 153;
  int64_t date = rest - (153 * month + 2) / 5 + 1, real = month < 10 ? month + 3 : month - 9;
  char text[64];
  snprintf(text, sizeof text, "%04d-%02d-%02dT", (int)(of_year + era * 400 + (real <= 2)), (int)real, (int)date);
  fputs(text, sheet->file);
}

void eo_sheet_text_moment(struct eo_sheet_text *sheet, int column, double days)
{
  if (!(fabs(days) < 1e6) || !go_to(sheet, column))
    return;
  double whole = floor(days);
  int64_t ticks = llround((days - whole) * (double)TICKS), day = (int64_t)whole + ticks / TICKS;
  print_date(sheet, day);
  print_time(sheet, ticks % TICKS);
}

void eo_sheet_text_time(struct eo_sheet_text *sheet, int column, double days)
{
  if (days >= 0 && days < 1 && go_to(sheet, column))
    print_time(sheet, llround(days * (double)TICKS));
}

void eo_sheet_text_row(struct eo_sheet_text *sheet)
{
  putc('\n', sheet->file);
  sheet->written = 0;
}
