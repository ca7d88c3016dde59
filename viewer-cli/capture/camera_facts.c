/* Describes a capture's camera: position, direction, field of view, planes. */
#include "capture/camera_facts.h"

#include <math.h>
#include <stdio.h>

#include "io/console.h"

/* View depth at NDC z = n, from z_clip = A z + B and w = s z. */
static double depth_at(double a, double b, double s, double n) {
    double divisor = n * s - a;
    return fabs(divisor) < 1e-12 * fmax(1, fabs(a)) ? INFINITY : fabs(b / divisor);
}

struct camera_facts camera_facts(const struct glint_frame *frame) {
    struct camera_facts f;
    const double *m = frame->camera.world_to_view, *p = frame->camera.view_to_clip;
    double s = p[14];
    glint_camera_position(&frame->camera, f.position);
    for (int i = 0; i < 3; i++) f.forward[i] = s * m[8 + i];
    f.fov_x_deg = 2 * atan(1 / fabs(p[0])) * (180 / M_PI);
    f.fov_y_deg = 2 * atan(1 / fabs(p[5])) * (180 / M_PI);
    double low = depth_at(p[10], p[11], s, frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? -1 : 0);
    double high = depth_at(p[10], p[11], s, 1);
    f.near = fmin(low, high);
    f.far = fmax(low, high);
    return f;
}

json_t *frame_notes_json(const struct glint_frame *frame) {
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    json_t *list = json_array();
    for (size_t i = 0, count = glint_frame_notes(frame, notes); i < count; i++)
        json_array_append_new(list, json_string(notes[i]));
    return list;
}

void frame_notes_print(const struct glint_frame *frame) {
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    for (size_t i = 0, count = glint_frame_notes(frame, notes); i < count; i++)
        printf("note: %s\n", name_text(notes[i]));
}

const char *axis_name(enum glint_axis axis) {
    static const char *const names[] = {"+Y", "+Z", "+X", "−Y", "−Z", "−X"};
    return (size_t)axis < 6 ? names[axis] : "?";
}
