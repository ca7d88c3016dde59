/* Renders charts as SVG files by running the scripts of the pages in Duktape. */
#include "draw/page/page.h"

#include <duktape.h>
#include <stdlib.h>
#include <string.h>

#include "draw/blobs.h"
#include "draw/page/script_heap.h"
#include "io/output.h"
#include "record.h"

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

/* Bytecode fits only the version of Duktape that wrote it. */
static bool fits_bytecode(duk_context *js) {
    duk_get_global_string(js, "Duktape");
    duk_get_prop_string(js, -1, "version");
    const bool fits = duk_get_uint(js, -1) == DUK_VERSION;
    duk_pop_2(js);
    return fits;
}

static void load_echarts(duk_context *js) {
    if (!fits_bytecode(js)) {
        evaluate_script(js, "echarts.min.js", blob_echarts, blob_echarts_end);
        return;
    }
    const size_t size = (size_t)(blob_echarts_code_end - blob_echarts_code);
    memcpy(duk_push_fixed_buffer(js, size), blob_echarts_code, size);
    duk_load_function(js);
    duk_call(js, 0);
    duk_pop(js);
}

/* ECharts requests timers while it loads, but needs none here. */
static const char timers[] = "function setTimeout() { return 0; } function clearTimeout() {}";

static duk_ret_t load_scripts(duk_context *js, void *user) {
    (void)user;
    duk_eval_string_noresult(js, timers);
    load_echarts(js);
    evaluate_script(js, "chart.js", blob_chart, blob_chart_end);
    return 0;
}

static duk_ret_t draw_chart(duk_context *js, void *user) {
    struct drawing *drawing = user;
    duk_get_global_string(js, "glintChart");
    duk_push_string(js, "svg");
    duk_push_string(js, drawing->chart);
    duk_json_decode(js, -1);
    duk_call_prop(js, -3, 1);
    drawing->svg = strdup(duk_require_string(js, -1));
    return 0;
}

static bool call(duk_context *js, duk_safe_call_function function, struct drawing *drawing, const char *path,
                 struct glint_error *err) {
    const bool ok = duk_safe_call(js, function, drawing, 0, 1) == DUK_EXEC_SUCCESS;
    if (!ok) glint_fail(err, GLINT_ERROR_FORMAT, "%s: cannot draw the chart: %s", path, duk_safe_to_string(js, -1));
    duk_pop(js);
    return ok;
}

static bool draw_with_scripts(struct page_charts *charts, struct drawing *drawing, const char *path,
                              struct glint_error *err) {
    if (!charts->js) {
        charts->js = duk_create_heap(script_alloc, script_realloc, script_free, charts->heap, NULL);
        if (!charts->js) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        if (!call(charts->js, load_scripts, NULL, path, err)) return page_charts_finish(charts), false;
    }
    return call(charts->js, draw_chart, drawing, path, err) &&
           (drawing->svg || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path));
}

static bool draw(struct page_charts *charts, struct drawing *drawing, const char *path, struct glint_error *err) {
    if (!charts->heap && !(charts->heap = calloc(1, sizeof *charts->heap)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    if (setjmp(charts->heap->out) == 0) return draw_with_scripts(charts, drawing, path, err);
    charts->js = NULL;
    page_charts_finish(charts);
    return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
}

bool page_chart_write(struct page_charts *charts, const char *path, const json_t *chart, struct glint_error *err) {
    /* ASCII, because Duktape expects characters beyond 16 bits as surrogate pairs */
    struct drawing drawing = {.chart = record_text(chart, JSON_ENSURE_ASCII | JSON_COMPACT | JSON_ENCODE_ANY)};
    bool ok = drawing.chart ? draw(charts, &drawing, path, err) && output_text(path, drawing.svg, err)
                            : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    free(drawing.chart);
    free(drawing.svg);
    return ok;
}

void page_charts_finish(struct page_charts *charts) {
    if (charts->js) {
        if (setjmp(charts->heap->out) == 0) duk_destroy_heap(charts->js);
    }
    if (charts->heap) script_heap_free(charts->heap);
    free(charts->heap);
    *charts = (struct page_charts){0};
}
