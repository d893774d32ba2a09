/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of a design: one HTML file that a reviewer can check without the program. Inputs with what was stated and
   what assumed, standards with their editions and what is unchecked, every number of the result that is not a curve
   with its meaning, symbol and unit, figures, verdict, hash and version. Nothing in it depends on when, where or by
   whom it was made: the terminal and the server give the same bytes. */
#ifndef EASEOFF_REPORT_REPORT_H
#define EASEOFF_REPORT_REPORT_H

#include "document/design_document.h"
#include "evaluation/analysis.h"
#include "report/page.h"

/* Analyses the design on a pair that serves it, with everything, and appends the report to the page's text, in its unit
   of length. warnings: of reading the design; NULL: none. progress: cancellation between analysis and writing. Errors:
   those of eo_analysis_run(). */
enum eo_code eo_report_make(const struct eo_pair *pair, const struct eo_design *design,
                            const struct eo_warnings *warnings, const struct eo_progress *progress,
                            const struct eo_page *page, struct eo_error *error);

#endif
