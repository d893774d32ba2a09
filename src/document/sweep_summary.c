/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep for people. */
#include <math.h>

#include "format/text_table.h"
#include "document/sweep_document.h"

enum { DIGITS = 4 };

static double worse(const struct eo_sweep *sweep, const double value[2])
{
  return sweep->ends == 2 ? fmax(value[0], value[1]) : value[0];
}

static void add_headings(const struct eo_sweep *sweep, struct eo_text_table *sheet)
{
  static const char *const first[] = {"N m",      "rpm",    "TE um",   "unmod.", "impact N", "unmod.",
                                      "RMS m/s2", "unmod.", "transv.", "rotat.", "factor",   "loss %"};
  eo_text_table_init(sheet, 0, NULL);
  if (sweep->value)
    eo_text_table_string(sheet, sweep->key);
  for (size_t i = 0; i < sizeof first / sizeof *first; i++)
    eo_text_table_string(sheet, first[i]);
  if (sweep->branches[EO_SWEEP_DESIGN])
    eo_text_table_string(sheet, "down");
  if (sweep->branches[EO_SWEEP_UNMODIFIED])
    eo_text_table_string(sheet, "unmod. down");
  eo_text_table_string(sheet, "outcome");
  sheet->columns = sheet->cells;
}

static void add_point(const struct eo_sweep *sweep, int i, struct eo_text_table *sheet)
{
  static const char *const outcomes[] = {"converged", "contact lost", "not converged"};
  const struct eo_sweep_torque *torque[2] = {&sweep->at_torque[0][i / sweep->speeds],
                                             &sweep->at_torque[1][i / sweep->speeds]};
  const struct eo_sweep_point *sweep_point[2] = {&sweep->point[0][EO_SWEEP_UP][i], &sweep->point[1][EO_SWEEP_UP][i]};
  if (sweep->value)
    eo_text_table_number(sheet, sweep->value[i / sweep->speeds], NULL, 6);
  eo_text_table_number(sheet, sweep->torque[i / sweep->speeds], &eo_unit_Nm, 6);
  eo_text_table_number(sheet, sweep->speed[i % sweep->speeds], &eo_unit_rpm, 6);
  for (int v = 0; v < 2; v++)
    eo_text_table_number(sheet, torque[v]->peak_to_peak, &eo_unit_um, DIGITS);
  for (int v = 0; v < 2; v++)
    eo_text_table_number(sheet, worse(sweep, sweep_point[v]->impact), &eo_unit_N, DIGITS + 1);
  for (int v = 0; v < 2; v++)
    eo_text_table_number(sheet, sweep_point[v]->rms_pair[EO_READING_NORMAL], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_number(sheet, sweep_point[0]->rms_pair[EO_READING_TRANSVERSE], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_number(sheet, sweep_point[0]->rms_pair[EO_READING_ROTATIONAL], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_number(sheet, worse(sweep, sweep_point[0]->dynamic_factor), NULL, DIGITS);
  eo_text_table_number(sheet, 100 * worse(sweep, sweep_point[0]->contact_loss), NULL, 3);
  for (int v = 0; v < 2; v++)
    if (sweep->branches[v])
      eo_text_table_number(sheet, sweep->point[v][EO_SWEEP_DOWN][i].rms_pair[EO_READING_NORMAL], &eo_unit_m_per_s2,
                           DIGITS);
  eo_text_table_string(sheet, outcomes[sweep_point[0]->outcome]);
}

/* Modes of the middle torque and, beside each, the speeds at which mesh orders meet it. */
static void print_modes(const struct eo_sweep *sweep, struct eo_text *text)
{
  int middle = sweep->torques / 2;
  const struct eo_dynamics_modes *modes = &sweep->at_torque[EO_SWEEP_DESIGN][middle].modes;
  eo_text_print(text, "\nEigenfrequencies at %.6g N m and the speeds at which mesh orders meet them\n",
                eo_unit_out(&eo_unit_Nm, sweep->torque[middle]));
  for (int mode = 0; mode < modes->n; mode++) {
    eo_text_print(text, "  %8.1f Hz", modes->frequency[mode]);
    for (int i = 0; i < sweep->crossings; i++)
      if (sweep->crossing[i].torque == middle && sweep->crossing[i].mode == mode)
        eo_text_print(text, "   %d: %.0f rpm", sweep->crossing[i].order,
                      eo_unit_out(&eo_unit_rpm, sweep->crossing[i].speed));
    eo_text_add(text, "\n");
  }
}

void eo_sweep_summary(const struct eo_sweep *sweep, const struct eo_design *design, const struct eo_warnings *warnings,
                      struct eo_text *text)
{
  struct eo_text_table sheet;
  if (*design->name)
    eo_text_print(text, "%s\n", design->name);
  eo_text_add(text,
              "Peak-to-peak transmission error, entering impact (worse end) and RMS of the normal acceleration, each "
              "compared with the unmodified pair;\n"
              "RMS of the transverse and rotational acceleration, dynamic factor and contact loss of the design\n\n");
  add_headings(sweep, &sheet);
  for (int i = 0; i < sweep->torques * sweep->speeds; i++)
    add_point(sweep, i, &sheet);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  print_modes(sweep, text);
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_text_print(text, "Note: %s\n", warnings->text[i]);
}
