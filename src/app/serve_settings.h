/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What `easeoff serve` is told: a configuration file and options, both read by the same tables, which know every
   default and every range. An option goes before the file. */
#ifndef EASEOFF_APP_SERVE_SETTINGS_H
#define EASEOFF_APP_SERVE_SETTINGS_H

#include "app/app.h"
#include "http/limits.h"
#include "service/service.h"

struct eo_serve_settings {
  char listen[120], data[2000], token_file[2000], host[256], web[2000],
      launcher[1000]; /* "": not said; listen has its default */
  int threads;        /* 0: not said */
  bool allow_anyone, quiet;
  struct eo_http_limits limits;
  struct eo_service_limits work;
};

/* Reads argv and the file that --config names; --help describes every key. False: the command is over, with *status. */
bool eo_serve_settings_read(const struct eo_command *command, int argc, char **argv, struct eo_serve_settings *settings,
                            int *status);

#endif
