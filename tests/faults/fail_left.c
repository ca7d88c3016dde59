/* The blocks that glint allocated and nobody freed so far: a hash table of open addressing. */
#include "fail.h"

#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

enum { SLOTS = 1 << 17, FULL = SLOTS / 4 * 3, FILES = 256, LINE_BYTES = 512 };

static struct slot { const void *block, *site; } slots[SLOTS];
static size_t used;
static bool full;
static atomic_flag lock = ATOMIC_FLAG_INIT;

static size_t home_of(const void *block) {
    return (size_t)(((uintptr_t)block >> 4) * 11400714819323198485u >> 47) % SLOTS;
}

static size_t next_of(size_t i) {
    return (i + 1) % SLOTS;
}

static size_t find(const void *block) {
    size_t i = home_of(block);
    while (slots[i].block && slots[i].block != block) i = next_of(i);
    return i;
}

void fail_left_add(const void *block, const void *site) {
    while (atomic_flag_test_and_set(&lock)) continue;
    if (used == FULL) full = true;
    else {
        slots[find(block)] = (struct slot){block, site};
        used++;
    }
    atomic_flag_clear(&lock);
}

/* Moves back what stood behind the slot that becomes free, if it may stand there. */
static void close_gap(size_t gap) {
    for (size_t i = next_of(gap); slots[i].block; i = next_of(i)) {
        const size_t home = home_of(slots[i].block);
        const bool between = gap < i ? home > gap && home <= i : home > gap || home <= i;
        if (between) continue;
        slots[gap] = slots[i];
        gap = i;
    }
    slots[gap] = (struct slot){0};
}

const void *fail_left_remove(const void *block) {
    if (!block || !used) return NULL;
    while (atomic_flag_test_and_set(&lock)) continue;
    const size_t i = find(block);
    const void *site = slots[i].block ? slots[i].site : NULL;
    if (site) {
        close_gap(i);
        used--;
    }
    atomic_flag_clear(&lock);
    return site;
}

void fail_left_write(int file) {
    char line[LINE_BYTES] = "left ";
    const size_t start = 5;
    int open_files = 0;
    bool written = true;
    for (size_t i = 0; i < SLOTS && written; i++) {
        if (!slots[i].block || slots[i].block == stdout->_IO_buf_base) continue; /* glibc's, until the process ends */
        const size_t length = fail_stack_name(slots[i].site, line + start, sizeof line - start);
        written = write(file, line, start + length) > 0;
    }
    for (int i = 0; i < FILES; i++) open_files += fcntl(i, F_GETFD) >= 0;
    dprintf(file, "open %d\n%s", open_files, full ? "left ? ?\n" : "");
}
