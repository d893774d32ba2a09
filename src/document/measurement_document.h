/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measurements as JSON: what was found in one recording, and several beside the prediction. The terminal and the
   service print the same documents; a stored measurement is read back from its own.

   A measurement:
     file, label ("unmodified" | "modified"), torque_Nm, end, notes (what the reader and the layout guess say), layout
     findings [{kind, severity ("note" | "repaired" | "warning" | "refused"), channel, row (from 1), line, value,
   text}], refused signal {rows, interval_ms, ratio, tracks [per channel: amplitude, ratio, phase_deg, offset of raw
   tracks]} result (null when refused) {rows, seconds, turns {pinion, gear}, speed_rpm {mean, lowest, highest},
   harmonics, rms_m_per_s2 {value, sigma, upto [..], spectrum, band}, mesh {order, amplitude_um, phase_rad, sigma_um,
   acceleration_m_per_s2}, sidebands, shafts {pinion, gear}, te {peak_to_peak_um, position, mesh_um, average_um},
   residual_um, drift_um, hunting_turns, spectrum {order, acceleration_m_per_s2}}

   A comparison: measurements (columns over the measurements), orders, curves, reductions, ratio; see the encoder. */
#ifndef EASEOFF_DOCUMENT_MEASUREMENT_DOCUMENT_H
#define EASEOFF_DOCUMENT_MEASUREMENT_DOCUMENT_H

#include <jansson.h>

#include "format/outline.h"
#include "format/text.h"
#include "measurement/comparison.h"
#include "measurement/measurement.h"
#include "recording/notes.h"

/* What goes with a recording beside its result. */
struct eo_measurement_label {
  const char *file; /* borrowed, without folders */
  bool unmodified;
  double torque; /* N m */
  int end;
  const struct eo_notes *notes; /* borrowed; may be NULL */
  const json_t *layout;         /* borrowed; may be NULL */
};

extern const struct eo_outline eo_measurement_outline, eo_comparison_outline;
/* What lists and comparisons need of a measurement: eo_outline_take() gives it, eo_measured_decode() reads that too. */
extern const struct eo_outline eo_measurement_brief;

/* New document; NULL without memory. */
json_t *eo_measurement_encode(const struct eo_measurement *measurement, const struct eo_measurement_label *label);

/* Back from the document. Errors: EO_ERROR_INPUT (refused, or not such a document). */
enum eo_code eo_measured_decode(const json_t *document, struct eo_measured *measured, struct eo_error *error);

/* id: [count] numbers of stored measurements; NULL: they are files. */
json_t *eo_comparison_encode(const struct eo_comparison *comparison, const struct eo_measured *measured,
                             const int64_t *id);

/* For people. */
void eo_measurement_summary(const struct eo_measurement *measurement, const struct eo_measurement_label *label,
                            struct eo_text *text);
void eo_comparison_summary(const struct eo_comparison *comparison, const struct eo_measured *measured,
                           struct eo_text *text);

/* One line per measurement, CSV. */
void eo_comparison_csv(const struct eo_comparison *comparison, const struct eo_measured *measured,
                       struct eo_text *text);

#endif
