#include "jobs/rig_work.h"

#include "document/json.h"

/* Copies the keys that are there; borrowed values. */
static void copy(json_t *to, const json_t *from, const char *const *keys)
{
  for (; *keys; keys++)
    if (json_object_get(from, *keys))
      json_object_set(to, *keys, json_object_get(from, *keys));
}

static json_t *brief_findings(const json_t *findings)
{
  static const char *const keys[] = {"kind", "severity", "text", NULL};
  json_t *list = json_array();
  json_t *finding;
  size_t i;
  json_array_foreach(findings, i, finding) {
    json_t *brief = json_object();
    copy(brief, finding, keys);
    json_array_append_new(list, brief);
  }
  return list;
}

json_t *eo_rig_summary(const json_t *document)
{
  static const char *const outer[] = {"file", "label", "torque_Nm", "end", "refused", NULL};
  static const char *const inner[] = {"rows", "seconds", "turns", "speed_rpm", "harmonics", "rms_m_per_s2", "mesh", "residual_um", NULL};
  static const char *const te[] = {"peak_to_peak_um", NULL};
  const json_t *from = json_object_get(document, "result");
  json_t *summary = json_object(), *result = json_object(), *curve = json_object();
  bool failed = false;
  copy(summary, document, outer);
  copy(result, from, inner);
  copy(curve, json_object_get(from, "te"), te);
  eo_json_put(result, "te", curve, &failed);
  eo_json_put(summary, "findings", brief_findings(json_object_get(document, "findings")), &failed);
  eo_json_put(summary, "result", result, &failed);
  return failed ? (json_decref(summary), NULL) : summary;
}

void eo_rig_pair_hash(const struct eo_geometry *geometry, char key[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  for (int i = 0; i < 2; i++) {
    eo_hash_add_number(&hash, "teeth", geometry->teeth[i]);
    eo_hash_add_number(&hash, "base radius", geometry->base_radius[i]);
  }
  eo_hash_finish(&hash, key);
}
