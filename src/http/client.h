/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who sent a request. Behind a proxy that is trusted it is whom the proxy names; nobody else is believed. */
#ifndef EASEOFF_HTTP_CLIENT_H
#define EASEOFF_HTTP_CLIENT_H

#include <stdbool.h>
#include <sys/socket.h>

#include "base/error.h"

enum { EO_PROXIES = 16, EO_CLIENT_TEXT = 48 };

/* Networks: the first `bits` bits of the address, IPv4 as ::ffff:a.b.c.d. */
struct eo_proxies {
  int count;
  struct eo_network {
    unsigned char address[16];
    int bits;
  } network[EO_PROXIES];
};

/* Reads "127.0.0.1, 10.0.0.0/8, fd00::/8". Errors: EO_ERROR_INPUT. */
enum eo_code eo_proxies_read(struct eo_proxies *proxies, const char *list, struct eo_error *error);

struct eo_client {
  unsigned char key[16];     /* the address; of IPv6 the first half: a client has a whole /64 */
  char text[EO_CLIENT_TEXT]; /* the address for people */
  bool secure;               /* the client speaks TLS, as the proxy says */
};

/* peer: of the connection; forwarded, protocol: X-Forwarded-For and X-Forwarded-Proto, NULL: absent. From the right,
   the first address of the list that is no trusted proxy. */
struct eo_client eo_client_of(const struct eo_proxies *proxies, const struct sockaddr_storage *peer,
                              const char *forwarded, const char *protocol);

#endif
