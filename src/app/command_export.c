/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/number.h"
#include "exchange/exports.h"
#include "format/inch.h"

enum { MOST_DESIGNS = 200 };

/* A number that the preprocessor knows, as text. */
#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)
#define ROWS TEXT(EO_EXPORT_ROWS)
#define COLUMNS TEXT(EO_EXPORT_COLUMNS)

static int list_formats(void)
{
  struct eo_text text = {0};
  const struct eo_export *format;
  for (int i = 0; (format = eo_exports_at(i)); i++)
    eo_text_print(&text, "%-20s %s\n", format->name, format->summary);
  return eo_app_print(&text);
}

static const struct eo_export *find_format(const char *name, int *status)
{
  struct eo_error error;
  const struct eo_export *format = name ? eo_exports_find(name) : NULL;
  if (format)
    return format;
  eo_error_set(&error, EO_ERROR_INPUT, "",
               name ? "There is no format \"%.40s\"; easeoff export lists them."
                    : "--format NAME is missing%s; easeoff export lists them.",
               name ? name : "");
  *status = eo_app_fail(NULL, &error);
  return NULL;
}

static bool read_grid(const char *rows, const char *columns, int grid[2], int *status)
{
  struct eo_error error;
  const char *const value[2] = {rows, columns}, *const name[2] = {"--rows", "--columns"};
  for (int i = 0; i < 2; i++) {
    grid[i] = 0;
    if (value[i] &&
        !eo_app_read_whole(value[i], name[i], EO_EXPORT_GRID_LEAST, EO_EXPORT_GRID_MOST, &grid[i], &error)) {
      *status = eo_app_fail(NULL, &error);
      return false;
    }
  }
  return true;
}

static int save_text(struct eo_text *text, const char *path)
{
  struct eo_error error;
  if (!path || strcmp(path, "-") == 0)
    return eo_app_print(text);
  int status = eo_text_save(text, path, &error) ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
  eo_text_done(text);
  return status;
}

static void tell(const struct eo_export *format, const struct eo_text *file)
{
  struct eo_text notes = {0};
  eo_exports_tell(format, file, &notes);
  for (const char *line = notes.data; line && *line; line = strchr(line, '\n') + 1)
    fprintf(stderr, "easeoff: %.*s\n", (int)strcspn(line, "\n"), line);
  eo_text_done(&notes);
}

static int save(const struct eo_export *format, const struct eo_design *design, const struct eo_geometry *geometry,
                const int grid[2], bool inches, const char *path)
{
  struct eo_text text = {0};
  struct eo_error error;
  if (eo_export_write(format, design, geometry, grid[0], grid[1], &text, &error))
    return eo_app_fail(NULL, &error);
  if (inches)
    eo_inch_table(&text);
  tell(format, &text);
  return save_text(&text, path);
}

/* Several designs into one table. */
static int save_many(const struct eo_export *format, const char *const *file, int files, const char *path)
{
  json_t *documents[MOST_DESIGNS] = {NULL};
  struct eo_text text = {0};
  struct eo_error error;
  int status = EO_EXIT_DONE, read = 0;
  for (; read < files && !status; read++) {
    struct eo_design design;
    struct eo_geometry geometry;
    struct eo_warnings warnings = {0};
    if (eo_app_load_design(file[read], &design, &geometry, &warnings, &status))
      documents[read] = eo_design_encode(&design);
  }
  if (!status && eo_exports_write_many(format, (const json_t *const *)documents, files, &text, &error))
    status = eo_app_fail(NULL, &error);
  for (int i = 0; i < read; i++)
    json_decref(documents[i]);
  return status ? status : save_text(&text, path);
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  const char *file[MOST_DESIGNS], *name = NULL, *path = NULL, *rows = NULL, *columns = NULL, *units = NULL;
  bool inches = false;
  struct eo_error error;
  int operands, status, grid[2];
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  const struct eo_option options[] = {{.name = "--format", .value = &name}, {.name = "-o", .value = &path},
                                      {.name = "--rows", .value = &rows},   {.name = "--columns", .value = &columns},
                                      {.name = "--units", .value = &units}, {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 0, MOST_DESIGNS, file, &operands, &status))
    return status;
  if (!operands)
    return list_formats();
  const struct eo_export *format = find_format(name, &status);
  if (!format || !read_grid(rows, columns, grid, &status))
    return status;
  if (!eo_app_units(units, &inches, &status))
    return status;
  if (inches && (operands > 1 || !eo_export_has_columns(format))) {
    eo_error_set(
        &error, EO_ERROR_INPUT, "",
        "--units inch is for tables of columns: flank-points, topography, modification-chart; %s has the units "
        "that its readers expect.",
        format->name);
    return eo_app_fail(NULL, &error);
  }
  if (operands > 1)
    return save_many(format, file, operands, path);
  if (!eo_app_load_design(file[0], &design, &geometry, &warnings, &status))
    return status;
  return save(format, &design, &geometry, grid, inches, path);
}

const struct eo_command eo_command_export = {
    "export", "DESIGN.json... --format NAME [-o FILE] [--rows N] [--columns N] [--units mm|inch]",
    "a file for another program: REXS, STEP, STL, tables, flank points, charts",
    "Without a design, the list of formats. Without -o the file goes to standard output.\n"
    "--rows and --columns: points of flank-points and topography from root to tip (" ROWS
    ") and over the face (" COLUMNS ").\n"
    "--units inch gives the lengths of flank-points, topography and modification-chart in inches and thousandths, as\n"
    "their headings say.\n"
    "\n"
    "Points are in the frame of each member: z along the axis, from the middle of the groove to the right; the\n"
    "working flank of a tooth faces +x (-x, all mirrored, where the pinion turns clockwise seen from its left end, as\n"
    "a left-handed one with the apex trailing does) and would, unmodified, pass through x = 0 at the working pitch\n"
    "radius in mid face. Normals point out of the tooth. STEP and STL use the same frame, in mm, without thickness\n"
    "allowance; STL is for viewing and printing. Where the slope of a modification jumps (the start of a linear\n"
    "relief, the border of a grid or a corner relief), STEP faces end where both sides cross; what a corner of the\n"
    "rack sweeps is a narrow face of its own. Modified flanks reach from the start of the active profile to the tip\n"
    "circle; a flank whose relief is too steep for that ends where the end of the active profile is generated. If a\n"
    "face stays more than 5 nm off, a comment of the file says so: look for /*.\n"
    "\n"
    "Several designs go into one table (table, table-comma, table-rows, workbook). Gear programs read rexs; GDE\n"
    "(VDI/VDE 2610) and the files of measuring and grinding machines have no public layout: flank-points, topography\n"
    "and charts hold what they need.\n",
    run};
