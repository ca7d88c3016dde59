// OpenEXR's standard camera attributes, read and applied by OpenEXR and Imath themselves, against cameras in closed form: position, axes of
// the picture and angles of view are chosen, and glint's matrices made from them under every convention.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <unistd.h>

#include <ImathMatrix.h>
#include <ImathVec.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStandardAttributes.h>

#include "glint/capture.h"
#include "glint/edit.h"

namespace {

enum { W = 16, H = 8 };
const double eye[3] = {12, -3, 40};
// The picture's right and top, and the direction of view, in the world: no axis of the world's.
const double right[3] = {2 / 3., -2 / 3., 1 / 3.}, top[3] = {2 / 3., 1 / 3., -2 / 3.},
             ahead[3] = {1 / 3., 2 / 3., 2 / 3.};
const double tan_x = 0.8, tan_y = 0.4, jitter[2] = {0.3, -0.2};

struct convention {
    double x, y, z; // signs of view space's axes against right, top and ahead
    glint_clip_y clip_y;
};

glint_frame frame_of(const convention &c) {
    glint_frame frame{};
    const double *axes[3] = {right, top, ahead}, signs[3] = {c.x, c.y, c.z};
    double *view = frame.camera.world_to_view, *clip = frame.camera.view_to_clip;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            view[4 * i + j] = signs[i] * axes[i][j];
            view[4 * i + 3] -= signs[i] * axes[i][j] * eye[j];
        }
    view[15] = 1;
    const double up = c.clip_y == GLINT_CLIP_Y_UP ? 1 : -1;
    clip[0] = c.x / tan_x;
    clip[2] = c.z * 2 * jitter[0] / W;
    clip[5] = up * c.y / tan_y;
    clip[6] = c.z * -up * 2 * jitter[1] / H;
    clip[10] = c.z * 1.01;
    clip[11] = -0.1;
    clip[14] = c.z;
    frame.jitter_px[0] = jitter[0];
    frame.jitter_px[1] = jitter[1];
    frame.clip_y = c.clip_y;
    return frame;
}

bool write_capture(const char *path, const glint_frame &frame) {
    static const char *const names[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z", "material.roughness"};
    std::vector<float> ones(W * H, 1);
    glint_error err{};
    glint_channel channels[5] = {}, colors[3] = {};
    for (int i = 0; i < 5; i++) channels[i].name = names[i];
    colors[0].name = "R", colors[1].name = "G", colors[2].name = "B";
    for (glint_channel *c :
         {&channels[0], &channels[1], &channels[2], &channels[3], &channels[4], &colors[0], &colors[1], &colors[2]}) {
        c->type = GLINT_F32;
        c->data = ones.data();
    }
    glint_part gbuffer{}, lit{};
    gbuffer.name = "gbuffer", lit.name = "lit";
    gbuffer.width = lit.width = W, gbuffer.height = lit.height = H;
    gbuffer.channels = channels, gbuffer.channel_count = 5;
    lit.channels = colors, lit.channel_count = 3;
    glint_writer *writer = glint_writer_create(path, nullptr, &err);
    const bool ok = writer && glint_writer_set_frame(writer, &frame, &err) &&
                    glint_writer_add_part(writer, &lit, &err) && glint_writer_add_part(writer, &gbuffer, &err) &&
                    glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    if (!ok) std::printf("# %s\n", err.message);
    return ok;
}

bool near(double found, double expected, const char *what) {
    // The matrices are floats, whose largest elements are about 60: 60 · 6e-8 · 4 terms, over depths of at least 2.
    const bool ok = std::fabs(found - expected) < 2e-5;
    if (!ok) std::printf("# %s: expected %.9g, found %.9g\n", what, expected, found);
    return ok;
}

// Points at (x, y) tangents of the angle of view and at a depth; the window begins at (left, above) pixels and has a size in pixels; one of its pixels is `pixel` wide.
bool check(const char *path, double left, double above, double width, double height, int pixel = 1) {
    Imf::MultiPartInputFile file(path);
    const Imf::Header &header = file.header(0);
    if (header.name() != "gbuffer" || !Imf::hasWorldToCamera(header) || !Imf::hasWorldToNDC(header)) {
        std::printf("# the attributes are not on the first part\n");
        return false;
    }
    const Imath::Box2i window = header.displayWindow();
    bool ok = (window.max.x + 1) * pixel == int(width) && (window.max.y + 1) * pixel == int(height);
    for (double x : {-0.7, 0.0, 0.5})
        for (double y : {-0.3, 0.25})
            for (double depth : {2.0, 9.0}) {
                Imath::V3f world, camera, ndc;
                for (int i = 0; i < 3; i++) world[i] = float(eye[i] + depth * (x * right[i] + y * top[i] + ahead[i]));
                Imf::worldToCamera(header).multVecMatrix(world, camera);
                Imf::worldToNDC(header).multVecMatrix(world, ndc);
                ok = near(double(camera.x), depth * x, "camera x") && ok;
                ok = near(double(camera.y), depth * y, "camera y") && ok;
                ok = near(double(camera.z), depth, "camera z") && ok;
                const double px = (x / tan_x + 1) / 2 * W + jitter[0], py = (1 - y / tan_y) / 2 * H + jitter[1];
                ok = near(double(ndc.x), (px - left) / width, "NDC x") && ok;
                ok = near(double(ndc.y), (py - above) / height, "NDC y") && ok;
            }
    return ok;
}

// A rectangle, or every n-th pixel.
bool copy(const char *from, const char *to, const glint_edit_rectangle *r, std::uint32_t every) {
    glint_error err{};
    glint_edit *edit = glint_edit_open(from, nullptr, nullptr, nullptr, &err);
    const bool ok = edit && (r ? glint_edit_crop(edit, r, &err) : glint_edit_reduce(edit, every, &err)) &&
                    glint_edit_write(edit, to, &err);
    glint_edit_close(&edit);
    if (!ok) std::printf("# %s\n", err.message);
    return ok;
}

} // namespace

int main() {
    const char *folder = std::getenv("TMPDIR");
    std::string base = std::string(folder ? folder : "/tmp") + "/glint-standard-XXXXXX";
    if (!mkdtemp(&base[0])) return 1;
    const std::string whole = base + "/whole.exr", part = base + "/part.exr";
    int number = 0, failed = 0;
    std::printf("1..16\n");
    for (int bits = 0; bits < 16; bits++) {
        const convention c = {bits & 1 ? -1. : 1., bits & 2 ? -1. : 1., bits & 4 ? -1. : 1.,
                              bits & 8 ? GLINT_CLIP_Y_DOWN : GLINT_CLIP_Y_UP};
        const glint_edit_rectangle rectangle = {5, 2, 6, 4};
        const bool ok = write_capture(whole.c_str(), frame_of(c)) && check(whole.c_str(), 0, 0, W, H) &&
                        copy(whole.c_str(), part.c_str(), &rectangle, 0) && check(part.c_str(), 5, 2, 6, 4) &&
                        copy(whole.c_str(), part.c_str(), nullptr, 2) && check(part.c_str(), -0.5, -0.5, W, H, 2) &&
                        copy(whole.c_str(), part.c_str(), nullptr, 3) &&
                        check(part.c_str(), 0, 0, (W + 1) / 3 * 3, (H + 1) / 3 * 3, 3);
        failed += !ok;
        std::printf("%sok %d - view axes %+g %+g %+g, NDC y %s; cropped and reduced, too\n", ok ? "" : "not ", ++number,
                    c.x, c.y, c.z, c.clip_y == GLINT_CLIP_Y_UP ? "up" : "down");
        std::remove(whole.c_str());
        std::remove(part.c_str());
    }
    rmdir(base.c_str());
    return failed != 0;
}
