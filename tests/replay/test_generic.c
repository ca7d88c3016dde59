/* Modules that read parameters from memory: spirv-val accepts that of every pass, and spirv-dis finds no constant of a parameter in it but
   those that have to stay. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "listing.h"
#include "program.h"
#include "unit.h"

/* The constants of a pass's parameters, at the places 9, 10, … of the constants. */
struct places {
    uint32_t ids[SPIRV_PLACES];
    uint64_t parameters;
    const char *names[SPIRV_PLACES];
};
enum { FIRST_PLACE = 9 };
static struct places places_of(const struct glint_pass *pass) {
    struct places places = {0};
    uint32_t place = FIRST_PLACE;
    for (size_t r = 0; r < pass->row_count; r++) {
        if (pass->rows[r].kind != GLINT_ROW_SPEC && pass->rows[r].kind != GLINT_ROW_CHOICE) continue;
        places.ids[place] = pass->rows[r].id;
        places.names[place] = pass->rows[r].name;
        places.parameters |= UINT64_C(1) << place++;
    }
    return places;
}

/* Bits of the parameters whose constants are in the module. */
static uint64_t constants_in(const struct listing *listing, const struct places *places) {
    uint64_t found = 0;
    for (size_t i = 0; i < listing->count; i++) {
        unsigned id, spec;
        if (sscanf(listing->lines[i], "OpDecorate %%%u SpecId %u", &id, &spec) != 2) continue;
        for (uint32_t place = FIRST_PLACE; place < SPIRV_PLACES; place++)
            if (places->parameters >> place & 1 && places->ids[place] == spec) found |= UINT64_C(1) << place;
    }
    return found;
}

/* How many operations are of each kind, but for those that load values, and those that came of constants. */
static size_t count_operation(const struct listing *listing, const char *operation) {
    size_t count = 0;
    for (size_t i = 0; i < listing->count; i++) {
        const char *at = strstr(listing->lines[i], operation);
        count += at && (at[strlen(operation)] == ' ' || at[strlen(operation)] == '\n');
    }
    return count;
}

static void check_module(void **state, const struct glint_pass *pass, const uint32_t *words, size_t bytes,
                         size_t *turned_all, size_t *kept_all) {
    static struct listing before, after;
    /* What neither loads values nor is computed from constants stays. */
    static const char *const same[] = {
        "OpFunction", "OpLabel", "OpStore",      "OpExtInst",           "OpFMul",
        "OpFAdd",     "OpPhi",   "OpImageFetch", "OpBranchConditional", "OpFunctionCall"};
    const struct places places = places_of(pass);
    uint64_t turned;
    size_t generic_bytes;
    uint32_t *generic = spirv_generic(words, bytes, places.ids, places.parameters, &turned, &generic_bytes);
    assert_non_null(generic);
    list(*state, words, bytes, &before), list(*state, generic, generic_bytes, &after);
    const uint64_t had = constants_in(&before, &places), has = constants_in(&after, &places);
    assert_true((turned & ~places.parameters) == 0 && (had & ~turned) == has && (had | turned) == had);
    for (uint32_t place = FIRST_PLACE; place < SPIRV_PLACES; place++) {
        if (has >> place & 1) print_message("# %s/%s: %s stays\n", pass->slot, pass->variant, places.names[place]);
        *turned_all += turned >> place & 1, *kept_all += has >> place & 1;
    }
    for (size_t i = 0; i < sizeof same / sizeof *same; i++)
        assert_int_equal(count_operation(&before, same[i]), count_operation(&after, same[i]));
    if (!turned) assert_true(generic_bytes == bytes && memcmp(generic, words, bytes) == 0);
    list_free(&before), list_free(&after);
    free(generic);
}

static size_t every = 1;

static void the_module_of_every_pass_is_valid(void **state) {
    size_t count, turned = 0, kept = 0;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i += every) {
        const struct glint_pass *pass = &passes[i];
        if (!pass->spirv) continue;
        check_module(state, pass, pass->spirv, pass->spirv_bytes, &turned, &kept);
        if (pass->unprobed != pass->spirv)
            check_module(state, pass, pass->unprobed, pass->unprobed_bytes, &turned, &kept);
    }
    print_message("# %zu constants are read from memory, %zu stay\n", turned, kept);
    assert_true(turned > 300 / every);
}

/* ---- Users' shaders ---- */

#define START                                                                                                          \
    "#version 460\n"                                                                                                   \
    "#extension GL_GOOGLE_include_directive : require\n"                                                               \
    "#extension GL_EXT_samplerless_texture_functions : require\n"                                                      \
    "#include \"shared/bindings.glsl\"\n"                                                                              \
    "#include \"march.pass.h\"\n"                                                                                      \
    "#include \"shared/push_begin.glsl\"\n"                                                                            \
    "#include \"march.pass.h\"\n"                                                                                      \
    "};\n"
#define STORE "imageStore(travelled, ivec2(gl_GlobalInvocationID.xy), vec4(x));"

/* A pass that declares nothing but its output, at binding 4. */
static const struct glint_row bare_row = {.kind = GLINT_ROW_WRITE, .id = 4, .name = "o", .glsl = "image2D"};
static const struct glint_pass bare = {.slot = "cubemap_trace", .variant = "bare", .rows = &bare_row, .row_count = 1};
static const struct places bare_places = {
    .ids = {[FIRST_PLACE] = 3}, .parameters = 1 << FIRST_PLACE, .names = {[FIRST_PLACE] = "mine"}};

static void check_users_shader(void **state, const char *text, const char *stay) {
    static struct listing listing;
    const bool alone = strncmp(text, START, strlen(START)) != 0;
    const struct glint_pass *pass = alone ? &bare : glint_pass_find("cubemap_trace", "march");
    const struct places places = alone ? bare_places : places_of(pass);
    const struct fixture *fixture = *state;
    struct shaders shaders;
    struct spirv spirv = {0};
    struct glint_error err = {0};
    char path[200], names[400] = "";
    uint64_t turned;
    size_t bytes;
    snprintf(path, sizeof path, "%s/mine.comp", fixture->folder);
    FILE *file = fopen(path, "w");
    assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
    assert_true(shaders_init(&shaders, NULL, &err));
    if (!spirv_find(&spirv, &shaders, &(struct pipeline_pass){.pass = pass, .shader = path}, &err))
        fail_msg("%s: %s", text, err.message);
    uint32_t *generic = spirv_generic(spirv.words, spirv.bytes, places.ids, places.parameters, &turned, &bytes);
    assert_non_null(generic);
    list(*state, generic, bytes, &listing);
    const uint64_t left = constants_in(&listing, &places);
    for (uint32_t place = FIRST_PLACE; place < SPIRV_PLACES; place++)
        if (left >> place & 1) strcat(strcat(names, places.names[place]), " ");
    assert_string_equal(names, stay);
    assert_true(turned == (places.parameters & ~left));
    list_free(&listing);
    free(generic);
    shaders_finish(&shaders);
}

/* Catches: a constant that is read from memory where SPIR-V wants a constant, and one that needlessly is not. */
static void constants_stay_where_they_must(void **state) {
    static const struct {
        const char *text, *stay; /* names of parameters, each followed by a blank */
    } cases[] = {
        {START "void main() { float x = steps_hq; " STORE " }", ""},
        {START "void main() { float x[steps_hq]; x[3] = 1; imageStore(travelled, ivec2(0), vec4(x[steps_lq])); }",
         "steps_hq "},
        {START "shared float y[2 * steps_hq + chain]; void main() { y[refinements] = 2; barrier(); float x = y[1] + "
               "chain; " STORE " }",
         "steps_hq chain "},
        {START "const ivec2 both = ivec2(steps_hq, steps_lq); void main() { float x = both[gl_LocalInvocationIndex % "
               "2] + both.y; " STORE " }",
         ""},
        {START "float y = rough_level; float f(float z) { return verify ? z * rough_level : y; }\n"
               "void main() { float x = secant ? f(1) : f(float(count)); " STORE " }",
         ""},
        {START "void main() { float x = 0; for (int i = 0; i < steps_hq; i++) { if (i > refinements && !verify) break; "
               "x += i; }\n"
               "switch (count + loop) { case 1: x += 2; break; default: x += 3; } " STORE " }",
         ""},
        {START "layout(constant_id = 2000) const int mine = 2; void main() { float x = mine * steps_hq; " STORE " }",
         ""},
        {START "void main() { float x = 1; " STORE " }", ""},
        /* neither unsigned integers nor what glint declares */
        {"#version 460\nlayout(constant_id = 3) const float mine = 1;\nfloat f() { return mine; }\n"
         "layout(set = 0, binding = 4, r32f) uniform image2D o;\nvoid main() { imageStore(o, ivec2(0), vec4(f())); }",
         ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) check_users_shader(state, cases[i].text, cases[i].stay);
}

int main(int argc, char **argv) {
    if (argc > 1) every = (size_t)atoi(argv[1]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_module_of_every_pass_is_valid),
                                       cmocka_unit_test(constants_stay_where_they_must)};
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}
