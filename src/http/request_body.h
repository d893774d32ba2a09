/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The body of a request, read by the field table of its route. */
#ifndef EASEOFF_HTTP_REQUEST_BODY_H
#define EASEOFF_HTTP_REQUEST_BODY_H

#include "http/request.h"

/* Reads the body, or the parts of a form, into a struct of the table; false: the reply says everything that is wrong. A
   body that may be left out and was is an empty object. Objects in it last until the handler returns; release with
   eo_table_done() where the table has lists. */
bool eo_body_read(struct eo_request *request, void *order);

#endif
