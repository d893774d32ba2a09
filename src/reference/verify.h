/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reference cases: files whose "kind" says which function reads them; each number computed by the code that analyses
   designs, beside the number expected. A check belongs to a value of the file and is named after where it stands. */
#ifndef EASEOFF_REFERENCE_VERIFY_H
#define EASEOFF_REFERENCE_VERIFY_H

#include <stdbool.h>

#include <jansson.h>

#include "base/error.h"
#include "reference/case_file.h"

struct eo_check {
  char *block;                       /* owned: the key of the file it stands under */
  char *label;                       /* owned: the case */
  char *quantity;                    /* owned */
  char *pointer;                     /* owned: JSON pointer of what is expected */
  double value, expected, tolerance; /* in the case file's unit; NaN where the failure is that there is no number */
  bool pass;                         /* |value - expected| <= tolerance */
};

struct eo_verification {
  const char *folder;     /* where the case file is, without the last slash: file names in it are relative to it */
  struct eo_check *check; /* owned */
  int count, capacity;
  json_t *notes; /* owned array of strings: what is not compared, and why a case failed; each once */
  bool failed;   /* an allocation failed */
};

/* A computed number beside an expected one. Its tolerance is the larger of relative |expected| and absolute (0: none);
   an expected 0 without an absolute tolerance is a fault of the file. expected NULL: nothing happens. */
void eo_verify_number(struct eo_verification *verification, struct eo_case *expected, double value, double relative,
                      double absolute);
/* The member of that name, where the case has one. */
void eo_verify_member(struct eo_verification *verification, struct eo_case *object, const char *key, double value,
                      double relative, double absolute);
/* Whole numbers and flags agree exactly or not at all. */
void eo_verify_exact(struct eo_verification *verification, struct eo_case *expected, double value);
/* A list of numbers, which must be as long as it is expected. value: [count], times unit. */
void eo_verify_list(struct eo_verification *verification, struct eo_case *expected, int count, const double *value,
                    double unit, double relative, double absolute);
void eo_verify_size(struct eo_verification *verification, struct eo_case *list, int count);
/* A number that follows from values of the file, with its name. */
void eo_verify_derived(struct eo_verification *verification, struct eo_case *where, const char *quantity, double value,
                       double expected, double tolerance);
/* Passes when it holds. quantity: what is then true. */
void eo_verify_fact(struct eo_verification *verification, struct eo_case *where, const char *quantity, bool holds);
/* "did not converge": fails, and what the case expects counts as read. */
void eo_verify_diverged(struct eo_verification *verification, struct eo_case *where);
/* Told once, however often it is said. */
void eo_verify_note(struct eo_verification *verification, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Numbers for information: they count as read, and a note says that it is not compared, and why. */
void eo_verify_uncompared(struct eo_verification *verification, struct eo_case *value, const char *why);

/* Half a unit in the last decimal that a printed number shows: 2.35 -> 0.005. */
double eo_verify_rounding(double printed);

/* Full path of a file named in the case file; to be freed. NULL without memory. */
char *eo_verify_path(const struct eo_verification *verification, const char *name);

/* Reads a case, computes it, adds its checks. */
typedef enum eo_code eo_verify_function(void *context, struct eo_case *item, struct eo_error *error);

/* Runs every element of a list or member of an object. One that cannot be computed fails alone; one that checks nothing
   or is not fully read is a fault of the file, and nothing is computed after a fault. */
enum eo_code eo_verify_each(struct eo_verification *verification, struct eo_case *items, eo_verify_function *run,
                            void *context, struct eo_error *error);

enum eo_verify_shape {
  EO_BLOCK_INPUT,   /* read by other blocks or beforehand */
  EO_BLOCK_WHOLE,   /* one call */
  EO_BLOCK_EITHER,  /* the same; it may hold nothing but input */
  EO_BLOCK_EACH,    /* a list of cases, or an object of named ones */
  EO_BLOCK_REMARKS, /* texts for people */
};

/* What a kind of file may hold. The table ends with a key of NULL. */
struct eo_verify_block {
  const char *key; /* a final '*' stands for any ending */
  enum eo_verify_shape shape;
  eo_verify_function *run;
};

/* Runs the blocks of a file in its order; refuses what is not in the table before anything is computed, and blocks that
   check nothing. */
enum eo_code eo_verify_blocks(struct eo_verification *verification, struct eo_case *file,
                              const struct eo_verify_block *blocks, void *context, struct eo_error *error);

/* A kind of case file. Adds its checks; faults of the file are collected in it. */
struct eo_verify_kind {
  const char *name;
  enum eo_code (*run)(struct eo_case *file, struct eo_verification *v, struct eo_error *error);
};

/* Runs the file as its kind says. Faults of the file are collected in it; an error is what else went wrong. */
enum eo_code eo_verify_run(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);
void eo_verification_done(struct eo_verification *verification);

/* The lumped model: modes, periodic responses, the single degree of freedom. */
enum eo_code eo_verify_dynamics(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Files of other programs read into designs. */
enum eo_code eo_verify_exchange(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Designs as drawings state them. */
enum eo_code eo_verify_gear(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Recordings of two encoders with known truth. */
enum eo_code eo_verify_encoder(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* The optimizer's random numbers, prediction, history, operators and whole runs. */
enum eo_code eo_verify_optimizer(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Drawing dimensions and rating by ISO 6336. */
enum eo_code eo_verify_rating(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Compliance of whole gear bodies and loaded contact on it. */
enum eo_code eo_verify_ring(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Worked numbers of standards and published reports. */
enum eo_code eo_verify_standards(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

#endif
