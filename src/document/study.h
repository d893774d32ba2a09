/* From a design's optimization to the optimizer's settings. */
#ifndef EASEOFF_DOCUMENT_STUDY_H
#define EASEOFF_DOCUMENT_STUDY_H

#include "gear/design.h"
#include "optimizer/settings.h"

/* Everything but the bounds, which belong to the variables' physical meaning: algorithm, number of variables (5 shared or 10), three
   objectives, and each parameter by its key. */
void eo_design_study(const struct eo_design *design, struct eo_optimizer_settings *settings);

#endif
