/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "document/design_export.h"

static int list_formats(void)
{
  struct eo_text text = {0};
  const struct eo_export *format;
  for (int i = 0; (format = eo_export_at(i)); i++)
    eo_text_print(&text, "%-20s %s\n", format->name, format->summary);
  return eo_app_print(&text);
}

static const struct eo_export *find_format(const char *name, int *status)
{
  struct eo_error error;
  const struct eo_export *format = name ? eo_export_find(name) : NULL;
  if (format)
    return format;
  eo_error_set(&error, EO_ERROR_INPUT, "",
               name ? "There is no format \"%.40s\"; easeoff export lists them."
                    : "--format NAME is missing%s; easeoff export lists them.",
               name ? name : "");
  *status = eo_app_fail(NULL, &error);
  return NULL;
}

static int save(const struct eo_export *format, const struct eo_design *design, const struct eo_geometry *geometry,
                const char *path)
{
  struct eo_text text = {0};
  struct eo_error error;
  format->write(design, geometry, &text);
  if (!path || strcmp(path, "-") == 0)
    return eo_app_print(&text);
  int status = EO_EXIT_DONE;
  if (eo_text_save(&text, path, &error))
    status = eo_app_fail(NULL, &error);
  eo_text_done(&text);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  const char *file, *name = NULL, *path = NULL;
  int operands, status;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  const struct eo_option options[] = {
      {.name = "--format", .value = &name}, {.name = "-o", .value = &path}, {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 0, 1, &file, &operands, &status))
    return status;
  if (!operands)
    return list_formats();
  const struct eo_export *format = find_format(name, &status);
  if (!format || !eo_app_load_design(file, &design, &geometry, &warnings, &status))
    return status;
  return save(format, &design, &geometry, path);
}

const struct eo_command eo_command_export = {
    "export", "DESIGN.json --format NAME [-o FILE]", "a file for another program: flank points, charts, topography",
    "Without a design, the list of formats. Without -o the file goes to standard output.\n\n"
    "Points stand in the frame of each member: z along the axis, from the middle of the groove to the right; the "
    "working flank of a\n"
    "tooth faces +x and would, unmodified, pass through x = 0 at the working pitch radius in mid face. Normals point "
    "out of the tooth.\n",
    run};
