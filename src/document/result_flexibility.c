/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the teeth's flexibility was modelled: body, support, what of it belongs to shaft and bearings, and the standard's
   level of mesh stiffness beside it. */
#include <math.h>

#include "document/result_private.h"

static const char *const support_text[] = {
    [EO_MEMBER_SECTOR] = "sector",
    [EO_MEMBER_FLOATING] = "floating",
    [EO_MEMBER_HELD] = "held",
    [EO_MEMBER_HELD_AT_BORE] = "held_at_bore",
};

/* One member. */
struct member {
  const char *support;
  double radius, deflection, harmonic[2], windup;
  int reach;
};

#define OF_MEMBER(name) EO_AT(struct member, name)
static const struct eo_outline_row member_rows[] = {
    EO_KEY("support", "text",
           "floating: deflection relative to the mean rigid motion of the body in its plane; held, held_at_bore: its "
           "inner cylinder; sector: inner cylinder and cut faces",
           OF_MEMBER(support)),
    EO_KEY("inner_radius_mm", "number", "where the finite elements end inwards; held there unless floating",
           .unit = &eo_unit_mm, OF_MEMBER(radius)),
    EO_KEY("coupled_pairs", "integer", "tooth pairs ahead and behind with which each is coupled", OF_MEMBER(reach)),
    EO_KEY("deflection_um_mm_per_N", "number?",
           "of mid face at the pitch point under a uniform load there, per load over the face width, without the local "
           "part",
           .unit = &eo_unit_um_mm_per_N, OF_MEMBER(deflection)),
    EO_KEY("harmonic_0_um_mm_per_N", "number?",
           "what the ring's harmonic 0, torque and thrust, gives to the full deflection there; null of a sector",
           .unit = &eo_unit_um_mm_per_N, OF_MEMBER(harmonic[0])),
    EO_KEY("harmonic_1_um_mm_per_N", "number?",
           "the same of harmonics +-1, net force and tilting moment: what shaft, hub and bearings take",
           .unit = &eo_unit_um_mm_per_N, OF_MEMBER(harmonic[1])),
    EO_KEY(
        "hub_windup_um_mm_per_N", "number?",
        "wind-up of a hub that takes the torque through its bore, beyond the floating body, in the normal direction; "
        "in no other number here; null unless hub_windup is on",
        .unit = &eo_unit_um_mm_per_N, OF_MEMBER(windup)),
};
static const struct eo_outline member_outline = EO_OUTLINE("MemberFlexibility", member_rows);

struct iso_levels {
  double corrected, theory;
};

static const struct eo_outline_row iso_rows[] = {
    EO_KEY("C_M_0.8", "number", "with the correction to measured stiffness, C_M = 0.8", .unit = &eo_unit_N_per_mm_um,
           EO_AT(struct iso_levels, corrected)),
    EO_KEY("C_M_1", "number", "without it", .unit = &eo_unit_N_per_mm_um, EO_AT(struct iso_levels, theory)),
};
static const struct eo_outline iso_outline = EO_OUTLINE("IsoMeshStiffness", iso_rows);

struct flexibility {
  const char *body;
  json_t *member[2];
  struct iso_levels iso;
};

static const struct eo_outline_row flexibility_rows[] = {
    EO_KEY("body", "text", "ring: all teeth of a member; sector: a few between held cut faces; given: neither",
           EO_AT(struct flexibility, body)),
    EO_KEY("pinion", "object?", "null of a given compliance", .outline = &member_outline,
           EO_AT(struct flexibility, member[EO_PINION])),
    EO_KEY("gear", "object?", "the same of the gear", .outline = &member_outline,
           EO_AT(struct flexibility, member[EO_GEAR])),
    EO_KEY("iso_c_gamma_N_per_mm_um", "object",
           "mesh stiffness c_gamma_alpha by ISO 6336-1 method B, solid discs, transverse, per face width, to compare "
           "with the mean stiffness of the load cases",
           .outline = &iso_outline, EO_AT(struct flexibility, iso)),
};
const struct eo_outline eo_outline_flexibility = EO_OUTLINE("Flexibility", flexibility_rows);

double eo_result_hub_windup(const struct eo_result_source *source, int member)
{
  const struct eo_flexibility *flexibility = source->pair->flexibility;
  if (!source->design->resolution.hub_windup || !flexibility)
    return NAN;
  if (eo_flexibility_report(flexibility)->support[member] != EO_MEMBER_FLOATING)
    return 0;
  return eo_flexibility_hub_windup(&source->pair->geometry, &source->pair->material, member,
                                   source->design->gear_pair.bore[member] / 2);
}

static json_t *encode_member(const struct eo_result_source *source, int member)
{
  const struct eo_flexibility *flexibility = source->pair->flexibility;
  const struct eo_flexibility_report *report = eo_flexibility_report(flexibility);
  bool ring = report->support[member] != EO_MEMBER_SECTOR;
  double part[2];
  eo_flexibility_parts(flexibility, member, 0, part);
  const struct member view = {
      .support = support_text[report->support[member]],
      .radius = report->radius[member],
      .reach = report->reach[member],
      .deflection = source->pair->pitch_deflection[member],
      .harmonic = {ring ? part[0] : NAN, ring ? part[1] : NAN},
      .windup = eo_result_hub_windup(source, member),
  };
  return eo_outline_encode(&member_outline, &view);
}

static struct iso_levels find_iso(const struct eo_result_source *source)
{
  struct eo_iso_stiffness_input input = eo_pair_iso_stiffness_input(source->pair);
  struct eo_iso_stiffness corrected, theory;
  eo_iso_stiffness(&corrected, &input);
  input.theory_factor = 1;
  eo_iso_stiffness(&theory, &input);
  return (struct iso_levels){corrected.mesh_alpha, theory.mesh_alpha};
}

json_t *eo_result_flexibility(const struct eo_result_source *source)
{
  const struct eo_flexibility *flexibility = source->pair->flexibility;
  bool sector = flexibility && eo_flexibility_report(flexibility)->support[EO_PINION] == EO_MEMBER_SECTOR;
  struct flexibility view = {.body = !flexibility ? "given" : sector ? "sector" : "ring", .iso = find_iso(source)};
  for (int member = 0; member < 2; member++)
    view.member[member] = flexibility ? encode_member(source, member) : json_null();
  return eo_outline_encode(&eo_outline_flexibility, &view);
}
