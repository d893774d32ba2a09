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

static struct frame find_frame(const struct eo_band_chart *chart, struct eo_text *text)
{
  enum { X_PARTS = 9, Y_PARTS = 6 };
  struct frame frame = {.chart = chart, .x = {INFINITY, -INFINITY}, .y = {0, 0}, .text = text};
  widen(chart->x, chart->count, frame.x);
  widen(chart->nominal, chart->count, frame.y);
  widen(chart->upper, chart->count, frame.y);
  widen(chart->lower, chart->count, frame.y);
  if (!(frame.y[1] > frame.y[0]))
    frame.y[1] = frame.y[0] + 1;
  frame.x_step = round_step(frame.x[1] - frame.x[0], X_PARTS);
  frame.y_step = round_step(frame.y[1] - frame.y[0], Y_PARTS);
  frame.y[0] = frame.y_step * floor(frame.y[0] / frame.y_step - 0.5);
  frame.y[1] = frame.y_step * ceil(frame.y[1] / frame.y_step + 0.5);
  frame.height = TOP + FRAME + BELOW + SCALE * chart->scales;
  return frame;
}

static double place_x(const struct frame *frame, double x)
{
  return LEFT + (x - frame->x[0]) / (frame->x[1] - frame->x[0]) * (WIDTH - LEFT - RIGHT);
}

static double place_y(const struct frame *frame, double y)
{
  return TOP + FRAME - (y - frame->y[0]) / (frame->y[1] - frame->y[0]) * FRAME;
}

/* Straight between the points of the curve. */
static double value_at(const struct eo_band_chart *chart, const double *value, double x)
{
  int i = 0;
  while (i < chart->count - 2 && chart->x[i + 1] < x)
    i++;
  double step = chart->x[i + 1] - chart->x[i];
  return value[i] + (step > 0 ? (x - chart->x[i]) / step * (value[i + 1] - value[i]) : 0);
}

static void draw_x_axis(const struct frame *frame)
{
  const struct eo_band_chart *chart = frame->chart;
  struct eo_text *text = frame->text;
  int bottom = TOP + FRAME;
  for (double x = frame->x_step * ceil(frame->x[0] / frame->x_step - 1e-9); x <= frame->x[1] + 1e-9 * frame->x_step;
       x += frame->x_step) {
    double at = place_x(frame, x);
    eo_text_print(text, "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#e4e4e4\"/>", at, at, TOP, bottom);
    eo_text_print(text, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.6g</text>", at, bottom + 16,
                  fabs(x) < 1e-9 * frame->x_step ? 0 : x);
    for (int i = 0; i < chart->scales; i++)
      eo_text_print(text, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\" fill=\"#555\">%.*f</text>", at,
                    bottom + 16 + SCALE * (i + 1), chart->scale[i].decimals, value_at(chart, chart->scale[i].value, x));
    eo_text_add(text, "\n");
  }
  eo_text_print(text, "<text x=\"8\" y=\"%d\">", bottom + 16);
  eo_text_add_escaped(text, chart->x_label);
  eo_text_add(text, "</text>\n");
  for (int i = 0; i < chart->scales; i++) {
    eo_text_print(text, "<text x=\"8\" y=\"%d\" fill=\"#555\">", bottom + 16 + SCALE * (i + 1));
    eo_text_add_escaped(text, chart->scale[i].label);
    eo_text_add(text, "</text>\n");
  }
}

static void draw_y_axis(const struct frame *frame)
{
  struct eo_text *text = frame->text;
  for (double y = frame->y[0]; y <= frame->y[1] + 1e-9 * frame->y_step; y += frame->y_step) {
    double at = place_y(frame, y);
    bool zero = fabs(y) < 1e-9 * frame->y_step;
    eo_text_print(text, "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>", LEFT, WIDTH - RIGHT, at,
                  at, zero ? "#999" : "#e4e4e4");
    eo_text_print(text, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.6g</text>\n", LEFT - 6, at + 4, zero ? 0 : y);
  }
  eo_text_print(text, "<text transform=\"translate(%d %d) rotate(-90)\" text-anchor=\"middle\">", LEFT - 44,
                TOP + FRAME / 2);
  eo_text_add_escaped(text, frame->chart->y_label);
  eo_text_add(text, "</text>\n");
}

/* One polygon for each stretch where both limits are there. */
static void draw_band(const struct frame *frame)
{
  const struct eo_band_chart *chart = frame->chart;
  for (int first = 0; first < chart->count; first++) {
    int last = first;
    while (last < chart->count && isfinite(chart->upper[last]) && isfinite(chart->lower[last]))
      last++;
    if (last - first < 2)
      continue;
    eo_text_add(frame->text, "<path class=\"band\" fill=\"#cfe3f5\" stroke=\"#0072b2\" stroke-width=\"0.8\" d=\"");
    for (int i = first; i < last; i++)
      eo_text_print(frame->text, "%c%.2f %.2f", i == first ? 'M' : 'L', place_x(frame, chart->x[i]),
                    place_y(frame, chart->upper[i]));
    for (int i = last - 1; i >= first; i--)
      eo_text_print(frame->text, "L%.2f %.2f", place_x(frame, chart->x[i]), place_y(frame, chart->lower[i]));
    eo_text_add(frame->text, "Z\"/>\n");
    first = last;
  }
}

static void draw_nominal(const struct frame *frame)
{
  const struct eo_band_chart *chart = frame->chart;
  eo_text_add(frame->text, "<path class=\"nominal\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.8\" d=\"");
  for (int i = 0; i < chart->count; i++)
    eo_text_print(frame->text, "%c%.2f %.2f", i ? 'L' : 'M', place_x(frame, chart->x[i]),
                  place_y(frame, chart->nominal[i]));
  eo_text_add(frame->text, "\"/>\n");
}

/* Evaluation range: an arrow above the frame between two dashed lines. */
static void draw_range(const struct frame *frame)
{
  const struct eo_band_chart *chart = frame->chart;
  if (!(chart->range[1] > chart->range[0]))
    return;
  double from = place_x(frame, chart->range[0]), to = place_x(frame, chart->range[1]);
  for (int i = 0; i < 2; i++)
    eo_text_print(frame->text,
                  "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#d55e00\" stroke-dasharray=\"5 3\"/>",
                  i ? to : from, i ? to : from, TOP - 10, TOP + FRAME);
  eo_text_print(frame->text, "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#d55e00\"/>\n", from, to,
                TOP - 8, TOP - 8);
  eo_text_print(frame->text, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\" fill=\"#b04a00\">", (from + to) / 2,
                TOP - 13);
  eo_text_add_escaped(frame->text, chart->range_label);
  eo_text_add(frame->text, "</text>\n");
}

/* Labels stand at the top of the frame, turned along their lines. */
static void draw_marks(const struct frame *frame)
{
  const struct eo_band_chart *chart = frame->chart;
  for (int i = 0; i < chart->marks; i++) {
    double at = place_x(frame, chart->mark[i].x);
    if (!isfinite(chart->mark[i].x) || at < LEFT - 0.5 || at > WIDTH - RIGHT + 0.5)
      continue;
    eo_text_print(frame->text,
                  "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#666\" stroke-width=\"0.8\"/>", at, at,
                  TOP, TOP + FRAME);
    eo_text_print(frame->text, "<text transform=\"translate(%.1f %d) rotate(-90)\" font-size=\"11\" fill=\"#333\">",
                  at > WIDTH - RIGHT - 14 ? at - 4 : at + 11, TOP + FRAME - 6);
    eo_text_add_escaped(frame->text, chart->mark[i].label);
    eo_text_add(frame->text, "</text>\n");
  }
}

static void draw_sides(const struct frame *frame)
{
  const char *side[2] = {frame->chart->above, frame->chart->below};
  for (int i = 0; i < 2; i++)
    if (side[i]) {
      eo_text_print(frame->text, "<text x=\"%d\" y=\"%d\" font-style=\"italic\" fill=\"#777\">", 8,
                    i ? TOP + FRAME - 6 : TOP + 12);
      eo_text_add_escaped(frame->text, side[i]);
      eo_text_add(frame->text, "</text>\n");
    }
}

void eo_band_chart_svg(const struct eo_band_chart *chart, struct eo_text *text)
{
  struct frame frame = find_frame(chart, text);
  eo_text_print(text,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n<text x=\"8\" y=\"18\" font-weight=\"bold\">",
                WIDTH, frame.height);
  eo_text_add_escaped(text, chart->title);
  eo_text_add(text, "</text>\n");
  draw_x_axis(&frame);
  draw_y_axis(&frame);
  draw_band(&frame);
  draw_marks(&frame);
  draw_nominal(&frame);
  draw_range(&frame);
  draw_sides(&frame);
  eo_text_print(text, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#888\"/>\n</svg>\n",
                LEFT, TOP, WIDTH - LEFT - RIGHT, FRAME);
}
