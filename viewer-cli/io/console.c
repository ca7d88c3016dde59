/* Shows hidden characters, wraps lines at the width of the terminal, and colours. */
#include "io/console.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "shown.h"

/* A stream to a file or a terminal. On terminals a word is kept until it is known whether it fits into the line. */
struct wrapping {
    FILE *stream;
    int file;
    bool terminal, plain, leading, escape, failed, goes_on; /* goes_on: the word is not at its end yet */
    size_t columns, column, indent, gap;                    /* gap: spaces that are written before the next word */
    char cut[4], word[1024], out[8192];                     /* cut: a character's first bytes */
    size_t cut_length, length, width, filled;               /* of the word, in bytes and columns; of `out` */
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

static bool write_all(int file, const char *text, size_t size) {
    for (ssize_t n; size; text += n, size -= (size_t)n) {
        while ((n = write(file, text, size)) < 0 && errno == EINTR) {
        }
        if (n <= 0) return false;
    }
    return true;
}

static bool write_out(struct wrapping *w) {
    if (!write_all(w->file, w->out, w->filled)) w->failed = true;
    w->filled = 0;
    return !w->failed;
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

/* The next byte of a text; a character is written when it is whole. */
static void take(struct wrapping *w, char c) {
    char piece[SHOWN_PIECE] = "";
    w->cut[w->cut_length++] = c;
    for (size_t taken; w->cut_length; w->cut_length -= taken) {
        taken = 1;
        if (w->cut[0] == '\n') strcpy(piece, "\n");
        else if (!(taken = shown_piece(w->cut, w->cut_length, piece))) return;
        if (!w->terminal) put(w, piece, strlen(piece));
        for (const char *p = piece; w->terminal && *p; p++) add(w, *p);
        memmove(w->cut, w->cut + taken, w->cut_length - taken);
    }
}

static ssize_t write_shown(void *user, const char *text, size_t size) {
    struct wrapping *w = user;
    if (w->plain) return write_out(w) && write_all(w->file, text, size) ? (ssize_t)size : 0;
    w->columns = w->terminal ? columns_of(w->file) : 0;
    for (size_t i = 0; i < size; i++) take(w, text[i]);
    if (!w->goes_on) {
        put_word(w);
        put_spaces(w, w->gap); /* of a line that goes on in the next call */
        w->column += w->gap;
        w->gap = 0;
    }
    return write_out(w) ? (ssize_t)size : 0;
}

/* `mode` as of setvbuf: what is said on stderr shows at once. */
static bool wrap(struct wrapping *w, FILE **stream, int mode) {
    w->terminal = isatty(w->file);
    w->stream = fopencookie(w, "w", (cookie_io_functions_t){.write = write_shown});
    if (!w->stream) return false;
    setvbuf(w->stream, NULL, mode, mode == _IONBF ? 0 : BUFSIZ);
    fflush(*stream);
    *stream = w->stream;
    return true;
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

bool console_begin(void) {
    narrow_help();
    return wrap(&wrappings[0], &stdout, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF) &&
           wrap(&wrappings[1], &stderr, _IONBF);
}

void console_end(void) {
    for (size_t i = 0; i < 2; i++) {
        put_word(&wrappings[i]);
        write_out(&wrappings[i]);
    }
}

void console_plain(bool plain) {
    fflush(stdout);
    put_word(&wrappings[0]);
    write_out(&wrappings[0]);
    wrappings[0].plain = plain;
}

void console_code(FILE *out, const char *code) {
    struct wrapping *w = &wrappings[out == stderr];
    w->goes_on = true;
    fflush(out);
    w->goes_on = false;
    for (const char *c = code; *c; c++)
        if (w->terminal) add(w, *c);
        else put(w, c, 1);
    if (w->width) return; /* the code belongs to a word */
    put_word(w);
    write_out(w);
}

const char *name_text(const char *name) {
    enum { NAMES = 8 };
    static _Thread_local char *names[NAMES];
    static _Thread_local unsigned turn;
    if (!name || shown_is_plain(name)) return name;
    char **kept = &names[turn++ % NAMES];
    free(*kept);
    *kept = shown_copy(name);
    return *kept ? *kept : "?";
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

void mark_begin(FILE *out, enum mark mark) {
    static const char *const codes[] = {
        [MARK_TITLE] = "\033[1m", [MARK_GOOD] = "\033[32m", [MARK_WARN] = "\033[33m", [MARK_FAIL] = "\033[31m"};
    if (mark && has_color(out)) console_code(out, codes[mark]);
}

void mark_end(FILE *out, enum mark mark) {
    if (mark && has_color(out)) console_code(out, "\033[0m");
}

void mark_print(enum mark mark, const char *format, ...) {
    va_list args;
    va_start(args, format);
    mark_begin(stdout, mark);
    vprintf(format, args);
    mark_end(stdout, mark);
    va_end(args);
}
