/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The thread that looks once a second whose time is over, and keeps event streams alive. */
#ifndef EASEOFF_HTTP_TICKER_H
#define EASEOFF_HTTP_TICKER_H

#include "base/error.h"

struct eo_http;

/* The watchdog: closes slow connections, keeps streams alive. Errors: memory, which a thread that cannot start counts
 * as. */
enum eo_code eo_ticker_start(struct eo_http *http, struct eo_error *error);
void eo_ticker_stop(struct eo_http *http); /* after http->closing was set */

#endif
