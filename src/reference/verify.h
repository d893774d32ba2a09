/* Reference cases: files whose "kind" says which function reads them; each number computed by the code that analyses
   designs, beside the number expected. */
#ifndef EASEOFF_REFERENCE_VERIFY_H
#define EASEOFF_REFERENCE_VERIFY_H

#include <stdbool.h>

#include <jansson.h>

#include "base/error.h"
#include "format/text.h"

struct eo_check {
  char *label;                       /* owned: the case */
  char *quantity;                    /* owned */
  double value, expected, tolerance; /* in the case file's unit; passes when equal or |value - expected| <= tolerance */
  bool pass;
};

struct eo_verification {
  const char *folder;     /* where the case file is, without the last slash: file names in it are relative to it */
  struct eo_check *check; /* owned */
  int count, capacity;
  json_t *ignored; /* owned array of strings: keys that nobody read, and why */
  bool failed;     /* an allocation failed */
};

/* One computed number. */
void eo_verify_add(struct eo_verification *verification, const char *label, const char *quantity, double value,
                   double expected, double tolerance);

/* The computation itself failed where a number was expected: a check that does not pass, and the reason. */
void eo_verify_broken(struct eo_verification *verification, const char *label, const struct eo_error *error);

void eo_verify_ignore(struct eo_verification *verification, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Notes every key of the object that is not in the list (ends with NULL). where: for people. */
void eo_verify_unknown(struct eo_verification *verification, const char *where, const json_t *object,
                       const char *const *known);

/* Numbers of a case object: NaN when the key is absent or no number; element index of an array key. */
double eo_verify_number(const json_t *object, const char *key);
double eo_verify_number_or(const json_t *object, const char *key, double missing);
double eo_verify_element(const json_t *object, const char *key, int index);
double eo_verify_at(const json_t *array, size_t index);

/* Half a unit in the last decimal that a printed number shows: 2.35 -> 0.005. */
double eo_verify_rounding(double printed);

/* Full path of a file named in the case file; to be freed. NULL without memory. */
char *eo_verify_path(const struct eo_verification *verification, const char *name);

/* A kind of case file. Adds its checks; an error is what makes the file unreadable as this kind. */
struct eo_verify_kind {
  const char *name;
  enum eo_code (*run)(const json_t *cases, struct eo_verification *verification, struct eo_error *error);
};

/* NULL after the last. */
const struct eo_verify_kind *eo_verify_kind_at(int index);

/* The lumped model: modes, periodic responses, the single degree of freedom. */
enum eo_code eo_verify_dynamics(const json_t *cases, struct eo_verification *verification, struct eo_error *error);

/* Recordings of two encoders with known truth. */
enum eo_code eo_verify_encoder(const json_t *cases, struct eo_verification *verification, struct eo_error *error);

/* The optimizer's random numbers, prediction, history, operators and whole runs. */
enum eo_code eo_verify_optimizer(const json_t *cases, struct eo_verification *verification, struct eo_error *error);

/* Worked numbers of standards and published reports. */
enum eo_code eo_verify_standards(const json_t *cases, struct eo_verification *verification, struct eo_error *error);

#endif
