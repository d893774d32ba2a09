/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What tests of pairs without finite elements share: a compliance in closed form, and the end where one cannot go on.
 */
#ifndef EASEOFF_TESTS_SUPPORT_SYNTHETIC_PAIR_H
#define EASEOFF_TESTS_SUPPORT_SYNTHETIC_PAIR_H

#include "base/error.h"
#include "flexibility/closed_form.h"

#include <stdio.h>
#include <stdlib.h>

static struct eo_closed_form form = {1.5e-9, 12e-3, -0.8e-3, 20, 4000};

static void stop(const struct eo_error *error)
{
  printf("Bail out! %s: %s\n", error->pointer, error->text);
  exit(1);
}

#endif
