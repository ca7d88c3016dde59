/* What is said of the cases. */
#include <stdio.h>

#include <jansson.h>

#include "args.h"
#include "table.h"
#include "chosen.h"

static const char *unit_of(const struct selftest_case *c) {
    return c->bound > 0 ? c->unit : "exact";
}

/* ---- Tables ---- */

static void list_row(void *user, const struct chosen_group *group, const struct selftest_case *c,
                     const struct selftest_finding *finding) {
    (void)group, (void)finding;
    table_cell(user, "%s", c->name);
    table_cell(user, "%s", number_text(c->bound));
    table_cell(user, "%s", unit_of(c));
    table_cell(user, "%s: %s", c->what, c->reason);
}

static void result_row(void *user, const struct chosen_group *group, const struct selftest_case *c,
                       const struct selftest_finding *finding) {
    (void)group;
    table_cell(user, "%s", c->name);
    table_cell(user, "%s", number_text(finding->worst));
    table_cell(user, "%s", number_text(c->bound));
    table_cell(user, "%s", unit_of(c));
    table_cell(user, "%s", chosen_passes(c, finding) ? "pass" : "FAIL");
    table_cell(user, finding->ties ? "%zu" : "%.0zu", finding->ties);
    table_cell(user, "%s", finding->values == 0 ? "nothing was compared" : finding->worst > 0 ? finding->at : "");
}

static void print_cases(const struct chosen_group *group, bool list) {
    static const char *const listed[] = {"<case", ">bound", "<", "<what", NULL};
    static const char *const found[] = {"<case", ">worst", ">bound", "<", "<", ">ties", "<worst at", NULL};
    struct table *table = table_create(list ? listed : found);
    chosen_each(group, list ? list_row : result_row, table);
    if (!table_is_empty(table)) {
        printf("%s: %s\n\n", group->group->name, group->group->what);
        table_print(table, stdout);
        putchar('\n');
    }
    table_destroy(&table);
}

struct sum {
    size_t cases, failed, ties;
};
static void add(void *user, const struct chosen_group *group, const struct selftest_case *c,
                const struct selftest_finding *finding) {
    struct sum *sum = user;
    (void)group;
    sum->cases++;
    sum->failed += !chosen_passes(c, finding);
    sum->ties += finding->ties;
}

static void summary_row(struct table *table, const char *name, const struct sum *sum, double seconds) {
    table_cell(table, "%s", name);
    table_cell(table, "%zu", sum->cases);
    table_cell(table, "%zu", sum->failed);
    table_cell(table, "%zu", sum->ties);
    table_cell(table, "%s", time_text(seconds));
}

static void print_summary(const struct chosen *chosen, const struct glint_device_info *device, double seconds) {
    static const char *const titles[] = {"<group", ">cases", ">failed", ">ties", ">time", NULL};
    struct table *table = table_create(titles);
    struct sum all = {0};
    for (size_t g = 0; g < chosen->group_count; g++) {
        struct sum sum = {0};
        chosen_each(&chosen->groups[g], add, &sum);
        chosen_each(&chosen->groups[g], add, &all);
        if (sum.cases) summary_row(table, chosen->groups[g].group->name, &sum, chosen->groups[g].seconds);
    }
    summary_row(table, "all", &all, seconds);
    table_print(table, stdout);
    table_destroy(&table);
    printf("\n%s: %zu cases, %zu failed\n", device->name, all.cases, all.failed);
}

/* Once more, where nobody has to look for them, with what was claimed. */
static void print_failed(void *user, const struct chosen_group *group, const struct selftest_case *c,
                         const struct selftest_finding *finding) {
    (void)user;
    if (chosen_passes(c, finding)) return;
    printf("FAIL %s, %s (%s): %s %s, bound %s (%s); %s\n", group->group->name, c->name, c->what,
           number_text(finding->worst), unit_of(c), number_text(c->bound), c->reason,
           finding->values ? finding->at : "nothing was compared");
}

/* ---- JSON ---- */

struct document {
    bool list;
    json_t *cases;
};

static void add_case(void *user, const struct chosen_group *group, const struct selftest_case *c,
                     const struct selftest_finding *finding) {
    const struct document *document = user;
    json_t *object = json_pack("{s:s, s:s, s:s, s:s, s:f, s:s}", "group", group->group->name, "name", c->name, "what",
                               c->what, "unit", c->unit, "bound", c->bound, "reason", c->reason);
    if (c->source) json_object_set_new(object, "evaluated", json_string(c->source));
    if (!document->list) {
        json_object_set_new(object, "pass", json_boolean(chosen_passes(c, finding)));
        json_object_set_new(object, "worst", json_number(finding->worst)); /* null: infinite */
        json_object_set_new(object, "values", json_integer((json_int_t)finding->values));
        json_object_set_new(object, "ties", json_integer((json_int_t)finding->ties));
        if (finding->worst > 0) json_object_set_new(object, "worst_at", json_string(finding->at));
    }
    json_array_append_new(document->cases, object);
}

static enum status print_document(const struct chosen *chosen, const struct glint_device_info *device, double seconds,
                                  size_t failed) {
    const struct document document = {device == NULL, json_array()};
    json_t *json = json_object(), *groups = json_array();
    for (size_t g = 0; g < chosen->group_count; g++) {
        const struct chosen_group *group = &chosen->groups[g];
        struct sum sum = {0};
        chosen_each(group, add_case, (void *)&document);
        chosen_each(group, add, &sum);
        if (!sum.cases) continue;
        json_t *object = json_pack("{s:s, s:s, s:I}", "name", group->group->name, "what", group->group->what, "cases",
                                   (json_int_t)sum.cases);
        if (device) json_object_set_new(object, "failed", json_integer((json_int_t)sum.failed));
        if (device) json_object_set_new(object, "seconds", json_real(group->seconds));
        json_array_append_new(groups, object);
    }
    if (device) {
        json_object_set_new(json, "device", json_string(device->name));
        json_object_set_new(json, "seconds", json_real(seconds));
        json_object_set_new(json, "failed", json_integer((json_int_t)failed));
    }
    json_object_set_new(json, "groups", groups);
    json_object_set_new(json, "cases", document.cases);
    return print_json(json);
}

enum status chosen_report(const struct chosen *chosen, const struct glint_device_info *device, double seconds,
                          bool json) {
    struct sum all = {0};
    for (size_t g = 0; device && g < chosen->group_count; g++) chosen_each(&chosen->groups[g], add, &all);
    const enum status status = all.failed ? STATUS_CHECK : STATUS_DONE;
    if (json) {
        const enum status printed = print_document(chosen, device, seconds, all.failed);
        return status ? status : printed;
    }
    for (size_t g = 0; g < chosen->group_count; g++) print_cases(&chosen->groups[g], device == NULL);
    if (!device) return status;
    for (size_t g = 0; g < chosen->group_count; g++) chosen_each(&chosen->groups[g], print_failed, NULL);
    if (all.failed) putchar('\n');
    print_summary(chosen, device, seconds);
    return status;
}
