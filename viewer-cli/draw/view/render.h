/* Renders a source as a picture: colour through OpenColorIO or false colours, cross, crop, zoom, legend. */
#ifndef GLINT_VIEWER_RENDER_H
#define GLINT_VIEWER_RENDER_H

#include "draw/view/falsecolor.h"
#include "draw/view/ocio.h"

struct render_options {
    enum kind kind;
    struct falsecolor_options falsecolor;
    struct ocio_options ocio;
    double exposure_ev;
    bool faces;    /* cube maps as stored, not as a cross */
    bool latlong;  /* cube maps in longitude and latitude */
    bool has_crop; /* x, y, width, height */
    uint32_t crop[4], zoom;
    bool no_legend;
};

/* The requested kind, or the one that suits the source. */
enum kind render_kind(const struct source *source, const struct render_options *options);
/* Renders without zoom and legend. *invalid receives the number of pixels of a colour image that are NaN or infinite. */
bool render_plain(struct picture *picture, struct legend *legend, const struct source *source,
                  const struct render_options *options, size_t *invalid, struct glint_error *err);
/* Extends `range` by the range in which this source alone would be drawn; start with +inf, -inf. Kinds without a range do not change it. */
bool render_range(const struct source *source, const struct render_options *options, double range[2],
                  struct glint_error *err);
/* Renders with zoom and legend; colour images have no legend. */
bool render(struct picture *picture, const struct source *source, const struct render_options *options, size_t *invalid,
            struct glint_error *err);

/* Renders an image of an open run and its coarser levels as one picture, with one range of values. */
bool render_levels(struct picture *picture, const struct source *finest, const struct source_choice *choice,
                   const struct render_options *options, size_t *invalid, struct glint_error *err);

/* Renders images of runs (shown.h) as one picture, about as wide as high, each with its name or legend below and its pass above; those of
   several runs beside each other with one range of values. */
bool render_sheet(struct picture *sheet, const char *const *runs, size_t run_count, const char *const *images, bool all,
                  const struct render_options *options, struct glint_error *err);

#endif
