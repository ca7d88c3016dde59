/* The precision of declared storage formats, and perturbation of values within it. */
#include "perturb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "capture_internal.h"

/* ---- Formats by name ---- */

static struct glint_precision floating_precision(int digits, int lowest, int highest) {
    const double high = ldexp(2 - ldexp(1, -digits), highest);
    return (struct glint_precision){.digits = digits, .lowest = lowest, .low = -high, .high = high};
}

static struct glint_precision fixed_precision(int bits, bool is_signed) {
    const double steps = is_signed ? ldexp(1, bits - 1) - 1 : ldexp(1, bits) - 1;
    return (struct glint_precision){
        .fixed = true, .half_step = 0.5 / steps, .low = is_signed ? -1 : 0, .high = 1, .ends_stay = true};
}

static struct glint_precision floating_of(int bits) {
    if (bits >= 32) return floating_precision(23, -126, 127);
    /* 16, 11 and 10 bits have five of exponent; 9 share them, and each is taken for itself. */
    const int digits = bits >= 16 ? 10 : bits == 11 ? 6 : bits == 10 ? 5 : 8;
    return floating_precision(digits, -14, 15);
}

/* "R11G11B10…": the bits of the component that holds the channel, 0 when this is no such name. *rest: what follows. */
static int bits_of(const char *name, const char *channel, const char **rest) {
    const char *dot = strrchr(channel, '.'), *last = dot ? dot + 1 : channel;
    char component = last[1] ? 0 : last[0];
    if (component >= 'X' && component <= 'Z') component = "RGB"[component - 'X'];
    int first = 0, found = 0;
    while (strchr("RGBADE", *name) && *name) {
        const size_t letters = strspn(name, "RGBADE");
        char *end;
        const long bits = strtol(name + letters, &end, 10);
        if (end == name + letters || bits < 1 || bits > 64) break;
        for (size_t i = 0; i < letters && name[i] != 'E'; i++) {
            if (!first) first = (int)bits;
            if (name[i] == component || name[i] == 'D') found = (int)bits;
        }
        name = end;
    }
    *rest = name;
    return found ? found : first;
}

struct glint_precision glint_precision_of(const char *storage, const char *channel, enum glint_stored stored) {
    static const char *const prefixes[] = {"VK_FORMAT_", "DXGI_FORMAT_", "PF_", ""};
    const struct glint_precision own = stored == GLINT_STORED_HALF ? floating_of(16) : floating_of(32);
    int bits;
    if (sscanf(storage, "unorm%d", &bits) == 1 && bits > 0 && bits <= 32) return fixed_precision(bits, false);
    if (sscanf(storage, "snorm%d", &bits) == 1 && bits > 1 && bits <= 32) return fixed_precision(bits, true);
    if (!strcmp(storage, "half")) return floating_of(16);
    if (!strcmp(storage, "float")) return floating_of(32);
    size_t i = 0;
    while (strncmp(storage, prefixes[i], strlen(prefixes[i])) != 0) i++;
    const char *rest;
    bits = bits_of(storage + strlen(prefixes[i]), channel, &rest);
    const bool exponent = strstr(storage, "E5") != NULL;
    if (!bits || strstr(rest, "UINT") || strstr(rest, "SINT")) return own;
    if (strstr(rest, "SNORM")) return fixed_precision(bits, true);
    if (*rest == 'F' || strstr(rest, "FLOAT") || bits >= 32 || exponent || !strncmp(storage, "R11G11B10", 9))
        return floating_of(bits);
    struct glint_precision precision = fixed_precision(bits, false);
    precision.srgb = strstr(rest, "SRGB") != NULL;
    return precision;
}

/* A depth buffer's step of dz is one of t² / |B| dz at the distance t. */
void glint_precision_of_depth(struct glint_precision *p, const struct glint_decoder *d) {
    const double symmetric = d->frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? 2 : 1;
    if (d->encodings.depth != GLINT_DEPTH_VIEW_LINEAR) {
        p->low = 0;
        p->high = 1;
        p->ends_stay = true;
    } else if (p->fixed) {
        *p = (struct glint_precision){.of_square = symmetric * p->half_step / fabs(d->camera->view_to_clip[11]),
                                      .high = (double)INFINITY};
    }
}

double glint_half_step(const struct glint_precision *p, double value) {
    if (p->srgb) { /* the curve's slope at the value */
        const double v = fabs(value);
        return p->half_step * (v <= 0.0031308 ? 1 / 12.92 : 2.4 / 1.055 * pow(v, 1.4 / 2.4));
    }
    if (p->fixed) return p->half_step;
    if (p->of_square > 0) return p->of_square * value * value;
    int exponent;
    frexp(value, &exponent);
    return ldexp(1, (exponent - 1 < p->lowest || value == 0 ? p->lowest : exponent - 1) - p->digits - 1);
}

/* ---- Perturbing values ---- */

/* "gbuffer", "gbuffer:depth", "cubemap:distance.Z": a part's name or its role's, then a channel or its layer. */
static bool entry_matches(const char *entry, const struct glint_part_info *part, const char *channel) {
    const size_t length = strcspn(entry, ":");
    const char *role = part->role ? part->role->name : "";
    if ((strncmp(entry, part->name, length) != 0 || part->name[length]) &&
        (part->previous || strncmp(entry, role, length) != 0 || role[length]))
        return false;
    if (!entry[length]) return true;
    const char *layer = entry + length + 1;
    const size_t size = strlen(layer);
    return !strncmp(layer, channel, size) && (!channel[size] || channel[size] == '.');
}

bool glint_perturbation_moves(const struct glint_perturbation *p, const struct glint_part_info *part,
                              const char *channel) {
    for (size_t i = 0; p->seed && i < p->only_count; i++)
        if (entry_matches(p->only[i], part, channel)) return true;
    return p->seed && !p->only_count;
}

enum { TURNS = 8 };

struct glint_coins glint_perturbation_coins(const struct glint_perturbation *p, const struct glint_part_info *part,
                                            const char *channel) {
    struct glint_coins coins = {.turn = (p->seed - 1) % TURNS};
    for (size_t i = 0; i < part->channel_count && strcmp(part->channels[i].name, channel) != 0; i++)
        coins.number += glint_perturbation_moves(p, part, part->channels[i].name);
    const bool follows = coins.number < TURNS - 1;
    const uint64_t drawn = follows ? (uint64_t)((p->seed - 1) / TURNS + 1) << 32 : p->seed;
    coins.shared = XXH3_64bits_withSeed(part->name, strlen(part->name), drawn);
    coins.own = XXH3_64bits_withSeed(channel, strlen(channel), coins.shared);
    return coins;
}

double glint_perturbation_sign(const struct glint_coins *coins, uint64_t pixel) {
    uint64_t up = XXH3_64bits_withSeed(&pixel, sizeof pixel, coins->own) & 1;
    if (coins->number < TURNS - 1) {
        const uint64_t place = XXH3_64bits_withSeed(&pixel, sizeof pixel, coins->shared) >> 32;
        const uint64_t walsh = 1 + (place + coins->number) % (TURNS - 1), both = walsh & coins->turn;
        up ^= (both ^ both >> 1 ^ both >> 2) & 1;
    }
    return up ? 1 : -1;
}

void glint_perturb(const struct glint_precision *precision, const struct glint_coins *coins, uint64_t first, float *v,
                   size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double value = (double)v[i];
        if (!isfinite(value) || value == 0) continue;
        const double step = glint_half_step(precision, value), low = precision->low, high = precision->high;
        const double moved = value + glint_perturbation_sign(coins, first + i) * step;
        if (precision->ends_stay && (fmin(value, moved) <= low || fmax(value, moved) >= high)) continue;
        v[i] = (float)fmin(fmax(moved, low), high);
    }
}

bool glint_capture_perturb(struct glint_capture *capture, uint32_t seed, const char *const *only,
                           struct glint_error *err) {
    struct glint_perturbation *p = &capture->perturbation;
    free(p->only);
    *p = (struct glint_perturbation){.seed = seed};
    size_t count = 0;
    while (only && only[count]) count++;
    if (!seed || !count) return true;
    p->only = calloc(count, sizeof *p->only);
    if (!p->only) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", capture->exr->path);
    for (p->only_count = 0; p->only_count < count;) {
        char *entry = p->only[p->only_count++];
        bool known = false;
        snprintf(entry, sizeof *p->only, "%s", only[p->only_count - 1]);
        for (size_t i = 0; i < capture->count; i++)
            for (size_t c = 0; c < capture->parts[i].channel_count; c++)
                known |= entry_matches(entry, &capture->parts[i], capture->parts[i].channels[c].name);
        if (known) continue;
        p->seed = 0;
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: expected a part or PART:CHANNEL of the capture, such as gbuffer:depth, found \"%s\"",
                          capture->exr->path, only[p->only_count - 1]);
    }
    return true;
}

uint64_t glint_capture_perturbed(const struct glint_capture *capture) {
    const struct glint_perturbation *p = &capture->perturbation;
    return p->seed ? XXH3_64bits_withSeed(p->only, p->only_count * sizeof *p->only, p->seed) : 0;
}
