/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/stored_measurement.h"

#include <stdio.h>

#include "format/json.h"

static void add_json(struct eo_text *text, json_t *value)
{
  if (value)
    eo_json_write(text, value, EO_JSON_COMPACT);
  text->failed = text->failed || !value;
  json_decref(value);
}

static void add_files(struct eo_text *text, const struct eo_stored_measurement *row)
{
  json_t *files = json_array();
  for (int i = 0; i < row->files; i++)
    json_array_append_new(files, json_pack("{s:s, s:I, s:s}", "name", row->file[i].name, "size",
                                           (json_int_t)row->file[i].size, "sha256", row->file[i].sha256));
  eo_text_add(text, ",\"files\":");
  add_json(text, files);
}

void eo_stored_measurement_write(const struct eo_stored_measurement *row, const char *document, struct eo_text *text)
{
  eo_text_print(text, "{\"id\":%lld,\"design\":%lld,\"created\":\"%s\",\"stated_speed_rpm\":", (long long)row->id,
                (long long)row->design, row->created);
  json_t *speed = eo_json_real(row->speed, &eo_unit_rpm);
  add_json(text, speed);
  eo_text_print(text, ",\"asked_layout\":%s", *row->layout ? row->layout : "null");
  add_files(text, row);
  eo_text_add(text, ",");
  eo_text_add(text, document + 1);
}

enum eo_code eo_measurement_take(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct eo_found_measurement *found = context;
  found->id = row->id;
  snprintf(found->tag, sizeof found->tag, "%s", row->digest);
  eo_stored_measurement_write(row, row->result, &found->text);
  return found->text.failed ? eo_error_memory(error) : EO_OK;
}

void eo_reply_no_measurement(struct eo_reply *reply)
{
  eo_reply_problem(reply, 404, NULL, "There is no measurement with this number.");
}
