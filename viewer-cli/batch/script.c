/* The job scripts of a batch, which a person can read, change and submit. They find their logs by the folder that they are submitted from, so that no path stands in
   lines of #SBATCH, which quote in a way of their own. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "batch/batch.h"
#include "io/output.h"
#include "io/shell.h"

/* An option as a line of #SBATCH, in which quotes hold words together and a backslash takes the next character as it is. */
static void put_option(FILE *out, const char *option) {
    const char *value = strchr(option, '=');
    const size_t name = value ? (size_t)(value + 1 - option) : 0;
    const bool plain = !option[strcspn(option, " \t\"'\\#")];
    fputs("#SBATCH ", out);
    if (plain) fputs(option, out);
    else {
        fprintf(out, "%.*s\"", (int)name, option);
        for (const char *p = option + name; *p; p++) fprintf(out, "%s%c", *p == '"' || *p == '\\' ? "\\" : "", *p);
        fputc('"', out);
    }
    fputc('\n', out);
}

static void put_options(FILE *out, const struct batch_script *script) {
    fputs("#SBATCH --ntasks=1\n", out);
    if (script->gpus) fprintf(out, "#SBATCH --gpus-per-task=%u\n", script->gpus);
    if (script->partition) {
        char *option = NULL;
        if (asprintf(&option, "--partition=%s", script->partition) < 0) option = NULL;
        if (option) put_option(out, option);
        free(option);
    }
    for (size_t i = 0; script->sbatch && script->sbatch[i]; i++) put_option(out, script->sbatch[i]);
}

/* Where glint was called, and its executable file. */
struct place {
    char folder[4096], program[4096];
};

static bool find_place(struct place *place, struct glint_error *err) {
    const ssize_t length = readlink("/proc/self/exe", place->program, sizeof place->program - 1);
    if (length < 0) return glint_fail(err, GLINT_ERROR_IO, "/proc/self/exe: %s", strerror(errno));
    place->program[length] = '\0';
    return getcwd(place->folder, sizeof place->folder) ||
           glint_fail(err, GLINT_ERROR_IO, "the current folder: %s", strerror(errno));
}

static void put_command(FILE *out, const struct place *place, const char *command) {
    fputs("\ncd ", out);
    shell_path(out, place->folder);
    fputs(" || exit\nexec ", out);
    shell_word(out, place->program);
    fprintf(out, " %s", command);
}

static void put_shard(FILE *out, const struct batch *batch, const struct batch_script *script,
                      const struct place *place) {
    bool dashed = false;
    fprintf(out,
            "#!/bin/bash\n"
            "# Shard $SLURM_ARRAY_TASK_ID of %zu of glint %s. By hand, in the folder of this file:\n"
            "#   sbatch " BATCH_SHARD_SCRIPT "\n"
            "#   sbatch --dependency=afterok:JOB " BATCH_MERGE_SCRIPT "\n"
            "#SBATCH --job-name=glint-%s\n"
            "#SBATCH --array=1-%zu\n"
            "#SBATCH --output=" BATCH_LOGS "/shard-%%a-%%A.txt\n",
            batch->count, batch->command, batch->command, batch->count);
    put_options(out, script);
    put_command(out, place, batch->command);
    fprintf(out, " --shard=\"$SLURM_ARRAY_TASK_ID/%zu\" --%s=", batch->count, script->option);
    shell_word(out, script->output);
    for (size_t i = 0; script->options && script->options[i]; i++) {
        fputs(" \\\n    ", out);
        shell_word(out, script->options[i]);
    }
    for (size_t i = 0; script->operands[i]; i++) dashed |= script->operands[i][0] == '-';
    if (dashed) fputs(" --", out);
    for (size_t i = 0; script->operands[i]; i++) {
        fputs(" \\\n    ", out);
        shell_word(out, script->operands[i]);
    }
    fputc('\n', out);
}

static void put_merge(FILE *out, const struct batch *batch, const struct batch_script *script,
                      const struct place *place) {
    fprintf(out,
            "#!/bin/bash\n"
            "# Makes the result of all %zu shards of glint %s, when they are done.\n"
            "#SBATCH --job-name=glint-merge\n"
            "#SBATCH --output=" BATCH_LOGS "/merge-%%j.txt\n",
            batch->count, batch->command);
    put_options(out, script);
    put_command(out, place, "merge");
    fputc(' ', out);
    shell_path(out, script->output);
    fputc('\n', out);
}

typedef void (*put_script)(FILE *out, const struct batch *batch, const struct batch_script *script,
                           const struct place *place);

static bool write_script(const struct batch *batch, const char *name, put_script put, const struct batch_script *script,
                         const struct place *place, struct glint_error *err) {
    char path[4096], *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return fail_memory(err);
    put(out, batch, script, place);
    const bool whole = !ferror(out);
    const bool ok = (fclose(out) == 0 && whole) || fail_memory(err);
    const bool written = ok && batch_path(batch, name, path, err) && output_text(path, text, err);
    free(text);
    return written;
}

bool batch_write_scripts(const struct batch *batch, const struct batch_script *script, struct glint_error *err) {
    struct place place;
    return find_place(&place, err) && write_script(batch, BATCH_SHARD_SCRIPT, put_shard, script, &place, err) &&
           write_script(batch, BATCH_MERGE_SCRIPT, put_merge, script, &place, err);
}
