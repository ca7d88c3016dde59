// Colour conversion through OpenColorIO. Exceptions must not leave this file.
#include "draw/view/ocio.h"

#include <OpenColorIO/OpenColorIO.h>

#include <sys/stat.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
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

bool is_known(unsigned major, unsigned minor) {
    try {
        OCIO::Config::Create()->setVersion(major, minor);
        return true;
    } catch (const OCIO::Exception &) {
        return false;
    }
}

// Throws if the configuration was made for a newer library, with what works here.
void check_version(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    std::string line, head(1 << 16, '\0'); // a line may have no end
    file.read(&head[0], std::streamsize(head.size()));
    head.resize(size_t(file.gcount()));
    std::istringstream begin(head);
    unsigned major = 0, minor = 0;
    bool archive = false;
    for (int lines = 0; lines < 100 && std::getline(begin, line); lines++) {
        archive |= lines == 0 && line.compare(0, 2, "PK") == 0;
        if (std::sscanf(line.c_str(), "ocio_profile_version: %u.%u", &major, &minor) > 0) break;
    }
    const std::string have = std::string("this is OpenColorIO ") + OCIO::GetVersion();
    if (path.compare(0, 7, "ocio://") == 0 || archive) {
        if (OCIO::GetVersionHex() < 0x02020000)
            throw std::runtime_error(path + (archive ? ": archives" : ": built-in configurations") +
                                     " need OpenColorIO 2.2 or newer, and " + have +
                                     ", which reads files (.ocio) of version " + known_versions());
    } else if (major && !is_known(major, minor))
        throw std::runtime_error(path + ": a configuration of version " + std::to_string(major) + "." +
                                 std::to_string(minor) + "; " + have + ", which reads versions " + known_versions() +
                                 ". The ACES configurations are published for several: the end of a name such as "
                                 "…_ocio-v2.1.ocio says for which");
}

// YAML lets a text of a few kilobytes stand for one of gigabytes: a name for a list that has another name twice, and so on. Configurations have no
// use for that. Throws if this one does, or is longer than any.
void check_size(const std::string &path) {
    const std::streamoff most = 1 << 24;
    const int most_aliases = 16; // they multiply to a few hundred at most
    struct stat info;
    if (stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode))
        throw std::runtime_error(path + ": expected a file, found a folder"); // of which yaml-cpp would leak
    std::ifstream file(path, std::ios::binary);
    int aliases = 0;
    std::streamoff size = 0;
    for (char byte, before = ' '; size <= most && file.get(byte); size++) {
        if (byte == '*' && std::strchr(" ,[:-", before)) aliases++;
        before = byte == '\n' || byte == '\t' ? ' ' : byte;
    }
    if (file.bad()) throw std::runtime_error(path + ": it cannot be read"); // of which yaml-cpp would leak, too
    if (size > most) throw std::runtime_error(path + ": longer than 16 MiB");
    if (aliases > most_aliases)
        throw std::runtime_error(path + ": more than " + std::to_string(most_aliases) + " aliases (*name)");
}

// Throws if a file that the transform reads is a pipe or a device, which may never end, or larger than any table.
void check_files(const OCIO::ConstConfigRcPtr &config, const OCIO::ConstTransformRcPtr &transform) {
    const off_t most = 1 << 28;
    if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const OCIO::GroupTransform>(transform))
        for (int i = 0; i < group->getNumTransforms(); i++) check_files(config, group->getTransform(i));
    const auto file = OCIO_DYNAMIC_POINTER_CAST<const OCIO::FileTransform>(transform);
    if (!file) return;
    std::string path;
    try {
        path = config->getCurrentContext()->resolveFileLocation(file->getSrc());
    } catch (const OCIO::Exception &) {
        return; // it is missing, which matters only if it is used
    }
    struct stat info;
    if (stat(path.c_str(), &info) == 0 && (!S_ISREG(info.st_mode) || info.st_size > most))
        throw std::runtime_error(path + ": expected a file of at most 256 MiB");
}

void check_all_files(const OCIO::ConstConfigRcPtr &config) {
    const auto any = OCIO::SEARCH_REFERENCE_SPACE_ALL;
    for (int i = 0; i < config->getNumColorSpaces(any, OCIO::COLORSPACE_ALL); i++) {
        const auto space = config->getColorSpace(config->getColorSpaceNameByIndex(any, OCIO::COLORSPACE_ALL, i));
        if (!space) continue;
        check_files(config, space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE));
        check_files(config, space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
    }
    for (int i = 0; i < config->getNumViewTransforms(); i++) {
        const auto view = config->getViewTransform(config->getViewTransformNameByIndex(i));
        if (!view) continue;
        check_files(config, view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
        check_files(config, view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE));
    }
    for (int i = 0; i < config->getNumLooks(); i++) {
        const auto look = config->getLook(config->getLookNameByIndex(i));
        if (!look) continue;
        check_files(config, look->getTransform());
        check_files(config, look->getInverseTransform());
    }
    for (int i = 0; i < config->getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL); i++) {
        const auto named = config->getNamedTransform(config->getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, i));
        if (!named) continue;
        check_files(config, named->getTransform(OCIO::TRANSFORM_DIR_FORWARD));
        check_files(config, named->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
    }
}

// The file of the configuration: that of the option, else $OCIO; NULL for the one that glint has.
const char *config_file(const char *path) {
    if (!path) path = std::getenv("OCIO");
    return path && *path ? path : nullptr;
}

OCIO::ConstConfigRcPtr open_config(const char *path) {
    if ((path = config_file(path))) {
        check_version(path);
        check_size(path);
        OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(path);
        check_all_files(config);
        return config;
    }
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

// OpenColorIO wraps what the standard library throws in its own exceptions, which keep its text.
bool fail_with(const std::exception &e, struct glint_error *err) {
    if (std::strstr(e.what(),
                    "bad_alloc")) // nothing is allocated here: what an exception handler throws would leave this file
        return glint_fail(err, GLINT_ERROR_MEMORY, "OpenColorIO: out of memory");
    return glint_fail(err, GLINT_ERROR_FORMAT, "OpenColorIO: %s", e.what());
}

} // namespace

struct ocio_conversion {
    OCIO::ConstCPUProcessorRcPtr cpu;
};

struct ocio_conversion *ocio_prepare(const struct ocio_options *options, struct glint_error *err) {
    try {
        OCIO::ConstConfigRcPtr config = open_config(options->config);
        const std::string display = choose_display(config, options->display);
        const std::string view = choose_view(config, display, options->view);
        OCIO::DisplayViewTransformRcPtr transform = OCIO::DisplayViewTransform::Create();
        transform->setSrc(choose_input(config, options->input).c_str());
        transform->setDisplay(display.c_str());
        transform->setView(view.c_str());
        return new ocio_conversion{config->getProcessor(transform)->getDefaultCPUProcessor()};
    } catch (const std::invalid_argument &e) {
        const char *file = config_file(options->config);
        glint_fail(err, GLINT_ERROR_USAGE, "%s%s%s", file ? file : "", file ? ": " : "", e.what());
    } catch (const std::exception &e) {
        fail_with(e, err);
    }
    return nullptr;
}

void ocio_release(struct ocio_conversion **conversion) {
    delete *conversion;
    *conversion = nullptr;
}

bool ocio_apply(const struct ocio_options *options, float *rgba, size_t width, size_t height, struct glint_error *err) {
    struct ocio_conversion *own = options->ready ? nullptr : ocio_prepare(options, err);
    const struct ocio_conversion *conversion = options->ready ? options->ready : own;
    bool ok = conversion != nullptr;
    try {
        OCIO::PackedImageDesc image(rgba, long(width), long(height), 4);
        if (ok) conversion->cpu->apply(image);
    } catch (const std::exception &e) {
        ok = fail_with(e, err);
    }
    ocio_release(&own);
    return ok;
}

bool ocio_list(const char *path, void (*each)(void *user, const char *display, const char *view, bool preferred),
               void *user, struct glint_error *err) {
    try {
        OCIO::ConstConfigRcPtr config = open_config(path);
        const std::string first = config->getDefaultDisplay();
        for (int i = 0; i < config->getNumDisplays(); i++) {
            const std::string display = config->getDisplay(i), view = config->getDefaultView(display.c_str());
            for (int k = 0; k < config->getNumViews(display.c_str()); k++) {
                const std::string name = config->getView(display.c_str(), k);
                each(user, display.c_str(), name.c_str(), display == first && name == view);
            }
        }
        return true;
    } catch (const std::exception &e) {
        return fail_with(e, err);
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
