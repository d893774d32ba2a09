/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The threads or the MPI ranks that a command works with. */
#ifndef EASEOFF_APP_CREW_START_H
#define EASEOFF_APP_CREW_START_H

#include "crew/crew.h"
#include "format/text.h"

#define EO_APP_CREW_HELP                                                                                              \
  "mpirun -n N easeoff ... does the same on N processes: the first keeps the results, the others evaluate, each "     \
  "with\n"                                                                                                            \
  "--threads of its own (default 1); --cache DIR is the folder of prepared pairs of each machine (default: that of\n" \
  "--data).\n\n"

struct eo_app_crew {
  struct eo_crew crew;
  struct eo_text cache; /* folder of prepared pairs; without data: none */
};

/* Reads --data, --cache, --no-cache and --threads out of the arguments and begins. False: the command is over and has
   its status (a rank that has served, or a fault that was told). eo_app_crew_end() otherwise, after the last use. */
bool eo_app_crew_begin(struct eo_app_crew *crew, int argc, char **argv, int *status);
void eo_app_crew_end(struct eo_app_crew *crew);

#endif
