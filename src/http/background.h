/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Requests that take longer than a moment but need no gear pair (histories, exported files, recordings): threads with a
   connection to the database of their own work them off, so that the HTTP thread need not. Where there are several, one
   client's requests never hold the last of them. */
#ifndef EASEOFF_HTTP_BACKGROUND_H
#define EASEOFF_HTTP_BACKGROUND_H

#include "http/request.h"

struct eo_background;

enum { EO_MOST_BACKGROUND = 64, EO_READERS = 3 /* threads for recordings */ };

/* data: folder of the database. Errors: of opening it, memory. */
enum eo_code eo_background_new(struct eo_background **aside, const char *data, int threads, struct eo_error *error);

/* Runs the route's handler on the other thread and sends what it replies; 503 when too many wait. */
void eo_background_take(struct eo_background *aside, struct eo_request *request);

/* How many requests wait. */
int eo_background_waiting(struct eo_background *aside);

/* Works off what waits, ends the threads. NULL is fine. */
void eo_background_free(struct eo_background *aside);

#endif
