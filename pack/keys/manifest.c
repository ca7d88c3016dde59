/* Reads a manifest. */
#include "manifest.h"

#include <stdlib.h>

#include "check.h"
#include "file.h"
#include "inside.h"

enum { LONGEST_MANIFEST = 64 << 20 };

bool manifest_open(struct manifest *manifest, const char *path, const struct glint_pack_options *options,
                   struct faults *faults, struct glint_error *err) {
    struct bytes bytes = {0};
    json_error_t where;
    *manifest = (struct manifest){.path = path, .options = options, .faults = faults};
    if (!file_read(path, LONGEST_MANIFEST, &bytes, err)) return false;
    manifest->text = (char *)bytes.data;
    manifest->size = bytes.size;
    if (!inside_json_fits(path, manifest->text, manifest->size, err)) return false;
    manifest->root = json_loadb(manifest->text, manifest->size, JSON_REJECT_DUPLICATES, &where);
    if (!manifest->root)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s:%d: column %d: %s", path, where.line > 0 ? where.line : 1,
                          where.column, where.text);
    const struct node root = node_root(manifest);
    const struct node version = node_child(&root, "glint");
    if (json_is_object(root.value) && (!version.value || !json_is_integer(version.value)))
        return node_fail(&version, err, GLINT_ERROR_FORMAT, "expected 1, the version of the manifest, found %s",
                         version.value ? "another value" : "nothing");
    if (!node_check(&root, pack_objects, err)) return false;
    const long long number = json_integer_value(version.value);
    return number == 1 || node_fail(&version, err, GLINT_ERROR_FORMAT,
                                    "expected version 1, found %lld: this glint is older than the manifest", number);
}

char *manifest_file(const struct node *node, const char *name, struct glint_error *err) {
    const struct manifest *manifest = node->manifest;
    const bool anywhere = manifest->options->outside || (manifest->own && file_same(manifest->own, name));
    char *path = anywhere ? file_beside(manifest->path, name) : inside_beside(manifest->path, name, err);
    char *real = path && anywhere ? realpath(path, NULL) : NULL; /* for what takes no links */
    if (!path && anywhere) node_no_memory(node, err);
    else if (!path) node_wrap(node, err);
    if (!real) return path;
    free(path);
    return real;
}

void manifest_close(struct manifest *manifest) {
    json_decref(manifest->root);
    free(manifest->text);
    *manifest = (struct manifest){0};
}
