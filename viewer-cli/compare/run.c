/* Compares the results of one effect on all captures, and writes what was found. */
#include <stdlib.h>
#include <string.h>

#include "compare/overall.h"
#include "draw/page/page.h"
#include "draw/view/png_file.h"
#include "io/output.h"
#include "io/pipe.h"
#include "options/capture_set.h"

/* ---- Runs ---- */

/* Runs all presets on a capture; or draws its pictures only, where showings is NULL. */
static bool run_capture(struct contest *contest, const struct list *captures, size_t i, struct showing *showings,
                        struct contest_pictures *pictures, struct glint_error *err) {
    struct pipe pipe;
    const char *file = pipe_input(&pipe, captures->items[i], err);
    struct glint_capture *capture = file ? glint_capture_open(file, NULL, err) : NULL;
    const bool ok = capture && capture_set_check_open(captures, i, capture, err) &&
                    (showings ? contest_run(contest, capture, showings, pictures, err)
                              : contest_picture(contest, capture, pictures, err));
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    if (ok && pictures) pictures->drawn = true;
    return ok;
}

/* Whether an error concerns more than one capture. */
static bool ends_all(const struct contest *contest, const struct list *captures, const struct glint_error *own) {
    return captures->count == 1 || own->code == GLINT_ERROR_INTERRUPTED || own->code == GLINT_ERROR_MEMORY ||
           glint_device_lost(contest->device);
}

/* The pictures of a capture that is judged, where all captures are shown. */
static struct contest_pictures *pictures_of(struct contest_work *work, size_t i) {
    return work->folder && !work->table.rows && !work->shard.count ? &work->pictures[i] : NULL;
}

struct judging {
    struct contest *contest;
    struct contest_work *work;
};

/* A capture that cannot be read, or is not the one that is meant, has a line that says so. */
static json_t *judge_capture(void *user, size_t i, struct glint_error *err) {
    const struct judging *judging = user;
    struct contest *contest = judging->contest;
    struct glint_error own = {0};
    struct showing *showings = calloc(contest->count + 1, sizeof *showings);
    if (!showings) return fail_memory(err), NULL;
    const bool ran = run_capture(contest, judging->work->captures, i, showings, pictures_of(judging->work, i), &own);
    json_t *line = NULL;
    if (!ran && ends_all(contest, judging->work->captures, &own)) *err = own;
    else if (!(line = contest_log_entry(contest, ran ? showings : NULL, own.message))) fail_memory(err);
    for (size_t p = 0; p < contest->count; p++) showing_finish(&showings[p]);
    free(showings);
    return line;
}

static bool judge_all(struct contest *contest, struct contest_work *work, struct glint_error *err) {
    struct judging judging = {contest, work};
    struct survey *survey = &work->log.survey;
    for (size_t i = survey->begin; i < survey->end; i++) {
        json_t *line = survey_take(survey, i, judge_capture, &judging, err);
        const bool ok = line && contest_log_keep(&work->log, i, line, err);
        json_decref(line);
        if (!ok) return false;
    }
    return true;
}

/* ---- Pictures ---- */

static bool make_folders(const char *folder, struct glint_error *err) {
    char path[4096];
    return journal_path(folder, "pictures", path, err) && glint_make_folder(path, err);
}

/* The pictures of a capture, which get the same share of the sheet and of the page as those of others. */
static struct contest_pictures place(const struct contest *contest, struct contest_work *work, size_t capture,
                                     size_t k) {
    const size_t columns = contest->count + 1, cells = CONTEST_ROWS * columns;
    const size_t bytes = work->table.rows ? PAGE_VALUE_BYTES / 8 : PAGE_VALUE_BYTES,
                 count = work->sheet.rows / CONTEST_ROWS;
    return (struct contest_pictures){.effect = contest->effect,
                                     .cells = &work->sheet.cells[k * cells],
                                     .columns = columns,
                                     .capture = capture,
                                     .beside = work->table.rows,
                                     .folder = work->folder,
                                     .values_bytes = bytes / (count * cells),
                                     .rows = json_pack("[[], [], []]")};
}

static bool begin_pictures(const struct contest *contest, struct contest_work *work, struct glint_error *err) {
    const size_t count = work->captures->count < CAPTURES_SHOWN ? work->captures->count : CAPTURES_SHOWN;
    if (!work->folder) return true;
    if (!sheet_init(&work->sheet, (uint32_t)contest->count + 1, CONTEST_ROWS * (uint32_t)count, err) ||
        !make_folders(work->folder, err))
        return false;
    for (size_t k = 0; k < count && !work->table.rows; k++) work->pictures[k] = place(contest, work, k, k);
    return true;
}

/* Draws the pictures of captures that are shown and were not drawn when they ran: the worst of many, and those of an earlier process. */
static bool draw_missing(struct contest *contest, struct contest_work *work, struct glint_error *err) {
    for (size_t k = 0; work->folder && k < work->table.shown_count; k++) {
        const size_t capture = work->table.shown[k], at = work->table.rows ? k : capture;
        if (work->table.rows) work->pictures[at] = place(contest, work, capture, at);
        if (!work->pictures[at].drawn && !run_capture(contest, work->captures, capture, NULL, &work->pictures[at], err))
            return false;
    }
    return true;
}

/* ---- Results ---- */

/* All captures that have results, or the worst of more. */
static void choose_shown(struct contest_work *work) {
    struct contest_table *t = &work->table;
    for (size_t i = 0; i < t->capture_count && t->shown_count < CAPTURES_SHOWN; i++) {
        const size_t capture = t->rows ? work->overall->order[i] : i;
        if (work->log.states[capture] == CONTEST_DONE) t->shown[t->shown_count++] = capture;
    }
}

static bool write_file(const struct contest_work *work, const char *name, struct glint_error *err) {
    char path[4096];
    struct output output;
    if (!journal_path(work->folder, name, path, err) || !output_open(&output, path, err)) return false;
    if (!strcmp(name, "table.csv")) contest_write_csv(output.file, &work->table);
    else contest_write_json(output.file, &work->table, work->overall, 1, 0);
    return output_close(&output, contest_log_check(&work->log, err), err);
}

static bool write_all(const struct contest_work *work, struct glint_error *err) {
    struct picture picture = {0};
    char path[4096];
    if (!work->folder) return true;
    const bool ok = journal_path(work->folder, "sheet.png", path, err) && write_file(work, "table.json", err) &&
                    write_file(work, "table.csv", err) && sheet_lay_out(&picture, &work->sheet, err) &&
                    png_file_write(path, &picture, err) &&
                    contest_write_page(work->folder, &work->table, work->overall, work->pictures, err);
    picture_finish(&picture);
    return ok;
}

static bool find_overall(struct contest_work *work, struct glint_error *err) {
    if (work->captures->count == 1) return true;
    work->overall = calloc(1, sizeof *work->overall);
    return work->overall ? contest_overall_find(work->overall, &work->log, err) : fail_memory(err);
}

static bool begin_shard(struct contest_work *work, struct glint_error *err) {
    const struct survey *survey = &work->log.survey;
    if (!work->record) return true;
    work->record->results = work->effects * (survey->end - survey->begin);
    if (!shard_begin(work->record, err)) return false;
    work->record = NULL;
    return true;
}

bool contest_compare(struct contest *contest, struct contest_work *work, struct glint_error *err) {
    const size_t count = work->captures->count;
    if (!contest_log_open(&work->log, contest, work->captures, work->folder, &work->shard, err)) return false;
    if (work->shard.count) return begin_shard(work, err) && judge_all(contest, work, err);
    work->table = (struct contest_table){.contest = contest,
                                         .log = &work->log,
                                         .captures = work->captures->items,
                                         .capture_count = count,
                                         .rows = count > CAPTURES_SHOWN};
    if (!begin_pictures(contest, work, err) || !judge_all(contest, work, err) || !find_overall(work, err)) return false;
    choose_shown(work);
    return draw_missing(contest, work, err) && write_all(work, err) && contest_log_check(&work->log, err);
}

void contest_work_finish(struct contest_work *work, bool finished) {
    for (size_t k = 0; k < CAPTURES_SHOWN; k++) json_decref(work->pictures[k].rows);
    if (work->overall) contest_overall_finish(work->overall);
    free(work->overall);
    contest_log_close(&work->log, finished);
    sheet_finish(&work->sheet);
}
