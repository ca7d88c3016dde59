/* Reports as self-contained HTML pages, and charts as SVG files, from one description.

   A document is JSON:
     {"format": 1, "title": T,
      "facts": [[NAME, CELL], …]            provenance: tool, device, capture, command line
      "sections": [{"title": T, "blocks": [BLOCK, …]}, …]}
   BLOCK is one of
     {"text": T}  {"heading": T}  {"note": T}  {"code": T}   note: a warning; code: preformatted, as a command line or JSON
     {"table": {"columns": [{"name": T, "unit": T, "help": T, "decimals": N, "bar": BOOL}, …], "rows": [[CELL, …], …]}}
                                             bar: draws numbers also as bars in their cells
     {"pictures": [PICTURE, …], "columns": N}
                                             N per row (default: as many as fit); an enlarged picture is flipped in place
     {"stage": {"title": T, "pictures": [SHOWN, …]}}
                                             comparison of pictures: under a slider, side by side, alternating or one at a
                                             time, with the values of the pixel under the pointer
     {"chart": CHART}
     {"fold": {"title": T, "blocks": [BLOCK, …]}}
                                             blocks that are built when their title is clicked
     {"player": {"title": T, "frames": [T, …], "tracks": [{"name": T, "pictures": [PICTURE, …], "key": KEY}, …], "marks": [{"frame": N, "label": T}, …]}}
                                             pictures of a sequence, one for each frame of the chosen track; marks name frames by
                                             their place. Points of charts that have a frame's name go with it
   "refresh" of a document, in seconds: the page reloads itself unless somebody is using it.
   CELL: text, number, boolean, null (unknown), or {"value": number, "low": L, "high": H, "text": T}: a number with its
   interval, or shown as T and sorted by value.
   PICTURE: {"file": F, "caption": T, "group": T}. A picture whose group is not that of the one before begins a row below the
   group's name. F: a PNG in the document's folder, or the result of page_picture.
   SHOWN: a PICTURE, optionally with "values": VALUES and "key": KEY; "alone": BOOL, it is not compared with others (a heat map).
   VALUES: {"channels": [T, …], "unit": T, "width": PX, "height": PX, "every": N, "names": {"VALUE": T, …}, "data": the result of page_values}
                                             the values of every N-th pixel, to limit the size; names: what single values mean
   KEY: {"title": T, "scale": {"low": L, "high": H, "log": BOOL, "colors": ["#rrggbb", …]},
         "items": [{"color": "#rrggbb", "text": T, "share": number}, …]}
                                             what the colours of a picture stand for: the result of page_key
   CHART:
     {"title": T, "x": AXIS, "y": AXIS, "series": [SERIES, …], "marks": [MARK, …], "width": PX, "height": PX}
   AXIS: {"name": T, "unit": T, "scale": "linear" (default), "log" or "category", "min": A, "max": B, "ticks": [number, …],
          "categories": [T, …]}              categories on the y axis make bars horizontal
   SERIES: {"name": T, "kind": "scatter", "line", "bar" or "front" (points joined as a staircase: a Pareto front),
            "stack": T (bars of the same name are stacked), "muted": BOOL (drawn grey), "points": [POINT, …]}
   POINT: [x, y], or {"x": X, "y": Y, "x_low", "x_high", "low", "high": intervals, "name": T,
          "values": [[NAME, CELL, UNIT], …], "pictures": [PICTURE, …]}
                                             a selected point shows its values and pictures, and points of the same name in
                                             other charts are highlighted with it
          x (y of horizontal bars) on a category axis is the index of the category.
   MARK: {"x": X} or {"y": Y}: a line; {"x": X, "y": Y}: a point; with "label": T.
   Points <= 0 on a logarithmic axis are skipped, and the page counts them. Unknown members are ignored.

   Any text may come from an untrusted file: pages never interpret texts, run only their own scripts and load nothing. */
#ifndef GLINT_VIEWER_PAGE_H
#define GLINT_VIEWER_PAGE_H

#include <jansson.h>

#include "draw/view/falsecolor.h"

/* ---- Writing; files are renamed when complete ---- */

/* Limit for all pictures of a page together. A picture stays PNG if that fits into its share, else it becomes JPEG and then smaller. */
enum { PAGE_PICTURE_BYTES = 14000000 };

enum { PAGE_VALUE_BYTES = 16000000 }; /* limit for all VALUES of a page */

/* Writes the document as HTML. Files of pictures are read below `folder` only; NULL: there are none. A file that cannot be
   read is an error. */
bool page_write(const char *path, const json_t *document, const char *folder, struct glint_error *err);
/* The page of glint live, malloc'd: it has no document and asks its server. */
char *page_live(struct glint_error *err);
/* The script that draws charts, loaded by the first one in about 0.4 s. Zero-initialised. */
struct page_charts {
    struct duk_hthread *js;
    struct script_heap *heap;
};
/* Writes a CHART as SVG. */
bool page_chart_write(struct page_charts *charts, const char *path, const json_t *chart, struct glint_error *err);
void page_charts_finish(struct page_charts *charts);
/* Writes FOLDER/page.json, which `glint report FOLDER` renders again. */
bool page_store(const char *folder, const json_t *document, struct glint_error *err);
/* Loads a stored document; NULL on failure. */
json_t *page_load(const char *folder, struct glint_error *err);

/* ---- Building documents. When out of memory, nothing is added, and page_write or page_store fails ---- */

/* A document with its title and the version of the tool as its first fact; the caller releases it. */
json_t *page_create(const char *title);
void page_fact(json_t *document, const char *name, const char *value);
/* Adds a section and returns its blocks, borrowed. */
json_t *page_section(json_t *document, const char *title);
void page_text(json_t *blocks, const char *kind, const char *text); /* kind: "text", "heading", "note", "code" */
void page_chart(json_t *blocks, json_t *chart);                     /* takes ownership of the chart */
/* Adds a table, borrowed. */
json_t *page_table(json_t *blocks);
/* Unit "" for none; a leading '|' draws bars. */
void page_column(json_t *table, const char *name, const char *unit);
/* Takes ownership of the row, an array of cells. */
void page_row(json_t *table, json_t *row);
/* A number with its interval. */
json_t *page_interval(double value, double low, double high);
/* Encodes a picture in at most `bytes` as a data URI for "file"; NULL on failure. */
json_t *page_picture(const struct picture *picture, size_t bytes, struct glint_error *err);
/* The same for the contents of a PNG or JPEG file; errors call it `name`. */
json_t *page_picture_file(const char *name, uint8_t *file, size_t size, size_t bytes, struct glint_error *err);
/* VALUES of a source in at most `bytes`, if one pixel in 64 × 64 fits. */
json_t *page_values(const struct source *source, size_t bytes);
/* Adds a stage and returns its pictures, borrowed. */
json_t *page_stage(json_t *blocks, const char *title);
/* Adds a fold and returns its blocks, borrowed. */
json_t *page_fold(json_t *blocks, const char *title);
/* KEY of a false-colour picture; NULL for a legend that has only a title. */
json_t *page_key(const struct legend *legend);
/* A number as a cell; NaN and infinity in words. */
json_t *page_number(double value);

#endif
