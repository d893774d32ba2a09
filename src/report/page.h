/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of a report: head with its style, headings, paragraphs, lists. */
#ifndef EASEOFF_REPORT_PAGE_H
#define EASEOFF_REPORT_PAGE_H

#include <jansson.h>

#include "format/text.h"

void eo_page_begin(struct eo_text *text, const char *title);
void eo_page_end(struct eo_text *text);

/* level 2, 3 or 4. */
void eo_page_heading(struct eo_text *text, int level, const char *heading);
void eo_page_paragraph(struct eo_text *text, const char *paragraph);

/* An array of texts; nothing where it is empty. */
void eo_page_list(struct eo_text *text, const json_t *array);

/* A number with six digits, a flag as yes or no, a text as it is, null as a dash, a short array with commas. */
void eo_page_value(struct eo_text *text, const json_t *value);

#endif
