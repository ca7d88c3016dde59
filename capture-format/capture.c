/* Opens a capture: headers, attributes, siblings; no pixel is decoded. */
#include <stdlib.h>
#include <string.h>

#include "attributes.h"
#include "capture_internal.h"
#include "hash.h"
#include "sibling.h"

static bool fail_memory(const struct glint_check *check) {
    return glint_fail(check->err, GLINT_ERROR_MEMORY, "%s: out of memory", check->file);
}

/* ---- siblings ---- */

/* The captures of a shot share one sibling. Together with GLINT_SIBLING_SHARE this bounds the memory of all siblings. */
#define MAX_SIBLINGS 8

static struct glint_sibling *open_sibling(struct glint_capture *capture, struct glint_check *check,
                                          const struct glint_part_info *part) {
    for (size_t i = 0; i < capture->sibling_count; i++)
        if (!strcmp(capture->siblings[i].name, part->sibling)) return &capture->siblings[i];
    if (capture->sibling_count == MAX_SIBLINGS) {
        glint_fail(check->err, GLINT_ERROR_LIMIT, "%s: more than %d siblings, which is the limit", check->file,
                   MAX_SIBLINGS);
        return NULL;
    }
    struct glint_sibling *sibling = &capture->siblings[capture->sibling_count];
    struct glint_error err = {0};
    struct glint_limits limits = capture->exr->limits;
    limits.memory_bytes /= GLINT_SIBLING_SHARE;
    limits.no_link = true;
    char *path = glint_sibling_path(capture->exr->path, part->sibling);
    sibling->name = glint_arena_string(&capture->arena, part->sibling);
    if (!path || !sibling->name) {
        free(path);
        fail_memory(check);
        return NULL;
    }
    sibling->exr = glint_exr_open(path, &limits, &err);
    if (sibling->exr && !glint_hash_file(sibling->exr->stream.file, path, sibling->hex, &err))
        glint_exr_close(&sibling->exr);
    free(path);
    capture->sibling_count++;
    if (err.code == GLINT_ERROR_MEMORY) {
        fail_memory(check);
        return NULL;
    }
    if (!sibling->exr) glint_violation(check, GLINT_RULE_SIBLING, part->name, NULL, "%s", err.message);
    return sibling;
}

/* Sizes, channels and encodings come from the part of the same name in the sibling; the cube map's own attributes stay. */
static bool adopt_sibling_part(struct glint_capture *capture, struct glint_check *check, struct glint_part_info *part,
                               const char *expected, const struct glint_sibling *sibling, struct glint_source *source) {
    if (strcmp(sibling->hex, expected))
        return glint_violation(check, GLINT_RULE_SIBLING, part->name, NULL, "%s: expected the hash %s, found %s",
                               part->sibling, expected, sibling->hex);
    for (size_t i = 0; i < sibling->exr->part_count; i++) {
        const struct glint_exr_part_info *from = &sibling->exr->parts[i].info;
        struct glint_part_info theirs = {0};
        if (strcmp(from->name, part->name)) continue;
        if (!glint_part_parse(check, &capture->arena, from, sibling->exr->parts[i].readable, &theirs)) return false;
        if (theirs.sibling[0])
            return glint_violation(check, GLINT_RULE_SIBLING, part->name, NULL,
                                   "%s: expected pixels, found another sibling's name", part->sibling);
        part->width = theirs.width;
        part->height = theirs.height;
        part->channels = theirs.channels;
        part->channel_count = theirs.channel_count;
        part->encodings = theirs.encodings;
        memcpy(part->sibling_hash, sibling->hex, sizeof part->sibling_hash);
        *source = (struct glint_source){.exr = sibling->exr, .part = i};
        return true;
    }
    return glint_violation(check, GLINT_RULE_SIBLING, part->name, NULL, "%s: expected a part of this name, found none",
                           part->sibling);
}

static bool resolve_sibling(struct glint_capture *capture, struct glint_check *check, size_t i) {
    struct glint_part_info *part = &capture->parts[i];
    if (!part->sibling[0]) return true;
    part->width = part->height = 0;
    part->channel_count = 0;
    const struct glint_sibling *sibling = open_sibling(capture, check, part);
    if (!sibling || !sibling->exr) return sibling && check->report;
    const struct glint_exr_attribute *hash =
        glint_exr_attribute(&capture->exr->parts[i].info, GLINT_SIBLING_HASH_ATTRIBUTE);
    return adopt_sibling_part(capture, check, part, hash->string, sibling, &capture->sources[i]);
}

/* ---- open ---- */

static bool parse_headers(struct glint_capture *capture, struct glint_check *check) {
    const size_t count = capture->count = capture->exr->part_count;
    const struct glint_exr_part_info **files = glint_arena_take(&capture->arena, count * sizeof *files);
    capture->parts = glint_arena_take(&capture->arena, count * sizeof *capture->parts);
    capture->sources = glint_arena_take(&capture->arena, count * sizeof *capture->sources);
    capture->siblings = glint_arena_take(&capture->arena, count * sizeof *capture->siblings);
    if (!files || !capture->parts || !capture->sources || !capture->siblings) return fail_memory(check);
    for (size_t i = 0; i < count; i++) {
        files[i] = &capture->exr->parts[i].info;
        capture->sources[i] = (struct glint_source){.exr = capture->exr, .part = i};
        if (!glint_part_parse(check, &capture->arena, files[i], capture->exr->parts[i].readable, &capture->parts[i]) ||
            !resolve_sibling(capture, check, i))
            return false;
    }
    if (!glint_parts_check(check, files, capture->parts, count, &capture->frame, &capture->has_frame)) return false;
    if (!capture->has_frame) /* in a file of cube maps only, lengths are in units and colours are not exposed */
        capture->frame.metres_per_unit = capture->frame.pre_exposure = capture->frame.exposure = 1;
    return true;
}

struct glint_capture *glint_capture_open_checked(const char *path, const struct glint_limits *limits,
                                                 struct glint_check *check) {
    struct glint_capture *capture = calloc(1, sizeof *capture);
    if (!capture) {
        fail_memory(check);
        return NULL;
    }
    capture->exr = glint_exr_open(path, limits, check->err);
    if (!capture->exr || !glint_container_check(check, capture->exr) || !parse_headers(capture, check))
        glint_capture_close(&capture);
    return capture;
}

struct glint_capture *glint_capture_open(const char *path, const struct glint_limits *limits, struct glint_error *err) {
    struct glint_check check = {.file = path, .err = err};
    struct glint_capture *capture = glint_capture_open_checked(path, limits, &check);
    if (capture && !capture->has_frame) {
        glint_violation(&check, GLINT_RULE_REQUIRED, "gbuffer", NULL,
                        "missing: expected a capture, found a file of cube maps for captures to name as sibling");
        glint_capture_close(&capture);
    }
    return capture;
}

void glint_capture_close(struct glint_capture **capture) {
    if (!capture || !*capture) return;
    for (size_t i = 0; i < (*capture)->sibling_count; i++) glint_exr_close(&(*capture)->siblings[i].exr);
    glint_exr_close(&(*capture)->exr);
    glint_arena_finish(&(*capture)->arena);
    free((*capture)->perturbation.only);
    free(*capture);
    *capture = NULL;
}

const char *glint_capture_path(const struct glint_capture *capture) {
    return capture->exr->path;
}
const struct glint_frame *glint_capture_frame(const struct glint_capture *capture) {
    return &capture->frame;
}
size_t glint_capture_part_count(const struct glint_capture *capture) {
    return capture->count;
}

const struct glint_part_info *glint_capture_part(const struct glint_capture *capture, size_t i) {
    return i < capture->count ? &capture->parts[i] : NULL;
}

const struct glint_part_info *glint_capture_find(const struct glint_capture *capture, const char *name) {
    for (size_t i = 0; i < capture->count; i++)
        if (!strcmp(capture->parts[i].name, name)) return &capture->parts[i];
    return NULL;
}

bool glint_capture_hash(struct glint_capture *capture, char hex[33], struct glint_error *err) {
    return glint_hash_file(capture->exr->stream.file, capture->exr->path, hex, err);
}
