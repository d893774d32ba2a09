/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/preparation_cost.h"

#include "flexibility/ring.h"

#include <math.h>

/* Measured with CHOLMOD on the meshes of the examples from 8,700 to 81,000 unknowns. The kept unknowns are one dense
   block; what nested dissection adds for a body grows as n^(4/3) (George, SIAM J. Numer. Anal. 10, 1973). */
static const double FILL_SECTOR = 16.5, FILL_RING = 23; /* entries of the factor per n^(4/3) */
static const double PEAK = 1.27;                        /* what CHOLMOD holds at most, in terms of the factor */
static const double FACTOR_SECONDS = 7e-12;             /* per entries^(3/2) */
static const double OPERATIONS = 3e10;                  /* a second, of the ring's dense products */
static const double ALONE = 60e6;                       /* bytes of the program before it begins */
static const int MANY_TEETH = 150;                      /* one member after the other: prepare.c */

/* Numbers of unknowns of one member. */
struct size {
  double unknowns, inner, flank, face, kept;
};

static int count_held(unsigned char bits)
{
  return (bits & EO_HELD_X ? 1 : 0) + (bits & EO_HELD_Y ? 1 : 0) + (bits & EO_HELD_AXIAL ? 1 : 0);
}

static struct size measure(const struct eo_section *section, int layers)
{
  double across = layers + 1, free_directions = 0;
  for (int i = 0; i < section->nodes; i++)
    free_directions += 3 - count_held(section->fixed[i]);
  struct size size = {.unknowns = across * free_directions,
                      .flank = across * section->flank.count,
                      .face = across * 3 * section->cut_nodes};
  size.inner = across * 3 * section->root_nodes + size.flank +
               across * (section->next_flank[0].count + section->next_flank[1].count);
  size.kept = size.inner + 2 * size.face;
  return size;
}

/* Bytes of what is kept of a member: compliance, coupling and stress (struct eo_member_result). */
static double find_result(const struct size *size, const struct eo_section *section, int layers, int reach)
{
  double stresses = (section->root_nodes - 2.0) * (layers + 1) * EO_STRESSES, flank = size->flank;
  return sizeof(double) * (2 * flank * flank + 2 * reach * flank * flank + flank * stresses + reach * flank * stresses);
}

static void add_ring(const struct size *size, int teeth, int reach, double *memory, double *seconds)
{
  const struct eo_ring_tooth tooth = {
      .teeth = teeth, .inner = (int)size->inner, .flank = (int)size->flank, .face = (int)size->face};
  double operations, face = size->face;
  eo_ring_cheapest(&tooth, reach, &operations);
  *seconds += operations / OPERATIONS;
  *memory = fmax(*memory,
                 sizeof(double) * (2 * size->inner * face + 8 * face * face + (2 * reach + 4) * size->flank * face));
}

static enum eo_code add_member(const struct eo_member_settings *settings, const struct eo_geometry *geometry,
                               int member, double memory[2], double *seconds, struct eo_error *error)
{
  struct eo_section section;
  enum eo_code code = eo_section_init(&section, geometry, member, settings->bore_radius, &settings->section, error);
  if (code)
    return code;
  struct size size = measure(&section, settings->layers);
  double entries = size.kept * size.kept +
                   (settings->section.open ? FILL_RING : FILL_SECTOR) * pow(size.unknowns, 4.0 / 3);
  memory[member] = sizeof(double) * PEAK * entries;
  *seconds += FACTOR_SECONDS * pow(entries, 1.5);
  if (settings->section.open)
    add_ring(&size, geometry->teeth[member], settings->reach, &memory[member], seconds);
  memory[member] += find_result(&size, &section, settings->layers, settings->reach);
  eo_section_done(&section);
  return EO_OK;
}

static enum eo_code add_half(const struct eo_geometry *geometry, const struct eo_gear_pair *pair,
                             const struct eo_flexibility_settings *settings, struct eo_preparation_cost *cost,
                             struct eo_error *error)
{
  double memory[2];
  for (int member = 0; member < 2; member++) {
    struct eo_member_settings own = eo_flexibility_member_settings(settings, geometry, pair, member);
    enum eo_code code = add_member(&own, geometry, member, memory, &cost->seconds, error);
    if (code)
      return code;
  }
  bool together = settings->body == EO_BODY_SECTOR || geometry->teeth[0] + geometry->teeth[1] <= MANY_TEETH;
  cost->memory = fmax(cost->memory, ALONE + (together ? memory[0] + memory[1] : fmax(memory[0], memory[1])));
  return EO_OK;
}

enum eo_code eo_preparation_cost_find(const struct eo_geometry *geometry, const struct eo_gear_pair *pair,
                                      const struct eo_flexibility_settings *settings, struct eo_preparation_cost *cost,
                                      struct eo_error *error)
{
  int halves = eo_gear_pair_is_uneven(pair) ? 2 : 1;
  *cost = (struct eo_preparation_cost){0};
  for (int end = 0; end < halves; end++) {
    const struct eo_geometry half = eo_geometry_of_half(geometry, pair, end);
    const struct eo_gear_pair own = eo_gear_pair_half(pair, end);
    EO_TRY(add_half(&half, &own, settings, cost, error));
  }
  return EO_OK;
}
