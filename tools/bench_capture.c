/* Times writing and reading of a 1920 x 1080 capture with all that a frame usually brings; prints JSON.
   usage: bench_capture FILE [threads] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "fixture.h"

enum { W = 1920, H = 1080, N = 512 };

static double seconds(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Float to half by arithmetic on the value, for test data only. */
static uint16_t half(float value) {
    int exponent = 0;
    const float fraction = frexpf(fabsf(value), &exponent);
    if (exponent < -13) return 0;
    return (uint16_t)((value < 0 ? 0x8000 : 0) | (((exponent + 14) << 10) + (int)((fraction * 2 - 1) * 1024)));
}

/* Smooth shapes with edges, and noise in the low bits, as rendered pictures have them. */
static float shade(uint32_t x, uint32_t y, uint32_t c) {
    const float u = (float)x * 0.01f, v = (float)y * 0.013f;
    const float base = 0.5f + 0.4f * sinf(u + (float)c) * cosf(v * 1.3f + (float)c);
    const float edge = ((x >> 6) + (y >> 5) + c) % 3 ? 0.7f : 0.2f;
    return base * edge * (1 + 0.02f * (float)fixture_noise(y * 8192 + x, c));
}

static uint16_t *halves(uint32_t w, uint32_t h, uint32_t seed) {
    uint16_t *data = malloc((size_t)w * h * 2);
    for (uint32_t i = 0; data && i < w * h; i++) data[i] = half(shade(i % w, i / w, seed));
    return data;
}

static float *floats(uint32_t w, uint32_t h, uint32_t seed) {
    float *data = malloc((size_t)w * h * 4);
    for (uint32_t i = 0; data && i < w * h; i++) data[i] = 0.1f + 100 * shade(i % w, i / w, seed);
    return data;
}

struct layer {
    const char *name;
    bool wide;
};
static const struct layer gbuffer[] = {{"depth.Z", true},
                                       {"normal.X", false},
                                       {"normal.Y", false},
                                       {"normal.Z", false},
                                       {"material.roughness", false},
                                       {"material.metalness", false},
                                       {"material.specular", false},
                                       {"albedo.R", false},
                                       {"albedo.G", false},
                                       {"albedo.B", false},
                                       {"motion.X", false},
                                       {"motion.Y", false},
                                       {"vertexNormal.X", false},
                                       {"vertexNormal.Y", false},
                                       {"vertexNormal.Z", false}};
static const struct layer color[] = {{"R", false}, {"G", false}, {"B", false}, {"A", false}, {"distance.Z", true}};

static struct glint_part part(const char *name, uint32_t w, uint32_t h, const struct layer *layers, size_t count,
                              struct glint_channel *channels, uint32_t seed) {
    for (size_t i = 0; i < count; i++)
        channels[i] = (struct glint_channel){.name = layers[i].name,
                                             .type = layers[i].wide ? GLINT_F32 : GLINT_F16,
                                             .data = layers[i].wide ? (void *)floats(w, h, seed + (uint32_t)i)
                                                                    : (void *)halves(w, h, seed + (uint32_t)i)};
    return (struct glint_part){.name = name, .width = w, .height = h, .channels = channels, .channel_count = count};
}

static bool read_all(const char *path, uint32_t threads, struct glint_error *err) {
    struct glint_capture *capture = glint_capture_open(path, NULL, err);
    bool ok = capture != NULL;
    for (size_t i = 0; ok && i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *info = glint_capture_part(capture, i);
        const char *wide[20], *narrow[20];
        size_t wides = 0, narrows = 0;
        for (size_t c = 0; c < info->channel_count; c++)
            if (info->channels[c].stored == GLINT_STORED_FLOAT) wide[wides++] = info->channels[c].name;
            else narrow[narrows++] = info->channels[c].name;
        const size_t pixels = (size_t)info->width * info->height;
        void *a = malloc(pixels * 4 * (wides ? wides : 1)), *b = malloc(pixels * 2 * narrows);
        ok = a && b && (!wides || glint_capture_read(capture, info, wide, wides, GLINT_F32, a, threads, err));
        ok = ok && glint_capture_read(capture, info, narrow, narrows, GLINT_F16, b, threads, err);
        free(a);
        free(b);
    }
    glint_capture_close(&capture);
    return ok;
}

int main(int argc, char **argv) {
    if (argc < 2) return 2;
    const uint32_t threads = argc > 2 ? (uint32_t)atoi(argv[2]) : 0;
    struct glint_error err = {0};
    struct glint_channel channels[12][20];
    struct glint_part parts[13];
    struct glint_cubemap cube = {.outdoor = true};
    char names[8][16];
    size_t count = 0;
    parts[count++] = part("gbuffer", W, H, gbuffer, 15, channels[0], 0);
    parts[count++] = part("lit", W, H, color, 3, channels[1], 20);
    parts[count] = parts[1];
    parts[count++].name = "previous.lit";
    parts[count] = parts[0];
    parts[count++].name = "previous.gbuffer";
    parts[count++] = part("sky", N, 6 * N, color, 3, channels[2], 30);
    for (uint32_t i = 0; i < 8; i++) {
        snprintf(names[i], sizeof names[i], "cubemap.%03u", i);
        parts[count] = part(names[i], N, 6 * N, color, 5, channels[3 + i], 40 + 5 * i);
        parts[count++].cubemap = &cube;
    }
    struct glint_frame frame = fixture_frame();
    frame.metres_per_unit = 1;
    const struct glint_writer_options options = {.threads = threads};
    const double start = seconds(CLOCK_MONOTONIC), start_cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    struct glint_writer *writer = glint_writer_create(argv[1], &options, &err);
    bool ok = writer && glint_writer_set_frame(writer, &frame, &err);
    for (size_t i = 0; ok && i < count; i++) ok = glint_writer_add_part(writer, &parts[i], &err);
    const double copied = seconds(CLOCK_MONOTONIC);
    ok = ok && glint_writer_finish(writer, &err);
    const double written = seconds(CLOCK_MONOTONIC), written_cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    ok = ok && read_all(argv[1], threads, &err);
    const double read = seconds(CLOCK_MONOTONIC), read_cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    glint_writer_destroy(&writer);
    struct stat info = {0};
    if (!ok || stat(argv[1], &info)) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    /* Processor time beside the clock's: on a busy machine only the former says what the work costs. */
    printf("{\"write_s\": %.3f, \"copy_s\": %.3f, \"read_s\": %.3f, \"write_cpu_s\": %.3f, \"read_cpu_s\": %.3f, "
           "\"bytes\": %lld}\n",
           written - start, copied - start, read - written, written_cpu - start_cpu, read_cpu - written_cpu,
           (long long)info.st_size);
    return 0;
}
