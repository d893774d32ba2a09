/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/log.h"

#include <stdio.h>
#include <time.h>

#include "base/clock.h"
#include "format/json.h"

static void add_string(struct eo_text *line, const char *key, const char *value)
{
  char shown[200];
  eo_text_clean(shown, sizeof shown, value);
  json_t *string = json_string(shown);
  if (!string)
    string = json_string("?"); /* not UTF-8 */
  eo_text_print(line, ",\"%s\":", key);
  if (string)
    eo_json_write(line, string, EO_JSON_COMPACT);
  json_decref(string);
}

void eo_log_request(const struct eo_request *request)
{
  struct eo_text line = {0};
  struct timespec now;
  struct tm utc;
  char time[40];
  clock_gettime(CLOCK_REALTIME, &now);
  gmtime_r(&now.tv_sec, &utc);
  strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%S", &utc);
  eo_text_print(&line, "{\"time\":\"%s.%03ldZ\",\"id\":\"%s\"", time, now.tv_nsec / 1000000, request->id);
  add_string(&line, "method", request->method_name);
  add_string(&line, "path", request->path);
  eo_text_print(&line, ",\"status\":%u,\"bytes\":%zu,\"ms\":%.1f}\n", request->reply.status, request->sent,
                eo_clock_milliseconds() - request->started);
  if (!line.failed)
    fwrite(line.data, 1, line.size, stderr);
  eo_text_done(&line);
}
