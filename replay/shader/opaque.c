/* Values of uniform buffers and push constants that a driver cannot tell from others. Lavapipe compiles a shader again at each dispatch whose
   branches depend on uniform values alone, with these values as constants, and keeps parts of each copy for as long as the process lives. So
   each value that is loaded becomes the result of a choice by the number of workgroups, which is never 0: the same bits, but no uniform value. */
#include "shader.h"

#include <stdlib.h>
#include <string.h>

#include "words.h"

/* A load becomes six instructions at most: one of the entry below, and a null constant of its type. */
enum { WORDS_A_LOAD = 4 + 5 + 5 + 6 + 3, WORDS_AT_MOST = 64 };

struct hiding {
    const uint32_t *words;
    size_t count;    /* of words */
    bool *uniform;   /* for each id: it is the type of pointers to uniform values, or such a pointer */
    uint32_t *nulls; /* for each type that is loaded from them: the null constant */
    size_t loads;
    uint32_t uint_type, bool_type, triple, groups, pointer, zero, next_id;
    uint32_t *out;
    size_t out_count;
};

static void look_at(struct hiding *h, const uint32_t *op) {
    switch (opcode(op)) {
    case OP_TYPE_BOOL:
        h->bool_type = op[1];
        break;
    case OP_TYPE_INT:
        if (op[2] == 32 && op[3] == 0) h->uint_type = op[1];
        break;
    case OP_TYPE_VECTOR:
        if (op[2] == h->uint_type && op[3] == 3) h->triple = op[1];
        break;
    case OP_TYPE_POINTER:
        h->uniform[op[1]] = op[2] == STORAGE_UNIFORM || op[2] == STORAGE_PUSH_CONSTANT;
        break;
    case OP_DECORATE:
        if (op[2] == BUILT_IN && op[3] == NUM_WORKGROUPS) h->groups = op[1];
        break;
    case OP_VARIABLE:
    case OP_ACCESS_CHAIN:
    case OP_IN_BOUNDS_ACCESS_CHAIN:
        h->uniform[op[2]] = h->uniform[op[1]];
        break;
    case OP_LOAD:
        if (!h->uniform[op[3]]) break;
        if (!h->nulls[op[1]]) h->nulls[op[1]] = h->next_id++;
        h->loads++;
        break;
    default:
        break;
    }
}

/* False: it is not whole, or has nothing to hide. */
static bool look_at_all(struct hiding *h) {
    size_t at = HEADER;
    for (; at < h->count && op_words(h->words + at) > 0; at += op_words(h->words + at)) look_at(h, h->words + at);
    return at == h->count && h->loads > 0;
}

static void emit(struct hiding *h, const uint32_t *words, size_t count) {
    memcpy(h->out + h->out_count, words, count * sizeof *words);
    h->out_count += count;
}
/* An instruction from its operands. */
#define EMIT(h, code, ...)                                                                                             \
    emit(h, (const uint32_t[]){(uint32_t)(sizeof((uint32_t[]){0, __VA_ARGS__}) / 4) << 16 | (code), __VA_ARGS__},      \
         sizeof((uint32_t[]){0, __VA_ARGS__}) / 4)

/* What the functions need of types, constants and variables, and the module lacks. */
static void emit_needed(struct hiding *h, uint32_t bound) {
    if (h->uint_type >= bound) EMIT(h, OP_TYPE_INT, h->uint_type, 32, 0);
    if (h->bool_type >= bound) EMIT(h, OP_TYPE_BOOL, h->bool_type);
    if (h->triple >= bound) EMIT(h, OP_TYPE_VECTOR, h->triple, h->uint_type, 3);
    EMIT(h, OP_CONSTANT, h->uint_type, h->zero, 0);
    if (h->groups >= bound) {
        EMIT(h, OP_TYPE_POINTER, h->pointer, STORAGE_INPUT, h->triple);
        EMIT(h, OP_VARIABLE, h->pointer, h->groups, STORAGE_INPUT);
    }
    for (uint32_t type = 0; type < bound; type++)
        if (h->nulls[type]) EMIT(h, OP_CONSTANT_NULL, type, h->nulls[type]);
}

static void emit_load(struct hiding *h, const uint32_t *op) {
    const uint32_t loaded = h->next_id++, groups = h->next_id++, across = h->next_id++, is_some = h->next_id++;
    emit(h, op, 2);
    emit(h, &loaded, 1);
    emit(h, op + 3, op_words(op) - 3);
    EMIT(h, OP_LOAD, h->triple, groups, h->groups);
    EMIT(h, OP_COMPOSITE_EXTRACT, h->uint_type, across, groups, 0);
    EMIT(h, OP_I_NOT_EQUAL, h->bool_type, is_some, across, h->zero);
    EMIT(h, OP_SELECT, op[1], op[2], is_some, loaded, h->nulls[op[1]]);
}

static void write_module(struct hiding *h) {
    const uint32_t bound = h->words[BOUND];
    uint32_t *const needed[] = {&h->uint_type, &h->bool_type, &h->triple, &h->groups, &h->pointer, &h->zero};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (!*needed[i]) *needed[i] = h->next_id++;
    bool decorated = h->groups < bound, declared = false;
    emit(h, h->words, HEADER);
    for (size_t at = HEADER; at < h->count; at += op_words(h->words + at)) {
        const uint32_t *op = h->words + at, code = opcode(op);
        if (!decorated && (code == OP_DECORATE || (code >= OP_TYPE_VOID && code <= OP_TYPE_FORWARD_POINTER))) {
            EMIT(h, OP_DECORATE, h->groups, BUILT_IN, NUM_WORKGROUPS);
            decorated = true;
        }
        if (!declared && code == OP_FUNCTION) emit_needed(h, bound), declared = true;
        if (code == OP_ENTRY_POINT && h->groups >= bound) { /* lists all variables */
            emit(h, &(uint32_t){(op_words(op) + 1) << 16 | code}, 1);
            emit(h, op + 1, op_words(op) - 1);
            emit(h, &h->groups, 1);
        } else if (code == OP_LOAD && h->uniform[op[3]]) emit_load(h, op);
        else emit(h, op, op_words(op));
    }
    h->out[BOUND] = h->next_id;
}

uint32_t *spirv_opaque(const uint32_t *words, size_t bytes, size_t *opaque_bytes) {
    const uint32_t bound = words[BOUND];
    struct hiding h = {.words = words, .count = bytes / sizeof *words, .next_id = bound};
    h.uniform = calloc(bound, sizeof *h.uniform);
    h.nulls = calloc(bound, sizeof *h.nulls);
    if (h.uniform && h.nulls) {
        const bool hides = look_at_all(&h);
        h.out = malloc(bytes + (h.loads * WORDS_A_LOAD + WORDS_AT_MOST) * sizeof *h.out);
        if (h.out && hides) write_module(&h);
        else if (h.out) emit(&h, words, h.count);
    }
    free(h.uniform);
    free(h.nulls);
    *opaque_bytes = h.out_count * sizeof *h.out;
    return h.out;
}
