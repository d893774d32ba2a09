/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/problem_page.h"

#include <string.h>

#include "http/problems.h"

bool eo_problem_page_reply(struct eo_request *request)
{
  static const char place[] = "/problems";
  struct eo_text text = {0};
  const char *rest = request->path + sizeof place - 1;
  if (strncmp(request->path, place, sizeof place - 1) != 0 || (*rest && *rest != '/'))
    return false;
  const struct eo_problem *problem = *rest ? eo_problem_find(rest + 1) : NULL;
  if (*rest && !problem)
    return false;
  eo_problem_write(problem, &text);
  eo_reply_text(&request->reply, 200, "text/html; charset=utf-8", &text);
  return true;
}
