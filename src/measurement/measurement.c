/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/measurement.h"

#include <math.h>
#include <string.h>

#include "measurement/leaps.h"
#include "measurement/orientation.h"
#include "measurement/units_probe.h"

/* What is open about both scales. */
static enum eo_track_doubt doubt_of(const struct eo_tracks *tracks)
{
  return tracks->channel[0].doubt == tracks->channel[1].doubt ? tracks->channel[0].doubt : EO_DOUBT_NONE;
}

/* Turns and a stated speed leave no doubt about the unit; the overflow of a counter and its lines per turn do. */
static bool unit_is_open(const struct eo_angles *angles, const struct eo_tracks *tracks, double stated)
{
  enum eo_track_doubt doubt = doubt_of(tracks);
  bool whole = !angles->wrapped[0] && !angles->wrapped[1];
  return isnan(stated) && (whole || doubt == EO_DOUBT_WIDTH || doubt == EO_DOUBT_EDGES) &&
         tracks->channel[0].track == EO_TRACK_ANGLE && tracks->channel[1].track == EO_TRACK_ANGLE;
}

/* Torque and speed beside the encoders; a speed that cannot be forbids the result. */
static enum eo_code judge_load(struct eo_measurement *measurement, const struct eo_recording *recording,
                               const struct eo_tracks *tracks, const struct eo_measurement_settings *settings,
                               struct eo_error *error)
{
  const struct eo_part *part = &measurement->transmission.parts.measured;
  struct eo_load_known known = {.torque = settings->stated_torque > 0 ? settings->stated_torque : NAN,
                                .speed = settings->stated_speed,
                                .measured = measurement->transmission.speed,
                                .expected = {settings->expected_speed[0], settings->expected_speed[1]}};
  for (int i = 0; i < 2; i++)
    known.teeth[i] = settings->transmission.teeth[i];
  EO_TRY(eo_load_read(&measurement->load, recording, tracks, part->from, part->to, error));
  eo_load_judge(&measurement->load, &known, &measurement->findings);
  return EO_OK;
}

static bool is_refused(const struct eo_measurement *measurement)
{
  return eo_findings_worst(&measurement->findings) == EO_SEVERITY_REFUSED;
}

/* From the angles to what is judged; what is refused on the way is not looked at further. */
static enum eo_code measure(struct eo_measurement *measurement, struct eo_angles *angles,
                            const struct eo_recording *recording, const struct eo_tracks *tracks,
                            const struct eo_measurement_settings *settings, const struct eo_progress *progress,
                            struct eo_error *error)
{
  bool enough = angles->series && angles->rows >= 64;
  if (enough) {
    measurement->ratio = angles->ratio;
    eo_orientation_judge(angles, settings->transmission.teeth, settings->stated_speed, &measurement->findings);
  }
  if (!angles->series || is_refused(measurement))
    return EO_OK;
  if (enough && unit_is_open(angles, tracks, settings->stated_speed)) {
    const struct eo_unit_doubt doubt = {doubt_of(tracks),
                                        tracks->channel[angles->from[0]].scale * fabs(angles->factor[0])};
    EO_TRY(eo_units_judge(angles, &settings->transmission, &doubt, &measurement->findings, error));
  }
  if (is_refused(measurement))
    return EO_OK;
  EO_TRY(eo_leaps_cut(angles, &settings->transmission, &measurement->findings, progress, error));
  EO_TRY(eo_transmission_measure(&measurement->transmission, angles, &settings->transmission, &measurement->findings,
                                 progress, error));
  return measurement->transmission.harmonics > 0 ? judge_load(measurement, recording, tracks, settings, error) : EO_OK;
}

enum eo_code eo_measurement_run(struct eo_measurement *measurement, const struct eo_recording *recording,
                                const struct eo_tracks *tracks, const struct eo_measurement_settings *settings,
                                const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_angles angles = {0};
  const struct eo_times asked = {settings->transmission.part.from, settings->transmission.part.to};
  memset(measurement, 0, sizeof *measurement);
  measurement->load.pinion_torque = NAN;
  measurement->rows = eo_recording_rows(recording);
  measurement->ratio = NAN;
  enum eo_code code = eo_angles_make(&angles, recording, tracks, &asked, settings->transmission.teeth,
                                     settings->spool_directory, &measurement->findings, progress, error);
  measurement->interval = angles.interval;
  for (int channel = 0; channel < 2; channel++) {
    measurement->raw[channel] = angles.raw[channel];
    measurement->ellipse[channel] = angles.ellipse[channel];
  }
  if (!code)
    code = measure(measurement, &angles, recording, tracks, settings, progress, error);
  measurement->refused = is_refused(measurement);
  eo_angles_done(&angles);
  return code;
}

void eo_measurement_done(struct eo_measurement *measurement)
{
  eo_transmission_done(&measurement->transmission);
}
