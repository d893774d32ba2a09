/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The schema's steps, in order: sql/NNNN_name.sql as text. */
#ifndef EASEOFF_STORE_MIGRATIONS_H
#define EASEOFF_STORE_MIGRATIONS_H

extern const char *const eo_store_migrations[]; /* [eo_store_schema] */
extern const int eo_store_schema;               /* the newest schema this program knows */

#endif
