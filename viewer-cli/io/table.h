/* Tables for people: columns aligned, the last one wrapped at the terminal's width. */
#ifndef GLINT_VIEWER_TABLE_H
#define GLINT_VIEWER_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct table;

/* Titles start with '<' (left) or '>' (right aligned), NULL-terminated. NULL when memory is short: every call then does
   nothing and table_print returns false. */
struct table *table_create(const char *const *titles);
void table_destroy(struct table **table);
/* Appends the next cell, row by row. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void table_cell(struct table *table, const char *format, ...);
bool table_print(const struct table *table, FILE *out);
bool table_print_markdown(const struct table *table, FILE *out);
bool table_is_empty(const struct table *table);

/* How many columns the terminal on stdout has; 0 when it is none. */
int terminal_width(void);
/* Columns that a UTF-8 text takes. */
size_t text_width(const char *text);
/* Names in files are written by strangers: replaces control characters, which a terminal would obey. */
void text_clean(char *text);

/* "12.3 ms", "456 µs", "1.20 s"; static storage for a few calls within one expression. */
const char *time_text(double seconds);
/* "1.5 GiB" */
const char *bytes_text(uint64_t bytes);
/* A number in as few digits as it needs, at most four significant ones. */
const char *number_text(double value);

#endif
