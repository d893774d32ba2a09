/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a request ends and for whom it is (RFC 9112, RFC 9110): whatever two readers could take in two ways is refused,
   because a proxy in front may be the other reader. */
#ifndef EASEOFF_HTTP_FRAMING_H
#define EASEOFF_HTTP_FRAMING_H

#include <stdbool.h>
#include <stddef.h>

struct MHD_Connection;
struct eo_request;

/* False: the reply says what is wrong, and the connection ends with it, since nobody knows where the next request
   begins. */
bool eo_framing_is_sound(struct eo_request *request);

/* What the library calls to decode %XX in paths and queries, in place: "%00" stays as it stands, so that no text ends
   before its end. Returns the new length. */
size_t eo_framing_unescape(void *context, struct MHD_Connection *connection, char *text);

#endif
