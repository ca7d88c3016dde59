/* glint sample: renders a capture with the stand-in engine. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "options/args.h"
#include "glint/samples.h"
#include "nearest.h"
#include "io/pipe.h"
#include "io/progress.h"
#include "io/table.h"

struct arguments {
    const char *scene, *out;
    bool list, json, overwrite;
    struct glint_sample_options sample;
};

enum {
    KEY_SIZE = 256,
    KEY_CUBE_SIZE,
    KEY_PLANAR,
    KEY_FRAMES,
    KEY_FIRST_FRAME,
    KEY_CUT,
    KEY_PROBES,
    KEY_ENCODING,
    KEY_TRUTH,
    KEY_TRUTH_OF_PIXELS,
    KEY_TRUTH_OF,
    KEY_RADIUS,
    KEY_LENGTH,
    KEY_CASCADES,
    KEY_ALSO,
    KEY_FINISHED,
    KEY_FOREGROUND,
    KEY_LIGHT,
    KEY_CAMERA,
    KEY_TRAVEL,
    KEY_UNJITTERED,
    KEY_REFLECTING,
    KEY_SCATTERED,
    KEY_FOV,
    KEY_OFFSET,
    KEY_COMPRESSION,
    KEY_THREADS,
    KEY_DEPTH,
    KEY_NORMAL,
    KEY_ROUGHNESS,
    KEY_MOTION,
    KEY_COLOR
};

/* clang-format off */
static const struct argp_option options[] = {
    {"output",      'o',             "FILE",  0, "Capture to write, or - for stdout; with several frames, .NNNN is inserted before the suffix", 0},
    OVERWRITE_OPTION,
    {"list",        'l',             NULL,    0, "List the scenes", 0},
    {"json",        'j',             NULL,    0, "With --list: print JSON", 0},
    {"size",        KEY_SIZE,        "WxH",   0, "Image size (default 1280x720)", 0},
    {"cube-size",   KEY_CUBE_SIZE,   "N",     0, "Face size of the cube maps in texels (default 256)", 0},
    {"planar-size", KEY_PLANAR,      "WxH",   0, "Size of the planar reflection of a scene with water (default 240x120)", 0},
    {"frames",      KEY_FRAMES,      "N",     0, "Number of frames; the captures share their cube maps (default 1)", 0},
    {"first-frame", KEY_FIRST_FRAME, "N",     0, "Number of the first frame (default 1)", 0},
    {"cut",         KEY_CUT,         NULL,    0, "Mark the first frame as the start of a shot, so that no history is used", 0},
    {"probes",      KEY_PROBES,      "imperfect|perfect|auto",  0, "Contents of the cube maps. imperfect: as in games, only static objects, simplified, with metals as diffuse; perfect: "
        "the exact scene; auto: placed automatically, for glTF files", 0},
    {"truth",       KEY_TRUTH,       "N",     0, "Path trace the true reflection with N rays per pixel into truth.* (default 0: no truth)", 0},
    {"truth-of",    KEY_TRUTH_OF,    "WHAT,...", 0, "Which truths --truth traces: reflection (default), occlusion, sun, indirect, antialiased, picture, lamps", 0},
    {"occlusion-radius", KEY_RADIUS, "M",     0, "How far away surfaces occlude, in metres, in the truth of occlusion (default 1)", 0},
    {"contact-length", KEY_LENGTH,   "M",     0, "How far away surfaces cast contact shadows, in metres, in the truth of the sun (default 0.5)", 0},
    {"also",        KEY_ALSO,        "WHAT,...", 0, "Also write the engine's own: ao (ambient occlusion), sun (shadow mask), shadow (shadow map), volume (of light), lut (table of colours), dirt (on the lens), stipple (mask of stippled pixels), decals (on the ground, in buffers of their own), lamps (their light, and shadow maps of spot lights), caustics (on the bottom of water), froxels (light in the air, where the scene has fog), curvature (of the surfaces), sky (atmosphere, clouds and stars, of which the sky of the picture is then drawn; cube maps keep the scene's own)", 0},
    {"cascades",    KEY_CASCADES,    "N",     0, "Shadow maps that --also shadow writes, from the finest on, each three times as wide as the one before (default 1, at most 4)", 0},
    {"truth-of-pixels", KEY_TRUTH_OF_PIXELS, NULL, 0, "Average the truth over the area of each pixel, as over the jitter of a static camera, instead of at the frame's single "
        "sample", 0},
    {"finished",    KEY_FINISHED,    "N",     0, "Also write the final image into scene, with N rays per pixel for the reflections of opaque surfaces; the truth then "
        "includes reflections in reflected surfaces", 0},
    {"foreground",  KEY_FOREGROUND,  NULL,    0, "Add a gun and hands in front of the camera, of the class foreground: only camera rays hit them", 0},
    {"light",       KEY_LIGHT,       "N",     0, "Rays per point for indirect light (default: set by the scene)", 0},
    {"camera",      KEY_CAMERA,      "ex,ey,ez,tx,ty,tz", 0, "Camera position and target (default: the camera of the scene, which moves in a shot)", 0},
    {"travel",      KEY_TRAVEL,      "x,y,z", 0, "Camera motion per frame in metres", 0},
    {"unjittered",  KEY_UNJITTERED,  NULL,    0, "Sample pixel centres in every frame", 0},
    {"reflecting",  KEY_REFLECTING,  "PERCENT", 0, "Make this percentage of the image reflective, as a block in the middle, whatever the materials: 2x2 pixel squares of "
        "roughness 0.05 and 0.4", 0},
    {"scattered",   KEY_SCATTERED,   NULL,    0, "With --reflecting: scatter the squares over the image instead of one block", 0},
    {"fov",         KEY_FOV,         "DEG",   0, "Vertical field of view in degrees (default: set by the scene)", 0},
    {"offset",      KEY_OFFSET,      "x,y,z", 0, "Move all stored positions, in double precision, without rendering again", 0},
    {"encoding",    KEY_ENCODING,    "WHAT=NAME,...", 0, "Set several encodings: depth, normal, vertex_normal, normal_space, roughness, motion, motion_depth, color", 0},
    {"depth",       KEY_DEPTH,       "NAME",  0, "Encoding of depth: ", 0},
    {"normal",      KEY_NORMAL,      "NAME",  0, "Encoding of normals: ", 0},
    {"roughness",   KEY_ROUGHNESS,   "NAME",  0, "Encoding of roughness: ", 0},
    {"motion",      KEY_MOTION,      "NAME",  0, "Encoding of motion vectors: ", 0},
    {"color",       KEY_COLOR,       "NAME",  0, "Encoding of colours: ", 0},
    {"compression", KEY_COMPRESSION, "NAME",  0, "Compression of the file: ", 0},
    {"threads",     KEY_THREADS,     "N",     0, "Number of threads (default: one per core)", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint sample --list", "lists the scenes"},
    {"glint sample street -o street.exr --truth 64", "renders a wet street at dusk, with the path-traced truth"},
    {"glint sample courtyard -o yard.exr --truth 64 --truth-of occlusion,sun,indirect --also sun,shadow",
     "renders a sunlit yard with the truths of other effects, and the engine's shadows"},
    {"glint sample room -o room.exr --frames 8 --size 640x360", "renders a shot: room.0001.exr to room.0008.exr"},
    {"glint sample scene.glb -o scene.exr --camera 0,1.7,5,0,1,0 --probes auto", "renders a glTF file"},
    {"glint sample room -o room.exr --encoding depth=reversed,normal=octahedral",
     "uses the conventions of another engine"},
    {0},
};
static const char *const probes[] = {"imperfect", "perfect", "auto", NULL};
static const char *const truths[] = {"reflection",  "occlusion", "sun",   "indirect",
                                     "antialiased", "picture",   "lamps", NULL};
static const char *const extras[] = {"ao",     "sun",   "shadow",   "volume",  "lut",       "dirt", "stipple",
                                     "decals", "lamps", "caustics", "froxels", "curvature", "sky",  NULL};
static const char *const compressions[] = {"zip", "none", "zips", "piz", "pxr24", "rle", NULL};

static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_EXR),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('l', struct arguments, list),
    STORED('j', struct arguments, json),
    STORED_NUMBER(KEY_CUBE_SIZE, struct arguments, sample.cube_size, 4, 4096),
    STORED_NUMBER(KEY_FRAMES, struct arguments, sample.frames, 1, 9999),
    STORED_NUMBER(KEY_FIRST_FRAME, struct arguments, sample.first_frame, 1, 9999),
    STORED(KEY_CUT, struct arguments, sample.cut),
    STORED_NUMBER(KEY_TRUTH, struct arguments, sample.truth_samples, 0, 1 << 20),
    STORED(KEY_TRUTH_OF_PIXELS, struct arguments, sample.truth_of_pixels),
    STORED_NUMBER(KEY_FINISHED, struct arguments, sample.finished_samples, 1, 1 << 20),
    STORED(KEY_FOREGROUND, struct arguments, sample.foreground),
    STORED_NUMBER(KEY_CASCADES, struct arguments, sample.cascades, 1, 4),
    STORED_NUMBER(KEY_LIGHT, struct arguments, sample.light_samples, 1, 1 << 20),
    STORED(KEY_UNJITTERED, struct arguments, sample.unjittered),
    STORED(KEY_SCATTERED, struct arguments, sample.scattered),
    STORED_NUMBER(KEY_THREADS, struct arguments, sample.threads, 1, 1024),
    {0},
};

static const char *encoding_of_key(int key) {
    switch (key) {
    case KEY_DEPTH:
        return "depth";
    case KEY_NORMAL:
        return "normal";
    case KEY_ROUGHNESS:
        return "roughness";
    case KEY_MOTION:
        return "motion";
    case KEY_COLOR:
        return "color";
    }
    return NULL;
}

static char *cmd_sample_values(int key) {
    if (key == KEY_COMPRESSION) return join_names("", compressions);
    const char *which = encoding_of_key(key);
    if (!which) return NULL;
    const char *names[32] = {0};
    for (int i = 0; i < 31 && (names[i] = glint_encoding_name(which, i)) != NULL; i++) continue;
    return join_names("", names);
}

static void set_encoding(struct glint_encodings *e, const char *what, const char *name, struct argp_state *state) {
    static const char *const kinds[] = {
        "depth", "normal", "vertex_normal", "normal_space", "roughness", "motion", "color", "motion_depth", NULL};
    int kind = arg_choice("encoding", what, kinds, state);
    const char *which = kind == 2 ? "normal" : what; /* vertex normals are stored as normals are */
    const char *names[32] = {0};
    for (int i = 0; i < 31 && (names[i] = glint_encoding_name(which, i)) != NULL; i++) continue;
    int value = arg_choice(what, name, names, state);
    switch (kind) {
    case 0:
        e->depth = (enum glint_depth_encoding)value;
        break;
    case 1:
        e->normal = (enum glint_normal_encoding)value;
        break;
    case 2:
        e->vertex_normal = (enum glint_normal_encoding)value;
        break;
    case 3:
        e->normal_space = (enum glint_normal_space)value;
        break;
    case 4:
        e->roughness = (enum glint_roughness_encoding)value;
        break;
    case 5:
        e->motion = (enum glint_motion_encoding)value;
        break;
    case 6:
        e->color = (enum glint_color_encoding)value;
        break;
    case 7:
        e->motion_depth = (enum glint_motion_depth_encoding)value;
        break;
    }
}

static void set_encodings(struct glint_encodings *e, char *text, struct argp_state *state) {
    for (char *rest = text, *piece; (piece = strsep(&rest, ",")) != NULL;) {
        char *equals = strchr(piece, '=');
        if (!equals) {
            argp_error(state, "--encoding=%s: expected WHAT=NAME, such as depth=reversed", piece);
            return;
        }
        *equals = '\0';
        set_encoding(e, piece, equals + 1, state);
    }
}

/* A bit for each name of a list. */
static uint32_t names_to_bits(const char *option, char *text, const char *const *names, struct argp_state *state) {
    uint32_t bits = 0;
    for (char *rest = text, *piece; (piece = strsep(&rest, ",")) != NULL;)
        bits |= 1u << arg_choice(option, piece, names, state);
    return bits;
}

static double metres(const char *option, const char *text, struct argp_state *state) {
    double value;
    arg_numbers(option, text, &value, 1, state);
    if (!(value > 0 && value <= 1e6)) argp_error(state, "--%s=%s: expected a length in metres above 0", option, text);
    return value;
}

static error_t parse_scene(int key, char *arg, struct argp_state *state, struct arguments *a) {
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "expected one scene, found %s and %s", a->scene, arg);
        a->scene = arg;
        return 0;
    case ARGP_KEY_END:
        if (!a->list && !a->scene) argp_error(state, "no scene given; --list shows them");
        if (!a->list && !a->out) argp_error(state, "no output file given: -o FILE");
        if (a->out && !strcmp(a->out, "-") && a->sample.frames > 1)
            argp_error(state, "several frames cannot be written to stdout");
        if ((a->sample.also & GLINT_ALSO_SKY) && (a->sample.truth_samples || a->sample.finished_samples))
            argp_error(state,
                       "--also sky is for captures without --truth and --finished, which show the scene's own sky");
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static error_t cmd_sample_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    struct glint_sample_options *s = &a->sample;
    double numbers[6];
    switch (key) {
    case KEY_SIZE:
        arg_size("size", arg, &s->width, &s->height, state);
        return 0;
    case KEY_PLANAR:
        arg_size("planar-size", arg, &s->planar_width, &s->planar_height, state);
        return 0;
    case KEY_PROBES:
        s->probes_given = true;
        s->probes = (enum glint_probes)arg_choice("probes", arg, probes, state);
        return 0;
    case KEY_TRUTH_OF:
        s->truths = names_to_bits("truth-of", arg, truths, state);
        return 0;
    case KEY_ALSO:
        s->also = names_to_bits("also", arg, extras, state);
        return 0;
    case KEY_RADIUS:
        s->occlusion_radius = metres("occlusion-radius", arg, state);
        return 0;
    case KEY_LENGTH:
        s->contact_length = metres("contact-length", arg, state);
        return 0;
    case KEY_CAMERA:
        arg_numbers("camera", arg, numbers, 6, state);
        s->camera_given = true;
        memcpy(s->eye, numbers, sizeof s->eye);
        memcpy(s->target, numbers + 3, sizeof s->target);
        return 0;
    case KEY_TRAVEL:
        arg_numbers("travel", arg, s->travel, 3, state);
        s->travel_given = true;
        return 0;
    case KEY_REFLECTING:
        arg_numbers("reflecting", arg, numbers, 1, state);
        if (!(numbers[0] >= 0 && numbers[0] <= 100)) argp_error(state, "--reflecting=%s: expected 0 to 100", arg);
        s->reflecting_given = true;
        s->reflecting = numbers[0] / 100;
        return 0;
    case KEY_FOV:
        arg_numbers("fov", arg, numbers, 1, state);
        if (!(numbers[0] >= 0.1 && numbers[0] <= 170)) argp_error(state, "--fov=%s: expected 0.1 to 170 degrees", arg);
        s->fov_y_rad = numbers[0] * (3.14159265358979323846 / 180);
        return 0;
    case KEY_OFFSET:
        arg_numbers("offset", arg, s->offset, 3, state);
        return 0;
    case KEY_COMPRESSION:
        s->compression = (enum glint_compression)arg_choice("compression", arg, compressions, state);
        return 0;
    case KEY_ENCODING:
        set_encodings(&s->encodings, arg, state);
        return 0;
    }
    if (encoding_of_key(key)) {
        set_encoding(&s->encodings, encoding_of_key(key), arg, state);
        return 0;
    }
    return parse_scene(key, arg, state, a);
}

static enum status list_scenes(bool json) {
    size_t count = 0;
    const struct glint_sample *scenes = glint_samples(&count);
    if (json) {
        json_t *list = json_array();
        for (size_t i = 0; i < count; i++)
            json_array_append_new(list, json_pack("{s:s, s:s}", "name", scenes[i].name, "summary", scenes[i].summary));
        return print_json(json_pack("{s:o}", "scenes", list));
    }
    static const char *const titles[] = {"<scene", "<contents", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < count; i++) {
        table_cell(table, "%s", scenes[i].name);
        table_cell(table, "%s", scenes[i].summary);
    }
    table_print(table, stdout);
    table_destroy(&table);
    return STATUS_DONE;
}

/* A name that is not a built-in scene must be a file. */
static bool check_scene(const char *scene, struct glint_error *err) {
    size_t count = 0;
    const struct glint_sample *scenes = glint_samples(&count);
    struct glint_nearest near = glint_nearest_to(scene);
    for (size_t i = 0; i < count; i++) {
        if (!strcmp(scenes[i].name, scene)) return true;
        glint_nearest_offer(&near, scenes[i].name);
    }
    if (access(scene, R_OK) == 0) return true;
    if (strpbrk(scene, "./")) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", scene, strerror(errno));
    return glint_fail(err, GLINT_ERROR_USAGE, "there is no scene %s%s; glint sample --list shows them", scene,
                      glint_nearest_text(&near));
}

static enum status cmd_sample_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_sample, argc, argv, &a);
    if (a.list) return list_scenes(a.json);
    struct glint_error err = {0};
    if (!check_scene(a.scene, &err)) return command_fail(&cmd_sample, &err);
    struct progress progress;
    struct pipe pipe;
    progress_begin(&progress);
    progress_phase(&progress, "capture");
    const char *out = pipe_output(&pipe, a.out, &err);
    bool ok = out && glint_sample_write(a.scene, out, &a.sample, progress_report, &progress, &err) &&
              pipe_output_flush(&pipe, &err);
    pipe_finish(&pipe);
    progress_end(&progress);
    return ok ? STATUS_DONE : command_fail(&cmd_sample, &err);
}

const struct command cmd_sample = {
    .name = "sample",
    .arguments = "SCENE|FILE.glb -o FILE",
    .summary = "render a capture with the stand-in engine",
    .description =
        "Renders a built-in scene or a glTF file and dumps it as an engine would: G-buffer, lit colour, cube maps, "
        "sky, camera, and on request the path-traced truth. The same options give the same bytes. Of the materials "
        "of a glTF file, the factors, vertex colours and textures (PNG, JPEG) are used; masked alpha cuts holes, "
        "blended alpha is opaque. The same command completes an interrupted shot: existing frames with the same "
        "settings are kept.",
    .options = options,
    .targets = targets,
    .parse = cmd_sample_parse,
    .examples = examples,
    .values = cmd_sample_values,
    .run = cmd_sample_run,
};
