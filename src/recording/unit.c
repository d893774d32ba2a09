#include "recording/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295 /* rad */
#define TURN 6.283185307179586      /* rad */

static const struct {
  const char *text;
  enum eo_quantity quantity;
  double factor;
} units[] = {
    {"s", EO_QUANTITY_TIME, 1},
    {"sec", EO_QUANTITY_TIME, 1},
    {"second", EO_QUANTITY_TIME, 1},
    {"seconds", EO_QUANTITY_TIME, 1},
    {"sek", EO_QUANTITY_TIME, 1},
    {"ms", EO_QUANTITY_TIME, 1e-3},
    {"msec", EO_QUANTITY_TIME, 1e-3},
    {"us", EO_QUANTITY_TIME, 1e-6},
    {"usec", EO_QUANTITY_TIME, 1e-6},
    {"\xc2\xb5s", EO_QUANTITY_TIME, 1e-6},
    {"\xce\xbcs", EO_QUANTITY_TIME, 1e-6},
    {"\xb5s", EO_QUANTITY_TIME, 1e-6},
    {"ns", EO_QUANTITY_TIME, 1e-9},
    {"min", EO_QUANTITY_TIME, 60},
    {"deg", EO_QUANTITY_ANGLE, DEGREE},
    {"degree", EO_QUANTITY_ANGLE, DEGREE},
    {"degrees", EO_QUANTITY_ANGLE, DEGREE},
    {"grad", EO_QUANTITY_ANGLE, DEGREE}, /* what German rigs call degrees */
    {"\xc2\xb0", EO_QUANTITY_ANGLE, DEGREE},
    {"\xb0", EO_QUANTITY_ANGLE, DEGREE},
    {"rad", EO_QUANTITY_ANGLE, 1},
    {"radian", EO_QUANTITY_ANGLE, 1},
    {"radians", EO_QUANTITY_ANGLE, 1},
    {"mrad", EO_QUANTITY_ANGLE, 1e-3},
    {"urad", EO_QUANTITY_ANGLE, 1e-6},
    {"mdeg", EO_QUANTITY_ANGLE, DEGREE * 1e-3},
    {"arcsec", EO_QUANTITY_ANGLE, DEGREE / 3600},
    {"arcmin", EO_QUANTITY_ANGLE, DEGREE / 60},
    {"rev", EO_QUANTITY_ANGLE, TURN},
    {"revs", EO_QUANTITY_ANGLE, TURN},
    {"turn", EO_QUANTITY_ANGLE, TURN},
    {"turns", EO_QUANTITY_ANGLE, TURN},
    {"count", EO_QUANTITY_COUNT, 1},
    {"counts", EO_QUANTITY_COUNT, 1},
    {"cnt", EO_QUANTITY_COUNT, 1},
    {"cts", EO_QUANTITY_COUNT, 1},
    {"inc", EO_QUANTITY_COUNT, 1},
    {"incs", EO_QUANTITY_COUNT, 1},
    {"increments", EO_QUANTITY_COUNT, 1},
    {"inkr", EO_QUANTITY_COUNT, 1},
    {"ticks", EO_QUANTITY_COUNT, 1},
    {"pulses", EO_QUANTITY_COUNT, 1},
    {"lsb", EO_QUANTITY_COUNT, 1},
    {"adc", EO_QUANTITY_COUNT, 1},
    {"digits", EO_QUANTITY_COUNT, 1},
    {"v", EO_QUANTITY_VOLTAGE, 1},
    {"volt", EO_QUANTITY_VOLTAGE, 1},
    {"volts", EO_QUANTITY_VOLTAGE, 1},
    {"mv", EO_QUANTITY_VOLTAGE, 1e-3},
    {"ua", EO_QUANTITY_CURRENT, 1e-6},
    {"\xc2\xb5"
     "a",
     EO_QUANTITY_CURRENT, 1e-6},
    {"\xb5"
     "a",
     EO_QUANTITY_CURRENT, 1e-6},
    {"ma", EO_QUANTITY_CURRENT, 1e-3},
    {"a", EO_QUANTITY_CURRENT, 1},
    {"rpm", EO_QUANTITY_OTHER, 1},
    {"1/min", EO_QUANTITY_OTHER, 1},
    {"min-1", EO_QUANTITY_OTHER, 1},
    {"hz", EO_QUANTITY_OTHER, 1},
    {"khz", EO_QUANTITY_OTHER, 1},
    {"nm", EO_QUANTITY_OTHER, 1},
    {"n", EO_QUANTITY_OTHER, 1},
    {"n*m", EO_QUANTITY_OTHER, 1},
    {"n.m", EO_QUANTITY_OTHER, 1},
    {"n\xc2\xb7m", EO_QUANTITY_OTHER, 1},
    {"kn", EO_QUANTITY_OTHER, 1},
    {"knm", EO_QUANTITY_OTHER, 1},
    {"g", EO_QUANTITY_OTHER, 1},
    {"m/s2", EO_QUANTITY_OTHER, 1},
    {"m/s^2", EO_QUANTITY_OTHER, 1},
    {"m/s\xc2\xb2", EO_QUANTITY_OTHER, 1},
    {"m/s", EO_QUANTITY_OTHER, 1},
    {"rad/s", EO_QUANTITY_OTHER, 1},
    {"deg/s", EO_QUANTITY_OTHER, 1},
    {"m", EO_QUANTITY_OTHER, 1},
    {"mm", EO_QUANTITY_OTHER, 1},
    {"um", EO_QUANTITY_OTHER, 1},
    {"\xc2\xb5m", EO_QUANTITY_OTHER, 1},
    {"\xb5m", EO_QUANTITY_OTHER, 1},
    {"c", EO_QUANTITY_OTHER, 1},
    {"\xc2\xb0"
     "c",
     EO_QUANTITY_OTHER, 1},
    {"\xb0"
     "c",
     EO_QUANTITY_OTHER, 1},
    {"degc", EO_QUANTITY_OTHER, 1},
    {"bar", EO_QUANTITY_OTHER, 1},
    {"pa", EO_QUANTITY_OTHER, 1},
    {"%", EO_QUANTITY_OTHER, 1},
    {"1", EO_QUANTITY_OTHER, 1},
};

static bool opens(char c)
{
  return c == '[' || c == '(' || c == '{' || c == '<';
}

static bool closes(char c)
{
  return c == ']' || c == ')' || c == '}' || c == '>';
}

enum eo_quantity eo_unit_find(const char *text, double *factor)
{
  char unit[32];
  size_t length = strlen(text);
  while (length && text[length - 1] == ' ')
    length--;
  while (length && *text == ' ')
    text++, length--;
  if (length >= 2 && opens(text[0]) && closes(text[length - 1]))
    text++, length -= 2;
  *factor = 1;
  if (!length || length >= sizeof unit)
    return EO_QUANTITY_NONE;
  memcpy(unit, text, length);
  unit[length] = '\0';
  for (size_t i = 0; i < sizeof units / sizeof *units; i++)
    if (!strcasecmp(unit, units[i].text) && strcmp(unit, "S")) {
      *factor = units[i].factor;
      return units[i].quantity;
    }
  return EO_QUANTITY_NONE;
}

static void copy_part(char *to, int size, const char *from, size_t length)
{
  while (length && *from == ' ')
    from++, length--;
  while (length && from[length - 1] == ' ')
    length--;
  snprintf(to, (size_t)size, "%.*s", (int)length, from);
}

void eo_unit_split(const char *label, char *name, int name_size, char *unit, int unit_size)
{
  size_t length = strlen(label);
  while (length && label[length - 1] == ' ')
    length--;
  *unit = '\0';
  if (length > 2 && closes(label[length - 1])) {
    size_t open = length - 1;
    while (open > 0 && !opens(label[open]))
      open--;
    if (open > 0) {
      copy_part(name, name_size, label, open);
      copy_part(unit, unit_size, label + open + 1, length - open - 2);
      return;
    }
  }
  /* The last part after a slash, an underscore or a blank, when it is a unit. */
  for (size_t i = length; i-- > 1;) {
    if (label[i] != '_' && label[i] != ' ' && label[i] != '/')
      continue;
    char last[32];
    double factor;
    copy_part(last, (int)sizeof last, label + i + 1, length - i - 1);
    enum eo_quantity quantity = eo_unit_find(last, &factor);
    if (quantity == EO_QUANTITY_NONE || (strlen(last) == 1 && strchr("1cmgna", last[0])))
      break;
    copy_part(unit, unit_size, last, strlen(last));
    while (i > 1 && (label[i - 1] == ' ' || label[i - 1] == '_' || label[i - 1] == '/'))
      i--;
    copy_part(name, name_size, label, i);
    return;
  }
  copy_part(name, name_size, label, length);
}
