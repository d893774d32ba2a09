/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/band_chart.h"

#include <math.h>

#include "format/plot.h"

enum { WIDTH = 720, LEFT = 118, RIGHT = 24, TOP = 58, FRAME = 230, BELOW = 38, SCALE = 18 };

struct frame {
  const struct eo_band_chart *chart;
  double x[2], y[2], x_step, y_step;
  int height;
  struct eo_text *text;
};

/* 1, 2 or 5 times a power of ten, about `parts` of them over the range. */
static double round_step(double range, int parts)
{
  double raw = range / parts, power = pow(10, floor(log10(raw))), lead = raw / power;
  return power * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10);
}

static void widen(const double *value, int count, double range[2])
{
  for (int i = 0; i < count; i++)
    if (isfinite(value[i])) {
      range[0] = fmin(range[0], value[i]);
      range[1] = fmax(range[1], value[i]);
    }
}

static struct frame find_frame(const struct eo_band_chart *c, struct eo_text *text)
{
  enum { X_PARTS = 9, Y_PARTS = 6 };
  struct frame f = {.chart = c, .x = {INFINITY, -INFINITY}, .y = {0, 0}, .text = text};
  widen(c->x, c->count, f.x);
  widen(c->nominal, c->count, f.y);
  widen(c->upper, c->count, f.y);
  widen(c->lower, c->count, f.y);
  if (!(f.y[1] > f.y[0]))
    f.y[1] = f.y[0] + 1;
  f.x_step = round_step(f.x[1] - f.x[0], X_PARTS);
  f.y_step = round_step(f.y[1] - f.y[0], Y_PARTS);
  f.y[0] = f.y_step * floor(f.y[0] / f.y_step - 0.5);
  f.y[1] = f.y_step * ceil(f.y[1] / f.y_step + 0.5);
  f.height = TOP + FRAME + BELOW + SCALE * c->scales;
  return f;
}

static double place_x(const struct frame *f, double x)
{
  return LEFT + (x - f->x[0]) / (f->x[1] - f->x[0]) * (WIDTH - LEFT - RIGHT);
}

static double place_y(const struct frame *f, double y)
{
  return TOP + FRAME - (y - f->y[0]) / (f->y[1] - f->y[0]) * FRAME;
}

/* Straight between the points of the curve. */
static double value_at(const struct eo_band_chart *c, const double *value, double x)
{
  int i = 0;
  while (i < c->count - 2 && c->x[i + 1] < x)
    i++;
  double step = c->x[i + 1] - c->x[i];
  return value[i] + (step > 0 ? (x - c->x[i]) / step * (value[i + 1] - value[i]) : 0);
}

static void draw_x_axis(const struct frame *f)
{
  const struct eo_band_chart *c = f->chart;
  struct eo_text *t = f->text;
  int bottom = TOP + FRAME;
  for (double x = f->x_step * ceil(f->x[0] / f->x_step - 1e-9); x <= f->x[1] + 1e-9 * f->x_step; x += f->x_step) {
    double at = place_x(f, x);
    eo_text_print(t, "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#e4e4e4\"/>", at, at, TOP, bottom);
    eo_text_print(t, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.6g</text>", at, bottom + 16,
                  fabs(x) < 1e-9 * f->x_step ? 0 : x);
    for (int i = 0; i < c->scales; i++)
      eo_text_print(t, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\" fill=\"#555\">%.*f</text>", at,
                    bottom + 16 + SCALE * (i + 1), c->scale[i].decimals, value_at(c, c->scale[i].value, x));
    eo_text_add(t, "\n");
  }
  eo_text_print(t, "<text x=\"8\" y=\"%d\">", bottom + 16);
  eo_plot_escape(t, c->x_label);
  eo_text_add(t, "</text>\n");
  for (int i = 0; i < c->scales; i++) {
    eo_text_print(t, "<text x=\"8\" y=\"%d\" fill=\"#555\">", bottom + 16 + SCALE * (i + 1));
    eo_plot_escape(t, c->scale[i].label);
    eo_text_add(t, "</text>\n");
  }
}

static void draw_y_axis(const struct frame *f)
{
  struct eo_text *t = f->text;
  for (double y = f->y[0]; y <= f->y[1] + 1e-9 * f->y_step; y += f->y_step) {
    double at = place_y(f, y);
    bool zero = fabs(y) < 1e-9 * f->y_step;
    eo_text_print(t, "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>", LEFT, WIDTH - RIGHT, at, at,
                  zero ? "#999" : "#e4e4e4");
    eo_text_print(t, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.6g</text>\n", LEFT - 6, at + 4, zero ? 0 : y);
  }
  eo_text_print(t, "<text transform=\"translate(%d %d) rotate(-90)\" text-anchor=\"middle\">", LEFT - 44,
                TOP + FRAME / 2);
  eo_plot_escape(t, f->chart->y_label);
  eo_text_add(t, "</text>\n");
}

/* One polygon for each stretch where both limits are there. */
static void draw_band(const struct frame *f)
{
  const struct eo_band_chart *c = f->chart;
  for (int first = 0; first < c->count; first++) {
    int last = first;
    while (last < c->count && isfinite(c->upper[last]) && isfinite(c->lower[last]))
      last++;
    if (last - first < 2)
      continue;
    eo_text_add(f->text, "<path class=\"band\" fill=\"#cfe3f5\" stroke=\"#0072b2\" stroke-width=\"0.8\" d=\"");
    for (int i = first; i < last; i++)
      eo_text_print(f->text, "%c%.2f %.2f", i == first ? 'M' : 'L', place_x(f, c->x[i]), place_y(f, c->upper[i]));
    for (int i = last - 1; i >= first; i--)
      eo_text_print(f->text, "L%.2f %.2f", place_x(f, c->x[i]), place_y(f, c->lower[i]));
    eo_text_add(f->text, "Z\"/>\n");
    first = last;
  }
}

static void draw_nominal(const struct frame *f)
{
  const struct eo_band_chart *c = f->chart;
  eo_text_add(f->text, "<path class=\"nominal\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.8\" d=\"");
  for (int i = 0; i < c->count; i++)
    eo_text_print(f->text, "%c%.2f %.2f", i ? 'L' : 'M', place_x(f, c->x[i]), place_y(f, c->nominal[i]));
  eo_text_add(f->text, "\"/>\n");
}

/* Evaluation range: an arrow above the frame between two dashed lines. */
static void draw_range(const struct frame *f)
{
  const struct eo_band_chart *c = f->chart;
  if (!(c->range[1] > c->range[0]))
    return;
  double from = place_x(f, c->range[0]), to = place_x(f, c->range[1]);
  for (int i = 0; i < 2; i++)
    eo_text_print(f->text,
                  "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#d55e00\" stroke-dasharray=\"5 3\"/>",
                  i ? to : from, i ? to : from, TOP - 10, TOP + FRAME);
  eo_text_print(f->text, "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#d55e00\"/>\n", from, to, TOP - 8,
                TOP - 8);
  eo_text_print(f->text, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\" fill=\"#b04a00\">", (from + to) / 2,
                TOP - 13);
  eo_plot_escape(f->text, c->range_label);
  eo_text_add(f->text, "</text>\n");
}

/* Labels stand at the top of the frame, turned along their lines. */
static void draw_marks(const struct frame *f)
{
  const struct eo_band_chart *c = f->chart;
  for (int i = 0; i < c->marks; i++) {
    double at = place_x(f, c->mark[i].x);
    if (!isfinite(c->mark[i].x) || at < LEFT - 0.5 || at > WIDTH - RIGHT + 0.5)
      continue;
    eo_text_print(f->text, "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#666\" stroke-width=\"0.8\"/>",
                  at, at, TOP, TOP + FRAME);
    eo_text_print(f->text, "<text transform=\"translate(%.1f %d) rotate(-90)\" font-size=\"11\" fill=\"#333\">",
                  at > WIDTH - RIGHT - 14 ? at - 4 : at + 11, TOP + FRAME - 6);
    eo_plot_escape(f->text, c->mark[i].label);
    eo_text_add(f->text, "</text>\n");
  }
}

static void draw_sides(const struct frame *f)
{
  const char *side[2] = {f->chart->above, f->chart->below};
  for (int i = 0; i < 2; i++)
    if (side[i]) {
      eo_text_print(f->text, "<text x=\"%d\" y=\"%d\" font-style=\"italic\" fill=\"#777\">", 8,
                    i ? TOP + FRAME - 6 : TOP + 12);
      eo_plot_escape(f->text, side[i]);
      eo_text_add(f->text, "</text>\n");
    }
}

void eo_band_chart_svg(const struct eo_band_chart *chart, struct eo_text *text)
{
  struct frame f = find_frame(chart, text);
  eo_text_print(text,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n<text x=\"8\" y=\"18\" font-weight=\"bold\">",
                WIDTH, f.height);
  eo_plot_escape(text, chart->title);
  eo_text_add(text, "</text>\n");
  draw_x_axis(&f);
  draw_y_axis(&f);
  draw_band(&f);
  draw_marks(&f);
  draw_nominal(&f);
  draw_range(&f);
  draw_sides(&f);
  eo_text_print(text, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#888\"/>\n</svg>\n",
                LEFT, TOP, WIDTH - LEFT - RIGHT, FRAME);
}
