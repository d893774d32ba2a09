/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fit of unknown inputs as JSON and for people.
     request {"unknowns": {"pinion_bearing_stiffness_N_per_um": [200, 3000], ...}, "model_error": 0.05, "seed": 1}
     answer  {"unknowns": [{key, before, value, range, confidence_95, at_bound, undetermined, same_as, correlation}],
   "correlation": [[..]], "condition", "misfit": {before, after}, "model_error", "minima": [{values, confidence_95,
   misfit, within}], "measurements", "orders", "evaluations", "converged", "warnings"} */
#ifndef EASEOFF_DOCUMENT_UPDATE_DOCUMENT_H
#define EASEOFF_DOCUMENT_UPDATE_DOCUMENT_H

#include <jansson.h>

#include "format/faults.h"
#include "format/outline.h"
#include "format/table.h"
#include "format/text.h"
#include "measurement/updating.h"

/* What a request may say; the terminal and the service read it with eo_update_decode(). */
extern const struct eo_table eo_update_table;
void eo_update_decode(const json_t *document, struct eo_update_settings *settings, struct eo_faults *faults);

extern const struct eo_outline eo_update_outline;

/* New; NULL without memory. */
json_t *eo_update_encode(const struct eo_update *update);

/* For the terminal: the fitted inputs with their intervals, the misfit before and behind. */
void eo_update_summary(const struct eo_update *update, struct eo_text *text);

#endif
