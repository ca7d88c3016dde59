/* Captures of the fixture in which some channels of a part are encoded. */
#include "encoded.h"

#include <string.h>

#include "unit.h"

double encoded_bits[3][FIX_W * FIX_H];

static bool is_left_out(const char *channel, const struct glint_encodings *encodings) {
    if (!strcmp(channel, "normal.Z")) return encodings->normal >= GLINT_NORMAL_OCTAHEDRAL;
    return !strcmp(channel, "vertexNormal.Z") && encodings->vertex_normal >= GLINT_NORMAL_OCTAHEDRAL;
}

static void encode(struct glint_part *part, struct fixture_channels *channels, const char *const *names, size_t count,
                   enum glint_type type, const char *storage) {
    size_t kept = 0;
    for (size_t c = 0; c < part->channel_count; c++) {
        struct glint_channel channel = channels->all[c];
        for (size_t i = 0; i < count; i++)
            if (!strcmp(channels->all[c].name, names[i]))
                channel =
                    (struct glint_channel){.name = names[i], .type = type, .data = encoded_bits[i], .storage = storage};
        if (!is_left_out(channel.name, &part->encodings)) channels->all[kept++] = channel;
    }
    part->channel_count = kept;
}

struct glint_capture *encoded_capture(const char *path, const char *part_name, const struct glint_encodings *encodings,
                                      const char *const *names, size_t count, enum glint_type type, const char *storage,
                                      const struct glint_frame *frame) {
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(path, NULL, &err);
    bool ok = writer && glint_writer_set_frame(writer, frame, &err);
    for (int p = 0; ok && p <= FIXTURE_PREVIOUS_GBUFFER; p++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        if (!strcmp(part.name, part_name)) {
            part.encodings = *encodings;
            encode(&part, &channels, names, count, type, storage);
        }
        ok = glint_writer_add_part(writer, &part, &err);
    }
    ok = ok && glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = ok ? glint_capture_open(path, NULL, &err) : NULL;
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

void encoded_read(struct glint_capture *capture, const char *part, const char *const *names, size_t count, float *out) {
    struct glint_error err = {0};
    if (!glint_capture_read(capture, glint_capture_find(capture, part), names, count, GLINT_F32, out, 0, &err))
        fail_msg("%s", err.message);
}
