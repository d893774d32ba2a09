/* SPDX-License-Identifier: GPL-3.0-or-later */
/* POST /measurements. */
#ifndef EASEOFF_HTTP_MEASUREMENT_UPLOAD_H
#define EASEOFF_HTTP_MEASUREMENT_UPLOAD_H

#include "http/request.h"

/* The handler, on the thread that reads recordings; its form is eo_measure_form_table. */
void eo_measurement_add(struct eo_request *request);

/* The same without keeping anything: 200 with what was measured. */
void eo_measurement_try(struct eo_request *request);

#endif
