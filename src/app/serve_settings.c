/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/serve_settings.h"

#include <stdlib.h>

#include "app/table_options.h"
#include "base/parallel.h"
#include "format/json.h"

static const struct eo_field server_fields[] = {
    {.key = "listen",
     .kind = EO_FIELD_TEXT,
     .offset = offsetof(struct eo_serve_settings, listen),
     .count = sizeof((struct eo_serve_settings *)0)->listen,
     .fallback_text = "127.0.0.1:8080",
     .help = "address and port; port 0 takes a free one"},
    EO_TEXT_DERIVED(struct eo_serve_settings, data, "data", 0, "as said above",
                    "folder of the database and the recordings"),
    EO_TEXT_DERIVED(struct eo_serve_settings, token_file, "token_file", 0, "$EASEOFF_TOKEN",
                    "file whose first line is the token"),
    EO_TEXT_DERIVED(struct eo_serve_settings, host, "host", 0, "none; with a token every name",
                    "name under which clients call the server, in addition to localhost and plain addresses"),
    EO_TEXT_DERIVED(struct eo_serve_settings, web, "web", 0, "$EASEOFF_WEB, else where they were installed",
                    "folder of the page's files"),
    EO_TEXT_DERIVED(struct eo_serve_settings, launcher, "launcher", 0, "the server itself",
                    "command that runs optimizations and studies, for instance \"mpirun -n 64 --hostfile hosts\""),
    EO_INTEGER_DERIVED(struct eo_serve_settings, threads, "threads", 1, EO_MAX_THREADS,
                       "as many as there are processors", "threads of an optimization or a sweep"),
    EO_FLAG(struct eo_serve_settings, allow_anyone, "allow_anyone", 0,
            "answer without a token at an address that others reach"),
    EO_FLAG(struct eo_serve_settings, quiet, "quiet", 0, "log only errors"),
    EO_OBJECT(struct eo_serve_settings, limits, "requests", &eo_http_limits_table, "what clients may do"),
    EO_OBJECT(struct eo_serve_settings, work, "work", &eo_service_limits_table, "what jobs may take and what is kept"),
};
static const struct eo_table server_table = EO_TABLE("the configuration of a server", struct eo_serve_settings,
                                                     server_fields);

static enum eo_code load(const struct eo_table_options *options, const char *config, json_t **document,
                         struct eo_error *error)
{
  *document = config ? eo_json_load(config, EO_JSON_DESIGN_BYTES, error) : json_object();
  if (!*document)
    return config ? error->code : eo_error_memory(error);
  return eo_table_options_put(options, *document, error);
}

static int decode(const struct eo_table_options *options, const char *config, struct eo_serve_settings *settings)
{
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = NULL;
  enum eo_code code = faults ? load(options, config, &document, &error) : eo_error_memory(&error);
  if (!code)
    eo_table_decode(&server_table, document, NULL, settings, faults);
  int status = code            ? eo_app_fail(config, &error)
               : faults->count ? eo_app_fail_all(config ? config : "serve", faults)
                               : EO_EXIT_DONE;
  json_decref(document);
  free(faults);
  return status;
}

bool eo_serve_settings_read(const struct eo_command *command, int argc, char **argv, struct eo_serve_settings *settings,
                            int *status)
{
  struct eo_table_options *options = eo_app_request(sizeof *options, status);
  const char *none, *config = NULL;
  int operands;
  if (!options)
    return false;
  options->bare_flags = true;
  eo_table_options_add(options, &server_table);
  eo_table_options_add_own(options, (struct eo_option){.name = "--config", .value = &config});
  bool good = eo_table_options_read(options, command, argc, argv, 0, 0, &none, &operands, status) &&
              (*status = decode(options, config, settings)) == EO_EXIT_DONE;
  free(options);
  return good;
}
