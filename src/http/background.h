/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Requests that take longer than a moment but need no gear pair (histories, exported files): one thread with a
   connection to the database of its own works them off, so that the HTTP thread need not. */
#ifndef EASEOFF_HTTP_BACKGROUND_H
#define EASEOFF_HTTP_BACKGROUND_H

#include "http/request.h"

struct eo_background;

enum { EO_MOST_BACKGROUND = 64 };

/* data: folder of the database. Errors: of opening it, memory. */
enum eo_code eo_background_new(struct eo_background **aside, const char *data, struct eo_error *error);

/* Runs the route's handler on the other thread and sends what it replies; 503 when too many wait. */
void eo_background_take(struct eo_background *aside, struct eo_request *request);

/* Works off what waits, ends the thread. NULL is fine. */
void eo_background_free(struct eo_background *aside);

#endif
