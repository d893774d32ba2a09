/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files for other programs. */
#include <stdio.h>
#include <string.h>

#include "http/answers.h"
#include "format/object.h"
#include "exchange/exports.h"
#include "format/inch.h"
#include "http/route.h"
#include "http/http_private.h"

/* The notes on a file as one header field. */
static void tell(const struct eo_export *format, const struct eo_text *file, char *notes, size_t size)
{
  struct eo_text lines = {0};
  size_t length = 0;
  eo_exports_tell(format, file, &lines);
  for (const char *line = lines.data; line && *line && length < size; line = strchr(line, '\n') + 1)
    length += (size_t)snprintf(notes + length, size - length, "%s%.*s", length ? "; " : "", (int)strcspn(line, "\n"),
                               line);
  eo_text_done(&lines);
}

static void export(struct eo_request *request)
{
  const struct eo_export *format = eo_exports_find(request->argument[0]);
  struct eo_design design;
  struct eo_geometry geometry;
  if (!format) {
    eo_reply_problem(&request->reply, 404, NULL, "There is no format of this name; " EO_API "/export lists them.");
    return;
  }
  if (request->reply.inches && !eo_export_has_columns(format)) {
    eo_reply_problem(&request->reply, 400, "query",
                     "The query parameter units=inch is for tables of columns: flank-points, topography, "
                     "modification-chart; %s has the units that its readers expect.",
                     format->name);
    return;
  }
  const json_t *body = eo_request_json(request);
  if (body && eo_request_design(request, body, "", &design, &geometry, NULL)) {
    struct eo_text text = {0};
    struct eo_error error;
    if (eo_export_write(format, &design, &geometry, (int)eo_route_number(request, "rows"),
                        (int)eo_route_number(request, "columns"), &text, &error)) {
      eo_reply_error(&request->reply, "", &error);
      return;
    }
    if (request->reply.inches)
      eo_inch_table(&text);
    tell(format, &text, request->reply.notes, sizeof request->reply.notes);
    eo_reply_text(&request->reply, 200, format->type, &text);
    eo_export_file_name(format, &design, request->reply.file_name, sizeof request->reply.file_name);
  }
}

static json_t *write_inches(const void *format)
{
  return json_boolean(eo_export_has_columns(format));
}

struct listed_exports {
  json_t *items;
};
static const struct eo_outline_row export_rows[] = {
    EO_KEY("name", "text", "in its address", EO_AT(struct eo_export, name)),
    EO_KEY("title", "text", "for people", EO_AT(struct eo_export, summary)),
    EO_KEY("type", "text", "media type", EO_AT(struct eo_export, type)),
    EO_KEY("inches", "flag", "units=inch gives it in inches", .write = write_inches),
};
static const struct eo_outline export_outline = EO_OUTLINE("Export", export_rows);
static const struct eo_outline_row exports_rows[] = {
    EO_KEY("items", "[object]", "formats", .outline = &export_outline, EO_AT(struct listed_exports, items)),
};
const struct eo_outline eo_outline_exports = EO_OUTLINE("Exports", exports_rows);

static void list(struct eo_request *request)
{
  struct eo_object items = eo_list_open();
  const struct eo_export *format;
  for (int i = 0; (format = eo_exports_at(i)); i++)
    eo_list_add(&items, eo_outline_encode(&export_outline, format));
  const struct listed_exports exports = {eo_object_close(&items)};
  eo_reply_json(&request->reply, 200, eo_outline_encode(&eo_outline_exports, &exports));
}

const struct eo_route eo_routes_export[] = {
    {.method = EO_GET,
     .pattern = "/export",
     .handle = list,
     .name = "listExports",
     .summary = "The formats of exported files.",
     .gives = "200 Exports"},
    {.method = EO_POST,
     .pattern = "/export/{format}",
     .handle = export,
     .name = "exportDesign",
     .takes = "Design",
     .rate = EO_RATE_START,
     .aside = true,
     .gives =
         "200 text/csv, 200 ResolvedDesign, 200 application/xml, 200 application/zip, 200 model/step, 200 model/stl, "
         "200 application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
     .query = {{"rows", EO_EXPORT_GRID_LEAST, EO_EXPORT_GRID_MOST, EO_EXPORT_ROWS, NULL,
                "points of a flank from root to tip"},
               {"columns", EO_EXPORT_GRID_LEAST, EO_EXPORT_GRID_MOST, EO_EXPORT_COLUMNS, NULL,
                "points of a flank over the face"},
               EO_UNITS_QUERY},
     .summary = "A file for another program, as `easeoff export` writes it: points of the flanks, charts, the design. "
                "Easeoff-Notes says which face of a STEP file is further off than 5 nm."},
    {0}};
