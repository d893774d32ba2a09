/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/stated.h"
#include "recording/column.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY 96

/* The key in lower case with nothing but letters, digits and the slash of "samples/s". */
static void fold(const char *key, char *folded)
{
  size_t n = 0;
  for (; *key && n + 1 < KEY; key++)
    if (isalnum((unsigned char)*key) || *key == '/')
      folded[n++] = (char)tolower((unsigned char)*key);
  folded[n] = '\0';
}

/* True when the key is one of the words before the double bar, or holds one of those behind it. */
static bool matches(const char *key, const char *const *whole, const char *const *part)
{
  for (; *whole; whole++)
    if (!strcmp(key, *whole))
      return true;
  for (; *part; part++)
    if (strstr(key, *part))
      return true;
  return false;
}

static bool is_rate(const char *key)
{
  static const char *const whole[] = {"fs",   "sr",      "rate",      "fsample",       "fsamp",
                                      "fa",   "ratehz",  "samples/s", "samples/sec",   "s/s",
                                      "sa/s", "fabtast", "frequenz",  "samplespersec", NULL};
  static const char *const part[] = {"samplerate",
                                     "samplingrate",
                                     "samplefreq",
                                     "samplingfreq",
                                     "scanrate",
                                     "scanfreq",
                                     "acquisitionrate",
                                     "acqrate",
                                     "datarate",
                                     "daqrate",
                                     "recordingrate",
                                     "recordrate",
                                     "loggingrate",
                                     "lograte",
                                     "lograte",
                                     "abtastrate",
                                     "abtastfreq",
                                     "messrate",
                                     "messfreq",
                                     "speicherrate",
                                     "samplespersec",
                                     "samplesper/",
                                     "samples/s",
                                     "readingspersec",
                                     "scanspersec",
                                     "scans/s",
                                     "pointspersec",
                                     "outputrate",
                                     "updaterate",
                                     "pollrate",
                                     "samplingspeed",
                                     "sampleclk",
                                     "sampleclock",
                                     "samplerates",
                                     "framerate",
                                     "erfassungsrate",
                                     "digitalisierungsrate",
                                     "aufzeichnungsrate",
                                     "ratehz",
                                     "bandrate",
                                     "recordedat",
                                     "sampledat",
                                     "acquiredat",
                                     "loggedat",
                                     "frequenceechantillonnage",
                                     "fsample",
                                     NULL};
  return matches(key, whole, part);
}

static bool is_interval(const char *key)
{
  static const char *const whole[] = {"dt",       "ts",    "deltat",     "deltax",     "dx",         "increment",
                                      "interval", "xincr", "xinc",       "xincrement", "incrementx", "wfincrement",
                                      "tsample",  "tsamp", "period",     "timestep",   "delta",      "intervall",
                                      "xdelta",   "xin",   "step",       "ta",         "abtastung",  "stepsize",
                                      "xstep",    "tinc",  "tincrement", NULL};
  static const char *const part[] = {
      "sampleinterval",   "samplinginterval",  "sampleperiod",    "samplingperiod",     "sampletime",
      "samplingtime",     "samplestep",        "scaninterval",    "scanperiod",         "timeinterval",
      "timeincrement",    "timestep",          "timedelta",       "deltatime",          "acquisitioninterval",
      "recordinterval",   "recordinginterval", "logginginterval", "loginterval",        "updateinterval",
      "abtastinterval",   "abtastzeit",        "abtastperiode",   "abtastschritt",      "zeitschritt",
      "zeitinkrement",    "messintervall",     "messinterval",    "speicherintervall",  "horizontalinterval",
      "horizinterval",    "xincrement",        "wfincrement",     "timeperpoint",       "timepersample",
      "secondspersample", "tasttakt",          "dtsec",           "samplingresolution", NULL};
  return matches(key, whole, part);
}

static bool is_start(const char *key)
{
  static const char *const whole[] = {"x0",         "t0",     "tstart",  "starttime",  "startoffset", "wfstartoffset",
                                      "xzero",      "xstart", "xoffset", "startvalue", "starts",      "offsettime",
                                      "timeoffset", "tzero",  "start",   NULL};
  static const char *const part[] = {"wfstartoffset", NULL};
  return matches(key, whole, part);
}

static bool is_tick(const char *key)
{
  static const char *const whole[] = {"timebase", "clock",     "fclk", "fclock", "tick", "timerclock",
                                      "timer",    "zeitbasis", "clk",  "takt",   "mhz",  NULL};
  static const char *const part[] = {
      "timebasefreq", "timebaserate",    "timebaseclock", "clockfreq",   "clockrate",      "counterclock",
      "counterfreq",  "countertimebase", "timerfreq",     "timerclock",  "timerrate",      "tickrate",
      "tickfreq",     "tickspersec",     "ticks/s",       "ticksper",    "tickduration",   "ticklength",
      "tickperiod",   "ticktime",        "tickinterval",  "taktfreq",    "taktrate",       "timerresolution",
      "timerperiod",  "zaehlertakt",     "zhlertakt",     "clockperiod", "referenceclock", NULL};
  return matches(key, whole, part);
}

static bool is_turn(const char *key)
{
  static const char *const whole[] = {"cpr",           "ppr",
                                      "lpr",           "encoderresolution",
                                      "resolution",    "aufloesung",
                                      "auflsung",      "strichzahl",
                                      "lines",         "pulses",
                                      "striche",       "teethofwheel",
                                      "encoderlines",  "encoderpulses",
                                      "encodercounts", "geberstriche",
                                      "wheelteeth",    NULL};
  static const char *const part[] = {"perrev",
                                     "perturn",
                                     "percycle",
                                     "/rev",
                                     "/turn",
                                     "/umdr",
                                     "/u",
                                     "proumdr",
                                     "prou",
                                     "countsper360",
                                     "encoderresolution",
                                     "geberaufl",
                                     "encoderaufl",
                                     "strichzahl",
                                     "impulszahl",
                                     "encodercpr",
                                     "encoderppr",
                                     "pulsesperrev",
                                     "countsperrev",
                                     "linesperrev",
                                     "polepairs",
                                     NULL};
  return matches(key, whole, part);
}

static bool is_scale(const char *key)
{
  static const char *const whole[] = {"scalefactor",
                                      "scale",
                                      "gain",
                                      "slope",
                                      "factor",
                                      "faktor",
                                      "conversionfactor",
                                      "bitvolts",
                                      "calibration",
                                      "calibrationfactor",
                                      "sensitivityfactor",
                                      "scaling",
                                      "multiplier",
                                      "umrechnungsfaktor",
                                      "lsb",
                                      "resolutionperbit",
                                      NULL};
  static const char *const part[] = {"scalefactor", NULL};
  return matches(key, whole, part);
}

static bool is_offset(const char *key)
{
  static const char *const whole[] = {"addoffset", "offset", "intercept", "bias", "yoffset", "scaleoffset", NULL};
  static const char *const part[] = {"addoffset", NULL};
  return matches(key, whole, part);
}

/* "Pinion counts" and the like say whose it is. */
int eo_stated_member(const char *name)
{
  bool pinion = eo_column_named(name, "pinion|ritzel|input|antrieb|eingang|driver|drive|1"),
       gear = eo_column_named(name, "gear|wheel|rad|output|abtrieb|ausgang|driven|grossrad|2");
  return pinion == gear ? -1 : gear;
}

bool eo_stated_begin(const char *key)
{
  static const char *const whole[] = {"start",    "t0",          "beginn",      "begin", "datetime", "timestamp",
                                      "date",     "datum",       "time",        "zeit",  "uhrzeit",  "created",
                                      "acquired", "wfstarttime", "triggertime", NULL};
  static const char *const part[] = {"starttime",      "startdate",
                                     "startzeit",      "startdatum",
                                     "starttimestamp", "startedat",
                                     "recordingstart", "messbeginn",
                                     "messstart",      "begintime",
                                     "recordedat",     "startat",
                                     "timeofstart",    "startofrecording",
                                     "triggertime",    "acquisitiondate",
                                     "aufnahmebeginn", "recordingdate",
                                     "recordingtime",  "datetime",
                                     "timestamp",      NULL};
  char folded[KEY];
  fold(key, folded);
  return matches(folded, whole, part);
}

static struct eo_stated nothing(void)
{
  return (struct eo_stated){EO_STATED_NOTHING, 0, -1};
}

/* The key without the words that only say whose it is. */
static void strip_owner(const char *key, char *rest, size_t size)
{
  static const char owners[] =
      "pinion|gear|ritzel|rad|wheel|input|output|antrieb|abtrieb|eingang|ausgang|channel|chan|ch|"
      "kanal|encoder|enc|geber|of|the|for|des|der|von|1|2";
  size_t n = 0;
  for (const char *p = key; *p;) {
    char word[KEY];
    size_t length = strcspn(p, " _.-:;,()[]"), used = length < KEY ? length : KEY - 1;
    memcpy(word, p, used);
    word[used] = '\0';
    if (length && !eo_column_named(word, owners) && n + used + 2 < size)
      n += (size_t)snprintf(rest + n, size - n, "%s ", word);
    p += length + (p[length] != '\0');
  }
  rest[n] = '\0';
}

/* "counts/rev" and "pulses per revolution". */
static bool is_turn_unit(const char *unit)
{
  static const char *const none[] = {NULL};
  static const char *const part[] = {"perrev", "perturn", "/rev", "/turn", "/umdr", "proumdr", NULL};
  char folded[KEY];
  fold(unit, folded);
  return matches(folded, none, part);
}

/* What a key of one meaning says; folded: in lower case, its unit taken off. */
static void judge_key(const char *folded, double number, enum eo_quantity quantity, double factor, bool turn_unit,
                      struct eo_stated *stated)
{
  bool positive = number > 0, time = quantity == EO_QUANTITY_TIME, frequency = quantity == EO_QUANTITY_FREQUENCY;
  bool plain = quantity == EO_QUANTITY_NONE || quantity == EO_QUANTITY_OTHER || quantity == EO_QUANTITY_COUNT;
  bool rate = is_rate(folded), interval = is_interval(folded), tick = is_tick(folded);
  if (plain && (is_turn(folded) || turn_unit) && positive && number < 1e12)
    stated->kind = EO_STATED_TURN, stated->value = number;
  else if (tick && positive && (time || frequency || number > 1000))
    stated->kind = EO_STATED_TICK, stated->value = time ? number * factor : 1 / (number * factor);
  else if ((rate || interval) && positive && (time || frequency || plain))
    stated->kind = EO_STATED_INTERVAL,
    stated->value = time || (interval && !frequency) ? number * factor : 1 / (number * factor);
  else if (is_start(folded) && (time || plain))
    stated->kind = EO_STATED_START, stated->value = number * factor;
  else if (is_scale(folded) && number != 0)
    stated->kind = EO_STATED_SCALE, stated->value = number;
  else if (is_offset(folded))
    stated->kind = EO_STATED_OFFSET, stated->value = number;
}

struct eo_stated eo_stated_read(const char *key, double number, const char *unit)
{
  char name[KEY], own[32], folded[KEY];
  double factor = 1;
  struct eo_stated stated = nothing();
  if (!isfinite(number))
    return stated;
  eo_unit_split(key, name, (int)sizeof name, own, (int)sizeof own);
  enum eo_quantity quantity = eo_unit_find(*unit ? unit : own, &factor);
  bool sampling = quantity == EO_QUANTITY_TIME || quantity == EO_QUANTITY_FREQUENCY;
  fold(key, folded);
  bool word = quantity == EO_QUANTITY_TIME && is_rate(folded) && (strchr(key, '/') || strstr(folded, "per"));
  if (!*unit && (word || !sampling)) /* "Samples/s" is a word of its own; other units are none of a sampling */
    quantity = EO_QUANTITY_NONE, factor = 1;
  const char *bare = !*unit && sampling && !word ? name : key;
  stated.member = eo_stated_member(name);
  fold(bare, folded);
  judge_key(folded, number, quantity, factor, is_turn_unit(unit), &stated);
  if (!stated.kind) {
    char rest[KEY];
    strip_owner(bare, rest, sizeof rest);
    fold(rest, folded);
    judge_key(folded, number, quantity, factor, false, &stated);
  }
  return stated;
}
