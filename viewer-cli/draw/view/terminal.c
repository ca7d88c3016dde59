/* Draws pictures in the terminal. */
#include "draw/view/terminal.h"

#include <chafa.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "io/console.h"

const char *const terminal_mode_names[] = {"auto", "kitty", "sixel", "iterm2", "blocks", NULL};

enum { COLUMNS = 80, ROWS = 24, CELL_WIDTH_PX = 8, CELL_HEIGHT_PX = 16 };

struct area {
    int columns, rows, cell_width_px, cell_height_px;
};

static struct area area_of(int file) {
    struct area area = {COLUMNS, ROWS, CELL_WIDTH_PX, CELL_HEIGHT_PX};
    struct winsize size;
    if (ioctl(file, TIOCGWINSZ, &size) != 0 || !size.ws_col || !size.ws_row) return area;
    area.columns = size.ws_col;
    area.rows = size.ws_row;
    if (size.ws_xpixel >= size.ws_col && size.ws_ypixel >= size.ws_row) {
        area.cell_width_px = size.ws_xpixel / size.ws_col;
        area.cell_height_px = size.ws_ypixel / size.ws_row;
    }
    return area;
}

static ChafaPixelMode pixel_mode(enum terminal_mode mode, const ChafaTermInfo *info) {
    if (mode == TERMINAL_KITTY) return CHAFA_PIXEL_MODE_KITTY;
    if (mode == TERMINAL_SIXEL) return CHAFA_PIXEL_MODE_SIXELS;
    if (mode == TERMINAL_ITERM2) return CHAFA_PIXEL_MODE_ITERM2;
    if (mode == TERMINAL_BLOCKS) return CHAFA_PIXEL_MODE_SYMBOLS;
    if (chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_BEGIN_KITTY_IMMEDIATE_IMAGE_V1)) return CHAFA_PIXEL_MODE_KITTY;
    if (chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_BEGIN_ITERM2_IMAGE)) return CHAFA_PIXEL_MODE_ITERM2;
    return chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_BEGIN_SIXELS) ? CHAFA_PIXEL_MODE_SIXELS
                                                                       : CHAFA_PIXEL_MODE_SYMBOLS;
}

/* Pixel protocols need true colour; blocks use what the terminal supports. */
static ChafaCanvasMode color_mode(ChafaPixelMode pixels, enum terminal_mode mode, const ChafaTermInfo *info) {
    if (pixels != CHAFA_PIXEL_MODE_SYMBOLS || mode == TERMINAL_BLOCKS) return CHAFA_CANVAS_MODE_TRUECOLOR;
    if (chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_DIRECT)) return CHAFA_CANVAS_MODE_TRUECOLOR;
    return chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_256) ? CHAFA_CANVAS_MODE_INDEXED_240
                                                                             : CHAFA_CANVAS_MODE_INDEXED_16;
}

static ChafaCanvasConfig *configure(const struct picture *picture, enum terminal_mode mode,
                                    const ChafaTermInfo *known) {
    const struct area area = area_of(STDOUT_FILENO);
    ChafaCanvasConfig *config = chafa_canvas_config_new();
    const ChafaPixelMode pixels = pixel_mode(mode, known);
    ChafaSymbolMap *symbols = chafa_symbol_map_new();
    gint columns = area.columns, rows = area.rows > 2 ? area.rows - 1 : area.rows; /* leaves a line for the prompt */
    chafa_calc_canvas_geometry((gint)picture->width, (gint)picture->height, &columns, &rows,
                               (gfloat)area.cell_width_px / (gfloat)area.cell_height_px, TRUE, FALSE);
    chafa_symbol_map_add_by_tags(symbols, CHAFA_SYMBOL_TAG_BLOCK | CHAFA_SYMBOL_TAG_SPACE);
    chafa_canvas_config_set_symbol_map(config, symbols);
    chafa_canvas_config_set_geometry(config, columns, rows);
    chafa_canvas_config_set_cell_geometry(config, area.cell_width_px, area.cell_height_px);
    chafa_canvas_config_set_pixel_mode(config, pixels);
    chafa_canvas_config_set_canvas_mode(config, color_mode(pixels, mode, known));
    chafa_canvas_config_set_work_factor(config, 1);
    chafa_symbol_map_unref(symbols);
    return config;
}

bool terminal_draw(const struct picture *picture, enum terminal_mode mode, struct glint_error *err) {
    char **environment = g_get_environ();
    ChafaTermDb *database = chafa_term_db_get_default();
    ChafaTermInfo *info = chafa_term_db_detect(database, environment),
                  *rest = chafa_term_db_get_fallback_info(database);
    ChafaCanvasConfig *config = configure(picture, mode, info);
    ChafaCanvas *canvas = chafa_canvas_new(config);
    /* enables modes that the user requests although the terminal is not known to support them */
    chafa_term_info_supplement(info, rest);
    chafa_canvas_draw_all_pixels(canvas, CHAFA_PIXEL_RGBA8_UNASSOCIATED, picture->rgba, (gint)picture->width,
                                 (gint)picture->height, (gint)picture->width * 4);
    console_plain(true);
    GString *text = chafa_canvas_print(canvas, info);
    const bool ok =
        fwrite(text->str, 1, text->len, stdout) == text->len && fputc('\n', stdout) != EOF && fflush(stdout) == 0;
    console_plain(false);
    g_string_free(text, TRUE);
    chafa_term_info_unref(rest);
    chafa_term_info_unref(info);
    g_strfreev(environment);
    chafa_canvas_unref(canvas);
    chafa_canvas_config_unref(config);
    return ok || glint_fail(err, GLINT_ERROR_IO, "stdout: cannot write");
}
