/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What clients may do and how much, as whoever runs the server says: one table, read from the configuration file and
   from options, and described by `easeoff serve --help`. */
#ifndef EASEOFF_HTTP_LIMITS_H
#define EASEOFF_HTTP_LIMITS_H

#include "format/table.h"

enum { EO_MOST_CONNECTIONS = 4000 }; /* of all clients together */

enum eo_log_level { EO_LOG_ERROR, EO_LOG_WARNING, EO_LOG_INFO };

struct eo_http_limits {
  int connections_per_client, streams, uploads, uploads_per_client;
  double upload_MB, recordings_GB, spare_MB, reading_seconds;
  double questions_at_once, questions_per_second, starts_at_once, starts_per_second, wrong_tokens_per_minute;
  double session_hours;
  char base_path[100], trusted_proxies[500];
  int log_level; /* enum eo_log_level */
};

extern const struct eo_table eo_http_limits_table;

#endif
