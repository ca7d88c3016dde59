/* Modules that read parameters from memory. A specialization constant makes a driver compile the whole shader again for each new value, which
   takes longer than running it. In a generic module the constants of parameters are loaded at the start of each function that uses them,
   from a uniform buffer, and what is computed from constants alone becomes ordinary instructions there. A constant stays as it is where
   SPIR-V wants one, such as the length of an array, or where this file does not know the instruction. */
#include "shader.h"

#include <stdlib.h>
#include <string.h>

#include "words.h"

/* ---- What the words of an instruction are ---- */

enum word { LITERAL /* or an id that is no constant */, VALUE, NEEDS_CONSTANT };

/* Words `value` to `value_end` - 1 are ids of values, those from `constant` on are ids of constants, others are literals or ids of something
   else. `mask` is the word of an image instruction's operands, or 0. */
static const struct form {
    uint16_t first, last; /* opcodes */
    uint8_t value, value_end, constant, mask;
} forms[] = {
#define REST UINT8_MAX
    {0, 8, REST, REST, REST, 0},     /* debug information */
    {10, 11, REST, REST, REST, 0},   /* extensions */
    {12, 12, 5, REST, REST, 0},      /* OpExtInst */
    {14, 17, REST, REST, REST, 0},   /* memory model, entry points, execution modes, capabilities */
    {19, 27, REST, REST, REST, 0},   /* types without a length */
    {28, 28, REST, REST, 3, 0},      /* OpTypeArray */
    {29, 33, REST, REST, REST, 0},   /* other types */
    {41, 46, REST, REST, REST, 0},   /* constants */
    {54, 56, REST, REST, REST, 0},   /* functions */
    {57, 57, 4, REST, REST, 0},      /* OpFunctionCall */
    {59, 59, REST, REST, 4, 0},      /* OpVariable: its initializer */
    {61, 61, REST, REST, REST, 0},   /* OpLoad */
    {62, 62, 2, 3, REST, 0},         /* OpStore */
    {65, 66, 4, REST, REST, 0},      /* OpAccessChain, OpInBoundsAccessChain */
    {71, 72, REST, REST, REST, 0},   /* decorations */
    {77, 78, 3, REST, REST, 0},      /* vectors with a dynamic index */
    {79, 79, 3, 5, REST, 0},         /* OpVectorShuffle */
    {80, 80, 3, REST, REST, 0},      /* OpCompositeConstruct */
    {81, 81, 3, 4, REST, 0},         /* OpCompositeExtract */
    {82, 82, 3, 5, REST, 0},         /* OpCompositeInsert */
    {83, 84, 3, REST, REST, 0},      /* OpCopyObject, OpTranspose */
    {86, 86, REST, REST, REST, 0},   /* OpSampledImage */
    {88, 88, 4, 5, REST, 5},         /* OpImageSampleExplicitLod */
    {90, 90, 4, 6, REST, 6},         /* OpImageSampleDrefExplicitLod */
    {95, 95, 4, 5, REST, 5},         /* OpImageFetch */
    {96, 96, 4, 5, 5, 6},            /* OpImageGather: the component is a constant */
    {98, 98, 4, 5, REST, 5},         /* OpImageRead */
    {99, 99, 2, 4, REST, 4},         /* OpImageWrite */
    {100, 100, REST, REST, REST, 0}, /* OpImage */
    {103, 107, 4, REST, REST, 0},    /* queries of images */
    {109, 124, 3, REST, REST, 0},    /* conversions */
    {126, 152, 3, REST, REST, 0},    /* arithmetic */
    {154, 191, 3, REST, REST, 0},    /* relations */
    {194, 205, 3, REST, REST, 0},    /* bits */
    {224, 225, REST, REST, 1, 0},    /* barriers */
    {229, 229, 6, REST, 4, 0},       /* OpAtomicExchange: scope and semantics are constants, here and below */
    {234, 242, 6, REST, 4, 0},       /* other atomic operations */
    {245, 245, 3, REST, REST, 0},    /* OpPhi */
    {246, 249, REST, REST, REST, 0}, /* merges, OpLabel, OpBranch */
    {250, 251, 1, 2, REST, 0},       /* OpBranchConditional, OpSwitch */
    {252, 253, REST, REST, REST, 0}, /* OpKill, OpReturn */
    {254, 254, 1, REST, REST, 0},    /* OpReturnValue */
    {255, 255, REST, REST, REST, 0}, /* OpUnreachable */
    {317, 317, REST, REST, REST, 0}, /* OpNoLine */
    {331, 332, REST, REST, 3, 0},    /* OpExecutionModeId, OpDecorateId */
};
/* Image operands that have to be constants: ConstOffset, ConstOffsets. */
enum { CONSTANT_OFFSETS = 0x8 | 0x20 };

static const struct form *form_of(uint32_t code) {
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        if (code >= forms[i].first && code <= forms[i].last) return &forms[i];
    return NULL;
}

static enum word word_kind(const struct form *form, const uint32_t *op, uint32_t word) {
    if (!form) return NEEDS_CONSTANT; /* an unknown instruction: whatever equals the id of a constant may be it */
    if (word >= form->value && (word < form->value_end || form->value_end == REST)) return VALUE;
    if (form->mask && word > form->mask) return op[form->mask] & CONSTANT_OFFSETS ? NEEDS_CONSTANT : VALUE;
    return word >= form->constant ? NEEDS_CONSTANT : LITERAL;
}

static bool is_constant_expression(uint32_t code) {
    return code == OP_SPEC_CONSTANT_COMPOSITE || code == OP_SPEC_CONSTANT_OP;
}
static bool is_constant_scalar(uint32_t code) {
    return code >= OP_SPEC_CONSTANT_TRUE && code <= OP_SPEC_CONSTANT;
}
/* Whether a word of an instruction that makes a constant from others names one of these. As an ordinary instruction it has the same
   words without the opcode, which is word 3 of OpSpecConstantOp. */
static bool names_constant(const uint32_t *op, uint32_t word) {
    if (opcode(op) == OP_SPEC_CONSTANT_COMPOSITE) return word >= 3;
    const struct form *form = form_of(op[3]);
    return word >= 4 && (!form || word_kind(form, op, word - 1) == VALUE);
}

/* ---- Which constants can be loaded ---- */

struct turning {
    const uint32_t *words;
    size_t count;             /* of words */
    uint32_t bound;           /* ids of the original are below it */
    uint64_t *roots;          /* for each id the places of parameters that it is computed from, one bit each */
    uint64_t kept;            /* places of parameters that stay specialization constants */
    uint32_t *fresh;          /* for each id: what stands for it in the function being written, or 0 */
    const uint32_t **sources; /* the instructions of all constants that are turned, in order */
    size_t source_count;
    uint32_t *out;
    size_t out_count, capacity;
    bool failed;                                                         /* out of memory */
    uint32_t next_id, uint_type, block, scalar_pointer, pointer, values; /* ids; values: the uniform buffer */
    uint32_t first_index; /* id of the constant 0; those up to the last place follow */
    uint32_t places;      /* members of the buffer */
};

static bool is_turned(const struct turning *t, uint32_t id) {
    return id < t->bound && (t->roots[id] & ~t->kept);
}

static uint32_t type_code(const struct turning *t, uint32_t type, uint32_t *width) {
    for (size_t at = HEADER; at < t->count; at += op_words(t->words + at)) {
        const uint32_t *op = t->words + at;
        if (opcode(op) == OP_FUNCTION) break;
        if ((opcode(op) != OP_TYPE_INT && opcode(op) != OP_TYPE_FLOAT) || op[1] != type) continue;
        *width = op[2];
        return opcode(op);
    }
    return 0;
}

/* Whether each instruction lies within the module. */
static bool is_whole(const struct turning *t) {
    size_t at = HEADER;
    while (at < t->count && op_words(t->words + at) > 0) at += op_words(t->words + at);
    return at == t->count;
}

/* Finds the constants of the parameters, and what is computed from them. Decorations come before constants, and those in order. */
static void find_roots(struct turning *t, const uint32_t *ids, uint64_t parameters) {
    for (size_t at = HEADER; at < t->count; at += op_words(t->words + at)) {
        const uint32_t *op = t->words + at, code = opcode(op);
        uint32_t width = 32;
        if (code == OP_FUNCTION) return;
        if (code == OP_DECORATE && op_words(op) == 4 && op[2] == SPEC_ID && op[1] < t->bound)
            for (uint32_t place = 0; place < SPIRV_PLACES; place++)
                if (parameters >> place & 1 && ids[place] == op[3]) t->roots[op[1]] = UINT64_C(1) << place;
        if (code == OP_SPEC_CONSTANT && (!type_code(t, op[1], &width) || width != 32)) t->kept |= t->roots[op[2]];
        if (!is_constant_expression(code)) continue;
        for (uint32_t word = 3; word < op_words(op); word++)
            if (names_constant(op, word) && op[word] < t->bound) t->roots[op[2]] |= t->roots[op[word]];
        if (code == OP_SPEC_CONSTANT_OP && !form_of(op[3])) t->kept |= t->roots[op[2]];
    }
}

static void find_kept(struct turning *t) {
    for (size_t at = HEADER; at < t->count; at += op_words(t->words + at)) {
        const uint32_t *op = t->words + at;
        if (is_constant_scalar(opcode(op)) || is_constant_expression(opcode(op))) continue;
        const struct form *form = form_of(opcode(op));
        for (uint32_t word = 1; word < op_words(op); word++)
            if (op[word] < t->bound && t->roots[op[word]] && word_kind(form, op, word) == NEEDS_CONSTANT)
                t->kept |= t->roots[op[word]];
    }
}

/* ---- Writing the module ---- */

static void emit(struct turning *t, const uint32_t *words, size_t count) {
    if (t->out_count + count > t->capacity) {
        const size_t capacity = 2 * t->capacity + count + t->count;
        uint32_t *out = t->failed ? NULL : realloc(t->out, capacity * sizeof *out);
        if (!out) {
            t->failed = true;
            return;
        }
        t->out = out;
        t->capacity = capacity;
    }
    memcpy(t->out + t->out_count, words, count * sizeof *words);
    t->out_count += count;
}
/* An instruction from its operands. */
#define EMIT(t, code, ...)                                                                                             \
    emit(t, (const uint32_t[]){(uint32_t)(sizeof((uint32_t[]){0, __VA_ARGS__}) / 4) << 16 | (code), __VA_ARGS__},      \
         sizeof((uint32_t[]){0, __VA_ARGS__}) / 4)

static void emit_decorations(struct turning *t) {
    EMIT(t, OP_DECORATE, t->block, BLOCK);
    for (uint32_t place = 0; place < t->places; place++)
        EMIT(t, OP_MEMBER_DECORATE, t->block, place, OFFSET, place * (uint32_t)sizeof(uint32_t));
    EMIT(t, OP_DECORATE, t->values, DESCRIPTOR_SET, SPIRV_VALUES_SET);
    EMIT(t, OP_DECORATE, t->values, BINDING, 0);
}

/* The uniform buffer, after all other types and constants. */
static void emit_buffer(struct turning *t, bool has_uint) {
    if (!has_uint) EMIT(t, OP_TYPE_INT, t->uint_type, 32, 0);
    emit(t, &(uint32_t){(2 + t->places) << 16 | OP_TYPE_STRUCT}, 1);
    emit(t, &t->block, 1);
    for (uint32_t place = 0; place < t->places; place++) emit(t, &t->uint_type, 1);
    EMIT(t, OP_TYPE_POINTER, t->pointer, STORAGE_UNIFORM, t->block);
    EMIT(t, OP_TYPE_POINTER, t->scalar_pointer, STORAGE_UNIFORM, t->uint_type);
    for (uint32_t place = 0; place < t->places; place++)
        EMIT(t, OP_CONSTANT, t->uint_type, t->first_index + place, place);
    EMIT(t, OP_VARIABLE, t->pointer, t->values, STORAGE_UNIFORM);
}

static uint32_t find_uint(const struct turning *t) {
    for (size_t at = HEADER; at < t->count && opcode(t->words + at) != OP_FUNCTION; at += op_words(t->words + at))
        if (opcode(t->words + at) == OP_TYPE_INT && t->words[at + 2] == 32 && t->words[at + 3] == 0)
            return t->words[at + 1];
    return 0;
}

static bool is_decoration(uint32_t code) {
    return code >= OP_DECORATE && code <= OP_GROUP_MEMBER_DECORATE;
}
static bool is_type(uint32_t code) {
    return code >= OP_TYPE_VOID && code <= OP_TYPE_FORWARD_POINTER;
}

/* Copies what comes before the functions. Returns where these start, in words. */
static size_t emit_globals(struct turning *t) {
    size_t at = HEADER;
    bool decorated = false;
    const bool has_uint = t->uint_type < t->bound;
    for (; at < t->count && opcode(t->words + at) != OP_FUNCTION; at += op_words(t->words + at)) {
        const uint32_t *op = t->words + at, code = opcode(op);
        if (!decorated && (is_decoration(code) || is_type(code))) emit_decorations(t), decorated = true;
        if (code == OP_ENTRY_POINT) { /* lists all variables */
            emit(t, &(uint32_t){(op_words(op) + 1) << 16 | code}, 1);
            emit(t, op + 1, op_words(op) - 1);
            emit(t, &t->values, 1);
        } else if ((code == OP_NAME || code == OP_DECORATE) && is_turned(t, op[1])) continue;
        else if ((is_constant_scalar(code) || is_constant_expression(code)) && is_turned(t, op[2]))
            t->sources[t->source_count++] = op;
        else emit(t, op, op_words(op));
    }
    emit_buffer(t, has_uint);
    return at;
}

static uint32_t place_of(uint64_t root) {
    uint32_t place = 0;
    while (!(root >> place & 1)) place++;
    return place;
}

static void emit_load(struct turning *t, const uint32_t *op) {
    const uint32_t index = t->first_index + place_of(t->roots[op[2]]), chain = t->next_id++, result = t->fresh[op[2]];
    const bool is_uint = opcode(op) == OP_SPEC_CONSTANT && op[1] == t->uint_type;
    const uint32_t loaded = is_uint ? result : t->next_id++;
    EMIT(t, OP_ACCESS_CHAIN, t->scalar_pointer, chain, t->values, index);
    EMIT(t, OP_LOAD, t->uint_type, loaded, chain);
    if (is_uint) return;
    if (opcode(op) == OP_SPEC_CONSTANT) EMIT(t, OP_BITCAST, op[1], result, loaded);
    else EMIT(t, OP_I_NOT_EQUAL, op[1], result, loaded, t->first_index); /* the constant 0 */
}

static uint32_t replaced(const struct turning *t, uint32_t id) {
    return id < t->bound && t->fresh[id] ? t->fresh[id] : id;
}

static void emit_expression(struct turning *t, const uint32_t *op) {
    const bool composite = opcode(op) == OP_SPEC_CONSTANT_COMPOSITE;
    const uint32_t first = composite ? 3 : 4, code = composite ? (uint32_t)OP_COMPOSITE_CONSTRUCT : op[3];
    emit(t, (uint32_t[]){(op_words(op) - first + 3) << 16 | code, op[1], t->fresh[op[2]]}, 3);
    for (uint32_t word = first; word < op_words(op); word++)
        emit(t, &(uint32_t){names_constant(op, word) ? replaced(t, op[word]) : op[word]}, 1);
}

/* Gives the turned constants that the function uses ids in it. */
static void find_used(struct turning *t, size_t from, size_t end) {
    memset(t->fresh, 0, t->bound * sizeof *t->fresh);
    for (size_t at = from; at < end; at += op_words(t->words + at)) {
        const uint32_t *op = t->words + at;
        const struct form *form = form_of(opcode(op));
        for (uint32_t word = 1; word < op_words(op); word++)
            if (is_turned(t, op[word]) && !t->fresh[op[word]] && word_kind(form, op, word) == VALUE)
                t->fresh[op[word]] = t->next_id++;
    }
    for (size_t i = t->source_count; i-- > 0;) {
        const uint32_t *op = t->sources[i];
        if (!t->fresh[op[2]] || !is_constant_expression(opcode(op))) continue;
        for (uint32_t word = 3; word < op_words(op); word++)
            if (names_constant(op, word) && is_turned(t, op[word]) && !t->fresh[op[word]])
                t->fresh[op[word]] = t->next_id++;
    }
}

static void emit_function(struct turning *t, size_t from, size_t end) {
    bool in_block = false, loaded = false;
    find_used(t, from, end);
    for (size_t at = from; at < end; at += op_words(t->words + at)) {
        const uint32_t *op = t->words + at, code = opcode(op);
        if (in_block && !loaded && code != OP_VARIABLE && code != OP_LINE) {
            for (size_t i = 0; i < t->source_count; i++) {
                if (!t->fresh[t->sources[i][2]]) continue;
                if (is_constant_expression(opcode(t->sources[i]))) emit_expression(t, t->sources[i]);
                else emit_load(t, t->sources[i]);
            }
            loaded = true;
        }
        in_block |= code == OP_LABEL;
        const struct form *form = form_of(code);
        emit(t, op, 1);
        for (uint32_t word = 1; word < op_words(op); word++)
            emit(t, &(uint32_t){word_kind(form, op, word) == VALUE ? replaced(t, op[word]) : op[word]}, 1);
    }
}

static void write_module(struct turning *t, uint64_t turned) {
    while (turned >> t->places) t->places++;
    t->next_id = t->bound;
    if (!(t->uint_type = find_uint(t))) t->uint_type = t->next_id++;
    t->block = t->next_id++, t->pointer = t->next_id++, t->scalar_pointer = t->next_id++, t->values = t->next_id++;
    t->first_index = t->next_id;
    t->next_id += t->places;
    emit(t, t->words, HEADER);
    for (size_t at = emit_globals(t), end; at < t->count; at = end) {
        for (end = at; opcode(t->words + end) != OP_FUNCTION_END && end < t->count;) end += op_words(t->words + end);
        end += end < t->count; /* OpFunctionEnd is a single word */
        emit_function(t, at, end);
    }
    if (!t->failed) t->out[BOUND] = t->next_id;
}

uint32_t *spirv_generic(const uint32_t *words, size_t bytes, const uint32_t ids[SPIRV_PLACES], uint64_t parameters,
                        uint64_t *turned, size_t *generic_bytes) {
    struct turning t = {.words = words, .count = bytes / sizeof *words, .bound = words[BOUND]};
    *turned = 0;
    t.roots = calloc(t.bound, sizeof *t.roots);
    t.fresh = calloc(t.bound, sizeof *t.fresh);
    t.sources = calloc(t.bound, sizeof *t.sources);
    t.failed = !t.roots || !t.fresh || !t.sources;
    if (!t.failed && is_whole(&t)) {
        uint64_t used = 0;
        find_roots(&t, ids, parameters);
        find_kept(&t);
        for (uint32_t id = 0; id < t.bound; id++) used |= t.roots[id];
        *turned = used & ~t.kept;
        if (*turned) write_module(&t, *turned);
    }
    if (!t.failed && !*turned) emit(&t, words, t.count);
    free(t.roots);
    free(t.fresh);
    free(t.sources);
    *generic_bytes = t.out_count * sizeof *t.out;
    if (!t.failed) return t.out;
    free(t.out);
    return NULL;
}
