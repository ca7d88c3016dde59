// Decodes images with OpenImageIO: the module libglint-oiio, which oiio.c loads. Exceptions must not leave this file.
#include "oiio.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>

namespace {

bool decode(const char *path, const char *kind, const uint8_t *data, size_t size, uint64_t most, oiio_image *out,
            glint_error *err) {
    OIIO::Filesystem::IOMemReader memory(data, size);
    OIIO::Filesystem::IOProxy *proxy = &memory;
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    config.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(kind);
    if (!input) return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: OpenImageIO reads no %s here", path, kind);
    input->threads(1);
    if (!input->open(std::string("memory.") + kind, spec, config)) {
        const std::string reason = input->geterror();
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a %s image that OpenImageIO reads: %.300s", path, kind,
                          reason.c_str());
    }
    const OIIO::TypeDesc::BASETYPE type = static_cast<OIIO::TypeDesc::BASETYPE>(spec.format.basetype);
    if (type != OIIO::TypeDesc::UINT8 && type != OIIO::TypeDesc::UINT16 && type != OIIO::TypeDesc::HALF &&
        type != OIIO::TypeDesc::FLOAT)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: expected 8 or 16 bits, half or float, found %s", path,
                          spec.format.c_str());
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.nchannels > 4)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected pixels of 1 to 4 channels, found %d x %d of %d", path,
                          spec.width, spec.height, spec.nchannels);
    const uint64_t bytes =
        uint64_t(spec.width) * uint64_t(spec.height) * uint64_t(spec.nchannels) * spec.format.basesize();
    if (bytes > most)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: expected at most %llu bytes of pixels, found %llu", path,
                          static_cast<unsigned long long>(most), static_cast<unsigned long long>(bytes));
    std::unique_ptr<void, decltype(&std::free)> pixels(std::malloc(size_t(bytes)), std::free);
    if (!pixels) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc(type), pixels.get())) {
        const std::string reason = input->geterror();
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected whole pixels: %.300s", path, reason.c_str());
    }
    *out = oiio_image{uint32_t(spec.width),
                      uint32_t(spec.height),
                      uint32_t(spec.nchannels),
                      unsigned(8 * spec.format.basesize()),
                      type == OIIO::TypeDesc::HALF || type == OIIO::TypeDesc::FLOAT,
                      pixels.release(),
                      size_t(bytes)};
    return true;
}

} // namespace

bool glint_oiio_decode(const char *path, const char *kind, const uint8_t *data, size_t size, uint64_t most,
                       oiio_image *out, glint_error *err) {
    try {
        return decode(path, kind, data, size, most, out, err);
    } catch (const std::bad_alloc &) {
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    } catch (const std::exception &e) {
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: OpenImageIO: %.300s", path, e.what());
    } catch (...) {
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: OpenImageIO failed", path);
    }
}
