/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The finite-element model of one member as an input file of Abaqus and CalculiX, to check our solver on its own mesh.
   Lengths in m, forces in N. A sector, or all teeth of a ring; node set FLANK lists the loaded flank,
   rows in ascending s, layers in ascending eta within a row; FIXED is what is held. One step per load
   case; the displacements of FLANK are printed.

   A floating ring is balanced by forces in proportion to mass on the nodes of its cuts, and held at two nodes where it
   then pulls at nothing; AXIAL is what keeps its place along the axis. Its displacements count from the weighted mean
   rigid motion of the cuts, CUTS, which are printed too: tooth by tooth clockwise, from the root inwards, layer by
   layer. */
#ifndef EASEOFF_FLEXIBILITY_EXPORT_H
#define EASEOFF_FLEXIBILITY_EXPORT_H

#include "flexibility/member.h"

enum eo_mesh_element {
  EO_MESH_C3D8I,  /* eight nodes, incompatible modes: the element of this program */
  EO_MESH_C3D20R, /* twenty nodes, reduced integration, on the same bricks */
};

struct eo_mesh_load {
  int row, layer;
  double force; /* along the inward normal of the flank, N */
};

struct eo_mesh_case {
  int loads;
  const struct eo_mesh_load *load; /* [loads], borrowed */
};

/* Takes text as it comes; returns non-zero to stop. */
typedef int eo_writer_function(void *context, const char *text, size_t length);

/* Errors: as eo_section_init() and eo_sector_init(); EO_ERROR_FILE when the writer stops. */
enum eo_code eo_mesh_export(const struct eo_geometry *geometry, int member, const struct eo_material *material,
                            const struct eo_member_settings *settings, enum eo_mesh_element element, int cases,
                            const struct eo_mesh_case *load_case, eo_writer_function *writer, void *context,
                            struct eo_error *error);

#endif
