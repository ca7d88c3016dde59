/* A manifest in memory: its values with their keys and lines. */
#ifndef GLINT_PACK_NODE_H
#define GLINT_PACK_NODE_H

#include <jansson.h>
#include <stdint.h>

#include "glint/pack.h"

/* Errors that do not stop the reading, so that all can be told together. */
enum { FAULTS_MAX = 20 };
struct faults {
    size_t count;
    struct glint_error first;
    char *more[FAULTS_MAX - 1];
};

struct manifest {
    const char *path; /* the caller's */
    const char *own;  /* a file that the caller named, and that may lie anywhere; or NULL */
    char *text;
    size_t size;
    json_t *root;
    const struct glint_pack_options *options; /* the caller's */
    struct faults *faults;                    /* the caller's */
};

/* A value and the way to it. Nodes live on the stack of those who read; a parent must outlive its children. */
struct node {
    const struct manifest *manifest;
    const struct node *parent; /* NULL: the whole manifest */
    const char *key;           /* in an object, */
    size_t index;              /* or in a list */
    json_t *value;             /* NULL: nothing was said */
};

struct node node_root(const struct manifest *manifest);
struct node node_child(const struct node *parent, const char *key);
struct node node_item(const struct node *parent, size_t index);
/* "parts.gbuffer.normal.X" */
const char *node_path(const struct node *node, char text[512]);
/* The line of the value, or of the nearest value around it that was said. */
unsigned node_line(const struct node *node);

/* "FILE:LINE: PATH: MESSAGE". Returns false. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
bool node_fail(const struct node *node, struct glint_error *err, enum glint_code code, const char *format, ...);
/* Puts file, line and path before the message of an error that something below reported. Returns false. */
bool node_wrap(const struct node *node, struct glint_error *err);
/* Keeps an error of the manifest, unless it is known. Returns whether to go on and find others: not after errors of another kind, and not when
   there are FAULTS_MAX, since finding the line of one takes a walk through the text. */
bool node_keep(const struct node *node, const struct glint_error *err);
/* True if there are none. Otherwise `err` is the first, and options->fault gets the others. */
bool faults_none(const struct faults *faults, const struct glint_pack_options *options, struct glint_error *err);
void faults_finish(struct faults *faults);
bool node_no_memory(const struct node *node, struct glint_error *err);
/* Tells the caller what was understood. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void node_note(const struct node *node, enum glint_pack_note kind, const char *format, ...);

/* Values of the node's key, which check.c has accepted. */
bool node_has(const struct node *node, const char *key);
const char *node_text(const struct node *node, const char *key); /* NULL: not said */
double node_number(const struct node *node, const char *key, double fallback);
/* Limited to UINT32_MAX by check.c, but for keys of bytes. */
uint64_t node_count(const struct node *node, const char *key, uint64_t fallback);
bool node_bool(const struct node *node, const char *key, bool fallback);
/* False if nothing was said; `out` is then unchanged. */
bool node_numbers(const struct node *node, const char *key, double *out);

#endif
