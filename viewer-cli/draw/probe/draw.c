/* Draws the trace of a pixel: its rays over the depths that they pass, on screen and in each cube map. */
#include "draw/probe/draw.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/probe/panels.h"
#include "io/table.h"

enum { HEAD = 62, LEGEND = 62 };

static const char style[] =
    "<style>text{font-family:system-ui,'DejaVu Sans',sans-serif;fill:#222}.head{font-size:20px;font-weight:600}"
    ".title{font-size:15px;font-weight:600}.tick{font-size:11.5px;fill:#555}.axis{font-size:12.5px;fill:#333}"
    ".area{fill:#fbfcfd;stroke:#c9d1d9}.grid{stroke:#e6eaee;stroke-width:1;fill:none}"
    ".solid{fill:#e3e0d8;stroke:none}.surface{fill:none;stroke:#6b6558;stroke-width:1.6;stroke-linejoin:round}"
    ".ray{fill:none;stroke:#24324a;stroke-width:1.4}.bar{fill:#3b7dd8}.swatch{stroke:#888;stroke-width:.5}"
    ".paper{fill:#fff}"
    "@media(prefers-color-scheme:dark){.paper{fill:#15181d}text{fill:#e3e6ea}.tick{fill:#a5aeb8}.axis{fill:#c3cad1}"
    ".area{fill:#1b1f26;stroke:#3a424c}.grid{stroke:#2a3038}.solid{fill:#33312b}.surface{stroke:#b8ae98}"
    ".ray{stroke:#b9c9e6}}</style>\n";

static void legend_entry(FILE *out, double *x, double y, const char *shape, const char *text) {
    fprintf(out, "<g transform=\"translate(%.1f %.1f)\">%s<text x=\"14\" y=\"4\" class=\"tick\">", *x, y, shape);
    svg_text(out, text);
    fputs("</text></g>\n", out);
    *x += 30 + 6.3 * (double)text_width(text);
}

/* Returns the y of its last line. */
static double draw_legend(const struct drawing *d, double y) {
    double x = 30;
    bool any = false;
    for (size_t i = 0; i < DRAW_DECISIONS; i++) any |= d->used[i];
    if (!any) return y - 30;
    legend_entry(d->out, &x, y, "<path d=\"M-6 0H8\" class=\"ray\"/>", "ray");
    legend_entry(
        d->out, &x, y,
        "<rect x=\"-6\" y=\"-5\" width=\"14\" height=\"10\" class=\"solid\"/><path d=\"M-6 5H8\" class=\"surface\"/>",
        "behind the visible surface");
    for (size_t i = 0; i < DRAW_DECISIONS; i++) {
        char shape[96];
        const char *text = "";
        for (float w = 0; glint_probe_label("decision", w).name; w++)
            if (strcmp(glint_probe_label("decision", w).name, draw_decisions[i].decision) == 0)
                text = glint_probe_label("decision", w).text;
        if (!d->used[i]) continue;
        if (x + 30 + 6.3 * (double)text_width(text) > DRAW_WIDTH) x = 30, y += 18;
        snprintf(shape, sizeof shape, "<circle r=\"4.5\" cx=\"1\" fill=\"%s\"/>", draw_decisions[i].color);
        legend_entry(d->out, &x, y, shape, text);
    }
    return y;
}

static void write_svg_head(FILE *out, const struct probe *probe, double height) {
    fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%.0f\" viewBox=\"0 0 %d %.0f\">\n%s",
            DRAW_WIDTH, height, DRAW_WIDTH, height, style);
    fprintf(out, "<rect width=\"%d\" height=\"%.0f\" class=\"paper\"/>\n<text x=\"24\" y=\"34\" class=\"head\">",
            DRAW_WIDTH, height);
    svg_text(out, probe->capture);
    fprintf(out, ", pixel %u,%u</text>\n", probe->pixel[0], probe->pixel[1]);
}

static char *draw_panels(struct drawing *d) {
    char *body = NULL;
    size_t size;
    if (!(d->out = open_memstream(&body, &size))) return NULL;
    const struct glint_probe_trace *trace = &d->probe->own.trace;
    draw_define(d);
    for (size_t i = 0, end; i < trace->count; i = end) {
        const struct glint_probe_record *first = &trace->records[i];
        for (end = i;
             end < trace->count && trace->records[end].pass == first->pass && trace->records[end].ray == first->ray;)
            end++;
        const struct ray_records records = {first, end - i};
        draw_picture(d, &records, DRAW_LEFT - 52, DRAW_AREA + 52);
        draw_screen(d, &records);
        draw_cubes(d, &records);
        draw_mixtures(d, &records);
    }
    fclose(d->out);
    return body;
}

char *probe_draw(const struct probe *probe, struct glint_error *err) {
    struct drawing d = {.probe = probe};
    char *text = NULL;
    size_t size;
    if (probe->own.picture.texels && !(d.uri = draw_encode_picture(probe, err))) return NULL;
    d.points = calloc(DRAW_POINTS, sizeof *d.points);
    char *body = d.points ? draw_panels(&d) : NULL;
    if (body && d.top == 0)
        glint_fail(err, GLINT_ERROR_FORMAT, "pixel %u,%u has no ray to draw", probe->pixel[0], probe->pixel[1]);
    else if (!body || !(d.out = open_memstream(&text, &size))) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else {
        write_svg_head(d.out, probe, HEAD + LEGEND + d.top);
        const double below = draw_legend(&d, HEAD) + LEGEND;
        fprintf(d.out, "<g transform=\"translate(0 %.0f)\">\n%s</g></svg>\n", below, body);
        fclose(d.out);
    }
    free(body);
    free(d.points);
    json_decref(d.uri);
    return text;
}
