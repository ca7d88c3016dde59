/* Prints the records of a pixel, pass by pass. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "probe/probe.h"
#include "io/table.h"

enum { TEXT = 160 };

/* Steps are printed as tables, one for each kind; single records as a line. */
static bool is_step(const struct glint_probe_row *kind) {
    const size_t count = glint_probe_count(kind);
    for (size_t i = 0; i < count; i++)
        if (strcmp(kind[1 + i].unit, "decision") == 0 || strcmp(kind[1 + i].name, "weight") == 0) return true;
    return false;
}

/* Whether the records have ray and surface depths, whose difference is printed as a column of its own. */
static bool has_gap(const struct glint_probe_row *kind) {
    bool ray = false, surface = false;
    for (size_t i = 0; i < glint_probe_count(kind); i++) {
        ray |= strcmp(kind[1 + i].name, "ray_m") == 0;
        surface |= strcmp(kind[1 + i].name, "surface_m") == 0;
    }
    return ray && surface;
}

/* `first`: number of preceding steps of the pass. */
static void print_steps(FILE *out, const struct probe_side *side, const struct glint_probe_record *records,
                        size_t count, size_t first) {
    struct probe_group groups[GLINT_PROBE_VALUES];
    const size_t columns = probe_groups(records->kind, groups);
    char titles[GLINT_PROBE_VALUES + 3][48];
    const char *list[GLINT_PROBE_VALUES + 3] = {NULL};
    size_t used = 0;
    const bool gap = has_gap(records->kind);
    snprintf(titles[used++], sizeof titles[0], ">   step");
    for (size_t g = 0; g < columns; g++) {
        const char *unit = groups[g].unit;
        const bool metres = strcmp(unit, "m") == 0 || strcmp(unit, "1/m") == 0;
        const bool word = strcmp(unit, "decision") == 0;
        if (gap && word) snprintf(titles[used++], sizeof titles[0], ">behind m");
        snprintf(titles[used++], sizeof titles[0], "%c%s%s%s", word ? '<' : '>', groups[g].name, metres ? " " : "",
                 metres ? unit : "");
    }
    for (size_t i = 0; i < used; i++) list[i] = titles[i];
    struct table *table = table_create(list);
    for (size_t r = 0; r < count; r++) {
        const struct glint_probe_record *record = &records[r];
        table_cell(table, "%zu", first + r + 1);
        for (size_t g = 0; g < columns; g++) {
            char text[TEXT];
            const double behind =
                (double)glint_probe_value(record, "ray_m") - (double)glint_probe_value(record, "surface_m");
            if (gap && strcmp(groups[g].unit, "decision") == 0) table_cell(table, "%s", number_text(behind));
            probe_group_text(side, record, &groups[g], text, sizeof text);
            table_cell(table, "%s", text);
        }
    }
    table_print(table, out);
    table_destroy(&table);
}

/* Cube maps are not traced if the ray already ended on screen: PREFIXcubemap_trace continues the rays of PREFIXscreen_trace. */
static bool ended_on_screen(const struct probe_side *side, const struct glint_probe_record *record) {
    if (!glint_probe_is(record, "cubemap_end")) return false;
    const char *slot = record->pass->slot, *name = strstr(slot, "cubemap_trace");
    const size_t prefix = name ? (size_t)(name - slot) : 0;
    for (size_t i = 0; i < side->trace.count; i++) {
        const struct glint_probe_record *screen = &side->trace.records[i];
        if (glint_probe_is(screen, "screen_end") && screen->ray == record->ray &&
            strncmp(screen->pass->slot, slot, prefix) == 0 && strcmp(screen->pass->slot + prefix, "screen_trace") == 0)
            return glint_probe_value(screen, "finished") > 0;
    }
    return false;
}

/* Records of cube maps have no screen position, and records of the screen no cube map: empty fields are not printed. */
static bool is_void(const struct glint_probe_record *record, const struct probe_group *group, const char *text) {
    if (!glint_probe_is(record, "color")) return false;
    return strcmp(group->unit, "px") == 0 ? strcmp(text, "0.0,0.0") == 0
                                          : strcmp(group->unit, "index") == 0 && strcmp(text, "none") == 0;
}

static void print_once(FILE *out, const struct probe_side *side, const struct glint_probe_record *record) {
    struct probe_group groups[GLINT_PROBE_VALUES];
    const size_t count = probe_groups(record->kind, groups);
    for (size_t g = 0; g < count; g++) {
        char text[TEXT];
        const char *unit = groups[g].unit;
        const bool shown = strcmp(unit, "m") == 0 || strcmp(unit, "px") == 0 || strcmp(unit, "radiance") == 0;
        probe_group_text(side, record, &groups[g], text, sizeof text);
        if (!is_void(record, &groups[g], text))
            fprintf(out, "%s%s%s %s%s%s", g ? ", " : "    ", groups[g].name, strcmp(unit, "end reason") ? "" : ":",
                    text, shown ? " " : "", shown ? unit : "");
    }
    fputc('\n', out);
}

static void print_records(FILE *out, const struct probe_side *side, const struct glint_pass *pass) {
    const struct glint_probe_record *records = side->trace.records, *before = NULL;
    size_t steps = 0;
    for (size_t i = 0, end; i < side->trace.count; i = end) {
        end = i + 1;
        if (records[i].pass != pass) continue;
        if (before ? before->ray != records[i].ray : records[i].ray > 0)
            fprintf(out, "  ray %u\n", records[i].ray), steps = 0;
        before = &records[i];
        const bool step = is_step(records[i].kind);
        while (step && end < side->trace.count && records[end].pass == pass && records[end].kind == records[i].kind &&
               records[end].ray == records[i].ray)
            end++;
        fprintf(out, "  %s%s\n", records[i].kind->text, step ? ":" : "");
        if (ended_on_screen(side, &records[i])) fprintf(out, "    not traced: the ray ended on screen\n");
        else if (step) print_steps(out, side, &records[i], end - i, steps);
        else print_once(out, side, &records[i]);
        steps = step ? steps + end - i : 0;
    }
}

static void print_value(FILE *out, const struct probe_value *value) {
    fprintf(out, "  %-28s", value->row->name);
    const struct glint_probe_label word = glint_probe_label(value->row->unit, (float)value->values[0]);
    if (word.text) fprintf(out, "  %s", word.text);
    const char *channel = value->row->kind == GLINT_ROW_CAPTURE ? value->row->source : value->row->channels;
    for (uint32_t c = 0; c < value->count && !word.text; c++) {
        const size_t length = strcspn(channel, " "), part = strcspn(channel, ".") + 1;
        const size_t from = part < length ? part : 0; /* "normal.X" is X */
        if (length != 1 || channel[0] != '-')
            fprintf(out, "  %.*s%s%s", value->count > 1 ? (int)(length - from) : 0, channel + from,
                    value->count > 1 ? " " : "", number_text(value->values[c]));
        channel += length + (channel[length] == ' ');
    }
    const bool unit = !word.text && strcmp(value->row->unit, "1") != 0;
    fprintf(out, "%s%s\n", unit ? " " : "", unit ? value->row->unit : "");
}

static bool has_records(const struct probe_side *side, const struct glint_pass *pass) {
    for (size_t i = 0; i < side->trace.count; i++)
        if (side->trace.records[i].pass == pass) return true;
    for (size_t i = 0; i < side->value_count; i++)
        if (side->values[i].pass == pass) return true;
    return false;
}

static void print_side(FILE *out, const struct probe_side *side) {
    fprintf(out, "\ncapture  G-buffer at the pixel\n");
    for (size_t i = 0; i < side->value_count; i++)
        if (!side->values[i].pass) print_value(out, &side->values[i]);
    for (size_t p = 0; p < side->pass_count; p++) {
        const struct glint_pass *pass = side->passes[p].pass;
        if (!side->passes[p].shown || !has_records(side, pass)) continue;
        fprintf(out, "\n%s/%s  %s\n", pass->slot, pass->variant, pass->title);
        print_records(out, side, pass);
        for (size_t i = 0; i < side->value_count; i++)
            if (side->values[i].pass == pass) print_value(out, &side->values[i]);
    }
}

/* ---- Comparison with the reference ---- */

static const char *ending_text(const struct probe_side *side, const char *slot, const char *kind, char *text,
                               size_t size) {
    const struct glint_probe_record *end = probe_last(side, slot, kind);
    if (!end || ended_on_screen(side, end)) return "–";
    const struct glint_probe_label why = glint_probe_label("end reason", glint_probe_value(end, "end"));
    const double place = (double)glint_probe_value(end, "cubemap_index");
    const bool mapped = place >= 0 && place < side->cubemap_count;
    snprintf(text, size, "%s m, %s%s%s", number_text((double)glint_probe_value(end, "travelled_m")),
             why.text ? why.text : "?", mapped ? ", " : "", mapped ? probe_cubemap(side, place) : "");
    return text;
}

static const char *color_text(const struct probe_side *side, const char *name, char *text, size_t size) {
    const struct probe_value *value = NULL;
    for (size_t i = 0; i < side->value_count; i++)
        if (side->values[i].pass && strcmp(side->values[i].row->name, name) == 0) value = &side->values[i];
    if (!value || value->count < 3) return "–";
    snprintf(text, size, "%s %s %s", number_text(value->values[0]), number_text(value->values[1]),
             number_text(value->values[2]));
    return text;
}

static void print_reference(FILE *out, const struct probe *probe) {
    static const char *const titles[] = {"<", "<this pipeline", "<reference: screen_trace/dda, cubemap_trace/exact",
                                         NULL};
    static const char *const colors[] = {"reflection_half", "reflection", "composed", NULL};
    const struct probe_side *sides[] = {&probe->own, &probe->reference};
    char text[2 * TEXT];
    struct table *table = table_create(titles);
    for (int row = 0; row < 2; row++) {
        table_cell(table, row ? "in the cube maps" : "on screen");
        for (int s = 0; s < 2; s++)
            table_cell(table, "%s",
                       ending_text(sides[s], row ? "cubemap_trace" : "screen_trace", row ? "cubemap_end" : "screen_end",
                                   text, sizeof text));
    }
    for (size_t i = 0; colors[i]; i++) {
        table_cell(table, "%s", colors[i]);
        for (int s = 0; s < 2; s++) table_cell(table, "%s", color_text(sides[s], colors[i], text, sizeof text));
    }
    fputc('\n', out);
    table_print(table, out);
    table_destroy(&table);
}

void probe_print(FILE *out, const struct probe *probe) {
    fprintf(out, "%s, pixel %u,%u of %u x %u, texel %u,%u of %u x %u, preset %s on %s\n", name_text(probe->capture),
            probe->pixel[0], probe->pixel[1], probe->full[0], probe->full[1], probe->texel[0], probe->texel[1],
            probe->half[0], probe->half[1], name_text(probe->preset), name_text(probe->device));
    const struct glint_probe_record *ray = probe_last(&probe->own, "screen_trace", "screen_ray");
    if (ray) {
        const double x = floor((double)glint_probe_value(ray, "start_x")),
                     y = floor((double)glint_probe_value(ray, "start_y"));
        if (x != probe->pixel[0] || y != probe->pixel[1])
            fprintf(out, "The texel's ray was sampled for pixel %.0f,%.0f of the block.\n", x, y);
    } else if (!probe_last(&probe->own, "cubemap_trace", "cubemap_ray"))
        fprintf(out,
                "The texel has no ray: it is sky, a surface without reflection, or one that the pipeline leaves to a "
                "coarser level.\n");
    print_side(out, &probe->own);
    if (probe->own.trace.dropped)
        fprintf(out, "\n%zu further steps exceeded the recording buffer.\n", probe->own.trace.dropped);
    if (probe->has_reference) print_reference(out, probe);
}
