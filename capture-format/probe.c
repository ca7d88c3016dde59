/* The levels of probes that an engine pre-filtered by roughness. */
#include "probe.h"

static const struct glint_part_info *level_of(const struct glint_part_info *parts, size_t count, int32_t index,
                                              int32_t level) {
    for (size_t i = 0; i < count; i++)
        if (parts[i].has_probe && parts[i].index == index && parts[i].level == level) return &parts[i];
    return NULL;
}

size_t glint_probe_levels(const struct glint_part_info *parts, size_t count, int32_t index,
                          const struct glint_part_info *levels[GLINT_MAX_LEVELS], double roughness[GLINT_MAX_LEVELS]) {
    size_t found = 0;
    while (found < GLINT_MAX_LEVELS && (levels[found] = level_of(parts, count, index, (int32_t)found))) found++;
    for (size_t l = 0; l < found; l++) {
        const double evenly = found > 1 ? (double)l / (double)(found - 1) : 0;
        roughness[l] = levels[l]->probe.has_roughness ? levels[l]->probe.roughness : evenly;
    }
    return found;
}

size_t glint_capture_probe(const struct glint_capture *capture, int32_t index,
                           const struct glint_part_info *levels[GLINT_MAX_LEVELS], double roughness[GLINT_MAX_LEVELS]) {
    const size_t count = glint_capture_part_count(capture);
    return count ? glint_probe_levels(glint_capture_part(capture, 0), count, index, levels, roughness) : 0;
}

#define BROKEN(part, ...) glint_violation(check, GLINT_RULE_PROBE, (part)->name, NULL, __VA_ARGS__)

static bool check_level(struct glint_check *check, const struct glint_part_info *const *levels, const double *roughness,
                        size_t l) {
    const uint32_t half = levels[l - 1]->width / 2, expected = half ? half : 1;
    if (levels[l]->width != expected && !BROKEN(levels[l], "expected faces of %u, half of those of %s, found %u",
                                                expected, levels[l - 1]->name, levels[l]->width))
        return false;
    if (roughness[l] > roughness[l - 1]) return true;
    return BROKEN(levels[l], "expected a roughness above %g, that of %s, found %g", roughness[l - 1],
                  levels[l - 1]->name, roughness[l]);
}

bool glint_probes_check(struct glint_check *check, const struct glint_part_info *parts, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const struct glint_part_info *levels[GLINT_MAX_LEVELS];
        double roughness[GLINT_MAX_LEVELS];
        if (!parts[i].has_probe) continue;
        const size_t found = glint_probe_levels(parts, count, parts[i].index, levels, roughness);
        if ((size_t)parts[i].level >= found) {
            if (!BROKEN(&parts[i], "expected levels from 0 without a gap, at most %d, found none of number %zu",
                        GLINT_MAX_LEVELS, found))
                return false;
        } else if (parts[i].level && !check_level(check, levels, roughness, (size_t)parts[i].level)) return false;
    }
    return true;
}
