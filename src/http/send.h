/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reply on its way: header fields, compression, and what the connection may take for it. */
#ifndef EASEOFF_HTTP_SEND_H
#define EASEOFF_HTTP_SEND_H

#include <microhttpd.h>

#include "http/request.h"

/* Hands the reply to the connection. */
enum MHD_Result eo_send_reply(struct eo_request *request);

#endif
