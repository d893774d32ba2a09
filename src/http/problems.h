/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every kind of problem that a reply can name: "/problems/NAME" in its type is a page that says what it means and what
   can be done, and the API's description lists them by their status. */
#ifndef EASEOFF_HTTP_PROBLEMS_H
#define EASEOFF_HTTP_PROBLEMS_H

#include <stdbool.h>

#include "format/text.h"

struct eo_problem {
  const char *name; /* NULL ends the table */
  unsigned status;
  const char *means, *remedy; /* one sentence each */
};

extern const struct eo_problem eo_problems[];

const struct eo_problem *eo_problem_find(const char *name); /* NULL: there is none */

/* The names with this status, ", " between them, to the text; false: there is none. */
bool eo_problems_list(unsigned status, struct eo_text *text);

/* The page of one, or of all (NULL), as HTML. */
void eo_problem_write(const struct eo_problem *problem, struct eo_text *text);

#endif
