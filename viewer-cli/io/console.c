/* Wraps lines at the width of the terminal, and colours. */
#include "io/console.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* A stream to a terminal. A word is kept until it is known whether it fits into the line. */
struct wrapping {
    FILE *stream;
    int file;
    bool plain, leading, escape;
    size_t columns, column, indent, gap; /* gap: spaces that are written before the next word */
    char word[1024], out[8192];
    size_t length, width, filled; /* of the word, in bytes and columns; of `out` */
};

static struct wrapping wrappings[] = {{.file = STDOUT_FILENO, .leading = true},
                                      {.file = STDERR_FILENO, .leading = true}};

static size_t columns_of(int file) {
    struct winsize size = {0};
    return isatty(file) && ioctl(file, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

static int file_of(FILE *out) {
    return out == stdout ? STDOUT_FILENO : out == stderr ? STDERR_FILENO : -1;
}

size_t console_width(FILE *out) {
    return columns_of(file_of(out));
}

/* ---- Wrapping ---- */

static bool write_out(struct wrapping *w) {
    size_t done = 0;
    while (done < w->filled) {
        const ssize_t n = write(w->file, w->out + done, w->filled - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        done += (size_t)n;
    }
    w->filled = 0;
    return true;
}

static void put(struct wrapping *w, const char *text, size_t length) {
    if (w->filled + length > sizeof w->out) write_out(w);
    memcpy(w->out + w->filled, text, length);
    w->filled += length;
}

static void put_spaces(struct wrapping *w, size_t count) {
    for (; count; count--) put(w, " ", 1);
}

static void put_word(struct wrapping *w) {
    if (!w->length) return;
    if (w->columns && w->column > w->indent && w->column + w->gap + w->width > w->columns) {
        put(w, "\n", 1);
        w->column = w->indent;
        w->gap = w->indent;
    } else w->column += w->gap;
    put_spaces(w, w->gap);
    put(w, w->word, w->length);
    w->column += w->width;
    w->gap = w->length = w->width = 0;
}

static void add_space(struct wrapping *w) {
    const bool item = w->leading && w->length == 1 && w->word[0] == '-'; /* its text is indented, too */
    put_word(w);
    w->gap++;
    if ((w->leading && !w->column) || item) w->indent = w->column + w->gap;
    if (w->column) w->leading = false;
    if (w->indent > w->columns / 2) w->indent = w->columns / 2;
}

static void add(struct wrapping *w, char c) {
    if (c == '\n' || c == '\r') {
        put_word(w);
        put(w, &c, 1);
        w->column = w->indent = w->gap = 0;
        w->leading = true;
        return;
    }
    if (c == ' ' && !w->escape) {
        add_space(w);
        return;
    }
    if (w->length == sizeof w->word) put_word(w);
    w->word[w->length++] = c;
    const bool begins = c == '\033', final = w->escape && c >= '@' && c <= '~' && c != '[';
    if (!begins && !w->escape) w->width += ((unsigned char)c & 0xC0) != 0x80;
    w->escape = begins || (w->escape && !final);
}

static ssize_t write_wrapped(void *user, const char *text, size_t size) {
    struct wrapping *w = user;
    w->columns = w->plain ? 0 : columns_of(w->file);
    for (size_t i = 0; i < size; i++) add(w, text[i]);
    put_word(w);
    put_spaces(w, w->gap); /* of a line that goes on in the next call */
    w->column += w->gap;
    w->gap = 0;
    return write_out(w) ? (ssize_t)size : -1;
}

/* `mode` as of setvbuf: a bar on stderr shows at once. */
static void wrap(struct wrapping *w, FILE **stream, int mode) {
    if (!isatty(w->file)) return;
    FILE *wrapped = fopencookie(w, "w", (cookie_io_functions_t){.write = write_wrapped});
    if (!wrapped) return;
    setvbuf(wrapped, NULL, mode, mode == _IOLBF ? BUFSIZ : 0);
    fflush(*stream);
    *stream = w->stream = wrapped;
}

/* argp wraps --help at 79 columns, unless it is told otherwise. */
static void narrow_help(void) {
    const size_t columns = columns_of(STDOUT_FILENO);
    char format[80];
    if (!columns || columns >= 80) return;
    snprintf(format, sizeof format, "rmargin=%zu,opt-doc-col=%d,long-opt-col=4,usage-indent=4", columns - 1,
             columns < 60 ? 8 : 29);
    setenv("ARGP_HELP_FMT", format, 0);
}

void console_begin(void) {
    narrow_help();
    wrap(&wrappings[0], &stdout, _IOLBF);
    wrap(&wrappings[1], &stderr, _IONBF);
}

void console_plain(void) {
    fflush(stdout);
    wrappings[0].plain = true;
}

/* ---- Colours ---- */

const char *const console_colors[] = {"auto", "always", "never", NULL};
static int color_choice;

void console_choose_color(int choice) {
    color_choice = choice;
}

static bool has_color(FILE *out) {
    const char *no = getenv("NO_COLOR"), *kind = getenv("TERM");
    if (color_choice) return color_choice == 1 && file_of(out) >= 0;
    return file_of(out) >= 0 && isatty(file_of(out)) && !(no && *no) && !(kind && !strcmp(kind, "dumb"));
}

const char *mark_begin(FILE *out, enum mark mark) {
    static const char *const codes[] = {
        [MARK_TITLE] = "\033[1m", [MARK_GOOD] = "\033[32m", [MARK_WARN] = "\033[33m", [MARK_FAIL] = "\033[31m"};
    return mark && has_color(out) ? codes[mark] : "";
}

const char *mark_end(FILE *out, enum mark mark) {
    return mark && has_color(out) ? "\033[0m" : "";
}

void mark_print(enum mark mark, const char *format, ...) {
    va_list args;
    va_start(args, format);
    fputs(mark_begin(stdout, mark), stdout);
    vprintf(format, args);
    fputs(mark_end(stdout, mark), stdout);
    va_end(args);
}
