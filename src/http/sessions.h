/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sessions of pages that gave the token: random names, of which only the hash is kept, in memory: a restart ends them.
   Of the HTTP thread. */
#ifndef EASEOFF_HTTP_SESSIONS_H
#define EASEOFF_HTTP_SESSIONS_H

#include <stdbool.h>

#include "base/hash.h"

enum { EO_SESSIONS = 256, EO_SESSION_NAME = 43 /* letters */ };

struct eo_sessions {
  struct eo_session {
    char hash[EO_HASH_LENGTH + 1];
    double until; /* s of the monotonic clock; 0: free */
  } session[EO_SESSIONS];
};

/* A new one in the place of the one that would end first; false: the system has no random numbers. */
bool eo_session_begin(struct eo_sessions *sessions, double seconds, char name[EO_SESSION_NAME + 1]);
bool eo_session_holds(const struct eo_sessions *sessions, const char *name);
void eo_session_end(struct eo_sessions *sessions, const char *name);

#endif
