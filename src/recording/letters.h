/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words as they are compared: lower case and without accents, since "Fréquence" is written with and without. Internal.
 */
#ifndef EASEOFF_RECORDING_LETTERS_H
#define EASEOFF_RECORDING_LETTERS_H

#include <stdbool.h>
#include <stddef.h>

/* Copies text to plain (of size bytes, ended by 0, cut where it is too long). Letters of Latin 1, as UTF-8 or as single
   bytes, lose their accents; other bytes above 127 stay as they are. */
void eo_letters_plain(const char *text, size_t length, char *plain, size_t size);

/* Whether a text is one of the words, which stand plain between bars: "time|zeit|temps". */
bool eo_letters_listed(const char *text, size_t length, const char *words);

#endif
