/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/design_document.h"

#include <math.h>
#include <string.h>

#include "format/json.h"
#include "gear/names.h"

/* T = P / omega. */
static void settle_power(struct eo_load_case *load_case, int i, struct eo_faults *faults)
{
  char pointer[64];
  double torque = load_case->power / load_case->speed;
  if (isnan(load_case->power))
    return;
  snprintf(pointer, sizeof pointer, "/load_cases/%d/power_kW", i);
  if (!isnan(load_case->torque) && !(fabs(torque - load_case->torque) <= 1e-6 * fabs(torque)))
    eo_faults_add(faults, pointer,
                  "%.9g kW at %.9g rpm is a torque of %.9g N m, but %.9g N m is stated: leave one of the two out.",
                  load_case->power / 1e3, eo_unit_out(&eo_unit_rpm, load_case->speed), torque, load_case->torque);
  load_case->torque = isnan(load_case->torque) ? torque : load_case->torque;
  load_case->power = NAN;
}

/* A number that may have either sign, and how small or large it may be without it. */
static void check_size(double value, const struct eo_unit *unit, double low, double high, int i, const char *key,
                       struct eo_faults *faults)
{
  char pointer[64];
  if (fabs(value) >= low && fabs(value) <= high)
    return;
  snprintf(pointer, sizeof pointer, "/load_cases/%d/%s", i, key);
  eo_faults_add(faults, pointer, "%.9g is outside %.9g .. %.9g %s and their negatives.", eo_unit_out(unit, value),
                eo_unit_out(unit, low), eo_unit_out(unit, high), unit->symbol);
}

/* Refuses a sign that says another thing than the word beside it. */
static void check_word(const json_t *row, int i, const char *key, const char *word, const char *reading,
                       struct eo_faults *faults)
{
  char pointer[64];
  const char *stated = json_string_value(json_object_get(row, key));
  if (!stated || strcmp(stated, word) == 0)
    return;
  snprintf(pointer, sizeof pointer, "/load_cases/%d/%s", i, key);
  eo_faults_add(faults, pointer, "\"%s\" contradicts the signs, %s: leave the signs or this key out.", stated, reading);
}

/* Signs as a drive's table has them: below 0, a speed says astern, and a torque against the speed that the gear drives.
   row: as the document states it, for the words beside. */
static void settle_signs(const json_t *row, struct eo_load_case *load_case, int i, struct eo_warnings *warnings,
                         struct eo_faults *faults)
{
  bool astern = load_case->speed < 0, braked = load_case->torque * load_case->speed < 0;
  int before = faults->count;
  if (!astern && !braked && load_case->torque > 0)
    return;
  if (astern)
    check_word(row, i, "direction", "astern", "which turn the pinion astern", faults);
  if (braked)
    check_word(row, i, "driver", "gear", "by which the gear drives", faults);
  if (faults->count != before)
    return;
  load_case->direction = astern ? EO_ASTERN : load_case->direction;
  load_case->driver = braked ? EO_GEAR : load_case->driver;
  if (warnings) {
    char key[64];
    snprintf(key, sizeof key, "/load_cases/%d/%s", i, astern ? "speed_rpm" : "torque_Nm");
    eo_warnings_at(warnings, key, "%.9g N m at %.9g rpm is read as: %s, the %s drives.", load_case->torque,
                   eo_unit_out(&eo_unit_rpm, load_case->speed), load_case->direction == EO_ASTERN ? "astern" : "ahead",
                   eo_member_name[load_case->driver]);
  }
  load_case->torque = fabs(load_case->torque);
  load_case->speed = fabs(load_case->speed);
}

/* Shares of load cases that state their hours. */
static void share_hours(struct eo_load_case *load_case, int count, struct eo_faults *faults)
{
  double sum = 0;
  int stated = 0, shares = 0;
  for (int i = 0; i < count; i++) {
    stated += load_case[i].hours > 0 || load_case[i].hours == 0;
    shares += !isnan(load_case[i].share);
    sum += load_case[i].hours > 0 ? load_case[i].hours : 0;
  }
  if (stated == 0)
    return;
  if (stated < count)
    eo_faults_add(faults, "/load_cases", "Either every load case states its hours or none does; %d of %d do.", stated,
                  count);
  else if (sum <= 0)
    eo_faults_add(faults, "/load_cases", "The hours of operating time sum to 0.");
  for (int i = 0; i < count && stated == count && sum > 0; i++) {
    double share = load_case[i].hours / sum;
    if (shares == count && fabs(load_case[i].share - share) > 1e-6) {
      eo_faults_add(faults, "/load_cases",
                    "Load case %d states %.9g hours, %.6g of all, and a share of %.6g: state hours or shares.", i + 1,
                    load_case[i].hours, share, load_case[i].share);
      return;
    }
    load_case[i].share = share;
  }
}

/* Torque, speed and which way round, of one load case. */
static void settle_running(const json_t *row, struct eo_load_case *load_case, int i, struct eo_warnings *warnings,
                           struct eo_faults *faults)
{
  int before = faults->count;
  check_size(load_case->speed, &eo_unit_rpm, eo_unit_in(&eo_unit_rpm, 0.1), eo_unit_in(&eo_unit_rpm, 1e6), i,
             "speed_rpm", faults);
  if (faults->count == before) {
    bool by_power = !isnan(load_case->power) && isnan(load_case->torque);
    settle_power(load_case, i, faults);
    check_size(load_case->torque, &eo_unit_Nm, 1e-3, 1e8, i, by_power ? "power_kW" : "torque_Nm", faults);
  }
  if (faults->count == before)
    settle_signs(row, load_case, i, warnings, faults);
}

void eo_load_cases_settle(const json_t *rows, struct eo_load_case *load_case, int count, struct eo_warnings *warnings,
                          struct eo_faults *faults)
{
  double sum = 0;
  int stated = 0, before = faults->count;
  share_hours(load_case, count, faults);
  if (faults->count != before)
    return;
  for (int i = 0; i < count; i++) {
    settle_running(json_array_get(rows, (size_t)i), &load_case[i], i, warnings, faults);
    stated += !isnan(load_case[i].share);
    sum += isnan(load_case[i].share) ? 0 : load_case[i].share;
  }
  if (stated && stated < count)
    eo_faults_add(faults, "/load_cases",
                  "Either every load case states its share of operating time or none does; %d of %d do.", stated,
                  count);
  else if (stated && sum <= 0)
    eo_faults_add(faults, "/load_cases", "The shares of operating time sum to 0.");
  else if (stated && fabs(sum - 1) > 1e-9)
    eo_warnings_add(
        warnings, "The shares of operating time of the load cases summed to %.9g; they were scaled to sum to 1.", sum);
  if (stated && fabs(sum - 1) <= 1e-9)
    return;
  for (int i = 0; i < count; i++)
    load_case[i].share = stated ? load_case[i].share / sum : 1. / count;
}
