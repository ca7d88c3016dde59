/* Tables in the terminal. */
#include "io/table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

struct table {
    const char *const *titles;
    size_t columns, count, capacity;
    char **cells;
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
    for (size_t i = 0; i < (*table)->count; i++) free((*table)->cells[i]);
    free((*table)->cells);
    free(*table);
    *table = NULL;
}

void table_cell(struct table *t, const char *format, ...) {
    if (!t || t->failed) return;
    if (t->count == t->capacity) {
        size_t capacity = t->capacity ? 2 * t->capacity : 64;
        char **cells = realloc(t->cells, capacity * sizeof *cells);
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
        text_clean(text);
        t->cells[t->count++] = text;
    }
    va_end(args);
}

int terminal_width(void) {
    struct winsize size = {0};
    if (!isatty(STDOUT_FILENO) || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
    return size.ws_col;
}

/* The bytes of the UTF-8 sequence that begins here; 0 if it is none. */
static size_t sequence_length(const unsigned char *p) {
    const size_t length = *p < 0x80                 ? 1
                          : *p >= 0xC2 && *p < 0xE0 ? 2
                          : *p >= 0xE0 && *p < 0xF0 ? 3
                          : *p >= 0xF0 && *p < 0xF5 ? 4
                                                    : 0;
    for (size_t i = 1; i < length; i++)
        if ((p[i] & 0xC0) != 0x80) return 0;
    const bool overlong = (*p == 0xE0 && p[1] < 0xA0) || (*p == 0xF0 && p[1] < 0x90),
               none = (*p == 0xED && p[1] >= 0xA0) || (*p == 0xF4 && p[1] >= 0x90);
    return overlong || none ? 0 : length;
}

void text_clean(char *text) {
    size_t length;
    for (unsigned char *p = (unsigned char *)text; *p; p += length ? length : 1) {
        length = sequence_length(p);
        const bool high = p[0] == 0xC2 && length == 2 && p[1] < 0xA0; /* C1 controls in UTF-8 */
        if (!length || *p < 0x20 || *p == 0x7F || high) *p = '?';
        if (high) p[1] = '?';
    }
}

size_t text_width(const char *text) {
    size_t n = 0;
    for (; *text; text++) n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

static void pad(FILE *out, size_t n) {
    while (n--) fputc(' ', out);
}

/* Prints `text` in lines of at most `room` columns, broken at spaces; all but the first are indented. */
static void print_wrapped(FILE *out, const char *text, size_t indent, size_t room) {
    while (text_width(text) > room) {
        const char *cut = NULL;
        size_t columns = 0;
        for (const char *p = text; *p && columns <= room; p++) {
            if (*p == ' ') cut = p;
            columns += ((unsigned char)*p & 0xC0) != 0x80;
        }
        if (!cut || cut == text) break;
        fprintf(out, "%.*s\n", (int)(cut - text), text);
        pad(out, indent);
        text = cut + 1;
    }
    fprintf(out, "%s\n", text);
}

static void print_row(FILE *out, const struct table *t, const char *const *row, const size_t *widths, size_t room,
                      bool titles) {
    size_t indent = 0,
           gap = 0; /* pending spaces, which are written before the next text only, never at the end of a line */
    for (size_t i = 0; i < t->columns; i++) {
        const char *text = row[i] + (titles ? 1 : 0);
        size_t fill = widths[i] - text_width(text);
        bool last = i + 1 == t->columns, right = t->titles[i][0] == '>';
        if (right) gap += fill;
        if (*text) {
            pad(out, gap);
            gap = 0;
        }
        if (last) print_wrapped(out, text, indent, room > indent + 20 ? room - indent : SIZE_MAX);
        else fputs(text, out);
        gap += (right ? 0 : fill) + 2;
        indent += widths[i] + 2;
    }
}

bool table_print(const struct table *t, FILE *out) {
    if (!t || t->failed || t->columns == 0) return false;
    size_t *widths = calloc(t->columns, sizeof *widths);
    if (!widths) return false;
    for (size_t i = 0; i < t->columns; i++) widths[i] = text_width(t->titles[i] + 1);
    for (size_t i = 0; i < t->count; i++) {
        size_t width = text_width(t->cells[i]), column = i % t->columns;
        if (width > widths[column]) widths[column] = width;
    }
    int columns = terminal_width();
    size_t room = columns > 0 ? (size_t)columns : SIZE_MAX;
    print_row(out, t, t->titles, widths, room, true);
    for (size_t i = 0; i + t->columns <= t->count; i += t->columns)
        print_row(out, t, (const char *const *)&t->cells[i], widths, room, false);
    free(widths);
    return true;
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
        print_markdown_cell(out, t->cells[i]);
    }
    fputc('\n', out);
    return true;
}

/* A ring of buffers, so that one printf can use several results. */
static char *next_buffer(void) {
    static char buffers[8][48];
    static unsigned turn;
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
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', out);
        fputc(*text, out);
    }
    fputc('"', out);
}
