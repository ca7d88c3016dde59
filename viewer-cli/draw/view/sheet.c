/* Arranges many images as one picture: those of a run, or the same images of several runs side by side. */
#include "draw/view/sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/replay.h"
#include "threads.h"

enum { CELL_PX = 480, CELL_HEIGHT_PX = 270, GAP_PX = 12, WORKERS = 8 /* each holds an image in memory */ };

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

static bool run_has(const char *path, const char *image, bool *has, struct glint_error *err) {
    struct glint_run *run = glint_run_open(path, err);
    *has = run && glint_run_find(run, image);
    bool ok = run != NULL;
    glint_run_close(&run);
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

/* Draws one image of every run. The cell of a run without this image stays empty if another run has it. */
static bool draw_row(struct picture *pictures, const char *const *runs, uint32_t columns, const char *image,
                     const struct render_options *options, struct glint_error *err) {
    struct render_options row = *options;
    struct cell *cells = calloc(columns, sizeof *cells);
    bool *present = calloc(columns, sizeof *present), ok = cells && present, any = false;
    if (!ok) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (uint32_t i = 0; ok && i < columns; i++) {
        cells[i] = (struct cell){runs[i], image, columns > 1};
        ok = run_has(runs[i], image, &present[i], err);
        any = any || present[i];
    }
    if (ok && !any) present[0] = true; /* the attempt to open it reports the names that exist */
    if (ok && columns > 1 && !options->falsecolor.range_given) ok = common_range(cells, present, columns, &row, err);
    for (uint32_t i = 0; ok && i < columns; i++)
        if (present[i]) ok = draw_cell(&pictures[i], &cells[i], &row, err);
    free(cells);
    free(present);
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
    *sheet = (struct sheet){calloc((size_t)columns * rows + 1, sizeof *sheet->cells), columns, rows};
    return sheet->cells || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

void sheet_finish(struct sheet *sheet) {
    for (size_t i = 0; sheet->cells && i < (size_t)sheet->columns * sheet->rows; i++) picture_finish(&sheet->cells[i]);
    free(sheet->cells);
    *sheet = (struct sheet){0};
}

/* Each row is as high as its highest cell. */
bool sheet_lay_out(struct picture *picture, const struct sheet *sheet, struct glint_error *err) {
    uint32_t height = GAP_PX, top = GAP_PX, width = sheet->columns * (CELL_PX + GAP_PX) + GAP_PX;
    for (uint32_t row = 0; row < sheet->rows; row++) height += row_height(sheet, row) + GAP_PX;
    if (!picture_init(picture, width, height, COLOR_BACKGROUND, err)) return false;
    for (uint32_t row = 0; row < sheet->rows; row++) {
        for (uint32_t k = 0; k < sheet->columns; k++) {
            const struct picture *cell = &sheet->cells[(size_t)row * sheet->columns + k];
            if (cell->rgba) picture_paste(picture, cell, GAP_PX + k * (CELL_PX + GAP_PX), top);
        }
        top += row_height(sheet, row) + GAP_PX;
    }
    return true;
}

static size_t count_images(const struct glint_run *run, const char *const *images) {
    size_t count = 0;
    if (!images) return glint_run_image_count(run);
    while (images[count]) count++;
    return count;
}

struct filling {
    struct sheet *sheet;
    const char *const *runs;
    uint32_t run_count;
    const struct glint_run *first;
    const char *const *images;
    const struct render_options *options;
    struct glint_error errors[WORKERS];
};

static bool fill_row(void *user, uint32_t worker, size_t i) {
    struct filling *f = user;
    const char *image = f->images ? f->images[i] : glint_run_image(f->first, i)->name;
    return draw_row(&f->sheet->cells[i * f->run_count], f->runs, f->run_count, image, f->options, &f->errors[worker]);
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

bool sheet_fill(struct sheet *sheet, const char *const *runs, size_t run_count, const char *const *images,
                const struct render_options *options, struct glint_error *err) {
    struct glint_run *first = glint_run_open(runs[0], err);
    size_t count = first ? count_images(first, images) : 0;
    bool ok = first != NULL;
    *sheet = (struct sheet){0};
    if (ok && count == 0) ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: the run has no images", runs[0]);
    if (ok) {
        /* a single run: about as many columns as rows */
        uint32_t columns = run_count > 1 ? (uint32_t)run_count : (uint32_t)ceil(sqrt((double)count));
        uint32_t rows = run_count > 1 ? (uint32_t)count : (uint32_t)((count + columns - 1) / columns);
        ok = sheet_init(sheet, columns, rows, err);
    }
    struct filling filling = {sheet, runs, (uint32_t)run_count, first, images, options, {{0}}};
    ok = ok && fill_rows(&filling, count, err);
    glint_run_close(&first);
    return ok;
}

bool render_sheet(struct picture *picture, const char *const *runs, size_t run_count, const char *const *images,
                  const struct render_options *options, struct glint_error *err) {
    struct sheet sheet;
    bool ok = sheet_fill(&sheet, runs, run_count, images, options, err) && sheet_lay_out(picture, &sheet, err);
    sheet_finish(&sheet);
    return ok;
}
