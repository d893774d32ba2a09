/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evaluating variants, for any process of a crew: the order names the design, what varies and the columns, an item is a
   JSON array of values, an answer is that of variant_answer.h. A pair is prepared once per folder of prepared pairs and
   held by a process while one of its threads uses it. */
#ifndef EASEOFF_VARIANTS_VARIANT_TRADE_H
#define EASEOFF_VARIANTS_VARIANT_TRADE_H

#include "crew/trade.h"
#include "document/result_scalars.h"
#include "variants/variant_plan.h"

extern const struct eo_crew_trade eo_variant_trade;

/* The order. extra: EO_WANT_... beyond what the columns need. Errors: memory. */
enum eo_code eo_variant_trade_order(const struct eo_variant_plan *plan, struct eo_text *order, struct eo_error *error);

#endif
