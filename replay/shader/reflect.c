/* Reflects SPIR-V: which words of the uniform block it reads, whether it records probes. */
#include "shader.h"

#include <string.h>

#include "words.h"

#define NONE UINT32_MAX

/* `op` if that instruction lies entirely in the module, otherwise NULL. */
static const uint32_t *checked_op(const struct spirv *spirv, const uint32_t *op) {
    const size_t left = spirv->bytes / sizeof *op - (size_t)(op - spirv->words);
    return left > 0 && op_words(op) > 0 && op_words(op) <= left ? op : NULL;
}
static const uint32_t *first_op(const struct spirv *spirv) {
    return spirv->bytes > HEADER * sizeof(uint32_t) ? checked_op(spirv, spirv->words + HEADER) : NULL;
}
static const uint32_t *next_op(const struct spirv *spirv, const uint32_t *op) {
    return checked_op(spirv, op + op_words(op));
}

/* The variable of set 1 with this binding (passes/shared/interface.glsl), or 0. */
static uint32_t find_common(const struct spirv *spirv, uint32_t binding) {
    uint32_t found = 0;
    for (const uint32_t *op = first_op(spirv); op; op = next_op(spirv, op)) {
        if (opcode(op) != OP_DECORATE || op_words(op) != 4 || op[2] != DESCRIPTOR_SET || op[3] != 1) continue;
        for (const uint32_t *at = first_op(spirv); at; at = next_op(spirv, at))
            if (opcode(at) == OP_DECORATE && op_words(at) == 4 && at[1] == op[1] && at[2] == BINDING &&
                at[3] == binding)
                found = op[1];
    }
    return found;
}

/* Word number `word` of the instruction `code` whose word number `at` is `value`, or NONE. */
static uint32_t find_word(const struct spirv *spirv, uint32_t code, uint32_t at, uint32_t value, uint32_t word) {
    for (const uint32_t *op = first_op(spirv); op; op = next_op(spirv, op))
        if (opcode(op) == code && op_words(op) > at && op_words(op) > word && op[at] == value) return op[word];
    return NONE;
}

static uint32_t member_offset(const struct spirv *spirv, uint32_t type, uint32_t member) {
    for (const uint32_t *op = first_op(spirv); op; op = next_op(spirv, op))
        if (opcode(op) == OP_MEMBER_DECORATE && op_words(op) == 5 && op[1] == type && op[2] == member &&
            op[3] == OFFSET)
            return op[4];
    return sizeof(struct frame_block);
}

/* Marks the words of the block that an access chain may read: a component if the second index is constant, otherwise the whole member. */
static void mark_words(struct spirv *spirv, uint32_t type, const uint32_t *op) {
    const uint32_t member = op_words(op) > 4 ? find_word(spirv, OP_CONSTANT, 2, op[4], 3) : NONE;
    const uint32_t begin = member_offset(spirv, type, member), end = member_offset(spirv, type, member + 1);
    const uint32_t place = op_words(op) == 6 && end - begin == 16 ? find_word(spirv, OP_CONSTANT, 2, op[5], 3) : NONE;
    for (uint32_t word = begin / 4; word < end / 4 && word < FRAME_WORDS; word++)
        if (place == NONE || word == begin / 4 + place) spirv->frame_words[word] = true;
}

void spirv_find_uses(struct spirv *spirv) {
    const uint32_t frame = find_common(spirv, 0);
    const uint32_t pointer = find_word(spirv, OP_VARIABLE, 2, frame, 1);
    const uint32_t type = find_word(spirv, OP_TYPE_POINTER, 1, pointer, 3);
    bool code = false, whole = false;
    memset(spirv->frame_words, 0, sizeof spirv->frame_words);
    spirv->probes = find_common(spirv, 3) != 0;
    for (const uint32_t *op = first_op(spirv); op && frame; op = next_op(spirv, op)) {
        const bool chain = opcode(op) == OP_ACCESS_CHAIN || opcode(op) == OP_IN_BOUNDS_ACCESS_CHAIN;
        code |= opcode(op) == OP_FUNCTION;
        if (chain && op_words(op) > 3 && op[3] == frame) mark_words(spirv, type, op);
        else /* any other use may read the whole block */
            for (uint32_t w = 1; code && w < op_words(op); w++) whole |= op[w] == frame;
    }
    for (uint32_t word = 0; whole && word < FRAME_WORDS; word++) spirv->frame_words[word] = true;
}
