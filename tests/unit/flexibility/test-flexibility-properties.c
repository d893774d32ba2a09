/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What must hold for any prepared flexibility: symmetry, semi-definiteness, the same bytes each time, a cache that is
   believed only when it is whole, and a preparation that can be stopped. A coarse mesh keeps it quick. */
#include "flexibility/flexibility.h"
#include "numerics/sparse.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PAIRS = 4, PER_PAIR = 15, POINTS = PAIRS * PER_PAIR };

static struct eo_geometry geometry;
static struct eo_gear_pair pair;
static struct eo_flexibility_settings coarse = {.body = EO_BODY_SECTOR,
                                                .sector_teeth = 5,
                                                .neighbour_coupling = true,
                                                .layers = 10,
                                                .flank_rows = 6,
                                                .fillet_elements = 10,
                                                .columns = 4,
                                                .rim_elements = 4};

static struct eo_flexibility *prepare(const struct eo_flexibility_settings *settings, const char *directory)
{
  struct eo_material material = paper_steel();
  struct eo_flexibility *flexibility = NULL;
  struct eo_error error = {0};
  if (eo_flexibility_prepare(&geometry, &pair, &material, settings, directory, NULL, &flexibility, &error))
    printf("# %s\n", error.text);
  return flexibility;
}

/* Points of four neighbouring pairs, all over their flanks and a little beyond. */
static void scatter(struct eo_flank_point *point)
{
  double length = geometry.path_end - geometry.path_start;
  for (int i = 0; i < POINTS; i++) {
    double x = fmod(0.618034 * i, 1), y = fmod(0.754878 * i + 0.3, 1);
    double s = geometry.path_start + (1.06 * x - 0.03) * length;
    point[i] = (struct eo_flank_point){.pair = i / PER_PAIR, .s = {s, s}, .eta = (y - 0.5) * geometry.face_width};
  }
}

static void evaluate(const struct eo_flexibility *flexibility, double *matrix)
{
  struct eo_flank_point point[POINTS];
  struct eo_kernel kernel = eo_flexibility_kernel(flexibility);
  scatter(point);
  kernel.evaluate(kernel.context, POINTS, point, matrix);
}

static double extreme_ratio(const double *matrix, int n, int stride)
{
  double *copy = malloc((size_t)(n * n) * sizeof *copy), low = 0, high = 1;
  for (int i = 0; i < n; i++)
    memcpy(copy + i * n, matrix + i * stride, (size_t)n * sizeof *copy);
  eo_symmetric_extremes(n, copy, &low, &high, NULL);
  free(copy);
  return low / high;
}

static void check_matrix(const struct eo_flexibility *flexibility)
{
  static double matrix[POINTS * POINTS];
  evaluate(flexibility, matrix);
  int symmetric = 1, far = 1;
  double neighbour = 0, own = 0;
  for (int i = 0; i < POINTS; i++)
    for (int j = 0; j < POINTS; j++) {
      int distance = abs(i / PER_PAIR - j / PER_PAIR);
      double value = matrix[i * POINTS + j];
      symmetric = symmetric && value == matrix[j * POINTS + i];
      far = far && (distance < 2 || value == 0);
      own += distance == 0 ? value : 0;
      neighbour += distance == 1 ? value : 0;
    }
  ok(symmetric, "the compliance is symmetric to the last bit");
  ok(far, "pairs that are not neighbours do not feel each other");
  own /= PAIRS * PER_PAIR * PER_PAIR;
  neighbour /= 2 * (PAIRS - 1) * PER_PAIR * PER_PAIR;
  ok(neighbour > 0.01 * own && neighbour < 0.5 * own,
     "a neighbour moves less than the loaded tooth, but the same way: %.3g of %.3g um/kN", 1e9 * neighbour, 1e9 * own);
  ok(extreme_ratio(matrix, PER_PAIR, POINTS) > -1e-9,
     "the compliance is semi-definite on one pair: smallest eigenvalue over largest %.2e",
     extreme_ratio(matrix, PER_PAIR, POINTS));
  ok(extreme_ratio(matrix, POINTS, POINTS) > -1e-9, "the compliance is semi-definite over four pairs: %.2e",
     extreme_ratio(matrix, POINTS, POINTS));
  const struct eo_flexibility_report *report = eo_flexibility_report(flexibility);
  ok(report->smallest_eigenvalue[0] > -1e-9 && report->smallest_eigenvalue[1] > -1e-9,
     "the compliance is semi-definite on all nodes of a flank with its neighbours: %.2e, %.2e",
     report->smallest_eigenvalue[0], report->smallest_eigenvalue[1]);
}

/* Compliance at the nodes of a flank is what the finite elements gave; the spline between them is smooth. */
static void check_nodes(const struct eo_flexibility *flexibility)
{
  struct eo_material material = paper_steel();
  struct eo_member_settings settings = eo_flexibility_member_settings(&coarse, &geometry, &pair, EO_GEAR);
  struct eo_member_result result = {0};
  struct eo_member_times times;
  struct eo_error error = {0};
  if (!ok(!eo_member_compute(&result, &geometry, EO_GEAR, &material, &settings, NULL, &times, &error),
          "the gear alone is computed %s", error.text))
    return;
  int across = coarse.layers + 1, n = result.rows * across;
  double worst = 0, reciprocity = 0, largest = 0;
  for (int i = 0; i < n; i += 7)
    for (int j = 0; j < n; j += 5) {
      double compliance[4] = {0}, expected = result.full[i * n + j] - result.half[i * n + j];
      struct eo_flank_point point[2];
      for (int k = 0; k < 2; k++) {
        int node = k ? j : i;
        point[k] =
            (struct eo_flank_point){.s = {result.s[node / across], result.s[node / across]},
                                    .eta = geometry.face_width * ((double)(node % across) / coarse.layers - 0.5)};
      }
      eo_flexibility_add_compliance(flexibility, EO_GEAR, 2, point, compliance);
      worst = fmax(worst, fabs(compliance[1] - expected));
      largest = fmax(largest, fabs(expected));
      reciprocity = fmax(reciprocity, fabs(result.full[i * n + j] - result.full[j * n + i]));
    }
  ok(worst < 1e-10 * largest, "the spline passes through the nodes: %.1e of the largest", worst / largest);
  ok(reciprocity == 0, "the finite-element compliance is reciprocal");
  eo_member_result_done(&result);
}

static void check_coupling(const struct eo_flexibility *flexibility)
{
  static double with[POINTS * POINTS], without[POINTS * POINTS];
  struct eo_flexibility_settings uncoupled = coarse;
  uncoupled.neighbour_coupling = false;
  struct eo_flexibility *other = prepare(&uncoupled, NULL);
  if (!ok(other != NULL, "the pair is prepared without coupling"))
    return;
  evaluate(flexibility, with);
  evaluate(other, without);
  int same = 1, zero = 1;
  for (int i = 0; i < POINTS; i++)
    for (int j = 0; j < POINTS; j++) {
      same = same && (i / PER_PAIR != j / PER_PAIR || with[i * POINTS + j] == without[i * POINTS + j]);
      zero = zero && (i / PER_PAIR == j / PER_PAIR || without[i * POINTS + j] == 0);
    }
  ok(same && zero, "coupling adds blocks between neighbours and changes nothing else, to the last bit on a second run");
  ok(!strcmp(eo_flexibility_report(other)->key, eo_flexibility_report(flexibility)->key),
     "preparations with and without coupling share one cache file");
  eo_flexibility_free(other);
}

static void check_root(const struct eo_flexibility *flexibility)
{
  struct eo_flank_point point[POINTS];
  double force[POINTS], worst = 0, largest = 0;
  struct eo_root root = eo_flexibility_root(flexibility, EO_PINION);
  size_t from = 1, to = (size_t)root.points - 1, length = (to - from) * (size_t)(root.layers + 1) * EO_STRESSES;
  double *stress = malloc(length * sizeof *stress), *influence = malloc(POINTS * length * sizeof *influence), one = 1;
  scatter(point);
  for (int i = 0; i < POINTS; i++)
    force[i] = 10 + i;
  eo_flexibility_root_stress(flexibility, EO_PINION, 1, POINTS, point, force, (int)from, (int)to, stress);
  for (int i = 0; i < POINTS; i++)
    eo_flexibility_root_stress(flexibility, EO_PINION, 1, 1, &point[i], &one, (int)from, (int)to,
                               influence + (size_t)i * length);
  for (size_t k = 0; k < length; k++) {
    double sum = 0;
    for (int i = 0; i < POINTS; i++)
      sum += force[i] * influence[(size_t)i * length + k];
    worst = fmax(worst, fabs(sum - stress[k]));
    largest = fmax(largest, fabs(sum));
  }
  ok(worst < 1e-12 * largest, "root stress is the sum of its influences: %.1e of the largest", worst / largest);
  ok(root.first > 1 && root.first < root.points - 2 && root.arc[root.points - 1] > root.arc[0],
     "the root runs down from the active profile");
  double plane[EO_STRESSES] = {30, -10, 15};
  close_to(eo_stress_principal(plane), 35, 1e-12, "principal stress of (30, -10, 15)");
  free(stress);
  free(influence);
}

/* Same numbers, and whether they were read. */
static void check_same(const struct eo_flexibility *flexibility, const char *directory, int expect_read,
                       const char *what)
{
  static double fresh[POINTS * POINTS], other[POINTS * POINTS];
  struct eo_flexibility *again = prepare(&coarse, directory);
  if (!ok(again != NULL, "%s: the pair is prepared", what))
    return;
  evaluate(flexibility, fresh);
  evaluate(again, other);
  const struct eo_flexibility_report *report = eo_flexibility_report(again);
  ok(report->from_cache == expect_read, "%s: the pair is %s%s%s", what,
     expect_read ? "read from the cache" : "computed again", report->note[0] ? ", note: " : "", report->note);
  ok(!memcmp(fresh, other, sizeof fresh), "%s: the pair has the same bytes", what);
  eo_flexibility_free(again);
}

static void overwrite(const char *path, off_t at, const char *bytes, size_t count)
{
  int file = open(path, O_WRONLY);
  ok(file >= 0 && pwrite(file, bytes, count, at) == (ssize_t)count, "the cache file is damaged at byte %ld", (long)at);
  close(file);
}

static void *prepare_thread(void *directory)
{
  return prepare(&coarse, directory);
}

static void check_cache(const struct eo_flexibility *flexibility)
{
  char parent[] = "/tmp/easeoff-cache-XXXXXX", directory[100], path[300], command[400];
  if (!ok(mkdtemp(parent) != NULL, "a directory for the cache is made"))
    return;
  snprintf(directory, sizeof directory, "%s/new", parent);
  snprintf(path, sizeof path, "%s/%s.flex", directory, eo_flexibility_report(flexibility)->key);
  check_same(flexibility, directory, 0, "empty cache");
  check_same(flexibility, directory, 1, "full cache");
  struct stat state;
  ok(!stat(path, &state), "the file stands under its key");
  overwrite(path, state.st_size / 2, "rubbish!", 8);
  check_same(flexibility, directory, 0, "damaged numbers");
  check_same(flexibility, directory, 1, "made anew");
  overwrite(path, 0, "X", 1);
  check_same(flexibility, directory, 0, "wrong magic");
  overwrite(path, 8, "\x63", 1);
  check_same(flexibility, directory, 0, "wrong format");
  overwrite(path, 40, "0123456789", 10);
  check_same(flexibility, directory, 0, "wrong key");
  ok(!truncate(path, state.st_size - 1), "the file is cut short");
  check_same(flexibility, directory, 0, "cut short");
  ok(!truncate(path, 10), "the file is cut shorter");
  check_same(flexibility, directory, 0, "cut in the header");
  ok(!truncate(path, state.st_size + 3), "the file is made longer");
  check_same(flexibility, directory, 0, "too long");
  ok(!unlink(path), "the file is removed");
  pthread_t thread[2];
  void *result[2];
  for (int i = 0; i < 2; i++)
    pthread_create(&thread[i], NULL, prepare_thread, directory);
  for (int i = 0; i < 2; i++)
    pthread_join(thread[i], &result[i]);
  int both = result[0] && result[1];
  ok(both && eo_flexibility_report(result[0])->from_cache + eo_flexibility_report(result[1])->from_cache == 1,
     "one of two preparations at once computes and the other reads");
  eo_flexibility_free(result[0]);
  eo_flexibility_free(result[1]);
  snprintf(command, sizeof command, "test $(ls '%s' | wc -l) = 1", directory);
  ok(!system(command), "the directory holds nothing but the cache file");
  check_same(flexibility, "/dev/null/nowhere", 0, "a directory that cannot be");
  check_same(flexibility, "/proc/self", 0, "a directory that cannot be written");
  snprintf(command, sizeof command, "rm -r '%s'", parent);
  ok(!system(command), "the directory is removed");
}

static void check_full_disk(const struct eo_flexibility *flexibility)
{
  char directory[] = "/tmp/easeoff-full-XXXXXX", path[300], command[400];
  if (!ok(mkdtemp(directory) != NULL, "another directory is made"))
    return;
  snprintf(path, sizeof path, "%s/%s.part", directory, eo_flexibility_report(flexibility)->key);
  ok(!symlink("/dev/full", path), "whatever is written there meets a full disk");
  check_same(flexibility, directory, 0, "full disk");
  snprintf(command, sizeof command, "test $(ls '%s' | wc -l) = 0 && rmdir '%s'", directory, directory);
  ok(!system(command), "a full disk leaves no file behind");
}

static int stop_at_half(void *context, const char *what, double fraction)
{
  (void)what;
  int *calls = context;
  ++*calls;
  return fraction >= 0.05;
}

static void check_stop(void)
{
  struct eo_material material = paper_steel();
  struct eo_flexibility *flexibility = NULL;
  struct eo_error error = {0};
  int calls = 0;
  struct eo_progress progress = {.report = stop_at_half, .context = &calls};
  enum eo_code code = eo_flexibility_prepare(&geometry, &pair, &material, &coarse, NULL, &progress, &flexibility,
                                             &error);
  ok(code == EO_ERROR_CANCELLED && !flexibility && calls > 0, "the preparation stops when asked: %s", error.text);
}

static void refuse(struct eo_flexibility_settings settings, const struct eo_gear_pair *asked, const char *pointer)
{
  struct eo_material material = paper_steel();
  struct eo_flexibility *flexibility = NULL;
  struct eo_error error = {0};
  enum eo_code code = eo_flexibility_prepare(&geometry, asked, &material, &settings, NULL, NULL, &flexibility, &error);
  ok(code == EO_ERROR_INPUT && !flexibility && !strcmp(error.pointer, pointer), "the input is refused at %s: %s",
     error.pointer, error.text);
}

static void check_refusals(void)
{
  struct eo_flexibility_settings settings = coarse;
  struct eo_gear_pair hollow = pair;
  settings.layers = 2;
  refuse(settings, &pair, "/resolution/layers");
  settings = coarse;
  settings.flank_rows = 1000000;
  refuse(settings, &pair, "/resolution/flank_rows");
  settings = coarse;
  settings.sector_teeth = 4;
  refuse(settings, &pair, "/resolution/sector_teeth");
  settings = coarse;
  settings.columns = 5;
  refuse(settings, &pair, "/resolution/columns");
  hollow.bore[EO_GEAR] = 2 * geometry.root_radius[EO_GEAR];
  refuse(coarse, &hollow, "/gear_pair/gear_bore_mm");
}

/* Deflection of one member at a place of its face under a unit load there, m/N. */
static double own_compliance(const struct eo_flexibility *flexibility, int member, double eta)
{
  const struct eo_flank_point point = {.pair = 0, .s = {0, 0}, .eta = eta};
  double compliance = 0;
  eo_flexibility_add_compliance(flexibility, member, 1, &point, &compliance);
  return compliance;
}

/* A pinion whose own face is wider than the common one: its teeth are supported beyond the face ends of the gear, where
   they become nearly as stiff as in their middle; the gear's stay what they are. */
static void check_wider_member(const struct eo_flexibility *narrow)
{
  struct eo_geometry common = geometry;
  struct eo_gear_pair usual = pair;
  double end = geometry.face_width / 2, before[2], after[2];
  pair.member_width[EO_PINION] = 1.5 * pair.face_width;
  eo_geometry_init(&geometry, &pair, NULL);
  struct eo_flexibility_settings finer = coarse;
  finer.layers = 15; /* layers as thick as those of the common face */
  struct eo_flexibility *wide = prepare(&finer, NULL);
  if (ok(wide != NULL && strcmp(eo_flexibility_report(wide)->key, eo_flexibility_report(narrow)->key) != 0,
         "a wider pinion is another preparation")) {
    for (int m = 0; m < 2; m++) {
      before[m] = own_compliance(narrow, m, end) / own_compliance(narrow, m, 0);
      after[m] = own_compliance(wide, m, end) / own_compliance(wide, m, 0);
    }
    ok(before[EO_PINION] > 3 && after[EO_PINION] < 1.3,
       "the end of the common face is %.3f times as soft as its middle, with teeth beyond it %.3f times",
       before[EO_PINION], after[EO_PINION]);
    near(own_compliance(wide, EO_PINION, 0), own_compliance(narrow, EO_PINION, 0), 0.06,
         "compliance in mid face of a wider pinion, hardly another");
    near(after[EO_GEAR], before[EO_GEAR], 0.05, "compliance of the gear beside a wider pinion, hardly another");
    close_to(eo_flexibility_root(wide, EO_PINION).width, pair.member_width[EO_PINION], 0,
             "width over which the root reaches, m");
  }
  eo_flexibility_free(wide);
  pair = usual;
  geometry = common;
}

int main(void)
{
  struct eo_error error = {0};
  pair = paper_pair();
  ok(!eo_geometry_init(&geometry, &pair, &error), "the paper's pair is accepted");
  struct eo_flexibility *flexibility = prepare(&coarse, NULL);
  if (!ok(flexibility != NULL, "the paper's pair is prepared"))
    return tap_done();
  check_matrix(flexibility);
  check_nodes(flexibility);
  check_coupling(flexibility);
  check_root(flexibility);
  check_cache(flexibility);
  check_full_disk(flexibility);
  check_stop();
  check_refusals();
  check_wider_member(flexibility);
  eo_flexibility_free(flexibility);
  return tap_done();
}
