/* The definition and results of an attribution on disk, from which an interrupted one resumes, and the parts of it that shards do. */
#include <stdlib.h>
#include <string.h>

#include "blame/blame.h"

/* ---- The definition ---- */

/* Everything that results in the log depend on. The number of permutations does not belong to it, because permutations share coalitions. */
static json_t *define(const struct blame *blame, const struct list *shaders, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(blame->device);
    json_t *captures = captures_json(&blame->captures, blame->captures.count > 1, err),
           *before = captures ? captures_json(&blame->before, false, err) : NULL,
           *sources = before ? shaders_json(shaders, err) : NULL, *players = json_array();
    for (size_t p = 0; p < blame->count; p++)
        json_array_append_new(players, json_string(glint_player_change(blame->players, p)));
    if (!sources) {
        json_decref(captures);
        json_decref(before);
        json_decref(players);
        return NULL;
    }
    json_t *json = json_pack("{s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:s, s:o, s:I, s:b, s:I, s:[ss]}", "format", 1,
                             "glint", GLINT_VERSION, "effect", blame->against.effect->name, "captures", captures,
                             "before", before, "pipeline", pipeline_json(blame->base), "shaders", sources, "players",
                             players, "reference", blame->against.truth ? "truth" : "computed", "reference_runs",
                             strings_json(blame->against.references.items), "reference_rays",
                             (json_int_t)blame->against.rays, "all", blame->all, "metrics", (json_int_t)blame->metrics,
                             "device", device->name, device->driver_version);
    if (!json) fail_memory(err);
    return json;
}

/* ---- Lines ---- */

struct blame_round *blame_rounds(struct blame *blame, size_t capture) {
    struct blame_round **rounds = &blame->of[capture].rounds;
    if (!*rounds) *rounds = calloc(blame->rounds * blame->timed_count + 1, sizeof **rounds);
    return *rounds;
}

/* Times of other rounds and coalitions are those of a call with other options. */
static bool keep_time(struct blame *blame, size_t capture, uint32_t coalition, json_int_t round, const json_t *line) {
    size_t at = 0;
    while (at < blame->timed_count && blame->timed[at] != coalition) at++;
    if (round >= blame->rounds || at == blame->timed_count) return true;
    struct blame_round *rounds = blame_rounds(blame, capture);
    const json_t *ms = json_object_get(line, "frame_ms");
    if (!rounds || !json_is_number(ms)) return false;
    rounds[(size_t)round * blame->timed_count + at] = (struct blame_round){true, json_number_value(ms)};
    return true;
}

static bool keep_look(struct blame_capture *of, uint32_t coalition, int64_t at) {
    if (of->look_count == of->look_room) {
        const size_t room = of->look_room ? 2 * of->look_room : 16;
        struct blame_look *looks = realloc(of->looks, room * sizeof *looks);
        if (!looks) return false;
        of->looks = looks;
        of->look_room = room;
    }
    of->looks[of->look_count++] = (struct blame_look){coalition, at};
    return true;
}

static bool keep_line(void *user, json_t *line) {
    struct blame *blame = user;
    const json_t *c = json_object_get(line, "capture"), *s = json_object_get(line, "coalition"),
                 *r = json_object_get(line, "round");
    if (!json_is_integer(c) || !json_is_integer(s)) return false;
    const json_int_t capture = json_integer_value(c), coalition = json_integer_value(s), round = json_integer_value(r);
    if (capture < 0 || capture >= (json_int_t)blame->captures.count || coalition < 0 ||
        coalition >= (json_int_t)1 << blame->count)
        return false;
    struct blame_capture *of = &blame->of[capture];
    if (r)
        return json_is_integer(r) && round >= 0 && round <= UINT32_MAX &&
               keep_time(blame, (size_t)capture, (uint32_t)coalition, round, line);
    if (json_is_string(json_object_get(line, "failed"))) {
        if (of->failed_at < 0) of->failed_at = blame->journal.at;
        return of->failed = true;
    }
    return json_is_object(json_object_get(line, "errors")) && keep_look(of, (uint32_t)coalition, blame->journal.at);
}

int64_t blame_found(const struct blame *blame, size_t capture, uint32_t coalition) {
    const struct blame_capture *of = &blame->of[capture];
    for (size_t i = 0; i < of->look_count; i++)
        if (of->looks[i].coalition == coalition) return of->looks[i].at;
    return -1;
}

void blame_forget_looks(struct blame_capture *capture) {
    free(capture->looks);
    capture->looks = NULL;
    capture->look_count = capture->look_room = 0;
}

char *blame_failure(const struct blame *blame, size_t capture) {
    struct glint_error err = {0};
    if (blame->of[capture].failed_at < 0) return NULL;
    json_t *line = journal_read((struct journal *)&blame->journal, blame->of[capture].failed_at, &err);
    const char *failure = json_string_value(json_object_get(line, "failed"));
    char *text = strdup(failure ? failure : err.message);
    json_decref(line);
    return text;
}

bool blame_open(struct blame *blame, const struct list *shaders, struct glint_error *err) {
    blame_choose_timed(blame);
    blame->of = calloc(blame->captures.count + 1, sizeof *blame->of);
    blame->journal =
        (struct journal){.folder = blame->out, .kind = "blame", .reread = true, .keep = keep_line, .user = blame};
    if (!blame->of) return fail_memory(err);
    for (size_t c = 0; c < blame->captures.count; c++) blame->of[c].failed_at = -1;
    return blame_cut(blame, err) && (blame->definition = define(blame, shaders, err)) &&
           journal_open(&blame->journal, blame->definition, err);
}

/* ---- Shards ---- */

/* The place of a coalition in its capture's part of the whole work. Its bits are reversed, so that neighbours differ in the last player: the number of rays,
   which makes half of all pipelines expensive. */
static size_t place_of(const struct blame *blame, uint32_t coalition) {
    size_t place = 0;
    for (size_t p = 0; p < blame->count; p++) place |= (size_t)(coalition >> p & 1) << (blame->count - 1 - p);
    return place;
}

static size_t points_of(const struct blame *blame) {
    return blame->divided ? (size_t)1 << blame->count : 1;
}

bool blame_works_on(const struct blame *blame, size_t capture, uint32_t coalition) {
    const size_t points = points_of(blame),
                 place = capture * points + (blame->divided ? place_of(blame, coalition) : 0);
    return place >= blame->begin && place < blame->end;
}

size_t blame_looks(const struct blame *blame) {
    const size_t whole = (size_t)1 << blame->count,
                 drawn = 2 * blame->count + 2 + blame->options.permutations * blame->count;
    return blame->count <= blame->options.exact || drawn > whole ? whole : drawn;
}

/* In rays and pixels: a reference's, and those of the mean coalition. */
static struct shard_cost cost_of(const struct blame *blame, double pixels) {
    const struct answer_args *against = &blame->against;
    const bool traces = !against->truth && !against->references.count;
    const double rays = against->rays ? against->rays : GLINT_JUDGE_RAYS,
                 ideal = blame->player_rays ? blame->player_rays : rays,
                 results = (double)blame_looks(blame) + blame->rounds * (double)blame->timed_count;
    return (struct shard_cost){traces ? rays * pixels : pixels,
                               pixels * (1 + 0.5 * ideal) * results / (double)points_of(blame)};
}

bool blame_cut(struct blame *blame, struct glint_error *err) {
    const size_t count = blame->captures.count;
    struct shard_cost *costs = calloc(count + 1, sizeof *costs);
    bool ok = costs || fail_memory(err);
    blame->divided = blame->count <= blame->options.exact;
    for (size_t c = 0; ok && blame->shard.count && c < count; c++) {
        double pixels;
        ok = shard_pixels(blame->captures.items[c], &pixels, err);
        costs[c] = cost_of(blame, pixels);
    }
    if (ok) shard_cut(&blame->shard, costs, count, points_of(blame), &blame->begin, &blame->end);
    free(costs);
    return ok;
}

size_t blame_expected(const struct blame *blame, size_t *all) {
    const size_t looks = blame_looks(blame);
    size_t own = (blame->end - blame->begin) * (blame->divided ? 1 : looks);
    for (size_t c = 0; c < blame->captures.count; c++)
        for (size_t i = 0; i < blame->timed_count; i++)
            own += blame_works_on(blame, c, blame->timed[i]) ? blame->rounds : 0;
    *all = blame->captures.count * (looks + blame->rounds * blame->timed_count);
    return own;
}
