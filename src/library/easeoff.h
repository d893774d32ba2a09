/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Easeoff as a library: a gear pair in, its transmission error, impact and vibration out.

     struct easeoff *gear;
     struct easeoff_error error;
     if (easeoff_new(&gear, design, NULL, &error))
       ... error.text says what is wrong, error.pointer at which key
     for (int k = 0; k < easeoff_cases(gear); k++)
       ... easeoff_case(gear, k).peak_to_peak ...
     easeoff_free(gear);

   A design is the JSON document that the program and its API know (easeoff example, doc/guide.md); what it does not
   state is derived. Numbers out are SI: m, N, Pa, rad/s. A handle serves one thread at a time; different handles are
   independent. Nothing is printed, no environment is read. Where there is no memory for a Fourier transform, GSL ends
   the process unless the program called its gsl_set_error_handler_off(). */
#ifndef EASEOFF_H
#define EASEOFF_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum easeoff_status {
  EASEOFF_OK = 0,
  EASEOFF_INPUT,   /* the design is wrong: the pointer names the key */
  EASEOFF_MEMORY,  /* an allocation failed */
  EASEOFF_NUMERIC, /* a solver failed where the model says it cannot */
  EASEOFF_OTHER    /* a file of the cache, or what else */
};

struct easeoff_error {
  enum easeoff_status status;
  char pointer[160]; /* JSON pointer of the key at fault, "" when none */
  char text[400];    /* one sentence */
};

/* One load case of the last analysis. Pointers belong to the handle and hold until its next analysis. */
struct easeoff_case {
  double torque;                    /* on the pinion shaft, all ends together, N m */
  double speed;                     /* of the pinion, rad/s */
  double mean;                      /* of the loaded transmission error, transverse, m */
  double peak_to_peak;              /* of the same, m */
  const double *transmission_error; /* [positions] over one mesh cycle, m */
  int positions;
  double impact;           /* entering impact, general, worse end, N */
  double vibration;        /* RMS of the normal acceleration, mean of the ends, m/s2 */
  double contact_pressure; /* largest, Hertz, Pa */
  double root_stress;      /* largest, Pa */
  int converged;           /* 0: contact or vibration did not converge, and the numbers mean nothing */
};

struct easeoff; /* a prepared gear pair and its last analysis */

/* Reads the design, prepares its gear pair (some ten seconds of processor time) and analyses it. cache: an existing
   folder where prepared pairs are kept for the next time; NULL: nowhere. *gear is NULL on failure. error may be NULL.
 */
enum easeoff_status easeoff_new(struct easeoff **gear, const char *design, const char *cache,
                                struct easeoff_error *error);
void easeoff_free(struct easeoff *gear); /* NULL is fine */

/* Analyses another design, some tens of milliseconds when its gear pair, material and mesh are the same; else the new
   pair is prepared, with the cache of easeoff_new(). On failure the last analysis stays. */
enum easeoff_status easeoff_analyze(struct easeoff *gear, const char *design, struct easeoff_error *error);

int easeoff_cases(const struct easeoff *gear);
struct easeoff_case easeoff_case(const struct easeoff *gear, int number); /* 0 .. easeoff_cases() - 1 */

/* The three objectives in one number, 1 for the unmodified pair; NaN when a load case did not converge. */
double easeoff_objective(const struct easeoff *gear);

/* Everything that was computed: the document of easeoff analyze --json, compact. New text for free(); NULL without
   memory. */
char *easeoff_result(const struct easeoff *gear);

/* "0.2.0" */
const char *easeoff_version(void);

#ifdef __cplusplus
}
#endif

#endif
