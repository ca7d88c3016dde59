/* Tables in the terminal: aligned columns. Where the terminal is too narrow, texts are wrapped, and if that is not enough, the columns are
   printed in several parts. */
#ifndef GLINT_VIEWER_TABLE_H
#define GLINT_VIEWER_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "io/console.h"

struct table;

/* Titles start with '<' (left) or '>' (right aligned), NULL-terminated. Returns NULL when out of memory; all calls then
   do nothing, and table_print returns false. */
struct table *table_create(const char *const *titles);
void table_destroy(struct table **table);
/* Appends the next cell, row by row, its hidden characters escaped (shown.h). */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void table_cell(struct table *table, const char *format, ...);
/* Colours the last cell. */
void table_mark(struct table *table, enum mark mark);
/* `out` is stdout or stderr. Nothing is printed of an empty table, nor titles that are all empty. */
bool table_print(const struct table *table, FILE *out);
bool table_print_markdown(const struct table *table, FILE *out);
bool table_is_empty(const struct table *table);

/* The number of columns of a UTF-8 text. */
size_t text_width(const char *text);

/* "12.3 ms", "456 µs", "1.20 s". In static storage, valid for a few calls. */
const char *time_text(double seconds);
/* "1.5 GiB" */
const char *bytes_text(uint64_t bytes);
/* A number with at most four significant digits. */
const char *number_text(double value);

/* Writes a text as a quoted cell of CSV. Hidden characters are escaped, and what a spreadsheet would take as a formula begins with an apostrophe. */
void csv_text(FILE *out, const char *text);

#endif
