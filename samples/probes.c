/* Candidates are on a grid over the scene's bounding box, not inside of objects and with free space around them. From these, the one
   that is farthest from all chosen ones is chosen repeatedly. */
#include "probes.h"

#include "noise.h"

enum { ACROSS = 9, UP = 5, RAYS = 48, WANTED = 8 };

struct place {
    vec3 at;
    float room;   /* distance to the nearest surface among the tested directions; 0: not free */
    bool outdoor; /* most of the upper hemisphere is sky */
};

static struct place survey(const struct world *world, vec3 at, float diagonal) {
    struct place place = {.at = at, .room = INFINITY};
    int behind = 0, above = 0, open = 0;
    for (uint32_t i = 0; i < RAYS; i++) { /* Fibonacci directions */
        float y = 1 - 2 * ((float)i + 0.5f) / RAYS, r = sqrtf(1 - y * y), phi = 2.39996323f * (float)i;
        struct hit hit = world_trace(world, at, v3(r * cosf(phi), y, r * sinf(phi)), 0);
        above += y > 0;
        open += y > 0 && !(hit.t < INFINITY);
        behind += hit.from_behind;
        if (hit.t < place.room) place.room = hit.t;
    }
    place.outdoor = 2 * open > above;
    if (4 * behind > RAYS || place.room < 0.02f * diagonal) place.room = 0;
    place.room = fminf(place.room, 0.25f * diagonal);
    return place;
}

void place_probes(struct scene *scene, const struct world *world) {
    struct place places[ACROSS * UP * ACROSS];
    vec3 low, high;
    if (!scene_bounds(scene, &low, &high)) return;
    vec3 size = sub(high, low);
    float diagonal = fmaxf(length(size), 1e-3f);
    /* a flat scene has free space above it */
    if (size.y < 0.1f * diagonal) high.y = low.y + 0.2f * diagonal;
    size = sub(high, low);
    uint32_t count = 0;
    for (uint32_t i = 0; i < ACROSS * UP * ACROSS; i++) {
        vec3 f = v3((float)(i % ACROSS + 1) / (ACROSS + 1), (float)(i / ACROSS % UP + 1) / (UP + 1),
                    (float)(i / (ACROSS * UP) + 1) / (ACROSS + 1));
        struct place place = survey(world, add(low, times(size, f)), diagonal);
        if (place.room > 0) places[count++] = place;
    }
    scene->cubemap_count = 0;
    for (uint32_t n = 0; n < WANTED && n < count; n++) {
        uint32_t best = 0;
        float best_score = -INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            float apart = n ? INFINITY : -length(sub(places[i].at, scene->eye));
            for (uint32_t k = 0; k < n; k++) {
                const double *c = scene->cubemaps[k].center;
                apart = fminf(apart, length(sub(places[i].at, v3((float)c[0], (float)c[1], (float)c[2]))));
            }
            float score = n ? apart + 0.5f * places[i].room : apart;
            if (score > best_score) {
                best_score = score;
                best = i;
            }
        }
        scene_cubemap(scene, places[best].at, places[best].outdoor);
    }
}
