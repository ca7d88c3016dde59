/* Interprets parts of an EXR file as parts of a capture, and checks the rules for them. */
#include "part.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "attributes.h"
#include "nearest.h"
#include "probe.h"
#include "sibling.h"

#define BROKEN(rule, channel, ...) glint_violation(check, GLINT_RULE_##rule, out->name, channel, __VA_ARGS__)

int glint_part_encoding(const struct glint_part_info *part, const struct glint_role_channel *channel) {
    const struct glint_encoding_row *row = glint_encoding_find(channel->encoding);
    return row ? glint_encoding_get(&part->encodings, row) : 0;
}

bool glint_normal_has_z(enum glint_normal_encoding encoding) {
    return encoding == GLINT_NORMAL_SIGNED || encoding == GLINT_NORMAL_UNORM;
}

static bool is_normal(const struct glint_role_channel *channel) {
    return !strcmp(channel->encoding, "normal") || !strcmp(channel->encoding, "vertex_normal");
}

static bool ends_in(const char *name, const char *end) {
    const size_t length = strlen(name), tail = strlen(end);
    return length >= tail && !strcmp(name + length - tail, end);
}

bool glint_part_has_channel(const struct glint_part_info *part, const char *channel) {
    for (size_t i = 0; i < part->channel_count; i++)
        if (!strcmp(part->channels[i].name, channel)) return true;
    /* The Z of some normals is reconstructed from X and Y. */
    const struct glint_role_channel *row = glint_role_channel_find(part->role, channel);
    if (!row || !is_normal(row) || !ends_in(channel, ".Z")) return false;
    if (glint_normal_has_z((enum glint_normal_encoding)glint_part_encoding(part, row))) return false;
    char other[64];
    snprintf(other, sizeof other, "%s", channel);
    other[strlen(other) - 1] = 'X';
    return glint_part_has_channel(part, other);
}

/* ---- attributes of a part ---- */

static bool parse_version(struct glint_check *check, const struct glint_exr_part_info *from,
                          const struct glint_part_info *out) {
    const struct glint_exr_attribute *version = glint_exr_attribute(from, GLINT_VERSION_ATTRIBUTE);
    if (!version || version->type != GLINT_EXR_INT)
        return BROKEN(VERSION, NULL, "%s: expected an int, found %s", GLINT_VERSION_ATTRIBUTE,
                      version ? version->type_name : "none");
    if (version->numbers[0] != GLINT_FORMAT_VERSION)
        return BROKEN(VERSION, NULL, "%s: expected %d, found %g", GLINT_VERSION_ATTRIBUTE, GLINT_FORMAT_VERSION,
                      version->numbers[0]);
    return true;
}

static bool parse_encodings(struct glint_check *check, const struct glint_exr_part_info *from,
                            struct glint_part_info *out) {
    size_t count = 0;
    const struct glint_encoding_row *rows = glint_encoding_rows(&count);
    for (size_t i = 0; i < count; i++) {
        const struct glint_exr_attribute *a = glint_exr_attribute(from, rows[i].attribute);
        if (!a) continue;
        const int value = a->type == GLINT_EXR_STRING ? glint_encoding_value(rows[i].which, a->string) : -1;
        if (value >= 0) glint_encoding_set(&out->encodings, &rows[i], value);
        else if (!BROKEN(ENCODING, NULL, "%s: expected an encoding such as \"%s\", found \"%.60s\"", a->name,
                         rows[i].values[0].name, a->type == GLINT_EXR_STRING ? a->string : a->type_name))
            return false;
    }
    return true;
}

/* A format may have any name. The channel is one of the role, which the part may lack. */
static bool check_storage(struct glint_check *check, const struct glint_part_info *out, const char *entry) {
    const char *equals = strchr(entry, '=');
    struct glint_nearest nearest;
    char channel[256];
    if (!equals || equals == entry || !equals[1])
        return BROKEN(ATTRIBUTE, GLINT_STORAGE_ATTRIBUTE, "expected channel=format, found \"%.60s\"", entry);
    snprintf(channel, sizeof channel, "%.*s", (int)(equals - entry), entry);
    if (!out->role->channels || glint_role_channel_find(out->role, channel)) return true;
    nearest = glint_nearest_to(channel);
    for (size_t i = 0; i < out->role->channel_count; i++) glint_nearest_offer(&nearest, out->role->channels[i].name);
    return BROKEN(ATTRIBUTE, GLINT_STORAGE_ATTRIBUTE, "expected a channel of %s, found %.60s%s", out->role->name,
                  channel, glint_nearest_text(&nearest));
}

static bool parse_storage(struct glint_check *check, const struct glint_exr_part_info *from,
                          const struct glint_part_info *out, struct glint_channel_info *channels) {
    const struct glint_exr_attribute *a = glint_exr_attribute(from, GLINT_STORAGE_ATTRIBUTE);
    if (a && a->type != GLINT_EXR_STRINGS)
        return BROKEN(ATTRIBUTE, GLINT_STORAGE_ATTRIBUTE, "expected type stringvector, found %s", a->type_name);
    for (size_t i = 0; a && i < a->count; i++) {
        const char *equals = strchr(a->strings[i], '=');
        if (!check_storage(check, out, a->strings[i])) return false;
        for (size_t c = 0; equals && c < from->channel_count; c++) {
            const size_t length = strlen(channels[c].name);
            if ((size_t)(equals - a->strings[i]) == length && !strncmp(a->strings[i], channels[c].name, length))
                snprintf(channels[c].storage, sizeof channels[c].storage, "%.63s", equals + 1);
        }
    }
    return true;
}

static bool parse_sibling(struct glint_check *check, const struct glint_exr_part_info *from,
                          struct glint_part_info *out) {
    const struct glint_exr_attribute *a = glint_exr_attribute(from, GLINT_SIBLING_ATTRIBUTE);
    const struct glint_exr_attribute *hash = glint_exr_attribute(from, GLINT_SIBLING_HASH_ATTRIBUTE);
    if (!a && !hash) return true;
    if (!a)
        return BROKEN(SIBLING, NULL, "expected %s beside %s, found none", GLINT_SIBLING_ATTRIBUTE,
                      GLINT_SIBLING_HASH_ATTRIBUTE);
    if (a->type != GLINT_EXR_STRING || strlen(a->string) >= sizeof out->sibling || !glint_sibling_is_plain(a->string))
        return BROKEN(SIBLING, NULL, "%s: expected a plain file name, found \"%.80s\"", GLINT_SIBLING_ATTRIBUTE,
                      a->type == GLINT_EXR_STRING ? a->string : a->type_name);
    if (!hash || hash->type != GLINT_EXR_STRING || strlen(hash->string) != 32 ||
        strspn(hash->string, "0123456789abcdef") != 32)
        return BROKEN(SIBLING, NULL, "%s: expected 32 hexadecimal digits, found \"%.40s\"",
                      GLINT_SIBLING_HASH_ATTRIBUTE, hash && hash->type == GLINT_EXR_STRING ? hash->string : "none");
    if (strcmp(out->role->name, "cubemap"))
        return BROKEN(SIBLING, NULL, "%s: expected it on cubemap.NNN only", GLINT_SIBLING_ATTRIBUTE);
    if ((from->width != 1 || from->height != 6) &&
        !BROKEN(SIBLING, NULL, "expected a placeholder of 1 x 6 pixels, found %u x %u", from->width, from->height))
        return false;
    snprintf(out->sibling, sizeof out->sibling, "%s", a->string);
    return true;
}

/* Attributes unknown to glint, of the types of the public header. */
static bool keep_foreign(struct glint_arena *arena, const struct glint_exr_part_info *from,
                         struct glint_part_info *out) {
    struct glint_attribute *kept = glint_arena_take(arena, (from->attribute_count + 1) * sizeof *kept);
    out->attributes = kept;
    for (size_t i = 0; kept && i < from->attribute_count; i++) {
        const struct glint_exr_attribute *a = &from->attributes[i];
        if (glint_attribute_is_ours(a->name)) continue;
        struct glint_attribute *to = &kept[out->attribute_count];
        to->name = a->name;
        to->type = a->type == GLINT_EXR_STRING ? GLINT_ATTRIBUTE_STRING
                   : a->type == GLINT_EXR_INT  ? GLINT_ATTRIBUTE_INT
                                               : GLINT_ATTRIBUTE_DOUBLE;
        if (a->type == GLINT_EXR_STRING) to->string = a->string;
        else if (a->type == GLINT_EXR_INT || a->type == GLINT_EXR_FLOAT || a->type == GLINT_EXR_DOUBLE)
            to->number = a->numbers[0];
        else continue;
        out->attribute_count++;
    }
    return kept != NULL;
}

/* ---- channels ---- */

/* The suffixes of a vector's channels; NULL for a scalar. */
static const char *axes_of(const struct glint_role_channel *row) {
    if (is_normal(row) || !strcmp(row->encoding, "motion")) return "XYZ";
    return ends_in(row->name, ".R") || ends_in(row->name, ".G") || ends_in(row->name, ".B") ? "RGB" : NULL;
}

/* A previous G-buffer only needs depth, which shows what was occluded then. */
static bool is_required(const struct glint_part_info *out, const struct glint_role_channel *row) {
    return row->required && (!out->previous || strcmp(out->role->name, "gbuffer") || !strcmp(row->encoding, "depth"));
}

bool glint_part_can_read(const struct glint_part_info *part, const char *channel) {
    const struct glint_role_channel *row = glint_role_channel_find(part->role, channel);
    return glint_part_has_channel(part, channel) || (row && !isnan(row->absent));
}

bool glint_part_needs_channel(const struct glint_part_info *part, const char *channel) {
    const struct glint_role_channel *row = glint_role_channel_find(part->role, channel);
    return row && is_required(part, row);
}

static bool check_required(struct glint_check *check, const struct glint_part_info *out) {
    for (size_t i = 0; i < out->role->channel_count; i++) {
        const struct glint_role_channel *row = &out->role->channels[i];
        bool required = is_required(out, row);
        char other[64];
        snprintf(other, sizeof other, "%s", row->name);
        /* Optional vectors must be complete: one of X, Y, Z requires the others; motion.Z remains optional. */
        for (const char *axis = axes_of(row); axis && *axis; axis++) {
            other[strlen(other) - 1] = *axis;
            required = required || glint_part_has_channel(out, other);
        }
        if (required && !glint_part_has_channel(out, row->name) && !BROKEN(CHANNELS, row->name, "missing"))
            return false;
    }
    return true;
}

static bool check_channel(struct glint_check *check, const struct glint_part_info *out,
                          const struct glint_channel_info *channel) {
    const struct glint_role_channel *row = glint_role_channel_find(out->role, channel->name);
    if (!row) return BROKEN(CHANNELS, channel->name, "expected a channel of %s, found another", out->role->name);
    const int encoding = glint_part_encoding(out, row);
    if (is_normal(row) && ends_in(row->name, ".Z") && !glint_normal_has_z((enum glint_normal_encoding)encoding))
        return BROKEN(CHANNELS, channel->name, "expected no Z beside a normal that is %s, found one",
                      glint_encoding_name(row->encoding, encoding));
    const bool integer = !strcmp(row->name, "stencil.id") ||
                         (!strcmp(row->encoding, "motion") && encoding == GLINT_MOTION_PACKED16) ||
                         (!strcmp(row->encoding, "motion_depth") && encoding == GLINT_MOTION_DEPTH_PACKED16);
    if (integer != (channel->stored == GLINT_STORED_UINT))
        return BROKEN(TYPES, channel->name, "expected %s, found %s", integer ? "uint" : "half or float",
                      glint_stored_name(channel->stored));
    return true;
}

static bool check_channels(struct glint_check *check, const struct glint_part_info *out) {
    if (!out->role->channels || out->sibling[0]) return true;
    for (size_t i = 0; i < out->channel_count; i++)
        if (!check_channel(check, out, &out->channels[i])) return false;
    return check_required(check, out);
}

static bool check_grid(struct glint_check *check, const struct glint_part_info *out) {
    const double *m = out->volume.world_to_grid;
    if (!out->has_volume) return true;
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        return BROKEN(GRID, "glint.worldToGrid", "expected the last row 0 0 0 1, found %g %g %g %g", m[12], m[13],
                      m[14], m[15]);
    return (out->volume.slices && out->height % out->volume.slices == 0) ||
           BROKEN(GRID, "glint.volumeSlices", "expected a height of a whole number of slices, found %u and %u slices",
                  out->height, out->volume.slices);
}

static bool check_froxels(struct glint_check *check, const struct glint_part_info *out) {
    const struct glint_froxels *froxels = &out->froxels;
    const double near = froxels->near_depth, far = froxels->far_depth;
    if (!out->has_froxels) return true;
    if (!froxels->slices || froxels->slices > GLINT_MAX_FROXEL_SLICES || out->height % froxels->slices != 0)
        return BROKEN(FROXELS, "glint.froxelSlices",
                      "expected 1 to %d slices in a height of a whole number of them, found %u and %u slices",
                      GLINT_MAX_FROXEL_SLICES, out->height, froxels->slices);
    return ((float)near < (float)far && far >= 1e-6 && far <= 1e9 && (!froxels->exponential || near >= far / 1e9)) ||
           BROKEN(FROXELS, "glint.froxelNear", "expected %s < froxelFar, from 1e-6 to 1e9, found %g and %g",
                  froxels->exponential ? "froxelFar / 1e9 <= froxelNear" : "froxelNear", near, far);
}

/* The attributes of the role, but for those of the frame, which all parts need. */
static bool parse_scopes(struct glint_check *check, const struct glint_exr_part_info *from,
                         struct glint_part_info *out) {
    for (int i = 0; i < GLINT_SCOPE_COUNT; i++) {
        const enum glint_scope scope = (enum glint_scope)i;
        const struct glint_scope_row *row = glint_scope_row(scope);
        if (row->of_frame || !glint_scope_is_on(scope, out->role, out->previous)) continue;
        *(bool *)((char *)out + row->has) = true;
        if (!glint_attributes_decode(check, from, scope, (char *)out + row->found)) return false;
    }
    if (!check_grid(check, out) || !check_froxels(check, out)) return false;
    const struct glint_probe_box *box = &out->probe.box;
    for (int i = 0; out->probe.has_box && i < 3; i++)
        if (!(box->min[i] < box->max[i]))
            return BROKEN(PROBE, NULL, "expected boxMin < boxMax, found %g and %g on axis %d", box->min[i], box->max[i],
                          i);
    return true;
}

bool glint_part_parse(struct glint_check *check, struct glint_arena *arena, const struct glint_exr_part_info *from,
                      bool scanline, struct glint_part_info *out) {
    snprintf(out->name, sizeof out->name, "%s", from->name);
    out->role = glint_role_find(out->name, &out->index, &out->previous);
    out->level = out->role && out->role->shape == GLINT_SHAPE_LEVELS ? glint_role_level(out->name) : 0;
    out->width = from->width;
    out->height = from->height;
    struct glint_channel_info *channels =
        glint_arena_copy(arena, from->channels, from->channel_count * sizeof *from->channels);
    if (!channels || !keep_foreign(arena, from, out))
        return glint_fail(check->err, GLINT_ERROR_MEMORY, "%s: out of memory", check->file);
    out->channels = channels;
    out->channel_count = from->channel_count;
    if (!out->role) return true;
    if (!parse_version(check, from, out) || !parse_storage(check, from, out, channels)) return false;
    if (out->role->reserved && !BROKEN(RESERVED, NULL, "the role is reserved for a later version")) return false;
    if (!scanline && !BROKEN(STORAGE, NULL, "expected flat scanlines without subsampling")) return false;
    return glint_attribute_names_check(check, from, out) && parse_encodings(check, from, out) &&
           parse_sibling(check, from, out) && parse_scopes(check, from, out) && check_channels(check, out);
}

/* ---- rules between parts ---- */

static bool check_depth(struct glint_check *check, const struct glint_part_info *out, const struct glint_frame *frame) {
    const struct glint_role_channel *row = glint_role_channel_find(out->role, "depth.Z");
    if (!row || !row->encoding[0] || !glint_part_has_channel(out, "depth.Z")) return true;
    const enum glint_depth_encoding encoding = out->encodings.depth;
    const struct glint_camera *camera = out->has_planar ? &out->planar.camera
                                        : out->previous ? &frame->previous
                                                        : &frame->camera;
    if (encoding == GLINT_DEPTH_LOGARITHMIC || encoding == GLINT_DEPTH_LOGARITHMIC_REVERSED) {
        if (frame->depth_near > 0 && frame->depth_near < frame->depth_far) return true;
        return BROKEN(DEPTH, "depth.Z", "logarithmic: expected 0 < depthNear < depthFar, found %g and %g",
                      frame->depth_near, frame->depth_far);
    }
    if (encoding == GLINT_DEPTH_VIEW_LINEAR) return true;
    /* NDC z at distance t is A·s + B/t with s the sign of view z in front: B > 0 puts near at the larger value. */
    const double *m = camera->view_to_clip, far_ndc = m[10] * m[14];
    const double far_value = frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? (far_ndc + 1) / 2 : far_ndc;
    const bool near_at_one = m[11] > 0;
    if (near_at_one != (encoding != GLINT_DEPTH_DEVICE))
        return BROKEN(DEPTH, "depth.Z", "%s: expected a matrix with near at %d, found near at %d",
                      glint_encoding_name("depth", (int)encoding), encoding == GLINT_DEPTH_DEVICE ? 0 : 1, near_at_one);
    if (encoding == GLINT_DEPTH_REVERSED_INFINITE && !(fabs(far_value) <= 1e-5))
        return BROKEN(DEPTH, "depth.Z", "reversed_infinite: expected a matrix with 0 at infinity, found %g", far_value);
    return true;
}

/* A pass looks at all pixels of a cell at once. */
enum { FROXEL_PIXELS = 256 };

static bool check_shape(struct glint_check *check, const struct glint_part_info *out,
                        const struct glint_part_info *gbuffer) {
    if (!out->width || !out->height) return true; /* its size is that of a sibling, which is not open yet */
    if (glint_shape_is_cube(out->role->shape) && (uint64_t)out->height != 6 * (uint64_t)out->width)
        return BROKEN(SHAPE, NULL, "expected N x 6N pixels, found %u x %u", out->width, out->height);
    if (out->role->shape == GLINT_SHAPE_TABLE &&
        (out->width < 2 || (uint64_t)out->height != (uint64_t)out->width * out->width))
        return BROKEN(SHAPE, NULL, "expected N x N² pixels, N at least 2, found %u x %u", out->width, out->height);
    const uint32_t down = out->has_froxels && out->froxels.slices ? out->height / out->froxels.slices : 0;
    if (down && gbuffer &&
        ((uint64_t)out->width * FROXEL_PIXELS < gbuffer->width || (uint64_t)down * FROXEL_PIXELS < gbuffer->height))
        return BROKEN(FROXELS, NULL, "expected a cell for each %d x %d of the %u x %u pixels, found %u x %u cells",
                      FROXEL_PIXELS, FROXEL_PIXELS, gbuffer->width, gbuffer->height, out->width, down);
    if (out->role->shape == GLINT_SHAPE_FRAME && gbuffer &&
        (out->width != gbuffer->width || out->height != gbuffer->height))
        return BROKEN(SHAPE, NULL, "expected %u x %u pixels as in gbuffer, found %u x %u", gbuffer->width,
                      gbuffer->height, out->width, out->height);
    return true;
}

/* A shadow map is of a light, and maybe of a class, that the frame has. */
static bool check_shadow(struct glint_check *check, const struct glint_part_info *out,
                         const struct glint_frame *frame) {
    const struct glint_shadow *shadow = &out->shadow;
    if (!out->has_shadow) return true;
    if (shadow->has_stencil_class && shadow->stencil_class >= frame->class_count)
        return BROKEN(SHADOW, "glint.shadowClass",
                      "expected the number of one of the %u classes of glint.stencilClasses, found %u",
                      frame->class_count, shadow->stencil_class);
    if (shadow->has_light ? shadow->light < frame->light_count : frame->has_sun) return true;
    if (!shadow->has_light)
        return BROKEN(SHADOW, NULL, "expected glint.sunDirection on gbuffer, or glint.shadowLight, found neither");
    return BROKEN(SHADOW, "glint.shadowLight", "expected the number of one of the frame's %u lights, found %u",
                  frame->light_count, shadow->light);
}

static bool check_lut_stops(struct glint_check *check, const struct glint_frame *frame) {
    const double *stops = frame->lut_stops;
    if (!frame->has_lut_stops || (stops[0] >= -64 && stops[0] < stops[1] && stops[1] <= 64)) return true;
    return glint_violation(check, GLINT_RULE_ATTRIBUTE, "gbuffer", "glint.lutStops",
                           "expected two increasing numbers from -64 to 64, found %g and %g", stops[0], stops[1]);
}

/* What atmosphere and clouds say on gbuffer. */
static bool check_air(struct glint_check *check, const struct glint_part_info *out, const struct glint_frame *frame) {
    const struct glint_atmosphere *air = &frame->atmosphere;
    const struct glint_clouds *clouds = &frame->clouds;
    if (frame->has_atmosphere && !(air->mie_extinction >= air->mie) &&
        !BROKEN(AIR, "glint.atmosphere.mieExtinction", "expected at least mieScattering, %g, found %g", air->mie,
                air->mie_extinction))
        return false;
    if (!frame->has_clouds) return true;
    const struct {
        const char *name;
        double value, least, most;
    } bounds[] = {
        {"glint.cloudTile", clouds->tile, 1e-3, 1e9},          {"glint.cloudNoiseTile", clouds->noise_tile, 1e-3, 1e9},
        {"glint.cloudOffset", clouds->offset[0], -1e12, 1e12}, {"glint.cloudOffset", clouds->offset[1], -1e12, 1e12},
        {"glint.cloudBottom", clouds->bottom, -1e9, 1e9},      {"glint.cloudTop", clouds->top, -1e9, 1e9}};
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++)
        if (!(bounds[i].value >= bounds[i].least && bounds[i].value <= bounds[i].most) &&
            !BROKEN(AIR, bounds[i].name, "expected %g to %g, found %g", bounds[i].least, bounds[i].most,
                    bounds[i].value))
            return false;
    return (float)clouds->top > (float)clouds->bottom ||
           BROKEN(AIR, "glint.cloudTop", "expected more than cloudBottom, %g, found %g", clouds->bottom, clouds->top);
}

/* The textures of clouds: the attributes say where they lie. */
static bool check_clouds(struct glint_check *check, const struct glint_part_info *parts, size_t count,
                         const struct glint_frame *frame) {
    const struct glint_part_info *out = NULL, *height = NULL;
    for (size_t i = 0; i < count; i++)
        if (!strcmp(parts[i].name, "cloud.density")) out = &parts[i];
        else if (!strcmp(parts[i].name, "cloud.height")) height = &parts[i];
    if (!out) return true;
    if (!frame->has_clouds && !BROKEN(AIR, NULL, "expected glint.cloudBottom on gbuffer, found none")) return false;
    if (out->height % GLINT_CLOUD_SLICES &&
        !BROKEN(AIR, NULL, "expected a height of a whole number of %d slices, found %u", GLINT_CLOUD_SLICES,
                out->height))
        return false;
    return !height || (height->width == out->width && height->height == out->height) ||
           glint_violation(check, GLINT_RULE_AIR, height->name, NULL, "expected %u x %u pixels as in %s, found %u x %u",
                           out->width, out->height, out->name, height->width, height->height);
}

static bool check_required_roles(struct glint_check *check, const struct glint_part_info *parts, size_t count) {
    size_t role_count = 0;
    const struct glint_role *roles = glint_roles(&role_count);
    for (size_t r = 0; r < role_count; r++) {
        bool found = !roles[r].required;
        for (size_t i = 0; i < count && !found; i++) found = parts[i].role == &roles[r] && !parts[i].previous;
        if (!found && !glint_violation(check, GLINT_RULE_REQUIRED, roles[r].name, NULL, "missing")) return false;
    }
    return true;
}

bool glint_parts_check(struct glint_check *check, const struct glint_exr_part_info *const *files,
                       const struct glint_part_info *parts, size_t count, struct glint_frame *frame, bool *has_frame) {
    const struct glint_part_info *gbuffer = NULL;
    bool cubes_only = count > 0;
    *has_frame = false;
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i; j++)
            if (!strcmp(parts[i].name, parts[j].name) && !glint_violation(check, GLINT_RULE_NAMES, parts[i].name, NULL,
                                                                          "expected one part of this name, found two"))
                return false;
        if (parts[i].role && !strcmp(parts[i].name, "gbuffer")) {
            gbuffer = &parts[i];
            *has_frame = true;
            if (!glint_attributes_decode(check, files[i], GLINT_SCOPE_FRAME, frame) || !check_lut_stops(check, frame) ||
                !check_air(check, &parts[i], frame))
                return false;
        }
        cubes_only = cubes_only && parts[i].has_cubemap && !parts[i].sibling[0];
    }
    if (!cubes_only && !check_required_roles(check, parts, count)) return false;
    for (size_t i = 0; i < count; i++) {
        const struct glint_part_info *out = &parts[i];
        if (!out->role) continue;
        if (!check_shape(check, out, gbuffer) ||
            (gbuffer && !(check_depth(check, out, frame) && check_shadow(check, out, frame))))
            return false;
        if (gbuffer && out->previous && !strcmp(out->role->name, "gbuffer") && !frame->has_previous &&
            !BROKEN(PREVIOUS, NULL, "expected previousWorldToView and previousViewToClip on gbuffer, found none"))
            return false;
    }
    return (!gbuffer || check_clouds(check, parts, count, frame)) && glint_probes_check(check, parts, count);
}
