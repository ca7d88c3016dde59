/* Arranges many images as one picture: those of a run, or the same images of several runs side by side. */
#include "draw/view/sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/view/text.h"
#include "threads.h"

enum {
    CELL_PX = 480,
    CELL_HEIGHT_PX = 270,
    GAP_PX = 12,
    HEAD_PX = 24,
    HEAD_FONT_PX = 14,
    WORKERS = 8 /* each holds an image in memory */
};

struct cell {
    const char *run, *image;
    bool named; /* the legend names the run */
};

const char *sheet_name(const char *path) {
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') length--;
    const char *name = path;
    for (const char *p = path; p < path + length; p++)
        if (*p == '/') name = p + 1;
    return name;
}

static bool open_cell(struct source *source, const struct cell *cell, struct glint_error *err) {
    const struct source_choice choice = {.path = cell->run, .image = cell->image};
    return source_open(source, &choice, err);
}

bool sheet_fit(struct picture *picture, const struct legend *legend, struct glint_error *err) {
    const bool categories = legend->kind == KIND_INDEX || legend->kind == KIND_REASON;
    const uint32_t wide = CELL_PX / picture->width, high = CELL_HEIGHT_PX / picture->height;
    return picture_shrink(picture, (picture->width + CELL_PX - 1) / CELL_PX, !categories, err) &&
           picture_zoom(picture, wide < high ? wide : high, err) && legend_add(picture, legend, err);
}

/* The number of texels along each axis that are averaged in colour images. Blocks of cube maps stay within a face. */
static uint32_t color_block(const struct source *source, const struct render_options *options) {
    const uint32_t width = source->cube && !options->faces ? 4 * source->width : source->width;
    uint32_t block = (width + CELL_PX - 1) / CELL_PX;
    if (render_kind(source, options) != KIND_COLOR || options->has_crop) return 1;
    while (source->cube && source->width % block) block--;
    return block;
}

/* Averages radiance before the conversion to display colours, which is far less to convert. A non-finite texel makes
   its whole block invalid, so that it stays visible. */
static bool shrink_light(struct source *small, const struct source *source, uint32_t block, struct glint_error *err) {
    *small = *source;
    small->width = source->width / block ? source->width / block : 1;
    small->height = source->height / block ? source->height / block : 1;
    const size_t components = source->components, texels = (size_t)small->width * small->height;
    const uint32_t rows = block < source->height ? block : source->height;
    small->texels = calloc(texels * components, sizeof *small->texels);
    if (!small->texels) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < texels; i++) {
        float *mean = small->texels + i * components;
        for (uint32_t k = 0; k < rows * block; k++) {
            const size_t x = i % small->width * block + k % block, y = i / small->width * block + k / block;
            const float *texel = source->texels + (y * source->width + x) * components;
            for (size_t c = 0; c < components; c++) mean[c] += texel[c] / (float)(rows * block);
        }
    }
    return true;
}

bool sheet_cell(struct picture *picture, const struct source *source, const char *run,
                const struct render_options *options, struct glint_error *err) {
    const uint32_t block = color_block(source, options);
    struct source small = {0};
    struct legend legend;
    size_t invalid;
    bool ok = (block == 1 || shrink_light(&small, source, block, err)) &&
              render_plain(picture, &legend, block > 1 ? &small : source, options, &invalid, err);
    free(small.texels);
    if (!ok) return false;
    if (run) legend_label(&legend, run);
    return sheet_fit(picture, &legend, err);
}

static bool draw_cell(struct picture *picture, const struct cell *cell, const struct render_options *options,
                      struct glint_error *err) {
    struct source source;
    if (!open_cell(&source, cell, err)) return false;
    bool ok = sheet_cell(picture, &source, cell->named ? sheet_name(cell->run) : NULL, options, err);
    source_finish(&source);
    return ok;
}

/* The union of all ranges of a row, so that equal colours mean equal values. */
static bool common_range(const struct cell *cells, const bool *present, uint32_t columns,
                         struct render_options *options, struct glint_error *err) {
    double range[2] = {INFINITY, -INFINITY};
    for (uint32_t i = 0; i < columns; i++) {
        struct source source;
        if (!present[i]) continue;
        if (!open_cell(&source, &cells[i], err)) return false;
        const bool ok = render_range(&source, options, range, err);
        source_finish(&source);
        if (!ok) return false;
    }
    options->falsecolor.range_given = range[0] < range[1];
    options->falsecolor.low = range[0];
    options->falsecolor.high = range[1];
    return true;
}

/* The place of an image that another run has: says so, so that what stands beside each other has one name. */
static bool draw_absent(struct picture *picture, const struct cell *cell, struct glint_error *err) {
    static const struct rgb ground = {0x1e, 0x21, 0x27};
    struct legend legend = {.kind = KIND_COLOR};
    snprintf(legend.title, sizeof legend.title, "%.128s: not in %.128s", cell->image, sheet_name(cell->run));
    return picture_init(picture, CELL_PX, CELL_HEIGHT_PX, ground, err) && legend_add(picture, &legend, err);
}

/* Draws one image of every run. */
static bool draw_row(struct picture *pictures, const char *const *runs, uint32_t columns,
                     const struct shown_image *image, const struct render_options *options, struct glint_error *err) {
    struct render_options row = *options;
    struct cell *cells = calloc(columns, sizeof *cells);
    const bool unknown = !image->pass[0]; /* the attempt to open it reports the names that exist */
    bool ok = cells || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (uint32_t i = 0; ok && i < columns; i++) cells[i] = (struct cell){runs[i], image->name, columns > 1};
    if (ok && columns > 1 && !options->falsecolor.range_given) ok = common_range(cells, image->in, columns, &row, err);
    for (uint32_t i = 0; ok && i < columns; i++)
        ok = image->in[i] || unknown ? draw_cell(&pictures[i], &cells[i], &row, err)
                                     : draw_absent(&pictures[i], &cells[i], err);
    free(cells);
    return ok;
}

static uint32_t row_height(const struct sheet *sheet, uint32_t row) {
    uint32_t height = 0;
    for (uint32_t k = 0; k < sheet->columns; k++) {
        uint32_t cell = sheet->cells[(size_t)row * sheet->columns + k].height;
        if (cell > height) height = cell;
    }
    return height;
}

bool sheet_init(struct sheet *sheet, uint32_t columns, uint32_t rows, struct glint_error *err) {
    *sheet = (struct sheet){calloc((size_t)columns * rows + 1, sizeof *sheet->cells), columns, rows, 1, NULL};
    return sheet->cells || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

void sheet_finish(struct sheet *sheet) {
    for (size_t i = 0; sheet->cells && i < (size_t)sheet->columns * sheet->rows; i++) picture_finish(&sheet->cells[i]);
    free(sheet->cells);
    *sheet = (struct sheet){0};
}

static const char *pass_at(const struct sheet *sheet, uint32_t row, uint32_t unit) {
    const uint32_t in_row = sheet->columns / sheet->unit;
    const size_t i = (size_t)row * in_row + unit;
    return unit < in_row && i < sheet->shown->count ? sheet->shown->images[i].pass : "";
}

/* Names the pass of each stretch of cells above a line as long as the stretch. */
static void draw_heads(struct picture *picture, const struct sheet *sheet, struct text *text, uint32_t row,
                       uint32_t top) {
    static const struct rgb line = {0x5a, 0x5d, 0x63};
    const uint32_t in_row = sheet->columns / sheet->unit, wide = sheet->unit * (CELL_PX + GAP_PX);
    for (uint32_t k = 0, end; k < in_row; k = end) {
        const char *pass = pass_at(sheet, row, k);
        char label[128];
        for (end = k + 1; end < in_row && !strcmp(pass_at(sheet, row, end), pass);) end++;
        if (!*pass) continue;
        const bool continued = k == 0 && row > 0 && !strcmp(pass_at(sheet, row - 1, in_row - 1), pass);
        snprintf(label, sizeof label, "%s%s", pass, continued ? ", continued" : "");
        const int x = (int)(GAP_PX + k * wide);
        text_draw(text, picture, x, (int)top + HEAD_FONT_PX, label, COLOR_TEXT);
        picture_fill(picture, x, (int)(top + HEAD_PX) - 5, (int)((end - k) * wide) - GAP_PX, 1, line);
    }
}

static bool lay_out_rows(struct picture *picture, const struct sheet *sheet, struct text *text,
                         struct glint_error *err) {
    const uint32_t head = text ? HEAD_PX : 0;
    uint32_t height = GAP_PX, top = GAP_PX, width = sheet->columns * (CELL_PX + GAP_PX) + GAP_PX;
    for (uint32_t row = 0; row < sheet->rows; row++) height += head + row_height(sheet, row) + GAP_PX;
    if (!picture_init(picture, width, height, COLOR_BACKGROUND, err)) return false;
    for (uint32_t row = 0; row < sheet->rows; row++) {
        if (text) draw_heads(picture, sheet, text, row, top);
        top += head;
        for (uint32_t k = 0; k < sheet->columns; k++) {
            const struct picture *cell = &sheet->cells[(size_t)row * sheet->columns + k];
            if (cell->rgba) picture_paste(picture, cell, GAP_PX + k * (CELL_PX + GAP_PX), top);
        }
        top += row_height(sheet, row) + GAP_PX;
    }
    return true;
}

/* Each row is as high as its highest cell. */
bool sheet_lay_out(struct picture *picture, const struct sheet *sheet, struct glint_error *err) {
    if (!sheet->shown) return lay_out_rows(picture, sheet, NULL, err);
    struct text *text = text_create(HEAD_FONT_PX, err);
    const bool ok = text && lay_out_rows(picture, sheet, text, err);
    text_destroy(&text);
    return ok;
}

struct filling {
    struct sheet *sheet;
    const char *const *runs;
    uint32_t run_count;
    const struct shown *shown;
    const struct render_options *options;
    struct glint_error errors[WORKERS];
};

static bool fill_row(void *user, uint32_t worker, size_t i) {
    struct filling *f = user;
    return draw_row(&f->sheet->cells[i * f->run_count], f->runs, f->run_count, &f->shown->images[i], f->options,
                    &f->errors[worker]);
}

/* Rows are drawn in parallel, one on each core. */
static bool fill_rows(struct filling *filling, size_t count, struct glint_error *err) {
    uint32_t workers = glint_loop_workers(count, 0);
    if (workers > WORKERS) workers = WORKERS;
    if (glint_loop(count, workers, fill_row, filling)) return true;
    for (uint32_t i = 0; i < workers; i++)
        if (filling->errors[i].code != GLINT_OK)
            return glint_fail(err, filling->errors[i].code, "%s", filling->errors[i].message);
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static uint32_t sheet_height(const struct sheet *sheet) {
    uint32_t height = 0;
    for (uint32_t row = 0; row < sheet->rows; row++) height += row_height(sheet, row) + GAP_PX;
    return height;
}

/* The least number of units in a row with which the sheet is at least as wide as it is high. */
static void choose_columns(struct sheet *sheet, uint32_t units) {
    for (uint32_t k = 1; k <= units; k++) {
        sheet->columns = k * sheet->unit;
        sheet->rows = (units + k - 1) / k;
        if (sheet->columns * (CELL_PX + GAP_PX) >= sheet_height(sheet)) return;
    }
}

bool sheet_fill(struct sheet *sheet, const char *const *runs, size_t run_count, const struct shown *shown,
                const struct render_options *options, struct glint_error *err) {
    struct filling filling = {sheet, runs, (uint32_t)run_count, shown, options, {{0}}};
    /* twice the cells, as the last row may have empty ones */
    if (!sheet_init(sheet, (uint32_t)(shown->count * run_count), 2, err)) return false;
    sheet->unit = (uint32_t)run_count;
    if (!fill_rows(&filling, shown->count, err)) return false;
    choose_columns(sheet, (uint32_t)shown->count);
    return true;
}

bool render_sheet(struct picture *picture, const char *const *runs, size_t run_count, const char *const *images,
                  bool all, const struct render_options *options, struct glint_error *err) {
    struct sheet sheet = {0};
    struct shown shown;
    bool ok = shown_find(&shown, runs, run_count, images, all, err) &&
              sheet_fill(&sheet, runs, run_count, &shown, options, err);
    if (!images) sheet.shown = &shown; /* images that were asked for stand in the order of asking */
    ok = ok && sheet_lay_out(picture, &sheet, err);
    sheet_finish(&sheet);
    shown_finish(&shown);
    return ok;
}
