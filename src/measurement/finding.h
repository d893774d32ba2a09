/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the checks of a recording found: each with its evidence, in plain words. A recording with a refusing finding has
   no result. */
#ifndef EASEOFF_MEASUREMENT_FINDING_H
#define EASEOFF_MEASUREMENT_FINDING_H

#include <stdbool.h>
#include <stdint.h>

enum eo_finding_kind {
  EO_FINDING_SWAPPED,     /* pinion and gear exchanged */
  EO_FINDING_REVERSED,    /* one encoder counts the other way */
  EO_FINDING_TEETH,       /* the ratio of the speeds is not that of the tooth numbers */
  EO_FINDING_UNITS,       /* degrees against radians */
  EO_FINDING_WRAPPED,     /* the angle starts again every turn */
  EO_FINDING_DROPPED,     /* rows missing from both channels */
  EO_FINDING_SLIP,        /* one channel jumps against the other */
  EO_FINDING_CONSTANT,    /* a channel that does not move */
  EO_FINDING_SATURATED,   /* a raw track that is cut off */
  EO_FINDING_TOO_SHORT,   /* too few revolutions */
  EO_FINDING_UNSTEADY,    /* the speed changes */
  EO_FINDING_SAMPLE_RATE, /* too low for the mesh orders */
  EO_FINDING_TIME,        /* time runs backwards or stands still */
  EO_FINDING_NAN,         /* rows without a number */
  EO_FINDING_SPIKE,       /* single values far off */
  EO_FINDING_TRACK,       /* amplitude, ratio or phase of raw tracks outside the usual limits */
  EO_FINDING_SPEED,       /* not the speed that was stated */
  EO_FINDING_RESOLUTION,  /* the signal drowns in noise or quantisation */
  EO_FINDING_LAYOUT,      /* what the columns mean is unclear */
  EO_FINDING_TORQUE,      /* not steady, or not what was stated */
  EO_FINDING_PULSE,       /* missing, double, or teeth missing of the wheel */
  EO_FINDING_KINDS
};

enum eo_severity {
  EO_SEVERITY_NOTE,     /* worth knowing */
  EO_SEVERITY_REPAIRED, /* wrong, set right, the result stands */
  EO_SEVERITY_WARNING,  /* the result stands but deserves doubt */
  EO_SEVERITY_REFUSED,  /* no result */
};

struct eo_finding {
  enum eo_finding_kind kind;
  enum eo_severity severity;
  int channel;  /* EO_PINION, EO_GEAR; -1: both or neither */
  int64_t row;  /* first row concerned, from 0; -1: none in particular */
  int64_t line; /* of the file, from 1; 0: not known */
  double value; /* the evidence as a number; NaN: none. The text says of what */
  char text[320];
};

enum { EO_MAX_FINDINGS = 48 };

struct eo_findings {
  int count; /* all; beyond EO_MAX_FINDINGS they are only counted */
  struct eo_finding finding[EO_MAX_FINDINGS];
};

/* Adds a finding with its sentence; the caller may set row and line of the one returned (never NULL). */
struct eo_finding *eo_findings_add(struct eo_findings *findings, enum eo_finding_kind kind, enum eo_severity severity,
                                   int channel, double value, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

const char *eo_severity_name(enum eo_severity severity); /* "note", "repaired", ... */
/* "swapped", "reversed", ... and the severities, by number; end with NULL. */
extern const char *const eo_finding_names[], *const eo_severity_names[];

/* The first of a kind; NULL when there is none. */
const struct eo_finding *eo_findings_find(const struct eo_findings *findings, enum eo_finding_kind kind);

/* The most severe of all; EO_SEVERITY_NOTE when there is none. */
enum eo_severity eo_findings_worst(const struct eo_findings *findings);

#endif
