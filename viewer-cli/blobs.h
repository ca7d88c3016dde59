/* Files that are built into the program. */
#ifndef GLINT_VIEWER_BLOBS_H
#define GLINT_VIEWER_BLOBS_H

#ifdef __cplusplus
extern "C" {
#endif
extern const unsigned char blob_font[], blob_font_end[]; /* DejaVuSans.ttf */
extern const unsigned char blob_ocio[], blob_ocio_end[]; /* glint.ocio */
#ifdef __cplusplus
}
#endif
#endif
