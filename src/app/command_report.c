/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/app.h"
#include "app/data.h"
#include "app/watch.h"
#include "report/report.h"

struct request {
  const char *file, *path, *data, *units;
  bool no_cache, inches;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
};

static bool ends_with(const char *text, const char *ending)
{
  size_t length = strlen(text), tail = strlen(ending);
  return length >= tail && strcmp(text + length - tail, ending) == 0;
}

/* The first of these programs that is installed; false: none is. */
static bool find_browser(char *path, size_t size)
{
  static const char *const names[] = {"chromium", "chromium-browser", "google-chrome", NULL};
  const char *folders = getenv("PATH");
  for (const char *from = folders; from && *from; from += strcspn(from, ":") + (from[strcspn(from, ":")] == ':'))
    for (int i = 0; names[i]; i++) {
      int length = snprintf(path, size, "%.*s/%s", (int)strcspn(from, ":"), from, names[i]);
      if (length > 0 && (size_t)length < size && access(path, X_OK) == 0)
        return true;
    }
  return false;
}

/* The files of one print, in a folder of its own. */
struct print {
  char browser[4096], folder[4096];
  struct eo_text page, pdf, from, to; /* paths, and the same as the browser takes them */
};

static void name_files(struct print *print)
{
  eo_text_print(&print->page, "%s/report.html", print->folder);
  eo_text_print(&print->pdf, "%s/report.pdf", print->folder);
  eo_text_print(&print->from, "file://%s/report.html", print->folder);
  eo_text_print(&print->to, "--print-to-pdf=%s/report.pdf", print->folder);
}

static void forget_files(struct print *print)
{
  unlink(print->page.data);
  unlink(print->pdf.data);
  rmdir(print->folder);
  eo_text_done(&print->page);
  eo_text_done(&print->pdf);
  eo_text_done(&print->from);
  eo_text_done(&print->to);
}

/* Runs the browser on the page and waits; what it says goes nowhere. As root it has no sandbox to run in. */
static bool run_browser(const struct print *print)
{
  char *arguments[8] = {(char *)print->browser,   "--headless",   "--disable-gpu",
                        "--no-pdf-header-footer", print->to.data, print->from.data};
  if (geteuid() == 0)
    arguments[6] = "--no-sandbox";
  pid_t child = fork();
  if (child == 0) {
    if (freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr))
      execv(print->browser, arguments);
    _exit(127);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Printed beside, and moved into place when it is whole. */
static enum eo_code print_page(const struct eo_text *page, struct print *print, const char *path,
                               struct eo_error *error)
{
  enum { MOST_BYTES = 1 << 28 };
  struct eo_text printed = {0};
  EO_TRY(eo_text_save(page, print->page.data, error));
  if (!run_browser(print) || eo_text_read(&printed, print->pdf.data, MOST_BYTES, error)) {
    eo_text_done(&printed);
    return eo_error_set(error, EO_ERROR_FILE, "", "%.200s printed no PDF: write an HTML file and print that.",
                        print->browser);
  }
  enum eo_code code = eo_text_save(&printed, path, error);
  eo_text_done(&printed);
  return code;
}

static enum eo_code save_pdf(const struct eo_text *page, const char *path, struct eo_error *error)
{
  struct print print = {.browser = ""};
  const char *temporary = getenv("TMPDIR");
  if (!find_browser(print.browser, sizeof print.browser))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "A PDF needs Chromium, and none is installed: write an HTML file and print it in a browser.");
  snprintf(print.folder, sizeof print.folder, "%s/easeoff-report-XXXXXX", temporary ? temporary : "/tmp");
  if (!mkdtemp(print.folder))
    return eo_error_set(error, EO_ERROR_FILE, "", "A folder for the PDF cannot be made: %s.", strerror(errno));
  name_files(&print);
  enum eo_code code = print_page(page, &print, path, error);
  forget_files(&print);
  return code;
}

static int save(const struct request *request, struct eo_text *page)
{
  struct eo_error error;
  if (!request->path || strcmp(request->path, "-") == 0)
    return eo_app_print(page);
  enum eo_code code = ends_with(request->path, ".pdf") ? save_pdf(page, request->path, &error)
                                                       : eo_text_save(page, request->path, &error);
  eo_text_done(page);
  return code ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
}

static enum eo_code make(const struct request *request, const struct eo_progress *progress, struct eo_text *text,
                         struct eo_error *error)
{
  const struct eo_page page = {text, request->inches};
  struct eo_text directory = {0};
  struct eo_pair *pair = NULL;
  bool keep = !request->no_cache && eo_app_cache_directory(request->data, &directory);
  struct eo_pair_options options = {.cache_directory = keep ? directory.data : NULL};
  enum eo_code code = eo_pair_new(&pair, &request->design, &options, progress, error);
  eo_text_done(&directory);
  if (!code)
    code = eo_report_make(pair, &request->design, &request->warnings, progress, &page, error);
  eo_pair_free(pair);
  return code;
}

static int run_request(struct request *request)
{
  struct eo_watch watch;
  struct eo_error error;
  struct eo_text page = {0};
  eo_watch_start(&watch);
  enum eo_code code = make(request, &watch.progress, &page, &error);
  eo_watch_clear(&watch);
  if (watch.stopped)
    code = eo_error_set(&error, EO_ERROR_CANCELLED, "", "Stopped.");
  eo_watch_end(&watch);
  if (!code)
    return save(request, &page);
  eo_text_done(&page);
  return eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error);
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int operands, status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  const struct eo_option options[] = {{.name = "-o", .value = &request->path},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--units", .value = &request->units},
                                      {.name = "--no-cache", .flag = &request->no_cache},
                                      {.name = NULL}};
  if (eo_app_arguments(command, argc, argv, options, 1, 1, &request->file, &operands, &status) &&
      eo_app_units(request->units, &request->inches, &status) &&
      eo_app_load_design(request->file, &request->design, &request->geometry, &request->warnings, &status))
    status = run_request(request);
  free(request);
  return status;
}

const struct eo_command eo_command_report = {
    "report", "DESIGN.json [-o FILE.html|FILE.pdf] [--units mm|inch] [--data DIR] [--no-cache]",
    "the report of a design: inputs, standards, factors, figures, verdict",
    "Writes one HTML file that needs no other file; without -o it goes to standard output. The same design gives the "
    "same\n"
    "bytes, here and from POST /api/v1/report. If the name ends in .pdf, Chromium prints it, where it is installed.\n"
    "--units inch shows lengths in inches and thousandths, in tables, figures and sentences.\n"
    "\n" EO_APP_DATA_HELP,
    run};
