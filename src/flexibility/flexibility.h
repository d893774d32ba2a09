/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flexibility of a gear pair: 3-D finite elements of both members' bodies, once per pair, kept on disk; then the
   compliance between any points of the flanks and the stress in the roots, from cubic tensor splines (physics: Chang,
   Liu, Wu 2015). The body is the ring of all teeth, exact by its cyclic symmetry (flexibility/ring.h), or a sector of a
   few teeth whose cut faces and inner cylinder are held. A ring floats by default: deflection counts relative to the
   mean rigid motion of the body's sections in their plane, which is what shafts and lumped masses know; sections stay
   plane from 3.5 m_n below the root inwards; the bore is filled by its shaft. C_bulk = C_full - C_half: the dent under
   a point load, which depends on the mesh, goes; the contact adds its own local law. C_half is the material between
   tooth centre and loaded flank outside the root cylinder, both surfaces held (see flexibility/sector.h): of all ways
   to cut the half tooth it is the one that reproduces independently computed levels (tests/cases/contact.json, fe_bulk)
   within 2 %. Both members are computed at the same time by two threads; the result is the same to the last bit for any
   number of threads. A prepared flexibility is constant: any number of threads may evaluate it at once. */
#ifndef EASEOFF_FLEXIBILITY_FLEXIBILITY_H
#define EASEOFF_FLEXIBILITY_FLEXIBILITY_H

#include "base/error.h"
#include "base/hash.h"
#include "base/progress.h"
#include "flexibility/body_model.h"
#include "flexibility/kernel.h"
#include "flexibility/member.h"
#include "gear/geometry.h"

#include <stdbool.h>

/* Most pairs ahead and behind with which a pair is coupled. */
enum { EO_FLEXIBILITY_REACH = 31 };

/* Elements of a mesh that a stated resolution may ask for: below, the shape of a tooth is lost; above, the memory of
   the factor is. */
enum {
  EO_LAYERS_LEAST = 4,
  EO_LAYERS_MOST = 96,
  EO_FLANK_ROWS_LEAST = 4,
  EO_FLANK_ROWS_MOST = 32,
  EO_FILLET_ELEMENTS_LEAST = 6,
  EO_FILLET_ELEMENTS_MOST = 64,
  EO_SECTOR_TEETH_LEAST = 3,
  EO_SECTOR_TEETH_MOST = 5,
};

struct eo_flexibility_settings {
  enum eo_body body;
  enum eo_body_support support; /* of a ring */
  int sector_teeth;             /* of a sector; odd, the loaded one is in the middle */
  bool neighbour_coupling;      /* compliance between tooth pairs; does not change what is computed and kept */
  int layers;                   /* over the face width */
  int flank_rows;               /* over the active profile */
  int fillet_elements;          /* from the start of the active profile to the middle of the tooth space */
  int columns;                  /* across the loaded tooth, even, 4..32 */
  int rim_elements;             /* from the root to the bore, or to 3.5 m_n below it where rings go on, 3..32 */
  int reach; /* pairs ahead and behind that a ring couples, up to EO_FLEXIBILITY_REACH; 0: as many as are
                in contact at once */
};

/* How a member's body is supported. */
enum eo_member_support { EO_MEMBER_SECTOR, EO_MEMBER_FLOATING, EO_MEMBER_HELD, EO_MEMBER_HELD_AT_BORE };

/* What the preparation did. */
struct eo_flexibility_report {
  char key[EO_HASH_LENGTH + 1];      /* of everything the result depends on */
  enum eo_member_support support[2]; /* [member] */
  double radius[2];                  /* [member]: where the mesh ends inwards, m; held there unless floating */
  int reach[2];                      /* [member]: pairs ahead and behind that are coupled */
  bool from_cache;
  char note[200];                  /* why the cache could not be used or kept, "" when all went well */
  double seconds;                  /* wall time of the whole */
  struct eo_member_times times[2]; /* [member], 0 when read from the cache */
  double smallest_eigenvalue[2];   /* [member]: of the compliance of a few teeth side by side, over the largest; 0 from
                                      the cache */
};

struct eo_flexibility;

/* EO_ERROR_INPUT: a sector of other teeth than there may be. A ring states none. */
enum eo_code eo_flexibility_check_sector(const struct eo_flexibility_settings *settings, struct eo_error *error);

/* Prepares or reads from the cache. pair: bores and rim. cache_directory: NULL for none; it is made when missing (its
   parent must exist). Two processes that prepare the same pair at once are safe: the second waits and reads. A cache
   file that does not fit or is damaged is thrown away; a directory that cannot be written only leaves a note. progress
   may be NULL; it is called by one thread at a time. Errors: EO_ERROR_INPUT (settings, sector that does not fit, a root
   so undercut that its mesh folds), memory, EO_ERROR_NUMERIC, EO_ERROR_CANCELLED. */
enum eo_code eo_flexibility_prepare(const struct eo_geometry *geometry, const struct eo_gear_pair *pair,
                                    const struct eo_material *material, const struct eo_flexibility_settings *settings,
                                    const char *cache_directory, const struct eo_progress *progress,
                                    struct eo_flexibility **flexibility, struct eo_error *error);
void eo_flexibility_free(struct eo_flexibility *flexibility);
const struct eo_flexibility_report *eo_flexibility_report(const struct eo_flexibility *flexibility);

/* What the settings come to for a member: without a bore it cannot be held there and floats. */
enum eo_member_support eo_flexibility_support(const struct eo_flexibility_settings *settings,
                                              const struct eo_gear_pair *pair, int member);

/* Where the mesh ends inwards. Sector and held ring: r_f - rim coefficient * m_n, or at the bore if that is larger;
   held at the bore: there; never below r_f / 5. Floating: 0.3 r_f. */
double eo_flexibility_bore_radius(const struct eo_flexibility_settings *settings, const struct eo_geometry *geometry,
                                  const struct eo_gear_pair *pair, int member);

/* The settings of one member's model. */
struct eo_member_settings eo_flexibility_member_settings(const struct eo_flexibility_settings *settings,
                                                         const struct eo_geometry *geometry,
                                                         const struct eo_gear_pair *pair, int member);

/* Compliance for the contact. Without neighbour coupling, and between pairs beyond the reach, 0. Points beyond
   the active flank by up to one row or half a layer are extrapolated straight, beyond that they count as if there. */
struct eo_kernel eo_flexibility_kernel(const struct eo_flexibility *flexibility);

/* Adds one member's share of it to compliance[n][n]. */
void eo_flexibility_add_compliance(const struct eo_flexibility *flexibility, int member, int n,
                                   const struct eo_flank_point *point, double *compliance);

/* part[0], part[1]: what harmonics 0 (torque and thrust) and +-1 (net force, tilting moment) of the ring give to the
   deflection of mid face under a uniform load on the row at s, dent included, m per N/m: what shaft, hub and bearings
   take. 0 of a sector. */
void eo_flexibility_parts(const struct eo_flexibility *flexibility, int member, double s, double part[2]);

/* Wind-up of a hub that takes its torque through a bore of this radius, beyond the floating body: normal deflection per
   load over the face width, m per N/m: r_b^2 cos^2(beta_b)/(4 pi G) (1/r_h^2 - 4/(3 r_f^2)), plane torsion of the disc
   less its mean rotation. 0 without a bore. */
double eo_flexibility_hub_windup(const struct eo_geometry *geometry, const struct eo_material *material, int member,
                                 double bore_radius);

/* Nodes of the root surface, [points][layers + 1]: from the start of the active profile (point 0) to the middle of the
   tooth space. */
struct eo_root {
  int points, layers;
  int first; /* first point at or below the 30 degree tangent, ISO 6336-3's critical section: above it the surface feels
                the dent of a contact close by, which the mesh of the root does not resolve, more than the bending of
                the tooth */
  const double *arc;      /* [points], along the profile from the start of the active profile, m */
  const double *position; /* [points][2], transverse, tooth centre along +y and loaded flank at x > 0, m */
  double width;           /* of the face, m; layer l lies at eta = width (l / layers - 1/2) */
  double twist;           /* section turned counterclockwise by twist * eta, rad/m */
};
struct eo_root eo_flexibility_root(const struct eo_flexibility *flexibility, int member);

/* stress[to - from][layers + 1][EO_STRESSES], Pa: along the profile, across it in the surface, shear; of the root
   points from..to-1 of the tooth of `pair` under the normal forces force[n], N, at the points. Loads on other teeth
   within the reach count when coupling is on. */
void eo_flexibility_root_stress(const struct eo_flexibility *flexibility, int member, int pair, int n,
                                const struct eo_flank_point *point, const double *force, int from, int to,
                                double *stress);

/* The larger principal stress of a plane state. */
double eo_stress_principal(const double stress[EO_STRESSES]);

#endif
