/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "app/app.h"
#include "numerics/threads.h"

static const struct eo_command *const commands[] = {
    &eo_command_serve,     &eo_command_example, &eo_command_design,  &eo_command_analyze,  &eo_command_sweep,
    &eo_command_tolerance, &eo_command_study,   &eo_command_prepare, &eo_command_optimize, &eo_command_history,
    &eo_command_measure,   &eo_command_rig,     &eo_command_import,  &eo_command_export,   &eo_command_report,
    &eo_command_reproduce, &eo_command_verify,  &eo_command_stage,   &eo_command_backup,   &eo_command_restore,
    &eo_command_doctor,
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static int print_overview(void)
{
  struct eo_text text = {0};
  eo_text_print(&text, "%s: quiet herringbone gears by tooth micro-geometry\n\n", eo_program);
  for (int i = 0; i < COMMANDS; i++)
    eo_text_print(&text, "  easeoff %-9s  %s\n", commands[i]->name, commands[i]->summary);
  eo_text_add(
      &text,
      "\neaseoff COMMAND --help says more; easeoff --version prints the version. A file named - is standard input.\n"
      "Exit status: 0 done, 1 the input is wrong, 2 it failed.\n");
  return eo_app_print(&text);
}

static int print_version(void)
{
  struct eo_text text = {0};
  eo_text_print(&text, "%s\n", eo_program);
  return eo_app_print(&text);
}

/* OpenBLAS starts its threads while the program is loaded, before anybody can block a signal for them: a SIGTERM that
   one of them takes runs METIS's handler in the wrong thread. Only the environment keeps them away, so the program
   starts itself a second time. Where that cannot be done it goes on as it is. */
static void start_without_library_threads(char **argv)
{
  static const char *const variable[] = {"OPENBLAS_NUM_THREADS", "OMP_THREAD_LIMIT"};
  bool again = false;
  for (int i = 0; i < 2; i++) {
    const char *value = getenv(variable[i]);
    if (!value || strcmp(value, "1") != 0)
      again = setenv(variable[i], "1", 1) == 0 || again;
  }
  if (again)
    execv("/proc/self/exe", argv);
}

int main(int argc, char **argv)
{
  start_without_library_threads(argv);
  prctl(PR_SET_NAME, "easeoff"); /* the kernel has it from the path it started: "exe" */
  eo_threads_limit();
  gsl_set_error_handler_off(); /* it would end the process where there is no memory: numerics/fft.h */
  const char *name = argc > 1 ? argv[1] : "";
  for (int i = 0; i < COMMANDS; i++)
    if (strcmp(name, commands[i]->name) == 0)
      return commands[i]->run(commands[i], argc - 1, argv + 1);
  if (strcmp(name, "--help") == 0 || strcmp(name, "help") == 0)
    return print_overview();
  if (strcmp(name, "--version") == 0)
    return print_version();
  char shown[60];
  eo_text_clean(shown, sizeof shown, name);
  if (*name)
    fprintf(stderr, "easeoff: there is no command \"%s\"; easeoff --help lists them\n", shown);
  else
    fprintf(stderr, "easeoff: a command is missing; easeoff --help lists them\n");
  return EO_EXIT_INPUT;
}
