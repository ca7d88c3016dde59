/* Many pictures as one: cells of equal width in rows, each with its name or legend below. */
#ifndef GLINT_VIEWER_SHEET_H
#define GLINT_VIEWER_SHEET_H

#include "draw/view/render.h"
#include "draw/view/shown.h"

struct sheet {
    struct picture *cells; /* row by row; empty pictures leave their cells empty */
    uint32_t columns, rows;
    uint32_t unit;             /* cells that belong to one image, one for each run; divides `columns` */
    const struct shown *shown; /* names the passes above the cells, whose images these are; NULL: without names */
};
bool sheet_init(struct sheet *sheet, uint32_t columns, uint32_t rows, struct glint_error *err);
void sheet_finish(struct sheet *sheet);
bool sheet_lay_out(struct picture *picture, const struct sheet *sheet, struct glint_error *err);

/* Renders the images of runs as cells, in their order, those of one image beside each other with one range of values. A run without
   the image gets a cell that says so. Release the sheet even if this fails. */
bool sheet_fill(struct sheet *sheet, const char *const *runs, size_t run_count, const struct shown *shown,
                const struct render_options *options, struct glint_error *err);

/* The last component of a path. */
const char *sheet_name(const char *path);
/* Fits a finished picture with its legend into a cell. Colours are averaged, categories are not. */
bool sheet_fit(struct picture *picture, const struct legend *legend, struct glint_error *err);
/* Renders one image with its legend as a cell. The legend names `run` unless it is NULL. */
bool sheet_cell(struct picture *picture, const struct source *source, const char *run,
                const struct render_options *options, struct glint_error *err);

#endif
