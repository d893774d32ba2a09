/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/pair_log.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "evaluation/scatter_levels.h"

#include <config.h>

struct eo_pair_log {
  FILE *file;
  int outputs, pairs;
  double *row; /* [pairs][outputs] */
  bool *there; /* [pairs] */
  char path[200];
};

enum eo_code eo_pair_log_hash(const struct eo_design *design, char hash[EO_HASH_LENGTH + 1], struct eo_error *error)
{
  struct eo_design *own = malloc(sizeof *own);
  if (!own)
    return eo_error_memory(error);
  memcpy(own, design, sizeof *own);
  if (own->tolerance.sampling != EO_SAMPLING_LATIN)
    own->tolerance.pairs = 1;
  memset(own->tolerance.limit, 0, sizeof own->tolerance.limit);
  own->tolerance.limits = 0;
  bool followed = design->tolerance.single_teeth && eo_scatter_is_coarse_first(design);
  own->tolerance.method = followed ? EO_SCATTER_COARSE_FIRST : EO_SCATTER_AUTO;
  enum eo_code code = eo_design_hash(own, hash, error);
  free(own);
  return code;
}

static enum eo_code head_line(const struct eo_design *design, int outputs, char *line, size_t size,
                              struct eo_error *error)
{
  char hash[EO_HASH_LENGTH + 1];
  enum eo_code code = eo_pair_log_hash(design, hash, error);
  snprintf(line, size, "easeoff pairs %d %d %s\n", EO_EVALUATOR_VERSION, outputs, hash);
  return code;
}

/* "pair v v v ...\n", numbers in hexadecimal so that they come back as they were. False: cut off. */
static bool read_row(struct eo_pair_log *log)
{
  int pair, end = 0;
  if (fscanf(log->file, "%d", &pair) != 1 || pair < 0 || pair >= log->pairs)
    return false;
  double *row = log->row + (size_t)pair * (size_t)log->outputs;
  for (int i = 0; i < log->outputs; i++) {
    char word[64], *last;
    if (fscanf(log->file, "%63s", word) != 1)
      return false;
    row[i] = strtod(word, &last);
    if (*last)
      return false;
  }
  if (fscanf(log->file, " ;%n", &end) == EOF || end == 0)
    return false;
  log->there[pair] = true;
  return true;
}

static enum eo_code read_rows(struct eo_pair_log *log, const char *head, struct eo_error *error)
{
  char line[200] = "";
  long good;
  if (fgets(line, sizeof line, log->file) && strcmp(line, head) != 0)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "%.120s holds no pairs of this design with this scatter: name another file.", log->path);
  good = *line ? ftell(log->file) : 0;
  while (*line && read_row(log))
    good = ftell(log->file);
  if (fseek(log->file, good, SEEK_SET) != 0)
    return eo_error_set(error, EO_ERROR_FILE, "", "%.120s: %s.", log->path, strerror(errno));
  if (!*line)
    fputs(head, log->file);
  else
    fputc('\n', log->file); /* behind what was cut off */
  return EO_OK;
}

enum eo_code eo_pair_log_open(struct eo_pair_log **result, const char *path, const struct eo_design *design,
                              int outputs, struct eo_error *error)
{
  char head[160];
  struct eo_pair_log *log = calloc(1, sizeof *log);
  if (!log)
    return eo_error_memory(error);
  log->outputs = outputs;
  log->pairs = design->tolerance.pairs;
  snprintf(log->path, sizeof log->path, "%s", path);
  log->row = malloc(sizeof *log->row * (size_t)log->pairs * (size_t)outputs);
  log->there = calloc((size_t)log->pairs, sizeof *log->there);
  enum eo_code code = log->row && log->there ? head_line(design, outputs, head, sizeof head, error)
                                             : eo_error_memory(error);
  if (!code) {
    log->file = fopen(path, "r+");
    if (!log->file && errno == ENOENT)
      log->file = fopen(path, "w+");
    if (!log->file)
      code = eo_error_set(error, EO_ERROR_FILE, "", "%.120s: %s.", path, strerror(errno));
  }
  if (!code)
    code = read_rows(log, head, error);
  if (code)
    eo_pair_log_close(log);
  else
    *result = log;
  return code;
}

void eo_pair_log_close(struct eo_pair_log *log)
{
  if (!log)
    return;
  if (log->file)
    fclose(log->file);
  free(log->row);
  free(log->there);
  free(log);
}

static bool find(void *context, int pair, double *output)
{
  const struct eo_pair_log *log = context;
  if (pair >= log->pairs || !log->there[pair])
    return false;
  memcpy(output, log->row + (size_t)pair * (size_t)log->outputs, sizeof *output * (size_t)log->outputs);
  return true;
}

static enum eo_code keep(void *context, int pair, const double *output, double cost, struct eo_error *error)
{
  (void)cost;
  struct eo_pair_log *log = context;
  fprintf(log->file, "%d", pair);
  for (int i = 0; i < log->outputs; i++)
    fprintf(log->file, " %a", output[i]);
  fputs(" ;\n", log->file);
  if (fflush(log->file) != 0)
    return eo_error_set(error, EO_ERROR_FILE, "", "%.120s: %s.", log->path, strerror(errno));
  return EO_OK;
}

struct eo_scatter_log eo_pair_log_of(struct eo_pair_log *log)
{
  return log ? (struct eo_scatter_log){find, keep, log} : (struct eo_scatter_log){0};
}
