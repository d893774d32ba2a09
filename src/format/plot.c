/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/plot.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 640, HEIGHT = 380, LEFT = 64, RIGHT = 16, TOP = 34, BOTTOM = 84 };

/* Distinct for the colour-blind too (Okabe and Ito 2008). */
static const char *const colours[EO_PLOT_SERIES] = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                                    "#cc79a7", "#e69f00", "#56b4e9", "#8a8a00"};
static const char *const dashes[EO_PLOT_SERIES] = {"", "", "", "6 3", "6 3", "2 3", "2 3", "8 3 2 3"};

struct axis {
  double low, high, step;
};

struct frame {
  const struct eo_plot *plot;
  struct axis x, y;
  struct eo_text *text;
};

/* Steps of 1, 2 or 5 times a power of ten, about six of them. */
static struct axis round_axis(double low, double high)
{
  if (!(high > low)) {
    double middle = isfinite(low) ? low : 0, half = middle != 0 ? 0.5 * fabs(middle) : 1;
    low = middle - half;
    high = middle + half;
  }
  double raw = (high - low) / 6, power = pow(10, floor(log10(raw))), lead = raw / power;
  double step = power * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10);
  return (struct axis){step * floor(low / step + 1e-9), step * ceil(high / step - 1e-9), step};
}

static void widen(double value, double *low, double *high)
{
  if (!isfinite(value))
    return;
  *low = fmin(*low, value);
  *high = fmax(*high, value);
}

static struct frame find_frame(const struct eo_plot *plot, struct eo_text *text)
{
  double x[2] = {INFINITY, -INFINITY}, y[2] = {INFINITY, -INFINITY};
  for (int i = 0; i < plot->series; i++)
    for (int j = 0; j < plot->line[i].count; j++) {
      widen(plot->line[i].x[j], &x[0], &x[1]);
      widen(plot->line[i].y[j], &y[0], &y[1]);
    }
  if (plot->from_zero)
    widen(0, &y[0], &y[1]);
  struct frame frame = {.plot = plot, .x = round_axis(x[0], x[1]), .y = round_axis(y[0], y[1]), .text = text};
  if (x[1] > x[0]) { /* the x axis ends where the data do */
    frame.x.low = x[0];
    frame.x.high = x[1];
  }
  return frame;
}

static double place_x(const struct frame *frame, double x)
{
  return LEFT + (x - frame->x.low) / (frame->x.high - frame->x.low) * (WIDTH - LEFT - RIGHT);
}

static double place_y(const struct frame *frame, double y)
{
  return HEIGHT - BOTTOM - (y - frame->y.low) / (frame->y.high - frame->y.low) * (HEIGHT - TOP - BOTTOM);
}

static void draw_grid(const struct frame *frame)
{
  struct eo_text *text = frame->text;
  for (double x = frame->x.step * ceil(frame->x.low / frame->x.step - 1e-9); x <= frame->x.high + 1e-9 * frame->x.step;
       x += frame->x.step) {
    double at = place_x(frame, x);
    eo_text_print(text, "<line class=\"grid\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#ddd\"/>", at, at,
                  TOP, HEIGHT - BOTTOM);
    eo_text_print(text, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.6g</text>\n", at, HEIGHT - BOTTOM + 16,
                  fabs(x) < 1e-9 * frame->x.step ? 0 : x);
  }
  for (double y = frame->y.low; y <= frame->y.high + 1e-9 * frame->y.step; y += frame->y.step) {
    double at = place_y(frame, y);
    eo_text_print(text, "<line class=\"grid\" x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>", LEFT,
                  WIDTH - RIGHT, at, at);
    eo_text_print(text, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.6g</text>\n", LEFT - 6, at + 4,
                  fabs(y) < 1e-9 * frame->y.step ? 0 : y);
  }
}

static void draw_labels(const struct frame *frame)
{
  struct eo_text *text = frame->text;
  eo_text_print(text, "<text class=\"title\" x=\"%d\" y=\"18\" font-weight=\"bold\">", LEFT);
  eo_text_add_escaped(text, frame->plot->title);
  eo_text_print(text, "</text>\n<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">", (LEFT + WIDTH - RIGHT) / 2,
                HEIGHT - BOTTOM + 32);
  eo_text_add_escaped(text, frame->plot->x_label);
  eo_text_print(text, "</text>\n<text transform=\"translate(14 %d) rotate(-90)\" text-anchor=\"middle\">",
                (TOP + HEIGHT - BOTTOM) / 2);
  eo_text_add_escaped(text, frame->plot->y_label);
  eo_text_add(text, "</text>\n");
}

static void draw_line(const struct frame *frame, const struct eo_plot_series *line, int i)
{
  bool drawing = false;
  eo_text_print(
      frame->text,
      "<path class=\"series s%d\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\" stroke-dasharray=\"%s\" d=\"", i,
      colours[i], dashes[i]);
  for (int j = 0; j < line->count; j++) {
    bool good = isfinite(line->x[j]) && isfinite(line->y[j]);
    if (good)
      eo_text_print(frame->text, "%c%.1f %.1f", drawing ? 'L' : 'M', place_x(frame, line->x[j]),
                    place_y(frame, line->y[j]));
    drawing = good;
  }
  eo_text_add(frame->text, "\"/>\n");
}

static void draw_dots(const struct frame *frame, const struct eo_plot_series *line, int i)
{
  for (int j = 0; j < line->count; j++)
    if (isfinite(line->x[j]) && isfinite(line->y[j]))
      eo_text_print(frame->text, "<circle class=\"dot s%d\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", i,
                    place_x(frame, line->x[j]), place_y(frame, line->y[j]), colours[i]);
}

/* Below the axis, in as many rows as the names need. */
static void draw_legend(const struct frame *frame)
{
  double x = LEFT;
  int y = HEIGHT - BOTTOM + 52;
  for (int i = 0; i < frame->plot->series; i++) {
    const char *name = frame->plot->line[i].name;
    double width = 34 + 6.4 * (double)strlen(name);
    if (i && x + width > WIDTH) {
      x = LEFT;
      y += 16;
    }
    if (frame->plot->line[i].dots)
      eo_text_print(frame->text, "<circle class=\"dot s%d\" cx=\"%.1f\" cy=\"%d\" r=\"4\" fill=\"%s\"/>", i, x + 10,
                    y - 4, colours[i]);
    else
      eo_text_print(frame->text,
                    "<line class=\"series s%d\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"%s\" "
                    "stroke-width=\"1.6\" stroke-dasharray=\"%s\"/>",
                    i, x, x + 20, y - 4, y - 4, colours[i], dashes[i]);
    eo_text_print(frame->text, "<text x=\"%.1f\" y=\"%d\">", x + 24, y);
    eo_text_add_escaped(frame->text, name);
    eo_text_add(frame->text, "</text>\n");
    x += width;
  }
}

void eo_plot_svg(const struct eo_plot *plot, struct eo_text *text)
{
  struct frame frame = find_frame(plot, text);
  eo_text_print(text,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n",
                WIDTH, HEIGHT);
  draw_grid(&frame);
  eo_text_print(text,
                "<rect class=\"frame\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#888\"/>\n",
                LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
  draw_labels(&frame);
  for (int i = 0; i < plot->series; i++)
    if (plot->line[i].dots)
      draw_dots(&frame, &plot->line[i], i);
    else
      draw_line(&frame, &plot->line[i], i);
  draw_legend(&frame);
  eo_text_add(text, "</svg>\n");
}
