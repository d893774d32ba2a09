/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Older design documents, made such as this program writes them. */
#ifndef EASEOFF_DOCUMENT_DESIGN_MIGRATION_H
#define EASEOFF_DOCUMENT_DESIGN_MIGRATION_H

#include <jansson.h>

#include "document/design_document.h"

/* 1: what a document left out was taken from the paper's rig (shaft angle error 0.1 deg, its duty cycle, bearings and
   backlash), and tips were not shortened. 2: it follows from the pair, or is asked for. */
enum { EO_DESIGN_VERSION = 2 };

/* The document in the present version, new: the same numbers as before, with a warning that says what was filled in. A
   document of the present version is returned itself, with a reference more. One that does not say its version is of
   the present one, unless it names every key as version 1 wrote it. NULL without memory. */
json_t *eo_design_migrate(const json_t *document, struct eo_warnings *warnings);

#endif
