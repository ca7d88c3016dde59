/* Fuzzes presets: the file, the pipeline that it describes, and the graph of that. Written as a preset again, the pipeline is the same. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "graph.h"
#include "options/preset_json.h"

/* Every pass runs, and no image is in the capture, which is none. */
static void build_graph(const struct glint_pipeline *pipeline) {
    struct graph graph;
    struct glint_error err = {0};
    fuzz_must(graph_init(&graph, pipeline, &err), err.message);
    fuzz_must(!graph.declared.count || graph.declared.text[0], "a fault of a declaration has a message");
    graph_finish(&graph);
}

static void check_same(const struct glint_pipeline *a, const struct glint_pipeline *b) {
    fuzz_must(glint_pipeline_pass_count(a) == glint_pipeline_pass_count(b), "a pipeline written has as many passes");
    fuzz_must(glint_pipeline_rays(a) == glint_pipeline_rays(b) &&
                  glint_pipeline_first_ray(a) == glint_pipeline_first_ray(b),
              "a pipeline written has the same rays");
    for (size_t i = 0; i < glint_pipeline_pass_count(a); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(a, i);
        fuzz_must(pass == glint_pipeline_pass(b, i), "a pipeline written has the same variants");
        for (size_t r = 0; r < pass->row_count; r++)
            fuzz_must(!glint_row_is_parameter(&pass->rows[r]) || glint_pipeline_value(a, pass, &pass->rows[r]) ==
                                                                     glint_pipeline_value(b, pass, &pass->rows[r]),
                      "a pipeline written has the same values");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(fuzz_file("input.json", data, size), &err);
    if (!fuzz_reason(pipeline != NULL, &err)) return 0;
    build_graph(pipeline);
    json_t *json = preset_json(pipeline, "again", "Again");
    char *text = json_dumps(json, JSON_REAL_PRECISION(17));
    fuzz_must(text != NULL, "a pipeline can be written");
    struct glint_pipeline *again = glint_pipeline_create(fuzz_file("again.json", text, strlen(text)), &err);
    fuzz_must(again != NULL, err.message);
    check_same(pipeline, again);
    free(text);
    json_decref(json);
    glint_pipeline_destroy(&again);
    glint_pipeline_destroy(&pipeline);
    return 0;
}
