/* Arithmetic that is rounded operation by operation. Without it a compiler may contract a product and a sum into one operation, in some
   specializations of a shader and not in others, so that recording a pixel, or a plan, could change the last bit of an image. GLSL's `precise`
   says the same of single variables. */
#include "shader.h"

#include <stdlib.h>
#include <string.h>

#include "words.h"

enum { DECORATION_WORDS = 3 };
/* Instructions of GLSL.std.450 that are sums of products. */
enum { DETERMINANT = 33, MIX = 46, STEP = 48, FMA = 50, LENGTH = 66, NORMALIZE = 69, REFLECT = 71, REFRACT = 72 };

static bool is_arithmetic(const uint32_t *op) {
    const uint32_t code = opcode(op);
    if (code == OP_EXT_INST) {
        const uint32_t function = op[4];
        return function == DETERMINANT || function == MIX || (function >= STEP && function <= FMA) ||
               (function >= LENGTH && function <= NORMALIZE) || function == REFLECT || function == REFRACT;
    }
    return code == OP_F_NEGATE || code == OP_F_ADD || code == OP_F_SUB || code == OP_F_MUL || code == OP_F_DIV ||
           (code >= OP_F_REM && code <= OP_DOT); /* remainders, and products of vectors and matrices */
}

static bool is_decoration(uint32_t code) {
    return (code >= OP_DECORATE && code <= OP_GROUP_MEMBER_DECORATE) || code == OP_DECORATE_ID;
}

/* Marks the results of arithmetic that are not exact yet. Decorations come before types, and those before code. Returns where the first of
   either stands, in words. */
static size_t find_arithmetic(const uint32_t *words, size_t count, bool *found) {
    const uint32_t bound = words[3];
    size_t place = 0;
    for (size_t at = HEADER, length; at < count; at += length) {
        const uint32_t *op = words + at, code = opcode(op);
        if ((length = op_words(op)) == 0) break;
        if (!place && (is_decoration(code) || (code >= OP_TYPE_VOID && code <= OP_TYPE_FORWARD_POINTER))) place = at;
        if (is_arithmetic(op) && op[2] < bound) found[op[2]] = true;
    }
    for (size_t at = place; at < count && is_decoration(opcode(words + at)); at += op_words(words + at))
        if (opcode(words + at) == OP_DECORATE && words[at + 2] == NO_CONTRACTION) found[words[at + 1]] = false;
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
            *end++ = DECORATION_WORDS << 16 | OP_DECORATE;
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
