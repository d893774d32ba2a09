/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is modelled of a member's body, and how the ring of all teeth is supported (flexibility/flexibility.h). */
#ifndef EASEOFF_FLEXIBILITY_BODY_MODEL_H
#define EASEOFF_FLEXIBILITY_BODY_MODEL_H

enum eo_body { EO_BODY_RING, EO_BODY_SECTOR };
enum eo_body_support { EO_SUPPORT_FLOATING, EO_SUPPORT_HELD, EO_SUPPORT_HELD_AT_BORE };

#endif
