/* What the system refuses while OpenEXRCore works, and what OpenEXRCore says of it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exr_internal.h"

static _Thread_local bool ran_out;
static _Thread_local char complaint[256];

void *glint_exr_memory_take(size_t bytes) {
    void *memory = malloc(bytes ? bytes : 1);
    ran_out |= !memory;
    return memory;
}

void glint_exr_memory_free(void *memory) {
    free(memory);
}

void glint_exr_complain(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code;
    if (!complaint[0]) snprintf(complaint, sizeof complaint, "%s", message ? message : "");
}

const char *glint_exr_complaint(exr_result_t code) {
    return complaint[0] ? complaint : exr_get_default_error_message(code);
}

void glint_exr_memory_begin(void) {
    ran_out = false;
    complaint[0] = '\0';
}

bool glint_exr_memory_ran_out(void) {
    return ran_out;
}

bool glint_exr_system_failed(struct glint_exr *exr, enum glint_code *code, const char **what) {
    glint_mutex_lock(&exr->stream.lock);
    const int failure = exr->stream.failure;
    glint_mutex_unlock(&exr->stream.lock);
    if (!ran_out && !failure) return false;
    *code = ran_out ? GLINT_ERROR_MEMORY : GLINT_ERROR_IO;
    *what = ran_out ? "out of memory" : strerror(failure);
    return true;
}
