/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EASEOFF_HTTP_REQUEST_LOG_H
#define EASEOFF_HTTP_REQUEST_LOG_H

struct eo_request;

/* A request and its reply in the log: who asked for what and what came of it. */
void eo_log_request(const struct eo_request *request);

#endif
