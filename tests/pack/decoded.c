/* Prints a capture as a reader of the format sees it, for tests in Python: decoded CAPTURE. A line of text for the frame, each part and each
   channel; a channel's line is followed by its values, 32 bits each, decoded if the role has an encoding. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/capture.h"

static void print_matrix(const char *name, const double m[16]) {
    printf("%s", name);
    for (int i = 0; i < 16; i++) printf(" %.17g", m[i]);
    printf("\n");
}

static bool print_channel(struct glint_capture *capture, const struct glint_part_info *part, const char *name,
                          bool integer, const char *storage, struct glint_error *err) {
    const size_t texels = (size_t)part->width * part->height;
    uint32_t *values = malloc(texels * 4);
    const bool ok =
        values && glint_capture_read(capture, part, &name, 1, integer ? GLINT_U32 : GLINT_F32, values, 1, err);
    if (ok) {
        printf("channel %s %s %s\n", name, integer ? "uint" : "float", storage);
        fwrite(values, 4, texels, stdout);
    }
    free(values);
    return ok;
}

static bool print_part(struct glint_capture *capture, const struct glint_part_info *part, struct glint_error *err) {
    printf("part %s %u %u\n", part->name, part->width, part->height);
    if (part->has_cubemap) {
        const struct glint_cubemap *c = &part->cubemap;
        printf("center %.17g %.17g %.17g\n", c->center[0], c->center[1], c->center[2]);
    }
    bool ok = true;
    for (size_t i = 0; ok && i < part->channel_count; i++) {
        const struct glint_channel_info *channel = &part->channels[i];
        const bool packed = !strncmp(channel->name, "motion.", 7);
        ok = print_channel(capture, part, channel->name, channel->stored == GLINT_STORED_UINT && !packed,
                           channel->storage, err);
    }
    /* the Z that only the decoder knows */
    static const char *const derived[] = {"normal.Z", "vertexNormal.Z"};
    for (int k = 0; k < 2; k++) {
        bool stored = false;
        for (size_t i = 0; i < part->channel_count; i++) stored = stored || !strcmp(part->channels[i].name, derived[k]);
        if (ok && !stored && glint_part_has_channel(part, derived[k]))
            ok = print_channel(capture, part, derived[k], false, "-", err);
    }
    return ok;
}

int main(int argc, char **argv) {
    struct glint_error err = {0};
    struct glint_capture *capture = argc == 2 ? glint_capture_open(argv[1], NULL, &err) : NULL;
    bool ok = capture != NULL;
    if (ok) {
        const struct glint_frame *frame = glint_capture_frame(capture);
        print_matrix("world_to_view", frame->camera.world_to_view);
        print_matrix("view_to_clip", frame->camera.view_to_clip);
        print_matrix("previous_world_to_view", frame->previous.world_to_view);
        print_matrix("previous_view_to_clip", frame->previous.view_to_clip);
        printf("jitter %.17g %.17g\n", frame->jitter_px[0], frame->jitter_px[1]);
    }
    for (size_t i = 0; ok && i < glint_capture_part_count(capture); i++)
        ok = print_part(capture, glint_capture_part(capture, i), &err);
    glint_capture_close(&capture);
    if (!ok) fprintf(stderr, "%s\n", err.message);
    return ok ? 0 : 1;
}
