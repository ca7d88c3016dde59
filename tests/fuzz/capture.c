/* Fuzzes what reads captures: every rule is checked, every part is read as stored and decoded, and a capture without a violation is
   reduced and written again, which has to be one, too. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"
#include "glint/edit.h"

/* All half and float channels of a part, or all its uint channels. */
static void read_kind(struct glint_capture *capture, const struct glint_part_info *part, bool integer) {
    enum { MOST = 31 };
    struct glint_error err = {0};
    const char *names[MOST + 1];
    size_t count = 0;
    for (size_t c = 0; c < part->channel_count && count < MOST; c++)
        if ((part->channels[c].stored == GLINT_STORED_UINT) == integer) names[count++] = part->channels[c].name;
    if (!count) return;
    names[count++] = NULL;
    void *out = malloc((size_t)part->width * part->height * 4 * count);
    fuzz_must(out != NULL, "there is memory");
    const enum glint_type type = integer ? GLINT_U32 : GLINT_F32;
    const bool raw = glint_capture_read_raw(capture, part, names, count, type, out, 1, &err);
    if (fuzz_reason(raw, &err))
        fuzz_reason(glint_capture_read(capture, part, names, count, integer ? GLINT_U32 : GLINT_F16, out, 1, &err),
                    &err);
    free(out);
}

static void check_report(void *user, const char *rule, const char *message) {
    (void)user;
    fuzz_must(rule[0] && message[0] && !strchr(message, '\n'), "a violation has a rule and a message of one line");
}

static void edit(const char *path) {
    struct glint_error err = {0};
    const char *out = fuzz_file("reduced.exr", "", 0);
    struct glint_edit *edit = glint_edit_open(path, &fuzz_limits, NULL, NULL, &err);
    if (fuzz_reason(edit && glint_edit_reduce(edit, 2, &err) && glint_edit_write(edit, out, &err), &err)) {
        struct glint_capture *capture = glint_capture_open(out, &fuzz_limits, &err);
        fuzz_must(capture != NULL, err.message);
        glint_capture_close(&capture);
    }
    if (edit) glint_edit_close(&edit);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    size_t violations = 0;
    const char *path = fuzz_file("input.exr", data, size);
    const bool valid = glint_capture_validate(path, &fuzz_limits, check_report, NULL, &violations, &err);
    fuzz_reason(valid, &err);
    struct glint_capture *capture = glint_capture_open(path, &fuzz_limits, &err);
    if (!fuzz_reason(capture != NULL, &err)) return 0;
    fuzz_must(glint_frame_notes(glint_capture_frame(capture), notes) <= GLINT_NOTES, "there are few notes");
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        read_kind(capture, part, false);
        read_kind(capture, part, true);
    }
    glint_capture_close(&capture);
    if (valid && !violations) edit(path);
    return 0;
}
