/* How the channels of a part are encoded: what the manifest says, what follows from camera and textures, and what contradicts them. */
#include "encodings.h"

#include <stddef.h>
#include <string.h>

#include "camera.h"

static const struct {
    const char *key;
    size_t offset;
} members[] = {
    {"depth", offsetof(struct glint_encodings, depth)},
    {"normal", offsetof(struct glint_encodings, normal)},
    {"vertex_normal", offsetof(struct glint_encodings, vertex_normal)},
    {"normal_space", offsetof(struct glint_encodings, normal_space)},
    {"roughness", offsetof(struct glint_encodings, roughness)},
    {"motion", offsetof(struct glint_encodings, motion)},
    {"motion_depth", offsetof(struct glint_encodings, motion_depth)},
    {"color", offsetof(struct glint_encodings, color)},
};
enum { MEMBERS = sizeof members / sizeof *members };

static void set(struct glint_encodings *encodings, size_t member, int value) {
    memcpy((char *)encodings + members[member].offset, &value, sizeof value);
}

static const struct channel *find_channel(const struct part *part, const char *name) {
    for (size_t i = 0; i < part->count; i++)
        if (!strcmp(part->channels[i].name, name)) return &part->channels[i];
    return NULL;
}

static bool concerns(const struct part *part, const char *key) {
    for (size_t i = 0; i < part->count; i++) {
        const struct glint_role_channel *row = role_channel(part->role, part->channels[i].name);
        if (row && (!strcmp(row->encoding, key) || (!strcmp(key, "normal_space") && strstr(row->encoding, "normal"))))
            return true;
    }
    return false;
}

/* ---- Depth ---- */

static bool is_device(enum glint_depth_encoding depth) {
    return depth == GLINT_DEPTH_DEVICE || depth == GLINT_DEPTH_REVERSED || depth == GLINT_DEPTH_REVERSED_INFINITE;
}

static bool check_depth(struct part *part, const struct glint_camera *camera, struct glint_error *err) {
    const struct channel *channel = find_channel(part, "depth.Z");
    const struct node encodings = node_child(&part->node, "encodings"), node = node_child(&encodings, "depth");
    if (!concerns(part, "depth")) return true; /* a shadow map's depth is that of its matrix */
    if (!channel || !camera) return true;
    const struct projection p = projection_of(camera->view_to_clip, part->frame->clip_z);
    const bool buffer = channel->texture && channel->sources[0]->component.letter == 'd';
    const enum glint_depth_encoding fits = projection_encoding(&p), said = part->encodings.depth;
    if (!node.value) {
        part->encodings.depth = buffer ? fits : GLINT_DEPTH_VIEW_LINEAR;
        node_note(&node, GLINT_PACK_DEFAULT, "not said; %s, %s",
                  glint_encoding_name("depth", (int)part->encodings.depth),
                  buffer ? "as the projection has it" : "for the texture has no format of a depth buffer");
        return true;
    }
    if (said == GLINT_DEPTH_VIEW_LINEAR && buffer)
        return node_fail(&node, err, GLINT_ERROR_FORMAT,
                         "view_linear contradicts the texture: %s is a depth buffer in [0, 1]; expected %s, as the "
                         "projection has it",
                         channel->texture->images[0].format, glint_encoding_name("depth", (int)fits));
    if (is_device(said) &&
        (p.is_reversed != (said != GLINT_DEPTH_DEVICE) || (said == GLINT_DEPTH_REVERSED_INFINITE && !p.is_infinite)))
        return node_fail(&node, err, GLINT_ERROR_FORMAT,
                         "%s contradicts the projection, in which depth is %d at %.6g units and %s; expected %s",
                         glint_encoding_name("depth", (int)said), p.is_reversed, p.near,
                         p.is_infinite ? "has no far plane" : "has a far plane",
                         glint_encoding_name("depth", (int)fits));
    const struct glint_frame *frame = part->frame;
    if (said >= GLINT_DEPTH_LOGARITHMIC && !(frame->depth_near > 0 && frame->depth_near < frame->depth_far))
        return node_fail(&node, err, GLINT_ERROR_FORMAT,
                         "logarithmic: expected frame.depth_near and depth_far, 0 < near < far, found %g and %g",
                         frame->depth_near, frame->depth_far);
    return true;
}

/* ---- Normals ---- */

/* Components in [0, 1] without a scale hold (n + 1) / 2, unless something else is said. */
static bool check_normal(struct part *part, const char *layer, const char *key, enum glint_normal_encoding *encoding,
                         struct glint_error *err) {
    const char *const axes[] = {"X", "Y", "Z"};
    const struct channel *found[3];
    const struct node encodings = node_child(&part->node, "encodings"), node = node_child(&encodings, key);
    for (int i = 0; i < 3; i++) {
        char name[64];
        strcpy(name, layer);
        strcat(name, axes[i]);
        found[i] = find_channel(part, name);
    }
    const struct channel *first = found[0];
    const bool two = *encoding >= GLINT_NORMAL_OCTAHEDRAL; /* without Z */
    if (first && found[1] && !found[2] && !two)
        return node_fail(&first->node, err, GLINT_ERROR_FORMAT,
                         "expected X, Y and Z of a normal, found X and Y: say encodings.%s octahedral, view_xy or "
                         "spheremap, or name "
                         "three components",
                         key);
    if (found[2] && two)
        return node_fail(&found[2]->node, err, GLINT_ERROR_FORMAT,
                         "expected no Z beside a normal that is %s, found one",
                         glint_encoding_name("normal", (int)*encoding));
    if (!first || node.value) return true;
    const bool fixed = first->texture && !first->is_scaled && first->sources[0]->component.kind == COMPONENT_UNORM;
    if (fixed) *encoding = GLINT_NORMAL_UNORM;
    node_note(&node, GLINT_PACK_DEFAULT, "not said; %s%s%s", fixed ? "unorm, since " : "signed",
              fixed ? first->texture->images[0].format : "", fixed ? " holds [0, 1]" : "");
    return true;
}

bool encodings_read(struct part *part, const struct glint_camera *camera, struct glint_error *err) {
    const struct node node = node_child(&part->node, "encodings");
    for (size_t i = 0; i < MEMBERS; i++) {
        const char *text = node.value ? node_text(&node, members[i].key) : NULL;
        const struct node key = node_child(&node, members[i].key);
        const bool needed = concerns(part, members[i].key);
        if (text && !needed)
            return node_fail(&key, err, GLINT_ERROR_FORMAT, "the part has no channel that this encoding applies to");
        set(&part->encodings, i, text ? glint_encoding_value(members[i].key, text) : 0);
        const bool later = !strcmp(members[i].key, "depth") || strstr(members[i].key, "normal");
        if (needed && text) node_note(&key, GLINT_PACK_SAID, "%s", text);
        else if (needed && (!later || !strcmp(members[i].key, "normal_space")))
            node_note(&key, GLINT_PACK_DEFAULT, "not said; %s", glint_encoding_name(members[i].key, 0));
    }
    if (!part->role || !part->role->channels) return true;
    return check_depth(part, camera, err) && check_normal(part, "normal.", "normal", &part->encodings.normal, err) &&
           check_normal(part, "vertexNormal.", "vertex_normal", &part->encodings.vertex_normal, err);
}
