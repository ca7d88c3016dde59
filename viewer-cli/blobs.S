/* Files that are built into the program; GLINT_FONT and GLINT_OCIO are their paths. */
    .section .rodata
    .global blob_font, blob_font_end, blob_ocio, blob_ocio_end
    .balign 16
blob_font:
    .incbin GLINT_FONT
blob_font_end:
    .byte 0
blob_ocio:
    .incbin GLINT_OCIO
blob_ocio_end:
    .byte 0
    .section .note.GNU-stack, "", %progbits
