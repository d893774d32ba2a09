/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EASEOFF_HTTP_PROBLEM_PAGE_H
#define EASEOFF_HTTP_PROBLEM_PAGE_H

#include "http/request.h"

/* Answers "/problems" and "/problems/NAME"; false: the path is another. */
bool eo_problem_page_reply(struct eo_request *request);

#endif
