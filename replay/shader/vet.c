/* What a user's shader may not hold: what the device was not asked for, another kind of binding than the declared one, and variables too large for the stack of a
   CPU device. A driver does not check these, and may crash. */
#include "shader.h"

#include <stdlib.h>
#include <string.h>

#include "graph.h"
#include "words.h"

enum { NESTING_MAX = 16, BYTES_MAX = 64 << 10 };
enum { DIM_BUFFER = 5, SAMPLED = 1, STORED = 2 };

/* The capabilities of what gpu.c asks devices for, and of what every one has. */
static const uint32_t capabilities[] = {0 /* Matrix */,
                                        1 /* Shader */,
                                        34 /* ImageCubeArray */,
                                        43 /* Sampled1D */,
                                        44 /* Image1D */,
                                        45 /* SampledCubeArray */,
                                        46 /* SampledBuffer */,
                                        47 /* ImageBuffer */,
                                        50 /* ImageQuery */,
                                        51 /* DerivativeControl */,
                                        56 /* StorageImageWriteWithoutFormat */,
                                        61 /* GroupNonUniform */};

/* A module with the place of the instruction that makes each id. */
struct module {
    const uint32_t *words;
    size_t count;
    uint32_t bound;
    const uint32_t **made;   /* NULL: by an instruction that is of no interest here */
    uint32_t *set, *binding; /* of a variable; UINT32_MAX: none */
};

static const uint32_t *made(const struct module *m, uint32_t id) {
    static const uint32_t nothing[1];
    return id < m->bound && m->made[id] ? m->made[id] : nothing;
}

/* The word that holds the result's id; 0: of no interest. */
static uint32_t result_word(uint32_t code) {
    if (code >= OP_TYPE_BOOL && code <= OP_TYPE_POINTER) return 1;
    return code == OP_CONSTANT || (code >= OP_SPEC_CONSTANT && code <= OP_SPEC_CONSTANT_OP) || code == OP_VARIABLE ? 2
                                                                                                                   : 0;
}

static bool module_read(struct module *m, const struct spirv *spirv) {
    *m = (struct module){
        .words = spirv->words, .count = spirv->bytes / sizeof *spirv->words, .bound = spirv->words[BOUND]};
    m->made = calloc(m->bound, sizeof *m->made);
    m->set = malloc(m->bound * sizeof *m->set + 1);
    m->binding = malloc(m->bound * sizeof *m->binding + 1);
    if (!m->made || !m->set || !m->binding) return false;
    memset(m->set, 0xff, m->bound * sizeof *m->set);
    memset(m->binding, 0xff, m->bound * sizeof *m->binding);
    for (size_t at = HEADER, length; at < m->count; at += length) {
        const uint32_t *op = m->words + at, result = result_word(opcode(op));
        if ((length = op_words(op)) == 0 || length > m->count - at) break;
        if (result && length > result && op[result] < m->bound) m->made[op[result]] = op;
        if (opcode(op) != OP_DECORATE || length != 4 || op[1] >= m->bound) continue;
        if (op[2] == DESCRIPTOR_SET) m->set[op[1]] = op[3];
        if (op[2] == BINDING) m->binding[op[1]] = op[3];
    }
    return true;
}

static void module_finish(struct module *m) {
    free(m->made);
    free(m->set);
    free(m->binding);
}

/* ---- Sizes ---- */

/* The value of a constant, of those of parameters the default. UINT32_MAX: unknown. */
static uint32_t constant(const struct module *m, uint32_t id, int depth) {
    const uint32_t *op = made(m, id);
    if (opcode(op) == OP_CONSTANT || opcode(op) == OP_SPEC_CONSTANT) return op[3];
    if (opcode(op) != OP_SPEC_CONSTANT_OP) return UINT32_MAX;
    if (depth == NESTING_MAX || op_words(op) != 6) return UINT32_MAX;
    if (op[3] == OP_COMPOSITE_EXTRACT) { /* a side of the workgroup */
        const uint32_t *whole = made(m, op[4]);
        const bool fits = opcode(whole) == OP_SPEC_CONSTANT_COMPOSITE && op[5] < op_words(whole) - 3;
        return fits ? constant(m, whole[3 + op[5]], depth + 1) : UINT32_MAX;
    }
    const uint32_t a = constant(m, op[4], depth + 1), b = constant(m, op[5], depth + 1);
    if (a == UINT32_MAX || b == UINT32_MAX) return UINT32_MAX;
    switch (op[3]) {
    case OP_I_ADD:
        return a + b;
    case OP_I_SUB:
        return a - b;
    case OP_I_MUL:
        return a * b;
    case OP_U_DIV:
    case OP_S_DIV:
        return b ? a / b : UINT32_MAX;
    }
    return UINT32_MAX;
}

static uint64_t type_bytes(const struct module *m, uint32_t type, int depth) {
    const uint32_t *op = made(m, type);
    uint64_t sum = 0;
    if (depth == NESTING_MAX) return UINT32_MAX;
    switch (opcode(op)) {
    case OP_TYPE_BOOL:
        return sizeof(uint32_t);
    case OP_TYPE_INT:
    case OP_TYPE_FLOAT:
        return op[2] / 8;
    case OP_TYPE_VECTOR:
    case OP_TYPE_MATRIX:
        return type_bytes(m, op[2], depth + 1) * op[3];
    case OP_TYPE_ARRAY:
        sum = type_bytes(m, op[2], depth + 1) * constant(m, op[3], 0);
        break;
    case OP_TYPE_STRUCT:
        for (uint32_t w = 2; w < op_words(op); w++) sum += type_bytes(m, op[w], depth + 1);
    }
    return sum < UINT32_MAX ? sum : UINT32_MAX;
}

static bool check_sizes(const struct module *m, const char *path, struct glint_error *err) {
    uint64_t bytes = 0;
    for (uint32_t id = 0; id < m->bound; id++) {
        const uint32_t *op = made(m, id);
        if (opcode(op) != OP_VARIABLE ||
            (op[3] != STORAGE_WORKGROUP && op[3] != STORAGE_PRIVATE && op[3] != STORAGE_FUNCTION))
            continue;
        bytes += type_bytes(m, made(m, op[1])[3], 0);
    }
    return bytes <= BYTES_MAX ||
           glint_fail(err, GLINT_ERROR_LIMIT, "%s: its variables take %llu bytes, more than %d, the limit", path,
                      (unsigned long long)bytes, BYTES_MAX);
}

/* ---- Bindings ---- */

/* Whether a variable is an image or a texel buffer as the row declares it, or an array of them. */
static bool fits_row(const struct module *m, const uint32_t *variable, const struct glint_row *row) {
    const uint32_t *type = made(m, made(m, variable[1])[3]);
    if (row->kind == GLINT_ROW_WRITE_LEVELS) {
        if (opcode(type) != OP_TYPE_ARRAY || constant(m, type[3], 0) > row_bindings(row)) return false;
        type = made(m, type[2]);
    }
    return variable[3] == STORAGE_UNIFORM_CONSTANT && opcode(type) == OP_TYPE_IMAGE &&
           (type[3] == DIM_BUFFER) == (strstr(row->glsl, "Buffer") != NULL) &&
           type[7] == (row_is_sampled(row) ? (uint32_t)SAMPLED : (uint32_t)STORED);
}

/* What passes/shared/interface.glsl declares in set 1. */
static bool fits_interface(const struct module *m, const uint32_t *variable, uint32_t binding) {
    const uint32_t type = opcode(made(m, made(m, variable[1])[3]));
    if (binding == 0) return variable[3] == STORAGE_UNIFORM && type == OP_TYPE_STRUCT;
    if (binding == 3) return variable[3] == STORAGE_BUFFER && type == OP_TYPE_STRUCT;
    return binding < 3 && variable[3] == STORAGE_UNIFORM_CONSTANT && type == OP_TYPE_SAMPLER;
}

static bool fits(const struct module *m, const uint32_t *variable, const struct glint_pass *pass) {
    const uint32_t set = m->set[variable[2]] == UINT32_MAX ? 0 : m->set[variable[2]], binding = m->binding[variable[2]];
    if (set == 1) return fits_interface(m, variable, binding);
    for (size_t r = 0; set == 0 && r < pass->row_count; r++)
        if (row_is_image(&pass->rows[r]) && pass->rows[r].id == binding) return fits_row(m, variable, &pass->rows[r]);
    return false;
}

static bool check_bindings(const struct module *m, const struct glint_pass *pass, const char *path,
                           struct glint_error *err) {
    for (uint32_t id = 0; id < m->bound; id++)
        if (m->binding[id] != UINT32_MAX && opcode(made(m, id)) == OP_VARIABLE && !fits(m, made(m, id), pass))
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "%s: binding %u of set %u is not an image that %s/%s declares, or not of its kind", path,
                              m->binding[id], m->set[id] == UINT32_MAX ? 0 : m->set[id], pass->slot, pass->variant);
    return true;
}

static bool check_capabilities(const struct module *m, const char *path, struct glint_error *err) {
    for (size_t at = HEADER; at < m->count && op_words(m->words + at) == 2 && opcode(m->words + at) == OP_CAPABILITY;
         at += 2) {
        bool known = false;
        for (size_t i = 0; i < sizeof capabilities / sizeof *capabilities; i++)
            known |= capabilities[i] == m->words[at + 1];
        if (!known)
            return glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                              "%s: it needs the capability %u of SPIR-V, which glint does not ask devices for", path,
                              m->words[at + 1]);
    }
    return true;
}

bool spirv_vet(const struct spirv *spirv, const struct glint_pass *pass, const char *path, struct glint_error *err) {
    struct module module;
    const bool ok = module_read(&module, spirv)
                        ? check_capabilities(&module, path, err) && check_bindings(&module, pass, path, err) &&
                              check_sizes(&module, path, err)
                        : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    module_finish(&module);
    return ok;
}
