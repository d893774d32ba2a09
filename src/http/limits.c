/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/limits.h"

static const char *const levels[] = {"error", "warning", "info", NULL};

static const struct eo_field fields[] = {
    EO_INTEGER(struct eo_http_limits, connections_per_client, "connections_per_client", 1, 4000, 1500,
               "open connections of one address; all together 4000"),
    EO_INTEGER(struct eo_http_limits, streams, "streams", 1, 4000, 1000, "open event streams"),
    EO_INTEGER(struct eo_http_limits, uploads, "uploads", 1, 256, 16, "uploads on their way at once"),
    EO_INTEGER(struct eo_http_limits, uploads_per_client, "uploads_per_client", 1, 256, 4, "of them, of one address"),
    EO_NUMBER(struct eo_http_limits, upload_MB, "upload_MB", NULL, 0.001, 1e6, 2048, "size of one upload"),
    EO_NUMBER(struct eo_http_limits, recordings_GB, "recordings_GB", NULL, 0, 1e6, 64,
              "all recordings that are kept; more are refused, none is deleted"),
    EO_NUMBER(struct eo_http_limits, spare_MB, "spare_MB", NULL, 0, 1e6, 256,
              "that uploads leave free on the disk; below it the server says that it is not ready"),
    EO_NUMBER(struct eo_http_limits, reading_seconds, "reading_seconds", NULL, 1, 3600, 60,
              "processor time for reading one file of a format that is read in a process of its own"),
    EO_NUMBER(struct eo_http_limits, questions_at_once, "questions_at_once", NULL, 1, 1e6, 400,
              "analyses, checks and design writes of one address at once"),
    EO_NUMBER(struct eo_http_limits, questions_per_second, "questions_per_second", NULL, 0.01, 1e6, 100,
              "and how many more every second"),
    EO_NUMBER(struct eo_http_limits, starts_at_once, "starts_at_once", NULL, 1, 1e6, 100,
              "jobs, sweeps, fits, uploads of one address at once"),
    EO_NUMBER(struct eo_http_limits, starts_per_second, "starts_per_second", NULL, 0.01, 1e6, 2,
              "and how many more every second"),
    EO_NUMBER(struct eo_http_limits, wrong_tokens_per_minute, "wrong_tokens_per_minute", NULL, 1, 1e6, 30,
              "wrong tokens of one address that are told so; further ones wait. The right token never does"),
    EO_NUMBER(struct eo_http_limits, session_hours, "session_hours", NULL, 0.0001, 8760, 12,
              "after which a page has to give the token again"),
    EO_TEXT(struct eo_http_limits, base_path, "base_path",
            "path under which a proxy shows the server, for instance /easeoff; it stands in Location and cookies"),
    EO_TEXT(struct eo_http_limits, trusted_proxies, "trusted_proxies",
            "addresses (with /bits: networks) of proxies, separated by commas, whose X-Forwarded-For and "
            "X-Forwarded-Proto are believed"),
    EO_CHOICE(struct eo_http_limits, log_level, "log_level", levels, EO_LOG_INFO,
              "least grave lines in the log; info: every request and job"),
};
const struct eo_table eo_http_limits_table = EO_TABLE("limits of requests", struct eo_http_limits, fields);
