/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/answers.h"

#include "format/form.h"

static const char *const states[] = {"ok", "failing", NULL};

#define OF_HEALTH(member) EO_AT(struct eo_health, member)
static const struct eo_outline_row jobs_rows[] = {
    EO_KEY("queued", "integer", "jobs that wait", EO_AT(struct eo_queue_length, queued)),
    EO_KEY("running", "integer", "jobs that are being worked on", EO_AT(struct eo_queue_length, running)),
};
static const struct eo_outline jobs_outline = EO_OUTLINE("HealthJobs", jobs_rows);

static const struct eo_outline_row health_rows[] = {
    EO_KEY("status", "word", "of all", .words = states, OF_HEALTH(failing)),
    EO_KEY("program", "text", "name and version", OF_HEALTH(program)),
    EO_KEY("uptime_s", "number", "since the start, s", OF_HEALTH(uptime)),
    EO_KEY("jobs", "object", "by state", .outline = &jobs_outline, OF_HEALTH(jobs)),
    EO_KEY("database", "word", "whether it can be read and written", .words = eo_storage_states, OF_HEALTH(database)),
    EO_KEY("free_MB", "number", "that its disk has left", OF_HEALTH(free_megabytes)),
    EO_KEY("warnings", "[text]", "what the start found", OF_HEALTH(warnings)),
};
const struct eo_outline eo_outline_health = EO_OUTLINE("Health", health_rows);

static const struct eo_outline_row live_rows[] = {
    EO_KEY("status", "word", "that it answers", .words = states, OF_HEALTH(failing)),
    EO_KEY("program", "text", "name and version", OF_HEALTH(program)),
    EO_KEY("uptime_s", "number", "since the start, s", OF_HEALTH(uptime)),
};
const struct eo_outline eo_outline_live = EO_OUTLINE("Live", live_rows);

static const struct eo_outline_row example_rows[] = {
    EO_KEY("name", "text", "in its address", EO_AT(struct eo_example, name)),
    EO_KEY("title", "text", "for people", EO_AT(struct eo_example, summary)),
};
const struct eo_outline eo_outline_example = EO_OUTLINE("Example", example_rows);
static const struct eo_outline_row examples_rows[] = {
    EO_KEY("items", "[object]", "designs to start from", .outline = &eo_outline_example,
           EO_AT(struct eo_listed_examples, items)),
};
const struct eo_outline eo_outline_examples = EO_OUTLINE("Examples", examples_rows);

static const struct eo_outline_row form_rows[] = {
    EO_KEY("design", "object", "of a design", .outline = &eo_fields_outline, EO_AT(struct eo_form, design)),
    EO_KEY("sweep", "object", "of a sweep", .outline = &eo_fields_outline, EO_AT(struct eo_form, sweep)),
    EO_KEY("fit", "object", "of an order of a fit", .outline = &eo_fields_outline, EO_AT(struct eo_form, fit)),
};
const struct eo_outline eo_outline_form = EO_OUTLINE("Form", form_rows);
