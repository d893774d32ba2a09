/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands in header fields, paths and queries, read without trust: no allocation, no state, any bytes may come. */
#ifndef EASEOFF_HTTP_HEADER_FIELD_H
#define EASEOFF_HTTP_HEADER_FIELD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A whole decimal number and nothing else; false: it is none, or it does not fit. */
bool eo_field_integer(const char *text, int64_t *value);

/* A finite decimal number and nothing else. */
bool eo_field_real(const char *text, double *value);

/* 1..size - 1 characters from '!' to '~': tokens, keys, names that go into headers and logs. */
bool eo_field_is_visible(const char *text, size_t size);

/* Whether an Accept-Encoding allows a coding (RFC 9110 12.5.3); NULL: no header. */
bool eo_field_accepts_coding(const char *header, const char *coding);

/* Whether an Accept prefers a media type over "application/json" (RFC 9110 12.5.1): it is named with a quality at least
   as high. */
bool eo_field_prefers_type(const char *header, const char *type);

/* Whether an If-Match or If-None-Match list holds "*" or the tag (without quotes). weak: a weak entry counts. */
bool eo_field_lists_tag(const char *header, const char *tag, bool weak);

/* Seconds of "wait=N" in a Prefer header (RFC 7240); 0: none. */
int eo_field_wait(const char *header);

/* Whether a Prefer header asks for the answer later (RFC 7240: respond-async). */
bool eo_field_is_async(const char *header);

/* Copies the host of "name", "name:port", "[v6]:port", lower case, without port and brackets; false: it is malformed.
 */
bool eo_field_host(const char *header, char *host, size_t size);

/* True when the host is a number, IPv4 or IPv6: no name that somebody's name server could bend to another address. */
bool eo_field_host_is_address(const char *host);

/* Copies the value of a cookie (RFC 6265); false: it is not there or does not fit. */
bool eo_field_cookie(const char *header, const char *name, char *value, size_t size);

/* Same length and same bytes, in a time that depends on the expected text alone. */
bool eo_field_equal_secret(const char *given, const char *expected);

/* True for a decoded path without "//", "/./", "/../", control characters and backslashes. */
bool eo_field_path_is_plain(const char *path);

/* Matches a path against "/jobs/{id}/events": each {word} takes one non-empty segment, copied to argument[] in their
   order; false also when one is longer than size - 1. count: places in argument. */
bool eo_field_match(const char *pattern, const char *path, size_t size, char argument[][64], int count);

#endif
