/* Many images of a run on one picture. */
#include "render.h"

#include <math.h>
#include <stdlib.h>

#include "glint/replay.h"

enum { CELL_PX = 480, CELL_HEIGHT_PX = 270, GAP_PX = 12, MOST = 256 };

/* One image at the sheet's width, with its legend. Colours are averaged; categories must not be mixed. */
static bool draw_cell(struct picture *cell, const char *run, const char *image, const struct render_options *options,
                      struct glint_error *err) {
    const struct source_choice choice = {.path = run, .image = image};
    struct legend legend;
    struct source source;
    size_t invalid;
    if (!source_open(&source, &choice, err)) return false;
    bool ok = render_plain(cell, &legend, &source, options, &invalid, err);
    source_finish(&source);
    if (!ok) return false;
    bool categories = legend.kind == KIND_INDEX || legend.kind == KIND_REASON;
    uint32_t wide = CELL_PX / cell->width, high = CELL_HEIGHT_PX / cell->height;
    return picture_shrink(cell, (cell->width + CELL_PX - 1) / CELL_PX, !categories, err) &&
           picture_zoom(cell, wide < high ? wide : high, err) && legend_add(cell, &legend, err);
}

/* As many columns as rows; each row is as high as its highest cell. */
static bool lay_out(struct picture *sheet, const struct picture *cells, size_t count, struct glint_error *err) {
    uint32_t columns = (uint32_t)ceil(sqrt((double)count)), height = GAP_PX, tops[MOST];
    for (size_t i = 0; i < count; i += columns) {
        uint32_t row = 0;
        for (size_t k = i; k < count && k < i + columns; k++) row = cells[k].height > row ? cells[k].height : row;
        tops[i / columns] = height;
        height += row + GAP_PX;
    }
    if (!picture_init(sheet, columns * (CELL_PX + GAP_PX) + GAP_PX, height, COLOR_BACKGROUND, err)) return false;
    for (size_t i = 0; i < count; i++)
        picture_paste(sheet, &cells[i], GAP_PX + (uint32_t)(i % columns) * (CELL_PX + GAP_PX), tops[i / columns]);
    return true;
}

bool render_sheet(struct picture *sheet, const char *run, const char *const *images,
                  const struct render_options *options, struct glint_error *err) {
    struct picture *cells = calloc(MOST, sizeof *cells);
    struct glint_run *opened = NULL;
    size_t count = 0;
    bool ok = cells || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) ok = (opened = glint_run_open(run, err)) != NULL;
    while (ok && count < MOST && (images ? images[count] != NULL : count < glint_run_image_count(opened))) {
        const char *image = images ? images[count] : glint_run_image(opened, count)->name;
        ok = draw_cell(&cells[count++], run, image, options, err);
    }
    if (ok && count == 0) ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: the run has no images", run);
    if (ok) ok = lay_out(sheet, cells, count, err);
    for (size_t i = 0; i < count; i++) picture_finish(&cells[i]);
    free(cells);
    glint_run_close(&opened);
    return ok;
}
