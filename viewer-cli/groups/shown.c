/* Figures over captures in tables, JSON and pages. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "draw/page/page.h"
#include "groups/groups.h"
#include "options/capture_set.h"

static const char *name_of(const struct capture_group *group) {
    return group->tag ? group->tag : "all";
}

void group_cells(struct table *table, const struct capture_group *group) {
    table_cell(table, "%s", name_of(group));
    table_cell(table, "%zu", group->captures);
    table_cell(table, "%zu", group->shots);
}

json_t *group_page_table(json_t *blocks) {
    static const char *const titles[] = {"captures", "number", "shots"};
    json_t *table = page_table(blocks);
    for (size_t i = 0; i < sizeof titles / sizeof *titles; i++) page_column(table, titles[i], "");
    return table;
}

json_t *group_page_row(const struct capture_group *group) {
    return json_pack("[s, I, I]", name_of(group), (json_int_t)group->captures, (json_int_t)group->shots);
}

json_t *group_json(const struct capture_group *group) {
    return json_pack("{s:s?, s:I, s:I}", "tag", group->tag, "captures", (json_int_t)group->captures, "shots",
                     (json_int_t)group->shots);
}

void figure_cell(struct table *table, const struct glint_figure *figure) {
    if (isnan(figure->value)) table_cell(table, "–");
    else if (isnan(figure->low)) table_cell(table, "%.4f", figure->value);
    else table_cell(table, "%.4f (%.4f to %.4f)", figure->value, figure->low, figure->high);
}

void difference_cell(struct table *table, const struct glint_figure *d) {
    if (isnan(d->value)) table_cell(table, "–");
    else if (isnan(d->low)) table_cell(table, "%+.4f", d->value);
    else table_cell(table, "%+.4f (%+.4f to %+.4f)", d->value, d->low, d->high);
}

json_t *figure_json(const struct glint_figure *figure) {
    return json_pack("{s:o, s:o, s:o}", "value", json_number(figure->value), "low", json_number(figure->low), "high",
                     json_number(figure->high));
}

json_t *figure_page_cell(const struct glint_figure *figure, double factor) {
    return isnan(figure->value) ? json_null()
                                : page_interval(factor * figure->value, factor * figure->low, factor * figure->high);
}

char *capture_tags_text(const struct list *captures, size_t capture) {
    const json_t *tags = capture_set_tags(captures, capture);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (size_t i = 0; out && i < json_array_size(tags); i++)
        fprintf(out, "%s%s", i ? ", " : "", json_string_value(json_array_get(tags, i)));
    if (out) fclose(out);
    return text;
}
