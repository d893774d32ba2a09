/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/framing.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

#include <microhttpd.h>

#include "http/request.h"

/* How often the fields that decide stand in the head of a request. */
struct counted {
  int lengths, codings, hosts;
  bool chunked; /* the last coding is that one, alone */
  bool digits;  /* the length is a number and nothing else: "5, 5" or "+5" is one to some readers */
};

static enum MHD_Result count(void *context, enum MHD_ValueKind kind, const char *name, const char *value)
{
  struct counted *counted = context;
  (void)kind;
  if (strcasecmp(name, "Content-Length") == 0) {
    counted->lengths++;
    counted->digits = value && *value && strspn(value, "0123456789") == strlen(value);
  } else if (strcasecmp(name, "Transfer-Encoding") == 0) {
    counted->codings++;
    counted->chunked = value && strcasecmp(value, "chunked") == 0;
  } else if (strcasecmp(name, "Host") == 0)
    counted->hosts++;
  return MHD_YES;
}

static bool refuse(struct eo_request *request, unsigned status, const char *what)
{
  eo_reply_problem(&request->reply, status, "framing", "%s", what);
  request->reply.close = true;
  return false;
}

bool eo_framing_is_sound(struct eo_request *request)
{
  struct counted counted = {.digits = true};
  MHD_get_connection_values(request->connection, MHD_HEADER_KIND, count, &counted);
  if (counted.lengths > 1)
    return refuse(request, 400, "The length of the body is stated more than once (RFC 9112, 6.3).");
  if (!counted.digits)
    return refuse(request, 400, "The length of the body must be a whole number.");
  if (counted.lengths && counted.codings)
    return refuse(request, 400, "The body has a length and a transfer coding (RFC 9112, 6.1).");
  if (counted.codings > 1 || (counted.codings && !counted.chunked))
    return refuse(request, 501, "The only transfer coding that is known here is chunked (RFC 9112, 6.1).");
  if (counted.hosts > 1)
    return refuse(request, 400, "The host is named more than once (RFC 9112, 3.2).");
  return true;
}

static int digit_of(char c)
{
  return !isxdigit((unsigned char)c) ? -1 : isdigit((unsigned char)c) ? c - '0' : tolower((unsigned char)c) - 'a' + 10;
}

size_t eo_framing_unescape(void *context, struct MHD_Connection *connection, char *text)
{
  char *to = text;
  (void)context, (void)connection;
  for (const char *from = text; *from; to++) {
    int high = *from == '%' ? digit_of(from[1]) : -1, low = high < 0 ? -1 : digit_of(from[2]);
    bool encoded = low >= 0 && (high || low);
    *to = encoded ? (char)(high << 4 | low) : *from;
    from += encoded ? 3 : 1;
  }
  *to = '\0';
  return (size_t)(to - text);
}
