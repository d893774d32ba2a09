/* Rows of a verification: one per number compared. */
#ifndef EASEOFF_APP_VERIFY_ROW_H
#define EASEOFF_APP_VERIFY_ROW_H

#include <jansson.h>

/* |value - expected| <= tolerance (absolute). A value that is not finite fails and is written as null. */
void eo_verify_row(json_t *rows, const char *name, const char *quantity, double value, double expected, double tolerance);

#endif
