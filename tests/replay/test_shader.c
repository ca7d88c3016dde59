/* Users' shaders: includes are found, and errors have the user's file and line. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fixture.h"
#include "shader.h"
#include "unit.h"

static char *write_text(void **state, const char *name, const char *text) {
    const struct fixture *fixture = *state;
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", fixture->folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return path;
}

static struct shaders shaders;

static bool compile(char *path, struct spirv *spirv, struct glint_error *err) {
    const struct pipeline_pass pass = {.pass = glint_pass_find("resolve", "hit"), .shader = path};
    *err = (struct glint_error){0};
    *spirv = (struct spirv){0};
    return spirv_find(spirv, &shaders, &pass, err);
}

#define START                                                                                                          \
    "#version 460\n"                                                                                                   \
    "#extension GL_GOOGLE_include_directive : require\n"                                                               \
    "#include \"shared/bindings.glsl\"\n"                                                                              \
    "#include \"hit.pass.h\"\n"                                                                                        \
    "#include \"shared/push_begin.glsl\"\n"                                                                            \
    "#include \"hit.pass.h\"\n"                                                                                        \
    "};\n"

/* Copies a module without debug information about its source. */
static size_t without_source(const uint32_t *words, size_t bytes, uint32_t *out) {
    enum { OP_SOURCE = 3, OP_SOURCE_EXTENSION = 4 };
    size_t n = 0, count = bytes / sizeof *words;
    for (size_t i = 5; i < count; i += words[i] >> 16) {
        const uint32_t op = words[i] & 0xffff, length = words[i] >> 16;
        assert_true(length > 0);
        if (op == OP_SOURCE || op == OP_SOURCE_EXTENSION) continue;
        memcpy(out + n, words + i, length * sizeof *words);
        n += length;
    }
    return n;
}

/* The module as the build embeds it: what spirv.py does after compiling. */
static uint32_t *inlined(void **state, const struct spirv *spirv, size_t *bytes) {
    char command[1200], plain[256], out[256];
    snprintf(plain, sizeof plain, "%s", write_text(state, "plain.spv", ""));
    snprintf(out, sizeof out, "%s", write_text(state, "inlined.spv", ""));
    FILE *file = fopen(plain, "wb");
    assert_true(file && fwrite(spirv->words, spirv->bytes, 1, file) == 1 && fclose(file) == 0);
    snprintf(command, sizeof command, GLINT_SPIRV_OPT " %s -o %s 2>/dev/null", plain, out);
    assert_int_equal(system(command), 0);
    file = fopen(out, "rb");
    assert_true(file && fseek(file, 0, SEEK_END) == 0);
    *bytes = (size_t)ftell(file);
    rewind(file);
    uint32_t *words = malloc(*bytes);
    assert_true(words && fread(words, *bytes, 1, file) == 1 && fclose(file) == 0);
    return words;
}

static size_t every = 1;

/* Each pass's file, compiled here, must become the embedded shader: the same bindings and constants. */
static void every_pass_compiles_to_what_is_built_in(void **state) {
    size_t count;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i += every) {
        char name[128];
        snprintf(name, sizeof name, "%s/%s.comp", passes[i].folder, passes[i].variant);
        if (!passes[i].spirv) continue;
        assert_non_null(glint_pass_text(name));
        char *path = write_text(state, "copy.comp", glint_pass_text(name));
        const struct pipeline_pass pass = {.pass = &passes[i], .shader = path};
        struct spirv spirv;
        struct glint_error err = {0};
        if (!spirv_find(&spirv, &shaders, &pass, &err)) fail_msg("%s: %s", name, err.message);
        size_t bytes;
        uint32_t *all = inlined(state, &spirv, &bytes), *mine = malloc(bytes),
                 *built_in = malloc(passes[i].spirv_bytes);
        const size_t words = without_source(all, bytes, mine);
        assert_int_equal(words, without_source(passes[i].spirv, passes[i].spirv_bytes, built_in));
        if (memcmp(mine, built_in, words * sizeof *mine) != 0) fail_msg("%s: differs", name);
        free(all), free(mine), free(built_in);
        spirv.words = passes[i].unprobed, spirv.bytes = passes[i].unprobed_bytes;
        spirv_find_uses(&spirv);
        assert_false(spirv.probes);
    }
}

/* The text that spirv-dis makes of a module, which spirv-val finds valid. */
static FILE *disassembled(void **state, const uint32_t *words, size_t bytes) {
    char command[600], path[256];
    snprintf(path, sizeof path, "%s", write_text(state, "exact.spv", ""));
    FILE *file = fopen(path, "wb");
    assert_true(file && fwrite(words, bytes, 1, file) == 1 && fclose(file) == 0);
    snprintf(command, sizeof command, "spirv-val --target-env vulkan1.3 %s && spirv-dis --raw-id --no-indent %s", path,
             path);
    assert_non_null(file = popen(command, "r"));
    return file;
}

enum { IDS_MAX = 20000, LINE = 4096 };
/* How often the result of an instruction is decorated as exact, and which are floats' arithmetic. Other lines are hashed. */
struct listing {
    int exact[IDS_MAX];
    bool arithmetic[IDS_MAX];
    uint64_t rest;
};
static struct listing *list(void **state, const uint32_t *words, size_t bytes) {
    static const char *const operations[] = {"OpFAdd",
                                             "OpFSub",
                                             "OpFMul",
                                             "OpFDiv",
                                             "OpFNegate",
                                             "OpFMod",
                                             "OpDot",
                                             "OpVectorTimesScalar",
                                             "OpVectorTimesMatrix",
                                             "OpMatrixTimesVector",
                                             "OpMatrixTimesMatrix",
                                             "OpExtInst"};
    static const char *const functions[] = {"FMix",  "Step",     "SmoothStep", "Fma",     "Length",
                                            "Cross", "Distance", "Normalize",  "Reflect", "Refract"};
    struct listing *found = calloc(1, sizeof *found);
    static char line[LINE];
    FILE *file = disassembled(state, words, bytes);
    while (fgets(line, sizeof line, file)) {
        unsigned id;
        char operation[64], function[64] = "";
        if (sscanf(line, "OpDecorate %%%u NoContractio%63s", &id, operation) == 2) {
            found->exact[id]++;
            continue;
        }
        for (const char *c = line; *c; c++) found->rest = found->rest * 31 + (uint8_t)*c;
        if (sscanf(line, "%%%u = %63s %*s %*s %63s", &id, operation, function) < 2) continue;
        for (size_t i = 0; i < sizeof operations / sizeof *operations; i++)
            if (strcmp(operation, operations[i]) == 0) found->arithmetic[id] = strcmp(operation, "OpExtInst") != 0;
        for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
            if (strcmp(operation, "OpExtInst") == 0 && strcmp(function, functions[i]) == 0)
                found->arithmetic[id] = true;
    }
    assert_int_equal(pclose(file), 0);
    return found;
}

/* What devices get is the pass's shader, in which each sum and product is exact, once, and nothing else differs. */
static void arithmetic_is_exact(void **state) {
    size_t count, marked = 0;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i += 7 * every) {
        size_t bytes = 0;
        if (!passes[i].spirv) continue;
        uint32_t *words = spirv_exact(passes[i].spirv, passes[i].spirv_bytes, &bytes);
        assert_non_null(words);
        struct listing *before = list(state, passes[i].spirv, passes[i].spirv_bytes),
                       *after = list(state, words, bytes);
        for (int id = 0; id < IDS_MAX; id++)
            if (after->exact[id] != (after->arithmetic[id] || before->exact[id]))
                fail_msg("%s/%s: %%%d is exact %d times", passes[i].slot, passes[i].variant, id, after->exact[id]);
            else marked += (size_t)(after->exact[id] - before->exact[id]);
        assert_true(before->rest == after->rest);
        free(words), free(before), free(after);
    }
    assert_true(marked > 100 / every);
}

static void errors_name_the_users_file_and_line(void **state) {
    struct spirv spirv;
    struct glint_error err;
    char *path = write_text(state, "mine.comp", START "void main() {\n    float x = 1.0;\n    y = x;\n}\n");
    assert_false(compile(path, &spirv, &err));
    assert_int_equal(err.code, GLINT_ERROR_FORMAT);
    fixture_says(&err, "/mine.comp:10: 'y' : undeclared identifier");
}

static void errors_in_an_included_file_name_that_file(void **state) {
    struct spirv spirv;
    struct glint_error err;
    write_text(state, "helper.glsl", "float half_of(float x) {\n    return x * zz;\n}\n");
    char *path = write_text(state, "mine.comp", START "#include \"helper.glsl\"\nvoid main() { half_of(1); }\n");
    assert_false(compile(path, &spirv, &err));
    fixture_says(&err, "/helper.glsl:2: 'zz'");
}

static void lines_after_an_include_keep_their_numbers(void **state) {
    struct spirv spirv;
    struct glint_error err;
    write_text(state, "helper.glsl", "\n\n\nfloat half_of(float x) { return x / 2; }\n");
    char *path = write_text(state, "mine.comp", START "#include \"helper.glsl\"\n\nvoid main() {\n    oops;\n}\n");
    assert_false(compile(path, &spirv, &err));
    fixture_says(&err, "/mine.comp:11: 'oops'");
}

/* Rows take their numbers from #line, so code after an include must continue with the right number. */
static void lines_after_a_directive_and_an_include_keep_its_numbers(void **state) {
    struct spirv spirv;
    struct glint_error err;
    write_text(state, "helper.glsl", "\nfloat half_of(float x) { return x / 2; }\n");
    char *path =
        write_text(state, "mine.comp", START "#line 500\n#include \"helper.glsl\"\nvoid main() {\n    oops;\n}\n");
    assert_false(compile(path, &spirv, &err));
    fixture_says(&err, "/mine.comp:502: 'oops'");
}

static void a_missing_include_is_placed(void **state) {
    struct spirv spirv;
    struct glint_error err;
    char *path = write_text(state, "mine.comp", "#version 460\n\n#include \"nowhere.glsl\"\n");
    assert_false(compile(path, &spirv, &err));
    fixture_says(&err, "/mine.comp:3: include \"nowhere.glsl\" not found");
}

static void a_file_that_includes_itself_is_an_error(void **state) {
    struct spirv spirv;
    struct glint_error err;
    char *path = write_text(state, "mine.comp", "#version 460\n#include \"mine.comp\"\n");
    assert_false(compile(path, &spirv, &err));
    fixture_says(&err, "mine.comp includes itself");
}

static void what_is_no_shader_is_an_error(void **state) {
    struct spirv spirv;
    struct glint_error err;
    assert_false(compile(write_text(state, "empty.comp", ""), &spirv, &err));
    fixture_says(&err, "empty.comp");
    assert_false(compile(write_text(state, "text.comp", "not a shader\n"), &spirv, &err));
    fixture_says(&err, "text.comp:1: expected #version");
    assert_false(compile(write_text(state, "none.comp", "#version 460\n"), &spirv, &err));
    assert_int_equal(err.code, GLINT_ERROR_FORMAT);
    fixture_says(&err, "none.comp");
    char missing[] = "/nowhere/x.comp";
    assert_false(compile(missing, &spirv, &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
}

static void foreign_bindings_are_refused(void **state) {
    static const struct {
        const char *declaration, *use, *says;
    } cases[] = {
        {"layout(set = 0, binding = 2) uniform writeonly image2D other;\n#undef imageStore",
         "imageStore(other, ivec2(0), vec4(0));", "binding 2 of set 0"},
        {"layout(set = 2, binding = 0) buffer B { uint x; } b;", "b.x = 1;", "binding 0 of set 2"},
        {"layout(set = 1, binding = 5) uniform sampler s;",
         "imageStore(reflection_half, ivec2(0), textureLod(sampler2D(depth_half, s), vec2(0), 0));",
         "binding 5 of set 1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct spirv spirv;
        struct glint_error err;
        char text[1024];
        snprintf(text, sizeof text, START "%s\nvoid main() { %s }\n", cases[i].declaration, cases[i].use);
        assert_false(compile(write_text(state, "foreign.comp", text), &spirv, &err));
        fixture_says(&err, cases[i].says);
    }
}

/* Catches: a pass that does not run again although a field of the frame that it reads changed, and one that runs in every frame because
   of fields that it does not read. */
static void the_words_of_the_frame_that_a_shader_reads_are_known(void **state) {
    const size_t size = offsetof(struct frame_block, size) / 4, counts = offsetof(struct frame_block, counts) / 4,
                 view = offsetof(struct frame_block, view_from_world) / 4;
    const struct {
        const char *use;
        size_t first, count;
    } cases[] = {
        {"vec4(1)", 0, 0},
        {"vec4(frame.counts.z)", counts + 2, 1},
        {"vec4(frame.size)", size, 4},
        {"frame.view_from_world * vec4(1)", view, 16},
        {"vec4(frame.counts[int(gl_GlobalInvocationID.x)])", counts, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct spirv spirv;
        struct glint_error err;
        char text[1024];
        snprintf(text, sizeof text, START "void main() { imageStore(reflection_half, ivec2(0), %s); }\n", cases[i].use);
        if (!compile(write_text(state, "words.comp", text), &spirv, &err)) fail_msg("%s", err.message);
        for (size_t w = 0; w < FRAME_WORDS; w++)
            if (spirv.frame_words[w] != (w >= cases[i].first && w < cases[i].first + cases[i].count))
                fail_msg("%s: word %zu", cases[i].use, w);
    }
}

static bool find_variant(struct spirv *spirv, struct shaders *from, const char *variant, struct glint_error *err) {
    const struct pipeline_pass pass = {.pass = glint_pass_find("resolve", variant)};
    *err = (struct glint_error){0};
    return spirv_find(spirv, from, &pass, err);
}

static void file_in(const char *folder, const char *below, const char *name, const char *text) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, below);
    mkdir(path, 0700);
    snprintf(path, sizeof path, "%s/%s/%s", folder, below, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* Catches: an edit of a shared file that a pass misses, one that unrelated passes see, and one that is not noticed again. */
static void files_of_a_folder_replace_embedded_ones(void **state) {
    const struct fixture *fixture = *state;
    struct shaders from;
    struct glint_error err = {0};
    struct spirv hit, previous, changed;
    char folder[200];
    snprintf(folder, sizeof folder, "%s/passes", fixture->folder);
    mkdir(folder, 0700);
    char effect[250];
    snprintf(effect, sizeof effect, "%s/reflection", folder);
    mkdir(effect, 0700);
    if (!shaders_init(&from, folder, &err)) fail_msg("%s", err.message);
    file_in(folder, "reflection/resolve", "hit.comp",
            START "void main() { imageStore(reflection_half, ivec2(0), vec4(1)); }\n");
    assert_true(find_variant(&hit, &from, "hit", &err) && find_variant(&previous, &from, "previous", &err));
    assert_non_null(hit.from);
    assert_null(previous.from);
    assert_ptr_equal(previous.words, glint_pass_find("resolve", "previous")->spirv);
    file_in(folder, "reflection/resolve", "hit.comp",
            START "void main() { imageStore(reflection_half, ivec2(0), vec4(2)); }\n");
    assert_true(find_variant(&changed, &from, "hit", &err));
    assert_int_not_equal(changed.hash, hit.hash);
    file_in(folder, "shared", "camera.glsl", "\n#error seen\n");
    assert_true(find_variant(&hit, &from, "hit", &err)); /* it includes none of these files */
    assert_false(find_variant(&previous, &from, "previous", &err));
    fixture_says(&err, "shared/camera.glsl:2: '#error' : seen");
    shaders_finish(&from);
    assert_false(shaders_init(&from, "/nowhere/passes", &err));
    fixture_says(&err, "/nowhere/passes");
}

static int teardown(void **state) {
    shaders_finish(&shaders);
    return fixture_teardown(state);
}

/* With an argument N, every N-th pass only: what a sanitizer sees of one, it sees of all. */
int main(int argc, char **argv) {
    if (argc > 1) every = (size_t)atoi(argv[1]);
    assert_true(every > 0);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pass_compiles_to_what_is_built_in),
        cmocka_unit_test(arithmetic_is_exact),
        cmocka_unit_test(errors_name_the_users_file_and_line),
        cmocka_unit_test(errors_in_an_included_file_name_that_file),
        cmocka_unit_test(lines_after_an_include_keep_their_numbers),
        cmocka_unit_test(lines_after_a_directive_and_an_include_keep_its_numbers),
        cmocka_unit_test(a_missing_include_is_placed),
        cmocka_unit_test(a_file_that_includes_itself_is_an_error),
        cmocka_unit_test(what_is_no_shader_is_an_error),
        cmocka_unit_test(foreign_bindings_are_refused),
        cmocka_unit_test(the_words_of_the_frame_that_a_shader_reads_are_known),
        cmocka_unit_test(files_of_a_folder_replace_embedded_ones),
    };
    return cmocka_run_group_tests(tests, fixture_setup_host, teardown);
}
