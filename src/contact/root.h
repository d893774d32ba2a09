/* Root bending stress of one tooth through its mesh, from the contact loads and the stress influence of the finite-element model. */
#ifndef EASEOFF_CONTACT_ROOT_H
#define EASEOFF_CONTACT_ROOT_H

#include "contact/loaded.h"
#include "flexibility/flexibility.h"

struct eo_root_history {
  int phases;          /* 0: not computed */
  double *phase;       /* [phases]: c of the tooth's pair over base pitches, ascending */
  double *stress;      /* [phases]: largest principal stress of the loaded root over face and fillet, from the 30 degree tangent inwards, Pa */
  double maximum;      /* of the history, Pa */
  double arc, eta;     /* where it is: along the root from the start of the active profile, from mid face, m */
};

/* Room for the mesh of a tooth over every position of the grid. */
enum eo_code eo_root_history_init(struct eo_root_history *history, const struct eo_contact_grid *grid, struct eo_error *error);
void eo_root_history_done(struct eo_root_history *history);

/* step: every step-th position of the grid counts (the stress is a smooth function of the phase). */
void eo_root_history_compute(struct eo_root_history *history, const struct eo_flexibility *flexibility, int member,
                             const struct eo_contact_grid *grid, const struct eo_loaded_end *end, int step);

#endif
