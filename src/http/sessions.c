/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/sessions.h"

#include <string.h>
#include <sys/random.h>

#include "base/clock.h"
#include "http/header_field.h"

static double seconds_now(void)
{
  return 1e-3 * eo_clock_milliseconds();
}

static int find(const struct eo_sessions *sessions, const char *name)
{
  char hash[EO_HASH_LENGTH + 1];
  int found = -1;
  eo_hash_hex(name, strlen(name), hash);
  for (int i = 0; i < EO_SESSIONS; i++)
    if (sessions->session[i].until > seconds_now() && eo_field_equal_secret(hash, sessions->session[i].hash))
      found = i;
  return found;
}

bool eo_session_begin(struct eo_sessions *sessions, double seconds, char name[EO_SESSION_NAME + 1])
{
  static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  unsigned char byte[EO_SESSION_NAME];
  struct eo_session *first = &sessions->session[0];
  if (getrandom(byte, sizeof byte, 0) != (ssize_t)sizeof byte)
    return false;
  for (int i = 0; i < EO_SESSION_NAME; i++)
    name[i] = letter[byte[i] & 63];
  name[EO_SESSION_NAME] = '\0';
  for (int i = 1; i < EO_SESSIONS; i++)
    if (sessions->session[i].until < first->until)
      first = &sessions->session[i];
  eo_hash_hex(name, EO_SESSION_NAME, first->hash);
  first->until = seconds_now() + seconds;
  return true;
}

bool eo_session_holds(const struct eo_sessions *sessions, const char *name)
{
  return find(sessions, name) >= 0;
}

void eo_session_end(struct eo_sessions *sessions, const char *name)
{
  int i = find(sessions, name);
  if (i >= 0)
    sessions->session[i] = (struct eo_session){0};
}
