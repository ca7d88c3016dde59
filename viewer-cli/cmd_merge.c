/* glint merge: makes the result of a study of its shards. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command.h"
#include "io/console.h"
#include "journal/journal.h"
#include "journal/merge.h"
#include "journal/shard.h"
#include "options/args.h"

struct arguments {
    struct list folders;
    const char *out;
    bool json, only;
};

enum { KEY_JOURNAL = 256 };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",       'o',         "FOLDER", 0, "Folder for the result (default: the folder DIR, whose shards are merged)", 0},
    {"journal-only", KEY_JOURNAL, NULL,     0, "Merge the journals and files, without the tables and the page that the command makes of them", 0},
    {"json",         'j',         NULL,     0, "Print the JSON that the command prints", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint merge steps", "puts the shards of glint sweep … -o steps --shard K/N together, in steps"},
    {"glint merge steps/shards/*-of-8 -o merged", "does so in another folder"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED('j', struct arguments, json),
    STORED(KEY_JOURNAL, struct arguments, only),
    STORED(ARGP_KEY_ARG, struct arguments, folders),
    {0},
};

/* ---- The shards of a folder ---- */

static bool is_folder(const char *folder, const char *name, char path[4096]) {
    struct stat info;
    return journal_path(folder, name, path, NULL) && stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* All folders K-of-N of DIR/shards. They are owned by `made`. */
static bool find_shards(const char *shards, struct list *found, json_t *made, struct glint_error *err) {
    DIR *entries = opendir(shards);
    if (!entries) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", shards, strerror(errno));
    for (const struct dirent *entry; (entry = readdir(entries));) {
        char path[4096];
        struct shard shard;
        if (!shard_of_name(entry->d_name, &shard) || !is_folder(shards, entry->d_name, path)) continue;
        json_t *kept = json_string(path);
        json_array_append_new(made, kept);
        if (kept) list_add(found, json_string_value(kept), NULL);
    }
    closedir(entries);
    return found->count || glint_fail(err, GLINT_ERROR_USAGE, "%s: expected folders K-of-N, found none", shards);
}

/* Replaces the only folder by the shards that it has. */
static bool expand(struct arguments *a, json_t *made, struct glint_error *err) {
    char path[4096];
    if (a->folders.count != 1 || !is_folder(a->folders.items[0], "shards", path)) return true;
    struct list found = {0};
    if (!a->out) a->out = a->folders.items[0];
    const bool ok = find_shards(path, &found, made, err);
    list_free(&a->folders);
    a->folders = found;
    return ok;
}

/* ---- The command ---- */

/* Runs the command of the shards in the merged folder, where nothing is left to be measured. */
static enum status run_command(const struct arguments *a, const struct merge *merge, const char *out,
                               const struct command *command, struct glint_error *err) {
    const size_t given = json_array_size(merge->arguments);
    const char *const added[] = {command->rounds ? "--folder" : "-o", out, "--shard", "whole",
                                 a->json ? "--json" : NULL};
    char **argv = calloc(given + 8, sizeof *argv);
    int argc = 0;
    if (!argv) return fail_memory(err), command_fail(&cmd_merge, err);
    argv[argc++] = strdup(command->name);
    size_t cut = 0; /* what follows -- is no option */
    while (cut < given && strcmp(json_string_value(json_array_get(merge->arguments, cut)), "--") != 0) cut++;
    for (size_t i = 0; i < given || i == cut; i++) {
        for (size_t k = 0; i == cut && k < sizeof added / sizeof *added && added[k]; k++)
            argv[argc++] = strdup(added[k]);
        if (i < given) argv[argc++] = strdup(json_string_value(json_array_get(merge->arguments, i)));
    }
    enum status status = STATUS_CHECK;
    bool ok = true;
    for (int i = 0; i < argc; i++) ok = ok && argv[i];
    if (!ok) fail_memory(err);
    else if (chdir(merge->folder) != 0)
        ok = glint_fail(err, GLINT_ERROR_IO, "%s, where the shards were made: %s", merge->folder, strerror(errno));
    status = ok ? command->run(argc, argv) : command_fail(&cmd_merge, err);
    for (int i = 0; i < argc; i++) free(argv[i]);
    free(argv);
    return status;
}

/* As many as the system lets a process have: the journals of all shards are read at the same time. */
static void open_many_files(void) {
    struct rlimit files;
    if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
}

static enum status merge_shards(const struct arguments *a, struct merge *merge, struct glint_error *err) {
    if (!merge_open(merge, &a->folders, err)) return command_fail(&cmd_merge, err);
    const struct command *command = command_find(merge->command);
    if (!command || !command_option(command, KEY_SHARD)) {
        glint_fail(err, GLINT_ERROR_FORMAT, "%s/shard.json: expected a command with --shard, found %s",
                   a->folders.items[0], merge->command);
        return command_fail(&cmd_merge, err);
    }
    open_many_files();
    if (!(command->rounds ? merge_gather : merge_write)(merge, a->out, err)) return command_fail(&cmd_merge, err);
    if (a->only) {
        printf("%zu results of %zu shards are in %s\n", merge->results, merge->count, name_text(a->out));
        return STATUS_DONE;
    }
    char *out = realpath(a->out, NULL);
    if (!out) glint_fail(err, GLINT_ERROR_IO, "%s: %s", a->out, strerror(errno));
    const enum status status = out ? run_command(a, merge, out, command, err) : command_fail(&cmd_merge, err);
    free(out);
    return status;
}

static enum status cmd_merge_run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    struct merge merge = {0};
    json_t *made = json_array();
    command_parse(&cmd_merge, argc, argv, &a);
    bool ok = made ? expand(&a, made, &err) : fail_memory(&err);
    if (ok && !a.out)
        ok = glint_fail(&err, GLINT_ERROR_USAGE,
                        "%s: expected a folder with shards/K-of-N, as --shard makes it; shards that are named one by "
                        "one need -o FOLDER",
                        a.folders.items[0]);
    const enum status status = ok ? merge_shards(&a, &merge, &err) : command_fail(&cmd_merge, &err);
    merge_close(&merge);
    list_free(&a.folders);
    json_decref(made);
    return status;
}

const struct command cmd_merge = {
    .name = "merge",
    .arguments = "DIR | SHARD... -o FOLDER",
    .summary = "make the result of a study of its shards",
    .description =
        "Puts the shards of a study together that several processes made with --shard K/N, on one machine or on many: "
        "the result is that of one process. Their journals become one, in the order of one process; their references "
        "and "
        "pictures get a second name in the folder of the result, or are copied; and the command, which shard.json has, "
        "makes its tables, charts and page of them, in the folder in which it was run. All shards have to be there and "
        "done: one that died goes on where it stopped when its command is run again. Commands with --shard can be "
        "merged: "
        "what merge prints, and its exit status, are those of the command, such as 1 if glint lint has findings.",
    .options = options,
    .targets = targets,
    .operand = "folder",
    .examples = examples,
    .run = cmd_merge_run,
};
