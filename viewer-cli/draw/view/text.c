/* Draws text on pictures through FreeType. */
#include "draw/view/text.h"

#include <stdlib.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H

#include "draw/blobs.h"

struct text {
    struct FT_MemoryRec_ memory;
    FT_Library library;
    FT_Face face;
};

/* FreeType does without some of what it has no memory for, such as a table of the font: io/memory.c notes that it had none. */
static void *take(FT_Memory memory, long bytes) {
    (void)memory;
    return malloc((size_t)bytes);
}

static void give_back(FT_Memory memory, void *block) {
    (void)memory;
    free(block);
}

static void *resize(FT_Memory memory, long before, long bytes, void *block) {
    (void)memory, (void)before;
    return realloc(block, (size_t)bytes);
}

struct text *text_create(uint32_t height_px, struct glint_error *err) {
    struct text *text = calloc(1, sizeof *text);
    if (!text) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    FT_Long size = (FT_Long)(blob_font_end - blob_font);
    text->memory = (struct FT_MemoryRec_){.alloc = take, .free = give_back, .realloc = resize};
    FT_Error failed = FT_New_Library(&text->memory, &text->library);
    if (!failed) FT_Add_Default_Modules(text->library);
    if (!failed) failed = FT_New_Memory_Face(text->library, blob_font, size, 0, &text->face);
    if (!failed) failed = FT_Set_Pixel_Sizes(text->face, 0, height_px);
    if (failed) {
        const bool memory = failed == FT_Err_Out_Of_Memory;
        glint_fail(err, memory ? GLINT_ERROR_MEMORY : GLINT_ERROR_UNSUPPORTED,
                   "FreeType cannot read the built-in font%s", memory ? ": out of memory" : "");
        text_destroy(&text);
    }
    return text;
}

void text_destroy(struct text **text) {
    if (!*text) return;
    if ((*text)->face) FT_Done_Face((*text)->face);
    if ((*text)->library) FT_Done_Library((*text)->library);
    free(*text);
    *text = NULL;
}

/* The next code point of UTF-8; invalid bytes are taken as code points. */
static FT_ULong next_character(const char **string) {
    const unsigned char *p = (const unsigned char *)*string;
    int more = *p >= 0xF0 ? 3 : *p >= 0xE0 ? 2 : *p >= 0xC0 ? 1 : 0;
    FT_ULong c = more == 3 ? *p & 0x07u : more == 2 ? *p & 0x0Fu : more == 1 ? *p & 0x1Fu : *p;
    p++;
    for (; more > 0 && (*p & 0xC0) == 0x80; more--) c = c << 6 | (*p++ & 0x3Fu);
    *string = (const char *)p;
    return c;
}

static void draw_glyph(const FT_GlyphSlot glyph, struct picture *picture, int x, int y, struct rgb color) {
    const FT_Bitmap *map = &glyph->bitmap;
    for (int j = 0; j < (int)map->rows; j++)
        for (int i = 0; i < (int)map->width; i++)
            picture_blend(picture, x + glyph->bitmap_left + i, y - glyph->bitmap_top + j, color,
                          map->buffer[j * map->pitch + i]);
}

static int walk(struct text *text, struct picture *picture, int x, int y, const char *string, struct rgb color) {
    int start = x;
    while (*string) {
        FT_ULong c = next_character(&string);
        if (FT_Load_Char(text->face, c, FT_LOAD_RENDER)) continue;
        if (picture) draw_glyph(text->face->glyph, picture, x, y, color);
        x += (int)(text->face->glyph->advance.x >> 6);
    }
    return x - start;
}

int text_measure(struct text *text, const char *string) {
    return walk(text, NULL, 0, 0, string, COLOR_TEXT);
}

void text_draw(struct text *text, struct picture *picture, int x, int y, const char *string, struct rgb color) {
    walk(text, picture, x, y, string, color);
}
