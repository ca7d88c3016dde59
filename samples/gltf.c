#include "gltf.h"
bool gltf_load(const char *path, struct scene *scene, struct glint_error *err) {
    (void)scene;
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: no such scene", path);
}
bool place_probes(struct scene *scene, struct glint_error *err) {
    (void)scene;
    (void)err;
    return true;
}
