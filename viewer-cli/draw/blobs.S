/* Files that are built into the program; what starts with GLINT_ are their paths. */
#define BLOB(name, file)    \
    .global name, name##_end; \
    .balign 16;             \
    name: .incbin file;     \
    name##_end: .byte 0;

    .section .rodata
BLOB(blob_font, GLINT_FONT)
BLOB(blob_ocio, GLINT_OCIO)
BLOB(blob_page_head, GLINT_PAGE_HEAD)
BLOB(blob_page_scripts, GLINT_PAGE_SCRIPTS)
BLOB(blob_live_head, GLINT_LIVE_HEAD)
BLOB(blob_live_scripts, GLINT_LIVE_SCRIPTS)
BLOB(blob_echarts, GLINT_ECHARTS)
BLOB(blob_echarts_code, GLINT_ECHARTS_CODE)
BLOB(blob_chart, GLINT_CHART)
    .section .note.GNU-stack, "", %progbits
