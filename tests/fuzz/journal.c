/* Fuzzes the journals from which sweeps, searches and attributions go on: the input's first line is the definition, the others are the log. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "journal/journal.h"

static bool keep_line(void *user, json_t *line) {
    json_t **last = user;
    if (!json_is_object(line)) return false;
    json_decref(*last);
    *last = json_incref(line);
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    json_t *last = NULL, *definition = json_pack("{s:i, s:s, s:[i, i]}", "format", 1, "glint", "0", "captures", 1, 2);
    const uint8_t *end = memchr(data, '\n', size);
    const size_t first = end ? (size_t)(end - data) : size, rest = end ? first + 1 : size;
    struct journal journal = {.folder = fuzz_folder(), .kind = "sweep", .keep = keep_line, .user = &last};
    fuzz_file("sweep.json", data, first);
    fuzz_file("log.jsonl", data + rest, size - rest);
    fuzz_must(definition != NULL, "there is memory");
    if (fuzz_reason(journal_open(&journal, definition, &err), &err)) {
        char text[512];
        const size_t results = journal.results;
        journal_describe_kept(&journal, "points", text);
        fuzz_must(journal_append(&journal, json_pack("{s:i}", "capture", 1), &err), err.message);
        journal_close(&journal);
        journal = (struct journal){.folder = fuzz_folder(), .kind = "sweep", .keep = keep_line, .user = &last};
        fuzz_must(journal_open(&journal, definition, &err), err.message);
        fuzz_must(journal.results == results + 1,
                  "a journal that was read can be read again, with the line that was added");
    }
    journal_close(&journal);
    json_decref(last);
    json_decref(definition);
    return 0;
}
