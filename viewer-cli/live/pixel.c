/* What every pass does for one pixel: answers /api/v1/probe. */
#include <stdlib.h>

#include "draw/probe/draw.h"
#include "live/answers.h"
#include "options/args.h"

struct probing {
    struct state state;
    json_int_t x, y;
    bool reference;
    json_t *result;
};

static bool trace_reference(struct live *live, const struct probing *p, struct probe *probe,
                            const struct glint_replay_options *options, struct glint_error *err) {
    if (!p->reference) return true;
    struct glint_pipeline *pipeline = probe_reference(p->state.pipeline, err);
    probe->has_reference =
        pipeline && probe_run(probe, &probe->reference, live->replay, pipeline, options, live_progress, live, err);
    if (pipeline) glint_pipeline_destroy(&pipeline);
    return probe->has_reference;
}

static char *probe_text(const struct probe *probe) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    probe_print(out, probe);
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
}

static bool report(struct probing *p, const struct probe *probe, struct glint_error *err) {
    struct glint_error no_drawing = {0};
    char *text = probe_text(probe), *svg = probe_draw(probe, &no_drawing);
    p->result = text ? json_pack("{s:o, s:s, s:s?, s:s?}", "probe", probe_json(probe), "text", text, "svg", svg,
                                 "no_drawing", svg ? NULL : no_drawing.message)
                     : NULL;
    free(text);
    free(svg);
    return p->result || fail_memory(err);
}

static bool work_probe(struct live *live, void *user, struct glint_error *err) {
    struct probing *p = user;
    if (!live_load(live, &p->state, false, err)) return false;
    const struct glint_part_info *gbuffer = glint_capture_find(live->capture, "gbuffer");
    if (p->x >= gbuffer->width || p->y >= gbuffer->height)
        return glint_fail(err, GLINT_ERROR_USAGE, "pixel %lld,%lld: the picture has %u x %u pixels", (long long)p->x,
                          (long long)p->y, gbuffer->width, gbuffer->height);
    struct probe probe = {.capture = base_name(live->frames[p->state.capture].path),
                          .preset = glint_pipeline_name(p->state.pipeline),
                          .device = glint_device_get_info(live->device)->name,
                          .pixel = {(uint32_t)p->x, (uint32_t)p->y},
                          .full = {gbuffer->width, gbuffer->height}};
    const struct glint_replay_options options = live_options(live, &p->state);
    bool ok = live_ran(
        live, &p->state,
        probe_run(&probe, &probe.own, live->replay, p->state.pipeline, &options, live_progress, live, err), err);
    if (ok) {
        /* The reference tracers leave other images behind. */
        ok = trace_reference(live, p, &probe, &options, err);
        if (p->reference) live_ran(live, &p->state, ok, err), live->ran = 0;
    }
    ok = ok && report(p, &probe, err);
    probe_side_finish(&probe.own);
    probe_side_finish(&probe.reference);
    return ok;
}

void live_answer_probe(void *user, const struct http_request *request, struct http_answer *answer) {
    enum { SIDE = 1 << 20 };
    struct live *live = user;
    struct glint_error err = {0};
    struct probing p = {.reference = !json_is_false(json_object_get(request->body, "reference"))};
    if (!answer_state(live, request, "state", &p.state, answer)) return;
    const bool ok = answer_number(request, "x", 0, SIDE, -1, &p.x, &err) &&
                    answer_number(request, "y", 0, SIDE, -1, &p.y, &err) &&
                    live_do(live, 0, answer_text(request, "client"), work_probe, &p, &err);
    answer_with(answer, ok, p.result, &err);
    state_finish(&p.state);
}
