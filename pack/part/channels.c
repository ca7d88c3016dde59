/* The channels of a part: which keys name which, and the texture's components that they are made of. */
#include "channels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "nearest.h"

enum { MOST_CHANNELS = 1024, GROUP = 8 };

/* Channels that one key names. */
struct names {
    const char *all[GROUP];
    size_t count;
    char letters[GROUP][2];
};

static bool is_free(const struct part *part) {
    return !part->role || !part->role->channels;
}

/* "RGB": channels of one letter. */
static bool name_letters(const struct part *part, const char *key, struct names *names) {
    if (strcmp(key, "RGB") && strcmp(key, "RGBA")) return false;
    for (size_t i = 0; key[i]; i++) {
        snprintf(names->letters[i], 2, "%c", key[i]);
        if (!is_free(part) && !role_channel(part->role, names->letters[i])) return false;
        names->all[names->count++] = names->letters[i];
    }
    return true;
}

/* "normal": the channels of a layer, in the order of the role's rows. */
static bool name_layer(const struct part *part, const char *key, struct names *names) {
    const size_t length = strlen(key);
    for (size_t i = 0; i < part->role->channel_count && names->count < GROUP; i++) {
        const char *channel = part->role->channels[i].name;
        if (!strncmp(channel, key, length) && channel[length] == '.' && strlen(channel) == length + 2)
            names->all[names->count++] = channel;
    }
    return names->count > 0;
}

static bool unknown_channel(const struct part *part, const struct node *node, struct glint_error *err) {
    struct glint_nearest near = glint_nearest_to(node->key);
    for (size_t i = 0; i < part->role->channel_count; i++) glint_nearest_offer(&near, part->role->channels[i].name);
    for (const struct key *key = pack_object("part")->keys; key->name; key++) glint_nearest_offer(&near, key->name);
    return node_fail(node, err, GLINT_ERROR_FORMAT, "%s has no such channel and a part no such key%s", part->role->name,
                     glint_nearest_text(&near));
}

static bool find_names(const struct part *part, const struct node *node, bool exact, struct names *names,
                       struct glint_error *err) {
    *names = (struct names){.count = 0};
    if (!node->key[0] || strlen(node->key) > 255)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected a channel's name of 1 to 255 bytes");
    if (!exact && name_letters(part, node->key, names)) return true;
    names->count = 0;
    if (is_free(part) || role_channel(part->role, node->key)) {
        names->all[names->count++] = node->key;
        return true;
    }
    return (!exact && name_layer(part, node->key, names)) || unknown_channel(part, node, err);
}

/* ---- Components ---- */

/* The components that a text selects: the whole name of one, a layer, or one letter for each. Returns their number, 0 for none. */
static size_t select_sources(const struct image *image, const char *text, size_t most, size_t out[GROUP]) {
    const size_t length = strlen(text);
    const struct source *whole = image_source(image, text, length);
    size_t count = 0;
    if (whole) return out[0] = (size_t)(whole - image->sources), 1;
    for (const char *axis = "RGBAXYZ"; *axis && count < most && length && length < 250; axis++) {
        char name[256];
        snprintf(name, sizeof name, "%s.%c", text, *axis);
        const struct source *one = image_source(image, name, length + 2);
        if (one) out[count++] = (size_t)(one - image->sources);
    }
    if (count) return count;
    for (; text[count]; count++) {
        const struct source *one = count < GROUP ? image_source(image, text + count, 1) : NULL;
        if (!one) return 0;
        out[count] = (size_t)(one - image->sources);
    }
    return count;
}

static void list_components(const struct image *image, char text[200]) {
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < image->count && length < 150; i++)
        length += (size_t)snprintf(text + length, 200 - length, "%s%.60s", i ? " " : "", image->sources[i].name);
}

static bool choose_components(const struct texture *texture, const struct node *node, const char *text, size_t names,
                              size_t out[GROUP], size_t *count, struct glint_error *err) {
    const struct image *image = &texture->images[0];
    char list[200];
    list_components(image, list);
    *count = text ? select_sources(image, text, names, out) : 0;
    if (!text && image->count == 1) out[(*count)++] = 0;
    if (!*count && !text)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected a component of texture \"%.80s\": %s",
                         texture->node.key, list);
    if (!*count)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "texture \"%.80s\" has no component \"%.40s\"; it has %s",
                         texture->node.key, text, list);
    if (*count > names)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected at most %zu component%s, found %zu in \"%.40s\"",
                         names, names == 1 ? "" : "s", *count, text);
    return true;
}

/* ---- One key ---- */

static struct channel *add_channel(struct part *part, const struct node *node, const char *name,
                                   struct glint_error *err) {
    for (size_t i = 0; i < part->count; i++)
        if (!strcmp(part->channels[i].name, name)) {
            node_fail(node, err, GLINT_ERROR_FORMAT, "expected channel %s once, found it also in %s", name,
                      part->channels[i].node.key);
            return NULL;
        }
    if (part->count == MOST_CHANNELS) {
        node_fail(node, err, GLINT_ERROR_LIMIT, "expected at most %d channels", MOST_CHANNELS);
        return NULL;
    }
    struct channel *channel = &part->channels[part->count++];
    *channel = (struct channel){.node = *node, .scale = 1};
    snprintf(channel->name, sizeof channel->name, "%s", name);
    return channel;
}

static bool check_size(struct part *part, const struct node *node, const struct texture *texture,
                       struct glint_error *err) {
    if (!part->width) {
        part->width = texture->width;
        part->height = texture->height;
    }
    if (texture->width == part->width && texture->height == part->height) return true;
    return node_fail(node, err, GLINT_ERROR_FORMAT,
                     "expected %u x %u texels, as the part's other channels have, found %u x %u in texture \"%.80s\"",
                     part->width, part->height, texture->width, texture->height, texture->node.key);
}

static bool add_textured(struct part *part, const struct node *node, const struct names *names, const char *name,
                         size_t length, const char *component, struct glint_error *err) {
    size_t found[GROUP], count = 0;
    const struct texture *texture = texture_find(part->textures, node, name, length, part->is_cube, err);
    if (!texture || !check_size(part, node, texture, err) ||
        !choose_components(texture, node, component, names->count, found, &count, err))
        return false;
    for (size_t i = 0; i < count; i++) {
        struct channel *channel = add_channel(part, node, names->all[i], err);
        if (!channel) return false;
        channel->texture = texture;
        for (size_t k = 0; k < texture->image_count; k++) channel->sources[k] = &texture->images[k].sources[found[i]];
    }
    return true;
}

static bool add_constant(struct part *part, const struct node *node, const struct names *names, double value,
                         struct glint_error *err) {
    for (size_t i = 0; i < names->count; i++) {
        struct channel *channel = add_channel(part, node, names->all[i], err);
        if (!channel) return false;
        channel->value = value;
    }
    return true;
}

static bool add_object(struct part *part, const struct node *node, const struct names *names, struct glint_error *err) {
    const char *texture = node_text(node, "texture"), *storage = node_text(node, "storage"),
               *type = node_text(node, "type");
    const bool constant = node_has(node, "value");
    const size_t first = part->count;
    if (constant == (texture != NULL))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected a texture or a value, found %s",
                         constant ? "both" : "none");
    if (storage && (!storage[0] || strlen(storage) > 63))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "storage: expected a format's name of 1 to 63 bytes");
    if (!(constant ? add_constant(part, node, names, node_number(node, "value", 0), err)
                   : add_textured(part, node, names, texture, strlen(texture), node_text(node, "channel"), err)))
        return false;
    for (size_t i = first; i < part->count; i++) {
        struct channel *channel = &part->channels[i];
        channel->scale = node_number(node, "scale", 1);
        channel->offset = node_number(node, "offset", 0);
        channel->is_scaled = channel->scale != 1 || channel->offset != 0;
        if (storage) snprintf(channel->storage, sizeof channel->storage, "%s", storage);
        channel->is_typed = type != NULL;
        if (type)
            channel->stored = !strcmp(type, "half")    ? GLINT_STORED_HALF
                              : !strcmp(type, "float") ? GLINT_STORED_FLOAT
                                                       : GLINT_STORED_UINT;
    }
    return true;
}

static bool add_key(struct part *part, const struct node *node, bool exact, struct glint_error *err) {
    struct names names;
    const char *text = json_string_value(node->value);
    if (!find_names(part, node, exact, &names, err)) return false;
    if (text) {
        const size_t listed = texture_name_length(part->textures, text), dot = strcspn(text, "."),
                     length = listed ? listed : dot;
        return add_textured(part, node, &names, text, length, text[length] ? text + length + 1 : NULL, err);
    }
    if (json_is_number(node->value)) return add_constant(part, node, &names, json_number_value(node->value), err);
    if (json_is_object(node->value))
        return node_check(node, pack_object("channel"), err) && add_object(part, node, &names, err);
    return node_fail(node, err, GLINT_ERROR_FORMAT,
                     "expected a channel: \"TEXTURE.COMPONENT\", a number or an object, found another value");
}

/* ---- All keys ---- */

static bool add_keys(struct part *part, const struct node *object, bool exact, struct glint_error *err) {
    const struct object *part_keys = pack_object("part");
    bool ok = true;
    for (void *at = json_object_iter(object->value); at; at = json_object_iter_next(object->value, at)) {
        const struct node node = node_child(object, json_object_iter_key(at));
        if (!exact && (pack_key(part_keys, node.key) || !strcmp(node.key, "comment"))) continue;
        if (add_key(part, &node, exact, err)) continue;
        ok = false;
        if (!node_keep(&node, err)) return false;
    }
    return ok;
}

bool channels_read(struct part *part, struct glint_error *err) {
    const char *sibling = node_text(&part->node, "sibling");
    part->channels = calloc(MOST_CHANNELS, sizeof *part->channels);
    if (!part->channels) return node_no_memory(&part->node, err);
    part->more = node_child(&part->node, "channels");
    const struct node *more = &part->more;
    const bool ok = add_keys(part, &part->node, false, err);
    if ((more->value && !add_keys(part, more, true, err)) || !ok) return false;
    if (sibling && part->count)
        return node_fail(&part->channels[0].node, err, GLINT_ERROR_FORMAT, "expected no channels beside a sibling");
    if (!sibling && !part->count)
        return node_fail(&part->node, err, GLINT_ERROR_FORMAT, "expected channels, found none");
    if (!sibling && !part->width)
        return node_fail(&part->node, err, GLINT_ERROR_FORMAT,
                         "expected a channel with a texture, which gives the part its size, found constants alone");
    return true;
}

void channels_finish(struct part *part) {
    for (size_t i = 0; part->channels && i < part->count; i++) free(part->channels[i].data);
    free(part->channels);
    part->channels = NULL;
    part->count = 0;
}
