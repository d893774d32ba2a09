/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Designs to start from, by name. */
#ifndef EASEOFF_DOCUMENT_EXAMPLES_H
#define EASEOFF_DOCUMENT_EXAMPLES_H

#include "design/design.h"

struct eo_example {
  const char *name;
  const char *summary;                     /* one line */
  void (*build)(struct eo_design *design); /* on top of the defaults */
};

/* NULL after the last. */
const struct eo_example *eo_example_at(int index);

/* Fills a design; derived defaults stay open. False: no example has this name. */
bool eo_example_build(const char *name, struct eo_design *design);

#endif
