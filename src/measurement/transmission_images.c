/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the rows are those that were recorded. Orders that are not fitted stand in the residual above any image:
   where fewer are asked for than usual, the usual ones are fitted once more over the same axis, for this question
   alone. */
#include "measurement/transmission_private.h"

#include <stdlib.h>

/* m, residual: encoders leave a hundred times as much, digits of angles that were computed less. */
static const double QUIET = 1e-11;

/* A fit of its own that what is asked for does not see. */
struct looked {
  struct eo_order_fit fit;
  struct eo_transmission result;
};

static enum eo_code add_row(struct eo_order_fit *fit, const double row[3], int64_t index, struct eo_error *error)
{
  double theta, part[3], residual;
  (void)index;
  (void)error;
  if (eo_order_fit_residual(fit, row, &theta, part, &residual))
    eo_images_add(fit->images, theta, residual);
  return EO_OK;
}

static enum eo_code fit_again(struct eo_order_fit *fit, struct eo_error *error)
{
  eo_terms_init(&fit->terms, fit->settings->teeth, fit->result->harmonics, fit->turns, fit->start, fit->end);
  return eo_order_fit_solve(fit, error);
}

static enum eo_code look(struct eo_order_fit *fit, int asked, struct eo_images_found *found, struct eo_error *error)
{
  struct eo_order_line mesh[EO_MESH_ORDERS];
  if (fit->result->harmonics > asked)
    EO_TRY(fit_again(fit, error));
  EO_TRY(eo_images_new(&fit->images, error));
  EO_TRY(eo_order_fit_each_row(fit, add_row, "residual", error));
  for (int h = 0; h < fit->result->harmonics; h++)
    mesh[h] = (struct eo_order_line){.order = fit->terms.order[h], .amplitude = eo_order_fit_amplitude(fit, h)};
  return eo_images_find(fit->images, mesh, fit->result->harmonics, asked, found, error);
}

static enum eo_code find_images(const struct eo_order_fit *fit, struct eo_images_found *found, struct eo_error *error)
{
  struct looked *looked = calloc(1, sizeof *looked);
  int asked = fit->result->harmonics, usual = fit->possible < EO_USUAL_ORDERS ? fit->possible : EO_USUAL_ORDERS;
  if (!looked)
    return eo_error_memory(error);
  looked->fit = *fit;
  looked->fit.result = &looked->result;
  looked->result.harmonics = asked > usual ? asked : usual;
  looked->fit.last = fit->last - fit->first < EO_IMAGES_ROWS ? fit->last : fit->first + EO_IMAGES_ROWS - 1;
  enum eo_code code = look(&looked->fit, asked, found, error);
  eo_images_free(looked->fit.images);
  free(looked);
  return code;
}

/* Not rows that were interpolated here, and not where the noise goes with the tracks. */
enum eo_code eo_order_fit_judge_images(struct eo_order_fit *fit, struct eo_error *error)
{
  const struct eo_transmission *result = fit->result;
  struct eo_images_found found;
  if (fit->angles->interpolated.step > 0 || fit->angles->raw[0] || fit->angles->raw[1])
    return EO_OK;
  EO_TRY(find_images(fit, &found, error));
  if (found.rate > 0 && found.loss * result->rms > result->rms_sigma)
    eo_findings_add(
        fit->findings, EO_FINDING_SAMPLE_RATE, EO_SEVERITY_REFUSED, -1, found.rate / fit->angles->interval,
        "The angles were recorded with about %.5g rows per second and brought to %.5g on straight lines "
        "between them, which takes up to %.2g %% from the RMS of the mesh orders. Export each channel as it "
        "was recorded, with its own times.",
        found.rate / fit->angles->interval, 1 / fit->angles->interval, 100 * found.loss);
  else if (result->residual > QUIET && found.alike_loss * result->rms > result->rms_sigma)
    eo_findings_add(fit->findings, EO_FINDING_SAMPLE_RATE, EO_SEVERITY_WARNING, -1, found.alike,
                    "The noise of neighbouring rows is alike as if they were means of neighbours: by a filter, or a "
                    "program that brought a channel to other times on straight lines. If the vibration went the same "
                    "way, about %.2g %% of the RMS are missing. Export each channel with its own times.",
                    100 * found.alike_loss);
  return EO_OK;
}
