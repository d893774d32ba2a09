/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A measurement for people. */
#include <complex.h>
#include <math.h>
#include <stdio.h>

#include "document/measure_order.h"
#include "document/measurement_document.h"
#include "document/result_private.h"
#include "gear/names.h"

static const double CHANGING = 0.02; /* range of the speed, relative, from which the stretches are told */

/* The stretches of a recording whose speed changes. */
static void print_order_tracks(const struct eo_transmission *transmission, struct eo_text *text)
{
  if (transmission->speed_high - transmission->speed_low < CHANGING * transmission->speed || !transmission->tracks)
    return;
  eo_text_add(text, "  rpm and m/s2 of stretches:");
  for (int i = 0; i < transmission->tracks; i++)
    eo_text_print(text, " %.5g|%.4g", transmission->track[i].speed * 30 / M_PI, transmission->track[i].rms);
  eo_text_add(text, "\n");
}

void eo_measurement_summary(const struct eo_measurement *measurement, const struct eo_measurement_label *label,
                            struct eo_text *text)
{
  const struct eo_transmission *transmission = &measurement->transmission;
  char torque[40] = "torque not known";
  if (label->torque > 0)
    snprintf(torque, sizeof torque, "%.6g N m", label->torque);
  eo_text_print(text, "%s: %s, %s, %s end, %lld rows\n", label->file ? label->file : "recording",
                eo_measure_label[label->unmodified], torque, eo_end_name[label->end], (long long)measurement->rows);
  for (int i = 0; label->notes && i < label->notes->count && i < EO_NOTES; i++)
    eo_text_print(text, "  note: %s\n", label->notes->text[i]);
  for (int i = 0; i < measurement->findings.count && i < EO_MAX_FINDINGS; i++)
    eo_text_print(text, "  %s: %s\n", eo_severity_name(measurement->findings.finding[i].severity),
                  measurement->findings.finding[i].text);
  if (measurement->refused) {
    eo_text_add(text, "  No result.\n");
    return;
  }
  eo_text_print(
      text, "  %.7g rpm, %.4g turns; RMS %.4f +- %.4f m/s2 of %d mesh orders (spectrum %.4f, with sidebands %.4f)\n",
      transmission->speed * 30 / M_PI, transmission->revolutions[EO_PINION], transmission->rms, transmission->rms_sigma,
      transmission->harmonics, transmission->rms_spectrum, transmission->rms_band);
  eo_text_print(
      text,
      "  TE of the mesh %.4g um peak to peak; first shaft orders %.4g um pinion, %.4g um gear; residual %.3g um\n",
      1e6 * transmission->mesh_peak_to_peak, 1e6 * cabs(transmission->shaft[EO_PINION][0].amplitude),
      1e6 * cabs(transmission->shaft[EO_GEAR][0].amplitude), 1e6 * transmission->residual);
  print_order_tracks(transmission, text);
}
