/* JSON that is whole: run.json and what else glint's libraries write. A record that could not be made whole, because there was no memory, is NULL, and so is
   what it would have been a member of: a run.json that lacks something is never written. json_pack does that for values that are NULL ("so"), and these
   functions for members that are added one by one. For glint's own libraries. */
#ifndef GLINT_RECORD_H
#define GLINT_RECORD_H

#include <jansson.h>
#include <stdbool.h>

/* The record, or NULL if it lacks something; the reference is used up. */
static inline json_t *record_if(bool whole, json_t *record) {
    if (whole) return record;
    json_decref(record);
    return NULL;
}

/* Take `value`, also if *list is NULL. */
static inline void record_append(json_t **list, json_t *value) {
    const bool whole = json_array_append_new(*list, value) == 0;
    *list = record_if(whole, *list);
}

static inline void record_set(json_t **object, const char *key, json_t *value) {
    const bool whole = json_object_set_new(*object, key, value) == 0;
    *object = record_if(whole, *object);
}

/* Whether JSON can hold the text, which has to be UTF-8: then it is memory that a text lacks that could not be made. */
bool record_can_hold(const char *text);

/* A record as JSON, malloc'd; NULL without memory or record. Jansson's own functions pass over some pieces that could not be stored or written, and report
   success (2.14: the separator before a value), so that a full disk went unnoticed. */
char *record_text(const json_t *record, size_t flags);

#endif
