/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dates and times of day as loggers, spreadsheets and tools write them. Internal to the readers. */
#ifndef EASEOFF_RECORDING_MOMENT_H
#define EASEOFF_RECORDING_MOMENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct eo_moment {
  bool has_day, has_time;
  bool minutes;   /* of the hour only: the times start again after an hour */
  int64_t day;    /* since 1970-01-01 */
  double seconds; /* since midnight, or of a duration; may be beyond a day */
};

#define EO_MOMENT_DAY 86400.0 /* s */
#define EO_MOMENT_STAMP 19    /* digits at most of a whole number that is a moment */

/* Reads the whole text: "2024-03-05T08:59:59.5Z" (also +01:00, a blank for T, slashes for hyphens), "05.03.2024
   08:59:59,5", "3/5/2024 8:59:59 AM" (month first unless that is impossible), "05-Mar-2024 08:59:59", either half
   alone, "59:59.5" (minutes and seconds), "0 days 00:00:01", "1700000000000042244" (nanoseconds since 1970; tenths of a
   microsecond since 1601 or year 1), "2024-065T08:59:59.5", "2024:065:08:59:59.5" (day of the year), "PT1.25S". False
   when it is none of these. */
bool eo_moment_read(const char *text, size_t length, struct eo_moment *moment);

/* Nanoseconds since 1970 of a moment that has a day. */
int64_t eo_moment_epoch(const struct eo_moment *moment);

/* Days from 1970-01-01 to a date of the Gregorian calendar. */
int64_t eo_moment_day(int64_t year, int month, int day);

#endif
