/* Where the program keeps what it may need again. */
#ifndef EASEOFF_APP_DATA_H
#define EASEOFF_APP_DATA_H

#include "document/text.h"

/* The paragraph that --help of a command with --data shows. */
#define EO_APP_DATA_HELP                                                                                                            \
  "The flexibility of a gear pair is computed once and kept in DIR/flexibility: --data DIR, else $EASEOFF_DATA, else\n"             \
  "$XDG_CACHE_HOME/easeoff, else ~/.cache/easeoff.\n"

/* The directory of the flexibility cache, its parents made; false (path empty) when there is no place for one. What cannot be made is
   noticed later, by the cache, which then does without. option: of --data, NULL when not given. path is to be freed with
   eo_text_done(). */
bool eo_app_cache_directory(const char *option, struct eo_text *path);

#endif
