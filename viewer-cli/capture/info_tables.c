/* The tables of glint info. */
#include "capture/info_tables.h"

#include <stdio.h>
#include <string.h>

#include "capture/camera_facts.h"
#include "capture/depth_facts.h"
#include "io/table.h"

/* "cubemap" of "cubemap.003", with the number; the whole name and -1 otherwise. */
static size_t stem_length(const char *part) {
    size_t length = strlen(part), digits = 0;
    while (digits < length && strchr("0123456789", part[length - 1 - digits])) digits++;
    return digits == 3 && length > 4 && part[length - 4] == '.' ? length - 4 : length;
}

static bool same_part(const struct channel_row *a, const struct channel_row *b) {
    size_t n = stem_length(a->part);
    return n == stem_length(b->part) && !strncmp(a->part, b->part, n);
}

/* R G B or X Y Z of one layer share a line. */
static bool same_vector(const struct channel_row *a, const struct channel_row *b) {
    int ra = channel_rank(a->channel), rb = channel_rank(b->channel);
    size_t n = channel_layer_length(a->channel);
    bool color = ra < 3 && rb<3, vector = ra> 3 && ra < 7 && rb > 3 && rb < 7;
    return n == channel_layer_length(b->channel) && !strncmp(a->channel, b->channel, n) && (color || vector);
}

static bool same_line(const struct channel_row *a, const struct channel_row *b) {
    return same_part(a, b) && (!strcmp(a->channel, b->channel) || same_vector(a, b));
}

static const struct channel_row *first_like(const struct channel_table *all, size_t i,
                                            bool (*alike)(const struct channel_row *, const struct channel_row *)) {
    size_t k = 0;
    while (k < i && !alike(&all->rows[k], &all->rows[i])) k++;
    return &all->rows[k];
}

static void print_part_line(struct table *table, const struct channel_table *all, const struct channel_row *first) {
    size_t parts = 0;
    for (size_t i = 0; i < all->count; i++)
        parts += same_part(first, &all->rows[i]) && !strcmp(first->channel, all->rows[i].channel);
    if (parts > 1) table_cell(table, "%.*s.NNN × %zu", (int)stem_length(first->part), first->part, parts);
    else table_cell(table, "%s", first->part);
    for (int k = 0; k < 8; k++) table_cell(table, "%s", "");
}

static void print_channel_line(struct table *table, const struct channel_table *all, const struct channel_row *first) {
    struct channel_row row = *first;
    char name[300];
    int length = snprintf(name, sizeof name, "  %s", row.channel);
    for (const struct channel_row *r = first + 1; r < all->rows + all->count; r++) {
        if (!same_line(first, r)) continue;
        stats_merge(&row.stats, &r->stats);
        if (!strcmp(r->part, row.part) && length < (int)sizeof name - 8)
            length += snprintf(name + length, sizeof name - (size_t)length, " %s",
                               strrchr(r->channel, '.') ? strrchr(r->channel, '.') + 1 : r->channel);
    }
    const struct channel_stats *s = &row.stats;
    bool finite = row.has_stats && s->count > s->nan + s->inf;
    bool declared = *row.storage && strcmp(row.storage, row.stored) != 0;
    table_cell(table, "%s", name);
    table_cell(table, "%s%s%s", row.stored, declared ? "/" : "", declared ? row.storage : "");
    table_cell(table, "%s", row.encoding);
    table_cell(table, "%s", strcmp(row.unit, "1") ? row.unit : "");
    const double values[] = {s->min, s->max, stats_mean(s)};
    for (int k = 0; k < 3; k++)
        if (finite) table_cell(table, "%.3g", values[k]);
        else table_cell(table, "%s", "");
    for (int k = 0; k < 2; k++) {
        uint64_t n = k ? s->inf : s->nan;
        if (row.has_stats && n) table_cell(table, "%llu", (unsigned long long)n);
        else table_cell(table, "%s", row.has_stats ? "–" : "");
    }
}

void info_print_channels(const struct channel_table *all) {
    static const char *const titles[] = {"<channels", "<stored", "<encoding", "<unit", ">min",
                                         ">max",      ">mean",   ">NaN",      ">Inf",  NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < all->count; i++) {
        const struct channel_row *row = &all->rows[i];
        if (first_like(all, i, same_part) == row) print_part_line(table, all, row);
        if (first_like(all, i, same_line) == row) print_channel_line(table, all, row);
    }
    table_print(table, stdout);
    table_destroy(&table);
    bool of_surfaces = false;
    for (size_t i = 0; i < all->count; i++) of_surfaces |= all->rows[i].of_surfaces;
    if (of_surfaces) puts("\nIn parts with depth.Z, ranges cover surfaces only, without sky and empty pixels.");
}

/* Parts with the same stem and size share a line. */
static bool same_kind(const struct glint_part_info *a, const struct glint_part_info *b) {
    size_t n = stem_length(a->name);
    return a->index >= 0 && b->index >= 0 && n == stem_length(b->name) && !strncmp(a->name, b->name, n) &&
           a->width == b->width && a->height == b->height && !strcmp(a->sibling, b->sibling);
}

void info_print_parts(const struct glint_capture *capture) {
    static const char *const titles[] = {"<part", ">size", "<meaning", NULL};
    struct table *table = table_create(titles);
    size_t count = glint_capture_part_count(capture);
    for (size_t i = 0; i < count; i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        size_t alike = 1;
        bool seen = false;
        for (size_t k = 0; k < count; k++) {
            bool same = k != i && same_kind(part, glint_capture_part(capture, k));
            seen = seen || (same && k < i);
            alike += same;
        }
        if (seen) continue;
        if (alike > 1) table_cell(table, "%.*s.NNN × %zu", (int)stem_length(part->name), part->name, alike);
        else table_cell(table, "%s", part->name);
        table_cell(table, "%u × %u", part->width, part->height);
        const char *meaning = part->role ? part->role->meaning : "unknown to this version; kept";
        table_cell(table, "%.*s%s%s%s", (int)strcspn(meaning, ":;"), meaning,
                   part->previous ? ", one frame earlier" : "", part->sibling[0] ? "; stored in " : "", part->sibling);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

void info_print_depth(const struct glint_capture *capture) {
    static const char *const titles[] = {"<depth storage", "<encoding", "<steps", NULL};
    const struct depth_facts facts = depth_facts(capture);
    struct table *table = table_create(titles);
    char text[160];
    depth_steps_text(&facts, text, sizeof text);
    table_cell(table, "%s", facts.storage);
    table_cell(table, "%s", facts.encoding);
    table_cell(table, "%s", text);
    putchar('\n');
    table_print(table, stdout);
    table_destroy(&table);
}

const char *cubemap_volume_name(enum glint_volume volume) {
    static const char *const names[] = {"none", "box", "sphere", "hull"};
    return (size_t)volume < 4 ? names[volume] : "?";
}

void info_print_cubemaps(const struct glint_capture *capture) {
    static const char *const titles[] = {"<cube map", ">face",         ">x",    ">y", ">z",
                                         "<where",    "<inner volume", ">fade", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (!part->has_cubemap) continue;
        table_cell(table, "%s", part->name);
        table_cell(table, "%u", part->width);
        for (int k = 0; k < 3; k++) table_cell(table, "%.3f", part->cubemap.center[k]);
        table_cell(table, "%s", part->cubemap.outdoor ? "outdoor" : "indoor");
        table_cell(table, "%s", cubemap_volume_name(part->cubemap.inner));
        table_cell(table, "%s", number_text(part->cubemap.fade > 0 ? part->cubemap.fade : 1));
    }
    if (!table_is_empty(table)) {
        putchar('\n');
        table_print(table, stdout);
    }
    table_destroy(&table);
}

static void add_probe(struct table *table, const struct glint_capture *capture, int32_t index) {
    const struct glint_part_info *levels[GLINT_MAX_LEVELS];
    double roughness[GLINT_MAX_LEVELS];
    const size_t count = glint_capture_probe(capture, index, levels, roughness);
    for (size_t l = 0; l < count; l++) {
        const struct glint_probe *probe = &levels[l]->probe;
        table_cell(table, "%s", levels[l]->name);
        table_cell(table, "%u", levels[l]->width);
        table_cell(table, "%.3f", roughness[l]);
        table_cell(table, "%s", l ? "" : probe->has_box ? "in a box" : "infinitely far");
        if (!l && probe->has_ground) table_cell(table, "below %g°", probe->ground);
        else table_cell(table, "%s", l ? "" : "none");
    }
}

void info_print_probes(const struct glint_capture *capture) {
    static const char *const titles[] = {"<probe", ">face", ">for roughness", "<where", "<painted ground", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (part->has_probe && !part->level) add_probe(table, capture, part->index);
    }
    if (!table_is_empty(table)) {
        putchar('\n');
        table_print(table, stdout);
    }
    table_destroy(&table);
    const struct glint_part_info *sky = glint_capture_find(capture, GLINT_PART_SKY);
    if (sky && sky->sky.has_ground) printf("\nsky shows painted ground below %g°\n", sky->sky.ground);
}

void info_print_camera(const struct glint_frame *frame) {
    const struct camera_facts c = camera_facts(frame);
    printf("frame %u, camera at (%.3f, %.3f, %.3f) looking along (%.3f, %.3f, %.3f)\n", frame->number, c.position[0],
           c.position[1], c.position[2], c.forward[0], c.forward[1], c.forward[2]);
    printf("field of view %.1f° × %.1f°, near %s, far %s, %s metres per unit, %s up\n", c.fov_x_deg, c.fov_y_deg,
           number_text(c.near), number_text(c.far),
           number_text(frame->metres_per_unit > 0 ? frame->metres_per_unit : 1), axis_name(frame->up));
    printf("%s; exposure %s; %s%s%s\n",
           !frame->has_previous ? "no previous frame"
           : frame->cut         ? "after a cut"
                                : "has the previous frame",
           number_text(frame->exposure > 0 ? frame->exposure : 1), frame->has_fog ? "fog" : "no fog",
           frame->has_atmosphere ? ", an atmosphere" : "", frame->has_clouds ? ", clouds" : "");
    frame_notes_print(frame);
}

/* A line and a bar for each bin; `of` is what 100 % are. */
static void print_bins(const char *const *names, const uint64_t *bins, size_t count, uint64_t of) {
    double most = 1;
    for (size_t i = 0; i < count; i++)
        if ((double)bins[i] > most) most = (double)bins[i];
    for (size_t i = 0; i < count && of; i++) {
        const int length = (int)(40 * (double)bins[i] / most + 0.5);
        printf("  %-12s %6.1f %% ", names[i], 100 * (double)bins[i] / (double)of);
        for (int k = 0; k < length; k++) fputs("█", stdout);
        putchar('\n');
    }
}

static const char *const tenths[] = {"0.0 to 0.1", "0.1 to 0.2", "0.2 to 0.3", "0.3 to 0.4", "0.4 to 0.5",
                                     "0.5 to 0.6", "0.6 to 0.7", "0.7 to 0.8", "0.8 to 0.9", "0.9 to 1.0"},
                         *const halvings[] = {"over 1/2",   "over 1/4",    "over 1/8",    "over 1/16",
                                              "over 1/32",  "over 1/64",   "over 1/128",  "over 1/256",
                                              "over 1/512", "over 1/1024", "over 1/2048", "less"};

void info_print_survey(const struct glint_survey *survey) {
    const double all = survey->pixels ? (double)survey->pixels : 1;
    const struct glint_survey_pixels *reflecting = &survey->reflecting;
    printf("%.1f %% sky, %.1f %% reflecting", 100 * (double)survey->sky / all, 100 * (double)reflecting->count / all);
    puts(reflecting->count ? "; reflecting pixels by roughness:" : ": nothing to trace");
    print_bins(tenths, reflecting->by_roughness, GLINT_SURVEY_BINS, reflecting->count);
}

static void print_classes(const struct glint_survey *survey, const struct glint_frame *frame) {
    uint64_t count;
    for (uint32_t i = 0; i < frame->class_count; i++)
        if (glint_survey_class(survey, &frame->classes[i], &count))
            printf("class %s: %llu pixels\n", name_text(frame->classes[i].name), (unsigned long long)count);
}

static const char *faces_text(uint8_t faces, char text[32]) {
    static const char *const names[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
    size_t length = 0;
    text[0] = 0;
    for (int face = 0; face < 6; face++)
        if (faces >> face & 1)
            length += (size_t)snprintf(text + length, 32 - length, "%s%s", length ? " " : "", names[face]);
    return faces ? text : "none";
}

static void print_cubemaps(const struct glint_survey *survey) {
    static const char *const titles[] = {">cube map", "<faces with sky", "<faces that rays may reach", NULL};
    char text[32];
    if (survey->active_surveyed == 0) return;
    printf("%u of %u faces of the active cube maps show sky; rays may reach %u%s:\n",
           glint_survey_faces(survey, GLINT_SURVEY_SKY), 6 * survey->active_surveyed,
           glint_survey_faces(survey, GLINT_SURVEY_CROSSED),
           survey->active_traced ? "" : ", because only mirror rays are bounded");
    struct table *table = table_create(titles);
    for (uint32_t i = 0; i < survey->active_surveyed; i++) {
        table_cell(table, "%u", survey->active[i].number);
        table_cell(table, "%s", faces_text(survey->active[i].sky, text));
        table_cell(table, "%s", faces_text(survey->active_traced ? survey->active[i].crossed : 63, text));
    }
    table_print(table, stdout);
    table_destroy(&table);
}

void info_print_whole_survey(const struct glint_survey *survey, const struct glint_time *time,
                             const struct glint_frame *frame) {
    info_print_survey(survey);
    if (survey->reflecting.count)
        printf("their roughness is between %.3g and %.3g\n", (double)survey->reflecting.roughness[0],
               (double)survey->reflecting.roughness[1]);
    puts("reflecting pixels by weight of the reflection:");
    print_bins(halvings, survey->weight, GLINT_SURVEY_WEIGHTS, survey->reflecting.count);
    puts("surfaces by metalness:");
    print_bins(tenths, survey->metalness, GLINT_SURVEY_BINS, survey->surfaces.count);
    print_classes(survey, frame);
    printf("%llu pixels of water, %llu transparent; %s planar reflection map; %u cube maps, %u with an inner volume\n",
           (unsigned long long)survey->water, (unsigned long long)survey->transparent, survey->has_planar ? "a" : "no",
           survey->cubemaps, survey->volumes);
    print_cubemaps(survey);
    const char *motion = glint_survey_motion(survey);
    printf("motion: %s (%llu pixels moved on screen, %llu belong to moving objects)\n", motion ? motion : "none",
           (unsigned long long)survey->moved, (unsigned long long)survey->moving);
    printf("luminance %.3g to %.3g; depth %.3g to %.3g m\n", (double)survey->light[0], (double)survey->light[1],
           (double)survey->depth_m[0], (double)survey->depth_m[1]);
    if (time->n)
        printf("survey took %.3f ms%s\n", (double)time->median_ns * 1e-6,
               time->cold ? " (cold: one round without warm-up)" : "");
}

void info_print_run(const struct glint_run *run) {
    static const char *const titles[] = {"<image", "<made by", ">size", "<channels", "<unit", "<meaning", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        table_cell(table, "%s", image->name);
        table_cell(table, "%s/%s", image->slot, image->variant);
        table_cell(table, "%u × %u", image->width, image->height);
        table_cell(table, "%s", image->channels);
        table_cell(table, "%s", strcmp(image->unit, "1") ? image->unit : "");
        table_cell(table, "%s", image->meaning);
    }
    table_print(table, stdout);
    table_destroy(&table);
}
