// How an engine in C++ writes a capture: copy this file, and put your textures in place of those of engine.h. It writes the same
// bytes as integration.c. usage: integration_cc FILE.exr
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "engine.h"
#include "glint/capture.h"

namespace {

// One capture on its way to the disk. Errors are values: error() is empty as long as everything went well.
class Capture {
  public:
    explicit Capture(const std::string &path) {
        glint_writer_options options{};
        options.background = true; // compressing and writing is a thread's work
        options.threads = 2;       // leave cores to the engine
        writer_.reset(glint_writer_create(path.c_str(), &options, &error_));
        ok_ = writer_ != nullptr;
    }

    void set_frame(const glint_frame &frame) { ok_ = ok_ && glint_writer_set_frame(writer_.get(), &frame, &error_); }

    // Copies the pixels: the textures may be reused when it returns.
    void add(const glint_part &part) { ok_ = ok_ && glint_writer_add_part(writer_.get(), &part, &error_); }

    // Starts writing, and returns at once.
    void finish() { ok_ = ok_ && glint_writer_finish(writer_.get(), &error_); }

    // Some frames later, or when the engine ends: waits until the file is complete.
    bool wait() {
        ok_ = ok_ && glint_writer_wait(writer_.get(), &error_);
        return ok_;
    }

    std::string error() const { return ok_ ? "" : "error " + std::to_string(error_.code) + ": " + error_.message; }

  private:
    struct Destroy {
        void operator()(glint_writer *writer) const {
            glint_writer_destroy(&writer); // waits for the thread; without finish, nothing of the file is left
        }
    };
    glint_error error_{};
    std::unique_ptr<glint_writer, Destroy> writer_;
    bool ok_ = false;
};

// A part of channels that lie in textures.
class Part {
  public:
    Part(std::string name, const engine_texture &size) : name_(std::move(name)) {
        part_.width = size.width;
        part_.height = size.height;
    }

    // A channel that begins at a byte of each pixel. `storage` is the engine's format: how precise the values are.
    Part &channel(const char *name, glint_type type, const engine_texture &texture, std::size_t first_byte,
                  const char *storage) {
        channels_.push_back({name, type, texture.bytes + first_byte, texture.pixel_bytes, texture.row_bytes, storage});
        return *this;
    }

    Part &half_channels(const char *names, const engine_texture &texture) {
        static const char *const all[] = {"R", "G", "B", "A"};
        for (std::size_t i = 0; names[i]; i++) channel(all[i], GLINT_F16, texture, 2 * i, "RGBA16F");
        return *this;
    }

    // What is not set here is stored as the reader wants it: FORMAT.md, "Encodings".
    glint_encodings &encodings() { return part_.encodings; }

    void add_to(Capture &capture, const glint_cubemap *cubemap = nullptr) {
        part_.name = name_.c_str();
        part_.channels = channels_.data();
        part_.channel_count = channels_.size();
        part_.cubemap = cubemap;
        capture.add(part_);
    }

  private:
    std::string name_;
    std::vector<glint_channel> channels_;
    glint_part part_{};
};

glint_camera camera(const engine_camera &from) {
    glint_camera to{};
    std::copy(std::begin(from.world_to_view), std::end(from.world_to_view), to.world_to_view);
    std::copy(std::begin(from.view_to_clip), std::end(from.view_to_clip), to.view_to_clip);
    return to;
}

void describe(Capture &capture, const engine_frame &frame) {
    glint_frame description{};
    description.camera = camera(frame.camera);
    description.previous = camera(frame.previous);
    description.has_previous = true;
    std::copy(std::begin(frame.camera.jitter_px), std::end(frame.camera.jitter_px), description.jitter_px);
    description.number = frame.number;
    capture.set_frame(description);

    Part gbuffer("gbuffer", frame.depth);
    gbuffer.channel("depth.Z", GLINT_F32, frame.depth, 0, "D32F");
    gbuffer.channel("normal.X", GLINT_UNORM16, frame.normal, 0, "RG16")
        .channel("normal.Y", GLINT_UNORM16, frame.normal, 2, "RG16");
    const char *const material[] = {"material.roughness", "material.metalness", "material.specular"};
    const char *const albedo[] = {"albedo.R", "albedo.G", "albedo.B"};
    for (std::size_t i = 0; i < 3; i++) gbuffer.channel(material[i], GLINT_UNORM8, frame.material, i, "RGBA8");
    for (std::size_t i = 0; i < 3; i++) gbuffer.channel(albedo[i], GLINT_UNORM8, frame.albedo, i, "RGBA8");
    gbuffer.channel("motion.X", GLINT_F32, frame.motion, 0, "RG32F")
        .channel("motion.Y", GLINT_F32, frame.motion, 4, "RG32F");
    gbuffer.encodings().depth = GLINT_DEPTH_REVERSED_INFINITE;
    gbuffer.encodings().normal = GLINT_NORMAL_OCTAHEDRAL;
    gbuffer.add_to(capture);

    Part("lit", frame.lit).half_channels("RGB", frame.lit).add_to(capture);
    Part("sky", frame.sky).half_channels("RGB", frame.sky).add_to(capture);
    for (int i = 0; i < ENGINE_PROBES; i++) {
        const engine_probe &probe = frame.probes[i];
        glint_cubemap cubemap{};
        std::copy(std::begin(probe.position), std::end(probe.position), cubemap.center);
        cubemap.outdoor = true;
        Part part("cubemap.00" + std::to_string(i), probe.color);
        part.half_channels("RGBA", probe.color)
            .channel("distance.Z", GLINT_F32, probe.distance, 0, "R32F")
            .add_to(capture, &cubemap);
    }
}

} // namespace

int main(int argc, char **argv) {
    const std::unique_ptr<engine_frame, void (*)(engine_frame *)> frame(argc == 2 ? engine_render(7) : nullptr,
                                                                        engine_free);
    if (!frame) return std::fprintf(stderr, "usage: %s FILE.exr\n", argv[0]), 2;
    Capture capture(argv[1]);
    describe(capture, *frame);
    capture.finish(); // the engine goes on
    if (capture.wait()) return 0;
    std::fprintf(stderr, "%s\n", capture.error().c_str());
    return 1;
}
