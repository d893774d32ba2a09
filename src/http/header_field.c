/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/header_field.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool eo_field_integer(const char *text, int64_t *value)
{
  char *end;
  if (!isdigit((unsigned char)text[*text == '-']))
    return false;
  errno = 0;
  long long read = strtoll(text, &end, 10);
  if (*end || errno)
    return false;
  *value = read;
  return true;
}

bool eo_field_real(const char *text, double *value)
{
  char *end;
  if (!*text || strspn(text, "0123456789+-.eE") != strlen(text))
    return false;
  double read = strtod(text, &end);
  if (*end || !isfinite(read))
    return false;
  *value = read;
  return true;
}

bool eo_field_is_visible(const char *text, size_t size)
{
  size_t length = strnlen(text, size);
  for (size_t i = 0; i < length; i++)
    if (text[i] < '!' || text[i] > '~')
      return false;
  return length > 0 && length < size;
}

struct item {
  const char *text; /* borrowed */
  size_t length;    /* of the name, before parameters */
  double quality;
};

static const char *skip_blanks(const char *text)
{
  return text + strspn(text, " \t");
}

static double read_quality(const char *text, size_t length)
{
  for (const char *at = text; at + 2 < text + length; at++)
    if (at[0] == ';') {
      const char *name = skip_blanks(at + 1);
      if (strncasecmp(name, "q=", 2) == 0)
        return isdigit((unsigned char)name[2]) ? fmin(strtod(name + 2, NULL), 1) : 0;
    }
  return 1;
}

/* The next entry of a comma-separated list of names with parameters; false at its end. */
static bool next_item(const char **list, struct item *item)
{
  const char *text = *list + strspn(*list, " \t,");
  size_t length = strcspn(text, ",");
  if (!length)
    return false;
  *item = (struct item){text, strcspn(text, ";, \t"), read_quality(text, length)};
  *list = text + length;
  return true;
}

static bool is_named(const struct item *item, const char *name)
{
  return item->length == strlen(name) && strncasecmp(item->text, name, item->length) == 0;
}

bool eo_field_accepts_coding(const char *header, const char *coding)
{
  struct item item;
  double any = 0;
  while (header && next_item(&header, &item)) {
    if (is_named(&item, coding))
      return item.quality > 0;
    if (is_named(&item, "*"))
      any = item.quality;
  }
  return any > 0;
}

bool eo_field_prefers_type(const char *header, const char *type)
{
  struct item item;
  double asked = 0, json = 0;
  while (header && next_item(&header, &item)) {
    if (is_named(&item, type))
      asked = item.quality;
    else if (is_named(&item, "application/json"))
      json = item.quality;
  }
  return asked > 0 && asked >= json;
}

bool eo_field_lists_tag(const char *header, const char *tag, bool weak)
{
  size_t length = strlen(tag);
  while (header && *(header += strspn(header, " \t,"))) {
    bool is_weak = strncmp(header, "W/", 2) == 0;
    const char *start = header + (is_weak ? 2 : 0);
    if (*start != '"')
      return *header == '*' && !*skip_blanks(header + 1);
    size_t size = strcspn(start + 1, "\"");
    if (start[1 + size] != '"')
      return false;
    if ((weak || !is_weak) && size == length && strncmp(start + 1, tag, size) == 0)
      return true;
    header = start + 2 + size;
  }
  return false;
}

int eo_field_wait(const char *header)
{
  static const int MOST = 60;
  while (header && *(header += strspn(header, " \t,;"))) {
    if (strncasecmp(header, "wait=", 5) == 0 && isdigit((unsigned char)header[5])) {
      long seconds = strtol(header + 5, NULL, 10);
      return seconds > MOST ? MOST : (int)seconds;
    }
    header += strcspn(header, " \t,;");
  }
  return 0;
}

bool eo_field_is_async(const char *header)
{
  static const char WORD[] = "respond-async";
  while (header && *(header += strspn(header, " \t,;"))) {
    size_t length = strcspn(header, " \t,;");
    if (length == sizeof WORD - 1 && strncasecmp(header, WORD, length) == 0)
      return true;
    header += length;
  }
  return false;
}

static bool is_port(const char *text)
{
  size_t digits = strspn(text, "0123456789");
  return digits <= 5 && !text[digits];
}

bool eo_field_host(const char *header, char *host, size_t size)
{
  bool bracket = *header == '[';
  const char *start = header + bracket;
  size_t length = strcspn(start, bracket ? "]" : ":");
  const char *rest = start + length;
  if (bracket && *rest++ != ']')
    return false;
  if (!length || length >= size || (*rest && (*rest != ':' || !is_port(rest + 1))))
    return false;
  for (size_t i = 0; i < length; i++) {
    unsigned char c = (unsigned char)start[i];
    if (!isalnum(c) && !strchr(bracket ? ":." : "-._", c))
      return false;
    host[i] = (char)tolower(c);
  }
  host[length] = '\0';
  return true;
}

bool eo_field_host_is_address(const char *host)
{
  struct in6_addr address;
  return inet_pton(AF_INET, host, &address) == 1 || inet_pton(AF_INET6, host, &address) == 1;
}

bool eo_field_cookie(const char *header, const char *name, char *value, size_t size)
{
  size_t length = strlen(name);
  while (header && *(header += strspn(header, " ;"))) {
    size_t whole = strcspn(header, ";");
    if (strncmp(header, name, length) == 0 && header[length] == '=') {
      size_t rest = whole - length - 1;
      if (rest >= size)
        return false;
      memcpy(value, header + length + 1, rest);
      value[rest] = '\0';
      return true;
    }
    header += whole;
  }
  return false;
}

bool eo_field_equal_secret(const char *given, const char *expected)
{
  size_t length = strlen(expected), have = strlen(given);
  unsigned char different = have != length;
  for (size_t i = 0; i < length; i++)
    different |= (unsigned char)(expected[i] ^ given[have ? i % have : 0]);
  return !different && length > 0;
}

bool eo_field_path_is_plain(const char *path)
{
  if (*path != '/')
    return false;
  for (const char *c = path; *c; c++) {
    if ((unsigned char)*c < 32 || *c == 127 || *c == '\\')
      return false;
    if (*c != '/')
      continue;
    size_t length = strcspn(c + 1, "/");
    bool last = !c[1 + length], dots = (length == 1 && c[1] == '.') || (length == 2 && c[1] == '.' && c[2] == '.');
    if (dots || (length == 0 && !last))
      return false;
  }
  return true;
}

bool eo_field_match(const char *pattern, const char *path, size_t size, char argument[][64], int count)
{
  int found = 0;
  while (*pattern) {
    if (*pattern != '{') {
      if (*pattern++ != *path++)
        return false;
      continue;
    }
    pattern += strcspn(pattern, "}") + 1;
    size_t length = strcspn(path, "/");
    if (*pattern && *pattern != '/' && length > strlen(pattern)) /* "{id}.csv" */
      length -= strlen(pattern);
    if (!length || length >= size || found == count)
      return false;
    memcpy(argument[found], path, length);
    argument[found++][length] = '\0';
    path += length;
  }
  return !*path;
}
