/* The settings in which two runs differ: capture, device, preset, passes and their parameters. */
#include "diff/diff.h"
#include "report/report.h"

static void add_setting(json_t *list, const char *what, const json_t *a, const json_t *b) {
    json_t *json = json_object();
    json_object_set_new(json, "what", json_string(what));
    json_object_set_new(json, "a", a ? json_deep_copy(a) : json_null());
    json_object_set_new(json, "b", b ? json_deep_copy(b) : json_null());
    json_array_append_new(list, json);
}

static void compare(json_t *list, const char *what, const json_t *a, const json_t *b) {
    if ((a || b) && !(a && b && json_equal(a, b))) add_setting(list, what, a, b);
}

/* Compares the parameters of one pass. Those of different variants are unrelated. */
static void compare_pass(json_t *list, const char *slot, const json_t *a, const json_t *b) {
    static const char *const facts[] = {"variant", "ran", "shader"};
    char what[256];
    const char *name;
    json_t *value;
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++) {
        snprintf(what, sizeof what, "%.100s: %s", slot, facts[i]);
        compare(list, what, json_object_get(a, facts[i]), json_object_get(b, facts[i]));
    }
    if (!a || !b || !json_equal(json_object_get(a, "variant"), json_object_get(b, "variant"))) return;
    json_object_foreach(json_object_get(a, "parameters"), name, value) {
        snprintf(what, sizeof what, "%.100s.%.100s", slot, name);
        compare(list, what, value, json_object_get(json_object_get(b, "parameters"), name));
    }
}

json_t *diff_settings(const json_t *a, const json_t *b) {
    static const char *const facts[] = {"preset",    "diagnostics", "frame",   "rays",           "first_ray",
                                        "precision", "inputs",      "history", "active_cubemaps"};
    static const char *const inner[][2] = {{"capture", "xxh3_128"},
                                           {"tool", "version"},
                                           {"device", "name"},
                                           {"device", "driver"},
                                           {"device", "driver_version"}};
    json_t *list = json_array(), *pass;
    size_t i;
    for (i = 0; i < sizeof inner / sizeof *inner; i++) {
        char what[64];
        snprintf(what, sizeof what, "%s %s", inner[i][0], inner[i][1]);
        compare(list, what, json_object_get(json_object_get(a, inner[i][0]), inner[i][1]),
                json_object_get(json_object_get(b, inner[i][0]), inner[i][1]));
    }
    for (i = 0; i < sizeof facts / sizeof *facts; i++)
        compare(list, facts[i], json_object_get(a, facts[i]), json_object_get(b, facts[i]));
    for (int side = 0; side < 2; side++) json_array_foreach(json_object_get(side ? b : a, "passes"), i, pass) {
            const char *slot = json_string_value(json_object_get(pass, "slot"));
            if (!slot || (side && report_pass(a, slot))) continue;
            compare_pass(list, slot, side ? NULL : pass, side ? pass : report_pass(b, slot));
        }
    return list;
}
