/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The log: JSON lines on standard error. A thread of its own writes them, so that whoever reads slowly or not at all
   holds nobody up: what does not fit into the room between is dropped, counted, and told as soon as there is room. */
#ifndef EASEOFF_HTTP_LOG_H
#define EASEOFF_HTTP_LOG_H

#include <stdint.h>

#include "base/error.h"
#include "http/limits.h"

struct eo_log;

/* Lines of this level and above, on standard error, by a thread of their own. Errors: memory, which a thread that
 * cannot start counts as. */
enum eo_code eo_log_new(struct eo_log **log, enum eo_log_level level, struct eo_error *error);

/* Waits for the reader of what is left, a second at most. NULL is fine. */
void eo_log_free(struct eo_log *log);

/* {"time", "level", "event", "text"}. From any thread; log may be NULL. event: one word. */
void eo_log_event(struct eo_log *log, enum eo_log_level level, const char *event, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* A line by parts. Begin: with time, level and event; false: no such lines are wanted, and log may be NULL. Add: a key
   with at most so many bytes of a text. Put: ends the line and takes it over. */
bool eo_log_begin(const struct eo_log *log, enum eo_log_level level, const char *event, struct eo_text *line);
void eo_log_add(struct eo_text *line, const char *key, const char *value, size_t most);
void eo_log_put(struct eo_log *log, struct eo_text *line);

/* Lines that were dropped since the start. */
uint64_t eo_log_dropped(struct eo_log *log);

#endif
