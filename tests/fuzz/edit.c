/* Fuzzes the texts of glint set: lines of KEY=VALUE or PART:KEY=VALUE, applied to a small capture. What can be written can be opened again. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "glint/edit.h"

enum { SIDE = 2, PIXELS = 6 * SIDE * SIDE, CHANNELS = 32 };

/* A part of its role's required channels, of which each is 1 everywhere. */
static void add_part(struct glint_writer *writer, const char *name, uint32_t height) {
    static float ones[PIXELS];
    static const struct glint_cubemap cubemap = {.outdoor = true};
    struct glint_channel channels[CHANNELS];
    struct glint_error err = {0};
    int32_t index;
    bool previous;
    const struct glint_role *role = glint_role_find(name, &index, &previous);
    struct glint_part part = {.name = name, .width = SIDE, .height = height, .channels = channels};
    if (!strncmp(name, "cubemap", 7)) part.cubemap = &cubemap;
    for (size_t i = 0; i < PIXELS; i++) ones[i] = 1;
    for (size_t c = 0; c < role->channel_count && part.channel_count < CHANNELS; c++)
        if (role->channels[c].required)
            channels[part.channel_count++] =
                (struct glint_channel){.name = role->channels[c].name, .type = GLINT_F32, .data = ones};
    fuzz_must(glint_writer_add_part(writer, &part, &err), err.message);
}

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerInitialize(int *argc, char ***argv) {
    const struct glint_camera camera = {.world_to_view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                        .view_to_clip = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.25, -1.25, 0, 0, -1, 0}};
    const struct glint_frame frame = {.camera = camera, .light_count = 1, .lights = {{.intensity = {1, 1, 1}}}};
    struct glint_error err = {0};
    (void)argc, (void)argv;
    struct glint_writer *writer = glint_writer_create(fuzz_file("input.exr", "", 0),
                                                      &(struct glint_writer_options){.compression = GLINT_NONE}, &err);
    fuzz_must(writer && glint_writer_set_frame(writer, &frame, &err), err.message);
    add_part(writer, GLINT_PART_GBUFFER, SIDE);
    add_part(writer, GLINT_PART_LIT, SIDE);
    add_part(writer, "cubemap.000", 6 * SIDE);
    add_part(writer, GLINT_PART_SKY, 6 * SIDE);
    fuzz_must(glint_writer_finish(writer, &err), err.message);
    glint_writer_destroy(&writer);
    return 0;
}

static void check_note(void *user, const char *text) {
    (void)user;
    fuzz_must(text[0] != '\0', "a note has a text");
}

static bool assign(struct glint_edit *edit, char *line) {
    struct glint_error err = {0};
    char *value = strchr(line, '='), *key = line;
    if (!value) return false;
    *value++ = '\0';
    char *colon = strchr(line, ':');
    if (colon) {
        *colon = '\0';
        key = colon + 1;
    }
    return fuzz_reason(glint_edit_assign(edit, colon ? line : NULL, key, value, &err), &err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static char in[600], out[600];
    struct glint_error err = {0};
    if (!in[0]) {
        snprintf(in, sizeof in, "%s/input.exr", fuzz_folder());
        snprintf(out, sizeof out, "%s/output.exr", fuzz_folder());
    }
    struct glint_edit *edit = glint_edit_open(in, &fuzz_limits, check_note, NULL, &err);
    char *text = strdup(fuzz_text(data, size));
    fuzz_must(edit && text, err.message);
    bool changed = false;
    for (char *rest = text, *line; (line = strsep(&rest, "\n")) != NULL;) changed |= assign(edit, line);
    if (changed && fuzz_reason(glint_edit_write(edit, out, &err), &err)) {
        struct glint_capture *capture = glint_capture_open(out, &fuzz_limits, &err);
        fuzz_must(capture != NULL, err.message);
        glint_capture_close(&capture);
    }
    glint_edit_close(&edit);
    free(text);
    return 0;
}
