/* Fuzzes the texts of --set and --use: a line each, applied to a built-in preset. Whatever is taken lies in its range. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "glint/replay.h"

static void check_values(const struct glint_pipeline *pipeline) {
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        fuzz_must(glint_pipeline_find(pipeline, pass->slot) == pass, "a pass is found by its slot");
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            if (!glint_row_is_parameter(row)) continue;
            const double value = glint_pipeline_value(pipeline, pass, row);
            fuzz_must(value >= row->lowest && value <= row->highest, "a value lies in its range");
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static struct glint_pipeline *plain;
    struct glint_error err = {0};
    if (!plain) plain = glint_pipeline_create("mafia3", &err);
    struct glint_pipeline *pipeline = glint_pipeline_copy(plain, &err);
    fuzz_must(pipeline != NULL, err.message);
    char *text = strdup(fuzz_text(data, size)), *rest = text, *line;
    fuzz_must(text != NULL, "there is memory");
    while ((line = strsep(&rest, "\n")) != NULL) {
        const bool set = memchr(line, '.', strcspn(line, "=")) != NULL;
        fuzz_reason(set ? glint_pipeline_set(pipeline, line, &err) : glint_pipeline_use(pipeline, line, &err), &err);
    }
    check_values(pipeline);
    free(text);
    glint_pipeline_destroy(&pipeline);
    return 0;
}
