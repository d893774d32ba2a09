/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "store/checkup.h"

struct request {
  const char *data;
  bool trust;
};

static void print_finding(void *context, const struct eo_finding_of_store *finding)
{
  static const char *const loss[] = {
      [EO_LOSS_LOST] = "lost", [EO_LOSS_AGAIN] = "can be had again", [EO_LOSS_NOTE] = "note"};
  char shown[500];
  eo_text_clean(shown, sizeof shown, finding->text);
  eo_text_print(context, "%s: %s\n", loss[finding->loss], shown);
}

static void print_sum(const struct eo_checkup *sum, struct eo_text *text)
{
  eo_text_print(
      text,
      "%lld pages, %lld designs, %lld recordings, %lld jobs, %lld evaluations looked at; %lld lost, %lld can be "
      "had again\n",
      (long long)sum->pages, (long long)sum->designs, (long long)sum->recordings, (long long)sum->jobs,
      (long long)sum->evaluations, (long long)sum->lost, (long long)sum->again);
}

static enum eo_code look(const char *directory, struct eo_text *text, struct eo_checkup *sum, struct eo_error *error)
{
  struct eo_store *store = NULL;
  enum eo_code code = eo_store_open(&store, directory, EO_STORE_READ, error);
  if (!code)
    code = eo_store_checkup(store, print_finding, text, sum, error);
  eo_store_close(store);
  return code;
}

static enum eo_code trust(const char *directory, struct eo_text *text, struct eo_error *error)
{
  int64_t pages;
  enum eo_code code = eo_store_trust(directory, &pages, error);
  if (!code)
    eo_text_print(text, "%lld pages are taken for right as they are\n", (long long)pages);
  return code;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request request = {0};
  struct eo_error error;
  struct eo_checkup sum = {0};
  struct eo_text directory = {0}, text = {0};
  const char *none;
  int operands, status;
  const struct eo_option options[] = {
      {.name = "--data", .value = &request.data}, {.name = "--trust", .flag = &request.trust}, {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 0, 0, &none, &operands, &status))
    return status;
  enum eo_code code = eo_app_data_directory(request.data, &directory, &error);
  if (!code && request.trust)
    code = trust(directory.data, &text, &error);
  if (!code)
    code = look(directory.data, &text, &sum, &error);
  eo_text_done(&directory);
  if (code) {
    eo_text_done(&text);
    return eo_app_fail(NULL, &error);
  }
  print_sum(&sum, &text);
  status = eo_app_print(&text);
  return sum.lost || sum.again ? EO_EXIT_FAILED : status;
}

const struct eo_command eo_command_doctor = {
    "doctor", "[--data DIR] [--trust]", "checks everything in the data folder and says what is damaged",
    "Compares every page of the database, every row that has a check sum, and every recording with what was written, "
    "and\n"
    "says what is lost and what can be computed again. It changes nothing, and a server may run meanwhile. Exit status "
    "2\n"
    "when something is lost or has to be computed again.\n"
    "\n"
    "--trust first accepts the pages of the database as they are, after another program has written them and while no\n"
    "server runs.\n"
    "\n" EO_APP_HISTORY_HELP,
    run};
