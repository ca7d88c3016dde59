/* Leaves parts and channels out of a capture, by their names. */
#include "edit/edit.h"

#include <stdio.h>
#include <string.h>

#include "capture/missing.h"
#include "glint/capture.h"
#include "io/table.h"
#include "nearest.h"

/* "gbuffer", "cubemap" (all of them), "previous" (all of them), "gbuffer:motion", "cubemap:distance.Z". */
static bool begins(const char *name, const char *with, size_t length) {
    return !strncmp(name, with, length) && (name[length] == '\0' || name[length] == '.');
}

static bool names_part(const char *item, const char *part) {
    return begins(part, item, strcspn(item, ":"));
}

static bool names_channel(const char *item, const char *part, const char *channel) {
    const char *colon = strchr(item, ':');
    return names_part(item, part) && (!colon || begins(channel, colon + 1, strlen(colon + 1)));
}

static bool any_names_part(const struct list *list, const char *part) {
    for (size_t i = 0; i < list->count; i++)
        if (names_part(list->items[i], part)) return true;
    return false;
}

static bool any_names_channel(const struct list *list, const char *part, const char *channel) {
    for (size_t i = 0; i < list->count; i++)
        if (names_channel(list->items[i], part, channel)) return true;
    return false;
}

/* ---- Names that the capture does not have ---- */

static bool is_known(const struct glint_capture *capture, const char *item) {
    for (size_t p = 0; p < glint_capture_part_count(capture); p++) {
        const struct glint_part_info *part = glint_capture_part(capture, p);
        for (size_t c = 0; c < part->channel_count; c++)
            if (names_channel(item, part->name, part->channels[c].name)) return true;
    }
    return false;
}

static bool refuse_unknown(const struct glint_capture *capture, const char *item, struct glint_error *err) {
    enum { NAMES = 512 };
    char names[NAMES][128];
    size_t count = 0;
    struct glint_nearest near = glint_nearest_to(item);
    for (size_t p = 0; p < glint_capture_part_count(capture); p++) {
        const struct glint_part_info *part = glint_capture_part(capture, p);
        glint_nearest_offer(&near, part->name);
        for (size_t c = 0; c < part->channel_count; c++) {
            const char *channel = part->channels[c].name;
            const size_t layer = strcspn(channel, ".");
            if (count + 2 > NAMES || !strchr(item, ':')) continue;
            snprintf(names[count], sizeof *names, "%.60s:%.60s", part->name, channel);
            glint_nearest_offer(&near, names[count++]);
            snprintf(names[count], sizeof *names, "%.60s:%.*s", part->name, (int)layer, channel);
            glint_nearest_offer(&near, names[count++]);
        }
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: the capture has no part or channel of this name%s", item,
                      glint_nearest_text(&near));
}

/* ---- What stays ---- */

static bool part_is_required(const struct glint_part_info *part) {
    return part->role && part->role->required && !part->previous;
}

static bool part_stays(const struct selection *s, const struct glint_part_info *part) {
    if (s->keep->count) return part_is_required(part) || any_names_part(s->keep, part->name);
    for (size_t c = 0; c < part->channel_count; c++)
        if (!any_names_channel(s->drop, part->name, part->channels[c].name)) return true;
    return false;
}

static bool channel_stays(const struct selection *s, const struct glint_part_info *part, const char *channel) {
    if (s->keep->count)
        return glint_part_needs_channel(part, channel) || any_names_channel(s->keep, part->name, channel);
    return !any_names_channel(s->drop, part->name, channel);
}

/* What must be there cannot be dropped. */
static bool check_required(const struct selection *s, const struct glint_part_info *part, struct glint_error *err) {
    if (!part_stays(s, part))
        return !part_is_required(part) ||
               glint_fail(err, GLINT_ERROR_USAGE, "%s: every capture must have this part", part->name);
    for (size_t c = 0; c < part->channel_count; c++)
        if (!channel_stays(s, part, part->channels[c].name) && glint_part_needs_channel(part, part->channels[c].name))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s:%s: a part %s must have this channel", part->name,
                              part->channels[c].name, part->name);
    return true;
}

/* ---- Leaving out ---- */

static uint64_t stored_bytes(const struct glint_part_info *part, const struct glint_channel_info *channel) {
    return (uint64_t)part->width * part->height * (channel->stored == GLINT_STORED_HALF ? 2 : 4);
}

/* Costs that were said of another part. */
struct said {
    const char *costs[32];
    size_t count;
};

static void add_cost(char *text, size_t size, struct said *said, const char *cost) {
    const size_t used = strlen(text);
    for (size_t i = 0; i < said->count; i++)
        if (said->costs[i] == cost) return;
    if (!cost || said->count == sizeof said->costs / sizeof *said->costs) return;
    said->costs[said->count++] = cost;
    snprintf(text + used, size - used, "%s%s", used ? "; " : "", cost);
}

/* `costs`: what a replay loses, or "". */
static void say_left_out(const struct command *command, const struct glint_part_info *part, const char *channels,
                         uint64_t bytes, const char *costs) {
    command_note(command, "left out: %s%s%s, %s of pixels%s%s", part->name, *channels ? ": " : "", channels,
                 bytes_text(bytes), *costs ? ": " : "", costs);
}

static bool select_part(struct glint_edit *edit, const struct glint_part_info *part, const struct selection *s,
                        const struct command *command, struct said *said, struct glint_error *err) {
    const size_t i = glint_edit_find(edit, part->name);
    char names[400] = "", costs[600] = "";
    uint64_t bytes = 0;
    if (!part_stays(s, part)) {
        glint_edit_drop_part(edit, i);
        for (size_t c = 0; c < part->channel_count; c++) bytes += stored_bytes(part, &part->channels[c]);
        add_cost(costs, sizeof costs, said, missing_cost(part->name, NULL));
        say_left_out(command, part, "", bytes, costs);
        return true;
    }
    for (size_t c = 0; c < part->channel_count; c++) {
        const struct glint_channel_info *channel = &part->channels[c];
        if (channel_stays(s, part, channel->name)) continue;
        if (!glint_edit_drop_channel(edit, i, channel->name, err)) return false;
        bytes += stored_bytes(part, channel);
        add_cost(costs, sizeof costs, said, missing_cost(part->name, channel->name));
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", *names ? " " : "", channel->name);
    }
    if (bytes) say_left_out(command, part, names, bytes, costs);
    return true;
}

bool edit_select(struct glint_edit *edit, const char *path, const struct selection *selection,
                 const struct command *command, struct glint_error *err) {
    const struct list *items = selection->keep->count ? selection->keep : selection->drop;
    struct glint_capture *capture = glint_capture_open(path, NULL, err);
    struct said said = {.count = 0};
    bool ok = capture != NULL;
    const size_t count = ok ? glint_capture_part_count(capture) : 0;
    for (size_t i = 0; ok && i < items->count; i++)
        ok = is_known(capture, items->items[i]) || refuse_unknown(capture, items->items[i], err);
    for (size_t p = 0; ok && p < count; p++) ok = check_required(selection, glint_capture_part(capture, p), err);
    for (size_t p = 0; ok && p < count; p++)
        ok = select_part(edit, glint_capture_part(capture, p), selection, command, &said, err);
    glint_capture_close(&capture);
    return ok;
}
