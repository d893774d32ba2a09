/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gear train of a REXS model: which gears mesh, on which shafts and where, which meshes are the two ends of one
   double helical pair, and how speed and torque run through. Axes: x runs along the u axis of the first shaft of a mesh
   and from the origin of the model. */
#ifndef EASEOFF_EXCHANGE_REXS_TRAIN_H
#define EASEOFF_EXCHANGE_REXS_TRAIN_H

#include "base/error.h"
#include "exchange/rexs_model.h"

enum { EO_REXS_MESHES = 256, EO_REXS_SHAFTS = 512, EO_REXS_LOADS = 1024 };

/* One gear where it meshes. Lengths in mm, angles in degrees, as in the file; NaN: not stated. */
struct eo_rexs_wheel {
  const struct eo_rexs_component *gear, *flank[2], *data; /* [left, right], seen along the gear's own u axis */
  int shaft;                                              /* index in the train; -1: none */
  double along;                                           /* +1, -1: the gear's own u axis against x */
  double left, right;                                     /* face interval along x */
  double teeth, module, helix, pressure_angle, shift, face_width;
};

struct eo_rexs_mesh {
  const struct eo_rexs_component *stage;
  struct eo_rexs_wheel wheel[2]; /* gear_1, gear_2; of the right end of a pair in the order of its left end */
  double centre_distance;        /* NaN: neither stated nor to be had from positions */
  bool from_positions, crossed;
};

struct eo_rexs_pair {
  int ends, mesh[2];  /* [left, right], + x to the right */
  int driver;         /* of the wheels */
  bool driver_stated; /* by is_driving_gear of exactly one, or by the way the torque takes */
  char why[160];      /* not importable because; "": it is */
  char remark[160];
};

struct eo_rexs_train {
  const struct eo_rexs_model *model;
  int shafts, meshes, pairs, couplings, loads;
  const struct eo_rexs_component *shaft[EO_REXS_SHAFTS];
  struct eo_rexs_mesh mesh[EO_REXS_MESHES];
  struct eo_rexs_pair pair[EO_REXS_MESHES];
  int coupling[EO_REXS_SHAFTS][2]; /* indices of shafts that turn together */
  struct eo_rexs_load {
    int shaft;
    const struct eo_rexs_component *component;
  } load[EO_REXS_LOADS]; /* external loads */
};

/* What runs through the shafts in one load case, about the u axis of each. NaN: not known. */
struct eo_rexs_flow {
  double speed[EO_REXS_SHAFTS];  /* 1/min */
  double torque[EO_REXS_SHAFTS]; /* N m, that drives what follows */
  int reached[EO_REXS_SHAFTS];   /* order in which the torque arrives, from 1; 0: not */
  char why[160];                 /* there is no torque because; "" */
};

/* false: there is more than there is room for; *error says so. */
bool eo_rexs_train_find(struct eo_rexs_train *train, const struct eo_rexs_model *model, struct eo_error *error);

/* load_case: index, or -1 for what the components state themselves. */
void eo_rexs_flow_find(const struct eo_rexs_train *train, int load_case, struct eo_rexs_flow *flow);

/* An attribute in a load case: what varies there, else what the component states. */
const struct eo_rexs_attribute *eo_rexs_vary(const struct eo_rexs_model *model, int load_case,
                                             const struct eo_rexs_component *component, const char *attribute);
/* The number of an attribute; NaN: absent or no number. */
double eo_rexs_value(const struct eo_rexs_component *component, const char *attribute);
bool eo_rexs_flag(const struct eo_rexs_component *component, const char *attribute);

/* The next of the components that relations of this type tie to `component` standing in `role`: what stands in
   `other`. NULL after the last. *at: 0 before the first. */
const struct eo_rexs_component *eo_rexs_related(const struct eo_rexs_model *model, const char *type, const char *role,
                                                const struct eo_rexs_component *component, const char *other, int *at);

/* Direction of a component's u axis (default +u of the model), and its origin. */
void eo_rexs_axis(const struct eo_rexs_component *component, double axis[3], double origin[3]);

#endif
