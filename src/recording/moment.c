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

static void skip_blanks(struct rest *r)
{
  while (r->at < r->end && *r->at == ' ')
    r->at++;
}

static bool take(struct rest *r, char c)
{
  bool there = r->at < r->end && *r->at == c;
  r->at += there;
  return there;
}

/* Up to `most` digits; returns how many there were. */
static int take_number(struct rest *r, int most, int *number)
{
  int digits = 0;
  *number = 0;
  while (digits < most && r->at < r->end && isdigit((unsigned char)*r->at)) {
    *number = *number * 10 + (*r->at++ - '0');
    digits++;
  }
  return digits;
}

/* An English or German name of a month, by its first three letters. */
static bool take_month(struct rest *r, int *month)
{
  static const char names[][4] = {"jan", "feb", "mar", "apr", "may", "jun", "jul", "aug",
                                  "sep", "oct", "nov", "dec", "mrz", "mai", "okt", "dez"};
  static const int number[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 3, 5, 10, 12};
  if (r->end - r->at < 3)
    return false;
  for (size_t i = 0; i < sizeof number / sizeof *number; i++)
    if (!strncasecmp(r->at, names[i], 3)) {
      *month = number[i];
      while (r->at < r->end && isalpha((unsigned char)*r->at))
        r->at++;
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
static bool take_date(struct rest *r, struct eo_moment *m)
{
  struct rest start = *r;
  int part[3], digits[3];
  digits[0] = take_number(r, 4, &part[0]);
  char separator = r->at < r->end ? *r->at : '\0';
  if (!digits[0] || !separator || !strchr("-./ ", separator))
    goto none;
  r->at++;
  bool named = take_month(r, &part[1]);
  digits[1] = named ? 2 : take_number(r, 2, &part[1]);
  if (!digits[1] || (separator == ' ' && !named) || !take(r, separator))
    goto none;
  digits[2] = take_number(r, 4, &part[2]);
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
  m->has_day = true;
  m->day = eo_moment_day(year, month, day);
  return true;
none:
  *r = start;
  return false;
}

/* ".5" or ",5"; a colon before thousandths is also in use. */
static double take_fraction(struct rest *r, bool *there)
{
  struct rest start = *r;
  if (!take(r, '.') && !take(r, ',') && !take(r, ':'))
    return 0;
  if (r->at >= r->end || !isdigit((unsigned char)*r->at)) {
    *r = start;
    return 0;
  }
  int64_t digits = 0, number = 0;
  for (; r->at < r->end && isdigit((unsigned char)*r->at); r->at++)
    if (digits < 15) {
      number = number * 10 + (*r->at - '0');
      digits++;
    }
  *there = true;
  return (double)number / pow(10, (double)digits);
}

/* AM and PM; 12 AM is midnight. */
static bool take_half(struct rest *r, int *hour)
{
  skip_blanks(r);
  if (r->end - r->at < 2 || (r->at[1] | 0x20) != 'm' || !strchr("aApP", r->at[0]))
    return true;
  if (*hour < 1 || *hour > 12)
    return false;
  *hour = *hour % 12 + ((r->at[0] | 0x20) == 'p' ? 12 : 0);
  r->at += 2;
  return true;
}

/* "Z" or "+01:00": the time is brought to that of Greenwich. */
static bool take_zone(struct rest *r, struct eo_moment *m)
{
  int hours, minutes = 0;
  skip_blanks(r);
  if (take(r, 'Z') || take(r, 'z'))
    return true;
  if (r->end - r->at >= 3 && (!strncmp(r->at, "UTC", 3) || !strncmp(r->at, "GMT", 3)))
    r->at += 3;
  if (r->at >= r->end || (*r->at != '+' && *r->at != '-'))
    return true;
  double sign = *r->at++ == '-' ? 1 : -1;
  if (take_number(r, 2, &hours) != 2)
    return false;
  take(r, ':');
  take_number(r, 2, &minutes);
  m->seconds += sign * (hours * 3600.0 + minutes * 60.0);
  return true;
}

static bool take_time(struct rest *r, struct eo_moment *m)
{
  struct rest start = *r;
  int part[3] = {0}, parts = 0, digits = 0;
  bool fraction = false;
  do {
    digits = take_number(r, 3, &part[parts]);
    if (!digits)
      break;
    parts++;
  } while (parts < 3 && take(r, ':'));
  double rest = parts == 3 || (parts == 2 && r->at < r->end && *r->at != ':') ? take_fraction(r, &fraction) : 0;
  bool minutes = parts == 2 && fraction;
  int hour = minutes ? 0 : part[0], minute = minutes ? part[0] : part[1], second = minutes ? part[1] : part[2];
  if (parts < 2 || !digits || minute > 59 || second > 60 || !take_half(r, &hour) || (hour > 23 && m->has_day)) {
    *r = start;
    return false;
  }
  m->has_time = true;
  m->minutes = minutes;
  m->seconds += hour * 3600.0 + minute * 60.0 + second + rest;
  return take_zone(r, m);
}

/* "0 days 00:00:00.00025", as tables of time differences are written. */
static void take_days(struct rest *r, struct eo_moment *m)
{
  struct rest start = *r;
  int days;
  bool counted = take_number(r, 4, &days) > 0;
  skip_blanks(r);
  if (!counted || r->end - r->at < 4 || strncasecmp(r->at, "day", 3)) {
    *r = start;
    return;
  }
  r->at += 3;
  take(r, 's');
  m->seconds = days * EO_MOMENT_DAY;
  skip_blanks(r);
}

bool eo_moment_read(const char *text, size_t length, struct eo_moment *moment)
{
  struct rest r = {text, text + length};
  *moment = (struct eo_moment){0};
  skip_blanks(&r);
  take_days(&r, moment);
  if (take_date(&r, moment)) {
    skip_blanks(&r);
    if (r.at < r.end && (*r.at == 'T' || *r.at == 't' || *r.at == ','))
      r.at++;
    skip_blanks(&r);
    if (r.at < r.end && !take_time(&r, moment))
      return false;
  } else if (!take_time(&r, moment))
    return false;
  skip_blanks(&r);
  return r.at == r.end;
}
