/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sentences for people, for whoever thinks in inches: "at least 0.5 mm" as "at least 0.019685 in", um in thousandths of
   an inch, keys that end in _mm or _um as inch.h spells them. Sentences are made in mm and um and stored so; a display
   converts them. A number is a length where the unit follows it, or ".." , "to", "and" or "is outside" with such a
   number; mm2, mm/s and N/um are none. The page does the same (web/src/base/units.js, less keys). */
#ifndef EASEOFF_FORMAT_INCH_SENTENCE_H
#define EASEOFF_FORMAT_INCH_SENTENCE_H

#include "base/error.h"
#include "format/text.h"

/* Adds the sentence, its lengths to as many digits as they have, at least five. */
void eo_inch_sentence(struct eo_text *text, const char *sentence);

/* Its sentence; the pointer stays. */
void eo_inch_error(struct eo_error *error);

#endif
