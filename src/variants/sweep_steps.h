/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep over a number of a design other than torque and speed, by the names that studies have. */
#ifndef EASEOFF_VARIANTS_SWEEP_STEPS_H
#define EASEOFF_VARIANTS_SWEEP_STEPS_H

#include "document/sweep_document.h"

/* Whether the key names numbers over which a design can be swept. design: the base, complete. Errors: EO_ERROR_INPUT at
   /vary/key (no key; a word; a number that a sweep does not show or that makes another gear pair), memory. */
enum eo_code eo_sweep_steps_check(const struct eo_sweep_axes *axes, const struct eo_design *design,
                                  struct eo_error *error);

/* Notes the design as it was stated, on which the steps stand; nothing where no such number varies. Errors: memory. */
enum eo_code eo_sweep_steps_take(struct eo_sweep_axes *axes, const json_t *base, struct eo_error *error);

/* Makes the design of every step from the noted one, some milliseconds each; nothing where no such number varies.
   design: the base, complete. Errors: those of the check; where it stands in the design what that may not be; memory.
 */
enum eo_code eo_sweep_steps_init(struct eo_sweep_axes *axes, const struct eo_design *design, struct eo_error *error);

#endif
