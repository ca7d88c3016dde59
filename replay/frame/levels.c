/* The levels and texels that rows DISPATCH run over. */
#include <math.h>

#include "frame_plan.h"

/* The finest level that is no wider than the value of a parameter. */
static int level_of_width(const struct graph_pass *pass, const struct image_desc *desc, const char *parameter) {
    const double width = *pipeline_value(pass->entry, parameter);
    int level = 0;
    while (level < 31 && ldexp(width, level) < desc->width) level++;
    return level;
}

bool dispatch_levels(const struct frame_sizes *sizes, const struct graph_pass *pass, const struct glint_row *row,
                     const struct image_desc *desc, uint32_t *first, uint32_t *last) {
    const int count = (int)desc->levels;
    const bool swapped = (row->first < 0) == (row->last < 0) ? row->first > row->last : row->first < 0;
    int fine = swapped ? row->last : row->first, coarse = swapped ? row->first : row->last;
    if (row->chain) fine = (int)row_levels(row, sizes->is_cpu), coarse = count - 1;
    else if (row->assigned) {
        const int from = level_of_width(pass, desc, row->assigned);
        fine = from + row->first, coarse = from + row->last;
    } else {
        fine = fine < 0 ? fine + count : fine;
        coarse = coarse < 0 ? coarse + count : coarse;
    }
    if (fine < 0) fine = 0;
    if (coarse > count - 1) coarse = count - 1;
    *first = (uint32_t)fine;
    *last = coarse < 0 ? 0 : (uint32_t)coarse;
    return coarse >= fine;
}

uint64_t dispatch_texels(const struct frame_sizes *sizes, const struct image_desc *desc, uint32_t level) {
    const struct extent extent = image_extent(desc, level);
    if (desc->buffer) return tile_count(sizes);
    return (uint64_t)extent.width * extent.height * image_layers(desc);
}
