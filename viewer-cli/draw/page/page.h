/* Reports as one self-contained HTML page, and charts as SVG files, both from one description.

   A document is JSON:
     {"format": 1, "title": T,
      "facts": [[NAME, CELL], …]            provenance: tool, device, capture, command line
      "sections": [{"title": T, "blocks": [BLOCK, …]}, …]}
   BLOCK, one of
     {"text": T}  {"heading": T}  {"note": T}  {"code": T}  prose; a title within the section; a warning; a command line or JSON as it stands
     {"table": {"columns": [{"name": T, "unit": T, "help": T, "decimals": N, "bar": BOOL}, …], "rows": [[CELL, …], …]}}
                                             bar: numbers also as bars in their cells
     {"pictures": [PICTURE, …], "columns": N}
                                             N in a row (default: as fit); one enlarged flips to the next in place
     {"stage": {"title": T, "pictures": [SHOWN, …]}}
                                             pictures over each other: a slider between two, both beside each other or in
                                             turns, one alone, and the values under the pointer
     {"chart": CHART}
   A document's "refresh", in seconds: the page loads itself again, as long as nobody is working with it.
   CELL: text, number, boolean, null (not known), or {"value": number, "low": L, "high": H, "text": T}: with an interval, or
   shown as T and sorted by value.
   PICTURE: {"file": F, "caption": T}. F: a PNG in the document's folder, or what page_picture gave.
   SHOWN: a PICTURE with "values": VALUES, or none; "alone": BOOL, it is not one of those that are compared (a heat map).
   VALUES: {"channels": [T, …], "unit": T, "width": PX, "height": PX, "every": N, "data": what page_values gave}
                                             every N-th pixel's, where more would be too much
   CHART:
     {"title": T, "x": AXIS, "y": AXIS, "series": [SERIES, …], "marks": [MARK, …], "width": PX, "height": PX}
   AXIS: {"name": T, "unit": T, "scale": "linear" (default), "log" or "category", "min": A, "max": B, "ticks": [number, …],
          "categories": [T, …]}                a category axis in y makes bars lie
   SERIES: {"name": T, "kind": "scatter", "line", "bar" or "front" (points joined by the staircase of what they offer
            at a cost x), "stack": T (bars of one name stand on each other), "muted": BOOL (greyed: others
            matter more), "points": [POINT, …]}
   POINT: [x, y], or {"x": X, "y": Y, "x_low", "x_high", "low", "high": intervals, "name": T,
          "values": [[NAME, CELL, UNIT], …], "pictures": [PICTURE, …]}; kept together with those of its name in other charts
                                             what the page shows of a point that is pointed at, clicked or reached by keys
          x (y of lying bars) of a category axis: the category's place from 0.
   MARK: {"x": X} or {"y": Y}: a line across; {"x": X, "y": Y}: a point; with "label": T.
   Points at or below zero of a logarithmic axis are left out, and the page counts them. Unknown members are ignored.

   Every text may come from a stranger's file: pages show texts as texts, run no script but their own and fetch nothing. */
#ifndef GLINT_VIEWER_PAGE_H
#define GLINT_VIEWER_PAGE_H

#include <jansson.h>

#include "draw/view/picture.h"
#include "draw/view/source.h"

/* ---- Writing; files appear complete or not at all ---- */

/* PAGE_PICTURE_BYTES for all pictures of a page together: each keeps its PNG if that fits its share, else it becomes a
   JPEG and then a smaller one. */
enum { PAGE_PICTURE_BYTES = 14000000 };

enum { PAGE_VALUE_BYTES = 16000000 }; /* for the values of all pixels of a page */

/* The document as HTML. Pictures' files are looked for below `folder`, never outside of it; NULL: there are none. One that
   cannot be read is an error. */
bool page_write(const char *path, const json_t *document, const char *folder, struct glint_error *err);
/* A CHART as SVG; takes some 0.4 s, whatever it shows. */
bool page_chart_write(const char *path, const json_t *chart, struct glint_error *err);
/* FOLDER/page.json, which `glint report FOLDER` renders again. */
bool page_store(const char *folder, const json_t *document, struct glint_error *err);
/* A stored document; NULL on failure. */
json_t *page_load(const char *folder, struct glint_error *err);

/* ---- Putting documents together. When memory is short, nothing is added, and page_write or page_store fails ---- */

/* A document with its title and, as the first fact, the tool's version; the caller releases it. */
json_t *page_create(const char *title);
void page_fact(json_t *document, const char *name, const char *value);
/* A new section's blocks, borrowed. */
json_t *page_section(json_t *document, const char *title);
void page_text(json_t *blocks, const char *kind, const char *text); /* kind: "text", "heading", "note", "code" */
void page_chart(json_t *blocks, json_t *chart);                     /* takes the chart */
/* A new table, borrowed. */
json_t *page_table(json_t *blocks);
/* Unit "" for none; '|' before it: its numbers also as bars. */
void page_column(json_t *table, const char *name, const char *unit);
/* Takes the row, an array of cells. */
void page_row(json_t *table, json_t *row);
/* A number with its interval. */
json_t *page_interval(double value, double low, double high);
/* A picture as a text for "file", no longer than `bytes` of image; NULL on failure. */
json_t *page_picture(const struct picture *picture, size_t bytes, struct glint_error *err);
/* The same of a PNG or JPEG file's bytes, which errors call `name`. */
json_t *page_picture_file(const char *name, uint8_t *file, size_t size, size_t bytes, struct glint_error *err);
/* VALUES of a source, no longer than `bytes` if keeping one pixel of 64 × 64 comes to that. */
json_t *page_values(const struct source *source, size_t bytes);
/* A new stage's pictures, borrowed. */
json_t *page_stage(json_t *blocks, const char *title);

#endif
