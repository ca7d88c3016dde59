/* Arithmetic that is rounded operation by operation. Without it a compiler may contract a product and a sum into one operation, in some
   specializations of a shader and not in others, so that recording a pixel, or a plan, could change the last bit of an image. GLSL's `precise`
   says the same of single variables. */
#include "shader.h"

#include <stdlib.h>
#include <string.h>

enum { HEADER = 5, DECORATION_WORDS = 3 };
/* Opcodes of SPIR-V. */
enum {
    EXT_INST = 12,
    TYPE_VOID = 19,
    TYPE_FORWARD_POINTER = 39,
    DECORATE = 71,
    GROUP_MEMBER_DECORATE = 75,
    F_NEGATE = 127,
    F_ADD = 129,
    F_SUB = 131,
    F_MUL = 133,
    F_DIV = 136,
    F_REM = 140,
    DOT = 148,
    DECORATE_ID = 332
};
/* Instructions of GLSL.std.450 that are sums of products. */
enum { DETERMINANT = 33, MIX = 46, STEP = 48, FMA = 50, LENGTH = 66, NORMALIZE = 69, REFLECT = 71, REFRACT = 72 };
enum { NO_CONTRACTION = 42 };

static uint32_t opcode(const uint32_t *op) {
    return op[0] & 0xffff;
}

static bool is_arithmetic(const uint32_t *op) {
    const uint32_t code = opcode(op);
    if (code == EXT_INST) {
        const uint32_t function = op[4];
        return function == DETERMINANT || function == MIX || (function >= STEP && function <= FMA) ||
               (function >= LENGTH && function <= NORMALIZE) || function == REFLECT || function == REFRACT;
    }
    return code == F_NEGATE || code == F_ADD || code == F_SUB || code == F_MUL || code == F_DIV ||
           (code >= F_REM && code <= DOT); /* remainders, and products of vectors and matrices */
}

static bool is_decoration(uint32_t code) {
    return (code >= DECORATE && code <= GROUP_MEMBER_DECORATE) || code == DECORATE_ID;
}

/* Marks the results of arithmetic that are not exact yet. Decorations come before types, and those before code. Returns where the first of
   either stands, in words. */
static size_t find_arithmetic(const uint32_t *words, size_t count, bool *found) {
    const uint32_t bound = words[3];
    size_t place = 0;
    for (size_t at = HEADER, length; at < count; at += length) {
        const uint32_t *op = words + at, code = opcode(op);
        if ((length = op[0] >> 16) == 0) break;
        if (!place && (is_decoration(code) || (code >= TYPE_VOID && code <= TYPE_FORWARD_POINTER))) place = at;
        if (is_arithmetic(op) && op[2] < bound) found[op[2]] = true;
    }
    for (size_t at = place; at < count && is_decoration(opcode(words + at)); at += words[at] >> 16)
        if (opcode(words + at) == DECORATE && words[at + 2] == NO_CONTRACTION) found[words[at + 1]] = false;
    return place;
}

uint32_t *spirv_exact(const uint32_t *words, size_t bytes, size_t *exact_bytes) {
    const size_t count = bytes / sizeof *words;
    const uint32_t bound = words[3]; /* ids are below it */
    bool *found = calloc(bound, sizeof *found);
    uint32_t *exact = malloc(bytes + (size_t)bound * DECORATION_WORDS * sizeof *exact);
    if (found && exact) {
        const size_t place = find_arithmetic(words, count, found);
        uint32_t *end = exact + place;
        memcpy(exact, words, place * sizeof *words);
        for (uint32_t id = 0; id < bound; id++) {
            if (!found[id]) continue;
            *end++ = DECORATION_WORDS << 16 | DECORATE;
            *end++ = id;
            *end++ = NO_CONTRACTION;
        }
        memcpy(end, words + place, (count - place) * sizeof *words);
        *exact_bytes = (size_t)(end - exact + (ptrdiff_t)(count - place)) * sizeof *exact;
    } else {
        free(exact);
        exact = NULL;
    }
    free(found);
    return exact;
}
