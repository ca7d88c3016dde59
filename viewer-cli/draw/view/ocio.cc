// Colour conversion through OpenColorIO. Exceptions must not leave this file.
#include "draw/view/ocio.h"

#include <OpenColorIO/OpenColorIO.h>

#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "draw/blobs.h"
#include "nearest.h"

namespace OCIO = OCIO_NAMESPACE;

namespace {

// "1.0 and 2.0 to 2.1": the versions of configurations that this library reads, by its own word.
std::string known_versions() {
    std::string text;
    for (unsigned major = 1; major < 100; major++) {
        try {
            OCIO::ConfigRcPtr config = OCIO::Config::Create();
            config->setMajorVersion(major); // also sets the newest minor version of it
            const std::string start = std::to_string(major), newest = std::to_string(config->getMinorVersion());
            text += (major > 1 ? " and " : "") + start + ".0" + (newest != "0" ? " to " + start + "." + newest : "");
        } catch (const OCIO::Exception &) {
            break;
        }
    }
    return text;
}

OCIO::ConstConfigRcPtr open_file(const char *path) {
    try {
        return OCIO::Config::CreateFromFile(path);
    } catch (const OCIO::Exception &e) {
        std::string text = std::string(path) + ": " + e.what();
        while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
        throw OCIO::Exception((text + "; OpenColorIO " + OCIO::GetVersion() +
                               ", which glint is built with, reads files of version " + known_versions())
                                  .c_str());
    }
}

OCIO::ConstConfigRcPtr open_config(const char *path) {
    if (!path) path = std::getenv("OCIO");
    if (path && *path) return open_file(path);
    std::istringstream text(std::string(reinterpret_cast<const char *>(blob_ocio), size_t(blob_ocio_end - blob_ocio)));
    return OCIO::Config::CreateFromStream(text);
}

// Returns the name as the config spells it, or throws with the known names and the nearest one.
std::string find_name(const char *what, const char *name, const std::vector<std::string> &names) {
    struct glint_nearest near = glint_nearest_to(name);
    std::string list;
    for (const std::string &known : names) {
        if (known == name) return known;
        glint_nearest_offer(&near, known.c_str());
        list += (list.empty() ? "" : ", ") + known;
    }
    throw std::invalid_argument(std::string("there is no ") + what + " " + name + glint_nearest_text(&near) +
                                "; the configuration has " + list);
}

std::string choose_display(const OCIO::ConstConfigRcPtr &config, const char *name) {
    if (!name) return config->getDefaultDisplay();
    std::vector<std::string> names;
    for (int i = 0; i < config->getNumDisplays(); i++) names.push_back(config->getDisplay(i));
    return find_name("display", name, names);
}

std::string choose_view(const OCIO::ConstConfigRcPtr &config, const std::string &display, const char *name) {
    if (!name) return config->getDefaultView(display.c_str());
    std::vector<std::string> names;
    for (int i = 0; i < config->getNumViews(display.c_str()); i++) names.push_back(config->getView(display.c_str(), i));
    return find_name("view", name, names);
}

// Linear Rec. 709 has several names. In a config without any of them, pixels are taken to be in its scene-linear role.
std::string choose_input(const OCIO::ConstConfigRcPtr &config, const char *name) {
    if (name) {
        if (config->getColorSpace(name)) return name;
        std::vector<std::string> names;
        for (int i = 0; i < config->getNumColorSpaces(); i++) names.push_back(config->getColorSpaceNameByIndex(i));
        return find_name("colour space", name, names);
    }
    for (const char *name : {"lin_rec709", "Linear Rec.709 (sRGB)", "Utility - Linear - Rec.709",
                             "Utility - Linear - sRGB", "lin_srgb", "Linear"})
        if (config->getColorSpace(name)) return name;
    return OCIO::ROLE_SCENE_LINEAR;
}

} // namespace

bool ocio_apply(const struct ocio_options *options, float *rgba, size_t width, size_t height, struct glint_error *err) {
    try {
        OCIO::ConstConfigRcPtr config = open_config(options->config);
        const std::string display = choose_display(config, options->display);
        const std::string view = choose_view(config, display, options->view);
        OCIO::DisplayViewTransformRcPtr transform = OCIO::DisplayViewTransform::Create();
        transform->setSrc(choose_input(config, options->input).c_str());
        transform->setDisplay(display.c_str());
        transform->setView(view.c_str());
        OCIO::ConstCPUProcessorRcPtr cpu = config->getProcessor(transform)->getDefaultCPUProcessor();
        OCIO::PackedImageDesc image(rgba, long(width), long(height), 4);
        cpu->apply(image);
        return true;
    } catch (const std::invalid_argument &e) {
        return glint_fail(err, GLINT_ERROR_USAGE, "%s", e.what());
    } catch (const std::exception &e) {
        return glint_fail(err, GLINT_ERROR_FORMAT, "OpenColorIO: %s", e.what());
    }
}

char *ocio_builtin_views(void) {
    try {
        std::istringstream text(
            std::string(reinterpret_cast<const char *>(blob_ocio), size_t(blob_ocio_end - blob_ocio)));
        OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromStream(text);
        std::string list;
        for (int i = 0; i < config->getNumViews(config->getDefaultDisplay()); i++)
            list += (i ? ", " : "") + std::string(config->getView(config->getDefaultDisplay(), i));
        return strdup(list.c_str());
    } catch (const std::exception &) {
        return nullptr;
    }
}
