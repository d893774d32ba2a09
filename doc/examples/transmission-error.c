/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gear in, its loaded transmission error out: transmission-error [DESIGN.json]
   cc transmission-error.c $(pkg-config --cflags --libs easeoff) -o transmission-error */
#include <easeoff.h>
#include <stdio.h>
#include <stdlib.h>

static const char own_gear[] = "{\"gear_pair\": {\"pinion_teeth\": 23, \"gear_teeth\": 61, \"normal_module_mm\": 5,"
                               " \"helix_angle_deg\": 28, \"face_width_mm\": 70},"
                               " \"load_cases\": [{\"torque_Nm\": 600, \"speed_rpm\": 1500}]}";

static char *read_file(const char *path)
{
  static char text[1 << 20];
  FILE *file = fopen(path, "r");
  size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
  if (file)
    fclose(file);
  return size ? text : NULL;
}

int main(int argc, char **argv)
{
  const char *design = argc > 1 ? read_file(argv[1]) : own_gear;
  struct easeoff *gear;
  struct easeoff_error error;
  if (!design || easeoff_new(&gear, design, NULL, &error)) {
    fprintf(stderr, "%s: %s\n", design ? error.pointer : argv[1], design ? error.text : "cannot be read");
    return 1;
  }
  for (int k = 0; k < easeoff_cases(gear); k++) {
    struct easeoff_case c = easeoff_case(gear, k);
    printf("# %g N m: %.4f um peak to peak, %.3g m/s2\n", c.torque, 1e6 * c.peak_to_peak, c.vibration);
    for (int j = 0; j < c.positions; j++)
      printf("%.4f %.5f\n", (double)j / c.positions, 1e6 * c.transmission_error[j]);
  }
  easeoff_free(gear);
  return 0;
}
