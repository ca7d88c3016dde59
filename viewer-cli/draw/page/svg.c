/* Renders charts as SVG files by running the scripts of the pages in Duktape. */
#include "draw/page/page.h"

#include <duktape.h>
#include <stdlib.h>
#include <string.h>

#include "draw/blobs.h"
#include "io/output.h"

struct drawing {
    char *chart; /* JSON */
    char *svg;   /* malloc'd */
};

static void evaluate_script(duk_context *js, const char *name, const unsigned char *begin, const unsigned char *end) {
    duk_push_string(js, name);
    duk_compile_lstring_filename(js, 0, (const char *)begin, (size_t)(end - begin));
    duk_call(js, 0);
    duk_pop(js);
}

/* ECharts requests timers while it loads, but needs none here. */
static const char timers[] = "function setTimeout() { return 0; } function clearTimeout() {}";

static duk_ret_t draw_chart(duk_context *js, void *user) {
    struct drawing *drawing = user;
    duk_eval_string_noresult(js, timers);
    evaluate_script(js, "echarts.min.js", blob_echarts, blob_echarts_end);
    evaluate_script(js, "chart.js", blob_chart, blob_chart_end);
    duk_get_global_string(js, "glintChart");
    duk_push_string(js, "svg");
    duk_push_string(js, drawing->chart);
    duk_json_decode(js, -1);
    duk_call_prop(js, -3, 1);
    drawing->svg = strdup(duk_require_string(js, -1));
    return 0;
}

static bool draw_all(struct drawing *drawing, const char *path, struct glint_error *err) {
    duk_context *js = duk_create_heap_default();
    if (!js) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    bool ok = duk_safe_call(js, draw_chart, drawing, 0, 1) == DUK_EXEC_SUCCESS && drawing->svg;
    if (!ok) glint_fail(err, GLINT_ERROR_FORMAT, "%s: cannot draw the chart: %s", path, duk_safe_to_string(js, -1));
    duk_destroy_heap(js);
    return ok;
}

bool page_chart_write(const char *path, const json_t *chart, struct glint_error *err) {
    /* ASCII, because Duktape expects characters beyond 16 bits as surrogate pairs */
    struct drawing drawing = {.chart = json_dumps(chart, JSON_ENSURE_ASCII | JSON_COMPACT | JSON_ENCODE_ANY)};
    bool ok = drawing.chart ? draw_all(&drawing, path, err) && output_text(path, drawing.svg, err)
                            : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    free(drawing.chart);
    free(drawing.svg);
    return ok;
}
