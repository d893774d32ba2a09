/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/stored_measurement.h"

#include <stdio.h>
#include <string.h>

#include "document/layout_document.h"
#include "document/measurement_document.h"
#include "format/json.h"
#include "format/object.h"
#include "http/answers.h"

/* What is known of its storage, as it is written. */
struct storage {
  int64_t id, design;
  const char *created;
  double speed;       /* rad/s; NaN: not stated */
  const char *layout; /* JSON; "": none */
  int files;
  const struct eo_measurement_file *file;
};

static json_t *write_layout(const void *source)
{
  const struct storage *storage = source;
  struct eo_error error;
  return *storage->layout ? eo_json_parse(storage->layout, strlen(storage->layout), &error) : json_null();
}

#define OF_FILE(member) EO_AT(struct eo_measurement_file, member)
static const struct eo_outline_row file_rows[] = {
    EO_KEY("name", "text", "without folders", OF_FILE(name)),
    EO_KEY("size", "integer", "bytes", OF_FILE(size)),
    EO_KEY("sha256", "text", "of its bytes", OF_FILE(sha256)),
};
static const struct eo_outline file_outline = EO_OUTLINE("StoredFile", file_rows);

#define OF_STORAGE(member) EO_AT(struct storage, member)
static const struct eo_outline_row storage_rows[] = {
    EO_KEY("id", "integer", "number of the measurement", OF_STORAGE(id)),
    EO_KEY("design", "integer", "number of the design", OF_STORAGE(design)),
    EO_KEY("created", "text", "date and time, UTC", OF_STORAGE(created)),
    EO_KEY("stated_speed_rpm", "number?", "as it was said", .unit = &eo_unit_rpm, OF_STORAGE(speed)),
    EO_KEY("asked_layout", "object?", "as it was asked for", .table = &eo_asked_layout_table, .name = "AskedLayout",
           .sparse = true, .write = write_layout),
    EO_KEY("files", "[object]", "as they came", .outline = &file_outline, EO_ROWS_AT(struct storage, file, files)),
};
const struct eo_outline eo_outline_stored = EO_OUTLINE("Stored", storage_rows);

/* The rows of the document behind those of the storage: described together, written by those who know each. */
static const struct eo_outline_row measurement_rows[] = {{.outline = &eo_outline_stored},
                                                         {.outline = &eo_measurement_outline}};
const struct eo_outline eo_outline_stored_measurement = EO_OUTLINE("Measurement", measurement_rows);

static const struct eo_outline_row listed_rows[] = {{.outline = &eo_outline_stored},
                                                    {.outline = &eo_measurement_brief}};
const struct eo_outline eo_outline_listed_measurement = EO_OUTLINE("ListedMeasurement", listed_rows);

static json_t *encode_storage(const struct eo_stored_measurement *row)
{
  const struct storage storage = {.id = row->id,
                                  .design = row->design,
                                  .created = row->created,
                                  .speed = row->speed,
                                  .layout = row->layout,
                                  .files = row->files,
                                  .file = row->file};
  return eo_outline_encode(&eo_outline_stored, &storage);
}

json_t *eo_listed_measurement_encode(const struct eo_stored_measurement *row)
{
  struct eo_error error;
  json_t *listed = encode_storage(row), *summary = eo_json_parse(row->summary, strlen(row->summary), &error);
  bool good = listed && summary && json_object_update(listed, summary) == 0;
  json_decref(summary);
  return good ? listed : (json_decref(listed), NULL);
}

/* The result is large and stays the text that it is kept as: its members go on where those of the storage end. */
static void write_stored(const struct eo_stored_measurement *row, struct eo_text *text)
{
  json_t *storage = encode_storage(row);
  if (storage)
    eo_json_write(text, storage, EO_JSON_COMPACT);
  text->failed = text->failed || !storage;
  json_decref(storage);
  if (text->failed)
    return;
  text->data[--text->size] = '\0'; /* its closing brace */
  eo_text_print(text, ",%s", row->result + 1);
}

enum eo_code eo_measurement_take(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct eo_found_measurement *found = context;
  found->id = row->id;
  snprintf(found->tag, sizeof found->tag, "%s", row->digest);
  write_stored(row, &found->text);
  return found->text.failed ? eo_error_memory(error) : EO_OK;
}

void eo_reply_no_measurement(struct eo_reply *reply)
{
  eo_reply_problem(reply, 404, NULL, "There is no measurement with this number.");
}
