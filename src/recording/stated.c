/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/stated.h"
#include "recording/column.h"
#include "recording/letters.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY 96

/* The key without accents, in lower case, with nothing but letters, digits and the slash of "samples/s". */
static void fold(const char *key, char *folded)
{
  char plain[KEY];
  size_t n = 0;
  eo_letters_plain(key, strlen(key), plain, sizeof plain);
  for (const char *p = plain; *p; p++)
    if (isalnum((unsigned char)*p) || *p == '/')
      folded[n++] = *p;
  folded[n] = '\0';
}

/* True when the key is one of the words, which blanks part. */
static bool is_one(const char *key, const char *words)
{
  size_t length = strlen(key);
  for (const char *p = words; *p;) {
    size_t n = strcspn(p, " ");
    if (n == length && !memcmp(p, key, n))
      return true;
    p += n + (p[n] == ' ');
  }
  return false;
}

/* True when one of the words stands in the key. */
static bool holds(const char *key, const char *words)
{
  for (const char *p = words; *p;) {
    char word[KEY];
    size_t n = strcspn(p, " ");
    memcpy(word, p, n);
    word[n] = '\0';
    if (strstr(key, word))
      return true;
    p += n + (p[n] == ' ');
  }
  return false;
}

/* Stems of what is sampled, in English, German, French, Spanish, Italian, Portuguese and Dutch. With a word for a rate
   or for an interval behind or before them they make most of the keys in use. */
#define SAMPLING "sampl scan abtast echantillon muestr campion amostra bemonster"
#define TAKING                                                                                              \
  "acqui acqrate acqfreq adquis daq data record enregistr regist logging lograte logfreq loginterval mess " \
  "mesure medici misura speicher stockage erfass digitali aufzeichn"
#define RATES "rate freq frec cadenc tasa taux takt"
#define INTERVALS "interval step increment inkrement delta schritt abstand pasde pasd paso passo spacing"
#define TIMES "time zeit temps tiempo tempo horiz"

/* Amounts of samples, what a filter does, and what a device could do are no sampling. */
#define NOT_SAMPLING                                                                                                \
  "numberof numof noof nof nrof anzahl nombre numero cantidad samplecount numsampl nsampl wfsamples samplesize "    \
  "points length filter cutoff corte coupure grenz lowpass tiefpass antialias max nyquist original duration dauer " \
  "divid teiler message calibrat accura generat"

static bool is_about(const char *key, const char *what, const char *measure)
{
  return holds(key, what) && holds(key, measure) && !holds(key, NOT_SAMPLING);
}

static bool is_rate(const char *key)
{
  return is_one(key, "fs sr rate fsample fsamp fsampling fa ratehz samples/s samples/sec s/s sa/s frequenz "
                     "fabtast fech samplespersec") ||
         holds(key, "samplespersec samplesper/ samples/s readingspersec scanspersec scans/s pointspersec "
                    "samplingspeed ratehz recordedat sampledat acquiredat loggedat outputrate updaterate pollrate "
                    "framerate") ||
         is_about(key, SAMPLING, RATES " clk clock velocid") || is_about(key, TAKING, RATES);
}

static bool is_interval(const char *key)
{
  return is_one(key, "dt ts deltat deltax dx increment interval xincr xinc xincrement xinterval incrementx wfincrement "
                     "tsample tsamp tsampling period timestep delta intervall xdelta xin step ta abtastung stepsize "
                     "xstep tinc tincr tincrement tinterval hresolution") ||
         holds(key, "sampletime samplingtime abtastzeit timeperpoint timepersample secondspersample tasttakt dtsec "
                    "samplingresolution wfincrement xincrement xinterval") ||
         is_about(key, SAMPLING, INTERVALS " period temps tiempo tempo") || is_about(key, TAKING " " TIMES, INTERVALS);
}

/* Without a word for a rate or an interval the unit of the number tells which of both it is; of a scan or of an
   acquisition a time may be its duration. */
static bool is_sampling(const char *key, bool time)
{
  return is_one(key, "sampling abtastung echantillonnage muestreo campionamento amostragem bemonstering") ||
         (!time && is_one(key, "sampled sample abgetastet scan scanning acquisition logging"));
}

static bool ends_with(const char *key, const char *words)
{
  size_t length = strlen(key);
  for (const char *p = words; *p;) {
    size_t n = strcspn(p, " ");
    if (n <= length && !memcmp(key + length - n, p, n))
      return true;
    p += n + (p[n] == ' ');
  }
  return false;
}

/* Sentences: "the channels were sampled with 4 kHz", "recording of 2 s at 4 kHz"; "one sample every 250 us". */
static bool is_told(const char *key, bool time)
{
  return !holds(key, NOT_SAMPLING) &&
         (time ? holds(key, SAMPLING) && ends_with(key, "every each alle jede toutesles cada ogni")
               : holds(key, SAMPLING " " TAKING " abgetastet") &&
                     ends_with(key, "with at mit von bei of de avec con was war betrug by"));
}

static bool is_start(const char *key)
{
  return is_one(key, "x0 t0 tstart starttime startoffset wfstartoffset xzero xstart xoffset startvalue starts "
                     "offsettime timeoffset tzero start xorg xorigin") ||
         holds(key, "wfstartoffset");
}

static bool is_tick(const char *key)
{
  return is_one(key, "timebase clock fclk fclock tick timerclock timer zeitbasis clk takt mhz") ||
         (holds(key, "timebasefreq timebaserate timebaseclock clockfreq clockrate counterclock counterfreq "
                     "countertimebase timerfreq timerclock timerrate tickrate tickfreq tickspersec ticks/s ticksper "
                     "tickduration ticklength tickperiod ticktime tickinterval taktfreq taktrate timerresolution "
                     "timerperiod zaehlertakt zahlertakt clockperiod referenceclock") &&
          !holds(key, SAMPLING));
}

static bool is_turn(const char *key)
{
  return is_one(key, "cpr ppr lpr encoderresolution resolution aufloesung auflosung strichzahl lines pulses striche "
                     "teethofwheel encoderlines encoderpulses encodercounts geberstriche wheelteeth") ||
         holds(key, "perrev perturn percycle /rev /turn /umdr /u /tour /giro /vuelta proumdr prou partour pervuelta "
                    "porvuelta pergiro countsper360 encoderresolution geberaufl encoderaufl strichzahl impulszahl "
                    "encodercpr encoderppr polepairs");
}

static bool is_scale(const char *key)
{
  return is_one(key, "scalefactor scale gain slope factor faktor conversionfactor bitvolts calibration "
                     "calibrationfactor sensitivityfactor scaling multiplier umrechnungsfaktor lsb resolutionperbit") ||
         holds(key, "scalefactor");
}

static bool is_offset(const char *key)
{
  return is_one(key, "addoffset offset intercept bias yoffset scaleoffset") || holds(key, "addoffset");
}

/* "Pinion counts" and the like say whose it is. */
int eo_stated_member(const char *name)
{
  bool pinion = eo_column_named(name, EO_PINION_WORDS "|1"), gear = eo_column_named(name, EO_GEAR_WORDS "|2");
  return pinion == gear ? -1 : gear;
}

bool eo_stated_excludes(const char *words)
{
  char folded[KEY];
  fold(words, folded);
  return holds(folded, NOT_SAMPLING);
}

bool eo_stated_thins(const char *words)
{
  char folded[KEY];
  fold(words, folded);
  return holds(folded, "decimat dezimi downsampl unterabtast subsampl");
}

bool eo_stated_begin(const char *key)
{
  char folded[KEY];
  fold(key, folded);
  return is_one(folded, "start t0 beginn begin datetime timestamp date datum time zeit uhrzeit created acquired "
                        "wfstarttime triggertime heure fecha hora data ora") ||
         holds(folded, "starttime startdate startzeit startdatum starttimestamp startedat recordingstart messbeginn "
                       "messstart begintime recordedat startat timeofstart startofrecording triggertime "
                       "acquisitiondate aufnahmebeginn recordingdate recordingtime datetime timestamp");
}

static struct eo_stated nothing(void)
{
  return (struct eo_stated){EO_STATED_NOTHING, 0, -1};
}

/* The key without the words that only say whose it is. */
static void strip_owner(const char *key, char *rest, size_t size)
{
  static const char owners[] = EO_PINION_WORDS "|" EO_GEAR_WORDS "|channel|chan|ch|kanal|canal|canale|voie|encoder|enc|"
                                               "geber|codeur|of|the|for|des|der|von|du|de|del|della|1|2";
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
  char folded[KEY];
  fold(unit, folded);
  return holds(folded, "perrev perturn /rev /turn /umdr proumdr");
}

static bool is_bits(const char *unit)
{
  char folded[KEY];
  fold(unit, folded);
  return is_one(folded, "bit bits");
}

/* Encoders of so many bits have two to that power of counts in a turn; an analogue input has bits too, and no turn. */
static struct eo_stated read_bits(const char *name, double number)
{
  char folded[KEY];
  fold(name, folded);
  bool encoder = holds(folded, "encoder geber codeur codificador singleturn perturn perrev") &&
                 holds(folded, "resol aufl bit turn rev");
  if (!encoder || !(number >= 1 && number <= 40) || number != floor(number))
    return nothing();
  return (struct eo_stated){EO_STATED_TURN, exp2(number), eo_stated_member(name)};
}

/* "kS/s" and the like: whatever stands before it, the number is a sampling rate. */
static bool is_sampling_unit(const char *unit)
{
  char folded[KEY];
  double factor;
  fold(unit, folded);
  return holds(folded, "s/s sps sa/s samples") && eo_unit_find(unit, &factor) == EO_QUANTITY_FREQUENCY;
}

/* "Values/h": a unit that is not known and counts something per something. A number under it is no rate in Hz. */
static bool is_unknown_ratio(const char *unit)
{
  char folded[KEY];
  double factor;
  fold(unit, folded);
  return holds(folded, "/ per pro") &&
         (eo_unit_find(unit, &factor) == EO_QUANTITY_OTHER || eo_unit_find(unit, &factor) == EO_QUANTITY_NONE);
}

/* German calls the rate of a logger and the clock of a counter a Takt; counters run at 1 MHz and more. */
static bool is_slow_clock(const char *folded, double number, enum eo_quantity quantity, double factor)
{
  return quantity == EO_QUANTITY_FREQUENCY && number * factor < 1e6 && holds(folded, "taktrate taktfreq") &&
         !holds(folded, "zaehler zahler timer counter");
}

/* What a key of one meaning says; folded: in lower case, its unit taken off. */
static void judge_key(const char *folded, double number, enum eo_quantity quantity, double factor, bool turn_unit,
                      struct eo_stated *stated)
{
  bool positive = number > 0, time = quantity == EO_QUANTITY_TIME, frequency = quantity == EO_QUANTITY_FREQUENCY;
  bool plain = quantity == EO_QUANTITY_NONE || quantity == EO_QUANTITY_OTHER || quantity == EO_QUANTITY_COUNT;
  bool rate = is_rate(folded) || (frequency && (is_sampling(folded, false) || is_told(folded, false))),
       interval = is_interval(folded) || (time && (is_sampling(folded, true) || is_told(folded, true))),
       tick = is_tick(folded);
  if (is_slow_clock(folded, number, quantity, factor))
    rate = true, tick = false;
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
  if (is_bits(*unit ? unit : own))
    return read_bits(name, number);
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
  if (!stated.kind && number > 0 && is_sampling_unit(*unit ? unit : own) && !holds(folded, NOT_SAMPLING))
    stated.kind = EO_STATED_INTERVAL, stated.value = 1 / (number * factor);
  if (!stated.kind) {
    char rest[KEY];
    strip_owner(bare, rest, sizeof rest);
    fold(rest, folded);
    judge_key(folded, number, quantity, factor, false, &stated);
  }
  if (stated.kind == EO_STATED_INTERVAL && is_unknown_ratio(unit))
    return nothing();
  return stated;
}
