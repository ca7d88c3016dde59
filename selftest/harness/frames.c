#include "harness/frames.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracles/noise.h"

/* ---- Contents of a frame ---- */

static void camera_at(struct glint_camera *camera, const double place[3], double turn) {
    const double c = cos(turn), s = sin(turn), near = 0.125, far = 1024;
    const double rotation[3][3] = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
    *camera = (struct glint_camera){0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            camera->world_to_view[4 * i + k] = rotation[i][k];
            camera->world_to_view[4 * i + 3] -= rotation[i][k] * place[k];
        }
    camera->world_to_view[15] = 1;
    camera->view_to_clip[0] = 1;
    camera->view_to_clip[5] = (double)FRAME_WIDTH / FRAME_HEIGHT;
    camera->view_to_clip[10] = far / (near - far);
    camera->view_to_clip[11] = near * far / (near - far);
    camera->view_to_clip[14] = -1;
}

void frame_cameras(struct frame *frame, const double now[3], const double before[3], double turn, double turn_before) {
    camera_at(&frame->info.camera, now, turn);
    camera_at(&frame->info.previous, before, turn_before);
    frame->info.has_previous = true;
}

void frame_ordinary(struct frame *frame, uint32_t number) {
    static const double origin[3] = {0};
    *frame = (struct frame){.info = {.number = number}};
    frame_cameras(frame, origin, origin, 0, 0);
    for (uint32_t i = 0; i < FRAME_PIXELS; i++) {
        frame->depth[i] = (float)frame_wall_m;
        frame->normal[2][i] = 1;
        frame->roughness[i] = 0.5f;
        frame->travelled[i] = 1;
        frame->color[3][i] = 1;
        for (uint32_t k = 0; k < 3; k++) frame->color[k][i] = (float)(2 * noise(number * 4 + k, i));
    }
}

void frame_to_view(const struct glint_camera *camera, const double world[3], double view[3]) {
    const double *m = camera->world_to_view;
    for (int i = 0; i < 3; i++)
        view[i] = m[4 * i] * world[0] + m[4 * i + 1] * world[1] + m[4 * i + 2] * world[2] + m[4 * i + 3];
}

void frame_position(const struct frame *frame, double x, double y, double depth_m, double world[3]) {
    const double *m = frame->info.camera.world_to_view, *p = frame->info.camera.view_to_clip;
    const double clip[2] = {2 * (x + 0.5) / FRAME_WIDTH - 1, 1 - 2 * (y + 0.5) / FRAME_HEIGHT};
    const double view[3] = {depth_m * (clip[0] + p[2]) / p[0] - m[3], depth_m * (clip[1] + p[6]) / p[5] - m[7],
                            -depth_m - m[11]};
    for (int i = 0; i < 3; i++) world[i] = m[i] * view[0] + m[4 + i] * view[1] + m[8 + i] * view[2];
}

/* ---- The capture that holds it ---- */

static bool add_part(struct glint_writer *writer, const struct planes *planes, struct glint_error *err) {
    struct glint_channel list[12] = {{0}};
    size_t count = 0;
    for (; count < 12 && planes->channels[count]; count++)
        list[count] =
            (struct glint_channel){.name = planes->channels[count], .type = planes->type, .data = planes->data[count]};
    const struct glint_part part = {.name = planes->name,
                                    .width = planes->width,
                                    .height = planes->height,
                                    .channels = list,
                                    .channel_count = count,
                                    .cubemap = planes->cubemap};
    return glint_writer_add_part(writer, &part, err);
}

/* A sky that is dark on one side and bright on the other: red is 2 x² of the unit direction (x, y, z), green 2 y², blue 2 z². */
enum { SKY = 16 };
static bool add_sky(struct glint_writer *writer, struct glint_error *err) {
    /* The axes along which the texels of a pair of faces lie; signs do not matter to squares. */
    static const int across[3] = {2, 0, 0}, down[3] = {1, 2, 1};
    float values[3][6 * SKY * SKY];
    for (size_t i = 0; i < 6 * SKY * SKY; i++) {
        const size_t pair = i / (2 * SKY * SKY);
        const double u = (2 * (double)(i % SKY) + 1) / SKY - 1, v = (2 * (double)(i / SKY % SKY) + 1) / SKY - 1;
        double d[3] = {1, 1, 1};
        d[across[pair]] = u, d[down[pair]] = v;
        for (size_t k = 0; k < 3; k++) values[k][i] = (float)(2 * d[k] * d[k] / (1 + u * u + v * v));
    }
    return add_part(
        writer,
        &(struct planes){"sky", SKY, 6 * SKY, {"R", "G", "B"}, {values[0], values[1], values[2]}, GLINT_F32, NULL},
        err);
}

static bool write_parts(struct glint_writer *writer, const struct frame *f, struct glint_error *err) {
    static const float zero[FRAME_PIXELS] = {0};
    float half[FRAME_PIXELS]; /* every surface reflects */
    for (size_t i = 0; i < FRAME_PIXELS; i++) half[i] = 0.5f;
    static const uint32_t not_finished[FRAME_PIXELS] = {0};
    uint32_t nowhere[FRAME_PIXELS]; /* in no cube map */
    for (size_t i = 0; i < FRAME_PIXELS; i++) nowhere[i] = 255;
    /* clang-format off */
    const struct planes parts[] = {
        {"gbuffer", FRAME_WIDTH, FRAME_HEIGHT,
         {"depth.Z", "normal.X", "normal.Y", "normal.Z", "material.roughness", "material.metalness", "material.specular", "albedo.R", "albedo.G", "albedo.B", "motion.X", "motion.Y"},
         {f->depth, f->normal[0], f->normal[1], f->normal[2], f->roughness, zero, half, zero, zero, zero, f->motion[0], f->motion[1]}, GLINT_F32, NULL},
        {"lit", FRAME_WIDTH, FRAME_HEIGHT, {"R", "G", "B"}, {zero, zero, zero}, GLINT_F32, NULL},
        {"engine.resolve.reflection_half", FRAME_WIDTH, FRAME_HEIGHT, {"R", "G", "B", "A"}, {f->color[0], f->color[1], f->color[2], f->color[3]}, GLINT_F32, NULL},
        {"engine.upscale.reflection", FRAME_WIDTH, FRAME_HEIGHT, {"R", "G", "B", "A"}, {f->color[0], f->color[1], f->color[2], f->color[3]}, GLINT_F32, NULL},
        {"engine.cubemap_trace.travelled", FRAME_WIDTH, FRAME_HEIGHT, {"Z"}, {f->travelled}, GLINT_F32, NULL},
        {"engine.cubemap_trace.cubemap_index", FRAME_WIDTH, FRAME_HEIGHT, {"index"}, {nowhere}, GLINT_U32, NULL},
        {"engine.screen_trace.screen_finished", FRAME_WIDTH, FRAME_HEIGHT, {"finished"}, {not_finished}, GLINT_U32, NULL},
    };
    /* clang-format on */
    bool ok = glint_writer_set_frame(writer, &f->info, err) && add_sky(writer, err);
    for (size_t i = 0; ok && i < (f->bare ? 2 : sizeof parts / sizeof *parts); i++)
        ok = add_part(writer, &parts[i], err);
    for (size_t i = 0; ok && i < f->more_count; i++) ok = add_part(writer, &f->more[i], err);
    return ok && glint_writer_finish(writer, err);
}

/* ---- Running ---- */

bool frames_begin(struct frames *frames, const struct case_context *context, struct glint_error *err) {
    *frames = (struct frames){.context = context, .replay = glint_replay_create(context->device, err)};
    return frames->replay != NULL;
}

void frames_end(struct frames *frames) {
    glint_replay_destroy(&frames->replay);
    glint_pipeline_destroy(&frames->pipeline);
    glint_capture_close(&frames->capture);
}

bool frames_pipeline(struct frames *frames, const char *const *passes, const char *const *settings,
                     struct glint_error *err) {
    static const char preset[] =
        "{\"name\": \"selftest\", \"title\": \"Histories\", \"source\": \"glint\", \"slots\": {\"downsample\": "
        "\"none\", \"screen_trace\": \"linear\", \"cubemap_active\": \"nearest\", \"cubemap_select\": \"nearest\", "
        "\"cubemap_trace\": \"lookup\", \"resolve\": \"hit\", \"temporal\": \"rough\", \"upscale\": \"bilinear\", "
        "\"temporal_sharp\": \"clamped\"}, \"set\": {}}\n";
    char path[4096];
    snprintf(path, sizeof path, "%s/frames.json", frames->context->folder);
    glint_pipeline_destroy(&frames->pipeline);
    frames->passes = passes;
    bool ok = case_write_text(path, preset, err) && (frames->pipeline = glint_pipeline_create(path, err));
    for (; ok && *settings; settings++) {
        const char *dot = strchr(*settings, '.');
        ok = dot && dot < strchr(*settings, '=') ? glint_pipeline_set(frames->pipeline, *settings, err)
                                                 : glint_pipeline_use(frames->pipeline, *settings, err);
    }
    return ok;
}

bool frames_shader(struct frames *frames, const char *slot, const char *text, struct glint_error *err) {
    char path[4096], assignment[4200];
    snprintf(path, sizeof path, "%s/%s.comp", frames->context->folder, slot);
    snprintf(assignment, sizeof assignment, "%s=%s", slot, path);
    return case_write_text(path, text, err) && glint_pipeline_shader(frames->pipeline, assignment, err);
}

bool frames_run_capture(struct frames *frames, const char *path, struct glint_error *err) {
    const struct glint_replay_options options = {
        .passes = frames->passes, .all = !frames->planned, .float_precision = !frames->half};
    glint_replay_load(frames->replay, NULL, NULL);
    glint_capture_close(&frames->capture);
    return (frames->capture = glint_capture_open(path, NULL, err)) &&
           glint_replay_load(frames->replay, frames->capture, err) &&
           glint_replay_run(frames->replay, frames->pipeline, &options, frames->context->progress,
                            frames->context->user, err);
}

bool frames_run(struct frames *frames, const struct frame *frame, struct glint_error *err) {
    const struct glint_writer_options plain = {.compression = GLINT_NONE, .threads = 1};
    char path[4096];
    snprintf(path, sizeof path, "%s/frame.exr", frames->context->folder);
    glint_replay_load(frames->replay, NULL, NULL);
    glint_capture_close(&frames->capture);
    struct glint_writer *writer = glint_writer_create(path, &plain, err);
    const bool written = writer && write_parts(writer, frame, err);
    glint_writer_destroy(&writer);
    return written && frames_run_capture(frames, path, err);
}

bool frames_read(struct frames *frames, const char *image, float *out, struct glint_error *err) {
    const struct glint_image *found = glint_replay_find_image(frames->replay, image);
    if (!found) return glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no %s", image);
    return glint_replay_read_image(frames->replay, found, GLINT_F32, out, err);
}
