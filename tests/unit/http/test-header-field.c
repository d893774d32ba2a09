/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Header fields, paths and queries. Expected values are those of RFC 9110, 6265, 7240 and
   3986. */
#include "http/header_field.h"
#include "support/tap.h"

#include <string.h>

static void test_numbers(void)
{
  int64_t whole;
  double real;
  ok(eo_field_integer("0", &whole) && whole == 0 && eo_field_integer("-12", &whole) && whole == -12,
     "whole numbers are read");
  ok(eo_field_integer("9223372036854775807", &whole) && whole == INT64_MAX, "the largest whole number is read");
  static const char *const wrong[] = {"", "-", "+1", " 1", "1 ", "1.0", "0x1", "9223372036854775808", "a"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
    ok(!eo_field_integer(wrong[i], &whole), "\"%s\" is no whole number", wrong[i]);
  ok(eo_field_real("-1.5e3", &real) && real == -1500, "a real number is read");
  ok(!eo_field_real("nan", &real) && !eo_field_real("1e999", &real) && !eo_field_real("0x1p3", &real) &&
         !eo_field_real("", &real),
     "nan, what overflows, hexadecimals and nothing are no real numbers");
}

static void test_visible(void)
{
  ok(eo_field_is_visible("abc-1_2~", 9) && !eo_field_is_visible("abc-1_2~", 8), "a token is visible within its room");
  ok(!eo_field_is_visible("", 9) && !eo_field_is_visible("a b", 9) && !eo_field_is_visible("\xc3\xa4", 9) &&
         !eo_field_is_visible("a\n", 9),
     "nothing, blanks, letters beyond ASCII and line ends are not visible");
}

static void test_codings(void)
{
  ok(eo_field_accepts_coding("gzip", "gzip") && eo_field_accepts_coding("br;q=1.0, GZIP;q=0.8, *;q=0.1", "gzip"),
     "a client that names gzip takes it");
  ok(eo_field_accepts_coding("*", "gzip") && eo_field_accepts_coding("deflate, *;q=0.5", "gzip"),
     "a client that takes anything takes gzip");
  ok(!eo_field_accepts_coding(NULL, "gzip") && !eo_field_accepts_coding("", "gzip") &&
         !eo_field_accepts_coding("identity", "gzip"),
     "a client that does not name gzip does not take it");
  ok(!eo_field_accepts_coding("gzip;q=0", "gzip") && !eo_field_accepts_coding("gzip; q=0.0, *", "gzip") &&
         !eo_field_accepts_coding("*;q=0", "gzip"),
     "a client that refuses gzip does not take it");
  ok(!eo_field_accepts_coding("gzipped", "gzip") && !eo_field_accepts_coding("x-gzip", "gzip"),
     "a coding of another name is not gzip");
}

static void test_types(void)
{
  ok(eo_field_prefers_type("text/csv", "text/csv") &&
         eo_field_prefers_type("application/json;q=0.5, text/csv", "text/csv"),
     "a client that prefers CSV gets it");
  ok(!eo_field_prefers_type("*/*", "text/csv") && !eo_field_prefers_type(NULL, "text/csv"),
     "a client that does not name CSV does not get it");
  ok(!eo_field_prefers_type("text/csv;q=0.5, application/json", "text/csv") &&
         !eo_field_prefers_type("text/csv;q=0", "text/csv"),
     "a client that prefers JSON gets it");
}

static void test_tags(void)
{
  ok(eo_field_lists_tag("\"a\"", "a", false) && eo_field_lists_tag("\"x\", \"a\"", "a", false) &&
         eo_field_lists_tag("*", "a", false),
     "strong tags match");
  ok(eo_field_lists_tag("W/\"a\"", "a", true) && !eo_field_lists_tag("W/\"a\"", "a", false),
     "weak tags match where they may");
  ok(eo_field_lists_tag("W/\"x\",W/\"a\" ", "a", true), "a tag in a list of weak ones matches");
  static const char *const wrong[] = {"", "a", "\"a", "\"ab\"", "\"", "W/", "W/a", "\"x\" a", "\"A\"", ",,"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
    ok(!eo_field_lists_tag(wrong[i], "a", true), "%s does not match", wrong[i]);
}

static void test_wait(void)
{
  ok(eo_field_wait("wait=7") == 7 && eo_field_wait("respond-async, wait=10") == 10 &&
         eo_field_wait("return=minimal; wait=3") == 3,
     "seconds to wait are read");
  ok(eo_field_wait("wait=600") == 60 && eo_field_wait("wait=99999999999999999999") == 60,
     "nobody waits longer than a minute");
  ok(eo_field_wait(NULL) == 0 && eo_field_wait("wait=-1") == 0 && eo_field_wait("await=5") == 0 &&
         eo_field_wait("wait") == 0,
     "a wrong wish to wait is none");
}

static bool host_is(const char *header, const char *expected)
{
  char host[40];
  bool good = eo_field_host(header, host, sizeof host);
  return expected ? good && strcmp(host, expected) == 0 : !good;
}

static void test_hosts(void)
{
  ok(host_is("LocalHost", "localhost") && host_is("gears.example:8080", "gears.example") &&
         host_is("127.0.0.1:1", "127.0.0.1"),
     "names of hosts are read without their port");
  ok(host_is("[::1]", "::1") && host_is("[fe80::1]:80", "fe80::1"), "addresses of version 6 are read from brackets");
  static const char *const wrong[] = {"",       ":80", "[::1",    "[]",
                                      "[::1]x", "a b", "a:b",     "a:123456",
                                      "a/b",    "a@b", "[a]:80/", "0123456789012345678901234567890123456789"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
    ok(host_is(wrong[i], NULL), "\"%s\" is no host", wrong[i]);
  ok(eo_field_host_is_address("127.0.0.1") && eo_field_host_is_address("::1") &&
         eo_field_host_is_address("192.168.1.7"),
     "addresses of hosts are told as such");
  ok(!eo_field_host_is_address("127.0.0.1.example") && !eo_field_host_is_address("1") &&
         !eo_field_host_is_address("localhost"),
     "names of hosts are no addresses");
}

static void test_secrets(void)
{
  char value[10];
  ok(eo_field_cookie("a=b; session=xyz; c=d", "session", value, sizeof value) && strcmp(value, "xyz") == 0,
     "a cookie is found among others");
  ok(eo_field_cookie("session=", "session", value, sizeof value) && !*value, "an empty cookie is found");
  ok(!eo_field_cookie("session=0123456789", "session", value, sizeof value) &&
         !eo_field_cookie("asession=x", "session", value, sizeof value) &&
         !eo_field_cookie(NULL, "session", value, sizeof value),
     "a cookie that is too long, or has another name, is not found");
  ok(eo_field_equal_secret("sesame", "sesame"), "the right secret is equal");
  ok(!eo_field_equal_secret("sesam", "sesame") && !eo_field_equal_secret("sesamesesame", "sesame") &&
         !eo_field_equal_secret("", "sesame") && !eo_field_equal_secret("Sesame", "sesame"),
     "every wrong secret is unequal");
  ok(!eo_field_equal_secret("", ""), "no secret opens nothing");
}

static void test_paths(void)
{
  static const char *const good[] = {"/", "/index.html", "/a/b-c.js", "/..a", "/a..b/c", "/a/"};
  static const char *const bad[] = {"",       "a",  "//",    "/a//b", "/..",  "/../a", "/a/..",
                                    "/a/./b", "/.", "/a\\b", "/a\nb", "/a//", "/\x7f"};
  for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
    ok(eo_field_path_is_plain(good[i]), "the path %s is plain", good[i]);
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
    ok(!eo_field_path_is_plain(bad[i]), "path %zu of the bad ones is not plain", i);
}

static bool matches(const char *pattern, const char *path, const char *first, const char *second)
{
  char argument[2][64] = {"", ""};
  bool found = eo_field_match(pattern, path, sizeof argument[0], argument, 2);
  return first ? found && strcmp(argument[0], first) == 0 && strcmp(argument[1], second) == 0 : !found;
}

static void test_patterns(void)
{
  ok(matches("/jobs", "/jobs", "", "") && matches("/jobs/{id}", "/jobs/7", "7", "") &&
         matches("/jobs/{id}/events", "/jobs/7/events", "7", ""),
     "patterns match their paths");
  ok(matches("/a/{x}/{y}", "/a/1/two", "1", "two"), "both places of a pattern are filled");
  ok(matches("/jobs/{id}", "/jobs/", NULL, NULL) && matches("/jobs/{id}", "/jobs/7/", NULL, NULL) &&
         matches("/jobs/{id}", "/jobs", NULL, NULL) && matches("/jobs", "/jobss", NULL, NULL) &&
         matches("/jobs", "/job", NULL, NULL),
     "paths that are not of a pattern do not match");
  char path[200] = "/jobs/";
  memset(path + 6, '1', 100);
  ok(matches("/jobs/{id}", path, NULL, NULL), "a place takes no more than its room");
  ok(matches("/a/{x}/{y}/{z}", "/a/1/2/3", NULL, NULL), "a pattern fills no more places than there is room");
}

int main(void)
{
  test_numbers();
  test_visible();
  test_codings();
  test_types();
  test_tags();
  test_wait();
  test_hosts();
  test_secrets();
  test_paths();
  test_patterns();
  return tap_done();
}
