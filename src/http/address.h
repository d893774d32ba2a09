/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where to listen: "127.0.0.1:8080", "[::1]:0", "localhost:8080". */
#ifndef EASEOFF_HTTP_ADDRESS_H
#define EASEOFF_HTTP_ADDRESS_H

#include <stdbool.h>

#include "base/error.h"

struct eo_listening {
  int socket;    /* owned by the caller */
  bool loopback; /* nobody but this machine reaches it */
  bool version6;
  char url[80]; /* with the port that was taken */
};

/* Errors: EO_ERROR_INPUT (not an address), EO_ERROR_FILE (taken, not allowed). */
enum eo_code eo_listen(struct eo_listening *listening, const char *address, struct eo_error *error);

/* Whether the address is one that only this machine reaches; the same errors. */
enum eo_code eo_listen_is_loopback(const char *address, bool *loopback, struct eo_error *error);

#endif
