/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One JSON line per request on standard error. */
#ifndef EASEOFF_HTTP_LOG_H
#define EASEOFF_HTTP_LOG_H

#include "http/request.h"

void eo_log_request(const struct eo_request *request);

#endif
