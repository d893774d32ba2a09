/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/finding.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *const eo_finding_names[EO_FINDING_KINDS + 1] = {
    "swapped",   "reversed",   "teeth",    "units",       "wrapped", "dropped", "slip",  "constant",
    "saturated", "too-short",  "unsteady", "sample-rate", "time",    "nan",     "spike", "track",
    "speed",     "resolution", "layout",   "torque",      "pulse",   NULL};

struct eo_finding *eo_findings_add(struct eo_findings *findings, enum eo_finding_kind kind, enum eo_severity severity,
                                   int channel, double value, const char *format, ...)
{
  va_list arguments;
  int at = findings->count < EO_MAX_FINDINGS ? findings->count : EO_MAX_FINDINGS - 1;
  struct eo_finding *finding = &findings->finding[at];
  findings->count++;
  *finding = (struct eo_finding){.kind = kind, .severity = severity, .channel = channel, .row = -1, .value = value};
  va_start(arguments, format);
  vsnprintf(finding->text, sizeof finding->text, format, arguments);
  va_end(arguments);
  return finding;
}

const char *const eo_severity_names[] = {"note", "repaired", "warning", "refused", NULL};

const char *eo_severity_name(enum eo_severity severity)
{
  return eo_severity_names[severity];
}

static int kept(const struct eo_findings *findings)
{
  return findings->count < EO_MAX_FINDINGS ? findings->count : EO_MAX_FINDINGS;
}

const struct eo_finding *eo_findings_find(const struct eo_findings *findings, enum eo_finding_kind kind)
{
  for (int i = 0; i < kept(findings); i++)
    if (findings->finding[i].kind == kind)
      return &findings->finding[i];
  return NULL;
}

enum eo_severity eo_findings_worst(const struct eo_findings *findings)
{
  enum eo_severity worst = EO_SEVERITY_NOTE;
  for (int i = 0; i < kept(findings); i++)
    if (findings->finding[i].severity > worst)
      worst = findings->finding[i].severity;
  return worst;
}
