/* Loads the module that decodes with OpenImageIO when the first image needs it: Debian's OpenImageIO brings 240 libraries, which would
   add most of a second to the start of every command. */
#include "oiio.h"

#include <dlfcn.h>
#include <string.h>

typedef bool decode_fn(const char *path, const char *kind, const uint8_t *data, size_t size, uint64_t most,
                       struct oiio_image *out, struct glint_error *err);

bool oiio_decode(const char *path, const char *kind, const uint8_t *data, size_t size, uint64_t most,
                 struct oiio_image *out, struct glint_error *err) {
    void *module = dlopen("libglint-oiio.so", RTLD_NOW | RTLD_LOCAL); /* stays loaded */
    void *found = module ? dlsym(module, "glint_oiio_decode") : NULL;
    decode_fn *decode = NULL;
    if (!found) {
        const char *reason = dlerror();
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                          "%s: %s images are decoded by OpenImageIO, which cannot be loaded (Debian: apt install "
                          "libopenimageio2.4): %.200s",
                          path, kind, reason ? reason : "it is incomplete");
    }
    memcpy(&decode, &found, sizeof decode); /* C knows no conversion of pointers to functions */
    return decode(path, kind, data, size, most, out, err);
}
