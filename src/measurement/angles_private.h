/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The making of angles from the inside: angles.c reads, corrects and concludes, jumps.c finds what is missing, doubled
   or far off between one sample and the next, resampled.c what another program put between recorded ones. */
#ifndef EASEOFF_MEASUREMENT_ANGLES_PRIVATE_H
#define EASEOFF_MEASUREMENT_ANGLES_PRIVATE_H

#include "measurement/angles.h"
#include "measurement/sampler.h"

enum { EO_MOST_LOSSES = 3, EO_MOST_DISTANCES = 64, EO_AHEAD = 4, EO_HELD = EO_SAMPLER_BLOCK + EO_AHEAD };

/* Usual speeds of the samples that are held, and the size of step that is out of the ordinary. */
struct eo_usual {
  double rate[2], interval;
  double gap;               /* s: rows are missing where more time passes from one to the next */
  double limit[2], fine[2]; /* of what a row lost, of what a few counts lost stand out of */
  bool uneven;              /* the speed changes much among the samples */
};

struct eo_angles_maker {
  const struct eo_recording *recording;
  const struct eo_tracks *tracks;
  struct eo_findings *findings;
  const struct eo_progress *progress;
  const struct eo_times *asked;
  int teeth[2];
  struct eo_scan *scan; /* owned */
  struct eo_sampler sampler;
  struct eo_sample sample[EO_HELD];
  int held;                          /* samples not yet passed on */
  struct eo_sample last;             /* good one before them */
  struct eo_sample recent[EO_AHEAD]; /* the ones before that, the oldest at kept % EO_AHEAD */
  int64_t kept;
  struct eo_sample low, high; /* of all good ones of this run: those with the extreme pinion angles */
  struct eo_sample widest[2]; /* the two of the run that goes the farthest */
  bool begun;
  struct eo_usual usual; /* of the last block that is long enough to tell */
  bool known;
  double delay;                 /* s taken out of or put into time so far */
  double quantum[2];            /* rad */
  double *rate[2], *proportion; /* [blocks] owned: of each block */
  int blocks, block_room;
  double scratch[EO_HELD];
  int losses;
  struct loss {
    int channel;
    int64_t row;
    double jump;
  } loss[EO_MOST_LOSSES];
  int64_t gaps, gap_row, spikes, spike_row;
  int64_t hidden, hidden_row;         /* gaps that the times do not show, and the last of them */
  double distance[EO_MOST_DISTANCES]; /* rows from each to the next */
  bool origin_known;
  struct {
    int blocks, straight; /* of samples: looked at, and with many rows on straight lines */
  } raster[2];            /* [channel] */
  bool wrapped[2];
  int restarts, next_restart;
  int64_t restart[EO_RUNS + 1]; /* rows with which a new run begins, in their order */
  const char *run_why;          /* of the second run */
  int64_t run_row;
  double run_time; /* s after the first row */
  bool more_runs;  /* than EO_RUNS */
};

/* Sets row and line of a finding. */
struct eo_finding *eo_angles_at_row(const struct eo_angles_maker *maker, struct eo_finding *finding, int64_t row);

/* Judges the samples that are held and passes them on as rows; the last EO_AHEAD stay unless `final`. */
enum eo_code eo_jumps_pass_on(struct eo_angles_maker *maker, struct eo_angles *angles, bool final, double (*out)[3],
                              int *written, struct eo_error *error);

/* Findings about gaps, single values and lost counts, at the end. */
void eo_jumps_judge(struct eo_angles_maker *maker, const struct eo_angles *angles);

/* Keeps those rows of a channel that repeat a value for lost ones: the sampler leaves them out, a finding says so. */
void eo_holds_find(struct eo_angles_maker *maker, int channel);
/* They begin with this row. */
bool eo_holds_left_out(const struct eo_angles_maker *maker, int channel, int64_t row);

/* Both channels went on by the same time beyond the usual: excess is that way, rad, with the turns that angles which
   start again leave open, by which the samples from here on are moved. False: they did not. */
bool eo_gaps_settle(struct eo_angles_maker *maker, const struct eo_usual *usual, struct eo_sample *sample, int left,
                    double excess[2]);

/* Time leaps and the angles go on from where they were, as sums of increments do: what lies between is lost. */
bool eo_gaps_stops(const struct eo_angles_maker *maker, const struct eo_usual *usual, const struct eo_sample *sample,
                   int left, const double excess[2]);

/* Time leaps, and each channel goes on from a value of its own, as counters do that were set meanwhile. */
bool eo_gaps_pauses(const struct eo_angles_maker *maker, const struct eo_usual *usual, const struct eo_sample *sample,
                    const double excess[2]);

/* A run begins with this sample, the next row that is written. why: with a small letter, no full stop; not copied. */
void eo_gaps_begin_run(struct eo_angles_maker *maker, struct eo_angles *angles, const struct eo_sample *sample,
                       int written, const char *why);
/* One of the restarts lies at or before this row and behind those asked about before. */
bool eo_gaps_starts_anew(struct eo_angles_maker *maker, int64_t row);
void eo_gaps_widen(struct eo_angles_maker *maker);
void eo_gaps_judge(struct eo_angles_maker *maker, const struct eo_angles *angles);

/* Looks at samples of one block for rows that another program made up between recorded ones; at the end, the finding.
 */
void eo_resampled_note(struct eo_angles_maker *maker, const struct eo_sample *sample, int count);
void eo_resampled_judge(const struct eo_angles_maker *maker);

static inline const char *eo_channel_name(int channel)
{
  return channel ? "gear" : "pinion";
}

#endif
