/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/recorded_unit.h"
#include "recording/letters.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295   /* rad */
#define TURN 6.283185307179586        /* rad */
#define INCH_POUND 0.1129848290276167 /* N m */
#define KILOPOND 9.80665              /* N */

/* Units by their spelling after fold(); of a list that shares a factor. */
static const struct {
  const char *spellings; /* separated by blanks */
  enum eo_quantity quantity;
  double factor;
} units[] = {
    {"s sec secs second seconds sek sekunde sekunden seconde secondes segundo segundos secondi secondo",
     EO_QUANTITY_TIME, 1},
    {"ms msec msecs millisec millisecs millisecond milliseconds millis msek millisekunden", EO_QUANTITY_TIME, 1e-3},
    {"us usec usecs microsec microsecs microsecond microseconds micros mikrosekunden", EO_QUANTITY_TIME, 1e-6},
    {"ns nsec nsecs nanosec nanosecs nanosecond nanoseconds nanos nanosekunden", EO_QUANTITY_TIME, 1e-9},
    {"ps", EO_QUANTITY_TIME, 1e-12},
    {"cs centisec centiseconds", EO_QUANTITY_TIME, 1e-2},
    {"ds decisec deciseconds", EO_QUANTITY_TIME, 0.1},
    {"min mins minute minutes minuten", EO_QUANTITY_TIME, 60},
    {"h hr hrs hour hours std stunden", EO_QUANTITY_TIME, 3600},
    {"d day days tag tage", EO_QUANTITY_TIME, 86400},
    {"deg degs degree degrees grad altgrad winkelgrad degre degres grado grados gradi grau graus \xc2\xb0",
     EO_QUANTITY_ANGLE, DEGREE},
    {"degca cad \xc2\xb0"
     "ca degkw gradkw \xc2\xb0kw", /* of a crank */
     EO_QUANTITY_ANGLE, DEGREE},
    {"rad rads radian radians radiant", EO_QUANTITY_ANGLE, 1},
    {"mrad millirad milliradian milliradians", EO_QUANTITY_ANGLE, 1e-3},
    {"urad microrad microradian microradians mikrorad", EO_QUANTITY_ANGLE, 1e-6},
    {"nrad", EO_QUANTITY_ANGLE, 1e-9},
    {"mdeg m\xc2\xb0 millidegree millidegrees", EO_QUANTITY_ANGLE, DEGREE * 1e-3},
    {"udeg", EO_QUANTITY_ANGLE, DEGREE * 1e-6},
    {"arcsec arcsecs arcsecond arcseconds asec as \" '' winkelsekunden bogensekunden", EO_QUANTITY_ANGLE,
     DEGREE / 3600},
    {"marcsec mas", EO_QUANTITY_ANGLE, DEGREE / 3.6e6},
    {"arcmin arcmins arcminute arcminutes amin ' winkelminuten bogenminuten", EO_QUANTITY_ANGLE, DEGREE / 60},
    {"gon gons gradian gradians grads ngrad neugrad", EO_QUANTITY_ANGLE, TURN / 400},
    {"mgon", EO_QUANTITY_ANGLE, TURN / 4e5},
    {"rev revs revolution revolutions turn turns tr tour tours u umdr umdrehung umdrehungen cycle cycles cyc cycs rot "
     "rots rotation rotations giro giri vuelta vueltas",
     EO_QUANTITY_ANGLE, TURN},
    {"mrev", EO_QUANTITY_ANGLE, TURN * 1e-3},
    {"count counts cnt cnts cts ct inc incs increment increments inkr ink inkrement inkremente tick ticks pulse pulses "
     "puls pulse(s) impuls impulse imp lsb adc digit digits step steps schritt schritte strich striche edges flanken "
     "quadcounts cuenta cuentas impulso impulsos impulsi conteggio conteggi coups",
     EO_QUANTITY_COUNT, 1},
    {"v volt volts", EO_QUANTITY_VOLTAGE, 1},
    {"mv", EO_QUANTITY_VOLTAGE, 1e-3},
    {"uv", EO_QUANTITY_VOLTAGE, 1e-6},
    {"a amp amps ampere", EO_QUANTITY_CURRENT, 1},
    {"ma", EO_QUANTITY_CURRENT, 1e-3},
    {"ua", EO_QUANTITY_CURRENT, 1e-6},
    {"hz hertz 1/s s-1 s/s sa/s samples/s samples/sec sps spers s/sec samplespersecond", EO_QUANTITY_FREQUENCY, 1},
    {"samples/min sa/min samplesperminute", EO_QUANTITY_FREQUENCY, 1. / 60},
    {"khz 1/ms ks/s ksa/s ksps kilohertz ksamples/s", EO_QUANTITY_FREQUENCY, 1e3},
    {"mhz ms/s msa/s msps megahertz", EO_QUANTITY_FREQUENCY, 1e6},
    {"ghz gs/s gsa/s", EO_QUANTITY_FREQUENCY, 1e9},
    {"krpm 1000rpm x1000rpm rpmx1000 1000/min x1000/min tsd/min", EO_QUANTITY_SPEED, 1e3 * TURN / 60},
    {"rad/min", EO_QUANTITY_SPEED, 1. / 60},
    {"deg/min \xc2\xb0/min", EO_QUANTITY_SPEED, DEGREE / 60},
    {"rpm 1/min min-1 u/min umdr/min rev/min r/min rev./min tr/min trs/min tours/min giri/min g/min vueltas/min "
     "rot/min upm",
     EO_QUANTITY_SPEED, TURN / 60},
    {"rps u/s rev/s r/s umdr/s turns/s", EO_QUANTITY_SPEED, TURN},
    {"rad/s rad/sec rads-1", EO_QUANTITY_SPEED, 1},
    {"deg/s \xc2\xb0/s deg/sec grad/s", EO_QUANTITY_SPEED, DEGREE},
    {"Nm NM newtonmeter newtonmeters newtonmetre newtonmetres", EO_QUANTITY_TORQUE, 1},
    {"kNm KNM knm", EO_QUANTITY_TORQUE, 1e3},
    {"mNm Nmm NMM", EO_QUANTITY_TORQUE, 1e-3},
    {"MNm", EO_QUANTITY_TORQUE, 1e6},
    {"daNm", EO_QUANTITY_TORQUE, 10},
    {"dNm", EO_QUANTITY_TORQUE, 0.1},
    {"Ncm cNm", EO_QUANTITY_TORQUE, 1e-2},
    {"kgfm kpm mkp mkg kgm", EO_QUANTITY_TORQUE, KILOPOND},
    {"kgfcm kpcm cmkg kgcm", EO_QUANTITY_TORQUE, KILOPOND * 1e-2},
    {"gfcm gcm", EO_QUANTITY_TORQUE, KILOPOND * 1e-5},
    {"lbin lbsin lbfin inlb inlbs inlbf inchpound inchpounds poundinch poundinches", EO_QUANTITY_TORQUE, INCH_POUND},
    {"lbft lbsft lbfft ftlb ftlbs ftlbf footpound footpounds poundfoot poundfeet", EO_QUANTITY_TORQUE, 12 * INCH_POUND},
    {"ozin ozfin inoz inozf", EO_QUANTITY_TORQUE, INCH_POUND / 16},
    {"n kn lbf g mg gn m/s2 mm/s2 m/ss m/s mm/s m mm um nm cm km c \xc2\xb0"
     "c degc f k celsius bar mbar pa kpa mpa psi n/mm2 % 1 db dbv w kw l/min kg ohm mm/m um/m ue rad/s2 hpa pc nc "
     "ppm mv/v",
     EO_QUANTITY_OTHER, 1},
};

static bool opens(char c)
{
  return c == '[' || c == '(' || c == '{' || c == '<';
}

static bool closes(char c)
{
  return c == ']' || c == ')' || c == '}' || c == '>';
}

/* Signs that have several spellings, as bytes of UTF-8 and of Latin 1, and what they become. "" : nothing. */
static const char *const signs[][2] = {
    {"\xc2\xb5", "u"},
    {"\xce\xbc", "u"},
    {"\xc2\xba", "\xc2\xb0"},
    {"\xcb\x9a", "\xc2\xb0"},
    {"\xe2\x80\xb3", "\""},
    {"\xe2\x80\xb2", "'"},
    {"\xe2\x80\x9d", "\""},
    {"\xe2\x80\x99", "'"},
    {"\xc2\xb4", "'"},
    {"\xc2\xb7", ""},
    {"\xe2\x8b\x85", ""},
    {"\xe2\x88\x99", ""},
    {"\xc3\x97", ""},
    {"\xc2\xb2", "2"},
    {"\xe2\x81\xbb", "-"},
    {"\xc2\xb9", "1"},
    {"\xe2\x88\x92", "-"},
    {"\xc2\xa0", ""},
    {"\xc2\xb0", "\xc2\xb0"},
    {"\xb5", "u"},
    {"\xb0", "\xc2\xb0"},
    {"\xba", "\xc2\xb0"},
    {"\xb7", ""},
    {"\xb2", "2"},
    {"\xb9", "1"},
    {"\xb4", "'"},
    {"*", ""},
    {"^", ""},
    {" ", ""},
    {"\xf8", "\xc2\xb0"},
};

/* Writes the unit with one spelling for each sign; false when it is too long for a unit. */
static bool fold(const char *text, size_t length, char *unit, size_t size)
{
  size_t n = 0;
  for (size_t at = 0; at < length;) {
    const char *with = NULL;
    size_t used = 1;
    for (size_t i = 0; i < sizeof signs / sizeof *signs && !with; i++) {
      size_t bytes = strlen(signs[i][0]);
      if (bytes <= length - at && !memcmp(text + at, signs[i][0], bytes))
        with = signs[i][1], used = bytes;
    }
    char one[2] = {text[at], '\0'};
    with = with ? with : one;
    if (n + strlen(with) + 1 > size)
      return false;
    memcpy(unit + n, with, strlen(with));
    n += strlen(with);
    at += used;
  }
  unit[n] = '\0';
  return n > 0;
}

/* Case tells a newton metre from a nanometre and its multiples apart, so that spellings with capitals are exact. */
static bool is_spelling(const char *unit, size_t length, const char *spelling, size_t n)
{
  bool exact = false;
  if (n != length)
    return false;
  for (size_t i = 0; i < n; i++)
    exact = exact || isupper((unsigned char)spelling[i]);
  return exact ? !memcmp(unit, spelling, n) : !strncasecmp(unit, spelling, n);
}

static enum eo_quantity look_up(const char *unit, double *factor)
{
  size_t length = strlen(unit);
  for (size_t i = 0; i < sizeof units / sizeof *units; i++)
    for (const char *p = units[i].spellings; *p;) {
      size_t n = strcspn(p, " ");
      if (is_spelling(unit, length, p, n)) {
        *factor = units[i].factor;
        return units[i].quantity;
      }
      p += n + (p[n] == ' ');
    }
  return EO_QUANTITY_NONE;
}

/* "ft-lb", "lb.in", "kN-m": a hyphen or a point for the product, which only torques have. */
static bool find_product(char *unit, double *factor)
{
  size_t n = 0;
  for (const char *c = unit; *c; c++)
    if (*c != '-' && *c != '.')
      unit[n++] = *c;
  unit[n] = '\0';
  bool torque = look_up(unit, factor) == EO_QUANTITY_TORQUE;
  *factor = torque ? *factor : 1;
  return torque;
}

enum eo_quantity eo_unit_find(const char *text, double *factor)
{
  char unit[48];
  size_t length = strlen(text);
  *factor = 1;
  while (length && text[length - 1] == ' ')
    length--;
  while (length && *text == ' ')
    text++, length--;
  if (length >= 2 && opens(text[0]) && closes(text[length - 1]))
    text++, length -= 2;
  const char *since = strstr(text, " since ");
  if (since) /* "seconds since 2024-03-05", as climate data have it */
    length = (size_t)(since - text);
  if (length > 2 && text[length - 1] == '.') /* an abbreviation */
    length--;
  if (!length || length >= 40 || !fold(text, length, unit, sizeof unit) || !strcmp(unit, "S"))
    return EO_QUANTITY_NONE;
  if (strstr(unit, "\xc3")) /* "degrés" */
    eo_letters_plain(text, strlen(text), unit, sizeof unit);
  enum eo_quantity quantity = look_up(unit, factor);
  if (quantity == EO_QUANTITY_NONE && find_product(unit, factor))
    return EO_QUANTITY_TORQUE;
  return quantity;
}

/* What a multiple of a unit begins with: "0.0001", "0,1", "x10", "x 10^-5", "1E-4", "1/4000"; what follows it is copied
   to unit without blanks. 0: nothing that could be one; a number like 360 tells a range. */
static double multiple_of(const char *text, char *unit, size_t size)
{
  char plain[48], *end = plain;
  size_t n = 0;
  for (const char *c = text; *c && n + 1 < sizeof plain; c++)
    if (*c != ' ')
      plain[n++] = *c == ',' ? '.' : *c;
  plain[n] = '\0';
  const char *from = plain + (*plain == 'x');
  double number = !strncmp(from, "10^", 3)        ? pow(10, strtod(from + 3, &end))
                  : isdigit((unsigned char)*from) ? strtod(from, &end)
                                                  : 0;
  if (number > 0 && *end == '/' && isdigit((unsigned char)end[1]))
    number /= strtod(end + 1, &end);
  if (!(number > 0) || !isfinite(number) || (number > 1 && log10(number) != floor(log10(number))))
    return 0;
  snprintf(unit, size, "%s", end);
  return number;
}

enum eo_quantity eo_unit_find_multiple(const char *text, double *factor)
{
  char unit[48];
  enum eo_quantity quantity = eo_unit_find(text, factor);
  double number = quantity == EO_QUANTITY_NONE ? multiple_of(text, unit, sizeof unit) : 0;
  if (!(number > 0))
    return quantity;
  quantity = eo_unit_find(unit, factor);
  *factor *= quantity == EO_QUANTITY_NONE || quantity == EO_QUANTITY_OTHER ? 1 : number;
  return quantity;
}

static void copy_part(char *to, int size, const char *from, size_t length)
{
  while (length && *from == ' ')
    from++, length--;
  while (length && from[length - 1] == ' ')
    length--;
  snprintf(to, (size_t)size, "%.*s", (int)length, from);
}

/* "(raw)" and "(encoder 1)" name a channel: a known unit, or what is too short and too odd for a word, is a unit. */
static bool names_channel(const char *text, size_t length)
{
  char unit[48];
  double factor;
  bool word = length >= 3, number = length > 0;
  copy_part(unit, (int)sizeof unit, text, length);
  for (size_t i = 0; i < length; i++)
    word = word && (isalnum((unsigned char)text[i]) || text[i] == ' ' || text[i] == '_' || text[i] == '-');
  for (size_t i = 0; i < length; i++)
    number = number && isdigit((unsigned char)text[i]);
  return number || (eo_unit_find_multiple(unit, &factor) == EO_QUANTITY_NONE && word);
}

/* Where a number in front of `at` begins that belongs to the unit behind it, as "t / 10 us" and "ticks of 12.5 ns" have
   it; else `at`: in "encoder 1 deg" it belongs to the name. */
static size_t multiple_before(const char *label, size_t at)
{
  size_t from = at, to;
  while (from && strchr("0123456789.,", label[from - 1]))
    from--;
  to = from;
  while (to && label[to - 1] == ' ')
    to--;
  size_t word = to;
  while (word && isalpha((unsigned char)label[word - 1]))
    word--;
  bool of = to < from && eo_letters_listed(label + word, to - word, "in|zu|of|je|each");
  return from < at && to && (of || strchr("/@x*", label[to - 1])) ? from : at;
}

/* Splits at a slash, an underscore, a comma, a blank or the word "in" when a unit stands behind it. */
static bool split_word(const char *label, size_t length, size_t at, char *name, int name_size, char *unit,
                       int unit_size)
{
  char last[32];
  double factor;
  bool time = label[at] == '/' && at == 1 && *label == 't'; /* "t/h", as DIN 1313 writes it */
  copy_part(last, (int)sizeof last, label + at + 1, length - at - 1);
  if (eo_unit_find(last, &factor) == EO_QUANTITY_NONE ||
      (!time && strlen(last) == 1 && strchr("1cmgnaukfdhvw\"'", tolower((unsigned char)last[0]))))
    return false;
  at = multiple_before(label, at);
  copy_part(unit, unit_size, label + at + (strchr("_ /,:", label[at]) != NULL), length - at);
  while (at > 1 && strchr("_ /,:-", label[at - 1]))
    at--;
  if (at > 3 && !strncasecmp(label + at - 3, " in", 3))
    at -= 3;
  copy_part(name, name_size, label, at);
  return true;
}

void eo_unit_split(const char *label, char *name, int name_size, char *unit, int unit_size)
{
  size_t length = strlen(label);
  while (length && label[length - 1] == ' ')
    length--;
  *unit = '\0';
  if (length > 2 && closes(label[length - 1])) {
    size_t open = length - 1;
    while (open > 0 && !opens(label[open]))
      open--;
    bool round = label[open] == '(';
    if (open > 0 && !(round && names_channel(label + open + 1, length - open - 2))) {
      copy_part(name, name_size, label, open);
      copy_part(unit, unit_size, label + open + 1, length - open - 2);
      return;
    }
  }
  for (size_t i = length; i-- > 1;)
    if (strchr("_ /,:", label[i])) {
      if (split_word(label, length, i, name, name_size, unit, unit_size))
        return;
      if (label[i] != '/') /* "1/min" has one of its own */
        break;
    }
  copy_part(name, name_size, label, length);
}
