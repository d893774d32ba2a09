/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/moment.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

/* What is left of the text. */
struct rest {
  const char *at, *end;
};

int64_t eo_moment_day(int64_t year, int month, int day)
{
  /* Years begin in March, so that the leap day is their last; 400 of them have 146097 days. */
  year -= month <= 2;
  int64_t era = (year >= 0 ? year : year - 399) / 400, of_era = year - era * 400;
  int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

int64_t eo_moment_epoch(const struct eo_moment *moment)
{
  return moment->day * 86400000000000LL + llround(moment->seconds * 1e9);
}

static void skip_blanks(struct rest *rest)
{
  while (rest->at < rest->end && *rest->at == ' ')
    rest->at++;
}

static bool take(struct rest *rest, char c)
{
  bool there = rest->at < rest->end && *rest->at == c;
  rest->at += there;
  return there;
}

/* Up to `most` digits; returns how many there were. */
static int take_number(struct rest *rest, int most, int *number)
{
  int digits = 0;
  *number = 0;
  while (digits < most && rest->at < rest->end && isdigit((unsigned char)*rest->at)) {
    *number = *number * 10 + (*rest->at++ - '0');
    digits++;
  }
  return digits;
}

/* An English or German name of a month, by its first three letters. */
static bool take_month(struct rest *rest, int *month)
{
  static const char names[][4] = {"jan", "feb", "mar", "apr", "may", "jun", "jul", "aug",
                                  "sep", "oct", "nov", "dec", "mrz", "mai", "okt", "dez"};
  static const int number[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 3, 5, 10, 12};
  if (rest->end - rest->at < 3)
    return false;
  for (size_t i = 0; i < sizeof number / sizeof *number; i++)
    if (!strncasecmp(rest->at, names[i], 3)) {
      *month = number[i];
      while (rest->at < rest->end && isalpha((unsigned char)*rest->at))
        rest->at++;
      return true;
    }
  return false;
}

static bool is_date(int year, int month, int day)
{
  static const int days[] = {31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return year >= 1900 && year < 2200 && month >= 1 && month <= 12 && day >= 1 && day <= days[month - 1];
}

/* Years of two digits are those from 1970 to 2069. */
static int whole_year(int year, int digits)
{
  return digits == 2 ? year + (year < 70 ? 2000 : 1900) : year;
}

/* Year, month, day; or day and month in the order that the separator is used with. */
static bool take_date(struct rest *rest, struct eo_moment *moment)
{
  struct rest start = *rest;
  int part[3], digits[3];
  digits[0] = take_number(rest, 4, &part[0]);
  char separator = rest->at < rest->end ? *rest->at : '\0';
  if (!digits[0] || !separator || !strchr("-./ ", separator))
    goto none;
  rest->at++;
  bool named = take_month(rest, &part[1]);
  digits[1] = named ? 2 : take_number(rest, 2, &part[1]);
  if (!digits[1] || (separator == ' ' && !named) || !take(rest, separator))
    goto none;
  digits[2] = take_number(rest, 4, &part[2]);
  int year, month, day;
  if (digits[0] == 4) {
    year = part[0], month = part[1], day = part[2];
  } else {
    bool month_first = separator == '/' && part[0] <= 12 && !named;
    year = whole_year(part[2], digits[2]);
    month = month_first ? part[0] : part[1];
    day = month_first ? part[1] : part[0];
  }
  if (digits[0] == 3 || digits[2] < (digits[0] == 4 ? 1 : 2) || digits[2] == 3 || !is_date(year, month, day))
    goto none;
  moment->has_day = true;
  moment->day = eo_moment_day(year, month, day);
  return true;
none:
  *rest = start;
  return false;
}

/* ".5" or ",5"; a colon before thousandths is also in use. */
static double take_fraction(struct rest *rest, bool *there)
{
  struct rest start = *rest;
  if (!take(rest, '.') && !take(rest, ',') && !take(rest, ':'))
    return 0;
  if (rest->at >= rest->end || !isdigit((unsigned char)*rest->at)) {
    *rest = start;
    return 0;
  }
  int64_t digits = 0, number = 0;
  for (; rest->at < rest->end && isdigit((unsigned char)*rest->at); rest->at++)
    if (digits < 15) {
      number = number * 10 + (*rest->at - '0');
      digits++;
    }
  *there = true;
  return (double)number / pow(10, (double)digits);
}

/* AM and PM, also "a.m."; 12 AM is midnight. */
static bool take_half(struct rest *rest, int *hour)
{
  skip_blanks(rest);
  const char *at = rest->at, *end = rest->end;
  size_t dots = end - at >= 4 && at[1] == '.' && at[3] == '.' ? 1 : 0;
  if (end - at < 2 || (at[1 + dots] | 0x20) != 'm' || !strchr("aApP", at[0]))
    return true;
  if (*hour < 1 || *hour > 12)
    return false;
  *hour = *hour % 12 + ((at[0] | 0x20) == 'p' ? 12 : 0);
  rest->at += 2 + 2 * dots;
  return true;
}

/* "Z" or "+01:00": the time is brought to that of Greenwich. */
static bool take_zone(struct rest *rest, struct eo_moment *moment)
{
  int hours, minutes = 0;
  skip_blanks(rest);
  if (take(rest, 'Z') || take(rest, 'z'))
    return true;
  if (rest->end - rest->at >= 3 && (!strncmp(rest->at, "UTC", 3) || !strncmp(rest->at, "GMT", 3)))
    rest->at += 3;
  if (rest->at >= rest->end || (*rest->at != '+' && *rest->at != '-'))
    return true;
  double sign = *rest->at++ == '-' ? 1 : -1;
  if (take_number(rest, 2, &hours) != 2)
    return false;
  take(rest, ':');
  take_number(rest, 2, &minutes);
  moment->seconds += sign * (hours * 3600.0 + minutes * 60.0);
  return true;
}

static bool take_time(struct rest *this_rest, struct eo_moment *moment)
{
  struct rest start = *this_rest;
  int part[3] = {0}, parts = 0, digits = 0;
  bool fraction = false;
  do {
    digits = take_number(this_rest, 3, &part[parts]);
    if (!digits)
      break;
    parts++;
  } while (parts < 3 && take(this_rest, ':'));
  double rest = parts == 3 || (parts == 2 && this_rest->at < this_rest->end && *this_rest->at != ':')
                    ? take_fraction(this_rest, &fraction)
                    : 0;
  bool minutes = parts == 2 && fraction;
  int hour = minutes ? 0 : part[0], minute = minutes ? part[0] : part[1], second = minutes ? part[1] : part[2];
  if (parts < 2 || !digits || minute > 59 || second > 60 || !take_half(this_rest, &hour) ||
      (hour > 23 && moment->has_day)) {
    *this_rest = start;
    return false;
  }
  moment->has_time = true;
  moment->minutes = minutes;
  moment->seconds += hour * 3600.0 + minute * 60.0 + second + rest;
  return take_zone(this_rest, moment);
}

/* "0 days 00:00:00.00025", as tables of time differences are written. */
static void take_days(struct rest *rest, struct eo_moment *moment)
{
  struct rest start = *rest;
  int days;
  bool counted = take_number(rest, 4, &days) > 0;
  skip_blanks(rest);
  if (!counted || rest->end - rest->at < 4 || strncasecmp(rest->at, "day", 3)) {
    *rest = start;
    return;
  }
  rest->at += 3;
  take(rest, 's');
  moment->seconds = days * EO_MOMENT_DAY;
  skip_blanks(rest);
}

/* "Mar 04, 2026", after the day of the week or without it. */
static bool take_american(struct rest *rest, struct eo_moment *moment)
{
  struct rest start = *rest;
  int year, month, day;
  bool named = take_month(rest, &month);
  skip_blanks(rest);
  bool counted = named && take_number(rest, 2, &day) > 0;
  take(rest, ',');
  skip_blanks(rest);
  if (!counted || take_number(rest, 4, &year) != 4 || !is_date(year, month, day)) {
    *rest = start;
    return false;
  }
  moment->has_day = true;
  moment->day = eo_moment_day(year, month, day);
  return true;
}

/* "20260304T115959.7" and "20260304115959.7". */
static bool take_compact(struct rest *rest, struct eo_moment *moment)
{
  struct rest start = *rest;
  int year, month, day, hour, minute, second;
  bool date = take_number(rest, 4, &year) == 4 && take_number(rest, 2, &month) == 2 &&
              take_number(rest, 2, &day) == 2 && is_date(year, month, day),
       fraction = false;
  if (date && !take(rest, 'T') && !take(rest, '_'))
    take(rest, '-');
  date = date && take_number(rest, 2, &hour) == 2 && take_number(rest, 2, &minute) == 2 &&
         take_number(rest, 2, &second) == 2 && hour < 24 && minute < 60 && second < 61;
  if (!date) {
    *rest = start;
    return false;
  }
  *moment = (struct eo_moment){.has_day = true, .has_time = true, .day = eo_moment_day(year, month, day)};
  moment->seconds = hour * 3600.0 + minute * 60.0 + second + take_fraction(rest, &fraction);
  return take_zone(rest, moment);
}

/* Nanoseconds since 1970, or tenths of a microsecond since 1601 or year 1, which are too long for a double. */
static bool take_stamp(struct rest *rest, struct eo_moment *moment)
{
  static const struct {
    uint64_t low, high, zero, unit; /* zero: 1970 in its unit; unit: ns */
  } kinds[] = {{1000000000000000000, 2200000000000000000, 0, 1},
               {120000000000000000, 150000000000000000, 116444736000000000, 100},
               {620000000000000000, 660000000000000000, 621355968000000000, 100}};
  const uint64_t day = 86400000000000; /* ns */
  uint64_t number = 0;
  const char *at = rest->at;
  for (int digits = 0; at < rest->end && isdigit((unsigned char)*at) && digits < EO_MOMENT_STAMP; digits++)
    number = number * 10 + (uint64_t)(*at++ - '0');
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds && at == rest->end; i++)
    if (number > kinds[i].low && number < kinds[i].high) {
      number = (number - kinds[i].zero) * kinds[i].unit;
      rest->at = at;
      *moment = (struct eo_moment){
          .has_day = true, .has_time = true, .day = (int64_t)(number / day), .seconds = (double)(number % day) * 1e-9};
      return true;
    }
  return false;
}

/* "2026-123T10:00:00", "2026:123:10:00:00": year, day of the year and time. */
static bool take_ordinal(struct rest *rest, struct eo_moment *moment)
{
  struct rest start = *rest;
  struct eo_moment found = {.has_day = true};
  int year, day;
  bool leads = take_number(rest, 4, &year) == 4 && (take(rest, '-') || take(rest, ':') || take(rest, '/')) &&
               take_number(rest, 3, &day) == 3 && is_date(year, 1, 1) && day > 0 &&
               eo_moment_day(year, 1, 1) + day <= eo_moment_day(year + 1, 1, 1) && rest->at < rest->end &&
               strchr("T: -", *rest->at++);
  if (!leads || !take_time(rest, &found)) {
    *rest = start;
    return false;
  }
  found.day = eo_moment_day(year, 1, 1) + day - 1;
  *moment = found;
  return true;
}

/* "PT1.25S", "P0DT0H1M2.5S": a duration of ISO 8601; months and years of it have no length. */
static bool take_duration(struct rest *rest, struct eo_moment *moment)
{
  static const char marks[] = "DHMS";
  static const double seconds[] = {EO_MOMENT_DAY, 3600, 60, 1};
  struct rest start = *rest;
  double sum = 0;
  int number, next = 0;
  bool fraction = false;
  if (!take(rest, 'P'))
    return false;
  bool timed = take(rest, 'T');
  while (!fraction && take_number(rest, 9, &number) > 0) {
    double value = number + take_fraction(rest, &fraction);
    const char *mark = rest->at < rest->end && *rest->at ? strchr(marks, *rest->at) : NULL;
    if (!mark || mark - marks < next || (mark > marks) != timed)
      break;
    next = (int)(mark - marks) + 1;
    sum += value * seconds[mark - marks];
    rest->at++;
    timed = take(rest, 'T') || timed;
  }
  if (!next || rest->at < rest->end) {
    *rest = start;
    return false;
  }
  *moment = (struct eo_moment){.has_time = true, .seconds = sum};
  return true;
}

bool eo_moment_read(const char *text, size_t length, struct eo_moment *moment)
{
  struct rest rest = {text, text + length};
  *moment = (struct eo_moment){0};
  skip_blanks(&rest);
  if (take_stamp(&rest, moment) || take_compact(&rest, moment) || take_ordinal(&rest, moment) ||
      take_duration(&rest, moment))
    return rest.at == rest.end;
  take_days(&rest, moment);
  if (take_date(&rest, moment) || take_american(&rest, moment)) {
    skip_blanks(&rest);
    if (rest.at < rest.end && (*rest.at == 'T' || *rest.at == 't' || *rest.at == ','))
      rest.at++;
    skip_blanks(&rest);
    if (rest.at < rest.end && !take_time(&rest, moment))
      return false;
  } else if (!take_time(&rest, moment))
    return false;
  skip_blanks(&rest);
  return rest.at == rest.end;
}
