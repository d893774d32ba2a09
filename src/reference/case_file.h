/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case file as a tree that remembers what was read of it: what nobody read is a fault in the end, so a misspelt key
   cannot pass unnoticed. Faults (wrong type, missing or unread key) are collected with their JSON pointers; a function
   that meets one returns NaN, NULL or 0, and the caller asks eo_case_faulty() before it computes. Every function takes
   NULL for "not there". Commentary may stand anywhere and is never read: about, what, note, notes, source, remarks,
   units, conventions, uncertainty, mesh, reference_*. */
#ifndef EASEOFF_REFERENCE_CASE_FILE_H
#define EASEOFF_REFERENCE_CASE_FILE_H

#include <stdbool.h>

#include <jansson.h>

#include "format/faults.h"

/* One value of a case file. Opaque; belongs to its file. */
struct eo_case;

/* Takes over the document. NULL without memory. */
struct eo_case *eo_case_open(json_t *document);
void eo_case_close(struct eo_case *file);

const struct eo_faults *eo_case_faults(const struct eo_case *value);
/* True for NULL as well: what is needed and not there is a fault already. */
bool eo_case_faulty(const struct eo_case *value);
/* A fault at the value; the text is one sentence. */
void eo_case_fault(const struct eo_case *value, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The member of that name; NULL when it is absent. need: absence is a fault. given: null counts as absent. */
struct eo_case *eo_case_find(struct eo_case *object, const char *key);
struct eo_case *eo_case_need(struct eo_case *object, const char *key);
struct eo_case *eo_case_given(struct eo_case *object, const char *key);

/* A text of that name; NULL, and nothing is read, when there is no text. */
const char *eo_case_peek_text(struct eo_case *object, const char *key);

/* Members of an object or elements of a list, in the order of the file; 0 for anything else. */
int eo_case_size(const struct eo_case *value);
struct eo_case *eo_case_at(struct eo_case *value, int index);
/* The same without reading it. */
struct eo_case *eo_case_peek(const struct eo_case *value, int index);

struct eo_case *eo_case_parent(const struct eo_case *value); /* NULL: of the file itself */
int eo_case_index(const struct eo_case *value);              /* of an element in its list */
const char *eo_case_key(const struct eo_case *value);        /* NULL: an element of a list */
const json_t *eo_case_json(const struct eo_case *value);
void eo_case_pointer(const struct eo_case *value, char *pointer, int size);
bool eo_case_is_object(const struct eo_case *value);
bool eo_case_is_list(const struct eo_case *value);
bool eo_case_is_text(const struct eo_case *value);
bool eo_case_is_null(const struct eo_case *value);

/* The value itself as a number, text or flag; a fault when it is something else. */
double eo_case_real(struct eo_case *value);
const char *eo_case_text(struct eo_case *value);
bool eo_case_flag(struct eo_case *value);
/* An element of a list as a number; a fault when there is none. */
double eo_case_element(struct eo_case *list, int index);

/* The member of that name; a fault when it is something else than the type, or absent without a substitute. */
double eo_case_number(struct eo_case *object, const char *key);
double eo_case_number_or(struct eo_case *object, const char *key, double missing);
int eo_case_whole(struct eo_case *object, const char *key, int low, int high);
int eo_case_whole_or(struct eo_case *object, const char *key, int low, int high, int missing);
bool eo_case_flag_or(struct eo_case *object, const char *key, bool missing);
const char *eo_case_word(struct eo_case *object, const char *key);
/* NULL when absent. */
const char *eo_case_word_given(struct eo_case *object, const char *key);
/* Index among the words (ends with NULL); -1 and a fault when it is none of them. */
int eo_case_choice(struct eo_case *object, const char *key, const char *const *words, int missing);
/* A stated tolerance: > 0, and below 1 when it is relative. */
double eo_case_relative_or(struct eo_case *object, const char *key, double missing);
double eo_case_absolute_or(struct eo_case *object, const char *key, double missing);

/* A list of `count` numbers (count < 0: of any length up to most). Returns its length, or -1 with a fault. */
int eo_case_numbers(struct eo_case *list, int count, int most, double *number);
/* Largest size among the numbers of a list, of lists in it as well. */
double eo_case_largest(struct eo_case *list);

/* Everything below counts as read: information that is not compared, or a case that has already failed. */
void eo_case_skip(struct eo_case *value);
/* The member, where present, is a text (or a list of texts) for people. */
void eo_case_remark(struct eo_case *object, const char *key);
/* True for the keys that are commentary everywhere. */
bool eo_case_is_commentary(const char *key);

/* Faults for all that stands below the value and was not read. Where a key was missing, only the unread keys beside it
   are told: they are the likely misspellings. */
void eo_case_sweep(struct eo_case *value);

#endif
