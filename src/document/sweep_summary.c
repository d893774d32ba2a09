/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep for people. */
#include <math.h>

#include "format/text_table.h"
#include "document/sweep_document.h"

enum { DIGITS = 4 };

static double worse(const struct eo_sweep *s, const double value[2])
{
  return s->ends == 2 ? fmax(value[0], value[1]) : value[0];
}

static void add_headings(const struct eo_sweep *s, struct eo_text_table *sheet)
{
  static const char *const first[] = {"N m",      "rpm",    "TE um",   "unmod.", "impact N", "unmod.",
                                      "RMS m/s2", "unmod.", "transv.", "rotat.", "factor",   "loss %"};
  eo_text_table_init(sheet, 0, NULL);
  for (size_t i = 0; i < sizeof first / sizeof *first; i++)
    eo_text_table_string(sheet, first[i]);
  if (s->branches[EO_SWEEP_DESIGN])
    eo_text_table_string(sheet, "down");
  if (s->branches[EO_SWEEP_UNMODIFIED])
    eo_text_table_string(sheet, "unmod. down");
  eo_text_table_string(sheet, "outcome");
  sheet->columns = sheet->cells;
}

static void add_point(const struct eo_sweep *s, int i, struct eo_text_table *sheet)
{
  static const char *const outcomes[] = {"converged", "contact lost", "not converged"};
  const struct eo_sweep_torque *t[2] = {&s->at_torque[0][i / s->speeds], &s->at_torque[1][i / s->speeds]};
  const struct eo_sweep_point *p[2] = {&s->point[0][EO_SWEEP_UP][i], &s->point[1][EO_SWEEP_UP][i]};
  eo_text_table_number(sheet, s->torque[i / s->speeds], &eo_unit_Nm, 6);
  eo_text_table_number(sheet, s->speed[i % s->speeds], &eo_unit_rpm, 6);
  for (int v = 0; v < 2; v++)
    eo_text_table_number(sheet, t[v]->peak_to_peak, &eo_unit_um, DIGITS);
  for (int v = 0; v < 2; v++)
    eo_text_table_number(sheet, worse(s, p[v]->impact), &eo_unit_N, DIGITS + 1);
  for (int v = 0; v < 2; v++)
    eo_text_table_number(sheet, p[v]->rms_pair[EO_READING_NORMAL], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_number(sheet, p[0]->rms_pair[EO_READING_TRANSVERSE], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_number(sheet, p[0]->rms_pair[EO_READING_ROTATIONAL], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_number(sheet, worse(s, p[0]->dynamic_factor), NULL, DIGITS);
  eo_text_table_number(sheet, 100 * worse(s, p[0]->contact_loss), NULL, 3);
  for (int v = 0; v < 2; v++)
    if (s->branches[v])
      eo_text_table_number(sheet, s->point[v][EO_SWEEP_DOWN][i].rms_pair[EO_READING_NORMAL], &eo_unit_m_per_s2, DIGITS);
  eo_text_table_string(sheet, outcomes[p[0]->outcome]);
}

/* Modes of the middle torque and, beside each, the speeds at which mesh orders meet it. */
static void print_modes(const struct eo_sweep *s, struct eo_text *text)
{
  int middle = s->torques / 2;
  const struct eo_dynamics_modes *modes = &s->at_torque[EO_SWEEP_DESIGN][middle].modes;
  eo_text_print(text, "\nEigenfrequencies at %.6g N m and the speeds at which mesh orders meet them\n",
                eo_unit_out(&eo_unit_Nm, s->torque[middle]));
  for (int mode = 0; mode < modes->n; mode++) {
    eo_text_print(text, "  %8.1f Hz", modes->frequency[mode]);
    for (int i = 0; i < s->crossings; i++)
      if (s->crossing[i].torque == middle && s->crossing[i].mode == mode)
        eo_text_print(text, "   %d: %.0f rpm", s->crossing[i].order, eo_unit_out(&eo_unit_rpm, s->crossing[i].speed));
    eo_text_add(text, "\n");
  }
}

void eo_sweep_summary(const struct eo_sweep *s, const struct eo_design *design, const struct eo_warnings *warnings,
                      struct eo_text *text)
{
  struct eo_text_table sheet;
  if (*design->name)
    eo_text_print(text, "%s\n", design->name);
  eo_text_add(text,
              "Peak-to-peak transmission error, entering impact (worse end) and RMS of the normal acceleration, each "
              "beside the unmodified pair;\n"
              "RMS of the transverse and rotational acceleration, dynamic factor and contact loss of the design\n\n");
  add_headings(s, &sheet);
  for (int i = 0; i < s->torques * s->speeds; i++)
    add_point(s, i, &sheet);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  print_modes(s, text);
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_text_print(text, "Note: %s\n", warnings->text[i]);
}
