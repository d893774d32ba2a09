/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a reader or a guess has to say to people: a short list of full sentences. */
#ifndef EASEOFF_RECORDING_NOTES_H
#define EASEOFF_RECORDING_NOTES_H

#define EO_NOTES 48
#define EO_NOTE_LENGTH 256

struct eo_notes {
  int count;
  char text[EO_NOTES][EO_NOTE_LENGTH]; /* [count], sentences in English */
};

/* Adds a sentence; beyond EO_NOTES it is dropped. notes may be NULL. */
void eo_notes_add(struct eo_notes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
