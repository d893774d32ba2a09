/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/stated_private.h"
#include "recording/column.h"
#include "recording/letters.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEY EO_STATED_KEY

void eo_stated_fold(const char *key, char folded[KEY])
{
  char plain[KEY];
  size_t n = 0;
  eo_letters_plain(key, strlen(key), plain, sizeof plain);
  for (const char *p = plain; *p; p++)
    if (isalnum((unsigned char)*p) || *p == '/')
      folded[n++] = *p;
  folded[n] = '\0';
}

bool eo_stated_is_one(const char *key, const char *words)
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

bool eo_stated_holds(const char *key, const char *words)
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
#define NOT_SAMPLING                                                                                                 \
  "numberof numof noof nof nrof anzahl nombre numero cantidad samplecount numsampl nsampl wfsamples samplesize "     \
  "points length filter cutoff corte coupure grenz lowpass tiefpass antialias max nyquist original duration dauer "  \
  "divid teiler message calibrat accura generat aggregate uncertain transfer limit minim mindest recommend empfohl " \
  "planned geplant required erforder intern display anzeige temperat vibrat accelerom beschleunig microph mikrofon " \
  "audio"

/* Of a converter, behind what it averages; no output shaft is meant. */
#define OUTPUT_RATES "outputrate outputdatarate ausgaberate"

static bool is_about(const char *key, const char *what, const char *measure)
{
  return eo_stated_holds(key, what) && eo_stated_holds(key, measure) && !eo_stated_holds(key, NOT_SAMPLING);
}

static bool is_rate(const char *key)
{
  return eo_stated_is_one(key, "fs sr rate fsample fsamp fsampling fa ratehz samples/s samples/sec s/s sa/s frequenz "
                               "fabtast fech samplespersec") ||
         eo_stated_holds(
             key, "samplespersec samplesper/ samples/s readingspersec scanspersec scans/s pointspersec "
                  "ratechang newrate rowrate rowspersec rows/s valuespersec values/s points/s linespersec werte/s "
                  "werteprosek wertejesek "
                  "punkteprosek punktejesek pointsparsec samplingspeed ratehz recordedat sampledat acquiredat loggedat "
                  "outputrate updaterate pollrate storedrate "
                  "resultingrate effectiverate effektiverate "
                  "framerate storerate storagerate recordrate recordingrate loggingrate") ||
         is_about(key, SAMPLING, RATES " clk clock velocid") || is_about(key, TAKING, RATES);
}

static bool is_interval(const char *key)
{
  return eo_stated_is_one(
             key, "dt ts deltat deltax dx increment interval xincr xinc xincrement xinterval incrementx wfincrement "
                  "tsample tsamp tsampling period timestep delta intervall xdelta xin step ta abtastung stepsize "
                  "xstep tinc tincr tincrement tinterval hresolution") ||
         eo_stated_holds(
             key,
             "betweensamples betweenrows betweenpoints betweenvalues rowinterval intervalofrows sampletime "
             "samplingtime abtastzeit timeperpoint timepersample secondspersample tasttakt dtsec "
             "samplingresolution wfincrement xincrement xinterval storageinterval recordinginterval logginginterval") ||
         is_about(key, SAMPLING, INTERVALS " period temps tiempo tempo") || is_about(key, TAKING " " TIMES, INTERVALS);
}

/* Without a word for a rate or an interval the unit of the number tells which of both it is; of a scan or of an
   acquisition a time may be its duration. */
static bool is_sampling(const char *key, bool time)
{
  return eo_stated_is_one(key, "sampling abtastung echantillonnage muestreo campionamento amostragem bemonstering") ||
         (!time && eo_stated_is_one(key, "sampled sample abgetastet scan scanning acquisition logging"));
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
  return !eo_stated_holds(key, NOT_SAMPLING) &&
         (time ? eo_stated_holds(key, SAMPLING) && ends_with(key, "every each alle jede toutesles cada ogni")
               : eo_stated_holds(key, SAMPLING " " TAKING " abgetastet") &&
                     ends_with(key, "with at mit von bei of de avec con was war betrug by"));
}

static bool is_start(const char *key)
{
  return eo_stated_is_one(key,
                          "x0 t0 tstart starttime startoffset wfstartoffset xzero xstart xoffset startvalue starts "
                          "offsettime timeoffset tzero start xorg xorigin") ||
         eo_stated_holds(key, "wfstartoffset");
}

static bool is_tick(const char *key)
{
  return eo_stated_is_one(key, "timebase clock fclk fclock tick timerclock timer zeitbasis clk takt mhz") ||
         (eo_stated_holds(
              key, "timebasefreq timebaserate timebaseclock clockfreq clockrate counterclock counterfreq "
                   "countertimebase timerfreq timerclock timerrate tickrate tickfreq tickspersec ticks/s ticksper "
                   "tickduration ticklength tickperiod ticktime tickinterval taktfreq taktrate timerresolution "
                   "timerperiod zaehlertakt zahlertakt clockperiod referenceclock") &&
          !eo_stated_holds(key, SAMPLING));
}

/* What times resolve, and which whole numbers without a unit may count. */
static bool is_resolution(const char *key)
{
  return eo_stated_holds(key, "resolution aufloesung auflosung granular quantum timestampunit timestampstep") &&
         !eo_stated_holds(key, "samplingresolution hresolution horizontalresolution");
}

static bool is_scale(const char *key)
{
  return eo_stated_is_one(
             key, "scalefactor scale gain slope factor faktor conversionfactor conversion bitvolts calibration "
                  "calibrationfactor sensitivityfactor scaling multiplier umrechnungsfaktor lsb resolutionperbit") ||
         eo_stated_holds(key, "scalefactor");
}

static bool is_offset(const char *key)
{
  return eo_stated_is_one(key, "addoffset offset intercept bias yoffset scaleoffset") ||
         eo_stated_holds(key, "addoffset");
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
  eo_stated_fold(words, folded);
  return eo_stated_holds(folded, NOT_SAMPLING);
}

bool eo_stated_thins(const char *words)
{
  char folded[KEY];
  eo_stated_fold(words, folded);
  return eo_stated_holds(folded, "decimat dezimi downsampl unterabtast subsampl");
}

/* "Stored rate", "sampling rate after decimation", "output rate". */
static enum eo_stated_strength strength_of(const char *folded)
{
  return eo_stated_holds(folded, "store storage saved speicher effecti effekti result afterdecim afteraver afterdown "
                                 "nachdezim nachmitt nachunter apresdecim decimatedrate decimatedsampl")
             ? EO_STATED_ROWS
         : eo_stated_holds(folded, OUTPUT_RATES) ? EO_STATED_OUTPUT
                                                 : EO_STATED_CONVERTER;
}

bool eo_stated_begin(const char *key)
{
  char folded[KEY];
  eo_stated_fold(key, folded);
  return eo_stated_is_one(folded,
                          "start t0 beginn begin datetime timestamp date datum time zeit uhrzeit created acquired "
                          "wfstarttime triggertime heure fecha hora data ora") ||
         eo_stated_holds(folded,
                         "starttime startdate startzeit startdatum starttimestamp startedat recordingstart messbeginn "
                         "messstart begintime recordedat startat timeofstart startofrecording triggertime "
                         "acquisitiondate aufnahmebeginn recordingdate recordingtime datetime timestamp");
}

int eo_stated_number(const char *name)
{
  int number = -1;
  for (const char *p = name; *p;) {
    size_t digits = strspn(p, "0123456789");
    if (digits > 0 && digits < 5)
      number = atoi(p);
    p += digits ? digits : 1;
  }
  return number;
}

/* The key without the words that only say whose it is. */
static void strip_owner(const char *key, char *rest, size_t size)
{
  static const char owners[] = EO_PINION_WORDS "|" EO_GEAR_WORDS "|channel|chan|ch|kanal|canal|canale|voie|encoder|enc|"
                                               "geber|codeur|of|the|for|des|der|von|du|de|del|della|0|1|2";
  size_t n = 0;
  for (const char *p = key; *p;) {
    char word[KEY];
    size_t length = strcspn(p, " _.-:;,()[]"), digits = strspn(p, "0123456789"), letters = strcspn(p, "0123456789");
    length = digits && digits < length ? digits : letters && letters < length ? letters : length; /* "CPR" of "CPR1" */
    size_t used = length < KEY ? length : KEY - 1;
    memcpy(word, p, used);
    word[used] = '\0';
    if (length && !eo_column_named(word, owners) && n + used + 2 < size)
      n += (size_t)snprintf(rest + n, size - n, "%s ", word);
    p += length + (p[length] && strchr(" _.-:;,()[]", p[length]));
  }
  rest[n] = '\0';
}

void eo_stated_fold_bare(const char *key, char folded[KEY])
{
  char rest[KEY];
  strip_owner(key, rest, sizeof rest);
  eo_stated_fold(rest, folded);
}

/* "kS/s" and the like: whatever stands before it, the number is a sampling rate. */
static bool is_sampling_unit(const char *unit)
{
  char folded[KEY];
  double factor;
  eo_stated_fold(unit, folded);
  return eo_stated_holds(folded, "s/s sps sa/s samples") && eo_unit_find(unit, &factor) == EO_QUANTITY_FREQUENCY;
}

/* "Values/h": a unit that is not known and counts something per something. A number under it is no rate in Hz. */
static bool is_unknown_ratio(const char *unit)
{
  char folded[KEY];
  double factor;
  eo_stated_fold(unit, folded);
  return eo_stated_holds(folded, "/ per pro") &&
         (eo_unit_find(unit, &factor) == EO_QUANTITY_OTHER || eo_unit_find(unit, &factor) == EO_QUANTITY_NONE);
}

/* German calls the rate of a logger and the clock of a counter a Takt; counters run at 1 MHz and more. */
static bool is_slow_clock(const char *folded, double number, enum eo_quantity quantity, double factor)
{
  return quantity == EO_QUANTITY_FREQUENCY && number * factor < 1e6 && eo_stated_holds(folded, "taktrate taktfreq") &&
         !eo_stated_holds(folded, "zaehler zahler timer counter");
}

static void state_interval(const char *folded, struct eo_stated *stated)
{
  stated->kind = EO_STATED_INTERVAL;
  stated->strength = strength_of(folded);
  if (eo_stated_holds(folded, OUTPUT_RATES))
    stated->member = -1;
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
  if (plain && (eo_stated_is_turn(folded) || turn_unit) && positive && number < 1e12)
    stated->kind = EO_STATED_TURN, stated->value = number;
  else if (plain && eo_stated_is_fold(folded) && number >= 1 && number <= 65536 && number == floor(number))
    stated->kind = EO_STATED_FOLD, stated->value = number;
  else if (tick && positive && (time || frequency || number > 1000))
    stated->kind = EO_STATED_TICK, stated->value = time ? number * factor : 1 / (number * factor);
  else if (time && positive && is_resolution(folded))
    stated->kind = EO_STATED_RESOLUTION, stated->value = number * factor;
  else if ((rate || interval) && positive && (time || frequency || plain))
    state_interval(folded, stated),
        stated->value = time || (interval && !frequency) ? number * factor : 1 / (number * factor);
  else if (is_start(folded) && (time || plain))
    stated->kind = EO_STATED_START, stated->value = number * factor;
  else if (is_scale(folded) && number != 0)
    stated->kind = EO_STATED_SCALE, stated->value = number;
  else if (is_offset(folded))
    stated->kind = EO_STATED_OFFSET, stated->value = number;
}

/* Whose a key is, by its name; "Strichzahl Rad" ends with a word that is a unit, too. */
static int member_of(const char *key, const char *name, const char *own)
{
  int member = eo_stated_member(name);
  return member < 0 && *own && isalpha((unsigned char)key[strlen(key) - 1]) ? eo_stated_member(own) : member;
}

/* "decimation_factor" 4, "Averages" 4: as it would stand in a line. */
static void read_ratio(const char *key, double number, const char *unit, struct eo_stated *stated)
{
  char text[64];
  snprintf(text, sizeof text, "%.9g %.32s", number, unit);
  struct eo_stated ratio = eo_stated_read_ratio(key, text);
  stated->kind = ratio.kind;
  stated->value = ratio.value;
  stated->strength = ratio.strength;
}

struct eo_stated eo_stated_read(const char *key, double number, const char *unit)
{
  char name[KEY], own[32], folded[KEY];
  double factor = 1;
  struct eo_stated stated = eo_stated_nothing();
  if (!isfinite(number))
    return stated;
  eo_unit_split(key, name, (int)sizeof name, own, (int)sizeof own);
  stated.member = member_of(key, name, own);
  stated.number = eo_stated_number(name);
  eo_stated_fold(name, folded);
  stated.lines = eo_stated_are_lines(key, unit);
  if (!is_scale(folded) && eo_stated_read_turn(key, name, own, number, unit, &stated))
    return stated;
  enum eo_quantity quantity = eo_unit_find_multiple(*unit ? unit : own, &factor);
  if (!strcmp(*unit ? unit : own, "1/min")) /* of a rate; of a shaft it is rpm */
    quantity = EO_QUANTITY_FREQUENCY, factor = 1. / 60;
  bool sampling = quantity == EO_QUANTITY_TIME || quantity == EO_QUANTITY_FREQUENCY;
  eo_stated_fold(key, folded);
  bool word = quantity == EO_QUANTITY_TIME && is_rate(folded) && (strchr(key, '/') || strstr(folded, "per"));
  if (!*unit && (word || !sampling)) /* "Samples/s" is a word of its own; other units are none of a sampling */
    quantity = EO_QUANTITY_NONE, factor = 1;
  const char *bare = !*unit && sampling && !word ? name : key;
  eo_stated_fold(bare, folded);
  judge_key(folded, number, quantity, factor, eo_stated_is_turn_unit(name, unit), &stated);
  if (!stated.kind && number > 0 && is_sampling_unit(*unit ? unit : own) && !eo_stated_holds(folded, NOT_SAMPLING))
    stated.kind = EO_STATED_INTERVAL, stated.value = 1 / (number * factor);
  if (!stated.kind) {
    eo_stated_fold_bare(bare, folded);
    judge_key(folded, number, quantity, factor, false, &stated);
  }
  if (stated.kind == EO_STATED_INTERVAL && is_unknown_ratio(unit))
    return eo_stated_nothing();
  if (!stated.kind)
    read_ratio(key, number, unit, &stated);
  return stated;
}
