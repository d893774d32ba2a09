/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dates and times, units, and what a number under a key states, in the spellings that are in use. */
#include "recording/moment.h"
#include "recording/stated.h"
#include "recording/recorded_unit.h"
#include "support/tap.h"

#include <math.h>
#include <string.h>

static void moment(const char *text, int64_t day, double seconds)
{
  struct eo_moment m;
  bool read = eo_moment_read(text, strlen(text), &m);
  ok(read && (day < 0 ? !m.has_day : m.has_day && m.day == day) && fabs(m.seconds - seconds) < 1e-9,
     "%s is read as day %lld, %.9g s", text, read ? (long long)m.day : -99, read ? m.seconds : NAN);
}

static void no_moment(const char *text)
{
  struct eo_moment m;
  ok(!eo_moment_read(text, strlen(text), &m), "%s is no moment", text);
}

static void number(const char *text, double value, const char *unit)
{
  double read = NAN;
  char own[32];
  bool good = eo_stated_read_number(text, &read, own, sizeof own);
  ok(good == isfinite(value) && (!good || (fabs(read - value) < 1e-12 && !strcmp(own, unit))),
     "\"%s\" is judged as a number: %g %s", text, good ? read : NAN, good ? own : "");
}

static void test_numbers(void)
{
  number("4000.000000", 4000, "");
  number(" 4 kHz", 4, "kHz");
  number("0,25 ms", 0.25, "ms");
  number("0,250", 0.25, "");
  number("4 kHz, 16 bit", 4, "kHz");
  number("1024 counts/rev", 1024, "counts/rev");
  number("4,000 Hz", NAN, "");
  number("2024-03-05", NAN, "");
  number("05.03.2024", NAN, "");
  number("08:59:59", NAN, "");
  number("rig 3", NAN, "");
  struct eo_moment m;
  ok(eo_stated_moment("start_time", "2024-03-05 08:59:59.5", &m) && m.has_day && m.seconds == 32399.5,
     "a text under \"start_time\" states when the recording began");
  ok(!eo_stated_moment("created", "2024-03-05 08:59:59.5", &m), "a text under \"created\" does not state it");
  ok(fabs(eo_stated_read("resolution_deg_per_count", 0.25, "").value - 1440) < 1e-9 &&
         fabs(eo_stated_read("resolution", 0.25, "deg/count").value - 1440) < 1e-9,
     "the angle of a count states the counts per turn");
  ok(eo_stated_read("scale", 0.25, "deg/count").kind == EO_STATED_SCALE, "a scale in degrees per count stays one");
  ok(eo_stated_read("decimation_factor", 10, "").kind == EO_STATED_THINNED, "a decimation is stated");
  ok(eo_stated_read("store_every", 4, "").value == 4 && eo_stated_read("averages", 4, "").value == 4 &&
         eo_stated_read_ratio("decimation", "4:1").value == 4 &&
         eo_stated_read_ratio("comment", "one row stored of every 4 samples").value == 4,
     "keys and texts of properties state of how many samples a row is made");
  ok(!eo_stated_read("mean_torque", 4, "").kind && !eo_stated_read("averaging time", 4, "ms").kind &&
         !eo_stated_read_ratio("comment", "run 1 of 4, 16 bit").kind,
     "other means and ratios do not");
}

static void test_moments(void)
{
  const int64_t day = 19787; /* 2024-03-05, by `date -d 2024-03-05 +%s` / 86400 */
  const double time = 32399.5;
  ok(eo_moment_day(1970, 1, 1) == 0 && eo_moment_day(2000, 2, 29) == 11016 && eo_moment_day(2024, 3, 5) == day,
     "days of the calendar are counted from 1970");
  moment("2024-03-05T08:59:59.5Z", day, time);
  moment("2024-03-05 08:59:59,5", day, time);
  moment("2024-03-05T09:59:59.5+01:00", day, time);
  moment("2024/03/05 08:59:59.5", day, time);
  moment("05.03.2024 08:59:59,500000", day, time);
  moment("5.3.24 8:59:59.5", day, time);
  moment("03/05/2024 08:59:59.5 AM", day, time);
  moment("25/03/2024 8:59:59.5", day + 20, time);
  moment("3/5/2024 8:59:59.5 PM", day, time + 43200);
  moment("05-Mar-2024 08:59:59.5", day, time);
  moment("05-MRZ-24", day, 0);
  moment("12:00:00 AM", -1, 0);
  moment("08:59:59:500", -1, time);
  moment("59:59.5", -1, 3599.5);
  moment("0 days 00:00:01.25", -1, 1.25);
  moment("03/05/2024 08:59:59.5 a.m.", day, time);
  moment("Mar 05, 2024 08:59:59.5", day, time);
  moment("20240305T085959.5Z", day, time);
  moment("20240305085959.5", day, time);
  moment("1709629199500000000", day, time);
  moment("133541027995000000", day, time);
  moment("638452259995000000", day, time);
  struct eo_moment m;
  ok(eo_moment_read("2024-03-05T08:59:59.5", 21, &m) && eo_moment_epoch(&m) == 1709629199500000000,
     "a moment is read as an epoch");
  moment("2024-065T08:59:59.5", day, 32399.5);
  moment("2024:065:08:59:59.5", day, 32399.5);
  moment("2024-065 08:59:59.5Z", day, 32399.5);
  moment("PT1.25S", -1, 1.25);
  moment("P1DT2H3M4,5S", -1, 93784.5);
  no_moment("2023-366T00:00:00");
  no_moment("2024-065");
  no_moment("P1M");
  no_moment("PT");
  no_moment("PT5S1M");
  no_moment("12.5");
  no_moment("05.13.2024");
  no_moment("2024-02-30");
  no_moment("13:00:00 PM");
  no_moment("08:61:00");
  no_moment("1-2");
  no_moment("3:4 parts");
  no_moment("20241305085959");
  no_moment("9709629199500000000");
}

static void unit(const char *text, enum eo_quantity quantity, double expected)
{
  double factor;
  enum eo_quantity found = eo_unit_find(text, &factor);
  ok(found == quantity && fabs(factor / expected - 1) < 1e-12, "the unit %s has the quantity %d and the factor %.9g",
     text, (int)found, factor);
}

static void test_units(void)
{
  const double degree = M_PI / 180;
  unit("[U]", EO_QUANTITY_ANGLE, 2 * M_PI);
  unit("Umdr.", EO_QUANTITY_ANGLE, 2 * M_PI);
  unit("cycles", EO_QUANTITY_ANGLE, 2 * M_PI);
  unit("\"", EO_QUANTITY_ANGLE, degree / 3600);
  unit("\xe2\x80\xb3", EO_QUANTITY_ANGLE, degree / 3600);
  unit("'", EO_QUANTITY_ANGLE, degree / 60);
  unit("\xc2\xb5rad", EO_QUANTITY_ANGLE, 1e-6);
  unit("\xce\xbcrad", EO_QUANTITY_ANGLE, 1e-6);
  unit("\xb0", EO_QUANTITY_ANGLE, degree);
  unit("\xc2\xb0"
       "CA",
       EO_QUANTITY_ANGLE, degree);
  unit("degKW", EO_QUANTITY_ANGLE, degree);
  unit("\xc2\xb0"
       "C",
       EO_QUANTITY_OTHER, 1);
  unit("gon", EO_QUANTITY_ANGLE, M_PI / 200);
  unit("kS/s", EO_QUANTITY_FREQUENCY, 1e3);
  unit("U/min", EO_QUANTITY_SPEED, M_PI / 30);
  unit("min\xe2\x81\xbb\xc2\xb9", EO_QUANTITY_SPEED, M_PI / 30);
  unit("N\xc2\xb7m", EO_QUANTITY_TORQUE, 1);
  unit("lbf ft", EO_QUANTITY_TORQUE, 1.3558179483314);
  static const char *const pound_inches[] = {"in-lb", "in-lbs", "lb.in", "lbf-in", "inch-pounds"},
                           *const pound_feet[] = {"ft-lb", "ft lbs", "lb-ft", "ft\xc2\xb7lbf", "foot-pounds"};
  for (int i = 0; i < 5; i++) {
    unit(pound_inches[i], EO_QUANTITY_TORQUE, 0.1129848290276167);
    unit(pound_feet[i], EO_QUANTITY_TORQUE, 1.3558179483314);
  }
  unit("kN-m", EO_QUANTITY_TORQUE, 1e3);
  unit("N mm", EO_QUANTITY_TORQUE, 1e-3);
  unit("kgf\xc2\xb7m", EO_QUANTITY_TORQUE, 9.80665);
  unit("microseconds since 2024-03-05", EO_QUANTITY_TIME, 1e-6);
  unit("krpm", EO_QUANTITY_SPEED, 100 * M_PI / 3);
  unit("nm", EO_QUANTITY_OTHER, 1);
  unit("S", EO_QUANTITY_NONE, 1);
  unit("degr\xc3\xa9s", EO_QUANTITY_ANGLE, degree);
  unit("gradi", EO_QUANTITY_ANGLE, degree);
  unit("vueltas", EO_QUANTITY_ANGLE, 2 * M_PI);
  unit("foo", EO_QUANTITY_NONE, 1);
  char name[32], text[32];
  eo_unit_split("Winkel in Grad", name, sizeof name, text, sizeof text);
  ok(!strcmp(name, "Winkel") && !strcmp(text, "Grad"), "a name is split from its unit at \"in\"");
  eo_unit_split("Pinion (encoder 1)", name, sizeof name, text, sizeof text);
  ok(!strcmp(name, "Pinion (encoder 1)") && !*text, "a name in brackets is no unit");
  eo_unit_split("Pinion [foo]", name, sizeof name, text, sizeof text);
  ok(!strcmp(name, "Pinion") && !strcmp(text, "foo"), "square brackets hold a unit, known or not");
}

static void stated(const char *key, double number, const char *unit, enum eo_stated_kind kind, double value)
{
  struct eo_stated s = eo_stated_read(key, number, unit);
  ok(s.kind == kind && (!kind || fabs(s.value / value - 1) < 1e-12),
     "the statement %s %g %s is of kind %d and says %.9g", key, number, unit, (int)s.kind, s.value);
}

static void test_stated(void)
{
  stated("Sampling rate [kHz]", 4, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Sample Interval", 0.25, "ms", EO_STATED_INTERVAL, 2.5e-4);
  stated("Sampling interval [10 us]", 25, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Messrate [1/min]", 240000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Store rate", 4, "kHz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Drehzahl [1/min]", 600, "", EO_STATED_NOTHING, 1);
  stated("Aggregate sample rate", 8, "kHz", EO_STATED_NOTHING, 1);
  stated("Sampling interval [us]", 250, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Samples/s", 4000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Samples per second", 4000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Scan rate", 4000, "Hz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Delta X", 2.5e-4, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("wf_increment", 2.5e-4, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("dt_ms", 0.25, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Interval", 4, "kHz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Rate pinion", 4000, "Hz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Fr\xc3\xa9quence d'\xc3\xa9"
         "chantillonnage",
         4, "kHz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Fr\xe9quence d'\xe9"
         "chantillonnage",
         4000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("P\xc3\xa9riode d'\xc3\xa9"
         "chantillonnage (ms)",
         0.25, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Cadence d'acquisition", 4000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Pas de temps", 2.5e-4, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Frecuencia de muestreo", 4000, "Hz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Intervalo de muestreo", 0.25, "ms", EO_STATED_INTERVAL, 2.5e-4);
  stated("Frequenza di campionamento", 4000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Passo di campionamento [ms]", 0.25, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Zeitabstand", 250, "\xc2\xb5s", EO_STATED_INTERVAL, 2.5e-4);
  stated("Sample clock rate", 4000, "Hz", EO_STATED_INTERVAL, 2.5e-4);
  stated("", 4, "kS/s", EO_STATED_INTERVAL, 2.5e-4);
  stated("Tinterval", 2.5e-4, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("wf_samples", 4000, "", EO_STATED_NOTHING, 0);
  stated("Number of samples", 4000, "", EO_STATED_NOTHING, 0);
  stated("Anzahl Abtastwerte je Messintervall", 4000, "", EO_STATED_NOTHING, 0);
  stated("Max. sampling rate", 4000, "Hz", EO_STATED_NOTHING, 0);
  stated("Filter frequency of the data", 4000, "Hz", EO_STATED_NOTHING, 0);
  stated("Calibrated data", 1, "", EO_STATED_NOTHING, 0);
  stated("Recording time", 3, "s", EO_STATED_NOTHING, 0);
  stated("Timebase", 80, "MHz", EO_STATED_TICK, 1.25e-8);
  stated("Encoder resolution", 18000, "counts/rev", EO_STATED_TURN, 18000);
  stated("Pinion", 3600, "pulses per revolution", EO_STATED_TURN, 3600);
  stated("scale_factor", 4e-6, "", EO_STATED_SCALE, 4e-6);
  stated("Operators", 4, "", EO_STATED_NOTHING, 0);
  stated("Sampling rate", -4, "Hz", EO_STATED_NOTHING, 0);
  stated("Rate", 240000, "samples/min", EO_STATED_INTERVAL, 2.5e-4);
  stated("Rate", 240000, "values/h", EO_STATED_NOTHING, 0);
  stated("Taktrate", 4, "kHz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Taktrate", 80, "MHz", EO_STATED_TICK, 1.25e-8);
  stated("sampling", 4, "kHz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Abtastung", 0.25, "ms", EO_STATED_INTERVAL, 2.5e-4);
  stated("Echantillonnage [Hz]", 4000, "", EO_STATED_INTERVAL, 2.5e-4);
  stated("Sample", 4000, "", EO_STATED_NOTHING, 0);
  stated("Acquisition", 4, "kHz", EO_STATED_INTERVAL, 2.5e-4);
  stated("Acquisition", 20, "s", EO_STATED_NOTHING, 0); /* how long it took */
  stated("Encoder resolution", 22, "bit", EO_STATED_TURN, 4194304);
  stated("Geberaufl\xc3\xb6sung [Bit]", 20, "", EO_STATED_TURN, 1048576);
  stated("Singleturn resolution", 17, "bits", EO_STATED_TURN, 131072);
  stated("Resolution", 16, "bit", EO_STATED_NOTHING, 0); /* of an analogue input */
  stated("Encoder resolution", 64, "bit", EO_STATED_NOTHING, 0);
  ok(eo_stated_read("Rate gear", 1, "Hz").member == 1 && eo_stated_read("fs_pinion", 1, "Hz").member == 0,
     "a rate says whose it is by its name");
  ok(eo_stated_begin("Start time") && eo_stated_begin("T0") && !eo_stated_begin("Duration"),
     "a start is told from a duration by its name");
}

/* What an encoder's turn has, by the words on either side of the number. */
static void test_turns(void)
{
  stated("Resolution", 23, "bit", EO_STATED_TURN, 0x1p23);
  stated("Aufl\xc3\xb6sung Ritzel", 22, "Bit", EO_STATED_TURN, 0x1p22);
  stated("Resolution", 23, "bit/rev", EO_STATED_TURN, 0x1p23);
  stated("Resolution", 16, "bit per revolution", EO_STATED_TURN, 0x1p16);
  stated("Bits per turn", 23, "", EO_STATED_TURN, 0x1p23);
  stated("", 22, "bit singleturn", EO_STATED_TURN, 0x1p22);
  stated("Encoder resolution", 12, "bit multiturn", EO_STATED_NOTHING, 0);
  stated("Resolution", 24, "bit", EO_STATED_NOTHING, 0); /* of a converter, perhaps */
  stated("Encoder stop bits", 1, "", EO_STATED_NOTHING, 0);
  stated("Encoder resolution", 0.00004, "deg", EO_STATED_TURN, 9e6);
  stated("Resolution [arcsec]", 0.144, "", EO_STATED_TURN, 9e6);
  stated("Encoder scale: 1 count", 0.0001, "deg", EO_STATED_TURN, 3.6e6);
  stated("Resolution", 25000, "counts/deg", EO_STATED_TURN, 9e6);
  stated("Degrees per count", 0.00004, "", EO_STATED_TURN, 9e6);
  stated("Resoluci\xc3\xb3n", 3600000, "cuentas por vuelta", EO_STATED_TURN, 3.6e6);
  stated("Risoluzione encoder", 3600000, "impulsi/giro", EO_STATED_TURN, 3.6e6);
  stated("Impulses per rotation", 9000000, "", EO_STATED_TURN, 9e6);
  stated("Inkremente je Umdrehung (vierfach)", 9000000, "", EO_STATED_TURN, 9e6);
  stated("Z\xc3\xa4hnezahl Geberrad Ritzel", 512, "", EO_STATED_TURN, 512);
  stated("Pinion", 512, "PPR", EO_STATED_TURN, 512);
  stated("Encoder", 9000, "lines", EO_STATED_TURN, 9000);
  stated("Header", 12, "lines", EO_STATED_NOTHING, 0);
  stated("Teeth", 17, "", EO_STATED_NOTHING, 0);
  stated("Interpolation", 4096, "", EO_STATED_FOLD, 4096);
  stated("Interpolation order", 3, "", EO_STATED_NOTHING, 0);
  ok(eo_stated_read("CPR1", 9e6, "").number == 1 && eo_stated_read("CPR0", 9e6, "").kind == EO_STATED_TURN,
     "CPR is read with the number of its channel");
  ok(eo_stated_read("Strichzahl Rad", 9000, "").member == 1, "a wheel that is a unit is read, too");
  ok(eo_stated_read("Line count", 9000, "").lines && !eo_stated_read("CPR", 9000, "").lines,
     "lines may be multiplied, and counts may not");
}

int main(void)
{
  test_turns();
  test_moments();
  test_numbers();
  test_units();
  test_stated();
  return tap_done();
}
