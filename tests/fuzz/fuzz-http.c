/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a client sends, piece by piece: the first byte says which reader gets the rest. With clang's fuzzer:
     clang -fsanitize=fuzzer,address,undefined -DFUZZER ... ; without it the program replays the files it is given and
   prints TAP. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "format/json.h"
#include "document/sweep_document.h"
#include "http/header_field.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_design(const char *text, size_t size)
{
  static struct eo_faults faults;
  static struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  struct eo_error error;
  json_t *document = eo_json_parse(text, size, &error);
  faults.count = 0;
  if (document && eo_design_decode(document, &design, &warnings, &faults) &&
      eo_design_complete(&design, &geometry, &error) == EO_OK) {
    json_t *back = eo_design_encode(&design);
    if (!back)
      abort();
    json_decref(back);
  }
  json_decref(document);
}

static void read_sweep(const char *text, size_t size)
{
  static struct eo_faults faults;
  struct eo_sweep_request request;
  struct eo_sweep_axes axes = {0};
  struct eo_error error;
  json_t *document = eo_json_parse(text, size, &error);
  faults.count = 0;
  if (document)
    eo_table_decode(&eo_sweep_request_table, document, NULL, &request, &faults);
  if (document && !faults.count && eo_sweep_axes_init(&axes, &request, &error) == EO_OK)
    eo_sweep_axes_done(&axes);
  json_decref(document);
}

static void read_fields(const char *text)
{
  char host[80], cookie[80], argument[2][64];
  int64_t whole;
  double real;
  eo_field_integer(text, &whole);
  eo_field_real(text, &real);
  eo_field_is_visible(text, 65);
  eo_field_accepts_coding(text, "gzip");
  eo_field_prefers_type(text, "text/csv");
  eo_field_lists_tag(text, "1.1", true);
  eo_field_lists_tag(text, "1.1", false);
  eo_field_equal_secret(text, "sesame");
  eo_field_path_is_plain(text);
  if (eo_field_wait(text) < 0 || eo_field_wait(text) > 60)
    abort();
  if (eo_field_host(text, host, sizeof host))
    eo_field_host_is_address(host);
  if (eo_field_cookie(text, "easeoff_session", cookie, sizeof cookie) && strlen(cookie) >= sizeof cookie)
    abort();
  eo_field_match("/jobs/{id}/events", text, sizeof argument[0], argument, 2);
  eo_field_match("/export/{format}.csv", text, sizeof argument[0], argument, 2);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  if (!size)
    return 0;
  char *text = malloc(size);
  if (!text)
    return 0;
  memcpy(text, data + 1, size - 1);
  text[size - 1] = '\0';
  if (data[0] == 'd')
    read_design(text, size - 1);
  else if (data[0] == 's')
    read_sweep(text, size - 1);
  else
    read_fields(text);
  free(text);
  return 0;
}

#ifndef FUZZER
#include "support/tap.h"

static void replay(const char *path)
{
  static uint8_t data[1 << 20];
  FILE *stream = fopen(path, "rb");
  size_t size = stream ? fread(data, 1, sizeof data, stream) : 0;
  if (stream)
    fclose(stream);
  const char *name = strrchr(path, '/');
  ok(size > 0 && LLVMFuzzerTestOneInput(data, size) == 0, "%s: %zu bytes", name ? name + 1 : path, size);
}

int main(int argc, char **argv)
{
  for (int i = 1; i < argc; i++)
    replay(argv[i]);
  return tap_done();
}
#endif
