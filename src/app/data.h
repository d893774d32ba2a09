/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the program keeps what it may need again. */
#ifndef EASEOFF_APP_DATA_H
#define EASEOFF_APP_DATA_H

#include "format/text.h"

/* The paragraph that --help of a command with --data shows. */
#define EO_APP_DATA_HELP                                                                                          \
  "The flexibility of a gear pair is computed once and kept in DIR/flexibility: --data DIR, else $EASEOFF_DATA, " \
  "else\n"                                                                                                        \
  "$XDG_CACHE_HOME/easeoff, else ~/.cache/easeoff.\n"

#define EO_APP_HISTORY_HELP                                                                                    \
  "The history is kept in DIR/easeoff.db: --data DIR, else $EASEOFF_DATA, else $XDG_DATA_HOME/easeoff, else\n" \
  "~/.local/share/easeoff.\n"

/* The directory of the history, its parents made. EO_ERROR_INPUT when there is no place for one. path as below. */
enum eo_code eo_app_data_directory(const char *option, struct eo_text *path, struct eo_error *error);

/* The directory of the flexibility cache, its parents made; false (path empty) when there is no place for one. What
   cannot be made is noticed later, by the cache, which then does without. option: of --data, NULL when not given. path
   is to be freed with eo_text_done(). */
bool eo_app_cache_directory(const char *option, struct eo_text *path);

#endif
