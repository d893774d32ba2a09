/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ring of all teeth by harmonics against the same ring assembled tooth by tooth and solved at once; a chain of such
   teeth against the sector; symmetry, positive definiteness, number of threads. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flexibility/flexibility.h"
#include "numerics/sparse.h"
#include "support/paper-pair.h"
#include "support/tap.h"

/* Even and odd: the last harmonic stands alone or has a partner. */
static const int teeth[2] = {14, 15};

static const struct eo_flexibility_settings coarse = {.neighbour_coupling = true,
                                                      .sector_teeth = 5,
                                                      .layers = 4,
                                                      .flank_rows = 4,
                                                      .fillet_elements = 6,
                                                      .columns = 4,
                                                      .rim_elements = 3,
                                                      .reach = 7};

struct entry {
  int row, column;
  double value;
};

/* Teeth side by side, clockwise; closed to a ring, or between fixed end faces. */
struct body {
  const struct eo_section *section;
  const struct eo_sector *sector;
  int teeth, pitches; /* of the body, of the whole gear */
  bool closed;
  int inner, face; /* unknowns of a tooth without its right face, of a cut face */
  int *global;     /* [sector unknowns]: number within the tooth, or -1 - number on the right face */
  int *left;       /* [face]: number within the tooth */
  int *direction;  /* [face] */
  size_t entries, room;
  struct entry *entry;
};

static void add_entry(struct body *b, int row, int column, double value)
{
  if (row < column || value == 0)
    return;
  if (b->entries == b->room) {
    b->room = 2 * b->room + 1000;
    b->entry = realloc(b->entry, b->room * sizeof *b->entry);
    if (!b->entry)
      abort();
  }
  b->entry[b->entries++] = (struct entry){row, column, value};
}

/* Unknowns that a tooth's unknown stands for: itself, or on the right face two of the next tooth's left face. -1:
 * fixed. */
static int spread(const struct body *b, int t, int unknown, int at[2], double factor[2])
{
  double alpha = 2 * M_PI / b->pitches, c = cos(alpha), s = sin(alpha);
  int number = b->global[unknown], next = t + 1;
  factor[0] = 1;
  if (number >= 0) {
    bool left = false;
    for (int i = 0; i < b->face; i++)
      left = left || b->left[i] == number;
    at[0] = left && t == 0 && !b->closed ? -1 : t * b->inner + number;
    return 1;
  }
  int i = -1 - number, d = b->direction[i];
  if (next == b->teeth) {
    at[0] = at[1] = -1;
    if (!b->closed)
      return 1;
    next = 0;
  }
  at[0] = next * b->inner + b->left[i];
  if (d == 2)
    return 1;
  factor[0] = c;
  at[1] = next * b->inner + b->left[d == 0 ? i + 1 : i - 1];
  factor[1] = d == 0 ? s : -s;
  return 2;
}

static void list_faces(struct body *b)
{
  const struct eo_section *s = b->section;
  int n = b->sector->matrix.n, number = 0;
  b->global = malloc(sizeof(int) * (size_t)n);
  b->left = malloc(sizeof(int) * (size_t)n);
  b->direction = malloc(sizeof(int) * (size_t)n);
  for (int u = 0; u < n; u++)
    b->global[u] = 0;
  for (int i = 0; i < s->cut_nodes; i++)
    for (int l = 0; l <= b->sector->layers; l++)
      for (int c = 0; c < 3; c++) {
        int right = eo_sector_unknown(b->sector, s->cut[1][i], l, c);
        if (right < 0)
          continue;
        b->global[right] = -1 - b->face;
        b->direction[b->face] = c;
        b->left[b->face++] = eo_sector_unknown(b->sector, s->cut[0][i], l, c);
      }
  for (int u = 0; u < n; u++)
    if (b->global[u] >= 0)
      b->global[u] = number++;
  for (int i = 0; i < b->face; i++)
    b->left[i] = b->global[b->left[i]];
  b->inner = number;
}

static void add_tooth(struct body *b, int t)
{
  const struct eo_sparse *m = &b->sector->matrix;
  for (int j = 0; j < m->n; j++)
    for (int p = m->start[j]; p < m->start[j + 1]; p++) {
      int row[2], column[2];
      double by_row[2], by_column[2];
      int rows = spread(b, t, m->row[p], row, by_row), columns = spread(b, t, j, column, by_column);
      for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
          if (row[r] < 0 || column[c] < 0)
            continue;
          double value = m->value[p] * by_row[r] * by_column[c];
          add_entry(b, row[r], column[c], value);
          if (m->row[p] != j)
            add_entry(b, column[c], row[r], value);
        }
    }
}

static int compare(const void *a, const void *b)
{
  const struct entry *x = a, *y = b;
  return x->column != y->column ? (x->column > y->column) - (x->column < y->column)
                                : (x->row > y->row) - (x->row < y->row);
}

/* Sums equal places; unknowns that are fixed get a 1 on the diagonal. */
static void compress(struct body *b, struct eo_sparse *matrix)
{
  int n = b->teeth * b->inner, column = 0;
  for (int i = 0; i < n; i++)
    add_entry(b, i, i, 1e-300);
  qsort(b->entry, b->entries, sizeof *b->entry, compare);
  matrix->n = n;
  matrix->start = calloc((size_t)n + 1, sizeof(int));
  matrix->row = malloc(sizeof(int) * b->entries);
  matrix->value = malloc(sizeof(double) * b->entries);
  int filled = 0;
  for (size_t k = 0; k < b->entries; k++) {
    const struct entry *e = &b->entry[k];
    if (k && e->row == e[-1].row && e->column == e[-1].column) {
      matrix->value[filled - 1] += e->value;
      continue;
    }
    while (column <= e->column)
      matrix->start[column++] = filled;
    matrix->row[filled] = e->row;
    matrix->value[filled++] = e->value;
  }
  while (column <= n)
    matrix->start[column++] = filled;
  for (int i = 0; i < n; i++)
    if (matrix->value[matrix->start[i]] <= 1e-300)
      matrix->value[matrix->start[i]] = 1;
}

/* A place in the matrix that holds nothing. */
static void tie(struct body *b, int i, int j)
{
  add_entry(b, i > j ? i : j, i > j ? j : i, 1e-300);
}

static void body_done(struct body *b)
{
  free(b->global);
  free(b->left);
  free(b->direction);
  free(b->entry);
}

/* inverse[kept][kept] of the body's matrix; keep: numbers of the body. */
static double *solve_body(struct body *b, int kept, const int *keep)
{
  struct eo_sparse matrix = {0};
  struct eo_sparse_factor *factor = NULL;
  struct eo_error error;
  double *inverse = malloc(sizeof *inverse * (size_t)kept * (size_t)kept);
  for (int t = 0; t < b->teeth; t++)
    add_tooth(b, t);
  /* The solver wants what it eliminates first to end in the first kept unknown, and those to hang together; the insides
     of teeth between kept faces do not by themselves. */
  int inside = b->global[eo_sector_unknown(b->sector, b->section->root[2], 0, 0)];
  for (int t = 0; t < b->teeth; t++)
    tie(b, keep[0], t * b->inner + inside);
  for (int i = 1; i < kept; i++)
    tie(b, keep[i], keep[i - 1]);
  compress(b, &matrix);
  int *group = malloc(sizeof(int) * (size_t)matrix.n);
  for (int i = 0; i < matrix.n; i++)
    group[i] = i;
  if (eo_sparse_analyse(&matrix, group, matrix.n, keep, kept, &factor, &error) || eo_sparse_factorise(factor, &error) ||
      eo_sparse_inverse(factor, kept, inverse, &error)) {
    printf("# %s\n", error.text);
    free(inverse);
    inverse = NULL;
  }
  eo_sparse_factor_free(factor);
  eo_sparse_done(&matrix);
  free(group);
  return inverse;
}

static void rigid_at(const struct body *b, int t, int node, int layer, double field[3][3])
{
  const double *p = b->section->point + 2 * node;
  double angle = 2 * M_PI * t / b->pitches -
                 b->sector->twist * b->sector->width * ((double)layer / b->sector->layers - 0.5);
  double c = cos(angle), s = sin(angle);
  const double value[3][3] = {{-p[1], p[0], 0}, {c, s, 0}, {-s, c, 0}};
  memcpy(field, value, sizeof value);
}

/* Volume that a node of the left face stands for. */
static double volume_of(const struct body *b, int i, int layer)
{
  const struct eo_section *s = b->section;
  double radius[3];
  for (int k = -1; k <= 1; k++) {
    int at = i + k < 0 ? 0 : i + k >= s->cut_nodes ? s->cut_nodes - 1 : i + k;
    radius[k + 1] = hypot(s->point[2 * s->cut[0][at]], s->point[2 * s->cut[0][at] + 1]);
  }
  double height = b->sector->width / b->sector->layers * (layer == 0 || layer == b->sector->layers ? 0.5 : 1);
  return 2 * M_PI / b->pitches * radius[1] * 0.5 * (radius[0] - radius[2]) * height;
}

static void solve3(double m[3][3], double q[3])
{
  for (int p = 0; p < 3; p++)
    for (int i = 0; i < 3; i++) {
      if (i == p)
        continue;
      double f = m[i][p] / m[p][p];
      for (int j = 0; j < 3; j++)
        m[i][j] -= f * m[p][j];
      q[i] -= f * q[p];
    }
  for (int p = 0; p < 3; p++)
    q[p] /= m[p][p];
}

/* Everything of one comparison. */
struct floating {
  int flank, kept;
  double *field;  /* [3][kept] rigid motions at the kept unknowns */
  double *weight; /* [kept]: 0 on flanks */
};

static void fill_floating(const struct body *b, struct floating *f)
{
  const struct eo_section *s = b->section;
  int across = b->sector->layers + 1;
  f->field = calloc(3 * (size_t)f->kept, sizeof(double));
  f->weight = calloc((size_t)f->kept, sizeof(double));
  for (int t = 0; t < b->teeth; t++) {
    double field[3][3];
    for (int j = 0; j < f->flank; j++) {
      int node = s->flank.node[j / across];
      rigid_at(b, t, node, j % across, field);
      for (int a = 0; a < 3; a++)
        for (int c = 0; c < 3; c++)
          f->field[a * f->kept + t * f->flank + j] += field[a][c] * b->sector->frame[node][0][c];
    }
    int at = b->teeth * f->flank + t * b->face, i = 0;
    for (int node = 0; node < s->cut_nodes; node++)
      for (int l = 0; l < across; l++)
        for (int c = 0; c < 3; c++) {
          if (eo_sector_unknown(b->sector, s->cut[0][node], l, c) < 0)
            continue;
          rigid_at(b, t, s->cut[0][node], l, field);
          for (int a = 0; a < 3; a++)
            f->field[a * f->kept + at + i] = field[a][c];
          f->weight[at + i++] = volume_of(b, node, l);
        }
  }
}

static void mass_of(const struct floating *f, double mass[3][3])
{
  for (int a = 0; a < 3; a++)
    for (int c = 0; c < 3; c++) {
      mass[a][c] = 0;
      for (int i = 0; i < f->kept; i++)
        mass[a][c] += f->weight[i] * f->field[a * f->kept + i] * f->field[c * f->kept + i];
    }
}

/* Displacement of all kept unknowns under a unit load on one, balanced by inertia, counted from the mean motion. */
static void float_load(const struct floating *f, const double *inverse, int load, double *u)
{
  double mass[3][3], q[3];
  mass_of(f, mass);
  for (int a = 0; a < 3; a++)
    q[a] = f->field[a * f->kept + load];
  solve3(mass, q);
  memcpy(u, inverse + (size_t)load * (size_t)f->kept, sizeof *u * (size_t)f->kept);
  for (int i = 0; i < f->kept; i++) {
    double force = 0;
    for (int a = 0; a < 3; a++)
      force -= f->weight[i] * q[a] * f->field[a * f->kept + i];
    for (int j = 0; j < f->kept && force != 0; j++)
      u[j] += force * inverse[(size_t)i * (size_t)f->kept + (size_t)j];
  }
  mass_of(f, mass);
  for (int a = 0; a < 3; a++) {
    q[a] = 0;
    for (int i = 0; i < f->kept; i++)
      q[a] += f->weight[i] * f->field[a * f->kept + i] * u[i];
  }
  solve3(mass, q);
  for (int i = 0; i < f->kept; i++)
    for (int a = 0; a < 3; a++)
      u[i] -= q[a] * f->field[a * f->kept + i];
}

static int *list_kept(const struct body *b, int flank, bool faces, int *kept)
{
  int *keep = malloc(sizeof(int) * (size_t)(b->teeth * (flank + b->face))), n = 0, across = b->sector->layers + 1;
  for (int t = 0; t < b->teeth; t++)
    for (int j = 0; j < flank; j++)
      keep[n++] = t * b->inner +
                  b->global[eo_sector_unknown(b->sector, b->section->flank.node[j / across], j % across, 0)];
  for (int t = 0; t < b->teeth && faces; t++)
    for (int i = 0; i < b->face; i++)
      keep[n++] = t * b->inner + b->left[i];
  *kept = n;
  return keep;
}

/* What the member's result says of tooth t, counted clockwise from the loaded one. */
static const double *result_of(const struct eo_member_result *r, int member, int t)
{
  size_t n = (size_t)(r->rows * (r->layers + 1));
  int ahead = member == EO_PINION ? t : -t;
  return t == 0 ? r->full : r->next[ahead > 0] + (size_t)(abs(t) - 1) * n * n;
}

/* Statically determined springs on three unknowns of one face: loads in balance do not feel them. */
static void hold(struct body *b)
{
  add_entry(b, b->left[0], b->left[0], 1e9);
  add_entry(b, b->left[1], b->left[1], 1e9);
  int far = b->teeth / 2 * b->inner + b->left[0];
  add_entry(b, far, far, 1e9);
}

static void compare_ring(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member,
                         enum eo_body_support support, enum eo_ring_method method)
{
  struct eo_flexibility_settings wanted = coarse;
  wanted.support = support;
  wanted.reach = method == EO_RING_CHAINS ? 3 : coarse.reach;
  struct eo_member_settings settings = eo_flexibility_member_settings(&wanted, g, pair, member);
  settings.method = method;
  struct eo_material material = paper_steel();
  struct eo_member_result result;
  struct eo_member_times times;
  struct eo_section section;
  struct eo_sector sector;
  struct eo_error error = {0};
  const char *name = member ? "gear" : "pinion", *how = settings.section.floating ? "floating" : "held";
  if (!ok(!eo_member_compute(&result, g, member, &material, &settings, NULL, &times, &error),
          "%s %s: the compliance is computed %s", name, how, error.text))
    return;
  if (!ok(!eo_section_init(&section, g, member, settings.bore_radius, &settings.section, &error) &&
              !eo_sector_init(&sector, &section, settings.layers, g->face_width, eo_sector_twist(g, member), &material,
                              EO_WHOLE_SECTOR, &error),
          "%s %s: the mesh of one tooth is made %s", name, how, error.text))
    return;
  struct body body = {
      .section = &section, .sector = &sector, .teeth = g->teeth[member], .pitches = g->teeth[member], .closed = true};
  struct floating f = {.flank = result.rows * (result.layers + 1)};
  list_faces(&body);
  if (settings.section.floating)
    hold(&body);
  int *keep = list_kept(&body, f.flank, settings.section.floating, &f.kept);
  double *inverse = solve_body(&body, f.kept, keep), *u = malloc(sizeof *u * (size_t)f.kept), worst = 0, size = 0;
  if (settings.section.floating)
    fill_floating(&body, &f);
  for (int load = 0; load < f.flank && inverse; load += 7) {
    if (settings.section.floating)
      float_load(&f, inverse, load, u);
    else
      memcpy(u, inverse + (size_t)load * (size_t)f.kept, sizeof *u * (size_t)f.kept);
    for (int t = -result.reach; t <= result.reach; t++)
      for (int i = 0; i < f.flank; i++) {
        double ours = result_of(&result, member, t)[(size_t)load * (size_t)f.flank + (size_t)i];
        double theirs = u[(t + body.teeth) % body.teeth * f.flank + i];
        worst = fmax(worst, fabs(ours - theirs));
        size = fmax(size, fabs(theirs));
      }
  }
  ok(inverse && worst < 1e-8 * size, "%s %s, %d teeth: %s and all teeth at once agree: %.1e of %.3g m/N", name, how,
     body.teeth, method == EO_RING_CHAINS ? "chains" : "harmonics", worst, size);
  free(f.field);
  free(f.weight);
  free(inverse);
  free(u);
  free(keep);
  body_done(&body);
  eo_sector_done(&sector);
  eo_section_done(&section);
  eo_member_result_done(&result);
}

/* D_-d = D_d', and the compliance of all teeth together is positive semi-definite. */
static void check_matrix(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member)
{
  struct eo_member_settings settings = eo_flexibility_member_settings(&coarse, g, pair, member);
  struct eo_material material = paper_steel();
  struct eo_member_result r;
  struct eo_member_times times;
  struct eo_error error = {0};
  if (!ok(!eo_member_compute(&r, g, member, &material, &settings, NULL, &times, &error),
          "the compliance is computed %s", error.text))
    return;
  int n = r.rows * (r.layers + 1), z = g->teeth[member], all = z * n;
  double odd = 0, size = 0, smallest = 0, largest = 0;
  for (int d = 1; d <= r.reach; d++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        odd = fmax(odd, fabs(result_of(&r, member, d)[i * n + j] - result_of(&r, member, -d)[j * n + i]));
        size = fmax(size, fabs(result_of(&r, member, d)[i * n + j]));
      }
  ok(odd < 1e-9 * size, "%s: the compliance has D_-d = D_d': %.1e of %.3g m/N", member ? "gear" : "pinion", odd, size);
  double *matrix = malloc(sizeof *matrix * (size_t)all * (size_t)all);
  for (int a = 0; a < all; a++)
    for (int b = 0; b < all; b++) {
      int t = (b / n - a / n + z) % z, i = a % n, j = b % n;
      double value = result_of(&r, member, t <= z / 2 ? t : t - z)[i * n + j] - (t ? 0 : r.half[i * n + j]);
      matrix[(size_t)a * (size_t)all + (size_t)b] = value;
    }
  enum eo_code code = eo_symmetric_extremes(all, matrix, &smallest, &largest, &error);
  ok(!code && smallest > -1e-9 * largest, "%s: the compliance of all %d teeth has eigenvalues %.2e .. %.2e m/N",
     member ? "gear" : "pinion", z, smallest, largest);
  free(matrix);
  eo_member_result_done(&r);
}

/* Five teeth between fixed end faces, as the sector has them, and assembled from one tooth. */
static void compare_chain(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member)
{
  struct eo_flexibility_settings wanted = coarse;
  struct eo_material material = paper_steel();
  struct eo_member_result r;
  struct eo_member_times times;
  struct eo_section section;
  struct eo_sector sector;
  struct eo_error error = {0};
  wanted.body = EO_BODY_SECTOR;
  struct eo_member_settings of_sector = eo_flexibility_member_settings(&wanted, g, pair, member);
  const struct eo_tooth_division division = {4, 4, {5, 6}};
  of_sector.section.loaded = of_sector.section.next = of_sector.section.outer = division;
  struct eo_section_settings of_tooth = of_sector.section;
  of_tooth.teeth = 1;
  of_tooth.open = true;
  if (!ok(!eo_member_compute(&r, g, member, &material, &of_sector, NULL, &times, &error) &&
              !eo_section_init(&section, g, member, of_sector.bore_radius, &of_tooth, &error) &&
              !eo_sector_init(&sector, &section, of_sector.layers, g->face_width, eo_sector_twist(g, member), &material,
                              EO_WHOLE_SECTOR, &error),
          "sector and tooth are made %s", error.text))
    return;
  struct body body = {.section = &section, .sector = &sector, .teeth = 5, .pitches = g->teeth[member]};
  int n = r.rows * (r.layers + 1), kept;
  list_faces(&body);
  int *keep = list_kept(&body, n, false, &kept);
  double *inverse = solve_body(&body, kept, keep), worst = 0, size = 0;
  for (int j = 0; j < n && inverse; j++)
    for (int t = -1; t <= 1; t++)
      for (int i = 0; i < n; i++) {
        double chain = inverse[(size_t)(2 * n + j) * (size_t)kept + (size_t)((2 + t) * n + i)];
        worst = fmax(worst, fabs(result_of(&r, member, t)[j * n + i] - chain));
        size = fmax(size, fabs(chain));
      }
  ok(inverse && worst < 1e-9 * size, "%s: a chain of five such teeth is the sector: %.1e of %.3g m/N",
     member ? "gear" : "pinion", worst, size);
  free(keep);
  free(inverse);
  body_done(&body);
  eo_sector_done(&sector);
  eo_section_done(&section);
  eo_member_result_done(&r);
}

static void check_threads(const struct eo_geometry *g, const struct eo_gear_pair *pair)
{
  struct eo_material material = paper_steel();
  struct eo_member_result r[2];
  struct eo_member_times times;
  struct eo_error error = {0};
  enum eo_code code = EO_OK;
  for (int i = 0; i < 2 && !code; i++) {
    struct eo_member_settings settings = eo_flexibility_member_settings(&coarse, g, pair, EO_GEAR);
    settings.threads = 1 + 2 * i;
    code = eo_member_compute(&r[i], g, EO_GEAR, &material, &settings, NULL, &times, &error);
  }
  size_t n = (size_t)(r[0].rows * (r[0].layers + 1)), reach = (size_t)r[0].reach;
  ok(!code && !memcmp(r[0].full, r[1].full, n * n * sizeof(double)) &&
         !memcmp(r[0].next[0], r[1].next[0], reach * n * n * sizeof(double)) &&
         !memcmp(r[0].part[1], r[1].part[1], (size_t)r[0].rows * sizeof(double)),
     "one thread and three give the same bytes");
  for (int i = 0; i < 2; i++)
    eo_member_result_done(&r[i]);
}

/* The ring is softer than the sector, whose cuts are held, in the sense of its whole compliance. */
static void check_support(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_flexibility_settings settings = coarse;
  pair.bore[EO_PINION] = 0;
  pair.bore[EO_GEAR] = 90e-3;
  settings.support = EO_SUPPORT_HELD_AT_BORE;
  ok(eo_flexibility_support(&settings, &pair, EO_PINION) == EO_MEMBER_FLOATING &&
         eo_flexibility_support(&settings, &pair, EO_GEAR) == EO_MEMBER_HELD_AT_BORE,
     "a solid pinion floats where it is held at the bore");
  settings.body = EO_BODY_SECTOR;
  ok(eo_flexibility_support(&settings, &pair, EO_GEAR) == EO_MEMBER_SECTOR, "a member that is to be a sector is one");
}

int main(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_geometry g;
  struct eo_error error = {0};
  pair.teeth[0] = teeth[0];
  pair.teeth[1] = teeth[1];
  pair.profile_shift[0] = 0.2;
  pair.bore[EO_GEAR] = 0;
  pair.centre_distance = NAN;
  for (int m = 0; m < 2; m++)
    pair.tip_diameter[m] = NAN;
  if (!ok(!eo_geometry_init(&g, &pair, &error), "a pair of %d and %d teeth is made %s", teeth[0], teeth[1], error.text))
    return tap_done();
  for (int member = 0; member < 2; member++) {
    for (int method = EO_RING_HARMONICS; method <= EO_RING_CHAINS; method++) {
      compare_ring(&g, &pair, member, EO_SUPPORT_HELD, method);
      compare_ring(&g, &pair, member, EO_SUPPORT_FLOATING, method);
    }
    compare_chain(&g, &pair, member);
    check_matrix(&g, &pair, member);
  }
  check_threads(&g, &pair);
  check_support();
  return tap_done();
}
