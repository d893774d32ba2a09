/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All tables of routes. */
#ifndef EASEOFF_HTTP_ROUTES_H
#define EASEOFF_HTTP_ROUTES_H

#include "http/route.h"

extern const struct eo_route *const eo_routes[]; /* NULL after the last */

#endif
