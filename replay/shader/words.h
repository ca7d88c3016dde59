/* What SPIR-V is made of: the header, and instructions of whole words, the first of which has the number of words and the opcode. The numbers are
   those of SPIR-V's specification; only those that glint looks for are here. */
#ifndef GLINT_REPLAY_WORDS_H
#define GLINT_REPLAY_WORDS_H

#include <stdint.h>

/* The header's length, and its word that all ids are below. */
enum { HEADER = 5, BOUND = 3 };
/* Opcodes. */
enum {
    OP_NAME = 5,
    OP_LINE = 8,
    OP_EXT_INST = 12,
    OP_ENTRY_POINT = 15,
    OP_CAPABILITY = 17,
    OP_TYPE_VOID = 19,
    OP_TYPE_BOOL = 20,
    OP_TYPE_INT = 21,
    OP_TYPE_FLOAT = 22,
    OP_TYPE_VECTOR = 23,
    OP_TYPE_MATRIX = 24,
    OP_TYPE_IMAGE = 25,
    OP_TYPE_SAMPLER = 26,
    OP_TYPE_ARRAY = 28,
    OP_TYPE_STRUCT = 30,
    OP_TYPE_POINTER = 32,
    OP_TYPE_FORWARD_POINTER = 39,
    OP_CONSTANT = 43,
    OP_CONSTANT_NULL = 46,
    OP_SPEC_CONSTANT_TRUE = 48,
    OP_SPEC_CONSTANT_FALSE = 49,
    OP_SPEC_CONSTANT = 50,
    OP_SPEC_CONSTANT_COMPOSITE = 51,
    OP_SPEC_CONSTANT_OP = 52,
    OP_FUNCTION = 54,
    OP_FUNCTION_END = 56,
    OP_VARIABLE = 59,
    OP_LOAD = 61,
    OP_ACCESS_CHAIN = 65,
    OP_IN_BOUNDS_ACCESS_CHAIN = 66,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    OP_GROUP_MEMBER_DECORATE = 75,
    OP_COMPOSITE_CONSTRUCT = 80,
    OP_COMPOSITE_EXTRACT = 81,
    OP_BITCAST = 124,
    OP_F_NEGATE = 127,
    OP_I_ADD = 128,
    OP_F_ADD = 129,
    OP_I_SUB = 130,
    OP_F_SUB = 131,
    OP_I_MUL = 132,
    OP_F_MUL = 133,
    OP_U_DIV = 134,
    OP_S_DIV = 135,
    OP_F_DIV = 136,
    OP_F_REM = 140,
    OP_DOT = 148,
    OP_SELECT = 169,
    OP_I_NOT_EQUAL = 171,
    OP_LOOP_MERGE = 246,
    OP_LABEL = 248,
    OP_DECORATE_ID = 332
};
/* Decorations. */
enum { SPEC_ID = 1, BLOCK = 2, BUILT_IN = 11, BINDING = 33, DESCRIPTOR_SET = 34, OFFSET = 35, NO_CONTRACTION = 42 };
/* What BUILT_IN says. */
enum { NUM_WORKGROUPS = 24 };
/* Storage classes. */
enum {
    STORAGE_UNIFORM_CONSTANT = 0,
    STORAGE_INPUT = 1,
    STORAGE_UNIFORM = 2,
    STORAGE_WORKGROUP = 4,
    STORAGE_PRIVATE = 6,
    STORAGE_FUNCTION = 7,
    STORAGE_PUSH_CONSTANT = 9,
    STORAGE_BUFFER = 12
};

static inline uint32_t opcode(const uint32_t *op) {
    return op[0] & 0xffff;
}
static inline uint32_t op_words(const uint32_t *op) {
    return op[0] >> 16;
}

#endif
