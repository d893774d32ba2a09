/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of a key, and which of them speak of an encoder's turn. Internal to what is stated. */
#ifndef EASEOFF_RECORDING_STATED_PRIVATE_H
#define EASEOFF_RECORDING_STATED_PRIVATE_H

#include "recording/stated.h"

#define EO_STATED_KEY 96

static inline struct eo_stated eo_stated_nothing(void)
{
  return (struct eo_stated){.member = -1, .number = -1};
}

/* The key without accents, in lower case, with nothing but letters, digits and the slash of "samples/s". */
void eo_stated_fold(const char *key, char folded[EO_STATED_KEY]);

/* The same without the words that only say whose it is. */
void eo_stated_fold_bare(const char *key, char folded[EO_STATED_KEY]);

/* True when the key is one of the words, which blanks part. */
bool eo_stated_is_one(const char *key, const char *words);

/* True when one of the words stands in the key. */
bool eo_stated_holds(const char *key, const char *words);

/* A folded key of counts, lines or pulses per turn. */
bool eo_stated_is_turn(const char *key);

/* A folded key of what multiplies the lines: interpolation, or the edges that a counter takes. */
bool eo_stated_is_fold(const char *key);

/* "counts/rev", "pulses per revolution", "PPR" behind a number under this name. */
bool eo_stated_is_turn_unit(const char *name, const char *unit);

/* Lines and pulses, of which a counter may take more than one edge; counts and increments have them all. */
bool eo_stated_are_lines(const char *key, const char *unit);

/* Counts per turn by what the unit says, to *stated: bits of an encoder ("22 bit", or 22 under "Bits per turn"), the
   angle of a count ("Resolution: 0.00004 deg", "1 count = 0.0001 deg"), a ratio in the unit or in the key
   ("counts/deg", "arcsec per LSB"). own: the unit in the key, name: the key without it. True: the number is one of
   these, or one of bits that state nothing of a turn. */
bool eo_stated_read_turn(const char *key, const char *name, const char *own, double number, const char *unit,
                         struct eo_stated *stated);

#endif
