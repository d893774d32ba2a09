/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is said of a key that a table does not have, and of one that is missing. */
#ifndef EASEOFF_FORMAT_KEY_FAULTS_H
#define EASEOFF_FORMAT_KEY_FAULTS_H

#include "format/faults.h"
#include "format/table.h"

/* With the reason where the table refuses it, or the key that looks most like it. path: of the key. */
void eo_key_unknown(const struct eo_table *table, const char *key, const struct eo_path *path,
                    struct eo_faults *faults);

/* With the keys that may stand in its place. */
void eo_key_missing(const struct eo_field *field, const struct eo_path *path, struct eo_faults *faults);

#endif
