/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "app/number.h"
#include "store/backup.h"

struct request {
  const char *data, *design, *operand;
};

static void print_counts(const struct eo_backup_report *report, struct eo_text *text)
{
  eo_text_print(text, "%lld designs, %lld recordings, %lld jobs", (long long)report->designs,
                (long long)report->recordings, (long long)report->jobs);
}

static enum eo_code back_up(const struct request *request, const char *directory, struct eo_backup_report *report,
                            struct eo_error *error)
{
  struct eo_store *store = NULL;
  int design = 0;
  if (request->design && !eo_app_read_whole(request->design, "--design", 1, 2000000000, &design, error))
    return EO_ERROR_INPUT;
  enum eo_code code = eo_store_open(&store, directory, EO_STORE_READ, error);
  if (!code)
    code = eo_backup_write(store, request->operand, design, report, error);
  eo_store_close(store);
  return code;
}

static int run_backup(const struct eo_command *command, int argc, char **argv)
{
  struct request request = {0};
  struct eo_backup_report report;
  struct eo_error error;
  struct eo_text directory = {0}, text = {0};
  int operands, status;
  const struct eo_option options[] = {
      {.name = "--data", .value = &request.data}, {.name = "--design", .value = &request.design}, {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 1, 1, &request.operand, &operands, &status))
    return status;
  enum eo_code code = eo_app_data_directory(request.data, &directory, &error);
  if (!code)
    code = back_up(&request, directory.data, &report, &error);
  eo_text_done(&directory);
  if (code)
    return eo_app_fail(NULL, &error);
  print_counts(&report, &text);
  eo_text_print(&text, " in %s\n", request.operand);
  status = eo_app_print(&text);
  if (!report.missing)
    return status;
  fprintf(stderr, "easeoff: %d recording%s not in it: %s easeoff doctor says more.\n", report.missing,
          report.missing == 1 ? " is" : "s are", report.first);
  return EO_EXIT_FAILED;
}

static int run_restore(const struct eo_command *command, int argc, char **argv)
{
  struct request request = {0};
  struct eo_backup_report report;
  struct eo_error error;
  struct eo_text directory = {0}, text = {0};
  int operands, status;
  const struct eo_option options[] = {{.name = "--data", .value = &request.data}, {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 1, 1, &request.operand, &operands, &status))
    return status;
  enum eo_code code = eo_app_data_directory(request.data, &directory, &error);
  if (!code)
    code = eo_backup_restore(directory.data, request.operand, &report, &error);
  if (!code) {
    print_counts(&report, &text);
    eo_text_print(&text, report.whole ? " restored to %s\n" : " added to %s", directory.data);
    if (!report.whole)
      eo_text_print(&text, "; %lld were there already; jobs and history stay in the archive\n",
                    (long long)report.known);
  }
  eo_text_done(&directory);
  return code ? eo_app_fail(NULL, &error) : eo_app_print(&text);
}

const struct eo_command eo_command_backup = {
    "backup", "FILE [--data DIR] [--design N]",
    "designs, recordings, jobs and history in one file, also while a server runs",
    "Writes a tar.gz archive, and never over a file that is there: the database as it is at one moment, every "
    "recording,\n"
    "and the SHA-256 of each. --design N takes only that design and its recordings, to hand it on. Prepared gear "
    "pairs\n"
    "are left out, because they can be computed again.\n"
    "\n" EO_APP_HISTORY_HELP,
    run_backup};

const struct eo_command eo_command_restore = {
    "restore", "FILE [--data DIR]", "puts what easeoff backup wrote back into a data folder",
    "Compares every SHA-256 first. Into a folder without a database it restores everything. Into one that has a "
    "database,\n"
    "also while a server works on it, it adds designs and recordings under new numbers; what is there already stays\n"
    "once, and nothing is overwritten or removed.\n"
    "\n" EO_APP_HISTORY_HELP,
    run_restore};
