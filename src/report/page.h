/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of a report: head with its style, headings, paragraphs, lists; and the unit in which it gives lengths. */
#ifndef EASEOFF_REPORT_PAGE_H
#define EASEOFF_REPORT_PAGE_H

#include <jansson.h>

#include "format/inch.h"
#include "format/text.h"
#include "format/unit.h"

/* inches: the documents that are read are spelt in inches (eo_inch_from_mm()); tables, figures and sentences follow. */
struct eo_page {
  struct eo_text *text; /* borrowed */
  bool inches;
};

/* Head of the HTML file with its style; title: escaped here. */
void eo_page_begin(const struct eo_page *page, const char *title);
/* Closes what eo_page_begin() opened. */
void eo_page_end(const struct eo_page *page);

/* How a key, or a pointer or path that ends in one, is spelt here: the key itself, or spelt. */
const char *eo_page_key(const struct eo_page *page, const char *key, char spelt[EO_INCH_KEY]);

/* The symbol of a unit of keys: lengths alone are converted; "" for NULL. */
const char *eo_page_unit(const struct eo_page *page, const struct eo_unit *unit);

/* A member of an object, what a path with slashes leads to: by the names they have in mm. Borrowed; NULL: none. */
const json_t *eo_page_member(const struct eo_page *page, const json_t *object, const char *key);
const json_t *eo_page_find(const struct eo_page *page, const json_t *value, const char *path);

/* A sentence of the program's, escaped, its lengths in the page's unit. */
void eo_page_say(const struct eo_page *page, const char *sentence);

/* level 2, 3 or 4. */
void eo_page_heading(const struct eo_page *page, int level, const char *heading);
void eo_page_paragraph(const struct eo_page *page, const char *paragraph);

/* An array of sentences; nothing where it is empty. */
void eo_page_list(const struct eo_page *page, const json_t *array);

/* A number with six digits, a flag as yes or no, a text as it is, null as a dash, a short array with commas. */
void eo_page_value(const struct eo_page *page, const json_t *value);

#endif
