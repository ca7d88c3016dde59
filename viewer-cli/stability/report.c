/* The results of glint stability as tables and as JSON. */
#include "stability/stability.h"

#include <math.h>

#include "options/args.h"
#include "io/table.h"

/* ---- JSON ---- */

static json_t *summary_json(const struct glint_stability_summary *s) {
    return json_pack("{s:I, s:o, s:o, s:o, s:I}", "pixels", (json_int_t)s->compared, "median", json_number(s->median),
                     "p99", json_number(s->p99), "largest", json_number(s->largest), "above", (json_int_t)s->above);
}

static json_t *worst_json(const struct glint_stability_image *image) {
    json_t *list = json_array();
    for (size_t i = 0; i < image->worst_count; i++) {
        const struct glint_stability_pixel *p = &image->worst[i];
        json_t *before = json_array();
        for (uint32_t k = 0; k < image->components; k++)
            json_array_append_new(before, json_number((double)p->before[k]));
        json_array_append_new(list, json_pack("{s:i, s:i, s:o, s:o, s:o}", "x", (int)p->x, "y", (int)p->y,
                                              "amplification", json_number(p->amplification), "change",
                                              json_number(p->change), "value", before));
    }
    return list;
}

static json_t *image_json(const struct glint_stability_image *image) {
    json_t *json = json_pack("{s:s, s:s, s:i, s:i}", "name", image->name, "unit", image->row->unit, "width",
                             (int)image->width, "height", (int)image->height);
    if (!json) return NULL;
    json_object_set_new(json, "slot", image->pass ? json_string(image->pass->slot) : json_null());
    if (!image->discrete) {
        json_object_set_new(json, image->pass ? "amplification" : "change", summary_json(&image->summary));
        json_object_set_new(json, "overflow",
                            json_pack("{s:o, s:i, s:i, s:i, s:I, s:I}", "largest", json_number(image->peak), "x",
                                      (int)image->peak_x, "y", (int)image->peak_y, "component",
                                      (int)image->peak_component, "beyond", (json_int_t)image->overflowing, "invalid",
                                      (json_int_t)image->invalid));
    }
    if (image->pass) {
        json_object_set_new(json, "flipped", json_integer((json_int_t)image->flipped));
        json_object_set_new(json, "flip_share", json_number(image->flip_share));
        json_object_set_new(json, "worst", worst_json(image));
    }
    return json;
}

static json_t *pass_json(const struct glint_stability_pass *p) {
    return json_pack("{s:s, s:s, s:I, s:o, s:I, s:I, s:I, s:I}", "slot", p->pass->slot, "variant", p->pass->variant,
                     "place", (json_int_t)p->place, "amplification", summary_json(&p->summary), "starts",
                     (json_int_t)p->starts, "flipped", (json_int_t)p->flipped, "end_reasons", (json_int_t)p->ends,
                     "flip_starts", (json_int_t)p->flip_starts);
}

static json_t *invalid_json(const struct glint_stability_invalid *invalid) {
    if (!*invalid->image) return json_null();
    json_t *value = isfinite(invalid->value) ? json_real((double)invalid->value)
                    : isnan(invalid->value)  ? json_string("NaN")
                                             : json_string(invalid->value > 0 ? "inf" : "-inf");
    return json_pack("{s:s, s:s?, s:s, s:i, s:i, s:o, s:I, s:I}", "image", invalid->image, "slot",
                     invalid->pass ? invalid->pass->slot : NULL, "channel", invalid->channel, "x", (int)invalid->x, "y",
                     (int)invalid->y, "value", value, "not_finite", (json_int_t)invalid->not_finite, "clamped",
                     (json_int_t)invalid->clamped);
}

json_t *stability_json(const struct stability_report *report) {
    const struct glint_stability *s = report->stability;
    json_t *images = json_array(), *passes = json_array(), *inputs = json_array();
    for (size_t i = 0; i < s->image_count; i++) json_array_append_new(images, image_json(&s->images[i]));
    for (size_t i = 0; i < s->pass_count; i++) json_array_append_new(passes, pass_json(&s->passes[i]));
    for (size_t i = 0; report->inputs && report->inputs[i]; i++)
        json_array_append_new(inputs, json_string(report->inputs[i]));
    json_t *invalid = json_pack("{s:o, s:o}", "captured", invalid_json(&s->captured), "made", invalid_json(&s->made));
    return json_pack("{s:s, s:s, s:s, s:s, s:I, s:o, s:s, s:o, s:o, s:o, s:o}", "effect", report->effect->name,
                     "capture", report->capture, "preset", report->preset, "device", report->device, "seeds",
                     (json_int_t)s->seeds, "perturbed", inputs, "precision", report->half ? "half" : "float", "bound",
                     json_number(s->bound), "passes", passes, "images", images, "first_invalid", invalid);
}

/* ---- Tables ---- */

static void print_inputs(const struct glint_stability *s) {
    static const char *const titles[] = {"<input", ">median change", ">99 %", ">largest", NULL};
    struct table *t = table_create(titles);
    for (size_t i = 0; i < s->image_count; i++) {
        const struct glint_stability_image *image = &s->images[i];
        if (image->pass) continue;
        table_cell(t, "%s", image->name);
        table_cell(t, "%.2g", image->summary.median);
        table_cell(t, "%.2g", image->summary.p99);
        table_cell(t, "%.2g", image->summary.largest);
    }
    table_print(t, stdout);
    table_destroy(&t);
}

static void cell_count(struct table *t, uint64_t count) {
    if (count) table_cell(t, "%llu", (unsigned long long)count);
    else table_cell(t, "%s", "–");
}

static void print_passes(const struct glint_stability *s) {
    static const char *const titles[] = {">",      "<pass",        ">median", ">99 %",       ">largest",
                                         ">above", ">first above", ">flips",  ">end reason", ">first flip",
                                         NULL};
    struct table *t = table_create(titles);
    for (size_t i = 0; i < s->pass_count; i++) {
        const struct glint_stability_pass *p = &s->passes[i];
        table_cell(t, "%zu", p->place);
        table_cell(t, "%s/%s", p->pass->slot, p->pass->variant);
        table_cell(t, "%s", number_text(p->summary.median));
        table_cell(t, "%s", number_text(p->summary.p99));
        table_cell(t, "%s", number_text(p->summary.largest));
        cell_count(t, p->summary.above);
        cell_count(t, p->starts);
        cell_count(t, p->flipped);
        cell_count(t, p->ends);
        cell_count(t, p->flip_starts);
    }
    table_print(t, stdout);
    table_destroy(&t);
}

static void print_worst(const struct glint_stability *s) {
    static const char *const titles[] = {"<image", ">x,y", "<of", ">amplification", ">relative change", ">value", NULL};
    struct table *t = table_create(titles);
    for (size_t i = 0; i < s->image_count; i++) {
        const struct glint_stability_image *image = &s->images[i];
        for (size_t k = 0; image->per_pixel && k < image->worst_count && k < 2; k++) {
            const struct glint_stability_pixel *p = &image->worst[k];
            table_cell(t, "%s", k ? "" : image->name);
            table_cell(t, "%u,%u", p->x, p->y);
            table_cell(t, "%ux%u", image->width, image->height);
            table_cell(t, "%s", number_text(p->amplification));
            table_cell(t, "%s", number_text(p->change));
            table_cell(t, "%s", number_text((double)p->before[0]));
        }
    }
    table_print(t, stdout);
    table_destroy(&t);
}

/* Stops: how often the value can be doubled before it exceeds the range of half floats. */
static void print_overflow(const struct glint_stability *s) {
    static const char *const titles[] = {"<image",          ">largest",    ">x,y",      "<unit",
                                         ">stops to 65504", ">over 65504", ">NaN, Inf", NULL};
    struct table *t = table_create(titles);
    for (size_t i = 0; i < s->image_count; i++) {
        const struct glint_stability_image *image = &s->images[i];
        if (image->discrete) continue;
        table_cell(t, "%s", image->name);
        table_cell(t, "%s", number_text(image->peak));
        table_cell(t, "%u,%u", image->peak_x, image->peak_y);
        table_cell(t, "%s", image->row->unit);
        table_cell(t, "%.1f", image->peak > 0 ? log2(65504 / image->peak) : (double)INFINITY);
        cell_count(t, image->overflowing);
        cell_count(t, image->invalid);
    }
    table_print(t, stdout);
    table_destroy(&t);
}

static void print_invalid(const struct glint_stability_invalid *invalid) {
    if (!*invalid->image) return;
    if (invalid->pass)
        printf("\nThe first pass whose values are not finite is %s/%s: ", invalid->pass->slot, invalid->pass->variant);
    else printf("\nThe capture has invalid values: ");
    printf("%s %s at %u,%u is %g; %llu values are not finite, %llu are clamped\n", invalid->image, invalid->channel,
           invalid->x, invalid->y, (double)invalid->value, (unsigned long long)invalid->not_finite,
           (unsigned long long)invalid->clamped);
}

void stability_print(const struct stability_report *report) {
    const struct glint_stability *s = report->stability;
    printf("%s, %s on %s: %u perturbed replays, images in %s\n\n", name_text(report->capture),
           name_text(report->preset), name_text(report->device), s->seeds,
           report->half ? "their declared formats" : "float");
    print_inputs(s);
    printf(
        "\nAmplification (relative change divided by that of the inputs) of the judged pixels. above: pixels over "
        "%g; first above: "
        "pixels that exceed it here and in no earlier pass; flips: pixels with a different decision in some replay\n",
        s->bound);
    print_passes(s);
    printf("\nWorst pixels\n");
    print_worst(s);
    printf("\nLargest values\n");
    print_overflow(s);
    print_invalid(&s->captured);
    print_invalid(&s->made);
}
