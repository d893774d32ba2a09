/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two files of a result's rating share. */
#ifndef EASEOFF_DOCUMENT_RESULT_RATING_PRIVATE_H
#define EASEOFF_DOCUMENT_RESULT_RATING_PRIVATE_H

#include "document/result_private.h"

extern const struct eo_outline eo_outline_rated_case;

/* New; NULL without memory. */
json_t *eo_result_rated_case(const struct eo_result_source *source, int load_case);

#endif
