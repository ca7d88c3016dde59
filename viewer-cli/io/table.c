/* Tables in the terminal. */
#include "io/table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "shown.h"

struct cell {
    char *text;
    enum mark mark;
};

struct table {
    const char *const *titles;
    size_t columns, count, capacity;
    struct cell *cells;
    bool failed;
};

struct table *table_create(const char *const *titles) {
    struct table *t = calloc(1, sizeof *t);
    if (!t) return NULL;
    t->titles = titles;
    while (titles[t->columns]) t->columns++;
    return t;
}

void table_destroy(struct table **table) {
    if (!*table) return;
    for (size_t i = 0; i < (*table)->count; i++) free((*table)->cells[i].text);
    free((*table)->cells);
    free(*table);
    *table = NULL;
}

void table_cell(struct table *t, const char *format, ...) {
    if (!t || t->failed) return;
    if (t->count == t->capacity) {
        size_t capacity = t->capacity ? 2 * t->capacity : 64;
        struct cell *cells = realloc(t->cells, capacity * sizeof *cells);
        if (!cells) {
            t->failed = true;
            return;
        }
        t->cells = cells;
        t->capacity = capacity;
    }
    va_list args;
    va_start(args, format);
    char *text = NULL;
    if (vasprintf(&text, format, args) < 0) t->failed = true;
    else {
        char *shown = shown_copy(text);
        free(text);
        t->failed = !shown;
        if (shown) t->cells[t->count++] = (struct cell){.text = shown};
    }
    va_end(args);
}

void table_mark(struct table *t, enum mark mark) {
    if (t && !t->failed && t->count) t->cells[t->count - 1].mark = mark;
}

size_t text_width(const char *text) {
    size_t n = 0;
    for (; *text; text++) n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

/* The part of `text` that fits into `width` columns, in bytes, broken at a space if there is one; *next: where the rest begins. */
static size_t fitting(const char *text, size_t width, const char **next) {
    size_t columns = 0, space = 0, bytes = 0;
    bool word = false;
    for (; text[bytes]; bytes++) {
        const bool begins = ((unsigned char)text[bytes] & 0xC0) != 0x80;
        if (text[bytes] == ' ' && word) space = bytes; /* not an indent */
        word |= text[bytes] != ' ';
        if (begins && columns == width) break;
        columns += begins;
    }
    if (text[bytes] && space) bytes = space;
    *next = text + bytes;
    while (**next == ' ') (*next)++;
    return bytes;
}

/* The width of the longest word. */
static size_t longest_word(const char *text) {
    size_t longest = 0, columns = 0;
    for (; *text; text++) {
        columns = *text == ' ' ? 0 : columns + (((unsigned char)*text & 0xC0) != 0x80);
        if (columns > longest) longest = columns;
    }
    return longest;
}

static bool is_right(const struct table *t, size_t column) {
    return t->titles[column][0] == '>';
}

struct layout {
    size_t *widths, *least; /* of each column: what it takes, and what it needs when its texts are wrapped */
    size_t room;            /* columns of the terminal */
};

/* Numbers are not wrapped, texts and titles are. */
static void measure(const struct table *t, const struct layout *layout) {
    enum { TEXT = 16 }; /* narrower texts are hard to read */
    for (size_t c = 0; c < t->columns; c++) {
        const char *title = t->titles[c] + 1;
        size_t width = text_width(title), least = longest_word(title);
        for (size_t i = c; i < t->count; i += t->columns) {
            const size_t own = text_width(t->cells[i].text);
            size_t word = is_right(t, c) ? own : longest_word(t->cells[i].text);
            if (!is_right(t, c) && word < TEXT) word = own < TEXT ? own : TEXT;
            if (own > width) width = own;
            if (word > least) least = word;
        }
        if (!is_right(t, c) && least > layout->room / 2) least = layout->room / 2;
        layout->widths[c] = width;
        layout->least[c] = least < width ? least : width;
    }
}

static size_t sum_of(const size_t *widths, const bool *shown, size_t count) {
    size_t sum = 0;
    for (size_t c = 0; c < count; c++)
        if (shown[c]) sum += widths[c] + 2;
    return sum ? sum - 2 : 0;
}

/* Narrows the widest column again and again until the shown ones fit, or cannot be narrowed. */
static void narrow(const struct table *t, const struct layout *layout, const bool *shown, size_t *widths) {
    memcpy(widths, layout->widths, t->columns * sizeof *widths);
    while (sum_of(widths, shown, t->columns) > layout->room) {
        size_t widest = t->columns;
        for (size_t c = 0; c < t->columns; c++)
            if (shown[c] && widths[c] > layout->least[c] && (widest == t->columns || widths[c] > widths[widest]))
                widest = c;
        if (widest == t->columns) return;
        widths[widest]--;
    }
}

/* Prints what fits of each shown cell of a row, and advances the texts behind that; false when nothing is left. */
static bool print_line(FILE *out, const struct table *t, const bool *shown, const size_t *widths, const char **texts,
                       const enum mark *marks) {
    bool more = false;
    size_t gap = 0; /* spaces that are written before the next text only, never at the end of a line */
    for (size_t c = 0; c < t->columns; c++) {
        if (!shown[c]) continue;
        const char *next, *text = texts[c];
        const size_t bytes = fitting(text, widths[c], &next);
        size_t columns = 0;
        for (size_t i = 0; i < bytes; i++) columns += ((unsigned char)text[i] & 0xC0) != 0x80;
        const size_t fill = widths[c] > columns ? widths[c] - columns : 0;
        if (is_right(t, c)) gap += fill;
        if (bytes) {
            fprintf(out, "%*s", (int)gap, "");
            mark_begin(out, marks[c]);
            fprintf(out, "%.*s", (int)bytes, text);
            mark_end(out, marks[c]);
            gap = 0;
        }
        gap += (is_right(t, c) ? 0 : fill) + 2;
        texts[c] = next;
        more |= *next != 0;
    }
    fputc('\n', out);
    return more;
}

/* Rows of the shown columns; `line` and `marks` have room for a row. */
static void print_rows(FILE *out, const struct table *t, const bool *shown, const size_t *widths, const char **line,
                       enum mark *marks) {
    bool titled = false;
    for (size_t c = 0; c < t->columns; c++) {
        line[c] = t->titles[c] + 1;
        marks[c] = MARK_TITLE;
        titled |= shown[c] && *line[c];
    }
    while (titled && print_line(out, t, shown, widths, line, marks)) {
    }
    for (size_t i = 0; i + t->columns <= t->count; i += t->columns) {
        for (size_t c = 0; c < t->columns; c++) line[c] = t->cells[i + c].text, marks[c] = t->cells[i + c].mark;
        while (print_line(out, t, shown, widths, line, marks)) {
        }
    }
}

/* How many columns name a row: the first, and the texts after it as long as half of the terminal is left. */
static size_t key_columns(const struct table *t, const struct layout *layout) {
    size_t keys = 1, width = layout->least[0];
    while (keys + 1 < t->columns && !is_right(t, keys) && width + layout->least[keys] + 2 <= layout->room / 2)
        width += layout->least[keys++] + 2;
    return keys;
}

/* A table that is too wide is printed in several parts, each with the columns that name its rows. */
static void print_parts(FILE *out, const struct table *t, const struct layout *layout, bool *shown, size_t *widths,
                        const char **line, enum mark *marks) {
    const size_t keys = key_columns(t, layout);
    for (size_t c = 0; c < t->columns; c++) shown[c] = true;
    if (sum_of(layout->least, shown, t->columns) <= layout->room || keys == t->columns) {
        narrow(t, layout, shown, widths);
        print_rows(out, t, shown, widths, line, marks);
        return;
    }
    for (size_t from = keys, to; from < t->columns; from = to) {
        for (size_t c = 0; c < t->columns; c++) shown[c] = c < keys;
        for (to = from; to < t->columns; to++) {
            shown[to] = true;
            if (to > from && sum_of(layout->least, shown, t->columns) > layout->room) {
                shown[to] = false;
                break;
            }
        }
        if (from > keys) fputc('\n', out);
        narrow(t, layout, shown, widths);
        print_rows(out, t, shown, widths, line, marks);
    }
}

bool table_print(const struct table *t, FILE *out) {
    if (!t || t->failed || t->columns == 0) return false;
    const size_t n = t->columns, room = console_width(out);
    const struct layout layout = {calloc(n, sizeof(size_t)), calloc(n, sizeof(size_t)), room ? room : 1000000};
    size_t *widths = calloc(n, sizeof *widths);
    const char **line = calloc(n, sizeof *line);
    enum mark *marks = calloc(n, sizeof *marks);
    bool *shown = calloc(n, sizeof *shown);
    const bool ok = layout.widths && layout.least && widths && line && marks && shown;
    if (ok && t->count) {
        measure(t, &layout);
        print_parts(out, t, &layout, shown, widths, line, marks);
    }
    free(layout.widths);
    free(layout.least);
    free(widths);
    free(line);
    free(marks);
    free(shown);
    return ok;
}

bool table_is_empty(const struct table *t) {
    return !t || t->count == 0;
}

static void print_markdown_cell(FILE *out, const char *text) {
    for (; *text; text++) {
        if (*text == '|') fputc('\\', out);
        fputc(*text, out);
    }
    fputs(" |", out);
}

bool table_print_markdown(const struct table *t, FILE *out) {
    if (!t || t->failed || t->columns == 0) return false;
    fputc('|', out);
    for (size_t i = 0; i < t->columns; i++) {
        fputc(' ', out);
        print_markdown_cell(out, t->titles[i] + 1);
    }
    fputs("\n|", out);
    for (size_t i = 0; i < t->columns; i++) fputs(t->titles[i][0] == '>' ? " ---: |" : " --- |", out);
    for (size_t i = 0; i < t->count; i++) {
        fputs(i % t->columns ? " " : "\n| ", out);
        print_markdown_cell(out, t->cells[i].text);
    }
    fputc('\n', out);
    return true;
}

/* A ring of buffers, so that one printf can use several results. */
static char *next_buffer(void) {
    static _Thread_local char buffers[8][48];
    static _Thread_local unsigned turn;
    return buffers[turn++ % 8];
}

const char *time_text(double seconds) {
    char *text = next_buffer();
    if (seconds < 1e-3) snprintf(text, 48, "%.1f µs", seconds * 1e6);
    else if (seconds < 1) snprintf(text, 48, "%.2f ms", seconds * 1e3);
    else snprintf(text, 48, "%.2f s", seconds);
    return text;
}

const char *bytes_text(uint64_t bytes) {
    static const char *const units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    char *text = next_buffer();
    double value = (double)bytes;
    size_t unit = 0;
    for (; value >= 1024 && unit < 4; unit++) value /= 1024;
    snprintf(text, 48, "%.*f %s", unit == 0 || value >= 100 ? 0 : 1, value, units[unit]);
    return text;
}

const char *number_text(double value) {
    char *text = next_buffer();
    if (isnan(value)) snprintf(text, 48, "nan");
    else if (isinf(value)) snprintf(text, 48, value > 0 ? "∞" : "−∞");
    else snprintf(text, 48, "%.4g", value);
    return text;
}

void csv_text(FILE *out, const char *text) {
    const char *shown = name_text(text);
    fputs(strchr("=+-@", *shown) && *shown ? "\"'" : "\"", out);
    for (; *shown; shown++) {
        if (*shown == '"') fputc('"', out);
        fputc(*shown, out);
    }
    fputc('"', out);
}
