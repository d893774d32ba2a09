/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts and lines per turn: what of an encoder a number under a key states. */
#include "recording/column.h"
#include "recording/recorded_unit.h"
#include "recording/stated_private.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY EO_STATED_KEY
#define TURN 6.283185307179586 /* rad */

#define ENCODERS "encoder geber codeur codificador codificatore"
#define RESOLUTIONS "resolution aufloesung auflosung resolucion risoluzione resolucao resolutie"

/* Behind a word for what is counted. */
#define PER_TURN                                                                                            \
  "perrev perturn percycle perrot /rev /turn /umdr /tour /giro /vuelta /volta /rot proumdr jeumdr partour " \
  "pervuelta porvuelta porrev porvolta pergiro"

bool eo_stated_is_turn(const char *key)
{
  return eo_stated_is_one(
             key, "cpr ppr lpr encoderresolution strichzahl lines linecount pulses striche teethofwheel encoderlines "
                  "encoderpulses encodercounts geberstriche wheelteeth " RESOLUTIONS) ||
         eo_stated_holds(key,
                         PER_TURN " /u prou countsper360 encoderresolution geberaufl encoderaufl strichzahl impulszahl "
                                  "encodercpr encoderppr polepairs zahlgeberrad");
}

bool eo_stated_is_fold(const char *key)
{
  return eo_stated_is_one(
      key, "interpolation interpolationfactor interpolationsfaktor interpolator interpolacion interpolazione "
           "unterteilung subdivision quadrature quadraturedecoding quadraturefactor decoding decodingtype "
           "decodingmode decoder evaluation edgeevaluation auswertung flankenauswertung multiplication "
           "multiplicationfactor vervielfachung edgesperline edgesperpulse");
}

bool eo_stated_is_turn_unit(const char *name, const char *unit)
{
  char folded[KEY], key[KEY];
  eo_stated_fold(unit, folded);
  eo_stated_fold(name, key);
  return eo_stated_holds(folded, PER_TURN) || eo_stated_is_one(folded, "cpr ppr lpr") ||
         (eo_stated_is_one(folded, "lines striche strich") &&
          (eo_stated_member(name) >= 0 || eo_stated_holds(key, ENCODERS)));
}

bool eo_stated_are_lines(const char *key, const char *unit)
{
  char both[KEY], folded[KEY];
  snprintf(both, sizeof both, "%s %s", key, unit);
  eo_stated_fold(both, folded);
  return eo_stated_holds(folded, "line strich ligne linea puls impul ppr lpr") &&
         !eo_stated_holds(folded, "cpr counts inkr incr polyline");
}

static bool begins_with_bits(const char *unit)
{
  size_t letters = strspn(unit, "bitsBITS");
  char word[8];
  snprintf(word, sizeof word, "%.*s", (int)(letters < sizeof word ? letters : 0), unit);
  return !isalpha((unsigned char)unit[letters]) && eo_column_named(word, "bit|bits");
}

/* Converters of voltages state their bits under a mere "resolution"; encoders of as many must say so. */
static bool is_converter_width(double bits)
{
  return bits == 24 || bits == 32 || (bits <= 18 && fmod(bits, 2) == 0);
}

/* Bits of an encoder, which has two to that power of counts in a turn; an analogue input has bits too, and no turn. */
static bool is_bits_of_turn(const char *name, const char *unit, double number)
{
  char folded[KEY], rest[KEY], words[KEY];
  eo_stated_fold(name, folded);
  eo_stated_fold_bare(name, rest);
  eo_stated_fold(unit, words);
  bool resolution = eo_stated_is_one(rest, RESOLUTIONS), member = eo_stated_member(name) >= 0,
       encoder = eo_stated_holds(folded, ENCODERS " singleturn perturn perrev");
  if (eo_stated_holds(words, "multiturn"))
    return false;
  if (eo_stated_holds(words, PER_TURN " singleturn") || (resolution && (member || !is_converter_width(number))) ||
      (eo_stated_is_one(rest, "bits") && member))
    return true;
  return encoder && (*unit ? eo_stated_holds(folded, "resol aufl bit turn rev")
                           : eo_stated_is_one(rest, "bits resolutionbits bitresolution") ||
                                 eo_stated_holds(folded, PER_TURN " singleturn"));
}

/* "22 bit", or 22 under "Bits per turn"; true: the number is one of bits, whatever of. */
static bool read_bits(const char *key, const char *name, const char *own, double number, const char *unit,
                      struct eo_stated *stated)
{
  bool whole = number >= 1 && number <= 32 && number == floor(number), within = !*unit && begins_with_bits(own);
  bool of_turn = whole && is_bits_of_turn(within ? name : key, within ? own : unit, number);
  if (of_turn && (within || begins_with_bits(unit) || (!*unit && eo_column_named(key, "bit|bits")))) {
    stated->kind = EO_STATED_TURN;
    stated->value = exp2(number);
  }
  return stated->kind || within || begins_with_bits(unit);
}

/* A word of a ratio, the last one before its mark or the first one behind it. */
static enum eo_quantity part_of_ratio(const char *text, size_t length, bool last, double *factor)
{
  char part[KEY];
  size_t from = 0;
  while (length && text[length - 1] == ' ')
    length--;
  for (size_t i = 0; last && i < length; i++)
    from = strchr(" _[(:", text[i]) ? i + 1 : from;
  size_t n = last ? length - from : strcspn(text, " _])");
  snprintf(part, sizeof part, "%.*s", (int)(n < sizeof part ? n : 0), text + from);
  return eo_unit_find(part, factor);
}

/* Counts per turn as counts of an angle ("counts/deg") or the angle of a count ("arcsec per LSB"); 0: no such words. */
static double turn_by_ratio(const char *words, double number)
{
  static const char *const marks[] = {"/", " per ", "_per_", " pro ", " je ", " par ", " por "};
  for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
    const char *mark = strstr(words, marks[i]);
    double above, below;
    if (!mark)
      continue;
    enum eo_quantity over = part_of_ratio(words, (size_t)(mark - words), true, &above),
                     under = part_of_ratio(mark + strlen(marks[i]), strlen(mark + strlen(marks[i])), false, &below);
    if (over == EO_QUANTITY_COUNT && under == EO_QUANTITY_ANGLE)
      return number * (TURN / below);
    if (over == EO_QUANTITY_ANGLE && under == EO_QUANTITY_COUNT)
      return TURN / above / number;
  }
  return 0;
}

/* "1 count" before its angle. */
static bool is_one_count(const char *key)
{
  char name[KEY], unit[32];
  double factor;
  eo_unit_split(key, name, (int)sizeof name, unit, (int)sizeof unit);
  size_t length = strlen(name);
  return length && eo_unit_find(unit, &factor) == EO_QUANTITY_COUNT && name[length - 1] == '1' &&
         !(length > 1 && isdigit((unsigned char)name[length - 2]));
}

/* Counts per turn that a resolution in an angle makes, which is that of a count: "Resolution: 0.00004 deg"; else by the
   words of a ratio in the unit or in the key. 0: the number is none of these. */
static double turn_by_angle(const char *key, const char *name, const char *own, double number, const char *unit)
{
  char folded[KEY];
  double factor, turn = turn_by_ratio(*unit ? unit : key, number);
  enum eo_quantity quantity = eo_unit_find(*unit ? unit : own, &factor);
  eo_stated_fold_bare(name, folded);
  if (!(turn > 0) && quantity == EO_QUANTITY_ANGLE && number > 0 && (eo_stated_is_turn(folded) || is_one_count(key)))
    turn = TURN / factor / number;
  double whole = round(turn); /* the angle has few digits */
  turn = fabs(turn - whole) < 1e-6 ? whole : turn;
  return turn >= 16 && turn < 1e12 ? turn : 0;
}

bool eo_stated_keeps(const char *unit)
{
  double factor;
  return begins_with_bits(unit) || (eo_unit_find(unit, &factor) == EO_QUANTITY_ANGLE && factor < TURN);
}

bool eo_stated_read_turn(const char *key, const char *name, const char *own, double number, const char *unit,
                         struct eo_stated *stated)
{
  stated->vague = eo_stated_keeps(*unit ? unit : own);
  if (read_bits(key, name, own, number, unit, stated))
    return true;
  stated->value = turn_by_angle(key, name, own, number, unit);
  if (is_one_count(key)) { /* its 1 is no channel */
    char before[KEY];
    snprintf(before, sizeof before, "%.*s", (int)strlen(name) - 1, name);
    stated->member = eo_stated_member(before);
    stated->number = eo_stated_number(before);
    stated->vague = false;
  }
  stated->kind = stated->value > 0 ? EO_STATED_TURN : EO_STATED_NOTHING;
  return stated->value > 0;
}
