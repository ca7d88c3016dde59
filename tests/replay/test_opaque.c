/* Modules whose values of uniform buffers and push constants are chosen by the number of workgroups: spirv-val accepts that of every pass, and in what
   spirv-dis writes of it nothing but that choice uses a value as it was loaded. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "listing.h"
#include "program.h"
#include "unit.h"

enum { IDS = 1 << 16 };
/* Of each id of a module. */
static struct of_id {
    bool uniform_pointer_type, uniform_pointer, loaded, groups_pointer, groups, null, across, some;
    unsigned choices, uses;
} ids[IDS];

static void note_pointers(const char *line) {
    unsigned a, b, c;
    char word[32];
    if (sscanf(line, "%%%u = OpTypePointer %31s", &a, word) == 2)
        ids[a].uniform_pointer_type = !strcmp(word, "Uniform") || !strcmp(word, "PushConstant");
    if (sscanf(line, "%%%u = OpVariable %%%u", &a, &b) == 2 || sscanf(line, "%%%u = OpAccessChain %%%u", &a, &b) == 2)
        ids[a].uniform_pointer = ids[b].uniform_pointer_type;
    if (sscanf(line, "OpDecorate %%%u BuiltIn %31s", &a, word) == 2)
        ids[a].groups_pointer = !strcmp(word, "NumWorkgroups");
    if (sscanf(line, "%%%u = OpConstantNull %%%u", &a, &b) == 2) ids[a].null = true;
    if (sscanf(line, "%%%u = OpLoad %%%u %%%u", &a, &b, &c) == 3)
        ids[a].loaded = ids[c].uniform_pointer, ids[a].groups = ids[c].groups_pointer;
}

/* The choice is the loaded value where a dispatch has a workgroup, as each has, and nothing else. */
static void note_choices(const char *line) {
    unsigned a, b, c, d, e;
    if (sscanf(line, "%%%u = OpCompositeExtract %%%u %%%u 0", &a, &b, &c) == 3) ids[a].across = ids[c].groups;
    if (sscanf(line, "%%%u = OpINotEqual %%%u %%%u %%%u", &a, &b, &c, &d) == 4) ids[a].some = ids[c].across;
    if (sscanf(line, "%%%u = OpSelect %%%u %%%u %%%u %%%u", &a, &b, &c, &d, &e) == 5 && ids[c].some && ids[e].null)
        ids[d].choices++;
}

static void note_uses(const char *line) {
    const char *at = strchr(line, '=');
    unsigned id;
    while ((at = strchr(at ? at : line, '%')))
        if (sscanf(at++, "%%%u", &id) == 1 && id < IDS) ids[id].uses++;
}

/* Returns how many values the module loads. */
static size_t check_choices(const struct listing *listing) {
    size_t loads = 0;
    memset(ids, 0, sizeof ids);
    for (size_t i = 0; i < listing->count; i++) note_pointers(listing->lines[i]);
    for (size_t i = 0; i < listing->count; i++) note_choices(listing->lines[i]), note_uses(listing->lines[i]);
    for (size_t id = 0; id < IDS; id++) {
        if (!ids[id].loaded) continue;
        loads++;
        if (ids[id].choices != 1 || ids[id].uses != 1)
            fail_msg("%%%zu: %u choices, %u uses", id, ids[id].choices, ids[id].uses);
    }
    return loads;
}

static size_t count_loads(const struct listing *listing) {
    size_t loads = 0;
    memset(ids, 0, sizeof ids);
    for (size_t i = 0; i < listing->count; i++) note_pointers(listing->lines[i]);
    for (size_t id = 0; id < IDS; id++) loads += ids[id].loaded;
    return loads;
}

static size_t check_module(void **state, const uint32_t *words, size_t bytes, bool count) {
    static struct listing before, after;
    size_t opaque_bytes;
    uint32_t *opaque = spirv_opaque(words, bytes, &opaque_bytes);
    assert_non_null(opaque);
    list(*state, opaque, opaque_bytes, &after);
    const size_t loads = check_choices(&after);
    if (count) {
        list(*state, words, bytes, &before);
        assert_int_equal(loads, count_loads(&before));
        list_free(&before);
    }
    if (!loads) assert_true(opaque_bytes == bytes && memcmp(opaque, words, bytes) == 0);
    list_free(&after);
    free(opaque);
    return loads;
}

static size_t every = 4;

/* Of generic modules, too, which load the values of parameters. */
static void the_module_of_every_pass_is_valid(void **state) {
    static const uint32_t specs[SPIRV_PLACES] = {[1] = 2000}; /* ids that no pass has, but for those below */
    size_t count, loads = 0;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i += every) {
        const struct glint_pass *pass = &passes[i];
        if (!pass->spirv) continue;
        uint32_t places[SPIRV_PLACES];
        uint64_t parameters = 0, turned;
        memcpy(places, specs, sizeof places);
        for (size_t r = 0, place = 9; r < pass->row_count; r++)
            if (pass->rows[r].kind == GLINT_ROW_SPEC || pass->rows[r].kind == GLINT_ROW_CHOICE)
                parameters |= UINT64_C(1) << place, places[place++] = pass->rows[r].id;
        size_t bytes;
        uint32_t *generic = spirv_generic(pass->spirv, pass->spirv_bytes, places, parameters, &turned, &bytes);
        assert_non_null(generic);
        loads += check_module(state, generic, bytes, i % 16 == 0);
        free(generic);
    }
    print_message("# %zu loads\n", loads);
    assert_true(loads > 1000 / every);
}

/* What users write that passes do not: whole structs and matrices, and the number of workgroups itself. */
static void users_shaders_are_valid(void **state) {
    static const char *const texts[] = {
        "layout(push_constant) uniform Push { uint level; mat3 m; } push;\n"
        "void main() { mat3 m = push.m; if (m[0].x > 0.0 && push.level < 3u) imageStore(o, ivec2(0), vec4(m[1], 1)); }",
        "struct Lamp { vec4 at; uint kind[3]; };\n"
        "layout(set = 1, binding = 0) uniform Frame { Lamp lamps[4]; ivec2 size; } frame;\n"
        "float f(Lamp lamp) { return lamp.kind[1] == 2u ? lamp.at.x : 0.0; }\n"
        "void main() { Lamp one = frame.lamps[1]; if (frame.size.x > 3) imageStore(o, ivec2(0), vec4(f(one))); }",
        "layout(push_constant) uniform Push { uint level; } push;\n"
        "void main() { if (push.level < gl_NumWorkGroups.x) imageStore(o, ivec2(0), vec4(1)); }",
        "void main() { imageStore(o, ivec2(0), vec4(1)); }",
    };
    static const size_t loads[] = {2, 2, 1, 0};
    static const struct glint_row row = {.kind = GLINT_ROW_WRITE, .id = 4, .name = "o", .glsl = "image2D"};
    static const struct glint_pass pass = {.slot = "cubemap_trace", .variant = "bare", .rows = &row, .row_count = 1};
    const struct fixture *fixture = *state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct shaders shaders;
        struct spirv spirv = {0};
        struct glint_error err = {0};
        char path[200];
        snprintf(path, sizeof path, "%s/mine.comp", fixture->folder);
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fprintf(file, "#version 460\nlayout(set = 0, binding = 4, r32f) uniform image2D o;\n%s\n", texts[i]);
        assert_int_equal(fclose(file), 0);
        assert_true(shaders_init(&shaders, NULL, &err));
        if (!spirv_find(&spirv, &shaders, &(struct pipeline_pass){.pass = &pass, .shader = path}, &err))
            fail_msg("%s: %s", texts[i], err.message);
        assert_int_equal(check_module(state, spirv.words, spirv.bytes, true), loads[i]);
        shaders_finish(&shaders);
    }
}

int main(int argc, char **argv) {
    if (argc > 1) every = (size_t)atoi(argv[1]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_module_of_every_pass_is_valid),
                                       cmocka_unit_test(users_shaders_are_valid)};
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}
