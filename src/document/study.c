#include "document/study.h"

#include <string.h>

#include "document/design_document.h"

static const struct eo_field *find_field(const char *key)
{
  for (int i = 0; i < eo_optimization_table.count; i++)
    if (strcmp(eo_optimization_table.field[i].key, key) == 0)
      return &eo_optimization_table.field[i];
  return NULL;
}

static void copy_parameter(const struct eo_parameter *parameter, const void *source, void *target)
{
  const struct eo_field *field = find_field(parameter->key);
  if (!field)
    return;
  const char *from = (const char *)source + field->offset;
  char *to = (char *)target + parameter->offset;
  if (field->kind == EO_FIELD_SEED)
    memcpy(to, from, sizeof(uint64_t));
  else if (field->kind == EO_FIELD_FLAG)
    *(int *)to = *(const bool *)from;
  else if (field->kind != EO_FIELD_NUMBER)
    *(int *)to = *(const int *)from;
  else if (!isnan(*(const double *)from)) /* open: the optimizer's own rule */
    *(double *)to = *(const double *)from;
}

void eo_design_study(const struct eo_design *design, struct eo_optimizer_settings *settings)
{
  int count, per_end = design->optimization.variables == EO_VARIABLES_PER_END && design->gear_pair.ends == 2;
  const struct eo_parameter *parameter = eo_optimizer_parameters(&count);
  eo_optimizer_defaults(settings, eo_optimizer_algorithm_find(design->optimization.algorithm), per_end ? 10 : 5);
  settings->objectives = 3;
  for (int i = 0; i < count; i++)
    copy_parameter(&parameter[i], &design->optimization, settings);
}
