/* Writes the fixture and prints the minimum, maximum and mean of the finite values of each channel, which any tool should report. uint
   channels are skipped, because tools scale them. usage: statistics FILE COMPRESSION */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fixture.h"

int main(int argc, char **argv) {
    static struct fixture fixture;
    struct glint_error err = {0};
    if (argc < 3) return 2;
    const struct glint_writer_options options = {.compression = (enum glint_compression)atoi(argv[2])};
    fixture_init(&fixture);
    if (!fixture_write(&fixture, argv[1], FIXTURE_PARTS, &options, &err)) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    for (int p = 0; p < FIXTURE_PARTS; p++) {
        struct fixture_channels channels;
        const struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        for (size_t c = 0; c < part.channel_count; c++) {
            const struct glint_channel *channel = &part.channels[c];
            if (channel->type != GLINT_F32) continue;
            double low = INFINITY, high = -INFINITY, sum = 0, count = 0;
            for (size_t i = 0; i < (size_t)part.width * part.height; i++) {
                const double v = (double)*(const float *)((const char *)channel->data + i * channel->x_stride_bytes);
                if (!isfinite(v)) continue;
                low = fmin(low, v);
                high = fmax(high, v);
                sum += v;
                count++;
            }
            printf("%s %s %.9g %.9g %.9g\n", part.name, channel->name, low, high, sum / count);
        }
    }
    return 0;
}
