/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fit of the orders over the rows of a part, shared by the files that make it: rows and terms (transmission.c), the
   axis (transmission_axis.c), what is read from the coefficients (transmission_lines.c), whether the rows are those
   that were recorded (transmission_images.c). */
#ifndef EASEOFF_MEASUREMENT_TRANSMISSION_PRIVATE_H
#define EASEOFF_MEASUREMENT_TRANSMISSION_PRIVATE_H

#include "measurement/axis.h"
#include "measurement/beside.h"
#include "measurement/images.h"
#include "measurement/synchronous.h"
#include "measurement/terms.h"
#include "measurement/transmission.h"
#include "measurement/waterfall.h"

enum { EO_ORDER_FIT_BLOCK = 4096 }; /* rows read at once */

struct eo_order_fit {
  const struct eo_angles *angles;
  const struct eo_transmission_settings *settings;
  struct eo_findings *findings;
  const struct eo_progress *progress;
  struct eo_transmission *result;
  int64_t first, last; /* rows that are measured, both inside */
  double origin;       /* s, time of the first row of the recording */
  double start, end;   /* s, of the rows that count */
  struct eo_axis axis;
  struct eo_axis_noise noise;
  double share_sigma[2];   /* [member]: of the swing that is taken out of the axis */
  double swing_sums[2][2]; /* [member]: products of the residual with what the swing does, and squares of that */
  struct eo_terms terms;
  struct eo_normal normal;
  double coefficient[EO_MOST_TERMS];
  double mean_speed; /* of all rows of the part, rad/s */
  double from, to;   /* pinion angle of the rows that count, rad */
  double turns;      /* between them */
  int possible;      /* mesh orders that the rows carry */
  double rows[EO_ORDER_FIT_BLOCK][3];
  struct eo_synchronous *synchronous;
  struct eo_waterfall *waterfall;
  struct eo_images *images; /* where they are looked for */
  struct eo_beside beside;
};

typedef enum eo_code eo_order_fit_row(struct eo_order_fit *fit, const double row[3], int64_t index,
                                      struct eo_error *error);

/* Calls function with each row of the part (time, both angles). Errors: of reading, of function, cancelled. */
enum eo_code eo_order_fit_each_row(struct eo_order_fit *fit, eo_order_fit_row *function, const char *what,
                                   struct eo_error *error);

/* Least squares of all terms on the rows that count, over the axis as it is. */
enum eo_code eo_order_fit_solve(struct eo_order_fit *fit, struct eo_error *error);

/* Transmission error of a row, m. */
double eo_order_fit_error(const struct eo_order_fit *fit, const double row[3]);

/* Amplitude of the order number `at` of the terms, m. */
double complex eo_order_fit_amplitude(const struct eo_order_fit *fit, int at);

/* Of a row that is fitted: angle of the axis, rad, the parts of its transmission error (drift, mesh orders, shaft
   orders) and what they leave, m; false: it is not fitted. */
bool eo_order_fit_residual(const struct eo_order_fit *fit, const double row[3], double *theta, double part[3],
                           double *residual);

/* What the encoder of the pinion, and what moves the pinion, do to the axis is told from the first fit and taken out;
   then it is fitted again. */
enum eo_code eo_order_fit_settle_axis(struct eo_order_fit *fit, struct eo_error *error);

/* Fills what the coefficients and the residual say of the orders. */
void eo_order_fit_read_lines(struct eo_order_fit *fit);

/* Looks for rows that a program brought to other times, with the usual orders where fewer are asked for; the finding.
   Errors: memory, of reading, cancelled. */
enum eo_code eo_order_fit_judge_images(struct eo_order_fit *fit, struct eo_error *error);

#endif
