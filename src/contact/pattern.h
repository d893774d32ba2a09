/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a flank shows over one mesh cycle: pressure and unloaded clearance on a regular grid, and how the tooth pairs
   share the load. Every point of the flank is passed by the contact line once per mesh, so the largest value over the
   cycle is the one at its passing. */
#ifndef EASEOFF_CONTACT_PATTERN_H
#define EASEOFF_CONTACT_PATTERN_H

#include "contact/loaded.h"

enum { EO_PATTERN_ROWS = 25, EO_PATTERN_COLUMNS = 33 };

/* How a place of the flank is passed: between which mesh positions, on which of their contact lines. */
struct eo_pattern_place {
  int position[2], line[2]; /* line: -1 where the contact line does not reach the flank */
  double weight[2];
  double radius; /* relative curvature, m */
};

struct eo_contact_pattern {
  double path[EO_PATTERN_ROWS];                                        /* s, from s_A to s_E, m */
  double eta[EO_PATTERN_COLUMNS];                                      /* from one face end to the other, m */
  struct eo_pattern_place place[EO_PATTERN_ROWS * EO_PATTERN_COLUMNS]; /* [rows][columns] */
  double pressure[EO_PATTERN_ROWS * EO_PATTERN_COLUMNS]; /* [rows][columns] Hertz pressure of line contact, Pa */
  double edge[2][EO_PATTERN_COLUMNS]; /* of the gear's and of the pinion's tip edge, the largest over the cycle, Pa */
  double clearance[EO_PATTERN_ROWS *
                   EO_PATTERN_COLUMNS]; /* [rows][columns] gap left when the unloaded teeth touch, normal, m */
};

/* The places alone. */
void eo_contact_pattern_init(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid);

/* pressure and edge under load. A tip edge has no radius of its own: its pressure is that of line contact with the
   flank's curvature, a nominal figure. */
void eo_contact_pattern_load(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid,
                             const struct eo_loaded_end *end);

/* Line load, N/m, behind the pressure at a place of the pattern. */
double eo_contact_pattern_line_load(const struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid,
                                    int place);

/* clearance, from the gap field of the end and its unloaded approach Z0 [positions]. Marking compound of a thickness
   above it is wiped off there. */
void eo_contact_pattern_unload(struct eo_contact_pattern *pattern, const struct eo_gap_field *field,
                               const double *unloaded);

/* share[grid->positions]: part of the end's load that one tooth pair carries, tip edges included. */
void eo_contact_pair_share(const struct eo_contact_grid *grid, const struct eo_loaded_end *end, int pair,
                           double *share);

#endif
