/* Calls every function of the library on an untrusted file. */
#define _GNU_SOURCE
#include "hostile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef _WIN32
#include <sys/mman.h>
#endif

#include "fixture.h"

const struct glint_limits hostile_limits = {
    .file_bytes = 1 << 24, .memory_bytes = 32 << 20, .width = 1024, .parts = 64};

/* Every failure must set a code and a message, because callers depend on both. */
static bool has_reason(bool ok, const struct glint_error *err) {
    if (!ok && (err->code == GLINT_OK || !err->message[0])) abort();
    return ok;
}

/* Reads all half and float channels of a part, or all its uint channels, as stored and decoded. */
static bool read_kind(struct glint_capture *capture, const struct glint_part_info *part, bool integer,
                      struct glint_error *err) {
    const char *names[32];
    size_t count = 0;
    for (size_t c = 0; c < part->channel_count && count < 31; c++)
        if ((part->channels[c].stored == GLINT_STORED_UINT) == integer) names[count++] = part->channels[c].name;
    if (!count) return true;
    names[count++] = NULL;
    void *out = malloc((size_t)part->width * part->height * 4 * count);
    if (!out) abort();
    const enum glint_type type = integer ? GLINT_U32 : GLINT_F32;
    bool ok = has_reason(glint_capture_read_raw(capture, part, names, count, type, out, 1, err), err);
    if (ok)
        ok = has_reason(glint_capture_read(capture, part, names, count, integer ? GLINT_U32 : GLINT_F16, out, 2, err),
                        err);
    free(out);
    return ok;
}

static bool read_part(struct glint_capture *capture, const struct glint_part_info *part, struct glint_error *err) {
    const bool floats = read_kind(capture, part, false, err);
    return read_kind(capture, part, true, err) && floats;
}

static void ignore(void *user, const char *rule, const char *message) {
    (void)user;
    if (!rule[0] || !message[0] || strchr(message, '\n')) abort();
}

bool hostile_use(const char *path, struct glint_error *err) {
    struct glint_error other = {0};
    size_t violations = 0;
    has_reason(glint_capture_validate(path, &hostile_limits, ignore, NULL, &violations, &other), &other);
    struct glint_capture *capture = glint_capture_open(path, &hostile_limits, err);
    bool ok = has_reason(capture != NULL, err);
    for (size_t i = 0; capture && i < glint_capture_part_count(capture); i++)
        if (!read_part(capture, glint_capture_part(capture, i), err)) ok = false;
    glint_capture_close(&capture);
    return ok;
}

#ifdef _WIN32

const char hostile_name[] = "hostile-bytes.exr";

bool hostile_use_bytes(const void *bytes, size_t size, struct glint_error *err) {
    char path[512];
    FILE *file = fopen(fixture_path(path, hostile_name), "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file)) abort();
    const bool ok = hostile_use(path, err);
    if (unlink(path)) abort(); /* somebody still has it open */
    return ok;
}

#else

const char hostile_name[] = "/proc/self/fd/";

bool hostile_use_bytes(const void *bytes, size_t size, struct glint_error *err) {
    char path[64];
    const int fd = memfd_create("hostile", 0);
    if (fd < 0) abort();
    for (size_t done = 0; done < size;) {
        const ssize_t got = write(fd, (const char *)bytes + done, size - done);
        if (got <= 0) abort();
        done += (size_t)got;
    }
    snprintf(path, sizeof path, "%s%d", hostile_name, fd);
    const bool ok = hostile_use(path, err);
    close(fd);
    return ok;
}

#endif

static uint32_t pick(uint32_t seed, uint32_t n, uint32_t below) {
    return (uint32_t)(fixture_noise(seed, n) * below);
}

size_t hostile_damage(uint8_t *bytes, size_t size, uint32_t seed) {
    static const uint32_t words[] = {0,           1,           0x7fffffffu, 0x80000000u, 0xffffffffu, 0x00010000u,
                                     0x7f800000u, 0xff800000u, 0x7fc00000u, 255,         65536 * 6,   0xfffffff0u};
    const uint32_t hits = 1 + pick(seed, 0, 4);
    for (uint32_t h = 0; h < hits; h++) {
        /* two of three changes hit the headers, which have most structure */
        const uint32_t span = (uint32_t)(pick(seed, 10 + h, 3) && size > 16384 ? 16384 : size);
        const uint32_t at = pick(seed, 20 + h, span), kind = pick(seed, 30 + h, 6);
        const uint32_t word = words[pick(seed, 40 + h, sizeof words / sizeof *words)];
        if (kind == 0) bytes[at] ^= (uint8_t)(1u << pick(seed, 50 + h, 8));
        if (kind == 1) bytes[at] = (uint8_t)pick(seed, 50 + h, 256);
        if (kind == 2 && at + 4 <= size) memcpy(bytes + at, &word, 4);
        if (kind == 3 && at + 8 <= size) memcpy(bytes + at, &(uint64_t){(uint64_t)word << 32 | word}, 8);
        if (kind == 4) { /* a copy of another range of the file */
            const uint32_t from = pick(seed, 50 + h, (uint32_t)size), left = (uint32_t)size - (from > at ? from : at);
            memmove(bytes + at, bytes + from, pick(seed, 60 + h, left < 64 ? left : 64));
        }
        if (kind == 5 && h + 1 == hits && pick(seed, 70, 4) == 0) return pick(seed, 80, (uint32_t)size);
    }
    return size;
}
