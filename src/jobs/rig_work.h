/* What the service computes from stored measurements and a prepared gear pair: comparison, model updating, a synthetic recording. */
#ifndef EASEOFF_JOBS_RIG_WORK_H
#define EASEOFF_JOBS_RIG_WORK_H

#include "document/measure_file.h"
#include "base/hash.h"

/* What lists and comparisons need of a measurement's document, itself readable by eo_measured_decode(). New; NULL without memory. */
json_t *eo_rig_summary(const json_t *document);

/* What of a pair a recording is measured with. */
void eo_rig_pair_hash(const struct eo_geometry *geometry, char hash[EO_HASH_LENGTH + 1]);

#endif
