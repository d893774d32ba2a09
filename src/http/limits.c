/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/limits.h"

static const char *const levels[] = {"error", "warning", "info", NULL};

static const struct eo_field fields[] = {
    EO_INTEGER(struct eo_http_limits, connections_per_client, "connections_per_client", 1, EO_MOST_CONNECTIONS, 1500,
               "open connections of one address; all addresses together may have the largest value"),
    EO_INTEGER(struct eo_http_limits, streams, "streams", 1, EO_MOST_CONNECTIONS, 1000, "open event streams"),
    EO_INTEGER(struct eo_http_limits, uploads, "uploads", 1, 256, 16, "uploads that arrive at the same time"),
    EO_INTEGER(struct eo_http_limits, uploads_per_client, "uploads_per_client", 1, 256, 4,
               "uploads of one address that arrive at the same time"),
    EO_NUMBER(struct eo_http_limits, upload_MB, "upload_MB", NULL, 0.001, 1e6, 2048, "size of one upload"),
    EO_NUMBER(struct eo_http_limits, recordings_GB, "recordings_GB", NULL, 0, 1e6, 64,
              "size of all recordings together; beyond it uploads are refused, nothing is deleted"),
    EO_NUMBER(struct eo_http_limits, spare_MB, "spare_MB", NULL, 0, 1e6, 256,
              "space that uploads leave free on the disk; with less the server says that it is not ready"),
    EO_NUMBER(struct eo_http_limits, reading_seconds, "reading_seconds", NULL, 1, 3600, 60,
              "processor time for reading one file of a format that is read in a process of its own"),
    EO_NUMBER(struct eo_http_limits, questions_at_once, "questions_at_once", NULL, 1, 1e6, 400,
              "analyses, checks and writes of designs that one address may ask for at once"),
    EO_NUMBER(struct eo_http_limits, questions_per_second, "questions_per_second", NULL, 0.01, 1e6, 100,
              "analyses, checks and writes of designs that one address may then ask for each second"),
    EO_NUMBER(struct eo_http_limits, starts_at_once, "starts_at_once", NULL, 1, 1e6, 100,
              "jobs, sweeps, fits and uploads that one address may start at once"),
    EO_NUMBER(struct eo_http_limits, starts_per_second, "starts_per_second", NULL, 0.01, 1e6, 2,
              "jobs, sweeps, fits and uploads that one address may then start each second"),
    EO_NUMBER(
        struct eo_http_limits, wrong_tokens_per_minute, "wrong_tokens_per_minute", NULL, 1, 1e6, 30,
        "wrong tokens of one address that are answered; after them its connections with a wrong token are closed, and "
        "the right token still passes"),
    EO_NUMBER(struct eo_http_limits, session_hours, "session_hours", NULL, 0.0001, 8760, 12,
              "time after which the page asks for the token again"),
    EO_TEXT(
        struct eo_http_limits, base_path, "base_path",
        "path under which a proxy shows the server, for instance /easeoff; the server puts it in Location and cookies"),
    EO_TEXT(struct eo_http_limits, trusted_proxies, "trusted_proxies",
            "addresses (with /bits: networks) of proxies, separated by commas, whose X-Forwarded-For and "
            "X-Forwarded-Proto are believed"),
    EO_CHOICE(struct eo_http_limits, log_level, "log_level", levels, EO_LOG_INFO,
              "which lines the log has: errors; warnings too; info: every request and job too"),
};
const struct eo_table eo_http_limits_table = EO_TABLE("limits of requests", struct eo_http_limits, fields);
