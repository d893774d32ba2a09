/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lengths in inches at the border. Documents keep mm and um; whoever thinks in inches may state a key that ends in
   "_mm" with "_in" in its place, and one that ends in "_um" with "_thou" (thousandths of an inch), and ask for answers
   spelt so. What is not a length alone ("_N_per_mm", "_per_um") stays. */
#ifndef EASEOFF_FORMAT_INCH_H
#define EASEOFF_FORMAT_INCH_H

#include <stdbool.h>

#include <jansson.h>

#include "format/faults.h"
#include "format/text.h"

/* Some key of the document, at any depth, is in inches. */
bool eo_inch_is_used(const json_t *document);

/* New: the same in mm and um, to 15 digits. A key that is there in both is a fault at it; NULL without memory. */
json_t *eo_inch_to_mm(const json_t *document, struct eo_faults *faults);

/* New: the same in inches and thousandths, to 15 digits; so is the value of a row whose "key" points to a length, and
   so are the sentences (inch_sentence.h) below "warnings", "notes", "text", "detail", "rule", "unchecked" and reasons.
   NULL without memory. */
json_t *eo_inch_from_mm(const json_t *document);

/* Gives a key that the document has in inches back that spelling in the pointer of a fault that was found in mm, and
   the fault's sentence its unit. */
void eo_inch_place(const json_t *document, struct eo_error *fault);

/* How the key, of so many bytes, is spelt in inches; false: it is no length. */
enum { EO_INCH_KEY = 208 };
bool eo_inch_key(const char *key, size_t length, char inch[EO_INCH_KEY]);

/* A table of comma-separated values whose first line names its columns, the same way: heads that end in "_mm" or "_um"
   and the numbers below them. *table is replaced; failed without memory. */
void eo_inch_table(struct eo_text *table);

#endif
