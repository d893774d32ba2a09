/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/problems.h"

#include <string.h>

const struct eo_problem eo_problems[] = {
    {"invalid", 422, "The document was read, but values in it are wrong.",
     "Each member of errors points at one of them and says its range."},
    {"not-json", 400, "The body is no JSON.", "The detail says at which line and column reading ended."},
    {"query", 400, "A query parameter is not known here, or has a value it cannot have.",
     "The API's description lists the parameters of every address."},
    {"framing", 400,
     "Two readers could see two different requests: two lengths, two hosts, or both a length and chunks.",
     "Send one Host and one Content-Length, or Transfer-Encoding: chunked (501: no other coding is known)."},
    {"form", 422, "The form of an upload has parts that are not known, too long, or missing.",
     "multipart/form-data with design, label and one or two parts named file."},
    {"refused", 422, "The recording was read but gives no result.", "Its findings say why; nothing of it was kept."},
    {"too-large", 422, "The order has more points than one answer may have.", "Ask for fewer, or in parts."},
    {"wrong-token", 401, "That is not this server's token (403 where it was given for a session).",
     "Ask whoever runs the server. After some wrong ones further wrong ones wait; the right one never does."},
    {"cross-site", 403, "A page of another site may not change anything here.",
     "Send the request from this server's own page, or from a program."},
    {"wrong-host", 421, "The server does not answer under that name.", "Whoever runs it can add the name with --host."},
    {"in-use", 409, "Measurements belong to the design.", "Remove them first."},
    {"overtaken", 409, "A newer question of the same lane took this one's place.",
     "Nothing: the newer one is answered."},
    {"state", 409, "The job is in a state in which that cannot be done.", "Look at its state; wait, cancel or retry."},
    {"key-used", 409, "The idempotency key stands for another order.", "Take a new key for a new order."},
    {"stale", 412, "The design has changed since the version that If-Match names.",
     "Fetch it again, and decide whether your change still holds."},
    {"queue-full", 503, "As many jobs wait as may wait.", "Come again after Retry-After."},
    {"busy", 503, "Too much is on its way at once.", "Come again after Retry-After."},
    {"stopping", 503, "The server is stopping; jobs go on when it starts again.", "Come again after Retry-After."},
    {"locked", 503, "Another program keeps the server's database locked.", "Come again after Retry-After."},
    {"full", 507, "There is no room for it on the server's disk, or in what it may keep.",
     "Delete what is no longer needed, which goes on; or ask whoever runs the server."},
    {"storage", 500, "The server's data cannot be read or written.",
     "Its log says more under the id of the request; whoever runs it has to act."},
    {"damaged", 500, "What is stored there is not what was written, and is not given out.",
     "`easeoff doctor` says what is lost and what can be computed again; `easeoff restore` puts a copy back."},
    {"failed", 500, "The computation failed where it should not.",
     "The detail says what; the log has it under the id of the request."},
    {0}};

const struct eo_problem *eo_problem_find(const char *name)
{
  for (const struct eo_problem *problem = eo_problems; problem->name; problem++)
    if (strcmp(problem->name, name) == 0)
      return problem;
  return NULL;
}

bool eo_problems_list(unsigned status, struct eo_text *text)
{
  bool any = false;
  for (const struct eo_problem *problem = eo_problems; problem->name; problem++)
    if (problem->status == status) {
      eo_text_print(text, "%s/problems/%s", any ? ", " : "", problem->name);
      any = true;
    }
  return any;
}

static void write_one(const struct eo_problem *problem, struct eo_text *text)
{
  eo_text_print(text, "<h1>%s</h1><p>Status %u. %s</p><p>%s</p>\n", problem->name, problem->status, problem->means,
                problem->remedy);
}

void eo_problem_write(const struct eo_problem *problem, struct eo_text *text)
{
  eo_text_print(text, "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Easeoff: %s</title><body>\n",
                problem ? problem->name : "problems");
  if (problem)
    write_one(problem, text);
  for (const struct eo_problem *each = eo_problems; !problem && each->name; each++)
    write_one(each, text);
  eo_text_add(text, "</body></html>\n");
}
