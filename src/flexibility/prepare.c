/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/cache.h"

#include "base/clock.h"
#include "flexibility/flexibility.h"
#include "flexibility/flexibility_private.h"

#include <config.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gear/names.h"

/* Raise whenever the same input may give other numbers. */
#define TABLE_FORMAT "2"

/* What the two threads share: the caller's progress is called by one at a time, and the first error stops both. */
struct shared {
  pthread_mutex_t mutex;
  const struct eo_progress *progress;
  double fraction[2];
  bool stop;
};

struct worker {
  struct shared *shared;
  struct eo_flexibility *flexibility;
  const struct eo_geometry *geometry;
  struct eo_material material; /* of the member */
  struct eo_member_settings settings;
  int member;
  enum eo_code code;
  struct eo_error error;
};

enum eo_member_support eo_flexibility_support(const struct eo_flexibility_settings *settings,
                                              const struct eo_gear_pair *pair, int member)
{
  if (settings->body == EO_BODY_SECTOR)
    return EO_MEMBER_SECTOR;
  if (settings->support == EO_SUPPORT_HELD)
    return EO_MEMBER_HELD;
  return settings->support == EO_SUPPORT_HELD_AT_BORE && pair->bore[member] > 0 ? EO_MEMBER_HELD_AT_BORE
                                                                                : EO_MEMBER_FLOATING;
}

double eo_flexibility_bore_radius(const struct eo_flexibility_settings *settings, const struct eo_geometry *geometry,
                                  const struct eo_gear_pair *pair, int member)
{
  /* Going on from 0.3 to 0.15 of the root radius makes a floating pair 0.1 to 0.7 % softer. */
  static const double FLOATING = 0.3, DEEPEST = 0.2;
  enum eo_member_support support = eo_flexibility_support(settings, pair, member);
  double root = geometry->root_radius[member], rim = root - pair->rim_thickness_coefficient * geometry->normal_module;
  if (support == EO_MEMBER_FLOATING)
    return FLOATING * root;
  double bore = 0.5 * pair->bore[member], held = support == EO_MEMBER_HELD_AT_BORE ? bore : fmax(rim, bore);
  return fmax(held, DEEPEST * root);
}

/* D: as many pairs as are in contact at once, plus one for the tip edges; a tooth of the ring is not coupled with
   itself. */
static int reach_of(const struct eo_flexibility_settings *settings, const struct eo_geometry *geometry, int member)
{
  double pairs = settings->reach ? settings->reach : ceil(geometry->transverse_contact_ratio + geometry->overlap_ratio);
  return (int)fmin(fmin(pairs, EO_FLEXIBILITY_REACH), geometry->teeth[member] - 1);
}

struct eo_member_settings eo_flexibility_member_settings(const struct eo_flexibility_settings *settings,
                                                         const struct eo_geometry *geometry,
                                                         const struct eo_gear_pair *pair, int member)
{
  /* Depth of the lines that follow the root, and below which a floating body's sections stay plane: a hold along the
     axis at 2.5 m_n makes helical pairs 4 % stiffer, at 5 m_n 8 % softer, and a small core needs what lies inside. */
  static const double FOOT_MODULES = 3.5, FOOT_SHARE = 0.45;
  int half_rows = settings->flank_rows / 2 > 3 ? settings->flank_rows / 2 : 3;
  int columns = settings->columns, free_side = settings->fillet_elements / 2 < 8 ? settings->fillet_elements / 2 : 8;
  enum eo_member_support support = eo_flexibility_support(settings, pair, member);
  bool ring = support != EO_MEMBER_SECTOR;
  double root = geometry->root_radius[member];
  return (struct eo_member_settings){
      .section = {.teeth = ring ? 1 : settings->sector_teeth,
                  .loaded = {columns, settings->flank_rows, {free_side, settings->fillet_elements}},
                  .next = {columns > 6 ? 6 : 4, half_rows, {6, 6}},
                  .outer = {4, 3, {4, 4}},
                  .rim = settings->rim_elements,
                  .foot_radius = ring ? root - fmin(FOOT_MODULES * geometry->normal_module, FOOT_SHARE * root) : 0,
                  .open = ring,
                  .floating = support == EO_MEMBER_FLOATING},
      .layers = settings->layers,
      .reach = ring ? reach_of(settings, geometry, member) : 1,
      .bore_radius = eo_flexibility_bore_radius(settings, geometry, pair, member)};
}

enum eo_code eo_flexibility_check_sector(const struct eo_flexibility_settings *settings, struct eo_error *error)
{
  int teeth = settings->sector_teeth;
  bool fits = teeth >= EO_SECTOR_TEETH_LEAST && teeth <= EO_SECTOR_TEETH_MOST && teeth % 2;
  return settings->body != EO_BODY_SECTOR || fits
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "/resolution/sector_teeth",
                            "The sector has its loaded tooth in the middle: %d or %d teeth, not %d.",
                            EO_SECTOR_TEETH_LEAST, EO_SECTOR_TEETH_MOST, teeth);
}

static enum eo_code check(const struct eo_flexibility_settings *settings, struct eo_error *error)
{
  const struct {
    int value, low, high;
    const char *key;
  } range[] = {{settings->layers, EO_LAYERS_LEAST, EO_LAYERS_MOST, "layers"},
               {settings->flank_rows, EO_FLANK_ROWS_LEAST, EO_FLANK_ROWS_MOST, "flank_rows"},
               {settings->fillet_elements, EO_FILLET_ELEMENTS_LEAST, EO_FILLET_ELEMENTS_MOST, "fillet_elements"},
               {settings->columns, 4, 32, "columns"},
               {settings->rim_elements, 3, 32, "rim_elements"}};
  for (size_t i = 0; i < sizeof range / sizeof *range; i++) {
    char pointer[64];
    snprintf(pointer, sizeof pointer, "/resolution/%s", range[i].key);
    if (range[i].value < range[i].low || range[i].value > range[i].high)
      return eo_error_set(error, EO_ERROR_INPUT, pointer, "%s is %d, but must be between %d and %d.", range[i].key,
                          range[i].value, range[i].low, range[i].high);
  }
  EO_TRY(eo_flexibility_check_sector(settings, error));
  if (settings->columns % 2)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/columns", "columns is %d, but must be even.",
                        settings->columns);
  return EO_OK;
}

/* What of one member the key names: its size, and how much of it is modelled. */
static void add_member(struct eo_hash *hash, const struct eo_geometry *geometry, int m, const struct worker *worker)
{
  eo_hash_add_number(hash, "teeth", geometry->teeth[m]);
  eo_hash_add_number(hash, "profile_shift", geometry->profile_shift[m]);
  eo_hash_add_number(hash, "reference_radius", geometry->reference_radius[m]);
  eo_hash_add_number(hash, "base_radius", geometry->base_radius[m]);
  eo_hash_add_number(hash, "start_radius", geometry->start_radius[m]);
  eo_hash_add_number(hash, "form_radius", geometry->form_radius[m]);
  eo_hash_add_number(hash, "root_radius", geometry->root_radius[m]);
  eo_hash_add_number(hash, "tip_radius", geometry->tip_radius[m]);
  eo_hash_add_number(hash, "tangent_length", geometry->tangent_length[m]);
  eo_hash_add_number(hash, "section_teeth", worker->settings.section.teeth);
  eo_hash_add_number(hash, "open", worker->settings.section.open);
  eo_hash_add_number(hash, "floating", worker->settings.section.floating);
  eo_hash_add_number(hash, "foot", worker->settings.section.foot_radius);
  eo_hash_add_number(hash, "reach", worker->settings.reach);
  eo_hash_add_number(hash, "bore", worker->settings.bore_radius);
}

/* Everything the numbers depend on. */
static void make_key(const struct eo_geometry *geometry, const struct eo_material *material,
                     const struct eo_flexibility_settings *flexibility_settings, const struct worker worker[2],
                     char key[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  eo_hash_add_text(&hash, "format", TABLE_FORMAT);
  eo_hash_add_text(&hash, "program", PACKAGE_VERSION);
  const struct {
    const char *name;
    double value;
  } number[] = {{"layers", flexibility_settings->layers},
                {"flank_rows", flexibility_settings->flank_rows},
                {"fillet_elements", flexibility_settings->fillet_elements},
                {"columns", flexibility_settings->columns},
                {"rim_elements", flexibility_settings->rim_elements},
                {"youngs_modulus", material->youngs_modulus},
                {"poissons_ratio", material->poissons_ratio},
                {"normal_module", geometry->normal_module},
                {"normal_pressure_angle", geometry->normal_pressure_angle},
                {"transverse_pressure_angle", geometry->transverse_pressure_angle},
                {"working_pressure_angle", geometry->working_pressure_angle},
                {"helix_angle", geometry->helix_angle},
                {"face_width", geometry->face_width},
                {"centre_distance", geometry->centre_distance},
                {"path_start", geometry->path_start},
                {"path_end", geometry->path_end},
                {"dedendum", geometry->dedendum[EO_PINION]},
                {"fillet_radius", geometry->fillet_radius[EO_PINION]}};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++)
    eo_hash_add_number(&hash, number[i].name, number[i].value);
  if (!eo_material_is_one(material)) {
    eo_hash_add_number(&hash, "gear_youngs_modulus", worker[EO_GEAR].material.youngs_modulus);
    eo_hash_add_number(&hash, "gear_poissons_ratio", worker[EO_GEAR].material.poissons_ratio);
  }
  if (geometry->dedendum[EO_GEAR] != geometry->dedendum[EO_PINION] ||
      geometry->fillet_radius[EO_GEAR] != geometry->fillet_radius[EO_PINION]) {
    eo_hash_add_number(&hash, "gear_dedendum", geometry->dedendum[EO_GEAR]);
    eo_hash_add_number(&hash, "gear_fillet_radius", geometry->fillet_radius[EO_GEAR]);
  }
  for (int m = 0; m < 2; m++)
    if (geometry->generating_shift[m] != geometry->profile_shift[m] || geometry->residual_undercut[m] > 0) {
      eo_hash_add_number(&hash, m ? "gear_generating_shift" : "pinion_generating_shift", geometry->generating_shift[m]);
      eo_hash_add_number(&hash, m ? "gear_residual_undercut" : "pinion_residual_undercut",
                         geometry->residual_undercut[m]);
    }
  for (int m = 0; m < 2; m++)
    if (geometry->member_width[m] != geometry->face_width)
      eo_hash_add_number(&hash, m ? "gear_face_width" : "pinion_face_width", geometry->member_width[m]);
  for (int m = 0; m < 2; m++)
    add_member(&hash, geometry, m, &worker[m]);
  eo_hash_finish(&hash, key);
}

/* One member's progress, as half of the whole. */
static int forward_progress(void *context, const char *what, double fraction)
{
  struct worker *worker = context;
  struct shared *shared = worker->shared;
  pthread_mutex_lock(&shared->mutex);
  shared->fraction[worker->member] = fraction;
  if (!shared->stop && eo_progress_report(shared->progress, what, 0.5 * (shared->fraction[0] + shared->fraction[1])))
    shared->stop = true;
  int stop = shared->stop;
  pthread_mutex_unlock(&shared->mutex);
  return stop;
}

/* The mesh of a tooth whose foot undercut has cut away folds; a shop would not make it either. */
static enum eo_code refuse_undercut(struct worker *worker)
{
  const struct eo_geometry *geometry = worker->geometry;
  int m = worker->member;
  return eo_error_set(
      &worker->error, EO_ERROR_INPUT,
      m == EO_PINION ? "/gear_pair/pinion_profile_shift" : "/gear_pair/gear_profile_shift",
      "The %s is undercut so far that finite elements of its tooth root fold: its profile shift is %.4g, and from %.4g "
      "on there is no undercut. A shift nearer to that, more teeth, or a shallower dedendum helps.",
      eo_member_name[m], geometry->profile_shift[m], geometry->least_shift[m]);
}

static void *compute_member(void *context)
{
  struct worker *worker = context;
  struct eo_member_result result = {0};
  struct eo_flexibility_report *report = &worker->flexibility->report;
  struct eo_progress progress = {.report = forward_progress, .context = worker};
  worker->code = eo_member_compute(&result, worker->geometry, worker->member, &worker->material, &worker->settings,
                                   &progress, &report->times[worker->member], &worker->error);
  if (worker->code == EO_ERROR_NUMERIC && worker->geometry->undercut[worker->member])
    worker->code = refuse_undercut(worker);
  if (!worker->code)
    worker->code = eo_flank_table_fill(&worker->flexibility->table[worker->member], &result,
                                       worker->flexibility->width[worker->member],
                                       &report->smallest_eigenvalue[worker->member], &worker->error);
  eo_member_result_done(&result);
  if (worker->code) {
    pthread_mutex_lock(&worker->shared->mutex);
    worker->shared->stop = true;
    pthread_mutex_unlock(&worker->shared->mutex);
  }
  return NULL;
}

/* The pinion in a thread of its own, the gear in this one. Rings of many teeth have deep bodies, whose factors are
   large: one after the other, so that a preparation stays below 1.5 GB. */
static enum eo_code compute(struct worker worker[2], struct eo_error *error)
{
  static const int MANY_TEETH = 150;
  const int *teeth = worker[0].geometry->teeth;
  bool together = !worker[0].settings.section.open || teeth[0] + teeth[1] <= MANY_TEETH;
  pthread_t thread;
  bool apart = together && !pthread_create(&thread, NULL, compute_member, &worker[0]);
  if (!apart)
    compute_member(&worker[0]);
  compute_member(&worker[1]);
  if (apart)
    pthread_join(thread, NULL);
  /* A worker that was only stopped by the other's error does not hide that error. */
  int first = worker[0].code && worker[0].code != EO_ERROR_CANCELLED ? 0 : worker[1].code ? 1 : 0;
  if (worker[first].code && error)
    *error = worker[first].error;
  return worker[first].code;
}

static enum eo_code fill(struct eo_flexibility *flexibility, struct worker worker[2], const char *cache_directory,
                         const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_cache cache;
  struct eo_cache_part part[2] = {{flexibility->table[0].data, flexibility->table[0].size},
                                  {flexibility->table[1].data, flexibility->table[1].size}};
  enum eo_code code = eo_cache_open(&cache, cache_directory, flexibility->report.key, progress, error);
  if (code)
    return code;
  flexibility->report.from_cache = eo_cache_read(&cache, part, 2);
  if (!flexibility->report.from_cache) {
    code = compute(worker, error);
    if (!code)
      eo_cache_write(&cache, part, 2);
  }
  for (int m = 0; m < 2 && !code && flexibility->report.from_cache; m++)
    code = eo_flank_table_connect(&flexibility->table[m], flexibility->width[m], error);
  if (!flexibility->report.from_cache)
    memcpy(flexibility->report.note, cache.note, sizeof flexibility->report.note);
  eo_cache_close(&cache);
  return code;
}

enum eo_code eo_flexibility_prepare(const struct eo_geometry *geometry, const struct eo_gear_pair *pair,
                                    const struct eo_material *material, const struct eo_flexibility_settings *settings,
                                    const char *cache_directory, const struct eo_progress *progress,
                                    struct eo_flexibility **flexibility, struct eo_error *error)
{
  double start = (1e-3 * eo_clock_milliseconds());
  enum eo_code code = check(settings, error);
  if (code)
    return code;
  struct eo_flexibility *this_flexibility = calloc(1, sizeof *this_flexibility);
  if (!this_flexibility)
    return eo_error_memory(error);
  struct shared shared = {.mutex = PTHREAD_MUTEX_INITIALIZER, .progress = progress};
  struct worker worker[2];
  this_flexibility->settings = *settings;
  for (int m = 0; m < 2; m++) {
    this_flexibility->width[m] = geometry->member_width[m];
    this_flexibility->twist[m] = eo_sector_twist(geometry, m);
    worker[m] = (struct worker){.shared = &shared,
                                .flexibility = this_flexibility,
                                .geometry = geometry,
                                .material = eo_material_of(material, m),
                                .member = m,
                                .settings = eo_flexibility_member_settings(settings, geometry, pair, m)};
    this_flexibility->report.support[m] = eo_flexibility_support(settings, pair, m);
    this_flexibility->report.radius[m] = worker[m].settings.bore_radius;
    this_flexibility->report.reach[m] = settings->neighbour_coupling ? worker[m].settings.reach : 0;
    if (!code)
      code = eo_flank_table_init(&this_flexibility->table[m], &worker[m].settings, error);
  }
  make_key(geometry, material, settings, worker, this_flexibility->report.key);
  if (!code)
    code = fill(this_flexibility, worker, cache_directory, progress, error);
  pthread_mutex_destroy(&shared.mutex);
  if (code) {
    eo_flexibility_free(this_flexibility);
    return code;
  }
  this_flexibility->report.seconds = (1e-3 * eo_clock_milliseconds()) - start;
  *flexibility = this_flexibility;
  return EO_OK;
}
