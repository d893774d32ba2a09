/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers on the command line. */
#ifndef EASEOFF_APP_NUMBER_H
#define EASEOFF_APP_NUMBER_H

#include <stdbool.h>

#include "base/error.h"

/* A whole number of low..high and nothing else; false with *error filled (it names the option). */
bool eo_app_read_whole(const char *text, const char *option, int low, int high, int *value, struct eo_error *error);

#endif
