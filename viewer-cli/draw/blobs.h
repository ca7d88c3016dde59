/* Files that are embedded in the program. */
#ifndef GLINT_VIEWER_BLOBS_H
#define GLINT_VIEWER_BLOBS_H

#ifdef __cplusplus
extern "C" {
#endif
extern const unsigned char blob_font[], blob_font_end[]; /* DejaVuSans.ttf */
extern const unsigned char blob_ocio[], blob_ocio_end[]; /* glint.ocio */
/* A page up to its document, and what follows that and ECharts. */
extern const unsigned char blob_page_head[], blob_page_head_end[];
extern const unsigned char blob_page_scripts[], blob_page_scripts_end[];
extern const unsigned char blob_live_head[], blob_live_head_end[];
extern const unsigned char blob_live_scripts[], blob_live_scripts_end[];
extern const unsigned char blob_echarts[], blob_echarts_end[];           /* Apache ECharts */
extern const unsigned char blob_echarts_code[], blob_echarts_code_end[]; /* its bytecode, for Duktape */
extern const unsigned char blob_chart[], blob_chart_end[];               /* page/chart.js */
#ifdef __cplusplus
}
#endif
#endif
