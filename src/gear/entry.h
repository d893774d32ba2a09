/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From what drawings say to what the program computes with: every way to state one gear ends in the same numbers. */
#ifndef EASEOFF_GEAR_ENTRY_H
#define EASEOFF_GEAR_ENTRY_H

#include "base/error.h"
#include "gear/gear_pair.h"

/* Replaces what pair->entry states by the members of the pair, and NaN where a member follows from others: alpha_n 20
   deg (ISO 53), the face width common to both members, x of the pinion 0, of the gear what shift sum, working pressure
   angle or centre distance ask for, else 0. What is worked out is rounded to 12 digits in the unit of the document; a
   centre distance, tip diameter or face width that is what the others give anyway becomes NaN (derived), so that every
   path to one gear ends in the same bits. Idempotent. EO_ERROR_INPUT with the key: no module, statements that
   contradict each other, no working pressure angle. */
enum eo_code eo_gear_pair_settle(struct eo_gear_pair *pair, struct eo_error *error);

/* Largest rho_fP* that fits into the tip of a rack. */
double eo_gear_rack_largest_fillet(double dedendum_coefficient, double normal_pressure_angle);

/* Recommended least normal backlash (ISO/TR 10064-2:1996): 2/3 (0.06 mm + 0.0005 a + 0.03 m_n), m. */
double eo_gear_pair_backlash(double centre_distance, double normal_module);

/* Tip diameter d_a = d + 2 m_n (x + h_aP* + k) of a settled pair, m; k: see struct eo_gear_pair. centre_distance: a_w.
 */
double eo_gear_pair_tip_diameter(const struct eo_gear_pair *pair, double centre_distance, int member);

#endif
