/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Synthetic recordings of every kind, drawn at random with their truth. */
#ifndef EASEOFF_TESTS_DRAWN_RECORDINGS_H
#define EASEOFF_TESTS_DRAWN_RECORDINGS_H

#include <math.h>

#include "base/random.h"
#include "measurement/synthetic.h"

/* What is special about a drawn recording. */
enum drawn_kind {
  DRAWN_STEADY,
  DRAWN_DRIFT,
  DRAWN_SLOW_SWING,
  DRAWN_TURN_SWING, /* once or twice per turn: a coupling */
  DRAWN_RUN_UP,
  DRAWN_TWO_STATES,
  DRAWN_REST,
  DRAWN_TURN_BACK,
  DRAWN_STEPS, /* angles rounded to the steps of an encoder */
  DRAWN_COUNTS,
  DRAWN_INDEX,
  DRAWN_TRACKS,
  DRAWN_PULSES,
  DRAWN_JITTER,
  DRAWN_SKEW,
  DRAWN_WRAPPED,
  DRAWN_OWN_RATE,   /* each encoder with its own clock and rate */
  DRAWN_OWN_START,  /* the gear is sampled between the rows of the pinion */
  DRAWN_INCREMENTS, /* counts since the row before */
  DRAWN_SQUARES,    /* A and B tracks in volts */
  DRAWN_RUN_OUT,    /* of the gears instead of the encoders */
  DRAWN_KINDS
};
static const char *const drawn_names[DRAWN_KINDS] = {
    "steady",    "drift",   "slow swing", "swing per turn", "run-up",     "two states",   "rest",
    "turn back", "steps",   "counts",     "index",          "raw tracks", "pulses",       "jitter",
    "skew",      "wrapped", "own rate",   "own start",      "increments", "square waves", "run-out"};

static double between(struct eo_random random, uint64_t draw, double low, double high)
{
  return low + (high - low) * eo_random_unit(random, draw);
}

/* The paper's pair with a shaft encoder each. */
static struct eo_synthetic drawn_base(struct eo_random r, uint64_t seed)
{
  struct eo_synthetic s = {.teeth = {17, 44},
                           .base_radius = {0.0518616, 0.1342300},
                           .orders = 8,
                           .lines = {18000, 18000},
                           .amplitude = 0.5,
                           .seed = seed + 10};
  for (int h = 0; h < 8; h++)
    s.order[h] = 1e-6 * pow(10, between(r, 10 + (uint64_t)h, -1, 0.5)) / pow(h + 1, 1.5) *
                 cexp(2 * M_PI * I * between(r, 20 + (uint64_t)h, 0, 1));
  s.pinion_share = between(r, 0, 0, 1);
  s.speed = pow(10, between(r, 1, 2.5, 3.5)) * M_PI / 30;
  s.sample_rate = s.speed / (2 * M_PI) * between(r, 2, 340, 480);
  s.turns = between(r, 3, 14, 40);
  s.eccentricity[0] = 1e-6 * between(r, 4, 0, 60);
  s.eccentricity[1] = 1e-6 * between(r, 5, 0, 60);
  s.noise = pow(10, between(r, 6, -8, -6));
  return s;
}

static void draw_speed(struct eo_synthetic *s, enum drawn_kind kind, struct eo_random r)
{
  double low = 1;
  switch (kind) {
  case DRAWN_DRIFT:
    s->drift = between(r, 7, -0.1, 0.1);
    break;
  case DRAWN_SLOW_SWING:
    s->swing = between(r, 8, 0, 0.02);
    s->swing_turns = between(r, 9, 3, 60);
    break;
  case DRAWN_TURN_SWING:
    s->swing = between(r, 8, 0.002, 0.05);
    s->swing_turns = 1.0 / (1 + (int)eo_random_index(r, 9, 2));
    break;
  case DRAWN_RUN_UP:
    s->drift = between(r, 7, 0.5, 1.6) * (eo_random_unit(r, 9) < 0.5 ? -1 : 1);
    low = 1 + fabs(s->drift) / 2;
    break;
  case DRAWN_TWO_STATES:
    s->step = between(r, 7, 0.03, 0.2) * (eo_random_unit(r, 9) < 0.5 ? -1 : 1);
    break;
  case DRAWN_REST:
    s->rest[0] = between(r, 7, 1, 6) * 2 * M_PI / s->speed;
    s->rest[1] = between(r, 8, 0, 4) * 2 * M_PI / s->speed;
    break;
  case DRAWN_TURN_BACK:
    s->turn_back = true;
    break;
  default:
    break;
  }
  s->sample_rate *= low;
}

static void draw_encoder(struct eo_synthetic *s, enum drawn_kind kind, struct eo_random r)
{
  static const int lines[] = {1024, 2048, 5000, 9000, 18000, 36000}, steps[] = {4, 64, 256, 1024, 4096};
  bool increments = kind == DRAWN_INCREMENTS,
       stepped = kind == DRAWN_STEPS || kind == DRAWN_COUNTS || kind == DRAWN_INDEX || increments;
  for (int i = 0; i < 2 && stepped; i++)
    s->lines[i] = lines[eo_random_index(r, 32 + (uint64_t)i, 6)];
  if (stepped)
    s->interpolation = steps[eo_random_index(r, 34, 5)];
  if (kind == DRAWN_COUNTS || kind == DRAWN_INDEX)
    s->output = EO_SYNTHETIC_COUNTS;
  if (increments)
    s->output = EO_SYNTHETIC_INCREMENTS;
  s->index = kind == DRAWN_INDEX;
  if (kind == DRAWN_TRACKS) {
    s->output = EO_SYNTHETIC_SINE_COSINE;
    s->lines[0] = s->lines[1] = 250;
    s->offset = between(r, 35, -0.1, 0.1);
    s->gain = between(r, 36, -0.2, 0.2);
    s->phase = between(r, 37, -0.2, 0.2);
    s->track_noise = between(r, 38, 0, 1e-4);
    s->track_step = 1.0 / 32768;
    s->sample_rate *= 2.6; /* the tracks turn less than half a period from row to row */
  }
  if (kind == DRAWN_PULSES) {
    s->output = EO_SYNTHETIC_PULSES;
    s->lines[0] = 1024;
    s->lines[1] = 2500;
    s->noise = 0;
    s->jitter = 1e-7 / s->speed * between(r, 30, 0, 10);
  }
  if (kind == DRAWN_JITTER)
    s->jitter = 1e-7 / s->speed * between(r, 30, 0, 300);
  if (kind == DRAWN_SKEW)
    s->skew = 1e-7 / s->speed * between(r, 31, 0, 20);
  s->wrapped = kind == DRAWN_WRAPPED;
  s->run_out = kind == DRAWN_RUN_OUT;
  if (kind == DRAWN_SQUARES) { /* a fast converter: some 12000 samples per turn */
    s->output = EO_SYNTHETIC_SQUARE;
    s->lines[0] = 360;
    s->lines[1] = 720;
    s->sample_rate *= 30;
    s->turns = between(r, 3, 9, 14);
  }
}

static void draw_clocks(struct eo_synthetic *s, enum drawn_kind kind, struct eo_random r)
{
  if (kind == DRAWN_OWN_RATE)
    s->gear_rate = s->sample_rate * between(r, 40, 0.8, 1.3);
  if (kind == DRAWN_OWN_RATE || kind == DRAWN_OWN_START)
    s->gear_delay = between(r, 41, 0.05, 0.95) / s->sample_rate;
}

/* The seed-th recording; the kinds take turns. */
__attribute__((unused)) static struct eo_synthetic drawn(uint64_t seed, enum drawn_kind *kind)
{
  struct eo_random r = eo_random_at(2016, 0, 0, seed);
  struct eo_synthetic s = drawn_base(r, seed);
  *kind = (enum drawn_kind)(seed % DRAWN_KINDS);
  draw_speed(&s, *kind, r);
  draw_encoder(&s, *kind, r);
  draw_clocks(&s, *kind, r);
  return s;
}

#endif
