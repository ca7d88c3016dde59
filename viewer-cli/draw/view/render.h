/* A source as a finished picture: colour through OpenColorIO or false colour, cross, crop, zoom, legend. */
#ifndef GLINT_VIEWER_RENDER_H
#define GLINT_VIEWER_RENDER_H

#include "draw/view/falsecolor.h"
#include "draw/view/ocio.h"

struct render_options {
    enum kind kind;
    struct falsecolor_options falsecolor;
    struct ocio_options ocio;
    double exposure_ev;
    bool faces;    /* cube maps as they are stored, not as a cross */
    bool latlong;  /* cube maps by longitude and latitude */
    bool has_crop; /* x, y, width, height */
    uint32_t crop[4], zoom;
    bool no_legend;
};

/* What is asked for, or what the source calls for. */
enum kind render_kind(const struct source *source, const struct render_options *options);
/* Without zoom and legend. *invalid receives how many pixels of a colour image are NaN or infinite. */
bool render_plain(struct picture *picture, struct legend *legend, const struct source *source,
                  const struct render_options *options, size_t *invalid, struct glint_error *err);
/* Widens `range` to hold what this source alone would be shown over; begin with +inf, -inf. Kinds without a range leave it. */
bool render_range(const struct source *source, const struct render_options *options, double range[2],
                  struct glint_error *err);
/* With them; colour explains itself and gets no legend. */
bool render(struct picture *picture, const struct source *source, const struct render_options *options, size_t *invalid,
            struct glint_error *err);

/* A run's image, which is open, and its coarser levels on one picture, by one range of values. */
bool render_levels(struct picture *picture, const struct source *finest, const struct source_choice *choice,
                   const struct render_options *options, size_t *invalid, struct glint_error *err);

/* All images of a run, or those of a NULL-terminated list, in rows of one width, each with its name or legend below.
   Several runs: a row for each image of the first, a column for each run, one range of values in a row. */
bool render_sheet(struct picture *sheet, const char *const *runs, size_t run_count, const char *const *images,
                  const struct render_options *options, struct glint_error *err);

#endif
