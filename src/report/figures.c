/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/figures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "format/plot.h"
#include "gear/names.h"

enum { MOST_CASES = 6, MOST_POINTS = 1024 };

static int read_column(const json_t *array, double value[MOST_POINTS])
{
  int count = (int)json_array_size(array);
  count = count < MOST_POINTS ? count : MOST_POINTS;
  for (int i = 0; i < count; i++) {
    const json_t *number = json_array_get(array, (size_t)i);
    value[i] = json_is_number(number) ? json_number_value(number) : NAN;
  }
  return count;
}

/* The numbers of the load cases that are drawn: those with the largest shares, ascending. */
static int choose_cases(const json_t *result, size_t chosen[MOST_CASES])
{
  const json_t *cases = json_object_get(result, "load_cases");
  int count = 0;
  for (size_t i = 0; i < json_array_size(cases); i++) {
    double share = eo_json_find_number(json_array_get(cases, i), "share");
    int heavier = 0;
    for (size_t j = 0; j < json_array_size(cases); j++) {
      double other = eo_json_find_number(json_array_get(cases, j), "share");
      heavier += other > share || (j < i && other >= share);
    }
    if (heavier < MOST_CASES)
      chosen[count++] = i;
  }
  return count;
}

/* One curve of each of several load cases. */
struct curves {
  struct eo_plot plot;
  char name[EO_PLOT_SERIES][60];
  double x[EO_PLOT_SERIES][MOST_POINTS], y[EO_PLOT_SERIES][MOST_POINTS];
};

static void add_curve(const struct eo_page *page, struct curves *curves, const json_t *load_case, const char *x,
                      const char *y, const char *suffix)
{
  int i = curves->plot.series;
  const json_t *column = eo_page_find(page, load_case, y);
  if (i == EO_PLOT_SERIES || !json_array_size(column))
    return;
  int points = read_column(eo_page_find(page, load_case, x), curves->x[i]), values = read_column(column, curves->y[i]);
  snprintf(curves->name[i], sizeof curves->name[i], "%.5g N m, %.5g rpm%s", eo_json_find_number(load_case, "torque_Nm"),
           eo_json_find_number(load_case, "speed_rpm"), suffix);
  curves->plot.line[i] = (struct eo_plot_series){
      .name = curves->name[i], .count = points < values ? points : values, .x = curves->x[i], .y = curves->y[i]};
  curves->plot.series++;
}

static void draw_cases(const json_t *result, const struct eo_plot *frame, const char *x, const char *const y[2],
                       const struct eo_page *page)
{
  struct curves *curves = calloc(1, sizeof *curves);
  size_t chosen[MOST_CASES];
  int count = choose_cases(result, chosen);
  if (!curves) {
    page->text->failed = true;
    return;
  }
  curves->plot = *frame;
  for (int i = 0; i < count; i++) {
    const json_t *load_case = json_array_get(json_object_get(result, "load_cases"), chosen[i]);
    bool two = y[1] && eo_page_find(page, load_case, y[1]);
    add_curve(page, curves, load_case, x, y[0], two ? ", left" : "");
    if (two)
      add_curve(page, curves, load_case, x, y[1], ", right");
  }
  if (curves->plot.series)
    eo_plot_svg(&curves->plot, page->text);
  free(curves);
}

void eo_figure_transmission(const json_t *result, const struct eo_page *page)
{
  const struct eo_plot frame = {.title = "Loaded transmission error of the pair",
                                .x_label = "mesh position",
                                .y_label = page->inches ? "thou, transverse" : "um, transverse"};
  draw_cases(result, &frame, "position", (const char *const[]){"lte/pair_um", NULL}, page);
}

void eo_figure_stiffness(const json_t *result, const struct eo_page *page)
{
  const struct eo_plot frame = {
      .title = "Mesh stiffness of each end, normal", .x_label = "mesh position", .y_label = "N/um"};
  draw_cases(result, &frame, "position",
             (const char *const[]){"mesh_stiffness/left_N_per_um", "mesh_stiffness/right_N_per_um"}, page);
}

void eo_figure_face_load(const json_t *result, const struct eo_page *page)
{
  const struct eo_plot frame = {.title = "Load over the face, mean over the mesh cycle",
                                .x_label = page->inches ? "from mid face, in; + on the side that meets first"
                                                        : "from mid face, mm; + on the side that meets first",
                                .y_label = "N/mm, normal",
                                .from_zero = true};
  draw_cases(result, &frame, "contact/face_load/eta_mm",
             (const char *const[]){"contact/face_load/left_N_per_mm", "contact/face_load/right_N_per_mm"}, page);
}

/* From white over blue to dark, by how dark it prints. */
static void put_colour(struct eo_text *text, double share)
{
  double t = fmin(fmax(share, 0), 1);
  eo_text_print(text, "#%02x%02x%02x", (int)lround(255 - 225 * t), (int)lround(255 - 195 * t),
                (int)lround(255 - 110 * t));
}

/* What lies over the flanks of one or two ends. */
struct map {
  const char *title, *unit;
  bool thin; /* the least value is the dark one */
  const json_t *eta, *s, *end[2];
};

/* The largest value, or the least one; 0 where there is none. */
static double extreme(const struct map *map, int end)
{
  const json_t *rows = map->end[end];
  double found = 0;
  for (size_t i = 0; i < json_array_size(rows); i++)
    for (size_t j = 0; j < json_array_size(json_array_get(rows, i)); j++) {
      double value = json_number_value(json_array_get(json_array_get(rows, i), j));
      if (value > 0 && (found == 0 || (map->thin ? value < found : value > found)))
        found = value;
    }
  return found;
}

static void draw_cells(const struct map *map, int end, double darkest, double x, double y, double width, double height,
                       struct eo_text *text)
{
  const json_t *rows = map->end[end];
  size_t n = json_array_size(rows), m = json_array_size(json_array_get(rows, 0));
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) {
      double value = json_number_value(json_array_get(json_array_get(rows, i), j));
      if (!(value > 0))
        continue;
      eo_text_print(text, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.2f\" height=\"%.2f\" fill=\"",
                    x + width * (double)j / (double)m, y + height * (double)(n - 1 - i) / (double)n,
                    width / (double)m + 0.2, height / (double)n + 0.2);
      put_colour(text, map->thin ? darkest / value : value / darkest);
      eo_text_add(text, "\"/>");
    }
  eo_text_print(text, "\n<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#888\"/>\n",
                x, y, width, height);
}

static void label_end(const struct map *map, int end, double x, double y, double width, double height,
                      const struct eo_page *page)
{
  size_t last_eta = json_array_size(map->eta) - 1, last_s = json_array_size(map->s) - 1;
  const char *unit = eo_page_unit(page, &eo_unit_mm);
  eo_text_print(page->text, "<text x=\"%.1f\" y=\"%.1f\">%s%s%s %.5g %s</text>\n", x, y - 6,
                map->end[1] ? eo_end_name[end] : "", map->end[1] ? " end, " : "", map->thin ? "least" : "largest",
                extreme(map, end), map->unit);
  eo_text_print(page->text,
                "<text x=\"%.1f\" y=\"%.1f\">%.4g %s</text><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.4g %s, "
                "meets first</text>\n",
                x, y + height + 14, json_number_value(json_array_get(map->eta, 0)), unit, x + width, y + height + 14,
                json_number_value(json_array_get(map->eta, last_eta)), unit);
  if (end == 0)
    eo_text_print(page->text,
                  "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">s %.4g %s</text><text x=\"%.1f\" y=\"%.1f\" "
                  "text-anchor=\"end\">s %.4g %s</text>\n",
                  x - 6, y + 10, json_number_value(json_array_get(map->s, last_s)), unit, x - 6, y + height,
                  json_number_value(json_array_get(map->s, 0)), unit);
}

static void draw_map(const struct map *map, const struct eo_page *page)
{
  enum { WIDTH = 720, HEIGHT = 236, LEFT = 84, TOP = 46, FLANK = 160, GAP = 24 };
  int ends = json_is_array(map->end[1]) ? 2 : 1;
  double width = (WIDTH - LEFT - GAP * ends) / (double)ends, darkest = extreme(map, 0), other = extreme(map, ends - 1);
  if (map->thin ? other < darkest : other > darkest)
    darkest = other;
  if (!(darkest > 0))
    return;
  eo_text_print(page->text,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n<text x=\"8\" y=\"18\" font-weight=\"bold\">",
                WIDTH, HEIGHT);
  eo_text_add_escaped(page->text, map->title);
  eo_text_add(page->text, "</text>\n");
  for (int end = 0; end < ends; end++) {
    double x = LEFT + end * (width + GAP);
    draw_cells(map, end, darkest, x, TOP, width, FLANK, page->text);
    label_end(map, end, x, TOP, width, FLANK, page);
  }
  eo_text_add(page->text, "</svg>\n");
}

/* Where the torque is largest. */
static size_t heaviest(const json_t *cases)
{
  size_t found = 0;
  for (size_t i = 1; i < json_array_size(cases); i++)
    if (eo_json_find_number(json_array_get(cases, i), "torque_Nm") >
        eo_json_find_number(json_array_get(cases, found), "torque_Nm"))
      found = i;
  return found;
}

void eo_figure_maps(const json_t *result, const struct eo_page *page)
{
  static const struct {
    const char *title;
    const struct eo_unit *unit;
    const char *left, *right;
    bool thin;
    bool contact; /* of the load case's contact; else of the tribology */
  } maps[] = {{"Contact pressure", &eo_unit_MPa, "contact/pattern/left/pressure_MPa",
               "contact/pattern/right/pressure_MPa", false, true},
              {"Flash temperature", &eo_unit_K, "left/flash_K", "right/flash_K", false, false},
              {"Film thickness", &eo_unit_um, "left/film_um", "right/film_um", true, false}};
  const json_t *cases = json_object_get(result, "load_cases"), *tribology = json_object_get(result, "tribology");
  size_t k = heaviest(cases);
  for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
    char title[160];
    const json_t *contact = json_array_get(cases, k),
                 *from = maps[i].contact ? contact : json_array_get(json_object_get(tribology, "load_cases"), k);
    snprintf(title, sizeof title, "%s over the flank, %.5g N m, %.5g rpm; up: towards the pinion's tip", maps[i].title,
             eo_json_find_number(contact, "torque_Nm"), eo_json_find_number(contact, "speed_rpm"));
    const struct map map = {.title = title,
                            .unit = eo_page_unit(page, maps[i].unit),
                            .thin = maps[i].thin,
                            .eta = eo_page_find(page, contact, "contact/pattern/eta_mm"),
                            .s = eo_page_find(page, contact, "contact/pattern/s_mm"),
                            .end = {eo_page_find(page, from, maps[i].left), eo_page_find(page, from, maps[i].right)}};
    if (json_is_array(map.end[0]))
      draw_map(&map, page);
  }
}
