/* An engine's sky, in double precision, by distances from the planet's middle. What FORMAT.md says of atmosphere and clouds is the model; how light is
   scattered by clouds, and how often, is this engine's own choice. */
#include "air.h"

#include <stdlib.h>
#include <string.h>

#include "air_maps.h"
#include "dump_part.h"

static const double PI = 3.14159265358979324;

struct air {
    const struct scene *scene;
    struct glint_atmosphere gas;
    struct glint_clouds clouds;
    double sun[3], irradiance[3];
    struct air_maps maps;
};

struct rgb {
    double c[3];
};

static void put3(vec3 v, double out[3]) {
    out[0] = (double)v.x, out[1] = (double)v.y, out[2] = (double)v.z;
}
static double dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct air *air_create(const struct scene *scene, double time, struct glint_error *err) {
    struct air *air = calloc(1, sizeof *air);
    if (!air) {
        glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the sky");
        return NULL;
    }
    air->scene = scene;
    /* Of the earth: E. Bruneton, Precomputed Atmospheric Scattering, 2017. The light has the scene's own unit. */
    const float light = 12 * scene->gain;
    air->gas = (struct glint_atmosphere){.planet_radius = 6360e3,
                                         .top = 60e3,
                                         .irradiance = {light, light, light},
                                         .rayleigh = {5.802e-6f, 13.558e-6f, 33.1e-6f},
                                         .rayleigh_height = 8000,
                                         .mie = 3.996e-6,
                                         .mie_extinction = 4.44e-6,
                                         .mie_height = 1200,
                                         .mie_asymmetry = 0.76};
    air->clouds = (struct glint_clouds){.bottom = 1200,
                                        .top = 2800,
                                        .tile = 14000,
                                        .noise_tile = 1600,
                                        .extinction = 0.02,
                                        .erosion = 0.6,
                                        .offset = {3000 + 0.4 * time, 5000 + 0.15 * time}};
    put3(scene->sun_direction, air->sun);
    const double length = sqrt(dot3(air->sun, air->sun));
    for (int i = 0; i < 3; i++) {
        air->sun[i] = length > 0 ? air->sun[i] / length : 0;
        air->irradiance[i] = length > 0 ? (double)air->gas.irradiance[i] : 0;
    }
    air_maps_fill(&air->maps);
    return air;
}

void air_destroy(struct air **air) {
    free(*air);
    *air = NULL;
}

void air_describe(const struct air *air, const double offset[3], struct glint_frame *frame) {
    frame->has_atmosphere = frame->has_clouds = true;
    frame->atmosphere = air->gas;
    frame->clouds = air->clouds;
    frame->atmosphere.ground = frame->clouds.ground = offset[1];
    frame->clouds.offset[0] += offset[0];
    frame->clouds.offset[1] += offset[2];
}

/* ---- rays about the planet's middle ---- */

struct ray {
    double from[3], direction[3]; /* from the planet's middle */
    double world[2];              /* x and z of the start in the world */
};

static struct ray ray_of(const struct air *air, vec3 eye, vec3 direction) {
    struct ray ray;
    vec3 d = unit(direction);
    put3(d, ray.direction);
    const double length = sqrt(dot3(ray.direction, ray.direction));
    for (int i = 0; i < 3; i++) ray.direction[i] /= length;
    ray.from[0] = ray.from[2] = 0;
    ray.from[1] = air->gas.planet_radius + fmax((double)eye.y, 0);
    ray.world[0] = (double)eye.x, ray.world[1] = (double)eye.z;
    return ray;
}
static struct ray towards_sun(const struct air *air, const struct ray *ray, double t) {
    struct ray out;
    for (int i = 0; i < 3; i++) out.from[i] = ray->from[i] + t * ray->direction[i], out.direction[i] = air->sun[i];
    out.world[0] = ray->world[0] + t * ray->direction[0], out.world[1] = ray->world[1] + t * ray->direction[2];
    return out;
}
static double altitude(const struct air *air, const struct ray *ray, double t) {
    double p[3];
    for (int i = 0; i < 3; i++) p[i] = ray->from[i] + t * ray->direction[i];
    return sqrt(dot3(p, p)) - air->gas.planet_radius;
}
/* Where the ray crosses a sphere at this altitude: both places, or false. */
static bool crosses(const struct air *air, const struct ray *ray, double level, double t[2]) {
    const double r = air->gas.planet_radius + level, b = dot3(ray->from, ray->direction),
                 inner = b * b - dot3(ray->from, ray->from) + r * r;
    if (inner < 0) return false;
    t[0] = -b - sqrt(inner), t[1] = -b + sqrt(inner);
    return true;
}
static bool hits_ground(const struct air *air, const struct ray *ray) {
    double t[2];
    return crosses(air, ray, 0, t) && t[0] > 0;
}

/* ---- the atmosphere ---- */

static struct rgb extinction(const struct air *air, double high, double *molecules, double *particles) {
    struct rgb e;
    *molecules = exp(-high / air->gas.rayleigh_height), *particles = exp(-high / air->gas.mie_height);
    for (int i = 0; i < 3; i++)
        e.c[i] = (double)air->gas.rayleigh[i] * *molecules + air->gas.mie_extinction * *particles;
    return e;
}

/* Of the sun's light above the atmosphere, what comes to the start of a ray towards it: by Simpson's rule over t², which is fine near the start. */
static struct rgb sun_through(const struct air *air, const struct ray *ray) {
    enum { PARTS = 24 };
    struct rgb sum = {{0}};
    double t[2], m, p;
    if (hits_ground(air, ray) || !crosses(air, ray, air->gas.top, t)) return sum;
    for (int i = 0; i <= PARTS; i++) {
        const double u = (double)i / PARTS, weight = (i == 0 || i == PARTS ? 1 : i % 2 ? 4 : 2) / (3.0 * PARTS) * 2 * u;
        const struct rgb e = extinction(air, altitude(air, ray, t[1] * u * u), &m, &p);
        for (int k = 0; k < 3; k++) sum.c[k] += weight * t[1] * e.c[k];
    }
    for (int k = 0; k < 3; k++) sum.c[k] = exp(-sum.c[k]);
    return sum;
}

struct seen {
    struct rgb light, passed;
};

/* What the air between two places scatters to the camera, and what passes it. */
static struct seen scattered(const struct air *air, const struct ray *ray, double far, int steps) {
    const double cosine = dot3(ray->direction, air->sun), g = air->gas.mie_asymmetry,
                 rayleigh = 3 / (16 * PI) * (1 + cosine * cosine),
                 mie = (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cosine, 1.5));
    struct seen s = {{{0}}, {{1, 1, 1}}};
    for (int i = 0; i < steps; i++) {
        const double a = (double)i / steps, b = (double)(i + 1) / steps, step = far * (b * b - a * a),
                     t = far * (a * a + b * b) / 2;
        double m, p;
        const struct ray up = towards_sun(air, ray, t);
        const struct rgb sun = sun_through(air, &up), e = extinction(air, altitude(air, ray, t), &m, &p);
        for (int k = 0; k < 3; k++) {
            const double source = (double)air->gas.rayleigh[k] * m * rayleigh + air->gas.mie * p * mie,
                         kept = exp(-e.c[k] * step);
            s.light.c[k] +=
                s.passed.c[k] * air->irradiance[k] * sun.c[k] * source * (e.c[k] > 0 ? (1 - kept) / e.c[k] : step);
            s.passed.c[k] *= kept;
        }
    }
    return s;
}

/* ---- clouds ---- */

/* Linear between the middles of cells of a square that repeats. */
static double between(const float *values, int side, double u, double v) {
    const double x = (u - floor(u)) * side - 0.5, y = (v - floor(v)) * side - 0.5;
    const int x0 = (int)floor(x), y0 = (int)floor(y);
    double sum = 0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const double weight = (i ? x - x0 : 1 - (x - x0)) * (j ? y - y0 : 1 - (y - y0));
            sum += weight * (double)values[(y0 + j + side) % side * side + (x0 + i + side) % side];
        }
    return sum;
}
static double layered(const float *values, double u, double v, double rise) {
    const double z = fmin(fmax(rise * CLOUD_SLICES - 0.5, 0), CLOUD_SLICES - 1);
    const int k = z < CLOUD_SLICES - 1 ? (int)z : CLOUD_SLICES - 2;
    const double low = between(values + k * CLOUD_SIDE * CLOUD_SIDE, CLOUD_SIDE, u, v),
                 high = between(values + (k + 1) * CLOUD_SIDE * CLOUD_SIDE, CLOUD_SIDE, u, v);
    return low + (z - k) * (high - low);
}
static double noise_at(const struct air *air, double u, double v, double w) {
    const double z = (w - floor(w)) * CLOUD_NOISE - 0.5;
    const int k = (int)floor(z);
    const double low = between(&air->maps.noise[(k + CLOUD_NOISE) % CLOUD_NOISE][0][0], CLOUD_NOISE, u, v),
                 high = between(&air->maps.noise[(k + 1) % CLOUD_NOISE][0][0], CLOUD_NOISE, u, v);
    return low + (z - k) * (high - low);
}

/* 1/m */
static double cloud_at(const struct air *air, const struct ray *ray, double t) {
    const struct glint_clouds *c = &air->clouds;
    const double high = altitude(air, ray, t), rise = (high - c->bottom) / (c->top - c->bottom);
    if (rise < 0 || rise > 1) return 0;
    const double x = ray->world[0] + t * ray->direction[0] - c->offset[0],
                 z = ray->world[1] + t * ray->direction[2] - c->offset[1];
    double full = layered(&air->maps.density[0][0][0], x / c->tile, z / c->tile, rise);
    if (full > 0)
        full *= fmin(
            fmax(1 + CLOUD_SLICES * (layered(&air->maps.height[0][0][0], x / c->tile, z / c->tile, rise) - rise), 0),
            1);
    if (full > 0) full -= c->erosion * noise_at(air, x / c->noise_tile, z / c->noise_tile, high / c->noise_tile);
    return c->extinction * fmax(full, 0);
}

/* Optical depth of the clouds towards the sun, up to a distance. */
static double cloud_depth(const struct air *air, const struct ray *ray, double most, int steps) {
    double t[2], sum = 0;
    if (!crosses(air, ray, air->clouds.top, t)) return 0;
    const double far = fmin(t[1], most);
    for (int i = 0; i < steps; i++) sum += cloud_at(air, ray, far * (i + 0.5) / steps) * far / steps;
    return sum;
}

static double lobes(double cosine, double factor) {
    const double ahead = 0.8 * factor, back = 0.3 * factor;
    return 0.7 * (1 - ahead * ahead) / (4 * PI * pow(1 + ahead * ahead - 2 * ahead * cosine, 1.5)) +
           0.3 * (1 - back * back) / (4 * PI * pow(1 + back * back + 2 * back * cosine, 1.5));
}

struct cloud {
    double mask, light, distance; /* light: once and more often, for a sun of irradiance 1 */
};
static struct cloud clouds_along(const struct air *air, const struct ray *ray) {
    enum { STEPS = 160, LIGHT_STEPS = 12, OCTAVES = 5 };
    static const double FARTHEST = 60000, SHADOW = 1500;
    struct cloud found = {0, 0, 0};
    double low[2], high[2], passed = 1;
    if (hits_ground(air, ray) || !crosses(air, ray, air->clouds.bottom, low) ||
        !crosses(air, ray, air->clouds.top, high))
        return found;
    const double begin = fmax(low[1], 0), step = (fmin(high[1], FARTHEST) - begin) / STEPS,
                 cosine = dot3(ray->direction, air->sun);
    for (int i = 0; i < STEPS && step > 0 && passed > 1e-5; i++) {
        const double t = begin + step * (i + 0.5), density = cloud_at(air, ray, t),
                     covered = passed * (1 - exp(-density * step));
        if (!(covered > 0)) continue;
        const struct ray up = towards_sun(air, ray, t);
        const double depth = cloud_depth(air, &up, SHADOW, LIGHT_STEPS);
        if (!hits_ground(air, &up))
            for (int k = 0; k < OCTAVES; k++)
                found.light += covered * ldexp(lobes(cosine, ldexp(1, -k)) * exp(-ldexp(depth, -k)), -k);
        found.distance += covered * t;
        passed -= covered;
    }
    found.mask = 1 - passed;
    if (found.mask > 0) found.distance /= found.mask;
    return found;
}

/* ---- all of it ---- */

/* OpenGL's cube maps, by the face's own axes. */
static struct rgb stars_at(const struct air *air, const double d[3]) {
    static const double axes[6][3][3] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                         {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                         {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};
    int face = 0;
    struct rgb sum = {{0}};
    for (int f = 1; f < 6; f++)
        if (dot3(axes[f][0], d) > dot3(axes[face][0], d)) face = f;
    const double far = dot3(axes[face][0], d), most = STAR_SIDE - 1,
                 x = fmin(fmax((dot3(axes[face][1], d) / far + 1) / 2 * STAR_SIDE - 0.5, 0), most),
                 y = fmin(fmax((dot3(axes[face][2], d) / far + 1) / 2 * STAR_SIDE - 0.5, 0), most);
    for (int corner = 0; corner < 4; corner++) {
        const int i = (int)fmin(floor(x) + (corner & 1), most), j = (int)fmin(floor(y) + (corner >> 1), most);
        const double weight =
            (corner & 1 ? x - floor(x) : 1 - (x - floor(x))) * (corner >> 1 ? y - floor(y) : 1 - (y - floor(y)));
        double star[3];
        put3(air->maps.stars[face][j][i], star);
        for (int k = 0; k < 3; k++) sum.c[k] += weight * star[k];
    }
    return sum;
}

static vec3 look(const struct air *air, vec3 eye, vec3 direction) {
    enum { STEPS = 48 };
    const struct ray ray = ray_of(air, eye, direction);
    double t[2] = {0, 0}, ground[2];
    crosses(air, &ray, air->gas.top, t);
    const bool open = !hits_ground(air, &ray);
    if (!open && crosses(air, &ray, 0, ground)) t[1] = ground[0];
    const struct seen all = scattered(air, &ray, t[1], STEPS);
    const struct cloud cloud = clouds_along(air, &ray);
    struct seen before = {{{0}}, {{1, 1, 1}}};
    struct rgb own = {{0}};
    const struct rgb stars = stars_at(air, ray.direction);
    if (cloud.mask > 0) {
        const struct ray up = towards_sun(air, &ray, cloud.distance);
        before = scattered(air, &ray, cloud.distance, STEPS / 3);
        own = sun_through(air, &up);
    }
    double out[3];
    for (int k = 0; k < 3; k++) {
        const double behind = all.light.c[k] - before.light.c[k] + (open ? all.passed.c[k] * stars.c[k] : 0);
        out[k] = before.light.c[k] + (1 - cloud.mask) * behind +
                 before.passed.c[k] * cloud.light * air->irradiance[k] * own.c[k];
    }
    return v3((float)out[0], (float)out[1], (float)out[2]);
}

struct paint_work {
    const struct air *air;
    const struct world *world;
    const struct view *view;
    struct pixel *pixels;
    vec3 eye;
    uint32_t size;
    struct texel *texels;
};
/* Takes away the sun's light that clouds keep from a surface, which is a part of the light that is neither indirect nor its own. */
static void shade_pixel(const struct paint_work *work, uint32_t x, uint32_t y, struct pixel *pixel) {
    const struct scene *scene = work->air->scene;
    const struct hit hit = primary_hit(work->world, work->view, x, y);
    const float cosine = hit.t < INFINITY ? dot(hit.normal, scene->sun_direction) : 0;
    if (cosine <= 0 || world_blocked(work->world, world_leave(&hit, hit.normal), scene->sun_direction, INFINITY))
        return;
    const float kept = 1 - air_sunlight(work->air, hit.position),
                light = kept * scene->gain * cosine * (1 - pixel->metalness) / PI_F;
    const vec3 most = sub(sub(sub(pixel->lit, pixel->indirect), pixel->emission), pixel->lamps),
               sun = times(scale(scene->sun_irradiance, light), pixel->albedo);
    pixel->lit = sub(pixel->lit, v3(clampf(sun.x, 0, fmaxf(most.x, 0)), clampf(sun.y, 0, fmaxf(most.y, 0)),
                                    clampf(sun.z, 0, fmaxf(most.z, 0))));
}
static void paint_row(void *user, uint32_t y) {
    const struct paint_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        struct pixel *pixel = &work->pixels[(size_t)y * work->view->width + x];
        if (pixel->depth < INFINITY) shade_pixel(work, x, y, pixel);
        else pixel->lit = look(work->air, view_eye(work->view), view_ray(work->view, x, y));
    }
}
static void paint_cube_row(void *user, uint32_t row) {
    const struct paint_work *work = user;
    for (uint32_t x = 0; x < work->size; x++)
        work->texels[(size_t)row * work->size + x].color =
            look(work->air, work->eye, cube_direction(row / work->size, x, row % work->size, work->size));
}

bool air_paint(const struct air *air, const struct world *world, const struct view *view, struct pixel *pixels,
               struct job *job, struct glint_error *err) {
    struct paint_work work = {.air = air, .world = world, .view = view, .pixels = pixels};
    return parallel_for(job, "drawing the sky", 0, view->height, paint_row, &work, err);
}
bool air_paint_cube(const struct air *air, vec3 eye, uint32_t size, struct texel *texels, struct job *job,
                    struct glint_error *err) {
    struct paint_work work = {.air = air, .eye = eye, .size = size, .texels = texels};
    return parallel_for(job, "drawing the sky", 0, 6 * size, paint_cube_row, &work, err);
}

float air_sunlight(const struct air *air, vec3 point) {
    enum { STEPS = 64 };
    const struct ray here = ray_of(air, point, v3(0, 1, 0)), up = towards_sun(air, &here, 0);
    double low[2];
    if (hits_ground(air, &up) || !crosses(air, &up, air->clouds.bottom, low)) return 1;
    const struct ray above = towards_sun(air, &up, fmax(low[1], 0));
    return (float)exp(-cloud_depth(air, &above, INFINITY, STEPS));
}

static bool write_map(const struct dump *dump, const char *name, const char *channel, uint32_t side, uint32_t slices,
                      const float *values, struct glint_error *err) {
    static const struct storage byte = {GLINT_UNORM8, "R8"};
    struct dump_part part;
    dump_begin(&part, dump, name, side, side * slices);
    dump_channel(&part, channel, byte, values, sizeof *values);
    return dump_end(&part, dump, err);
}

bool air_write(const struct dump *dump, const struct air *air, struct glint_error *err) {
    const struct air_maps *maps = &air->maps;
    struct dump_part part;
    return dump_colors(&part, dump, "stars", STAR_SIDE, 6 * STAR_SIDE, dump_half, &maps->stars[0][0][0], sizeof(vec3),
                       err) &&
           dump_end(&part, dump, err) &&
           write_map(dump, "cloud.density", "density", CLOUD_SIDE, CLOUD_SLICES, &maps->density[0][0][0], err) &&
           write_map(dump, "cloud.height", "height", CLOUD_SIDE, CLOUD_SLICES, &maps->height[0][0][0], err) &&
           write_map(dump, "cloud.noise", "noise", CLOUD_NOISE, CLOUD_NOISE, &maps->noise[0][0][0], err);
}
