/* A picture of many: cells of one width in rows, each with its name or legend below. */
#ifndef GLINT_VIEWER_SHEET_H
#define GLINT_VIEWER_SHEET_H

#include "draw/view/render.h"

struct sheet {
    struct picture *cells; /* row by row; those that stay empty leave their place empty */
    uint32_t columns, rows;
};
bool sheet_init(struct sheet *sheet, uint32_t columns, uint32_t rows, struct glint_error *err);
void sheet_finish(struct sheet *sheet);
bool sheet_lay_out(struct picture *picture, const struct sheet *sheet, struct glint_error *err);

/* What render_sheet lays out. Release the sheet whether or not this succeeds. */
bool sheet_fill(struct sheet *sheet, const char *const *runs, size_t run_count, const char *const *images,
                const struct render_options *options, struct glint_error *err);

/* A path from its last name on. */
const char *sheet_name(const char *path);
/* A finished picture at the sheet's width, with its legend. Colours are averaged; categories must not be mixed. */
bool sheet_fit(struct picture *picture, const struct legend *legend, struct glint_error *err);
/* One image at the sheet's width, with its legend, which names `run` unless it is NULL. */
bool sheet_cell(struct picture *picture, const struct source *source, const char *run,
                const struct render_options *options, struct glint_error *err);

#endif
