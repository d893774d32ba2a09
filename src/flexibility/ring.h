/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A whole gear body from one tooth's sector: z equal teeth between cut faces, each seen in a frame of its own that is
   turned by the pitch angle alpha = 2 pi / z from tooth to tooth (clockwise, as teeth are counted here). One set of
   matrices then serves all teeth, the ring's matrix is block circulant, and every harmonic k = 0 .. z/2 of the tooth
   number, e = exp(i k alpha), is a system of one face (Thomas 1979):
       S_k = S_LL + S_RR + e S_LR + conj(e) S_RL,  F_k = F_L + conj(e) F_R,  u_L,k = -S_k^-1 F_k p
       u_L(t) = (1/z) sum_k w_k Re[e^(i k alpha t) u_L,k],  w_k = 1 for k = 0 and k = z/2, else 2
       u_o(t) = [t = 0] G p - F' [u_L(t); u_L(t + 1)].
   A floating body has rigid motions: in harmonic 0 a rotation, in harmonic 1 two translations. The load is balanced
   there by forces in proportion to mass, and displacements count from the weighted mean of the rigid motion:
       a = (N* w N)^-1 N_o* p,  (S_k + s n n*) u = -F_k p - w N a,  u -= N (N* w N)^-1 N* w u.  */
#ifndef EASEOFF_FLEXIBILITY_RING_H
#define EASEOFF_FLEXIBILITY_RING_H

#include "base/error.h"
#include "base/progress.h"

#include <complex.h>
#include <stdbool.h>

enum { EO_RING_RIGID = 2 }; /* harmonics 0 and 1 */

/* One tooth, condensed (numerics/sparse.h). Unknowns of the right face stand in the next tooth's frame. */
struct eo_ring_tooth {
  int teeth;          /* z */
  int inner;          /* unknowns of the tooth whose displacement is wanted */
  int flank;          /* the last of them, which carry loads */
  int face;           /* unknowns of a cut face */
  double *compliance; /* G, [flank][inner], m/N; owned, as all */
  double *influence;  /* F, [inner][2][face]: left, right face */
  double *stiffness;  /* S, [2 face][2 face], N/m */
  bool floating;
  double *weight;                             /* [face]: share of the volume, m3 */
  double complex *rigid[EO_RING_RIGID];       /* [face]: N of harmonic 0 and 1 on the left face */
  double complex *rigid_flank[EO_RING_RIGID]; /* [flank]: N_o, the same motion on the loaded unknowns */
};

/* Room for a tooth with so many unknowns, unset; teeth: of the ring. Errors: memory. */
enum eo_code eo_ring_tooth_init(struct eo_ring_tooth *tooth, int teeth, int inner, int flank, int face, bool floating,
                                struct eo_error *error);
void eo_ring_tooth_done(struct eo_ring_tooth *tooth);

/* Writes the right face's unknowns in the next tooth's frame. direction[face]: 0, 1, 2 = along x, y, the axis; an x is
   followed by the y of the same node. */
void eo_ring_tooth_turn(struct eo_ring_tooth *tooth, const int *direction);

/* What eo_ring_solve() finds. */
struct eo_ring_motion {
  int reach; /* D: teeth -D .. D are wanted */
  double
      *left; /* [2 D + 2][flank][face]: left face of tooth -D .. D + 1 under unit loads on the flank of tooth 0, m/N */
  double *part[EO_RING_RIGID]; /* [flank][flank]: what harmonics 0 and +-1 give to the tooth's own compliance, m/N */
};

/* How a ring is solved: by all harmonics, or by chains of teeth (flexibility/chain.h), whose cost hardly grows with the
   number of teeth; they need more teeth than are coupled. */
enum eo_ring_method { EO_RING_CHEAPEST, EO_RING_HARMONICS, EO_RING_CHAINS };

/* The cheaper of both. operations: NULL, or what it takes, floating-point operations. */
enum eo_ring_method eo_ring_cheapest(const struct eo_ring_tooth *tooth, int reach, double *operations);

/* Room for what the loads of a tooth do to teeth up to reach away. Errors: memory. */
enum eo_code eo_ring_motion_init(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth, int reach,
                                 struct eo_error *error);
void eo_ring_motion_done(struct eo_ring_motion *motion);

/* The harmonics are shared among threads (>= 1) and summed in their order: the same bytes for any number of threads.
   Chains are followed by one thread. Memory: by harmonics 16 face (face + flank) bytes per thread, by chains some
   120 + 16 reach times face^2 bytes. progress goes from first to last. Errors: memory,
   EO_ERROR_NUMERIC, EO_ERROR_CANCELLED. */
enum eo_code eo_ring_solve(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth, int threads,
                           enum eo_ring_method method, const struct eo_progress *progress, const char *what,
                           double first, double last, struct eo_error *error);

/* displacement[flank][inner]: of tooth t, -reach .. reach, under unit loads on the flank of tooth 0, m/N. */
enum eo_code eo_ring_displacement(const struct eo_ring_tooth *tooth, const struct eo_ring_motion *motion, int t,
                                  double *displacement, struct eo_error *error);

#endif
