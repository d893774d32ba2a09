/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables of the gears as made. */
#include "document/design_document.h"

#include "evaluation/design_scatter.h"
#include "rating/flank_tolerance.h"

static const char *const presets[] = {"as_stated", "iso_class", "ground", "as_measured", NULL};
static const char *const editions[] = {"1995", "1995_exact", "2013", NULL};
static const char *const samplings[] = {"sobol", "latin", "random", NULL};
static const char *const methods[] = {"auto", "full", "coarse_first", NULL};
static const char *const kinds[] = {"normal", "uniform", "values", "fixed_sum", "half_normal", NULL};

static const struct eo_field row[] = {
    {.key = "key",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_scatter_row, key),
     .low = 1,
     .count = EO_SCATTER_KEY,
     .help = "what scatters: keys of this document with points between, modification.pinion.left.profile_slope_um; "
             "load_cases.1.torque_Nm, alignment.centre_distance_deviation_um; * for every name, "
             "modification.*.*.helix_slope_um; compliance_factor, "
             "speed_factor; with single_teeth pitch.pinion.eccentricity_um"},
    EO_CHOICE(struct eo_scatter_row, kind, "distribution", kinds, EO_SCATTER_NORMAL,
              "of the deviation from the nominal value; fixed_sum: normal, and what a group is off in all is "
              "nothing; half_normal: the size of a normal one, of what has no sign, an eccentricity"),
    EO_NUMBER(struct eo_scatter_row, bias, "bias", NULL, -1e6, 1e6, 0, "mean deviation, in the unit of the key"),
    EO_NUMBER(struct eo_scatter_row, sigma, "sigma", NULL, 0, 1e6, 0,
              "standard deviation before the cut, in the unit of the key"),
    EO_NUMBER_DERIVED(struct eo_scatter_row, cut, "cut_sigma", NULL, 0.1, 10, "no cut",
                      "deviations farther from the bias do not occur, in sigma (normal, half_normal)"),
    EO_NUMBER(struct eo_scatter_row, low, "low", NULL, -1e6, 1e6, 0, "least deviation (uniform)"),
    EO_NUMBER(struct eo_scatter_row, high, "high", NULL, -1e6, 1e6, 0, "largest deviation (uniform)"),
    EO_TEXT(struct eo_scatter_row, values, "values",
            "deviations as they were measured, numbers with spaces, commas or semicolons between (values)"),
    EO_TEXT(struct eo_scatter_row, group, "group",
            "values: rows of one group are drawn together, pair by pair; fixed_sum: whose sum stays"),
};
static const struct eo_table row_table = EO_TABLE("an input that scatters", struct eo_scatter_row, row);

static const struct eo_field limit[] = {
    {.key = "output",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_tolerance_limit, output),
     .low = 1,
     .count = EO_SCATTER_KEY,
     .help = "a number of the load cases: peak_to_peak_um, rms_m_per_s2, max_pressure_MPa ..."},
    EO_INTEGER_DERIVED(struct eo_tolerance_limit, load_case, "load_case", 1, EO_MAX_LOAD_CASES, "every one",
                       "which load case, from 1"),
    EO_NUMBER_REQUIRED(struct eo_tolerance_limit, most, "at_most", NULL, -1e9, 1e9, "in the unit of the output"),
};
static const struct eo_table limit_table = EO_TABLE("a limit", struct eo_tolerance_limit, limit);

static const struct eo_field tolerance[] = {
    EO_CHOICE(
        struct eo_tolerance_settings, preset, "preset", presets, EO_SCATTER_AS_STATED,
        "inputs in addition to those stated: iso_class: slopes, form as crownings and shaft angles by ISO 1328-1, the "
        "tolerance is 2 sigma, cut at 2.5; ground: the tolerance is 3 sigma, reliefs and crownings within 2 um; "
        "as_stated, as_measured: none"),
    EO_CHOICE(struct eo_tolerance_settings, edition, "edition", editions, EO_ISO1328_2013, "of ISO 1328-1"),
    EO_INTEGER(struct eo_tolerance_settings, grade, "class", 0, 12, 5,
               "tolerance class of 2013, or grade of 1995, of the preset and of single teeth"),
    EO_INTEGER(struct eo_tolerance_settings, pairs, "pairs", 1, EO_SCATTER_MOST_PAIRS, 1000, "how many are drawn"),
    EO_CHOICE(struct eo_tolerance_settings, sampling, "sampling", samplings, EO_SAMPLING_SOBOL,
              "scrambled Sobol points, a Latin hypercube, or independent draws"),
    EO_CHOICE(
        struct eo_tolerance_settings, method, "method", methods, EO_SCATTER_AUTO,
        "full: every pair as an analysis computes it; coarse_first: every pair on a coarse grid, and in full those "
        "that show what this leaves open and those by which the 95 % percentiles are decided; auto: coarse_first "
        "from 500 pairs on, on 48 mesh positions or more, or from 64 pairs with single teeth on, unless the pinion is "
        "held along its axis with these; without root stress, with halves that are alike"),
    {.key = "seed",
     .kind = EO_FIELD_SEED,
     .offset = offsetof(struct eo_tolerance_settings, seed),
     .low = 0,
     .high = 9007199254740991.,
     .fallback = 1,
     .help = "equal seeds give equal pairs"},
    EO_FLAG(struct eo_tolerance_settings, vibration, "vibration", 1, "with the vibration of every pair"),
    EO_FLAG(struct eo_tolerance_settings, root_stress, "root_stress", 0, "with its root stress, which takes longest"),
    EO_FLAG(
        struct eo_tolerance_settings, centre_distance, "centre_distance", 0,
        "the centre distance scatters within gear_pair.centre_distance_allowance_um (js7 of ISO 286 unless stated): "
        "normal, the allowance is 2 sigma (ground: 3), cut there; as alignment.centre_distance_deviation_um, which "
        "inputs may state otherwise"),
    EO_FLAG(struct eo_tolerance_settings, single_teeth, "single_teeth", 0,
            "with teeth of its own for every pair: index deviations drawn within the member's tolerance_class of the "
            "block pitch, or the class here; their share of it is half normal, the class 2 sigma (ground: 3) and cut "
            "there. Gives what the hunting period has, period_peak_to_peak_um and others; a pair in full takes some "
            "hundred times as long"),
    EO_LIST(struct eo_tolerance_settings, row, rows, "inputs", &row_table, 0, EO_MAX_SCATTER_ROWS,
            "what scatters and how; a key that the preset has too is taken from here"),
    EO_LIST(struct eo_tolerance_settings, limit, limits, "limits", &limit_table, 0, EO_MAX_TOLERANCE_LIMITS,
            "what a good pair meets"),
};
const struct eo_table eo_tolerance_table = EO_TABLE("tolerance", struct eo_tolerance_settings, tolerance);
