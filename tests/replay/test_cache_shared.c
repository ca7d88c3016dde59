/* Many processes that read, write, evict and damage one cache folder. */
#include <signal.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cache_place.h"

enum { PROCESSES = 6, KEYS = 5, LIMIT = 3000 };

static void make_key(unsigned k, char key[GLINT_CACHE_KEY_SIZE]) {
    snprintf(key, GLINT_CACHE_KEY_SIZE, "%032x", k + 1);
}

/* What the entries of a key begin with; what follows is of the process that stored it, as times are. */
static void make_contents(unsigned k, unsigned process, char text[1024]) {
    const int length = snprintf(text, 1024, "key %u process %u ", k, process);
    memset(text + length, (int)('a' + k), 600 + 20 * k);
    snprintf(text + length + 600 + 20 * k, 16, " end");
}

/* Changes an entry without its name, in place or by another file. */
static void damage_any(const struct place *place, unsigned chance, unsigned process) {
    char path[256 + sizeof place->folder], other[160];
    DIR *entries = opendir(place->folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (entry->d_name[0] == '.' || strstr(entry->d_name, ".tmp-") || chance-- % KEYS) continue;
        snprintf(path, sizeof path, "%s/%s", place->folder, entry->d_name);
        if (chance % 3 == 0) unlink(path);
        else if (chance % 3 == 1 && truncate(path, chance % 600)) continue;
        else {
            snprintf(other, sizeof other, "%s/wrong%u", place->top, process);
            write_text(other, "key 0 process 0 but not its end");
            rename(other, path);
        }
        break;
    }
    if (entries) closedir(entries);
}

/* Exits with 1 if it was given what nobody stored. */
static void use_cache(const struct place *place, unsigned process, unsigned rounds, atomic_uint *hits) {
    char key[GLINT_CACHE_KEY_SIZE], own[160], back[160], found[256], expected[1024], text[1024];
    unsigned chance = 12345 + process * 7919, k, by;
    snprintf(own, sizeof own, "%s/own%u.txt", place->top, process);
    snprintf(back, sizeof back, "%s/back%u", place->top, process);
    for (unsigned i = 0; i < rounds; i++) {
        chance = chance * 1103515245 + 12345;
        k = chance >> 16 & 0x7fff;
        if (k % 11 == 0) damage_any(place, k / 11, process);
        k %= KEYS;
        make_key(k, key);
        glint_cache_find(place->folder, key, found, sizeof found);
        if (!glint_cache_copy(place->folder, key, back)) {
            make_contents(k, process, text);
            write_text(own, text);
            glint_cache_store(place->folder, key, own, LIMIT);
            continue;
        }
        FILE *file = fopen(back, "r");
        const size_t length = file ? fread(text, 1, sizeof text - 1, file) : 0;
        text[length] = 0;
        if (file) fclose(file);
        if (sscanf(text, "key %*u process %u", &by) != 1) _exit(1);
        make_contents(k, by, expected);
        if (by >= PROCESSES || strcmp(text, expected) != 0) _exit(1);
        atomic_fetch_add(hits, 1);
    }
    _exit(0);
}

/* Catches: contents that are damaged, cut or of another key; an error that a file causes which vanishes; a limit that many exceed together; and
   temporary files that a killed process leaves. */
static void many_processes_read_write_evict_and_damage(UNUSED void **state) {
    struct place place;
    char path[256], key[GLINT_CACHE_KEY_SIZE], text[1024];
    int status;
    pid_t children[PROCESSES];
    begin(&place);
    atomic_uint *hits = mmap(NULL, sizeof *hits, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(hits, MAP_FAILED);
    for (unsigned p = 0; p < PROCESSES; p++) {
        children[p] = fork();
        assert_true(children[p] >= 0);
        if (children[p] == 0) use_cache(&place, p, p == 0 ? UINT32_MAX : 150, hits);
    }
    for (unsigned p = 1; p < PROCESSES; p++) {
        assert_int_equal(waitpid(children[p], &status, 0), children[p]);
        assert_int_equal(status, 0);
    }
    assert_int_equal(kill(children[0], SIGKILL), 0); /* the one that would go on for ever, somewhere in the midst */
    assert_int_equal(waitpid(children[0], &status, 0), children[0]);
    assert_true(WIFSIGNALED(status));
    assert_true(atomic_load(hits) > 50); /* of more than 750 */
    assert_int_equal(munmap(hits, sizeof *hits), 0);
    for (unsigned k = 0; k <= KEYS; k++) { /* whatever is left, and one that nobody stored */
        make_key(k, key);
        make_contents(k, 0, text);
        write_text(place.file, text);
        usleep(20000); /* times of files have a limited resolution */
        glint_cache_store(place.folder, key, place.file, LIMIT);
        assert_true(glint_cache_find(place.folder, key, path, sizeof path));
    }
    const size_t left = count_files(place.folder);
    assert_int_equal(left, 4); /* of more than 600 and less than 750 bytes each, and no temporary file */
    remove_place(&place);
}

/* Catches: processes that count only what they removed themselves, and so remove more and more. */
static void several_that_evict_remove_no_more_than_one(UNUSED void **state) {
    enum { OLD = 600, LEFT = 300 };
    struct place place;
    char path[256], own[128];
    pid_t children[4];
    int start[2], status;
    begin(&place);
    write_text(place.file, "ten bytes.");
    glint_cache_store(place.folder, keys[0], place.file, 0);
    for (unsigned i = 0; i < OLD; i++) {
        snprintf(path, sizeof path, "%s/%032x-%032x", place.folder, i + 1, i);
        write_text(path, "ten bytes.");
        set_age(path, 1000 + i);
    }
    assert_int_equal(pipe(start), 0);
    for (unsigned p = 0; p < 4; p++) {
        children[p] = fork();
        assert_true(children[p] >= 0);
        if (children[p]) continue;
        snprintf(own, sizeof own, "%032x", 0xabc0 + p);
        close(start[1]);
        if (read(start[0], path, 1) != 0) _exit(1); /* until all are there */
        glint_cache_store(place.folder, own, place.file, 10 * LEFT);
        _exit(0);
    }
    close(start[0]);
    close(start[1]);
    for (unsigned p = 0; p < 4; p++) {
        assert_int_equal(waitpid(children[p], &status, 0), children[p]);
        assert_int_equal(status, 0);
    }
    /* Those that did not see each other's new entries leave up to as many more. */
    assert_in_range(count_files(place.folder), LEFT, LEFT + 3);
    remove_place(&place);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_processes_read_write_evict_and_damage),
        cmocka_unit_test(several_that_evict_remove_no_more_than_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
